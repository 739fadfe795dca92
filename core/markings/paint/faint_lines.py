"""Lines that are brighter than what lies on both sides of them, however bright that is.

A threshold above the usual asphalt misses a line where the ground is darker than usual or the strip beside it brighter,
as at the inside of a hairpin. What is painted there still stands out against both its sides, over metres along the road.
"""

from __future__ import annotations

import numpy as np

from ...lazy import cv2
from ..road_grid import fill_gaps
from .noisy import local_scatter

STROKE_CELLS = 3          # across the road: 12 cm, of which the line is the mean
FLANK_CELLS = 4, 5        # from the middle of the stroke: what lies beside it, on either side
BEYOND_CELLS = 15         # from the middle of the stroke: the ground of the half metre farther on, where it was scanned
LEAST_RIM = 0.22          # m from the middle of the stroke to the rim of what was scanned: both flanks are ground, and no gutter ends there
MEAN_ALONG = 13           # cells: half a metre that both are taken over
MIN_CELLS_AVERAGED = 6    # of the stroke, and of the flanks, that were scanned
STROKE_REACH = 2          # cells from the middle of the stroke that may be paint
DRIFT_CELLS = 1           # either way that a line wavers from row to row
LONGEST_BREAK = 15        # cells along the road: a worn spot
SHORTEST_LINE = 50        # cells along the road: 2 m
MIN_PAINTED_SHARE = 0.65  # of the cells of a line: wear leaves more, and of even ground half are brighter than the mean
MAX_REFUSED_SHARE = 0.05  # of the cells of a line
LEAST_RATIO = 0.10        # of the brightness beside it, by which a line is brighter
CLEAR_SIGMAS = 3.0        # standard deviations of what asphalt shows, by which a line stands out


