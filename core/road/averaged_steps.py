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

from .corners import MOST_SKEW, SIGMAS, STEEPEST_ROAD, Steps

AVERAGE = 1.25       # m of road averaged
SKEW_STEP = 0.1      # m outward per m along between the directions tried: 3 cm at the ends of the average
LEAST_ROWS = 0.5     # share of the profiles averaged that must have ground in a cell
FIT = 0.35           # m of road, and of ground behind, to which a level is fitted
FACE = 0.09          # m either side of a step left out of both levels: the blurred face
STEEP_HALF = 0.07    # m either side of a step within which most of the rise must lie
STEEP_SHARE = 0.65   # of the height, more than an even rise from level to level has
LEAST_FILLED = 0.6   # share of the cells of a level that must hold ground
ALONE = 0.20         # m across within which one step is reported
ROUGH = 0.008        # m, scatter of averaged heights about their level: verges and banks have more


def find_averaged_steps(lines, least, highest):
    """Steps between `least` and `highest` metres of the averaged profiles of one side.

    Parameters
    ----------
    lines : PseudoScanLines; the first and last AVERAGE / 2 metres serve the averages of the others
    least, highest : metres

    Returns
    -------
    Steps, sorted by profile, then outward. The offset is that of half the height: a
    blurred face does not tell its bottom from its top.
    """
    best = None
    for skew in np.arange(-MOST_SKEW, MOST_SKEW + 1e-9, SKEW_STEP):
        seen = _Averaged(lines, skew).rises()
        if best is None:
            best = seen
            continue
        better = seen["rise"] > best["rise"]
        for name, values in seen.items():
            best[name] = np.where(better, values, best[name])
    good = ((best["height"] >= least) & (best["height"] <= highest) & (best["height"] >= SIGMAS * best["doubt"])
            & (best["rise"] >= STEEP_SHARE * best["height"]) & (best["scatter"] <= ROUGH)
            & (np.abs(best["before"]) <= STEEPEST_ROAD) & (np.abs(best["behind"]) <= STEEPEST_ROAD))
    score = np.where(good, best["rise"], -np.inf)
    rows, cells = np.nonzero(good & (score >= _largest_near(score, int(round(ALONE / lines.spacing)))))
    pick = {name: values[rows, cells] for name, values in best.items()}
    count = np.diff(lines.starts).reshape(lines.shape)
    reach = int(round((FACE + FIT) / lines.spacing))
    total = np.concatenate([np.zeros((len(count), 1), np.int64), np.cumsum(count, axis=1)], axis=1)
    first, last = np.maximum(cells - reach, 0), np.minimum(cells + reach + 1, lines.shape[1])
    return Steps(profile=lines.first + rows, s=(lines.first + rows + 0.5) * lines.width,
                 u=lines.offset(cells) + pick["shift"], h=pick["bottom"], skew=pick["skew"], height=pick["height"],
                 run=np.zeros(len(rows)), noise=pick["scatter"], usual=lines.spread[rows],
                 support=total[rows, cells] - total[rows, first], behind=total[rows, last] - total[rows, cells])


class _Averaged:
    """The profiles of one side averaged along one direction."""

    def __init__(self, lines, skew):
        self.spacing, self.skew = lines.spacing, skew
        half = max(int(round(0.5 * AVERAGE / lines.width)), 1)
        low = lines.low
        stack = np.full((2 * half + 1, *low.shape), np.nan)
        for k in range(-half, half + 1):
            _shifted(low, k, int(round(skew * k * lines.width / lines.spacing)), stack[k + half])
        enough = np.isfinite(stack).sum(0) >= max(LEAST_ROWS * len(stack), 2)
        self.height = np.where(enough, _median_of_rows(stack), np.nan)

    def rises(self):
        """For a step at every cell: its height, what of it lies within the face, what remains in doubt; dict of (P, C)."""
        value, spacing = self.height, self.spacing
        gap, fit = int(round(FACE / spacing)), int(round(FIT / spacing))
        road, slope, rough, n = _levels(value, -gap - fit, -gap, spacing)
        top, climb, uneven, m = _levels(value, gap, gap + fit, spacing)
        near = int(round(STEEP_HALF / spacing))
        with np.errstate(invalid="ignore", divide="ignore"):
            height = top - road
            smooth = _mean_of(value, -1, 1)
            rise = _moved(smooth, near) - _moved(smooth, -near) - 2 * near * spacing * 0.5 * (slope + climb)
            doubt = np.sqrt(rough**2 / n + uneven**2 / m) * 2.0
            filled = np.minimum(n, m) >= LEAST_FILLED * (fit + 1)
            rise = np.where(filled & np.isfinite(rise), rise, -np.inf)
            # where the profile crosses half the height: mean height of the face tells how far from this cell
            face = _mean_of(value, -gap, gap)
            shift = np.clip((0.5 - (face - road) / height) * (2 * gap + 1) * spacing, -FACE, FACE)
        return dict(rise=rise, height=height, doubt=doubt, scatter=np.maximum(rough, uneven), before=slope, behind=climb,
                    shift=np.nan_to_num(shift), bottom=road, skew=np.full(value.shape, self.skew))


def _levels(value, first, last, spacing):
    """Line through the cells from `first` to `last` beside every cell: height at the cell, slope, scatter, cells used."""
    there = np.isfinite(value)
    h = np.where(there, value, 0.0)
    steps = np.arange(first, last + 1) * spacing
    n, su, sz, suu, suz, szz = (np.zeros(value.shape) for _ in range(6))
    for k, u in zip(range(first, last + 1), steps):
        t, z = _moved(there, k, False), _moved(h, k, 0.0)
        n += t
        su += u * t
        suu += u * u * t
        sz += z
        suz += u * z
        szz += z * z
    with np.errstate(invalid="ignore", divide="ignore"):
        mu, mz = su / n, sz / n
        vuu, vuz, vzz = suu / n - mu * mu, suz / n - mu * mz, szz / n - mz * mz
        slope = np.where(vuu > 1e-4, vuz / vuu, 0.0)
        scatter = np.sqrt(np.maximum(vzz - slope * vuz, 0.0) * n / np.maximum(n - 2, 1))
    return mz - slope * mu, slope, scatter, n


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


def _mean_of(values, first, last):
    """Mean of the occupied cells from `first` to `last` beside every cell."""
    there = np.isfinite(values)
    h = np.where(there, values, 0.0)
    n = sum(_moved(there, k, False).astype(float) for k in range(first, last + 1))
    with np.errstate(invalid="ignore", divide="ignore"):
        return sum(_moved(h, k, 0.0) for k in range(first, last + 1)) / n


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
