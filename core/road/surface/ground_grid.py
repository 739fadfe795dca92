"""The ground in cells of station and offset: how high the lowest layer lies, how rough and how bright it is."""

from dataclasses import dataclass

import numpy as np

from ...common.order_statistics import order_by
from ...survey.store.records import COORDINATE_SCALE

ROW_LENGTH, COLUMN_WIDTH = 0.5, 0.25   # m along and across the road
GROUND_LAYER_JUMP = 0.06         # m between two layers: ground below, a car's sill above
GROUND_LAYER_DEPTH = 0.12        # m of the lowest layer that count as ground: a wall has no upper end
MIN_LAYER_SHARE = 0.08              # of a cell's points that the lowest layer holds at least: less is multipath below the road
GOLDEN_RATIO_32 = 0x9E3779B9       # of 2^32
MAX_POINTS_PER_CELL = 100                # points of a cell that are looked at: more tell nothing new of it
POINTS_PER_BATCH = 1 << 15         # points worked at a time: what fits the processor's cache
MIN_LAYER_POINTS = 3          # points of a layer
MIN_PLANE_POINTS = 6           # points from which a cell's plane and roughness are taken
GROUND_REACH, GROUND_REACH_PER_METRE = 0.7, 0.12  # m about the vehicle's road height, and per metre beside the track, where ground may lie


@dataclass
class GroundCells:
    """(rows, columns) float32 arrays, NaN where there is no ground: `height` (local z of a cell's middle),
    `rough` (m about the cell's own plane), `brightness` (median intensity), `scatter` (its lower spread as a sigma), and `count`.

    Row k reaches from row_size * (first_row + k), column j from column_size * (first_column + j).
    """

    first_row: int
    first_column: int
    row_size: float
    column_size: float
    height: np.ndarray
    rough: np.ndarray
    brightness: np.ndarray
    scatter: np.ndarray
    count: np.ndarray

    NAMES = ("height", "rough", "brightness", "scatter", "count")

    @classmethod
    def joined(cls, parts):
        """The cells of windows that follow on each other."""
        return cls(parts[0].first_row, parts[0].first_column, parts[0].row_size, parts[0].column_size,
                   *(np.concatenate([getattr(part, name) for part in parts]) for name in cls.NAMES))

    @property
    def stations(self):
        """Middles of the rows."""
        return (self.first_row + np.arange(len(self.height)) + 0.5) * self.row_size

    @property
    def offsets(self):
        """Middles of the columns."""
        return (self.first_column + np.arange(self.height.shape[1]) + 0.5) * self.column_size


