"""Reads OpenDRIVE 1.1 to 1.8 into a map and its layers, and writes 1.7 and 1.8."""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import replace
from typing import Any

import numpy as np

from ....core.common.errors import RoadExtractionError
from ....core.common.features import MARKING_LINES, ROAD_EDGES, Features
from ....core.common.progress import Progress
from ....core.driving.layers import Lanes
from ..sources import LEAST_CURB, RoadMapSource, add_edge, add_marking_line, plan_length, without_repeats
from ..xml_tree import XmlElement, file_text, read_xml
from .geometry import Cubics, PlanElement, PlanView
from .model import DRIVEN_TYPES, LINK_NAMES, Connection, Junction, LaneNetwork, LaneSection, MapLane, MapRoad, OpenDriveMap, RoadLink, RoadMark
from .objects import FIELD_OF, left_out_of, outlines_of, signals_of

# kind of a geometry -> attributes of its values
GEOMETRIES = {"line": (), "arc": ("curvature",), "spiral": ("curvStart", "curvEnd"), "poly3": tuple("abcd"),
              "paramPoly3": ("aU", "bU", "cU", "dU", "aV", "bV", "cV", "dV")}
SHAPE = ("s", "t", "a", "b", "c", "d")
XODR_KIND = "an OpenDRIVE file"
LONGEST_ROAD, LONGEST_MAP = 200_000.0, 1_000_000.0   # m of one road, and of all: more is no map but a file that shall fill the memory


def read_opendrive(path: str, progress: Progress = Progress()) -> OpenDriveMap:
    """Read an .xodr file; what could not be read of it, such as a road without geometry, is in `problems`.

    Raises RoadExtractionError if the file is no OpenDRIVE, hostile, or has no road that can be read.
    """
    root = read_xml(path, "OpenDRIVE", XODR_KIND, progress)
    whole = _opendrive_of(root)
    if not whole.roads:
        why = f" Line {whole.problems[0][0]}: {whole.problems[0][1]}" if whole.problems else ""
        raise RoadExtractionError(f"{path} has no road that can be read.{why} Choose a file with roads and their geometry.")
    length = sum(road.plan.length for road in whole.roads)
    if length > LONGEST_MAP:
        raise RoadExtractionError(f"The roads of {path} are {length / 1000:,.0f} km long; at most {LONGEST_MAP / 1000:,.0f} km are read at once. "
                                  "Export the map again, or in parts.")
    return whole


def _opendrive_of(root: XmlElement) -> OpenDriveMap:
    """The map of the element <OpenDRIVE>."""
    whole = OpenDriveMap(tree=root)
    header = root.find("header")
    if header is None:
        whole.problems.append((root.line, "there is no <header>."))
    else:
        whole.version = (int(header.number("revMajor", 1.0)), int(header.number("revMinor", 0.0)))
        whole.name = header.get("name")
        sides = [header.number(name, 0.0) for name in ("west", "south", "east", "north") if name in header.attributes]
        whole.bounds = (sides[0], sides[1], sides[2], sides[3]) if len(sides) == 4 else None
        reference, offset = header.find("geoReference"), header.find("offset")
        whole.reference = reference.text if reference is not None else ""
        if offset is not None:
            whole.offset = (offset.number("x", 0.0), offset.number("y", 0.0), offset.number("z", 0.0), offset.number("hdg", 0.0))
    for element in root.all("road"):
        try:
            whole.roads.append(_road_of(element, whole.problems))
        except RoadExtractionError as problem:
            whole.problems.append((element.line, f"road {element.get('id')} cannot be read: {problem}"))
    whole.junctions = [_junction(element) for element in root.all("junction")]
    return whole


