"""Where to drive: driving lines with their curve elements, and the whole chain in one call."""

from __future__ import annotations

from collections.abc import Iterable
from importlib.util import find_spec
from typing import TYPE_CHECKING

from ..core.common.errors import RoadExtractionError
from ..core.common.features import Features
from .algorithm import MAP_LAYERS, Algorithm, settings_of
from .markings import CLUSTER_SETTINGS, IMAGE_SETTINGS, INTENSITY_SETTINGS, LINE_SETTINGS, MARKING_METHOD, OUTLIER_SETTINGS, marking_settings
from .road import CURB_SETTINGS, EDGE_SETTINGS, METHOD_SETTING, SCANLINE_METHOD_SETTINGS, SURFACE_SETTINGS, edges_of
from .rooms import core, products
from .survey_input import SURVEY_SETTINGS, add_execution, corrections_of, estimated_trajectory, execution_of, frame_of, road_points_of, survey_inputs
from .texts import tr

if TYPE_CHECKING:
    from ..core.corrections.corrections import Corrections

DRIVING_SETTINGS = settings_of("core.driving.settings:DrivingSettings", "COUNTRY* LANE_WIDTH LINE_DISTANCE* TRAFFIC_SIDE")


class DrivingLines(Algorithm):
    ID, TITLE, GROUP = "drivinglines", "Driving lines", "Driving"
    RETIRED = ("MAX_BRIDGE", "MAX_INFERRED", "SHORTEST")

    def declare(self):
        self.add_map_layer("MARKING_LINES")
        self.add_trajectory()
        self.add_map_layer("MARKINGS", optional=True)
        self.add_map_layer("ROAD_EDGES", optional=True)
        self.add_input("cloud", "ROAD_POINTS", optional=True)
        self.add_settings(DRIVING_SETTINGS)
        self.add_map_sink("DRIVING_LINES")
        self.add_map_sink("LANES", optional=True)
        self.add_map_sink("CURVE_ELEMENTS", optional=True)

    def work(self, call, progress):
        layers = {name: call.map_layer(name) for name in ("MARKING_LINES", "MARKINGS", "ROAD_EDGES")}
        marking_lines, markings, edges = layers.values()
        road_points = road_points_of(call, "ROAD_POINTS", progress.part(0.0, 0.3)) if call.cloud("ROAD_POINTS") else None
        frame = frame_of(call, marking_lines.crs, progress, road_points, layers)
        lines, elements, lanes = core.driving.driving_lines.make_driving_lines(
            core.markings.lines.painted_lines.PaintedLines.from_features(marking_lines, frame), frame, call.settings(DRIVING_SETTINGS),
            progress.part(0.3, 1.0), edges=edges_of(edges, frame), road_points=road_points,
            markings=None if markings is None else core.markings.objects.marking_objects.MarkingObjects.from_features(markings, frame))
        call.layer("DRIVING_LINES", lines.to_features(frame))
        call.layer("LANES", lanes.to_features(frame))
        call.layer("CURVE_ELEMENTS", elements.to_features(frame))


# The road map in numbers, for batches and models: how much there is, and how much of it was measured.

MEASURED = "measured"

NUMBERS = ("ROADS ROAD_LENGTH EDGE_LENGTH EDGES_MEASURED LINE_LENGTH LINES_MEASURED LANE_COUNT LANE_LENGTH LANES_MEASURED MARKING_COUNT "
           "TRUST CORRECTIONS_MADE CORRECTIONS_UNMATCHED").split()


def road_map_numbers(road_lengths: Iterable[float], edges: Features | None, marking_lines: Features | None, driving_lines: Features | None,
                     markings: Features | None, corrections: Corrections | None = None) -> dict[str, float]:
    """The values of NUMBERS to three decimals; a share or mean of nothing is left out.

    road_lengths : m of each road
    edges, marking_lines, driving_lines, markings : layers of the road map, None where there are none
    corrections : of an analyst, and which of them were made; None for none
    """
    lengths = list(road_lengths)
    numbers: dict[str, float | None] = {"ROADS": float(len(lengths)), "ROAD_LENGTH": float(sum(lengths))}
    for layer, length, share in ((edges, "EDGE_LENGTH", "EDGES_MEASURED"), (marking_lines, "LINE_LENGTH", "LINES_MEASURED"),
                                 (driving_lines, "LANE_LENGTH", "LANES_MEASURED")):
        numbers[length], numbers[share] = _along(layer, lambda row: 100.0 * (row.get("status") == MEASURED))
    lanes = [] if driving_lines is None else driving_lines.rows
    numbers["LANE_COUNT"] = float(len({(row.get("road"), row.get("lane")) for row in lanes}))
    numbers["MARKING_COUNT"] = float(0 if markings is None else len(markings))
    _, numbers["TRUST"] = _along(driving_lines, lambda row: row.get("confidence"))
    unmatched = 0 if corrections is None else len({correction.row for correction in corrections.unmatched})
    made = 0 if corrections is None else len({correction.row for correction in corrections.rows}) - unmatched
    numbers["CORRECTIONS_MADE"], numbers["CORRECTIONS_UNMATCHED"] = float(made), float(unmatched)
    return {name: round(value, 3) for name, value in numbers.items() if value is not None}


