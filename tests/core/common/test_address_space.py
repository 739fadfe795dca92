"""Work where the operating system gives little memory (`ulimit -v`) ends with one sentence, or begins with what it cannot do without."""

import subprocess
import sys
from pathlib import Path

import pytest
from lanewright.core.common import parallel as address_space
from lanewright.core.common.parallel import is_lack_of_memory, lack_of_memory, least_room, limited_memory

resource = pytest.importorskip("resource")

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = """
import resource, sys
sys.path.insert(0, {tools!r})
from plugin_package import load
load()
from lanewright.core.common.parallel import MEGABYTE, claim_memory, least_room, limited_memory
resource.setrlimit(resource.RLIMIT_AS, (2**40, 2**40))
limit = limited_memory()[1] + (least_room() + {more}) * MEGABYTE
resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
claim_memory()
print("began")
"""


def begun(more):
    """What a program says that may use so many MB more than are needed to begin."""
    return subprocess.run([sys.executable, "-c", PROGRAM.format(tools=str(ROOT / "tools"), more=more)], capture_output=True, text=True, timeout=120)


@pytest.mark.parametrize("more", [-20, -300])
def test_work_does_not_begin_where_the_libraries_and_threads_cannot_have_their_memory(more):
    run = begun(more)
    assert run.returncode and "before it can begin, and this program may use" in run.stderr.splitlines()[-1], run.stderr


def test_work_begins_where_they_can_and_does_not_wait_for_memory_for_ever():
    run = begun(30)
    assert run.stdout == "began\n", run.stderr


def test_nothing_is_asked_where_there_is_no_limit(monkeypatch):
    monkeypatch.setattr(address_space, "limited_memory", lambda: None)
    assert lack_of_memory() == ""
    monkeypatch.setattr(address_space, "limited_memory", lambda: (10**9, 10**9 - 10**8))
    assert f"needs about {900 + least_room()} MB" in lack_of_memory() and "may use 1000 MB" in lack_of_memory()


def test_the_limit_of_this_process_is_read():
    memory = limited_memory()
    assert (memory is None) == (resource.getrlimit(resource.RLIMIT_AS)[0] == resource.RLIM_INFINITY)


def raised_for(error, cause):
    error.__cause__ = cause
    return error


@pytest.mark.parametrize("error", [
    MemoryError(), ImportError("libopencv_mcc.so.406: failed to map segment from shared object"), RuntimeError("can't start new thread"),
    OSError(12, "Cannot allocate memory"), ImportError("DLL load failed: The paging file is too small for this operation to complete."),
    RuntimeError("std::bad_alloc"), raised_for(ValueError("no rows"), MemoryError()),
])
def test_lack_of_memory_is_known_in_whatever_words_it_is_told(error):
    assert is_lack_of_memory(error)


@pytest.mark.parametrize("error", [ImportError("No module named 'cv2'"), OSError(28, "No space left on device"), ValueError("memory of a goldfish")])
def test_other_faults_are_not_taken_for_lack_of_memory(error):
    assert not is_lack_of_memory(error)
