"""Lanes made fit for a map: one border between neighbours, and ways through junctions from every arm to every other."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import shapely
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from ...core.common.arrays import linked_groups, members_of
from ...core.driving.layers import Lanes
from .sources import LEAST_CURB, SAME_LEVEL, RoadMapSource, areas_of, is_stated, wrapped

WIDEST_DOUBLE = 0.5       # m between the stripes of a double line at the most; what is wider is a median
SAME_VERTEX = 0.001       # m in plan between vertices that are one
SAME_ROAD_RISE = 0.3      # m in height between vertices of one road
SAME_SECTION_ALONG = 0.1  # m along the road between vertices of one cross-section
MOST_LANE_OVERLAP = 0.35  # m that a lane placed where paint is missing may lie on its neighbour: a tenth of a lane
LEAST_STRIPE_GAP = 0.12   # m between the middles of two stripes at the least: what is nearer is one line measured twice
TOLD_MOVE = 0.05          # m from which the user is told
SHARED_FADE = 10.0        # m of border beyond a common one in which it comes back to its own place
MOST_MET = 0.01          # m by which a way of a map from elsewhere may miss its lane and is led there: half of the tolerance of an export
FACING_TRIED = 4          # vertices around one that may face it


class _SharedBorders(NamedTuple):
    """lanes : Lanes with common borders; gaps : (P, 2) median metres between the stripes at each left and right border, 0 for one line;"""

    lanes: Lanes
    gaps: np.ndarray
    moved: float   # largest metres that a border was moved


def with_shared_borders(source: RoadMapSource) -> RoadMapSource:
    """A road map whose lanes share their borders, with a note for the user where one was moved by more than a line is wide."""
    joined = meet_lanes(source.lanes)
    shared = share_borders(joined)
    notes = list(source.notes)
    if shared.moved > TOLD_MOVE:
        notes.append(f"Maps have one border between two lanes: facing borders, as of a double line, were led along their middle, moved by up to "
                     f"{shared.moved:.2f} m.")
    rise = np.abs(np.concatenate([shared.lanes.left - source.lanes.left, shared.lanes.right - source.lanes.right])[:, 2])
    if is_stated(source.lanes) and len(rise) and rise.max() > 2 * MOST_MET:
        row = int(np.argmax(rise)) % len(source.lanes.left)
        name = source.lanes.lane_id[int(np.searchsorted(source.lanes.start, row, side="right")) - 1]
        x, y, _ = source.lanes.left[row]
        notes.append(f"Lanes of the map do not lead on at one height; their borders were led to the middle, moved by up to {rise.max():.2f} m at "
                     f"lane {name} near x {x:.1f}, y {y:.1f}. Correct the heights where the map was made.")
    return replace(source, lanes=shared.lanes, gaps=shared.gaps, middles=(joined.left + joined.right) / 2, notes=notes)


def meet_lanes(lanes: Lanes) -> Lanes:
    """Lanes whose connectors begin and end at the corners of the lanes that they join, where they miss them by less than WIDEST_DOUBLE, or by
    less than MOST_MET on a map from elsewhere.

    The last metres of a connector, SHARED_FADE or half of it, follow its end.
    """
    row_of = {name: k for k, name in enumerate(lanes.lane_id)}
    left, right = lanes.left.copy(), lanes.right.copy()
    most = MOST_MET if is_stated(lanes) else WIDEST_DOUBLE
    joints = [joint for k, names in enumerate(lanes.successors) for name in names if name in row_of
              for joint in ((k, row_of[name], True), (row_of[name], k, False))]
    for connector, lane, at_end in joints:   # whether the lane follows the connector
        if lanes.type[connector] != "connector" or lanes.type[lane] == "connector":
            continue
        rows = np.arange(lanes.start[connector], lanes.start[connector + 1])
        end_row, corner_row = (rows[-1], lanes.start[lane]) if at_end else (rows[0], lanes.start[lane + 1] - 1)
        for side in (left, right):
            step = side[corner_row] - side[end_row]
            distance = np.hypot(*step[:2])
            if SAME_VERTEX < distance < most or distance < SAME_VERTEX and step[2]:
                side[rows] += _fading(side[rows], at_end)[:, None] * step
    return replace(lanes, left=left, right=right)


def _fading(line, at_end):
    """(n,) share from 0 to 1 that a line's places have of what its end is moved."""
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T)))
    distance = along[-1] - along if at_end else along
    share = np.clip(1 - distance / max(min(SHARED_FADE, along[-1] / 2), 1e-6), 0.0, 1.0)
    return share**2 * (3 - 2 * share)


