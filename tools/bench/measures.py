"""Everything that is measured, by name, and one measurement in a process of its own."""

import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

from . import cancel, chain, on_cluster, ours, theirs
from .prepare import prepare

MEASURES = {
    "prepare": prepare, "cancel": cancel.cancel,
    "read": ours.read, "read_long": lambda size: ours.read(size, "long"),
    "placing": ours.placing, "storing": ours.storing,
    "profiles": lambda size: chain.run("dense", size),
    "las": lambda size: chain.run("dense", size, suffix="las"),
    "both": lambda size: chain.run("dense", size, "both"),
    "scanlines": ours.scanlines,
    "alone_both": lambda size: chain.run("dense", size, "both"),
    "workers": lambda size: chain.run("dense", size, "both", workers=len(os.sched_getaffinity(0))),
    "alone_workers": lambda size: chain.run("dense", size, "both", workers=1),
    "side_by_side": lambda size: side_by_side("alone_both", size),
    "tiles_workers": lambda size: chain.run("long", size, workers=len(os.sched_getaffinity(0))),
    "far": lambda size: chain.run("far", size, workers=len(os.sched_getaffinity(0))),
    "dask_one": lambda size: on_cluster.run("long", size, 1),
    "dask_all": lambda size: on_cluster.run("long", size, len(os.sched_getaffinity(0))),
    "short": lambda size: chain.run("short", size),
    "tiles": lambda size: chain.run("long", size),
    "image_ours": ours.image_ours, "image_gdal": theirs.image_gdal,
    "sor_ours": ours.sor_ours, "sor_pcl": theirs.sor_pcl, "sor_open3d": theirs.sor_open3d,
    "clusters_ours": ours.clusters_ours, "clusters_pcl": theirs.clusters_pcl, "clusters_open3d": theirs.clusters_open3d,
}
ONE_CORE = ("sor_", "clusters_", "alone_")   # PCL has no more, so nobody gets more; and what one core takes for the whole
PARTS = dict(stages=("read", "placing", "storing", "profiles", "las", "both", "scanlines"), memory=("profiles", "short", "tiles", "read_long"),
             cores=("both", "alone_both", "side_by_side", "workers", "alone_workers", "tiles_workers"), cluster=("read_long", "dask_one", "dask_all"),
             image=("image_ours", "image_gdal"), outliers=("sor_ours", "sor_pcl", "sor_open3d"),
             clusters=("clusters_ours", "clusters_pcl", "clusters_open3d"), far=("tiles_workers", "far"), cancel=("cancel",))
LATER = ("far", "cancel")  # each takes longer than all the others together, so they run where they are asked for


def measure(name, size, cores):
    """Figures of one measurement, taken in a process of its own on `cores` processor cores."""
    threads = 1 if name.startswith(ONE_CORE) else cores
    load, began, before = os.getloadavg()[0], time.perf_counter(), _busy_seconds()
    figures = _figures(name, _child(name, size, threads))
    took, after = time.perf_counter() - began, _busy_seconds()
    # what the machine worked beyond what the child and its children did
    others = max(after[0] - before[0] - (after[1] - before[1]), 0.0) / took
    return dict(figures, load=load, took=took, others=others, cores=threads)


def side_by_side(name, size):
    """Means of a measurement taken on every core at once, each in a process of its own that stays on its core."""
    cores = sorted(os.sched_getaffinity(0))
    children = [_child(name, size, 1, core) for core in cores]
    found = [_figures(name, child) for child in children]
    return {key: sum(figures[key] for figures in found) / len(found) for key in ("wall", "cpu", "peak")}


def _child(name, size, threads, core=None):
    """A process that takes one measurement on so many cores, or on this one."""
    environment = dict(os.environ, **{key: str(threads) for key in ("RAYON_NUM_THREADS", "GDAL_NUM_THREADS")})
    # our own arrays are worked on by threads of ours, so numpy's stay at the one that the plugin gives them
    environment["OMP_NUM_THREADS"] = str(threads if name.endswith("open3d") else 1)
    # what runs on a cluster needs dask.distributed, which has an environment of its own
    python = str(on_cluster.PYTHON) if name.startswith("dask_") and on_cluster.PYTHON.exists() else sys.executable
    return subprocess.Popen([python, "-m", "bench", "--child", name, "--size", size, "--cores", str(threads)], env=environment,
                            stdout=subprocess.PIPE, text=True, preexec_fn=None if core is None else lambda: os.sched_setaffinity(0, {core}))


def _figures(name, child):
    """What a process of `_child` measured."""
    said, _ = child.communicate()
    if child.returncode:
        raise SystemExit(f"{name} could not be measured; the lines above say why.")
    return json.loads(said.strip().splitlines()[-1])


def _busy_seconds():
    """(CPU seconds of the whole machine, those of our own finished children); the first 0 where it is not told."""
    own = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        first = Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:]
    except OSError:
        return 0.0, 0.0
    user, nice, system, _, _, irq, soft, steal, *_ = map(int, first)
    return (user + nice + system + irq + soft + steal) / os.sysconf("SC_CLK_TCK"), own.ru_utime + own.ru_stime


def in_this_process(name, size, cores):
    """Measure, and print the figures as one line of JSON."""
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:cores])
    try:
        figures = MEASURES[name](size)
    except theirs.PeerMissing as why:
        figures = dict(missing=str(why))
    figures = figures or {}
    print(json.dumps({**figures, "peak": figures.get("peak", ours.peak_mib())}))
