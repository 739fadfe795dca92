"""A store of which one column is set anew."""

from __future__ import annotations

from typing import Any

import numpy as np

from .columns import Columns
from .section_store import SectionStore


class ColumnOverlay(SectionStore):
    """The points of a store with one column replaced; it holds no points itself and joins two stores.

    Parameters
    ----------
    points : SectionStore, closed with this one
    name : of the column
    """

    def __init__(self, points: SectionStore, name: str):
        super().__init__(points.dtype, points.section_length, points.memory_limit)
        self._points, self._name = points, name
        self._column = SectionStore([(name, points.dtype[name])], points.section_length, points.memory_limit)

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
        return self._points.roads()

    def sections(self, road: int) -> list[int]:
        return self._points.sections(road)

    def _read(self, road, section):
        column, points = self._column.section(road, section), self._points.section(road, section)

        def of(name):
            return column if name == self._name else points

        return Columns({}, self.dtype, len(points), lambda name: of(name)[name],
                       load_rows=lambda name, rows: of(name).column_rows(name, rows)), False

    def column(self, road: int, section: int, name: str, rows: np.ndarray) -> np.ndarray:
        return self.section(road, section).take(rows)[name]

    def clear_cache(self) -> None:
        self._column.clear_cache()
        self._points.clear_cache()

    def close(self) -> None:
        super().close()
        self._column.close()
        self._points.close()
