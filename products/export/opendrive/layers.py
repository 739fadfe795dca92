"""The lanes and lines of an OpenDRIVE map as layers like ours."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ....core.common.progress import Progress
from ....core.driving.layers import Lanes
from ..map_layers import MapLayers, MapLine, plan_length, without_repeats
from ..sources import LEAST_CURB
from .model import DRIVEN_TYPES, LaneNetwork, MapLane, OpenDriveMap, travel

LANE_TYPE_OF = {"shoulder": "shoulder", "stop": "shoulder", "border": "shoulder", "parking": "parking", "biking": "bicycle", "restricted": "hatched",
         "median": "median"}
PATTERN_OF_MARK = {"solid": "solid", "broken": "dashed", "solid solid": "double-solid",
                   "broken broken": "double-dashed", "solid broken": "solid-dashed", "broken solid": "dashed-solid", "botts dots": "dashed"}
RAISED = ("curb", "sidewalk", "walking")
NO_LANES = (*RAISED, "none", "rail", "tram")
SHORTEST_SECTION = 0.005   # m: of shorter ones the ends would be one vertex
NEGATIVE_WIDTH = -0.01     # m: less is the rounding of a file
BORDER_JUMP = 0.01     # m: half of the tolerance of an export
ROADS_NAMED = 20        # roads that one sentence names
LEAST_WIDTH = 0.05     # m: lanes that are narrower everywhere are none


def layers_of_opendrive(whole: OpenDriveMap, crs: str = "", progress: Progress = Progress()) -> MapLayers:
    """Lanes, painted borders and edges of a map; `crs` is the WKT of its coordinates, "" where unknown.

    Every section of a lane is a piece, whose lane_id is "road.lane.section"; lanes of roads in junctions are connectors.
    Sidewalks are no lanes of ours: where one begins there is an edge.
    """
    rows: list[dict[str, Any]] = []
    layers, network = MapLayers(Lanes.of_pieces([], crs)), LaneNetwork(whole)
    numbers, faults = _road_numbers(whole), _Faults()
    for count, road in enumerate(whole.roads):
        surface = road.surface
        faults.jumps += [(road.id, *jump) for jump in surface.jumps() if jump[1] > BORDER_JUMP]
        for number, section in enumerate(road.sections):
            if road.section_end(number) - section.s > SHORTEST_SECTION:
                _add_section(rows, layers.lines, whole, network, surface, number, numbers[road.id], faults)
        progress.report((count + 1) / len(whole.roads))
    layers.lanes = Lanes.of_pieces(_existing(rows), crs)
    if whole.problems:
        line, text = whole.problems[0]
        layers.notes.append(f"{len(whole.problems)} parts of the file were passed over; the first: line {line}, {text}")
    layers.notes += faults.said()
    return layers


@dataclass
class _Faults:
    """What is wrong with the geometry of the map."""

    jumps: list[tuple[str, float, float, int]] = field(default_factory=list)   # (road, s, metres by which a border jumps there, its lane)
    folds: list[tuple[str, int, np.ndarray]] = field(default_factory=list)   # (road, lane, place) of borders
    negative: list[tuple[str, int, float, float]] = field(default_factory=list)   # (road, lane, least width, s)

    def said(self) -> list[str]:
        sentences = []
        if self.jumps:
            sentences.append(self._said_jumps())
        if self.folds:
            road, lane, place = self.folds[0]
            sentences.append(f"{len(self.folds)} borders of lanes fold back over themselves, as a curve is tighter there than the border is far from "
                             f"the reference line. The folds were cut off. The first is of road {road}, lane {lane}, near x {place[0]:.1f}, "
                             f"y {place[1]:.1f}.")
        if self.negative:
            road, lane, width, s = self.negative[0]
            sentences.append(f"{len(self.negative)} lanes have a width below 0, which was taken as 0. The first is lane {lane} of road {road} with "
                             f"{width:.2f} m at s {s:.1f} m. Correct them where the map was made.")
        return sentences

    def _said_jumps(self) -> str:
        """Every road with gaps or kinks, those with the largest first."""
        roads: dict[str, list[tuple[str, float, float, int]]] = {}
        for jump in sorted(self.jumps, key=lambda jump: -jump[2]):
            roads.setdefault(jump[0], []).append(jump)
        named = []
        for jumps in list(roads.values())[:ROADS_NAMED]:
            road, s, metres, lane = jumps[0]
            named.append(f"road {road}, lane {lane}, by {metres:.3f} m at s {s:.1f} m" + (f" and less at {len(jumps) - 1} more" if jumps[1:] else ""))
        rest = list(roads.values())[ROADS_NAMED:]
        if rest:
            named.append(f"{len(rest)} more roads, by at most {rest[0][0][2]:.3f} m")
        return (f"Gaps or kinks of the reference line, or steps of heights and widths ({len(roads)} of the roads), make borders of lanes jump by "
                f"more than {BORDER_JUMP:g} m: {'; '.join(named)}. Correct them where the map was made.")


def _add_section(rows, lines, whole, network, surface, number, road_number, faults):
    """The lanes and lines of one section."""
    road, section = surface.road, surface.road.sections[number]
    s = surface.stations(number)
    offsets = surface.offsets(number, s)
    for id, lane in section.lanes.items():
        if id == 0:
            lines += _painted(road_number, lane, section.s, s, whole.placed(surface.places(s, offsets[0])), "centre")
            continue
        (inner, _), (outer, fold) = (surface.without_folds(s, points) for points in surface.borders(number, id, s, offsets))
        inner, outer = whole.placed(inner), whole.placed(outer)
        if fold is not None:
            faults.folds.append((road.id, id, whole.placed(fold[None])[0]))
        if not lane.border and len(lane.width) and (least := lane.width.least(float(s[-1]) - section.s))[0] < NEGATIVE_WIDTH:
            faults.negative.append((road.id, id, least[0], section.s + least[1]))
        lines += _painted(road_number, lane, section.s, s, outer, _kind(section.lanes, id))
        lines += _edges(surface, number, id, s, inner, outer, road_number)
        if lane.type not in NO_LANES and np.abs(offsets[id] - offsets[surface.inside(number, id)]).max() >= LEAST_WIDTH:
            rows.append({**_lane(network, surface, number, id, s, inner, outer), "road": road_number})


def _edges(surface, number, id, s, inner, outer, road_number):
    """The edges of the road at the borders of a lane."""
    lanes = surface.road.sections[number].lanes
    if _kind(lanes, id) == "pavement" and plan_length(outer) > LEAST_WIDTH:
        yield MapLine(road_number, "edge", "main", "", without_repeats(outer), side="left" if id > 0 else "right", edge="pavement")
    if _edge(lanes, id) and plan_length(inner) > LEAST_WIDTH:
        yield _curb(surface, number, id, s, inner, road_number)


def _lane(network, surface, number, id, s, inner, outer):
    """The values of a lane, its borders in the direction of travel."""
    road, lanes = surface.road, surface.road.sections[number].lanes
    way, driven = travel(road, id), lanes[id].type in DRIVEN_TYPES
    sides = [(border, _kind(lanes, lane), _pattern(lanes, lane)) for border, lane in ((inner, surface.inside(number, id)), (outer, id))]
    left, right = sides[::-1] if id > 0 else sides
    if driven and way < 0:
        left, right = ((border[::-1], kind, pattern) for border, kind, pattern in (right, left))
    return {"left": left[0], "right": right[0], "lane": id, "lane_id": _lane_name(road.id, id, number), "direction": way * driven,
            "type": ("connector" if road.junction != "-1" else "driving") if driven else LANE_TYPE_OF.get(lanes[id].type, "shoulder"),
            "left_kind": left[1], "right_kind": right[1], "left_pattern": left[2], "right_pattern": right[2],
            "successors": [_lane_name(key[0], key[2], key[1]) for key in _following(network, (road.id, number, id))] if driven else [],
            "station": float(s[0]), "end": float(s[-1])}


def _following(network, key, passed=()):
    """The lanes that a lane leads to, those beyond sections that are too short to be shown."""
    for following in network.following(key):
        road = network.roads[following[0]]
        if road.section_end(following[1]) - road.sections[following[1]].s > SHORTEST_SECTION:
            yield following
        elif following not in passed:
            yield from _following(network, following, (*passed, following))


def _curb(surface, number, id, s, inner, road_number):
    """The edge where a raised lane begins: at its foot, with its height, which is that of the top of a curb or of the near side of a sidewalk."""
    lane = surface.road.sections[number].lanes[id]
    near, far = surface.lifts(number, id, s)
    foot = surface.lifts(number, surface.inside(number, id), s)[1]
    rise = float(np.median((far if lane.type == "curb" else near) - foot))
    inner = np.c_[inner[:, :2], inner[:, 2] - near + foot]
    return MapLine(road_number, "edge", "main", "", without_repeats(inner), side="left" if id > 0 else "right",
                   height=rise if rise > LEAST_CURB else np.nan)


def _existing(rows):
    """Successors that were no lanes of ours are dropped."""
    lane_ids = {row["lane_id"] for row in rows}
    for row in rows:
        row["successors"] = [name for name in row["successors"] if name in lane_ids]
    return rows


def _lane_name(road: str, lane: int, section: int) -> str:
    """The lane_id of a lane's section; commas part lists of them."""
    return f"{re.sub('[,.]', '_', road)}.{lane}.{section}"


