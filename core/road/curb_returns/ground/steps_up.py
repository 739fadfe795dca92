"""Places where the ground rises beside driven ground, in any direction."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..ground_raster import PLAN_CELL, GroundRaster, diamond, grown

MAX_CELLS_FROM_ROAD = 4       # cells from driven ground within which it may end at a step
STEPS_PER_BATCH = 512         # steps that are measured together: they fit the processor's cache
PATCH_CELLS = 4               # cells about a step whose ground gives its direction and height
STEP_HALF_WIDTH = 0.11        # m from the middle of a step, beyond which ground is before or after it
PATCH_HALF_LENGTH = 0.31      # m along a step of the ground that is compared
MAX_PLAN_ROUGHNESS_SHARE = 0.25   # share of a step's height that the road before it may scatter
MIN_PLAN_RISE_SHARE = 0.6     # share of the least step that the cells of one must show


def step_places(raster: GroundRaster, slopes: Sequence[np.ndarray], driven: np.ndarray, stepped: np.ndarray, min_height: float,
                max_height: float, wanted: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None) -> tuple[np.ndarray, ...]:
    """Where the ground rises beside driven ground: place and direction, at most one for every square of two cells.

    Parameters
    ----------
    raster : GroundRaster
    slopes : result of `ground_slopes`
    driven, stepped : result of `driven_ground`
    min_height, max_height : m, of a step
    wanted : function, local x, y -> (N,) bool: only these are returned, and squares without such a cell are not looked at

    Returns
    -------
    x, y : (M,) local m
    nx, ny : (M,) unit vector uphill
    """
    beside = grown(driven, diamond(MAX_CELLS_FROM_ROAD))
    row, column = np.nonzero(stepped & beside)
    asked = np.ones(len(row), bool)
    if wanted is not None:
        x, y = raster.middle(row, column)
        asked = wanted(x, y)
        _, square = np.unique(_squares(x, y), return_inverse=True)
        own = np.flatnonzero(np.bincount(square, asked)[square])
        row, column, asked = row[own], column[own], asked[own]
    ground = np.pad(raster.low, PATCH_CELLS, constant_values=np.nan)
    parts = [_rises_at(raster, ground, slopes, row[a:a + STEPS_PER_BATCH], column[a:a + STEPS_PER_BATCH], min_height, max_height)
             for a in range(0, len(row), STEPS_PER_BATCH)]
    good, rises = (np.concatenate(column, axis=-1) for column in zip(*parts)) if parts else (np.empty(0, bool), np.empty((5, 0)))
    x, y, nx, ny, cost = rises
    best = _one_of_each_square(x, y, cost)
    best = best[asked[good][best]]
    return x[best], y[best], nx[best], ny[best]


def _rises_at(raster, ground, slopes, row, column, min_height, max_height):
    """Which cells rise like a step, and of these x, y, unit vector uphill, and how far the middle of the step is off, (5, M).

    ground : of the raster, padded by PATCH_CELLS empty cells
    """
    reach = np.arange(-PATCH_CELLS, PATCH_CELLS + 1)
    down, along = (v.ravel() for v in np.meshgrid(reach, reach, indexing="ij"))
    width = ground.shape[1]
    around = ground.ravel().take(((row + PATCH_CELLS) * width + column + PATCH_CELLS)[:, None] + (down * width + along))
    dx, dy = along * PLAN_CELL, down * PLAN_CELL
    sx, sy = (v[row, column] for v in slopes)
    around -= sx[:, None] * dx + sy[:, None] * dy
    # heights of the step at this cell, without the wall behind a curb and the ground below a bridge
    near = np.isfinite(around) & (np.abs(around - raster.low[row, column][:, None]) <= max_height + 0.05)
    gx, gy = _gradient(around, near, dx, dy)
    size = np.maximum(np.hypot(gx, gy), 1e-9)
    nx, ny = gx / size, gy / size
    u, v = nx[:, None] * dx + ny[:, None] * dy, ny[:, None] * dx - nx[:, None] * dy
    strip = near & (np.abs(v) <= PATCH_HALF_LENGTH)
    before, after, at = (_mean(around, strip & m) for m in ((u < -STEP_HALF_WIDTH), (u > STEP_HALF_WIDTH), (np.abs(u) < STEP_HALF_WIDTH)))
    rise = after - before
    rough = np.sqrt(_mean((around - before[:, None]) ** 2, strip & (u < -STEP_HALF_WIDTH)))
    with np.errstate(invalid="ignore", divide="ignore"):
        part = (at - before) / rise
        good = (part > 0.15) & (part < 0.85) & (rise >= MIN_PLAN_RISE_SHARE * min_height) & (rise <= max_height + 0.05) \
            & (rough <= MAX_PLAN_ROUGHNESS_SHARE * rise)
    # the middle of the step, not of the cell
    return good, np.array([*raster.middle(row[good], column[good]), nx[good], ny[good], np.abs(part - 0.5)[good]])


def _gradient(values, mask, dx, dy):
    """Slope of the plane through masked values of every row."""
    z = np.where(mask, values, 0.0)
    n = mask.sum(1)
    # two products in place of seven: each reads all patches, and OpenBLAS may start threads of its own for each
    sums = mask.astype(float) @ np.stack([dx, dy, dx * dx, dy * dy, dx * dy], axis=1)
    moments = z @ np.stack([dx, dy], axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        (mx, my, xx, yy, xy), (mxz, myz), mz = sums.T / n, moments.T / n, z.sum(1) / n
        xx, yy, xy = xx - mx * mx, yy - my * my, xy - mx * my
        xz, yz = mxz - mx * mz, myz - my * mz
        det = xx * yy - xy * xy + 1e-9
        return (yy * xz - xy * yz) / det, (xx * yz - xy * xz) / det


def _mean(values, mask):
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(mask, values, 0.0).sum(1) / mask.sum(1)


def _one_of_each_square(x, y, cost):
    """Indices of the cheapest place of every square of two cells, squares in order."""
    key = _squares(x, y)
    order = np.lexsort((cost, key))
    return order[np.r_[True, np.diff(key[order]) > 0][:len(order)]]


def _squares(x, y):
    """(N,) number of the square of two cells in which places lie."""
    return np.floor(y / (2 * PLAN_CELL)).astype(np.int64) * 10_000_000 + np.floor(x / (2 * PLAN_CELL)).astype(np.int64)
