"""What speaks for or against lanes beside lines and curbs: the drive, the road surface, hatched areas, arrows and stop lines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import shapely
from scipy.ndimage import grey_closing, median_filter

from ...common.arrays import mask_runs
from ...countries.catalogue import NEUTRAL
from ...road.surface.extract import SurfaceSettings
from ...survey.frame.placement import located
from ...survey.frame.road_frame import RoadFrame
from ...survey.frame.row_table import RowTable
from ...survey.store.records import BIN, BINS, FAR
from ...survey.store.road_points import RoadPoints
from ..objects.classify import LINE_KINDS
from ..objects.marking_objects import MarkingObjects
from ..road_grid import CELL_SIZE
from ..weights import EVIDENCE, LANES, SECTIONS
from .candidates import Candidates
from .sections import STATION_STEP
from .weights import BARE, UNPAINTED

_known: WeakKeyDictionary[Any, tuple[int, Any]] = WeakKeyDictionary()   # stores of road points -> their number, and what `seen_surface` told of them


@dataclass
class Evidence:
    """What is seen beside boundaries, by interval.

    taken : what an analyst took: interval, offset of the lane that it is taken for, and offset, width and direction of each lane instead
    """

    driven: np.ndarray   # (P, I) m, offset of each pass, NaN where it was not; the road's own first
    directions: np.ndarray   # (P,) 1 along, -1 against the road, 0 unknown
    asphalt: np.ndarray | None   # (I, B) share of each bin of BIN metres, from -FAR on, that is road surface or hatched; None where unknown
    hatched: np.ndarray | None
    arrows: np.ndarray   # (A, 3) interval, offset, and which way it points: 1 along the road, -1 against it, nearer 0 the less sure
    stops: np.ndarray   # (S, 4) interval, least and greatest offset, and how far ahead along the road the stop line lies, m, less than 0 behind
    divided: np.ndarray   # (I,) bool, whether the road is one carriageway of two
    bare: np.ndarray   # (I,) bool, where it was driven between two borders without any paint
    own: int | None = None   # how many of the passes are the road's own; None for all
    taken: tuple[tuple[int, float, tuple[tuple[float, float, int], ...]], ...] = ()

    @property
    def again_one_way(self) -> np.ndarray:
        """(I,) bool, where the road's own passes drove more than once, and all of them the same way."""
        driven = np.isfinite(self.driven[:self.own])
        number = driven.sum(axis=0)
        return (number > 1) & (np.abs(self.directions[:self.own] @ driven) == number)

    def part(self, first: int, end: int) -> Evidence:
        """That of the intervals from `first` to `end` (exclusive)."""
        def of(rows):
            return rows[(rows[:, 0] >= first) & (rows[:, 0] < end)] - np.append(first, np.zeros(rows.shape[1] - 1))

        asphalt, hatched = (None if share is None else share[first:end] for share in (self.asphalt, self.hatched))
        return Evidence(self.driven[:, first:end], self.directions, asphalt, hatched, of(self.arrows), of(self.stops), self.divided[first:end],
                        self.bare[first:end], self.own)


