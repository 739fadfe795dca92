"""Where the road is: scanlines, curbs, edges, and the points and outline of the surface."""

from contextlib import nullcontext

from ..core.common.features import CURB_POINTS, ROAD_EDGES
from .algorithm import Algorithm, settings_of
from .rooms import core, products
from .survey_input import SURVEY_SETTINGS, add_execution, check_layers_on_roads, frame_of, open_survey_of

SCANLINE_SETTINGS = settings_of("core.road.scanlines.section_planes:ScanlineSettings", "INTERVAL CORRIDOR ROTATION_FREQUENCY*")
LAYER_SETTINGS = settings_of("products.scanline_layer:ScanlineLayerSettings", "SIMPLIFY RESAMPLED_SPACING*", RESAMPLED_SPACING=dict(field="spacing"))


class NormalizedScanlines(Algorithm):
    ID, TITLE, GROUP = "normalizedscanlines", "Normalized scanlines", "Road"

    def declare(self):
        self.add_survey()
        self.add_settings(SCANLINE_SETTINGS)
        self.add_settings(LAYER_SETTINGS)
        self.add_settings(SURVEY_SETTINGS, only=("SCANNER_FIELD", "TIME", "INTENSITY_FROM", "FIT_PASSES", "TRAJECTORY_SIGMA"))
        add_execution(self)
        self.add_map_sink("SCANLINES", optional=True)
        self.add_output("cloud", "RESAMPLED_POINTS", optional=True, by_default=False)

    def work(self, call, progress):
        survey = open_survey_of(call, progress.part(0.0, 0.5))
        points = nullcontext()
        if call.wants("RESAMPLED_POINTS"):
            points = products.scanline_layer.ResampledPoints(
                call.new_file("RESAMPLED_POINTS"), survey.frame.origin, survey.crs, call.settings(LAYER_SETTINGS), survey.frame.farthest)
        layer = call.settings(LAYER_SETTINGS) if call.wants("SCANLINES") else None
        with points as opened:
            scanlines, _ = products.scanline_layer.write_scanlines(survey, call.settings(SCANLINE_SETTINGS), layer, opened, progress.part(0.5, 1.0))
        call.layer("SCANLINES", scanlines)


BOUNDARY_SETTINGS = settings_of("core.road.scanlines.detect:ScanlineBoundarySettings",
    "MIN_HEIGHT SEARCH_WIDTH* SENSOR_HEIGHT* CLIPPING_HEIGHT* DISTANCE_ACROSS* DISTANCE_ALONG* RANSAC_DISTANCE* VERTICAL_ANGLE* HORIZONTAL_ANGLE* "
    "MAX_GAP")


class BoundariesFromScanlines(Algorithm):
    ID, TITLE, GROUP = "boundariesfromscanlines", "Boundaries from scanlines", "Road"

    def declare(self):
        self.add_map_layer("SCANLINES")
        self.add_trajectory()
        self.add_settings(BOUNDARY_SETTINGS)
        self.add_sink("CORNERS", fields=CURB_POINTS, geometry="PointZ", optional=True, look="CURB_POINTS")
        self.add_sink("BOUNDARIES", fields=ROAD_EDGES, geometry="LineStringZ", optional=True)

    def work(self, call, progress):
        settings = call.settings(BOUNDARY_SETTINGS)
        layer = call.map_layer("SCANLINES")
        frame = frame_of(call, layer.crs, progress)
        frame.pass_sigma = core.survey.adjustment.register.sigma_of_layer(layer)
        lines, interval = products.scanline_layer.scanlines_from_features(layer, frame)
        source = core.road.scanlines.detect.LayerScanlines(lines, frame, interval, layer.crs, settings.sensor_height)
        corners = core.road.scanlines.detect.curbs_from_scanlines(source, settings, core.road.weights.SCANLINE.corner_block, progress.part(0.3, 0.95))
        lines = core.road.scanlines.detect.boundary_lines(corners, frame, settings.max_gap, progress.part(0.95, 1.0))
        call.layer("CORNERS", corners.to_features(frame))
        call.layer("BOUNDARIES", lines.to_features(frame))


CURB_SETTINGS = settings_of("core.road.profiles.detect:CurbSettings",
    "BLOCK_LENGTH PROFILE_WIDTH POINT_SPACING* LAYER_JUMP* SLOPE MIN_HEIGHT MAX_HEIGHT")


class DetectCurbs(Algorithm):
    ID, TITLE, GROUP = "detectcurbs", "Detect curbs", "Road"

    def declare(self):
        self.add_survey()
        self.add_settings(CURB_SETTINGS)
        self.add_settings(SURVEY_SETTINGS)
        self.add_map_sink("CURB_POINTS")
        self.add_sink("PRINCIPAL_POINTS", geometry="PointZ", optional=True, by_default=False)

    def work(self, call, progress):
        survey = open_survey_of(call, progress.part(0.0, 0.5))
        settings = call.settings(CURB_SETTINGS)
        if call.wants("PRINCIPAL_POINTS"):
            call.layer("PRINCIPAL_POINTS", core.road.profiles.detect.find_principal_points(survey, settings, progress.part(0.5, 0.6)))
        points = core.road.detect_boundaries.find_curb_points(
            survey, core.road.detect_boundaries.BoundarySettings("profiles", settings), progress.part(0.6, 1.0))["profiles"]
        call.layer("CURB_POINTS", points.to_features(survey.frame))


