"""A bounded store of points by road section: memory up to a limit, then a temporary file."""

import os
import tempfile
import threading
from collections import OrderedDict, defaultdict

import numpy as np

from .points import Points, UNIT, chosen, in_canonical_order, joined

SECTION_LENGTH = 20.0  # m of station; results must not depend on it
MEMORY_LIMIT = 256 * 2**20  # bytes of records kept before they are spilled
KEPT = 64 * 2**20      # bytes of spilled sections kept as last read: neighbours ask for them again
TURNS = 16             # locks that sections share while they are put in order


class SectionStore:
    """Points of all roads, appended in any order, read back by station.

    A section is a fixed cell of station of one road, cut from 0. What is read
    back is sorted by time and place, so it does not depend on the order of
    appending; a section is sorted once, when it is first read. The spill file
    has no name on disk, so a killed run leaves nothing.
    """

    def __init__(self, dtype, section_length=SECTION_LENGTH, memory_limit=MEMORY_LIMIT):
        self.dtype = np.dtype(dtype)
        self.section_length = section_length
        self.memory_limit = memory_limit
        self._waiting = defaultdict(list)   # (road, section) -> arrays in memory
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
        """Add (N,) records of one road; each goes to the section of its station."""
        if not len(records):
            return
        section = np.floor(records["s"] * UNIT / self.section_length).astype(np.int64)
        order = np.argsort(section, kind="stable")
        section, records = section[order], chosen(records, order)
        starts = np.r_[0, np.flatnonzero(np.diff(section)) + 1, len(section)]
        for a, b in zip(starts[:-1], starts[1:]):
            key = (int(road), int(section[a]))
            self._waiting[key].append(records[a:b].copy())
            self._in_order.discard(key)
            self._forget(key)
        self.count += len(records)
        self._waiting_bytes += records.nbytes
        if self._waiting_bytes > self.memory_limit:
            self._spill()

    def _spill(self):
        if self._file is None:
            self._file = tempfile.TemporaryFile(prefix="lanewright-")
        self._file.seek(self._end)
        for key, arrays in self._waiting.items():
            count = sum(map(len, arrays))
            for array in arrays:
                self._file.write(array.view(np.uint8))
            self._spilled[key].append((self._end, count))
            self._end += count * self.dtype.itemsize
        self._file.flush()
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
        """The records of one section in canonical order (empty where there are none); not to be written to."""
        key = (road, section)
        with self._turns[hash(key) % TURNS]:
            with self._lock:
                records = self._kept.get(key)
                if records is not None:
                    self._kept.move_to_end(key)
                    return records
            records = self._read(key)
            if key not in self._in_order:
                records = in_canonical_order(records)
                self._put_back(key, records)
                self._in_order.add(key)
            records.flags.writeable = False
            if key in self._spilled:
                self._keep(key, records)
            return records

    def _read(self, key):
        """What was appended to a section, as it lies in the file and in memory."""
        arrays = [np.frombuffer(self._read_at(offset, count * self.dtype.itemsize), self.dtype)
                  for offset, count in self._spilled.get(key, ())]
        arrays += self._waiting.get(key, [])
        return arrays[0] if len(arrays) == 1 else joined(arrays, self.dtype)

    def _put_back(self, key, records):
        """Records in their new order into the places they came from."""
        first = 0
        for offset, count in self._spilled.get(key, ()):
            self._write_at(offset, records[first:first + count].view(np.uint8))
            first += count
        if key in self._waiting:
            self._waiting[key] = [records[first:] if not first else records[first:].copy()]

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

    # pread and pwrite leave the file's position alone, so threads may use it together; Windows has neither
    def _read_at(self, offset, size):
        if hasattr(os, "pread"):
            return os.pread(self._file.fileno(), size, offset)
        with self._lock:
            self._file.seek(offset)
            return self._file.read(size)

    def _write_at(self, offset, data):
        if hasattr(os, "pwrite"):
            os.pwrite(self._file.fileno(), data, offset)
            return
        with self._lock:
            self._file.seek(offset)
            self._file.write(data)
            self._file.flush()

    def window(self, road, start, end):
        """Points of a road with start <= station < end (metres), in canonical order per section."""
        first = int(np.floor(start / self.section_length))
        last = int(np.floor(np.nextafter(end, -np.inf) / self.section_length))
        parts = []
        for number in range(first, last + 1):
            records = self.section(road, number)
            if number in (first, last) and len(records):
                s = records["s"] * UNIT
                inside = (s >= start) & (s < end)
                records = records if inside.all() else chosen(records, inside)
            parts.append(records)
        return Points(parts[0] if len(parts) == 1 else joined(parts, self.dtype))

    def span(self, road):
        """(start, end) of the sections of a road that have points, metres."""
        sections = self.sections(road)
        if not sections:
            return 0.0, 0.0
        return sections[0] * self.section_length, (sections[-1] + 1) * self.section_length

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