def driven_offsets(frame: RoadFrame, road: int, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(P, K) m, offset of every pass at (K,) stations, NaN where it did not drive, and (P,) its direction along the road's reference line.

    The direction is 1 or -1; 0 where the drive was estimated and that is not known.
    """
    passes = frame.passes_of(road)
    d = np.full((len(passes), len(s)), np.nan)
    for row, p in zip(d, passes):
        first, last = p.span
        on_pass = (s >= first) & (s <= last)
        row[on_pass] = p.at_station(s[on_pass])[0]
    return d, np.array([p.direction if frame.way_known else 0 for p in passes], int)


def offsets_of_others(frame: RoadFrame, road: int, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same of the passes of other roads, each as far as it was driven along this road, one way: (Q, K) m and (Q,)."""
    of_road, offsets, directions = frame.road(road), [], []
    for p in frame.passes if frame.way_known and len(s) else ():
        if p.road == road or _apart(p, of_road) > EVIDENCE.carriageway_distance:
            continue
        station, d = of_road.locate(p.x, p.y, corridor=EVIDENCE.carriageway_distance)
        ahead, aside = (np.gradient(np.nan_to_num(values)) for values in (station, d))
        for way in (1, -1):
            along = np.flatnonzero(np.isfinite(station) & (ahead * way > np.abs(aside) / EVIDENCE.along))
            if len(along) < 2:
                continue
            at = along[np.argsort(station[along])]
            near = np.searchsorted(station[at], s).clip(1, len(at) - 1)
            known = np.minimum(np.abs(station[at][near] - s), np.abs(station[at][near - 1] - s)) <= EVIDENCE.pass_spacing * STATION_STEP
            offsets.append(np.where(known, np.interp(s, station[at], d[at]), np.nan))
            directions.append(way)
    return np.array(offsets).reshape(-1, len(s)), np.array(directions, int)


def _apart(p, road):
    """Metres east or north between the rectangles about a pass and a road, the greater of both; 0 or less where they overlap."""
    return max(max(a.min() - b.max(), b.min() - a.max()) for a, b in ((p.x, road.x), (p.y, road.y)))


def surface_coverage(points: RoadPoints, road: int, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the road surface was scanned, and where it ends; points that are asked for again, as for lines and then for lanes, are read once.

    s : (K,) metres, stations of a grid with steps of STATION_STEP

    Returns
        covered : (K, BINS) bool, whether there are road points in a cell of STATION_STEP by BIN metres
        ends : (2, K) metres, offsets of the left and the right end of the surface, NaN where unknown
    """
    first, count, held = int(np.floor(s[0] / STATION_STEP + 0.5)), len(s), points.store.count
    if _known.get(points.store, (None, None))[0] != held:
        _known[points.store] = held, points.seen_surface()
    covered = np.zeros((count, BINS), bool)
    total, number = np.zeros((2, count, 2))
    for begin, *sums in _known[points.store][1].get(road, ()):
        a, b = max(begin, first), min(begin + len(sums[0]), first + count)
        if a < b:
            covered[a - first:b - first] |= sums[0][a - begin:b - begin]
            for values, of_section in zip((total, number), sums[1:]):
                values[a - first:b - first] += of_section[a - begin:b - begin]
    with np.errstate(invalid="ignore", divide="ignore"):
        ends = (1e-3 * total / number).T * np.array([[1.0], [-1.0]])
    return covered, ends


def point_spacing(road_points: RoadPoints, road: int, s: np.ndarray) -> np.ndarray:
    """(K,) m, the side of the square of surface that holds one road point, at (K,) stations; NaN where it is not known."""
    numbers, length = np.array(road_points.sections(road)), road_points.store.section_length
    left, right = surface_coverage(road_points, road, s)[1]
    finite = np.isfinite(left - right)
    if not len(numbers) or not finite.any():
        return np.full(len(s), np.nan)
    middles = (numbers + 0.5) * length
    width = np.maximum(np.interp(middles, s[finite], (left - right)[finite]), 1.0)
    count = np.array([road_points.store.size(road, number) for number in numbers.tolist()])
    side = np.sqrt(width * length / np.maximum(count, 1))
    return np.interp(s, middles, median_filter(side, EVIDENCE.sections_alike, mode="mirror"))


def between_ends(ends: np.ndarray, likely: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same where only paint tells how far the surface reaches: everything between the ends that neighbouring paint knows.

    `ends` : (2, K) m, NaN where there is no paint; `likely` : (2, K) m, where it may end on a side that has no paint at all. Returns (K, BINS) bool
    and the (2, K) ends, filled along the road.
    """
    rows = np.arange(ends.shape[1])
    filled = np.full(ends.shape, np.nan)
    for side, values in enumerate(ends):
        finite = np.flatnonzero(np.isfinite(values))
        if len(finite):
            filled[side] = np.interp(rows, finite, values[finite])
    left, right = np.where(np.isnan(filled), likely, filled)
    offsets = (np.arange(BINS) + 0.5) * BIN - FAR
    return (offsets < left[:, None]) & (offsets > right[:, None]), filled


def evidence_of(candidates: Candidates, s: np.ndarray, driven: np.ndarray, directions: np.ndarray, covered: np.ndarray | None = None,
                hatched: np.ndarray | None = None, arrows: np.ndarray | None = None, markings: MarkingObjects | None = None, road: int = 0,
                of_road: int | None = None, bare: np.ndarray | None = None) -> Evidence:
    """The Evidence of each interval, from what is known at each station.

    driven, directions : as `driven_offsets` gives them, and behind the passes `of_road` those of other roads; bare : (K,) bool as in Evidence
    covered, hatched : (K, BINS) bool; arrows : (A, 3) as `arrows_of` gives them; markings : of which stop lines count; each may be None
    """
    size = np.diff(np.r_[candidates.first, candidates.last[-1] + 1])

    def share(values):
        return None if values is None else np.add.reduceat(values.astype(np.float32), candidates.first, axis=0) / size[:, None]

    driven_there = np.isfinite(driven)
    count = np.add.reduceat(driven_there, candidates.first, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        offsets = np.where(2 * count >= size, np.add.reduceat(np.where(driven_there, driven, 0.0), candidates.first, axis=1) / count, np.nan)
    stops = np.empty((0, 4)) if markings is None else _stop_lines(candidates, s, markings, road)
    without_paint = np.zeros(len(size), bool) if bare is None else np.add.reduceat(bare, candidates.first) * 2 > size
    return Evidence(offsets, directions, share(covered), share(hatched), _of_interval(candidates, s, arrows), stops,
                    _divided(candidates, offsets, directions, of_road), without_paint, of_road)


def _divided(candidates, offsets, directions, of_road):
    """(I,) bool, whether another road was driven the other way beyond the end of this one: both are carriageways of one road.

    Where the surface ends so far away that it is looked at no farther, the road may go on.
    """
    ends = candidates.valid & UNPAINTED[candidates.made_of] & (candidates.made_of != BARE)
    ends &= np.abs(candidates.left) < SurfaceSettings.max_width - NEUTRAL.narrowest_lane
    oncoming = _oncoming(offsets, directions, of_road)
    with np.errstate(invalid="ignore"):   # NaN where it was not driven
        return (ends & (candidates.left * np.sign(oncoming) > 0) & (np.abs(candidates.left) < np.abs(oncoming))).any(axis=(0, 2))


def _oncoming(offsets, directions, of_road):
    """(P, I, 1) m, offsets of the passes of other roads that were driven the other way than this one; NaN where they drove elsewhere or on it."""
    other = offsets[of_road:][~np.isin(directions[of_road:], directions[:of_road]) & (len(set(directions[:of_road].tolist())) == 1)]
    return np.where(np.abs(other) > EVIDENCE.own_road, other, np.nan)[..., None]


def beside_median(evidence: Evidence, of_road: int) -> np.ndarray:
    """(I,) bool, whether another road was driven the other way beside this one, and the asphalt ends before the middle between both drives.

    evidence : its asphalt measured by road points, each of which is of the road driven nearer; of_road : how many of its passes are of this road
    """
    oncoming, middles = _oncoming(evidence.driven, evidence.directions, of_road), (np.arange(BINS) + 0.5) * BIN - FAR
    with np.errstate(invalid="ignore"):   # NaN where it was not driven
        between = (middles * np.sign(oncoming) > 0) & (np.abs(middles) < np.abs(oncoming) / 2)
    return ((between & (np.asarray(evidence.asphalt) < 0.5)).sum(axis=2) * BIN > EVIDENCE.median).any(axis=0)


def _of_interval(c, s, arrows):
    """Arrows on the road with the interval in place of the station, as far from the boundaries beside them as they lie where these are on average."""
    if arrows is None:
        return np.empty((0, 3))
    arrows = arrows[(arrows[:, 0] >= s[0]) & (arrows[:, 0] <= s[-1])]
    intervals = (np.searchsorted(s[c.first], arrows[:, 0], side="right") - 1).clip(0)
    share = (arrows[:, 0] - s[c.first[intervals]]) / np.maximum(s[c.last[intervals]] - s[c.first[intervals]], STATION_STEP)
    moved = [np.interp(-d, -c.left[k][c.valid[k]], c.drift[k][c.valid[k]] @ (1 - part, part))
             for k, d, part in zip(intervals.tolist(), arrows[:, 1].tolist(), share.tolist())]
    return np.c_[intervals, arrows[:, 1] - np.array(moved), arrows[:, 2]]


def _stop_lines(candidates, s, markings, road):
    """`Evidence.stops` of the stop lines on a road, for the intervals from which lanes may lead to them."""
    begin, end = s[candidates.first], s[candidates.last]
    stops, extents = [], markings.extent[(markings.road == road) & (markings.kind == "stop")]
    for first, last, low, high in extents[np.isfinite(extents[:, 0])]:
        ahead = np.maximum(first - end, 0.0) - np.maximum(begin - last, 0.0)
        # its lanes lead up to it from where most of the lines beside and between them end, dashes up to a gap before it
        near = np.flatnonzero(np.abs(ahead) <= SECTIONS.max_dash_gap)
        between = (candidates.left[near] > low - LANES.stop_margin) & (candidates.right[near] < high + LANES.stop_margin)
        lines = (candidates.painted[near] & between).sum(axis=1)
        if lines.any():
            ahead -= ahead[near[np.lexsort((np.abs(ahead[near]), -lines))[0]]]
        stops += [(k, low, high, ahead[k]) for k in np.flatnonzero(np.abs(ahead) <= EVIDENCE.approach).tolist()]
    return np.array(stops).reshape(-1, 4)


# Hatched areas: where nobody drives, and the borders that bound the lanes beside.

OUTSIDE_PAINT = CELL_SIZE / 2   # derived: m: outlines are of whole cells, of which paint reaches into the outermost ones by half on average


def hatched_places(borders: RowTable) -> np.ndarray | None:
    """(K, BINS) bool, what lies in hatched areas, of which `borders_of_hatching` gives the borders; None where there are none."""
    if not len(borders):
        return None
    result, offsets = np.zeros((borders.spans.stations, BINS), bool), (np.arange(BINS) + 0.5) * BIN - FAR
    for row in range(0, len(borders), 2):
        left, right = borders.row(row)[:, None], borders.row(row + 1)[:, None]
        result[borders.spans.first[row]:borders.spans.end[row]] |= (offsets < left) & (offsets > right)
    return result


def borders_of_hatching(markings: MarkingObjects, frame: RoadFrame, road: int, s: np.ndarray) -> RowTable:
    """RowTable (2 G, K) of m, the left and the right border of each of G hatched areas, NaN where it is not.

    Nobody drives between them, and they bound the lanes beside. A border is the middle of the line that is painted along the ends of the bars; where
    there is none, the ends themselves.
    """
    on_road = markings.road == road
    bars, lines = ([shape for shape in shapely.force_2d(markings.outlines.polygons()[on_road & kind]) if not shape.is_empty]
                   for kind in (markings.kind == "hatch", np.isin(markings.kind.astype(str), LINE_KINDS)))
    areas = shapely.get_parts(shapely.union_all(shapely.buffer(bars, EVIDENCE.bar_reach))) if bars else np.empty(0, object)
    bars_of, lines_of = _meeting(areas, bars), _meeting(areas, lines)
    borders_found = []
    for k in range(len(areas)):
        first, reach = _reach([bars[j] for j in bars_of[k]], frame, road, s)
        finite = np.flatnonzero(np.isfinite(reach[0]))
        if not len(finite) or np.ptp(finite) * STATION_STEP < EVIDENCE.shortest_area:
            continue
        borders = np.empty(reach.shape)
        for side, sign in enumerate((1.0, -1.0)):
            # bars touch the border only at their ends
            outer = grey_closing(np.where(np.isfinite(reach[side]), sign * reach[side], -FAR),
                                 size=int(2 * EVIDENCE.bar_reach / STATION_STEP) + 1, mode="nearest")
            borders[side] = sign * np.where(outer > -FAR, outer - OUTSIDE_PAINT - EVIDENCE.half_border, np.nan)
        for begin, reached in (_reach([lines[j]], frame, road, s) for j in lines_of[k]):
            low, high = max(begin, first), min(begin + reached.shape[1], first + reach.shape[1])
            if low < high:
                _follow(borders[:, low - first:high - first], reached.mean(axis=0)[low - begin:high - begin])
        borders_found += [(first, border) for border in borders]
    return RowTable.of_rows(borders_found, len(s))


def hatched_areas(markings: MarkingObjects, frame: RoadFrame, road: int) -> list[np.ndarray]:
    """(V, 2) outlines, by station and offset in m, of the hatched areas of a road, from border to border as of `borders_of_hatching`."""
    ends = markings.extent[(markings.road == road) & (markings.kind == "hatch"), :2]
    if not len(ends := ends[np.isfinite(ends[:, 0])]):
        return []
    s = np.arange(ends.min(), ends.max() + STATION_STEP, STATION_STEP)
    borders = borders_of_hatching(markings, frame, road, s)
    result = []
    for k in range(0, len(borders), 2):
        left, right = (np.c_[s[borders.spans.first[k]:borders.spans.end[k]], borders.row(row)] for row in (k, k + 1))
        result += [np.r_[left[first:end], right[first:end][::-1]] for first, end in mask_runs(np.isfinite(left + right)[:, 1]) if end > first + 1]
    return result


def _meeting(areas, shapes):
    """For each area the numbers of the shapes that meet it, ascending."""
    numbers: list[list[int]] = [[] for _ in areas]
    if len(areas) and shapes:
        for shape, area in sorted(zip(*shapely.STRtree(areas).query(shapes, predicate="intersects").tolist())):
            numbers[area].append(shape)
    return numbers


def _reach(shapes, frame, road, s):
    """Greatest and least offset of outlines, (2, N) m, from a first station on that is given; NaN at stations where there are none."""
    x, y = shapely.get_coordinates(shapely.segmentize(shapes, EVIDENCE.outline_spacing)).T
    station, d = located(frame, np.full(len(x), road), x, y)
    indices = np.rint((station - s[0]) / STATION_STEP)
    inside = np.isfinite(indices) & (indices >= 0) & (indices < len(s))
    if not inside.any():
        return 0, np.empty((2, 0))
    indices, d = indices[inside].astype(int), d[inside]
    first = int(indices.min())
    result = np.repeat([[-np.inf], [np.inf]], int(indices.max()) - first + 1, axis=1)
    np.maximum.at(result[0], indices - first, d)
    np.minimum.at(result[1], indices - first, d)
    return first, np.where(np.isfinite(result), result, np.nan)


def _follow(borders, middle):
    """Put borders on the middle of a line that runs along them, (N,) m at the same stations."""
    with np.errstate(invalid="ignore"):
        close = np.abs(borders - middle) < EVIDENCE.border_line_reach
    for border, follows in zip(borders, close):
        border[follows] = middle[follows]
