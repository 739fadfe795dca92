"""Arrays that a thread uses over and over: memory touched for the first time is dear, touched again it is cheap."""

import threading
from functools import partial

import numpy as np


class KeptArrays(threading.local):
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


columns_kept = KeptArrays()   # those in which columns are put down and picked up again
