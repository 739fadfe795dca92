"""What is proposed: pairs of places, which of them are accepted, what is known of the whole, and whether the paint allows another place."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ....core.common.features import PROPOSED_POINTS, Features
from ....core.common.setting import check_limits, setting
from ....core.io.geotiff import IntensityImage
from ....core.lazy import cv2
from ..rough_place import RoughPlace
from ..source_image import SourceImage
from .patches import correlation_maps
from .photo import Photo, SurveyedPaint, reduced
from .placement import Placement


@dataclass(frozen=True)
class ProposalSettings:
    """How pairs are found and accepted.

    tolerance : m, largest distance of a pair that is accepted from where the others place it
    pixel_size : m on the ground of the image's pixels, roughly; 0: as its position or its tags say
    """

    search: float = setting(15.0, 1.0, 100.0, "The search distance", "m")   # m, how far off the rough position may be
    tolerance: float = setting(0.10, 0.01, 1.0, "The tolerance", "m")
    min_score: float = setting(0.6, 0.3, 0.99, "The smallest score")   # smallest correlation of the two cut-outs of a pair that is accepted
    count: int = setting(40, 6, 400, "The number of pairs")   # most pairs that are accepted
    pixel_size: float = setting(0.0, 0.001, 1.0, "The pixel size", "m", zero="as the image says")

    def __post_init__(self) -> None:
        """Check the limits of all settings."""
        check_limits(self)


@dataclass(frozen=True)
class Proposal:
    """N pairs of places, in the image and on the map, the most certain first."""

    image: SourceImage   # image, intensity: as given
    intensity: IntensityImage
    settings: ProposalSettings   # ProposalSettings
    rough: RoughPlace   # RoughPlace
    crs: str   # WKT of the map
    easting: np.ndarray   # easting, northing: (N,) m, in the intensity image
    northing: np.ndarray
    pixel: np.ndarray   # pixel, line: (N,) in the image
    line: np.ndarray
    score: np.ndarray   # (N,) correlation of the two cut-outs
    residual: np.ndarray   # (N,) m, distance from where the accepted pairs without this one place it
    accepted: np.ndarray   # (N,) bool, by default
    why: tuple[str, ...]   # N texts, why a pair is not accepted
    order: int   # of the polynomial that the residuals belong to
    turn: float   # turn, size: radians and m, of the image on the map
    size: float
    rival: _Rival | None   # the most likely other place, None where there is none
    notes: list[str] = field(default_factory=list)   # warnings for the user, one sentence each

    def __len__(self) -> int:
        return len(self.pixel)

    @property
    def rmse(self) -> float:
        """Root mean square of the residuals of the accepted pairs, m; NaN without any."""
        return float(np.sqrt(np.mean(self.residual[self.accepted] ** 2))) if self.accepted.any() else float("nan")

    @property
    def turn_degrees(self) -> float:
        """Degrees counter-clockwise, from the rows of the image to east."""
        return float(np.degrees(self.turn))

    def features(self) -> Features:
        """Features PROPOSED_POINTS, as "Georeference image" takes them: pairs that are not accepted are switched off."""
        from shapely import Point

        layer = Features("PointZ", PROPOSED_POINTS, crs=self.crs)
        for k in range(len(self)):
            layer.add(Point(self.easting[k], self.northing[k], 0.0), point=k + 1, accepted=self.accepted[k], role="control",
                      score=self.score[k], residual=self.residual[k], pixel=self.pixel[k], line=self.line[k], why=self.why[k])
        return layer


# Whether a place is the only one that the paint allows: on a road of equal dashes several fit equally well.

_HALF = 0.8           # m, half the side of the patch about a corner
_AROUND = 6.0         # m within which shifted places are compared
_SAME = 0.6           # m, shifts nearer than this are the same place
_OFF = 0.24           # m by which a corner may be off its place
_CELL = 0.08          # m
_DECISIVE = 0.3       # difference of two correlations of a corner that speaks for one place
LEAST_DECISIVE = 4    # more corners must speak for a place than for another one
_SIGMAS = 2.0         # and by so many standard deviations of their number (sign test)
_UNLIKE = 0.4         # correlation below which a corner is not what lies there


class _Rival(NamedTuple):
    """Another place that the paint might allow."""

    dx: float   # dx, dy: m, from the place
    dy: float
    votes_for: float   # votes_for, votes_against: corners that speak for the place, and for the rival
    votes_against: float

    @property
    def margin(self) -> float:
        """How clearly the corners speak for the place, 1 or more: clearly enough."""
        needed = max(LEAST_DECISIVE, _SIGMAS * float(np.sqrt(self.votes_for + self.votes_against)))
        return (self.votes_for - self.votes_against) / needed


def corner_scores(placement: Placement, paint: SurveyedPaint, photo: Photo, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """How well the photo fits about corners of paint.

    x, y : (N,) m, local
    Returns (N,) correlation of the best place within some decimetres; NaN outside the photo
    """
    maps = _maps(placement, paint, photo, x, y, _OFF)
    return np.array([np.nan if match is None else match.max() for match in maps])


def nearby_rival(placement: Placement, paint: SurveyedPaint, photo: Photo, x: np.ndarray, y: np.ndarray) -> _Rival | None:
    """The shift by some metres that the corners allow best, besides none at all.

    as of `corner_scores`
    Returns _Rival, None where no corner lies in the photo
    """
    near = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * round(_OFF / _CELL) + 1,) * 2)
    maps = [cv2.dilate(match, near) for match in _maps(placement, paint, photo, x, y, _AROUND) if match is not None]
    if not maps:
        return None
    votes = np.maximum(maps, 0.0)
    total = votes.sum(axis=0)
    middle = len(total) // 2
    down, across = np.mgrid[:len(total), :len(total)] - middle
    total[np.hypot(down, across) * _CELL < _SAME] = -1.0
    row, column = divmod(int(total.argmax()), len(total))
    better = votes[:, middle, middle] - votes[:, row, column]
    return _Rival((column - middle) * _CELL, -(row - middle) * _CELL, int((better > _DECISIVE).sum()), int((better < -_DECISIVE).sum()))


def rival_elsewhere(best: np.ndarray, other: np.ndarray, shift: tuple[float, float]) -> _Rival:
    """A place against another one that lies too far away to be compared corner by corner: by the corners that look unlike at each.

    best, other : (N,) `corner_scores` of the two placements, NaN outside the photo
    shift : m, from the one to the other
    """
    best_scores, other_scores = best[np.isfinite(best)], other[np.isfinite(other)]
    scale = len(other_scores) / max(len(best_scores), 1)
    return _Rival(*shift, float((other_scores < _UNLIKE).sum()), scale * float((best_scores < _UNLIKE).sum()))


def _maps(placement, paint, photo, x, y, search):
    """Correlations about each corner, (2 n + 1, 2 n + 1) each, its own place in the middle; None outside the photo."""
    factor = max(1, round(_CELL / paint.cell))
    small = reduced(paint.contrast, factor)
    cell = paint.cell * factor
    drawn = placement.sign * placement.drawn(photo.contrast, photo, cell, small.shape, reduction=placement.reduction(photo, cell))
    return correlation_maps(small, drawn, cell, x, y, _HALF, search)
