"""The check of an OpenDRIVE map: numbers first, then what is linked to what, and what the file states that the format does not have.

Source: ASAM OpenDRIVE 1.7 and 1.8, the tables of attributes and the rules at the end of each section.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import shapely

from ....core.common.errors import RoadExtractionError
from ....core.common.progress import Progress
from ..opendrive.model import DRIVEN_TYPES, LINK_NAMES, OPEN_END, LaneKey, LaneNetwork, MapRoad, OpenDriveMap, RoadLink
from ..opendrive.xodr import GEOMETRIES
from ..sources import SAME_LEVEL, metric_wkt, wrapped
from ..xml_tree import XmlElement
from .findings import WORDS, Findings, metres

MAX_GAP_IN_ROAD = 0.01       # m: simulators of wheels feel more
MAX_KINK = 0.01              # rad between two geometries of one road
MAX_LENGTH_ERROR = 0.01     # m between the s of a geometry and the length before it
MAX_HEIGHT_STEP = 0.02       # m within a road
MAX_WIDTH_STEP = 0.02        # m of a border within a road
LEAST_OVERLAP = 0.3          # share of the smaller of two roads that lies on the other
FARTHEST_BOUND = 50.0        # m by which roads may reach beyond the bounds of the header


def check_opendrive(whole: OpenDriveMap, crs: str = "", progress: Progress = Progress()) -> Findings:
    """Everything that is wrong with a map; `crs` is that of its coordinates, "" where unknown."""
    report = _RoadCheck(whole, Findings(crs=crs))
    seen: set[str] = set()
    for line, text in whole.problems:
        report.add("unreadable", f"line {line}", text, None, 0.0)
    for count, road in enumerate(whole.roads):
        if road.id in seen:
            report.add("id twice", f"road {road.id}", "There is another road of this id.", road, 0.0)
        seen.add(road.id)
        report.plan(road)
        report.profile(road)
        report.sections(road)
        progress.report(0.6 * (count + 1) / len(whole.roads))
    report.statements()
    report.overlaps()
    _check_links(whole, report.findings)
    progress.report(1.0)
    return report.findings


class _RoadCheck:
    """Looks at one road after the other."""

    def __init__(self, whole: OpenDriveMap, findings: Findings) -> None:
        self.whole, self.findings = whole, findings
        self.areas: list[tuple[MapRoad, shapely.Geometry]] = []

    def add(self, fault, element, text, road, s):
        self.findings.add(fault, element, text, self.whole.place(road, s) if road is not None else np.zeros(3))

    def statements(self) -> None:
        """What the file says that the format does not have, and whether its header fits the roads."""
        for fault, element, text, road, s in _statements(self.whole.tree) if self.whole.tree is not None else ():
            self.add(fault, element, text, self.whole.road(road), s)
        if self.whole.reference:
            try:
                metric_wkt(self.whole.reference, "The map")
            except RoadExtractionError as problem:
                self.add("reference", "header", str(problem), None, 0.0)
        if self.whole.bounds is None or not self.whole.roads:
            return
        west, south, east, north = self.whole.bounds
        places = np.concatenate([road.plan.at(np.array([0.0, road.plan.length]))[0] for road in self.whole.roads])
        outside = (places < np.array([west, south]) - FARTHEST_BOUND) | (places > np.array([east, north]) + FARTHEST_BOUND)
        if south > north or west > east:
            self.add("bounds", "header", f"South {south:g} to north {north:g}, west {west:g} to east {east:g}.", None, 0.0)
        elif (east > west or north > south) and outside.any():
            x, y = places[np.flatnonzero(outside.any(1))[0]]
            self.add("bounds", "header", f"A road begins or ends at x {x:.1f}, y {y:.1f}, outside of them.", None, 0.0)

    def plan(self, road: MapRoad) -> None:
        name, along = f"road {road.id}", 0.0
        for element in road.plan.elements:
            if element.length <= 0:
                self.add("station", name, f"A geometry at s = {element.s:g} has the length {element.length:g} m.", road, element.s)
            if abs(element.s - along) > MAX_LENGTH_ERROR:
                self.add("station", name, f"A geometry says s = {element.s:.3f}; before it there are {along:.3f} m.", road, along)
            along += element.length
        for s, gap, turn in road.plan.jumps(MAX_GAP_IN_ROAD, MAX_KINK):
            if gap > MAX_GAP_IN_ROAD:
                self.add("gap", name, f"{metres(gap)} between two geometries at s = {s:.2f}.", road, s)
            if turn > MAX_KINK:
                self.add("kink", name, f"The direction jumps by {turn:.3f} rad at s = {s:.2f}.", road, s)
        if abs(road.length - along) > MAX_LENGTH_ERROR:
            self.add("road length", name, f"The road says {road.length:.3f} m; its geometries are {along:.3f} m.", road, along)

    def profile(self, road: MapRoad) -> None:
        for cubics, fault, quantity in ((road.elevation, "height step", "height"), (road.superelevation, "crossfall step", "crossfall")):
            for s, step in zip(*cubics.steps()):
                if step > MAX_HEIGHT_STEP:
                    self.add(fault, f"road {road.id}", f"The {quantity} jumps by {step:.3f} at s = {s:.2f}.", road, s)
        if road.rule not in ("RHT", "LHT"):
            self.add("traffic rule", f"road {road.id}", f"The rule is {road.rule!r}.", road, 0.0)

    def sections(self, road: MapRoad) -> None:
        if not road.sections:
            return
        starts = [section.s for section in road.sections]
        if abs(starts[0]) > MAX_LENGTH_ERROR or (np.diff(starts) <= 0).any() or starts[-1] >= road.length:
            self.add("section order", f"road {road.id}", f"Sections begin at {', '.join(f'{s:g}' for s in starts[:8])}.", road, 0.0)
            return
        outlines = []
        for number, section in enumerate(road.sections):
            self._numbering(road, section)
            for lane in section.lanes.values():
                self._lane(road, section.s, lane, f"road {road.id}, section {number}, lane {lane.id}", road.section_end(number) - section.s)
            outlines.append(self._borders(road, number))
        for s, step in zip(*road.lane_offset.steps()):
            if step > MAX_WIDTH_STEP and s not in starts:
                self.add("width step", f"road {road.id}", f"The lane offset jumps by {metres(step)} at s = {s:.2f}.", road, s)
        if road.junction == "-1":
            self.areas.append((road, shapely.union_all(outlines)))

    def _lane(self, road, start, lane, name, length):
        if lane.type not in WORDS["lane of OpenDRIVE"]:
            self.add("lane type", name, f"The type is {lane.type!r}.", road, start)
        for mark in lane.marks:
            if mark.type not in WORDS["road mark"]:
                self.add("road mark type", name, f"The type is {mark.type!r}.", road, start + mark.s)
        if lane.id == 0 or lane.border:
            return
        least, station = lane.width.least(length)
        if least < -1e-6:
            self.add("width below zero", name, f"{least:.3f} m at s = {start + station:.2f}.", road, start + station)
        for s, step in zip(*lane.width.steps()):
            if step > MAX_WIDTH_STEP:
                self.add("width step", name, f"The width jumps by {metres(step)} at s = {start + s:.2f}.", road, start + s)

    def _numbering(self, road, section):
        name = f"road {road.id}, section at {section.s:g}"
        centre = section.lanes.get(0)
        if centre is None or len(centre.width):
            self.add("centre lane", name, "There is no lane 0." if centre is None else "Lane 0 has a width.", road, section.s)
        ids = [id for id in section.order if id]
        expected = sorted((id for id in ids if id > 0), reverse=True) + sorted((id for id in ids if id < 0), reverse=True)
        left, right = max(ids, default=0), min(ids, default=0)
        if ids != expected or set(ids) != set(range(right, left + 1)) - {0}:
            self.add("lane order", name, f"The lanes are {', '.join(map(str, section.order))}.", road, section.s)
        if len(set(section.order)) != len(section.order):
            self.add("id twice", name, f"The lanes are {', '.join(map(str, section.order))}.", road, section.s)

    def _borders(self, road, number):
        """The outline of a section's driven lanes; whether its borders fold."""
        surface = road.surface
        s = surface.stations(number)
        offsets = surface.offsets(number, s)
        bend = road.plan.at(s)[2]
        for id, t in offsets.items():
            folded = np.flatnonzero(1 - bend * t <= 0)
            if len(folded):
                station = s[folded[0]]
                self.add("border folds", f"road {road.id}, lane {id}",
                         f"{abs(t[folded[0]]):.1f} m beside a curve of {1 / abs(bend[folded[0]]):.1f} m at s = {station:.2f}.", road, station)
                return None
        driven = [id for id in offsets if id and road.sections[number].lanes[id].type in DRIVEN_TYPES]
        if not driven:
            return None
        rings = [np.concatenate([inner, outer[::-1]])[:, :2] for inner, outer in (surface.borders(number, id, s, offsets) for id in driven)]
        return shapely.union_all(shapely.make_valid(np.array([shapely.Polygon(ring) for ring in rings], object)))

    def overlaps(self) -> None:
        roads, shapes = [road for road, _ in self.areas], np.array([shape for _, shape in self.areas], object)
        heights = [float(road.elevation.at(road.length / 2)) for road in roads]
        for first, second in shapely.STRtree(shapes).query(shapes, predicate="intersects").T:
            if first >= second:
                continue
            least = min(shapes[first].area, shapes[second].area)
            common = shapes[first].intersection(shapes[second])
            if least > 0 and common.area > LEAST_OVERLAP * least and abs(heights[first] - heights[second]) < SAME_LEVEL:
                x, y = common.representative_point().coords[0]
                self.findings.add("two at one place", f"roads {roads[first].id} and {roads[second].id}", f"They share {common.area:.0f} m².",
                                  self.whole.placed(np.array([[x, y, 0.0]]))[0])


