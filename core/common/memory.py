"""Arrays that a thread uses over and over: memory touched for the first time is dear, touched again it is cheap."""

import ctypes
import sys
import threading
from functools import partial

import numpy as np

# Memory that was freed and is kept all the same, handed back to the system.

def trim_heap():
    """Ask the C library for what it keeps of memory that was freed.

    glibc keeps it for the threads that had asked for it, and the threads of the
    next stage ask anew: after a few stages most of a process is such leftovers.
    Nothing happens where the C library knows no such request (Windows, macOS, musl).
    """
    if sys.platform.startswith("linux"):
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        if trim is not None:
            trim(0)

class ScratchBuffers(threading.local):
    """Working arrays by name, of every thread its own; what they held is not remembered from one use to the next."""

    def __init__(self):
        self._arrays = {}

    def of(self, count):
        """A function of a name, and of a dtype where it is not float64, that returns the array of `count` values."""
        return partial(self._array, count)

    def _array(self, count, name, dtype=np.float64):
        nbytes = count * np.dtype(dtype).itemsize
        data = self._arrays.get(name)
        if data is None or len(data) < nbytes:
            data = self._arrays[name] = np.empty(nbytes + nbytes // 8, np.uint8)
        return data[:nbytes].view(dtype)


column_buffers = ScratchBuffers()   # those in which columns are put down and picked up again