def _road_numbers(whole: OpenDriveMap) -> dict[str, int]:
    """A whole number for every road: its id where all are such, else its place."""
    ids = [road.id for road in whole.roads]
    if all(re.fullmatch(r"\d{1,9}", id) for id in ids):
        return {id: int(id) for id in ids}
    return {id: k for k, id in enumerate(ids, start=1)}


def _kind(lanes: dict[int, MapLane], id: int) -> str:
    """What the outer border of a lane is: centre (of lane 0), lane between two driven lanes, curb, pavement where that ends without one, edge."""
    if id == 0:
        return "centre"
    beyond = lanes.get(id + int(np.sign(id)))
    if beyond is not None and beyond.type in RAISED:
        return "curb"
    if any(mark.type == "edge" for mark in lanes[id].marks):
        return "pavement"
    if beyond is not None and beyond.type in DRIVEN_TYPES and lanes[id].type in DRIVEN_TYPES:
        return "lane"
    return "edge"


def _edge(lanes, id):
    """Whether the inner border of a lane is the edge of the road: what is raised begins here."""
    inside = lanes.get(id - int(np.sign(id)))
    return lanes[id].type in RAISED and (inside is None or inside.type not in RAISED)


def _pattern(lanes, id):
    marks = lanes[id].marks if id in lanes else []
    return PATTERN_OF_MARK.get(marks[0].type, "") if marks else ""


def _painted(number: int, lane: MapLane, start: float, s: np.ndarray, points: np.ndarray, kind: str) -> list[MapLine]:
    """The outer border of a lane, (N, 3) points at s, cut where its paint changes."""
    lines = []
    cuts = [max(mark.s + start, s[0]) for mark in lane.marks] + [s[-1]]
    for mark, first, last in zip(lane.marks, cuts[:-1], cuts[1:]):
        if mark.type not in PATTERN_OF_MARK or last - first < LEAST_WIDTH:
            continue
        stations = np.concatenate([[first], s[(s > first + 1e-6) & (s < last - 1e-6)], [last]])
        piece = without_repeats(np.stack([np.interp(stations, s, values) for values in points.T], axis=1))
        if len(piece) > 1:
            lines.append(MapLine(number, "marking", kind, PATTERN_OF_MARK[mark.type], piece, mark.width))
    return lines
