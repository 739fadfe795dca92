"""The limit of the pavement in cells along its edge: the cells inside look like the road before them, those outside do not.

Single returns scatter more than gravel and asphalt differ, and a strip of gravel lies as level and smooth as the road. So
rows are averaged along the edge, and height, roughness and brightness of every cell are compared with the course that those of
the road take outward; how much the cells of the road are off it themselves decides how much is too much. Near and far side
differ in nothing but their noise, which follows from the points in a cell. Paint lies on the road.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import median_filter, uniform_filter1d

from ...common.parallel import check_cancelled
from .ground_grid import known_median

if TYPE_CHECKING:
    from .ground_grid import SurfaceProfiles

ROAD_CELLS = 20              # cells of road from which its look is continued: 2 m
INNER_CELLS, OUTER_CELLS = 12, 10  # cells inside and outside the place where the ground changes in which the limit is searched
AVERAGED_ROWS = 3            # rows either side that are averaged: 7 m of road
MIN_SIGMA_SHARE = 0.25       # of the scatter of the brightness of single points that averages differ anyway: texture of asphalt
ROUGH_SIGMA = 0.25           # of the logarithm of roughness, that averages differ anyway within 2 m of road,
NEAR_ROUGH_SIGMA = 0.12      # and from one cell to the next
HEIGHT_SIGMA = 0.008         # m that averages lie off the height of the road anyway
LEVEL_DRIFT = 0.16           # sigmas by which the level of the road changes per cell: half a patch of 1.7 m; a filter of six cells
ROAD_DRIFT = 0.4             # more where there is road for certain: a patch of other asphalt is followed within three cells
VIEW_DRIFT = 1.0             # and more per unit of the logarithm of the density: where that changes, the ground is seen from elsewhere
DENSITY_CELLS, MIN_SEEN_SHARE = 5, 0.7  # cells over which the density is averaged where fewer of the road hold points: scan lines lie 0.3 m apart
MIN_KNOWN_ROWS = 3           # rows with a cell, of which it counts in full
MAX_SIGMAS = 2.8             # sigmas by which any of the three may be off: a cell of other ground weighs as much as one of road
OTHER_SIGMAS = 2.0           # sigmas from which a cell is rather not road
USUAL_QUANTILE, USUAL_SIGMAS = 0.5, 0.67  # quantile of what the cells of the road are off themselves, and its sigmas
PATCH_EDGE_CELLS, PATCH_EDGE_SIGMAS = 3, 5.0  # cells on either side of the edge of a patch that show it, and sigmas by which they differ
MIN_PATCH_ROWS, PATCH_ROWS = 5, 30  # rows about each row of a patch, and rows either side with which it is compared: patches are shorter
MIXED_CELLS = 1              # cells before a limit that may hold other ground in part: rows are averaged
LINE_SIGMAS = 2.0            # by which paint is brighter than the cells on both sides
PAINT_SHARE = 0.5            # of what it is brighter than the darker of them, at least, than the other: what rises once is other ground
LINE_CELLS = 2, 3, 4         # cells from a cell of a line to road on both of its sides: lines are up to 0.3 m wide
CELLS_INSIDE, CELLS_OUTSIDE = 8, 6  # cells beside a limit that show it: an edge line covers four of those inside at most
MAX_GROUND_HEIGHT = 0.25     # m above or below the road, of ground beside it
MIN_GROUND_SHARE = 0.66      # of the measured cells beyond a limit that are ground: those of a wall or a parked car stand higher,
MIN_GROUND_SEEN = 0.34       # and nothing is measured behind them: least share of measured cells, of that of road: over two of six
OWN_ROWS, MIN_MEASURED_SHARE = 1, 0.3  # rows either side in which that ground is measured too, and least share of cells, of that of road
SHOWN_COST = 2.0             # by costs of this sum outside and its negative inside: as much as two sure cells
LIMIT_SHIFT_COST, LARGEST_LIMIT_SHIFT_COST = 5.0, 60.0  # that a change of the limit by a cell, and any change, must save


@dataclass(frozen=True)
class _PavementLimits:
    """Where the pavement ends on P rows of one side.

    cell : (P,) cells, not necessarily whole
    gap : (P,) cells, within which it lies: 1 or more where not every cell was measured
    shown : (P,) bool, whether road before and other ground behind it were measured
    likely : (P,) bool, whether rather so than not
    hidden : (P,) bool, whether hardly anything was measured right behind it, or nothing that tells road from other ground
    """

    cell: np.ndarray
    gap: np.ndarray
    shown: np.ndarray
    likely: np.ndarray
    hidden: np.ndarray


def pavement_limits(rows: SurfaceProfiles, change: np.ndarray) -> _PavementLimits:
    """Where the pavement ends near the change of ground.

    Parameters
    ----------
    rows : SurfaceProfiles of one side, P rows of cells, outward; heights above that of the road
    change : (P,) cells, not necessarily whole, near which the pavement ends

    Returns
    -------
    _PavementLimits
    """
    whole = np.rint(change).astype(np.int64)
    # cells along the edge, so that rows can be averaged where it bends away from the reference line
    at = whole[:, None] + np.arange(-ROAD_CELLS - INNER_CELLS, OUTER_CELLS + CELLS_OUTSIDE)
    there = (at >= 0) & (at < rows.height.shape[1])
    height, rough, brightness, scatter, count = (np.where(there, np.take_along_axis(values, np.clip(at, 0, values.shape[1] - 1), 1), np.nan)
                                                 for values in (rows.height, rows.rough, rows.brightness, rows.scatter, rows.count))
    measured, known = np.isfinite(height), _added(np.isfinite(height), AVERAGED_ROWS)
    seen = _added(np.nan_to_num(count), AVERAGED_ROWS)
    height, rough, brightness, scatter = (_around(values) for values in (height, rough, brightness, scatter))
    share = known_median((scatter / np.maximum(brightness, 1.0))[:, :ROAD_CELLS], 1)[:, None]
    off = _unlike_road(height, np.log(np.maximum(rough, 1e-4)), np.log(np.maximum(brightness, 1.0)), share, seen, at[:, 0])
    own = _added(measured & np.isfinite(off), OWN_ROWS)
    weight = np.minimum(known / MIN_KNOWN_ROWS, 1.0)
    costs = weight * np.nan_to_num(np.clip(off, 0.0, MAX_SIGMAS) ** 2 - OTHER_SIGMAS ** 2) / 2
    # cell by cell outward, the cost of counting all cells before it as road
    total = np.concatenate([np.zeros((len(costs), 1)), np.cumsum(costs[:, ROAD_CELLS:-CELLS_OUTSIDE], axis=1)], axis=1)
    limit = _along(total, whole)
    beside = np.clip(limit, 0, INNER_CELLS + OUTER_CELLS)[:, None] + ROAD_CELLS + np.arange(-CELLS_INSIDE, CELLS_OUTSIDE)
    with np.errstate(invalid="ignore"):
        ground = np.abs(height) < MAX_GROUND_HEIGHT
    costs, known, own, ground = (np.take_along_axis(values, beside, 1) for values in (np.where(ground, costs, 0.0), known, own, ground))
    inside, outside = slice(CELLS_INSIDE), slice(CELLS_INSIDE, None)
    # far away only every third cell may hold a scan line
    usual = known[:, inside].mean(1) / (2 * AVERAGED_ROWS + 1)
    hidden = (own[:, outside].mean(1) / (2 * OWN_ROWS + 1) < MIN_MEASURED_SHARE * usual) | (usual == 0.0)
    costs_inside, costs_outside = costs[:, inside].sum(1), costs[:, outside].sum(1)
    flat, seen = ground[:, outside].mean(1), (known[:, outside] > 0).mean(1)
    goes_on = (flat >= MIN_GROUND_SHARE * seen) & (seen >= MIN_GROUND_SEEN * usual)
    likely = (costs_inside < 0.0) & (costs_outside > 0.0) & ~hidden & goes_on
    shown = likely & (costs_inside <= -SHOWN_COST) & (costs_outside >= SHOWN_COST * usual)
    place, gap = _between_known(limit + ROAD_CELLS, weight)
    place = place + _mixed(limit + ROAD_CELLS, off, weight)
    return _PavementLimits(place - ROAD_CELLS - INNER_CELLS + change, gap, shown, likely, hidden)


def _between_known(limit, weight):
    """(P,) cells, the middle between the last cell before the limit and the first one from it on that count, and how far those are apart."""
    columns = np.arange(weight.shape[1])
    counts = weight > 0
    before = np.where(counts & (columns < limit[:, None]), columns, -1).max(1)
    behind = np.where(counts & (columns >= limit[:, None]), columns, len(columns)).min(1)
    known = (before >= 0) & (behind < len(columns))
    return np.where(known, (before + 1 + behind) / 2, limit), np.where(known, behind - before, 1.0)


def _mixed(limit, off, weight):
    """(P,) cells by which a limit lies farther out than the cells tell: those about it hold road and other ground, and look like a mixture."""
    about = np.clip(limit[:, None] + np.arange(-MIXED_CELLS, 2), 0, off.shape[1] - 1)
    off, every_cell = np.take_along_axis(off, about, 1), (np.take_along_axis(weight, about, 1) > 0).all(1)
    other = np.clip(off[:, :-1] / np.maximum(off[:, -1:], OTHER_SIGMAS), 0.0, 1.0)
    return np.where(every_cell & (off[:, -1] > OTHER_SIGMAS), 1.0 - np.nan_to_num(other).sum(1), 0.0)


def _unlike_road(height, rough, brightness, scatter, seen, first):
    """(P, K) sigmas by which cells differ from the road before them; NaN where nothing tells.

    brightness and roughness are logarithms; `scatter` : (P, 1) of the brightness of single points; `seen` : (P, K) points;
    `first` : (P,) the first cell of each row
    """
    road = np.arange(height.shape[1]) < ROAD_CELLS
    points = np.sqrt(np.maximum(seen, 1.0))
    scatter = np.where(scatter > 0.0, scatter, np.nan)  # one brightness everywhere tells nothing
    brightness, rough_course = _without_slope(brightness), _without_slope(rough)
    sigma = np.hypot(MIN_SIGMA_SHARE * scatter, scatter / points)
    unpainted = np.where(_painted(brightness, sigma), np.nan, brightness)
    bright = _off_course(unpainted, sigma, seen)
    # behind a dark patch, ground as bright as the road before the patch may be road or gravel: the rows about the patch decide
    doubtful = (bright > OTHER_SIGMAS) & (bright < OTHER_SIGMAS + _darker_patch(unpainted, sigma, first) / sigma)
    bright = np.where(doubtful, 0.0, bright)
    rougher = _off_course(rough_course, np.hypot(NEAR_ROUGH_SIGMA, 1.0 / points), seen)
    off = np.fmax(np.abs(height - known_median(height[:, road], 1)[:, None]) / HEIGHT_SIGMA,
                  (rough - known_median(rough[:, road], 1)[:, None]) / ROUGH_SIGMA)
    # hardly any ground is darker than asphalt
    off = np.fmax(off, np.where(bright < 0.0, np.fmin(-bright, OTHER_SIGMAS), bright))
    # of two that are both off by chance the sum is off by one more
    off = np.fmax(off, np.sqrt(np.fmax(np.fmax(rougher, 0.0) ** 2 + np.fmax(bright, 0.0) ** 2 - 1.0, 0.0)))
    return np.where(doubtful & (off < OTHER_SIGMAS), np.nan, off)


def _without_slope(values):
    """Values without the median slope that they have on the road (Theil and Sen), to which paint does not contribute."""
    i, j = np.triu_indices(ROAD_CELLS, 4)
    slope = np.nan_to_num(known_median((values[:, j] - values[:, i]) / (j - i), 1))
    return values - slope[:, None] * np.arange(values.shape[1])


def _darker_patch(values, sigma, first):
    """(P, 1) by how much the road of each row becomes darker at once, as at the edge of a patch; 0 where it does not.

    What it changes by at the same offset all along the road is no patch: there it is seen by another scanner, or from elsewhere.

    values : (P, K) logarithms of brightness, NaN at paint; `sigma` : (P, K) of single cells; `first` : (P,) the first cell of each row
    """
    about = np.lib.stride_tricks.sliding_window_view(values[:, :ROAD_CELLS], 2 * PATCH_EDGE_CELLS, axis=1)
    inner, outer = about[..., :PATCH_EDGE_CELLS], about[..., PATCH_EDGE_CELLS:]
    change = known_median(outer, 2) - known_median(inner, 2)
    # what it loses over as many cells elsewhere is due to range and angle
    change = change - known_median(change, 1)[:, None]
    columns = (first - first.min())[:, None] + np.arange(change.shape[1])
    along, seen = np.zeros((2, len(change), columns.max() + 1))
    np.put_along_axis(along, columns, np.nan_to_num(change), 1)
    np.put_along_axis(seen, columns, np.isfinite(change).astype(float), 1)
    usual = _added(along, PATCH_ROWS) / np.maximum(_added(seen, PATCH_ROWS), 1.0)
    change = change - np.take_along_axis(usual, columns, 1)
    least = PATCH_EDGE_SIGMAS * known_median(sigma[:, :ROAD_CELLS], 1)[:, None]
    sure = (np.isfinite(inner).sum(2) > 1) & (np.isfinite(outer).sum(2) > 1) & (change < -least)
    # a patch is seen on most of the rows about each of its own
    return -median_filter(np.where(sure, change, 0.0).min(1), MIN_PATCH_ROWS, mode="nearest")[:, None]


def _off_course(values, sigma, seen):
    """(P, K) sigmas by which cells are off the course that the cells before them take across the road.

    A level is followed outward cell by cell (a Kalman filter). A cell that is far off moves it no more than one that is hardly
    off, so a metre of other ground stays other ground. Where the density of points changes, ground is seen from elsewhere, and
    the level is less certain.

    values : (P, K), without their slope; `sigma` : (P, K) of single cells; `seen` : (P, K) points
    """
    level = np.nan_to_num(known_median(values[:, :ROAD_CELLS], 1))
    usual = np.sqrt(known_median(sigma[:, :ROAD_CELLS] ** 2, 1))
    every_cell = (seen[:, :ROAD_CELLS] > 0).mean(1, keepdims=True) > MIN_SEEN_SHARE
    density = np.where(every_cell, seen, uniform_filter1d(seen, DENSITY_CELLS, axis=1, mode="nearest"))
    drift = LEVEL_DRIFT + VIEW_DRIFT * np.abs(np.diff(np.log(np.maximum(density, 1.0)), axis=1, prepend=0.0))
    variance, off = usual ** 2, np.empty_like(values)
    for k in range(values.shape[1]):
        variance = variance + ((drift[:, k] + (ROAD_DRIFT if k < ROAD_CELLS else 0.0)) * usual) ** 2
        total = np.sqrt(variance + sigma[:, k] ** 2)
        off[:, k] = (values[:, k] - level) / total
        gain = np.where(np.isfinite(off[:, k]), variance / total ** 2, 0.0)
        # what is on the road for certain is followed wherever it goes
        counted = off[:, k] if k < ROAD_CELLS else np.clip(off[:, k], -OTHER_SIGMAS, OTHER_SIGMAS)
        level = level + gain * np.nan_to_num(counted) * total
        variance = variance * (1.0 - gain)
    return off / np.fmax(1.0, _quantile(np.abs(off[:, :ROAD_CELLS]), USUAL_QUANTILE) / USUAL_SIGMAS)


def _along(total, whole):
    """(P,) cells, of the cheapest path; a change is counted across the road, not along the changing ground."""
    first, last = whole.min(), whole.max()
    fixed = np.full((len(total), last - first + total.shape[1]), 1e3)
    np.put_along_axis(fixed, (whole - first)[:, None] + np.arange(total.shape[1]), total, 1)
    return cheapest_path(fixed, LIMIT_SHIFT_COST, LARGEST_LIMIT_SHIFT_COST) - (whole - first)


def _added(values, reach):
    """Sum of every cell over the rows about it, so many either side."""
    return uniform_filter1d(values.astype(float), 2 * reach + 1, axis=0, mode="constant") * (2 * reach + 1)


def _around(values):
    """Median of every cell over the rows about it."""
    padded = np.pad(values, ((AVERAGED_ROWS, AVERAGED_ROWS), (0, 0)), constant_values=np.nan)
    return known_median(np.lib.stride_tricks.sliding_window_view(padded, 2 * AVERAGED_ROWS + 1, axis=0), 2)


def _painted(brightness, sigma):
    """(P, K) bool, cells in or beside a painted line: brighter than the cells on both sides of it."""
    padded = np.pad(brightness, ((0, 0), (max(LINE_CELLS),) * 2), constant_values=np.nan)
    columns = max(LINE_CELLS) + np.arange(brightness.shape[1])
    one, other = (brightness - np.fmin.reduce([padded[:, columns + sign * k] for k in LINE_CELLS]) for sign in (-1, 1))
    bright = np.minimum(one, other) > np.maximum(LINE_SIGMAS * sigma, PAINT_SHARE * np.maximum(one, other))
    bright = np.pad(bright, ((0, 0), (1, 1)))
    # a line covers the cells beside it in part
    return bright[:, :-2] | bright[:, 1:-1] | bright[:, 2:]


def _quantile(values, share):
    """(P, 1) quantile of every row without its NaN; NaN where it has nothing else."""
    ordered, count = np.sort(values, axis=1), np.isfinite(values).sum(1)
    return np.take_along_axis(ordered, np.rint(share * np.maximum(count - 1, 0)).astype(np.int64)[:, None], 1)


# The path of an edge along the road through what every profile says, by dynamic programming.

def cheapest_path(costs: np.ndarray, cost_per_place: float, largest_change: float) -> np.ndarray:
    """The place on every profile so that the costs of the places and of the changes between profiles are least together.

    A change costs in proportion to its size, so an even widening costs no more than a sudden one, up to a limit, so that a
    street that joins is followed.

    Parameters
    ----------
    costs : (P, K) of each place on each profile
    cost_per_place : of a change by one place from one profile to the next
    largest_change : cost of any larger change

    Returns
    -------
    (P,) indices of places
    """
    count = costs.shape[1]
    places = np.arange(count)
    change = np.minimum(cost_per_place * np.abs(places[:, None] - places), largest_change)
    total, before = costs[0].astype(float), np.zeros(costs.shape, np.int32)
    for k in range(1, len(costs)):
        check_cancelled()
        reached = total[:, None] + change
        before[k] = reached.argmin(axis=0)
        total = reached[before[k], places] + costs[k]
    path = np.empty(len(costs), np.int64)
    path[-1] = total.argmin()
    for k in range(len(costs) - 1, 0, -1):
        path[k - 1] = before[k, path[k]]
    return path
