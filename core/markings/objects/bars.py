"""Bars across the road, as stop lines are, and the lines that end at them.

A stop line between two lanes touches the end of the line that divides them. Their cluster is
shorter and narrower than markings that are cut along whole strips, most of all where one of the two
is worn, so the bar is known by its own form: it is as thick as stop lines are, full, and the line
leaves its front or its rear.
"""

from __future__ import annotations

import numpy as np

from ...common.runs import stretch_of
from ..road_grid import CELL_SIZE, fill_gaps
from .classify import MIN_STOP_LINE_FILL

WIDTH_STEP, WIDTH_TOLERANCE = 12, 2     # cells along a line whose width is taken together, and across by which it may be uneven
MAX_WIDTH_ALONE = 0.34                  # m of an even strip with nothing beside it; a double line is broader
MIN_LENGTH_BESIDE_BAR = 1.0             # m along the road: what is shorter is nothing but a bar
FRAYED_RIM = 0.12                       # m that a bar may reach farther along the road at a place; the tip of an arrow is longer
MAX_PAINT_GAP = 0.24                    # m across the road, closed; the stripes of a zebra crossing leave more
MAX_SCAN_GAP = 0.40                     # m between scan lines, closed
STOP_LINE_PIECE_THICKNESS = 0.18, 0.90  # m along the road of a stop line's pieces
MIN_STOP_LINE_PIECE = 0.8               # m across: a row of shorter blocks is a give-way line


def even_strip(cells: np.ndarray) -> tuple[np.ndarray, float]:
    """Which cells of a strip lie within its usual width about its middle, as what touches it does not.

    Parameters
    ----------
    cells : (K, 2) int, along the strip and across it

    Returns
    -------
    even : (K,) bool
    width : the usual width, cells
    """
    step = (cells[:, 0] - cells[:, 0].min()) // WIDTH_STEP
    count = int(step.max()) + 1
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, step, cells[:, 1])
    np.maximum.at(high, step, cells[:, 1])
    seen = np.isfinite(low)
    usual = np.median((high - low)[seen])
    even = np.flatnonzero(seen & (high - low <= usual + WIDTH_TOLERANCE))
    middle = np.interp(step, even, (low[even] + high[even]) / 2)
    return np.abs(cells[:, 1] - middle) <= (usual + WIDTH_TOLERANCE) / 2, usual


def complete_bar(parts: np.ndarray, bar: np.ndarray, turned: np.ndarray, along: np.ndarray) -> None:
    """Give a bar what is left over between its front and its rear: where it is worn it is no less its paint.

    Parameters
    ----------
    parts : (K,) int, the part of every cell, below 0 for what is left over; changed in place
    bar : (N,) the numbers of its cells, ascending
    turned : (K, 2) int cells, across the road first, sorted along it
    along : (K,) the second column of `turned`
    """
    own = turned[bar]
    (left, front), (right, rear) = own.min(axis=0), own.max(axis=0)
    about = stretch_of(along, front, rear)
    near = about.start + np.flatnonzero((parts[about] < 0) & (turned[about, 0] >= left) & (turned[about, 0] <= right))
    some = np.sort(np.concatenate([bar, near]))
    inside, _ = even_strip(turned[some])
    parts[some[inside & (parts[some] < 0)]] = parts[bar[0]]


def bar_with_lines(cells: np.ndarray) -> tuple[np.ndarray, int]:
    """Cut a bar from the lines that end at it or cross it, if that is all there is.

    Parameters
    ----------
    cells : (K, 2) int, along the road and across it, different ones

    Returns
    -------
    parts : (K,) int, the part of every cell, numbered from 0
    count : how many there are; 1 for anything else

    Notes
    -----
    The head of an arrow is no bar: it is longer or has a tip.
    """
    whole = np.zeros(len(cells), np.int64), 1
    if not len(cells):
        return whole
    first = cells.min(axis=0)
    mask = np.zeros(cells.max(axis=0) - first + 1, bool)
    mask[tuple((cells - first).T)] = True
    for axis, gap in enumerate((MAX_SCAN_GAP, MAX_PAINT_GAP)):
        mask = fill_gaps(mask, int(round(gap / CELL_SIZE)), axis)
    reach = np.where(mask.any(axis=1), mask.shape[1] - mask[:, ::-1].argmax(axis=1) - mask.argmax(axis=1), 0)
    broad = np.flatnonzero(reach * CELL_SIZE > MAX_WIDTH_ALONE)
    if not len(broad):
        return whole
    front, rear = broad[0], broad[-1] + 1
    across = np.flatnonzero(mask[front:rear].any(axis=0))
    box = mask[front:rear, across[0]:across[-1] + 1]
    thin, thick = STOP_LINE_PIECE_THICKNESS
    if not thin <= len(box) * CELL_SIZE <= thick or box.shape[1] * CELL_SIZE < MIN_STOP_LINE_PIECE or box.mean() < MIN_STOP_LINE_FILL:
        return whole
    row, parts, count = cells[:, 0] - first[0], np.zeros(len(cells), np.int64), 1
    for side, length in ((row < front, front * CELL_SIZE), (row >= rear, (len(mask) - rear) * CELL_SIZE)):
        if FRAYED_RIM < length < MIN_LENGTH_BESIDE_BAR:
            return whole
        if length > FRAYED_RIM:
            parts[side], count = count, count + 1
    return parts, count
