"""What else the road shows: its cross-sections and surface, and what stands beside it."""

from datetime import datetime

from ..core.common.features import BREAKLINES, CROSS_SECTIONS, ROADSIDE, ROADSIDE_OBJECTS, SURFACE_FACES
from ..core.countries.catalogue import COUNTRIES
from .algorithm import Algorithm, settings_of
from .survey_input import READING_SETTINGS, open_survey_with
from .texts import tr

BORDER_LAYERS = ("ROAD_EDGES", "MARKING_LINES", "DRIVING_LINES", "LANES")   # in the order of BorderLayers


def add_borders(algorithm, *helps, needed=()):
    """Declare the layers of the road map, each with what it is good for, "" where it is not asked for; those `needed` must be given."""
    for name, text in zip(BORDER_LAYERS, helps, strict=True):
        if text:
            algorithm.add_map_layer(name, text, optional=name not in needed)


def survey_with_borders(call, progress, above_road):
    """The survey, with points up to `above_road` metres above the road, and the BorderLayers, which lie on its roads and in its CRS.

    A layer without features, as a step before may have found nothing, counts as not given.
    """
    from ..products.inventory.borders import BorderLayers

    layers = {name: call.map_layer(name) for name in BORDER_LAYERS}
    survey = open_survey_with(call, layers, progress, above_road=above_road)
    return survey, BorderLayers(*layers.values())


SECTIONS = "products.inventory.borders:CrossSectionSettings"
ABOVE_SECTIONS = 12.0  # m of height above the road that are read: more than any clearance that a rule asks for

SECTION_SETTINGS = settings_of("inventory.SECTION_SETTINGS", SECTIONS,
    "INTERVAL COUNTRY MAX_RUT MIN_CROSSFALL* MAX_CROSSFALL* MAX_GRADE* MIN_WIDTH* MIN_CLEARANCE*", COUNTRY=dict(choices=tuple(COUNTRIES)))


class CrossSections(Algorithm):
    ID, TITLE, GROUP = "crosssections", "Cross-sections", "Inventory"
    SUMMARY = "Measures width, crossfall, grade, rut depth, curb heights and clearance of every lane at fixed stations against limits."
    TAGS = ("profile", "rutting", "crossfall", "superelevation", "clearance", "road condition", "width")
    LOOKS = {"OUTPUT": "CROSS_SECTIONS"}
    NUMBERS = (("SECTIONS", tr("Sections")),
               ("EXCEEDED", tr("Lanes and carriageways that exceed a limit")),
               ("LARGEST_RUT", tr("Greatest rut depth (mm)")),
               ("LEAST_CLEARANCE", tr("Least clearance (m)")))

    def declare(self):
        self.add_survey()
        add_borders(self,
                    tr("With it the carriageway ends at the edges, and heights of curbs are measured there."),
                    tr("With it lanes end at the painted lines."),
                    tr("With it lanes have their numbers and directions; not needed beside Lanes."),
                    tr("With it every lane, shoulder and parking strip of the road map is measured."))
        self.add_settings(SECTION_SETTINGS)
        self.add_settings(READING_SETTINGS)
        self.add_sink("OUTPUT", tr("Cross-sections"), tr("A line across every lane and carriageway at every section."), fields=CROSS_SECTIONS,
                      geometry="LineStringZ")
        self.add_sink("TABLE", tr("Table of the cross-sections"), tr("The same rows without lines, for spreadsheets."), fields=CROSS_SECTIONS,
                      geometry="None", optional=True, by_default=False)
        self.add_output("file", "DRAWING", tr("Drawing of the sections"), tr(
            "Every section true to scale, one below the other, with stations, heights and slopes, for CAD; lengths are metres."),
                        suffixes=(".dxf",), file_filter="DXF (*.dxf)", optional=True, by_default=False)
        self.add_output("file", "LANDXML", tr("Sections as LandXML"), tr(
            "LandXML 1.2: the reference line of every road as an alignment with its sections, offsets positive to the right as that format has "
            "them."), suffixes=(".xml", ".landxml"), file_filter="LandXML (*.xml *.landxml)", optional=True, by_default=False)
        self.add_output("file", "HEIGHTS", tr("Table of stations, offsets and heights"), tr(
            "A row for every place of every section: road, station, offset, left positive, and height, in metres."),
                        suffixes=(".csv",), file_filter="CSV (*.csv)", optional=True, by_default=False)
        self.add_report()

    def work(self, call, progress):
        from ..products.inventory.cross_sections import measure_cross_sections, sections_to_features
        from ..products.report.inventory import cross_section_report

        settings = call.settings(SECTION_SETTINGS)
        survey, layers = survey_with_borders(call, progress.part(0.0, 0.5), ABOVE_SECTIONS)
        sections = measure_cross_sections(survey, layers, settings, progress.part(0.5, 1.0))
        lines, table = sections_to_features(sections)
        call.layer("OUTPUT", lines)
        call.layer("TABLE", table)
        from ..products.cad import landxml_text, section_alignments, section_drawing, section_table, write_dxf

        if call.wants("DRAWING"):
            write_dxf(section_drawing(sections), call.new_file("DRAWING"))
        if call.wants("LANDXML"):
            call.text("LANDXML", landxml_text(section_alignments(sections), survey.crs, tr("Cross-sections"), datetime.now()))
        if call.wants("HEIGHTS"):
            call.text("HEIGHTS", section_table(sections))
        call.text("REPORT", cross_section_report(sections, table))
        return _numbers(table, len(sections.sections))


