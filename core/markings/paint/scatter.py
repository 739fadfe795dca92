"""The scatter of single points of each scanner on asphalt, which decides whether the scanner is noisy.

Points of multi-beam scanners scatter by half of asphalt's intensity, those of
mirror scanners by a sixth. A scanner is judged by all roads of a survey; the method used along a
stretch of road depends on the scanners whose points lie there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...common.arrays import order_by
from ...common.progress import Progress
from ...execution.phase import Phase
from ...intensity.asphalt_model import LOWER_QUANTILE
from ...survey.store.records import COORDINATE_SCALE, Points
from .windows import THRESHOLD_WINDOW, place_of, points_of_rows

if TYPE_CHECKING:
    from ...execution.phase import Executor
    from ...survey.store.road_points import RoadPoints

NOISY_SCATTER = 0.40      # of asphalt's level: single points that scatter more are averaged (multi-beam scanners)
SCATTER_SQUARE = 1.0      # m
MIN_SQUARE_POINTS = 30  # points of one scanner
MIN_SCANNER_POINTS = 500     # in squares, below which the scatter of a scanner is unknown
MAX_SCATTER_POINTS = 100_000   # of a window that are examined; of twice as many an evenly spread share
EXAMINED_WINDOWS = 16    # windows of 20 m that a worker process is given together
SAMPLED_WINDOW_STEP = 4      # every fourth window of a road is examined; the others only for scanners that are in none of these

WindowKey = tuple[int, int]   # road, number of the window


@dataclass(frozen=True)
class ScannerScatter:
    """ScannerScatter of a survey's scanners.

    shares : {scanner: scatter as a share of asphalt's level, the median over squares of 1 m of all roads}; scanners with too few
        points are left out, and are taken for not noisy
    points : {(road, window): (scanners,) points of each scanner}
    """

    shares: dict[int, float]
    points: dict[WindowKey, np.ndarray]

    @classmethod
    def of(cls, road_points: RoadPoints, windows: Sequence[WindowKey], executor: Executor, progress: Progress = Progress()) -> ScannerScatter:
        """ScannerScatter from the windows of a survey.

        Parameters
        ----------
        road_points : RoadPoints
        windows : (road, window) of all roads
        executor : Executor that looks at the windows
        progress : Progress
        """
        sampled = {key for key in windows if key[1] % SAMPLED_WINDOW_STEP == 0}
        roads = {road for road, _ in sampled}
        sampled |= {key for key in windows if key[0] not in roads}
        together = EXAMINED_WINDOWS if executor.folder else 1
        phase = Phase(scatter_of_windows, road_points, (), lambda item: place_of(road_points, (item[0][0], item[0][1], item[-1][1] + 1)))

        def run(items, part):
            tasks = [items[k:k + together] for k in range(0, len(items), together)]
            return [found for some in executor.run(phase, tasks, part) for found in some]

        found = run([(*key, key in sampled) for key in windows], progress)
        counts = {key: count for key, (count, _) in zip(windows, found)}
        squares = [some for _, some in found if some is not None]
        shares = _shares(squares)
        missing = {scanner for count in counts.values() for scanner in np.flatnonzero(count).tolist()} - set(shares)
        rest = [(*key, True) for key in windows if key not in sampled and any(counts[key][k] for k in missing if k < len(counts[key]))]
        squares += [some for _, some in run(rest, Progress())] if rest else []
        return cls({**{scanner: share for scanner, share in _shares(squares).items() if scanner in missing}, **shares}, counts)

    @property
    def noisy(self) -> list[int]:
        """Scanners that are noisy, in order."""
        return [scanner for scanner, share in sorted(self.shares.items()) if share > NOISY_SCATTER]

    def noisy_windows(self, road: int) -> set[int]:
        """The windows of a road in which most points are of noisy scanners: there paint is searched for in averages."""
        return {window for (of, window), count in self.points.items()
                if of == road and 2 * sum(count[k] for k in self.noisy if k < len(count)) > count.sum()}

    def summary(self, length: float) -> str:
        """A sentence for a log; `length` is that of a window, metres."""
        if not self.shares:
            return "The scatter of intensities on asphalt is not known, there are too few road points: paint is searched for in the image."
        each = ", ".join(f"{100 * share:.0f} % (scanner {scanner})" for scanner, share in sorted(self.shares.items()))
        text = f"Intensities on asphalt scatter by {each}; more than {100 * NOISY_SCATTER:.0f} % is noisy."
        windows = sum(len(self.noisy_windows(road)) for road in {road for road, _ in self.points})
        every = sum(bool(count.sum()) for count in self.points.values())
        if not windows:
            return text + " Paint is searched for in the image."
        if windows == every:
            return text + (" Paint is searched for in averages over a decimetre, as elongated pieces and rows of dashes; other markings are not "
                           "found.")
        return text + (f" Along {windows * length:.0f} of {every * length:.0f} m most points are of noisy scanners, and paint is searched for there "
                       "in averages over a decimetre, as elongated pieces and rows of dashes; other markings are not found there.")


def scatter_of_windows(road_points: RoadPoints,
                       windows: Sequence[tuple[int, int, bool]]) -> list[tuple[np.ndarray, tuple[np.ndarray, np.ndarray, np.ndarray] | None]]:
    """The phase that looks how single points scatter.

    Parameters
    ----------
    road_points : RoadPoints
    windows : road, window, and whether the scatter in it is asked for

    Returns
    -------
    count : (scanners,) points of each scanner in a window
    squares : of `scatter_in_squares`, None where they are not asked for
    """
    found = []
    for road, window, sampled in windows:
        points = points_of_rows(road_points, road, window * THRESHOLD_WINDOW, (window + 1) * THRESHOLD_WINDOW)
        found.append((np.bincount(points.scanner), scatter_in_squares(points) if sampled else None))
    return found


def scatter_in_squares(points: Points) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Scatter of single points on asphalt in squares of 1 m measured by one scanner from one distance.

    It is that of the raw intensities, from the lower half of a square, which holds no paint.

    Returns
    -------
    scanner, count, scatter : (squares,) the scatter as a share of asphalt's level; squares with few points or without intensity are left out
    """
    if not len(points):
        return np.empty(0, np.uint8), np.empty(0, int), np.empty(0)
    points = points[::max(len(points) // MAX_SCATTER_POINTS, 1)]
    value, scanner = points.intensity, points.scanner
    side = int(round(SCATTER_SQUARE / COORDINATE_SCALE))
    square = np.zeros(len(value), np.int32)
    # another pass is another distance
    for key in (points.records["s"] // side, points.records["d"] // side, scanner, points.pass_number):
        low, high = int(key.min()), int(key.max())
        square *= high - low + 1
        square += key.astype(np.int32) - low
    order = order_by(value, square)
    value = value[order].astype(float)
    starts = np.flatnonzero(np.r_[True, np.diff(square[order]) != 0])
    count = np.diff(np.r_[starts, len(value)])
    starts, count = starts[count >= MIN_SQUARE_POINTS], count[count >= MIN_SQUARE_POINTS]
    median, low = value[starts + count // 2], value[starts + (LOWER_QUANTILE * count).astype(np.int64)]
    lit = median > 0
    return scanner[order][starts[lit]], count[lit], 1.0 - low[lit] / median[lit]


def _shares(squares):
    """{scanner: median scatter} of the results of `scatter_in_squares` in several windows."""
    if not squares:
        return {}
    scanner, count, scatter = (np.concatenate(parts) for parts in zip(*squares))
    points = np.bincount(scanner, count)
    return {k: float(np.median(scatter[scanner == k])) for k in np.flatnonzero(points >= MIN_SCANNER_POINTS).tolist()}
