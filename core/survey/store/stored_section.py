"""The points of one section of a store, before and after they are sorted."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...common.memory import column_buffers
from .canonical_order import canonical_order
from .columns import Columns
from .spill_file import SpillFile, StoredColumn


class StoredSection:
    """The points of one section: some parts in memory, others in files; one part once they are sorted.

    Points are moved column by column, since a column that was just read is still in the processor's cache.

    Attributes
    ----------
    dtype : structured dtype of the points
    in_order : whether the points are in canonical order
    parts : Columns of points in memory, and {name: StoredColumn} of points in files
    """

    __slots__ = ("parts", "in_order", "dtype")

    def __init__(self, dtype: np.dtype, in_order: bool):
        self.dtype, self.in_order = dtype, in_order
        self.parts: list[Columns | dict[str, StoredColumn]] = []

    @property
    def nbytes(self) -> int:
        """Bytes in memory."""
        return sum(part.nbytes for part in self.parts if isinstance(part, Columns))

    @property
    def size(self) -> int:
        """Points."""
        return sum(map(self._count, self.parts))

    def spill(self, file: SpillFile) -> None:
        """Write the parts in memory to the file, as one part."""
        waiting = [part for part in self.parts if isinstance(part, Columns)]
        if waiting:
            stored = {name: file.put(_concatenate_into_buffer([part[name] for part in waiting])) for name in self.dtype.names or ()}
            self.parts = [part for part in self.parts if not isinstance(part, Columns)]
            self.parts.append(stored)

    def sort(self, file: SpillFile | None, finish: Callable[[Columns], np.ndarray | None] | None) -> None:
        """Finish the points and sort them into one part, which is in the file if any of them were in one.

        Parameters
        ----------
        file : that takes it
        finish : function of Columns, in no order, which it may change; it returns a mask of the points to keep, or None for all
        """
        records, order = self._sorted(finish)
        spilled = [part for part in self.parts if not isinstance(part, Columns)]
        arrays: dict[str, np.ndarray] = {}
        stored: dict[str, StoredColumn] = {}
        sorted_buffer = column_buffers.of(len(order))
        for name in self.dtype.names or () if len(order) else ():
            column = records[name]
            if file is None or not spilled:
                arrays[name] = column.take(order)
                continue
            for part in spilled:
                part[name].file.release(part[name])
            stored[name] = file.put(np.take(column, order, out=sorted_buffer("moved", column.dtype), mode="clip"))
        self.parts, self.in_order = [], True
        if len(order):
            self.parts = [stored if spilled else Columns(arrays, self.dtype)]

    def written_in_order(self, file: SpillFile, finish: Callable[[Columns], np.ndarray | None] | None) -> dict[str, StoredColumn] | None:
        """Write the points, in canonical order, to a file; this section stays as it is. None where `finish` keeps no point.

        Parameters
        ----------
        file, finish : as of `sort`
        """
        if self.in_order:
            return {name: file.put(part[name] if isinstance(part, Columns) else part[name].file.get(part[name]))
                    for part in self.parts for name in self.dtype.names or ()} or None
        records, order = self._sorted(finish)
        buffer = column_buffers.of(len(order))
        return {name: file.put(np.take(records[name], order, out=buffer("moved", self.dtype[name]), mode="clip"))
                for name in self.dtype.names or () if len(order)} or None

    def _sorted(self, finish):
        """The points of all parts, finished, in working memory of this thread, and the rows to keep, in canonical order."""
        count = self.size
        buffer = column_buffers.of(count)
        records = Columns({}, self.dtype, count, lambda name: self._fill(name, buffer(name, self.dtype[name])))
        mask = None if finish is None else finish(records)
        return records, canonical_order(records, mask)

    def _count(self, part):
        return len(part) if isinstance(part, Columns) else part[self.dtype.names[0]].packing.size

    def _fill(self, name, column):
        """Fill a column with the values of all parts."""
        first = 0
        for part in self.parts:
            out = column[first:first + self._count(part)]
            if isinstance(part, Columns):
                out[:] = part[name]
            else:
                part[name].file.get(part[name], out)
            first += len(out)
        return column


def _concatenate_into_buffer(columns):
    """Arrays of a column one after the other, in a buffer of this thread that the next call overwrites."""
    return np.concatenate(columns, out=column_buffers.of(sum(map(len, columns)))("column", columns[0].dtype))
