"""Paint points to markings: which points belong together, and what they are.

Conditional Euclidean clustering: two points belong together if they are near
each other, and the condition is that near is measured in the road's own way:
farther along the road, where scan lines lie apart and paint wears through, than
across it, where a decimetre may separate the two lines of a double line.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ...common.groups import linked_groups
from ...common.order_statistics import order_by
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...curves.robust import median
from ...execution.threads import THREADS
from ...survey.store.records import COORDINATE_SCALE, Points, join_columns
from .classify import (
    LINE_KINDS,
    MIN_COVERED_SHARE,
    NOT_PAINT,
    RIM_CLEARANCE,
    ROAD_EDGE_CLEARANCE,
    ClassSettings,
    classify_markings,
    relative_contrast,
    too_pale,
)
from .connected_cells import components, occupied
from .figures import painted_figures
from .marking_objects import make_marking_objects
from .outline import lifted
from .phases import ApartWork
from .road_grid import CELL_UNITS
from .scan_tracks import track_reach
from .shape import measure
from .split_merge import join_fragments, split_compounds
from .zebra import zebra_stripes

if TYPE_CHECKING:
    from ...execution.phase import Executor
    from ...survey.frame.road_frame import RoadFrame
    from ...survey.store.columns import Columns
    from ...survey.store.road_points import RoadPoints
    from .marking_objects import MarkingObjects
    from .shape import Shape

LINKING_WINDOW_CELLS = 1250                   # cells of 4 cm: 50 m of station are linked at a time
MIN_FRAGMENT_POINTS = 1                       # points: the smallest worn rest that a line may be joined from
STRIP_KINDS = LINE_KINDS + ("stop",)  # drawn as even strips, the others cell by cell
REACH_ALONG_FACTOR = 2.5                      # neighbours may be this times the distance apart along the road,
REACH_ACROSS_DIVISOR = 2.0                    # and across it the distance over this, or the reach between tracks of the scan


@dataclass(frozen=True)
class ClusterSettings:
    """How points join, and how small a marking may be.

    distance : m between points of one marking (twice as much along the road, half as much across it)
    min_points : fewer are no marking
    classes : when a cluster is a line
    """

    distance: float = setting(0.20, 0.02, 2.0, "The clustering distance", "m")
    min_points: int = setting(8, 1, 100000, "The least number of points of a marking")
    classes: ClassSettings = field(default_factory=ClassSettings)

    def __post_init__(self) -> None:
        check_limits(self)


def cluster_markings(marking_points: RoadPoints, frame: RoadFrame, settings: ClusterSettings = ClusterSettings(),
                     progress: Progress = Progress(), executor: Executor = THREADS) -> tuple[MarkingObjects, RoadPoints]:
    """Group paint points into markings with class, size and outline.

    Parameters
    ----------
    marking_points : RoadPoints on paint
    frame : RoadFrame
    settings : ClusterSettings
    progress : Progress
    executor : who looks for crossings, divides compound clusters and measures clusters

    Returns
    -------
    markings : MarkingObjects, one polygon a marking; one that wear or a shadow cut apart has
        several, with one `cluster` number
    clustered : RoadPoints with `cluster`, the number of the marking; 0 on what is no marking
    """
    rows, polygons = [], []
    clustered = replace(marking_points, store=marking_points.store.with_column("cluster"), has_cluster=True)
    number, refused = 0, 0
    roads = marking_points.roads()
    for k, road in enumerate(roads):
        part = progress.part(k / len(roads), (k + 1) / len(roads))
        work = ApartWork(executor, road)
        records, labels = connected_points(marking_points, road, settings.distance, part.part(0.0, 0.1))
        everything, cluster = records, np.zeros(len(records), np.int32)
        found, rest = _stripes_of_crossings(records, frame.road(road), work, part.part(0.1, 0.4))
        records, labels = records.take(rest), labels[rest]
        split = split_compounds(records, labels, partial(work.parts, progress=part.part(0.4, 0.5)))
        order, starts, _ = _by_cluster(split, MIN_FRAGMENT_POINTS)
        records = records.take(order)
        pieces = work.shapes(records, starts, part.part(0.5, 0.65))
        joins = join_fragments(pieces, settings.classes.max_width)
        again, starts, labels = _by_cluster(_relabelled(records, starts, joins), settings.min_points)
        records, order = records.take(again), rest[order[again]]
        bounds = list(zip(starts[:-1].tolist(), starts[1:].tolist()))
        alone = _alone(pieces, joins)
        some, ends = _some_clusters(records, [span for label, span in zip(labels.tolist(), bounds) if label not in alone])
        joined = iter(work.shapes(some, ends, part.part(0.65, 0.7)))
        shapes = [alone[label] if label in alone else next(joined) for label in labels.tolist()]
        half_width, hidden = records["half_width"].astype(float), records["covered"]
        half_widths = [median(half_width[a:b]) * 1e-3 for a, b in bounds]
        covered = [float(np.count_nonzero(hidden[a:b])) / (b - a) for a, b in bounds]
        kinds = classify_markings(shapes, half_widths, settings.classes, covered)
        clear = np.array(half_widths) - np.abs([shape.offset for shape in shapes]) > RIM_CLEARANCE
        possible = clear & (np.array(covered) <= MIN_COVERED_SHARE)
        if marking_points.has_corrected:
            bright = relative_contrast(Points(records).value, records["s"], starts)
            pale = [too_pale(share, kind) for share, (kind, _) in zip(bright.tolist(), kinds)]
            possible &= ~np.array(pale, bool)
            kinds = [(NOT_PAINT, "other") if faint else kind for faint, kind in zip(pale, kinds)]
        whole: list[tuple[tuple[int, ...], str, str]] = [((k,), *kind) for k, kind in enumerate(kinds)]
        for members, kind in painted_figures(shapes, [kind for kind, _ in kinds], possible, lambda some: _cells_together(records, bounds, some)):
            for k in members:
                whole[k] = ((), NOT_PAINT, "other")
            whole[members[0]] = (members, kind, "other")
        refused += sum(kind == NOT_PAINT for members, kind, _ in whole if members)
        for members, kind, use in whole:
            if kind != NOT_PAINT:
                of_it = _rows_of(bounds, members)
                shape = shapes[members[0]] if len(members) == 1 else measure(*(records[name][of_it] for name in ("s", "d", "spacing")))
                found.append(_Marking(records[of_it], order[of_it], shape, kind, use))
        found.sort(key=lambda marking: (marking.shape.s0, marking.shape.d0, marking.shape.s1))
        for marking, drawn in zip(found, _outlines(found, everything, frame.road(road), work, part.part(0.7, 1.0))):
            number += 1
            cluster[marking.rows] = number
            polygons += drawn
            rows += [_row(marking, number, road, frame)] * len(drawn)
        _put(clustered.store, road, cluster, marking_points)
    progress.info(f"Markings: {number} found; {refused} clusters were left out as gutters, seams, covers, specks or the feet of what "
                 "stands on the road.")
    return make_marking_objects(rows, polygons, frame, marking_points.crs), clustered


class _Marking(NamedTuple):
    """Records of a marking and their rows in those of the road; its outline in local coordinates where that is known already."""

    records: Columns
    rows: np.ndarray
    shape: Shape
    kind: str
    use: str
    outline: shapely.Polygon | None = None


def _some_clusters(records, spans):
    """The records of some clusters, of which the rows are given, one after the other, and their bounds."""
    rows = np.concatenate([np.empty(0, np.intp), *(np.arange(a, b) for a, b in spans)])
    return records.take(rows), np.cumsum([0, *(b - a for a, b in spans)])


def _stripes_of_crossings(records, road, work, progress):
    """[_Marking] the stripes of crossings, and the rows of all other records."""
    cells, member = occupied(records["x"] // CELL_UNITS, records["y"] // CELL_UNITS)
    station = np.zeros(len(cells))
    station[member] = records["s"] * COORDINATE_SCALE
    places = (cells + 0.5) * CELL_UNITS * COORDINATE_SCALE
    stripes = zebra_stripes(places, road.heading(station), lambda windows: work.combs(places, windows, progress))
    stripe_of, found = np.full(len(cells), -1), []
    for k, stripe in enumerate(stripes):
        stripe_of[stripe.spots] = k
    of_point = stripe_of[member]
    for k, stripe in enumerate(stripes):
        rows = np.flatnonzero(of_point == k)
        if len(rows):
            own = records.take(rows)
            length, width = (float(np.hypot(*(stripe.corners[j] - stripe.corners[j - 1]))) for j in (1, 2))
            shape = replace(measure(own["s"], own["d"], own["spacing"]), length=length, width=width)
            found.append(_Marking(own, rows, shape, "zebra", "other", shapely.Polygon(stripe.corners)))
    return found, np.flatnonzero(of_point < 0)


def _put(store, road, cluster, points):
    """Clusters of all points of a road, by station, into their sections."""
    first = 0
    for section in points.sections(road):
        count = len(points.section(road, section))
        store.put(road, section, cluster[first:first + count])
        first += count


def _rows_of(bounds, members):
    """The rows of some clusters: a slice of one, else their numbers."""
    return slice(*bounds[members[0]]) if len(members) == 1 else np.concatenate([np.arange(*bounds[k]) for k in members])


def _cells_together(records, bounds, members):
    """(K, 2) different cells of some clusters together, and (K,) m that the tracks of the scan lie apart there."""
    own = records[_rows_of(bounds, members)]
    cells, member = occupied(own["s"] // CELL_UNITS, own["d"] // CELL_UNITS)
    reach = np.zeros(len(cells))
    reach[member] = track_reach(own["spacing"])
    return cells, reach


def _alone(pieces, joins):
    """The pieces that were joined to no other, by the number of their marking."""
    count = np.bincount(joins, minlength=1)
    return {number: piece for number, piece in zip(joins.tolist(), pieces) if count[number] == 1}


def _relabelled(records, starts, number):
    """Label of every record after joining; records of no cluster get labels of their own."""
    labels = np.repeat(number, np.diff(starts))
    rest = len(records) - len(labels)
    return np.r_[labels, len(number) + np.arange(rest)]


def connected_points(marking_points: RoadPoints, road: int, distance: float, progress: Progress = Progress()) -> tuple[Columns, np.ndarray]:
    """Connected components of the points of one road.

    Returns
    -------
    records : Columns of the N points of the road
    labels : (N,) int component of each; its numbering follows station

    Notes
    -----
    Points of one 4 cm cell are one member, at their mean place: points of dense
    paint would otherwise have hundreds of neighbours each. Cells are fixed
    in station, and windows are joined through the cells they share, so neither
    window nor section length shows in the result.
    """
    start, end = marking_points.store.span(road)
    reach = int(np.ceil(distance * REACH_ALONG_FACTOR / (CELL_UNITS * COORDINATE_SCALE))) + 1
    records, labels, links = [], [], []
    shared_cells, shared_labels, count = np.empty((0, 2), np.int64), np.empty(0, np.int64), 0
    first_window, last_window = (int(np.floor(s / COORDINATE_SCALE / CELL_UNITS / LINKING_WINDOW_CELLS)) for s in (start, end))

    def linked(window):
        first, last = window * LINKING_WINDOW_CELLS, (window + 1) * LINKING_WINDOW_CELLS
        bounds = (row * CELL_UNITS * COORDINATE_SCALE for row in (first - 1, last + reach + 1))
        found = marking_points.window(road, *bounds).records
        column = found["s"] // CELL_UNITS
        found = found[(column >= first) & (column < last + reach)]
        cells, member, component = _components(found, distance)
        own = found["s"] // CELL_UNITS < last
        return cells, component, cells[:, 0] >= last, found[own], member[own]

    for cells, component, beyond, found, member in ordered_map(linked, range(first_window, last_window + 1), progress):
        component = component + count
        count = component.max(initial=count - 1) + 1
        links.append(_shared(shared_cells, shared_labels, cells, component))
        shared_cells, shared_labels = cells[beyond], component[beyond]
        records.append(found)
        labels.append(component[member])
    if not records:
        return join_columns([], marking_points.store.dtype), np.empty(0, np.int64)
    pairs = np.concatenate(links)
    merged = linked_groups(pairs[:, 0], pairs[:, 1], count)
    labels = np.concatenate(labels)
    return join_columns(records, marking_points.store.dtype), merged[labels] if len(labels) else labels


def _components(records, distance):
    """Occupied cells, the cell of each point, and the component of each cell."""
    cells, member = occupied(records["s"] // CELL_UNITS, records["d"] // CELL_UNITS)
    size = np.bincount(member, minlength=len(cells))
    # sums of integers are the same in any order
    s, d = (np.bincount(member, records[name], len(cells)) for name in ("s", "d"))
    places = np.stack([s / size / REACH_ALONG_FACTOR, d / size * REACH_ACROSS_DIVISOR], axis=1) * COORDINATE_SCALE
    size_of_cell = CELL_UNITS * COORDINATE_SCALE / REACH_ALONG_FACTOR, CELL_UNITS * COORDINATE_SCALE * REACH_ACROSS_DIVISOR
    found = components(cells, places, size_of_cell, distance)
    reach = np.zeros(len(cells))
    reach[member] = track_reach(records["spacing"])
    at_rim = np.zeros(len(cells), bool)
    at_rim[member[records["half_width"] * 1e-3 - np.abs(records["d"]) * COORDINATE_SCALE < ROAD_EDGE_CLEARANCE]] = True
    pairs = _across_tracks(places / [distance, REACH_ACROSS_DIVISOR], reach, at_rim)
    if len(pairs):
        found = linked_groups(*found[pairs].T, int(found.max()) + 1)[found]
    return cells, member, found


def _across_tracks(places, reach, at_rim):
    """(P, 2) cells on neighbouring tracks of the scan, where these lie farther apart than points that join anyway.

    places : (K, 2) along the road in units of the reach there, across it in metres
    reach : (K,) m across the road
    at_rim : (K,) bool, at the very edge of the road, where it is the curb that is bright: the next track may show an edge line
    """
    rows = np.flatnonzero(reach)
    if not len(rows):
        return np.empty((0, 2), np.int64)
    widest = reach[rows].max()
    pairs = rows[cKDTree(places[rows] / [1.0, widest]).query_pairs(1.0, output_type="ndarray").reshape(-1, 2)]
    along, across = (places[pairs[:, 0]] - places[pairs[:, 1]]).T
    near = along**2 + (across / reach[pairs].min(axis=1)) ** 2 <= 1.0
    return pairs[near & (at_rim[pairs[:, 0]] == at_rim[pairs[:, 1]])]


def _shared(cells, labels, others, other_labels):
    """(K, 2) labels that two windows gave to the same cells."""
    if not len(cells) or not len(others):
        return np.empty((0, 2), np.int64)
    low = min(cells[:, 1].min(), others[:, 1].min())
    width = max(cells[:, 1].max(), others[:, 1].max()) - low + 1
    keys, other_keys = (c[:, 0] * width + c[:, 1] - low for c in (cells, others))
    _, a, b = np.intersect1d(keys, other_keys, assume_unique=True, return_indices=True)
    return np.c_[labels[a], other_labels[b]]


def _by_cluster(labels, fewest):
    """Points of clusters large enough, one cluster after the other; those of the rest at the end.

    Returns their order, the bounds of the clusters in it (one more than there are clusters), and the label of each.
    """
    if not len(labels):
        return np.empty(0, np.intp), np.zeros(1, np.int64), np.empty(0, np.int32)
    labels = labels.astype(np.int32, copy=False)
    large = (np.bincount(labels) >= fewest)[labels]
    order = order_by(labels, ~large)
    labels = labels[order[:np.count_nonzero(large)]]
    starts = np.flatnonzero(np.r_[True, labels[1:] != labels[:-1]]) if len(labels) else np.empty(0, np.int64)
    return order, np.r_[starts, len(labels)], labels[starts]


def _outlines(markings, records, road, work, progress):
    """[Polygon] in local coordinates of each marking, from the road's start on; records : of the road."""
    unknown = [marking for marking in markings if marking.outline is None]
    looks = [(marking.shape, marking.kind in STRIP_KINDS) for marking in unknown]
    drawn = iter(work.outlines(records, [marking.rows for marking in unknown], looks, road, progress))
    return [next(drawn) if marking.outline is None else [lifted(marking.outline, _places(marking.records))] for marking in markings]


def _places(records):
    return np.stack([records["x"], records["y"], records["z"]], axis=1) * COORDINATE_SCALE


def _row(marking, number, road, frame):
    """The fields of one marking."""
    shape = marking.shape
    return dict(road=int(road), cluster=number, use=marking.use, station_m=shape.s0, offset_m=shape.offset, length_m=shape.length,
                width_m=shape.width, elongation=shape.elongation, scan_m=_scanning_distance(marking.records, frame),
                points=shape.points, **{"class": marking.kind})


def _scanning_distance(records, frame):
    """Median distance across the road from the track that scanned the marking."""
    numbers, along, across = (records[name] for name in ("pass_number", "s", "d"))
    away = np.empty(len(records))
    for number in numbers[:1] if (numbers == numbers[0]).all() else np.unique(numbers):
        rows = np.flatnonzero(numbers == number)
        track = frame.passes[number].at_station(along[rows] * COORDINATE_SCALE)[0]
        away[rows] = np.abs(across[rows] * COORDINATE_SCALE - track)
    return median(away)
