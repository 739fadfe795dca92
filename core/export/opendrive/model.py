"""A map of OpenDRIVE as objects: what the reader makes, the exporter fills, the writer writes and the check looks at."""

from __future__ import annotations

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
