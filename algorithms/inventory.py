"""What else the road shows: its cross-sections and surface, and what stands beside it."""

from datetime import datetime

from ..core.common.features import BREAKLINES, CROSS_SECTIONS, ROADSIDE, ROADSIDE_OBJECTS, SURFACE_FACES
from .algorithm import Algorithm, settings_of
from .rooms import products
from .survey_input import READING_SETTINGS, open_survey_with
from .texts import tr

BORDER_LAYERS = ("ROAD_EDGES", "MARKING_LINES", "DRIVING_LINES", "LANES")   # in the order of BorderLayers


def add_borders(algorithm, names=BORDER_LAYERS, needed=()):
    """Declare layers of the road map; those `needed` must be given."""
    for name in names:
        algorithm.add_map_layer(name, optional=name not in needed)


def survey_with_borders(call, progress, above_road):
    """The survey, with points up to `above_road` metres above the road, and the BorderLayers, which lie on its roads and in its CRS.

    A layer without features, as a step before may have found nothing, counts as not given.
    """
    layers = {name: call.map_layer(name) for name in BORDER_LAYERS}
    survey = open_survey_with(call, layers, progress, above_road=above_road)
    return survey, products.inventory.borders.BorderLayers(*layers.values())


ABOVE_SECTIONS = 12.0  # m of height above the road that are read: more than any clearance that a rule asks for

SECTION_SETTINGS = settings_of("products.inventory.borders:CrossSectionSettings",
    "INTERVAL COUNTRY MAX_RUT MIN_CROSSFALL* MAX_CROSSFALL* MAX_GRADE* MIN_WIDTH* MIN_CLEARANCE*")


class CrossSections(Algorithm):
    ID, TITLE, GROUP = "crosssections", "Cross-sections", "Inventory"
    NUMBERS = "SECTIONS EXCEEDED LARGEST_RUT LEAST_CLEARANCE".split()

    def declare(self):
        self.add_survey()
        add_borders(self)
        self.add_settings(SECTION_SETTINGS)
        self.add_settings(READING_SETTINGS)
        self.add_sink("OUTPUT", fields=CROSS_SECTIONS, geometry="LineStringZ", look="CROSS_SECTIONS")
        self.add_sink("TABLE", fields=CROSS_SECTIONS, geometry="None", optional=True, by_default=False)
        self.add_output("file", "DRAWING", suffixes=(".dxf",), file_filter="DXF (*.dxf)", optional=True, by_default=False)
        self.add_output("file", "LANDXML", suffixes=(".xml", ".landxml"), file_filter="LandXML (*.xml *.landxml)", optional=True, by_default=False)
        self.add_output("file", "HEIGHTS", suffixes=(".csv",), file_filter="CSV (*.csv)", optional=True, by_default=False)
        self.add_report()

    def work(self, call, progress):
        settings = call.settings(SECTION_SETTINGS)
        survey, layers = survey_with_borders(call, progress.part(0.0, 0.5), ABOVE_SECTIONS)
        sections = products.inventory.cross_sections.measure_cross_sections(survey, layers, settings, progress.part(0.5, 1.0))
        lines, table = products.inventory.cross_sections.sections_to_features(sections)
        call.layer("OUTPUT", lines)
        call.layer("TABLE", table)
        if call.wants("DRAWING"):
            products.cad.write_dxf(products.cad.section_drawing(sections), call.new_file("DRAWING"))
        if call.wants("LANDXML"):
            alignments = products.cad.section_alignments(sections)
            call.text("LANDXML", products.cad.landxml_text(alignments, survey.crs, tr("Cross-sections"), datetime.now()))
        if call.wants("HEIGHTS"):
            call.text("HEIGHTS", products.cad.section_table(sections))
        call.text("REPORT", products.report.inventory.cross_section_report(sections, table))
        return _numbers(table, len(sections.sections))


def _numbers(table, count):
    ruts = [value for name in ("rut_l_mm", "rut_r_mm") for value in table.column(name) if value is not None]
    clear = [value for value in table.column("clear_m") if value is not None]
    counts = {"SECTIONS": float(count), "EXCEEDED": float(sum(bool(row["exceeds"]) for row in table.rows))}
    return {**counts, **({"LARGEST_RUT": max(ruts)} if ruts else {}), **({"LEAST_CLEARANCE": min(clear)} if clear else {})}


ABOVE_SURFACE = 3.0  # m of height above the road that are read: banks beside it, and what stands on it, which is told from the ground

