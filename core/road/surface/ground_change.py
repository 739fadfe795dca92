"""Where the ground across the road changes: the first cell outward that is no longer like the road before it.

The ground changes where, over some cells, it is off the height of the road, tilts away, or is rougher than the road before, or where nothing was
measured and no road follows. A flush sidewalk or bicycle path before such a place changes in brightness alone: paving and concrete are about twice as
bright as asphalt. Falloff with range has no step, painted lines are narrower than what is compared, and patches are shorter. The rules are our own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d, median_filter, uniform_filter1d

from ...common.parallel import by_rows, check_cancelled
from ..weights import SURFACE
from .ground_grid import GroundCells, MeasuredGround, known_median


@dataclass
class HalfProfiles:
    """P profiles of K cells from the reference line outward."""

    u: np.ndarray   # (K,) m, outward offsets of the middles of the cells, ascending
    off: np.ndarray   # (P, K) m above the height of the road; NaN where nothing was measured, or an obstacle hides the road
    rough: np.ndarray   # (P, K) m

    def __post_init__(self) -> None:
        """Cells of obstacles are no ground."""
        low = np.isfinite(self.off) & (np.abs(self.off) < SURFACE.max_height_deviation)
        follows = _ahead(np.pad(low, ((0, 0), (0, 1)))[:, 1:], SURFACE.obstacle_cells, fill=False).any(axis=2)
        self.off = np.where((self.off > SURFACE.obstacle_height) & follows, np.nan, self.off)

    def changes(self, beside: np.ndarray, max_width: float) -> np.ndarray:
        """(P,) int, the first cell of other ground, or the one at the largest width; -1 where nothing was measured before it.

        beside : (P,) m, outward offset of the track
        max_width : m from the track
        """
        start = np.searchsorted(self.u, beside + SURFACE.certain_road)
        stop = np.searchsorted(self.u, beside + max_width)
        empty = self.blind()
        cells = np.empty(len(self.off), np.int64)
        for first in range(0, len(cells), SURFACE.profiles_per_batch):
            check_cancelled()
            part = slice(first, first + SURFACE.profiles_per_batch)
            uneven = _unevenness(self.off[part], np.maximum(start[part], SURFACE.cells_of_unevenness))
            differs = _differs(self.u, self.off[part], self.rough[part], uneven)
            for k in range(len(uneven)):
                profile = first + k
                cells[profile] = self._change(profile, int(start[profile]), int(stop[profile]), empty[profile], differs[k], float(uneven[k]))
        return cells

    def blind(self) -> np.ndarray:
        """(P, K) bool, whether nothing was measured in the cells from a cell on."""
        return ~_ahead(np.isfinite(self.off), SURFACE.max_empty_ground_cells, fill=False).any(axis=2)

    def _change(self, profile, start, stop, empty, differs, uneven):
        """The change of one profile between two cells."""
        if not np.isfinite(self.off[profile, :stop]).any():
            return -1
        changed = np.flatnonzero(differs[start:stop])
        last = start + int(changed[0]) if len(changed) else stop
        blind = start
        for k in (start + np.flatnonzero(empty[start:min(last + 1, stop)])).tolist():
            if k >= blind:
                blind = self._road_behind(profile, k, uneven)
                if not blind:
                    return k
        return last

    def _road_behind(self, profile, k, uneven):
        """The first cell behind a blind zone that begins at cell k, or 0 where no road follows.

        The ground behind must be at the height of the road and as smooth. Its brightness is not compared, because it was
        measured in another part of the scanner's turn.
        """
        off, rough = self.off[profile], self.rough[profile]
        measured = np.flatnonzero(np.isfinite(off[k:k + SURFACE.max_blind_cells + 1]))
        if not len(measured):
            return 0
        resumed = k + int(measured[0])
        behind, inner = slice(resumed, resumed + 2 * SURFACE.min_change_cells), slice(max(k - SURFACE.cells_before_blind, 0), k)
        if np.isfinite(off[behind]).mean() < SURFACE.min_measured_behind \
                or (np.abs(off[behind]) > SURFACE.max_height_deviation + SURFACE.unevenness_factor * uneven).any():
            return 0
        smooth = known_median(rough[behind], 0) <= SURFACE.roughness_factor * known_median(rough[inner], 0) + SURFACE.roughness_floor
        return resumed if smooth else 0


def _ahead(values, count, fill=np.nan):
    """(P, K, count) the cells from each cell on; `fill` beyond the end."""
    return np.lib.stride_tricks.sliding_window_view(np.pad(values, ((0, 0), (0, count - 1)), constant_values=fill), count, axis=1)


def _before(values, count):
    """(P, K, count) the cells before each cell; NaN before the first."""
    return np.lib.stride_tricks.sliding_window_view(np.pad(values, ((0, 0), (count, 0)), constant_values=np.nan), count, axis=1)[:, :-1]


def _unevenness(off, cells):
    """(P,) m, median step between neighbouring ones of the first cells."""
    step = np.abs(np.diff(off, axis=1))
    return np.nan_to_num(known_median(np.where(np.arange(step.shape[1]) < cells[:, None] - 1, step, np.nan), 1))


def _differs(u, off, rough, uneven):
    """(P, K) bool, whether the ground from a cell on is no longer that of the road."""
    ahead, before = _ahead(off, SURFACE.min_change_cells), _before(off, SURFACE.min_change_cells)
    measured = np.isfinite(ahead)
    count = measured.sum(axis=2)
    slack = SURFACE.unevenness_factor * uneven[:, None]
    deviates = np.abs(ahead) > SURFACE.max_height_deviation + slack[..., None]
    high = (count > 1) & deviates[..., 0] & (deviates.sum(axis=2) > SURFACE.min_agreeing_share * count)
    # the step may cut the first cell that was measured
    stepped = (np.abs(ahead - known_median(before, 2)[..., None]) > SURFACE.max_height_change + slack[..., None]) \
        | ~measured | (np.cumsum(measured, axis=2) == 1)
    step = (count > 2) & (np.isfinite(before).sum(axis=2) > 2) & stepped.all(axis=2)
    rough_ahead, usual = _ahead(rough, SURFACE.min_change_cells), _before(rough, SURFACE.cells_of_roughness)
    rougher = rough_ahead > (SURFACE.roughness_factor * known_median(usual, 2) + SURFACE.roughness_floor)[..., None]
    rough_count = np.isfinite(rough_ahead).sum(axis=2)
    rugged = (rough_count > 1) & (np.isfinite(usual).sum(axis=2) > 3) & rougher[..., 0] \
        & (rougher.sum(axis=2) > SURFACE.min_agreeing_share * rough_count)
    return high | step | rugged | _turns(u, off, slack)


def _turns(u, off, slack):
    """(P, K) bool, whether the ground from a cell on tilts away from the metre before."""
    # cells are of one width, so places are counted from the cell itself
    size = u[1] - u[0]
    after, inner = _ahead(off, SURFACE.cells_of_tilt[1]), _before(off, SURFACE.cells_of_tilt[0])
    at_after, at_inner = np.arange(SURFACE.cells_of_tilt[1]) * size, np.arange(-SURFACE.cells_of_tilt[0], 0) * size
    a, b = np.isfinite(after), np.isfinite(inner)
    level, slope = _lines(at_inner, inner, b)
    rise = np.where(a, after - level[..., None] - slope[..., None] * at_after, np.nan)
    _, tilt = _lines(at_after, rise, a)
    # most cells, not a single one beside an obstacle
    typical = known_median(rise / (at_after + 0.5 * size), 2)
    # the bank may begin farther out
    begins = np.abs(rise[..., 0]) >= 0.5 * SURFACE.min_tilt_change * size + slack
    return (b.sum(axis=2) >= SURFACE.min_cells_of_tilt[0]) & (a.sum(axis=2) >= SURFACE.min_cells_of_tilt[1]) & a[..., 0] & begins \
        & (np.minimum(np.abs(typical), np.abs(tilt)) > SURFACE.min_tilt_change)


def _lines(at, values, known):
    """Level at 0 and slope of the straight lines of least squares through the known ones of values at (N,) places."""
    count = np.maximum(known.sum(axis=2), 1)
    values = np.where(known, values, 0.0)
    middle, mean = (known * at).sum(axis=2) / count, values.sum(axis=2) / count
    offset = known * (at - middle[..., None])
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = (offset * values).sum(axis=2) / (offset * at).sum(axis=2)
    return mean - slope * middle, slope


def other_ground_begins(brightness: np.ndarray, track: np.ndarray, limit: np.ndarray) -> np.ndarray:
    """Where brighter ground begins between the vehicle and the limit of the road, and goes on as far as that.

    A narrower strip along the limit than `pavement_limits` searches is left to it.

    brightness : (P, K) counts, profiles of cells outward
    track : (P,) cells, not necessarily whole, of the vehicle's track
    limit : (P,) cells, not necessarily whole, at which the ground changes

    Returns (P,) cells; NaN where there is no such ground
    """
    begins, step, step_at_limit = by_rows(lambda some: _brighter_from(brightness[some], track[some], limit[some]), len(brightness)).T
    brighter, lasts = begins >= 0, step_at_limit >= SURFACE.lasting_share * step
    holds = np.flatnonzero(brighter & lasts)
    if not len(holds):
        return np.full(len(begins), np.nan)
    # a single profile tells little of how far a strip goes on, which has dark patches and fades with range, but where it begins
    course = median_filter(np.interp(np.arange(len(begins)), holds, begins[holds]), SURFACE.agreeing_profiles, mode="nearest")
    alike = brighter & (np.abs(begins - course) <= SURFACE.max_strip_shift)
    share, lasting_share = (uniform_filter1d(rows.astype(float), SURFACE.lasting_profiles, mode="reflect") for rows in (alike, alike & lasts))
    return np.where(alike & (share > 0.5) & (lasting_share >= 0.5 * share), course, np.nan)


def _brighter_from(brightness, track, limit):
    """(P, 3) of each profile by itself: the cell from which on the ground is brighter, or -1, by how much, and by how much still at the limit.

    The latter two are logarithms; NaN where nothing is brighter.
    """
    count = brightness.shape[1]
    level = np.log(np.maximum(brightness, 1.0))
    padded = np.pad(level, ((0, 0), (SURFACE.compared_cells, SURFACE.compared_cells)), constant_values=np.nan)
    medians = known_median(np.lib.stride_tricks.sliding_window_view(padded, SURFACE.compared_cells, axis=1), 2)
    # median of the cells before each cell, and of those from it on
    inner, outer = medians[:, :count], medians[:, SURFACE.compared_cells:SURFACE.compared_cells + count]
    cell = np.arange(count)
    # medians rise half a window before the step itself
    between = (cell >= track[:, None]) & (cell + SURFACE.compared_cells // 2 + SURFACE.inner_cells < limit[:, None])
    step = np.where(between & np.isfinite(outer - inner), outer - inner, -np.inf)
    rows, begins = np.arange(len(step)), step.argmax(axis=1)
    last = medians[rows, np.clip(np.rint(limit).astype(np.int64), 0, count)]
    brighter = step[rows, begins] >= SURFACE.brighter
    step_at_limit = np.where(brighter, last - inner[rows, begins], np.nan)
    return np.c_[np.where(brighter, begins, -1), np.where(brighter, step[rows, begins], np.nan), step_at_limit]


# The height of the road, followed outward from the track of the vehicle, cell by cell.


@dataclass
class _RoadHeight:
    """The height of a road on a grid of R rows and C columns."""

    height: np.ndarray   # (R, C) float32 m, local z of the road, also under obstacles
    ground: np.ndarray   # (R, C) bool, cells that show the road itself
    noise: float   # m, median standard deviation of the points of a cell


def follow_road(cells: GroundCells, prior: np.ndarray) -> _RoadHeight | None:
    """Follow the road outward from the reference line, column by column.

    Each column is predicted from the height and the tilt of the one before it. Cells near the prediction belong to the
    road and correct height and tilt. Other cells (a car, an island, no ground) are skipped, and the prediction is
    continued. Corrections are averaged over neighbouring rows. The method is our own.

    cells : GroundCells of a road, R rows
    prior : (R,) m, local z of the road under the vehicle, accurate to decimetres

    Returns _RoadHeight, or None where no ground was measured near the track
    """
    offsets = cells.offsets
    track = np.abs(offsets) < SURFACE.track_half_width
    base = known_median(cells.height[:, track] - prior[:, None], 1)
    noise = float(known_median(cells.rough[:, np.abs(offsets) < 3.0].ravel(), 0))
    if not np.isfinite(base).any():
        return None
    noise = noise if np.isfinite(noise) else 0.01
    base = prior + _running_median(base, 5)
    height, ground = np.full(cells.height.shape, np.nan, np.float32), np.zeros(cells.height.shape, bool)
    middle = int(np.flatnonzero(offsets > 0)[0])
    start = _starting_tilt(cells.height, base, offsets)
    # both sides at once, as far as the narrower one
    common_columns = min(middle, len(offsets) - middle)
    columns = np.stack([middle + np.arange(common_columns), middle - 1 - np.arange(common_columns)], axis=1)
    _walk(cells, base, columns, start, noise, height, ground)
    return _RoadHeight(height, ground, noise)


def _running_median(values, reach):
    """Median over 2 * reach + 1 rows; gaps are interpolated before."""
    rows = np.arange(len(values))
    finite = np.isfinite(values)
    filled = np.interp(rows, rows[finite], values[finite])
    return median_filter(filled, 2 * reach + 1, mode="nearest")


def _starting_tilt(height, base, offsets):
    """(R,) m per m, cross slope under the vehicle."""
    near = np.abs(offsets) < 2 * SURFACE.track_half_width
    left, right = (known_median(height[:, near & side] - base[:, None], 1) for side in (offsets > 0, offsets < 0))
    tilt = (left - right) / (2 * SURFACE.track_half_width)
    return np.clip(_running_median(tilt, 5), -SURFACE.max_cross_slope, SURFACE.max_cross_slope) if np.isfinite(tilt).any() else np.zeros(len(tilt))


def _walk(cells, base, columns, start, noise, height, ground):
    """Follow both sides outward from the heights `base` under the vehicle, (K, 2) columns; fills `height` and `ground` in place."""
    tilt = np.stack([start, -start])
    z, skipped = np.zeros_like(tilt), np.zeros_like(tilt)
    sigma = SURFACE.row_smoothing_sigma / SURFACE.row_length
    step = max(SURFACE.cells_between_questions // tilt.size, 1)
    # one pair of columns after the other: of the whole road nothing is there but what comes in and goes out
    for k, pair in enumerate(columns):
        if k % step == step - 1:
            check_cancelled()
        predicted = z + tilt * (0.5 * SURFACE.column_width if k == 0 else SURFACE.column_width)
        measured, count = (cells.height[:, pair] - base[:, None]).T, np.nan_to_num(cells.count[:, pair]).T
        off = measured - predicted
        tolerance = SURFACE.max_height_deviation + SURFACE.noise_factor * noise / np.sqrt(np.clip(count, 1.0, 25.0)) \
            + np.minimum(SURFACE.tolerance_gain * np.maximum(skipped - 0.5, 0.0), SURFACE.max_tolerance_gain)
        near = np.abs(off) < tolerance   # False where there is no ground
        off = np.where(near, off, 0.0)
        # cells near the tolerance have little weight: the surface must not climb a low curb
        weight = np.where(near, (1.0 - (off / tolerance) ** 2) ** 2, 0.0) * np.minimum(count, 20.0)
        # weighted mean over neighbouring rows, which fill the gaps of a row
        total, around = gaussian_filter1d(np.stack([weight, off * weight]), sigma, mode="nearest")
        around /= np.maximum(total, 1e-9)
        certainty = np.minimum(total / 3.0, 1.0)
        # behind a gap the measured height replaces the prediction
        z = predicted + np.where(skipped > 0.5, 1.0, SURFACE.height_gain) * certainty * around
        tilt = np.clip(tilt + SURFACE.tilt_gain * certainty * around / SURFACE.column_width, -SURFACE.max_cross_slope, SURFACE.max_cross_slope)
        tilt = gaussian_filter1d(tilt, sigma, mode="nearest")
        skipped = np.where(certainty > 0.5, 0.0, skipped + SURFACE.column_width)
        height[:, pair] = (z + base).T
        ground[:, pair] = (np.abs(measured - z) < tolerance).T


def followed_road(ground: MeasuredGround, road: int, cells: GroundCells, prior: np.ndarray) -> tuple[_RoadHeight, np.ndarray] | None:
    """The height of a road, which the ground keeps, as it is followed and smoothed in its cells; None as of `follow_road`."""
    if road not in ground.followed:
        followed = follow_road(cells, prior)
        ground.followed[road] = followed and (followed, _smooth_road(followed, cells))
    return ground.followed[road]


def _smooth_road(road: _RoadHeight, cells: GroundCells) -> np.ndarray:
    """The height of the road smoothed over the cells that show ground; elsewhere as it was followed.

    Following lags behind on a crowned road. A mean over 5 rows and 3 columns, weighted by points, does not.

    Returns (R, C) m, local z
    """
    # a running mean along the road depends on its rows, and not on other columns
    total, rise = np.empty((2, *road.height.shape), np.float32)
    for first in range(0, road.height.shape[1], SURFACE.smoothed_columns):
        some = slice(first, first + SURFACE.smoothed_columns)
        ground = road.ground[:, some]
        weight = np.where(ground, np.minimum(cells.count[:, some], 20.0), 0.0)
        off = np.where(ground, np.nan_to_num(cells.height[:, some] - road.height[:, some]), 0.0)
        for values, output in ((weight, total), (off * weight, rise)):
            uniform_filter1d(values, 5, axis=0, mode="nearest", output=output[:, some])

    def smoothed(some):
        weights, rises = (uniform_filter1d(values[some], 3, axis=1, mode="nearest") for values in (total, rise))
        return road.height[some] + np.where(weights > 1e-6, rises / np.maximum(weights, 1e-9), 0.0)

    return by_rows(smoothed, len(road.height))