def _numbers(table, count):
    ruts = [value for name in ("rut_l_mm", "rut_r_mm") for value in table.column(name) if value is not None]
    clear = [value for value in table.column("clear_m") if value is not None]
    counts = {"SECTIONS": float(count), "EXCEEDED": float(sum(bool(row["exceeds"]) for row in table.rows))}
    return {**counts, **({"LARGEST_RUT": max(ruts)} if ruts else {}), **({"LEAST_CLEARANCE": min(clear)} if clear else {})}


ABOVE_SURFACE = 3.0  # m of height above the road that are read: banks beside it, and what stands on it, which is told from the ground

SURFACE_SETTINGS = settings_of("inventory.SURFACE_SETTINGS", "products.surface.model:SurfaceSettings", "TOLERANCE REACH CELL_SIZE MAX_GAP*")


class SurfaceOfRoad(Algorithm):
    ID, TITLE, GROUP = "surfacemodel", "Surface model", "Inventory"
    SUMMARY = "Makes the ground of the road for design: breaklines, and triangles between them that keep to a tolerance, for CAD and as a raster."
    TAGS = ("TIN", "DTM", "DEM", "terrain", "breakline", "LandXML", "DXF", "triangulation")
    NUMBERS = (("VERTICES", tr("Vertices of the triangles")), ("TRIANGLES", tr("Triangles")),
               ("RMSE", tr("Ground of the carriageway against the triangles, root mean square (m)")),
               ("SHARE", tr("Vertices for every hundred points of the ground")))

    def declare(self):
        self.add_survey()
        add_borders(self,
                    tr("Lines along whose bottom and top the surface breaks; between them the carriageway lies."),
                    tr("Without Lanes the surface follows the painted lines."),
                    "",
                    tr("With it the surface follows the borders of lanes."), needed=("ROAD_EDGES",))
        self.add_settings(SURFACE_SETTINGS)
        self.add_settings(READING_SETTINGS)
        self.add_sink("BREAKLINES", tr("Breaklines"), tr("A line for every stretch that was measured."), fields=BREAKLINES, geometry="LineStringZ")
        self.add_sink("TIN", tr("Triangles"), tr("A triangle where status is bridged lies over ground that was not seen."), fields=SURFACE_FACES,
                      geometry="PolygonZ", optional=True)
        self.add_output("file", "SURFACE_FILE", tr("Surface for CAD"), tr(
            "With the ending .xml for LandXML, or .dxf, which names no CRS. Both have the units of the survey's CRS."),
                        suffixes=(".xml", ".landxml", ".dxf"), file_filter="LandXML (*.xml *.landxml);;DXF (*.dxf)", optional=True, by_default=False)
        self.add_output("raster", "DEM", tr("Heights"), tr("A raster of the heights of the triangles."), optional=True, by_default=False)

    def work(self, call, progress):
        from ..products.surface.model import make_surface_model, surface_to_features, write_heights

        settings = call.settings(SURFACE_SETTINGS)
        survey, layers = survey_with_borders(call, progress.part(0.0, 0.4), ABOVE_SURFACE)
        model = make_surface_model(survey, layers, settings, progress.part(0.4, 0.9))
        for note in model.notes:
            progress.warn(note)
        lines, faces = surface_to_features(model)
        call.layer("BREAKLINES", lines)
        call.layer("TIN", faces)
        if call.wants("SURFACE_FILE"):
            from ..products.cad import landxml_text, surface_lines, write_dxf

            if call.new_file("SURFACE_FILE").lower().endswith(".dxf"):
                write_dxf(surface_lines(model), call.new_file("SURFACE_FILE"), model.crs, model.places[model.surface.faces])
            else:
                call.text("SURFACE_FILE", landxml_text((), model.crs, tr("Surface"), datetime.now(), model))
        if call.wants("DEM"):
            write_heights(model, call.new_file("DEM"), settings.cell_size, progress.part(0.9, 1.0))
        share = 100 * model.vertices / max(model.points, 1)
        progress.info(tr("{triangles} triangles with {vertices} vertices, {share:.2f} for every hundred points; they miss the ground of the "
                         "carriageway by {rmse:.1f} mm (root mean square).").format(triangles=len(faces), vertices=model.vertices, share=share,
                                                                                   rmse=1000 * model.rmse))
        return {"VERTICES": float(model.vertices), "TRIANGLES": float(len(faces)), "RMSE": model.rmse, "SHARE": share}


