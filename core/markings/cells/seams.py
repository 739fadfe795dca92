"""Figures of which two roads have points: where roads meet or overlap, each pass gives its points to its own road.

A block of a give-way line or an arrow is one figure, whichever road its points were given to. All of them are told in the frame of the road that
has most of them. Lines along a road stay with each of the roads, which links and fits them in its own frame. Stripes of crossings were found
before, by road.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...common.groups import linked_groups
from ...common.order_statistics import order_by
from ...lazy import cv2
from ...survey.store.records import COORDINATE_SCALE, join_columns, to_units
from ..road_grid import occupied
from .clusters import components_of_points

if TYPE_CHECKING:
    from ...survey.frame.road import Road
    from ...survey.store.columns import Columns

LARGEST_FIGURE = 8.0                # m, of an arrow: what is longer runs on along a road
LINE_WIDTH, LINE_ELONGATION = 0.35, 4.0   # m, and length by width: a line or one of its dashes
SPOT_UNITS = 1000                   # units of 0.1 mm: points are compared in squares of 10 cm,
TOUCHING = 1.5                      # squares: and those that touch, at a corner too, are of one figure


class RoadPaint(NamedTuple):
    """Points of paint told in the frame of one road.

    records : N points
    labels : (N,) int, the cluster of each
    home : (N, 2) int32, whose the points are: the place of their road among all, and their row there
    """

    records: Columns
    labels: np.ndarray
    home: np.ndarray


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
    for rows in _shared(found):
        home = max(rows, key=lambda k: len(rows[k]))
        records = _told_by(roads[home], [(found[k][0].take(own), k == home) for k, own in rows.items()])
        if records is not None:
            labels = _clusters(records, distance) + following[home]
            following[home] = int(labels.max()) + 1
            came[home].append(RoadPaint(records, labels, np.concatenate([paint[k].home[own] for k, own in rows.items()])))
            for k, own in rows.items():
                gone[k][own] = True
    return [_with(one, ~lost, more) if lost.any() or more else one for one, lost, more in zip(paint, gone, came)]


def _shared(found):
    """Rows of the points of each figure that several roads have points of, {place of the road: (N,) int}."""
    orders, starts, parts = [], [], []
    for records, labels in found:
        order = order_by(labels)
        begins = np.flatnonzero(np.r_[True, np.diff(labels[order]) != 0]) if len(labels) else np.empty(0, np.int64)
        orders.append(order)
        starts.append(np.r_[begins, len(order)])
        parts.append(_compact_parts(records, order, begins))
    before = np.cumsum([0, *(len(one) - 1 for one in starts)])
    spots = np.concatenate([spots for spots, _ in parts])
    part = np.concatenate([number + first for (_, number), first in zip(parts, before)])
    road = np.repeat(np.arange(len(found)), [len(number) for _, number in parts])
    pairs = cKDTree(spots).query_pairs(TOUCHING, output_type="ndarray").reshape(-1, 2) if len(spots) else np.empty((0, 2), np.int64)
    pairs = part[pairs[road[pairs[:, 0]] != road[pairs[:, 1]]]]
    group = linked_groups(pairs[:, 0], pairs[:, 1], int(before[-1]))
    members = np.unique(pairs)
    members = members[order_by(members, group[members])]
    for some in np.split(members, np.flatnonzero(np.diff(group[members])) + 1) if len(members) else ():
        rows: dict[int, list[np.ndarray]] = {}
        for k, number in zip(np.searchsorted(before, some, side="right") - 1, some):
            first = number - before[k]
            rows.setdefault(int(k), []).append(orders[k][starts[k][first]:starts[k][first + 1]])
        joined = {k: np.concatenate(own) for k, own in rows.items()}
        if _is_figure(np.concatenate([np.column_stack([found[k][0][name].take(own) for name in "xy"]) for k, own in joined.items()])):
            yield joined


def _compact_parts(records, order, begins):
    """Different squares (K, 2) that the points of clusters no larger than a figure lie in, and the number of the cluster of each."""
    if not len(begins):
        return np.empty((0, 2), np.int64), np.empty(0, np.int64)
    places = [records[name].take(order).astype(np.int64) for name in "xy"]
    size = np.max([np.maximum.reduceat(values, begins) - np.minimum.reduceat(values, begins) for values in places], axis=0)
    number = np.repeat(np.arange(len(begins)), np.diff(np.r_[begins, len(order)]))
    small = np.flatnonzero(size[number] * COORDINATE_SCALE <= LARGEST_FIGURE)
    different = np.unique(np.column_stack([number[small], *(values[small] // SPOT_UNITS for values in places)]), axis=0)
    return different[:, 1:], different[:, 0]


def _is_figure(places):
    """Whether (N, 2) places, units of 0.1 mm, are no larger than a figure and no line."""
    cells, _ = occupied(*(places // (SPOT_UNITS // 4)).T)
    sides = np.add(cv2.minAreaRect(cells.astype(np.float32))[1], 1.0) * (SPOT_UNITS // 4) * COORDINATE_SCALE
    length, width = max(sides), min(sides)
    return length <= LARGEST_FIGURE and not (width <= LINE_WIDTH and length >= LINE_ELONGATION * width)


def _told_by(road, parts):
    """Points, each part with whether it is the road's own, in the frame of a road; None where it does not reach there."""
    told = []
    for records, own in parts:
        if not own:
            s, d = road.locate(records["x"] * COORDINATE_SCALE, records["y"] * COORDINATE_SCALE)
            if not np.isfinite(s).all():
                return None
            # as far from the edge of the road as on its own
            clearance = records["half_width"] * 1e-3 - np.abs(records["d"]) * COORDINATE_SCALE
            half_width = np.clip(np.rint((np.abs(d) + clearance) * 1e3), 0, np.iinfo(np.uint16).max).astype(np.uint16)
            records = records.with_columns(s=to_units(s), d=to_units(d), half_width=half_width)
        told.append(records)
    return join_columns(told, told[0].dtype)


def _clusters(records, distance):
    _, member, component = components_of_points(records, distance)
    return component[member].astype(np.int64)


def _with(paint, kept, more):
    rows = np.flatnonzero(kept)
    parts = [RoadPaint(paint.records.take(rows), paint.labels[rows], paint.home[rows]), *more]
    return RoadPaint(join_columns([part.records for part in parts], paint.records.dtype),
                     *(np.concatenate([getattr(part, name) for part in parts]) for name in ("labels", "home")))
