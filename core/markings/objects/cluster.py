"""Paint points to markings: which points belong together, and what they are (conditional Euclidean clustering in the road frame)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
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
from ...execution.phase import THREADS, Executor, Items, NoSource, Phase
from ...survey.frame.road import Road
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE, Points
from ...survey.store.road_points import RoadPoints
from ..road_grid import CELL_UNITS, occupied, track_reach
from ..weights import CLASSES, ROWS, SHAPES
from .classify import LINE_KINDS, NOT_PAINT, ClassSettings, classify_markings, filled, relative_contrast, too_pale
from .figures import figure_of_cells, painted_figures
from .grouping import connected_points
from .marking_objects import MarkingObjects, make_marking_objects
from .repeating import Comb, Crossing, Stripe, blocks_of_strip, comb_of_window, give_way_blocks, stripes_of_crossing, zebra_stripes
from .shape import Shape, drawn_outline, lifted, measure, smallest_rectangle
from .split_merge import join_fragments, parts_of_compound, split_compounds

STRIP_KINDS = LINE_KINDS + ("stop",)  # drawn as even strips, the others cell by cell


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

    executor : who links points, looks for crossings, divides compound clusters and measures clusters

    Returns
        markings : MarkingObjects, one polygon a marking; one that wear or a shadow cut apart has several, with one `cluster` number
        clustered : RoadPoints with `cluster`, the number of the marking; 0 on what is no marking
    """
    clustered = replace(marking_points, store=marking_points.store.with_column("cluster"), has_cluster=True)
    roads = marking_points.roads()
    lines = [frame.road(road) for road in roads]
    first, second, last = ([progress.part(begin + share * k / len(roads), begin + share * (k + 1) / len(roads)) for k in range(len(roads))]
                           for begin, share in ((0.0, 0.1), (0.1, 0.6), (0.7, 0.3)))
    connected = [connected_points(marking_points, road, settings.distance, part, executor) for road, part in zip(roads, first)]
    counts = [len(records) for records, _ in connected]
    works = [ApartWork(executor, line.number) for line in lines]
    stripes_by_road = [_stripes_of_crossings(records, line, work, part.part(0.0, 0.5))
                       for (records, _), line, work, part in zip(connected, lines, works, second)]
    # what is not used any more is let go, since the paint of a whole road is in memory
    paint = [(records.take(other_rows), labels[other_rows]) for (records, labels), (_, other_rows) in zip(connected, stripes_by_road)]
    del connected
    pieces_by_road = [_pieces(*of_road, work, settings, part.part(0.5, 1.0)) for of_road, work, part in zip(paint, works, second)]
    del paint
    blocks = _blocks_of_all(pieces_by_road)
    rows, polygons, refused = [], [], 0
    cluster = [np.zeros(count, np.int32) for count in counts]
    number = 0
    for k, ((stripes, other_rows), pieces, line, block, part) in enumerate(zip(stripes_by_road, pieces_by_road, lines, blocks, last)):
        painted, without = _markings(pieces, block, settings, marking_points.has_corrected, part.part(0.0, 0.5))
        refused += without
        markings = sorted([*stripes, *painted], key=lambda marking: (marking.shape.s0, marking.shape.d0, marking.shape.s1))
        for marking, drawn in zip(markings, _outlines(markings, pieces.paint, line, pieces.work, part.part(0.5, 1.0))):
            number += 1
            check_cancelled()
            cluster[k][other_rows[marking.rows] if marking.outline is None else marking.rows] = number
            polygons += drawn
            rows += [_row(marking, number, line, frame)] * len(drawn)
    for road, numbers in zip(roads, cluster):
        _put(clustered.store, road, numbers, marking_points)
    progress.info(f"Markings: {number} found; {refused} clusters were left out as gutters, seams, covers, specks or the feet of what "
                 "stands on the road.")
    return make_marking_objects(rows, polygons, frame, marking_points.crs), clustered


class _Pieces(NamedTuple):
    """Clusters of one road, before it is known what they are."""

    paint: Columns   # of the road but for stripes of crossings
    records: Columns   # their points, one cluster after the other, and the rows of these in the paint
    order: np.ndarray
    bounds: list[tuple[int, int]]   # first and end row of each cluster in the records, and its Shape
    shapes: list[Shape]
    work: ApartWork


