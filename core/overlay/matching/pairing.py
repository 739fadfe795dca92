"""Corners of paint paired: found in the photo by their surroundings, and judged by what the others say."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .patches import find_patches
from .photo import Photo, SurveyedPaint
from .placement import Placement, highest_order, left_out_residuals, robust_placement
from .proposal import ProposalSettings

LEAST_PAIRS = 6         # pairs that agree, below which a fit may be chance: twice what turn, scale and shift need
_LEAST_SHARE = 0.4      # of the corners that look alike, which must agree on one placement
_PATCH = 0.8            # m, half the side of the cut-out that is compared: a dash's end, an arrow's corner
_ROUNDS = ((0.40, 1.5), (0.25, 1.0))  # m within which a corner is looked for, and how many tolerances a pair may be off
_MOST_SECOND = 0.9      # share of the best correlation that another place in the window may have
_LISTED_SCORE = 0.3     # correlation below which a corner is not worth showing
_SIGMAS = 3.0           # robust standard deviations of the residuals from which a pair is false
_FINEST = 0.03          # m: residuals below a cell of the image do not make a pair false
_MEDIAN_LENGTH = 1.1774  # median length of errors of two coordinates, in their standard deviation (Rayleigh)

WEAK, REPEATS, AWAY = "looks different", "repeats nearby", "does not fit the others"


class Pairs(NamedTuple):
    """N corners of paint and where the image has them.

    Attributes
    ----------
    placement : Placement that those that agree were fitted to
    order : of the polynomial that the residuals belong to
    x, y : (N,) m, local
    pixel, line : (N,)
    score : (N,) correlation of the two cut-outs
    residual : (N,) m, from where the pairs that agree place it, each without itself
    why : (N,) texts, why a pair is false or doubtful; "" for a sound one
    """

    placement: Placement
    order: int
    x: np.ndarray
    y: np.ndarray
    pixel: np.ndarray
    line: np.ndarray
    score: np.ndarray
    residual: np.ndarray
    why: np.ndarray


def pair_corners(placement: Placement, paint: SurveyedPaint, photo: Photo, x: np.ndarray, y: np.ndarray, settings: ProposalSettings) -> Pairs | None:
    """Find corners of paint in a photo that lies on the map to some decimetres.

    Parameters
    ----------
    placement : Placement of the photo
    paint : SurveyedPaint
    photo : Photo
    x, y : (M,) m, corners of paint, local
    settings : ProposalSettings

    Returns
    -------
    Pairs; None where too few agree on one placement
    """
    for search, times in _ROUNDS:
        drawn = placement.sign * placement.drawn(photo.contrast, photo, paint.cell, paint.contrast.shape,
                                                 reduction=placement.reduction(photo, paint.cell))
        found = find_patches(paint.contrast, drawn, paint.cell, x, y, _PATCH, search)
        found = found.where(found.score > _LISTED_SCORE)
        alike = (found.score >= settings.min_score) & (found.second <= _MOST_SECOND)
        moved = np.column_stack([found.dx, found.dy])
        fitted = robust_placement(placement, found.x[alike], found.y[alike], moved[alike], times * settings.tolerance, found.score[alike], 2)
        if fitted is None or fitted[1].sum() < max(LEAST_PAIRS, _LEAST_SHARE * alike.sum()):
            return None
        pixel, line = placement.pixels(found.x + found.dx, found.y + found.dy)
        placement = fitted[0]
        used = np.zeros(len(found.x), dtype=bool)
        used[np.flatnonzero(alike)[fitted[1]]] = True
    order = highest_order(found.x[used], found.y[used], 2)
    if order == 0:
        return None
    residual = left_out_residuals(found.x, found.y, pixel, line, used, order)
    spread = float(np.median(residual[used])) / _MEDIAN_LENGTH
    fits = residual <= min(settings.tolerance, max(_SIGMAS * spread, _FINEST))
    why = np.select([found.score < settings.min_score, found.second > _MOST_SECOND, ~fits | ~used], [WEAK, REPEATS, AWAY], "")
    return Pairs(placement, order, found.x, found.y, pixel, line, found.score, residual, why)
