"""What lies where in the files of a store: plain arrays, by which any process opens the points that others wrote."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .spill_file import PART_WIDTHS, ColumnFile, Packing, StoredColumn

Key = tuple[int, int]   # numbers of a road and of a section of it


@dataclass(frozen=True)
class StoreIndex:
    """Parts of sections in files of one folder. The parts of one section follow each other in the order in which they were added.

    Attributes
    ----------
    files : names of the files
    parts : (K, 5) int64: road, section, number of the file, points, whether they are all points of the section, in canonical order
    places, least : (K, C) int64, first byte and least value of each of the C columns of the store
    widths : (K, C) uint8, bytes of a packed value
    """

    files: tuple[str, ...]
    parts: np.ndarray
    places: np.ndarray
    least: np.ndarray
    widths: np.ndarray

    @classmethod
    def of(cls, sections: Iterable[tuple[Key, bool, Sequence[Any]]]) -> StoreIndex:
        """The index of sections whose points lie in files with names.

        Parameters
        ----------
        sections : key, whether its points are in order, and its parts, {name of a column: StoredColumn} each
        """
        files: dict[str, int] = {}
        rows, columns = [], []
        for key, in_order, parts in sections:
            for stored in parts:
                some = list(stored.values())
                number = files.setdefault(some[0].file.path.name, len(files))
                rows.append((*key, number, some[0].packing.size, in_order))
                columns.append([(column.place, column.packing.least, sum(column.packing.widths)) for column in some])
        found = np.array(columns, np.int64).reshape(len(rows), len(columns[0]) if rows else 0, 3)
        return cls(tuple(files), np.array(rows, np.int64).reshape(-1, 5), found[..., 0], found[..., 1], found[..., 2].astype(np.uint8))

    @classmethod
    def join(cls, indexes: Sequence[StoreIndex]) -> StoreIndex:
        """Several indexes one after the other."""
        indexes = [one for one in indexes if len(one.parts)] or list(indexes[:1])
        before = np.cumsum([0, *(len(one.files) for one in indexes)])
        parts = [one.parts + np.array([0, 0, shift, 0, 0]) for one, shift in zip(indexes, before)]
        return cls(tuple(name for one in indexes for name in one.files), np.concatenate(parts),
                   *(np.concatenate([getattr(one, name) for one in indexes]) for name in ("places", "least", "widths")))

    @property
    def count(self) -> int:
        """Points that have a station."""
        return int(self.parts[self.parts[:, 0] >= 0, 3].sum())

    def stored(self, folder: Path, dtype: np.dtype) -> Iterator[tuple[Key, bool, dict[str, StoredColumn]]]:
        """Yield (key, whether in order, {name of a column: StoredColumn}) of every part.

        Parameters
        ----------
        folder : that has the files
        dtype : structured dtype of the points
        """
        files = [ColumnFile(folder / name) for name in self.files]
        tables = (self.parts.tolist(), self.places.tolist(), self.least.tolist(), self.widths.tolist())
        for (road, section, number, count, in_order), *columns in zip(*tables):
            yield (road, section), bool(in_order), {
                name: StoredColumn(place, Packing(dtype[name], count, least, PART_WIDTHS.get(width, (width,))), files[number])
                for name, place, least, width in zip(dtype.names or (), *columns)}