def known_median(values, axis):
    """Median of what is not NaN along an axis; NaN where nothing is known (and no warning in some thread)."""
    ordered = np.sort(values, axis=axis)
    count = np.isfinite(ordered).sum(axis=axis, keepdims=True)
    low = np.take_along_axis(ordered, np.maximum(count - 1, 0) // 2, axis)
    high = np.take_along_axis(ordered, count // 2 * (count > 0) - (count // 2 >= ordered.shape[axis]), axis)
    return np.squeeze(0.5 * (low + high), axis)


def ground_cells(points, first_row, rows, reach, road_height, row_size=ROW_LENGTH, column_size=COLUMN_WIDTH):
    """Cells of a window of the road.

    Parameters
    ----------
    points : Points of the window
    first_row, rows : which rows to make
    reach : m either side
    road_height : function of stations, local z of the road under the vehicle, good to decimetres
    row_size, column_size : m along and across

    Returns
    -------
    GroundCells
    """
    half = int(np.ceil(reach / column_size))
    columns = 2 * half
    prior = road_height((first_row + np.arange(rows) + 0.5) * row_size)
    kept, cell = _near_ground(points.records, first_row, rows, half, prior, row_size, column_size)
    z = points.records["z"].take(kept)
    order = order_by(z, cell)
    kept, cell, z = kept[order], cell[order], z[order] * COORDINATE_SCALE
    low = np.flatnonzero(_in_lowest_layer(cell, z, np.bincount(cell, minlength=rows * columns)))
    kept, at, z = kept[low], cell[low], z[low]
    count = np.bincount(at, minlength=rows * columns)
    row, column = np.divmod(np.arange(rows * columns), columns)
    u, v = (points.records[name].take(kept) * COORDINATE_SCALE - np.repeat(middle, count) for name, middle in
            (("d", (column - half + 0.5) * column_size), ("s", (row + first_row + 0.5) * row_size)))
    height, rough = _planes(count, u, v, z)
    brightness, scatter = _medians(at, count, points.intensity[kept])
    shape = rows, columns
    return GroundCells(first_row, -half, row_size, column_size,
                 *(values.reshape(shape).astype(np.float32) for values in (height, rough, brightness, scatter, count)))


def _near_ground(records, first_row, rows, half, prior, row_size, column_size):
    """Indices of records in the window and near the road's height, no more of a cell than tell anything, and the cell of each."""
    prior = np.rint(prior / COORDINATE_SCALE).astype(np.int32)
    along, across = (np.int32(round(size / COORDINATE_SCALE)) for size in (row_size, column_size))
    nowhere = rows * 2 * half
    cell, count = np.empty(len(records), np.int32), np.zeros(nowhere + 1, np.int64)
    for first in range(0, len(records), POINTS_PER_BATCH):
        s, d, z = (records[name][first:first + POINTS_PER_BATCH] for name in ("s", "d", "z"))
        row = s // along
        row -= np.int32(first_row)
        column = d // across
        column += np.int32(half)
        # below 0 is far above as a number without a sign
        inside = row.view(np.uint32) < np.uint32(rows)
        inside &= column.view(np.uint32) < np.uint32(2 * half)
        above = z - prior.take(row, mode="clip")
        reach = np.abs(d * np.float32(GROUND_REACH_PER_METRE))
        reach += np.float32(GROUND_REACH / COORDINATE_SCALE)
        inside &= np.abs(above) < reach
        row *= np.int32(2 * half)
        row += column
        row[~inside] = nowhere
        cell[first:first + POINTS_PER_BATCH] = row
        count += np.bincount(row, minlength=nowhere + 1)
    # multiples of the golden section lie evenly whatever run of them is looked at
    share = np.floor(0xFFFFFFFF * np.minimum(MAX_POINTS_PER_CELL / np.maximum(count, 1), 1.0)).astype(np.uint32)
    share[nowhere] = 0
    turn = np.arange(1, POINTS_PER_BATCH + 1, dtype=np.uint32) * np.uint32(GOLDEN_RATIO_32)
    kept = [np.empty(0, np.intp)]
    for first in range(0, len(cell), POINTS_PER_BATCH):
        here = share.take(cell[first:first + POINTS_PER_BATCH])
        some = np.flatnonzero(turn[:len(here)] + np.uint32(first * GOLDEN_RATIO_32 % 2**32) < here)
        some += first
        kept.append(some)
    kept = np.concatenate(kept)
    return kept, cell.take(kept)


def _in_lowest_layer(cell, z, total):
    """Mask of points, sorted by cell and height, that belong to the lowest layer of their cell that is no stray."""
    if not len(cell):
        return np.zeros(0, bool)
    begins = np.r_[True, (np.diff(cell) > 0) | (np.diff(z) > GROUND_LAYER_JUMP)]
    layer = np.cumsum(begins) - 1
    size = np.bincount(layer)
    of_cell = cell[begins]
    solid = size >= np.maximum(MIN_LAYER_POINTS, MIN_LAYER_SHARE * total[of_cell])
    chosen = np.full(len(total), -1)
    numbers = np.flatnonzero(solid)[::-1]
    chosen[of_cell[numbers]] = numbers
    lowest = z[begins]
    return (chosen[cell] == layer) & (z - lowest[layer] < GROUND_LAYER_DEPTH)


def _planes(count, u, v, z):
    """Height at the middle and roughness of the plane through each cell's points, which lie cell by cell."""
    n = np.maximum(count, 1).astype(float)
    filled = np.flatnonzero(count)
    starts = (np.cumsum(count) - count)[filled]

    def mean(values):
        sums = np.zeros(len(count))
        if len(starts):
            sums[filled] = np.add.reduceat(values, starts)
        return sums / n

    mu, mv, mz = mean(u), mean(v), mean(z)
    du, dv, dz = (values - np.repeat(middle, count) for values, middle in ((u, mu), (v, mv), (z, mz)))
    uu, uv, vv, uz, vz, zz = mean(du * du), mean(du * dv), mean(dv * dv), mean(du * dz), mean(dv * dz), mean(dz * dz)
    # a little ridge keeps cells whose points lie on one line from tilting at will
    uu, vv = uu + 1e-4, vv + 1e-4
    determinant = uu * vv - uv * uv
    across, along = (uz * vv - vz * uv) / determinant, (vz * uu - uz * uv) / determinant
    rest = np.maximum(zz - across * uz - along * vz, 0.0)
    enough, any_ground = count >= MIN_PLANE_POINTS, count >= MIN_LAYER_POINTS
    rough = np.sqrt(rest * n / np.maximum(n - 3, 1))
    height = np.where(enough, mz - across * mu - along * mv, mz)
    return np.where(any_ground, height, np.nan), np.where(enough, rough, np.nan)


def _medians(at, count, intensity):
    """Median of each cell's intensities (16 bits) and the lower spread about it."""
    values = intensity[order_by(intensity, at)].astype(float)
    start = np.cumsum(count) - count
    filled = count >= MIN_LAYER_POINTS
    median, spread = np.full(len(count), np.nan), np.full(len(count), np.nan)
    median[filled] = values[(start + count // 2)[filled]]
    spread[filled] = (median[filled] - values[(start + count // 4)[filled]]) / 0.6745
    return median, spread
