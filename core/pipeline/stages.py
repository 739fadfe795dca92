"""The stages of the road map, run one after the other: their shares of the progress bar and their run times."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.parallel import trim_heap
from ..io.crs import check_projected
from ..survey.frame.road import CORRIDOR
from ..survey.las.reader import read_headers
from ..survey.trajectory.reprojection import reproject_trajectory

if TYPE_CHECKING:
    from ..common.progress import Progress
    from ..survey.trajectory.trajectory import Trajectory

# Relative run time of each stage (per million points, per kilometre of road), measured by `make bench`
STAGE_COSTS = dict(survey=(0.31, 0.1), profiles=(0.105, 4.6), scanlines=(0.2, 8.0), edges=(0.0, 0.04), surface=(0.05, 1.5), intensity=(0.037, 0.7),
             image=(0.047, 1.1), markings=(0.017, 2.4), outliers=(0.018, 0.26), clusters=(0.019, 1.1), lines=(0.007, 0.6), driving=(0.005, 0.85))
MIN_STAGE_COST = 0.01  # of a stage without work
LAZ_READ_COST, LAS_READ_COST = 1.0, 0.42  # relative run time of reading a point of a LAZ and of a LAS file


@dataclass(frozen=True)
class Extent:
    """The amount of work, as far as it is known.

    points : millions of points
    length : kilometres of road
    plain : share of the points in uncompressed files
    """

    points: float
    length: float
    plain: float = 0.0

    @classmethod
    def expected(cls, paths: Sequence[str | Path], trajectory: Trajectory, crs: str = "") -> Extent:
        """The extent by file headers and trajectory, before any point is read.

        Parameters
        ----------
        paths : point cloud files
        trajectory : Trajectory
        crs : WKT for clouds that carry none

        Raises
        ------
        RoadExtractionError
            If a header cannot be read or the CRS is unsuitable, as in `open_survey`.
        """
        files = read_headers(paths, given=crs or trajectory.crs)
        trajectory = reproject_trajectory(trajectory, check_projected(files, crs, trajectory.crs))
        held = [file for file in files if file.count]
        points = sum(file.count for file in held)
        places = np.column_stack([trajectory.x, trajectory.y])
        low, high = (np.array([getattr(file, name)[:2] for file in held]).reshape(-1, 2) for name in ("minimum", "maximum"))
        within = ((places > low.min(axis=0, initial=np.inf) - CORRIDOR) & (places < high.max(axis=0, initial=-np.inf) + CORRIDOR)).all(axis=1)
        driven = np.hypot(*np.diff(places, axis=0).T)[within[1:]].sum()
        return cls(points / 1e6, float(driven) / 1e3, sum(file.count for file in held if file.chunk == 1) / max(points, 1))

    def cost(self, name: str, method: str) -> float:
        """Relative run time of a stage, with the given method of boundary detection."""
        if name == "curbs":
            return sum(self.cost(one, method) for one in ("profiles", "scanlines") if method in (one, "both"))
        of_points, of_length = STAGE_COSTS[name]
        if name == "survey":
            of_points *= LAZ_READ_COST + self.plain * (LAS_READ_COST - LAZ_READ_COST)
        return MIN_STAGE_COST + of_points * self.points + of_length * self.length


INTENSITY_STAGES = ("intensity", "image", "markings", "outliers", "clusters", "lines", "driving")   # stages that need intensity
STAGE_NAMES = ("survey", "curbs", "edges", "surface", *INTENSITY_STAGES)


class Stages:
    """Runs the stages of a road map one after the other and measures their run times.

    Parameters
    ----------
    progress : Progress of the whole run
    extent : Extent
    method : of boundary detection: profiles, scanlines or both
    left_out : names of stages that will not run

    Attributes
    ----------
    done : fraction of the bar that is done
    seconds : {stage: run time in s}
    """

    def __init__(self, progress: Progress, extent: Extent, method: str, left_out: Sequence[str] = ()):
        self.progress, self.done, self.method = progress, 0.0, method
        self.seconds: dict[str, float] = {}
        self.waiting = list(STAGE_NAMES)
        self.plan(extent, left_out)

    def plan(self, extent: Extent, left_out: Sequence[str] = ()) -> None:
        """Divide the rest of the bar among the remaining stages by a better known extent; some will not run."""
        self.waiting = [name for name in self.waiting if name not in left_out]
        costs = {name: extent.cost(name, self.method) for name in self.waiting}
        self.shares = {name: (1.0 - self.done) * cost / max(sum(costs.values()), 1e-9) for name, cost in costs.items()}

    def run(self, name: str, title: str, function: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
        """Run a stage: log its title, call the function with its part of the progress, and return its result."""
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