def _pieces(paint, labels, work, settings, progress):
    """_Pieces of one road: compound clusters divided, what wear has parted joined."""
    split = split_compounds(paint, _with_rows_divided(paint, labels), partial(work.parts, progress=progress.part(0.0, 0.3)))
    order, starts, _ = _by_cluster(split, 1)
    records = paint.take(order)
    pieces = work.shapes(records, starts, progress.part(0.3, 0.9))
    joins = join_fragments(pieces, settings.classes.max_width)
    again, starts, labels = _by_cluster(_relabelled(records, starts, joins), settings.min_points)
    records, order = records.take(again), order[again]
    bounds = list(zip(starts[:-1].tolist(), starts[1:].tolist()))
    unjoined = _alone(pieces, joins)
    joined_records, ends = _some_clusters(records, [span for label, span in zip(labels.tolist(), bounds) if label not in unjoined])
    joined = iter(work.shapes(joined_records, ends, progress.part(0.9, 1.0)))
    return _Pieces(paint, records, order, bounds, [unjoined[label] if label in unjoined else next(joined) for label in labels.tolist()], work)


def _blocks_of_all(found):
    """Of each road (N,) bool, which clusters are blocks of give-way lines: a row of them may lie on several roads, and oblique to them."""
    shapes = [shape for pieces in found for shape in pieces.shapes]
    rectangles = [_rectangle(records, bounds) if max(shape.sides) <= SHAPES.small_marking_size else (0.0, 0.0, 0.0, 0.0)
                  for pieces in found for records in [pieces.records.unread()] for bounds, shape in zip(pieces.bounds, pieces.shapes)]
    sides, middles = np.split(np.array(rectangles).reshape(-1, 4), 2, axis=1)
    blocks = give_way_blocks(filled(shapes), sides, middles)
    return np.split(blocks, np.cumsum([len(pieces.shapes) for pieces in found])[:-1]) if found else []


