"""The whole chain in one call."""

from ...core.common.errors import RoadExtractionError
from ...core.common.features import (
    CURB_POINTS,
    CURVE_ELEMENTS,
    DRIVING_LINES,
    LANES,
    MARKING_LINES,
    MARKINGS,
    PASSES,
    ROAD_EDGES,
    ROAD_SURFACE,
    Features,
)
from ..algorithm import Algorithm
from ..corrections import add_corrections, corrections_of
from ..markings.cluster_markings import CLUSTER_SETTINGS
from ..markings.correct_intensity import INTENSITY_SETTINGS
from ..markings.extract_markings import METHOD as MARKING_METHOD
from ..markings.extract_markings import marking_settings
from ..markings.fit_marking_lines import LINE_SETTINGS
from ..markings.intensity_image import IMAGE_SETTINGS
from ..markings.remove_outliers import OUTLIER_SETTINGS
from ..road.detect_boundaries import METHOD_SETTING, SCANLINE_METHOD_SETTINGS
from ..road.detect_curbs import CURB_SETTINGS
from ..road.extract_road_surface import SURFACE_SETTINGS
from ..road.fit_road_edges import EDGE_SETTINGS
from ..survey_input import SURVEY_SETTINGS, WITHOUT_TRAJECTORY, add_execution, estimated_trajectory, execution_of, survey_inputs
from ..texts import tr
from .driving_lines import DRIVING_SETTINGS
from .road_map_numbers import NUMBERS, road_map_numbers

# Field of RoadMapSettings -> its settings
STAGES = {
    "curbs": CURB_SETTINGS,
    "scanlines": SCANLINE_METHOD_SETTINGS,
    "edges": EDGE_SETTINGS,
    "surface": SURFACE_SETTINGS,
    "intensity": INTENSITY_SETTINGS,
    "image": IMAGE_SETTINGS,
    "outliers": OUTLIER_SETTINGS,
    "clusters": CLUSTER_SETTINGS,
    "lines": LINE_SETTINGS,
    "driving": DRIVING_SETTINGS,
}

# Settings of the stages that one turns now and then; the rest is left to the single algorithms
OFFERED = ("BLOCK_LENGTH", "MIN_HEIGHT", "MAX_HEIGHT", "SLOPE", "MAX_GAP", "FALLBACK_WIDTH", "MAX_WIDTH", "CELL_SIZE", "CURVE", "DEGREE",
           "COUNTRY", "LANE_WIDTH", "TRAFFIC_SIDE")

LAYERS = (
    ("ROAD_EDGES", "edges", "LineStringZ", ROAD_EDGES, tr("Road edges")),
    ("ROAD_SURFACE", "surface", "PolygonZ", ROAD_SURFACE, tr("Road surface")),
    ("MARKINGS", "markings", "PolygonZ", MARKINGS, tr("Markings")),
    ("MARKING_LINES", "marking_lines", "LineStringZ", MARKING_LINES, tr("Marking lines")),
    ("DRIVING_LINES", "driving_lines", "LineStringZ", DRIVING_LINES, tr("Driving lines")),
    ("LANES", "lanes", "PolygonZ", LANES, tr("Lanes")),
    ("CURVE_ELEMENTS", "curve_elements", "None", CURVE_ELEMENTS, tr("Curve elements")),
)


ESTIMATED = 0.2   # of the work, where the trajectory is estimated first