def share_borders(lanes: Lanes) -> _SharedBorders:
    """Lanes whose borders are the same line where they face each other.

    Maps for planners and simulators know one border between two lanes. A double line has two stripes, each the border of its lane; and a lane
    placed where paint was missing may lie some centimetres beside the measured one. Vertices of one cross-section that face each other move to
    their middle. Where the common border ends, its lanes come back to their own borders along SHARED_FADE. On a map from elsewhere what lies
    apart stays apart, and a curb between two lanes keeps its bottom and its top.

    lanes : Lanes in metres; lanes of one road with vertices in the same cross-sections, as the layer LANES has them
    Returns _SharedBorders; the number and order of vertices stay as they are
    """
    rows = np.concatenate([lanes.left, lanes.right])
    nodes, first = numbered(rows)
    count = len(lanes.left)
    if is_stated(lanes):
        first, nodes = first[nodes], _levels(lanes, nodes, rows)
        first = first[np.unique(nodes, return_index=True)[1]]
    places = rows[first]
    # a place has one height, that of all lanes beside it
    places[:, 2] = np.bincount(nodes, rows[:, 2]) / np.bincount(nodes)
    pairs, beyond = (np.empty((0, 2), int), np.empty(0)) if is_stated(lanes) else _facing(lanes, nodes, places)
    if not len(pairs):
        return _SharedBorders(replace(lanes, left=places[nodes[:count]], right=places[nodes[count:]]), np.zeros((len(lanes), 2)), 0.0)
    apart = places[pairs[:, 1]] - places[pairs[:, 0]]
    move = np.zeros_like(places)
    np.add.at(move, pairs[:, 0], apart / 2)
    np.add.at(move, pairs[:, 1], -apart / 2)
    target = places + move + _faded(lanes, nodes, places, pairs, move)
    target[pairs[:, 1]] = target[pairs[:, 0]]   # the same to the last digit
    moved = target[nodes]
    gap = np.zeros(len(places))
    gap[pairs.ravel()] = np.repeat(beyond, 2)
    gaps = np.array([[np.median(gap[nodes[side + a:side + b]]) for side in (0, count)] for a, b in zip(lanes.start[:-1], lanes.start[1:])])
    gaps[gaps <= LEAST_STRIPE_GAP] = 0.0
    return _SharedBorders(replace(lanes, left=moved[:count], right=moved[count:]), gaps, float(np.hypot(*(target - places)[:, :2].T).max()))


def numbered(rows: np.ndarray, rise: float = SAME_ROAD_RISE) -> tuple[np.ndarray, np.ndarray]:
    """((V,) number of each of (V, 3) vertices' place, (N,) a vertex of each place): nearer than SAME_VERTEX, and `rise` in height, are one."""
    near = cKDTree(rows[:, :2]).query_pairs(SAME_VERTEX, output_type="ndarray")
    near = near[np.abs(rows[near[:, 0], 2] - rows[near[:, 1], 2]) < rise] if len(near) else near.reshape(0, 2)
    first = np.arange(len(rows))
    np.minimum.at(first, near[:, 1], near[:, 0])
    first, nodes = np.unique(first, return_inverse=True)
    return nodes, first


