"""Steps where the scanner's noise hides a curb in a single profile: seen in the average of several.

The heights of a spinning multi-beam scanner scatter by centimetres, and positions
that drift between one view and the next blur a face sideways. A curb of 5 cm is
then no taller than the scatter of one profile, but it goes on along the road where
noise does not. So profiles are averaged over AVERAGING_LENGTH metres in every direction that a
curb may take, the level of the road and of the ground behind are fitted apart, and
the step between the two is asked for: taller than what their scatter leaves in
doubt, and risen within the width of a blurred face, so that ramps and banks are not
taken for curbs.
"""

from functools import partial

import numpy as np

from ..common.corners import BEHIND_LENGTH, FACE_MARGIN, MAX_ROAD_SLOPE, MIN_STEP_SIGMAS, ROAD_SIDE_LENGTH, CurbSteps, measure_corners
from ..common.pseudo_scanlines import TOP_QUANTILE_SIGMAS, PseudoScanLines, seen_from

# CurbSteps on pseudo scan-lines: where the road ends against a face, profile by profile.

MAX_RISE_WIDTH = 0.15       # m across within which the whole rise must lie
MIN_RAISED_CELLS = 3     # cells of raised ground behind a rise that tell its height
MIN_RAISED_HEIGHT_SHARE = 0.65     # share of the least height that they must show


def find_steps(lines: PseudoScanLines, least, highest):
    """Steps between `least` and `highest` metres on every profile of one side.

    Returns
    -------
    CurbSteps, sorted by profile, then outward
    """
    rows, cells = _rising_cells(lines, least, highest)
    return measure_corners(lines, rows, cells, least, highest)


def _rising_cells(lines, least, highest):
    """(row, cell) of the cells in which a profile crosses the middle of a step."""
    low, high, spacing = lines.low, lines.high, lines.spacing
    span = max(int(round(MAX_RISE_WIDTH / spacing)), 2)
    top = max_ahead(high, span) - TOP_QUANTILE_SIGMAS * lines.noise[:, None]
    # the cell before must still be road: the last occupied one within the window
    before = last_before(low, span)
    # a step's middle lies between that and its top, which it leaves half of its height below
    with np.errstate(invalid="ignore"):
        rows, cells = np.nonzero((high > before) & (top - before > 0.4 * least - 1e-9))
    base, slope, rough, count = road_before(low, spacing, rows, cells)
    with np.errstate(invalid="ignore"):
        step = top[rows, cells] - base
        middle = base + 0.5 * step
        found = np.flatnonzero((count >= 3) & (step >= np.maximum(0.8 * least, MIN_STEP_SIGMAS * np.maximum(lines.noise[rows], rough) / 2))
                               & (step <= highest + 0.05) & (high[rows, cells] >= middle) & (before[rows, cells] < middle))
    rows, cells, base, slope = rows[found], cells[found], base[found], slope[found]
    score = np.full(low.shape, -np.inf)
    score[rows, cells] = step[found] - 2 * rough[found]
    # one of a cluster: the best within the window
    beyond = max_ahead(score, span, inclusive=False)
    nearer = max_ahead(score[:, ::-1], span, inclusive=False)[:, ::-1]
    best = score[rows, cells] >= np.maximum(beyond[rows, cells], nearer[rows, cells])
    best[best] = _stays_up(low, base[best], slope[best], rows[best], cells[best], least, spacing)
    return rows[best], cells[best]


def _stays_up(low, base, slope, rows, columns, least, spacing):
    """(M,) bool: does the ground behind rising cells look as high as a step, or is too little of it seen to tell?

    base, slope : (M,) of the road before each

    What a single high point among many made rise need not be measured.
    """
    cells = np.arange(1, int(round(BEHIND_LENGTH / spacing)) + 1)
    padded = np.pad(low, ((0, 0), (0, len(cells))), constant_values=np.nan)
    rise = padded[rows[:, None], columns[:, None] + cells] - base[:, None] - slope[:, None] * cells * spacing
    with np.errstate(invalid="ignore"):
        raised = rise > 0.4 * least
    count = raised.sum(1)
    return (count < MIN_RAISED_CELLS) | (np.where(raised, rise, 0.0).sum(1) >= MIN_RAISED_HEIGHT_SHARE * least * count)