# Links of an OpenDRIVE map: they lead somewhere, both ways, and what they join touches.

MAX_GAP_AT_LINK = 0.05      # m between the borders of linked lanes
MAX_KINK_AT_LINK = 0.05     # rad: 3 degrees, which a vehicle cannot follow at once
MAX_HEIGHT_AT_LINK = 0.05   # m
LEAST_LANE = 0.5            # m: a lane that is narrower where it ends has tapered away
END_STEP = 0.05             # m before an end, from which its direction is taken


def _check_links(whole: OpenDriveMap, findings: Findings) -> None:
    """Add what is wrong with the links of roads, lanes and junctions, and count the routing network."""
    check = _Links(whole, findings)
    check.junctions()
    for road in whole.roads:
        check.road(road)
        for number, section in enumerate(road.sections):
            for id in section.lanes:
                if id:
                    check.lane((road.id, number, id))
            driven = [id for id, lane in section.lanes.items() if lane.type in DRIVEN_TYPES]
            findings.lanes += len(driven)
            findings.neighbours += sum(1 for id in driven if id + 1 in driven or id == -1 and 1 in driven)
            findings.successors += sum(len(check.network.following((road.id, number, id))) for id in driven)


class _Links:
    def __init__(self, whole: OpenDriveMap, findings: Findings) -> None:
        self.whole, self.findings, self.network = whole, findings, LaneNetwork(whole)
        self.known = {junction.id for junction in whole.junctions}
        self.ends: dict[tuple[LaneKey, str], tuple[np.ndarray, np.ndarray, float]] = {}

    def place(self, road: MapRoad, end: str) -> np.ndarray:
        return self.whole.place(road, 0.0 if end == "start" else road.plan.length)

    def road(self, road: MapRoad) -> None:
        for end in ("start", "end"):
            link = road.links.get(end)
            if link is not None:
                fault, text = self._to_junction(road, link) if link.element == "junction" else self._to_road(road, end, link)
                if fault:
                    self.findings.add(fault, f"road {road.id}, {end}", text, self.place(road, end))

    def _to_junction(self, road, link):
        """(fault, what was seen) of a road's link to a junction, ("", "") where it is right."""
        if link.id not in self.known:
            return "road link", f"There is no junction {link.id}."
        # whether a connecting road of the junction leads to it
        left = any(one.junction == link.id and one.touches(end, "road", road.id) for one in self.whole.roads for end in LINK_NAMES)
        if road.junction == "-1" and not self.network.connections.get((link.id, road.id)) and not left:
            return "one-sided link", f"Junction {link.id} has no connection with it."
        return "", ""

    def _to_road(self, road, end, link):
        """The same of its link to another road."""
        linked = self.network.roads.get(link.id)
        if link.element != "road" or linked is None:
            return "road link", f"There is no {link.element or 'element'} {link.id}."
        if link.contact not in ("start", "end"):
            return "road link", f"It touches the {link.contact or 'unnamed'} end of road {link.id}."
        if road.junction == linked.junction == "-1" and linked.links.get(link.contact) != RoadLink("road", road.id, end):
            return "one-sided link", f"Road {link.id} is not linked back."
        return "", ""

    def junctions(self) -> None:
        reached = {(junction.id, connection.connecting) for junction in self.whole.junctions for connection in junction.connections}
        for road in self.whole.roads:
            self._inside(road, reached)
        seen = set()
        for junction in self.whole.junctions:
            if junction.id in seen:
                self.findings.add("id twice", f"junction {junction.id}", "There is another junction of this id.", np.zeros(3))
            seen.add(junction.id)
            ids = Counter(connection.id for connection in junction.connections)
            for connection in junction.connections:
                self._connection(junction.id, connection)
                if ids[connection.id] > 1:
                    self.findings.add("id twice", f"junction {junction.id}, connection {connection.id}", "There is another connection of this id.",
                                      np.zeros(3))
            ways = {id for connection in junction.connections for id in (connection.incoming, connection.connecting)}
            for id in dict.fromkeys(id for pair in junction.priorities for id in pair if id not in ways):
                self.findings.add("connection", f"junction {junction.id}", f"A priority names road {id}, which is not part of it.", np.zeros(3))

    def _inside(self, road, reached):
        """A road of a junction leads somewhere at both ends, and is one of (junction, road) that connections name."""
        for end in ("start", "end") if road.junction in self.known else ():
            if road.links.get(end) is None:
                self.findings.add("road link", f"road {road.id}, {end}", "It lies in a junction and leads nowhere.", self.place(road, end))
        if road.junction != "-1" and (road.junction, road.id) not in reached:
            self.findings.add("unused junction road", f"road {road.id}", f"Junction {road.junction} has no connection to it.",
                              self.place(road, "start"))

    def _connection(self, junction, connection):
        name, missing = f"junction {junction}, connection {connection.id}", [
            id for id in (connection.incoming, connection.connecting) if id not in self.network.roads]
        if missing:
            self.findings.add("connection", name, f"There is no road {missing[0]}.", np.zeros(3))
            return
        incoming, connecting = self.network.roads[connection.incoming], self.network.roads[connection.connecting]
        place = self.place(connecting, "end" if connection.contact == "end" else "start")
        for text in _connection_faults(junction, connection, incoming, connecting):
            self.findings.add("connection", name, text, place)

    def lane(self, key: LaneKey) -> None:
        road, lane = self.network.roads[key[0]], self.network.lane(key)
        if lane is None:
            return
        name, driven = f"road {key[0]}, section {key[1]}, lane {key[2]}", lane.type in DRIVEN_TYPES
        for end in ("start", "end"):
            corners = self._end(key, end)
            touching = self.network.touching(key, end)
            for neighbour, neighbour_end in touching:
                target = self.network.lane(neighbour)
                if target is None or not neighbour[2]:   # lane 0 is a line
                    self.findings.add("lane link", name, f"At its {end} there is no such lane {neighbour[2]} of road {neighbour[0]}.", corners[0])
                    continue
                self._joined(name, key, end, corners, neighbour, neighbour_end, target, driven)
            declared = end in lane.data.get(OPEN_END, "").split()
            if self.network.is_open(key, end) and not declared and np.hypot(*(corners[0] - corners[1])[:2]) > LEAST_LANE:
                fault = "dead end" if end == road.way_out(key[2]) else "no way in"
                self.findings.add(fault, name, f"At its {end} it is linked to no driven lane.", corners[0])

    def _joined(self, name, key, end, here, other, there, target, driven):
        neighbour = self._end(other, there)
        # seen along the road, an end that touches another end has left and right swapped
        turned = end == there
        pairs = ((here[0], neighbour[1] if turned else neighbour[0]), (here[1], neighbour[0] if turned else neighbour[1]))
        apart = [pair[0] - pair[1] for pair in pairs]
        gap, rise = max(float(np.hypot(*d[:2])) for d in apart), max(abs(float(d[2])) for d in apart)
        kink = abs(float(wrapped(here[2] - neighbour[2] + np.pi * turned)))
        for fault, size, most, text in (("gap at a link", gap, MAX_GAP_AT_LINK, metres(gap)),
                                        ("height step at a link", rise, MAX_HEIGHT_AT_LINK, metres(rise)),
                                        ("kink at a link", kink * driven, MAX_KINK_AT_LINK, f"{kink:.3f} rad")):
            if size > most:
                self.findings.add(fault, name, f"{text} between it and lane {other[2]} of road {other[0]} at its {end}.", here[0])
        road, to = self.network.roads[key[0]], self.network.roads[other[0]]
        if driven and target.type in DRIVEN_TYPES and (end == road.way_out(key[2])) == (there == to.way_out(other[2])):
            self.findings.add("direction at a link", name, f"Lane {other[2]} of road {other[0]} is driven against it.", here[0])
        # lanes of a junction need not be linked back
        if (key[0] == other[0] or road.junction == to.junction == "-1") and not any(
                back == key for back, _ in self.network.touching(other, there)):
            self.findings.add("one-sided link", name, f"Lane {other[2]} of road {other[0]} is not linked back.", here[0])

    def _end(self, key, end):
        """(left, right) end of a lane's borders along the road, (3,) each, and the heading there."""
        corners = self.ends.get((key, end))
        if corners is None:
            road = self.network.roads[key[0]]
            first, last = road.sections[key[1]].s, road.section_end(key[1])
            step = min(END_STEP, (last - first) / 2)
            s = np.array([first, first + step]) if end == "start" else np.array([last - step, last - 1e-6])
            surface = road.surface
            # the functions of a section hold up to its end: those of the next begin at the same s
            inner, outer = (self.whole.placed(line) for line in surface.borders(key[1], key[2], s, surface.offsets(key[1], s)))
            left, right = (inner, outer) if key[2] < 0 else (outer, inner)
            row = 0 if end == "start" else 1
            x, y, _ = left[1] - left[0] + right[1] - right[0]
            corners = self.ends[key, end] = left[row], right[row], float(np.arctan2(y, x))
        return corners


