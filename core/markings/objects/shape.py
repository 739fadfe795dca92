"""Length, width and direction of a cluster, measured in the road frame from its points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common.order_statistics import order_by
from ...curves.robust import median, percentiles
from ...lazy import cv2
from ...survey.store.records import COORDINATE_SCALE
from ..road_grid import CELL_SIZE, CELL_UNITS, fill_gaps, filled_between_tracks, occupied, track_reach
from .zigzag import zigzag_legs

MIDDLE_LINE_STEP_UNITS = 5000                         # units: 0.5 m of station that the run of a line is followed in
TRACKS_PER_STEP = 10.0                                # times the distance between the tracks of the scan that the step is at least
WIDTH_PERCENT = 95.0                                  # % of the points that the width spans; divided out again
MAX_ANGLE_ALONG = np.radians(20.0)                    # closer to the road's direction than this is "along" it
MIN_ANGLE_ACROSS = np.radians(60.0)                   # farther from it is "across"
END_UNITS, MIN_END_UNITS, MIN_END_POINTS = 10000, 2000, 4   # units: 1 m at either end, and 0.2 m and points at least that show how a track runs there
STEM_BREADTH_CELLS, STEM_STEP_CELLS = 9, 5            # cells: a stroke along the road is no broader (0.36 m), looked at every 20 cm
SCAN_GAPS_OF_BARS = 10, 6                             # cells along the road and across it: gaps between the scan lines on a bar
SMALL_MARKING_SIZE, SCAN_GAPS_OF_SMALL = 1.2, (3, 1)  # m, and cells likewise of what is no longer than that: the strokes of a sign lie farther apart


@dataclass(frozen=True)
class Shape:
    """What a cluster looks like in (s, d); metres, radians.

    direction is 0 along the road, pi/2 across it, within (-pi/2, pi/2].
    s0, s1, d0, d1 bound it; `offset` is the median offset, `area` that of its 4 cm cells;
    `closed_area` is the area with the gaps between scan lines, of what runs across the road or is small (`area` of the rest);
    `begin` and `finish` are the offsets of its middle line at s0 and s1 (the median for what is not along the road).
    `stems` are the shares of its length, from s0 on and from s1 back, over which it is a single stroke.
    `spacing` is the distance between the tracks of the scan that it was seen on, where these are farther apart than cells, else 0;
    `askew` is then how fast the tracks cross it at s0 and at s1, metres across per metre along, 0 where it is not known.
    `legs` are those of a zigzag line, 0 of anything else.
    `sides` are those of the smallest rectangle about what is small, however it lies, else length and width.
    """

    s0: float
    s1: float
    d0: float
    d1: float
    offset: float
    length: float
    width: float
    direction: float
    area: float
    points: int
    begin: float
    finish: float
    closed_area: float
    stems: tuple
    spacing: float = 0.0
    askew: tuple[float, float] = (0.0, 0.0)
    legs: int = 0
    sides: tuple[float, float] = (0.0, 0.0)

    @property
    def elongation(self) -> float:
        return self.length / max(self.width, 1e-3)

    @property
    def station(self) -> float:
        return (self.s0 + self.s1) / 2

    @property
    def along(self) -> bool:
        """Whether it runs along the road."""
        return abs(self.direction) <= MAX_ANGLE_ALONG

    @property
    def across(self) -> bool:
        """Whether it runs across the road."""
        return abs(self.direction) > MIN_ANGLE_ACROSS


def measure(s: np.ndarray, d: np.ndarray, spacing: np.ndarray | None = None) -> Shape:
    """The Shape of a cluster.

    Parameters
    ----------
    s, d : (N,) int, station and offset in units of 0.1 mm (integers, so that the order of points does not matter)
    spacing : (N,) int, mm across the road between the tracks of the scan; None where it is not known

    Notes
    -----
    Width is the 95 % range across the local tangent, scaled to the full range of
    evenly spread points: a principal axis would call every bend wide.
    """
    cells, member = occupied(s // CELL_UNITS, d // CELL_UNITS)
    apart = 0.0
    if spacing is not None and (reach := track_reach(spacing)).any():
        reach_of_cell = np.zeros(len(cells))
        reach_of_cell[member] = reach
        mask, first = filled_between_tracks(cells, reach_of_cell)
        cells, apart = np.argwhere(mask) + first, median(spacing) * 1e-3
    direction = _principal_direction(cells)
    s0, s1, d0, d1 = s.min(), s.max(), d.min(), d.max()
    if abs(direction) <= MAX_ANGLE_ALONG and s1 - s0 > 2 * MIDDLE_LINE_STEP_UNITS:
        length = (s1 - s0) * COORDINATE_SCALE
        nodes, offsets = middle_line(s, d, apart)
        across = d - np.interp(s, nodes, offsets)
        begin, finish = offsets[0] * COORDINATE_SCALE, offsets[-1] * COORDINATE_SCALE
    else:
        c, n = np.cos(direction), np.sin(direction)
        along = s * c + d * n
        length = np.ptp(along) * COORDINATE_SCALE
        across = d * c - s * n
        begin = finish = median(d) * COORDINATE_SCALE
    width = full_width(across) * COORDINATE_SCALE
    sides = float(length), width
    if max(s1 - s0, d1 - d0) * COORDINATE_SCALE <= SMALL_MARKING_SIZE:
        sides = smallest_rectangle(cells)
        closed = _closed(cells, SCAN_GAPS_OF_SMALL)
    else:
        closed = _closed(cells, SCAN_GAPS_OF_BARS) if abs(direction) > MIN_ANGLE_ACROSS else len(cells)
    area, closed_area = (count * (CELL_UNITS * COORDINATE_SCALE) ** 2 for count in (len(cells), closed))
    return Shape(s0 * COORDINATE_SCALE, s1 * COORDINATE_SCALE, d0 * COORDINATE_SCALE, d1 * COORDINATE_SCALE, median(d) * COORDINATE_SCALE,
                 float(length), width, direction, area, len(s), float(begin), float(finish), closed_area,
                 _stems(cells), apart, _askew(s, d) if apart else (0.0, 0.0), 0 if apart else zigzag_legs(cells), sides)


def smallest_rectangle(cells: np.ndarray) -> tuple[float, float]:
    """Sides of the smallest rectangle about (K, 2) cells, m."""
    sides = cv2.minAreaRect(cells.astype(np.float32))[1]
    return float((sides[0] + 1.0) * CELL_SIZE), float((sides[1] + 1.0) * CELL_SIZE)


def _closed(cells, gaps):
    """How many cells there are when the gaps between scan lines are closed."""
    low = cells.min(axis=0)
    mask = np.zeros(cells.max(axis=0) - low + 1, bool)
    mask[tuple((cells - low).T)] = True
    for axis, limit in enumerate(gaps):
        mask = fill_gaps(mask, limit, axis)
    return int(mask.sum())


def _stems(cells):
    """Shares of the length, from either end, over which cells reach no farther across than a stroke; wear parts none."""
    step = (cells[:, 0] - cells[:, 0].min()) // STEM_STEP_CELLS
    count = int(step.max()) + 1
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, step, cells[:, 1])
    np.maximum.at(high, step, cells[:, 1])
    broad = np.flatnonzero(high - low >= STEM_BREADTH_CELLS)
    return (float(broad[0]) / count, 1.0 - float(broad[-1] + 1) / count) if len(broad) else (1.0, 1.0)


def _askew(s, d):
    """How fast the tracks cross a cluster at its begin and at its end, from the points there."""
    found = []
    for end in (s - s.min() <= END_UNITS, s.max() - s <= END_UNITS):
        along, across = s[end] - s[end].mean(), d[end] - d[end].mean()
        clear = len(along) >= MIN_END_POINTS and np.ptp(along) >= MIN_END_UNITS
        found.append(abs(float((along * across).sum() / (along * along).sum())) if clear else 0.0)
    return found[0], found[1]


def full_width(across: np.ndarray) -> float:
    """Full width of evenly spread values from their 95 % range."""
    low, high = percentiles(across, ((100 - WIDTH_PERCENT) / 2, (100 + WIDTH_PERCENT) / 2))
    return (high - low) / (WIDTH_PERCENT / 100)


def _principal_direction(cells):
    if len(cells) < 2:
        return 0.0
    x, y = (cells - cells[0]).T.astype(float)
    x, y = x - x.mean(), y - y.mean()
    angle = 0.5 * np.arctan2(2 * (x * y).sum(), (x * x).sum() - (y * y).sum())
    return float(angle)


def middle_line(s: np.ndarray, d: np.ndarray, spacing: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """The middle line of an elongated cluster.

    Parameters
    ----------
    s, d : (N,) int, along and across it, units of 0.1 mm
    spacing : m between the tracks of the scan

    Returns
    -------
    stations, offsets : (K,) float, nodes every 0.5 m, smoothed over 2.5 m; of a line seen on few tracks, each of which
        shows it at one place of its width, they lie ten track spacings apart
    """
    step = max(MIDDLE_LINE_STEP_UNITS, int(round(TRACKS_PER_STEP * spacing / COORDINATE_SCALE)))
    bins = (s - s.min()) // step
    order = order_by(d, bins)
    sorted_bins = bins[order]
    starts = np.flatnonzero(np.append(True, sorted_bins[1:] != sorted_bins[:-1]))
    ends = np.append(starts[1:], len(s))
    count = ends - starts
    # the middle between the outer eighths is steadier than a median where paint is worn on one side
    low, high = d[order[starts + count // 8]], d[order[ends - 1 - count // 8]]
    nodes = s.min() + (sorted_bins[starts] + 0.5) * step
    weight = np.minimum(count, 30).astype(float)
    return nodes, _smooth(nodes, (low + high) / 2, weight, step)


def _smooth(nodes, values, weight, step):
    """A straight line fitted to the five nodes about each, so that ends and slopes stay."""
    if len(values) < 3:
        return np.full(len(values), np.average(values, weights=weight))
    reach = np.arange(-2, 3)
    rows = np.arange(len(values))[:, None] + reach
    inside = (rows >= 0) & (rows < len(values))
    rows = np.clip(rows, 0, len(values) - 1)
    x = nodes[rows] - nodes[:, None]
    w = weight[rows] * inside * (np.abs(x) <= 2.6 * step)
    y = values[rows]
    sw, sx, sy = w.sum(1), (w * x).sum(1), (w * y).sum(1)
    sxx, sxy = (w * x * x).sum(1), (w * x * y).sum(1)
    spread_x = sw * sxx - sx * sx
    steady = spread_x > 1e-6 * sw * sw * step**2
    return np.where(steady, (sxx * sy - sx * sxy) / np.where(steady, spread_x, 1.0), sy / sw)
