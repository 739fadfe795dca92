"""What is bright and has the form of paint: along the road, across it, or as a stroke."""

import numpy as np
from scipy import ndimage

from ..survey.points import UNIT
from .polygons import fill_gaps
from .shapes import CELL, measure

AVERAGE = 1.5     # cells, sigma of the average that noisy points are seen through
AROUND = 10.0     # cells, sigma of the average that this is compared with: tracks, patches and shadows are wider than strokes
CURB_FACE = 0.20  # m from the rim of the road
STRIP_AREA, STRIP_LENGTH, STRIP_ELONGATION = 0.12, 0.80, 3.5  # m2, m: least of a stroke of paint where single points are noisy


def averaged(cell, value, shape):
    """How much brighter the points about each cell are than those within half a metre.

    Parameters
    ----------
    cell : (N,) flat cell number of each point
    value : (N,) its brightness

    Returns
    -------
    (rows, columns) float32; NaN where there are no points
    """
    size = shape[0] * shape[1]
    count = np.bincount(cell, minlength=size).reshape(shape).astype(float)
    # brightness in whole 64ths sums exactly, in any order
    total = np.bincount(cell, np.rint(value.astype(float) * 64), size).reshape(shape) / 64

    def seen(sigma):
        return [ndimage.gaussian_filter(a, sigma, mode="constant", truncate=3.0) for a in (count, total)]

    (near, near_total), (around, around_total) = seen(AVERAGE), seen(AROUND)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(near > 0.05, near_total / near - around_total / around, np.nan).astype(np.float32)


def morphology(mask, settings):
    """Close gaps along the road, then drop what is short both along and across it.

    A stop line is short along the road and a lane line across it: a cell stays
    where either run through it is long enough.
    """
    length = int(round(settings.shortest / (CELL * UNIT)))
    closed = fill_gaps(mask, int(round(settings.close / (CELL * UNIT))), 0)
    return mask & (runs(closed, 0) >= length) | mask & (runs(closed, 1) >= length)


def strips(z, threshold, gutter, rim):
    """Only connected pieces that are long for their width, as strokes of paint are and blotches are not.

    An average blurs the rim of a stroke over its surroundings; half of the
    stroke's own height above asphalt is where the rim was. What hugs the road's
    rim is the face of a curb.
    """
    with np.errstate(invalid="ignore"):
        mask = (z > threshold) & ~gutter
    labels, count = ndimage.label(mask, np.ones((3, 3), bool))
    result = np.zeros(z.shape, bool)
    large = np.bincount(labels.ravel(), minlength=count + 1) * (CELL * UNIT) ** 2 >= STRIP_AREA
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        if not large[number]:
            continue
        piece = labels[box] == number
        if _long_stroke(piece) and np.median(rim[box][piece]) > CURB_FACE:
            result[box] |= piece & (z[box] > 0.5 * np.percentile(z[box][piece], 90))
    return result


def _long_stroke(piece):
    """Whether a piece is long for its width: as a whole, or branched as hatching is, area over thickness."""
    row, column = np.nonzero(piece)
    shape = measure(row * CELL, column * CELL)
    if shape.length >= STRIP_LENGTH and shape.elongation >= STRIP_ELONGATION:
        return True
    thickness = 2.0 * CELL * UNIT * ndimage.distance_transform_edt(np.pad(piece, 1)).max()
    return len(row) * (CELL * UNIT) ** 2 / thickness >= max(STRIP_LENGTH, STRIP_ELONGATION * thickness)


def runs(mask, axis):
    """Length of the run of on cells through each cell along one axis, in cells; 0 where off."""
    on = np.moveaxis(mask, axis, 0)
    index = np.arange(len(on)).reshape(-1, 1)
    before = np.maximum.accumulate(np.where(on, -1, index), axis=0)
    after = np.minimum.accumulate(np.where(on, len(on), index)[::-1], axis=0)[::-1]
    return np.moveaxis(np.where(on, after - before - 1, 0), 0, axis)
