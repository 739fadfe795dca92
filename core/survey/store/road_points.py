"""The points of the road surface, as they pass from stage to stage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...execution.phase import THREADS, Executor, Recipe
from .columns import Columns
from .records import ROAD_POINT, Points, Seen, point_dtype, points_of_scanners, seen_in_section
from .section_store import SectionStore, Stretch

if TYPE_CHECKING:
    from ..frame.row_table import SigmaAlong


@dataclass
class RoadPoints:
    """Road points by section, and the properties that later stages need."""

    store: SectionStore   # SectionStore of ROAD_POINT records
    origin: np.ndarray   # (3,) whole numbers, map coordinates in metres that were subtracted from x, y, z
    crs: str = ""   # WKT, "" where unknown
    has_corrected: bool = False   # has_corrected, has_cluster, has_spacing: whether the columns `corrected`, `cluster` and `spacing` hold values
    has_cluster: bool = False
    moves: Any = None   # PassCorrections, the shifts of the passes against the coordinates that were measured; None where there are none
    has_spacing: bool = False
    pass_sigma: dict[int, SigmaAlong] = field(default_factory=dict)   # {road number: SigmaAlong}, as in RoadFrame
    survey: Any = field(default=None, repr=False)   # Survey whose points these are, None where they are their own
    density: Any = ()   # CubeDensity of all points of the survey and of these, where that was asked for
    of_scanners: np.ndarray | None = None   # as of `points_of_scanners`, where they were counted
    seen: dict[int, list[Seen]] | None = None   # as of `seen_surface`, where that was looked at
    of_colours: bool = False   # as of the Survey

    @property
    def executor(self) -> Executor:
        """Who runs the phases that read these points."""
        return THREADS if self.survey is None else self.survey.executor

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the points, which must be those of a Survey."""
        return Recipe("core.survey.store.road_points:_shared_road_points", dict(
            survey=self.survey.recipe(folder), store=self.store.recipe(folder), has_corrected=self.has_corrected))

    @classmethod
    def empty_like(cls, other: RoadPoints | None = None, origin: Any = None, crs: str = "") -> RoadPoints:
        """A new, empty set: with the sections, origin, CRS and columns of `other`, or with the given origin and CRS."""
        if other is not None:
            store = SectionStore(other.store.dtype, other.store.section_length)
            return cls(store, other.origin, other.crs, other.has_corrected, other.has_cluster, other.moves, other.has_spacing,
                       other.pass_sigma, of_colours=other.of_colours)
        return cls(SectionStore(ROAD_POINT), np.asarray(origin, float), crs)

    @classmethod
    def of_survey(cls, survey: Any) -> RoadPoints:
        """An empty set for points of a survey, in its sections; the Survey lives as long as the road points and is closed with them."""
        dtype = point_dtype(ROAD_POINT, np.inf if survey.store.dtype["x"] == np.int64 else 0.0)
        store = SectionStore(dtype, survey.store.section_length, survey.executor.folder, dict(corrected=np.nan, cluster=0, spacing=0))
        return cls(store, np.asarray(survey.frame.origin, float), survey.crs, moves=survey.moves,
                   pass_sigma=survey.frame.pass_sigma, survey=survey, of_colours=survey.of_colours)

    def close(self) -> None:
        self.store.close()
        if self.survey is not None:
            self.survey.store.close()

    def __len__(self) -> int:
        return self.store.count

    def roads(self) -> list[int]:
        return self.store.roads()

    def sections(self, road: int) -> list[int]:
        return self.store.sections(road)

    def section(self, road: int, number: int) -> Points:
        return Points(self.store.section(road, number))

    def stretches(self, road: int | None = None) -> list[Stretch]:
        """Stretches of a road or of all roads, which those of a survey share with all its points: they stay where others are chosen of these."""
        store = self.store if self.survey is None else self.survey.store
        return store.stretches([number for number in self.roads() if road in (None, number)])

    def state(self, road: int, start: float, end: float) -> list[Any]:
        """Plain values that differ where the points of a road between two stations (m) are others."""
        length = self.store.section_length
        return self.store.state((road, int(np.floor(start / length)), int(np.ceil(end / length))))

    def window(self, road: int, start: float, end: float) -> Points:
        return self.store.window(road, start, end)

    def points_of_scanners(self) -> np.ndarray:
        """(256,) how many points each scanner has."""
        sections = (points_of_scanners(self.section(*key).records) for key in self.all_sections())
        return sum(sections, np.zeros(256, np.int64)) if self.of_scanners is None else self.of_scanners

    def seen_surface(self) -> dict[int, list[Seen]]:
        """{number of a road: what `seen_in_section` gives of its sections, in order}."""
        return self.seen or {road: [seen_in_section(self.section(road, number).records) for number in self.sections(road)] for road in self.roads()}

    def all_sections(self) -> list[tuple[int, int]]:
        """(road, section number) of every section that has points, in order."""
        return [(road, number) for road in self.roads() for number in self.sections(road)]

    def all_points(self) -> Points:
        """All points in one structured array, ordered by road and section; only for sets known to be small, such as paint."""
        parts = [self.store.section(road, number) for road, number in self.all_sections()]
        return Points(np.asarray(Columns.concatenate(parts, self.store.dtype)))


def _shared_road_points(survey: Any, **others: Any) -> RoadPoints:
    """What `RoadPoints.recipe` describes."""
    return replace(RoadPoints.of_survey(survey), **others)


# The points of whole roads, read from the sections of a store whenever a column is asked for.

def columns_of_roads(store: SectionStore, roads: Sequence[int], names: Sequence[str] | None = None) -> Columns:
    """The Columns of all points of some roads, each by station; of all columns, or of some by `names`.

    A column is there as long as whoever asked for it uses it, and is read again when it is asked for again: of a long road, columns that are
    kept would take as much memory as the points.
    """
    sections = [(road, number) for road in roads for number in store.sections(road)]
    ends = np.cumsum([0, *(len(store.section(*key)) for key in sections)])

    def load(name):
        column = np.empty(ends[-1], store.dtype[name])
        for key, first, end in zip(sections, ends[:-1].tolist(), ends[1:].tolist()):
            column[first:end] = store.section(*key)[name]
        return column

    asked: tuple[Any, list[Any]] = None, []   # rows, which are asked for column by column, and in which sections they lie

    def load_rows(name, rows):
        nonlocal asked
        if 2 * len(rows) > ends[-1]:
            return load(name).take(rows)
        known = asked
        if known[0] is not rows:
            order = np.argsort(rows, kind="stable")
            bounds = np.searchsorted(rows, ends, sorter=order)
            parts = {k: order[bounds[k]:bounds[k + 1]] for k in np.flatnonzero(np.diff(bounds)).tolist()}
            known = asked = rows, [(store.section(*sections[k]), part, rows.take(part) - ends[k]) for k, part in parts.items()]
        values = np.empty(len(rows), store.dtype[name])
        for section, part, of_section in known[1]:
            values[part] = section.column_rows(name, of_section)
        return values

    dtype = store.dtype if names is None else np.dtype([(name, store.dtype[name]) for name in names])
    return Columns({}, dtype, int(ends[-1]), load, load_rows=load_rows, kept=False).read_only()
