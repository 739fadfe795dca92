"""The road map under the names, codes and fields of whoever ordered it."""

from dataclasses import replace

from ..core.common.errors import RoadExtractionError
from .algorithm import Algorithm
from .call import existing_file
from .map_layers import MAP_LAYERS
from .texts import tr

# Parameters, which are the names of the layers in a template
TEMPLATE_LAYERS = ("ROAD_EDGES", "ROAD_SURFACE", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "LANES", "ROADSIDE", "ROADSIDE_OBJECTS",
                   "CROSS_SECTIONS")


class ExportTemplate(Algorithm):
    ID, TITLE, GROUP = "exporttemplate", "Export by template", "Export"
    NUMBERS = "FEATURES LAYERS LEFT_OUT".split()

    def declare(self):
        self.add_input("file", "TEMPLATE", file_filter="CSV (*.csv *.CSV *.tsv *.txt);;All files (*.*)")
        for name in TEMPLATE_LAYERS:
            self.add_map_layer(name, help=tr("Rows with {name} in the column from are about it.").format(name=name), optional=True)
        self.add_input("file", "OFFICE", optional=True, file_filter="GeoPackage (*.gpkg *.GPKG);;All files (*.*)")
        self.add_input("connection", "CONNECTION", optional=True)
        self.add_input("schema", "SCHEMA", optional=True, of="CONNECTION")
        self.add_output("file", "OUTPUT", optional=True, suffixes=(".gpkg", ".dxf"), file_filter="GeoPackage (*.gpkg);;DXF (*.dxf)")

    def work(self, call, progress):
        from ..core.io.crs import parse_crs, same_crs
        from ..products.client_fields import Database, apply_template, layers_of_client, read_template, write_client_layers

        schema = call.value("SCHEMA") or ""
        if bool(schema) != call.given("CONNECTION") or not (schema or call.wants("OUTPUT")):
            raise RoadExtractionError(tr("Nothing says where the map goes. Name a file as {output}, or both {connection} and {schema}.").format(
                output=call.label("OUTPUT"), connection=call.label("CONNECTION"), schema=call.label("SCHEMA")))
        database = Database(call.connection("CONNECTION"), schema, call.value("CONNECTION")) if schema else None
        drawing = call.wants("OUTPUT") and str(call.output_path("OUTPUT")).lower().endswith(".dxf")
        office = existing_file(call.file("OFFICE"), call.label("OFFICE")) if call.given("OFFICE") else ""
        if drawing and office:
            raise RoadExtractionError(tr("The client's GeoPackage cannot be filled as a DXF drawing. Leave it out, or name the result .gpkg."))
        known = {name: (MAP_LAYERS[name].schema, MAP_LAYERS[name].geometry) for name in TEMPLATE_LAYERS}
        template = read_template(existing_file(call.file("TEMPLATE"), call.label("TEMPLATE")), known, mixed=drawing)
        layers = {name: call.features(name, [replace(field, needed=False) for field in schema], geometry)
                  for name, (schema, geometry) in known.items() if call.given(name)}
        if not layers:
            raise RoadExtractionError(tr("No layer of the road map was given. Choose at least one of those that the template names."))
        for name in sorted({rule.source for rule in template.rules} - set(layers)):
            progress.info(tr("{label} was not given: the rows about it are not used.").format(label=call.label(name)))
        crs = next((features.crs for features in layers.values() if features.crs), "")
        for name, features in layers.items():
            if features.crs and not same_crs(parse_crs(features.crs), parse_crs(crs)):
                raise RoadExtractionError(tr("{label} is in another CRS than the other layers. Reproject it to theirs and run again.").format(
                    label=call.label(name)))
        made = apply_template(template, layers, layers_of_client(office, crs, template) if office else None)
        stored = apply_template(template, layers, layers_of_client(database, crs, template), whole=False).layers if database else {}
        if drawing:
            from ..products.cad import drawn_layers, write_dxf

            write_dxf(drawn_layers(made.layers), call.new_file("OUTPUT"), crs)
        elif call.wants("OUTPUT"):
            write_client_layers(made.layers, call.new_file("OUTPUT"), office)
        if database:
            write_client_layers(stored, database)
        for name, features in made.layers.items():
            progress.info(tr("{name}: {count:,} features").format(name=name, count=len(features)))
        for what, count in sorted(made.left_out.items()):
            progress.warn(tr("No row of the template takes {count} feature(s) of {what}.").format(count=count, what=what))
        return {"FEATURES": float(sum(map(len, made.layers.values()))), "LAYERS": float(len(made.layers)),
                "LEFT_OUT": float(sum(made.left_out.values()))}
