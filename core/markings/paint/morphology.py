"""Bright cells in runs as long as paint, along the road or across it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...lazy import cv2
from ..road_grid import CELL_SIZE, MAX_GAP_ON_TRACK, fill_gaps

if TYPE_CHECKING:
    from .settings import MarkingSettings

WORN_GAP = 0.80  # m along the road: no painted gap is shorter, so bright specks in it belong to one worn line
ALONG_REACH = 6       # cells of 4 cm along the road, either way: points so near are on the same track
ACROSS_REACH = 2      # cells across it, either way: a track wavers by so much
MAX_TRACK_GAP = 0.50  # m across the road: more between points is no spacing but a shadow


def track_spacing(occupied: np.ndarray) -> np.ndarray:
    """Distance across the road from each cell's track of the scan to the next one, on the side where it is farther.

    Parameters
    ----------
    occupied : (rows, columns) bool, cells of 4 cm that hold points; rows along the road

    Returns
    -------
    (rows, columns) float32 m; 0 where points lie in every cell or nothing was scanned
    """
    tracks = cv2.dilate(occupied.astype(np.uint8), np.ones((2 * ALONG_REACH + 1, 1), np.uint8), borderValue=0).astype(bool)
    columns = np.arange(tracks.shape[1], dtype=np.int16)
    far = np.int16(2 * tracks.shape[1])
    # beyond the outermost tracks they are far away; a product is quicker than a choice between a column and that
    before = tracks * (columns + far)
    before = np.maximum.accumulate(before, axis=1, out=before)
    before -= far
    after = (tracks * (columns - 2 * far))[:, ::-1]
    after = np.minimum.accumulate(after, axis=1)[:, ::-1] + 2 * far
    gap = after - before
    gap[gap > int(MAX_TRACK_GAP / CELL_SIZE)] = 0
    return cv2.dilate(gap.astype(np.float32), np.ones((1, 2 * ACROSS_REACH + 1), np.uint8), borderValue=0) * np.float32(CELL_SIZE)


def morphology(mask: np.ndarray, seen: np.ndarray, settings: MarkingSettings) -> np.ndarray:
    """Close gaps along the road, then remove runs that are short both along and across it.

    A stop line is short along the road and a lane line across it: a cell stays
    where either run through it is long enough. The remains of a worn line between
    two such runs stay, too. Where points lie far apart, cells between two bright ones that no point was near are no gap.

    Parameters
    ----------
    mask : (rows, columns) bool, bright cells
    seen : (rows, columns) bool, cells whose brightness is known
    settings : MarkingSettings, of which `close` and `shortest` are used

    Returns
    -------
    (rows, columns) bool, a subset of `mask`
    """
    length = int(round(settings.shortest / CELL_SIZE))
    closed = fill_gaps(mask, int(round(settings.close / CELL_SIZE)), 0)
    along, across = (closed | _unseen_gaps(mask, seen, limit, axis) for axis, limit in enumerate((MAX_GAP_ON_TRACK, MAX_TRACK_GAP)))
    long = mask & (long_runs(along, length, 0) | long_runs(across, length, 1))
    return mask & (long | _between(long, mask)) if long.any() else long


def _unseen_gaps(mask, seen, limit, axis):
    """Cells between two bright ones, at most `limit` metres apart along an axis, if none of them was seen."""
    gaps = fill_gaps(mask, int(round(limit / CELL_SIZE)), axis) & ~mask
    if not (gaps & ~seen).any():
        return np.zeros(mask.shape, bool)
    ends, dark, gaps = (cells if axis == 0 else cells.T for cells in (mask, seen & ~mask, gaps))
    gaps = gaps & _met_since(ends, dark) & _met_since(ends[::-1], dark[::-1])[::-1]
    return gaps if axis == 0 else gaps.T


def _between(ends, specks):
    """Cells of runs along the road that connect two ends by specks, with gaps no longer than WORN_GAP.

    A run may deviate by one column: paint is not exactly parallel to the road's reference line.
    """
    beside, result = np.ones((1, 3), np.uint8), np.zeros(specks.shape, bool)
    ends, specks = (cv2.dilate(mask.view(np.uint8), beside, borderValue=0).view(bool) for mask in (ends, specks))
    columns = np.flatnonzero(ends.any(axis=0))
    ends, specks = np.ascontiguousarray(ends[:, columns]), np.ascontiguousarray(specks[:, columns])
    run = fill_gaps(specks, int(round(WORN_GAP / CELL_SIZE)), 0)
    result[:, columns] = run & _met_since(ends, ~run) & _met_since(ends[::-1], ~run[::-1])[::-1]
    return result


def _met_since(ends, breaks):
    """Cells from which an end is reached before a break, going back along the first axis."""
    # what was met last: twice its row, and 1 more where it is an end and no break
    twice = np.arange(2, 2 * len(ends) + 2, 2, dtype=np.int16)[:, None]
    met = (ends | breaks) * twice
    met += ends > breaks
    met = np.maximum.accumulate(met, axis=0, out=met)
    met &= np.int16(1)
    return met.astype(bool)


def long_runs(mask: np.ndarray, length: int, axis: int) -> np.ndarray:
    """The cells that lie in runs of a minimum length along an axis.

    Parameters
    ----------
    mask : (rows, columns) bool
    length : cells
    axis : 0 along the road, 1 across it

    Returns
    -------
    (rows, columns) bool, a subset of `mask`
    """
    if length < 2:
        return mask.copy()
    size, behind = ((1, length), (0, length - 1)) if axis == 0 else ((length, 1), (length - 1, 0))
    along = np.ones(size[::-1], np.uint8)
    # outside the window all cells are off
    begun = cv2.erode(mask.astype(np.uint8), along, anchor=(0, 0), borderType=cv2.BORDER_CONSTANT, borderValue=0)
    return cv2.dilate(begun, along, anchor=behind, borderType=cv2.BORDER_CONSTANT, borderValue=0).astype(bool)
