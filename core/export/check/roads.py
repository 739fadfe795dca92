"""The check of an OpenDRIVE map: numbers first, then what is linked to what."""

from __future__ import annotations

import numpy as np
import shapely

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ..map_layers import metric_wkt
from ..opendrive.model import DRIVEN_TYPES, MARK_TYPES, OPEN_END, ROAD_LANE_TYPES, LaneKey, LaneNetwork, MapRoad, OpenDriveMap, RoadSurface, travel
from .findings import Findings, metres
from .statements import statements

MAX_GAP_IN_ROAD = 0.01       # m: simulators of wheels feel more
MAX_KINK = 0.01              # rad between two geometries of one road
MAX_LENGTH_ERROR = 0.01     # m between the s of a geometry and the length before it
MAX_HEIGHT_STEP = 0.02       # m within a road
MAX_WIDTH_STEP = 0.02        # m of a border within a road
LEAST_OVERLAP = 0.3          # share of the smaller of two roads that lies on the other
FARTHEST_BOUND = 50.0        # m by which roads may reach beyond the bounds of the header
FOLD_STEP = 1.0              # m between the places at which borders are held against the curvature


def check_opendrive(whole: OpenDriveMap, crs: str = "", progress: Progress = Progress()) -> Findings:
    """Everything that is wrong with a map.

    Parameters
    ----------
    whole : OpenDriveMap
    crs : WKT of its coordinates, "" where unknown
    progress : told of the share of the roads

    Returns
    -------
    Findings
    """
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
        report.objects(road)
        progress.report(0.6 * (count + 1) / len(whole.roads))
    report.statements()
    report.overlaps()
    check_links(whole, report.findings)
    progress.report(1.0)
    return report.findings


