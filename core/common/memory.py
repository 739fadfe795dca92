"""Reused working memory, work on some rows of a long table at a time, and the return of freed memory to the operating system."""

from __future__ import annotations

import ctypes
import gc
import sys
import threading
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import DTypeLike

ROWS_OF_A_PART = 1024   # rows of some hundred cells: a megabyte of each array


def by_rows(function: Callable[[slice], np.ndarray], count: int, at_once: int = ROWS_OF_A_PART) -> np.ndarray:
    """What a function gives for rows that do not depend on each other, computed some at a time, so that what it needs meanwhile stays small.

    Parameters
    ----------
    function : of a slice of the rows; an array with one entry for each of them
    count : of rows
    at_once : rows in a slice

    Returns
    -------
    (count, ...) array
    """
    found = function(slice(0, min(at_once, count)))
    if count <= at_once:
        return found
    whole = np.empty((count, *found.shape[1:]), found.dtype)
    whole[:at_once] = found
    for first in range(at_once, count, at_once):
        some = slice(first, min(first + at_once, count))
        whole[some] = function(some)
    return whole


def trim_heap() -> None:
    """Return freed memory from the C library to the operating system.

    glibc keeps freed memory per thread, and the threads of the next stage allocate anew: after a few stages most of
    the memory of a process would be such remains. Nothing happens where the C library has no `malloc_trim` (Windows,
    macOS, musl).
    """
    if sys.platform.startswith("linux"):
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        if trim is not None:
            trim(0)


M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3   # parameters of glibc's mallopt
LARGEST_REUSED = 32 * 2**20                    # bytes of an array whose memory is used again; glibc takes no more on 64 bits


def reuse_freed_memory() -> None:
    """Let the C library keep freed memory for the next arrays, until `trim_heap`.

    It does so by itself unless the environment says otherwise, which Dask does for its workers (MALLOC_TRIM_THRESHOLD_): then every array of
    more than 128 KiB is mapped anew, and each page of it fetched from the operating system, which takes longer than the work on it.
    The limits are those up to which glibc raises its own. Nothing happens where the C library has no `mallopt` of glibc.
    """
    if sys.platform.startswith("linux"):
        library = ctypes.CDLL(None)
        if hasattr(library, "mallopt") and hasattr(library, "gnu_get_libc_version"):
            library.mallopt(M_MMAP_THRESHOLD, LARGEST_REUSED)
            library.mallopt(M_TRIM_THRESHOLD, 2 * LARGEST_REUSED)


_kept: list[Callable[[], None]] = []


def freed_on_demand(free: Callable[[], None]) -> Callable[[], None]:
    """Decorator of functions that let go of what a module keeps for later: `free_memory` calls them."""
    _kept.append(free)
    return free


def free_memory() -> None:
    """Let go of what modules keep for later, and return all freed memory to the operating system."""
    for free in _kept:
        free()
    gc.collect()
    trim_heap()


class ScratchBuffers(threading.local):
    """Per-thread working arrays by name; reuse avoids the page faults of newly allocated memory.

    The content of an array is undefined at the start of each use.
    """

    def __init__(self) -> None:
        self._arrays: dict[str, np.ndarray] = {}

    def of(self, count: int) -> Callable[..., np.ndarray]:
        """A function (name, dtype=float64) that returns the array of that name with `count` values."""
        return partial(self._array, count)

    def _array(self, count: int, name: str, dtype: DTypeLike = np.float64) -> np.ndarray:
        nbytes = count * np.dtype(dtype).itemsize
        data = self._arrays.get(name)
        if data is None or len(data) < nbytes:
            data = self._arrays[name] = np.empty(nbytes + nbytes // 8, np.uint8)
        return data[:nbytes].view(dtype)


column_buffers = ScratchBuffers()   # for packing and unpacking columns of records
