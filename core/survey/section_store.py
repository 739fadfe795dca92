"""A bounded store of points by road section: memory up to a limit, then a temporary file."""

import os
import tempfile
import threading
from collections import OrderedDict, defaultdict

import numpy as np

from .points import Points, UNIT, canonical_order

SECTION_LENGTH = 20.0  # m of station; results must not depend on it
MEMORY_LIMIT = 400 * 2**20  # bytes of records kept before they are spilled
KEPT_SECTIONS = 8  # last read, sorted: neighbours ask for them again


class SectionStore:
    """Points of all roads, appended in any order, read back by station.

    A section is a fixed cell of station of one road, cut from 0. What is read
    back is sorted by time and place, so it does not depend on the order of
    appending. The spill file has no name on disk, so a killed run leaves nothing.
    """

    def __init__(self, dtype, section_length=SECTION_LENGTH, memory_limit=MEMORY_LIMIT):
        self.dtype = np.dtype(dtype)
        self.section_length = section_length
        self.memory_limit = memory_limit
        self._waiting = defaultdict(list)   # (road, section) -> arrays in memory
        self._spilled = defaultdict(list)   # (road, section) -> (offset, count) in the file
        self._sorted = OrderedDict()        # a few sections as last read
        self._lock = threading.Lock()       # sections are read by several threads
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
        section, records = section[order], records[order]
        starts = np.r_[0, np.flatnonzero(np.diff(section)) + 1, len(section)]
        for a, b in zip(starts[:-1], starts[1:]):
            key = (int(road), int(section[a]))
            self._waiting[key].append(records[a:b].copy())
            self._sorted.pop(key, None)
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
                self._file.write(array.tobytes())
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
        """The records of one section in canonical order (empty where there are none)."""
        key = (road, section)
        with self._lock:
            cached = self._sorted.get(key)
            if cached is not None:
                self._sorted.move_to_end(key)
                return cached
        arrays = []
        for offset, count in self._spilled.get(key, ()):
            # pread leaves the file's position alone, so threads may read together
            data = os.pread(self._file.fileno(), count * self.dtype.itemsize, offset) if hasattr(os, "pread") \
                else self._read_at(offset, count)
            arrays.append(np.frombuffer(data, self.dtype))
        arrays += self._waiting.get(key, [])
        records = np.concatenate(arrays) if arrays else np.empty(0, self.dtype)
        records = records[canonical_order(records)]
        with self._lock:
            self._sorted[key] = records
            while len(self._sorted) > KEPT_SECTIONS:
                self._sorted.popitem(last=False)
        return records

    def _read_at(self, offset, count):
        with self._lock:
            self._file.seek(offset)
            return self._file.read(count * self.dtype.itemsize)

    def window(self, road, start, end):
        """Points of a road with start <= station < end (metres), in canonical order per section."""
        first = int(np.floor(start / self.section_length))
        last = int(np.floor(np.nextafter(end, -np.inf) / self.section_length))
        parts = []
        for number in range(first, last + 1):
            records = self.section(road, number)
            if number in (first, last) and len(records):
                s = records["s"] * UNIT
                records = records[(s >= start) & (s < end)]
            parts.append(records)
        return Points(np.concatenate(parts) if parts else np.empty(0, self.dtype))

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
        self._sorted.clear()
        if self._file is not None:
            self._file.close()
            self._file = None
