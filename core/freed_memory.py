"""Memory that was freed and is kept all the same, handed back to the system."""

import ctypes
import sys


def hand_back():
    """Ask the C library for what it keeps of memory that was freed.

    glibc keeps it for the threads that had asked for it, and the threads of the
    next stage ask anew: after a few stages most of a process is such leftovers.
    Nothing happens where the C library knows no such request (Windows, macOS, musl).
    """
    if sys.platform.startswith("linux"):
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        if trim is not None:
            trim(0)
