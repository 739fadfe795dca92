"""From a place that is right to about a metre to one that is right to a decimetre, over the whole photo."""

from __future__ import annotations

import numpy as np

from ...common.progress import Progress
from .patches import find_patches
from .photo import Photo, SurveyedPaint, reduced
from .placement import Placement, robust_placement

# Half the side of a patch, how far it is looked for, and the largest residual of one that is used (m each), with the cell. Large patches
# hold several markings, so that one dash is not taken for the next; small ones follow the tilt of the camera and its lens.
_ROUNDS = ((10.0, 2.5, 0.6, 0.16), (5.0, 1.0, 0.25, 0.08), (3.0, 0.6, 0.15, 0.08))
_LEAST_SCORE = 0.15    # of a patch: shadows and cars spoil many, and which are right shows in that they agree
_MOST_SECOND = 0.8     # share of the best correlation that another place may have


def align(placement: Placement, paint: SurveyedPaint, photo: Photo, progress: Progress = Progress()) -> Placement | None:
    """Follow the photo's distortion from patches of the intensity image that are found in it, in ever smaller ones.

    Parameters
    ----------
    placement : Placement, right to some metres
    paint : SurveyedPaint
    photo : Photo
    progress : Progress

    Returns
    -------
    Placement of order 2, or 1 where few patches hold paint; None where they do not agree
    """
    for half, search, tolerance, cell in _ROUNDS:
        progress.check_cancelled()
        factor = max(1, round(cell / paint.cell))
        small = reduced(paint.contrast, factor)
        now = paint.cell * factor
        drawn = placement.sign * placement.drawn(photo.contrast, photo, now, small.shape, reduction=placement.reduction(photo, now))
        height, width = (n * now for n in small.shape)
        x, y = (axis.ravel() for axis in np.meshgrid(np.arange(half / 2, width, half), -np.arange(half / 2, height, half)))
        found = find_patches(small, drawn, now, x, y, half, search)
        found = found.where((found.score > _LEAST_SCORE) & (found.second < _MOST_SECOND))
        fitted = robust_placement(placement, found.x, found.y, np.column_stack([found.dx, found.dy]), tolerance, found.score, 2)
        if fitted is None:
            return None
        placement = fitted[0]
    return placement