def cuts_beside(lanes: Lanes, left: np.ndarray, right: np.ndarray, among: np.ndarray) -> set[int]:
    """Numbers of the places at which every lane beside them is cut, as one of them begins, ends or is cut there.

    left, right : (V,) numbers of the places of the vertices of borders; among : (V,) bool, of the lanes that count
    """
    rows = np.concatenate([lanes.start[:-1], lanes.start[1:] - 1]).astype(int)
    rows = rows[among[rows]]
    cuts = set(left[rows].tolist()) | set(right[rows].tolist())
    while True:
        numbers = np.array(sorted(cuts))
        one_sided = np.flatnonzero((np.isin(left, numbers) ^ np.isin(right, numbers)) & among)
        new_cuts = (set(left[one_sided].tolist()) | set(right[one_sided].tolist())) - cuts
        if not new_cuts:
            return cuts
        cuts |= new_cuts


def _levels(lanes, nodes, rows):
    """(V,) number of each of (V, 3) vertices' place and height: of a curb the bottom and the top are two; where a lane continues there is one."""
    order = np.lexsort((rows[:, 2], nodes))
    apart = (np.diff(nodes[order]) > 0) | (np.diff(rows[order, 2]) > LEAST_CURB)
    level = np.empty(len(rows), int)
    level[order] = np.append(0, np.cumsum(apart))
    row_of, count = {name: k for k, name in enumerate(lanes.lane_id)}, len(lanes.left)
    ends = [(lanes.start[k + 1] - 1, lanes.start[row_of[name]]) for k, names in enumerate(lanes.successors) for name in names if name in row_of]
    led = np.array(ends, int).reshape(-1, 2)
    led = np.concatenate([led, led + count])
    first, second = level[led[nodes[led[:, 0]] == nodes[led[:, 1]]]].T
    return linked_groups(first, second, int(level.max()) + 1)[level]


def _inward(lanes, nodes, count):
    """((N, 2) unit vector from each place to the other border of its lane, (N,) whether it bounds lanes on one side only)."""
    across = (lanes.right - lanes.left)[:, :2]
    across = across / np.maximum(np.hypot(*across.T), 1e-9)[:, None]
    ordinary = np.repeat(lanes.type != "connector", np.diff(lanes.start))
    vectors, counted = np.concatenate([across, -across]), np.tile(ordinary, 2)
    total, number = np.zeros((count, 2)), np.zeros(count)
    np.add.at(total, nodes[counted], vectors[counted])
    np.add.at(number, nodes[counted], 1)
    mean = total / np.maximum(number, 1)[:, None]
    size = np.hypot(*mean.T)
    return mean / np.maximum(size, 1e-9)[:, None], (number > 0) & (size > 0.8)


def _facing(lanes, nodes, places):
    """((M, 2) places that are each other's nearest, with their lanes on opposite sides; (M,) metres between the lanes, negative where they
    overlap)."""
    inward, free = _inward(lanes, nodes, len(places))
    free = np.flatnonzero(free)
    if len(free) < 2:
        return np.empty((0, 2), int), np.empty(0)
    near, neighbours = cKDTree(places[free, :2]).query(places[free, :2], k=min(FACING_TRIED + 1, len(free)), distance_upper_bound=WIDEST_DOUBLE)
    best = np.full(len(places), -1)
    least, gaps = np.full(len(places), np.inf), np.zeros(len(places))
    for distance, neighbour in zip(near.T[1:], neighbours.T[1:]):
        rows = np.flatnonzero(np.isfinite(distance))
        a, b = free[rows], free[neighbour[rows]]
        gap = places[b] - places[a]
        beyond = -np.einsum("ij,ij->i", gap[:, :2], inward[a])       # positive outside of a's lane
        along = np.abs(gap[:, 0] * inward[a, 1] - gap[:, 1] * inward[a, 0])
        good = (np.einsum("ij,ij->i", inward[a], inward[b]) < -0.8) & (beyond > -MOST_LANE_OVERLAP) & (along < SAME_SECTION_ALONG)
        good &= (np.abs(gap[:, 2]) < SAME_ROAD_RISE) & (distance[rows] < least[a])
        best[a[good]], least[a[good]], gaps[a[good]] = b[good], distance[rows][good], beyond[good]
    mutual = np.flatnonzero(best >= 0)
    mutual = mutual[(best[best[mutual]] == mutual) & (mutual < best[mutual])]
    return np.stack([mutual, best[mutual]], axis=1), gaps[mutual]