def _along(layer, value_of):
    """(m of all lines of a layer, mean of a value of their rows by length), the mean None where no row has one."""
    pieces = [] if layer is None else [(geometry.length, value_of(row)) for geometry, row in layer]
    rated = [(length, value) for length, value in pieces if value is not None]
    total = sum(length for length, _ in rated)
    return float(sum(length for length, _ in pieces)), sum(length * value for length, value in rated) / total if total else None


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

# Layer of the road map -> where RoadMap holds it
LAYERS = {"ROAD_EDGES": "edges", "ROAD_SURFACE": "surface", "MARKINGS": "markings", "MARKING_LINES": "marking_lines",
          "DRIVING_LINES": "driving_lines", "LANES": "lanes", "CURVE_ELEMENTS": "curve_elements"}

ESTIMATED = 0.2   # of the work, where the trajectory is estimated first


class RoadMap(Algorithm):
    ID, TITLE, GROUP = "roadmap", "Road map", "Road map"
    WHOLE_MAP = True
    NUMBERS = NUMBERS
    RETIRED = ("INTERVAL", "SCANLINE_MIN_HEIGHT", "LINE_DISTANCE")

    def declare(self):
        # the dialog shows clouds, trajectory and where to save; all else is folded away, in the order of the stages
        self.add_survey(trajectory_optional=True)
        self.add_settings(METHOD_SETTING, advanced=True)
        for stage, specs in STAGES.items():
            if stage == "intensity":
                self.add_input("flag", "CORRECT_INTENSITY", default=True, advanced=True)
            self.add_settings(specs, only=OFFERED, advanced=True)
            if stage == "image":
                self.add_settings((MARKING_METHOD,), advanced=True)
        self.add_settings(SURVEY_SETTINGS)
        self.add_input("layer", "CORRECTIONS", optional=True, advanced=True)
        add_execution(self)
        for name in LAYERS:
            self.add_map_sink(name, optional=True)
        self.add_map_sink("PASSES", optional=True)
        self.add_map_sink("CURB_POINTS", optional=True, by_default=False)
        self.add_output("cloud", "ROAD_POINTS", optional=True, by_default=False)
        self.add_output("raster", "INTENSITY_IMAGE", optional=True)
        self.add_report()

    def work(self, call, progress):
        settings = core.pipeline.road_map.RoadMapSettings(
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
        # GDAL writes the image; a report without one has its map on plain ground
        image_path = call.new_file("INTENSITY_IMAGE")
        if not image_path and call.wants("REPORT") and find_spec("osgeo") is not None:
            image_path = call.scratch_file("intensity.tif")
        road_map = core.pipeline.road_map.make_road_map(paths, trajectory, image_path, settings, progress.part(0.0, 0.95), corrections)
        call.at_end(road_map.free)
        if estimated:
            road_map.survey_facts["trajectory"] = estimated.summary()
        if call.wants("ROAD_POINTS"):
            core.survey.road_points_las.write_road_points(road_map.road_points, call.new_file("ROAD_POINTS"), progress.part(0.95, 1.0))
        if road_map.markings is None:
            call.drop_file("INTENSITY_IMAGE")
        layers = {}
        for name, attribute in LAYERS.items():
            layer = layers[attribute] = road_map.layer(attribute)
            call.layer(name, layer if layer is not None else Features(MAP_LAYERS[name].geometry, MAP_LAYERS[name].schema, crs=road_map.crs))
        if call.wants("PASSES"):
            call.layer("PASSES", core.survey.frame.placement.passes_to_features(road_map.frame, road_map.crs))
        if call.wants("CURB_POINTS"):
            call.layer("CURB_POINTS", road_map.layer("curb_points"))
        if call.wants("REPORT"):
            call.text("REPORT", products.report.road_map.road_map_report(road_map, image_path))
        return road_map_numbers([road.length for road in road_map.frame.roads],
                                *(layers[name] for name in ("edges", "marking_lines", "driving_lines", "markings")), road_map.corrections)
