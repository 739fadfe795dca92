"""How single points of each scanner scatter on asphalt: whether it is noisy, and whether its brightness is that of photographs.

Half of asphalt's intensity under multi-beam scanners, a sixth under mirror scanners. A scanner is judged by all roads of a survey.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
    photographed : nats by which brightness is rather that of photographs than the scanners' own, of all scanners and roads: `_nats_of_photographs`
    """

    shares: dict[int, float]
    points: dict[WindowKey, np.ndarray]
    photographed: float = -np.inf

    @property
    def noisy(self) -> list[int]:
        return [scanner for scanner, share in sorted(self.shares.items()) if share > ASPHALT.noisy_scatter]

    def noisy_windows(self, road: int) -> set[int]:
        """The windows of a road in which most points are of noisy scanners: there paint is searched for in averages."""
        return {window for (of, window), count in self.points.items()
                if of == road and 2 * sum(count[k] for k in self.noisy if k < len(count)) > count.sum()}

    def doubt(self, length: float) -> str:
        """What to warn of where brightness is, or may be, that of photographs, "" for nothing; `length` is that of a window, metres."""
        if self.photographed > 0.0:
            along = length * sum(bool(count.sum()) for count in self.points.values())
            return (f"Along {along:.0f} m brightness is that of colours, or points that are neighbours, or that several scanners or passes saw at "
                    "one place, are as alike as in photographs. Paint is compared with the ground around each spot there, and edges of shadows may "
                    "be taken for it: look at these markings, or give the scanner's own intensity.")
        return ("Points are nearly as alike as in photographs, but brightness is taken for the scanner's own: look at the intensity image."
                if self.photographed > -ASPHALT.doubtful_photographs else "")

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
    points = {key: count for key, (count, _) in zip(windows, measured)}
    if not measured:
        return ScannerScatter({}, points)
    squares = [np.concatenate(column, axis=-1) for column in zip(*(entry for _, entry in measured))]
    road = np.repeat([road for road, _ in windows], [len(entry[0]) for _, entry in measured])
    # in photographs of many pixels, single points scatter as under a scanner
    return ScannerScatter(_shares(*squares[:3]), points, np.inf if road_points.of_colours else _nats_of_photographs(road, *squares))


def scatter_of_windows(road_points: RoadPoints, windows: Sequence[WindowKey]) -> list[tuple[np.ndarray, tuple[np.ndarray, ...]]]:
    """The phase that looks how single points scatter in windows: (scanners,) points of each scanner, and what `_scatter_in_squares` gives."""
    of_windows = (road_points.window(road, *_stations(window, window + 1)) for road, window in windows)
    return [(np.bincount(points.scanner), _scatter_in_squares(points)) for points in of_windows]


