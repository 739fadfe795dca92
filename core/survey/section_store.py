"""A bounded store of points by road section: memory up to a limit, then a temporary file."""

import threading
from bisect import bisect_left
from collections import OrderedDict
from dataclasses import dataclass

import numpy as np

from ..parallel import go_on
from .columns import Columns, in_columns
from .points import UNIT, Points, canonical_order
from .spill_file import SpillFile

SECTION_LENGTH = 5.0   # m of station; results must not depend on it
MEMORY_LIMIT = 64 * 2**20  # bytes of records kept before they are spilled
KEPT = 64 * 2**20      # bytes of spilled sections kept as last read: neighbours ask for them again
TURNS = 16             # locks that sections share while they are put in order


@dataclass(frozen=True)
class Parted:
    """Records of a road sorted by section: those of section `first + k` end before row `ends[k]`."""

    road: int
    records: np.ndarray
    first: int
    ends: list


class _Section:
    """The records of one section: some as they came, row by row, others in order, column by column; in memory or in the file."""

    __slots__ = ("rows", "row_places", "columns", "places")

    def __init__(self):
        self.rows, self.row_places = [], []  # structured arrays; (place, count) of such in the file
        # Columns; (place, count, alike) of such in the file, before those in memory. alike: what all points have, by column
        self.columns, self.places = [], []

    @property
    def nbytes(self):
        return sum(part.nbytes for part in self.rows + self.columns)


