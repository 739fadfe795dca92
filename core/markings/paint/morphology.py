"""What is bright and has the length of paint, along the road or across it."""

import cv2
import numpy as np

from ...survey.store.records import COORDINATE_SCALE
from ..objects.road_grid import CELL_UNITS
from ..objects.shape import fill_gaps

WORN = 0.80  # m along the road: no gap is painted shorter, so what bright specks lead over is one worn line


def morphology(mask, settings):
    """Close gaps along the road, then drop what is short both along and across it.

    A stop line is short along the road and a lane line across it: a cell stays
    where either run through it is long enough. What wear has left of a line between
    two such runs stays, too.
    """
    length = int(round(settings.shortest / (CELL_UNITS * COORDINATE_SCALE)))
    closed = fill_gaps(mask, int(round(settings.close / (CELL_UNITS * COORDINATE_SCALE))), 0)
    long = mask & (long_runs(closed, length, 0) | long_runs(closed, length, 1))
    return mask & (long | _between(long, mask)) if long.any() else long


def _between(ends, specks):
    """Cells of runs along the road that lead from one end to another by specks no farther apart than wear takes a line away.

    A run may leave its column by one: the road's frame is not the paint's.
    """
    beside, result = np.ones((1, 3), np.uint8), np.zeros(specks.shape, bool)
    ends, specks = (cv2.dilate(mask.view(np.uint8), beside, borderValue=0).view(bool) for mask in (ends, specks))
    columns = np.flatnonzero(ends.any(axis=0))
    ends, specks = np.ascontiguousarray(ends[:, columns]), np.ascontiguousarray(specks[:, columns])
    run = fill_gaps(specks, int(round(WORN / (CELL_UNITS * COORDINATE_SCALE))), 0)
    result[:, columns] = run & _met_since(ends, ~run) & _met_since(ends[::-1], ~run[::-1])[::-1]
    return result


def _met_since(ends, breaks):
    """Cells from which, going back along the first axis, an end is met before a break."""
    row = np.arange(1, len(ends) + 1, dtype=np.int16)[:, None]
    last_end, last_break = (np.maximum.accumulate(np.where(mask, row, np.int16(0)), axis=0) for mask in (ends, breaks))
    return last_end > last_break


def long_runs(mask, length, axis):
    """The on cells in runs of at least `length` cells along one axis."""
    if length < 2:
        return mask.copy()
    size, behind = ((1, length), (0, length - 1)) if axis == 0 else ((length, 1), (length - 1, 0))
    along = np.ones(size[::-1], np.uint8)
    # off beyond the rim
    begun = cv2.erode(mask.astype(np.uint8), along, anchor=(0, 0), borderType=cv2.BORDER_CONSTANT, borderValue=0)
    return cv2.dilate(begun, along, anchor=behind, borderType=cv2.BORDER_CONSTANT, borderValue=0).astype(bool)
