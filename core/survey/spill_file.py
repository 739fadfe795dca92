"""A temporary file in which columns are put down and picked up again, by several threads at once."""

import os
import tempfile
import threading
import weakref
from bisect import insort
from typing import NamedTuple

import numpy as np

from .kept_arrays import columns_kept
from .packing import Packing, packed

MOST_GAPS = 64   # places given back that are remembered; of more the largest


class Stored(NamedTuple):
    """Where the packed bytes of a column lie, and how they are packed."""

    place: int
    packing: Packing


class SpillFile:
    """Columns at places of a file without a name (on Windows it is deleted when it is closed): a killed run leaves nothing.

    A column takes the place of others that were given back, where there is room.
    """

    def __init__(self):
        self._file = tempfile.TemporaryFile(prefix="lanewright-", buffering=0)
        # it goes with the survey that it was made for; left to Python, the log would be warned of an unclosed file
        weakref.finalize(self, self._file.close)
        self._lock = threading.Lock()
        self._gaps = []       # (place, bytes) given back, by place
        self.end = 0

    def put(self, column):
        """Put a column of one or more numbers down; returns a Stored."""
        packing, data = packed(column)
        place = self._room(packing.nbytes)
        self.write(place, data)
        return Stored(place, packing)

    def get(self, stored, out=None, rows=None):
        """The (N,) column of a Stored, or (M,) some rows of it; put into `out` where one is given, else read-only where all are alike."""
        place, packing = stored
        count = packing.count if rows is None else len(rows)
        if not packing.widths and out is None:
            return packing.alike[:count]
        column = np.empty(count, packing.dtype) if out is None else out
        if not packing.widths:
            column[:] = packing.alike[:count]
        elif packing.widths == (packing.dtype.itemsize,) and rows is None:
            self.read(place, column)
        elif rows is not None and 2 * count > packing.count:   # most rows: all are unpacked faster than these picked from every part
            np.take(self.get(stored, columns_kept.of(packing.count)("column", packing.dtype)), rows, out=column, mode="clip")
        elif count:
            first, end = (0, packing.count) if rows is None else (int(rows.min()), int(rows.max()) + 1)
            run = packing._replace(count=end - first)
            data, begin = columns_kept.of(run.nbytes)("packed", np.uint8), 0
            for width in packing.widths:
                self.read(place + first * width, data[begin:begin + run.count * width])
                place, begin = place + packing.count * width, begin + run.count * width
            run.unpack(data, column, rows - first if first else rows)
        return column

    def give_back(self, stored):
        """The place of a column may be taken by others."""
        if not stored.packing.nbytes:
            return
        with self._lock:
            insort(self._gaps, (stored.place, stored.packing.nbytes))
            joined = [self._gaps[0]]
            for place, size in self._gaps[1:]:
                before, room = joined[-1]
                if before + room == place:
                    joined[-1] = before, room + size
                else:
                    joined.append((place, size))
            if len(joined) > MOST_GAPS:
                joined.remove(min(joined, key=lambda gap: gap[1]))
            self._gaps = joined

    def _room(self, nbytes):
        """The first place that is large enough."""
        if not nbytes:
            return 0
        with self._lock:
            for k, (place, size) in enumerate(self._gaps):
                if size >= nbytes:
                    self._gaps[k:k + 1] = [(place + nbytes, size - nbytes)] * (size > nbytes)
                    return place
            self.end += nbytes
            return self.end - nbytes

    # pread and pwrite leave the file's position alone, so threads may use it together; Windows has neither
    def write(self, place, array):
        """Put an array down at a place."""
        data = memoryview(np.ascontiguousarray(array).view(np.uint8)) if array.nbytes else b""
        while len(data):  # a full disk raises, a signal only shortens
            if hasattr(os, "pwrite"):
                written = os.pwrite(self._file.fileno(), data, place)
            else:
                with self._lock:
                    self._file.seek(place)
                    written = self._file.write(data)
            data, place = data[written:], place + written

    def read(self, place, array):
        """Fill a contiguous array with what lies at a place."""
        data = memoryview(array.view(np.uint8)) if array.nbytes else b""
        while len(data):
            if hasattr(os, "preadv"):
                read = os.preadv(self._file.fileno(), [data], place)
            else:
                with self._lock:
                    self._file.seek(place)
                    read = self._file.readinto(data)
            if not read:
                raise EOFError(f"The temporary file ends at byte {place:,}.")
            data, place = data[read:], place + read

    def close(self):
        """Give the disk space back."""
        self._file.close()
