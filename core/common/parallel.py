"""Worker threads with ordered results, and cancellation of long work."""

from __future__ import annotations

import ctypes
import errno
import gc
import os
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from ..lazy import LazyModule
from .errors import Cancelled, RoadExtractionError
from .progress import Progress

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import DTypeLike
else:
    np = LazyModule("numpy")  # the plugin loads without it, to say what is missing

POLL_INTERVAL = 0.2   # cost: s between two checks for cancellation while a result is awaited
MAX_WORKERS = 4       # cost: threads by default at most

_thread = threading.local()

Item = TypeVar("Item")
Result = TypeVar("Result")


def ordered_map(function: Callable[[Item], Result], items: Iterable[Item], progress: Progress = Progress(),
                threads: int | None = None) -> Iterator[Result]:
    """Apply a function to every item in several threads and yield the results in the order of the items.

    At most one result more than there are threads is computed ahead, so memory stays bounded. While a result is awaited, cancellation is checked too,
    by `progress` and by `check_cancelled`. numpy and scipy release the interpreter lock in their heavy loops, which is where most of the time is
    spent. Whatever the function raises is raised, and the remaining items are dropped.

    progress : reports the share of the items that are done
    threads : number of threads; by default one per processor core, at most four

    Raises Cancelled if the user cancelled; the worker threads end at their next `check_cancelled`.
    """
    items = items if isinstance(items, Sequence) else list(items)
    threads, following = threads or min(MAX_WORKERS, os.cpu_count() or 1), iter(items)
    stop = threading.Event()

    def check_stopped() -> None:
        if stop.is_set():
            raise Cancelled

    def work(item: Item) -> Result:
        _thread.check = check_stopped
        return function(item)

    with ThreadPoolExecutor(threads) as pool:
        waiting: deque[Future[Result]] = deque()
        try:
            for done in range(len(items)):
                waiting += [pool.submit(work, item) for item in islice(following, threads + 1 - len(waiting))]
                while not wait(list(waiting)[:1], POLL_INTERVAL).done:
                    progress.report(done / len(items))
                    check_cancelled()
                yield waiting.popleft().result()
                progress.report((done + 1) / len(items))
        finally:
            stop.set()
            for future in waiting:
                future.cancel()


@contextmanager
def cancellation_scope(progress: Progress) -> Iterator[None]:
    """Within this context, `check_cancelled` in the current thread checks `progress` for cancellation."""
    before = getattr(_thread, "check", None)
    _thread.check = progress.check_cancelled
    try:
        yield
    finally:
        _thread.check = before


def check_cancelled() -> None:
    """Raise `Cancelled` in long work without a `progress` argument, if the user cancelled or nobody uses the results of this worker thread any more.

    See `cancellation_scope` and `ordered_map`.
    """
    check = getattr(_thread, "check", None)
    if check is not None:
        check()


# Reused working memory, work on some rows of a long table at a time, and the return of freed memory to the operating system.

ROWS_OF_A_PART = 1024   # cost: rows of some hundred cells: a megabyte of each array


def by_rows(function: Callable[[slice], np.ndarray], count: int, at_once: int = ROWS_OF_A_PART) -> np.ndarray:
    """What a function of a slice gives for `count` rows, (count, ...), computed some at a time, so that what it needs meanwhile stays small.

    The rows do not depend on each other.
    """
    head = function(slice(0, min(at_once, count)))
    if count <= at_once:
        return head
    whole = np.empty((count, *head.shape[1:]), head.dtype)
    whole[:at_once] = head
    for first in range(at_once, count, at_once):
        rows = slice(first, min(first + at_once, count))
        whole[rows] = function(rows)
    return whole


def trim_heap() -> None:
    """Return freed memory from the C library to the operating system.

    glibc keeps freed memory per thread, and the threads of the next stage allocate anew: after a few stages most of the memory of a process would be
    such remains. Nothing happens where the C library has no `malloc_trim` (Windows, macOS, musl).
    """
    if sys.platform.startswith("linux"):
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        if trim is not None:
            trim(0)


