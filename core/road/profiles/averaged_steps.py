"""Steps where the scanner's noise hides a curb in a single profile: seen in the average of several.

The heights of a spinning multi-beam scanner scatter by centimetres, and positions
that drift between one view and the next blur a face sideways. A curb of 5 cm is
then no taller than the scatter of one profile, but it goes on along the road where
noise does not. So profiles are averaged over AVERAGE metres in every direction that a
curb may take, the level of the road and of the ground behind are fitted apart, and
the step between the two is asked for: taller than what their scatter leaves in
doubt, and risen within the width of a blurred face, so that ramps and banks are not
taken for curbs.
"""

import numpy as np

from .corners import SIGMAS, STEEPEST_ROAD, Steps
from .profiles import seen_between

AVERAGE = 1.25       # m of road averaged
SKEW_STEP = 0.125    # m outward per m along between the directions tried: 4 cm at the ends of the average
STEEPEST_SKEW = 8    # such steps to either side
SURER = 1.15         # how much taller a rise must look in a direction farther from the road's own
LEAST_ROWS = 0.5     # share of the profiles averaged that must have ground in a cell
ROAD_FIT = 0.35      # m of road to which a level is fitted
BEHIND_FIT = 0.25    # m of ground behind: a hedge may stand close
FACE = 0.09          # m either side of a step left out of both levels: the blurred face
STEEP_HALF = 0.07    # m either side of a step within which most of the rise must lie
STEEP_SHARE = 0.65   # of the height, more than an even rise from level to level has
LEAST_FILLED = 0.6   # share of the cells of a level that must hold ground
ALONE = 0.12         # m across within which one step is reported
ALL_SIGMAS, RING_SIGMAS = 2.0, 2.5  # times the spread of single heights that a step must rise: in all views, in one
SAME = 0.25          # m across within which a step seen from one side only is the one already found
ROUGH = 0.008        # m, scatter of averaged heights about their level: verges and banks have more


def find_averaged_steps(lines, least, highest, layer_jump):
    """Steps between `least` and `highest` metres of the averaged profiles of one side.

    They are sought in all points together; where those show none, in what was seen from
    before and from behind alone: positions that drifted in between blur a face away that
    each of the two shows.

    Parameters
    ----------
    lines : PseudoScanLines; the first and last AVERAGE / 2 metres serve the averages of the others
    least, highest : metres
    layer_jump : metres

    Returns
    -------
    Steps, sorted by profile, then outward. The offset is that of half the height: a
    blurred face does not tell its bottom from its top.
    """
    found = _steps_in(lines, np.maximum(least, ALL_SIGMAS * lines.spread)[:, None], highest)
    for nearest, farthest in ((0.0, np.inf), (-np.inf, 0.0)):
        # a view of its own averages few rings of a multi-beam scanner, each with an error of its own
        single = _steps_in(seen_between(lines, nearest, farthest, layer_jump),
                           np.maximum(least, RING_SIGMAS * lines.spread)[:, None], highest)
        found = Steps.join([found, single[~_beside(single, found)]])
    return found[np.lexsort((found.u, found.profile))]


def _beside(steps, others):
    """(M,) bool: does one of the others lie within SAME metres across in the same profile?"""
    if not len(others):
        return np.zeros(len(steps), bool)
    order = np.lexsort((others.u, others.profile))
    key = others.profile[order] * 1000.0 + others.u[order]
    wanted = steps.profile * 1000.0 + steps.u
    right = np.searchsorted(key, wanted)
    return np.minimum(np.abs(key[np.clip(right, 0, len(key) - 1)] - wanted),
                      np.abs(key[np.clip(right - 1, 0, len(key) - 1)] - wanted)) < SAME


def _steps_in(lines, least, highest):
    """Steps of averaged profiles; `least` is (P, 1)."""
    best = None
    for skew in sorted(np.arange(-STEEPEST_SKEW, STEEPEST_SKEW + 1) * SKEW_STEP, key=abs):
        seen = _rises(_averaged(lines, skew), lines.spacing, skew)
        if best is None:
            best = seen
            continue
        better = seen["rise"] > SURER * best["rise"]
        for name, values in seen.items():
            np.copyto(best[name], values, where=better)
    good = ((best["height"] >= least) & (best["height"] <= highest) & (best["height"] >= SIGMAS * best["doubt"])
            & (best["rise"] >= STEEP_SHARE * best["height"]) & (best["scatter"] <= ROUGH)
            & (np.abs(best["before"]) <= STEEPEST_ROAD) & (np.abs(best["behind"]) <= STEEPEST_ROAD))
    score = np.where(good, best["rise"], -np.inf)
    rows, cells = np.nonzero(good & (score >= _largest_near(score, int(round(ALONE / lines.spacing)))))
    pick = {name: values[rows, cells] for name, values in best.items()}
    count = np.diff(lines.starts).reshape(lines.shape)
    reach = int(round((FACE + ROAD_FIT) / lines.spacing))
    total = np.concatenate([np.zeros((len(count), 1), np.int64), np.cumsum(count, axis=1)], axis=1)
    first, last = np.maximum(cells - reach, 0), np.minimum(cells + reach + 1, lines.shape[1])
    return Steps(profile=lines.first + rows, s=(lines.first + rows + 0.5) * lines.width,
                 u=lines.offset(cells) + pick["shift"], h=pick["bottom"], skew=pick["skew"], height=pick["height"],
                 run=np.zeros(len(rows)), noise=pick["scatter"], usual=lines.spread[rows],
                 support=total[rows, cells] - total[rows, first], behind=total[rows, last] - total[rows, cells])


