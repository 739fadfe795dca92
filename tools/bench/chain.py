"""The whole chain, with what its user sees of the time: how the bar moves and how long Cancel is not heard."""

import os
import re
import resource
import threading
import time
from contextlib import contextmanager
from pathlib import Path

from lanewright.core.common.parallel import cancellation_scope
from lanewright.core.common.progress import Progress
from lanewright.core.execution.choice import ExecutionSettings
from lanewright.core.pipeline.road_map import RoadMapSettings, make_road_map
from lanewright.core.survey.trajectory.reader import read_trajectory

from .ours import peak_mib, timed
from .prepare import prepared
from .surveys import clouds_of, trajectory_of

SAMPLING = 0.1   # s between two looks at the memory of worker processes


class Watch(Progress):
    """Notes when it is asked, since every such moment may end the work, and what is being done."""

    def __init__(self):
        self.began = time.perf_counter()
        self.moments = [(0.0, 0.0, "")]  # seconds, fraction, the last line of the log

    def report(self, fraction):
        self.moments.append((time.perf_counter() - self.began, fraction, self.moments[-1][2]))

    def check_cancelled(self):
        self.report(self.moments[-1][1])

    def info(self, text):
        """Notes how a line of the log begins: what follows are figures, and places on this computer."""
        self.moments.append((*self.moments[-1][:2], re.split("[:,]", text)[0]))

    def figures(self):
        """How far the bar lay from the truth at worst (of 1), and the longest time without a question: seconds, where."""
        end = self.moments[-1][0]
        off = max(abs(fraction - seconds / end) for seconds, fraction, _ in self.moments)
        gaps = [(b[0] - a[0], a[2]) for a, b in zip(self.moments, self.moments[1:])]
        return dict(bar_off=off, silence=max(gaps))


def run(survey, size, method="profiles", suffix="laz", workers=0, scheduler=""):
    """Figures of the chain on a survey; `seconds` of every stage. Memory is that of all processes at one moment."""
    target = prepared(f"chain_{survey}_{os.getpid()}.tif", size)   # runs side by side write their own
    target.parent.mkdir(parents=True, exist_ok=True)
    watch = Watch()
    settings = RoadMapSettings(boundary_method=method, execution=ExecutionSettings(workers=workers, scheduler=scheduler))
    clouds = clouds_of(survey, size, suffix)
    with cancellation_scope(watch), memory_together() as together:
        road_map, seconds = timed(lambda: make_road_map(clouds, read_trajectory(trajectory_of(survey, size)), target, settings, watch))
    Path(target).unlink()
    found = {name: len(getattr(road_map, name) or ()) for name in ("edges", "markings", "marking_lines", "driving_lines")}
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds["cpu"] += ended.ru_utime + ended.ru_stime
    peak = max(*together, peak_mib())
    return dict(seconds, seconds=road_map.seconds, points=road_map.survey_facts["read"], road_points=len(road_map.road_points),
                length=sum(road.length for road in road_map.frame.roads), peak=peak, found=found, **watch.figures())


@contextmanager
def memory_together():
    """A list to which the memory (MiB) of this process and all its children is added again and again.

    Pages of files, which are those of the libraries that all of them have loaded, count once, as many as the process with the most has.
    """
    seen, done = [0.0], threading.Event()

    def look():
        while not done.wait(SAMPLING):
            own, of_files = zip(*map(_resident_mib, ["self", *_children()]))
            seen.append(sum(own) + max(of_files))

    thread = threading.Thread(target=look, daemon=True)
    thread.start()
    try:
        yield seen
    finally:
        done.set()
        thread.join()


def _children():
    """Numbers of the child processes."""
    tasks = Path("/proc/self/task")
    return [number for task in tasks.iterdir() for number in _text(task / "children").split()] if tasks.exists() else []


def _resident_mib(process):
    """MiB of a process that are in memory: its own, and pages of files; 0 and 0 if it has ended."""
    fields = _text(Path("/proc") / process / "statm").split()
    resident, of_files = (int(field) * os.sysconf("SC_PAGE_SIZE") / 2**20 for field in fields[1:3]) if fields else (0.0, 0.0)
    return resident - of_files, of_files


def _text(path):
    try:
        return path.read_text()
    except OSError:
        return ""
