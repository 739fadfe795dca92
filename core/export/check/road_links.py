"""Links of an OpenDRIVE map: they lead somewhere, both ways, and what they join touches."""

from __future__ import annotations

import numpy as np

from ..opendrive.model import DRIVEN_TYPES, OPEN_END, LaneKey, LaneNetwork, MapRoad, OpenDriveMap, travel
from ..opendrive.surface import RoadSurface
from .findings import Findings, metres

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