def _connection_faults(junction, connection, incoming, connecting):
    """What is wrong with a connection between two roads."""
    if connecting.junction != junction:
        yield f"Road {connecting.id} belongs to junction {connecting.junction}."
    if connection.contact not in ("start", "end"):
        yield f"It touches the {connection.contact or 'unnamed'} end of road {connecting.id}."
        return
    incoming_lanes = [incoming.lanes_at(end) for end in ("start", "end") if incoming.touches(end, "junction", junction)]
    if not incoming_lanes:
        yield f"Road {incoming.id} does not lead into this junction."
        return
    if not connection.lanes:
        yield "It links no lanes."
    if len(set(connection.lanes)) < len(connection.lanes):
        yield "It links the same lanes twice."
    connecting_lanes = connecting.lanes_at(connection.contact)
    for start, to in connection.lanes:
        if to not in connecting_lanes or start not in set().union(*incoming_lanes):
            yield f"There is no lane {start} or no lane {to} where it links them."


# What the file states, held against what the format allows: words, ranges of numbers, order of records, what excludes what.

MINORS = range(9)                # of version 1
STATED_NEAR = 0.01               # m by which a record may lie beyond its end
FARTHEST_OBJECT = 100.0          # m beside the reference line


class _Allowed(NamedTuple):
    """What an attribute may be: words, or numbers from `least` to `most`, `least` itself or not; numbers count since version 1.since."""

    words: tuple[str, ...] = ()
    least: float = np.inf
    most: float = np.inf
    itself: bool = True
    since: int = 0

    def holds(self, element: XmlElement, name: str, minor: float) -> bool:
        """Whether the attribute of this name is allowed in a file of version 1.minor."""
        if element.get(name) in self.words or minor < self.since:
            return True
        value = _number(element, name, np.nan)
        return bool(self.least < value <= self.most or self.itself and value == self.least)


