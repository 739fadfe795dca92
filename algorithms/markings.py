"""What is painted: intensity corrected and drawn, paint, markings and the lines along them, and their colours."""

from dataclasses import replace

from ..core.common.errors import RoadExtractionError
from ..core.common.features import COLOUR, MARKING_LINES, MARKINGS
from ..core.countries.catalogue import COUNTRIES
from .algorithm import Algorithm, ParameterSpec, settings_of
from .road import edges_of
from .rooms import core, products
from .survey_input import bright_road_points_of, check_layers_on_roads, frame_of, paint_of, road_points_of
from .texts import tr

INTENSITY_SETTINGS = settings_of("core.intensity.correction:IntensitySettings", "SCALE*")


class CorrectIntensity(Algorithm):
    ID, TITLE, GROUP = "correctintensity", "Correct intensity", "Markings"

    def declare(self):
        self.add_input("cloud", "ROAD_POINTS")
        self.add_trajectory()
        self.add_settings(INTENSITY_SETTINGS)
        self.add_output("cloud", "OUTPUT")
        self.add_report()

    def work(self, call, progress):
        road_points = bright_road_points_of(call, "ROAD_POINTS", progress.part(0.0, 0.2))
        frame = frame_of(call, road_points.crs, progress, road_points)
        corrected, report = core.intensity.correction.correct_intensity(
            road_points, frame, call.settings(INTENSITY_SETTINGS), progress.part(0.2, 0.8))
        core.survey.road_points_las.write_road_points(corrected, call.new_file("OUTPUT"), progress.part(0.8, 1.0))
        for line in report.lines()[1:]:  # the first was said when it was found, as was a warning
            if line != report.saturation.warning:
                progress.info(line)
        call.text("REPORT", products.report.page.html_page("intensity_correction", report=report))


IMAGE_SETTINGS = settings_of("core.intensity.image:ImageSettings", "CELL_SIZE")


class IntensityImage(Algorithm):
    ID, TITLE, GROUP = "intensityimage", "Intensity image", "Markings"
    RETIRED = ("POWER", "BETA", "RADIUS_CELLS")

    def declare(self):
        self.add_input("cloud", "ROAD_POINTS")
        self.add_settings(IMAGE_SETTINGS)
        self.add_output("raster", "INTENSITY_IMAGE")
        self.add_output("raster", "DISPLAY_IMAGE", optional=True, by_default=False)

    def work(self, call, progress):
        road_points = bright_road_points_of(call, "ROAD_POINTS", progress.part(0.0, 0.2))
        path = call.new_file("INTENSITY_IMAGE")
        core.intensity.image.make_intensity_image(road_points, call.settings(IMAGE_SETTINGS), progress.part(0.2, 0.9), path).close()
        if call.wants("DISPLAY_IMAGE"):
            core.io.geotiff.write_display_image(path, call.new_file("DISPLAY_IMAGE"), progress.part(0.9, 1.0))


MARKING_METHOD = ParameterSpec("choice", "METHOD", default="multi-threshold", choices=("multi-threshold", "intensity-peaks", "point-segments"))

MARKING_SETTINGS = settings_of("core.markings.paint.settings:MarkingSettings", "SEPARATION*")


def marking_settings(call):
    """MarkingSettings with the method that the user chose."""
    return call.settings(MARKING_SETTINGS, method=products.published_markings.METHODS[call.value("METHOD")])


class ExtractMarkings(Algorithm):
    ID, TITLE, GROUP = "extractmarkings", "Extract markings", "Markings"
    RETIRED = ("SHORTEST_PAINT", "CLOSE", "PROFILE_LENGTH", "PROMINENCE", "NARROWEST", "WIDEST", "JUMP", "PEAK_GAP", "SHORTEST_LINE",
               "SEGMENT_LENGTH", "SEGMENT_WIDTH", "SEGMENT_SEPARATION", "NEIGHBOUR_RADIUS")

    def declare(self):
        self.add_input("cloud", "ROAD_POINTS")
        self.add_input("raster", "INTENSITY_IMAGE")
        self.add_trajectory()
        self.add(MARKING_METHOD)
        self.add_settings(MARKING_SETTINGS)
        self.add_output("cloud", "MARKING_POINTS")
        self.add_output("raster", "MARKING_MASK", optional=True, by_default=False)

    def work(self, call, progress):
        road_points = bright_road_points_of(call, "ROAD_POINTS", progress.part(0.0, 0.2))
        frame = frame_of(call, road_points.crs, progress, road_points)
        image = core.io.geotiff.IntensityImage.open(call.raster("INTENSITY_IMAGE"))
        core.intensity.image.check_image_shows(image, road_points)
        markings = core.markings.paint.extract.extract_markings(
            road_points, image, frame, marking_settings(call), progress.part(0.2, 0.95), mask_path=call.new_file("MARKING_MASK") or None)
        core.survey.road_points_las.write_road_points(markings, call.new_file("MARKING_POINTS"), progress.part(0.95, 1.0))