def _road_of(element, problems):
    elements = sorted((_geometry(child) for child in element.all("planView", "geometry")), key=lambda one: one.s)
    if not elements:
        raise RoadExtractionError("it has no geometry.")
    if sum(abs(one.length) for one in elements) > LONGEST_ROAD:
        raise RoadExtractionError(f"it is longer than {LONGEST_ROAD / 1000:g} km.")
    road = MapRoad(
        element.get("id"), element.number("length", sum(one.length for one in elements)), PlanView(tuple(elements)), element.get("name"),
        element.get("junction", "-1"), element.get("rule", "RHT"),
        {end: RoadLink(child.get("elementType"), child.get("elementId"), child.get("contactPoint"))
         for end, name in LINK_NAMES.items() if (child := element.find("link", name)) is not None},
        _cubics(element, "elevationProfile", "elevation"), _cubics(element, "lateralProfile", "superelevation"),
        np.array(_rows_of(element, SHAPE, "lateralProfile", "shape")).reshape(-1, len(SHAPE)), _cubics(element, "lanes", "laneOffset"))
    road.sections = sorted((_section_of(child) for child in element.all("lanes", "laneSection")), key=lambda section: section.s)
    if not road.sections:
        problems.append((element.line, f"road {road.id} has no lane section."))
    road.objects = [_object(child) for child in element.all("objects", "object")]
    road.signals = [_signal(child) for name in ("signal", "signalReference") for child in element.all("signals", name)]
    road.speeds = sorted((child.number("s", 0.0), _speed(child.find("speed"))) for child in element.all("type"))
    return road


def _speed(element):
    """km/h of a record of a speed limit; NaN where there is none."""
    try:
        return element.number("max") * {"km/h": 1.0, "mph": 1.609344}.get(element.get("unit"), 3.6) if element is not None else np.nan
    except RoadExtractionError:   # it says that there is no limit
        return np.nan


def _geometry(element):
    numbers = [element.number(name) for name in ("s", "x", "y", "hdg", "length")]
    for child in element.children:
        if child.tag in GEOMETRIES:
            values = tuple(child.number(name) for name in GEOMETRIES[child.tag])
            return PlanElement(*numbers, child.tag, values, child.tag == "paramPoly3" and child.get("pRange", "normalized") == "normalized")
    raise RoadExtractionError(f"line {element.line}: a geometry is none of line, arc, spiral, poly3 and paramPoly3.")


def _rows_of(element, names, *path):
    return [[child.number(name) for name in names] for child in element.all(*path)]


def _cubics(element, *path, start="s"):
    rows = _rows_of(element, (start, *"abcd"), *path)
    return Cubics(np.array(sorted(rows, key=lambda row: row[0]), float).reshape(-1, 5))


def _section_of(element):
    lanes = [_lane_of(child) for side in ("left", "center", "right") for child in element.all(side, "lane")]
    return LaneSection(element.number("s"), {lane.id: lane for lane in lanes}, [lane.id for lane in lanes])


def _lane_of(element):
    lane = MapLane(int(element.number("id")), element.get("type"), _cubics(element, "width", start="sOffset"))
    if not len(lane.width) and element.find("border") is not None:
        lane.width, lane.border = _cubics(element, "border", start="sOffset"), True
    lane.marks = sorted((_mark(child) for child in element.all("roadMark")), key=lambda mark: mark.s)
    for end, name in LINK_NAMES.items():
        lane.links[end] = [int(child.number("id")) for child in element.all("link", name)]
    heights = sorted([child.number(name, 0.0) for name in ("sOffset", "inner", "outer")] for child in element.all("height"))
    lane.heights = np.array(heights, float).reshape(-1, 3)
    lane.speeds = sorted((child.number("sOffset", 0.0), _speed(child)) for child in element.all("speed"))
    lane.data = {child.get("code"): child.get("value") for child in element.all("userData")}
    return lane


def _mark(element):
    mark = RoadMark(element.number("sOffset", 0.0), element.get("type", "none"), element.get("color", "standard"),
                    element.number("width", RoadMark.width), element.get("weight", "standard"))
    lines = list(element.all("type", "line"))
    dashed = next((line for line in lines if line.number("space", 0.0)), None)
    if dashed is not None:
        mark.dash, mark.gap = dashed.number("length", 0.0), dashed.number("space", 0.0)
    if len(lines) == 2:
        mark.apart = abs(lines[0].number("tOffset", 0.0) - lines[1].number("tOffset", 0.0))
    return mark


