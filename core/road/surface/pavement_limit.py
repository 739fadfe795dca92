"""The limit of the pavement in cells along its edge: the cells inside look like the road before them, those outside do not.

Single returns scatter more than gravel and asphalt differ, and a strip of gravel lies as level and smooth as the road. So
rows are averaged along the edge, and height, roughness and brightness of every cell are compared with those of the road,
continued by their trend across it. Paint lies on the road.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .edge_path import cheapest_path
from .ground_grid import known_median

if TYPE_CHECKING:
    from .pavement_edge import SurfaceProfiles

ROAD_CELLS = 20              # cells of road from which its look is continued: 2 m
INNER_CELLS, OUTER_CELLS = 12, 10  # cells inside and outside the place where the ground changes in which the limit is searched
NEAREST_BEFORE, FARTHEST_BEFORE = 2, 8  # cells before a cell from which its brightness is continued
AVERAGED_ROWS = 3            # rows either side that are averaged: 7 m of road
MIN_SIGMA_SHARE = 0.5        # of the scatter of single points that averages differ anyway: worn and patched asphalt
ROUGH_SIGMA = 0.25           # of the logarithm of roughness, that averages differ anyway
HEIGHT_SIGMA = 0.008         # m that averages lie off the height of the road anyway
MAX_SIGMAS = 2.8             # sigmas by which any of the three may be off: a cell of other ground weighs as much as one of road
OTHER_SIGMAS = 2.0           # sigmas from which a cell is rather not road
USUAL_QUANTILES, USUAL_SIGMAS = (0.5, 0.75), (0.67, 1.15)  # quantiles of what the cells of the road are off themselves, and their sigmas
PAINT_QUANTILE, PAINT_ROWS = 0.98, 25  # of the cells of road of so many rows: lines cover a few per cent of a road
MIN_PAINT_SIGMAS = 2.0       # scatters of single points by which paint is brighter than the cells beside it,
PAINT_SHARE = 0.5            # and this share of the contrast of the paint on this side
MAX_USUAL_SHARE = 2.0        # times that scatter, of the upper quantile, beyond which brightness says nothing: the road was scanned from two sides
GROSS_SIGMAS = 3.0           # of that scatter
LINE_CELLS = 2, 3, 4         # cells from a cell of a line to road on both of its sides: lines are up to 0.3 m wide
LIMIT_SHIFT_COST, LARGEST_LIMIT_SHIFT_COST = 6.0, 60.0  # that a change of the limit by a cell, and any change, must save


def pavement_limits(rows: SurfaceProfiles, change: np.ndarray) -> np.ndarray:
    """Where the pavement ends near the change of ground.

    Parameters
    ----------
    rows : SurfaceProfiles of one side, P rows of cells, outward; heights above that of the road
    change : (P,) cells, not necessarily whole, near which the pavement ends

    Returns
    -------
    (P,) cells, as `change`
    """
    whole = np.rint(change).astype(np.int64)
    # cells along the edge, so that rows can be averaged where it bends away from the reference line
    at = whole[:, None] + np.arange(-ROAD_CELLS - INNER_CELLS, OUTER_CELLS)
    there = (at >= 0) & (at < rows.height.shape[1])
    unpainted = np.where(_painted(rows, change), np.nan, rows.brightness)
    height, rough, brightness, scatter = (_around(np.where(there, np.take_along_axis(values, np.clip(at, 0, values.shape[1] - 1), 1), np.nan))
                                          for values in (rows.height, rows.rough, unpainted, rows.scatter))
    scatter = known_median(scatter[:, :ROAD_CELLS], 1)[:, None]
    brighter, darker = _off_trend(brightness, scatter)
    usual, most = (_quantile(brighter[:, :ROAD_CELLS], share) / sigmas for share, sigmas in zip(USUAL_QUANTILES, USUAL_SIGMAS))
    off = np.fmax(np.abs(height - known_median(height[:, :ROAD_CELLS], 1)[:, None]) / HEIGHT_SIGMA,
                  np.log(np.maximum(rough, 1e-4) / known_median(rough[:, :ROAD_CELLS], 1)[:, None]) / ROUGH_SIGMA)
    bright = np.where(most < MAX_USUAL_SHARE * scatter, brighter / np.fmax(MIN_SIGMA_SHARE * scatter, usual), 0.0)
    # hardly any ground is darker than asphalt: what is, was scanned from elsewhere. What is unpainted in no row is painted,
    # and paint lies on the road
    off = np.fmax(off, np.where(darker > GROSS_SIGMAS * scatter, OTHER_SIGMAS, bright))
    costs = np.nan_to_num(np.clip(off, 0.0, MAX_SIGMAS) ** 2 - OTHER_SIGMAS ** 2)[:, ROAD_CELLS:] / 2
    # cell by cell outward, the cost of counting all cells before it as road
    total = np.concatenate([np.zeros((len(costs), 1)), np.cumsum(costs, axis=1)], axis=1)
    return _along(total, whole) - INNER_CELLS + change


def _along(total, whole):
    """(P,) cells, of the cheapest path; a change is counted across the road, not along the changing ground."""
    first, last = whole.min(), whole.max()
    fixed = np.full((len(total), last - first + total.shape[1]), 1e3)
    np.put_along_axis(fixed, (whole - first)[:, None] + np.arange(total.shape[1]), total, 1)
    return cheapest_path(fixed, LIMIT_SHIFT_COST, LARGEST_LIMIT_SHIFT_COST) - (whole - first)


def _around(values):
    """Median of every cell over the rows about it."""
    padded = np.pad(values, ((AVERAGED_ROWS, AVERAGED_ROWS), (0, 0)), constant_values=np.nan)
    return known_median(np.lib.stride_tricks.sliding_window_view(padded, 2 * AVERAGED_ROWS + 1, axis=0), 2)


def _off_trend(values, scatter):
    """By how much every cell is off the brightness of the road, continued by its trend across, and darker than the road farther in.

    Median slopes and levels, to which paint does not contribute (Theil and Sen). The level is that of the cells just before.
    Where that differs grossly from the road farther in, they were scanned from elsewhere, and either level may continue.
    """
    road = values[:, :ROAD_CELLS]
    i, j = np.triu_indices(ROAD_CELLS, 4)
    slope = np.nan_to_num(known_median((road[:, j] - road[:, i]) / (j - i), 1))[:, None] * np.arange(values.shape[1])
    level = np.pad(values - slope, ((0, 0), (FARTHEST_BEFORE, 0)), constant_values=np.nan)
    before = np.lib.stride_tricks.sliding_window_view(level, FARTHEST_BEFORE - NEAREST_BEFORE + 1, axis=1)[:, :values.shape[1]]
    off = values - slope
    near, far = known_median(before, 2), known_median(off[:, :ROAD_CELLS], 1)[:, None]
    elsewhere = np.abs(near - far) > GROSS_SIGMAS * scatter
    return np.where(elsewhere, np.fmin(np.abs(off - near), np.abs(off - far)), np.abs(off - near)), far - off


def _painted(rows, change):
    """(P, K) bool, cells in or beside a painted line: brighter than the cells on both sides by far more than single points scatter."""
    brightness = rows.brightness
    road = np.where(np.arange(brightness.shape[1]) < change[:, None], brightness, np.nan)
    above = road - known_median(road, 1)[:, None]
    paint = np.zeros((len(road), 1))
    for first in range(0, len(road), PAINT_ROWS):
        around = above[max(first - PAINT_ROWS // 2, 0):first + PAINT_ROWS + PAINT_ROWS // 2]
        paint[first:first + PAINT_ROWS] = _quantile(around.reshape(1, -1), PAINT_QUANTILE)
    padded = np.pad(brightness, ((0, 0), (max(LINE_CELLS),) * 2), constant_values=np.nan)
    columns = max(LINE_CELLS) + np.arange(brightness.shape[1])
    beside = np.fmin.reduce([np.fmax(padded[:, columns - k], padded[:, columns + k]) for k in LINE_CELLS])
    bright = brightness - beside > np.fmax(MIN_PAINT_SIGMAS * known_median(rows.scatter, 1)[:, None], PAINT_SHARE * paint)
    # a line covers the cells beside it in part
    bright = np.pad(bright, ((0, 0), (1, 1)))
    return bright[:, :-2] | bright[:, 1:-1] | bright[:, 2:]


def _quantile(values, share):
    """(P, 1) quantile of every row without its NaN; NaN where it has nothing else."""
    ordered, count = np.sort(values, axis=1), np.isfinite(values).sum(1)
    return np.take_along_axis(ordered, np.rint(share * np.maximum(count - 1, 0)).astype(np.int64)[:, None], 1)
