"""Steps on pseudo scan-lines: where the road ends against a face, profile by profile.

A step is sought outward from the vehicle: a smooth road side, a rise within
WINDOW, ground that stays up behind it. The bottom corner is then measured from
the raw points, where the road's line meets the line of the face, so that it does
not carry the grain of the cells.
"""

import numpy as np

from .corners import BEHIND, CLEARANCE, ROAD_SIDE, SIGMAS, STEEPEST_ROAD, measure_corners
from .profiles import HIGH_SIGMA, PseudoScanLines

WINDOW = 0.15       # m across within which the whole rise must lie
SEEN_BEHIND = 3     # cells of raised ground behind a rise that tell its height
LOW_LOOK = 0.65     # share of the least height that they must show


def find_steps(lines: PseudoScanLines, least, highest):
    """Steps between `least` and `highest` metres on every profile of one side.

    Returns
    -------
    Steps, sorted by profile, then outward
    """
    rows, cells = _rising_cells(lines, least, highest)
    return measure_corners(lines, rows, cells, least, highest)


def _rising_cells(lines, least, highest):
    """(row, cell) of the cells in which a profile crosses the middle of a step."""
    low, high, spacing = lines.low, lines.high, lines.spacing
    span = max(int(round(WINDOW / spacing)), 2)
    top = max_ahead(high, span) - HIGH_SIGMA * lines.noise[:, None]
    # the cell before must still be road: the last occupied one within the window
    before = last_before(low, span)
    # a step's middle lies between that and its top, which it leaves half of its height below
    with np.errstate(invalid="ignore"):
        rows, cells = np.nonzero((high > before) & (top - before > 0.4 * least - 1e-9))
    base, slope, rough, count = road_before(low, spacing, rows, cells)
    with np.errstate(invalid="ignore"):
        step = top[rows, cells] - base
        middle = base + 0.5 * step
        found = np.flatnonzero((count >= 3) & (step >= np.maximum(0.8 * least, SIGMAS * np.maximum(lines.noise[rows], rough) / 2))
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
    cells = np.arange(1, int(round(BEHIND / spacing)) + 1)
    padded = np.pad(low, ((0, 0), (0, len(cells))), constant_values=np.nan)
    rise = padded[rows[:, None], columns[:, None] + cells] - base[:, None] - slope[:, None] * cells * spacing
    with np.errstate(invalid="ignore"):
        raised = rise > 0.4 * least
    count = raised.sum(1)
    return (count < SEEN_BEHIND) | (np.where(raised, rise, 0.0).sum(1) >= LOW_LOOK * least * count)


def road_before(low, spacing, rows, columns):
    """Line through the principal points before some cells: its height at each, slope, scatter, and count, (M,) each."""
    cells = low.shape[1]
    reach, skip = int(round(ROAD_SIDE / spacing)), int(round(CLEARANCE / spacing))
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
        slope = np.clip(slope, -STEEPEST_ROAD, STEEPEST_ROAD)
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
