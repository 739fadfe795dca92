"""What is proposed: pairs of places, which of them are accepted, and what is known of the whole."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...common.features import PROPOSED_POINTS, Features
from ...common.setting import check_limits, setting
from ...io.geotiff import IntensityImage
from ..rough_place import RoughPlace
from ..source_image import SourceImage
from .evidence import Rival


@dataclass(frozen=True)
class ProposalSettings:
    """How pairs are found and accepted.

    Attributes
    ----------
    search : m, how far off the rough position may be
    tolerance : m, largest distance of a pair that is accepted from where the others place it
    min_score : smallest correlation of the two cut-outs of a pair that is accepted
    count : most pairs that are accepted
    pixel_size : m on the ground of the image's pixels, roughly; 0: as its position or its tags say
    """

    search: float = setting(15.0, 1.0, 100.0, "The search distance", "m")
    tolerance: float = setting(0.10, 0.01, 1.0, "The tolerance", "m")
    min_score: float = setting(0.6, 0.3, 0.99, "The smallest score")
    count: int = setting(40, 6, 400, "The number of pairs")
    pixel_size: float = setting(0.0, 0.001, 1.0, "The pixel size", "m", zero="as the image says")

    def __post_init__(self) -> None:
        """Check the limits of all settings."""
        check_limits(self)


@dataclass(frozen=True)
class Proposal:
    """N pairs of places, in the image and on the map, the most certain first.

    Attributes
    ----------
    image, intensity : as given
    settings : ProposalSettings
    rough : RoughPlace
    crs : WKT of the map
    easting, northing : (N,) m, in the intensity image
    pixel, line : (N,) in the image
    score : (N,) correlation of the two cut-outs
    residual : (N,) m, distance from where the accepted pairs without this one place it
    accepted : (N,) bool, by default
    why : N texts, why a pair is not accepted
    order : of the polynomial that the residuals belong to
    turn, size : radians and m, of the image on the map
    rival : the most likely other place, None where there is none
    notes : warnings for the user, one sentence each
    """

    image: SourceImage
    intensity: IntensityImage
    settings: ProposalSettings
    rough: RoughPlace
    crs: str
    easting: np.ndarray
    northing: np.ndarray
    pixel: np.ndarray
    line: np.ndarray
    score: np.ndarray
    residual: np.ndarray
    accepted: np.ndarray
    why: tuple[str, ...]
    order: int
    turn: float
    size: float
    rival: Rival | None
    notes: list[str] = field(default_factory=list)

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
