"""Open3D's statistical outlier removal and clustering, to compare ours with.

Open3D comes from PyPI into build/peers/venv, since it wants a numpy of its own.
Nothing of the plugin needs it.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from .pcl import PeerMissing

HERE = Path(__file__).resolve().parent
VENV = HERE.parents[1] / "build" / "peers" / "venv"
PYTHON = VENV / "bin" / "python"
WHEELS = ("open3d-cpu", "open3d")   # the first is the smaller, and is not made for every processor


def install():
    """Open3D into build/peers/venv, unless it is there.

    Raises
    ------
    PeerMissing
        If PyPI has none for this Python, or cannot be reached.
    """
    if _works():
        return
    subprocess.run([sys.executable, "-m", "venv", "--clear", VENV], check=True)
    for wheel in WHEELS:
        made = subprocess.run([PYTHON, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--only-binary", ":all:", wheel],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if made.returncode == 0 and _works():
            return
    why = next((line for line in made.stderr.splitlines() if line.startswith("ERROR")), "it was installed and does not start")
    raise PeerMissing(f"Open3D could not be installed for Python {sys.version_info.major}.{sys.version_info.minor}: {why}.")


def _works():
    return PYTHON.exists() and subprocess.run([PYTHON, "-c", "import open3d"], capture_output=True).returncode == 0


def outliers(places, neighbours, std_ratio):
    """(N,) bool of the points that Open3D keeps, and its wall and CPU seconds; places (N, 3) metres."""
    return _run("outliers", places, neighbours, std_ratio)


def clusters(places, distance):
    """(N,) int cluster of each point by DBSCAN with one point enough (plain Euclidean clustering), and the seconds."""
    return _run("clusters", places, distance)


def _run(task, places, *words):
    if not PYTHON.exists():
        raise PeerMissing("Open3D is not installed; make bench installs it into build/peers/venv.")
    with tempfile.TemporaryDirectory() as folder:
        taken, given = Path(folder) / "points.npy", Path(folder) / "found.npy"
        np.save(taken, places)
        said = subprocess.run([PYTHON, HERE / "open3d_work.py", task, taken, given, *map(str, words)], check=True,
                              stdout=subprocess.PIPE, text=True).stdout
        return np.load(given), json.loads(said.strip().splitlines()[-1])
