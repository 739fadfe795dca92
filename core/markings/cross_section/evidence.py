"""What speaks for or against lanes beside lines and curbs: the drive, the road surface, hatching, arrows and stop lines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
from scipy.ndimage import binary_closing, median_filter

from ...execution.phase import Phase
from ...survey.store.records import COORDINATE_SCALE
from ...survey.store.section_store import STRETCH_POINTS
from .candidates import FAR, Candidates
from .sections import STATION_STEP

if TYPE_CHECKING:
    from ...survey.frame.road_frame import RoadFrame
    from ...survey.store.road_points import RoadPoints
    from ...survey.store.section_store import Stretch
    from ..objects.marking_objects import MarkingObjects

BIN = 0.2              # m across, of what is seen of the surface and of hatching
BINS = int(round(2 * FAR / BIN))
CARRIAGEWAY_DISTANCE = 40.0  # m between the tracks on two carriageways of one road at most
OWN_ROAD = 6.0         # m: what runs nearer is on this road
PASS_SPACING = 20      # stations, between the places of a pass at most
SECTIONS_ALIKE = 3   # sections of points whose median spacing is taken: one in which the road begins or ends holds fewer points
STOP_REACH = 5.0    # m before and after a stop line where its lanes are still its lanes

_known: WeakKeyDictionary[Any, dict[Any, Any]] = WeakKeyDictionary()   # stores of road points -> what `surface_coverage` found


@dataclass
class Evidence:
    """What is seen beside boundaries, by interval.

    driven : (P, I) m, offset of each pass, NaN where it was not; directions : (P,) 1 along, -1 against the road, 0 unknown
    asphalt, hatched : (I, B) share of each bin of BIN metres, from -FAR on, that is road surface or hatched; None where unknown
    arrows : (A, 3) interval, offset, and which way it points: 1 along the road, -1 against it, nearer 0 the less sure
    stops : (S, 3) interval, least and greatest offset
    divided : (I,) bool, whether the road is one carriageway of two
    taken : what an analyst took: interval, offset of the lane that it is taken for, and offset, width and direction of each lane instead
    """

    driven: np.ndarray
    directions: np.ndarray
    asphalt: np.ndarray | None
    hatched: np.ndarray | None
    arrows: np.ndarray
    stops: np.ndarray
    divided: np.ndarray
    taken: tuple[tuple[int, float, tuple[tuple[float, float, int], ...]], ...] = ()

    def part(self, first: int, end: int) -> Evidence:
        """That of the intervals from `first` to `end` (exclusive)."""
        def of(rows):
            return rows[(rows[:, 0] >= first) & (rows[:, 0] < end)] - [first, 0, 0]

        asphalt, hatched = (None if share is None else share[first:end] for share in (self.asphalt, self.hatched))
        return Evidence(self.driven[:, first:end], self.directions, asphalt, hatched, of(self.arrows), of(self.stops), self.divided[first:end])


def driven_offsets(frame: RoadFrame, road: int, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the vehicle drove.

    Parameters
    ----------
    frame : RoadFrame
    road : number of the road
    s : (K,) metres, stations

    Returns
    -------
    d : (P, K) metres, offset of every pass; NaN where it did not drive
    direction : (P,) int, 1 along the road's reference line, -1 against it; 0 where the drive was estimated and that is not known
    """
    passes = frame.passes_of(road)
    d = np.full((len(passes), len(s)), np.nan)
    for row, p in zip(d, passes):
        first, last = p.span
        there = (s >= first) & (s <= last)
        row[there] = p.at_station(s[there])[0]
    return d, np.array([p.direction if frame.way_known else 0 for p in passes], int)


def other_carriageway(frame: RoadFrame, road: int, s: np.ndarray) -> np.ndarray:
    """(K,) bool, whether another road of the survey was driven the other way beside this one: the two are carriageways of one road.

    Parameters
    ----------
    frame : RoadFrame
    road : number of the road
    s : (K,) metres, stations
    """
    found = np.zeros(len(s), bool)
    ways = {p.direction for p in frame.passes_of(road)}
    if len(ways) != 1 or not frame.way_known:
        return found
    of_road = frame.road(road)
    for p in frame.passes:
        if p.road == road or _apart(p, of_road) > CARRIAGEWAY_DISTANCE:
            continue
        station, d = of_road.locate(p.x, p.y, corridor=CARRIAGEWAY_DISTANCE)
        against = np.gradient(np.nan_to_num(station)) * next(iter(ways)) < 0
        beside = np.isfinite(station) & against & (np.abs(d) > OWN_ROAD)
        at = np.rint((station[beside] - s[0]) / STATION_STEP)
        at = at[(at >= 0) & (at < len(s))].astype(int)
        found[at] = True
    # the places of a pass are sparser than the stations
    return binary_closing(found, np.ones(2 * PASS_SPACING + 1, bool)) if len(found) else found


