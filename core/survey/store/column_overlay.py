"""A store of which one column is set anew."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from .columns import Columns
from .section_store import CACHE_LIMIT, SectionStore, Stretch
from .store_index import Key, StoreIndex


class ColumnOverlay(SectionStore):
    """The points of a store with one column replaced; it holds no points itself and joins two stores.

    Parameters
    ----------
    points : SectionStore, closed with this one; it stays an attribute
    name : of the column
    folder : where its values go that are not kept in memory, so that others can read them; None for a temporary file without a name
    """

    def __init__(self, points: SectionStore, name: str, folder: Path | None = None):
        super().__init__(points.dtype, points.section_length, points.memory_limit)
        self.points, self._name = points, name
        # of as many points as the store keeps ready, not of as many bytes
        share = points.dtype[name].itemsize / points.dtype.itemsize
        self._column = SectionStore([(name, points.dtype[name])], points.section_length, points.memory_limit, folder=folder,
                                    cache_limit=int(share * CACHE_LIMIT))

    @property
    def count(self) -> int:
        return self._column.count

    def put(self, road: int, section: int, records: np.ndarray) -> None:
        """Set the column of one section, (N,) in the order of its points."""
        self._column.put(road, section, Columns({self._name: records}, self._column.dtype))

    def append(self, road: int, records: Any) -> None:
        """Refused: the points are those of another store."""
        raise TypeError("The points of this store are those of another; a column can be put, points cannot be added.")

    def roads(self) -> list[int]:
        return self.points.roads()

    def sections(self, road: int) -> list[int]:
        return self.points.sections(road)

    def in_stretch(self, stretch: Stretch) -> list[Key]:
        return self.points.in_stretch(stretch)

    def shared(self) -> dict[str, Any]:
        """As `SectionStore.contents` of the column alone, and the folder that its values lie in then."""
        return dict(column=self._column.index(), folder=str(self._column.folder))

    def adopt_shared(self, column: StoreIndex, folder: str) -> None:
        """Add the values of `shared`."""
        self._column.adopt(column, Path(folder))

    def size(self, road: int, section: int) -> int:
        return self.points.size(road, section)

    def _read(self, road, section):
        column, points = self._column.section(road, section), self.points.section(road, section)

        def of(name):
            return column if name == self._name else points

        return Columns({}, self.dtype, len(points), lambda name: of(name)[name],
                       load_rows=lambda name, rows: of(name).column_rows(name, rows)), False

    def column(self, road: int, section: int, name: str, rows: np.ndarray) -> np.ndarray:
        return self.section(road, section).take(rows)[name]

    def clear_cache(self) -> None:
        self._column.clear_cache()
        self.points.clear_cache()

    def close(self) -> None:
        super().close()
        self._column.close()
        self.points.close()