def road_before(low, spacing, rows, columns):
    """Line through the principal points before some cells: its height at each, slope, scatter, and count, (M,) each."""
    cells = low.shape[1]
    reach, skip = int(round(ROAD_SIDE_LENGTH / spacing)), int(round(FACE_MARGIN / spacing))
    there = np.isfinite(low)
    value = np.where(there, low, 0.0)
    u = there * (np.arange(cells) * spacing)
    # running sums, before the first cell and as far as a window reaches back 0
    total = np.zeros((len(low), reach + skip + cells))
    first = rows * total.shape[1] + columns

    def window(terms):
        np.cumsum(terms, axis=1, out=total[:, reach + skip:])
        return total.take(first + reach) - total.take(first)

    n, su, sz = window(there), window(u), window(value)
    suz, suu, szz = window(value * u), window(np.multiply(u, u, out=u)), window(np.multiply(value, value, out=value))
    with np.errstate(all="ignore"):
        mu, mz = su / n, sz / n
        vuu, vuz, vzz = suu / n - mu * mu, suz / n - mu * mz, szz / n - mz * mz
        slope = np.where(vuu > 1e-4, vuz / vuu, 0.0)
        slope = np.clip(slope, -MAX_ROAD_SLOPE, MAX_ROAD_SLOPE)
        rough = np.sqrt(np.maximum(vzz - 2 * slope * vuz + slope * slope * vuu, 0.0))
        return mz + slope * (columns * spacing - mu), slope, rough, n


def max_ahead(values, span, inclusive=True):
    """Largest value in this and the following cells, NaN taken as none."""
    best = np.full(values.shape, -np.inf)
    for k in range(0 if inclusive else 1, span + 1):
        width = values.shape[1] - k
        if width > 0:
            np.fmax(best[:, :width], values[:, k:], out=best[:, :width])
    return best


def last_before(values, span):
    """Value of the nearest occupied cell before each within the span, NaN where there is none."""
    found = np.full(values.shape, np.nan)
    found[:, 1:] = values[:, :-1]
    for k in range(2, min(span, values.shape[1] - 1) + 1):
        np.copyto(found[:, k:], values[:, :-k], where=np.isnan(found[:, k:]))
    return found

AVERAGING_LENGTH = 1.25       # m of road averaged
SKEW_STEP = 0.125    # m outward per m along between the directions tried: 4 cm at the ends of the average
SKEW_STEPS = 8    # such steps to either side
OBLIQUE_FACTOR = 1.15         # how much taller a rise must look in a direction farther from the road's own
MIN_PROFILE_SHARE = 0.5     # share of the profiles averaged that must have ground in a cell
ROAD_FIT_LENGTH = 0.35      # m of road to which a level is fitted
BEHIND_FIT_LENGTH = 0.25    # m of ground behind: a hedge may stand close
BLURRED_FACE_HALF_WIDTH = 0.09          # m either side of a step left out of both levels: the blurred face
STEEP_HALF_WIDTH = 0.07    # m either side of a step within which most of the rise must lie
MIN_STEEP_SHARE = 0.65   # of the height, more than an even rise from level to level has
MIN_FILLED_SHARE = 0.6   # share of the cells of a level that must hold ground
MIN_STEP_SPACING = 0.12         # m across within which one step is reported
ALL_VIEWS_SIGMAS, SINGLE_VIEW_SIGMAS = 2.0, 2.5  # times the spread of single heights that a step must rise: in all views, in one
SAME_STEP_DISTANCE = 0.25          # m across within which a step seen from one side only is the one already found
MAX_NETWORK_ROWS = 9         # profiles that are put in order one against the other: of more numpy's own way is faster
MAX_AVERAGED_SCATTER = 0.008        # m, scatter of averaged heights about their level: verges and banks have more