def _object(element):
    texts = {name: element.get(name) for name in ("id", "type", "subtype", "name", "orientation")}
    numbers = {name: element.number(name, 0.0) for name in ("s", "t", "zOffset", "length", "width", "hdg", "height")}
    outline = element.find("outlines", "outline") or element.find("outline")
    corners = [[corner.number(name, 0.0) for name in (("s", "t", "dz") if corner.tag == "cornerRoad" else ("u", "v", "z"))]
               for corner in (outline.children if outline is not None else ()) if corner.tag in ("cornerRoad", "cornerLocal")]
    local = outline is not None and outline.find("cornerLocal") is not None
    return {**texts, **numbers, "corners": np.array(corners, float).reshape(-1, 3), "local": local}


def _signal(element):
    texts = {name: element.get(name) for name in ("id", "dynamic", "orientation", *FIELD_OF)}
    numbers = {name: element.number(name, 0.0) for name in ("s", "t", "zOffset", "hOffset", "height", "width")}
    pairs = [(int(child.number("fromLane", 0.0)), int(child.number("toLane", 0.0))) for child in element.all("validity")]
    return {**texts, **numbers, "value": element.number("value", -1.0), "validity": pairs, "own": element.tag == "signal"}


def _junction(element):
    # a direct junction links roads without a road between
    return Junction(element.get("id"), element.get("name"), [
        Connection(child.get("id"), child.get("incomingRoad"), child.get("connectingRoad") or child.get("linkedRoad"), child.get("contactPoint"),
                   [(int(link.number("from")), int(link.number("to"))) for link in child.all("laneLink")]) for child in element.all("connection")],
        [(child.get("high"), child.get("low")) for child in element.all("priority")])


# Writing.

def opendrive_text(whole: OpenDriveMap) -> str:
    """The file as text."""
    places = [road.plan.at(np.linspace(0, road.plan.length, max(int(road.plan.length / 5), 1) + 1))[0] for road in whole.roads]
    bounds = np.concatenate(places or [np.zeros((1, 2))])
    return file_text("opendrive.xml", map=whole, bounds=np.round([*bounds.min(0), *bounds.max(0)], 3), link_names=LINK_NAMES, geometries=GEOMETRIES)


# The lanes and lines of an OpenDRIVE map as layers like ours.

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


def layers_of_opendrive(whole: OpenDriveMap, crs: str = "", progress: Progress = Progress()) -> RoadMapSource:
    """Lanes, painted borders and edges of a map; `crs` is the WKT of its coordinates, "" where unknown.

    Every section of a lane is a piece, whose lane_id is "road.lane.section"; a section in which a speed limit changes is cut there. Lanes of roads in
    junctions are connectors. Sidewalks are no lanes of ours: where one begins there is an edge.
    """
    whole = replace(whole, roads=[road.cut_where_speeds_change() for road in whole.roads])
    rows: list[dict[str, Any]] = []
    lines, edges = Features("LineStringZ", MARKING_LINES, crs=crs), Features("LineStringZ", ROAD_EDGES, crs=crs)
    network, faults = LaneNetwork(whole), defaultdict[str, list[Any]](list)
    # a whole number for every road: its id where all are such, else its place
    numbered = all(re.fullmatch(r"\d{1,9}", road.id) for road in whole.roads)
    numbers = {road.id: int(road.id) if numbered else k for k, road in enumerate(whole.roads, start=1)}
    for count, road in enumerate(whole.roads):
        surface = road.surface
        faults["jumps"] += [(road.id, *jump) for jump in surface.jumps() if jump[1] > BORDER_JUMP]
        for number, section in enumerate(road.sections):
            if road.section_end(number) - section.s > SHORTEST_SECTION:
                _add_section(rows, lines, edges, whole, network, surface, number, numbers[road.id], faults)
        progress.report((count + 1) / len(whole.roads))
    lane_ids = {row["lane_id"] for row in rows}
    first = _first_at_junctions(whole)
    for row in rows:   # what follows or goes first may be no lane of ours
        row["successors"] = [name for name in row["successors"] if name in lane_ids]
        if names := [name for name in first.get(row["lane_id"], ()) if name in lane_ids]:
            row["known"]["yields_to"] = ",".join(names)
    notes = list(_said(**faults))
    if whole.problems:
        line, text = whole.problems[0]
        notes.insert(0, f"{len(whole.problems)} parts of the file were passed over; the first: line {line}, {text}")
    return RoadMapSource.of_map(
        Lanes.of_pieces(rows, crs), lines, edges, outlines_of(whole), notes=notes, signals=signals_of(whole, crs),
        attributes={row["lane_id"]: row["known"] for row in rows if row["known"]}, left_out=left_out_of(whole))


