"""What the ground behind a step does: back at the bottom of the step, as behind an island, or up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..ground_raster import PLAN_CELL, GroundRaster

ROAD_BEFORE = 1.25            # m before a step, where the slope of the road is taken: the step itself is not in it
ISLAND_DROP_SHARE = 0.4       # share of a step's height that the ground behind an island may lie above its bottom
MIN_EDGE_SHARE = 0.7          # share of that height at which its far side begins


@dataclass
class GroundBehind:
    """What the ground behind M steps does, along a ray uphill from each.

    Attributes
    ----------
    falls : (M,) m uphill at which the ground is back at the step's bottom, NaN where it stays up
    edge : (M,) m uphill of the last raised ground, if the step down behind it was not seen, because the raised ground itself hid it; else NaN
    slope : (M,) m per m uphill, of the road before the step
    """

    falls: np.ndarray
    edge: np.ndarray
    slope: np.ndarray


def ground_behind(raster: GroundRaster, slopes: Sequence[np.ndarray], x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray,
                  bottom: np.ndarray, height: np.ndarray, farthest: float) -> GroundBehind:
    """Where the ground behind steps is down again.

    Parameters
    ----------
    raster : GroundRaster
    slopes : result of `ground_slopes`
    x, y : (M,) local m, places of the steps
    nx, ny : (M,) unit vectors uphill
    bottom, height : (M,) m, of the steps
    farthest : m uphill that are searched
    """
    # the ground behind is down where the plane of the road before the step goes on
    before = raster.nearest_cells(x - ROAD_BEFORE * nx, y - ROAD_BEFORE * ny)
    slope = nx * slopes[0][before] + ny * slopes[1][before]
    out = (np.arange(int(round(farthest / PLAN_CELL))) + 2) * PLAN_CELL
    row, column = raster.cells_at(x[:, None] + out * nx[:, None], y[:, None] + out * ny[:, None])
    on = (row >= 0) & (column >= 0) & (row < raster.low.shape[0]) & (column < raster.low.shape[1])
    there = np.where(on, raster.low[np.where(on, row, 0), np.where(on, column, 0)], np.nan)
    with np.errstate(invalid="ignore"):
        share = (there - bottom[:, None] - slope[:, None] * out) / height[:, None]
        down, up = share < ISLAND_DROP_SHARE, share >= ISLAND_DROP_SHARE
    first = np.where(down.any(1), np.argmax(down, axis=1), len(out))
    last = np.where(up, np.arange(len(out)), -1)
    last[np.arange(len(out)) >= first[:, None]] = -1
    last = last.max(axis=1)
    own = np.arange(len(x))
    # a ramp is seen all the way down
    hidden = (first < len(out)) & (last >= 0) & (first - last > 1) & (share[own, last] >= MIN_EDGE_SHARE)
    return GroundBehind(np.where(first < len(out), out[np.minimum(first, len(out) - 1)], np.nan), np.where(hidden, out[last], np.nan), slope)
