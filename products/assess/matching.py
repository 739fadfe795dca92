"""Points sampled along lines, their distances from other lines, their stations along the road; rates and errors from what was matched."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from ...core.common.arrays import Rows
from ...core.curves.line_segments import NearestPoints, SegmentIndex

LINE_SAMPLE_STEP = 0.1     # m between the compared points along a line
MAX_BESIDE_DISTANCE = 2.5  # m; a result farther from every reference line is stationed along itself
MIN_REFERENCE_WIDTH = 2.0       # m between the outermost reference lines, below which lines have no sides
MAX_ROAD_DISTANCE = 30.0   # m from the trajectory or the longest reference line within which lines have stations and sides


@dataclass(frozen=True)
class LinePoints(Rows):
    """Midpoints of the pieces into which lines are divided."""

    xy: np.ndarray   # (N, 2) metres
    z: np.ndarray   # (N,) metres, NaN if the line has no heights
    line: np.ndarray   # (N,) index of the line
    station: np.ndarray   # (N,) metres along the line
    length: np.ndarray   # (N,) of the piece, metres
    heading: np.ndarray   # (N,) radians, in the direction the line is drawn

    def inside(self, area: shapely.Geometry | None) -> LinePoints:
        """The points within a polygon; all if it is None."""
        return self if area is None else self[shapely.contains_xy(area, self.xy[:, 0], self.xy[:, 1])]


def sample_lines(lines: Sequence[shapely.LineString], step: float = LINE_SAMPLE_STEP) -> LinePoints:
    """Points every `step` metres or less along LineStrings, each the midpoint of its piece."""
    if not len(lines):
        none = np.empty(0)
        return LinePoints(np.empty((0, 2)), none, np.empty(0, int), none, none, none)
    total = shapely.length(np.asarray(lines, object))
    count = np.maximum(np.ceil(total / step - 1e-9).astype(int), 1)
    line = np.repeat(np.arange(len(lines)), count)
    piece = (total / count)[line]
    number = np.arange(len(line)) - np.repeat(np.cumsum(count) - count, count)
    segments = SegmentIndex(lines)
    station = (number + 0.5) * piece
    xy, z = segments.at(line, station)
    return LinePoints(xy, z, line, station, piece, segments.heading_at(line, station))


def constant_runs(points: LinePoints, key: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Runs of successive points along a line with the same (N,) integer `key`.

    Returns first, last: (R,) index of the first and the last point of each run
    """
    if not len(points):
        return np.empty(0, int), np.empty(0, int)
    apart = np.abs(np.diff(points.station)) > 1.5 * np.maximum(points.length[1:], points.length[:-1])
    cut = np.flatnonzero((np.diff(key) != 0) | (np.diff(points.line) != 0) | apart) + 1
    return np.r_[0, cut], np.r_[cut, len(points)] - 1


def cut_runs(lines: Sequence[shapely.LineString], points: LinePoints, first: np.ndarray, last: np.ndarray) -> list[shapely.LineString]:
    """The pieces of the lines from the first to the last point of each run of `constant_runs`."""
    start = points.station[first] - points.length[first] / 2
    end = points.station[last] + points.length[last] / 2
    pieces = []
    vertices: dict[int, tuple[np.ndarray, np.ndarray]] = {}
    for k, a, b in zip(points.line[first].tolist(), start.tolist(), end.tolist()):
        if k not in vertices:
            xyz = shapely.get_coordinates(lines[k], include_z=shapely.has_z(lines[k]))
            vertices[k] = xyz, np.r_[0.0, np.cumsum(np.hypot(*np.diff(xyz[:, :2], axis=0).T))]
        pieces.append(_cut(*vertices[k], a, b))
    return pieces


def _cut(points, along, start, end):
    """The part of a line from one station to another."""
    inner = slice(np.searchsorted(along, start + 1e-6, side="right"), np.searchsorted(along, end - 1e-6, side="left"))
    ends = np.stack([np.interp([start, end], along, axis) for axis in points.T], axis=1)
    return shapely.LineString(np.concatenate([ends[:1], points[inner], ends[1:]]))


@dataclass(frozen=True)
class Stations:
    """Positions along the road."""

    unit: np.ndarray   # (N,) index of the road or line along which a point is measured, -1 if there is none
    station: np.ndarray   # (N,) metres along it
    side: np.ndarray   # (N,) 1 left, -1 right, 0 unknown
    offset: np.ndarray   # (N,) metres from the trajectory, positive to the left; NaN without one