def _apart(p, road):
    """Metres east or north between the rectangles about a pass and a road, the greater of both; 0 or less where they overlap."""
    return max(max(a.min() - b.max(), b.min() - a.max()) for a, b in ((p.x, road.x), (p.y, road.y)))


def surface_coverage(points: RoadPoints, road: int, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the road surface was scanned, and where it ends; found once for points that are asked for again, as for lines and then for lanes.

    Parameters
    ----------
    points : RoadPoints
    road : number of the road
    s : (K,) metres, stations of a grid with steps of STATION_STEP

    Returns
    -------
    covered : (K, BINS) bool, whether there are road points in a cell of STATION_STEP by BIN metres; read-only
    ends : (2, K) metres, offsets of the left and the right end of the surface, NaN where unknown; read-only
    """
    count, first = len(s), int(np.floor(s[0] / STATION_STEP + 0.5))
    known, key = _known.setdefault(points.store, {}), (road, first, count, points.store.count)
    if key not in known:
        known[key] = _surface_coverage(points, road, first, count)
        for found in known[key]:
            found.flags.writeable = False
    return known[key]


def _surface_coverage(points, road, first, count):
    """The same for stations first to first + count of the grid."""
    covered = np.zeros((count, BINS), bool)
    total, number = np.zeros((2, count, 2))
    executor, length = points.executor, points.store.section_length
    phase = Phase(seen_in_stretch, points, (first, count), lambda item: points.survey.stretch(road, item[1] * length, item[2] * length))
    numbers = [one for one in points.roads() if one == road]
    stretches = points.store.stretches(STRETCH_POINTS if executor.folder else 0, numbers)
    for begin, *seen in (one for some in executor.run(phase, stretches) for one in some):
        own = slice(begin, begin + len(seen[0]))
        covered[own] |= seen[0]
        total[own] += seen[1]
        number[own] += seen[2]
    with np.errstate(invalid="ignore", divide="ignore"):
        ends = (1e-3 * total / number).T * np.array([[1.0], [-1.0]])
    return covered, ends


def point_spacing(road_points: RoadPoints, road: int, s: np.ndarray) -> np.ndarray:
    """Spacing of the road points at stations, the side of the square of surface that holds one of them.

    Parameters
    ----------
    road_points : RoadPoints
    road : number
    s : (K,) m, the grid stations of the road's lines

    Returns
    -------
    (K,) m; NaN where it is not known
    """
    numbers, length = np.array(road_points.sections(road)), road_points.store.section_length
    left, right = surface_coverage(road_points, road, s)[1]
    known = np.isfinite(left - right)
    if not len(numbers) or not known.any():
        return np.full(len(s), np.nan)
    middles = (numbers + 0.5) * length
    width = np.maximum(np.interp(middles, s[known], (left - right)[known]), 1.0)
    count = np.array([road_points.store.size(road, number) for number in numbers.tolist()])
    side = np.sqrt(width * length / np.maximum(count, 1))
    return np.interp(s, middles, median_filter(side, SECTIONS_ALIKE, mode="mirror"))


def seen_in_stretch(points: RoadPoints, stretch: Stretch, first: int, count: int) -> list[tuple[int, np.ndarray, np.ndarray, np.ndarray]]:
    """The phase that looks where the surface was scanned.

    Parameters
    ----------
    points : RoadPoints
    stretch : Stretch of a road
    first, count : stations first to first + count of the grid are looked at

    Returns
    -------
    of each section the first of the N stations that it shows, less `first`; (N, BINS) bool, the bins with points; (N, 2) sums of half widths (mm)
    and (N, 2) numbers of points on the left and on the right
    """
    return [_seen_in_section(points.section(*key).records, first, count) for key in points.store.in_stretch(stretch)]


def _seen_in_section(records, first, count):
    """What `seen_in_stretch` gives of one section."""
    step, wide, far = (int(round(length / COORDINATE_SCALE)) for length in (STATION_STEP, BIN, FAR))
    k, d = (records["s"] + step // 2) // step - first, records["d"]
    inside = (k >= 0) & (k < count) & (np.abs(d) < far)
    if not inside.any():
        return 0, np.zeros((0, BINS), bool), np.zeros((0, 2)), np.zeros((0, 2))
    half_width = records["half_width"]
    if not inside.all():
        k, d, half_width = k[inside], d[inside], half_width[inside]
    begin = int(k.min())
    k -= begin
    stations = int(k.max()) + 1
    covered = np.zeros((stations, BINS), bool)
    covered.reshape(-1)[k * BINS + (d + far) // wide] = True
    side = 2 * k + (d < 0)
    total, number = (np.bincount(side, weights, 2 * stations).reshape(-1, 2) for weights in (half_width, None))
    return begin, covered, total, number


def between_ends(ends: np.ndarray, likely: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same where only paint tells how far the surface reaches: everything between the ends that neighbouring paint knows.

    Parameters
    ----------
    ends : (2, K) metres, NaN where there is no paint
    likely : (2, K) metres, where it may end on a side that has no paint at all

    Returns
    -------
    covered : (K, BINS) bool; ends : (2, K) metres, filled along the road
    """
    rows = np.arange(ends.shape[1])
    filled = np.full(ends.shape, np.nan)
    for side, values in enumerate(ends):
        known = np.flatnonzero(np.isfinite(values))
        if len(known):
            filled[side] = np.interp(rows, known, values[known])
    left, right = np.where(np.isnan(filled), likely, filled)
    offsets = (np.arange(BINS) + 0.5) * BIN - FAR
    return (offsets < left[:, None]) & (offsets > right[:, None]), filled


def evidence_of(candidates: Candidates, s: np.ndarray, driven: np.ndarray, directions: np.ndarray, covered: np.ndarray | None = None,
                hatched: np.ndarray | None = None, arrows: np.ndarray | None = None, markings: MarkingObjects | None = None, road: int = 0,
                divided: np.ndarray | None = None) -> Evidence:
    """The Evidence of each interval, from what is known at each station.

    Parameters
    ----------
    candidates : Candidates
    s : (K,) metres
    driven, directions : as `driven_offsets` gives them
    covered, hatched : (K, BINS) bool, or None
    arrows : (A, 3) as `arrows_of` gives them, or None
    markings : MarkingObjects, of which stop lines count; or None
    road : number of the road
    divided : (K,) bool as `other_carriageway` gives it, or None
    """
    size = np.diff(np.r_[candidates.first, candidates.last[-1] + 1])

    def share(values):
        return None if values is None else np.add.reduceat(values.astype(np.float32), candidates.first, axis=0) / size[:, None]

    known = np.isfinite(driven)
    count = np.add.reduceat(known, candidates.first, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        where = np.where(2 * count >= size, np.add.reduceat(np.where(known, driven, 0.0), candidates.first, axis=1) / count, np.nan)
    stops = np.empty((0, 3)) if markings is None else _stop_lines(candidates, s, markings, road)
    return Evidence(where, directions, share(covered), share(hatched), _of_interval(candidates, s, arrows), stops,
                    np.zeros(len(size), bool) if divided is None else np.add.reduceat(divided, candidates.first) * 2 > size)


def _extents(markings, road, kind):
    found = markings.extent[(markings.road == road) & (markings.kind == kind)]
    return found[np.isfinite(found[:, 0])]


def _of_interval(candidates, s, arrows):
    """Arrows on the road with the interval in place of the station."""
    if arrows is None:
        return np.empty((0, 3))
    arrows = arrows[(arrows[:, 0] >= s[0]) & (arrows[:, 0] <= s[-1])]
    interval = np.searchsorted(s[candidates.first], arrows[:, 0], side="right") - 1
    return np.c_[interval.clip(0), arrows[:, 1:]]


def _stop_lines(candidates, s, markings, road):
    """(S, 3) interval, least and greatest offset of the stop lines on or near it."""
    begin, end = s[candidates.first], s[candidates.last]
    found = [(k, low, high) for first, last, low, high in _extents(markings, road, "stop")
             for k in np.flatnonzero((begin <= last + STOP_REACH) & (end >= first - STOP_REACH)).tolist()]
    return np.array(found).reshape(-1, 3)