class RoadMap(Algorithm):
    ID, TITLE, GROUP = "roadmap", "Road map", "Road map"
    SUMMARY = "From a survey to driving lines in one call: edges, surface, intensity image, markings, lines and curve elements."
    HELP = ("Point clouds, the trajectory, and where to save are enough: everything else has a default that suits most surveys. "
            "The stages are those of the single algorithms, handed on in memory. Every output is optional.")
    TAGS = ("hd map", "lane", "driving line", "road marking", "curb", "kerb")
    WHOLE_MAP = True
    NEEDS_GDAL = True  # the stages hand the intensity image on as a GeoTIFF
    NUMBERS = NUMBERS
    RETIRED = ("INTERVAL", "SCANLINE_MIN_HEIGHT", "LINE_DISTANCE")

    def declare(self):
        # the dialog shows clouds, trajectory and where to save; all else is folded away, in the order of the stages
        self.add_survey(trajectory_optional=True, without=WITHOUT_TRAJECTORY)
        self.add_settings((METHOD_SETTING,), advanced=True)
        for stage, specs in STAGES.items():
            if stage == "intensity":
                self.add_input("flag", "CORRECT_INTENSITY", tr("Correct intensity first"),
                               tr("Evens out range, incidence and the difference between scanners. Switch it off for clouds whose intensity was "
                                  "corrected already."), default=True, advanced=True)
            self.add_settings(specs, only=OFFERED, advanced=True)
            if stage == "image":
                self.add_settings((MARKING_METHOD,), advanced=True)
        self.add_settings(SURVEY_SETTINGS)
        add_corrections(self)
        add_execution(self)
        for name, _, geometry, fields, label in LAYERS:
            self.add_sink(name, label, fields=fields, geometry=geometry, optional=True)
        self.add_sink("PASSES", tr("Passes (the trajectory)"), tr("Where the vehicle drove, as this run used it: one line a pass."), fields=PASSES,
                      geometry="LineStringZ", optional=True)
        self.add_sink("CURB_POINTS", tr("Curb points"), fields=CURB_POINTS, geometry="PointZ", optional=True, by_default=False)
        self.add_output("cloud", "ROAD_POINTS", tr("Road points"), tr("Class 11, with the fields the single stages need."), optional=True,
                        by_default=False)
        self.add_output("raster", "INTENSITY_IMAGE", tr("Intensity image"), optional=True)
        self.add_report()

    def work(self, call, progress):
        from ...core.pipeline.road_map import RoadMapSettings, make_road_map
        from ...core.survey.road_points_las import write_road_points

        settings = RoadMapSettings(
            correct=call.value("CORRECT_INTENSITY"),
            boundary_method=call.value("BOUNDARY_METHOD"),
            survey=call.settings(SURVEY_SETTINGS, crs=call.crs()),
            execution=execution_of(call),
            markings=marking_settings(call),
            **{field: call.settings(specs) for field, specs in STAGES.items()})
        if not any(call.wants(output.name) for output in self.outputs()):
            raise RoadExtractionError(tr(
                "No result was asked for, and all of the work would be lost. Name at least one output, such as DRIVING_LINES, MARKINGS or REPORT."))
        corrections = corrections_of(call)
        estimated = estimated_trajectory(call, progress.part(0.0, ESTIMATED))
        paths, trajectory = (call.point_clouds(), estimated.trajectory) if estimated else survey_inputs(call)
        progress = progress.part(ESTIMATED if estimated else 0.0, 1.0)
        image_path = call.new_file("INTENSITY_IMAGE") or call.scratch_file("intensity.tif")
        road_map = make_road_map(paths, trajectory, image_path, settings, progress.part(0.0, 0.95), corrections)
        call.at_end(road_map.free)
        if estimated:
            road_map.survey_facts["trajectory"] = estimated.summary()
        if call.wants("ROAD_POINTS"):
            write_road_points(road_map.road_points, call.new_file("ROAD_POINTS"), progress.part(0.95, 1.0))
        if road_map.image is None:
            call.drop_file("INTENSITY_IMAGE")
        layers = {}
        for name, attribute, geometry, fields, _ in LAYERS:
            layer = layers[attribute] = road_map.layer(attribute)
            call.layer(name, layer if layer is not None else Features(geometry, fields, crs=road_map.crs))
        if call.wants("PASSES"):
            from ...core.survey.frame.placement import passes_to_features

            call.layer("PASSES", passes_to_features(road_map.frame, road_map.crs))
        call.layer("CURB_POINTS", road_map.layer("curb_points"))
        if call.wants("REPORT"):
            from ...products.report.road_map import road_map_report

            call.text("REPORT", road_map_report(road_map, image_path))
        return road_map_numbers([road.length for road in road_map.frame.roads],
                                *(layers[name] for name in ("edges", "marking_lines", "driving_lines", "markings")), road_map.corrections)
