"""When a spot of road is paint: the settings of all ways to tell it."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...common.errors import RoadExtractionError
from ...common.setting import check_limits, setting

MARKING_METHODS = ("multi-threshold", "intensity-peaks", "point-segments")


@dataclass(frozen=True)
class PeakSettings:
    """When a peak of intensity across the road is a painted line.

    profile_length : m of road that one profile is averaged over
    prominence : deviations (MAD of the profile) that a peak must rise above both its feet
    narrowest, widest : m, width of a peak at half its height
    jump, gap : m that a peak may move across, and be missing along the road, from profile to profile of a chain
    shortest : m, least length of a chain
    """

    profile_length: float = setting(0.20, 0.02, 2.0, "The length of a profile", "m")
    prominence: float = setting(7.0, 0.5, 100.0, "The prominence of a peak")
    narrowest: float = setting(0.08, 0.0, 1.95, "The narrowest line", "m")
    widest: float = setting(0.35, 0.02, 2.0, "The widest line", "m")
    jump: float = setting(0.15, 0.01, 1.0, "The shift between profiles", "m")
    gap: float = setting(0.60, 0.02, 10.0, "The gap along a line", "m")
    shortest: float = setting(1.0, 0.0, 50.0, "The shortest line", "m")

    def __post_init__(self) -> None:
        check_limits(self)
        if not self.narrowest < self.widest:
            raise RoadExtractionError(f"Peaks are {self.narrowest} to {self.widest} m wide; the first must be below the second.")
        if self.gap < self.profile_length:
            raise RoadExtractionError(f"Peaks are linked over {self.gap} m along the road; it must be at least the length of a "
                                      f"profile ({self.profile_length} m).")


@dataclass(frozen=True)
class SegmentSettings:
    """How road points are split, and when a bright one is paint.

    length, width : m, of a segment along and across the road
    separation : spreads of asphalt between the means of the two classes, below which a segment has no paint
    radius : m around a bright point in which its bright neighbours are counted
    """

    length: float = setting(10.0, 0.5, 200.0, "The length of a segment", "m")
    width: float = setting(1.0, 0.1, 50.0, "The width of a segment", "m")
    separation: float = setting(3.0, 0.0, 50.0, "The distance of paint from asphalt", "spreads")
    radius: float = setting(0.12, 0.01, 1.0, "The radius in which neighbours are counted", "m")

    def __post_init__(self) -> None:
        check_limits(self)


@dataclass(frozen=True)
class MarkingSettings:
    """When a spot of road is paint.

    "spreads" are those of asphalt below its median.

    method : "multi-threshold" on the intensity image; "intensity-peaks" of profiles across the road; "point-segments", thresholds on the points and
        their density
    separation : spreads of asphalt between the mean of paint and the mean of asphalt, below which a bin has no paint
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
