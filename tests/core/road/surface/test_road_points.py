"""Which points lie on a road of known height and limits: the same as point by point in double precision."""

import numpy as np
import pytest
from lanewright.core.road.surface.ground_grid import GroundCells
from lanewright.core.road.surface.pavement_edge import Carriageway
from lanewright.core.road.surface.road_points import points_on_road
from lanewright.core.road.weights import SURFACE
from lanewright.core.survey.store.columns import Columns
from lanewright.core.survey.store.records import SURVEY_POINT, Points, to_units

FIRST_ROW, FIRST_COLUMN, COLUMNS, TOLERANCE = -7, -40, 80, 0.05


def carriageway(rows, seed=5):
    """A hilly road with limits that wander, and stretches without road."""
    rng = np.random.default_rng(seed)
    height = 87.0 + 0.1 * np.arange(rows)[:, None] + np.cumsum(rng.normal(0, 0.005, (rows, COLUMNS)), axis=1)
    left, right = 4 + rng.normal(0, 0.3, rows), -5 + rng.normal(0, 0.3, rows)
    left[rng.random(rows) < 0.2] = np.nan
    none = np.empty((rows, 0))
    cells = GroundCells(FIRST_ROW, FIRST_COLUMN, SURFACE.row_length, SURFACE.column_width, height.astype(np.float32), none, none, none, none, none)
    return Carriageway(cells, height.astype(np.float32), none, right, left, none, none, TOLERANCE)


def points_about(road, count=40_000, seed=6):
    rng = np.random.default_rng(seed)
    records = np.zeros(count, SURVEY_POINT)
    s = np.sort(rng.uniform(FIRST_ROW * SURFACE.row_length - 1, (FIRST_ROW + len(road.height)) * SURFACE.row_length + 1, count))
    d = rng.uniform(-11, 11, count)
    records["s"], records["d"] = to_units(s), to_units(d)
    records["z"] = to_units(height_at(road, s, d) + rng.choice([0.0, 0.0, 1.0], count) + rng.normal(0, 0.04, count))
    return Points(Columns.from_records(records))


def height_at(road, s, d):
    rows, columns = road.height.shape
    row = np.clip(s / SURFACE.row_length - FIRST_ROW - 0.5, 0, rows - 1)
    column = np.clip(d / SURFACE.column_width - FIRST_COLUMN - 0.5, 0, columns - 1)
    k, j = np.minimum(row.astype(int), max(rows - 2, 0)), np.minimum(column.astype(int), columns - 2)
    u, v, after = row - k, column - j, np.minimum(k + 1, rows - 1)
    h = road.height.astype(float)
    return (1 - u) * ((1 - v) * h[k, j] + v * h[k, j + 1]) + u * ((1 - v) * h[after, j] + v * h[after, j + 1])


def limit_at(limit, s):
    row = np.clip(s / SURFACE.row_length - FIRST_ROW - 0.5, 0, len(limit) - 1)
    k = np.minimum(row.astype(int), max(len(limit) - 2, 0))
    u, after = row - k, np.minimum(k + 1, len(limit) - 1)
    between = (1 - u) * limit[k] + u * limit[after]
    return np.where(np.isfinite(between), between, np.where(u < 0.5, limit[k], limit[after]))


@pytest.mark.parametrize("rows", [1, 2, 30])
def test_each_point_is_told_as_in_double_precision(rows):
    road = carriageway(rows)
    points = points_about(road)
    left, right = limit_at(road.left, points.s), limit_at(road.right, points.s)
    rise = points.z - height_at(road, points.s, points.d)
    within = (points.d < left) & (points.d > right)
    found = points_on_road(points, road)
    # a hundredth of a millimetre from a limit, or from where two rows are equally near, either answer is right
    sure = (np.abs(np.abs(rise) - TOLERANCE) > 1e-5) & ~(np.abs(points.d - left) < 1e-5) & ~(np.abs(points.d - right) < 1e-5)
    sure &= np.abs(points.s / SURFACE.row_length % 1.0) > 1e-5
    on_road = np.zeros(len(points), bool)
    on_road[found.surface] = True
    np.testing.assert_array_equal(on_road[sure], (within & (np.abs(rise) < TOLERANCE))[sure])
    side = np.where(points.d >= 0, left, -right)[found.surface]
    np.testing.assert_allclose(found.half_width * 1e-3, np.maximum(side, np.abs(points.d[found.surface])), atol=0.00051)
    np.testing.assert_array_equal(found.above, np.flatnonzero(within & (rise > 0.25) & (rise < 2.0)))


def test_no_points_none_on_the_road():
    found = points_on_road(points_about(carriageway(3), count=0), carriageway(3))
    assert [len(part) for part in (found.surface, found.half_width, found.above)] == [0, 0, 0]
