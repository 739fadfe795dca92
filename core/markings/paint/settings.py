"""When a spot of road is paint."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

from ...common.progress import Progress
from ...common.setting import Limited, setting
from ...survey.store.columns import Columns
from ...survey.store.road_points import RoadPoints


class PaintMethod(Protocol):
    """Another way to find paint, from the points alone."""

    def paint_of(self, road_points: RoadPoints, road: int, progress: Progress) -> Iterator[Columns]:
        """The records of one road's points that lie on paint, in the order of the road."""


@dataclass(frozen=True)
class MarkingSettings(Limited):
    """When a spot of road is paint.

    separation : spreads of asphalt below its median between the mean of paint and the mean of asphalt, below which a bin has no paint
    method : PaintMethod used instead of thresholds on the intensity image, and of all other settings; None for these thresholds
    """

    separation: float = setting(4.0, 0.5, 20.0, "The distance of paint from asphalt", "spreads")
    method: PaintMethod | None = None
