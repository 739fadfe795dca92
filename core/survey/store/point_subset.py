"""Some of the points of a store, with columns of their own: which points these are is kept, and not the points again."""

import numpy as np

from .columns import Columns
from .section_store import SectionStore

OWN_LIMIT = 16 * 2**20  # bytes of rows, and of columns of their own, kept in memory


class PointSubset(SectionStore):
    """Points of a store by their rows in its sections.

    Parameters
    ----------
    points : SectionStore; no points may be added to it any more, and it is closed with this one
    dtype : columns of the points that are handed out
    own : names of those columns that are put with the rows
    alike : {name: value} of those that are the same for all; the others are the store's
    """

    def __init__(self, points, dtype, own, alike):
        super().__init__(dtype, points.section_length, points.memory_limit)
        self._points = points
        # what is read of these is kept with the points
        self._bits, self._own = (SectionStore(kind, points.section_length, min(OWN_LIMIT, points.memory_limit), kept=0)
                                 for kind in ([("bits", "u1")], [(name, self.dtype[name]) for name in own]))
        self._alike = {name: np.array(value, self.dtype[name]) for name, value in alike.items()}

    @property
    def count(self):
        return self._own.count

    def put(self, road, section, rows, **columns):
        """Choose rows, (M,) ascending, of a section of the store, with (M,) values of each own column."""
        if len(rows):
            chosen = np.zeros(rows[-1] + 1, bool)
            chosen[rows] = True
            self._bits.put(road, section, Columns({"bits": np.packbits(chosen)}, self._bits.dtype))
            self._own.put(road, section, Columns(columns, self._own.dtype))

    def append(self, road, records):
        raise TypeError("The points of this store are rows of another; points cannot be added.")

    def roads(self):
        return self._own.roads()

    def sections(self, road):
        return self._own.sections(road)

    def _read(self, road, section):
        own = self._own.section(road, section)
        if not len(own):
            return Columns.concatenate([], self.dtype), False
        rows = np.flatnonzero(np.unpackbits(self._bits.section(road, section)["bits"]).view(bool))

        def read(name):
            if name in self._alike:
                return np.broadcast_to(self._alike[name], len(rows))
            return own[name] if name in self._own.dtype.names else self._points.column(road, section, name, rows)

        def pick(name, some):
            if name in self._alike:
                return np.broadcast_to(self._alike[name], len(some))
            return own[name].take(some) if name in self._own.dtype.names else self._points.column(road, section, name, rows.take(some))

        return Columns({}, self.dtype, len(rows), read, pick=pick), True

    def close(self):
        super().close()
        for store in (self._bits, self._own, self._points):
            store.close()