def find_averaged_steps(lines, least, highest, layer_jump):
    """Steps between `least` and `highest` metres of the averaged profiles of one side.

    They are sought in all points together; where those show none, in what was seen from
    before and from behind alone: positions that drifted in between blur a face away that
    each of the two shows.

    Parameters
    ----------
    lines : PseudoScanLines; the first and last AVERAGING_LENGTH / 2 metres serve the averages of the others
    least, highest : metres
    layer_jump : metres

    Returns
    -------
    CurbSteps, sorted by profile, then outward. The offset is that of half the height: a
    blurred face does not tell its bottom from its top.
    """
    found = _steps_in(lines, np.maximum(least, ALL_VIEWS_SIGMAS * lines.spread)[:, None], highest)
    for nearest, farthest in ((0.0, np.inf), (-np.inf, 0.0)):
        # a view of its own averages few rings of a multi-beam scanner, each with an error of its own
        single = _steps_in(seen_from(lines, nearest, farthest, layer_jump),
                           np.maximum(least, SINGLE_VIEW_SIGMAS * lines.spread)[:, None], highest)
        found = CurbSteps.join([found, single[~_beside(single, found)]])
    return found[np.lexsort((found.u, found.profile))]


def _beside(steps, others):
    """(M,) bool: does one of the others lie within SAME_STEP_DISTANCE metres across in the same profile?"""
    if not len(others):
        return np.zeros(len(steps), bool)
    order = np.lexsort((others.u, others.profile))
    key = others.profile[order] * 1000.0 + others.u[order]
    wanted = steps.profile * 1000.0 + steps.u
    right = np.searchsorted(key, wanted)
    return np.minimum(np.abs(key[np.clip(right, 0, len(key) - 1)] - wanted),
                      np.abs(key[np.clip(right - 1, 0, len(key) - 1)] - wanted)) < SAME_STEP_DISTANCE


def _steps_in(lines, least, highest):
    """Steps of averaged profiles; `least` is (P, 1)."""
    best = {name: np.zeros(lines.shape) for name in ("height", "doubt", "scatter", "before", "behind", "shift", "bottom", "skew")}
    best["rise"] = np.full(lines.shape, -np.inf)
    sums = _Sums(lines.shape, lines.spacing)
    for skew in sorted(np.arange(-SKEW_STEPS, SKEW_STEPS + 1) * SKEW_STEP, key=abs):
        sums.of(_averaged(lines, skew))
        cells, seen = _rises(sums, OBLIQUE_FACTOR * best["rise"])
        for name, values in seen.items():
            best[name].flat[cells] = values
        best["skew"].flat[cells] = skew
    good = ((best["height"] >= least) & (best["height"] <= highest) & (best["height"] >= MIN_STEP_SIGMAS * best["doubt"])
            & (best["rise"] >= MIN_STEEP_SHARE * best["height"]) & (best["scatter"] <= MAX_AVERAGED_SCATTER)
            & (np.abs(best["before"]) <= MAX_ROAD_SLOPE) & (np.abs(best["behind"]) <= MAX_ROAD_SLOPE))
    score = np.where(good, best["rise"], -np.inf)
    rows, cells = np.nonzero(good & (score >= _largest_near(score, int(round(MIN_STEP_SPACING / lines.spacing)))))
    pick = {name: values[rows, cells] for name, values in best.items()}
    count = np.diff(lines.starts).reshape(lines.shape)
    reach = int(round((BLURRED_FACE_HALF_WIDTH + ROAD_FIT_LENGTH) / lines.spacing))
    total = np.concatenate([np.zeros((len(count), 1), np.int64), np.cumsum(count, axis=1)], axis=1)
    first, last = np.maximum(cells - reach, 0), np.minimum(cells + reach + 1, lines.shape[1])
    return CurbSteps(profile=lines.first + rows, s=(lines.first + rows + 0.5) * lines.width,
                 u=lines.offset(cells) + pick["shift"], h=pick["bottom"], skew=pick["skew"], height=pick["height"],
                 run=np.zeros(len(rows)), noise=pick["scatter"], scanner_noise=lines.spread[rows],
                 support=total[rows, cells] - total[rows, first], behind=total[rows, last] - total[rows, cells])


