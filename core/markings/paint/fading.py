"""Rims of granite and concrete that lie flush with the road: bright like paint, but they fade out on one side.

Paint ends sharply: a decimetre beside it nothing of its contrast is left. The stones at the rim of a road are bright at
the joint with the asphalt and fade into the ground behind them.
"""

from __future__ import annotations

import cv2
import numpy as np

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
    z : (rows, columns) brightness above asphalt; rows along the road
    mask : (rows, columns) bool, bright cells
    seen : (rows, columns) bool, cells whose brightness was measured

    Returns
    -------
    below, above : (rows, columns) float32, towards lower and higher columns, at the cells of the mask; NaN where it is not known
    """
    z = np.where(np.isfinite(z), z, 0.0).astype(np.float32)
    top = cv2.dilate(np.where(mask, z, 0.0).astype(np.float32), np.ones((1, 2 * TOP_REACH + 1), np.uint8))
    columns = np.arange(mask.shape[1], dtype=np.int32)
    near = cv2.dilate(mask.astype(np.uint8), np.ones((1, 3), np.uint8)).astype(bool)
    counted = seen & ~near
    found = []
    for step in (-1, 1):          # towards higher columns, then lower ones
        flip = slice(None, None, -step)
        runs, value, ok, high = (a[:, ::-step] for a in (mask, z, counted, top))
        # the last cell of the run before each cell
        last = np.maximum.accumulate(np.where(runs, columns, -100), axis=1)
        apart = columns - last
        ring = ok & (apart >= FADING_BESIDE[0]) & (apart <= FADING_BESIDE[1])
        row, column = np.nonzero(ring)
        sums = np.zeros((3, *mask.shape), np.float32)
        at = row, last[row, column]
        np.add.at(sums[0], at, value[row, column])
        np.add.at(sums[1], at, high[at])
        np.add.at(sums[2], at, 1.0)
        size = 2 * RUN_ACROSS + 1, 2 * RUN_ALONG + 1
        rest, whole, count = (cv2.boxFilter(a, -1, size, normalize=False, borderType=cv2.BORDER_CONSTANT) for a in sums)
        share = np.where(count >= MIN_CELLS_BESIDE, rest / np.maximum(whole, 1e-6), np.nan)
        # every cell of a run has what its end has
        end = np.minimum.accumulate(np.where(runs & ~np.roll(runs, -1, axis=1), columns, mask.shape[1] - 1)[:, ::-1], axis=1)[:, ::-1]
        share = np.where(runs, np.take_along_axis(share, end, axis=1), np.nan)
        found.append(share[:, flip])
    return found[1], found[0]


def without_fading_rims(z: np.ndarray, mask: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """The bright cells without the runs that fade out on one side; the parameters are those of `side_fading`."""
    fading = np.maximum(*(np.nan_to_num(side) for side in side_fading(z, mask, seen)))
    count, label = cv2.connectedComponents((fading > SLIGHT_FADING).astype(np.uint8), connectivity=8, ltype=cv2.CV_32S)
    clear = np.bincount(label[fading > CLEAR_FADING], minlength=count) > 0
    return mask & ~clear[label]