class _RoadCheck:
    """Looks at one road after the other."""

    def __init__(self, whole: OpenDriveMap, findings: Findings) -> None:
        self.whole, self.findings = whole, findings
        self.areas: dict[str, shapely.Geometry] = {}

    def add(self, fault, element, text, road, s):
        place = np.zeros(3)
        if road is not None:
            at = np.array([min(max(s, 0.0), road.plan.length)])
            place = self.whole.placed(np.c_[road.plan.at(at)[0], road.elevation.at(at)])[0]
        self.findings.add(fault, element, text, place)

    def statements(self) -> None:
        """What the file says that the format does not have, and whether its header fits the roads."""
        if self.whole.tree is not None:
            for fault, element, text, road, s in statements(self.whole.tree):
                self.add(fault, element, text, self.whole.road(road), s)
        if self.whole.reference:
            try:
                metric_wkt(self.whole.reference, "The map")
            except RoadExtractionError as problem:
                self.add("reference", "header", str(problem), None, 0.0)
        if self.whole.bounds is not None and self.whole.roads:
            west, south, east, north = self.whole.bounds
            places = np.concatenate([road.plan.at(np.array([0.0, road.plan.length]))[0] for road in self.whole.roads])
            outside = (places < np.array([west, south]) - FARTHEST_BOUND) | (places > np.array([east, north]) + FARTHEST_BOUND)
            if (east > west or north > south) and outside.any():
                x, y = places[np.flatnonzero(outside.any(1))[0]]
                self.add("bounds", "header", f"A road begins or ends at x {x:.1f}, y {y:.1f}, outside of them.", None, 0.0)

    def plan(self, road: MapRoad) -> None:
        name, along, last = f"road {road.id}", 0.0, None
        for element in road.plan.elements:
            if element.length <= 0:
                self.add("station", name, f"A geometry at s = {element.s:g} has the length {element.length:g} m.", road, element.s)
            if abs(element.s - along) > MAX_LENGTH_ERROR:
                self.add("station", name, f"A geometry says s = {element.s:.3f}; before it there are {along:.3f} m.", road, along)
            if last is not None:
                gap = float(np.hypot(element.x - last[0], element.y - last[1]))
                if gap > MAX_GAP_IN_ROAD:
                    self.add("gap", name, f"{metres(gap)} between two geometries at s = {element.s:.2f}.", road, element.s)
                turn = abs(float(wrapped(element.heading - last[2])))
                if turn > MAX_KINK:
                    self.add("kink", name, f"The direction jumps by {turn:.3f} rad at s = {element.s:.2f}.", road, element.s)
            last, along = element.end(), along + element.length
        if abs(road.length - along) > MAX_LENGTH_ERROR:
            self.add("road length", name, f"The road says {road.length:.3f} m; its geometries are {along:.3f} m.", road, along)

    def profile(self, road: MapRoad) -> None:
        for cubics, fault, what in ((road.elevation, "height step", "height"), (road.superelevation, "crossfall step", "crossfall")):
            for s, step in zip(*cubics.steps()):
                if step > MAX_HEIGHT_STEP:
                    self.add(fault, f"road {road.id}", f"The {what} jumps by {step:.3f} at s = {s:.2f}.", road, s)
        if road.rule not in ("RHT", "LHT"):
            self.add("traffic rule", f"road {road.id}", f"The rule is {road.rule!r}.", road, 0.0)

    def sections(self, road: MapRoad) -> None:
        if not road.sections:
            return
        starts = [section.s for section in road.sections]
        if abs(starts[0]) > MAX_LENGTH_ERROR or (np.diff(starts) <= 0).any() or starts[-1] >= road.length:
            self.add("section order", f"road {road.id}", f"Sections begin at {', '.join(f'{s:g}' for s in starts[:8])}.", road, 0.0)
            return
        surface = RoadSurface(road)
        outlines = []
        for number, section in enumerate(road.sections):
            self._numbering(road, section)
            length = road.section_end(number) - section.s
            for lane in section.lanes.values():
                name = f"road {road.id}, section {number}, lane {lane.id}"
                if lane.type not in ROAD_LANE_TYPES:
                    self.add("lane type", name, f"The type is {lane.type!r}.", road, section.s)
                for mark in lane.marks:
                    if mark.type not in MARK_TYPES:
                        self.add("road mark type", name, f"The type is {mark.type!r}.", road, section.s + mark.s)
                if lane.id == 0 or lane.border:
                    continue
                least, where = lane.width.least(length)
                if least < -1e-6:
                    self.add("width below zero", name, f"{least:.3f} m at s = {section.s + where:.2f}.", road, section.s + where)
                for s, step in zip(*lane.width.steps()):
                    if step > MAX_WIDTH_STEP:
                        self.add("width step", name, f"The width jumps by {metres(step)} at s = {section.s + s:.2f}.", road, section.s + s)
            outlines.append(self._borders(road, surface, number))
        for s, step in zip(*road.lane_offset.steps()):
            if step > MAX_WIDTH_STEP and s not in starts:
                self.add("width step", f"road {road.id}", f"The lane offset jumps by {metres(step)} at s = {s:.2f}.", road, s)
        if road.junction == "-1":
            self.areas[road.id] = shapely.union_all([outline for outline in outlines if outline is not None])

    def _numbering(self, road, section):
        name = f"road {road.id}, section at {section.s:g}"
        centre = section.lanes.get(0)
        if centre is None or len(centre.width):
            self.add("centre lane", name, "There is no lane 0." if centre is None else "Lane 0 has a width.", road, section.s)
        ids = [id for id in section.order if id]
        expected = sorted((id for id in ids if id > 0), reverse=True) + sorted((id for id in ids if id < 0), reverse=True)
        left, right = max(ids, default=0), min(ids, default=0)
        if ids != expected or set(ids) != set(range(right, left + 1)) - {0} and ids:
            self.add("lane order", name, f"The lanes are {', '.join(map(str, section.order))}.", road, section.s)
        if len(set(section.order)) != len(section.order):
            self.add("id twice", name, f"The lanes are {', '.join(map(str, section.order))}.", road, section.s)

    def _borders(self, road, surface, number):
        """The outline of a section's driven lanes; whether its borders fold."""
        s = surface.stations(number, FOLD_STEP)
        offsets = surface.offsets(number, s)
        bend = road.plan.at(s)[2]
        for id, t in offsets.items():
            folded = np.flatnonzero(1 - bend * t <= 0)
            if len(folded):
                at = s[folded[0]]
                self.add("border folds", f"road {road.id}, lane {id}",
                         f"{abs(t[folded[0]]):.1f} m beside a curve of {1 / abs(bend[folded[0]]):.1f} m at s = {at:.2f}.", road, at)
                return None
        driven = [id for id in offsets if id and road.sections[number].lanes[id].type in DRIVEN_TYPES]
        if not driven:
            return None
        rings = [np.concatenate([inner, outer[::-1]])[:, :2] for inner, outer in (surface.borders(number, id, s, offsets) for id in driven)]
        return shapely.union_all(shapely.make_valid(np.array([shapely.Polygon(ring) for ring in rings], object)))

    def objects(self, road: MapRoad) -> None:
        for item in road.objects:
            if not -MAX_LENGTH_ERROR <= item["s"] <= road.length + MAX_LENGTH_ERROR:
                self.add("object off the road", f"road {road.id}, object {item['id']}", f"It is at s = {item['s']:.2f} of {road.length:.2f} m.",
                         road, item["s"])

    def overlaps(self) -> None:
        ids, shapes = list(self.areas), np.array(list(self.areas.values()), object)
        if not len(ids):
            return
        tree = shapely.STRtree(shapes)
        for first, second in tree.query(shapes, predicate="intersects").T:
            if first >= second:
                continue
            least = min(shapes[first].area, shapes[second].area)
            common = shapes[first].intersection(shapes[second])
            if least > 0 and common.area > LEAST_OVERLAP * least and abs(self._height(ids[first]) - self._height(ids[second])) < 2.0:
                x, y = common.representative_point().coords[0]
                self.findings.add("two at one place", f"roads {ids[first]} and {ids[second]}", f"They share {common.area:.0f} m².",
                                  self.whole.placed(np.array([[x, y, 0.0]]))[0])

    def _height(self, id):
        road = self.whole.road(id)
        return float(road.elevation.at(road.length / 2)) if road is not None else 0.0