def _rectangle(records, bounds):
    """Sides of the smallest rectangle about a cluster in local coordinates, and the middle of its extent there, m."""
    x, y = (records[name][slice(*bounds)] for name in "xy")
    cells, _ = occupied(x // CELL_UNITS, y // CELL_UNITS)
    middle = [(int(values.min()) + int(values.max())) / 2 * COORDINATE_SCALE for values in (x, y)]
    return *smallest_rectangle(cells), *middle


def _with_rows_divided(records, labels):
    """Labels of clusters, rows of the blocks of give-way lines divided into these."""
    if not len(labels):
        return labels
    order = order_by(labels)
    starts = np.flatnonzero(np.r_[True, np.diff(labels[order]) != 0])
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


def _markings(pieces, blocks, settings, has_corrected, progress):
    """[_Marking] of one road but for stripes of crossings, and how many clusters are none; blocks : (N,) bool."""
    records, bounds, shapes = pieces.records.unread(), pieces.bounds, pieces.shapes
    half_width, hidden = records["half_width"], records["covered"]
    half_widths = [median(half_width[a:b].astype(float)) * 1e-3 for a, b in bounds]
    covered = [float(np.count_nonzero(hidden[a:b])) / (b - a) for a, b in bounds]
    kinds = classify_markings(shapes, half_widths, settings.classes, covered, blocks)
    clear = np.array(half_widths) - np.abs([shape.offset for shape in shapes]) > CLASSES.rim_clearance
    possible = clear & (np.array(covered) <= CLASSES.min_covered_share)
    if has_corrected:
        bright = relative_contrast(Points(records).value, records["s"], np.array([0, *(b for _, b in bounds)]))
        pale = [too_pale(share, kind) for share, (kind, _) in zip(bright.tolist(), kinds)]
        possible &= ~np.array(pale, bool)
        kinds = [(NOT_PAINT, "other") if faint else kind for faint, kind in zip(pale, kinds)]
    classes: list[tuple[tuple[int, ...], str, str]] = [((k,), *kind) for k, kind in enumerate(kinds)]
    for members, kind in painted_figures(shapes, [kind for kind, _ in kinds], possible, lambda group: _cells_together(records, bounds, group),
                                         partial(pieces.work.figures, progress=progress)):
        for k in members:
            classes[k] = ((), NOT_PAINT, "other")
        classes[members[0]] = (members, kind, "other")
    # the columns that told kinds of markings are not used any more
    markings, records = [], records.unread()
    for members, kind, use in classes:
        if kind != NOT_PAINT:
            check_cancelled()
            of_it = _rows_of(bounds, members)
            shape = shapes[members[0]] if len(members) == 1 else measure(*(records[name][of_it] for name in ("s", "d", "spacing")))
            markings.append(_Marking(records[of_it], pieces.order[of_it], shape, kind, use))
    return markings, sum(kind == NOT_PAINT for members, kind, _ in classes if members)


class _Marking(NamedTuple):
    """Records of a marking and their rows in the paint of its road; of a stripe of a crossing, whose outline in local coordinates is known
    already, in all points of the road."""

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
    places, way = (cells + 0.5) * CELL_UNITS * COORDINATE_SCALE, road.heading(station)
    del cells, station
    stripes = zebra_stripes(places, way, lambda windows: work.combs(places, windows, progress.part(0.0, 0.7)),
                            lambda crossings: work.stripes(places, way, crossings, progress.part(0.7, 0.9)))
    stripe_of, markings = np.full(len(places), -1, np.int32), []
    for k, stripe in enumerate(stripes):
        stripe_of[stripe.spots] = k
    of_point = stripe_of[member]
    rows = list(members_of(of_point))
    painted = records.take(np.concatenate([np.empty(0, np.intp), *(members for _, members in rows)])).load_all()
    bounds = np.cumsum([0, *(len(members) for _, members in rows)])
    for (k, members), first, end, shape in zip(rows, bounds[:-1], bounds[1:], work.shapes(painted, bounds, progress.part(0.9, 1.0))):
        corners = stripes[k].corners
        length, width = (float(np.hypot(*(corners[j] - corners[j - 1]))) for j in (1, 2))
        markings.append(_Marking(painted[first:end], members, replace(shape, length=length, width=width), "zebra", "other", shapely.Polygon(corners)))
    return markings, np.flatnonzero(of_point < 0)


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


def _alone(pieces, joins):
    """The pieces that were joined to no other, by the number of their marking."""
    count = np.bincount(joins, minlength=1)
    return {number: piece for number, piece in zip(joins.tolist(), pieces) if count[number] == 1}


def _relabelled(records, starts, number):
    """Label of every record after joining; records of no cluster get labels of their own."""
    labels = np.repeat(number, np.diff(starts))
    extra = len(records) - len(labels)
    return np.r_[labels, len(number) + np.arange(extra)]


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
    return [next(drawn) if marking.outline is None
            else [lifted(marking.outline, np.stack([marking.records[name] for name in "xyz"], axis=1) * COORDINATE_SCALE)] for marking in markings]


def _row(marking, number, line, frame):
    """The fields of one marking."""
    shape = marking.shape
    return dict(road=int(line.number), cluster=number, use=marking.use, station_m=shape.s0, offset_m=shape.offset, length_m=shape.length,
                width_m=shape.width, elongation=shape.elongation, scan_m=_scanning_distance(marking.records, line, frame),
                points=shape.points, **{"class": marking.kind})


def _scanning_distance(records, line, frame):
    """Median distance across the road from the track that scanned the marking."""
    numbers, along, across = (records[name] for name in ("pass_number", "s", "d"))
    distance = np.empty(len(records))
    for number in numbers[:1] if (numbers == numbers[0]).all() else np.unique(numbers):
        rows, driven = np.flatnonzero(numbers == number), frame.passes[number]
        s, d = along[rows] * COORDINATE_SCALE, across[rows] * COORDINATE_SCALE
        if driven.road != line.number:
            # what another road's pass scanned lies in the frame of that road, too
            s, d = frame.road(driven.road).locate(*(records[name][rows] * COORDINATE_SCALE for name in "xy"))
        distance[rows] = np.abs(d - driven.at_station(s)[0])
    return median(distance)


# The phases: what is computed of some clusters or windows apart from all others; their items hold the columns that they need.

TASK_POINTS = 20_000   # derived: of paint, that a worker process is given together on average: about a tenth of a second of its time


def combs_of_windows(source: NoSource, item: tuple[np.ndarray, np.ndarray]) -> list[tuple[Any, ...] | None]:
    """The phase that looks for stripes of crossings; item : (N, 2) m spots of windows one after the other, and the bounds of the windows."""
    places, bounds = item
    combs = []
    for first, end in zip(bounds[:-1].tolist(), bounds[1:].tolist()):
        check_cancelled()
        comb = comb_of_window(places[first:end])
        combs.append(None if comb is None else tuple(comb))
    return combs


def _zebra_stripes(source: NoSource, item: tuple[np.ndarray, np.ndarray, np.ndarray, list[tuple[Any, ...]]]) -> list[list[tuple[Any, ...]]]:
    """The phase that finds the stripes of crossings.

    `item` : (N, 2) m spots about crossings one after the other, (N,) radians of the road there, the bounds of the crossings, and the Comb of each.
    """
    places, way, bounds, combs = item
    stripes = []
    for first, end, comb in zip(bounds[:-1].tolist(), bounds[1:].tolist(), combs):
        check_cancelled()
        stripes.append([tuple(stripe) for stripe in stripes_of_crossing(places[first:end], way[first:end], Comb(*comb))])
    return stripes


def _parts_of_compounds(source: NoSource, item: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]) -> list[tuple[np.ndarray, int]]:
    """The phase that divides compound clusters; item : s, d (0.1 mm), spacing (mm) of the points, and the bounds of the clusters."""
    return [parts_of_compound(*columns) for columns in _clusters(item)]