POSITIVE, NOT_NEGATIVE = _Allowed(least=0.0, itself=False), _Allowed(least=0.0)
# tag -> attribute -> what it may be; what is not stated has a default
ATTRIBUTES = {
    "type": {"type": _Allowed(WORDS["road"])},
    "speed": {"unit": _Allowed(("m/s", "mph", "km/h")), "max": _Allowed(("no limit", "undefined"), 0.0)},
    "paramPoly3": {"pRange": _Allowed(("arcLength", "normalized"))},
    "roadMark": {"color": _Allowed(WORDS["colour of a road mark"]), "weight": _Allowed(("standard", "bold")),
                 "laneChange": _Allowed(("increase", "decrease", "both", "none")), "width": NOT_NEGATIVE},
    "line": {"length": POSITIVE, "space": NOT_NEGATIVE, "width": NOT_NEGATIVE},
    # before 1.7 the sizes of objects are any numbers
    "object": {"type": _Allowed(WORDS["object"]), "orientation": _Allowed(WORDS["orientation"]), "length": POSITIVE._replace(since=7),
               "width": POSITIVE._replace(since=7), "height": NOT_NEGATIVE._replace(since=7), "radius": NOT_NEGATIVE._replace(since=7)},
    "signal": {"orientation": _Allowed(WORDS["orientation"]), "dynamic": _Allowed(("yes", "no")), "s": NOT_NEGATIVE},
    "superelevation": {"a": _Allowed(least=-np.pi / 2, most=np.pi / 2)},
    "width": {"a": _Allowed(least=-1.0, most=50.0)},
}
NEEDED_ATTRIBUTES = {"object": ("id", "s", "t"), "signal": ("id", "s", "t"), "lane": ("id", "type"), "connection": ("id",)}
# (where they are in a road or lane, whether the first must be at 0) of records that go on from s to s
ROAD_RECORDS = ((("type",), False), (("planView", "geometry"), True), (("elevationProfile", "elevation"), True),
                (("lateralProfile", "superelevation"), True), (("lanes", "laneOffset"), True))
