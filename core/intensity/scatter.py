"""How single points of each scanner scatter on asphalt: whether it is noisy, and whether its brightness is that of photographs.

Half of asphalt's intensity under multi-beam scanners, a sixth under mirror scanners. A scanner is judged by all roads of a survey.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy import ndimage

from ..common.arrays import order_by
from ..execution.in_step import Asked, Work
from ..execution.phase import Phase
from ..survey.store.records import COORDINATE_SCALE, Points
from ..survey.store.road_points import RoadPoints
from .asphalt_model import LOWER_QUANTILE
from .weights import ASPHALT, IMAGE

WINDOW_UNITS = round(IMAGE.ranking_window / COORDINATE_SCALE)   # derived: units of road whose points are judged together
WINDOWS_PER_TASK = 12   # derived: windows that a worker process is given together: at everyday density half a second of its time
MAX_SCATTER_POINTS = 100_000   # derived: of a window that are examined; of twice as many an evenly spread share

WindowKey = tuple[int, int]   # road, number of the window


@dataclass(frozen=True)
class ScannerScatter:
    """How single points of each scanner scatter on asphalt.

    shares : {scanner: scatter as a share of asphalt's level, the median over squares of 1 m of all roads}; scanners with too few points are left
        out, and are taken for not noisy
    points : {(road, window): (scanners,) points of each scanner}
    differences : {scanner: mean squared difference of neighbouring points of asphalt as a share of their variance about a plane through the square,
        von Neumann's ratio (1941), the mean over squares}: 2 where each point scatters by itself, less where neighbours are of one pixel of a
        photograph or of two; 0 of points whose brightness is that of their colours
    """

    shares: dict[int, float]
    points: dict[WindowKey, np.ndarray]
    differences: dict[int, float] = field(default_factory=dict)

    @property
    def noisy(self) -> list[int]:
        return [scanner for scanner, share in sorted(self.shares.items()) if share > ASPHALT.noisy_scatter]

    @property
    def photographed(self) -> list[int]:
        return [scanner for scanner, ratio in sorted(self.differences.items()) if ratio < ASPHALT.photographed]

    def noisy_windows(self, road: int) -> set[int]:
        """The windows of a road in which most points are of noisy scanners: there paint is searched for in averages."""
        return self._windows_of(road, self.noisy)

    def photographed_windows(self, road: int) -> set[int]:
        """The windows of a road in which the brightness of most points is that of photographs."""
        return self._windows_of(road, self.photographed)

    def _windows_of(self, road, scanners):
        """The windows of a road in which most points are of some scanners."""
        return {window for (of, window), count in self.points.items()
                if of == road and 2 * sum(count[k] for k in scanners if k < len(count)) > count.sum()}

    def summary(self, length: float) -> str:
        """A sentence for a log; `length` is that of a window, metres."""
        if not self.shares:
            return "The scatter of intensities on asphalt is not known, there are too few road points: paint is searched for in the image."
        listed = ", ".join(f"{100 * share:.0f} % (scanner {scanner})" for scanner, share in sorted(self.shares.items()))
        text = f"Intensities on asphalt scatter by {listed}; more than {100 * ASPHALT.noisy_scatter:.0f} % is noisy."
        windows = sum(len(self.noisy_windows(road)) for road in {road for road, _ in self.points})
        filled = sum(bool(count.sum()) for count in self.points.values())
        if not windows:
            return f"{text} Paint is searched for in the image."
        return (f"{text} Along {windows * length:.0f} of {filled * length:.0f} m most points are of noisy scanners: there paint is searched for in "
                "averages, as elongated pieces and rows of dashes; other markings are not found.")


def windows_of(road_points: RoadPoints) -> list[WindowKey]:
    """Roads and numbers of the windows of all roads."""
    ends = ((road, *(int(np.floor(s / COORDINATE_SCALE / WINDOW_UNITS)) for s in road_points.store.span(road))) for road in road_points.roads())
    return [(road, window) for road, first, last in ends for window in range(first, last + 1)]


def place_of(road_points: RoadPoints, windows: tuple[int, int, int]) -> str:
    """What messages call the windows of a road from a first to before a last number."""
    road, *ends = windows
    return road_points.survey.stretch(road, *_stations(*ends))


def _stations(*windows):
    """Stations, m, at which windows begin."""
    return [window * WINDOW_UNITS * COORDINATE_SCALE for window in windows]


def scanner_scatter(road_points: RoadPoints) -> Work:
    """The work that looks at the ScannerScatter of all roads of a survey."""
    windows = windows_of(road_points)
    phase = Phase(scatter_of_windows, road_points, (), lambda item: place_of(road_points, (*item[0], item[-1][1] + 1)),
                  state=lambda item: [road_points.state(road, *_stations(window, window + 1)) for road, window in item], listed=WINDOWS_PER_TASK)
    measured = yield Asked(phase, windows, 1.0)
    squares = [entry for _, entry in measured]
    shares = _shares(squares)
    # in photographs of many pixels, single points scatter as under a scanner
    differences = dict.fromkeys(shares, 0.0) if road_points.of_colours else _shares(squares, 3, np.mean)
    return ScannerScatter(shares, {key: count for key, (count, _) in zip(windows, measured)}, differences)


def scatter_of_windows(road_points: RoadPoints, windows: Sequence[WindowKey]) -> list[tuple[np.ndarray, tuple[np.ndarray, ...]]]:
    """The phase that looks how single points scatter in windows: (scanners,) points of each scanner, and what `_scatter_in_squares` gives."""
    of_windows = (road_points.window(road, *_stations(window, window + 1)) for road, window in windows)
    return [(np.bincount(points.scanner), _scatter_in_squares(points)) for points in of_windows]


def _scatter_in_squares(points: Points) -> tuple[np.ndarray, ...]:
    """Scanner, number of points, scatter as a share of asphalt's level and differences of neighbours as a share of the variance, (squares,) each,
    of every fourth square of 1 m along the road, seen by one scanner from one distance.

    Taken from raw intensities of the lower half of a square, which holds no paint; squares with few points or without intensity are left out.
    Differences are NaN where few points have a neighbour in their cell of 4 cm.
    """
    side = int(round(ASPHALT.scatter_square / COORDINATE_SCALE))
    points = points[points.records["s"] // side % ASPHALT.scatter_step == 0]
    if not len(points):
        return np.empty(0, np.uint8), np.empty(0, int), np.empty(0), np.empty(0)
    points = points[::max(len(points) // MAX_SCATTER_POINTS, 1)]
    value, scanner = points.intensity, points.scanner
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
    starts, count = starts[count >= ASPHALT.min_square_points], count[count >= ASPHALT.min_square_points]
    median, low = value[starts + count // 2], value[starts + (LOWER_QUANTILE * count).astype(np.int64)]
    lit = median > 0
    return scanner[order][starts[lit]], count[lit], 1.0 - low[lit] / median[lit], _differences(points, order, starts[lit], count[lit] // 2)


def _differences(points, order, starts, count):
    """(squares,) mean squared difference of points in one cell, by the variance of the square; NaN where few share a cell.

    order : (N,) of points, by squares; starts, count : (squares,) where each begins and how many of its points are looked at
    """
    if not len(count):
        return np.empty(0)
    square = np.repeat(np.arange(len(count)), count)
    place = order[np.arange(len(square)) + np.repeat(starts - np.cumsum(count) + count, count)]
    # brightness that falls with distance is no likeness of neighbours: a plane through the square is taken off
    columns = np.stack([points.s[place], points.d[place], points.intensity[place].astype(float)])
    columns -= np.stack([np.bincount(square, column) / count for column in columns])[:, square]
    products = np.array([[np.bincount(square, a * b) for a in columns] for b in columns]).transpose(2, 0, 1)
    slope = np.linalg.pinv(products[:, :2, :2], hermitian=True) @ products[:, :2, 2:]
    residual = columns[2] - (slope[square, :, 0].T * columns[:2]).sum(axis=0)
    # in one cell by order of the points: by that of their values neighbours would be alike
    keys = np.stack([place, *(points.records[key][place] // ASPHALT.pixel for key in "ds"), square])
    by_cell = np.lexsort(keys)
    of = np.where((np.diff(keys[1:, by_cell]) == 0).all(axis=0), square[1:], -1)
    few = np.bincount(of + 1, minlength=len(count) + 1)[1:] < ASPHALT.min_neighbours
    with np.errstate(divide="ignore", invalid="ignore"):
        # three numbers of each square are those of its plane
        ratio = ndimage.mean(np.diff(residual[by_cell]) ** 2, of, range(len(count))) * (count - 3) / np.bincount(square, residual**2)
    return np.where(few, np.nan, ratio)


def _shares(squares, place=2, middle=np.median):
    """{scanner: median or mean} of what stands at a place of the results of `_scatter_in_squares` in several windows, where that is known."""
    if not squares:
        return {}
    scanner, count, scatter = (np.concatenate([entry[k] for entry in squares]) for k in (0, 1, place))
    known = np.isfinite(scatter)
    scanner, count, scatter = scanner[known], count[known], scatter[known]
    points = np.bincount(scanner, count)
    return {k: float(middle(scatter[scanner == k])) for k in np.flatnonzero(points >= ASPHALT.min_scanner_points).tolist()}