OUTLIER_SETTINGS = settings_of("core.markings.outliers:OutlierSettings", "NEIGHBOURS STD_RATIO SCOPE")


class RemoveOutliers(Algorithm):
    ID, TITLE, GROUP = "removeoutliers", "Remove outliers", "Markings"

    def declare(self):
        self.add_input("cloud", "INPUT")
        self.add_settings(OUTLIER_SETTINGS)
        self.add_output("cloud", "OUTPUT")

    def work(self, call, progress):
        points = paint_of(call, "INPUT", progress.part(0.0, 0.3))
        settings = call.settings(OUTLIER_SETTINGS)
        kept = core.markings.outliers.remove_outliers(points, settings, progress.part(0.3, 0.8)) if len(points) else points
        core.survey.road_points_las.write_road_points(kept, call.new_file("OUTPUT"), progress.part(0.8, 1.0))


CLUSTER_SETTINGS = settings_of("core.markings.objects.cluster:ClusterSettings", "DISTANCE")


class ClusterMarkings(Algorithm):
    ID, TITLE, GROUP = "clustermarkings", "Cluster markings", "Markings"
    RETIRED = ("MIN_POINTS",)

    def declare(self):
        self.add_input("cloud", "MARKING_POINTS")
        self.add_trajectory()
        self.add_settings(CLUSTER_SETTINGS)
        self.add_map_sink("MARKINGS")
        self.add_output("cloud", "CLUSTERED_POINTS")

    def work(self, call, progress):
        points = paint_of(call, "MARKING_POINTS", progress.part(0.0, 0.2))
        frame = frame_of(call, points.crs, progress, points)
        markings, clustered = core.markings.objects.cluster.cluster_markings(points, frame, call.settings(CLUSTER_SETTINGS), progress.part(0.2, 0.9))
        core.survey.road_points_las.write_road_points(clustered, call.new_file("CLUSTERED_POINTS"), progress.part(0.9, 1.0))
        call.layer("MARKINGS", markings.to_features(frame))


LINE_SETTINGS = settings_of("core.markings.lines.fit:MarkingLineSettings", "COUNTRY* CURVE DEGREE", COUNTRY=dict(words=tuple(COUNTRIES)),
    CURVE=dict(words=("automatic", "line", "circle", "ellipse", "clothoid", "polynomial", "b-spline")))


class FitMarkingLines(Algorithm):
    ID, TITLE, GROUP = "fitmarkinglines", "Fit marking lines", "Markings"
    RETIRED = ("LINK_GAP", "LINK_BRIDGE", "MIN_PAINT")

    def declare(self):
        self.add_input("cloud", "CLUSTERED_POINTS")
        self.add_map_layer("MARKINGS")
        self.add_trajectory()
        self.add_map_layer("ROAD_EDGES", optional=True)
        self.add_input("cloud", "ROAD_POINTS", optional=True)
        self.add_settings(LINE_SETTINGS)
        self.add_map_sink("MARKING_LINES")
        self.add_sink("NAMED_MARKINGS", fields=MARKINGS, geometry="PolygonZ", optional=True, by_default=False, look="MARKINGS")

    def work(self, call, progress):
        layer = call.map_layer("MARKINGS")
        points = paint_of(call, "CLUSTERED_POINTS", progress.part(0.0, 0.2))
        frame = frame_of(call, points.crs, progress, points, {"MARKINGS": layer})
        markings = core.markings.objects.marking_objects.MarkingObjects.from_features(layer, frame)
        edges = call.map_layer("ROAD_EDGES")
        check_layers_on_roads(call, {"ROAD_EDGES": edges}, frame, progress)
        road_points = road_points_of(call, "ROAD_POINTS", progress.part(0.2, 0.3)) if call.cloud("ROAD_POINTS") else None
        lines = core.markings.lines.fit.fit_marking_lines(points, markings, frame, call.settings(LINE_SETTINGS), progress.part(0.3, 1.0),
                                  edges=edges_of(edges, frame), road_points=road_points)
        call.layer("MARKING_LINES", lines.to_features(frame))
        if call.wants("NAMED_MARKINGS"):
            kinds = core.markings.lines.fit.named_by_lines(markings, lines)
            call.layer("NAMED_MARKINGS", core.markings.objects.marking_objects.with_kinds_of(layer, kinds, frame))