def _averaged(lines, skew):
    """(P, C) median heights of AVERAGING_LENGTH metres of road about every profile, along one direction."""
    half = max(int(round(0.5 * AVERAGING_LENGTH / lines.width)), 1)
    low = np.where(np.isnan(lines.low), np.inf, lines.low)
    stack = [_shifted(low, k, int(round(skew * k * lines.width / lines.spacing))) for k in range(-half, half + 1)]
    count = np.zeros(low.shape, np.int8)
    for row in stack:
        count += row < np.inf
    return _median(stack, count, max(MIN_PROFILE_SHARE * len(stack), 2))


def _rises(sums, least):
    """Where a step would rise more than `least`, (P, C): its height, what of it lies within the face, what remains in doubt.

    Returns
    -------
    (M,) indices of cells, and a dict of (M,)
    """
    spacing = sums.spacing
    gap, fit, short = (int(round(v / spacing)) for v in (BLURRED_FACE_HALF_WIDTH, ROAD_FIT_LENGTH, BEHIND_FIT_LENGTH))
    near = int(round(STEEP_HALF_WIDTH / spacing))
    before, behind = sums.line(-gap - fit, -gap), sums.line(gap, gap + short)
    smooth = sums.mean(-1, 1)
    with np.errstate(invalid="ignore", divide="ignore"):
        height = behind.level - before.level
        rise = _moved(smooth, near) - _moved(smooth, -near) - near * spacing * (before.slope + behind.slope)
        cells = np.flatnonzero((rise > least) & (before.n >= MIN_FILLED_SHARE * (fit + 1)) & (behind.n >= MIN_FILLED_SHARE * (short + 1))
                               & (sums.mean(gap, gap + fit) - before.level > 0.5 * height) & np.isfinite(rise))
        height = height.take(cells)
        rough, uneven = before.scatter(cells), behind.scatter(cells)
        doubt = 2.0 * np.sqrt(rough**2 / before.n.take(cells) + uneven**2 / behind.n.take(cells))
        bottom = before.level.take(cells)
        # where the profile crosses half the height: mean height of the face tells how far from this cell
        shift = (0.5 - (sums.mean(-gap, gap).take(cells) - bottom) / height) * (2 * gap + 1) * spacing
        shift = np.nan_to_num(np.clip(shift, -BLURRED_FACE_HALF_WIDTH, BLURRED_FACE_HALF_WIDTH))
    return cells, dict(rise=rise.take(cells), height=height, doubt=doubt, scatter=np.maximum(rough, uneven), shift=shift, bottom=bottom,
                       before=before.slope.take(cells), behind=behind.slope.take(cells))