def _faded(lanes, nodes, places, pairs, move):
    """(N, 3) how far places beyond the ends of common borders follow them."""
    count = len(lanes.left)
    steps = np.ones(count, bool)
    steps[lanes.start[1:] - 1] = False
    first = np.flatnonzero(steps)
    first = np.concatenate([first, first + count])
    a, b = nodes[first], nodes[first + 1]
    length = np.hypot(*(places[b] - places[a])[:, :2].T)
    size = len(places)
    graph = coo_matrix((np.maximum(length, 1e-6), (a, b)), shape=(size, size)).tocsr()
    common = np.unique(pairs)
    distance, _, source = dijkstra(graph, directed=False, indices=common, limit=SHARED_FADE, return_predecessors=True, min_only=True)
    follows = np.flatnonzero(np.isfinite(distance) & (distance > 0))
    share = 1 - distance[follows] / SHARED_FADE
    moves = np.zeros_like(places)
    moves[follows] = move[source[follows]] * (share**2 * (3 - 2 * share))[:, None]
    return moves


# Borders moved within the tolerance of the map, so that the middles of its lanes are the driving lines.

NEAR_LINE = 0.15   # m from the middle of a lane within which a driving line is its own
ROUNDS = 50        # of moving borders: neighbours share them


def with_driven_middles(source: RoadMapSource, most: float) -> RoadMapSource:
    """A road map whose lanes have their driving lines in their middle, as far as it takes to move no border by more than `most` metres.

    Driving lines are smooth, borders are as they were measured; a map of borders alone tells where to drive by the middle between them. Of two
    lanes that share a border each asks for its own move; the least squares of what is missed are looked for, within the limit.

    source : RoadMapSource with common borders
    most : metres
    """
    lanes = source.lanes
    if not source.driving_lines or most <= 0 or is_stated(lanes):   # a map from elsewhere has its driving lines from its borders
        return source
    across = (lanes.left - lanes.right)[:, :2]
    across = across / np.maximum(np.hypot(*across.T), 1e-9)[:, None]
    middles = source.middles if source.middles is not None else (lanes.left + lanes.right) / 2
    offsets = _beside(source, middles[:, :2], across)
    rows = np.flatnonzero(np.isfinite(offsets))
    if not len(rows):
        return source
    nodes, first = numbered(np.concatenate([lanes.left, lanes.right]))
    left, right = nodes[:len(lanes.left)], nodes[len(lanes.left):]
    sides, lateral = np.concatenate([left[rows], right[rows]]), np.tile(across[rows], (2, 1))
    way = np.zeros((len(first), 2))
    way[sides] = lateral
    turned = np.sign((lateral * way[sides]).sum(1))   # neighbours may be driven against each other
    counts, move = np.maximum(np.bincount(sides, minlength=len(first)), 1), np.zeros(len(first))
    for _ in range(ROUNDS):
        shift = (turned * move[sides]).reshape(2, -1).mean(0)
        change = np.bincount(sides, turned * np.tile(offsets[rows] - shift, 2), minlength=len(first))
        move = np.clip(move + change / counts, -most, most)
    way = way * move[:, None]
    moved = [np.c_[side[:, :2] + way[numbers], side[:, 2]] for side, numbers in ((lanes.left, left), (lanes.right, right))]
    return replace(source, lanes=replace(lanes, left=moved[0], right=moved[1]))


