"""Files of arrays: written once, as the arrays lie in memory, and mapped into memory by whoever reads them: thread, process or machine.

The operating system keeps in memory what was written and read last, once for all who read it.
"""

from __future__ import annotations

import math
import mmap
import os
import tempfile
import threading
import weakref
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np

from ...common.parallel import freed_on_demand
from ...execution.phase import SEAL, checksum
from ..weights import STORE

ArrayPlace = tuple[str, int]   # the name of a file and the first byte of an array there
ALIGNMENT = 8   # derived: bytes: the longest number of an array begins at a multiple of them


class ArrayFile:
    """Arrays one after the other in a file, which several threads may write and read; `end` is its length in bytes.

    name : no other file has it
    path : of the file; None for a temporary one without a name, which a killed run does not leave behind (on Windows it is deleted when it is closed)
    mode : "w+b" for a new file, "rb" for one that others finished
    """

    def __init__(self, path: Path | None = None, mode: str = "w+b") -> None:
        self.path, self._lock = path, threading.Lock()
        self.name = uuid4().hex if path is None else path.name
        self._file: Any = tempfile.TemporaryFile(prefix="lanewright-", buffering=0) if path is None else open(path, mode, buffering=0)
        # closed with this object; otherwise Python warns of an unclosed file
        weakref.finalize(self, self._file.close)
        self._map: mmap.mmap | None = None
        self.end = os.fstat(self._file.fileno()).st_size

    def put(self, arrays: Iterable[np.ndarray], nbytes: int) -> int:
        """Write arrays of so many bytes together one after the other; their first byte. Each is written before the next one is asked for."""
        with self._lock:
            first, self.end = self.end, self.end + -(-nbytes // ALIGNMENT) * ALIGNMENT
        place = first
        for array in arrays:
            self._write(place, array)
            place += array.nbytes
        return first

    def get(self, place: int, count: int, dtype: Any) -> np.ndarray:
        """(N,) read-only values from a byte on, which stay in the file until they are used. Raises OSError where the file ends before."""
        end = place + count * np.dtype(dtype).itemsize
        with self._lock:
            if self._map is None or end > len(self._map):
                if os.fstat(self._file.fileno()).st_size < end:
                    raise OSError(f"{self._file.name} ends early, before byte {end:,}")
                self._map = mmap.mmap(self._file.fileno(), 0, access=mmap.ACCESS_READ)
                _mapped.follow(self)
            mapped = self._map
        _mapped.count(end - place)
        return np.frombuffer(mapped, dtype, count, place)

    # pwrite leaves the file's position alone, so threads may use it together; Windows lacks it
    def _write(self, place, array):
        data = memoryview(np.ascontiguousarray(array).view(np.uint8)) if array.nbytes else b""
        try:
            while len(data):  # a signal may shorten a write; a full disk raises
                if hasattr(os, "pwrite"):
                    written = os.pwrite(self._file.fileno(), data, place)
                else:
                    with self._lock:
                        self._file.seek(place)
                        written = self._file.write(data)
                data, place = data[written:], place + written
        except OSError as error:   # which does not say where the disk is full
            raise OSError(error.errno, error.strerror, str(self.path or tempfile.gettempdir())) from error

    def seal(self) -> None:
        """Fill the file up to its end and write a checksum of all bytes behind them, by which `is_sealed` knows them again."""
        self._file.truncate(self.end)
        self._file.seek(0)
        self._write(self.end, np.frombuffer(SEAL.pack(checksum(self._file, self.end)), np.uint8))

    def close(self) -> None:
        """Release the disk space of a file without a name, as soon as nobody uses its arrays; others stay."""
        self._map = None
        self._file.close()

    def forget_pages(self) -> None:
        """Let go of the pages that are mapped; the arrays stay, and fetch theirs again from the file."""
        mapped = self._map
        if mapped is not None and hasattr(mapped, "madvise"):
            mapped.madvise(mmap.MADV_DONTNEED)


class _MappedPages:
    """What this process has mapped of all files: more than `STORE.mapped_bytes` would count as its memory for as long as they are open."""

    def __init__(self) -> None:
        self._lock, self._files, self._nbytes = threading.Lock(), weakref.WeakSet[ArrayFile](), 0

    def follow(self, file: ArrayFile) -> None:
        with self._lock:
            self._files.add(file)

    def count(self, nbytes: int) -> None:
        with self._lock:
            self._nbytes += nbytes
            if self._nbytes <= STORE.mapped_bytes:
                return
            self._nbytes, files = 0, list(self._files)
        for file in files:
            file.forget_pages()


_mapped = _MappedPages()


@lru_cache(maxsize=STORE.open_files)
def opened(path: Path) -> ArrayFile:
    """A file that is finished, open for reading; again where too many others were read meanwhile."""
    return ArrayFile(path, "rb")


@freed_on_demand
def close_files() -> None:
    """Close the files that are held open: Windows removes none that is."""
    opened.cache_clear()


@contextmanager
def new_file(folder: Path) -> Iterator[tuple[ArrayFile, str]]:
    """A new file in a folder and its name, under which it appears there at the end, whole or not at all; without a byte in it there is none."""
    name = f"points-{uuid4().hex}.bin"
    unfinished = folder / f"{name}.part"
    file = ArrayFile(unfinished)
    try:
        yield file, name
        if file.end:
            file.seal()
        file.close()
        if file.end:
            os.replace(unfinished, folder / name)
    finally:
        file.close()
        unfinished.unlink(missing_ok=True)


class SharedArrays:
    """Arrays that tasks write, each task those of its own at once; whoever does so, and the caller, finds them again by their places.

    folder : that all of them see, in which each task makes a file; None for threads, which share a temporary file without a name
    """

    def __init__(self, folder: Path | str | None) -> None:
        self.folder: Any = folder and Path(folder)
        self._file = None if folder else ArrayFile()

    def __getstate__(self) -> dict[str, Any]:
        return {"folder": str(self.folder)}

    def put(self, arrays: Iterable[np.ndarray]) -> list[ArrayPlace]:
        """Write arrays; where each of them lies."""
        if self._file is not None:
            return [("", self._file.put([array], array.nbytes)) for array in arrays]
        with new_file(self.folder) as (file, name):
            return [(name, file.put([array], array.nbytes)) for array in arrays]

    def get(self, place: ArrayPlace, shape: Sequence[int], dtype: Any = np.float32) -> np.ndarray:
        """An array that was written, read-only, which stays in its file until it is used."""
        name, first = place
        file = opened(self.folder / name) if self._file is None else self._file
        return file.get(first, math.prod(shape), dtype).reshape(shape)

    def close(self) -> None:
        """Release the disk space of a file without a name; what lies in a folder may be wanted again."""
        if self._file is not None:
            self._file.close()