LANE_RECORDS = (("width", True), ("border", True), ("roadMark", False), ("height", False), ("speed", False))


def _statements(root: XmlElement) -> Iterator[tuple[str, str, str, str, float]]:
    """Every statement of the element <OpenDRIVE> that the format does not allow: a fault of FAULTS, what it is about, what was seen, the id of a
    road, "" for none, and metres along it."""
    header, minor = root.find("header"), float(MINORS[-1])
    if header is not None:
        major, minor = (_number(header, name, np.nan) for name in ("revMajor", "revMinor"))
        if major != 1 or minor not in MINORS:
            yield "value", "header", f"The version is {header.get('revMajor')}.{header.get('revMinor')}; there are 1.0 to 1.{MINORS[-1]}.", "", 0.0
    seen: dict[str, set[str]] = {"object": set(), "signal": set()}
    for road in root.all("road"):
        id = road.get("id")
        for fault, part, text, s in _stated_of_road(road, minor, seen):
            yield fault, f"road {id}, {part}" if part else f"road {id}", text, id, s


# Of a road (fault, which part of it, what was seen, metres along it).

def _stated_of_road(road, minor, seen):
    length = _number(road, "length", 0.0)
    for path, zero in ROAD_RECORDS:
        for text in _order(road, path, "s", length, zero):
            yield "record order", path[-1], text, 0.0
    shapes = [(_number(shape, "s", 0.0), _number(shape, "t", 0.0)) for shape in road.all("lateralProfile", "shape")]
    if shapes != sorted(shapes):
        yield "record order", "shape", "The shapes do not go on from s to s and from t to t.", 0.0
    for geometry in road.all("planView", "geometry"):
        kinds = [child for child in geometry.children if child.tag in GEOMETRIES]
        s = _number(geometry, "s", 0.0)
        if len(kinds) > 1:
            yield "two at once", "geometry", f"The geometry at s = {s:g} is {' and '.join(child.tag for child in kinds)}.", s
        if any(child.tag == "arc" and _number(child, "curvature", 1.0) == 0 for child in kinds):
            yield "value", "geometry", f"The arc at s = {s:g} has no curvature; it is a line.", s
    yield from _stated_of_lanes(road, length)
    numbers = {_number(lane, "id", 0.0) for lane in _within(road) if lane.tag == "lane"}
    for kind in seen:
        for one in road.all(f"{kind}s", kind):
            yield from _stated_of_object(one, kind, length, numbers, seen[kind])
    for element in _within(road):
        for text in _values(element, minor):
            yield "value", "", text, 0.0


