"""Files of columns: temporary ones, written and read by several threads at once, and parts that one process writes for all.

Columns are packed, without loss, into as few bytes per value as their range needs, since the cost of a
temporary file grows with its bytes.
"""

from __future__ import annotations

import os
import struct
import tempfile
import threading
import weakref
from bisect import insort
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple
from uuid import uuid4

import numpy as np

from ...common.parallel import column_buffers, freed_on_demand
from ...execution.phase import checksum
from ..weights import STORE

PART_WIDTHS = {0: (), 1: (1,), 2: (2,), 3: (2, 1), 4: (4,), 5: (4, 1), 6: (4, 2)}  # derived: bytes of a value -> bytes of its parts, lowest first
PART_DTYPES = {width: np.dtype(f"u{width}") for width in (1, 2, 4, 8)}   # derived: of unsigned integers
SEAL = struct.Struct("<I")   # CRC-32 of what comes before it in a part


class Packing(NamedTuple):
    """How a column was packed: the bits of its values less `least`, split into parts; all lowest parts come first.

    dtype : of the column
    size : values
    least : the least value, as an integer of the column's bits
    widths : bytes of each part, lowest first; none where all values are equal
    """

    dtype: np.dtype
    size: int
    least: int
    widths: tuple[int, ...]

    @property
    def nbytes(self) -> int:
        return self.size * sum(self.widths)

    @property
    def constant(self) -> np.ndarray | None:
        """A read-only (N,) view of the one value that all have; None where they differ."""
        if self.widths:
            return None
        itemsize = self.dtype.itemsize
        return np.broadcast_to(np.array(self.least % 2**(8 * itemsize), f"u{itemsize}").view(self.dtype), self.size)

    def unpack(self, data: np.ndarray, column: np.ndarray, rows: np.ndarray | None = None) -> None:
        """Fill a column, (N,) or (M,) with the indices of some `rows`, from its (B,) uint8 packed bytes."""
        bits = np.dtype(f"u{self.dtype.itemsize}")
        least, column = bits.type(self.least % 2**(8 * bits.itemsize)), column.view(bits)
        low, *high = _part_views(data, self)
        for first in range(0, len(column), STORE.packing_chunk):
            chunk = column[first:first + STORE.packing_chunk]
            chunk_rows = slice(first, first + STORE.packing_chunk) if rows is None else rows[first:first + STORE.packing_chunk]
            if high:
                np.left_shift(_values_at(high[0], chunk_rows), 8 * self.widths[0], out=chunk, dtype=bits)
                chunk |= _values_at(low, chunk_rows)
                chunk += least
            else:
                np.add(_values_at(low, chunk_rows), least, out=chunk, dtype=bits)