class SectionStore:
    """Points of all roads, appended in any order, read back by station.

    A section is a fixed cell of station of one road, cut from 0. What is read
    back is sorted by station, offset, height and time, so it does not depend on
    the order of appending, and a window is a run of rows; a section is sorted
    once, when it is first read: till then its records lie row by row, so that
    each is moved in one go.

    `finish`, where set, is a function of road and the records of a section (a
    structured array, in no order). It is called once, before they are sorted; it
    may change them, and returns which of them stay, a mask or None for all.
    """

    def __init__(self, dtype, section_length=SECTION_LENGTH, memory_limit=MEMORY_LIMIT, finish=None):
        self.dtype = np.dtype(dtype)
        self.section_length = section_length
        self.memory_limit = memory_limit
        self.finish = finish
        self._sections = {}                 # (road, section) -> _Section
        self._kept = OrderedDict()          # a few spilled sections as last read
        self._kept_bytes = 0
        self._lock = threading.Lock()       # sections are read by several threads
        self._turns = [threading.Lock() for _ in range(TURNS)]
        self._waiting_bytes = 0
        self._file = None
        self.count = 0

    def append(self, road, records):
        """Add (N,) records of one road (a structured array or Columns); each goes to the section of its station."""
        if len(records):
            self.add(self.parted(road, np.asarray(records)))

    def parted(self, road, records, rows=None):
        """Records sorted by section: the work of `append` that any thread may do.

        `rows` are the indices of those that are meant, all by default.
        """
        station = records["s"] if rows is None else records["s"].take(rows)
        section = np.floor(station * UNIT / self.section_length).astype(np.int64)
        low, high = int(section.min()), int(section.max())
        section -= low
        order = np.argsort(section.astype(np.uint16) if high - low < 2**16 else section, kind="stable")
        records = records.take(order if rows is None else rows.take(order))
        return Parted(int(road), records, low, np.cumsum(np.bincount(section)).tolist())

    def add(self, parted):
        """Add what `parted` made."""
        for k, (first, end) in enumerate(zip([0, *parted.ends], parted.ends)):
            if end > first:
                records = parted.records[first:end]
                self._place((parted.road, parted.first + k), records).rows.append(records)
        self._spill_beyond_limit()

    def put(self, road, section, records):
        """Add the Columns of one section, which lie in order already and are all that it will hold."""
        if len(records):
            self._place((int(road), int(section)), records).columns.append(records.whole())
            self._spill_beyond_limit()

    def _place(self, key, records):
        section = self._sections.get(key)
        if section is None:
            section = self._sections[key] = _Section()
        self._forget(key)
        self.count += len(records)
        self._waiting_bytes += records.nbytes
        return section

    def _spill_beyond_limit(self):
        if self._waiting_bytes <= self.memory_limit:
            return
        if self._file is None:
            self._file = SpillFile()
        for section in self._sections.values():
            if section.rows:
                section.row_places.append((self._file.end, sum(map(len, section.rows))))
                for records in section.rows:
                    self._file.append(records)
            for records in section.columns:
                # a column whose points are all alike (one pass, not corrected yet) need not be written
                alike = {name: records[name][:1].copy() for name in self.dtype.names if _all_alike(records[name])}
                section.places.append((self._file.end, len(records), alike))
                for name in self.dtype.names:
                    if name not in alike:
                        self._file.append(records[name])
            section.rows, section.columns = [], []
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
            section = self._sections.get(key)
            if section is None:
                return Columns.joined([], self.dtype).locked()
            if section.rows or section.row_places:
                self._put_in_order(road, section)
            records = self._in_order(section).locked()
            if section.places:
                self._keep(key, records)
            return records

    def _in_order(self, section):
        """The Columns of a section, those in the file read one by one when they are asked for."""
        return Columns.joined([self._read_columns(*place) for place in section.places] + section.columns, self.dtype)

    def _put_in_order(self, road, section):
        """Sort what came to a section, and what was in order before, into the places they came from."""
        before = section.nbytes
        records = self._rows_of(section)
        stay = None if self.finish is None else self.finish(road, records)
        if stay is not None:
            records = records.take(np.flatnonzero(stay))
        columns = in_columns(records, canonical_order(records))
        first, places = 0, []
        # where columns were left out there is no room for them now
        for place, count in section.row_places + [(place, count) for place, count, alike in section.places if not alike]:
            count = min(count, len(columns) - first)
            self._write_columns(place, columns[first:first + count])
            places.append((place, count, {}))
            first += count
        section.rows, section.row_places, section.places = [], [], places
        section.columns = [columns[first:].copy() if first else columns] if first < len(columns) or not places else []
        with self._lock:
            self._waiting_bytes += section.nbytes - before

    def _rows_of(self, section):
        """All records of a section, as an array of their own."""
        parts = section.rows + [np.asarray(self._in_order(section))] * bool(section.places or section.columns)
        records = np.empty(sum(map(len, parts)) + sum(count for _, count in section.row_places), self.dtype)
        whole = np.dtype((np.void, self.dtype.itemsize))  # or rows would be copied field by field
        first = 0
        for place, count in section.row_places:
            self._file.read(place, records[first:first + count])
            first += count
        for part in parts:
            records.view(whole)[first:first + len(part)] = part.view(whole)
            first += len(part)
        return records

    def _keep(self, key, records):
        with self._lock:
            self._kept[key] = records
            self._kept_bytes += records.nbytes
            while self._kept_bytes > KEPT and len(self._kept) > 1:
                self._kept_bytes -= self._kept.popitem(last=False)[1].nbytes

    def _forget(self, key):
        with self._lock:
            records = self._kept.pop(key, None)
            self._kept_bytes -= 0 if records is None else records.nbytes

    def _read_columns(self, place, count, alike):
        """Columns of a piece of the file, each read when it is asked for."""
        written = [name for name in self.dtype.names if name not in alike]
        places = dict(zip(written, np.cumsum([place] + [count * self.dtype[name].itemsize for name in written]).tolist()))

        def read(name):
            if name in alike:
                return np.broadcast_to(alike[name], count)
            column = np.empty(count, self.dtype[name])
            self._file.read(places[name], column)
            return column

        return Columns({}, self.dtype, count, read)

    def _write_columns(self, place, columns):
        for name in self.dtype.names:
            self._file.write(place, columns[name])
            place += columns[name].nbytes

    def window(self, road, start, end):
        """Points of a road with start <= station < end (metres), in canonical order."""
        first = int(np.floor(start / self.section_length))
        last = int(np.floor(np.nextafter(end, -np.inf) / self.section_length))
        parts = []
        for number in range(first, last + 1):
            records = self.section(road, number)
            if number in (first, last) and len(records):
                stations = _Metres(records["s"])
                a = bisect_left(stations, start) if number == first else 0
                b = bisect_left(stations, end) if number == last else len(records)
                records = records if b - a == len(records) else records[a:b]
            parts.append(records)
        return Points(Columns.joined(parts, self.dtype))

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
        return ends[0] * UNIT, (ends[1] + 1) * UNIT

    def with_column(self, name):
        """A store of the same points in which one column is put anew, section by section; it shares all others with this one."""
        return _WithColumn(self, name)

    def close(self):
        """Forget everything and give the disk space back."""
        self._sections.clear()
        self._kept.clear()
        self._kept_bytes = self._waiting_bytes = 0
        if self._file is not None:
            self._file.close()
            self._file = None


class _WithColumn(SectionStore):
    """The points of a store with one column of their own."""

    def __init__(self, points, name):
        self._points, self._name = points, name
        self._column = SectionStore([(name, points.dtype[name])], points.section_length, points.memory_limit)
        self.dtype, self.section_length, self.memory_limit = points.dtype, points.section_length, points.memory_limit

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

    def section(self, road, section):
        column = self._column.section(road, section)[self._name]
        return self._points.section(road, section).with_columns(**{self._name: column}).locked()

    def close(self):
        self._column.close()
        self._points.close()


def _all_alike(column):
    """Whether all of one or more values are the same, bit by bit (so that NaN is NaN)."""
    bits = np.ascontiguousarray(column).view(f"u{column.dtype.itemsize}")
    return bool(bits[0] == bits[-1] == bits[len(bits) // 2] and (bits == bits[0]).all())


class _Metres:
    """Units of a column as metres, one at a time, for a binary search."""

    def __init__(self, column):
        self.column = column

    def __len__(self):
        return len(self.column)

    def __getitem__(self, k):
        return self.column[k] * UNIT
