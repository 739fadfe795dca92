"""The estimate of lines and lanes for all roads of a survey: the side of traffic is one for all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import shapely

from ...common.arrays import mask_runs
from ...common.progress import Progress
from ...countries.catalogue import NEUTRAL
from ...countries.traffic_side import side_of_traffic
from ...execution.phase import THREADS
from ...io.crs import horizontal_part, parse_crs, place_on_ground
from ...road.edges.road_edges import RoadEdges
from ...survey.frame.placement import located
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.road_points import RoadPoints
from ..objects.marking_objects import MarkingObjects
from ..weights import ROADS
from .beside import lanes_beside
from .candidates import Boundaries, boundary_candidates, gather_boundaries
from .estimate import RoadEstimate, estimates_of_roads
from .evidence import (
    beside_median,
    between_ends,
    borders_of_hatching,
    driven_offsets,
    evidence_of,
    hatched_places,
    offsets_of_others,
    surface_coverage,
)
from .sections import STATION_STEP, CrossSections, EdgeSections, no_lines, sections_of_lines
from .sequence import lane_strips
from .weights import PAVEMENT, EstimateWeights, TakenReading

if TYPE_CHECKING:
    from ..lines.painted_lines import PaintedLines


@dataclass
class EstimatedRoad:
    """One road: its lines on a grid of stations, everything that may bound lanes, and the estimate."""

    lines: CrossSections
    boundaries: Boundaries
    estimate: RoadEstimate


@dataclass
class RoadEstimates:
    """All roads of a survey."""

    roads: dict[int, EstimatedRoad]   # {number: EstimatedRoad}
    side: str   # "right" or "left"
    sure: bool   # whether the survey shows that
    lane_width: float   # metres, usual
    against_arrows: bool   # whether the survey was driven against the arrows in its lanes


def estimate_roads(painted: PaintedLines, frame: RoadFrame, usual_width: float, side: str = "automatic",
                   edges: RoadEdges | EdgeSections | None = None, markings: MarkingObjects | None = None,
                   road_points: RoadPoints | None = None, paint: RoadPoints | None = None, width_asked: bool = False,
                   weights: EstimateWeights = EstimateWeights(), progress: Progress = Progress(),
                   taken: Sequence[TakenReading] = ()) -> RoadEstimates:
    """Estimate lines and lanes.

    usual_width : metres, of lanes where the lines do not tell
    side : "right", "left" or "automatic"
    edges, markings : what else the estimate is made from, or None
    road_points : RoadPoints or None; paint : points of markings, which serve where there are no road points, or None
    width_asked : whether `usual_width` is the user's own
    taken : second readings that an analyst took
    """
    curbs, pavement = EdgeSections.of(edges)
    lines, bare = _between_borders_too(sections_of_lines(painted), frame, curbs or {}, pavement)
    drives = {number: driven_offsets(frame, number, of_road.s) for number, of_road in lines.items()}
    arrows, against = _arrows_and_drive(markings, frame, lines, drives, side == "automatic", weights)
    if width_asked:
        weights = replace(weights, width_sigma=weights.width_sigma_asked, other_width=0.0, odd_width=weights.odd_width_asked)
    evidence = {}
    for k, (number, of_road) in enumerate(lines.items()):
        beside = [(sections or {}).get(number) for sections in (curbs, pavement)]
        evidence[number] = _evidence_of_road(of_road, number, frame, beside, (road_points, paint), markings, arrows.get(number), drives[number],
                                             usual_width, weights, taken, bare[number])
        progress.report(0.4 * (k + 1) / len(lines))
    sides = {"right": (-1,), "left": (1,)}.get(side, (-1, 1))
    executor = THREADS if road_points is None else road_points.executor
    estimates = _estimates(evidence, sides, usual_width, weights, executor, progress.part(0.4, 0.7))
    best, behind, opposite = _best_side(estimates, usual_side(frame), weights)
    used = tuple(first for first in sides if first == best or behind < ROADS.sure_side or opposite < weights.doubt)
    width, shown = (usual_width, True) if width_asked else _usual_width(evidence, estimates[best], usual_width)
    # the road's own width tells lanes better than that of a country
    if width != usual_width:
        estimates = _estimates(evidence, used, width, weights, executor, progress.part(0.7, 1.0), shown)
    roads = {}
    for number, estimate in estimates[best].items():
        if len(used) > 1:
            other_side = estimates[-best][number]
            estimate = replace(estimate, other=other_side if behind < ROADS.sure_side else None, behind=behind, opposite=other_side,
                               opposite_behind=opposite)
        roads[number] = EstimatedRoad(lines[number], evidence[number][0], estimate)
    return RoadEstimates(roads, "right" if best < 0 else "left", behind >= ROADS.sure_side, width, against)


def _between_borders_too(lines, frame, curbs, pavement):
    """The lines of each road on stations as far as it was driven between two borders too, and where that is without any paint, (K,) bool each."""
    result, bare = {}, {}
    for number in sorted({*lines, *curbs, *pavement}):
        of_road = lines.get(number, no_lines())
        edges = [sections for sections in (curbs.get(number), pavement.get(number)) if sections is not None]
        painted = np.rint(of_road.s[np.unique(of_road.d.spans.station[np.isfinite(of_road.d.values)])] / STATION_STEP)
        free = [_driven_bare(p, edges, painted) for p in frame.passes_of(number)]
        stations = np.concatenate([of_road.s, *(s for both in free for s in both)])
        if not len(stations):
            continue
        first, count = stations.min(), int(np.rint(np.ptp(stations) / STATION_STEP)) + 1
        by = int(np.rint((first - of_road.s[0]) / STATION_STEP)) if len(of_road.s) else 0
        tables = {name: getattr(of_road, name).shifted(by, count) for name in ("d", "z", "seen", "drawn", "number", "width")}
        result[number] = replace(of_road, s=first + STATION_STEP * np.arange(count), **tables)
        bare[number] = np.zeros(count, bool)
        for s, _ in free:
            bare[number][np.rint((s - first) / STATION_STEP).astype(int)] = True
    return result, bare


def _driven_bare(p, edges, painted):
    """(N,) and (M,) m, stations without paint that a pass drove between two borders: of long stretches, and of what is left beyond the paint's ends.

    `painted` : the numbers of the stations with paint.
    """
    s = STATION_STEP * np.arange(np.ceil(p.span[0] / STATION_STEP), np.floor(p.span[1] / STATION_STEP) + 1)
    track, sides = p.at_station(s)[0], np.zeros((2, len(s)), bool)
    for sections in edges:
        d = sections.d.shifted(int(np.rint((s[0] - sections.s[0]) / STATION_STEP)), len(s))
        along = np.array([kind != "island" for kind in sections.kinds], bool)[d.spans.owner]
        across = d.values - track[d.spans.station]
        for side, there in zip(sides, (across > 0, across < 0)):
            side[d.spans.station[there & along]] = True
    bare = sides.all(axis=0) & ~np.isin(np.rint(s / STATION_STEP), painted)
    reach = painted[[0, -1]] * STATION_STEP + ROADS.shortest_bare * np.array([-1, 1]) if len(painted) else np.zeros(2)
    return (np.concatenate([np.empty(0), *(s[first:end] for first, end in mask_runs(bare) if (end - first) * STATION_STEP >= ROADS.shortest_bare)]),
            s[sides.any(axis=0) & (s > reach[0]) & (s < reach[1])])


def _arrows_and_drive(markings, frame, lines, drives, automatic, weights):
    """The arrows of each road, turned where the survey was driven against them, and whether it was: which lanes lead alike they tell even then."""
    arrows = {number: arrows_of(markings, frame, number) for number in lines} if markings is not None else {}
    against = automatic and weights.arrow_against * sum(
        driven_against(of_road, lines[number].s, *drives[number]) for number, of_road in arrows.items()) > weights.against_arrows
    return {number: of_road * (1, 1, -1) for number, of_road in arrows.items()} if against else arrows, against


def _evidence_of_road(of_road, number, frame, edges, points, markings, arrows, driven, usual_width, weights, taken, bare):
    """Boundaries, Candidates and Evidence of one road; `edges` with and without a curb, `points` of the road and of paint, each may be None."""
    s, likely, (curbs, pavement) = of_road.s, _likely_ends(of_road, usual_width), edges
    road_points, paint = points
    if road_points is not None:
        covered, ends = surface_coverage(road_points, number, s)
    else:   # paint tells how far the surface reaches
        covered, ends = (None, None) if paint is None else between_ends(surface_coverage(paint, number, s)[1], likely)
    open_ends = likely if ends is None else np.where(np.isnan(ends).all(1, keepdims=True), likely, np.nan)
    borders = None if markings is None else borders_of_hatching(markings, frame, number, s)
    hatched = None if borders is None else hatched_places(borders)
    boundaries = gather_boundaries(of_road, curbs, ends, open_ends, borders, pavement)
    candidates = boundary_candidates(boundaries, weights)
    seen = [np.concatenate(parts) for parts in zip(driven, offsets_of_others(frame, number, s))]
    evidence = evidence_of(candidates, s, *seen, covered, hatched, arrows, markings, number, len(driven[1]), bare)
    divided = evidence.divided if road_points is None else evidence.divided | beside_median(evidence, len(driven[1]))
    return boundaries, candidates, replace(evidence, divided=divided, taken=_taken_on(taken, number, candidates, s))


def usual_side(frame: RoadFrame) -> str:
    """"right" or "left", the side of traffic of the country where the survey lies; "" where that is not known."""
    crs = horizontal_part(parse_crs(frame.crs))
    if crs is None or not crs.is_projected:
        return ""
    place = place_on_ground(crs, float(frame.origin[0]), float(frame.origin[1]))
    return side_of_traffic(place.longitude, place.latitude)


def _best_side(estimates, usual, weights):
    """The most probable side of traffic, and by how many nats the other is behind, once and as a second reading.

    What is seen again and again along a road was laid out and driven once.
    """
    if len(estimates) == 1:
        return next(iter(estimates)), np.inf, np.inf
    prior = {"left": -weights.foreign_side, "right": weights.foreign_side}.get(usual, weights.left_hand)
    # nats by which traffic on the left is behind
    total, once = (prior + sum((getattr(left, name) - getattr(estimates[-1][number], name)) * min(
        1.0, weights.repeats / max(float(left.candidates.length.sum()), 1.0)) for number, left in estimates[1].items())
        for name in ("total", "once_total"))
    best = 1 if total < 0 else -1
    return best, max(-best * once, 0.0), abs(total)


def _taken_on(taken, number, candidates, s):
    """`Evidence.taken` of a road: each reading in the intervals whose middle it reaches over."""
    middle = (s[candidates.first] + s[candidates.last]) / 2
    result = []
    for reading in taken:
        if reading.road == number:
            inside = np.flatnonzero((middle >= reading.s[0]) & (middle <= reading.s[-1]))
            for interval, d in zip(inside.tolist(), np.interp(middle[inside], reading.s, reading.d).tolist()):
                result.append((interval, d, tuple((d + offset, width, way) for offset, width, way in reading.lanes)))
    return tuple(result)


def _likely_ends(lines, width):
    """(2, K) metres, where the road would end beyond the outermost lines if it had one more lane there."""
    ends = np.full((2, len(lines.s)), np.nan)
    np.fmax.at(ends[0], lines.d.spans.station, lines.d.values)
    np.fmin.at(ends[1], lines.d.spans.station, lines.d.values)
    return ends + np.array([[width], [-width]])


def _estimates(known, sides, width, weights, executor, progress, shown=False):
    """{side of traffic: {number of the road: RoadEstimate}}; `shown` : whether lines of the survey show the width."""
    widths = {number: replace(candidates, beside=lanes_beside(candidates, evidence, width, shown, weights))
              for number, (_, candidates, evidence) in known.items()}
    results = estimates_of_roads([(widths[number], evidence, first, int(np.rint(boundaries.s[0] / STATION_STEP)))
                                  for first in sides for number, (boundaries, _, evidence) in known.items()], width, weights, executor, progress)
    return {first: {number: next(results) for number in known} for first in sides}


def _usual_width(known, estimates, usual):
    """Median width of lanes between painted lines, or between one and the edge of the pavement, and whether these show it.

    In whole millimetres: a line that moves a little somewhere on a long road moves no lane elsewhere.
    """
    widths, lengths = [], []
    for number, estimate in estimates.items():
        c, strips = known[number][1], lane_strips(estimate.sections.chosen(estimate.choice))
        left, right = ((strips.interval, side) for side in (strips.left, strips.right))
        painted, edge = (np.stack([of[left], of[right]]) for of in (c.painted, c.made_of == PAVEMENT))
        width, shown = (c.right[left] - c.left[right]) / strips.number, (painted | edge).all(axis=0)
        # beside the edge of the pavement a lane may be narrower than the strip
        widths += np.where(painted.all(axis=0), width, np.minimum(width, usual))[shown].tolist()
        lengths += c.length[strips.interval][shown].tolist()
    if not lengths:
        return usual, False
    widths, lengths = np.append(widths, usual), np.append(lengths, ROADS.length_of_usual)
    order = np.argsort(widths)
    total = np.cumsum(lengths[order])
    middle = float(widths[order[int(np.searchsorted(total, total[-1] / 2))]])
    mean = (middle * sum(lengths[:-1]) + usual * ROADS.length_of_usual) / sum(lengths)
    return round(mean, 3), sum(lengths[:-1]) > ROADS.length_of_usual


# Arrows on the road: in which lane they lie and which way they point.

SHORTEST_ARROW = 2.0   # source: m along the road, of a lane of a road (Convention on Road Signs and Signals, Vienna 1968, annex 2, 39)
SLICES = 50   # derived: of an arrow from end to end, whose breadth is taken


def arrows_of(markings: MarkingObjects, frame: RoadFrame, road: int) -> np.ndarray:
    """(A, 3) station and offset of the middle of arrows, m, and which way they point: 1 along the road, -1 against it, nearer 0 the less that shows.

    An arrow begins with a bare shaft and soon is broad behind its tip, so it points to the end at which less of it is a single stroke. That
    is read from the painted outline alone. Shorter arrows than a lane of a road has belong to cycle paths or are none.
    """
    rows = np.flatnonzero((markings.road == road) & (markings.kind == "arrow") & np.isfinite(markings.extent[:, 0]))
    if not len(rows):
        return np.empty((0, 3))
    # the parts that wear left of an arrow are one arrow
    cluster = markings.cluster[rows]
    _, of = np.unique(np.where(cluster >= 0, cluster, -2 - np.arange(len(rows))), return_inverse=True)
    parts = shapely.force_2d(markings.outlines.polygons()[rows])
    parts = shapely.transform(parts, lambda places: np.column_stack(located(frame, np.full(len(places), road), *places.T)))
    places, owner = shapely.get_coordinates(parts, return_index=True)
    # some may lie beyond what the road reaches
    complete = np.bincount(owner, ~np.isfinite(places).all(axis=1), minlength=len(rows)) == 0
    arrows = np.array([shapely.union_all(shapely.make_valid(parts[complete & (of == k)])) for k in np.unique(of[complete])], object)
    first, low, last, high = shapely.bounds(arrows).T
    arrows, first, low, last, high = (values[last - first >= SHORTEST_ARROW - ROADS.worn_ends] for values in (arrows, first, low, last, high))
    begin, finish = stems(arrows)
    way = np.clip((begin - finish) / ROADS.sure_lean, -1, 1) * (np.minimum(begin, finish) > ROADS.pointed)
    return np.c_[(first + last) / 2, (low + high) / 2, way]


def driven_against(arrows: np.ndarray, s: np.ndarray, driven: np.ndarray, directions: np.ndarray) -> float:
    """How many arrows point against those who drove over them, less those that point along with them, each as far as it surely points.

    `arrows` : (A, 3) as `arrows_of` gives them; `driven`, `directions` : as `driven_offsets` gives them at (K,) stations in order.
    """
    if not len(arrows) or not len(s):
        return 0.0
    stations = np.searchsorted(s, arrows[:, 0]).clip(0, len(s) - 1)
    with np.errstate(invalid="ignore"):
        over = np.abs(driven[:, stations] - arrows[:, 1]) < NEUTRAL.narrowest_lane / 2
    return -float((over * directions[:, None] * arrows[:, 2]).sum())


def stems(shapes: np.ndarray) -> np.ndarray:
    """(2, A) shares of the length of polygons in (s, d) that are a single stroke: from the first station on, and from the last one back."""
    first, _, last, _ = shapely.bounds(shapes).T
    parts, shape_of = shapely.get_parts(shapes, return_index=True)
    rings, part_of = shapely.get_rings(parts, return_index=True)
    places, ring = shapely.get_coordinates(rings, return_index=True)
    shape = shape_of[part_of[ring]]
    # slices lie at whole numbers along a shape
    along = (places[:, 0] - first[shape]) * (SLICES / (last - first)[shape]) - 0.5
    edge = np.flatnonzero(ring[1:] == ring[:-1])
    begin, end = np.ceil([np.minimum(along[edge], along[edge + 1]), np.maximum(along[edge], along[edge + 1])]).astype(int)
    edge, cut = np.repeat(edge, end - begin), np.arange((end - begin).sum()) + np.repeat(begin - np.cumsum(end - begin) + end - begin, end - begin)
    across = places[edge, 1] + np.diff(places[:, 1])[edge] * (cut - along[edge]) / np.diff(along)[edge]
    left, right = np.full((len(shapes), SLICES), -np.inf), np.full((len(shapes), SLICES), np.inf)
    np.maximum.at(left, (shape[edge], cut), across)
    np.minimum.at(right, (shape[edge], cut), across)
    broad = left - right > ROADS.shaft_breadth
    bare = np.stack([np.argmax(broad, axis=1), np.argmax(broad[:, ::-1], axis=1)]) / SLICES
    return np.where(broad.any(axis=1), bare, 0.0)
