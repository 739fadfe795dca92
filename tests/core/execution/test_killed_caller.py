"""A caller that is killed in the middle of the work leaves nothing behind."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[2]
CALLER = """
import sys
sys.path[:0] = [{tests!r}, {tests!r} + "/streets"]
import conftest
from curbed_streets import street, survey_of
from lanewright.core.execution.tasks import find_interpreter
from lanewright.core.execution.processes import WorkerProcesses
from lanewright.core.road.detect_boundaries import BoundarySettings, find_curb_points

survey = survey_of(street())
survey.executor = WorkerProcesses(find_interpreter(), 1)
print(survey.executor.folder, flush=True)
while True:
    find_curb_points(survey, BoundarySettings("profiles"))
    print("curbs found", flush=True)
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="kill -9 is a way of Unix")
def test_a_killed_caller_leaves_nothing_behind():
    caller = subprocess.Popen([sys.executable, "-W", "ignore", "-c", CALLER.format(tests=str(TESTS))], stdout=subprocess.PIPE, text=True)
    folder = Path(caller.stdout.readline().strip())
    caller.stdout.readline()
    assert folder.is_dir()
    caller.kill()
    caller.wait()
    caller.stdout.close()
    until = time.monotonic() + 20.0
    while folder.exists() and time.monotonic() < until:
        time.sleep(0.1)
    # a worker removes it as the last thing it does
    assert not folder.exists()