ABOVE_ROADSIDE = 8.0  # m of height above the road that are read: buildings reach higher than anything that is looked for

ROADSIDE_SETTINGS = settings_of("inventory.ROADSIDE_SETTINGS", "products.inventory.borders:RoadsideSettings",
    "INTERVAL* COUNTRY* REACH MIN_LENGTH MIN_HEIGHT* MAX_GAP* MIN_POLE_HEIGHT*", COUNTRY=dict(choices=tuple(COUNTRIES)))


class Roadside(Algorithm):
    ID, TITLE, GROUP = "roadside", "Roadside", "Inventory"
    SUMMARY = "Finds guard rails, concrete barriers, walls, fences, hedges and gutters as lines, and poles, signs and tree trunks as points."
    TAGS = ("guard rail", "barrier", "noise wall", "fence", "hedge", "pole", "sign", "tree", "asset", "street furniture")
    LOOKS = {"OUTPUT": "ROADSIDE", "OBJECTS": "ROADSIDE_OBJECTS"}
    NUMBERS = (("LENGTH", tr("Length of all lines but gutters (m)")), ("POLES", tr("Poles, signs and trunks")))

    def declare(self):
        self.add_survey()
        add_borders(self,
                    tr("With it things are looked for from the edges outward, and gutters along them."),
                    tr("With it the carriageway without edges ends at the outermost line."),
                    tr("With it the carriageway without edges holds every lane."),
                    tr("The same, with shoulders and parking strips."))
        self.add_settings(ROADSIDE_SETTINGS)
        self.add_settings(READING_SETTINGS)
        self.add_sink("OUTPUT", tr("Roadside"), tr("Pieces of lines along the foot, on the ground; those of one line have its number."),
                      fields=ROADSIDE, geometry="LineStringZ")
        self.add_sink("OBJECTS", tr("Poles, signs and trunks"), fields=ROADSIDE_OBJECTS, geometry="PointZ", optional=True)
        self.add_report()

    def work(self, call, progress):
        from ..products.inventory.roadside.find import find_roadside, roadside_to_features
        from ..products.report.inventory import roadside_report

        settings = call.settings(ROADSIDE_SETTINGS)
        survey, layers = survey_with_borders(call, progress.part(0.0, 0.6), ABOVE_ROADSIDE)
        roadside = find_roadside(survey, layers, settings, progress.part(0.6, 1.0))
        lines, points = roadside_to_features(roadside)
        call.layer("OUTPUT", lines)
        call.layer("OBJECTS", points)
        call.text("REPORT", roadside_report(roadside, lines, points))
        return {"LENGTH": sum(row["length_m"] for row in lines.rows if row["kind"] != "gutter"), "POLES": float(len(points))}
