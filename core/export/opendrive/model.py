"""A map of OpenDRIVE as objects: what the reader makes, the exporter fills, the writer writes and the check looks at."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..xml_tree import XmlElement
from .geometry import Cubics, PlanView

ROAD_LANE_TYPES = ("none", "driving", "stop", "shoulder", "biking", "sidewalk", "border", "restricted", "parking", "bidirectional", "median",
                   "special1", "special2", "special3", "roadWorks", "tram", "rail", "entry", "exit", "offRamp", "onRamp", "connectingRamp", "bus",
                   "taxi", "HOV", "mwyEntry", "mwyExit", "curb", "walking", "slipLane", "shared")
OPEN_END = "lanewright:open_end"   # userData of a driven lane at whose start or end, or both, the survey shows no lane to go on in
DRIVEN_TYPES = ("driving", "bidirectional", "entry", "exit", "offRamp", "onRamp", "connectingRamp", "bus", "taxi", "HOV", "mwyEntry", "mwyExit",
                "slipLane", "stop")
MARK_TYPES = ("none", "solid", "broken", "solid solid", "solid broken", "broken solid", "broken broken", "botts dots", "grass", "curb", "custom",
              "edge")


@dataclass
class RoadMark:
    """How a border is painted from `s` on (metres from the start of the section). dash, gap : metres, 0 where solid. apart : metres between
    the middles of the two stripes of a double mark, 0 where unknown."""

    s: float
    type: str
    colour: str = "standard"
    width: float = 0.12
    weight: str = "standard"
    dash: float = 0.0
    gap: float = 0.0
    apart: float = 0.0


@dataclass
class MapLane:
    """A lane of one section: positive numbers are left of the reference line, 0 has no width.

    width : Cubics of metres from the section's start; `heights` : (N, 3) such metres, inner and outer height above the road
    """

    id: int
    type: str = "driving"
    width: Cubics = field(default_factory=lambda: Cubics(np.empty((0, 5))))
    marks: list[RoadMark] = field(default_factory=list)
    predecessors: list[int] = field(default_factory=list)
    successors: list[int] = field(default_factory=list)
    heights: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))
    border: bool = False    # `width` holds the distance of its outer border from the reference line instead
    data: dict[str, str] = field(default_factory=dict)


@dataclass
class LaneSection:
    """Lanes from `s` on, by number."""

    s: float
    lanes: dict[int, MapLane] = field(default_factory=dict)
    order: list[int] = field(default_factory=list)   # of the numbers in the file


@dataclass
class RoadLink:
    """What a road's end touches: road or junction, its id, and which end of that road."""

    element: str
    id: str
    contact: str = ""


@dataclass
class MapRoad:
    """A road. `shape` : (N, 6) s, t, a, b, c, d of the cross-section. `objects` : dict of the attributes of each."""

    id: str
    length: float
    plan: PlanView
    name: str = ""
    junction: str = "-1"
    rule: str = "RHT"
    predecessor: RoadLink | None = None
    successor: RoadLink | None = None
    elevation: Cubics = field(default_factory=Cubics.constant)
    superelevation: Cubics = field(default_factory=Cubics.constant)
    shape: np.ndarray = field(default_factory=lambda: np.empty((0, 6)))
    lane_offset: Cubics = field(default_factory=Cubics.constant)
    sections: list[LaneSection] = field(default_factory=list)
    objects: list[dict[str, Any]] = field(default_factory=list)
    data: dict[str, str] = field(default_factory=dict)

    def section_end(self, number: int) -> float:
        """Metres at which a section ends."""
        return self.sections[number + 1].s if number + 1 < len(self.sections) else self.length

    def link(self, end: str) -> RoadLink | None:
        """What its "start" or "end" touches."""
        return self.predecessor if end == "start" else self.successor


@dataclass
class Connection:
    """A way through a junction. `lanes` : (from, to) numbers."""

    id: str
    incoming: str
    connecting: str
    contact: str
    lanes: list[tuple[int, int]] = field(default_factory=list)


@dataclass
class Junction:
    """A junction with its connections."""

    id: str
    name: str = ""
    connections: list[Connection] = field(default_factory=list)


