"""Rims of granite and concrete that lie flush with the road: bright like paint, but they fade out on one side.

Paint ends sharply: a decimetre beside it nothing of its contrast is left. The stones at the rim of a road are bright at
the joint with the asphalt and fade into the ground behind them. So does the sidewalk, where it was scanned between two parked
cars, at a driveway or where it lies as high as the road.
"""

from __future__ import annotations

import numpy as np

from ...lazy import cv2
from ..road_grid import CELL_SIZE
from .gutters import PAINT_TO_GUTTER

FADING_BESIDE = 2, 4   # cells from a run of paint across the road: where its fading is measured
TOP_REACH = 6          # cells in which the brightest of a run stands for it
RUN_ALONG = 62         # cells, either way: 5 m of road that fading is averaged over
RUN_ACROSS = 3         # cells, either way, that the rim may waver
MIN_CELLS_BESIDE = 60  # that were measured there
SLIGHT_FADING, CLEAR_FADING = 0.10, 0.22   # of the contrast of a run that is left beside a rim everywhere, and in places
AREA_WIDTH = 0.35      # m across the road: broader pieces are no lines, and they are judged one by one
AREA_CELLS_BESIDE = 15  # that were measured beside them
SPECK_CELLS = 26       # what two points brighten, each the cells no farther than two from it: smaller pieces outside an area are no end of it


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


def without_fading_areas(z: np.ndarray, mask: np.ndarray, seen: np.ndarray, gutter: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """The bright cells without the broad pieces that fade out, or lead on into a gutter, on the side away from the road's middle.

    Parameters
    ----------
    z, mask, seen : of `side_fading`
    gutter : (rows, columns) bool, cells of gutters
    offsets : (columns,) m from the reference line of the road
    """
    count, label, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    broad = stats[:, cv2.CC_STAT_WIDTH] > AREA_WIDTH / CELL_SIZE
    broad[0] = False
    if not broad.any():
        return mask
    refused = np.zeros(count, bool)
    pieces = mask & (stats[:, cv2.CC_STAT_AREA] >= SPECK_CELLS)[label]
    # a speck is none of the ground beside an area, and neither are the cells that it brightens
    ground = seen & np.isfinite(z) & ~cv2.dilate(mask.astype(np.uint8), np.ones((1, 3), np.uint8)).astype(bool)
    rows = np.flatnonzero(pieces.any(axis=1))
    for outward in (-1, 1):
        # the outermost cell of each row
        columns = (pieces if outward < 0 else pieces[:, ::-1])[rows].argmax(axis=1)
        columns = columns if outward < 0 else mask.shape[1] - 1 - columns
        number = label[rows, columns]
        own = broad[number] & (offsets[columns] * outward > 0)
        row, column, number = rows[own], columns[own], number[own]
        reach = np.clip(column[:, None] - outward * np.arange(TOP_REACH + 1), 0, mask.shape[1] - 1)
        inside = pieces[row[:, None], reach] & np.isfinite(z[row[:, None], reach])
        top = np.where(inside, z[row[:, None], reach], 0.0).max(axis=1, initial=0.0)
        # on asphalt or a sidewalk beside it, and in a gutter too
        rest, whole, cells = np.zeros((2, count)), np.zeros((2, count)), np.zeros((2, count))
        for away in range(FADING_BESIDE[0], FADING_BESIDE[1] + 1):
            beside = column + outward * away
            known = np.flatnonzero((beside >= 0) & (beside < mask.shape[1]))
            known = known[ground[row[known], beside[known]]]
            for k, counted in enumerate((known[~gutter[row[known], beside[known]]], known)):
                rest[k] += np.bincount(number[counted], z[row[counted], beside[counted]], count)
                whole[k] += np.bincount(number[counted], top[counted], count)
                cells[k] += np.bincount(number[counted], minlength=count)
        share = rest / np.maximum(whole, 1e-6)
        refused |= ((share > [[CLEAR_FADING], [1 / PAINT_TO_GUTTER]]) & (cells >= AREA_CELLS_BESIDE)).any(axis=0)
    return mask & ~refused[label] if refused.any() else mask
