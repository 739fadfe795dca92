"""The stages of a chain, run one after the other: each with its share of the bar, and its time taken."""

import time
from dataclasses import dataclass

import numpy as np

from ..common.memory import trim_heap
from ..io.crs import check_projected
from ..survey.frame.road_frame import CORRIDOR
from ..survey.las.reader import read_headers
from ..survey.trajectory.reprojection import reproject_trajectory

# How long each stage takes, in proportions, by points and by length of road: of a million points, of a kilometre (`make bench`).
# What is read packed is decoded; boundaries by both methods take what either does.
STAGE_COSTS = dict(survey=(0.31, 0.1), profiles=(0.105, 4.6), scanlines=(0.2, 8.0), edges=(0.0, 0.04), surface=(0.05, 1.5), intensity=(0.037, 0.7),
             image=(0.047, 1.1), markings=(0.017, 2.4), outliers=(0.018, 0.26), clusters=(0.019, 1.1), lines=(0.007, 0.6), driving=(0.005, 0.85))
MIN_STAGE_COST = 0.01                # the same, of a stage that has nothing to do
LAZ_READ_COST, LAS_READ_COST = 1.0, 0.42  # of what the stage of the survey takes for a point of a LAZ and of a LAS file


@dataclass(frozen=True)
class Extent:
    """How much there is to work on: millions of points and kilometres of road, as far as is known."""

    points: float
    length: float
    plain: float = 0.0  # share of the points that lie in files that are not compressed

    @classmethod
    def expected(cls, paths, trajectory, crs=""):
        """What headers and trajectory tell before anything is read; refuses what `open_survey` would refuse of them."""
        files = read_headers(paths)
        trajectory = reproject_trajectory(trajectory, check_projected(files, crs, trajectory.crs))
        held = [file for file in files if file.count]
        points = sum(file.count for file in held)
        places = np.column_stack([trajectory.x, trajectory.y])
        low, high = (np.array([getattr(file, name)[:2] for file in held]).reshape(-1, 2) for name in ("minimum", "maximum"))
        within = ((places > low.min(axis=0, initial=np.inf) - CORRIDOR) & (places < high.max(axis=0, initial=-np.inf) + CORRIDOR)).all(axis=1)
        driven = np.hypot(*np.diff(places, axis=0).T)[within[1:]].sum()
        return cls(points / 1e6, float(driven) / 1e3, sum(file.count for file in held if file.chunk == 1) / max(points, 1))

    def cost(self, name, method):
        """How long a stage takes, in proportion to others."""
        if name == "curbs":
            return sum(self.cost(one, method) for one in ("profiles", "scanlines") if method in (one, "both"))
        of_points, of_length = STAGE_COSTS[name]
        if name == "survey":
            of_points *= LAZ_READ_COST + self.plain * (LAS_READ_COST - LAZ_READ_COST)
        return MIN_STAGE_COST + of_points * self.points + of_length * self.length


INTENSITY_STAGES = ("intensity", "image", "markings", "outliers", "clusters", "lines", "driving")   # stages that look at intensity
STAGE_NAMES = ("survey", "curbs", "edges", "surface", *INTENSITY_STAGES)


class Stages:
    """Runs the stages of a road map one after the other; `seconds` of each are noted.

    Parameters
    ----------
    extent : Extent
    method : that boundaries are found by
    left_out : names of stages that will not be run
    """

    def __init__(self, progress, extent, method, left_out=()):
        self.progress, self.done, self.seconds, self.method = progress, 0.0, {}, method
        self.waiting = list(STAGE_NAMES)
        self.know(extent, left_out)

    def know(self, extent, left_out=()):
        """Divide what is left of the bar among the stages that are left, now that more is known; some will not be run."""
        self.waiting = [name for name in self.waiting if name not in left_out]
        costs = {name: extent.cost(name, self.method) for name in self.waiting}
        self.shares = {name: (1.0 - self.done) * cost / max(sum(costs.values()), 1e-9) for name, cost in costs.items()}

    def run(self, name, title, function, *arguments, **options):
        share = self.shares[name]
        self.progress.info(title)
        began = time.perf_counter()
        result = function(*arguments, progress=self.progress.part(self.done, self.done + share), **options)
        trim_heap()
        self.seconds[name] = time.perf_counter() - began
        self.done += share
        self.waiting.remove(name)
        self.progress.report(self.done)
        return result