def shapes_of_clusters(source: NoSource, item: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]) -> list[Shape]:
    """The phase that measures clusters; item : as of `_parts_of_compounds`."""
    return [measure(*columns) for columns in _clusters(item)]


def outlines_of_markings(source: NoSource, item: tuple[Any, ...], road: Road) -> tuple[np.ndarray, ...]:
    """The phase that draws markings.

    `item` : s, d, x, y, z (0.1 mm), spacing (mm) of the points, the bounds of the markings, and the Shape and whether it is a strip of each. Returns
    (V, 3) local m, first vertex of each ring, first ring of each polygon, each with the end, and the number of polygons of each marking.
    """
    *columns, looks = item
    drawn = [drawn_outline(cluster, shape, strip, road) for cluster, (shape, strip) in zip(_clusters(columns), looks)]
    polygons = [polygon for outline in drawn for polygon in outline]
    _, vertices, starts = shapely.to_ragged_array(polygons, include_z=True) if polygons else (None, np.empty((0, 3)), (np.zeros(1, int),) * 2)
    return vertices, *starts, np.array([len(outline) for outline in drawn])


def _clusters(item):
    *columns, bounds = item
    for first, end in zip(bounds[:-1].tolist(), bounds[1:].tolist()):
        check_cancelled()
        yield [column[first:end] for column in columns]


