"""A bounded store of points by road section: memory up to a limit, then a temporary file."""

import os
import tempfile
import threading
from bisect import bisect_left
from collections import OrderedDict, defaultdict

import numpy as np

from ..parallel import go_on
from .columns import Columns
from .points import UNIT, Points, canonical_order

SECTION_LENGTH = 5.0   # m of station; results must not depend on it
MEMORY_LIMIT = 128 * 2**20  # bytes of records kept before they are spilled
KEPT = 64 * 2**20      # bytes of spilled sections kept as last read: neighbours ask for them again
TURNS = 16             # locks that sections share while they are put in order


class SectionStore:
    """Points of all roads, appended in any order, read back by station.

    A section is a fixed cell of station of one road, cut from 0. What is read
    back is sorted by station, offset, height and time, so it does not depend on
    the order of appending, and a window is a run of rows; a section is sorted
    once, when it is first read. The spill file has no name on disk (on Windows it
    is deleted when it is closed), so a killed run leaves nothing.

    `finish`, where set, is a function of road and Columns that is applied to
    every section once, when it is first read, and returns its final points.
    """

    def __init__(self, dtype, section_length=SECTION_LENGTH, memory_limit=MEMORY_LIMIT, finish=None):
        self.dtype = np.dtype(dtype)
        self.section_length = section_length
        self.memory_limit = memory_limit
        self.finish = finish
        # in the file the widest columns of a piece come first, so that each begins at a multiple of its width
        self._names = sorted(self.dtype.names, key=lambda name: -self.dtype[name].itemsize)
        self._waiting = defaultdict(list)   # (road, section) -> Columns in memory
        self._spilled = defaultdict(list)   # (road, section) -> (offset, count) in the file, before those in memory
        self._in_order = set()              # sections whose records lie sorted, in the file and in memory
        self._kept = OrderedDict()          # a few spilled sections as last read
        self._kept_bytes = 0
        self._lock = threading.Lock()       # sections are read by several threads
        self._turns = [threading.Lock() for _ in range(TURNS)]
        self._waiting_bytes = 0
        self._file = None
        self._end = 0
        self.count = 0

    def append(self, road, records):
        """Add (N,) records of one road (a structured array or Columns); each goes to the section of its station."""
        if len(records):
            self.add(self.parted(road, Columns.of(records)))

    def parted(self, road, records):
        """[((road, section), Columns)] of the sections that (N,) Columns lie in: the work of `append` that any thread may do."""
        section = np.floor(records["s"] * UNIT / self.section_length).astype(np.int64)
        low, high = int(section.min()), int(section.max())
        if low == high:
            return [((int(road), low), records.whole())]
        section -= low
        section = section.astype(np.uint16) if high - low < 2**16 else section
        records = records.take(np.argsort(section, kind="stable")).whole()
        ends = np.cumsum(np.bincount(section))
        return [((int(road), low + k), records[first:end])
                for k, (first, end) in enumerate(zip([0, *ends[:-1].tolist()], ends.tolist())) if end > first]

    def add(self, parted):
        """Add what `parted` made."""
        for key, records in parted:
            self._add(key, records)
        self._spill_beyond_limit()

    def put(self, road, section, records):
        """Add the records of one section, which lie in order already and are all that it will hold."""
        if len(records):
            self._add((int(road), int(section)), records.whole())
            self._in_order.add((int(road), int(section)))
            self._spill_beyond_limit()

    def _add(self, key, records):
        self._waiting[key].append(records)
        self._in_order.discard(key)
        self._forget(key)
        self.count += len(records)
        self._waiting_bytes += records.nbytes

    def _spill_beyond_limit(self):
        if self._waiting_bytes <= self.memory_limit:
            return
        if self._file is None:
            self._file = tempfile.TemporaryFile(prefix="lanewright-")
        for key, parts in self._waiting.items():
            records = Columns.joined(parts, self.dtype)
            if len(records):
                # every piece begins at a multiple of the widest column
                self._end += -self._end % 8
                self._write(self._end, records)
                self._spilled[key].append((self._end, len(records)))
                self._end += records.nbytes
        self._waiting.clear()
        self._waiting_bytes = 0

    def roads(self):
        """Numbers of the roads that have points, ascending."""
        return sorted({road for road, _ in self._keys()})

    def sections(self, road):
        """Numbers of the sections of a road that have points, ascending."""
        return sorted({section for number, section in self._keys() if number == road})

    def _keys(self):
        return set(self._waiting) | set(self._spilled)

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
            records = self._read(key)
            if len(records) and key not in self._in_order:
                records = self._put_in_order(key, records)
            records.locked()
            if key in self._spilled:
                self._keep(key, records)
            return records

    def _put_in_order(self, key, records):
        records = records.take(canonical_order(records)).whole()
        if self.finish is not None:
            records = self.finish(key[0], records).whole()
        self._put_back(key, records)
        self._in_order.add(key)
        return records

    def _read(self, key):
        """What was appended to a section, as it lies in the file and in memory."""
        parts = [self._read_piece(offset, count) for offset, count in self._spilled.get(key, ())]
        return Columns.joined(parts + self._waiting.get(key, []), self.dtype)

    def _put_back(self, key, records):
        """Records in their new order, no more than before, into the places they came from."""
        first, places = 0, []
        for offset, count in self._spilled.get(key, ()):
            count = min(count, len(records) - first)
            self._write(offset, records[first:first + count])
            places.append((offset, count))
            first += count
        if places:
            self._spilled[key] = places
        if key in self._waiting:
            self._waiting[key] = [records[first:].copy() if first else records]

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

    def _read_piece(self, offset, count):
        """Columns of a piece of the file, each read when it is asked for."""
        starts = dict(zip(self._names, offset + count * np.cumsum([0] + [self.dtype[name].itemsize for name in self._names])))

        def read(name):
            return np.frombuffer(self._read_at(int(starts[name]), count * self.dtype[name].itemsize), self.dtype[name])

        return Columns({}, self.dtype, count, read)

    def _write(self, offset, records):
        for name in self._names:
            column = np.ascontiguousarray(records[name])
            self._write_at(offset, column.view(np.uint8))
            offset += column.nbytes

    # pread and pwrite leave the file's position alone, so threads may use it together; Windows has neither
    def _read_at(self, offset, size):
        if hasattr(os, "pread"):
            return os.pread(self._file.fileno(), size, offset)
        with self._lock:
            self._file.seek(offset)
            return self._file.read(size)

    def _write_at(self, offset, data):
        if hasattr(os, "pwrite"):
            while len(data):  # a full disk raises, a signal only shortens
                written = os.pwrite(self._file.fileno(), data, offset)
                data, offset = data[written:], offset + written
            return
        with self._lock:
            self._file.seek(offset)
            self._file.write(data)
            self._file.flush()

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
        self._waiting.clear()
        self._spilled.clear()
        self._in_order.clear()
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


class _Metres:
    """Units of a column as metres, one at a time, for a binary search."""

    def __init__(self, column):
        self.column = column

    def __len__(self):
        return len(self.column)

    def __getitem__(self, k):
        return self.column[k] * UNIT
