"""Islands that were taken for the road's own curb, because they stand nearer to the vehicle than that."""

from contextlib import closing
from functools import partial

import numpy as np
import pytest
import shapely
from lanewright.core.common.progress import Progress
from lanewright.core.road.common.curb_limits import CurbSettings
from lanewright.core.road.common.curb_points import CurbPoints, curb_points_at
from lanewright.core.road.common.decimation import PointDecimation
from lanewright.core.road.common.occlusion import OcclusionGrid
from lanewright.core.road.common.side_curbs import curbs_along, grids_beside, steps_of_roads
from lanewright.core.road.common.sides import expected_height
from lanewright.core.road.curb_returns.detect import with_curb_returns
from lanewright.core.road.curb_returns.islands import island_stretches
from lanewright.core.road.profiles.detect import profiles_of, steps_of_section
from lanewright.core.road.surface.ground_grid import MeasuredGround
from lanewright.core.road.surface.road_look import RoadLook
from lanewright.core.road.weights import CURBS
from street_plans import LENGTH, scan, sidewalks, survey_along

ISLAND, CURB = (10.0, 30.0, 4.0, 6.0), 9.0     # m: an island from 10 to 30 along and 4 to 6 across, the curb of the road
HEIGHT = 0.15


def beside(slope=0.0, behind=0.0, curb=CURB):
    """Ground about the island, `behind` it as high above the plane of the road as that, and about the curb."""
    grid = OcclusionGrid(0.25, 0, 160, 20.0)
    s, u = (np.arange(160) + 0.5) * 0.25, (np.arange(grid.cells) + 0.5) * CURBS.occlusion_cell
    along = (s > ISLAND[0]) & (s < ISLAND[1])
    top = along[:, None] & (u > ISLAND[2]) & (u < ISLAND[3])
    grid.ground[:] = slope * u + np.where(top | (u > curb), HEIGHT, 0.0) + np.where(along[:, None] & (u >= ISLAND[3]) & (u < curb), behind, 0.0)
    return grid


def stretches(grid, slope=0.0, before=CURB, after=CURB):
    """Where the curb `before` the island, its side, and the curb `after` it are parted, as (first, last) stations."""
    s = np.arange(0.5, 40.0)
    inside = (s > ISLAND[0]) & (s < ISLAND[1])
    u = np.where(inside, ISLAND[2], np.where(s < ISLAND[0], before, after))
    found = island_stretches(s, u, slope * u, np.full(len(s), HEIGHT), grid)
    return [(s[part][0], s[part][-1], np.median(away)) for part, away in found]


@pytest.mark.parametrize("slope", [0.0, -0.04, 0.03])
def test_an_island_has_road_behind_it_and_curbs_farther_out_before_and_after(slope):
    (first, last, away), = stretches(beside(slope), slope)
    assert (first, last) == (10.5, 29.5)
    assert away == pytest.approx(ISLAND[3] - ISLAND[2] + 0.5 * CURBS.occlusion_cell)


def test_a_sidewalk_that_is_wider_along_a_stretch_is_none():
    assert not stretches(beside(behind=HEIGHT))


def test_a_road_that_widens_or_narrows_once_has_none():
    assert not stretches(beside(), after=ISLAND[2])
    assert not stretches(beside(), before=ISLAND[2])


@pytest.mark.parametrize("behind", [0.0, HEIGHT])
def test_the_nose_of_an_island_in_the_mouth_of_a_street_is_one_unless_the_ground_stays_up_behind_it(behind):
    grid = beside(behind=behind, curb=20.0)
    s = np.r_[np.arange(2.0, 9.0), np.arange(12.0, 15.0), np.arange(18.0, 25.0)]
    nose = (s > 10.0) & (s < 16.0)
    found = island_stretches(s, np.where(nose, ISLAND[2], ISLAND[2] - 1.3), np.zeros(len(s)), np.full(len(s), HEIGHT), grid)
    assert [(s[part][0], s[part][-1]) for part, _ in found] == ([] if behind else [(12.0, 14.0)])


def test_a_long_bay_with_a_platform_and_low_ground_behind_it_is_bounded_by_the_road_s_own_curb():
    assert not stretches(beside(), before=ISLAND[2] - 1.3, after=ISLAND[2] - 1.3)


def test_ground_that_is_low_only_behind_the_curbs_of_the_road_is_none():
    assert not stretches(beside(), before=ISLAND[2] + 1.2, after=ISLAND[2] + 1.2)


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_curb_behind_a_platform_is_the_roads_own(side):
    sign = 1 if side == "left" else -1
    platform = shapely.box(10.0, *sorted((sign * 3.0, sign * 5.0))[:1], 26.0, sorted((sign * 3.0, sign * 5.0))[1])
    survey = survey_along(scan(shapely.union_all([sidewalks(8.0), platform])))
    settings = CurbSettings()
    with closing(PointDecimation(survey, settings.profile_width, settings.point_spacing)) as decimation:
        steps = steps_of_roads(steps_of_section, decimation, (settings,), {"profiles": profiles_of(decimation, settings)}, Progress())
        points, sides = curbs_along(decimation, steps, partial(RoadLook, MeasuredGround(survey)))["profiles"], grids_beside(steps["profiles"])
        # as if the curb behind had not been seen in profiles
        hidden = (points.side == side) & (points.station > 9.0) & (points.station < 27.0)
        s = np.arange(10.5, 26.0)
        places = survey.frame.to_map(0, s, np.full(len(s), sign * 3.0), expected_height(survey, 0, s))
        taken = curb_points_at(survey.frame, 0, places, side=side, status="measured", station=s, offset=sign * 3.0, height=0.12, chain=999)
        points = with_curb_returns(CurbPoints.join([points[~hidden], taken]), decimation, settings, beside=sides)
    main = points[(points.side == side) & (points.kind == "main")]
    np.testing.assert_allclose(np.abs(main.offset), 8.0, atol=0.05)
    assert np.diff(np.sort(main.station)).max() < 3.0 and np.ptp(main.station) > LENGTH - 6.0
    about = shapely.union_all([shapely.Point(x, y) for x, y in zip(points.station[points.kind == "island"], points.offset[points.kind == "island"])])
    assert shapely.hausdorff_distance(about, shapely.boundary(platform), densify=0.02) < 1.0
