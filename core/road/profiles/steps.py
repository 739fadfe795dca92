"""Steps on single profiles: where the pseudo scan-line of the road ends at a rising face."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import maximum_filter1d

from ...common.arrays import best_within
from ..common.corners import MIN_BED_SLOPE, CurbSteps, RunningSums, SideLines, measure_corners, road_before
from ..common.pseudo_scanlines import TOP_QUANTILE_SIGMAS, PseudoScanLines, nearest_distance, seen_from
from ..weights import CURBS, PROFILE


def find_steps(lines: PseudoScanLines, min_height: float, max_height: float, least_evidence: float = -np.inf) -> CurbSteps:
    """Steps on every single profile of one side.

    min_height, max_height : m, of a step
    least_evidence : as of `measure_corners`

    Returns CurbSteps, sorted by profile, then outward
    """
    low, high, spacing = lines.low, lines.high, lines.spacing
    span = max(int(round(PROFILE.max_rise_width / spacing)), 2)
    # only occupied cells are looked at, profile by profile outward
    indices = np.flatnonzero(np.isfinite(high))
    row = indices // low.shape[1]
    column = indices - row * low.shape[1]
    offset = column * spacing
    own_low, own_high = low.ravel().take(indices), high.ravel().take(indices)
    # the highest of this and the following cells
    highest = maximum_filter1d(np.fmax(high, -np.inf), span + 1, axis=1, mode="constant", cval=-np.inf, origin=-((span + 1) // 2))
    top = highest.ravel().take(indices) - (TOP_QUANTILE_SIGMAS * lines.noise).take(row)
    # the cell before must still be road: the last occupied one within the window
    before = np.full(len(indices), np.nan)
    near = (indices[1:] - indices[:-1] <= span) & (row[1:] == row[:-1])
    np.copyto(before[1:], own_low[:-1], where=near)
    # a step's middle lies between that and its top, which it leaves half of its height below
    with np.errstate(invalid="ignore"):
        rising = np.flatnonzero((own_high > before) & (top - before > 0.4 * min_height - 1e-9))
    indices, row, column, own_high, top, before = (v.take(rising) for v in (indices, row, column, own_high, top, before))
    base, slope, rough, count = road_before(low, own_low, offset, spacing, row, column)
    with np.errstate(invalid="ignore"):
        step = top - base
        middle = base + 0.5 * step
        least = np.maximum(0.8 * min_height, CURBS.min_step_sigmas * np.maximum(lines.noise.take(row), rough) / 2)
        candidates = np.flatnonzero((count >= 3) & (step >= least)
                                    & (step <= max_height + 0.05) & (own_high >= middle) & (before < middle))
    # of neighbouring cells only the best within the window is a step
    best = candidates[best_within(indices.take(candidates), row.take(candidates), (step - 2 * rough).take(candidates), span)]
    row, column, base, slope = (v.take(best) for v in (row, column, base, slope))
    up = _stays_up(low, base, slope, row, column, min_height, spacing)
    return measure_corners(lines, row[up], column[up], min_height, max_height, least_evidence)


def _stays_up(low, base, slope, rows, columns, min_height, spacing):
    """(M,) bool: does the ground behind rising cells look as high as a step, or is too little of it seen?

    base, slope : (M,) of the road before each. A rise due to a single high point among many need not be measured.
    """
    cells = np.arange(1, int(round(CURBS.behind_length / spacing)) + 1)
    padded = np.pad(low, ((0, 0), (0, len(cells))), constant_values=np.nan)
    rise = padded[rows[:, None], columns[:, None] + cells] - base[:, None] - slope[:, None] * cells * spacing
    with np.errstate(invalid="ignore"):
        raised = rise > 0.4 * min_height
    count = raised.sum(1)
    return (count < PROFILE.min_raised_cells) | (np.where(raised, rise, 0.0).sum(1) >= PROFILE.min_raised_height_share * min_height * count)


# Steps where the scanner's noise hides a curb in a single profile: measured in the average of several profiles.
#
# The heights of a spinning multi-beam scanner scatter by centimetres, and positions that drift between one view and the next blur a face sideways.
# A curb of 5 cm is then no higher than the scatter of one profile, but it continues along the road and noise does not. So profiles are averaged
# over PROFILE.averaging_length metres in every direction that a curb may have. The level of the road and of the ground behind are fitted
# separately. The step between the two must be higher than the uncertainty of both levels, and must rise within the width of a blurred face, so
# that ramps and banks are not taken for curbs.
#
# Where plants or a wall stand right behind a curb there is no level ground. What rises behind is then no part of the step: the step is as high as
# its line is at the face.


def find_averaged_steps(lines: PseudoScanLines, min_height: float, max_height: float, layer_jump: float, overgrown: bool) -> CurbSteps:
    """Steps on the averaged profiles of one side.

    They are looked for in all points together, and where those show none, in the points seen ahead of the vehicle and behind it separately: positions
    that drifted between the two views blur a face that each of them shows.

    lines : PseudoScanLines; the first and last PROFILE.averaging_length / 2 metres serve the averages of the others
    min_height, max_height : m, of a step
    layer_jump : m of height between two layers
    overgrown : whether steps before plants or a wall are looked for, too

    Returns CurbSteps, sorted by profile, then outward. The offset is that of half the height, since a
    blurred face does not separate its bottom from its top.
    """
    least = np.maximum(min_height, PROFILE.all_views_sigmas * lines.spread)[:, None]
    result, *before_plants = _steps_in(lines, least, max_height, (True, False) if overgrown else (True,))
    for nearest, farthest in ((0.0, np.inf), (-np.inf, 0.0)):
        # a single view averages few rings of a multi-beam scanner, each with an error of its own
        single, = _steps_in(seen_from(lines, nearest, farthest, layer_jump),
                            np.maximum(min_height, PROFILE.single_view_sigmas * lines.spread)[:, None], max_height)
        result = CurbSteps.join([result, single[~beside(single, result)]])
    for steps in before_plants:
        # level ground behind is the surer sign
        result = CurbSteps.join([result, steps[~beside(steps, result)]])
    return result[np.lexsort((result.u, result.profile))]


def beside(steps: CurbSteps, others: CurbSteps) -> np.ndarray:
    """(M,) bool: does one of the others lie within PROFILE.same_step_distance metres across in the same profile?"""
    return nearest_distance(steps.profile * 1000.0 + steps.u, others.profile * 1000.0 + others.u) < PROFILE.same_step_distance


def _steps_in(lines, min_height, max_height, behind=(True,)):
    """Steps of averaged profiles, a CurbSteps for each of `behind`: before level ground (True), before plants or a wall; `min_height` is (P, 1)."""
    names = "height", "doubt", "scatter", "before", "behind", "shift", "bottom", "skew"
    kinds = [{name: np.zeros(lines.shape) for name in names} | {"rise": np.full(lines.shape, -np.inf)} for _ in behind]
    sums = RunningSums(lines.shape, lines.spacing)
    for skew in sorted(np.arange(-PROFILE.skew_steps, PROFILE.skew_steps + 1) * PROFILE.skew_step, key=abs):
        sums.add(_averaged(lines, skew))
        for best, (cells, rises) in zip(kinds, _rises(sums, [best["rise"] for best in kinds], behind, CURBS.min_steep_share * min_height)):
            for name, values in rises.items():
                best[name].flat[cells] = values
            best["skew"].flat[cells] = skew
    return [_steps_of(lines, best, min_height, max_height) for best in kinds]


def _steps_of(lines, best, min_height, max_height):
    """The steps among the largest rises of cells, which rise more than those next to them."""
    good = ((best["height"] >= min_height) & (best["height"] <= max_height) & (best["height"] >= CURBS.min_step_sigmas * best["doubt"])
            & (best["rise"] >= CURBS.min_steep_share * best["height"]) & (best["scatter"] <= CURBS.max_averaged_scatter)
            & (np.abs(best["before"]) <= CURBS.max_road_slope) & (np.abs(best["behind"]) <= CURBS.max_road_slope))
    score = np.where(good, best["rise"], -np.inf)
    about = 2 * int(round(PROFILE.min_step_spacing / lines.spacing)) + 1
    rows, cells = np.nonzero(good & (score >= maximum_filter1d(score, about, axis=1, mode="constant", cval=-np.inf)))
    pick = {name: values[rows, cells] for name, values in best.items()}
    count = np.diff(lines.starts).reshape(lines.shape)
    reach = int(round((CURBS.blurred_face_half_width + CURBS.road_fit_length) / lines.spacing))
    total = np.concatenate([np.zeros((len(count), 1), np.int64), np.cumsum(count, axis=1)], axis=1)
    first, last = np.maximum(cells - reach, 0), np.minimum(cells + reach + 1, lines.shape[1])
    return CurbSteps(profile=lines.first + rows, s=(lines.first + rows + 0.5) * lines.width,
                 u=lines.offset(cells) + pick["shift"], h=pick["bottom"], skew=pick["skew"], height=pick["height"],
                 run=np.zeros(len(rows)), noise=pick["scatter"], scanner_noise=lines.spread[rows],
                 support=total[rows, cells] - total[rows, first], behind=total[rows, last] - total[rows, cells],
                 hidden=np.zeros(len(rows)))


def _averaged(lines, skew):
    """(P, C) median heights of PROFILE.averaging_length metres of road about every profile, along one direction."""
    half = max(int(round(0.5 * PROFILE.averaging_length / lines.width)), 1)
    shifts = [int(round(skew * k * lines.width / lines.spacing)) for k in range(-half, half + 1)]
    (rows, cells), most = lines.shape, max(map(abs, shifts))
    low = np.pad(np.where(np.isnan(lines.low), np.inf, lines.low), ((half, half), (most, most)), constant_values=np.inf)
    stack = [low[k:k + rows, most + shift:most + shift + cells].copy() for k, shift in enumerate(shifts)]
    count = np.zeros(lines.shape, np.int8)
    for row in stack:
        count += row < np.inf
    return _median(stack, count, max(PROFILE.min_profile_share * len(stack), 2))


def _rises(sums, largest, kinds, least):
    """Of each kind the (M,) indices of cells at which the ground rises by more than in any direction before, and a dict of (M,) measures of the rise.

    largest : the (P, C) rises of each kind before, m, which are made those of this direction where they are larger
    kinds : is the ground behind level, or do plants or a wall rise there?
    least : (P, 1) m, of a rise that is measured
    """
    spacing = sums.spacing
    gap, fit, short = (int(round(v / spacing)) for v in (CURBS.blurred_face_half_width, CURBS.road_fit_length, CURBS.behind_fit_length))
    near, rises = int(round(CURBS.steep_half_width / spacing)), []
    before, behind = SideLines(sums, -gap - fit, -gap), SideLines(sums, gap, gap + short)
    smooth = np.pad(sums.mean(-1, 1), ((0, 0), (near, near)), constant_values=np.nan)
    with np.errstate(invalid="ignore", divide="ignore"):
        jump = smooth[:, 2 * near:] - smooth[:, :sums.cells]
        heights = behind.level - before.level
        stays = ((before.n >= CURBS.min_filled_share * (fit + 1)) & (behind.n >= CURBS.min_filled_share * (short + 1))
                 & (sums.mean(gap, gap + fit) - before.level > 0.5 * heights))
        for known, is_level in zip(largest, kinds):
            slope = behind.slope if is_level else before.slope
            rise = jump - near * spacing * (before.slope + slope)
            cells = np.flatnonzero((rise > PROFILE.oblique_factor * known) & stays & np.isfinite(rise))
            if not is_level:
                lowest = behind.mz.take(cells) - PROFILE.stays_up_sigmas * behind.deviation(cells)
                bed = behind.slope.take(cells)
                cells = cells[(lowest > before.level.take(cells) + 0.5 * heights.take(cells)) & (bed > MIN_BED_SLOPE) & (bed <= CURBS.max_bed_slope)]
            known.flat[cells] = rise.take(cells)
            cells = cells[rise.take(cells) >= least.take(cells // sums.cells)]
            height, bottom, rough = heights.take(cells), before.level.take(cells), before.scatter(cells)
            uneven = behind.scatter(cells) if is_level else rough
            doubt = 2.0 * np.sqrt(rough**2 / before.n.take(cells) + uneven**2 / behind.n.take(cells))
            # where the profile crosses half the height: the mean height of the face gives the distance from this cell
            face = sums.window_at(1, -gap, gap, cells) / sums.window_at(0, -gap, gap, cells)
            shift = (0.5 - (face - bottom) / height) * (2 * gap + 1) * spacing
            shift = np.nan_to_num(np.clip(shift, -CURBS.blurred_face_half_width, CURBS.blurred_face_half_width))
            rises.append((cells, dict(height=height, doubt=doubt, scatter=np.maximum(rough, uneven), shift=shift, bottom=bottom,
                                      before=before.slope.take(cells), behind=slope.take(cells))))
    return rises


def _median(rows, count, min_count):
    """Median of heights at every cell, (P, C), where there are `min_count` or more; NaN elsewhere.

    rows : list of (P, C), infinite where there is none; they are overwritten
    count : (P, C) of those that are not
    """
    if len(rows) > PROFILE.max_network_rows:
        rows = np.sort(rows, axis=0)
    else:
        # odd-even transposition sort of the layers
        buffer = np.empty_like(rows[0])
        for turn in range(len(rows)):
            for k in range(turn % 2, len(rows) - 1, 2):
                np.minimum(rows[k], rows[k + 1], out=buffer)
                np.maximum(rows[k], rows[k + 1], out=rows[k + 1])
                rows[k], buffer = buffer, rows[k]
    middle = np.full(count.shape, np.nan)
    for n in range(int(np.ceil(min_count)), len(rows) + 1):
        np.copyto(middle, 0.5 * (rows[(n - 1) // 2] + rows[n // 2]), where=count == n)
    return middle