def wrapped(angle: np.ndarray | float) -> np.ndarray:
    """An angle in (-pi, pi]."""
    return (np.asarray(angle) + np.pi) % (2 * np.pi) - np.pi


# Links of an OpenDRIVE map: they lead somewhere, both ways, and what they join touches.

MAX_GAP_AT_LINK = 0.05      # m between the borders of linked lanes
MAX_KINK_AT_LINK = 0.05     # rad: 3 degrees, which a vehicle cannot follow at once
MAX_HEIGHT_AT_LINK = 0.05   # m
LEAST_LANE = 0.5            # m: a lane that is narrower where it ends has tapered away
END_STEP = 0.05             # m before an end, from which its direction is taken


def check_links(whole: OpenDriveMap, findings: Findings) -> None:
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
        self.touched = self.network.touched()
        self.ends: dict[tuple[LaneKey, str], tuple[np.ndarray, np.ndarray, np.ndarray]] = {}

    def place(self, road: MapRoad, end: str) -> np.ndarray:
        at = np.array([0.0 if end == "start" else road.plan.length])
        return self.whole.placed(np.c_[road.plan.at(at)[0], road.elevation.at(at)])[0]

    def road(self, road: MapRoad) -> None:
        for end in ("start", "end"):
            link = road.link(end)
            if link is None:
                continue
            name, place = f"road {road.id}, {end}", self.place(road, end)
            if link.element == "junction":
                if link.id not in self.known:
                    self.findings.add("road link", name, f"There is no junction {link.id}.", place)
                elif road.junction == "-1" and not self.network.connections.get((link.id, road.id)) and not self._is_left_by(link.id, road.id):
                    self.findings.add("one-sided link", name, f"Junction {link.id} has no connection with it.", place)
                continue
            other = self.network.roads.get(link.id)
            if link.element != "road" or other is None:
                self.findings.add("road link", name, f"There is no {link.element or 'element'} {link.id}.", place)
            elif link.contact not in ("start", "end"):
                self.findings.add("road link", name, f"It touches the {link.contact or 'unnamed'} end of road {link.id}.", place)
            elif road.junction == "-1" and other.junction == "-1":
                back = other.link(link.contact)
                if back is None or back.element != "road" or back.id != road.id or back.contact != end:
                    self.findings.add("one-sided link", name, f"Road {link.id} is not linked back.", place)

    def _is_left_by(self, junction: str, road: str) -> bool:
        """Whether a connecting road of a junction leads to a road."""
        for other in self.whole.roads:
            if other.junction == junction and any(link is not None and link.element == "road" and link.id == road
                                                  for link in (other.predecessor, other.successor)):
                return True
        return False

    def junctions(self) -> None:
        reached = {(junction.id, connection.connecting) for junction in self.whole.junctions for connection in junction.connections}
        for road in self.whole.roads:
            for end in ("start", "end") if road.junction in self.known else ():
                if road.link(end) is None:
                    self.findings.add("road link", f"road {road.id}, {end}", "It lies in a junction and leads nowhere.", self.place(road, end))
            if road.junction != "-1" and (road.junction, road.id) not in reached:
                self.findings.add("unused junction road", f"road {road.id}", f"Junction {road.junction} has no connection to it.",
                                  self.place(road, "start"))
        seen = set()
        for junction in self.whole.junctions:
            if junction.id in seen:
                self.findings.add("id twice", f"junction {junction.id}", "There is another junction of this id.", np.zeros(3))
            seen.add(junction.id)
            for connection in junction.connections:
                self._connection(junction.id, connection)

    def _connection(self, junction, connection):
        name = f"junction {junction}, connection {connection.id}"
        roads = [self.network.roads.get(id) for id in (connection.incoming, connection.connecting)]
        if roads[0] is None or roads[1] is None:
            missing = connection.incoming if roads[0] is None else connection.connecting
            self.findings.add("connection", name, f"There is no road {missing}.", np.zeros(3))
            return
        incoming, connecting = roads
        place = self.place(connecting, "end" if connection.contact == "end" else "start")
        if connecting.junction != junction:
            self.findings.add("connection", name, f"Road {connecting.id} belongs to junction {connecting.junction}.", place)
        if connection.contact not in ("start", "end"):
            self.findings.add("connection", name, f"It touches the {connection.contact or 'unnamed'} end of road {connecting.id}.", place)
            return
        ends = [end for end in ("start", "end") if (link := incoming.link(end)) is not None and link.element == "junction" and link.id == junction]
        if not ends:
            self.findings.add("connection", name, f"Road {incoming.id} does not lead into this junction.", place)
            return
        if not connection.lanes:
            self.findings.add("connection", name, "It links no lanes.", place)
        here = [incoming.sections[0 if end == "start" else -1].lanes for end in ends if incoming.sections]
        there = connecting.sections[0 if connection.contact == "start" else -1].lanes if connecting.sections else {}
        for start, to in connection.lanes:
            if not any(start in lanes for lanes in here) or to not in there:
                self.findings.add("connection", name, f"There is no lane {start} or no lane {to} where it links them.", place)

    def lane(self, key: LaneKey) -> None:
        road, lane = self.network.roads[key[0]], self.network.lane(key)
        if lane is None:
            return
        name, driven = f"road {key[0]}, section {key[1]}, lane {key[2]}", lane.type in DRIVEN_TYPES
        way = travel(road, key[2])
        for end in ("start", "end"):
            own = self._end(key, end)
            touching = self.network.touching(key, end)
            for other, there in touching:
                target = self.network.lane(other)
                if target is None or not other[2]:   # lane 0 is a line
                    self.findings.add("lane link", name, f"At its {end} there is no such lane {other[2]} of road {other[0]}.", own[0])
                    continue
                self._joined(name, key, end, own, other, there, target, driven)
            said = end in lane.data.get(OPEN_END, "").split()
            if self.network.is_open(key, end, self.touched) and not said and self._width(own) > LEAST_LANE:
                leaves = (end == "end") == (way > 0)
                self.findings.add("dead end" if leaves else "no way in", name, f"At its {end} it is linked to no driven lane.", own[0])

    def _joined(self, name, key, end, own, other, there, target, driven):
        road, to = self.network.roads[key[0]], self.network.roads[other[0]]
        theirs = self._end(other, there)
        # seen along the road, an end that touches another end has left and right swapped
        turned = end == there
        pairs = ((own[0], theirs[1] if turned else theirs[0]), (own[1], theirs[0] if turned else theirs[1]))
        apart = [pair[0] - pair[1] for pair in pairs]
        gap, rise = max(float(np.hypot(*d[:2])) for d in apart), max(abs(float(d[2])) for d in apart)
        kink = abs(float(np.arctan2(*(_cross_dot(own[2], theirs[2] if end != there else -theirs[2])))))
        if gap > MAX_GAP_AT_LINK:
            self.findings.add("gap at a link", name, f"{metres(gap)} from lane {other[2]} of road {other[0]} at its {end}.", own[0])
        if rise > MAX_HEIGHT_AT_LINK:
            self.findings.add("height step at a link", name, f"{metres(rise)} to lane {other[2]} of road {other[0]} at its {end}.", own[0])
        if kink > MAX_KINK_AT_LINK and driven:
            self.findings.add("kink at a link", name, f"{kink:.3f} rad to lane {other[2]} of road {other[0]} at its {end}.", own[0])
        if driven and target.type in DRIVEN_TYPES:
            leaves, enters = (end == "end") == (travel(road, key[2]) > 0), (there == "start") == (travel(to, other[2]) > 0)
            if leaves != enters:
                self.findings.add("direction at a link", name, f"Lane {other[2]} of road {other[0]} is driven against it.", own[0])
        if key[0] == other[0] or road.junction == "-1" and to.junction == "-1":
            if not any(back == key for back, _ in self.network.touching(other, there)):
                self.findings.add("one-sided link", name, f"Lane {other[2]} of road {other[0]} is not linked back.", own[0])

    def _end(self, key, end):
        """(left, right) end of a lane's borders along the road, (3,) each, and (2,) the direction there."""
        found = self.ends.get((key, end))
        if found is None:
            road = self.network.roads[key[0]]
            first, last = road.sections[key[1]].s, road.section_end(key[1])
            step = min(END_STEP, (last - first) / 2)
            s = np.array([first, first + step]) if end == "start" else np.array([last - step, last - 1e-6])
            surface = RoadSurface(road)
            # the functions of a section hold up to its end: those of the next begin at the same s
            inner, outer = (self.whole.placed(line) for line in surface.borders(key[1], key[2], s, surface.offsets(key[1], s)))
            left, right = (inner, outer) if key[2] < 0 else (outer, inner)
            at = 0 if end == "start" else 1
            way = (left[1] - left[0] + right[1] - right[0])[:2]
            found = self.ends[key, end] = left[at], right[at], way
        return found

    def _width(self, end):
        return float(np.hypot(*(end[0] - end[1])[:2]))


def _cross_dot(a, b):
    return float(a[0] * b[1] - a[1] * b[0]), float(a @ b)
