"""A real Dask cluster on this computer: a scheduler and two workers, each a process of its own."""

import json
import os
import signal
import subprocess
import sys
import time
from importlib.util import find_spec

import pytest

# `make test-cluster` installs it
if find_spec("distributed") is None:
    collect_ignore_glob = ["*"]

COMMAND = [sys.executable, "-W", "ignore", "-m"]
START_TIME = 60.0   # s


class RunningCluster:
    """A scheduler and workers with nannies, which restart workers that end.

    folder : for their logs and files
    workers : how many
    security : options of the commands for certificates
    scheme, memory, failures : tcp or tls; memory limit of a worker; the scheduler's allowed failures
    environment : further variables
    before : is called in each worker's process before it starts
    """

    def __init__(self, folder, workers=2, security=(), scheme="tcp", memory="2GB", failures=1, environment=None, before=None):
        self.folder, self.scheme = folder, scheme
        self.environment = {**os.environ, "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": str(failures), "OMP_NUM_THREADS": "1",
                            "DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "False", **(environment or {})}
        self.programs, self.security, self.before = [], list(security), None
        self.scheduler = self.start("dask_scheduler", "--host", f"{scheme}://127.0.0.1", "--port", "0", "--no-dashboard",
                                    "--scheduler-file", str(folder / "scheduler.json"))
        self.wait_for(lambda: address_in(folder / "scheduler.json"))
        self.address = address_in(folder / "scheduler.json")
        self.before = before
        for k in range(workers):
            self.start("dask_worker", self.address, "--nthreads", "1", "--nworkers", "1", "--memory-limit", memory, "--no-dashboard",
                       "--local-directory", str(folder / f"worker{k}"), "--death-timeout", "30")

    def start(self, name, *arguments):
        log = open(self.folder / f"{name}{len(self.programs)}.log", "w")
        program = subprocess.Popen([*COMMAND, f"distributed.cli.{name}", *arguments, *self.security], stdout=log, stderr=log, env=self.environment,
                                   start_new_session=True, preexec_fn=self.before)
        log.close()
        self.programs.append(program)
        return program

    def wait_for(self, condition):
        until = time.monotonic() + START_TIME
        while not condition():
            assert time.monotonic() < until, [log.read_text()[-2000:] for log in self.folder.glob("*.log")]
            time.sleep(0.1)

    def workers(self):
        """Process ids of the workers themselves, not of their nannies."""
        found = []
        for nanny in self.programs[1:]:
            listed = subprocess.run(["ps", "--ppid", str(nanny.pid), "-o", "pid=,args="], capture_output=True, text=True).stdout
            found += [int(line.split()[0]) for line in listed.splitlines() if "spawn_main" in line]
        return found

    def kill_a_worker(self):
        os.kill(self.workers()[0], signal.SIGKILL)

    def close(self):
        for program in reversed(self.programs):
            if program.poll() is None:
                os.killpg(program.pid, signal.SIGTERM)
        for program in self.programs:
            try:
                program.wait(10)
            except subprocess.TimeoutExpired:
                os.killpg(program.pid, signal.SIGKILL)
                program.wait()


def address_in(path):
    """The address in a scheduler's file; "" before it is there and whole."""
    try:
        return json.loads(path.read_text())["address"]
    except (OSError, ValueError):
        return ""


@pytest.fixture(scope="session")
def cluster(tmp_path_factory):
    running = RunningCluster(tmp_path_factory.mktemp("cluster"))
    yield running
    running.close()


@pytest.fixture(params=[1, 2])
def sections_together(request, monkeypatch):
    """So many sections in a task; of themselves short streets have one in each."""
    monkeypatch.setattr("lanewright.core.execution.folder_executor.items_together", lambda *_: request.param)


@pytest.fixture
def new_cluster(tmp_path):
    """Starts clusters of a test's own."""
    started = []

    def start(**options):
        folder = tmp_path / f"cluster{len(started)}"
        folder.mkdir()
        started.append(RunningCluster(folder, **options))
        return started[-1]
    yield start
    for running in started:
        running.close()
