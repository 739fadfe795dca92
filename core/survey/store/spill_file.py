"""A temporary file in which columns are put down and picked up again, by several threads at once."""

import os
import tempfile
import threading
import weakref
from bisect import insort
from typing import NamedTuple

import numpy as np

from ...common.memory import columns_kept

# Columns in as few bytes as hold them, to the bit: what is put into a temporary file costs by the byte.

AT_ONCE = 1 << 15      # values worked at a time: what fits the processor's cache
PARTS = {0: (), 1: (1,), 2: (2,), 3: (2, 1), 4: (4,), 5: (4, 1), 6: (4, 2)}  # bytes of a value, and widths of its parts, lowest first


class Packing(NamedTuple):
    """How a column of `count` values was packed: its bits less `least`, in parts of so many bytes, all lowest parts first."""

    dtype: np.dtype
    count: int
    least: int
    widths: tuple

    @property
    def nbytes(self):
        return self.count * sum(self.widths)

    @property
    def alike(self):
        """A read-only view of the one value that all have; None where they differ."""
        if self.widths:
            return None
        size = self.dtype.itemsize
        return np.broadcast_to(np.array(self.least % 2**(8 * size), f"u{size}").view(self.dtype), self.count)

    def unpack(self, data, column, rows=None):
        """Fill a column, (N,), from its packed bytes; with some rows of it, (M,), where they are given."""
        bits = np.dtype(f"u{self.dtype.itemsize}")
        least, column = bits.type(self.least % 2**(8 * bits.itemsize)), column.view(bits)
        low, *high = _parts(data, self)
        for first in range(0, len(column), AT_ONCE):
            piece = column[first:first + AT_ONCE]
            some = slice(first, first + AT_ONCE) if rows is None else rows[first:first + AT_ONCE]
            if high:
                np.left_shift(_some(high[0], some), 8 * self.widths[0], out=piece, dtype=bits)
                piece |= _some(low, some)
                piece += least
            else:
                np.add(_some(low, some), least, out=piece, dtype=bits)


def packed(column):
    """Packing and packed bytes, (B,) uint8, of a column of one or more numbers.

    The bytes are overwritten by the next column that the same thread packs.
    """
    column = np.ascontiguousarray(column)
    size = column.dtype.itemsize
    values = column.view(f"i{size}") if column.dtype.kind == "f" else column   # so that NaN is NaN
    least, most = int(values.min()), int(values.max())
    widths = PARTS.get(((most - least).bit_length() + 7) // 8, (size,))
    if sum(widths) >= size:
        return Packing(column.dtype, len(column), 0, (size,)), column.view(np.uint8)
    packing = Packing(column.dtype, len(column), least, widths)
    bits = column.view(f"u{size}")
    least = bits.dtype.type(least % 2**(8 * size))
    data = columns_kept.of(packing.nbytes)("packed", np.uint8)
    parts = _parts(data, packing)
    over = np.empty(min(len(bits), AT_ONCE), bits.dtype)
    for first in range(0, len(bits) if parts else 0, AT_ONCE):
        here = bits[first:first + AT_ONCE]
        rest = np.subtract(here, least, out=over[:len(here)])
        parts[0][first:first + AT_ONCE] = rest
        if len(parts) > 1:
            parts[1][first:first + AT_ONCE] = np.right_shift(rest, 8 * widths[0], out=rest)
    return packing, data


def _parts(data, packing):
    """Views of the packed bytes, one for each part of the values."""
    ends = np.cumsum([0, *packing.widths]) * packing.count
    return [data[first:end].view(f"u{width}") for first, end, width in zip(ends[:-1].tolist(), ends[1:].tolist(), packing.widths)]


def _some(part, rows):
    return part[rows] if isinstance(rows, slice) else part.take(rows, mode="clip")

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
