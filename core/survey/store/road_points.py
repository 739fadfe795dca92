"""The points of the road surface, as they pass from stage to stage."""

from dataclasses import dataclass

import numpy as np

from .point_subset import PointSubset
from .records import ROAD_POINT, Points, join_columns, point_dtype
from .section_store import SectionStore


def _store_like(store):
    return SectionStore(store.dtype, store.section_length, store.memory_limit)


@dataclass
class RoadPoints:
    """Road points in their sections, with what a later stage must know of them.

    `origin` (3 integers, map coordinates) is what was subtracted from x, y, z.
    `has_corrected` and `has_cluster` say whether those columns carry anything. `moves` are the PassMoves by
    which they lie off the coordinates that were measured, None where they do not.
    """

    store: SectionStore
    origin: np.ndarray
    crs: str = ""
    has_corrected: bool = False
    has_cluster: bool = False
    moves: object = None

    @classmethod
    def empty_like(cls, other=None, origin=None, crs=""):
        """A new, empty set; with `other` given, its sections, origin, CRS and columns."""
        if other is not None:
            return cls(_store_like(other.store), other.origin, other.crs, other.has_corrected, other.has_cluster, other.moves)
        return cls(SectionStore(ROAD_POINT), np.asarray(origin, float), crs)

    @classmethod
    def subset_of(cls, survey):
        """An empty set into which rows of a survey's sections are put, with `half_width` and `covered`.

        The points stay in the survey's store, which lives as long as the road points and is closed with them.
        """
        dtype = point_dtype(ROAD_POINT, np.inf if survey.store.dtype["x"] == np.int64 else 0.0)
        store = PointSubset(survey.store, dtype, ("half_width", "covered"), dict(corrected=np.nan, cluster=0))
        return cls(store, np.asarray(survey.frame.origin, float), survey.crs, moves=survey.moves)

    def close(self):
        """Forget the points, and give back the disk space they took."""
        self.store.close()

    def __len__(self):
        return self.store.count

    def roads(self):
        return self.store.roads()

    def sections(self, road):
        return self.store.sections(road)

    def section(self, road, number):
        """Points of one section, in canonical order."""
        return Points(self.store.section(road, number))

    def window(self, road, start, end):
        """Points with start <= station < end."""
        return self.store.window(road, start, end)

    def all_sections(self):
        """(road, section number) of every section that has points, in order."""
        return [(road, number) for road in self.roads() for number in self.sections(road)]

    def all_points(self):
        """Every point in one structured array, road by road and section by section (for sets known to be small: paint)."""
        parts = [self.store.section(road, number) for road, number in self.all_sections()]
        return Points(np.asarray(join_columns(parts, self.store.dtype)))