class TrajectoryStationing:
    """Stations of a RoadFrame; left and right are those of the drive."""

    title = "the trajectory"
    signed = "positive away from the trajectory"

    def __init__(self, frame: Any, corridor: float) -> None:
        """`frame`: RoadFrame; `corridor`: metres to either side."""
        self.frame, self.corridor = frame, corridor

    def of_reference(self, points: LinePoints) -> Stations:
        road, station, offset = self.frame.locate_nearest(*self.frame.to_local(*points.xy.T), corridor=self.corridor)
        return Stations(road, station, np.sign(np.nan_to_num(offset)).astype(int), offset)

    def of_result(self, points: LinePoints, nearest: NearestPoints) -> Stations:
        """Stations of points of the result; `nearest`: their nearest points on the reference."""
        return self.of_reference(points)

    def outward(self, points: LinePoints, nearest: NearestPoints, stations: Stations) -> np.ndarray:
        """(N,) +1 where a point lies farther from the trajectory than its nearest point on the reference, else -1."""
        offset = self.frame.locate_nearest(*self.frame.to_local(*np.nan_to_num(nearest.xy).T), corridor=self.corridor)[2]
        return np.where(np.abs(stations.offset) >= np.abs(np.nan_to_num(offset)), 1.0, -1.0)


class ReferenceStationing:
    """Stations along each reference line, for itself and for the result within MAX_BESIDE_DISTANCE of it."""

    title = "the reference lines"
    signed = "positive left of the reference line as it is drawn"

    def __init__(self, lines: Sequence[shapely.LineString], sides: Sequence[int] | None = None) -> None:
        """`sides`: 1, -1 or 0 of every line as its layer says; by default inferred by `_sides_of`."""
        self.side = _sides_of(lines) if sides is None else np.asarray(sides, int)
        self.count = len(lines)
        self.length = shapely.length(np.asarray(lines, object)) if self.count else np.empty(0)

    def of_reference(self, points: LinePoints) -> Stations:
        return Stations(points.line, points.station, self.side[points.line], np.full(len(points), np.nan))

    def of_result(self, points: LinePoints, nearest: NearestPoints) -> Stations:
        """Stations of points of the result; `nearest`: their nearest points on the reference."""
        # what lies beyond the end of a line is not beside it
        abreast = (nearest.station > 1e-6) & (nearest.station < self.length[nearest.line] - 1e-6) if self.count else False
        near = (nearest.distance <= MAX_BESIDE_DISTANCE) & abreast
        side = np.where(nearest.line >= 0, self.side[nearest.line] if self.count else 0, 0)
        return Stations(np.where(near, nearest.line, self.count + points.line), np.where(near, nearest.station, points.station),
                        side, np.full(len(points), np.nan))

    def outward(self, points: LinePoints, nearest: NearestPoints, stations: Stations) -> np.ndarray:
        """(N,) +1 left of the reference line as drawn, -1 right of it."""
        return nearest.side


def _sides_of(lines: Sequence[shapely.LineString]) -> np.ndarray:
    """(N,) side of every line: 1 left, -1 right or 0 unknown, along the longest line as it is drawn.

    The middle of the road is taken halfway between the outermost lines; lines less than 2 m apart, or a single one, have no sides.
    """
    if len(lines) < 2:
        return np.zeros(len(lines), int)
    length = shapely.length(np.asarray(lines, object))
    axis = SegmentIndex([lines[int(np.argmax(length))]])
    points = sample_lines(lines, 2.0)
    nearest = axis.nearest(points.xy)
    offset = np.bincount(points.line, nearest.side * nearest.distance, len(lines)) / np.bincount(points.line, minlength=len(lines))
    near = np.abs(offset) <= MAX_ROAD_DISTANCE
    low, high = offset[near].min(), offset[near].max()
    if high - low < MIN_REFERENCE_WIDTH:
        return np.zeros(len(lines), int)
    return np.where(near, np.where(offset > (low + high) / 2, 1, -1), 0)