def faint_lines(brightness: np.ndarray, scanned: np.ndarray, rim: np.ndarray, found: np.ndarray,
                refused: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cells of narrow lines along the road, where there is no paint yet.

    Parameters
    ----------
    brightness : (rows, columns) NaN where nothing was scanned; rows along the road
    scanned : (rows, columns) bool, cells that points lie in
    rim : (rows, columns) m from the rim of what was scanned
    found : (rows, columns) bool, paint that a threshold found
    refused : (rows, columns) bool, what it found and what is none: a line that is such in part is none

    Returns
    -------
    lines : (rows, columns) bool
    halfway : (rows, columns) float32, the brightness halfway from beside the line to the line, at its cells
    """
    known = scanned & np.isfinite(brightness)
    # (2, rows, columns) how many cells and their sum, over half a metre along the road
    sums = np.stack([cv2.boxFilter(a, -1, (1, MEAN_ALONG), normalize=False, borderType=cv2.BORDER_CONSTANT)
                     for a in (known.astype(np.float32), np.where(known, brightness, 0.0).astype(np.float32))])
    half = STROKE_CELLS // 2
    stroke = _mean(sums, range(-half, half + 1))
    beside = np.maximum(_mean(sums, FLANK_CELLS), _mean(sums, [-step for step in FLANK_CELLS]))
    # between two dark seams asphalt is no line: it is no brighter than what lies beyond them
    beyond = range(FLANK_CELLS[1] + 1, BEYOND_CELLS + 1), range(-FLANK_CELLS[1] - 1, -BEYOND_CELLS - 1, -1)
    with np.errstate(invalid="ignore"):
        clear = stroke - beside > LEAST_RATIO * beside
        cells = np.flatnonzero(clear)
        own = np.fmax(beside.take(cells), np.fmax(*(_mean(sums, steps, cells) for steps in beyond)))
        clear.ravel()[cells] = stroke.take(cells) - own > LEAST_RATIO * own
    lines, halfway = np.zeros(known.shape, bool), np.full(known.shape, np.inf, np.float32)
    # most windows have no such line: what asphalt scatters by is not asked for there
    if not (_long_lines(_wavering(clear & (rim > LEAST_RIM)), lines) * clear * ~_near(found)).any():
        return lines, halfway
    beside = np.fmax(beside, np.where(np.isfinite(beside), np.fmax(*(_mean(sums, steps) for steps in beyond)), np.nan))
    above = stroke - beside
    with np.errstate(invalid="ignore"):
        clear &= above > CLEAR_SIGMAS * local_scatter(above)
    above = np.where(clear, above, 0.0).astype(np.float32)
    # the middle of the stroke
    ridge = clear & (rim > LEAST_RIM) & (above >= cv2.dilate(above, np.ones((1, 2 * STROKE_REACH + 1), np.uint8)))
    line = np.where(ridge & ~_near(found), _long_lines(_wavering(ridge), refused), 0)
    row, column = np.nonzero(line)
    level = ((stroke + beside) / 2)[row, column]
    # (n, steps) the cells of the stroke about each cell of its middle
    across = np.clip(column[:, None] + np.arange(-STROKE_REACH, STROKE_REACH + 1), 0, line.shape[1] - 1)
    along = np.broadcast_to(row[:, None], across.shape)
    seen = known[along, across]
    with np.errstate(invalid="ignore"):
        bright = seen & (brightness[along, across] > level[:, None])
    # a few bright specks raise a mean, too
    number = line[row, column]
    inner = slice(STROKE_REACH - half, STROKE_REACH + half + 1)
    filled = [np.bincount(number, cells[:, inner].sum(axis=1), line.max() + 1) for cells in (bright, seen)]
    bright &= (filled[0] >= MIN_PAINTED_SHARE * filled[1])[number][:, None]
    lines[along[bright], across[bright]] = True
    np.minimum.at(halfway, (along[bright], across[bright]), np.broadcast_to(level[:, None], bright.shape)[bright].astype(np.float32))
    return lines, halfway


def _mean(sums, steps, cells=None):
    """Mean over the columns some steps beside all cells, or beside some of them, (n,) flat numbers; NaN where too few cells were scanned."""
    count, total = (sum(_beside(a, step) if cells is None else _beside_some(a, step, cells) for step in steps) for a in sums)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(count >= MIN_CELLS_AVERAGED, total / count, np.float32(np.nan))


def _beside(values, step):
    """Values some columns farther on, 0 beyond the last."""
    found = np.zeros_like(values)
    last = values.shape[1] - abs(step)
    if last > 0:
        found[:, max(-step, 0):max(-step, 0) + last] = values[:, max(step, 0):max(step, 0) + last]
    return found


def _beside_some(values, step, cells):
    """The same beside some cells."""
    column = cells % values.shape[1] + step
    return np.where((column >= 0) & (column < values.shape[1]), values.take(cells + step, mode="clip"), np.float32(0.0))


def _wavering(mask):
    """Cells of a mask and those that a line wavers to."""
    return cv2.dilate(mask.astype(np.uint8), np.ones((1, 2 * DRIFT_CELLS + 1), np.uint8)).astype(bool)


def _near(mask):
    """Cells beside some others, on either side of them."""
    box = np.ones((MEAN_ALONG, 2 * max(FLANK_CELLS) + 1), np.uint8)
    return cv2.dilate(mask.astype(np.uint8), box, borderType=cv2.BORDER_CONSTANT, borderValue=0).astype(bool)


def _long_lines(course, refused):
    """Numbers, from 1 on, of the pieces that run on along the road for long enough, slowly across it too; 0 elsewhere."""
    closed = fill_gaps(course, LONGEST_BREAK, 0)
    count, label, stats, _ = cv2.connectedComponentsWithStats(closed.astype(np.uint8), connectivity=8)
    area = np.maximum(stats[:, cv2.CC_STAT_AREA], 1)
    long = (stats[:, cv2.CC_STAT_HEIGHT] >= SHORTEST_LINE + MEAN_ALONG) & (np.bincount(label[refused], minlength=count) <= MAX_REFUSED_SHARE * area)
    long[0] = False
    return np.where(long, np.arange(count), 0)[label]
