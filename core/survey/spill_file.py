"""A temporary file in which arrays are put down and picked up again, by several threads at once."""

import os
import tempfile
import threading

import numpy as np


class SpillFile:
    """Bytes at places of a file without a name (on Windows it is deleted when it is closed): a killed run leaves nothing."""

    def __init__(self):
        self._file = tempfile.TemporaryFile(prefix="lanewright-", buffering=0)
        self._lock = threading.Lock()
        self.end = 0

    def append(self, array):
        """Put an array down behind all others."""
        self.write(self.end, array)
        self.end += array.nbytes

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