def _scatter_in_squares(points: Points) -> tuple[np.ndarray, ...]:
    """Scanner, number of points, scatter as a share of asphalt's level, differences of neighbours as a share of the variance, pass, place along and
    across the road, and logarithm of the level, (squares,) each, of every fourth square of 1 m along the road, seen by one scanner from one distance.

    Taken from raw intensities of the lower half of a square, which holds no paint; squares with few points or without intensity are left out.
    Differences are NaN where few points have a neighbour in their cell, of 4 cm and of 8 cm.
    """
    side = int(round(ASPHALT.scatter_square / COORDINATE_SCALE))
    points = points[points.records["s"] // side % ASPHALT.scatter_step == 0]
    if not len(points):
        return np.empty(0, np.uint8), np.empty(0, int), np.empty(0), np.empty((2, 0)), *np.empty((3, 0), np.int64), np.empty(0)
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
    first = points[order[starts[lit]]]
    return (first.scanner, count[lit], 1.0 - low[lit] / median[lit], _differences(points, order, starts[lit], count[lit] // 2),
            *(key.astype(np.int64) for key in (first.pass_number, first.records["s"] // side, first.records["d"] // side)), np.log(median[lit]))


def _differences(points, order, starts, count):
    """(2, squares) mean squared difference of points in one cell, small or larger, by the variance of the square; NaN where few share a cell.

    order : (N,) of points, by squares; starts, count : (squares,) where each begins and how many of its points are looked at
    """
    if not len(count):
        return np.empty((2, 0))
    square = np.repeat(np.arange(len(count)), count)
    place = order[np.arange(len(square)) + np.repeat(starts - np.cumsum(count) + count, count)]
    # brightness that falls with distance is no likeness of neighbours: a plane through the square is taken off
    columns = np.stack([points.s[place], points.d[place], points.intensity[place].astype(float)])
    columns -= np.stack([np.bincount(square, column) / count for column in columns])[:, square]
    products = np.array([[np.bincount(square, a * b) for a in columns] for b in columns]).transpose(2, 0, 1)
    slope = np.linalg.pinv(products[:, :2, :2], hermitian=True) @ products[:, :2, 2:]
    residual = columns[2] - (slope[square, :, 0].T * columns[:2]).sum(axis=0)
    # in one cell by order of the points: by that of their values neighbours would be alike
    keys = np.stack([place, *(points.records[key][place] // side for side in ASPHALT.pixels for key in "ds"), square])
    by_cell = np.lexsort(keys)
    step, same = np.diff(residual[by_cell]) ** 2, np.diff(keys[1:, by_cell]) == 0
    result = np.empty((2, len(count)))
    for ratio, alike in zip(result, (same.all(axis=0), same[2:].all(axis=0))):
        pairs, sums = (np.bincount(square[1:][alike], weights, len(count)) for weights in (None, step[alike]))
        with np.errstate(divide="ignore", invalid="ignore"):
            # three numbers of each square are those of its plane
            ratio[:] = np.where(pairs < ASPHALT.min_neighbours, np.nan, sums / pairs * (count - 3) / np.bincount(square, residual**2))
    return result


def _shares(scanner, count, scatter):
    """{scanner: median of the scatter}."""
    points = np.bincount(scanner, count)
    return {k: float(np.median(scatter[scanner == k])) for k in np.flatnonzero(points >= ASPHALT.min_scanner_points).tolist()}


def _nats_of_photographs(road, scanner, count, _, differences, of_pass, along, across, level):
    """Nats for photographs, from what `_scatter_in_squares` gives of several windows; -inf where too few points are known.

    Von Neumann's ratio (1941), the mean squared difference of neighbours by their variance about a plane through the square, is 2 where each point
    scatters by itself, and less where neighbours are of one pixel of a photograph or of two. In photographs the level of a place, in the sun or the
    shade, is the same for all scanners and passes; under a scanner it is another at each distance, or varies little where that was corrected. Levels
    are compared across the road, along which asphalt may be old and new.
    """
    # in thin clouds few points share a small cell
    known = [ratio[np.isfinite(ratio)] for ratio in differences if count[np.isfinite(ratio)].sum() >= ASPHALT.min_scanner_points]
    if not known:
        return -np.inf
    level = level - _means((road, along, scanner, of_pass), level)[0]
    (at_distance, by_distance), (at_place, by_place) = (_means(keys, level) for keys in ((scanner, of_pass, across), (road, along, across)))
    twice = (by_distance > 1) & (by_place > 1)
    about_distance, about_place = (((level - mean)[twice] ** 2).sum() / max((1.0 - 1.0 / of[twice]).sum(), 1.0) + ASPHALT.usual_level**2
                                   for mean, of in ((at_distance, by_distance), (at_place, by_place)))
    place_nats = ASPHALT.place_nats * twice.sum() / (twice.sum() + ASPHALT.usual_squares)
    return float(ASPHALT.neighbour_nats * (ASPHALT.photographed - known[0].mean()) + place_nats * np.log(about_distance / about_place))


def _means(keys, values):
    """Of each value the mean of those with the same keys, and how many these are, (N,) each."""
    order, group = np.lexsort(keys), np.zeros(len(values), np.intp)
    group[order[1:]] = np.cumsum((np.diff(np.stack(keys)[:, order]) != 0).any(axis=0))
    count = np.bincount(group)
    return (np.bincount(group, values) / count)[group], count[group]
