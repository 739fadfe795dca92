"""What a stage has freed does not stay with the process; what is freed within a task is used again."""

import ctypes
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from lanewright.core.common.parallel import by_rows, trim_heap

BLOCK, BLOCKS = 100_000, 1000  # bytes; small blocks are kept by the C library, large ones are not


def resident():
    """Bytes of the process in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


GLIBC = pytest.mark.skipif(not sys.platform.startswith("linux") or not hasattr(ctypes.CDLL(None), "gnu_get_libc_version"), reason="no glibc")
TOOLS = Path(__file__).resolve().parents[3] / "tools"
# prints the pages fetched while 2 MB are taken and freed 20 times, before and after the call
FETCHES = """
import resource, sys
import numpy as np
sys.path.insert(0, sys.argv[1])
from plugin_package import load
load()
from lanewright.core.common.parallel import reuse_freed_memory
def fetched():
    np.ones(250_000)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(20):
        np.ones(250_000)
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before
before = fetched()
reuse_freed_memory()
print(before, fetched())
"""


@GLIBC
def test_freed_memory_is_used_again_where_dask_would_give_it_back_at_once():
    environment = dict(os.environ, MALLOC_TRIM_THRESHOLD_="65536")
    done = subprocess.run([sys.executable, "-c", FETCHES, str(TOOLS)], env=environment, capture_output=True, text=True, check=True)
    before, after = map(int, done.stdout.split())
    assert before > 20 * 400 and after < 400


@GLIBC
def test_what_threads_freed_goes_back_to_the_system():
    with ThreadPoolExecutor(1) as pool:
        blocks = pool.submit(lambda: [np.ones(BLOCK, np.uint8) for _ in range(BLOCKS)]).result()
        full = resident()
        del blocks[:-1]  # the last one stands in the way of what the C library hands back unasked
        trim_heap()
        assert full - resident() > 0.8 * BLOCK * BLOCKS
        assert blocks[0].all()


@pytest.mark.parametrize("count", [0, 1, 9, 10, 11, 37])
def test_rows_worked_on_some_at_a_time_give_what_all_of_them_give(count):
    table, seen = np.arange(3.0 * count).reshape(count, 3), []

    def work(some):
        seen.append(len(table[some]))
        return table[some] ** 2

    np.testing.assert_array_equal(by_rows(work, count, 10), table**2)
    assert max(seen) <= 10 and sum(seen) == count
