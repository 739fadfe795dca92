"""Faint curbs that lead on from sure ones, and seams that do not, under a noisy scanner."""

import numpy as np
import pytest
import shapely
from curbed_streets import EAST, NORTH, driven, street, survey_of
from lanewright.core.road.curb_returns.extended_curbs import FollowedEnds, led_on
from lanewright.core.road.curb_returns.ground_raster import averaged, ground_raster
from road_layers import detect_curbs, fit_road_edges
from street_plans import scan, side_street

NOISE = 0.012   # m, of heights: that of a scanner of 64 beams
TIP = 10.0      # x at which the sure curb ends, 1 m before its corner begins


def led(height, beside=0.0, turned=0.0, gutter=0.0):
    """What continues from a left-hand curb that ends at TIP, along a corner of 5 m radius into a side street; heights of the rest in m.

    gutter : slope of the ground on either side of a gutter, whose bottom runs 15 cm before the corner's edge
    """
    area = side_street(radius=5.0)
    x, y, z, _ = scan(area, height=height, noise=NOISE, spacing=0.03, within=(3.0, 0.0, 21.0, 13.0))
    z[shapely.contains_xy(shapely.box(-9, 3.5, TIP, 30), x, y)] += 0.10 - height
    near = np.flatnonzero((gutter > 0.0) & (x > TIP - 2.0) & (x < TIP + 8.0) & (y > 1.0) & (y < 12.0))
    z[near] += gutter * shapely.distance(shapely.points(x[near], y[near]), shapely.boundary(shapely.buffer(area, 0.15, quad_segs=64)))
    raster = averaged(ground_raster(x, y, z, 0.05), 0.05)
    ends = FollowedEnds(*np.array([[TIP, 3.5 + beside, 0.0, np.cos(turned), np.sin(turned), -1.0, np.nan, 0]]).T)
    found = led_on(raster, ends)
    return found, shapely.distance(shapely.points(found.x, found.y), shapely.boundary(area))


def test_a_curb_dropped_to_two_centimetres_is_followed_around_its_corner():
    found, off = led(0.02)
    assert len(found) > 12 and found.y.max() > 8.0
    assert np.median(off) < 0.05 and off.max() < 0.12
    assert np.median(found.height) == pytest.approx(0.02, abs=0.004)


def test_a_flush_edge_is_none():
    assert not len(led(0.0)[0])


def test_a_gutter_is_none_but_a_dropped_curb_beside_it_is_followed():
    assert not len(led(0.0, gutter=0.1)[0])
    assert len(led(0.02, gutter=0.1)[0]) > 12


def test_what_begins_beside_the_curb_or_in_another_direction_does_not_lead_on():
    assert not len(led(0.02, beside=-0.3)[0])
    assert not len(led(0.02, turned=np.radians(-20.0))[0])


def dropped_street(stretch, height=0.02, seam=0.0):
    """A street of sure curbs, the left one dropped along a stretch; a seam between two layers of asphalt 1 m left of the middle."""
    x, y, z, time = street(open_left=stretch, noise=NOISE, lines=0.03)
    for a, b in stretch:
        z[(x > a) & (x < b) & (y > 3.5)] += height
    return survey_of((x, y, z + np.where(y > 1.0, seam, 0.0), time), driven())


def edge_places(survey):
    """Metres along and left of the middle, of the vertices of all edges."""
    edges = fit_road_edges(detect_curbs(survey), survey.frame)
    return np.concatenate([shapely.get_coordinates(line) for line, _ in edges]).T - np.array([[EAST], [NORTH]])


@pytest.mark.slow
def test_an_edge_goes_on_where_its_curb_is_dropped():
    x, y = edge_places(dropped_street([(18, 34)]))
    inside = (x > 19) & (x < 33) & (y > 0)
    assert inside.sum() > 20 and np.abs(y[inside] - 3.5).max() < 0.12


@pytest.mark.slow
def test_a_seam_between_two_layers_of_asphalt_is_no_curb():
    x, y = edge_places(dropped_street([(18, 34)], height=0.0, seam=0.02))
    assert len(x) and np.abs(y).min() > 3.0
    assert not ((x > 21) & (x < 31) & (y > 0)).any()