def _first_at_junctions(whole):
    """lane_id of a way through a junction -> {lane_id: None} of those that go first: priorities name these roads or those that lead to them."""
    first = defaultdict[str, dict[str, None]](dict)
    for junction in whole.junctions:
        ways = defaultdict[str, list[str]](list)
        for connection in junction.connections:
            road = whole.road(connection.connecting)
            section = len(road.sections) - 1 if road is not None and connection.contact == "end" else 0
            for id in (connection.connecting, connection.incoming) if road is not None else ():
                ways[id] += [road.lane_name(lane, section) for _, lane in connection.lanes]
        for high, low in junction.priorities:
            for name in ways[low]:
                first[name] |= dict.fromkeys(ways[high])
    return first


def _said(jumps=(), folds=(), negative=()):
    """Sentences on what is wrong with the geometry of the map: (road, s, metres, lane) of borders that jump, (road, lane, place) of those that fold,
    and (road, lane, least width, s) of lanes with a width below 0."""
    if jumps:   # every road with gaps or kinks, those with the largest first
        roads: dict[str, list[tuple[str, float, float, int]]] = {}
        for jump in sorted(jumps, key=lambda jump: -jump[2]):
            roads.setdefault(jump[0], []).append(jump)
        named = [f"road {road}, lane {lane}, by {metres:.3f} m at s {s:.1f} m" + (f" and less at {len(less)} more" if less else "")
                 for (road, s, metres, lane), *less in list(roads.values())[:ROADS_NAMED]]
        if rest := list(roads.values())[ROADS_NAMED:]:
            named.append(f"{len(rest)} more roads, by at most {rest[0][0][2]:.3f} m")
        yield (f"Gaps or kinks of the reference line, or steps of heights and widths ({len(roads)} of the roads), make borders of "
               f"lanes jump by more than {BORDER_JUMP:g} m: {'; '.join(named)}. Correct them where the map was made.")
    if folds:
        road, lane, place = folds[0]
        yield (f"{len(folds)} borders of lanes fold back over themselves, as a curve is tighter there than the border is far from "
               f"the reference line. The folds were cut off. The first is of road {road}, lane {lane}, near x {place[0]:.1f}, y {place[1]:.1f}.")
    if negative:
        road, lane, width, s = negative[0]
        yield (f"{len(negative)} lanes have a width below 0, which was taken as 0. The first is lane {lane} of road {road} with "
               f"{width:.2f} m at s {s:.1f} m. Correct them where the map was made.")


def _add_section(rows, lines, edges, whole, network, surface, number, road_number, faults):
    """The lanes and lines of one section."""
    road, section = surface.road, surface.road.sections[number]
    s = surface.stations(number)
    offsets = surface.offsets(number, s)
    for id, lane in section.lanes.items():
        if id == 0:
            _add_painted(lines, road_number, lane, section.s, s, whole.placed(surface.places(s, offsets[0])), "centre")
            continue
        (inner, _), (outer, fold) = (surface.without_folds(s, points) for points in surface.borders(number, id, s, offsets))
        inner, outer = whole.placed(inner), whole.placed(outer)
        if fold is not None:
            faults["folds"].append((road.id, id, whole.placed(fold[None])[0]))
        if not lane.border and len(lane.width) and (least := lane.width.least(float(s[-1]) - section.s))[0] < NEGATIVE_WIDTH:
            faults["negative"].append((road.id, id, least[0], section.s + least[1]))
        _add_painted(lines, road_number, lane, section.s, s, outer, _kind(section.lanes, id))
        _add_edges(edges, surface, number, id, s, inner, outer, road_number)
        if lane.type not in NO_LANES and np.abs(offsets[id] - offsets[surface.inside(number, id)]).max() >= LEAST_WIDTH:
            rows.append({**_lane(network, surface, number, id, s, inner, outer), "road": road_number})


