"""The limit of the pavement in cells along its edge: the cells inside look like the road before them, those outside do not.

Single returns scatter more than gravel and asphalt differ, and a strip of gravel lies as level and smooth as the road. So
rows are averaged along the edge, and height, roughness and brightness of every cell are compared with the course that those of
the road take outward; how much the cells of the road are off it themselves decides how much is too much. Near and far side
differ in nothing but their noise, which follows from the points in a cell. Paint lies on the road.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.ndimage import median_filter, uniform_filter1d

from ...common.parallel import check_cancelled
from ...curves.robust import MAD_TO_SIGMA
from ..weights import SURFACE
from .ground_grid import SurfaceProfiles, known_median, median_about, roughness_of_rows, sum_about


@dataclass(frozen=True)
class _PavementLimits:
    """Where the pavement ends on P rows of one side."""

    cell: np.ndarray   # (P,) cells, not necessarily whole
    gap: np.ndarray   # (P,) cells, within which it lies: 1 or more where not every cell was measured
    shown: np.ndarray   # (P,) bool, whether road before and other ground behind it were measured
    likely: np.ndarray   # (P,) bool, whether rather so than not
    hidden: np.ndarray   # (P,) bool, whether hardly anything was measured right behind it, or nothing that tells road from other ground
    look: np.ndarray   # (P,) bool, whether rather so than not by roughness and brightness alone: a verge may be as high as the road


def pavement_limits(rows: SurfaceProfiles, change: np.ndarray) -> _PavementLimits:
    """Where the pavement ends near the change of ground.

    rows : SurfaceProfiles of one side, P rows of cells, outward; heights above that of the road
    change : (P,) cells, not necessarily whole, near which the pavement ends

    Returns _PavementLimits
    """
    change_cell = np.rint(change).astype(np.int64)
    # cells along the edge, so that rows can be averaged where it bends away from the reference line
    cells = change_cell[:, None] + np.arange(-SURFACE.road_cells - SURFACE.inner_cells, SURFACE.outer_cells + SURFACE.cells_outside)
    inside_profile = (cells >= 0) & (cells < rows.height.shape[1])
    height, rough, brightness, scatter, count, freedom = (np.where(inside_profile,
                                                          np.take_along_axis(values, np.clip(cells, 0, values.shape[1] - 1), 1), np.nan)
                                                 for values in (rows.height, rows.rough, rows.brightness, rows.scatter, rows.count, rows.freedom))
    measured, measured_rows = np.isfinite(height), sum_about(np.isfinite(height), SURFACE.averaged_rows)
    coverage = sum_about(np.nan_to_num(count), SURFACE.averaged_rows)
    about, total = (partial(over, reach=SURFACE.averaged_rows) for over in (median_about, sum_about))
    height, brightness, scatter, rough = *map(about, (height, brightness, scatter)), roughness_of_rows(rough, freedom, about, total)
    share = known_median((scatter / np.maximum(brightness, 1.0))[:, :SURFACE.road_cells], 1)[:, None]
    off, look = _unlike_road(height, np.log(np.maximum(rough, 1e-4)), np.log(np.maximum(brightness, 1.0)), share, coverage, cells[:, 0])
    own_rows = sum_about(measured & np.isfinite(off), SURFACE.own_rows)
    weight = np.minimum(measured_rows / SURFACE.min_known_rows, 1.0)
    costs, look = (weight * np.nan_to_num(np.clip(sigmas, 0.0, SURFACE.max_sigmas) ** 2 - SURFACE.other_sigmas ** 2) / 2 for sigmas in (off, look))
    # cell by cell outward, the cost of counting all cells before it as road
    total = np.concatenate([np.zeros((len(costs), 1)), np.cumsum(costs[:, SURFACE.road_cells:-SURFACE.cells_outside], axis=1)], axis=1)
    limit = _along(total, change_cell)
    window = SURFACE.road_cells + np.arange(-SURFACE.cells_inside, SURFACE.cells_outside)
    window = np.clip(limit, 0, SURFACE.inner_cells + SURFACE.outer_cells)[:, None] + window
    ground = np.abs(height) < SURFACE.max_ground_height
    costs, look, measured_rows, own_rows, ground = (np.take_along_axis(values, window, 1) for values in (
        np.where(ground, costs, 0.0), look, measured_rows, own_rows, ground))
    inside, outside = slice(SURFACE.cells_inside), slice(SURFACE.cells_inside, None)
    # far away only every third cell may hold a scan line
    usual = measured_rows[:, inside].mean(1) / (2 * SURFACE.averaged_rows + 1)
    hidden = (own_rows[:, outside].mean(1) / (2 * SURFACE.own_rows + 1) < SURFACE.min_measured_share * usual) | (usual == 0.0)
    costs_inside, costs_outside = costs[:, inside].sum(1), costs[:, outside].sum(1)
    flat, coverage = ground[:, outside].mean(1), (measured_rows[:, outside] > 0).mean(1)
    goes_on = (flat >= SURFACE.min_ground_share * coverage) & (coverage >= SURFACE.min_ground_seen * usual)
    likely = (costs_inside < 0.0) & (costs_outside > 0.0) & ~hidden & goes_on
    shown = likely & (costs_inside <= -SURFACE.shown_cost) & (costs_outside >= SURFACE.shown_cost * usual)
    cell, gap = _between_known(limit + SURFACE.road_cells, weight)
    cell = cell + _mixed(limit + SURFACE.road_cells, off, weight)
    return _PavementLimits(cell - SURFACE.road_cells - SURFACE.inner_cells + change, gap, shown, likely, hidden,
                           look[:, outside].sum(1) > 0.0)


def _between_known(limit, weight):
    """(P,) cells, the middle between the last cell before the limit and the first one from it on that count, and how far those are apart."""
    columns = np.arange(weight.shape[1])
    counts = weight > 0
    before = np.where(counts & (columns < limit[:, None]), columns, -1).max(1)
    behind = np.where(counts & (columns >= limit[:, None]), columns, len(columns)).min(1)
    enclosed = (before >= 0) & (behind < len(columns))
    return np.where(enclosed, (before + 1 + behind) / 2, limit), np.where(enclosed, behind - before, 1.0)


def _mixed(limit, off, weight):
    """(P,) cells by which a limit lies farther out than the cells tell: those about it hold road and other ground, and look like a mixture."""
    window = np.clip(limit[:, None] + np.arange(-SURFACE.mixed_cells, 2), 0, off.shape[1] - 1)
    # cells of road alone are off by their noise
    usual = known_median(off[:, :SURFACE.road_cells], 1)[:, None]
    off, every_cell = np.take_along_axis(off, window, 1), (np.take_along_axis(weight, window, 1) > 0).all(1)
    other = off[:, -1] > SURFACE.other_sigmas
    with np.errstate(invalid="ignore", divide="ignore"):
        shares = np.clip((off[:, :-1] - usual) / (off[:, -1:] - usual), 0.0, 1.0)
    return np.where(every_cell & other, 1.0 - np.nan_to_num(shares).sum(1), 0.0)


def _unlike_road(height, rough, brightness, scatter, seen, first):
    """(P, K) sigmas by which cells differ from the road before them, in all and but for their height; NaN where nothing tells.

    brightness and roughness are logarithms; `scatter` : (P, 1) of the brightness of single points; `seen` : (P, K) points;
    `first` : (P,) the first cell of each row
    """
    road = np.arange(height.shape[1]) < SURFACE.road_cells
    points = np.sqrt(np.maximum(seen, 1.0))
    scatter = np.where(scatter > 0.0, scatter, np.nan)  # one brightness everywhere tells nothing
    brightness, rough_course = _without_slope(brightness), _without_slope(rough)
    sigma = np.hypot(SURFACE.min_sigma_share * scatter, scatter / points)
    unpainted = np.where(_painted(brightness, sigma), np.nan, brightness)
    bright = _off_course(unpainted, sigma, seen)
    # behind a dark patch, ground as bright as the road before the patch may be road or gravel: the rows about the patch decide
    doubtful = (bright > SURFACE.other_sigmas) & (bright < SURFACE.other_sigmas + _darker_patch(unpainted, sigma, first) / sigma)
    bright = np.where(doubtful, 0.0, bright)
    rough_sigma, above_road = np.hypot(SURFACE.near_rough_sigma, 1.0 / points), rough - known_median(rough[:, road], 1)[:, None]
    # behind a strip with few points, which looks smooth, the road is as rough as before it again
    rougher = np.minimum(_off_course(rough_course, rough_sigma, seen), np.maximum(above_road, 0.0) / rough_sigma)
    # hardly any ground is darker than asphalt
    look = np.fmax(above_road / SURFACE.rough_sigma, np.where(bright < 0.0, np.fmin(-bright, SURFACE.other_sigmas), bright))
    # of two that are both off by chance the sum is off by one more
    look = np.fmax(look, np.sqrt(np.fmax(np.fmax(rougher, 0.0) ** 2 + np.fmax(bright, 0.0) ** 2 - 1.0, 0.0)))
    off = np.fmax(np.abs(height - known_median(height[:, road], 1)[:, None]) / SURFACE.height_sigma, look)
    return np.where(doubtful & (off < SURFACE.other_sigmas), np.nan, off), look


def _without_slope(values):
    """Values without the median slope that they have on the road (Theil and Sen), to which paint does not contribute."""
    i, j = np.triu_indices(SURFACE.road_cells, 4)
    slope = np.nan_to_num(known_median((values[:, j] - values[:, i]) / (j - i), 1))
    return values - slope[:, None] * np.arange(values.shape[1])


def _darker_patch(values, sigma, first):
    """(P, 1) by how much the road of each row becomes darker at once, as at the edge of a patch; 0 where it does not.

    What it changes by at the same offset all along the road is no patch: there it is seen by another scanner, or from elsewhere.

    values : (P, K) logarithms of brightness, NaN at paint; `sigma` : (P, K) of single cells; `first` : (P,) the first cell of each row
    """
    windows = np.lib.stride_tricks.sliding_window_view(values[:, :SURFACE.road_cells], 2 * SURFACE.patch_edge_cells, axis=1)
    inner, outer = windows[..., :SURFACE.patch_edge_cells], windows[..., SURFACE.patch_edge_cells:]
    change = known_median(outer, 2) - known_median(inner, 2)
    # what it loses over as many cells elsewhere is due to range and angle
    change = change - known_median(change, 1)[:, None]
    columns = (first - first.min())[:, None] + np.arange(change.shape[1])
    along, measured = np.zeros((2, len(change), columns.max() + 1))
    np.put_along_axis(along, columns, np.nan_to_num(change), 1)
    np.put_along_axis(measured, columns, np.isfinite(change).astype(float), 1)
    usual = sum_about(along, SURFACE.patch_rows) / np.maximum(sum_about(measured, SURFACE.patch_rows), 1.0)
    change = change - np.take_along_axis(usual, columns, 1)
    least = SURFACE.patch_edge_sigmas * known_median(sigma[:, :SURFACE.road_cells], 1)[:, None]
    sure = (np.isfinite(inner).sum(2) > 1) & (np.isfinite(outer).sum(2) > 1) & (change < -least)
    # a patch is seen on most of the rows about each of its own
    return -median_filter(np.where(sure, change, 0.0).min(1), SURFACE.min_patch_rows, mode="nearest")[:, None]


def _off_course(values, sigma, seen):
    """(P, K) sigmas by which cells are off the course that the cells before them take across the road.

    A level is followed outward cell by cell (a Kalman filter). A cell that is far off moves it no more than one that is hardly off, so a metre of
    other ground stays other ground. Where the density of points changes, ground is seen from elsewhere, and the level is less certain.

    values : (P, K), without their slope; `sigma` : (P, K) of single cells; `seen` : (P, K) points
    """
    level = np.nan_to_num(known_median(values[:, :SURFACE.road_cells], 1))
    usual = np.sqrt(known_median(sigma[:, :SURFACE.road_cells] ** 2, 1))
    every_cell = (seen[:, :SURFACE.road_cells] > 0).mean(1, keepdims=True) > SURFACE.min_seen_share
    density = np.where(every_cell, seen, uniform_filter1d(seen, SURFACE.density_cells, axis=1, mode="nearest"))
    drift = SURFACE.level_drift + SURFACE.view_drift * np.abs(np.diff(np.log(np.maximum(density, 1.0)), axis=1, prepend=0.0))
    variance, off = usual ** 2, np.empty_like(values)
    for k in range(values.shape[1]):
        variance = variance + ((drift[:, k] + (SURFACE.road_drift if k < SURFACE.road_cells else 0.0)) * usual) ** 2
        total = np.sqrt(variance + sigma[:, k] ** 2)
        off[:, k] = (values[:, k] - level) / total
        gain = np.where(np.isfinite(off[:, k]), variance / total ** 2, 0.0)
        # what is on the road for certain is followed wherever it goes
        counted = off[:, k] if k < SURFACE.road_cells else np.clip(off[:, k], -SURFACE.other_sigmas, SURFACE.other_sigmas)
        level = level + gain * np.nan_to_num(counted) * total
        variance = variance * (1.0 - gain)
    return off / np.fmax(1.0, MAD_TO_SIGMA * known_median(np.abs(off[:, :SURFACE.road_cells]), 1)[:, None])


def _along(total, whole):
    """(P,) cells, of the cheapest path; a change is counted across the road, not along the changing ground."""
    first, last = whole.min(), whole.max()
    fixed = np.full((len(total), last - first + total.shape[1]), 1e3)
    np.put_along_axis(fixed, (whole - first)[:, None] + np.arange(total.shape[1]), total, 1)
    return cheapest_path(fixed, SURFACE.limit_shift_cost, SURFACE.largest_limit_shift_cost) - (whole - first)


def _painted(brightness, sigma):
    """(P, K) bool, cells in or beside a painted line: brighter than the cells on both sides of it."""
    padded = np.pad(brightness, ((0, 0), (max(SURFACE.line_cells),) * 2), constant_values=np.nan)
    columns = max(SURFACE.line_cells) + np.arange(brightness.shape[1])
    inward, outward = (brightness - np.fmin.reduce([padded[:, columns + sign * k] for k in SURFACE.line_cells]) for sign in (-1, 1))
    bright = np.minimum(inward, outward) > np.maximum(SURFACE.line_sigmas * sigma, SURFACE.paint_share * np.maximum(inward, outward))
    bright = np.pad(bright, ((0, 0), (1, 1)))
    # a line covers the cells beside it in part
    return bright[:, :-2] | bright[:, 1:-1] | bright[:, 2:]


# The path of an edge along the road through what every profile says, by dynamic programming.

def cheapest_path(costs: np.ndarray, cost_per_place: float, largest_change: float) -> np.ndarray:
    """The place on every profile so that the costs of the places and of the changes between profiles are least together.

    A change costs in proportion to its size, so an even widening costs no more than a sudden one, up to a limit, so that a
    street that joins is followed.

    costs : (P, K) of each place on each profile
    cost_per_place : of a change by one place from one profile to the next
    largest_change : cost of any larger change

    Returns (P,) indices of places
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