def _beside(source, middles, across):
    """(V,) metres by which the driving line lies left of the middle of its lane, NaN where none lies near."""
    lanes, offsets = source.lanes, np.full(len(middles), np.nan)
    lines = [geometry for geometry, row in source.driving_lines if geometry is not None and row.get("status") in (None, "measured")]
    driven = np.flatnonzero(np.repeat(lanes.type == "driving", np.diff(lanes.start)))
    if not lines or not len(driven):
        return offsets
    lines, points = shapely.force_2d(np.array(lines, object)), shapely.points(middles[driven])
    indices, line = shapely.STRtree(lines).query_nearest(points, max_distance=NEAR_LINE, all_matches=False)
    foot = shapely.get_coordinates(shapely.line_interpolate_point(lines[line], shapely.line_locate_point(lines[line], points[indices])))
    rows = driven[indices]
    vectors = foot - middles[rows]
    abreast = np.abs(vectors[:, 0] * across[rows, 1] - vectors[:, 1] * across[rows, 0]) < np.abs((vectors * across[rows]).sum(1)) + 1e-3
    offsets[rows[abreast]] = (vectors * across[rows]).sum(1)[abreast]
    return offsets


# Ways through a junction that nobody drove, from every arm that was driven in to every arm that was driven out.

MOST_TURNED = 2.5        # rad: who turns more drives back on the arm that he came from
LEAST_TURNED = 0.5       # rad from which a way leaves the outermost lane of its arm on that side
ARM_WIDTH = 20.0         # m across within which lane ends are of one arm
ARM_DEPTH = 10.0         # m along within which they are
HEADED_ALIKE = 0.4       # rad between lanes of one arm, and between ways that run together
RUN_TOGETHER = 1.5       # m between the middles of two ways that share a stretch, as of the ring of a roundabout
LONGEST_BLEND = 10.0     # m of it along which one way passes into the other
WAY_STEP = 0.5           # m between the vertices of a way
NARROWEST_TURN = 2.0     # m radius of the inner border at the least
UNDRIVEN_CONFIDENCE = 0.25   # half of that of a way that was driven without lines


class _Way(NamedTuple):
    """A connector and the rows of the lanes that it joins."""

    row: int
    entry: int
    exit: int


def with_inferred_ways(source: RoadMapSource) -> RoadMapSource:
    """A road map in which every arm of a junction that was driven in leads to every one that was driven out.

    The drive shows some ways through a junction. Where two of them run together for a while, as on the ring of a roundabout, who came by the one
    can leave by the other; else a smooth curve leads from lane to lane, for a turn from the outermost lane on its side to the outermost one.
    These connectors are `inferred`, with half of the confidence of those that were driven.

    source : RoadMapSource, checked; one of a map from elsewhere stays as it is, as that states all of its ways
    """
    lanes, added = source.lanes, 0
    if is_stated(lanes):
        return source
    for group in _junctions(lanes):
        for entry in sorted({way.entry for way in group}):
            for exit in sorted({way.exit for way in group}):
                way = _missing_way(lanes, group, entry, exit)
                if way is not None:
                    lanes, added = _with_connector(lanes, *way), added + 1
    if not added:
        return source
    note = f"{added} ways through junctions were driven by nobody; they join arms that were, and are inferred."
    return replace(source, lanes=lanes, notes=[*source.notes, note])


def _junctions(lanes):
    """Lists of _Way whose areas touch."""
    row_of = {name: k for k, name in enumerate(lanes.lane_id)}
    before = {name: k for k, names in enumerate(lanes.successors) if lanes.type[k] == "driving" for name in names}
    # every connector between two lanes that are driven
    ways = [_Way(k, before[lanes.lane_id[k]], row_of[lanes.successors[k][0]]) for k in range(len(lanes))
            if lanes.type[k] == "connector" and lanes.lane_id[k] in before and len(lanes.successors[k]) == 1]
    ways = [way for way in ways if lanes.type[way.exit] == "driving"]
    areas, height = areas_of(lanes, [way.row for way in ways]), np.array([lanes.borders(way.row)[0][:, 2].mean() for way in ways])
    first, second = shapely.STRtree(areas).query(areas, predicate="intersects")
    level = np.abs(height[first] - height[second]) < SAME_LEVEL
    group = linked_groups(first[level], second[level], len(ways))
    return [[ways[k] for k in rows] for _, rows in members_of(group) if len(rows) > 1]