M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3   # source: glibc, malloc.h: parameters of glibc's mallopt
LARGEST_REUSED = 32 * 2**20                    # source: glibc: bytes of an array whose memory is used again; glibc takes no more on 64 bits


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

    def _array(self, count: int, name: str, dtype: DTypeLike = float) -> np.ndarray:
        nbytes = count * np.dtype(dtype).itemsize
        data = self._arrays.get(name)
        if data is None or len(data) < nbytes:
            data = self._arrays[name] = np.empty(nbytes + nbytes // 8, np.uint8)
        return data[:nbytes].view(dtype)


column_buffers = ScratchBuffers()   # for packing and unpacking columns of records


# Memory that the operating system lets a process have (`ulimit -v`), and what is left of it.
#
# A process with too little of it does not end with a MemoryError alone: shared libraries cannot be loaded, threads cannot start, and OpenBLAS up to
# 0.3.21 asks for its working memory again and again, for ever. So what cannot do without is asked for before the work begins.

MEGABYTE = 10**6   # derived: bytes
# source: MB of address space, measured with Debian 12, whose libraries are the largest: OpenCV and SciPy with what they load, a product of
# matrices that runs at the same time as others (OpenBLAS's BUFFER_SIZE), and a thread (8 of stack, 64 of heap)
LIBRARIES, PRODUCT, THREAD = 270, 135, 72
WITHOUT_QGIS = 400  # source: MB more of libraries where QGIS has not brought NumPy, BLAS and GDAL
BLAS_SIZE = 600  # cost: rows and columns: a product takes some 20 ms, so that those of all threads overlap
# What says in other words than a MemoryError that there was none: of the loaders of Linux, macOS and Windows, of threads, OpenCV, GDAL and GEOS
_WORDS = ("failed to map segment", "cannot allocate memory", "paging file is too small", "not enough memory", "insufficient memory", "out of memory",
          "bad_alloc", "can't start new thread")


def least_room() -> int:
    """MB that the work takes at least beside Python itself: libraries, and the threads of the work and one in the background."""
    return LIBRARIES + (0 if "qgis.core" in sys.modules else WITHOUT_QGIS) + _room_of_threads()


def _room_of_threads():
    return (_threads() + 1) * (PRODUCT + THREAD)


def _threads():
    return min(MAX_WORKERS, os.cpu_count() or 1)


def limited_memory() -> tuple[int, int] | None:
    """Address space of this process: (bytes it may have, bytes it has); None where there is no limit, or the system does not tell."""
    try:
        import resource

        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        if limit == resource.RLIM_INFINITY:
            return None
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
        return limit, pages * os.sysconf("SC_PAGE_SIZE")
    except (ImportError, AttributeError, OSError, ValueError):
        return None


def lack_of_memory() -> str:
    """One sentence where this process may not have the memory without which no work can begin; otherwise ""."""
    memory = limited_memory()
    if memory is None or memory[0] - memory[1] >= least_room() * MEGABYTE:
        return ""
    limit, used = (value // MEGABYTE for value in memory)
    return (f"Lanewright needs about {used + least_room()} MB of memory before it can begin, and this program may use {limit} MB. "
            "Start it where the limit is higher (ulimit -v).")


def claim_memory() -> None:
    """Where memory is limited, take what the work cannot do without, while it is there, or refuse: large libraries, working memory of OpenBLAS."""
    lacking = lack_of_memory()
    if lacking:
        raise RoadExtractionError(lacking)
    if limited_memory() is None:
        return
    for library in ("cv2", "scipy.linalg.blas"):
        import_module(library)
    limit, used = limited_memory() or (0, 0)
    if limit - used < _room_of_threads() * MEGABYTE:  # the libraries of this system are larger: OpenBLAS would wait for ever
        raise MemoryError
    _claim_for_products(_threads() + 1)


def _claim_for_products(threads):
    """Multiply matrices in several threads at once: OpenBLAS keeps its working memory for the next products.

    SciPy, whose copy may be its own, multiplies one pair after the other.
    """
    import numpy as np
    from scipy.linalg.blas import dgemm

    matrix, together = np.ones((BLAS_SIZE, BLAS_SIZE)), threading.Barrier(threads)

    def multiply():
        together.wait()
        np.dot(matrix, matrix)

    with ThreadPoolExecutor(threads) as pool:
        try:
            for _ in range(threads):
                pool.submit(multiply)
        except (RuntimeError, MemoryError) as error:  # no further thread
            together.abort()
            raise MemoryError(str(error)) from error
    dgemm(1.0, matrix, matrix)


def is_lack_of_memory(error: BaseException) -> bool:
    """Whether an error, or one that it was raised for, says that there was no memory, whatever its type."""
    return any(isinstance(cause, MemoryError) or (isinstance(cause, OSError) and cause.errno == errno.ENOMEM)
               or any(word in str(cause).lower() for word in _WORDS) for cause in _causes(error))


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    visited: set[int] = set()
    while error is not None and id(error) not in visited:
        visited.add(id(error))
        yield error
        error = error.__cause__ or error.__context__


def out_of_memory() -> str:
    """One sentence for work that ended for want of memory."""
    memory = limited_memory()
    if memory is None:
        return "Not enough memory for this step; close other programs or process fewer files at once."
    return (f"Not enough memory for this step: this program may use {memory[0] // MEGABYTE} MB. Start it where the limit is higher (ulimit -v) or "
            "process fewer files at once.")
