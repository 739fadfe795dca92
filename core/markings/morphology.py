"""What is bright and has the length of paint, along the road or across it."""

import cv2
import numpy as np

from ..survey.points import UNIT
from .shapes import CELL, fill_gaps


def morphology(mask, settings):
    """Close gaps along the road, then drop what is short both along and across it.

    A stop line is short along the road and a lane line across it: a cell stays
    where either run through it is long enough.
    """
    length = int(round(settings.shortest / (CELL * UNIT)))
    closed = fill_gaps(mask, int(round(settings.close / (CELL * UNIT))), 0)
    return mask & (long_runs(closed, length, 0) | long_runs(closed, length, 1))


def long_runs(mask, length, axis):
    """The on cells in runs of at least `length` cells along one axis."""
    if length < 2:
        return mask.copy()
    size, behind = ((1, length), (0, length - 1)) if axis == 0 else ((length, 1), (length - 1, 0))
    along = np.ones(size[::-1], np.uint8)
    # off beyond the rim
    begun = cv2.erode(mask.astype(np.uint8), along, anchor=(0, 0), borderType=cv2.BORDER_CONSTANT, borderValue=0)
    return cv2.dilate(begun, along, anchor=behind, borderType=cv2.BORDER_CONSTANT, borderValue=0).astype(bool)