def _missing_way(lanes, group, entry, exit):
    """(row that is left, row that is entered, left border, right border) of the way between two arms; None where there is one, or can be none."""
    turn = wrapped(_heading(lanes, exit, 0) - _heading(lanes, entry, -1))
    entries, exits = _arm(lanes, entry, -1), _arm(lanes, exit, 0)
    if abs(turn) > MOST_TURNED or _is_led_to(lanes, entries, exits):
        return None
    first, last = (next(way.row for way in group if way[field] == row) for field, row in ((1, entry), (2, exit)))
    borders = _joined(lanes.borders(first), lanes.borders(last))
    if borders is None:
        if abs(turn) > LEAST_TURNED:   # arms are sorted from right to left
            entry, exit = (entries[0], exits[0]) if turn < 0 else (entries[-1], exits[-1])
        borders = _curved(lanes, entry, exit)
    return (entry, exit, *borders) if borders is not None and _is_drivable(*borders) else None


def _arm(lanes, row, end):
    """Rows of the lanes of one direction that end (end -1) or begin (0) beside one, from right to left."""
    heading, place = _heading(lanes, row, end), _place(lanes, row, end)
    along, across = np.array([np.cos(heading), np.sin(heading)]), np.array([-np.sin(heading), np.cos(heading)])
    members = []
    for k in np.flatnonzero((lanes.type == "driving") & (lanes.road == lanes.road[row]) & (lanes.direction == lanes.direction[row])).tolist():
        offset = _place(lanes, k, end) - place
        if abs(offset @ along) < ARM_DEPTH and abs(offset @ across) < ARM_WIDTH and abs(wrapped(_heading(lanes, k, end) - heading)) < HEADED_ALIKE:
            members.append((float(offset @ across), k))
    return [k for _, k in sorted(members)]


def _is_led_to(lanes, starts, goals):
    row_of = {name: k for k, name in enumerate(lanes.lane_id)}
    reached, new = set(), set(starts)
    while new:
        reached |= new
        new = {row_of[name] for row in new for name in lanes.successors[row]} - reached
    return not reached.isdisjoint(goals)


def _joined(first, last):
    """(left, right) along the first way up to where it runs together with the last, and along that one; None where they never do."""
    middles = [(left + right)[:, :2] / 2 for left, right in (first, last)]
    headings = [np.unwrap(np.arctan2(*np.gradient(middle, axis=0).T[::-1])) for middle in middles]
    apart = np.hypot(*(middles[0][:, None] - middles[1][None]).transpose(2, 0, 1))
    together = (apart < RUN_TOGETHER) & (np.abs(wrapped(headings[0][:, None] - headings[1][None])) < HEADED_ALIKE)
    rows = np.flatnonzero(together.any(1))
    if not len(rows):
        return None
    rows = rows[:int(np.argmax(np.append(np.diff(rows) > 1, True))) + 1]   # the first stretch
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(middles[0], axis=0).T)))
    rows = rows[along[rows] <= along[rows[0]] + LONGEST_BLEND]
    # places of the last way beside those of the first one, as fractions of its rows
    line = shapely.linestrings(middles[1])
    lengths = np.append(0.0, np.cumsum(np.hypot(*np.diff(middles[1], axis=0).T)))
    stations = shapely.line_locate_point(line, shapely.points(middles[0][rows]))
    rows, stations = rows[np.append(True, np.diff(stations) > 0)], stations[np.append(True, np.diff(stations) > 0)]
    if len(rows) < 2 or rows[0] == 0 or (np.diff(stations) <= 0).any():
        return None
    share = ((along[rows] - along[rows[0]]) / (along[rows[-1]] - along[rows[0]]))[:, None]
    share = share**2 * (3 - 2 * share)
    rest = lengths > stations[-1] + WAY_STEP / 2
    borders = []
    for border, last_border in zip(first, last):
        goal = np.stack([np.interp(stations, lengths, column) for column in last_border.T], axis=1)
        borders.append(np.concatenate([border[:rows[0]], border[rows] * (1 - share) + goal * share, last_border[rest]]))
    return tuple(borders)


