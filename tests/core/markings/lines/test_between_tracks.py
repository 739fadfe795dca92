"""Lines far off, of which the tracks of the scan show a piece each: they go on where they lie between two tracks."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.features import MARKING_LINES, MARKINGS, Features
from lanewright.core.markings.lines.linking import with_paint_between_tracks, with_unseen_paint
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.markings.objects.marking_objects import MarkingObjects, with_kinds_of
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.records import ROAD_POINT, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.trajectory.trajectory import Trajectory

EAST = np.arange(-5.0, 50.0, 0.1)
FRAME = build_frame(Trajectory(0.01 * np.arange(len(EAST)), EAST, np.zeros(len(EAST)), np.full(len(EAST), 2.0)))
LINE, WIDTH, ASPHALT, PAINT = 9.0, 0.15, 5000, 30000   # m north of the drive, m, brightness


def street(spacing=0.30, slope=0.012, phase=-0.05, painted=lambda x: x > -1, shadow=(0.0, 0.0), pattern="solid"):
    """Markings and marking line of an edge line along 40 m of road, with a gap from 10 to 25 m, the paint of them and all points.

    Tracks of the scan lie `spacing` apart and cross the line slowly, one of them `phase` beside its middle at the beginning.
    painted : of station, where there is paint; shadow : stations between which nothing was scanned
    """
    x, y = [], []
    for start in LINE + phase + spacing * np.arange(-6, 5):
        along = np.arange(0.0, 40.0, 0.09)
        along = along[(along < shadow[0]) | (along > shadow[1])]
        x, y = np.append(x, along), np.append(y, start + slope * along)
    on = (np.abs(y - LINE) < WIDTH / 2) & painted(x)
    markings, lines = Features("PolygonZ", MARKINGS), Features("LineStringZ", MARKING_LINES)
    for number, (first, last, status) in enumerate(((0.0, 10.0, "measured"), (10.0, 25.0, "bridged"), (25.0, 40.0, "measured")), 1):
        lines.add(shapely.LineString([(first, LINE, 0), (last, LINE, 0)]), road=0, line=1, kind="edge", pattern=pattern, status=status)
        if status == "measured":
            outline = shapely.box(first, LINE - WIDTH / 2, last, LINE + WIDTH / 2)
            markings.add(shapely.force_3d(outline), road=0, use="keep", cluster=number, station_m=first + 5.0, offset_m=LINE, width_m=WIDTH,
                         length_m=last - first, points=100, **{"class": "lane"})
    records = np.zeros(len(x), ROAD_POINT)
    s, d = FRAME.roads[0].locate(*FRAME.to_local(x, y))
    records["s"], records["d"], records["intensity"], records["corrected"] = to_units(s), to_units(d), np.where(on, PAINT, ASPHALT), np.nan
    records["spacing"], records["cluster"] = int(spacing * 1e3), on & ((x < 10.0) | (x > 25.0))
    paint, points = (RoadPoints.empty_like(origin=FRAME.origin) for _ in range(2))
    paint.store.append(0, records[records["cluster"] > 0])
    points.store.append(0, records)
    paint.has_cluster = paint.has_spacing = True
    return MarkingObjects.from_features(markings, FRAME), PaintedLines.from_features(lines, FRAME), paint, points


def completed(markings, lines, paint, points):
    return with_paint_between_tracks(markings, with_unseen_paint(lines, markings, paint, points))


def drawn_in_gap(markings):
    """Metres of the gap that are drawn."""
    polygons = shapely.union_all(markings.outlines.polygons(FRAME.origin))
    return polygons.intersection(shapely.box(10.0, LINE - 1.0, 25.0, LINE + 1.0)).area / WIDTH


def test_a_line_that_lies_between_two_tracks_for_a_while_goes_on_there():
    markings, *rest = street()
    found = completed(markings, *rest)
    assert drawn_in_gap(markings) == 0.0
    assert drawn_in_gap(found) == pytest.approx(15.0, abs=0.5)
    more = found[len(markings):]
    assert set(more.kind) == {"lane"} and set(more.cluster) <= {1, 3} and (more.points == 0).all() and more.width == pytest.approx(WIDTH)
    true = shapely.box(0.0, LINE - WIDTH / 2, 40.0, LINE + WIDTH / 2).buffer(0.01)
    assert all(true.contains(polygon) for polygon in more.outlines.polygons(FRAME.origin))


def test_where_a_track_on_its_course_is_asphalt_the_line_is_not_drawn():
    """The tracks run along the line, so one is on it over the whole gap."""
    assert drawn_in_gap(completed(*street(slope=0.003, painted=lambda x: (x < 10.0) | (x > 25.0)))) == 0.0


def test_a_worn_spot_stays_open_and_the_line_goes_on_behind_it():
    found = completed(*street(phase=-0.12, painted=lambda x: (x < 10.0) | (x > 12.0)))
    gap = shapely.box(10.1, LINE - 0.05, 11.7, LINE + 0.05)
    assert not any(gap.intersects(polygon) for polygon in found.outlines.polygons(FRAME.origin))
    assert drawn_in_gap(found) > 10.0


def test_nothing_is_drawn_in_the_shadow_of_a_parked_car():
    found = completed(*street(shadow=(13.0, 18.0)))
    assert drawn_in_gap(found) == pytest.approx(10.0, abs=1.0)
    car = shapely.box(13.5, LINE - 1.0, 17.5, LINE + 1.0)
    assert not any(car.intersects(polygon) for polygon in found.outlines.polygons(FRAME.origin))


def test_tracks_that_lie_closer_than_a_line_is_broad_leave_no_room_for_one():
    markings, *rest = street(spacing=0.06, painted=lambda x: (x < 10.0) | (x > 25.0))
    assert completed(markings, *rest) is markings


def test_tracks_too_far_apart_to_be_neighbours_tell_nothing():
    assert drawn_in_gap(completed(*street(spacing=0.70))) < 8.0


def test_a_dashed_line_keeps_its_gaps():
    markings, *rest = street(pattern="dashed")
    assert completed(markings, *rest) is markings


def test_lines_that_were_drawn_by_hand_add_no_paint():
    markings, lines, *_ = street()
    assert with_paint_between_tracks(markings, lines) is markings


def test_stage_by_stage_the_layer_gets_the_same_paint_as_in_one_call():
    markings, *rest = street()
    found = completed(markings, *rest)
    read, whole = markings.to_features(FRAME), found.to_features(FRAME)
    layer = with_kinds_of(read, found, FRAME)
    assert len(layer.rows) > len(read.rows) and layer.rows == whole.rows
    assert all(shapely.equals_identical(a, b) for a, b in zip(layer.geometries, whole.geometries, strict=True))
