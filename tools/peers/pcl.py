"""PCL's statistical outlier removal and conditional Euclidean clustering, to compare ours with.

Two small C++ programs are built against Debian's PCL into build/peers and run in processes of
their own; they print the CPU seconds of PCL's own work, reading and writing left out.
Nothing of the plugin needs them.
"""

import json
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

SOURCES = Path(__file__).resolve().parent
BUILD = SOURCES.parents[1] / "build" / "peers"
UNPACKED = BUILD / "debian"     # what unpack_pcl.sh leaves
LIBRARIES = dict(sor=("pcl_filters", "pcl_search", "pcl_kdtree", "pcl_octree", "pcl_common", "flann_cpp", "lz4"),
                 clustering=("pcl_search", "pcl_kdtree", "pcl_octree", "pcl_common", "flann_cpp", "lz4"))


class PeerMissing(Exception):
    """What there is no PCL to compare with for, in one sentence."""


def outliers(places, neighbours, std_ratio, intensity=0.0):
    """Which points PCL's StatisticalOutlierRemoval keeps.

    Parameters
    ----------
    places : (N, 3) metres, small numbers: they travel as float32

    Returns
    -------
    kept : (N,) bool
    cpu_seconds : of PCL's filter alone

    Raises
    ------
    PeerMissing
        Without PCL or a compiler.
    """
    kept, said = _run("sor", places, intensity, np.uint8, neighbours, std_ratio)
    return kept.astype(bool), said["cpu_seconds"]


def clusters(places, distance, stretch=1.0, squeeze=1.0, intensity=0.0):
    """Cluster of each point by PCL's ConditionalEuclideanClustering.

    Parameters
    ----------
    places : (N, 3) metres, x along the road and y across it
    distance, stretch, squeeze : points belong together where (dx / stretch)^2 + (dy * squeeze)^2 <= distance^2

    Returns
    -------
    labels : (N,) int32
    cpu_seconds : of PCL's clustering alone

    Raises
    ------
    PeerMissing
        Without PCL or a compiler.
    """
    labels, said = _run("clustering", places, intensity, np.int32, distance, stretch, squeeze)
    return labels, said["cpu_seconds"]


def build(name):
    """The path of the program sor or clustering, built if its source is newer.

    Raises
    ------
    PeerMissing
        Without PCL or a compiler.
    """
    source, program = SOURCES / f"{name}.cpp", BUILD / name
    newest = max(path.stat().st_mtime for path in (source, SOURCES / "points_file.h"))
    if program.exists() and program.stat().st_mtime > newest:
        return program
    compiler = shutil.which("g++")
    if not compiler:
        raise PeerMissing("There is no C++ compiler here to compare with PCL: apt-get install g++ libpcl-dev.")
    options = _options(LIBRARIES[name])
    BUILD.mkdir(parents=True, exist_ok=True)
    made = subprocess.run([compiler, "-O3", "-DNDEBUG", "-w", "-o", program, source, *options], stderr=subprocess.PIPE, text=True)
    if made.returncode:
        raise PeerMissing(f"{source.name} could not be built: {made.stderr.strip().splitlines()[0]}")
    return program


def _options(libraries):
    """What the compiler needs to be told of PCL, installed or unpacked."""
    # not asked of pkg-config, which wants what PCL's own dependencies are built with, too
    for root in (UNPACKED, Path("/")):
        headers = sorted(root.glob("usr/include/pcl-*"))
        if headers:
            shared = next(root.glob("usr/lib/*/libpcl_common.so")).parent
            include = [f"-I{path}" for path in (headers[-1], root / "usr/include/eigen3", root / "usr/include")]
            return [*include, f"-L{shared}", f"-Wl,--disable-new-dtags,-rpath,{shared}", *(f"-l{library}" for library in libraries)]
    raise PeerMissing("PCL is not installed, so there is nothing to compare with: apt-get install libpcl-dev, or run "
                      "tools/peers/unpack_pcl.sh where apt cannot install it beside QGIS.")


def _run(name, places, intensity, kind, *words):
    program = build(name)
    rows = np.empty((len(places), 4), np.float32)
    rows[:, :3], rows[:, 3] = places, intensity
    with tempfile.TemporaryDirectory() as folder:
        taken, given = Path(folder) / "points", Path(folder) / "result"
        rows.tofile(taken)
        ran = subprocess.run([program, taken, given, *map(str, words)], capture_output=True, text=True)
        if ran.returncode:
            raise PeerMissing(f"PCL's {name} did not run: {ran.stderr.strip()}")
        return np.fromfile(given, kind), json.loads(ran.stdout)