def stations_of_match(match: Any, frame: Any = None) -> tuple[tuple[np.ndarray, np.ndarray], str]:
    """((N,) stations of the result's points, (M,) of the reference's, m, NaN where unknown; what they are measured along) of a LineMatch.

    `frame`: RoadFrame, or None to measure along the reference lines.
    """
    if frame is not None:
        along = TrajectoryStationing(frame, MAX_ROAD_DISTANCE)
        return (along.of_reference(match.result_points).station, along.of_reference(match.reference_points).station), along.title
    nearest = SegmentIndex(match.reference).nearest(match.result_points.xy)
    return (nearest.station, match.reference_points.station), ReferenceStationing.title


def stations_of_blocks(blocks: np.ndarray, frame: Any = None) -> tuple[np.ndarray, str]:
    """((N,) stations, m, of (N, 2+) x and y; what they are measured along): a RoadFrame or, without one, their longer principal axis."""
    if not len(blocks):
        return np.empty(0), TrajectoryStationing.title
    xy = blocks[:, :2]
    if frame is not None:
        return frame.locate_nearest(*frame.to_local(*xy.T), corridor=MAX_ROAD_DISTANCE)[1], TrajectoryStationing.title
    centre = xy.mean(axis=0)
    axis = np.linalg.eigh(np.cov((xy - centre).T) if len(xy) > 1 else np.eye(2))[1][:, -1]
    axis = axis if axis[np.argmax(np.abs(axis))] > 0 else -axis
    along = (xy - centre) @ axis
    return along - along.min(), "the longer side of the layers"


# Precision, recall, F1 and IoU from counts, and statistics of deviations.
#
# The driving-line thesis prints tp / (tp + fn) for precision and 2 tp / (fp + fn) + 1 for F1; its tables follow the usual formulas, which are used
# here.

def f1_of(precision: float, recall: float) -> float:
    """Harmonic mean of precision and recall (both shares or both per cent); 0 where both are 0, NaN where one is unknown."""
    total = precision + recall
    return 2.0 * precision * recall / total if total else 0.0 * total


@dataclass(frozen=True)
class Rates:
    """Counts (cells, intervals, objects or metres) and their shares, 0 to 1.

    found : part of the reference that is in the result; None: equal to `right`. It differs where a
        tolerance matches one point of the result with several of the reference

    A share of nothing is NaN; without any result recall and F1 are still 0.
    """

    right: float   # part of the result that agrees with the reference
    false: float   # part of the result that does not
    missed: float   # part of the reference that is not in the result
    found: float | None = None

    @property
    def _found(self) -> float:
        return self.right if self.found is None else self.found

    @property
    def precision(self) -> float:
        """right / (right + false)"""
        return share_of(self.right, self.right + self.false)

    @property
    def recall(self) -> float:
        """found / (found + missed)"""
        return share_of(self._found, self._found + self.missed)

    @property
    def f1(self) -> float:
        """2 tp / (2 tp + fp + fn) where right = found, else the harmonic mean of precision and recall."""
        if not self.right + self.false + self._found + self.missed:
            return np.nan
        return f1_of(np.nan_to_num(self.precision), np.nan_to_num(self.recall))

    @property
    def iou(self) -> float:
        """Intersection over union: tp / (tp + fp + fn) = F1 / (2 - F1)."""
        return self.f1 / (2.0 - self.f1)


@dataclass(frozen=True)
class Errors:
    """Statistics of deviations, metres."""

    count: int   # number of points
    mean: float   # signed
    rmse: float   # root mean square
    p95: float   # p95, maximum: 95th percentile and maximum of the absolute deviations
    maximum: float

    @classmethod
    def of(cls, values: np.ndarray, weights: np.ndarray | None = None) -> Errors:
        """Errors of (N,) signed deviations with (N,) weights (lengths); non-finite deviations are ignored."""
        values = np.asarray(values, float)
        finite = np.isfinite(values)
        if not finite.any():
            return cls(0, np.nan, np.nan, np.nan, np.nan)
        values = values[finite]
        weights = np.ones(len(values)) if weights is None else np.asarray(weights, float)[finite]
        size = np.abs(values)
        order = np.argsort(size, kind="stable")
        reached = np.cumsum(weights[order]) / weights.sum()
        p95 = float(size[order][min(np.searchsorted(reached, 0.95), len(size) - 1)])
        mean = float(np.average(values, weights=weights))
        return cls(len(values), mean, float(np.sqrt(np.average(values**2, weights=weights))), p95, float(size.max()))


def share_of(part: float, whole: float) -> float:
    """A share, NaN of nothing."""
    return float(part / whole) if whole else np.nan
