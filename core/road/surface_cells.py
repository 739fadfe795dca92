"""The ground in cells of station and offset: how high the lowest layer lies, how rough and how bright it is."""

from dataclasses import dataclass

import numpy as np

from ..survey.points import UNIT
from ..survey.sorting import order_by, thinned

ROW, COLUMN = 0.5, 0.25   # m along and across the road
LAYER_JUMP = 0.06         # m between two layers: ground below, a car's sill above
LAYER_DEPTH = 0.12        # m of the lowest layer that count as ground: a wall has no upper end
SHARE = 0.08              # of a cell's points that the lowest layer holds at least: less is multipath below the road
MOST = 200                # points of a cell that are looked at: more tell nothing new of it
FEWEST_LAYER = 3          # points of a layer
FEWEST_TILT = 6           # points from which a cell's plane and roughness are taken
NEAR, PER_METRE = 0.7, 0.12  # m about the vehicle's road height, and per metre beside the track, where ground may lie


@dataclass
class Cells:
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


def ground_cells(points, first_row, rows, reach, road_height, row_size=ROW, column_size=COLUMN):
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
    Cells
    """
    half = int(np.ceil(reach / column_size))
    columns = 2 * half
    prior = road_height((first_row + np.arange(rows) + 0.5) * row_size)
    kept, cell = _near_ground(points.records, first_row, rows, half, prior, row_size, column_size)
    some = thinned(cell, MOST)
    kept, cell = kept[some], cell[some]
    z = points.records["z"].take(kept)
    order = order_by(z, cell)
    kept, cell, z = kept[order], cell[order].astype(np.int64), z[order] * UNIT
    total = np.bincount(cell, minlength=rows * columns)
    low = np.flatnonzero(_in_lowest_layer(cell, z, total))
    kept, at, z = kept[low], cell[low], z[low]
    u = points.records["d"].take(kept) * UNIT - (at % columns - half + 0.5) * column_size
    v = points.records["s"].take(kept) * UNIT - (at // columns + first_row + 0.5) * row_size
    height, rough = _planes(at, u, v, z, rows * columns)
    brightness, scatter = _medians(at, points.intensity[kept], rows * columns)
    shape = rows, columns
    count = np.bincount(at, minlength=rows * columns)
    return Cells(first_row, -half, row_size, column_size,
                 *(values.reshape(shape).astype(np.float32) for values in (height, rough, brightness, scatter, count)))


def _near_ground(records, first_row, rows, half, prior, row_size, column_size):
    """Indices of the records in the window and near the road's height, and the cell of each."""
    s, d = records["s"], records["d"]
    row = s // int(round(row_size / UNIT))
    row -= first_row
    column = d // int(round(column_size / UNIT))
    column += half
    inside = (row >= 0) & (row < rows) & (column >= 0) & (column < 2 * half)
    above = records["z"] - np.rint(prior / UNIT).astype(np.int32).take(row, mode="clip")
    inside &= np.abs(above) < np.abs(d * np.float32(PER_METRE)) + np.float32(NEAR / UNIT)
    kept = np.flatnonzero(inside)
    return kept, row.take(kept) * (2 * half) + column.take(kept)


def _in_lowest_layer(cell, z, total):
    """Mask of points, sorted by cell and height, that belong to the lowest layer of their cell that is no stray."""
    if not len(cell):
        return np.zeros(0, bool)
    begins = np.r_[True, (np.diff(cell) > 0) | (np.diff(z) > LAYER_JUMP)]
    layer = np.cumsum(begins) - 1
    size = np.bincount(layer)
    of_cell = cell[begins]
    solid = size >= np.maximum(FEWEST_LAYER, SHARE * total[of_cell])
    chosen = np.full(len(total), -1)
    numbers = np.flatnonzero(solid)[::-1]
    chosen[of_cell[numbers]] = numbers
    lowest = z[begins]
    return (chosen[cell] == layer) & (z - lowest[layer] < LAYER_DEPTH)


def _planes(at, u, v, z, cells):
    """Height at the middle and roughness of the plane through each cell's points."""
    n = np.bincount(at, minlength=cells).astype(float)

    def mean(values):
        return np.bincount(at, values, cells) / np.maximum(n, 1)

    mu, mv, mz = mean(u), mean(v), mean(z)
    du, dv, dz = u - mu[at], v - mv[at], z - mz[at]
    uu, uv, vv, uz, vz, zz = mean(du * du), mean(du * dv), mean(dv * dv), mean(du * dz), mean(dv * dz), mean(dz * dz)
    # a little ridge keeps cells whose points lie on one line from tilting at will
    uu, vv = uu + 1e-4, vv + 1e-4
    determinant = uu * vv - uv * uv
    across, along = (uz * vv - vz * uv) / determinant, (vz * uu - uz * uv) / determinant
    rest = np.maximum(zz - across * uz - along * vz, 0.0)
    enough, any_ground = n >= FEWEST_TILT, n >= FEWEST_LAYER
    with np.errstate(invalid="ignore", divide="ignore"):
        rough = np.sqrt(rest * n / np.maximum(n - 3, 1))
    height = np.where(enough, mz - across * mu - along * mv, mz)
    return np.where(any_ground, height, np.nan), np.where(enough, rough, np.nan)


def _medians(at, intensity, cells):
    """Median of each cell's intensities (16 bits) and the lower spread about it."""
    # one number for cell and value sorts several times as fast as the two of them
    values = (np.sort((at << 16) | intensity) & 0xFFFF).astype(float)
    count = np.bincount(at, minlength=cells)
    start = np.r_[0, np.cumsum(count)[:-1]]
    filled = count >= FEWEST_LAYER
    median, spread = np.full(cells, np.nan), np.full(cells, np.nan)
    median[filled] = values[(start + count // 2)[filled]]
    spread[filled] = (median[filled] - values[(start + count // 4)[filled]]) / 0.6745
    return median, spread
