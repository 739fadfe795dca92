"""The limit of the pavement in cells along its edge: the cells inside look like the road before them, those outside do not.

Single returns scatter more than gravel and asphalt differ, and a strip of gravel lies as level and smooth as the road. So
rows are averaged along the edge, and height, roughness and brightness of every cell are compared with those of the road,
continued by their trend across it; how much the cells of the road differ themselves decides how much is too much. Paint lies
on the road.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .edge_path import cheapest_path
from .ground_grid import known_median

if TYPE_CHECKING:
    from .pavement_edge import SurfaceProfiles

ROAD_CELLS = 20              # cells of road from which its look is continued: 2 m
INNER_CELLS, OUTER_CELLS = 12, 10  # cells inside and outside the place where the ground changes in which the limit is searched
NEAREST_BEFORE, FARTHEST_BEFORE = 2, 6  # cells before a cell from which its look is continued: a strip of gravel may be three cells wide
AVERAGED_ROWS = 3            # rows either side that are averaged: 7 m of road
MIN_SIGMA_SHARE = 0.5        # of the scatter of single points that averages differ anyway: worn and patched asphalt
ROUGH_SIGMA = 0.25           # of the logarithm of roughness, that averages differ anyway within 2 m of road,
NEAR_ROUGH_SIGMA, NEAR_CELLS = 0.12, 10  # and that they differ from those just before; cells of road that tell whether it is more
HEIGHT_SIGMA = 0.008         # m that averages lie off the height of the road anyway
MAX_SIGMAS = 2.8             # sigmas by which any of the three may be off: a cell of other ground weighs as much as one of road
OTHER_SIGMAS = 2.0           # sigmas from which a cell is rather not road
USUAL_QUANTILES, USUAL_SIGMAS = (0.5, 0.75), (0.67, 1.15)  # quantiles of what the cells of the road are off themselves, and their sigmas
PAINT_QUANTILE, PAINT_ROWS = 0.98, 25  # of the cells of road of so many rows: lines cover a few per cent of a road
MIN_PAINT_SIGMAS = 2.0       # scatters of single points by which paint is brighter than the cells beside it,
PAINT_SHARE = 0.5            # and this share of the contrast of the paint on this side
MAX_USUAL_SHARE = 2.0        # times that scatter, of the upper quantile, beyond which brightness says nothing: the road was scanned from two sides
GROSS_SIGMAS = 3.0           # of that scatter
ELSEWHERE_QUANTILE = 0.75    # of the brightness of the road, that tells what is grossly darker
LINE_CELLS = 2, 3, 4         # cells from a cell of a line to road on both of its sides: lines are up to 0.3 m wide
CELLS_INSIDE, CELLS_OUTSIDE = 8, 4  # cells beside a limit that show it: an edge line covers four of those inside at most,
GROUND_CELLS, MIN_GROUND_CELLS = 6, 4  # cells beyond a limit, and how many of them are ground: behind a wall or a parked car none is
MAX_GROUND_HEIGHT = 0.25     # m above or below the road, of ground beside it
MIN_MEASURED_CELLS = 2       # of those outside; with fewer what lies there is hidden
SHOWN_COST = 2.0             # by costs of this sum outside and its negative inside: as much as two sure cells
LIMIT_SHIFT_COST, LARGEST_LIMIT_SHIFT_COST = 5.0, 60.0  # that a change of the limit by a cell, and any change, must save


@dataclass(frozen=True)
class PavementLimits:
    """Where the pavement ends on P rows of one side.

    cell : (P,) cells, not necessarily whole
    shown : (P,) bool, whether road before and other ground behind it were measured
    likely : (P,) bool, whether rather so than not
    hidden : (P,) bool, whether hardly anything was measured right behind it
    """

    cell: np.ndarray
    shown: np.ndarray
    likely: np.ndarray
    hidden: np.ndarray


def pavement_limits(rows: SurfaceProfiles, change: np.ndarray) -> PavementLimits:
    """Where the pavement ends near the change of ground.

    Parameters
    ----------
    rows : SurfaceProfiles of one side, P rows of cells, outward; heights above that of the road
    change : (P,) cells, not necessarily whole, near which the pavement ends

    Returns
    -------
    PavementLimits
    """
    whole = np.rint(change).astype(np.int64)
    # cells along the edge, so that rows can be averaged where it bends away from the reference line
    at = whole[:, None] + np.arange(-ROAD_CELLS - INNER_CELLS, OUTER_CELLS + GROUND_CELLS)
    there = (at >= 0) & (at < rows.height.shape[1])
    unpainted = np.where(_painted(rows, change), np.nan, rows.brightness)
    height, rough, brightness, scatter = (_around(np.where(there, np.take_along_axis(values, np.clip(at, 0, values.shape[1] - 1), 1), np.nan))
                                          for values in (rows.height, rows.rough, unpainted, rows.scatter))
    off, measured = _unlike_road(height, rough, brightness, known_median(scatter[:, :ROAD_CELLS], 1)[:, None])
    costs = np.where(measured, np.nan_to_num(np.clip(off, 0.0, MAX_SIGMAS) ** 2 - OTHER_SIGMAS ** 2), 0.0) / 2
    # cell by cell outward, the cost of counting all cells before it as road
    total = np.concatenate([np.zeros((len(costs), 1)), np.cumsum(costs[:, ROAD_CELLS:-GROUND_CELLS], axis=1)], axis=1)
    limit = _along(total, whole)
    beside = np.clip(limit, 0, INNER_CELLS + OUTER_CELLS)[:, None] + ROAD_CELLS + np.arange(-CELLS_INSIDE, GROUND_CELLS)
    with np.errstate(invalid="ignore"):
        ground = np.take_along_axis(np.abs(height) < MAX_GROUND_HEIGHT, beside, 1)
    near, beside = (values[:, :CELLS_INSIDE + CELLS_OUTSIDE] for values in (np.where(ground, np.take_along_axis(costs, beside, 1), 0.0), beside))
    goes_on = ground[:, CELLS_INSIDE:].sum(1) >= MIN_GROUND_CELLS
    # in the row itself, not in the average
    place = np.clip(np.take_along_axis(at, beside[:, CELLS_INSIDE:], 1), 0, rows.height.shape[1] - 1)
    known = np.isfinite(np.take_along_axis(rows.height, place, 1)).sum(1)
    inside, outside = near[:, :CELLS_INSIDE].sum(1), near[:, CELLS_INSIDE:].sum(1)
    likely = (inside < 0.0) & (outside > 0.0) & (known > 0) & goes_on
    return PavementLimits(limit - INNER_CELLS + change, likely & (inside <= -SHOWN_COST) & (outside >= SHOWN_COST), likely,
                          known < MIN_MEASURED_CELLS)


def _unlike_road(height, rough, brightness, scatter):
    """(P, K) sigmas by which cells differ from the road before them, and whether they were measured."""
    road = np.arange(height.shape[1]) < ROAD_CELLS
    # what is grossly darker than the road was scanned from elsewhere, such as the strip beside the vehicle that the scanner hardly sees
    elsewhere = (_quantile(brightness[:, road], ELSEWHERE_QUANTILE) - brightness > GROSS_SIGMAS * scatter) \
        & (np.arange(height.shape[1]) < ROAD_CELLS + INNER_CELLS)
    rough, brightness = (np.where(elsewhere, np.nan, values) for values in (np.log(np.maximum(rough, 1e-4)), brightness))
    brighter, near_brighter, darker = _off_trend(brightness, scatter)
    usual, most = (_quantile(brighter[:, road], share) / sigmas for share, sigmas in zip(USUAL_QUANTILES, USUAL_SIGMAS))
    sigma = np.fmax(MIN_SIGMA_SHARE * scatter, usual)
    bright = np.where(most < MAX_USUAL_SHARE * scatter, brighter / sigma, 0.0)
    rougher = _before(rough)[0]
    usual = _quantile(np.abs(rougher[:, ROAD_CELLS - NEAR_CELLS:ROAD_CELLS]), USUAL_QUANTILES[0]) / USUAL_SIGMAS[0]
    # verge is rougher and brighter; what is rougher and darker was scanned from elsewhere
    rougher = np.where(near_brighter < -sigma, 0.0, rougher / np.fmax(NEAR_ROUGH_SIGMA, usual))
    off = np.fmax(np.abs(height - known_median(height[:, road], 1)[:, None]) / HEIGHT_SIGMA,
                  (rough - known_median(rough[:, road], 1)[:, None]) / ROUGH_SIGMA)
    # hardly any ground is darker than asphalt: what is, was scanned from elsewhere. What is unpainted in no row is painted,
    # and paint lies on the road
    off = np.fmax(off, np.where(darker > GROSS_SIGMAS * scatter, OTHER_SIGMAS, bright))
    # of two that are both off by chance the sum is off by one more
    off = np.fmax(off, np.sqrt(np.fmax(np.fmax(rougher, 0.0) ** 2 + np.fmax(bright, 0.0) ** 2 - 1.0, 0.0)))
    return off, np.isfinite(height)


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


def _before(values):
    """By how much every cell is off the values just before it, continued by their trend across, and off the trend alone.

    Median slopes and levels, to which paint does not contribute (Theil and Sen).
    """
    road = values[:, :ROAD_CELLS]
    i, j = np.triu_indices(ROAD_CELLS, 4)
    off = values - np.nan_to_num(known_median((road[:, j] - road[:, i]) / (j - i), 1))[:, None] * np.arange(values.shape[1])
    level = np.pad(off, ((0, 0), (FARTHEST_BEFORE, 0)), constant_values=np.nan)
    before = np.lib.stride_tricks.sliding_window_view(level, FARTHEST_BEFORE - NEAREST_BEFORE + 1, axis=1)[:, :values.shape[1]]
    return off - known_median(before, 2), off


def _off_trend(values, scatter):
    """By how much every cell is off the brightness of the road, brighter than the cells before it, and darker than the road farther in.

    The level of the road is that of the cells just before. Where that differs grossly from the road farther in, they were
    scanned from elsewhere, and either level may continue.
    """
    nearer, off = _before(values)
    far = known_median(off[:, :ROAD_CELLS], 1)[:, None]
    elsewhere = np.abs(off - nearer - far) > GROSS_SIGMAS * scatter
    return np.where(elsewhere, np.fmin(np.abs(nearer), np.abs(off - far)), np.abs(nearer)), nearer, far - off


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
