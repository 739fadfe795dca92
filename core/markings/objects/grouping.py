"""Which points of paint belong together, in the road's own way: farther apart along it than across it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import linked_groups, order_by
from ...common.parallel import check_cancelled
from ...common.progress import Progress
from ...execution.phase import THREADS, Executor, NoSource, Phase
from ...lazy import cv2
from ...survey.frame.road import Road
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE, join_columns, to_units
from ...survey.store.road_points import RoadPoints, columns_of_roads
from ..road_grid import CELL_UNITS, components, occupied, track_reach
from ..weights import GROUPS

LINKING_WINDOW_CELLS = 1250   # derived: cells of 4 cm: 50 m of station are linked at a time
LINKING_COLUMNS = ("s", "d", "spacing", "half_width")   # of a point, that linking looks at
LINKED_POINTS = 50_000   # derived: of paint, that are linked together at least: about 50 ms
PHASE_POINTS = 500_000   # derived: of paint, whose columns are held for tasks at a time
# of a point of paint that clustering looks at
PAINT_COLUMNS = ("x", "y", "z", "s", "d", "intensity", "corrected", "pass_number", "half_width", "covered", "spacing")


def connected_points(marking_points: RoadPoints, road: int, distance: float, progress: Progress = Progress(),
                     executor: Executor = THREADS) -> tuple[Columns, np.ndarray]:
    """Connected components of the points of one road.

    Points of one 4 cm cell are one member, at their mean place: points of dense paint would otherwise have hundreds of neighbours each. Cells are
    fixed in station, and windows are joined through the cells they share, so neither window nor section length shows in the result.

    Parameters
    ----------
    distance : m, by which points of one marking are joined
    executor : who links the points of windows

    Returns
    -------
    records : Columns PAINT_COLUMNS of the N points of the road, by station, which are read when they are asked for and not kept
    labels : (N,) int32 component of each; its numbering follows station
    """
    records = columns_of_roads(marking_points.store, [road], PAINT_COLUMNS)
    labels, links = [], []
    shared_cells, shared_labels, count = np.empty((0, 2), np.int64), np.empty(0, np.int64), 0
    for cells, component, beyond, member in _linked_windows(marking_points, road, distance, progress, executor):
        component = component + count
        count = component.max(initial=count - 1) + 1
        links.append(_shared_labels(shared_cells, shared_labels, cells, component))
        shared_cells, shared_labels = cells[beyond], component[beyond]
        labels.append(component[member].astype(np.int32))
    if not labels:
        return records, np.empty(0, np.int32)
    pairs = np.concatenate(links)
    merged = linked_groups(pairs[:, 0], pairs[:, 1], count).astype(np.int32, copy=False)
    return records, np.concatenate([merged[window_labels] for window_labels in labels])


def _linked_windows(marking_points, road, distance, progress, executor):
    """What `links_of_windows` finds in each window of a road, in their order."""
    phase = Phase(links_of_windows, NoSource(), (distance,), lambda item: f"markings of road {road}")
    first, last = (int(np.floor(s / COORDINATE_SCALE / CELL_UNITS / LINKING_WINDOW_CELLS)) for s in marking_points.store.span(road))
    items, size, total, begin = [], LINKED_POINTS, 0, first
    for number in range(first, last + 1):
        check_cancelled()
        window = _points_to_link(marking_points, road, distance, number)
        if size >= LINKED_POINTS:
            items.append([])
            size = 0
        items[-1].append(window)
        size, total = size + len(window[0]), total + len(window[0])
        if total >= PHASE_POINTS or number == last:
            part = progress.part((begin - first) / (last + 1 - first), (number + 1 - first) / (last + 1 - first))
            yield from (links for batch in executor.run(phase, items, part) for links in batch)
            items, size, total, begin = [], LINKED_POINTS, 0, number + 1


def _points_to_link(marking_points, road, distance, number):
    """LINKING_COLUMNS of the points of a window and of those beyond its end that they may reach, and the cell along the road at which it ends."""
    reach = int(np.ceil(distance * GROUPS.reach_along_factor / (CELL_UNITS * COORDINATE_SCALE))) + 1
    first, end = number * LINKING_WINDOW_CELLS, (number + 1) * LINKING_WINDOW_CELLS
    records = marking_points.window(road, *(row * CELL_UNITS * COORDINATE_SCALE for row in (first - 1, end + reach + 1))).records
    column = records["s"] // CELL_UNITS
    records = records[(column >= first) & (column < end + reach)]
    return *(records[name] for name in LINKING_COLUMNS), end


def links_of_windows(source: NoSource, item: list[tuple[Any, ...]], distance: float) -> list[tuple[np.ndarray, ...]]:
    """The phase that links the points of windows, by `distance`, m.

    `item` : of each window LINKING_COLUMNS of its N points, one after the other, and the cell along the road at which it ends. Returns of each
    (K, 2) int occupied cells, (K,) int their component, (K,) bool whether they lie beyond the end, and (M,) int the cell of each point that does not.
    """
    links: list[tuple[np.ndarray, ...]] = []
    for *columns, end in item:
        cells, member, component = _components_of_points(dict(zip(LINKING_COLUMNS, columns)), distance)
        links.append((cells, component, cells[:, 0] >= end, member[columns[0] // CELL_UNITS < end]))
    return links


def _components_of_points(records: Columns | Mapping[str, np.ndarray], distance: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(K, 2) int occupied cells, (N,) int the cell of each point, (K,) int the component of each cell; points are joined by `distance`, m."""
    cells, member = occupied(records["s"] // CELL_UNITS, records["d"] // CELL_UNITS)
    size = np.bincount(member, minlength=len(cells))
    # sums of integers are the same in any order
    s, d = (np.bincount(member, records[name], len(cells)) for name in ("s", "d"))
    places = np.stack([s / size / GROUPS.reach_along_factor, d / size * GROUPS.reach_across_divisor], axis=1) * COORDINATE_SCALE
    size_of_cell = CELL_UNITS * COORDINATE_SCALE / GROUPS.reach_along_factor, CELL_UNITS * COORDINATE_SCALE * GROUPS.reach_across_divisor
    labels = components(cells, places, size_of_cell, distance)
    reach = np.zeros(len(cells))
    reach[member] = track_reach(records["spacing"])
    at_rim = np.zeros(len(cells), bool)
    at_rim[member[records["half_width"] * 1e-3 - np.abs(records["d"]) * COORDINATE_SCALE < GROUPS.road_edge_clearance]] = True
    pairs = _across_tracks(places / [distance, GROUPS.reach_across_divisor], reach, at_rim)
    if len(pairs):
        labels = linked_groups(labels[pairs[:, 0]], labels[pairs[:, 1]], int(labels.max()) + 1)[labels]
    return cells, member, labels


def _across_tracks(places, reach, at_rim):
    """(P, 2) cells on neighbouring tracks of the scan, where these lie farther apart than points that join anyway.

    `places` : (K, 2) along the road in units of the reach there, across it in m; `reach` : (K,) m across the road; `at_rim` : (K,) bool, at the very
    edge of the road, where it is the curb that is bright: the next track may show an edge line.
    """
    rows = np.flatnonzero(reach)
    if not len(rows):
        return np.empty((0, 2), np.int64)
    widest = reach[rows].max()
    pairs = rows[cKDTree(places[rows] / [1.0, widest]).query_pairs(1.0, output_type="ndarray").reshape(-1, 2)]
    along, across = (places[pairs[:, 0]] - places[pairs[:, 1]]).T
    reachable = along**2 + (across / reach[pairs].min(axis=1)) ** 2 <= 1.0
    return pairs[reachable & (at_rim[pairs[:, 0]] == at_rim[pairs[:, 1]])]


def _shared_labels(cells, labels, others, other_labels):
    """(K, 2) labels that two windows gave to the same cells."""
    if not len(cells) or not len(others):
        return np.empty((0, 2), np.int64)
    low = min(cells[:, 1].min(), others[:, 1].min())
    width = max(cells[:, 1].max(), others[:, 1].max()) - low + 1
    keys, other_keys = (c[:, 0] * width + c[:, 1] - low for c in (cells, others))
    _, a, b = np.intersect1d(keys, other_keys, assume_unique=True, return_indices=True)
    return np.c_[labels[a], other_labels[b]]


# Figures on two roads: a block of a give-way line or an arrow is one figure, whichever road its points were given to, and is described in the frame
# of the road that has most of them. Lines along a road stay with each of the roads, which fits them in its own frame.


class RoadPaint(NamedTuple):
    """Points of paint told in the frame of one road."""

    records: Columns   # N points
    labels: np.ndarray   # (N,) int, the cluster of each
    home: np.ndarray   # (N, 2) int32, whose the points are: the place of their road among all, and their row there


def told_by_one_road(found: Sequence[tuple[Columns, np.ndarray]], roads: Sequence[Road], distance: float) -> list[RoadPaint]:
    """The same points, those of a shared figure in the frame of one road.

    Parameters
    ----------
    found : records and (N,) int labels of the clusters of each road
    roads : of them
    distance : m, by which points of one marking are joined

    Returns
    -------
    RoadPaint of each road, the points that others gave to it behind its own
    """
    paint = [RoadPaint(records, labels, np.column_stack([np.full(len(records), k, np.int32), np.arange(len(records), dtype=np.int32)]))
             for k, (records, labels) in enumerate(found)]
    if sum(len(records) > 0 for records, _ in found) < 2:
        return paint
    gone = [np.zeros(len(records), bool) for records, _ in found]
    came: list[list[RoadPaint]] = [[] for _ in found]
    following = [int(labels.max(initial=-1)) + 1 for _, labels in found]
    for rows in _shared_points(found):
        home = max(rows, key=lambda k: len(rows[k]))
        records = _told_by(roads[home], [(found[k][0].take(members), k == home) for k, members in rows.items()])
        if records is not None:
            labels = _clusters(records, distance) + following[home]
            following[home] = int(labels.max()) + 1
            came[home].append(RoadPaint(records, labels, np.concatenate([paint[k].home[members] for k, members in rows.items()])))
            for k, members in rows.items():
                gone[k][members] = True
    return [_with(road_paint, ~lost, more) if lost.any() or more else road_paint for road_paint, lost, more in zip(paint, gone, came)]


def _shared_points(found):
    """Rows of the points of each figure that several roads have points of, {place of the road: (N,) int}."""
    orders, starts, parts = [], [], []
    for records, labels in found:
        order = order_by(labels)
        begins = np.flatnonzero(np.r_[True, np.diff(labels[order]) != 0]) if len(labels) else np.empty(0, np.int64)
        orders.append(order)
        starts.append(np.r_[begins, len(order)])
        parts.append(_compact_parts(records, order, begins))
    before = np.cumsum([0, *(len(road_starts) - 1 for road_starts in starts)])
    spots = np.concatenate([spots for spots, _ in parts])
    part = np.concatenate([number + first for (_, number), first in zip(parts, before)])
    road = np.repeat(np.arange(len(found)), [len(number) for _, number in parts])
    pairs = cKDTree(spots).query_pairs(GROUPS.touching, output_type="ndarray").reshape(-1, 2) if len(spots) else np.empty((0, 2), np.int64)
    pairs = part[pairs[road[pairs[:, 0]] != road[pairs[:, 1]]]]
    group = linked_groups(pairs[:, 0], pairs[:, 1], int(before[-1]))
    members = np.unique(pairs)
    members = members[order_by(members, group[members])]
    for linked_parts in np.split(members, np.flatnonzero(np.diff(group[members])) + 1) if len(members) else ():
        rows: dict[int, list[np.ndarray]] = {}
        for k, number in zip(np.searchsorted(before, linked_parts, side="right") - 1, linked_parts):
            first = number - before[k]
            rows.setdefault(int(k), []).append(orders[k][starts[k][first]:starts[k][first + 1]])
        joined = {k: np.concatenate(indices) for k, indices in rows.items()}
        if _is_figure(np.concatenate([np.column_stack([found[k][0][name].take(indices) for name in "xy"]) for k, indices in joined.items()])):
            yield joined


def _compact_parts(records, order, begins):
    """Different squares (K, 2) that the points of clusters no larger than a figure lie in, and the number of the cluster of each."""
    if not len(begins):
        return np.empty((0, 2), np.int64), np.empty(0, np.int64)
    coordinates = [records[name].take(order).astype(np.int64) for name in "xy"]
    size = np.max([np.maximum.reduceat(values, begins) - np.minimum.reduceat(values, begins) for values in coordinates], axis=0)
    number = np.repeat(np.arange(len(begins)), np.diff(np.r_[begins, len(order)]))
    small = np.flatnonzero(size[number] * COORDINATE_SCALE <= GROUPS.largest_figure)
    different = np.unique(np.column_stack([number[small], *(values[small] // GROUPS.spot_units for values in coordinates)]), axis=0)
    return different[:, 1:], different[:, 0]


def _is_figure(places):
    """Whether (N, 2) places, units of 0.1 mm, are no larger than a figure and no line."""
    cells, _ = occupied(*(places // (GROUPS.spot_units // 4)).T)
    sides = np.add(cv2.minAreaRect(cells.astype(np.float32))[1], 1.0) * (GROUPS.spot_units // 4) * COORDINATE_SCALE
    length, width = max(sides), min(sides)
    return length <= GROUPS.largest_figure and not (width <= GROUPS.line_width and length >= GROUPS.line_elongation * width)


def _told_by(road, parts):
    """Points, each part with whether it is the road's own, in the frame of a road; None where it does not reach there."""
    result = []
    for records, is_own in parts:
        if not is_own:
            s, d = road.locate(records["x"] * COORDINATE_SCALE, records["y"] * COORDINATE_SCALE)
            if not np.isfinite(s).all():
                return None
            # as far from the edge of the road as on its own
            clearance = records["half_width"] * 1e-3 - np.abs(records["d"]) * COORDINATE_SCALE
            half_width = np.clip(np.rint((np.abs(d) + clearance) * 1e3), 0, np.iinfo(np.uint16).max).astype(np.uint16)
            records = records.with_columns(s=to_units(s), d=to_units(d), half_width=half_width)
        result.append(records)
    return join_columns(result, result[0].dtype)


def _clusters(records, distance):
    _, member, component = _components_of_points(records, distance)
    return component[member].astype(np.int64)


def _with(paint, kept, more):
    rows = np.flatnonzero(kept)
    parts = [RoadPaint(paint.records.take(rows), paint.labels[rows], paint.home[rows]), *more]
    return RoadPaint(join_columns([part.records for part in parts], paint.records.dtype),
                     *(np.concatenate([getattr(part, name) for part in parts]) for name in ("labels", "home")))
