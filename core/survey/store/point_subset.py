"""A subset of the points of a store, with additional columns: it stores which points are in it, not the points."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .columns import Columns
from .section_store import SectionStore, Stretch
from .store_index import Key, StoreIndex

SUBSET_MEMORY_LIMIT = 16 * 2**20  # bytes of masks, and as many of additional columns, in memory


def packed_mask(rows: np.ndarray) -> np.ndarray:
    """(B,) uint8, a bit for every row up to the last of (M,) ascending indices; none without rows."""
    mask = np.zeros(rows[-1] + 1 if len(rows) else 0, bool)
    mask[rows] = True
    return np.packbits(mask)


class PointSubset(SectionStore):
    """Points of a store by their rows in its sections.

    Parameters
    ----------
    points : SectionStore; no points may be added to it any more, and it is closed with this one
    dtype : columns of the points that are returned
    own : names of the columns whose values are stored here, with the rows
    constants : {name: value} of the columns that have one value for all points; the other columns are the store's
    folder : where rows and own columns go that are not kept in memory, so that others can read them; None for temporary files without a name
    """

    def __init__(self, points: SectionStore, dtype: Any, own: Sequence[str], constants: dict[str, Any], folder: Path | None = None):
        super().__init__(dtype, points.section_length, points.memory_limit)
        self._points = points
        # What is read from these two is cached with the points.
        self._masks, self._own = (
            SectionStore(kind, points.section_length, min(SUBSET_MEMORY_LIMIT, points.memory_limit), cache_limit=0, folder=folder)
            for kind in ([("bits", "u1")], [(name, self.dtype[name]) for name in own]))
        self._constants = {name: np.array(value, self.dtype[name]) for name, value in constants.items()}

    @property
    def count(self) -> int:
        """Points in the subset."""
        return self._own.count

    def put(self, road: int, section: int, rows: np.ndarray, **columns: np.ndarray) -> None:  # type: ignore[override]
        """Add points of a section of the store.

        Parameters
        ----------
        road, section : numbers
        rows : (M,) indices into the section, ascending
        columns : (M,) values of each own column
        """
        self.put_mask(road, section, packed_mask(rows), **columns)

    def put_mask(self, road: int, section: int, bits: np.ndarray, **columns: np.ndarray) -> None:
        """Add points of a section of the store; (B,) uint8 of `packed_mask`, and the own columns as in `put`."""
        if len(bits):
            self._masks.put(road, section, Columns({"bits": bits}, self._masks.dtype))
            self._own.put(road, section, Columns(columns, self._own.dtype))

    def shared(self) -> dict[str, Any]:
        """What another process, which has the store, needs to `adopt_shared` rows and own columns, which lie in the folder then; plain values."""
        return dict(masks=self._masks.index(), own=self._own.index(), folder=str(self._own.folder))

    def adopt_shared(self, masks: StoreIndex, own: StoreIndex, folder: str) -> None:
        """Add the points of `shared`."""
        self._masks.adopt(masks, Path(folder))
        self._own.adopt(own, Path(folder))

    def size(self, road: int, section: int) -> int:
        return self._own.size(road, section)

    def append(self, road: int, records: Any) -> None:
        """Refused: the points are rows of another store."""
        raise TypeError("The points of this store are rows of another; points cannot be added.")

    def roads(self) -> list[int]:
        return self._own.roads()

    def sections(self, road: int) -> list[int]:
        return self._own.sections(road)

    def in_stretch(self, stretch: Stretch) -> list[Key]:
        return self._own.in_stretch(stretch)

    def rows(self, road: int, section: int) -> np.ndarray:
        """(M,) indices into a section of the store, ascending."""
        bits = self._masks.section(road, section)
        return np.flatnonzero(np.unpackbits(bits["bits"]).view(bool)) if len(bits) else np.empty(0, np.intp)

    def _read(self, road, section):
        own = self._own.section(road, section)
        if not len(own):
            return Columns.concatenate([], self.dtype), False
        rows = self.rows(road, section)

        def load(name):
            if name in self._constants:
                return np.broadcast_to(self._constants[name], len(rows))
            return own[name] if name in self._own.dtype.names else self._points.column(road, section, name, rows)

        def load_rows(name, some):
            if name in self._constants:
                return np.broadcast_to(self._constants[name], len(some))
            return own[name].take(some) if name in self._own.dtype.names else self._points.column(road, section, name, rows.take(some))

        return Columns({}, self.dtype, len(rows), load, load_rows=load_rows), True

    def clear_cache(self) -> None:
        super().clear_cache()
        self._points.clear_cache()

    def close(self) -> None:
        super().close()
        for store in (self._masks, self._own, self._points):
            store.close()