def _stated_of_lanes(road, length):
    sections = list(road.all("lanes", "laneSection"))
    starts = [*(_number(section, "s", 0.0) for section in sections), length]
    for section, start, end in zip(sections, starts[:-1], starts[1:]):
        for lane in (lane for side in ("left", "center", "right") for lane in section.all(side, "lane")):
            name = f"section at {start:g}, lane {lane.get('id')}"
            for tag, zero in LANE_RECORDS:
                for text in _order(lane, (tag,), "sOffset", end - start, zero):
                    yield "record order", name, f"{tag}: {text}", start
            if lane.find("width") is not None and lane.find("border") is not None:
                yield "two at once", name, "It has widths and borders; only the widths are read.", start
            if _number(lane, "id", 0.0) % 1:
                yield "value", name, f"Its number is {lane.get('id')}.", start


def _stated_of_object(one, kind, length, numbers, seen):
    """The same of an object or signal of a road with lanes of these numbers."""
    name, s, t = f"{kind} {one.get('id')}", _number(one, "s", 0.0), _number(one, "t", 0.0)
    if one.get("id") in seen:
        yield "id twice", name, f"There is another {kind} of this id.", s
    seen.add(one.get("id"))
    if abs(t) > FARTHEST_OBJECT:
        yield "object off the road", name, f"It is {abs(t):.0f} m beside the reference line.", s
    if not -STATED_NEAR <= s <= length + STATED_NEAR:
        yield "object off the road", name, f"It is at s = {s:.2f} of {length:.2f} m.", s
    for validity in one.all("validity"):
        first, last = _number(validity, "fromLane", 0.0), _number(validity, "toLane", 0.0)
        if first > last or not numbers.issuperset((first, last)):
            yield "lane link", name, f"It is valid from lane {first:g} to lane {last:g}, which the road does not have.", s
    for outline in [*one.all("outlines", "outline"), *one.all("outline")]:
        corners = sum(child.tag in ("cornerRoad", "cornerLocal") for child in outline.children)
        if 0 < corners < 3 and outline.get("closed", "true") != "false":
            yield "value", name, f"Its outline has {corners} corners.", s


