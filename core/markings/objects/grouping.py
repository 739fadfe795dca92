"""Which points of paint belong together, in the road's own way: farther apart along it than across it."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import linked_groups
from ...execution.in_step import Asked, Work
from ...execution.phase import Phase
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE
from ...survey.store.road_points import RoadPoints
from ...survey.store.section_store import SectionStore
from ..road_grid import CELL_UNITS, components, occupied, track_reach
from ..weights import GROUPS

LINKING_WINDOW_CELLS = 1250   # derived: cells of 4 cm: 50 m of station are linked at a time
LINKING_COLUMNS = ("s", "d", "spacing", "half_width")   # of a point, that linking looks at
LINKED_POINTS = 50_000   # derived: of paint, that are linked together at most, on average: about 50 ms


def connected_points(marking_points: RoadPoints, distance: float) -> Work:
    """The work that links points of paint: (N,) int32 component of the points of each road, by station; its numbering follows station.

    Points of one 4 cm cell are one member, at their mean place: points of dense paint would otherwise have hundreds of neighbours each. Cells are
    fixed in station, and windows are joined through the cells they share, so neither window nor section length shows in the result.

    distance : m, by which points of one marking are joined
    """
    length, beyond = LINKING_WINDOW_CELLS * CELL_UNITS * COORDINATE_SCALE, 1.0 + distance * GROUPS.reach_along_factor
    phase = Phase(links_of_windows, marking_points.store, (distance, LINKING_WINDOW_CELLS), lambda item: f"markings of road {item[0]}",
                  state=lambda item: marking_points.state(item[0], item[1] * length - beyond, item[2] * length + beyond))
    items = [(road, *windows) for road in marking_points.roads() for windows in _windows_together(marking_points, road)]
    # road by road, window by window, as they come
    by_road = groupby(zip(items, (yield Asked(phase, items, 0.4))), lambda linked: linked[0][0])
    return [_joined_labels(window for _, windows in of_road for window in windows) for _, of_road in by_road]


def _joined_labels(windows):
    """(N,) int32 component of the points of a road, from what `links_of_windows` finds in each window."""
    labels, links = [np.empty(0, np.int32)], [np.empty((0, 2), np.int64)]
    shared_cells, shared_labels, count = np.empty((0, 2), np.int64), np.empty(0, np.int64), 0
    for cells, component, beyond, member in windows:
        component = component + count
        count = component.max(initial=count - 1) + 1
        links.append(_shared_labels(shared_cells, shared_labels, cells, component))
        shared_cells, shared_labels = cells[beyond], component[beyond]
        labels.append(component[member].astype(np.int32))
    pairs = np.concatenate(links)
    merged = linked_groups(pairs[:, 0], pairs[:, 1], count).astype(np.int32, copy=False)
    return np.concatenate([merged[window_labels] for window_labels in labels])


def _windows_together(marking_points, road):
    """First and last + 1 numbers of the windows of a road that are linked together."""
    store = marking_points.store
    first, last = (int(np.floor(s / COORDINATE_SCALE / CELL_UNITS / LINKING_WINDOW_CELLS)) for s in store.span(road))
    points = sum(store.size(road, number) for number in marking_points.sections(road))
    # a power of two, so that windows stay together where others change
    together = 2 ** max(int(np.log2(LINKED_POINTS * (last + 1 - first) / max(points, 1))), 0)
    begins = [first, *range((first // together + 1) * together, last + 1, together), last + 1]
    return zip(begins, begins[1:])


def links_of_windows(store: SectionStore, item: tuple[int, int, int], distance: float, size: int) -> list[tuple[np.ndarray, ...]]:
    """The phase that links the points of windows of so many cells, (road, first, last + 1 of their numbers), by `distance`, m.

    Returns of each (K, 2) int occupied cells, (K,) int their component, (K,) bool whether they lie beyond the end, and (M,) int the cell of each
    point that does not.
    """
    links: list[tuple[np.ndarray, ...]] = []
    road, *windows = item
    reach = int(np.ceil(distance * GROUPS.reach_along_factor / (CELL_UNITS * COORDINATE_SCALE))) + 1
    for number in range(*windows):
        first, end = number * size, (number + 1) * size
        records = store.window(road, *(row * CELL_UNITS * COORDINATE_SCALE for row in (first - 1, end + reach + 1))).records
        column = records["s"] // CELL_UNITS
        # with those beyond the end that they may reach
        records = records[(column >= first) & (column < end + reach)]
        columns = {name: records[name] for name in LINKING_COLUMNS}
        cells, member, component = _components_of_points(columns, distance)
        links.append((cells, component, cells[:, 0] >= end, member[columns["s"] // CELL_UNITS < end].astype(np.int32)))
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
    widest = reach[rows].max(initial=0.0)
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
