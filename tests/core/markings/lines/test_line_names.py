"""Markings have the names of the lines they make."""

import numpy as np
import shapely
from lanewright.core.common.features import MARKING_LINES, MARKINGS, Features
from lanewright.core.markings.lines.fit import named_by_lines
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.markings.objects.marking_objects import MarkingObjects
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.trajectory.trajectory import Trajectory

EAST = np.arange(-5.0, 30.0, 0.1)
FRAME = build_frame(Trajectory(0.01 * np.arange(len(EAST)), EAST, np.full(len(EAST), -2.0), np.full(len(EAST), 2.0)))


def street(*lines):
    """Three dashes on y = 0, an arrow's shaft beside them, an edge line on y = 4, and marking lines (y, kind) along them."""
    markings, found = Features("PolygonZ", MARKINGS), Features("LineStringZ", MARKING_LINES)
    for x in (0, 9, 18):
        markings.add(shapely.force_3d(shapely.box(x, -0.07, x + 3, 0.07)), road=0, use="keep", **{"class": "lane"})
    markings.add(shapely.force_3d(shapely.box(4, -0.07, 7, 0.07)), road=0, use="other", **{"class": "arrow"})
    markings.add(shapely.force_3d(shapely.box(0, 3.93, 21, 4.07)), road=0, use="keep", **{"class": "edge"})
    for y, kind in lines:
        found.add(shapely.LineString([(0, y, 0), (21, y, 0)]), road=0, kind=kind)
    return markings, found


def test_the_dashes_of_a_centre_line_are_centre_line_and_nothing_else_changes_its_name():
    markings, lines = street((0.0, "centre"), (4.0, "edge"))
    objects = MarkingObjects.from_features(markings, FRAME)
    assert named_by_lines(objects, PaintedLines.from_features(lines, FRAME)).kind.tolist() == ["centre"] * 3 + ["arrow", "edge"]
    assert objects.kind.tolist() == ["lane"] * 3 + ["arrow", "edge"]


def test_a_line_beside_a_marking_does_not_name_it():
    markings, lines = street((0.4, "centre"))
    objects = MarkingObjects.from_features(markings, FRAME)
    for some in (lines, Features("LineStringZ", MARKING_LINES)):
        assert named_by_lines(objects, PaintedLines.from_features(some, FRAME)).kind.tolist() == objects.kind.tolist()
