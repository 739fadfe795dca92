"""A bounded store of points by road section: memory up to a limit, then a temporary file."""

import threading
from bisect import bisect_left
from collections import OrderedDict
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...common.memory import KeptArrays, columns_kept
from ...common.order_statistics import dealt
from ...common.parallel import go_on
from .canonical_order import canonical_order
from .columns import Columns, in_columns
from .records import COORDINATE_SCALE, Points
from .spill_file import SpillFile

# The points of one section of a store: some parts in memory, others in its temporary file, in one part once they are in order.

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

SECTION_LENGTH = 5.0   # m of station; results must not depend on it
MEMORY_LIMIT = 64 * 2**20  # bytes of records kept before they are spilled
KEPT = 64 * 2**20      # bytes of spilled sections kept as last read: neighbours ask for them again
STRIPS = 16            # across a section: points lie strip by strip till they are put in order, so that what is sorted together lies together
TURNS = 16             # locks that sections share while they are put in order


@dataclass(frozen=True)
class Parted:
    """Columns of points of a road sorted by section: those of section `first + k` end before row `ends[k]`."""

    road: int
    records: Columns
    first: int
    ends: list


class SectionStore:
    """Points of all roads, appended in any order, read back by station.

    A section is a fixed cell of station of one road, cut from 0. What is read
    back is sorted by station, offset, height and time, so it does not depend on
    the order of appending, and a window is a run of rows; a section is sorted
    once, when it is first read.

    `finish`, where set, is a function of road and the Columns of a section, in no
    order. It is called once, before they are sorted; it may change them, and
    returns which of them stay, a mask or None for all.
    """

    def __init__(self, dtype, section_length=SECTION_LENGTH, memory_limit=MEMORY_LIMIT, finish=None, kept=KEPT):
        self.dtype = np.dtype(dtype)
        self.section_length = section_length
        self.memory_limit = memory_limit
        self.finish = finish
        self._arrays = KeptArrays()
        self._sections = {}                 # (road, section) -> StoredSection
        self._kept = OrderedDict()          # a few spilled sections as last read
        self._kept_bytes, self._kept_limit = 0, kept
        self._lock = threading.Lock()       # sections are read by several threads
        self._turns = [threading.Lock() for _ in range(TURNS)]
        self._waiting_bytes = 0
        self._file = None
        self._count = 0

    @property
    def count(self):
        """Points added."""
        return self._count

    def append(self, road, records):
        """Add (N,) records of one road (a structured array or Columns); each goes to the section of its station."""
        if len(records):
            self.add(self.parted(road, records))

    def parted(self, road, records, own=None):
        """Points sorted by section: the work of `append` that any thread may do.

        `own` is a mask of those that are meant, all by default.
        """
        strip = np.multiply(records["s"], COORDINATE_SCALE, out=self._arrays.of(len(records))("strip"))
        strip /= self.section_length
        low, high = int(np.floor(strip.min())), int(np.floor(strip.max()))
        strip *= STRIPS
        np.floor(strip, out=strip)
        strip -= STRIPS * low
        order, ends = dealt(strip, STRIPS * (high + 1 - low), own)
        records = records.take(order).whole() if isinstance(records, Columns) else in_columns(records, order)
        return Parted(int(road), records, low, ends[STRIPS - 1::STRIPS].tolist())

    def add(self, parted):
        """Add what `parted` made."""
        for k, (first, end) in enumerate(zip([0, *parted.ends], parted.ends)):
            if end > first:
                self._place((parted.road, parted.first + k), parted.records[first:end], False)
        self._spill_beyond_limit()

    def put(self, road, section, records):
        """Add the Columns of one section, which lie in order already and are all that it will hold."""
        if len(records):
            self._place((int(road), int(section)), records.whole(), True)
            self._spill_beyond_limit()

    def _place(self, key, records, in_order):
        section = self._sections.setdefault(key, StoredSection(self.dtype, in_order))
        section.in_order = in_order and not section.parts
        section.parts.append(records)
        self._forget(key)
        self._count += len(records)
        self._waiting_bytes += records.nbytes

    def _spill_beyond_limit(self):
        if self._waiting_bytes <= self.memory_limit:
            return
        if self._file is None:
            self._file = SpillFile()
        for section in self._sections.values():
            section.spill(self._file)
        self._waiting_bytes = 0

    def roads(self):
        """Numbers of the roads that have points, ascending."""
        return sorted({road for road, _ in self._sections})

    def sections(self, road):
        """Numbers of the sections of a road that have points, ascending."""
        return sorted(section for number, section in self._sections if number == road)

    def section(self, road, section):
        """The Columns of one section in canonical order (empty where there are none); not to be written to."""
        go_on()
        key = (road, section)
        with self._turns[hash(key) % TURNS]:
            with self._lock:
                records = self._kept.get(key)
                if records is not None:
                    self._kept.move_to_end(key)
                    return records
            records, keep = self._read(road, section)
            if keep:
                self._keep(key, records)
            return records.locked()

    def _read(self, road, section):
        """The Columns of one section, and whether they are worth keeping as read."""
        section = self._sections.get((road, section))
        if section is not None and not section.in_order:
            before = section.nbytes
            section.put_in_order(self._file, self.finish and partial(self.finish, road))
            with self._lock:
                self._waiting_bytes += section.nbytes - before
        if section is None or not section.parts:
            return Columns.concatenate([], self.dtype), False
        records = section.parts[0]
        return (records, False) if isinstance(records, Columns) else (self._in_file(records), True)

    def column(self, road, section, name, rows):
        """Some rows of one column of a section that was read before, (M,); nothing else is read, and nothing kept."""
        part = self._sections[road, section].parts[0]
        return part[name].take(rows, mode="clip") if isinstance(part, Columns) else self._file.get(part[name], rows=rows)

    def first_unit(self, section):
        """The least station, in units of 0.1 mm, that lies in a section."""
        unit = int(round(section * self.section_length / COORDINATE_SCALE))
        while np.floor((unit - 1) * COORDINATE_SCALE / self.section_length) >= section:
            unit -= 1
        while np.floor(unit * COORDINATE_SCALE / self.section_length) < section:
            unit += 1
        return unit

    def _in_file(self, stored):
        """Columns that are read one by one when they are asked for."""
        return Columns({}, self.dtype, stored[self.dtype.names[0]].packing.count, lambda name: self._file.get(stored[name]),
                       pick=lambda name, rows: self._file.get(stored[name], rows=rows))

    def _keep(self, key, records):
        with self._lock:
            self._kept[key] = records
            self._kept_bytes += records.nbytes
            while self._kept_bytes > self._kept_limit and len(self._kept) > 1:
                self._kept_bytes -= self._kept.popitem(last=False)[1].nbytes

    def _forget(self, key):
        with self._lock:
            records = self._kept.pop(key, None)
            self._kept_bytes -= 0 if records is None else records.nbytes

    def window(self, road, start, end):
        """Points of a road with start <= station < end (metres), in canonical order."""
        first = int(np.floor(start / self.section_length))
        last = int(np.floor(np.nextafter(end, -np.inf) / self.section_length))
        parts = []
        for number in range(first, last + 1):
            records = self.section(road, number)
            # of a section that lies inside, stations need not be looked at
            low, high = self.first_unit(number) * COORDINATE_SCALE, (self.first_unit(number + 1) - 1) * COORDINATE_SCALE
            if len(records) and (low < start or high >= end):
                stations = _Metres(records["s"])
                a, b = bisect_left(stations, start), bisect_left(stations, end)
                records = records if b - a == len(records) else records.run(a, b)
            parts.append(records)
        return Points(Columns.concatenate(parts, self.dtype))

    def span(self, road):
        """Stations between which the points of a road lie, start <= station < end; (0, 0) where there are none."""
        sections = self.sections(road)
        ends = []
        for numbers, row in ((sections, 0), (sections[::-1], -1)):
            # a section may be left empty when it is finished
            stations = next((s for number in numbers if len(s := self.section(road, number)["s"])), None)
            if stations is None:
                return 0.0, 0.0
            ends.append(int(stations[row]))
        return ends[0] * COORDINATE_SCALE, (ends[1] + 1) * COORDINATE_SCALE

    def with_column(self, name):
        """A store of the same points in which one column is put anew, section by section; it shares all others with this one."""
        return _WithColumn(self, name)

    def let_go(self):
        """Give the memory back of what was kept as last read."""
        with self._lock:
            self._kept.clear()
            self._kept_bytes = 0

    def close(self):
        """Forget everything and give the disk space back."""
        self.let_go()
        self._sections.clear()
        self._waiting_bytes = 0
        if self._file is not None:
            self._file.close()
            self._file = None