def _averaged(lines, skew):
    """(P, C) median heights of AVERAGE metres of road about every profile, along one direction."""
    half = max(int(round(0.5 * AVERAGE / lines.width)), 1)
    stack = np.full((2 * half + 1, *lines.shape), np.nan)
    for k in range(-half, half + 1):
        _shifted(lines.low, k, int(round(skew * k * lines.width / lines.spacing)), stack[k + half])
    enough = np.isfinite(stack).sum(0) >= max(LEAST_ROWS * len(stack), 2)
    return np.where(enough, _median_of_rows(stack), np.nan)


def _rises(value, spacing, skew):
    """For a step at every cell: its height, what of it lies within the face, what remains in doubt; dict of (P, C)."""
    gap, fit, short = (int(round(v / spacing)) for v in (FACE, ROAD_FIT, BEHIND_FIT))
    near = int(round(STEEP_HALF / spacing))
    sums = _Sums(value, spacing)
    road, slope, rough, n = sums.line(-gap - fit, -gap)
    top, climb, uneven, m = sums.line(gap, gap + short)
    smooth, face = sums.mean(-1, 1), sums.mean(-gap, gap)
    with np.errstate(invalid="ignore", divide="ignore"):
        height = top - road
        rise = _moved(smooth, near) - _moved(smooth, -near) - near * spacing * (slope + climb)
        doubt = 2.0 * np.sqrt(rough**2 / n + uneven**2 / m)
        filled = (n >= LEAST_FILLED * (fit + 1)) & (m >= LEAST_FILLED * (short + 1)) & (sums.mean(gap, gap + fit) - road > 0.5 * height)
        rise = np.where(filled & np.isfinite(rise), rise, -np.inf)
        # where the profile crosses half the height: mean height of the face tells how far from this cell
        shift = np.clip((0.5 - (face - road) / height) * (2 * gap + 1) * spacing, -FACE, FACE)
    return dict(rise=rise, height=height, doubt=doubt, scatter=np.maximum(rough, uneven), before=slope, behind=climb,
                shift=np.nan_to_num(shift), bottom=road, skew=np.full(value.shape, skew))


class _Sums:
    """Running sums over the cells of every profile, from which levels beside any cell follow at once."""

    def __init__(self, value, spacing):
        there = np.isfinite(value)
        h, self.u = np.where(there, value, 0.0), np.arange(value.shape[1]) * spacing
        u = np.where(there, self.u, 0.0)
        self.totals = [np.concatenate([np.zeros((len(value), 1)), np.cumsum(v, axis=1)], axis=1)
                       for v in (there.astype(float), h, h * h, u, u * u, u * h)]

    def _window(self, which, first, last):
        cells = len(self.u)
        c = np.arange(cells)
        total = self.totals[which]
        return total[:, np.clip(c + last + 1, 0, cells)] - total[:, np.clip(c + first, 0, cells)]

    def mean(self, first, last):
        """Mean of the occupied cells from `first` to `last` beside every cell."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return self._window(1, first, last) / self._window(0, first, last)

    def line(self, first, last):
        """Line through those cells: its height at the cell, slope, scatter, cells used."""
        n, sz, szz, su, suu, suz = (self._window(k, first, last) for k in range(6))
        with np.errstate(invalid="ignore", divide="ignore"):
            mu, mz = su / n, sz / n
            vuu, vuz, vzz = suu / n - mu * mu, suz / n - mu * mz, szz / n - mz * mz
            slope = np.where(vuu > 1e-4, vuz / vuu, 0.0)
            scatter = np.sqrt(np.maximum(vzz - slope * vuz, 0.0) * n / np.maximum(n - 2, 1))
            return mz + slope * (self.u - mu), slope, scatter, n


def _median_of_rows(stack):
    """Median over the first axis without NaN (NaN where there is nothing else)."""
    count = np.isfinite(stack).sum(0)
    stack.sort(axis=0)
    low, high = np.maximum(count - 1, 0) // 2, np.minimum(count // 2, len(stack) - 1)
    return 0.5 * (np.take_along_axis(stack, low[None], 0)[0] + np.take_along_axis(stack, high[None], 0)[0])


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


def _shifted(values, rows, cells, out):
    """values[p + rows, c + cells] into out, which holds NaN where there is none."""
    moved = _moved(values, cells)
    if rows >= 0:
        out[:len(values) - rows] = moved[rows:]
    else:
        out[-rows:] = moved[:rows]


def _largest_near(values, span):
    """Largest value within `span` cells either side."""
    best = values.copy()
    for k in range(1, span + 1):
        np.maximum(best, _moved(values, k, -np.inf), out=best)
        np.maximum(best, _moved(values, -k, -np.inf), out=best)
    return best