@dataclass
class OpenDriveMap:
    """A whole file.

    version : (major, minor); reference : text of geoReference; offset : x, y, z, heading added to coordinates
    problems : (line, text) of what the reader passed over; bounds : west, south, east, north of the header, None where it has none
    tree : the file's elements, for what the map has no place for; None where it was not read
    """

    version: tuple[int, int] = (1, 7)
    name: str = ""
    reference: str = ""
    offset: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    roads: list[MapRoad] = field(default_factory=list)
    junctions: list[Junction] = field(default_factory=list)
    problems: list[tuple[int, str]] = field(default_factory=list)
    bounds: tuple[float, float, float, float] | None = None
    tree: XmlElement | None = field(default=None, repr=False)

    def road(self, id: str) -> MapRoad | None:
        """The road of an id, None where there is none."""
        return next((road for road in self.roads if road.id == id), None)

    def placed(self, points: np.ndarray) -> np.ndarray:
        """(N, 3) points of the file in the coordinates of its CRS."""
        x, y, z, turn = self.offset
        c, s = np.cos(turn), np.sin(turn)
        return np.c_[points[:, 0] * c - points[:, 1] * s + x, points[:, 0] * s + points[:, 1] * c + y, points[:, 2] + z]


# Which lane follows which on a map of OpenDRIVE.

LaneKey = tuple[str, int, int]   # road, number of the section, lane


class LaneNetwork:
    """Looks up what lanes touch. Ends of a lane are "start" and "end", along the road's reference line."""

    def __init__(self, whole: OpenDriveMap) -> None:
        self.roads = {road.id: road for road in whole.roads}
        self.junctions = {junction.id for junction in whole.junctions}
        self.connections: dict[tuple[str, str], list[Connection]] = defaultdict(list)
        for junction in whole.junctions:
            for connection in junction.connections:
                self.connections[junction.id, connection.incoming].append(connection)

    def lane(self, key: LaneKey) -> MapLane | None:
        """The lane of a key, None where there is none."""
        road = self.roads.get(key[0])
        if road is None or not 0 <= key[1] < len(road.sections):
            return None
        return road.sections[key[1]].lanes.get(key[2])

    def touching(self, key: LaneKey, end: str) -> list[tuple[LaneKey, str]]:
        """(lane, which of its ends) of all lanes that a lane's end is linked to, whether they exist or not."""
        road, lane = self.roads[key[0]], self.lane(key)
        numbers = [] if lane is None else lane.successors if end == "end" else lane.predecessors
        inside = key[1] + (1 if end == "end" else -1)
        if 0 <= inside < len(road.sections):
            return [((road.id, inside, number), "start" if end == "end" else "end") for number in numbers]
        link = road.link(end)
        if link is None:
            return []
        if link.element != "junction":
            return [(self._at(link.id, link.contact, number), link.contact) for number in numbers]
        return [(self._at(connection.connecting, connection.contact, to), connection.contact)
                for connection in self.connections[link.id, road.id] for start, to in connection.lanes if start == key[2]]

    def _at(self, road: str, contact: str, number: int) -> LaneKey:
        known = self.roads.get(road)
        return road, len(known.sections) - 1 if contact == "end" and known is not None else 0, number

    def touched(self) -> set[tuple[LaneKey, str]]:
        """(lane, which of its ends) of all that any lane is linked to."""
        lanes = [(road.id, number, id) for road in self.roads.values() for number, section in enumerate(road.sections) for id in section.lanes if id]
        return {found for key in lanes for end in ("start", "end") for found in self.touching(key, end)}

    def is_open(self, key: LaneKey, end: str, touched: set[tuple[LaneKey, str]]) -> bool:
        """Whether a driven lane is linked to no driven lane at an end, although its road goes on there.

        touched : as above; roads that leave a junction are named by its connecting roads alone
        """
        road, lane = self.roads[key[0]], self.lane(key)
        if lane is None or lane.type not in DRIVEN_TYPES:
            return False
        touching = self.touching(key, end)
        if any((known := self.lane(other)) is not None and known.type in DRIVEN_TYPES for other, _ in touching):
            return False
        if not touching and (key, end) in touched:
            return False
        link = road.link(end)
        return 0 <= key[1] + (1 if end == "end" else -1) < len(road.sections) or link is not None and (
            link.element == "junction" and link.id in self.junctions or link.id in self.roads)

    def following(self, key: LaneKey) -> list[LaneKey]:
        """The driven lanes that a driven lane leads to, in the direction of travel."""
        end = "end" if travel(self.roads[key[0]], key[2]) > 0 else "start"
        found = []
        for other, there in self.touching(key, end):
            lane = self.lane(other)
            # what ends where ours ends is no way on
            if lane is not None and lane.type in DRIVEN_TYPES and there == ("start" if travel(self.roads[other[0]], other[2]) > 0 else "end"):
                found.append(other)
        return found


def travel(road: MapRoad, id: int) -> int:
    """1 where the lanes of this side are driven along the reference line, -1 where against it."""
    return 1 if (id < 0) == (road.rule != "LHT") else -1
