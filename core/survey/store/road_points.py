"""The points of the road surface, as they pass from stage to stage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...execution.phase import THREADS, Executor, Recipe
from ..weights import STORE
from .columns import Columns
from .records import ROAD_POINT, Points, join_columns, point_dtype
from .section_store import ColumnOverlay, DerivedStore, SectionStore
from .spill_file import StoreIndex

if TYPE_CHECKING:
    from ..frame.row_table import SigmaAlong


@dataclass
class RoadPoints:
    """Road points by section, and the properties that later stages need.

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
        return Recipe("core.survey.store.road_points:_shared_road_points", arguments)

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
        self.store.close()

    def __len__(self) -> int:
        return self.store.count

    def roads(self) -> list[int]:
        return self.store.roads()

    def sections(self, road: int) -> list[int]:
        return self.store.sections(road)

    def section(self, road: int, number: int) -> Points:
        return Points(self.store.section(road, number))

    def window(self, road: int, start: float, end: float) -> Points:
        return self.store.window(road, start, end)

    def all_sections(self) -> list[tuple[int, int]]:
        """(road, section number) of every section that has points, in order."""
        return [(road, number) for road in self.roads() for number in self.sections(road)]

    def all_points(self) -> Points:
        """All points in one structured array, ordered by road and section; only for sets known to be small, such as paint."""
        parts = [self.store.section(road, number) for road, number in self.all_sections()]
        return Points(np.asarray(join_columns(parts, self.store.dtype)))


def _shared_road_points(survey: Any, subset: dict[str, Any], corrected: dict[str, Any] | None) -> RoadPoints:
    """What `RoadPoints.recipe` describes."""
    points = RoadPoints.subset_of(survey)
    store: Any = points.store
    store.adopt_shared(**subset)
    if corrected is None:
        return points
    overlay: Any = points.store.with_column("corrected")
    overlay.adopt_shared(**corrected)
    return replace(points, store=overlay, has_corrected=True)


# A subset of the points of a store, with additional columns: it stores which points are in it, not the points.



def packed_mask(rows: np.ndarray) -> np.ndarray:
    """(B,) uint8, a bit for every row up to the last of (M,) ascending indices; none without rows."""
    mask = np.zeros(rows[-1] + 1 if len(rows) else 0, bool)
    mask[rows] = True
    return np.packbits(mask)


class PointSubset(DerivedStore):
    """Points of a store by their rows in its sections.

    points : SectionStore; no points may be added to it any more, and it is closed with this one
    dtype : columns of the points that are returned
    own : names of the columns whose values are stored here, with the rows
    constants : {name: value} of the columns that have one value for all points; the other columns are the store's
    folder : where rows and own columns go that are not kept in memory, so that others can read them; None for temporary files without a name
    """

    def __init__(self, points: SectionStore, dtype: Any, own: Sequence[str], constants: dict[str, Any], folder: Path | None = None):
        super().__init__(dtype, points)
        # What is read from these two is cached with the points.
        self._masks, self._own = (
            SectionStore(kind, points.section_length, min(STORE.subset_memory_limit, points.memory_limit), cache_limit=0, folder=folder)
            for kind in ([("bits", "u1")], [(name, self.dtype[name]) for name in own]))
        self._constants = {name: np.array(value, self.dtype[name]) for name, value in constants.items()}

    @property
    def count(self) -> int:
        """Points in the subset."""
        return self._own.count

    def put(self, road: int, section: int, rows: np.ndarray, **columns: np.ndarray) -> None:  # type: ignore[override]
        """Add points of a section of the store: (M,) ascending rows of the section, and (M,) values of each own column."""
        self.put_mask(road, section, packed_mask(rows), **columns)

    def put_mask(self, road: int, section: int, bits: np.ndarray, **columns: np.ndarray) -> None:
        """The same with the rows as (B,) uint8 of `packed_mask`."""
        if len(bits):
            self._masks.put(road, section, Columns({"bits": bits}, self._masks.dtype))
            self._own.put(road, section, Columns(columns, self._own.dtype))

    def shared(self) -> dict[str, Any]:
        """What another process, which has the store, needs to `adopt_shared` rows and own columns, which lie in the folder then; plain values."""
        return dict(masks=self._masks.index(), own=self._own.index(), folder=str(self._own.folder))

    def adopt_shared(self, masks: StoreIndex, own: StoreIndex, folder: str) -> None:
        self._masks.adopt(masks, Path(folder))
        self._own.adopt(own, Path(folder))

    def _parts(self) -> tuple[SectionStore, ...]:
        return self._own, self._masks, self.points

    def rows(self, road: int, section: int) -> np.ndarray:
        """(M,) indices into a section of the store, ascending."""
        bits = self._masks.section(road, section)
        return np.flatnonzero(np.unpackbits(bits["bits"]).view(bool)) if len(bits) else np.empty(0, np.intp)

    def _read(self, road, section):
        columns = self._own.section(road, section)
        if not len(columns):
            return Columns.concatenate([], self.dtype), False
        rows = self.rows(road, section)

        def load(name):
            if name in self._constants:
                return np.broadcast_to(self._constants[name], len(rows))
            return columns[name] if name in self._own.dtype.names else self.points.column(road, section, name, rows)

        def load_rows(name, some):
            if name in self._constants:
                return np.broadcast_to(self._constants[name], len(some))
            return columns[name].take(some) if name in self._own.dtype.names else self.points.column(road, section, name, rows.take(some))

        return Columns({}, self.dtype, len(rows), load, load_rows=load_rows), True


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

    def load_rows(name, rows):
        values = np.empty(len(rows), store.dtype[name])
        order = np.argsort(rows, kind="stable")
        ascending = rows.take(order)
        bounds = np.searchsorted(ascending, ends)
        for k in np.flatnonzero(np.diff(bounds)).tolist():
            rows_of_section = slice(bounds[k], bounds[k + 1])
            values[order[rows_of_section]] = store.section(*sections[k]).column_rows(name, ascending[rows_of_section] - ends[k])
        return values

    dtype = store.dtype if names is None else np.dtype([(name, store.dtype[name]) for name in names])
    return Columns({}, dtype, int(ends[-1]), load, load_rows=load_rows, kept=False).read_only()
