"""Ways through a junction that nobody drove, from every arm that was driven in to every arm that was driven out."""

from __future__ import annotations

from collections import deque
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import shapely

from ...core.driving.layers import Lanes
from .sources import SAME_LEVEL, RoadMapSource, is_stated, wrapped

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

    Parameters
    ----------
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
    ways = _ways(lanes)
    areas = [_area(*lanes.borders(way.row)) for way in ways]
    group = list(range(len(ways)))
    for a in range(len(ways)):
        for b in range(a):
            if group[a] != group[b] and _touch(areas[a], areas[b]):
                group = [group[b] if member == group[a] else member for member in group]
    return [[ways[k] for k in np.flatnonzero(np.array(group) == number)] for number in sorted(set(group)) if group.count(number) > 1]


def _touch(one, other):
    return abs(one[1] - other[1]) < SAME_LEVEL and one[0].intersects(other[0])


def _ways(lanes):
    """Every connector between two lanes that are driven."""
    row_of = {name: k for k, name in enumerate(lanes.lane_id)}
    before = {name: k for k, names in enumerate(lanes.successors) if lanes.type[k] == "driving" for name in names}
    ways = [_Way(k, before[lanes.lane_id[k]], row_of[lanes.successors[k][0]]) for k in range(len(lanes))
            if lanes.type[k] == "connector" and lanes.lane_id[k] in before and len(lanes.successors[k]) == 1]
    return [way for way in ways if lanes.type[way.exit] == "driving"]


def _area(left, right):
    """(polygon between two borders, metres of height)."""
    return shapely.make_valid(shapely.Polygon(np.concatenate([left, right[::-1]])[:, :2])), float(left[:, 2].mean())


def _missing_way(lanes, group, entry, exit):
    """(row that is left, row that is entered, left border, right border) of the way between two arms; None where there is one, or can be none."""
    turn = wrapped(_heading(lanes, exit, 0) - _heading(lanes, entry, -1))
    entries, exits = _arm(lanes, entry, -1), _arm(lanes, exit, 0)
    if abs(turn) > MOST_TURNED or _is_led_to(lanes, entries, exits):
        return None
    first, last = (next(way.row for way in group if way[which] == row) for which, row in ((1, entry), (2, exit)))
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
    waiting, visited = deque(starts), set(starts)
    while waiting:
        row = waiting.popleft()
        if row in goals:
            return True
        for name in lanes.successors[row]:
            if row_of[name] not in visited:
                visited.add(row_of[name])
                waiting.append(row_of[name])
    return False


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
    values = {"road": road, "lane": number, "lane_id": name, "type": "connector", "direction": int(lanes.direction[entry]), "left_line": "none",
              "right_line": "none", "left_kind": "none", "right_kind": "none", "left_pattern": "", "right_pattern": "", "status": "inferred",
              "confidence": UNDRIVEN_CONFIDENCE * float(min(lanes.confidence[entry], lanes.confidence[exit])), "station": float(lanes.end[entry]),
              "end": float(lanes.end[entry]), "other": ""}
    columns = {}
    for field, value in values.items():
        column = getattr(lanes, field)
        columns[field] = np.append(column, np.array([value], column.dtype))
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
