"""Outlines of roads that share ground: each place is drawn once."""

import numpy as np
import pytest
import shapely
from drives import drive, joined, straight
from lanewright.core.road.surface.road_surface import without_overlaps
from lanewright.core.survey.frame.road_frame import build_frame
from measured_streets import HALF, crossing_roads
from road_layers import extract_road_surface

APART, LENGTH = 20.0, 100.0   # m between two tracks, and of each


@pytest.mark.parametrize("up", [0.0, 6.0])
def test_where_two_roads_cross_on_one_level_the_ground_is_drawn_once_and_under_a_bridge_twice(up):
    _, surface = extract_road_surface(*crossing_roads(up))
    drawn, covered = sum(row["area_m2"] for row in surface.rows), shapely.union_all(shapely.force_2d(surface.geometries)).area
    assert shapely.is_valid(surface.geometries).all()
    assert drawn - covered == pytest.approx((2 * HALF) ** 2 if up else 0.0, abs=0.5)
    assert covered == pytest.approx(2 * HALF * (120.0 - 2 * HALF), rel=0.02)


def rectangle(road, first, last, right, left, status="measured", rise=0.1):
    """A stretch of 1 point per m², 1 m of it a vertex, that climbs by `rise` m per m; first, last: m along; right, left: m to the north."""
    x = np.arange(first, last + 0.5)
    places = np.concatenate([np.c_[x, right + 0 * x, rise * x], np.c_[x, left + 0 * x, rise * x][::-1]])
    area = (last - first) * (left - right)
    return road, status, first, last, area, round(area), shapely.Polygon(places)


def roads_beside(*stretches):
    """{(road, status): shapely geometry} of what two roads side by side keep, the second driven 20 m north of the first, and the rows."""
    frame = build_frame(joined(drive(straight(LENGTH)), drive(straight(LENGTH, (0.0, APART)), start=2000.0)))
    origin = [500_000.0, 5_400_000.0] - frame.origin[:2]
    rows = [(*row, shapely.transform(outline, lambda xyz: xyz + [*origin, 0.0], include_z=True)) for *row, outline in stretches]
    kept = without_overlaps(frame, rows)
    back = [shapely.transform(row[-1], lambda xyz: xyz - [*origin, 0.0], include_z=True) for row in kept]
    return {key: shapely.union_all([outline for row, outline in zip(kept, back) if row[:2] == key]) for key in {row[:2] for row in kept}}, kept


def test_what_both_roads_bound_is_of_the_one_driven_nearer_and_a_strip_along_its_rim_is_of_none():
    of, rows = roads_beside(rectangle(0, 0.0, 100.0, -4.0, 4.0), rectangle(1, 0.0, 60.0, -4.1, 3.9), rectangle(1, 60.0, 100.0, 3.0, 24.0))
    assert of[0, "measured"].area == pytest.approx(800.0)
    assert of[1, "measured"].area == pytest.approx(40.0 * 20.0, abs=1.0)
    assert [row[:4] for row in rows] == [(0, "measured", 0.0, 100.0), (1, "measured", 60.0, 100.0)]


def test_of_a_stretch_that_lies_wholly_in_that_of_another_road_nothing_is_left():
    _, rows = roads_beside(rectangle(0, 0.0, 100.0, -4.0, 4.0), rectangle(1, 20.0, 60.0, -3.0, 3.0))
    assert [row[:4] for row in rows] == [(0, "measured", 0.0, 100.0)]


@pytest.mark.parametrize("order", [1, -1])
def test_ground_that_one_road_only_grew_into_is_of_the_road_with_edges_there(order):
    grown, bounded = rectangle(0, 0.0, 100.0, -4.0, 24.0, "grown"), rectangle(1, 40.0, 60.0, -1.0, 24.0)
    of, rows = roads_beside(*(grown, bounded)[::order])
    assert of[1, "measured"].area == pytest.approx(20.0 * 25.0)
    assert of[0, "grown"].area == pytest.approx(2800.0 - 500.0)
    assert sum(row[5] for row in rows if row[0] == 0) == pytest.approx(2300, abs=2)
    x, _, z = shapely.get_coordinates(of[0, "grown"], include_z=True).T
    np.testing.assert_allclose(z, 0.1 * x, atol=0.01)


def test_a_rim_that_turns_back_on_itself_is_no_surface():
    """A spike of no width, as rounding leaves it where an arm leaves a ring, stays a line where a part of the outline is of another road."""
    outline = [(0.0, -4.0), (60.0, -4.0), (60.0, 0.0), (70.0, 0.0), (60.0, 0.0), (60.0, 24.0), (0.0, 24.0)]
    grown, bounded = shapely.Polygon([(x, y, 0.0) for x, y in outline]), rectangle(1, 0.0, 20.0, 4.0, 24.0, rise=0.0)
    assert shapely.difference(grown, bounded[-1]).geom_type == "GeometryCollection"
    of, _ = roads_beside((0, "grown", 0.0, 100.0, grown.area, 1680, grown), bounded)
    assert of[0, "grown"].area == pytest.approx(60.0 * 28.0 - 20.0 * 20.0, abs=0.1)
