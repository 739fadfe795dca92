"""Rims of granite and concrete that lie flush with the road: bright like paint, but they fade out on one side.

Paint ends sharply: a decimetre beside it nothing of its contrast is left. The stones at the rim of a road are bright at
the joint with the asphalt and fade into the ground behind them.
"""

from __future__ import annotations

import numpy as np

from ...lazy import cv2

FADING_BESIDE = 2, 4   # cells from a run of paint across the road: where its fading is measured
TOP_REACH = 6          # cells in which the brightest of a run stands for it
RUN_ALONG = 62         # cells, either way: 5 m of road that fading is averaged over
RUN_ACROSS = 3         # cells, either way, that the rim may waver
MIN_CELLS_BESIDE = 60  # that were measured there
SLIGHT_FADING, CLEAR_FADING = 0.10, 0.22   # of the contrast of a run that is left beside a rim everywhere, and in places


def side_fading(z: np.ndarray, mask: np.ndarray, seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Share of the contrast of each run of bright cells across the road that is left just beside its ends.

    Parameters
    ----------
    z : (rows, columns) float32 brightness above asphalt; rows along the road
    mask : (rows, columns) bool, N bright cells
    seen : (rows, columns) bool, cells whose brightness was measured

    Returns
    -------
    below, above : (N,) float32, towards lower and higher columns, at the cells of the mask in their order; NaN where it is not known
    """
    cells, columns = np.flatnonzero(mask), mask.shape[1]
    if not len(cells):
        return np.empty(0, np.float32), np.empty(0, np.float32)
    z = np.where(np.isfinite(z), z, np.float32(0.0)).astype(np.float32, copy=False)
    top = cv2.dilate(np.where(mask, z, np.float32(0.0)), np.ones((1, 2 * TOP_REACH + 1), np.uint8))
    counted = (seen & ~cv2.dilate(mask.astype(np.uint8), np.ones((1, 3), np.uint8)).astype(bool)).ravel()
    # runs of cells of a row
    begins = np.r_[True, (np.diff(cells) > 1) | (cells[1:] % columns == 0)]
    first, last = cells[begins], cells[np.r_[begins[1:], True]]
    row = last // columns * columns
    found = []
    for ends, room in ((first, np.minimum(first - np.r_[-1, last[:-1]], first - row + 1)),
                       (last, np.minimum(np.r_[first[1:], mask.size] - last, row + columns - last))):
        step = 1 if ends is last else -1
        sums = np.zeros((3, mask.size), np.float32)
        for away in range(FADING_BESIDE[0], FADING_BESIDE[1] + 1):
            # up to the next run, or the end of the row
            own = ends[room > away]
            own = own[counted.take(own + step * away)]
            sums[0, own] += z.take(own + step * away)
            sums[1, own] += top.take(own)
            sums[2, own] += 1.0
        size = 2 * RUN_ACROSS + 1, 2 * RUN_ALONG + 1
        rest, whole, count = (cv2.boxFilter(a.reshape(mask.shape), -1, size, normalize=False, borderType=cv2.BORDER_CONSTANT).take(ends)
                              for a in sums)
        share = np.where(count >= MIN_CELLS_BESIDE, rest / np.maximum(whole, np.float32(1e-6)), np.float32(np.nan))
        # every cell of a run has what its end has
        found.append(share.take(np.cumsum(begins) - 1))
    return found[0], found[1]


def without_fading_rims(z: np.ndarray, mask: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """The bright cells without the runs that fade out on one side; the parameters are those of `side_fading`."""
    share = np.maximum(*(np.nan_to_num(side) for side in side_fading(z, mask, seen)))
    if not (share > CLEAR_FADING).any():
        return mask.copy()
    fading = np.zeros(mask.shape, np.float32)
    fading[mask] = share
    count, label = cv2.connectedComponents((fading > SLIGHT_FADING).astype(np.uint8), connectivity=8, ltype=cv2.CV_32S)
    clear = np.bincount(label[fading > CLEAR_FADING], minlength=count) > 0
    return mask & ~clear[label]