EDGE_SETTINGS = settings_of("core.road.edges.fit:EdgeSettings", "MAX_GAP FALLBACK_WIDTH*")


class FitRoadEdges(Algorithm):
    ID, TITLE, GROUP = "fitroadedges", "Fit road edges", "Road"

    def declare(self):
        self.add_map_layer("CURB_POINTS")
        self.add_trajectory()
        self.add_settings(EDGE_SETTINGS)
        self.add_map_sink("ROAD_EDGES")

    def work(self, call, progress):
        layer = call.map_layer("CURB_POINTS")
        frame = frame_of(call, layer.crs, progress, layers={"CURB_POINTS": layer})
        curbs = core.road.common.curb_points.CurbPoints.from_features(layer, frame)
        edges = core.road.edges.fit.fit_road_edges(curbs, frame, call.settings(EDGE_SETTINGS), progress)
        call.layer("ROAD_EDGES", edges.to_features(frame))


def edges_of(layer, frame):
    """The layer ROAD_EDGES as RoadEdges with vertices close together; None for None."""
    return None if layer is None else core.road.edges.road_edges.RoadEdges.from_features(layer, frame).densified(frame)


METHOD_SETTING = settings_of("core.road.detect_boundaries:BoundarySettings", "BOUNDARY_METHOD", BOUNDARY_METHOD=dict(field="method"))
# Both methods ask for one least height
SCANLINE_METHOD_SETTINGS = tuple(spec for spec in BOUNDARY_SETTINGS if spec.name == "MIN_HEIGHT")
OFFERED = ("BLOCK_LENGTH", "SLOPE", "MIN_HEIGHT", "MAX_HEIGHT")


class DetectBoundaries(Algorithm):
    ID, TITLE, GROUP = "detectboundaries", "Detect road boundaries", "Road"
    RETIRED = ("PROFILE_WIDTH", "POINT_SPACING", "LAYER_JUMP", "INTERVAL", "ROTATION_FREQUENCY", "SCANLINE_MIN_HEIGHT", "SEARCH_WIDTH",
               "SENSOR_HEIGHT", "CLIPPING_HEIGHT", "DISTANCE_ACROSS", "DISTANCE_ALONG", "RANSAC_DISTANCE", "VERTICAL_ANGLE", "HORIZONTAL_ANGLE")

    def declare(self):
        self.add_survey()
        self.add_settings(METHOD_SETTING)
        self.add_settings(CURB_SETTINGS, only=OFFERED)
        self.add_settings(EDGE_SETTINGS)
        self.add_settings(SURVEY_SETTINGS)
        add_execution(self)
        self.add_map_sink("ROAD_EDGES")

    def work(self, call, progress):
        detect = core.road.detect_boundaries
        settings = detect.BoundarySettings(call.value("BOUNDARY_METHOD"), call.settings(CURB_SETTINGS), call.settings(SCANLINE_METHOD_SETTINGS))
        survey = open_survey_of(call, progress.part(0.0, 0.5))
        ground = core.road.surface.ground_grid.MeasuredGround(survey)
        curbs = detect.find_curb_points(survey, settings, progress.part(0.5, 0.95), ground)
        boundaries = detect.draw_boundaries(curbs, survey.frame, call.settings(EDGE_SETTINGS), progress.part(0.95, 1.0), survey, ground)
        call.layer("ROAD_EDGES", boundaries.edges.to_features(survey.frame))


SURFACE_SETTINGS = settings_of("core.road.surface.extract:SurfaceSettings", "MAX_WIDTH")


class ExtractRoadSurface(Algorithm):
    ID, TITLE, GROUP = "extractroadsurface", "Extract road surface", "Road"
    RETIRED = ("HEIGHT_TOLERANCE",)

    def declare(self):
        self.add_survey()
        self.add_map_layer("ROAD_EDGES", optional=True)
        self.add_settings(SURFACE_SETTINGS)
        self.add_settings(SURVEY_SETTINGS)
        self.add_output("cloud", "ROAD_POINTS")
        self.add_map_sink("ROAD_SURFACE", optional=True)

    def work(self, call, progress):
        layer = call.map_layer("ROAD_EDGES")
        survey = open_survey_of(call, progress.part(0.0, 0.5))
        edges = None
        if layer is not None:
            check_layers_on_roads(call, {"ROAD_EDGES": layer}, survey.frame, progress)
            edges = core.road.edges.road_edges.RoadEdges.from_features(layer, survey.frame)
        road_points, surface = core.road.surface.extract.extract_road_surface(survey, edges, call.settings(SURFACE_SETTINGS), progress.part(0.5, 0.9))
        core.survey.road_points_las.write_road_points(road_points, call.new_file("ROAD_POINTS"), progress.part(0.9, 1.0))
        road_points.close()
        call.layer("ROAD_SURFACE", surface.to_features(survey.frame))
