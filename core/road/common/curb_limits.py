"""How high and how steep a curb must be: the user's own limits, or as the data allow.

A curb of 5 cm with an upright face is one wherever it is seen. A lower or sloped one is told from seams, rails and verges by what averaging along the
road leaves of the noise: N profiles lower it from the scanner's sigma to sqrt(sigma² / N + texture²), where texture, the footprint of the beam and
the registration do not average out. Such a step must stand well above that, keep its line to a centimetre, and continue for metres.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.setting import check_limits, setting
from ..weights import CURBS


@dataclass(frozen=True)
class CurbLimits:
    """The least height and slope of curbs."""

    clear_height: float   # m, from which a step is a curb by its height, and
    clear_slope: float   # radians, by its face
    automatic_height: bool = False   # automatic_height, automatic_slope: may faint steps be lower, or less steep?
    automatic_slope: bool = False

    @classmethod
    def of(cls, height: float, slope: float, usual_height: float, usual_slope: float) -> CurbLimits:
        """The limits of settings, m and degrees, of which 0 is automatic; then the usual ones are those of clear steps."""
        return cls(height or usual_height, np.radians(slope or usual_slope), not height, not slope)

    @property
    def automatic(self) -> bool:
        """May there be faint steps?"""
        return self.automatic_height or self.automatic_slope

    @property
    def least_height(self) -> float:
        """m, below which no step is a curb."""
        return min(CURBS.least_height, self.clear_height) if self.automatic_height else self.clear_height

    @property
    def least_slope(self) -> float:
        """Radians, below which no face is a curb's."""
        return min(np.radians(CURBS.least_slope), self.clear_slope) if self.automatic_slope else self.clear_slope

    def faint(self, height: float, slope: float, noise: float, count: int, scatter: float) -> bool:
        """Is a step that is not clear a curb all the same?

        height : m; slope : radians, of the face
        noise : m, scatter of single heights beside it; count : profiles that show it
        scatter : m, of the step about its own running line
        """
        left = np.hypot(noise / np.sqrt(max(count, 1)), CURBS.texture_sigma)
        return bool(height >= max(self.least_height, CURBS.significant_sigmas * left) and slope >= self.least_slope
                    and scatter <= CURBS.max_faint_scatter)


@dataclass(frozen=True)
class CurbSettings:
    """How curbs are recognised.

    block_length : m of road per curb point; 0 = 0.5 to 2.0, shorter in sharp bends
    min_height, max_height : m, road to top of curb; 0 for the least height = as the noise allows
    """

    block_length: float = setting(0.0, 0.25, 10.0, "The block length", "m", "for automatic")
    profile_width: float = setting(0.25, 0.05, 2.0, "The profile width", "m")   # m of road per profile
    point_spacing: float = setting(0.025, 0.01, 0.1, "The point spacing", "m")   # m, width of the cells of the pseudo scan-lines
    layer_jump: float = setting(0.05, 0.01, 0.5, "The layer jump", "m")   # m of height between ground and what is above it
    slope: float = setting(0.0, 10.0, 89.0, "The slope", "°", "for automatic")   # degrees, least slope of a curb face; 0 = as the noise allows
    min_height: float = setting(0.0, 0.01, 0.95, "The minimum curb height", "m", "for automatic")
    max_height: float = setting(0.35, 0.02, 1.0, "The maximum curb height", "m")

    def __post_init__(self) -> None:
        check_limits(self)
        if not self.min_height < self.max_height:
            raise RoadExtractionError(f"Curbs from {self.min_height} m to {self.max_height} m were asked for; the maximum must be above the minimum.")

    @property
    def limits(self) -> CurbLimits:
        """The least height and slope of curbs."""
        return CurbLimits.of(self.min_height, self.slope, min(CURBS.usual_height, self.max_height), CURBS.usual_slope)