class _Sums:
    """Running sums over the cells of every profile, from which levels beside any cell follow at once."""

    def __init__(self, shape, spacing):
        self.cells, self.spacing, self.u = shape[1], spacing, np.arange(shape[1]) * spacing
        # a window may reach beyond the first and the last cell
        self.pad = int(round((BLURRED_FACE_HALF_WIDTH + ROAD_FIT_LENGTH) / spacing)) + 2
        self.totals = np.zeros((6, shape[0], self.cells + 2 * self.pad))

    def of(self, value):
        """Sum the heights of cells, (P, C), NaN where there is none."""
        there = np.isfinite(value)
        h, u = np.where(there, value, 0.0), there * self.u
        own = slice(self.pad, self.pad + self.cells)
        for total, v in zip(self.totals, (there * 1.0, h, h * h, u, u * u, u * h)):
            np.cumsum(v, axis=1, out=total[:, own])
            total[:, own.stop:] = total[:, own.stop - 1:own.stop]

    def window(self, which, first, last):
        """Sum of the cells from `first` to `last` beside every cell."""
        total, start, end = self.totals[which], self.pad - 1 + first, self.pad + last
        return total[:, end:end + self.cells] - total[:, start:start + self.cells]

    def window_at(self, which, first, last, cells):
        """The same at some cells."""
        row, cell = np.divmod(cells, self.cells)
        total = self.totals[which]
        return total[row, cell + self.pad + last] - total[row, cell + self.pad - 1 + first]

    def mean(self, first, last):
        """Mean of the occupied cells from `first` to `last` beside every cell."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.window(1, first, last) / self.window(0, first, last)

    def line(self, first, last):
        """_Line through those cells."""
        return _Line(self, first, last)


class _Line:
    """Lines through the cells beside every cell: height at the cell, slope, cells used; (P, C)."""

    def __init__(self, sums, first, last):
        self.n, sz, su, suu, suz = (sums.window(k, first, last) for k in (0, 1, 3, 4, 5))
        with np.errstate(invalid="ignore", divide="ignore"):
            mu, self.mz = su / self.n, sz / self.n
            vuu, self.vuz = suu / self.n - mu * mu, suz / self.n - mu * self.mz
            self.slope = np.where(vuu > 1e-4, self.vuz / vuu, 0.0)
            self.level = self.mz + self.slope * (sums.u - mu)
        self._squares = partial(sums.window_at, 2, first, last)

    def scatter(self, cells):
        """(M,) scatter of heights about the line at some cells."""
        n, mz = self.n.take(cells), self.mz.take(cells)
        vzz = self._squares(cells) / n - mz * mz
        return np.sqrt(np.maximum(vzz - self.slope.take(cells) * self.vuz.take(cells), 0.0) * n / np.maximum(n - 2, 1))


def _median(rows, count, least):
    """Median of heights at every cell, (P, C), where `least` or more of them are there; NaN elsewhere.

    rows : list of (P, C), infinite where there is none; they are overwritten
    count : (P, C) of those that are not
    """
    if len(rows) > MAX_NETWORK_ROWS:
        rows = np.sort(rows, axis=0)
    else:
        # neighbours change places till all are in order
        spare = np.empty_like(rows[0])
        for turn in range(len(rows)):
            for k in range(turn % 2, len(rows) - 1, 2):
                np.minimum(rows[k], rows[k + 1], out=spare)
                np.maximum(rows[k], rows[k + 1], out=rows[k + 1])
                rows[k], spare = spare, rows[k]
    middle = np.full(count.shape, np.nan)
    for n in range(int(np.ceil(least)), len(rows) + 1):
        np.copyto(middle, 0.5 * (rows[(n - 1) // 2] + rows[n // 2]), where=count == n)
    return middle


def _moved(values, k, empty=np.nan):
    """values[:, c + k] at every cell c."""
    out = np.full(values.shape, empty, values.dtype)
    if abs(k) >= values.shape[1]:
        return out
    if k >= 0:
        out[:, :values.shape[1] - k] = values[:, k:]
    else:
        out[:, -k:] = values[:, :k]
    return out


def _shifted(values, rows, cells):
    """values[p + rows, c + cells] at every profile and cell, infinite where there is none."""
    out = np.full(values.shape, np.inf)
    to, of = zip(*(_overlap(size, by) for size, by in zip(values.shape, (rows, cells))))
    out[to] = values[of]
    return out


def _overlap(size, by):
    """Slices of what is moved `by` places: where it comes to lie, and where it lay."""
    by = max(-size, min(by, size))
    return slice(max(-by, 0), size - max(by, 0)), slice(max(by, 0), size - max(-by, 0))


def _largest_near(values, span):
    """Largest value within `span` cells either side."""
    best = values.copy()
    for k in range(1, span + 1):
        np.maximum(best, _moved(values, k, -np.inf), out=best)
        np.maximum(best, _moved(values, -k, -np.inf), out=best)
    return best
