"""The points of one section of a store: some parts in memory, others in its temporary file, in one part once they are in order."""

import numpy as np

from .canonical_order import canonical_order
from .columns import Columns
from .kept_arrays import columns_kept


class StoredSection:
    """Points in parts: Columns in memory, and dicts of what lies in the file by name of column.

    Columns are moved one after the other: what a column was read into is still in the processor's cache then.
    """

    __slots__ = ("parts", "in_order", "dtype")

    def __init__(self, dtype, in_order):
        self.dtype, self.in_order, self.parts = dtype, in_order, []

    @property
    def nbytes(self):
        """Bytes in memory."""
        return sum(part.nbytes for part in self.parts if isinstance(part, Columns))

    def spill(self, file):
        """Put the parts that wait in memory down as one."""
        waiting = [part for part in self.parts if isinstance(part, Columns)]
        if waiting:
            stored = {name: file.put(_end_to_end([part[name] for part in waiting])) for name in self.dtype.names}
            self.parts = [part for part in self.parts if not isinstance(part, Columns)] + [stored]

    def put_in_order(self, file, finish):
        """Finish and sort the points into one part; it is in the file then where some of them were.

        `finish` is a function of Columns, in no order, which it may change; it returns which of them stay, a mask or None for all.
        """
        parts, count = self.parts, sum(map(self._count, self.parts))
        kept = columns_kept.of(count)
        records = Columns({}, self.dtype, count, lambda name: self._column(file, name, kept(name, self.dtype[name])))
        stay = None if finish is None else finish(records)
        order = canonical_order(records, stay)
        spilled = [part for part in parts if not isinstance(part, Columns)]
        ordered, moved = {}, columns_kept.of(len(order))
        for name in self.dtype.names if len(order) else ():
            column = records[name]
            for part in spilled:
                file.give_back(part[name])
            if spilled:
                ordered[name] = file.put(np.take(column, order, out=moved("moved", column.dtype), mode="clip"))
            else:
                ordered[name] = column.take(order)
        self.parts, self.in_order = [], True
        if len(order):
            self.parts = [ordered if spilled else Columns(ordered, self.dtype)]

    def _count(self, part):
        return len(part) if isinstance(part, Columns) else part[self.dtype.names[0]].packing.count

    def _column(self, file, name, column):
        """Fill a column with that of all parts."""
        first = 0
        for part in self.parts:
            out = column[first:first + self._count(part)]
            if isinstance(part, Columns):
                out[:] = part[name]
            else:
                file.get(part[name], out)
            first += len(out)
        return column


def _end_to_end(columns):
    """Arrays of a column one after the other, for this thread alone and till it asks for others."""
    return np.concatenate(columns, out=columns_kept.of(sum(map(len, columns)))("column", columns[0].dtype))
