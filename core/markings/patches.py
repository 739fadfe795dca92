"""Bright patches of road: repairs and concrete slabs, which are larger either way than any paint is filled.

Lines, arrows, letters and the bars of crossings and hatching leave asphalt within
a metre of every place. Where a whole square metre is brighter than the road about
it, that is what the road is made of there, and paint on it is brighter still.
"""

import cv2
import numpy as np
from scipy import ndimage

from .thresholds import asphalt

SQUARE = 25       # cells of 4 cm: 1 m
ABOUT = 7         # cells: a spot is bright where most of the 28 cm about it are
RAGGED = 3        # cells: the rim of a patch
TAIL = 3.0        # of its own spreads: how far the brightest of a patch lies above its median


def patch_level(z, bright):
    """What bright patches are brighter than the asphalt about them, so much as they scatter more included.

    Parameters
    ----------
    z : (rows, columns) brightness in spreads above asphalt, NaN where nothing was scanned
    bright : spreads, what is brighter is not the asphalt about

    Returns
    -------
    (rows, columns) float32 spreads, 0 outside patches
    """
    level = np.zeros(z.shape, np.float32)
    seen = np.isfinite(z)
    with np.errstate(invalid="ignore"):
        above = z > bright
    if np.count_nonzero(above) < SQUARE**2 // 2:
        return level
    share, known = (cv2.boxFilter(a.astype(np.float32), -1, (ABOUT, ABOUT), normalize=False, borderType=cv2.BORDER_CONSTANT)
                    for a in (above, seen))
    filled = (share > 0.5 * known) & (known > 0.1 * ABOUT**2)
    core = _morphed(cv2.erode, filled, SQUARE)
    if not core.any():
        return level
    whole = _morphed(cv2.dilate, core, SQUARE + 2 * RAGGED) & (filled | above)
    labels, count = ndimage.label(whole)
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        piece = labels[box] == number
        values = z[box][piece & seen[box]]
        if len(values):
            median, spread = asphalt(values)
            level[box][piece] = median + TAIL * max(spread - 1.0, 0.0)
    return level


def _morphed(operation, mask, side):
    """A mask worn off or grown by squares; off beyond its rim."""
    square = np.ones((side, side), np.uint8)
    return operation(mask.astype(np.uint8), square, borderType=cv2.BORDER_CONSTANT, borderValue=0).astype(bool)
