"""Which points lie on a road whose height and limits are known, and which stand on it."""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...survey.store.records import COORDINATE_SCALE
from .ground_grid import COLUMN_WIDTH, POINTS_PER_BATCH, ROW_LENGTH

# Road beneath something that stands on it or hangs over it: parked cars, tables, bushes.

MIN_OBSTACLE_HEIGHT, MAX_OBSTACLE_HEIGHT = 0.25, 2.0   # m above the road: curbs and stray points end below, signs and branches begin above
OBSTACLE_SQUARE = 0.20           # m
MIN_OBSTACLE_SHARE = 1 / 3           # of all points within a square and those about it


def covered_by_obstacles(road_points, above):
    """Which road points lie beneath or right beside something.

    Parameters
    ----------
    road_points, above : Points of the road and of what is MIN_OBSTACLE_HEIGHT to MAX_OBSTACLE_HEIGHT above it,
        a square farther along the road either way than is asked about

    Returns
    -------
    (N,) bool, one for each road point
    """
    if not len(above) or not len(road_points):
        return np.zeros(len(road_points), bool)
    places, high_places, shape = _squares(road_points.records, above.records)
    road, high = (ndimage.uniform_filter(np.bincount(p, minlength=shape[0] * shape[1]).reshape(shape).astype(float), 3, mode="constant")
                  for p in (places, high_places))
    # means of whole numbers over nine squares: exact enough to be compared
    dark = np.rint(9 * high) > MIN_OBSTACLE_SHARE * np.rint(9 * (road + high))
    return dark.ravel().take(places) if dark.any() else np.zeros(len(road_points), bool)


