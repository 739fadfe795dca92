"""Steps on single profiles: where the pseudo scan-line of the road ends at a rising face."""

from __future__ import annotations

import numpy as np

from ..common.corners import BEHIND_LENGTH, FACE_MARGIN, MAX_ROAD_SLOPE, MIN_STEP_SIGMAS, ROAD_SIDE_LENGTH, CurbSteps, measure_corners
from ..common.pseudo_scanlines import TOP_QUANTILE_SIGMAS, PseudoScanLines

MAX_RISE_WIDTH = 0.15             # m across within which the whole rise must lie
MIN_RAISED_CELLS = 3              # cells of raised ground behind a rise that a statement about its height needs
MIN_RAISED_HEIGHT_SHARE = 0.65    # share of the least height that these cells must show


def find_steps(lines: PseudoScanLines, min_height: float, max_height: float) -> CurbSteps:
    """Steps on every single profile of one side.

    Parameters
    ----------
    lines : PseudoScanLines
    min_height, max_height : m, of a step

    Returns
    -------
    CurbSteps, sorted by profile, then outward
    """
    rows, cells = _rising_cells(lines, min_height, max_height)
    return measure_corners(lines, rows, cells, min_height, max_height)


def _rising_cells(lines, min_height, max_height):
    """(row, cell) of the cells in which a profile crosses the middle of a step."""
    low, high, spacing = lines.low, lines.high, lines.spacing
    span = max(int(round(MAX_RISE_WIDTH / spacing)), 2)
    top = _max_ahead(high, span) - TOP_QUANTILE_SIGMAS * lines.noise[:, None]
    # the cell before must still be road: the last occupied one within the window
    before = _last_before(low, span)
    # a step's middle lies between that and its top, which it leaves half of its height below
    with np.errstate(invalid="ignore"):
        rows, cells = np.nonzero((high > before) & (top - before > 0.4 * min_height - 1e-9))
    base, slope, rough, count = _road_before(low, spacing, rows, cells)
    with np.errstate(invalid="ignore"):
        step = top[rows, cells] - base
        middle = base + 0.5 * step
        found = np.flatnonzero((count >= 3) & (step >= np.maximum(0.8 * min_height, MIN_STEP_SIGMAS * np.maximum(lines.noise[rows], rough) / 2))
                               & (step <= max_height + 0.05) & (high[rows, cells] >= middle) & (before[rows, cells] < middle))
    rows, cells, base, slope = rows[found], cells[found], base[found], slope[found]
    score = np.full(low.shape, -np.inf)
    score[rows, cells] = step[found] - 2 * rough[found]
    # of neighbouring cells only the best within the window is a step
    beyond = _max_ahead(score, span, inclusive=False)
    nearer = _max_ahead(score[:, ::-1], span, inclusive=False)[:, ::-1]
    best = score[rows, cells] >= np.maximum(beyond[rows, cells], nearer[rows, cells])
    best[best] = _stays_up(low, base[best], slope[best], rows[best], cells[best], min_height, spacing)
    return rows[best], cells[best]


def _stays_up(low, base, slope, rows, columns, min_height, spacing):
    """(M,) bool: does the ground behind rising cells look as high as a step, or is too little of it seen?

    base, slope : (M,) of the road before each. A rise due to a single high point among many need not be measured.
    """
    cells = np.arange(1, int(round(BEHIND_LENGTH / spacing)) + 1)
    padded = np.pad(low, ((0, 0), (0, len(cells))), constant_values=np.nan)
    rise = padded[rows[:, None], columns[:, None] + cells] - base[:, None] - slope[:, None] * cells * spacing
    with np.errstate(invalid="ignore"):
        raised = rise > 0.4 * min_height
    count = raised.sum(1)
    return (count < MIN_RAISED_CELLS) | (np.where(raised, rise, 0.0).sum(1) >= MIN_RAISED_HEIGHT_SHARE * min_height * count)


def _road_before(low, spacing, rows, columns):
    """Line through the principal points before some cells: its height at each cell, slope, scatter, and number of points, each (M,)."""
    cells = low.shape[1]
    reach, skip = int(round(ROAD_SIDE_LENGTH / spacing)), int(round(FACE_MARGIN / spacing))
    there = np.isfinite(low)
    value = np.where(there, low, 0.0)
    u = there * (np.arange(cells) * spacing)
    # running sums, 0 before the first cell as far as a window reaches back
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


def _max_ahead(values, span, inclusive=True):
    """Largest value in this and the following cells, NaN taken as none."""
    best = np.full(values.shape, -np.inf)
    for k in range(0 if inclusive else 1, span + 1):
        width = values.shape[1] - k
        if width > 0:
            np.fmax(best[:, :width], values[:, k:], out=best[:, :width])
    return best


def _last_before(values, span):
    """Value of the nearest occupied cell before each within the span, NaN where there is none."""
    found = np.full(values.shape, np.nan)
    found[:, 1:] = values[:, :-1]
    for k in range(2, min(span, values.shape[1] - 1) + 1):
        np.copyto(found[:, k:], values[:, :-k], where=np.isnan(found[:, k:]))
    return found