@dataclass(frozen=True)
class ApartWork:
    """The phases for the clusters of one road, by its number."""

    executor: Executor
    road: int

    def combs(self, places: np.ndarray, windows: Sequence[np.ndarray], progress: Progress) -> list[Comb | None]:
        """The Comb of each window, None where it has no stripes; places : (N, 2) m, windows : rows of the spots of each."""
        bounds = np.cumsum([0, *map(len, windows)])
        rows = np.concatenate([np.empty(0, np.int32), *windows])
        combs = self._run(combs_of_windows, lambda a, b: (places[rows[bounds[a]:bounds[b]]],), bounds, progress)
        return [None if comb is None else Comb(*comb) for comb in combs]

    def stripes(self, places: np.ndarray, way: np.ndarray, crossings: Sequence[Crossing], progress: Progress) -> list[list[Stripe]]:
        """The stripes of each crossing, their spots by number among those of the crossing; places, way : as of `zebra_stripes`."""
        bounds = np.cumsum([0, *(len(spots) for spots, _ in crossings)])
        rows = np.concatenate([np.empty(0, np.intp), *(spots for spots, _ in crossings)])
        stripes = self._run(_zebra_stripes, lambda a, b: tuple(values[rows[bounds[a]:bounds[b]]] for values in (places, way)), bounds, progress,
                            looks=[tuple(comb) for _, comb in crossings])
        return [[Stripe(*stripe) for stripe in crossing_stripes] for crossing_stripes in stripes]

    def parts(self, s: np.ndarray, d: np.ndarray, spacing: np.ndarray, spans: Sequence[tuple[int, int]],
              progress: Progress) -> list[tuple[np.ndarray, int]]:
        """Of each compound cluster, which begins and ends at rows of the columns, the part of every point, and how many parts there are."""
        rows = np.concatenate([np.empty(0, np.intp), *(np.arange(first, end) for first, end in spans)])
        bounds = np.cumsum([0, *(end - first for first, end in spans)])
        return self._run(_parts_of_compounds, lambda a, b: tuple(column[rows[bounds[a]:bounds[b]]] for column in (s, d, spacing)), bounds, progress)

    def shapes(self, records: Columns, bounds: np.ndarray, progress: Progress) -> list[Shape]:
        """The Shape of each cluster; bounds : of the clusters in the records."""
        def columns(a, b):
            return _columns_at(records, np.arange(bounds[a], bounds[b]), ("s", "d", "spacing"))

        return self._run(shapes_of_clusters, columns, bounds, progress)

    def outlines(self, records: Columns, rows: Sequence[np.ndarray], looks: Sequence[tuple[Shape, bool]], road: Road,
                 progress: Progress) -> list[list[Any]]:
        """The polygons of each marking, of `drawn_outline`; rows : in the records, of each; looks : the Shape of each and whether it is a strip."""
        def columns(a, b):
            return _columns_at(records, np.concatenate(rows[a:b]), ("s", "d", "x", "y", "z", "spacing"))

        return self._run(outlines_of_markings, columns, np.cumsum([0, *map(len, rows)]), progress, looks=looks, arguments=(road,), read=_polygons)

    def figures(self, cells: list[tuple[np.ndarray, np.ndarray]], begin: float, end: float, progress: Progress) -> Iterator[str]:
        """What `figure_of_cells` finds in each of some markings together; they are the work from a fraction `begin` of the progress to `end`."""
        phase = Phase(figure_of_cells, NoSource(), (), lambda item: f"markings of road {self.road}", together=4)
        return self.executor.run(phase, cells, progress.part(begin, end))

    def _run(self, function: Callable[..., Any], columns: Callable[[int, int], tuple[np.ndarray, ...]], bounds: np.ndarray, progress: Progress,
             looks: Sequence[Any] | None = None, arguments: tuple[Any, ...] = (),
             read: Callable[[Any], list[Any]] = list) -> list[Any]:
        """Results of all clusters; `columns` gives those of the clusters from a number to before another, one after the other."""
        phase = Phase(function, NoSource(), arguments, lambda item: f"markings of road {self.road}")
        cuts = _lasting_cuts(bounds, TASK_POINTS).tolist()

        def item(k):
            a, b = cuts[k:k + 2]
            return *columns(a, b), bounds[a:b + 1] - bounds[a], *([] if looks is None else [list(looks[a:b])])

        chunks = self.executor.run(phase, Items(len(cuts) - 1, item), progress) if len(bounds) > 1 else []
        return [result for chunk in chunks for result in read(chunk)]


def _lasting_cuts(bounds, points):
    """Ascending numbers of clusters, from the first to the end, with so many points between two of them on average.

    A cut lies where the sizes of the clusters beside it say so, whatever comes before them.
    What is asked of a task is then remembered where other clusters changed.
    """
    size = np.diff(bounds).astype(np.uint64)
    # a hash of two sizes is below a share of its range in as many cases: Knuth's multiplicative one, by 2**32 over the golden ratio
    mixed = (size[1:] * np.uint64(31) + size[:-1]) * np.uint64(2654435761) % np.uint64(2**32)
    return np.unique(np.r_[0, np.flatnonzero(mixed * float(points) < size[1:] * 2.0**32) + 1, len(bounds) - 1])


def _columns_at(records, rows, names):
    """Some columns of some rows."""
    selected = records.take(rows)
    return tuple(selected[name] for name in names)


def _polygons(found):
    """[[Polygon]] of each marking, from what `outlines_of_markings` gives."""
    vertices, ring_start, polygon_start, count = found
    ends = np.cumsum(count).tolist()
    polygons = shapely.from_ragged_array(shapely.GeometryType.POLYGON, vertices, (ring_start, polygon_start)).tolist()
    return [polygons[end - number:end] for end, number in zip(ends, count.tolist())]
