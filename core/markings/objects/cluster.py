"""Paint points to markings: which points belong together, and what they are (conditional Euclidean clustering in the road frame)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import shapely

from ...common.arrays import members_of, order_by
from ...common.parallel import check_cancelled
from ...common.progress import Progress
from ...common.setting import Limited, setting
from ...curves.robust import median
from ...execution.in_step import Asked, Work, in_step
from ...execution.phase import THREADS, Executor, Items, NoSource, Phase
from ...execution.weights import EXECUTION
from ...survey.frame.road import Road
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE, Points
from ...survey.store.road_points import RoadPoints, columns_of_roads
from ..road_grid import CELL_UNITS, occupied, track_reach
from ..weights import CLASSES, ROWS, SHAPES
from .classify import LINE_KINDS, NOT_PAINT, ClassSettings, classify_markings, filled, relative_contrast, too_pale
from .figures import painted_figures
from .grouping import connected_points
from .marking_objects import MarkingObjects, make_marking_objects
from .repeating import (
    Comb,
    Crossing,
    Stripe,
    blocks_of_strip,
    comb_of_window,
    crossings_of,
    give_way_blocks,
    spots_by_place,
    stripes_of_crossings,
)
from .shape import Shape, drawn_outline, measure, smallest_rectangle
from .split_merge import are_compound, join_fragments, parts_of_compound

STRIP_KINDS = LINE_KINDS + ("stop",)  # drawn as even strips, the others cell by cell
# of a point of paint that clustering looks at
PAINT_COLUMNS = ("x", "y", "z", "s", "d", "intensity", "corrected", "pass_number", "half_width", "covered", "spacing")


@dataclass(frozen=True)
class ClusterSettings(Limited):
    """How points join, and how small a marking may be.

    distance : m between points of one marking (twice as much along the road, half as much across it)
    """

    distance: float = setting(0.20, 0.02, 2.0, "The clustering distance", "m")
    min_points: int = setting(8, 1, 100000, "The least number of points of a marking")
    classes: ClassSettings = field(default_factory=ClassSettings)


def cluster_markings(marking_points: RoadPoints, frame: RoadFrame, settings: ClusterSettings = ClusterSettings(),
                     progress: Progress = Progress(), executor: Executor = THREADS) -> tuple[MarkingObjects, RoadPoints]:
    """Group road points on paint into markings with class, size and outline.

    executor : who links points, looks for crossings and divides compound clusters

    Returns
        markings : MarkingObjects, one polygon a marking; one that wear or a shadow cut apart has several, with one `cluster` number
        clustered : RoadPoints with `cluster`, the number of the marking; 0 on what is no marking
    """
    clustered = replace(marking_points, store=marking_points.store.with_column("cluster"), has_cluster=True)
    roads = marking_points.roads()
    lines = [frame.road(road) for road in roads]
    executor = marking_points.store.readers(executor)
    paint = [columns_of_roads(marking_points.store, [road], PAINT_COLUMNS) for road in roads]
    connected, *striped = in_step([connected_points(marking_points, settings.distance), *map(_striped, paint, lines)], executor,
                                  progress.part(0.0, 0.4))
    counts = [len(labels) for labels in connected]
    works = [_apart(*of_road, settings) for of_road in zip(paint, connected, striped)]
    # the labels of the points of all roads are in memory as long as anybody has them
    del connected, striped
    apart = in_step(works, executor, progress.part(0.4, 0.7))
    blocks = _blocks_of_all([pieces for _, pieces in apart])
    named = in_step([_markings(stripes, pieces, of_road, k, lines, settings, marking_points.has_corrected)
                     for k, ((stripes, pieces), of_road) in enumerate(zip(apart, blocks))], executor, progress.part(0.7, 1.0))
    rows, polygons = [], []
    cluster = [np.zeros(count, np.int32) for count in counts]
    number = 0
    for k, (line, (markings, outlines, _)) in enumerate(zip(lines, named)):
        for marking, drawn, scanned in zip(markings, outlines, _scanning_distances(paint[k], markings, line, frame)):
            number += 1
            check_cancelled()
            cluster[k][marking.rows] = number
            polygons += drawn
            shape = marking.shape
            rows += [dict(road=int(line.number), cluster=number, use="keep" if marking.kind in LINE_KINDS else "other", station_m=shape.s0,
                          offset_m=shape.offset, length_m=shape.length, width_m=shape.width, elongation=shape.elongation, scan_m=scanned,
                          points=shape.points, **{"class": marking.kind})] * len(drawn)
    for road, numbers in zip(roads, cluster):
        _put(clustered.store, road, numbers, marking_points)
    refused = sum(without for _, _, without in named)
    progress.info(f"Markings: {number} found; {refused} clusters were left out as gutters, seams, covers, specks or the feet of what "
                 "stands on the road.")
    return make_marking_objects(rows, polygons, frame, marking_points.crs), clustered


class _Pieces(NamedTuple):
    """Clusters of one road but for the stripes of crossings, before it is known what they are."""

    paint: Columns   # all points of paint of the road
    records: Columns   # those of the clusters, one after the other, and their rows in the paint
    order: np.ndarray
    bounds: list[tuple[int, int]]   # first and end row of each cluster in the records, and its Shape
    shapes: list[Shape]


def _striped(records: Columns, road: Road) -> Work:
    """The work on one road that finds the stripes of its crossings, [Stripe], and (N,) int32 the number of the stripe of each point, else -1."""
    cells, member = occupied(records["x"] // CELL_UNITS, records["y"] // CELL_UNITS)
    station = np.zeros(len(cells))
    station[member] = records["s"] * COORDINATE_SCALE
    places, way = (cells + 0.5) * CELL_UNITS * COORDINATE_SCALE, road.heading(station)
    del cells, station
    spots, windows = spots_by_place(places)
    crossings = crossings_of(spots, windows, (yield asked(combs_of_windows, partial(_at, (places,)), windows, 0.7)))
    del spots, windows
    striped = yield asked(_zebra_stripes, partial(_at, (places, way)), [rows for rows, _ in crossings], 1.0, [together for _, together in crossings])
    stripes = [replace(stripe, spots=rows[stripe.spots]) for (rows, _), of_them in zip(crossings, striped) for stripe in of_them]
    stripe_of = np.full(len(places), -1, np.int32)
    for k, stripe in enumerate(stripes):
        stripe_of[stripe.spots] = k
    return stripes, stripe_of[member]


def _apart(records: Columns, labels: np.ndarray, striped: tuple[list[Stripe], np.ndarray], settings: ClusterSettings) -> Work:
    """The work on one road that gives the stripes of its crossings as [_Marking], and its _Pieces.

    Stripes are set apart, compound clusters divided, and what wear has parted is joined.

    labels, striped : as of `connected_points` and `_striped`
    """
    stripes, of_point = striped
    members, rows = list(members_of(of_point)), np.flatnonzero(of_point < 0)
    paint, labels = records.take(rows), labels[rows]
    split, pieces, of_stripes = yield from _divided(paint, _with_rows_divided(paint, labels), records, [of_stripe for _, of_stripe in members])
    joins = join_fragments(pieces, settings.classes.max_width)
    order, starts, _ = _by_cluster(split, 1)
    # points of no cluster get labels of their own
    labels = np.r_[np.repeat(joins, np.diff(starts)), len(joins) + np.arange(len(paint) - starts[-1])]
    again, starts, labels = _by_cluster(labels, settings.min_points)
    order = rows[order[again]]
    clusters, bounds = records.take(order), list(zip(starts[:-1].tolist(), starts[1:].tolist()))
    count = np.bincount(joins, minlength=1)
    unjoined = {number: piece for number, piece in zip(joins.tolist(), pieces) if count[number] == 1}
    joined = [order[slice(*ends)] for label, ends in zip(labels.tolist(), bounds) if label not in unjoined]
    measured = iter((yield asked(pieces_of_clusters, partial(_columns_at, records, MEASURED), joined, 1.0, [False] * len(joined))))
    shapes = [unjoined[label] if label in unjoined else next(measured)[1][0] for label in labels.tolist()]
    return _stripe_markings(stripes, members, of_stripes), _Pieces(records, clusters, order, bounds, shapes)


def _divided(paint, labels, records, stripes):
    """Part of a work: (N,) labels in which parts of compound clusters have labels of their own, and the Shape of each cluster in their order.

    Also the Shape of each of the stripes, rows of the records.
    """
    order = order_by(labels)
    starts = np.flatnonzero(np.diff(labels[order], prepend=-1))
    columns = tuple(paint[name].take(order) for name in MEASURED)
    compound = [*are_compound(*columns[:2], starts).tolist(), *(False for _ in stripes)]
    ends = np.r_[starts, len(order) + np.cumsum([0, *map(len, stripes)])]
    clusters = [np.arange(*pair) for pair in zip(ends, ends[1:])]
    columns = tuple(map(np.append, columns, _columns_at(records, MEASURED, np.concatenate([np.empty(0, np.intp), *stripes]))))
    divided = yield asked(pieces_of_clusters, partial(_at, columns), clusters, 0.7, compound)
    labels, following = labels.copy(), int(labels.max(initial=-1)) + 1
    alone, of_parts = [], []
    for rows, (parts, shapes) in zip(clusters[:len(starts)], divided):
        if parts is None:
            alone += shapes
        else:
            labels[order[rows]] = following + parts
            following += len(shapes)
            of_parts += shapes
    return labels, alone + of_parts, [shape for _, (shape,) in divided[len(starts):]]


def _stripe_markings(stripes, striped, shapes):
    """[_Marking] of stripes of crossings, with points of each and its Shape."""
    markings = []
    for (k, rows), shape in zip(striped, shapes):
        corners = stripes[k].corners
        length, width = (float(np.hypot(*(corners[j] - corners[j - 1]))) for j in (1, 2))
        markings.append(_Marking(rows, replace(shape, length=length, width=width), "zebra", corners))
    return markings


def _blocks_of_all(pieces_by_road):
    """Of each road (N,) bool, which clusters are blocks of give-way lines: a row of them may lie on several roads, and oblique to them."""
    shapes = [shape for pieces in pieces_by_road for shape in pieces.shapes]
    sides, middles = np.split(np.array([shape.rectangle for shape in shapes]).reshape(-1, 4), 2, axis=1)
    blocks = give_way_blocks(filled(shapes), sides, middles)
    return np.split(blocks, np.cumsum([len(pieces.shapes) for pieces in pieces_by_road])[:-1]) if pieces_by_road else []


def _with_rows_divided(records, labels):
    """Labels of clusters, rows of the blocks of give-way lines divided into these."""
    order = order_by(labels)
    starts = np.flatnonzero(np.diff(labels[order], prepend=-1))
    along, across = ((np.maximum.reduceat(values, starts).astype(np.int64) - np.minimum.reduceat(values, starts)) * COORDINATE_SCALE
                     for values in (records[name].take(order) for name in "sd"))
    labels, following = labels.copy(), int(labels.max(initial=-1)) + 1
    for k in np.flatnonzero((along >= ROWS.row_of_blocks[0]) & (along <= ROWS.row_of_blocks[1]) & (across >= ROWS.block_size[0])
                            & (across <= ROWS.block_size[1] + ROWS.max_row_slope * along)).tolist():
        members = order[starts[k]:starts[k + 1] if k + 1 < len(starts) else None]
        cells, member = occupied(*(records[name].take(members) // CELL_UNITS for name in "xy"))
        if (blocks := blocks_of_strip(cells)) is not None:
            labels[members] = following + blocks[member]
            following += int(blocks.max()) + 1
    return labels


def _markings(stripes: list[_Marking], pieces: _Pieces, blocks: np.ndarray, number: int, roads: Sequence[Road], settings: ClusterSettings,
              has_corrected: bool) -> Work:
    """The work on the road of a number among all that gives its [_Marking] from its start on, [Polygon] of each, and how many clusters are none.

    stripes : of crossings; blocks : (N,) bool, which pieces are blocks of give-way lines
    """
    records, bounds, shapes = pieces.records.unread(), pieces.bounds, pieces.shapes
    half_width, hidden = records["half_width"], records["covered"]
    half_widths = [median(half_width[a:b].astype(float)) * 1e-3 for a, b in bounds]
    covered = [float(np.count_nonzero(hidden[a:b])) / (b - a) for a, b in bounds]
    kinds = classify_markings(shapes, half_widths, settings.classes, covered, blocks)
    clear = np.array(half_widths) - np.abs([shape.offset for shape in shapes]) > CLASSES.rim_clearance
    possible = clear & (np.array(covered) <= CLASSES.min_covered_share)
    if has_corrected:
        bright = relative_contrast(Points(records).value, records["s"], np.array([0, *(b for _, b in bounds)]))
        pale = [too_pale(share, kind) for share, kind in zip(bright.tolist(), kinds)]
        possible &= ~np.array(pale, bool)
        kinds = [NOT_PAINT if faint else kind for faint, kind in zip(pale, kinds)]
    classes: list[tuple[tuple[int, ...], str]] = [((k,), kind) for k, kind in enumerate(kinds)]
    for members, kind in (yield from painted_figures(shapes, kinds, possible, lambda group: _cells_together(records, bounds, group))):
        for k in members:
            classes[k] = ((), NOT_PAINT)
        classes[members[0]] = (members, kind)
    # the columns that told kinds of markings are not used any more
    markings, records = [*stripes], records.unread()
    for members, kind in classes:
        if kind != NOT_PAINT:
            check_cancelled()
            of_it = _rows_of(bounds, members)
            shape = shapes[members[0]] if len(members) == 1 else measure(*(records[name][of_it] for name in ("s", "d", "spacing")))
            markings.append(_Marking(pieces.order[of_it], shape, kind))
    markings = sorted(markings, key=lambda marking: (marking.shape.s0, marking.shape.d0, marking.shape.s1))
    drawn = yield asked(outlines_of_markings, lambda rows: (number, *_columns_at(pieces.paint, DRAWN, rows)), [marking.rows for marking in markings],
                        1.0, [marking.shape if marking.kind in STRIP_KINDS else marking.corners for marking in markings], (list(roads),), _polygons)
    return markings, drawn, sum(kind == NOT_PAINT for members, kind in classes if members)


class _Marking(NamedTuple):
    """Rows of a marking in the paint of its road; of a stripe of a crossing its (4, 2) corners in local coordinates are known already."""

    rows: np.ndarray
    shape: Shape
    kind: str
    corners: np.ndarray | None = None


def _put(store, road, cluster, points):
    """Clusters of all points of a road, by station, into their sections."""
    first = 0
    for section in points.sections(road):
        count = len(points.section(road, section))
        store.put(road, section, Columns({"cluster": cluster[first:first + count]}, store.dtype))
        first += count


def _rows_of(bounds, members):
    """The rows of some clusters: a slice of one, else their numbers."""
    return slice(*bounds[members[0]]) if len(members) == 1 else np.concatenate([np.arange(*bounds[k]) for k in members])


def _cells_together(records, bounds, members):
    """(K, 2) different cells of some clusters together, and (K,) m that the tracks of the scan lie apart there."""
    points = records[_rows_of(bounds, members)]
    cells, member = occupied(points["s"] // CELL_UNITS, points["d"] // CELL_UNITS)
    reach = np.zeros(len(cells))
    reach[member] = track_reach(points["spacing"])
    return cells, reach


def _by_cluster(labels, fewest):
    """Points of clusters large enough, one cluster after the other; those of the rest at the end.

    Returns their order, the bounds of the clusters in it (one more than there are clusters), and the label of each.
    """
    labels = labels.astype(np.int32, copy=False)
    large = (np.bincount(labels) >= fewest)[labels]
    order = order_by(labels, ~large)
    labels = labels[order[:np.count_nonzero(large)]]
    starts = np.flatnonzero(np.diff(labels, prepend=-1))
    return order, np.r_[starts, len(labels)], labels[starts]


def _scanning_distances(paint, markings, line, frame):
    """Of each marking of a road the median distance across it from the track that scanned the marking."""
    bounds = np.cumsum([0, *(len(marking.rows) for marking in markings)]).tolist()
    records = paint.take(np.concatenate([np.empty(0, np.intp), *(marking.rows for marking in markings)]))
    numbers, distance = records["pass_number"], np.empty(len(records))
    for number in np.unique(numbers).tolist():
        rows, driven = np.flatnonzero(numbers == number), frame.passes[number]
        s, d = (records[name][rows] * COORDINATE_SCALE for name in "sd")
        if driven.road != line.number:
            # what another road's pass scanned lies in the frame of that road, too
            s, d = frame.road(driven.road).locate(*(records[name][rows] * COORDINATE_SCALE for name in "xy"))
        distance[rows] = np.abs(d - driven.at_station(s)[0])
    return [median(distance[a:b]) for a, b in zip(bounds, bounds[1:])]


# The phases: what is computed of some clusters or windows apart from all others; their items hold the columns that they need.

MEASURED = "s", "d", "spacing", "x", "y"   # columns of points, in 0.1 mm and mm, by which a cluster is measured
DRAWN = "s", "d", "x", "y", "z", "spacing"   # by which a marking is drawn
TASK_POINTS = 5_000   # derived: of paint in an item on average, of which a worker process is given four together: a tenth of a second of its time


def combs_of_windows(source: NoSource, item: tuple[np.ndarray, np.ndarray]) -> list[Comb | None]:
    """The phase that looks for stripes of crossings; item : (N, 2) m spots of windows one after the other, and the bounds of the windows."""
    return [comb_of_window(spots) for spots, in _clusters(item)]


def _zebra_stripes(source: NoSource, item: tuple[np.ndarray, np.ndarray, np.ndarray, list[list[Crossing]]]) -> list[list[Stripe]]:
    """The phase that finds the stripes of crossings.

    `item` : (N, 2) m spots about crossings one after the other, (N,) radians of the road there, the bounds of spots that some crossings share, and
    these crossings.
    """
    *columns, crossings = item
    return [stripes_of_crossings(places, way, together) for (places, way), together in zip(_clusters(columns), crossings)]


def pieces_of_clusters(source: NoSource, item: tuple[Any, ...]) -> list[tuple[np.ndarray | None, list[Shape]]]:
    """The phase that divides compound clusters and measures all.

    `item` : columns MEASURED of the points, the bounds of the clusters, and whether each may be compound. Returns of each the (N,) part of every
    point, from 0 on, None of a single one, and the Shape of each part.
    """
    *columns, compound = item
    return [_pieces_of_cluster(cluster, divisible) for cluster, divisible in zip(_clusters(columns), compound)]


def _pieces_of_cluster(columns, divisible):
    """What `pieces_of_clusters` gives of one."""
    parts = parts_of_compound(*columns[:3]) if divisible else None
    if parts is None or not parts.any():
        return None, [_measured(*columns)]
    return parts, [_measured(*_at(columns, rows)) for _, rows in members_of(parts)]


def _measured(s, d, spacing, x, y):
    """The Shape of a cluster; if it is small, with its `rectangle`."""
    shape = measure(s, d, spacing)
    if max(shape.sides) > SHAPES.small_marking_size:
        return shape
    middle = [(int(values.min()) + int(values.max())) / 2 * COORDINATE_SCALE for values in (x, y)]
    return replace(shape, rectangle=(*smallest_rectangle(occupied(x // CELL_UNITS, y // CELL_UNITS)[0]), *middle))


def outlines_of_markings(source: NoSource, item: tuple[Any, ...], roads: Sequence[Road]) -> tuple[np.ndarray, ...]:
    """The phase that draws markings.

    `item` : the number of the road, columns DRAWN of the points, the bounds of the markings, and the look of each as of `drawn_outline`. Returns
    (V, 3) local m, first vertex of each ring, first ring of each polygon, each with the end, and the number of polygons of each marking.
    """
    number, *columns, looks = item
    drawn = [drawn_outline(cluster, look, roads[number]) for cluster, look in zip(_clusters(columns), looks)]
    polygons = [polygon for outline in drawn for polygon in outline]
    _, vertices, starts = shapely.to_ragged_array(polygons, include_z=True) if polygons else (None, np.empty((0, 3)), (np.zeros(1, int),) * 2)
    return vertices, *starts, np.array([len(outline) for outline in drawn])


def _clusters(item):
    *columns, bounds = item
    for first, end in zip(bounds[:-1].tolist(), bounds[1:].tolist()):
        check_cancelled()
        yield [column[first:end] for column in columns]


def asked(function: Callable[..., Any], columns: Callable[[np.ndarray], tuple[Any, ...]], rows: Sequence[np.ndarray], until: float,
          looks: Sequence[Any] | None = None, arguments: tuple[Any, ...] = (), read: Callable[[Any], list[Any]] = list) -> Asked:
    """Asks a phase about clusters, some in each item.

    columns : gives those that the phase takes of points at some rows; rows : of the points of each cluster
    looks : what else the phase takes of each cluster; until, arguments, read : as of Asked
    """
    together, bounds = np.concatenate([np.empty(0, np.intp), *rows]), np.cumsum([0, *map(len, rows)])
    cuts = _lasting_cuts(bounds, TASK_POINTS).tolist()

    def item(k):
        a, b = cuts[k:k + 2]
        return *columns(together[bounds[a]:bounds[b]]), bounds[a:b + 1] - bounds[a], *([] if looks is None else [list(looks[a:b])])

    phase = Phase(function, NoSource(), arguments, lambda item: "the markings of all roads", together=EXECUTION.items_per_task)
    return Asked(phase, Items(len(cuts) - 1, item), until, read=read)


def _lasting_cuts(bounds, points):
    """Ascending numbers of clusters, from the first to the end, with so many points between two of them on average.

    A cut lies where the sizes of the clusters beside it say so, whatever comes before them.
    What is asked of a task is then remembered where other clusters changed.
    """
    size = np.diff(bounds).astype(np.uint64)
    # a hash of two sizes is below a share of its range in as many cases: Knuth's multiplicative one, by 2**32 over the golden ratio
    mixed = (size[1:] * np.uint64(31) + size[:-1]) * np.uint64(2654435761) % np.uint64(2**32)
    return np.unique(np.r_[0, np.flatnonzero(mixed * float(points) < size[1:] * 2.0**32) + 1, len(bounds) - 1])


def _at(columns, rows):
    return tuple(column.take(rows, axis=0) for column in columns)


def _columns_at(records, names, rows):
    """Some columns of some rows, which are read for it."""
    selected = records.take(rows)
    return tuple(selected[name] for name in names)


def _polygons(outlines):
    """[[Polygon]] of each marking, from what `outlines_of_markings` gives."""
    vertices, ring_start, polygon_start, count = outlines
    ends = np.cumsum(count).tolist()
    polygons = shapely.from_ragged_array(shapely.GeometryType.POLYGON, vertices, (ring_start, polygon_start)).tolist()
    return [polygons[end - number:end] for end, number in zip(ends, count.tolist())]
