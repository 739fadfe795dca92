"""What a stage has freed does not stay with the process."""

import ctypes
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from lanewright.core.common.memory import trim_heap

BLOCK, BLOCKS = 100_000, 1000  # bytes; small blocks are kept by the C library, large ones are not


def resident():
    """Bytes of the process in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


@pytest.mark.skipif(not sys.platform.startswith("linux") or not hasattr(ctypes.CDLL(None), "malloc_trim"), reason="no glibc")
def test_what_threads_freed_goes_back_to_the_system():
    with ThreadPoolExecutor(1) as pool:
        blocks = pool.submit(lambda: [np.ones(BLOCK, np.uint8) for _ in range(BLOCKS)]).result()
        full = resident()
        del blocks[:-1]  # the last one stands in the way of what the C library hands back unasked
        trim_heap()
        assert full - resident() > 0.8 * BLOCK * BLOCKS
        assert blocks[0].all()
