"""Paint that was scanned sparsely: what lies between two tracks of the scan is as they are.

A scanner leaves tracks that lie 2 cm apart beside the vehicle and three decimetres apart on the far side of a
motorway. Where both of two neighbouring tracks show paint, no gap was seen between them, so the cells between
them belong to the marking; where the tracks lie closer than cells, nothing is added.
"""

from __future__ import annotations

import numpy as np

from ...common.arrays import stretch_of
from ...lazy import cv2
from .road_grid import CELL_SIZE

TRACK_WIDTH = 0.03       # m that points may lie farther apart than the middles of their tracks
MIN_TRACK_GAP = 0.10     # m: points so near across the road are of one marking in any case
MAX_GAP_ON_TRACK = 0.40  # m along the road between points on one track
ROWS_AT_ONCE = 2500      # of cells, along the road, that are filled together: 100 m


def fill_gaps(mask: np.ndarray, limit: int, axis: int = 0) -> np.ndarray:
    """Close runs of at most `limit` cells that are off between two that are on, along one axis."""
    if limit < 1:
        return mask.copy()
    length = limit + 1
    size, behind = ((1, length), (0, length - 1)) if axis == 0 else ((length, 1), (length - 1, 0))
    along = np.ones(size[::-1], np.uint8)
    margin = [length, length, 0, 0] if axis == 0 else [0, 0, length, length]
    # off beyond the rim, so that nothing is closed towards it
    grown = cv2.dilate(cv2.copyMakeBorder(mask.astype(np.uint8), *margin, cv2.BORDER_CONSTANT, value=0), along, anchor=(0, 0))
    closed = cv2.erode(grown, along, anchor=behind)
    return closed[margin[0]:margin[0] + mask.shape[0], margin[2]:margin[2] + mask.shape[1]].astype(bool)


def track_reach(spacing: np.ndarray) -> np.ndarray:
    """How far apart across the road points of one marking may lie for the spacing of the scan alone, m.

    Parameters
    ----------
    spacing : (N,) int, mm across the road between the tracks of the scan

    Returns
    -------
    (N,) float, 0 where points lie close together
    """
    reach = spacing * 1e-3 + TRACK_WIDTH
    return np.where(reach > MIN_TRACK_GAP, reach, 0.0)


def filled_between_tracks(cells: np.ndarray, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cells of a marking with those between neighbouring tracks of the scan.

    Parameters
    ----------
    cells : (K, 2) int, along the road and across it, different ones
    reach : (K,) m of `track_reach`

    Returns
    -------
    mask : (A, B) bool, first axis along the road, with a rim of cells that are off
    first : (2,) int, the cell of mask[0, 0]
    """
    first = cells.min(axis=0) - 1
    shape = cells.max(axis=0) - first + 2
    mask = np.zeros(shape, bool)
    mask[tuple((cells - first).T)] = True
    gaps = np.rint(reach / CELL_SIZE).astype(int)
    wide = gaps > 0
    if not wide.any():
        return mask, first
    (row, column), gaps = (cells[wide] - first).T, gaps[wide]
    order = np.argsort(row, kind="stable")
    row, column, gaps = np.ascontiguousarray(row[order]), column[order], gaps[order]
    longest = int(round(MAX_GAP_ON_TRACK / CELL_SIZE))
    # a marking may be as long as the road
    for begin in range(0, len(mask), ROWS_AT_ONCE):
        near = stretch_of(row, begin - longest, begin + ROWS_AT_ONCE + longest - 1)
        if near.stop > near.start:
            _fill(mask[begin:begin + ROWS_AT_ONCE], row[near] - begin, column[near], gaps[near], longest)
    return mask, first


def _fill(mask, row, column, gaps, longest):
    """Turn on, in some rows of a mask, the cells between those at (N,) places with gaps, of these rows and `longest` rows before and behind them."""
    # along each track first: two tracks rarely show points at the same station
    sparse = np.zeros((len(mask) + 2 * longest, mask.shape[1]), np.int16)
    here = row < len(mask) + longest
    sparse[row[here] + longest, column[here]] = gaps[here]
    on_track = fill_gaps(sparse > 0, longest, 0)
    own = slice(longest, longest + len(mask))
    widest = np.where(on_track & (sparse == 0), _carried(sparse), sparse)[own]
    mask |= on_track[own]
    for gap in np.unique(gaps).tolist():
        mask |= fill_gaps(widest >= gap, gap, 1)


def _carried(values):
    """(A, B) the value last met along the first axis."""
    row = np.maximum.accumulate(np.where(values > 0, np.arange(len(values))[:, None], 0), axis=0)
    return np.take_along_axis(values, row, axis=0)