def _squares(*points):
    """(N,) int32 number of the square that each point of several sets lies in, and the (rows, columns) of all squares."""
    size = np.int32(round(OBSTACLE_SQUARE / COORDINATE_SCALE))
    low = [min(int(records[name].min()) for records in points) // size - 1 for name in ("s", "d")]
    shape = tuple(max(int(records[name].max()) for records in points) // size - first + 2 for name, first in zip(("s", "d"), low))
    found = []
    for records in points:
        place = np.empty(len(records), np.int32)
        for first in range(0, len(place), POINTS_PER_BATCH):
            run = place[first:first + POINTS_PER_BATCH]
            np.floor_divide(records["s"][first:first + POINTS_PER_BATCH], size, out=run)
            run -= np.int32(low[0])
            run *= np.int32(shape[1])
            run += records["d"][first:first + POINTS_PER_BATCH] // size
            run -= np.int32(low[1])
        found.append(place)
    return *found, shape

@dataclass(frozen=True)
class OnRoad:
    """Points of a window by index.

    surface : (M,) those of the road itself; half_width : (M,) uint16 mm from the reference line to the limit of each one's side
    above : (K,) what is MIN_OBSTACLE_HEIGHT to MAX_OBSTACLE_HEIGHT above it
    """

    surface: np.ndarray
    half_width: np.ndarray
    above: np.ndarray


def points_on_road(points, carriageway):
    """The points of a window that lie on the road or stand above it.

    Between the middles of rows the limits are straight; beside a row without road the nearer row counts.
    Between the middles of cells the height is bilinear.

    Parameters
    ----------
    points : Points
    carriageway : Carriageway

    Returns
    -------
    OnRoad

    Notes
    -----
    It is reckoned in units of 0.1 mm from a corner of each cell in single precision, which
    is finer than coordinates are, and the same from whichever window a point is looked at.
    """
    records = points.records
    if not len(records):
        return OnRoad(np.empty(0, np.intp), np.empty(0, np.uint16), np.empty(0, np.intp))
    here = _SurfaceTables(carriageway, records["s"], records["d"])
    parts = []
    for first in range(0, len(records), POINTS_PER_BATCH):
        found = here.points(*(records[name][first:first + POINTS_PER_BATCH] for name in ("s", "d", "z")))
        parts.append((found[0] + first, found[1], found[2] + first))
    return OnRoad(*(np.concatenate(part) for part in zip(*parts)))


class _SurfaceTables:
    """Limits and height of the rows about a window, as tables of half rows and of cells."""

    def __init__(self, carriageway, s, d):
        cells = carriageway.cells
        # as many rows and columns as the points need: beyond the outermost cells height and limits stay as they are there
        (self.s0, rows), (self.d0, columns) = (
            _middles(values, size, first, count) for values, size, first, count in
            ((s, ROW_LENGTH, cells.first_row, cells.height.shape[0]), (d, COLUMN_WIDTH, cells.first_column, cells.height.shape[1])))
        height = carriageway.height[np.ix_(rows, columns)].astype(float) / COORDINATE_SCALE
        self.columns = len(columns) - 1
        self.left, self.right = (_half_rows(limit[rows] / COORDINATE_SCALE) for limit in (carriageway.left, carriageway.right))
        across = np.diff(height, axis=1)
        self.corner = np.rint(height[:-1, :-1]).astype(np.int32).ravel()
        # height = corner + rest + across * v + (along + twist * v) * u, with u, v from 0 to 1 in the cell
        self.tables = [table.astype(np.float32).ravel() for table in (height[:-1, :-1] - np.rint(height[:-1, :-1]), across[:-1],
                                                                      np.diff(height, axis=0)[:, :-1], np.diff(across, axis=0))]
        self.tolerance, self.low, self.high = (np.float32(metres / COORDINATE_SCALE) for metres in
                                               (carriageway.tolerance, MIN_OBSTACLE_HEIGHT, MAX_OBSTACLE_HEIGHT))

    def points(self, s, d, z):
        """Indices of points of the road, their half widths (mm), and indices of points above it."""
        row, u = _steps(s, self.s0, ROW_LENGTH)
        half = row + row
        half += u >= np.float32(0.5)
        left, right = (_line(*limit, half, u) for limit in (self.left, self.right))
        cell, v = _steps(d, self.d0, COLUMN_WIDTH)
        row *= np.int32(self.columns)
        cell += row
        rest, across, along, twist = (table.take(cell, mode="clip") for table in self.tables)
        twist *= v
        along += twist
        along *= u
        across *= v
        rest += across
        rest += along
        rise = z - self.corner.take(cell, mode="clip")
        rise = rise - rest
        d = d.astype(np.float32)
        inside = d < left
        inside &= d > right
        on_road = np.flatnonzero((np.abs(rise) < self.tolerance) & inside)
        width = np.where(d >= 0, left, -right).take(on_road)
        width *= np.float32(COORDINATE_SCALE * 1e3)
        width += np.float32(0.5)
        np.minimum(width, np.float32(65535), out=width)
        return on_road, width.astype(np.uint16), np.flatnonzero((rise > self.low) & (rise < self.high) & inside)


def _middles(units, size, first, count):
    """Where the first of the middles of cells lies between which places lie, in units, and the index of each one's cell."""
    low, high = (int(np.floor(int(end) * COORDINATE_SCALE / size - 0.5)) for end in (units.min(), units.max()))
    return int(round((low + 0.5) * size / COORDINATE_SCALE)), np.clip(np.arange(low, high + 2) - first, 0, count - 1)


def _steps(units, first, size):
    """The step of `size` metres that places lie in, counted from `first`, and the share of it behind them, (N,) int32 and float32."""
    size = np.int32(round(size / COORDINATE_SCALE))
    place = units - np.int32(first)
    step = place // size
    place -= step * size
    return step, place * np.float32(1.0 / size)


def _line(start, slope, half, u):
    """Values in half rows, (N,) float32."""
    found = slope.take(half, mode="clip")
    found *= u
    found += start.take(half, mode="clip")
    return found


def _half_rows(limit):
    """(start, slope) of a limit, (2 (R - 1),) float32 each: what it is, of u from 0 to 1 between rows, in each half row."""
    before, after = limit[:-1], limit[1:]
    whole = np.isfinite(before) & np.isfinite(after)
    slope = np.where(whole, after - before, 0.0)
    start = np.stack([before, np.where(whole, before, after)], axis=1)
    return start.ravel().astype(np.float32), np.repeat(slope, 2).astype(np.float32)