class _WithColumn(SectionStore):
    """The points of a store with one column of their own; nothing is kept here, only in the two stores that it joins."""

    def __init__(self, points, name):
        super().__init__(points.dtype, points.section_length, points.memory_limit)
        self._points, self._name = points, name
        self._column = SectionStore([(name, points.dtype[name])], points.section_length, points.memory_limit)

    @property
    def count(self):
        return self._column.count

    def put(self, road, section, column):
        """Set the column of one section, (N,) in the order of its points."""
        self._column.put(road, section, Columns({self._name: column}, self._column.dtype))

    def append(self, road, records):
        raise TypeError("The points of this store are those of another; a column can be put, points cannot be added.")

    def roads(self):
        return self._points.roads()

    def sections(self, road):
        return self._points.sections(road)

    def _read(self, road, section):
        column, points = self._column.section(road, section), self._points.section(road, section)

        def of(name):
            return column if name == self._name else points

        return Columns({}, self.dtype, len(points), lambda name: of(name)[name], pick=lambda name, rows: of(name)._rows(name, rows)), False

    def column(self, road, section, name, rows):
        return self.section(road, section).take(rows)[name]

    def let_go(self):
        self._column.let_go()
        self._points.let_go()

    def close(self):
        super().close()
        self._column.close()
        self._points.close()


class _Metres:
    """Units of a column as metres, one at a time, for a binary search."""

    def __init__(self, column):
        self.column = column

    def __len__(self):
        return len(self.column)

    def __getitem__(self, k):
        return self.column[k] * COORDINATE_SCALE