def _order(parent, path, key, length, zero):
    """Sentences on records that begin late, go back, or lie beyond the end."""
    stations = [_number(record, key, 0.0) for record in parent.all(*path)]
    if not stations:
        return
    if zero and stations[0] > STATED_NEAR:
        yield f"The first begins at {stations[0]:g} m."
    if (np.diff(stations) < 0).any():
        yield f"They begin at {', '.join(f'{record:g}' for record in stations[:8])} m."
    if min(stations) < -STATED_NEAR or max(stations) > length + STATED_NEAR:
        yield f"One begins at {max(stations) if max(stations) > length else min(stations):g} m of {length:g} m."


def _values(one, minor):
    """Sentences on words and numbers of an element of a file of version 1.minor."""
    if one.tag != "type" or "s" in one.attributes:   # a road mark has a type too
        for name, allowed in ATTRIBUTES.get(one.tag, {}).items():
            if name in one.attributes and not allowed.holds(one, name, minor):
                yield f"Line {one.line}: {name} of <{one.tag}> is {one.get(name)[:40]!r}."
    for name in NEEDED_ATTRIBUTES.get(one.tag, ()):
        if name not in one.attributes:
            yield f"Line {one.line}: <{one.tag}> has no {name}."


def _within(element):
    """The elements within an element, at any depth, but for the user's own."""
    stack = list(element.children)
    while stack:
        child = stack.pop()
        if child.tag != "userData":
            yield child
            stack += child.children


def _number(element, name, missing):
    """A number, NaN where it is none."""
    try:
        return element.number(name, missing)
    except RoadExtractionError:
        return np.nan
