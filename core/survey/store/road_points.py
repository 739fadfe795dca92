"""The points of the road surface, as they pass from stage to stage."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...execution.phase import Executor, Recipe
from ...execution.threads import THREADS
from .column_overlay import ColumnOverlay
from .point_subset import PointSubset
from .records import ROAD_POINT, Points, join_columns, point_dtype
from .section_store import SectionStore

if TYPE_CHECKING:
    from ..frame.sigma_along import SigmaAlong


@dataclass
class RoadPoints:
    """Road points by section, and the properties that later stages need.

    Attributes
    ----------
    store : SectionStore of ROAD_POINT records
    origin : (3,) whole numbers, map coordinates in metres that were subtracted from x, y, z
    crs : WKT, "" where unknown
    has_corrected, has_cluster, has_spacing : whether the columns `corrected`, `cluster` and `spacing` hold values
    moves : PassCorrections, the shifts of the passes against the coordinates that were measured; None where there are none
    pass_sigma : {road number: SigmaAlong}, as in RoadFrame
    survey : Survey whose points these are, None where they are their own
    """

    store: SectionStore
    origin: np.ndarray
    crs: str = ""
    has_corrected: bool = False
    has_cluster: bool = False
    moves: Any = None
    has_spacing: bool = False
    pass_sigma: dict[int, SigmaAlong] = field(default_factory=dict)
    survey: Any = field(default=None, repr=False)

    @property
    def executor(self) -> Executor:
        """Who runs the phases that read these points."""
        return THREADS if self.survey is None else self.survey.executor.passing()

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the points, which must be those of a Survey."""
        overlay = self.store.shared() if isinstance(self.store, ColumnOverlay) else None
        subset: Any = self.store.points if isinstance(self.store, ColumnOverlay) else self.store
        arguments = dict(survey=self.survey.recipe(folder), subset=subset.shared(), corrected=overlay)
        return Recipe("survey.store.road_points:shared_road_points", arguments)

    @classmethod
    def empty_like(cls, other: RoadPoints | None = None, origin: Any = None, crs: str = "") -> RoadPoints:
        """A new, empty set: with the sections, origin, CRS and columns of `other`, or with the given origin and CRS."""
        if other is not None:
            store = SectionStore(other.store.dtype, other.store.section_length, other.store.memory_limit)
            return cls(store, other.origin, other.crs, other.has_corrected, other.has_cluster, other.moves, other.has_spacing,
                       other.pass_sigma)
        return cls(SectionStore(ROAD_POINT), np.asarray(origin, float), crs)

    @classmethod
    def subset_of(cls, survey: Any) -> RoadPoints:
        """An empty set into which rows of a survey's sections are put, with `half_width` and `covered`.

        The points stay in the store of the Survey, which lives as long as the road points and is closed with them.
        """
        dtype = point_dtype(ROAD_POINT, np.inf if survey.store.dtype["x"] == np.int64 else 0.0)
        store = PointSubset(survey.store, dtype, ("half_width", "covered"), dict(corrected=np.nan, cluster=0, spacing=0),
                            survey.executor.passing().folder)
        return cls(store, np.asarray(survey.frame.origin, float), survey.crs, moves=survey.moves,
                   pass_sigma=survey.frame.pass_sigma, survey=survey)

    def close(self) -> None:
        """Release the points and their disk space."""
        self.store.close()

    def __len__(self) -> int:
        return self.store.count

    def roads(self) -> list[int]:
        """Numbers of the roads that have points, ascending."""
        return self.store.roads()

    def sections(self, road: int) -> list[int]:
        """Numbers of the sections of a road that have points, ascending."""
        return self.store.sections(road)

    def section(self, road: int, number: int) -> Points:
        """Points of one section, in canonical order."""
        return Points(self.store.section(road, number))

    def window(self, road: int, start: float, end: float) -> Points:
        """Points with start <= station < end (metres)."""
        return self.store.window(road, start, end)

    def all_sections(self) -> list[tuple[int, int]]:
        """(road, section number) of every section that has points, in order."""
        return [(road, number) for road in self.roads() for number in self.sections(road)]

    def all_points(self) -> Points:
        """All points in one structured array, ordered by road and section; only for sets known to be small, such as paint."""
        parts = [self.store.section(road, number) for road, number in self.all_sections()]
        return Points(np.asarray(join_columns(parts, self.store.dtype)))


def shared_road_points(survey: Any, subset: dict[str, Any], corrected: dict[str, Any] | None) -> RoadPoints:
    """What `RoadPoints.recipe` describes."""
    points = RoadPoints.subset_of(survey)
    store: Any = points.store
    store.adopt_shared(**subset)
    if corrected is None:
        return points
    overlay: Any = points.store.with_column("corrected")
    overlay.adopt_shared(**corrected)
    return replace(points, store=overlay, has_corrected=True)