def _curved(lanes, entry, exit):
    """(left, right) of a cubic from the end of one lane to the beginning of another, with their headings."""
    ends = [_place(lanes, entry, -1), _place(lanes, exit, 0)]
    ways = [np.array([np.cos(heading), np.sin(heading)]) for heading in (_heading(lanes, entry, -1), _heading(lanes, exit, 0))]
    distance = float(np.hypot(*(ends[1] - ends[0])))
    if (ends[1] - ends[0]) @ ways[0] <= 0 or (ends[1] - ends[0]) @ ways[1] <= 0:
        return None
    u = np.linspace(0.0, 1.0, max(int(distance / WAY_STEP), 8) + 1)[:, None]
    a, b, c, d = 2 * u**3 - 3 * u**2 + 1, u**3 - 2 * u**2 + u, 3 * u**2 - 2 * u**3, u**3 - u**2
    middle = a * ends[0] + b * distance * ways[0] + c * ends[1] + d * distance * ways[1]
    ahead = np.gradient(middle, axis=0)
    across = np.c_[-ahead[:, 1], ahead[:, 0]] / np.hypot(*ahead.T)[:, None]
    corners = [[border[end] for border in lanes.borders(row)] for row, end in ((entry, -1), (exit, 0))]
    borders = []
    for side, sign in ((0, 1), (1, -1)):
        half = [float(np.hypot(*(corner[0] - corner[1])[:2])) / 2 for corner in corners]
        line = np.c_[middle + sign * across * (half[0] * (1 - c) + half[1] * c), np.zeros(len(u))]
        # the last places are the corners of the lanes themselves
        line[:, :2] += (1 - c) * (corners[0][side] - line[0])[:2] + c * (corners[1][side] - line[-1])[:2]
        line[:, 2] = (corners[0][side][2] * (1 - c) + corners[1][side][2] * c)[:, 0]
        borders.append(line)
    return tuple(borders)


def _is_drivable(left, right):
    """Whether neither border turns back or bends more than a vehicle can."""
    for border in (left, right):
        line = shapely.linestrings(border[:, :2])
        steps = np.diff(border[:, :2], axis=0)
        turns = np.abs(wrapped(np.diff(np.arctan2(steps[:, 1], steps[:, 0]))))
        room = (np.hypot(*steps[:-1].T) + np.hypot(*steps[1:].T)) / 2
        if not line.is_simple or (turns > room / NARROWEST_TURN + 0.1).any():
            return False
    return not shapely.linestrings(left[:, :2]).crosses(shapely.linestrings(right[:, :2]))


def _with_connector(lanes, entry, exit, left, right):
    """Lanes with a connector between two rows."""
    road = int(lanes.road[entry])
    number = int(lanes.lane[lanes.road == road].max()) + 1
    name = f"{road}.{number}.1"
    values = Lanes.gathered([{
        "road": road, "lane": number, "lane_id": name, "type": "connector", "direction": lanes.direction[entry], "status": "inferred",
        "confidence": UNDRIVEN_CONFIDENCE * min(lanes.confidence[entry], lanes.confidence[exit]), "station": lanes.end[entry],
        "end": lanes.end[entry]}])
    columns = {field: np.append(getattr(lanes, field), value) for field, value in values.items()}
    successors = [(*names, name) if k == entry else names for k, names in enumerate(lanes.successors)]
    return Lanes(**columns, successors=[*successors, (lanes.lane_id[exit],)], left=np.concatenate([lanes.left, left]),
                 right=np.concatenate([lanes.right, right]), start=np.append(lanes.start, lanes.start[-1] + len(left)), crs=lanes.crs)


def _place(lanes, row, end):
    left, right = lanes.borders(row)
    return (left[end] + right[end])[:2] / 2


def _heading(lanes, row, end):
    """Radians in which a lane is driven at its end (-1) or beginning (0)."""
    middle = sum(lanes.borders(row))[:, :2] / 2
    reach = min(len(middle) - 1, 4)
    way = middle[-1] - middle[-1 - reach] if end else middle[reach] - middle[0]
    return float(np.arctan2(way[1], way[0]))
