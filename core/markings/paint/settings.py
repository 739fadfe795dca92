"""When a spot of road is paint: the settings of all ways to tell it."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...common.errors import RoadExtractionError
from ...common.setting import check_limits, setting
from .published import PeakSettings, SegmentSettings

MARKING_METHODS = ("multi-threshold", "intensity-peaks", "point-segments")


@dataclass(frozen=True)
class MarkingSettings:
    """When a spot of road is paint.

    "spreads" are those of asphalt below its median.

    method : "multi-threshold" on the intensity image; "intensity-peaks" of profiles across
        the road; "point-segments", thresholds on the points and their density
    separation : spreads of asphalt between the mean of paint and the mean of
        asphalt, below which a bin has no paint
    lowest, highest : limits of the threshold in spreads above the median of asphalt
    alone : spreads, the threshold where neither a bin nor its neighbours have two materials
    faint : spreads, the threshold on averages of noisy points, where the shape must be that of paint, too
    close : m, gaps along the road that are closed
    shortest : m, shorter runs are removed
    peaks, segments : settings of the other two methods; the settings from `separation` to `shortest` are for multi-threshold
    """

    method: str = "multi-threshold"
    separation: float = setting(4.0, 0.5, 20.0, "The distance of paint from asphalt", "spreads")
    lowest: float = 3.0
    highest: float = 8.0
    alone: float = 5.0
    faint: float = 3.0
    close: float = setting(0.20, 0.0, 2.0, "The gap that is closed along the road", "m")
    shortest: float = setting(0.20, 0.0, 2.0, "The shortest run of paint", "m")
    peaks: PeakSettings = field(default_factory=PeakSettings)
    segments: SegmentSettings = field(default_factory=SegmentSettings)

    def __post_init__(self) -> None:
        check_limits(self)
        if self.method not in MARKING_METHODS:
            raise RoadExtractionError(f"The method {self.method!r} is not known; use one of {', '.join(MARKING_METHODS)}.")
        if not 1.0 <= self.lowest <= self.highest:
            raise RoadExtractionError(
                f"The threshold lies between {self.lowest} and {self.highest} spreads above asphalt; the first must be at "
                "least 1 and not above the second.")