SURFACE_SETTINGS = settings_of("products.surface.model:SurfaceSettings", "TOLERANCE REACH CELL_SIZE MAX_GAP*")


class SurfaceOfRoad(Algorithm):
    ID, TITLE, GROUP = "surfacemodel", "Surface model", "Inventory"
    NUMBERS = "VERTICES TRIANGLES RMSE SHARE".split()

    def declare(self):
        self.add_survey()
        add_borders(self, ("ROAD_EDGES", "MARKING_LINES", "LANES"), needed=("ROAD_EDGES",))
        self.add_settings(SURFACE_SETTINGS)
        self.add_settings(READING_SETTINGS)
        self.add_sink("BREAKLINES", fields=BREAKLINES, geometry="LineStringZ")
        self.add_sink("TIN", fields=SURFACE_FACES, geometry="PolygonZ", optional=True)
        self.add_output("file", "SURFACE_FILE", suffixes=(".xml", ".landxml", ".dxf"), file_filter="LandXML (*.xml *.landxml);;DXF (*.dxf)",
                        optional=True, by_default=False)
        self.add_output("raster", "DEM", optional=True, by_default=False)

    def work(self, call, progress):
        settings = call.settings(SURFACE_SETTINGS)
        survey, layers = survey_with_borders(call, progress.part(0.0, 0.4), ABOVE_SURFACE)
        model = products.surface.model.make_surface_model(survey, layers, settings, progress.part(0.4, 0.9))
        progress.warn_all(model.notes)
        lines, faces = products.surface.model.surface_to_features(model)
        call.layer("BREAKLINES", lines)
        call.layer("TIN", faces)
        if call.wants("SURFACE_FILE"):
            if call.new_file("SURFACE_FILE").lower().endswith(".dxf"):
                products.cad.write_dxf(products.cad.surface_lines(model), call.new_file("SURFACE_FILE"), model.crs, model.places[model.surface.faces])
            else:
                call.text("SURFACE_FILE", products.cad.landxml_text((), model.crs, tr("Surface"), datetime.now(), model))
        if call.wants("DEM"):
            products.surface.model.write_heights(model, call.new_file("DEM"), settings.cell_size, progress.part(0.9, 1.0))
        share = 100 * model.vertices / max(model.points, 1)
        progress.info(tr("{triangles} triangles with {vertices} vertices, {share:.2f} for every hundred points; they miss the ground of the "
                         "carriageway by {rmse:.1f} mm (root mean square).", triangles=len(faces), vertices=model.vertices, share=share,
                         rmse=1000 * model.rmse))
        return {"VERTICES": float(model.vertices), "TRIANGLES": float(len(faces)), "RMSE": model.rmse, "SHARE": share}


ABOVE_ROADSIDE = 8.0  # m of height above the road that are read: buildings reach higher than anything that is looked for

ROADSIDE_SETTINGS = settings_of("products.inventory.borders:RoadsideSettings",
    "INTERVAL* COUNTRY* REACH MIN_LENGTH MIN_HEIGHT* MAX_GAP* MIN_POLE_HEIGHT*")


class Roadside(Algorithm):
    ID, TITLE, GROUP = "roadside", "Roadside", "Inventory"
    NUMBERS = "LENGTH POLES".split()

    def declare(self):
        self.add_survey()
        add_borders(self)
        self.add_settings(ROADSIDE_SETTINGS)
        self.add_settings(READING_SETTINGS)
        self.add_sink("OUTPUT", fields=ROADSIDE, geometry="LineStringZ", look="ROADSIDE")
        self.add_sink("OBJECTS", fields=ROADSIDE_OBJECTS, geometry="PointZ", optional=True, look="ROADSIDE_OBJECTS")
        self.add_report()

    def work(self, call, progress):
        settings = call.settings(ROADSIDE_SETTINGS)
        survey, layers = survey_with_borders(call, progress.part(0.0, 0.6), ABOVE_ROADSIDE)
        roadside = products.inventory.roadside.find.find_roadside(survey, layers, settings, progress.part(0.6, 1.0))
        lines, points = products.inventory.roadside.find.roadside_to_features(roadside)
        call.layer("OUTPUT", lines)
        call.layer("OBJECTS", points)
        call.text("REPORT", products.report.inventory.roadside_report(roadside, lines, points))
        return {"LENGTH": sum(row["length_m"] for row in lines.rows if row["kind"] != "gutter"), "POLES": float(len(points))}
