"""Steps on single profiles: where the pseudo scan-line of the road ends at a rising face."""

from __future__ import annotations

import numpy as np

from ...common.arrays import best_within
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
    # only occupied cells are looked at, profile by profile outward
    place = np.flatnonzero(np.isfinite(high))
    row = place // low.shape[1]
    column = place - row * low.shape[1]
    offset = column * spacing
    own_low, own_high = low.ravel().take(place), high.ravel().take(place)
    top = _max_ahead(high, span).ravel().take(place) - (TOP_QUANTILE_SIGMAS * lines.noise).take(row)
    # the cell before must still be road: the last occupied one within the window
    before = np.full(len(place), np.nan)
    near = (place[1:] - place[:-1] <= span) & (row[1:] == row[:-1])
    np.copyto(before[1:], own_low[:-1], where=near)
    # a step's middle lies between that and its top, which it leaves half of its height below
    with np.errstate(invalid="ignore"):
        rising = np.flatnonzero((own_high > before) & (top - before > 0.4 * min_height - 1e-9))
    place, row, column, own_high, top, before = (v.take(rising) for v in (place, row, column, own_high, top, before))
    base, slope, rough, count = _road_before(low, own_low, offset, spacing, row, column)
    with np.errstate(invalid="ignore"):
        step = top - base
        middle = base + 0.5 * step
        found = np.flatnonzero((count >= 3) & (step >= np.maximum(0.8 * min_height, MIN_STEP_SIGMAS * np.maximum(lines.noise.take(row), rough) / 2))
                               & (step <= max_height + 0.05) & (own_high >= middle) & (before < middle))
    # of neighbouring cells only the best within the window is a step
    best = found[best_within(place.take(found), row.take(found), (step - 2 * rough).take(found), span)]
    row, column, base, slope = (v.take(best) for v in (row, column, base, slope))
    up = _stays_up(low, base, slope, row, column, min_height, spacing)
    return row[up], column[up]


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


def _road_before(low, heights, offsets, spacing, rows, columns):
    """Line through the principal points before some cells: its height at each cell, slope, scatter, and number of points, each (M,).

    low : (P, C) principal points; heights, offsets : (N,) m, of the occupied cells, in order
    """
    reach, skip = int(round(ROAD_SIDE_LENGTH / spacing)), int(round(FACE_MARGIN / spacing))
    # of the occupied cells, those before a cell are a range
    held = np.zeros(low.size + 1, np.int32)
    np.cumsum(np.isfinite(low), out=held[1:])
    start = rows * low.shape[1]
    first, end = (held.take(start + np.maximum(columns + 1 - back, 0)).astype(np.intp) for back in (reach + skip, skip))
    n = end - first
    bounds = np.c_[first, end].ravel()
    u, z = np.append(offsets, 0.0), np.append(heights, 0.0)

    def window(terms):
        return np.add.reduceat(terms, bounds)[::2] if len(bounds) else np.empty(0)

    su, sz, suz, suu, szz = (window(terms) for terms in (u, z, u * z, u * u, z * z))
    with np.errstate(all="ignore"):
        mu, mz = su / n, sz / n
        vuu, vuz, vzz = suu / n - mu * mu, suz / n - mu * mz, szz / n - mz * mz
        slope = np.where(vuu > 1e-4, vuz / vuu, 0.0)
        slope = np.clip(slope, -MAX_ROAD_SLOPE, MAX_ROAD_SLOPE)
        rough = np.sqrt(np.maximum(vzz - 2 * slope * vuz + slope * slope * vuu, 0.0))
        return mz + slope * (columns * spacing - mu), slope, rough, n


def _max_ahead(values, span):
    """Largest value in this and the following cells, NaN taken as none."""
    best, width = np.fmax(values, -np.inf), 1
    # windows of twice the width, and one that overlaps
    while width <= span:
        by = min(width, span + 1 - width, values.shape[1])
        wider = best.copy()
        np.maximum(best[:, :values.shape[1] - by], best[:, by:], out=wider[:, :values.shape[1] - by])
        best, width = wider, width + by
    return best