def _add_edges(edges, surface, number, id, s, inner, outer, road_number):
    """The edges of the road at the borders of a lane: the end of its pavement, and the foot of a raised lane, with the height of the top of a curb
    or of the near side of a sidewalk."""
    lanes, side = surface.road.sections[number].lanes, "left" if id > 0 else "right"
    inside = lanes.get(id - int(np.sign(id)))
    if _kind(lanes, id) == "pavement" and plan_length(outer) > LEAST_WIDTH:
        add_edge(edges, without_repeats(outer), road_number, "pavement", side)
    if lanes[id].type in RAISED and (inside is None or inside.type not in RAISED) and plan_length(inner) > LEAST_WIDTH:
        near, far = surface.lifts(number, id, s)
        foot = surface.lifts(number, surface.inside(number, id), s)[1]
        rise = float(np.median((far if lanes[id].type == "curb" else near) - foot))
        inner = np.c_[inner[:, :2], inner[:, 2] - near + foot]
        add_edge(edges, without_repeats(inner), road_number, "curb", side, rise if rise > LEAST_CURB else np.nan)


def _lane(network, surface, number, id, s, inner, outer):
    """The values of a lane, its borders in the direction of travel."""
    road, lanes = surface.road, surface.road.sections[number].lanes
    way, driven = 1 if road.way_out(id) == "end" else -1, lanes[id].type in DRIVEN_TYPES
    sides = [(border, _kind(lanes, lane), next((PATTERN_OF_MARK.get(mark.type, "") for mark in lanes[lane].marks), "") if lane in lanes else "")
             for border, lane in ((inner, surface.inside(number, id)), (outer, id))]
    left, right = sides[::-1] if id > 0 else sides
    if driven and way < 0:
        left, right = ((border[::-1], kind, pattern) for border, kind, pattern in (right, left))
    return {"left": left[0], "right": right[0], "lane": id, "lane_id": road.lane_name(id, number), "direction": way * driven,
            "type": ("connector" if road.junction != "-1" else "driving") if driven else LANE_TYPE_OF.get(lanes[id].type, "shoulder"),
            "left_kind": left[1], "right_kind": right[1], "left_pattern": left[2], "right_pattern": right[2],
            "successors": list(_following(network, (road.id, number, id))) if driven else [],
            "station": float(s[0]), "end": float(s[-1]), "known": _known(road, number, id)}


def _known(road, number, id):
    """What a map says of a lane's road: the speed limit in the middle of the section, and its name where that is none by number."""
    section = road.sections[number]
    middle = (section.s + road.section_end(number)) / 2
    limits = [(s + section.s, speed) for s, speed in section.lanes[id].speeds if s + section.s <= middle] or [
        (s, speed) for s, speed in road.speeds if s <= middle]
    known = {"speed_kmh": limits[-1][1]} if limits and np.isfinite(limits[-1][1]) else {}
    return known | ({"name": road.name} if road.name and not re.fullmatch(r"Road [\d, ]+", road.name) else {})


def _following(network, key, passed=()):
    """The lane_ids of the lanes that a lane leads to, those beyond sections that are too short to be shown."""
    for following in network.following(key):
        name, number, id = following
        road = network.roads[name]
        if road.section_end(number) - road.sections[number].s > SHORTEST_SECTION:
            yield road.lane_name(id, number)
        elif following not in passed:
            yield from _following(network, following, (*passed, following))


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


def _add_painted(lines: Features, number: int, lane: MapLane, start: float, s: np.ndarray, points: np.ndarray, kind: str) -> None:
    """The outer border of a lane, (N, 3) points at s, cut where its paint changes."""
    cuts = [max(mark.s + start, s[0]) for mark in lane.marks] + [s[-1]]
    for mark, first, last in zip(lane.marks, cuts[:-1], cuts[1:]):
        if mark.type not in PATTERN_OF_MARK or last - first < LEAST_WIDTH:
            continue
        stations = np.concatenate([[first], s[(s > first + 1e-6) & (s < last - 1e-6)], [last]])
        piece = without_repeats(np.stack([np.interp(stations, s, values) for values in points.T], axis=1))
        if len(piece) > 1:
            add_marking_line(lines, piece, number, kind, PATTERN_OF_MARK[mark.type], mark.width)
