"""What is bright and has the length of paint, along the road or across it."""

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
    return mask & (runs(closed, 0) >= length) | mask & (runs(closed, 1) >= length)


def runs(mask, axis):
    """Length of the run of on cells through each cell along one axis, in cells; 0 where off."""
    on = np.moveaxis(mask, axis, 0)
    index = np.arange(len(on), dtype=np.int32).reshape(-1, 1)
    before = np.maximum.accumulate(np.where(on, -1, index), axis=0)
    after = np.minimum.accumulate(np.where(on, len(on), index)[::-1], axis=0)[::-1]
    return np.moveaxis(np.where(on, after - before - 1, 0), 0, axis)
