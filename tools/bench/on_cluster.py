"""The whole chain on a Dask cluster of this computer: a scheduler and workers of one thread, as a user would start them."""

import json
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

from . import ROOT, chain
from .theirs import PeerMissing

PYTHON = ROOT / "build" / "cluster" / "venv" / "bin" / "python"
START_TIME = 60.0   # s that a scheduler may take
MEMORY = "3GB"      # of a worker


def install(say=print):
    """Make the environment of tools/cluster_environment.sh; where it cannot be made, say so, and these figures are left out."""
    done = subprocess.run([str(ROOT / "tools" / "cluster_environment.sh")], check=False)
    if done.returncode:
        say("dask.distributed could not be installed into build/cluster, so runs on a cluster are left out.")


def run(survey, size, workers):
    """Figures of the chain on a survey, boundaries by profiles, the phases done by so many workers; CPU seconds are the caller's alone."""
    if not PYTHON.exists():
        raise PeerMissing("dask.distributed is not installed in build/cluster.")
    with _cluster(workers) as address:
        return chain.run(survey, size, scheduler=address)


@contextmanager
def _cluster(workers):
    """The address of a scheduler with so many workers, on loopback."""
    with tempfile.TemporaryDirectory(prefix="bench-") as folder, (Path(folder) / "log").open("wb") as log:
        programs = []

        def start(name, *arguments):
            command = [sys.executable, "-W", "ignore", "-m", f"distributed.cli.{name}", "--no-dashboard", *arguments]
            programs.append(subprocess.Popen(command, stdout=log, stderr=log))

        try:
            start("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", f"{folder}/scheduler.json")
            address = _address(Path(folder) / "scheduler.json")
            for k in range(workers):
                start("dask_worker", address, "--nthreads", "1", "--nworkers", "1", "--memory-limit", MEMORY, "--local-directory", f"{folder}/{k}")
            _await_workers(address, workers)
            yield address
        finally:
            for program in reversed(programs):
                program.terminate()
            for program in programs:
                program.wait()


def _address(path):
    """What the scheduler writes to its file, as soon as that is whole."""
    until = time.monotonic() + START_TIME
    while time.monotonic() < until:
        try:
            return json.loads(path.read_text())["address"]
        except (OSError, ValueError):
            time.sleep(0.1)
    raise PeerMissing("The scheduler did not start.")


def _await_workers(address, count):
    from distributed import Client

    with Client(address) as client:
        client.wait_for_workers(count, timeout=START_TIME)