COLOUR_SETTINGS = settings_of("products.cloud.colours:ColourSettings", "AROUND*")


class ColoursOfPaint(Algorithm):
    ID, TITLE, GROUP = "paintcolours", "Colours of paint", "Markings"
    NUMBERS = "WHITE YELLOW OPEN".split()

    def declare(self):
        self.add_map_layer("MARKINGS")
        self.add_map_layer("MARKING_LINES", optional=True)
        self.add_input("clouds", "POINT_CLOUDS", optional=True)
        self.add_input("raster", "IMAGE", optional=True)
        self.add_settings(COLOUR_SETTINGS)
        self.add_sink("COLOURED_MARKINGS", fields=[*MARKINGS, COLOUR], geometry="PolygonZ", look="MARKINGS")
        self.add_sink("COLOURED_LINES", fields=[*MARKING_LINES, COLOUR], geometry="LineStringZ", optional=True, look="MARKING_LINES")

    def work(self, call, progress):
        markings, lines = (_drawn(call.map_layer(name)) for name in ("MARKINGS", "MARKING_LINES"))
        if not len(markings):
            raise RoadExtractionError(tr("{label} holds no features, so there is no paint to look at. Choose the layer of a road map.",
                                         label=call.label("MARKINGS")))
        image = call.raster_in("IMAGE", markings.crs)
        if not image and not call.given("POINT_CLOUDS"):
            raise RoadExtractionError(tr("Nothing shows the colours of the paint. Give point clouds with colours, or an orthoimage."))
        seen = products.cloud.colours.PaintColours(markings, call.settings(COLOUR_SETTINGS))
        if call.given("POINT_CLOUDS"):
            files = core.survey.las.reader.read_headers(call.point_clouds(), progress.warn)
            for file in files:
                core.io.crs.check_same_crs(markings.crs, file.crs, seen.origin, call.label("MARKINGS"))
            products.cloud.colours.add_points(seen, files, progress.part(0.0, 0.5 if image else 0.95))
        if image:
            products.cloud.colours.add_pixels(seen, image, markings, progress.part(0.5 if call.given("POINT_CLOUDS") else 0.0, 0.95))
        colours = seen.colours()
        if not seen.seen.any():
            progress.warn(tr("No coloured point or pixel lies in a marking, so all colours stay open. Check that both show the same road."))
        call.layer("COLOURED_MARKINGS", _with_colours(markings, colours))
        if lines is not None:
            call.layer("COLOURED_LINES", _with_colours(lines, products.cloud.colours.colours_of_lines(lines, markings, colours)))
        counts = {"WHITE": int((colours == products.cloud.colours.WHITE).sum()), "YELLOW": int((colours == products.cloud.colours.YELLOW).sum())}
        return {**counts, "OPEN": len(markings) - sum(counts.values())}


def _drawn(layer):
    """The features of a layer that have a geometry; None for None."""
    if layer is None:
        return None
    kept = [k for k, shape in enumerate(layer.geometries) if shape is not None and not shape.is_empty]
    return replace(layer, geometries=[layer.geometries[k] for k in kept], rows=[layer.rows[k] for k in kept])


def _with_colours(layer, colours):
    rows = [{**row, COLOUR.name: colour} for row, colour in zip(layer.rows, colours.tolist())]
    return replace(layer, schema=[*layer.schema, COLOUR], rows=rows)
