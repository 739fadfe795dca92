"""Memory that the operating system lets a process have (`ulimit -v`), and what is left of it.

A process with too little of it does not end with a MemoryError alone: shared libraries cannot be loaded, threads cannot start, and OpenBLAS up to
0.3.21 asks for its working memory again and again, for ever. So what cannot do without is asked for before the work begins.
"""

from __future__ import annotations

import errno
import os
import sys
import threading
from collections.abc import Iterator
from contextlib import suppress
from importlib import import_module
from pathlib import Path

from ..common.errors import RoadExtractionError
from ..common.parallel import MAX_WORKERS

MEGABYTE = 10**6
# MB of address space, measured with Debian 12, whose libraries are the largest: OpenCV and SciPy with what they load, a product of matrices that runs
# at the same time as others (OpenBLAS's BUFFER_SIZE), and a thread (8 of stack, 64 of heap)
LIBRARIES, PRODUCT, THREAD = 270, 135, 72
WITHOUT_QGIS = 400  # MB more of libraries where QGIS has not brought NumPy, BLAS and GDAL
BLAS_SIZE = 600  # rows and columns: a product takes some 20 ms, so that those of all threads overlap
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
    return (f"Lanewright needs about {used + least_room()} MB of memory before it can begin, and this program may use {limit} MB: "
            "start it where the limit is higher (ulimit -v) or where there is none.")


def claim_memory() -> None:
    """Where memory is limited, take what the work cannot do without, while it is there: large libraries, and working memory of OpenBLAS.

    Raises
    ------
    RoadExtractionError
        If that is more than this process may have.
    """
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
        with suppress(threading.BrokenBarrierError):
            together.wait()
            np.dot(matrix, matrix)

    started = []
    try:
        for _ in range(threads):
            started.append(threading.Thread(target=multiply, daemon=True))
            started[-1].start()
    except RuntimeError as error:
        raise MemoryError(str(error)) from error
    finally:
        if len(started) < threads or not all(thread.ident for thread in started):
            together.abort()
        for thread in started:
            if thread.ident:
                thread.join()
    dgemm(1.0, matrix, matrix)


def is_lack_of_memory(error: BaseException) -> bool:
    """Whether an error, or one that it was raised for, says that there was no memory, whatever its type."""
    return any(isinstance(cause, MemoryError) or (isinstance(cause, OSError) and cause.errno == errno.ENOMEM)
               or any(word in str(cause).lower() for word in _WORDS) for cause in _causes(error))


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    seen: set[int] = set()
    while error is not None and id(error) not in seen:
        seen.add(id(error))
        yield error
        error = error.__cause__ or error.__context__


def out_of_memory() -> str:
    """One sentence for work that ended for want of memory."""
    memory = limited_memory()
    if memory is None:
        return "Not enough memory for this step; close other programs or process fewer files at once."
    return (f"Not enough memory for this step: this program may use {memory[0] // MEGABYTE} MB. Start it where the limit is higher (ulimit -v) or "
            "process fewer files at once.")