def pack(column: np.ndarray) -> tuple[Packing, np.ndarray]:
    """Packing and (B,) uint8 packed bytes of (N,) integers or floats, N > 0; the next column that the same thread packs overwrites the bytes."""
    column = np.ascontiguousarray(column)
    itemsize = column.dtype.itemsize
    values = column.view(f"i{itemsize}") if column.dtype.kind == "f" else column   # NaN has no order, its bits have
    least, most = int(values.min()), int(values.max())
    widths = PART_WIDTHS.get(((most - least).bit_length() + 7) // 8, (itemsize,))
    if sum(widths) >= itemsize:
        return Packing(column.dtype, len(column), 0, (itemsize,)), column.view(np.uint8)
    packing = Packing(column.dtype, len(column), least, widths)
    bits = column.view(f"u{itemsize}")
    offset = bits.dtype.type(least % 2**(8 * itemsize))
    data = column_buffers.of(packing.nbytes)("packed", np.uint8)
    parts = _part_views(data, packing)
    buffer = np.empty(min(len(bits), STORE.packing_chunk), bits.dtype)
    for first in range(0, len(bits) if parts else 0, STORE.packing_chunk):
        chunk = bits[first:first + STORE.packing_chunk]
        rest = np.subtract(chunk, offset, out=buffer[:len(chunk)])
        parts[0][first:first + STORE.packing_chunk] = rest
        if len(parts) > 1:
            parts[1][first:first + STORE.packing_chunk] = np.right_shift(rest, 8 * widths[0], out=rest)
    return packing, data


def _part_views(data, packing):
    """Views of the packed bytes, one for each part of the values."""
    views, first = [], 0
    for width in packing.widths:
        end = first + width * packing.size
        views.append(data[first:end].view(PART_DTYPES[width]))
        first = end
    return views


def _values_at(part, rows):
    return part[rows] if isinstance(rows, slice) else part.take(rows, mode="clip")


class StoredColumn(NamedTuple):
    """A column in a file: its first byte there, and how it is packed."""

    place: int
    packing: Packing
    file: ColumnFile


class ColumnFile:
    """Columns in a file that is finished, read by any number of threads and processes.

    The file is opened when it is read, and again where too many others were read meanwhile.
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    def get(self, stored: StoredColumn, out: np.ndarray | None = None, rows: np.ndarray | None = None) -> np.ndarray:
        """(N,) values of a column, or (M,) at the indices of some `rows`, into `out` where it is given; else read-only where all are equal."""
        packing = stored.packing
        count = packing.size if rows is None else len(rows)
        constant = packing.constant
        if constant is not None and out is None:
            return constant[:count]
        column = np.empty(count, packing.dtype) if out is None else out
        if constant is not None:
            column[:] = constant[:count]
        elif rows is not None and 2 * count > packing.size:   # for most rows, unpacking all is faster
            np.take(self.get(stored, column_buffers.of(packing.size)("column", packing.dtype)), rows, out=column, mode="clip")
        elif count:
            self._unpack(stored, column, rows)
        return column

    def _unpack(self, stored, column, rows):
        """Fill a column from the bytes between its first and its last row that is asked for."""
        start, packing, _ = stored
        if packing.widths == (packing.dtype.itemsize,) and rows is None:
            self._read(start, column)
            return
        first, end = (0, packing.size) if rows is None else (int(rows.min()), int(rows.max()) + 1)
        span = packing._replace(size=end - first)
        data, begin = column_buffers.of(span.nbytes)("packed", np.uint8), 0
        for width in packing.widths:
            self._read(start + first * width, data[begin:begin + span.size * width])
            start, begin = start + packing.size * width, begin + span.size * width
        span.unpack(data, column, rows - first if rows is not None and first else rows)

    def release(self, stored: StoredColumn) -> None:
        """Others may read the column: it stays."""

    def _read(self, place, array):
        """Fill a contiguous array from a place."""
        _opened(str(self.path)).read(place, array)


class _OpenFile:
    """A file that is closed when nobody reads it any more."""

    def __init__(self, file):
        # Closed with this object; otherwise Python warns of an unclosed file.
        self.file, self.lock = file, threading.Lock()
        weakref.finalize(self, file.close)

    # pread and pwrite leave the file's position alone, so threads may use them together; Windows has neither.
    def read(self, place, array):
        """Fill a contiguous array from a place."""
        data = memoryview(array.view(np.uint8)) if array.nbytes else b""
        while len(data):
            if hasattr(os, "preadv"):
                count = os.preadv(self.file.fileno(), [data], place)
            else:
                with self.lock:
                    self.file.seek(place)
                    count = self.file.readinto(data)
            if not count:
                raise OSError(f"{self.file.name} ends early, at byte {place:,}")
            data, place = data[count:], place + count

    def write(self, place, array):
        """Write an array at a place."""
        data = memoryview(np.ascontiguousarray(array).view(np.uint8)) if array.nbytes else b""
        try:
            while len(data):  # a signal may shorten a write; a full disk raises
                if hasattr(os, "pwrite"):
                    written = os.pwrite(self.file.fileno(), data, place)
                else:
                    with self.lock:
                        self.file.seek(place)
                        written = self.file.write(data)
                data, place = data[written:], place + written
        except OSError as error:   # which does not say where the disk is full
            name = self.file.name
            raise OSError(error.errno, error.strerror, name if isinstance(name, str) else tempfile.gettempdir()) from error


@lru_cache(maxsize=STORE.open_parts)
def _opened(path):
    return _OpenFile(open(path, "rb", buffering=0))


@freed_on_demand
def close_parts() -> None:
    """Close the files that are held open: Windows removes none that is."""
    _opened.cache_clear()


@contextmanager
def new_part(folder: Path) -> Iterator[SpillFile]:
    """A new file in a folder, which appears there at the end, whole or not at all; without a byte in it there is none."""
    name = f"points-{uuid4().hex}.bin"
    unfinished = folder / f"{name}.part"
    file = SpillFile(folder / name, unfinished)
    try:
        yield file
        file.seal()
        file.close()
        if file.end:
            os.replace(unfinished, folder / name)
    finally:
        file.close()
        unfinished.unlink(missing_ok=True)


def parts_are_whole(folder: Path) -> bool:
    """Whether all files of `new_part` in a folder are as they were written, which they may not be after the power failed."""
    for path in folder.glob("points-*.bin"):
        with open(path, "rb", buffering=0) as file:
            end = os.fstat(file.fileno()).st_size - SEAL.size
            if end < 0 or checksum(file, end) != SEAL.unpack(file.read(SEAL.size))[0]:
                return False
    return True


class SpillFile(ColumnFile):
    """Columns in a file that grows; `end` is its length in bytes.

    path : of the file; by default it is a temporary one without a name, which a killed run does not leave behind (on Windows it
        is deleted when it is closed)
    unfinished : its path until then
    """

    def __init__(self, path: Path | None = None, unfinished: Path | None = None) -> None:
        super().__init__(path or Path())
        self._own = _OpenFile(open(unfinished or path, "w+b", buffering=0) if path else tempfile.TemporaryFile(prefix="lanewright-", buffering=0))
        self._lock = threading.Lock()
        self._free: list[tuple[int, int]] = []   # (first byte, bytes) of released columns, by place
        self.end = 0

    def put(self, column: np.ndarray) -> StoredColumn:
        """Write an (N,) column, N > 0, into the first free range that is large enough, or at the end."""
        packing, data = pack(column)
        start = self._allocate(packing.nbytes)
        self._own.write(start, data)
        return StoredColumn(start, packing, self)

    def release(self, stored: StoredColumn) -> None:
        if not stored.packing.nbytes:
            return
        with self._lock:
            insort(self._free, (stored.place, stored.packing.nbytes))
            merged = [self._free[0]]
            for start, nbytes in self._free[1:]:
                before, length = merged[-1]
                if before + length == start:
                    merged[-1] = before, length + nbytes
                else:
                    merged.append((start, nbytes))
            if len(merged) > STORE.max_free_ranges:
                merged.remove(min(merged, key=lambda free: free[1]))
            self._free = merged

    def _allocate(self, nbytes):
        if not nbytes:
            return 0
        with self._lock:
            for k, (start, length) in enumerate(self._free):
                if length >= nbytes:
                    self._free[k:k + 1] = [(start + nbytes, length - nbytes)] * (length > nbytes)
                    return start
            self.end += nbytes
            return self.end - nbytes

    def seal(self) -> None:
        """Write a checksum of all bytes behind them, by which `parts_are_whole` knows them again."""
        if self.end:
            self._own.file.seek(0)
            self._own.write(self.end, np.frombuffer(SEAL.pack(checksum(self._own.file, self.end)), np.uint8))

    def _read(self, place, array):
        self._own.read(place, array)

    def close(self) -> None:
        """Release the disk space of a file without a name; others stay."""
        self._own.file.close()


# What lies where in the files of a store: plain arrays, by which any process opens the points that others wrote.

Key = tuple[int, int]   # numbers of a road and of a section of it


@dataclass(frozen=True)
class StoreIndex:
    """Parts of sections in files of one folder. The parts of one section follow each other in the order in which they were added.

    files : names of the files
    parts : (K, 5) int64: road, section, number of the file, points, whether they are all points of the section, in canonical order
    places, least : (K, C) int64, first byte and least value of each of the C columns of the store
    widths : (K, C) uint8, bytes of a packed value
    """

    files: tuple[str, ...]
    parts: np.ndarray
    places: np.ndarray
    least: np.ndarray
    widths: np.ndarray

    @classmethod
    def of(cls, sections: Iterable[tuple[Key, bool, Sequence[Any]]]) -> StoreIndex:
        """The index of sections whose points lie in files with names: key, whether its points are in order, and its parts, {column: StoredColumn}."""
        files: dict[str, int] = {}
        rows, columns = [], []
        for key, in_order, parts in sections:
            for part in parts:
                stored = list(part.values())
                number = files.setdefault(stored[0].file.path.name, len(files))
                rows.append((*key, number, stored[0].packing.size, in_order))
                columns.append([(column.place, column.packing.least, sum(column.packing.widths)) for column in stored])
        table = np.array(columns, np.int64).reshape(len(rows), len(columns[0]) if rows else 0, 3)
        return cls(tuple(files), np.array(rows, np.int64).reshape(-1, 5), table[..., 0], table[..., 1], table[..., 2].astype(np.uint8))

    @classmethod
    def join(cls, indexes: Sequence[StoreIndex]) -> StoreIndex:
        indexes = [index for index in indexes if len(index.parts)] or list(indexes[:1])
        before = np.cumsum([0, *(len(index.files) for index in indexes)])
        parts = [index.parts + np.array([0, 0, shift, 0, 0]) for index, shift in zip(indexes, before)]
        return cls(tuple(name for index in indexes for name in index.files), np.concatenate(parts),
                   *(np.concatenate([getattr(index, name) for index in indexes]) for name in ("places", "least", "widths")))

    @property
    def count(self) -> int:
        """Points that have a station."""
        return int(self.parts[self.parts[:, 0] >= 0, 3].sum())

    def stored(self, folder: Path, dtype: np.dtype) -> Iterator[tuple[Key, bool, dict[str, StoredColumn]]]:
        """Yield (key, whether in order, {column: StoredColumn}) of every part; the files lie in the folder, the points have the structured dtype."""
        files = [ColumnFile(folder / name) for name in self.files]
        tables = (self.parts.tolist(), self.places.tolist(), self.least.tolist(), self.widths.tolist())
        for (road, section, number, count, in_order), *columns in zip(*tables):
            yield (road, section), bool(in_order), {
                name: StoredColumn(start, Packing(dtype[name], count, least, PART_WIDTHS.get(width, (width,))), files[number])
                for name, start, least, width in zip(dtype.names or (), *columns)}
