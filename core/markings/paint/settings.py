"""When a spot of road is paint."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...survey.store.columns import Columns
from ...survey.store.road_points import RoadPoints


class PaintMethod(Protocol):
    """Another way to find paint, from the points alone."""

    def paint_of(self, road_points: RoadPoints, road: int, progress: Progress) -> Iterator[Columns]:
        """The records of one road's points that lie on paint, in the order of the road."""


@dataclass(frozen=True)
class MarkingSettings:
    """When a spot of road is paint.

    "spreads" are those of asphalt below its median.

    separation : spreads of asphalt between the mean of paint and the mean of asphalt, below which a bin has no paint
    method : PaintMethod used instead of thresholds on the intensity image, and of all other settings; None for these thresholds
    """

    separation: float = setting(4.0, 0.5, 20.0, "The distance of paint from asphalt", "spreads")
    # limits of the threshold in spreads above the median of asphalt; the lowest where no bin shows paint, and on averages of noisy points
    lowest: float = 3.0
    highest: float = 8.0
    evidence: float = 120.0   # spreads, summed over the cells of a piece: noise of asphalt reaches it once or twice on 1,000 m2
    close: float = 0.20   # m, gaps along the road that are closed
    method: PaintMethod | None = None

    def __post_init__(self) -> None:
        check_limits(self)
        if not 1.0 <= self.lowest <= self.highest:
            raise RoadExtractionError(f"The threshold lies between {self.lowest} and {self.highest} spreads above asphalt; the first must be at "
                                      "least 1 and not above the second.")
