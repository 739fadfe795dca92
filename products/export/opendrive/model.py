"""A map of OpenDRIVE as objects, which lane follows which on it, and where lanes lie."""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import shapely

from ..sources import LEAST_CURB
from ..xml_tree import XmlElement
from .geometry import LEAST_STEP, STEP_RUN, Cubics, PlanView

LINK_NAMES = {"start": "predecessor", "end": "successor"}   # an end of a road or lane -> its link there
OPEN_END = "lanewright:open_end"   # userData of a driven lane at whose start or end, or both, the survey shows no lane to go on in
DRIVEN_TYPES = ("driving", "bidirectional", "entry", "exit", "offRamp", "onRamp", "connectingRamp", "bus", "taxi", "HOV", "mwyEntry", "mwyExit",
                "slipLane", "stop")


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
    links: dict[str, list[int]] = field(default_factory=lambda: {"start": [], "end": []})   # numbers of the lanes that each end is linked to
    heights: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))
    border: bool = False    # `width` holds the distance of its outer border from the reference line instead
    data: dict[str, str] = field(default_factory=dict)
    speeds: list[tuple[float, float]] = field(default_factory=list)   # (metres from the section's start, km/h from there on, NaN for no limit)


@dataclass
class LaneSection:
    """Lanes from `s` on, by number."""

    s: float
    lanes: dict[int, MapLane] = field(default_factory=dict)
    order: list[int] = field(default_factory=list)   # of the numbers in the file


class RoadLink(NamedTuple):
    """What a road's end touches: road or junction, its id, and which end of that road."""

    element: str
    id: str
    contact: str = ""


@dataclass
class MapRoad:
    """A road. `shape` : (N, 6) s, t, a, b, c, d of the cross-section. `objects`, `signals` : dict of the attributes of each."""

    id: str
    length: float
    plan: PlanView
    name: str = ""
    junction: str = "-1"
    rule: str = "RHT"
    links: dict[str, RoadLink] = field(default_factory=dict)   # what its "start" and its "end" touch
    elevation: Cubics = field(default_factory=Cubics.constant)
    superelevation: Cubics = field(default_factory=Cubics.constant)
    shape: np.ndarray = field(default_factory=lambda: np.empty((0, 6)))
    lane_offset: Cubics = field(default_factory=Cubics.constant)
    sections: list[LaneSection] = field(default_factory=list)
    objects: list[dict[str, Any]] = field(default_factory=list)
    signals: list[dict[str, Any]] = field(default_factory=list)   # references to signals of other roads too
    speeds: list[tuple[float, float]] = field(default_factory=list)   # (s, km/h from there on, NaN for no limit) of lanes that say none
    data: dict[str, str] = field(default_factory=dict)

    @cached_property
    def surface(self) -> _RoadSurface:
        """Where its borders lie, once it is whole."""
        return _RoadSurface(self)

    def section_end(self, number: int) -> float:
        """Metres at which a section ends."""
        return self.sections[number + 1].s if number + 1 < len(self.sections) else self.length

    def lanes_at(self, end: str) -> dict[int, MapLane]:
        """The lanes by number at its "start" or "end"."""
        return self.sections[0 if end == "start" else -1].lanes if self.sections else {}

    def touches(self, end: str, element: str, id: str) -> bool:
        """Whether its "start" or "end" is linked to the road or junction of an id."""
        link = self.links.get(end)
        return link is not None and (link.element, link.id) == (element, id)

    def cut_where_speeds_change(self) -> MapRoad:
        """The road with sections within which no speed limit changes; itself where none does."""
        sections = []
        for number, section in enumerate(self.sections):
            length, cuts = self.section_end(number) - section.s, [0.0]
            for s in sorted({s - section.s for s, _ in self.speeds} | {s for lane in section.lanes.values() for s, _ in lane.speeds}):
                if cuts[-1] + BORDER_STEP <= s <= length - BORDER_STEP:
                    cuts.append(s)
            sections += [LaneSection(section.s + first, {id: _part(lane, first, last, length) for id, lane in section.lanes.items()}, section.order)
                         for first, last in zip(cuts, [*cuts[1:], length])]
        return replace(self, sections=sections) if len(sections) > len(self.sections) else self

    def lane_name(self, id: int, section: int) -> str:
        """The lane_id of a lane's section; commas part lists of them."""
        return f"{re.sub('[,.]', '_', self.id)}.{id}.{section}"

    def way_out(self, id: int) -> str:
        """The end, "start" or "end", at which the traffic of a lane leaves the road."""
        return "end" if (id < 0) == (self.rule != "LHT") else "start"


def _part(lane, first, last, length):
    """A lane from `first` to `last`, metres of its section of some length; within the section it leads to itself."""
    def held(starts):
        return slice(max(int(np.searchsorted(starts, first, side="right")) - 1, 0), int(np.searchsorted(starts, last)))

    width, heights = lane.width.rows, lane.heights
    return replace(
        lane, width=Cubics(width[held(width[:, 0])]).moved(-first), heights=heights[held(heights[:, 0])] - [first, 0.0, 0.0],
        marks=[replace(mark, s=mark.s - first) for mark in lane.marks[held([mark.s for mark in lane.marks])]],
        speeds=[(s - first, speed) for s, speed in lane.speeds[held([s for s, _ in lane.speeds])]],
        links={"start": [lane.id] if first > 0 else lane.links["start"], "end": [lane.id] if last < length else lane.links["end"]})


class Connection(NamedTuple):
    """A way through a junction. `lanes` : (from, to) numbers."""

    id: str
    incoming: str
    connecting: str
    contact: str
    lanes: list[tuple[int, int]]


@dataclass
class Junction:
    """A junction with its connections. priorities : (id of the road that goes first, id of the one that waits), ways through it or roads into it."""

    id: str
    name: str = ""
    connections: list[Connection] = field(default_factory=list)
    priorities: list[tuple[str, str]] = field(default_factory=list)


@dataclass
class OpenDriveMap:
    """A whole file."""

    version: tuple[int, int] = (1, 7)   # (major, minor)
    name: str = ""
    reference: str = ""   # text of geoReference
    offset: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)   # x, y, z, heading added to coordinates
    roads: list[MapRoad] = field(default_factory=list)
    junctions: list[Junction] = field(default_factory=list)
    problems: list[tuple[int, str]] = field(default_factory=list)   # (line, text) of what the reader passed over
    bounds: tuple[float, float, float, float] | None = None   # west, south, east, north of the header, None where it has none
    tree: XmlElement | None = field(default=None, repr=False)   # the file's elements, for what the map has no place for; None where it was not read

    def road(self, id: str) -> MapRoad | None:
        """The road of an id, None where there is none."""
        return next((road for road in self.roads if road.id == id), None)

    def place(self, road: MapRoad, s: float) -> np.ndarray:
        """(3,) map coordinates of the reference line of a road at s, or at its end where s lies beyond."""
        station = np.array([min(max(s, 0.0), road.plan.length)])
        return self.placed(np.c_[road.plan.at(station)[0], road.elevation.at(station)])[0]

    def placed(self, points: np.ndarray) -> np.ndarray:
        """(N, 3) points of the file in the coordinates of its CRS."""
        x, y, z, turn = self.offset
        c, s = np.cos(turn), np.sin(turn)
        return np.c_[points[:, 0] * c - points[:, 1] * s + x, points[:, 0] * s + points[:, 1] * c + y, points[:, 2] + z]


# Which lane follows which on a map of OpenDRIVE.

LaneKey = tuple[str, int, int]   # road, number of the section, lane
STEP, OTHER_END = {"start": -1, "end": 1}, {"start": "end", "end": "start"}   # from section to section beyond an end of a lane


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
        numbers = lane.links[end] if lane is not None else []
        beyond = key[1] + STEP[end]
        if 0 <= beyond < len(road.sections):
            return [((road.id, beyond, number), OTHER_END[end]) for number in numbers]
        link = road.links.get(end)
        if link is None:
            return []
        if link.element != "junction":
            return [(self._at(link.id, link.contact, number), link.contact) for number in numbers]
        return [(self._at(connection.connecting, connection.contact, to), connection.contact)
                for connection in self.connections[link.id, road.id] for start, to in connection.lanes if start == key[2]]

    def _at(self, road: str, contact: str, number: int) -> LaneKey:
        linked = self.roads.get(road)
        return road, len(linked.sections) - 1 if contact == "end" and linked is not None else 0, number

    @cached_property
    def touched(self) -> dict[tuple[LaneKey, str], list[tuple[LaneKey, str]]]:
        """(lane, which of its ends) of all that any lane is linked to -> those lanes and their ends."""
        touched = defaultdict(list)
        for road in self.roads.values():
            for key in [(road.id, number, id) for number, section in enumerate(road.sections) for id in section.lanes if id]:
                for end in LINK_NAMES:
                    for lane_end in self.touching(key, end):
                        touched[lane_end].append((key, end))
        return dict(touched)

    def is_open(self, key: LaneKey, end: str) -> bool:
        """Whether a driven lane is linked to no driven lane at an end, although its road goes on there."""
        road, touching = self.roads[key[0]], self.touching(key, end)
        if not self.driven(key) or any(self.driven(neighbour) for neighbour, _ in touching) or not touching and (key, end) in self.touched:
            return False
        link = road.links.get(end)
        return 0 <= key[1] + STEP[end] < len(road.sections) or link is not None and (
            link.element == "junction" and link.id in self.junctions or link.id in self.roads)

    def following(self, key: LaneKey) -> list[LaneKey]:
        """The driven lanes that a driven lane leads to, in the direction of travel, as it says or they say."""
        end = self.roads[key[0]].way_out(key[2])
        linked = dict.fromkeys((*self.touching(key, end), *self.touched.get((key, end), ())))
        # what ends where ours ends is no way on
        return [neighbour for neighbour, neighbour_end in linked
                if self.driven(neighbour) and neighbour_end != self.roads[neighbour[0]].way_out(neighbour[2])]

    def driven(self, key: LaneKey) -> bool:
        """Whether there is a lane of a key, and vehicles use it."""
        lane = self.lane(key)
        return lane is not None and lane.type in DRIVEN_TYPES


# Where the lanes of an OpenDRIVE road lie: borders in x, y, z.

BORDER_STEP = 1.0   # m between the places at which borders are computed
SAGITTA = 0.0005    # m by which the chord between two of them may miss a curve
LEAST_BORDER_STEP = 0.05   # m
BENDING_ROUNDS = 5   # of halving the steps where a border bends
BEFORE_END = 1e-6    # m before the end of a section at which its functions still hold
LONGEST_FOLD = 200      # places before and after a step back among which its crossing is looked for
GAP, KINK = 1e-4, 1e-4  # m and rad between elements of the reference line from which a border jumps there: it is cut on both sides


class _RoadSurface:
    """The borders of one road's lanes."""

    def __init__(self, road: MapRoad) -> None:
        self.road = road
        self._axis: tuple[np.ndarray, ...] = (np.empty(0),)   # s, and what all borders there share
        self._stations: dict[int, np.ndarray] = {}

    def stations(self, number: int) -> np.ndarray:
        """(N,) metres of s at which a section is cut: evenly, wherever a function of it changes, and closer where a border bends."""
        if number in self._stations:
            return self._stations[number]
        road, first, last = self.road, self.road.sections[number].s, self.road.section_end(number)
        bend = np.abs(road.plan.at(np.linspace(first, last, max(int((last - first) / BORDER_STEP), 1) + 1))[2]).max()
        step = min(BORDER_STEP, max(float(np.sqrt(8 * SAGITTA / max(bend, 1e-9))), LEAST_BORDER_STEP))
        even = np.linspace(first, last, max(int(np.ceil((last - first) / step - 1e-9)), 1) + 1)
        changes = [rows[:, 0] + first for lane in road.sections[number].lanes.values() for rows in (lane.width.rows, lane.heights)]
        heights = road.elevation.rows[:, 0], road.superelevation.rows[:, 0], road.shape[:, 0]
        knots = np.concatenate([even, [element.s for element in road.plan.elements], road.lane_offset.rows[:, 0], *heights, *changes])
        knots = np.unique(knots[(knots >= first) & (knots <= last)])
        keep = np.append(True, np.diff(knots) > STEP_RUN) & (knots < last - STEP_RUN)
        keep[0] = True
        knots = np.append(knots[keep], last) if last > first else knots[[0, -1]]
        if number + 1 < len(road.sections):   # the functions of the next section begin at its end
            knots[-1] = max(knots[-1] - BEFORE_END, knots[-2])
        steps = [_steps(values) for lane in road.sections[number].lanes.values() for values in (lane.width, lane.heights)]
        cuts = np.concatenate([self._cuts, *(s + first - 2 * LEAST_STEP for s in steps)])
        knots = np.unique(np.append(knots, cuts[(cuts > knots[0] + STEP_RUN) & (cuts < knots[-1] - STEP_RUN)]))
        self._stations[number] = self._bending(number, knots)
        return self._stations[number]

    def _bending(self, number, knots):
        """(N,) metres of s, with more between them where a border bends."""
        for _ in range(BENDING_ROUNDS):
            middles = (knots[:-1] + knots[1:]) / 2
            ends, inner = (np.stack(list(self.offsets(number, s).values())) for s in (knots, middles))
            rise, run = np.diff(ends, axis=1), np.diff(knots)
            missed = np.abs(inner - (ends[:, :-1] + ends[:, 1:]) / 2) * run / np.hypot(run, rise)
            bent = (missed > SAGITTA).any(0) & (run > 2 * LEAST_BORDER_STEP / 2**BENDING_ROUNDS)
            if not bent.any():
                break
            knots = np.sort(np.append(knots, middles[bent]))
        return knots

    @cached_property
    def _cuts(self):
        """(N,) metres of s before every gap or kink of the reference line, and before every step of a function of the whole road."""
        steps = [_steps(cubics) for cubics in (self.road.elevation, self.road.superelevation, self.road.lane_offset)]
        return np.append([s - BEFORE_END for s, _, _ in self.road.plan.jumps(GAP, KINK)], np.concatenate(steps) - 2 * LEAST_STEP)

    def offsets(self, number: int, s: np.ndarray) -> dict[int, np.ndarray]:
        """(N,) metres left of the reference line of every lane's outer border, and of lane 0, by lane number."""
        section = self.road.sections[number]
        centre = self.road.lane_offset.at(s)
        offsets = {0: centre}
        for side in (1, -1):
            outer = centre
            for id in sorted((id for id in section.lanes if id * side > 0), key=abs):
                lane = section.lanes[id]
                value = lane.width.at(s - section.s)
                outer = side * np.abs(value) if lane.border else outer + side * np.maximum(value, 0.0)
                offsets[id] = outer
        return offsets

    def places(self, s: np.ndarray, t: np.ndarray, height: np.ndarray | float = 0.0) -> np.ndarray:
        """(N, 3) coordinates of the file at s and t: the t axis rolled by the superelevation, the shape laid on it."""
        road = self.road
        if not np.array_equal(self._axis[0], s):
            plan, heading, _ = road.plan.at(s)
            roll = road.superelevation.at(s)
            self._axis = s.copy(), *plan.T, np.sin(heading), np.cos(heading), np.sin(roll), np.cos(roll), road.elevation.at(s)
        _, x, y, sine, cosine, rise, run, level = self._axis
        flat = t * run
        return np.stack([x - sine * flat, y + cosine * flat, level + t * rise + shape_height(road.shape, s, t) + height], axis=1)

    def borders(self, number: int, id: int, s: np.ndarray, offsets: dict[int, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """((N, 3) inner, (N, 3) outer) border of a lane along the road."""
        inner = offsets[self.inside(number, id)]
        lift = self.lifts(number, id, s)
        return self.places(s, inner, lift[0]), self.places(s, offsets[id], lift[1])

    def jumps(self) -> list[tuple[float, float, int]]:
        """(s, metres, lane) of every gap or kink of the reference line, with the jump of the farthest border there and its lane, and of every step
        of a width or height."""
        road, result = self.road, []
        starts = [section.s for section in road.sections]
        for s, gap, turn in road.plan.jumps(GAP, KINK):
            number = int(np.searchsorted(starts, s, side="right")) - 1
            if number >= 0:
                farthest, lane = max((abs(float(t[0])), id) for id, t in self.offsets(number, np.array([s])).items())
                result.append((s, gap + 2 * farthest * float(np.sin(turn / 2)), lane))
        result += [(s, size, 0) for s, size in zip(*road.elevation.steps())]
        result += [(s, size, 0) for s, size in zip(*road.lane_offset.steps()) if s not in starts]   # where lanes begin lane 0 may lie elsewhere
        return result + [(section.s + s, size, lane.id) for section in road.sections for lane in section.lanes.values()
                         for s, size in zip(*lane.width.steps())]

    def inside(self, number: int, id: int) -> int:
        """The lane next to one on the side of lane 0, which is never missing."""
        return max((lane for lane in self.road.sections[number].lanes if lane * id >= 0 and abs(lane) < abs(id)), key=abs, default=0)

    def lifts(self, number: int, id: int, s: np.ndarray) -> np.ndarray:
        """(2, N) metres that the inner and the outer border of a lane lie above the road."""
        heights = self.road.sections[number].lanes[id].heights if id in self.road.sections[number].lanes else np.empty((0, 3))
        if not len(heights):
            return np.zeros((2, len(s)))
        k = np.searchsorted(heights[:, 0], s - self.road.sections[number].s + 1e-9, side="right") - 1
        return np.where(k < 0, 0.0, heights[np.maximum(k, 0), 1:].T)

    def without_folds(self, s: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
        """(N, 3) places of a border at s, of which none lies on a loop, and where the first loop was, None where there was none.

        Where a curve is tighter than a border is far from the reference line, the border runs back for a while and crosses itself twice over.
        The places between are led to the crossing, so that the border stands still there.
        """
        heading = self.road.plan.at((s[:-1] + s[1:]) / 2)[1]
        steps = np.diff(points[:, :2], axis=0)
        back = steps[:, 0] * np.cos(heading) + steps[:, 1] * np.sin(heading) < 0
        if not back.any() or shapely.linestrings(points[:, :2]).is_simple:
            return points, None
        points, first = points.copy(), None
        for a in np.flatnonzero(back & ~np.append(False, back[:-1])):
            b = a + int(np.argmin(np.append(back[a:], False)))   # the steps a to b - 1 run back
            crossing = _crossing(points, a, b)
            if crossing is not None:
                before, after, place = crossing
                first = place if first is None else first
                points[before + 1:after + 1] = place
        return points, first


def _steps(values):
    """(N,) metres of s at which Cubics, or (M, 3) heights that hold from row to row, step by more than LEAST_CURB."""
    s, sizes = values.steps() if isinstance(values, Cubics) else (values[1:, 0], np.abs(np.diff(values[:, 1:], axis=0)).max(1, initial=0.0))
    return s[sizes > LEAST_CURB]


def _crossing(points, a, b):
    """(step, step, place) at which the steps before a cross those from b on: the one that is left last; None where none do."""
    lines = shapely.linestrings(np.stack([points[:-1, :2], points[1:, :2]], axis=1))
    before, after = np.arange(max(a - LONGEST_FOLD, 0), a), np.arange(b, min(b + LONGEST_FOLD, len(lines)))
    pairs = shapely.STRtree(lines[after]).query(lines[before], predicate="intersects")
    if not pairs.shape[1]:
        return None
    # the outermost crossing takes all smaller loops with it
    i, j = min(((before[p], after[q]) for p, q in pairs.T), key=lambda pair: (pair[0], -pair[1]))
    point = shapely.get_coordinates(shapely.intersection(lines[i], lines[j]))[0]
    share = np.hypot(*(point - points[i, :2])) / max(float(np.hypot(*(points[i + 1] - points[i])[:2])), 1e-12)
    return i, j, np.append(point, points[i, 2] + share * (points[i + 1, 2] - points[i, 2]))


def shape_height(shape: np.ndarray, s: np.ndarray, t: np.ndarray) -> np.ndarray:
    """(N,) metres of the lateral shape at s and t: a cubic in t at each given s, linear between them.

    Right of the first t its cubic goes on straight.
    """
    if not len(shape):
        return np.zeros(len(s))
    rows = shape[np.lexsort((shape[:, 1], shape[:, 0]))]
    given, first, count = np.unique(rows[:, 0], return_index=True, return_counts=True)
    starts = np.full((len(given), count.max()), np.inf)
    starts[np.repeat(np.arange(len(given)), count), np.arange(len(rows)) - np.repeat(first, count)] = rows[:, 1]

    def value(k: np.ndarray) -> np.ndarray:
        piece = np.maximum((starts[k] <= t[:, None] + 1e-9).sum(1) - 1, 0)
        _, start, a, b, c, d = rows[first[k] + piece].T
        dt = t - start
        return np.where(t < starts[k, 0], a + b * dt, a + dt * (b + dt * (c + dt * d)))

    k = np.clip(np.searchsorted(given, s, side="right") - 1, 0, max(len(given) - 2, 0))
    if len(given) == 1:
        return value(k)
    share = np.clip((s - given[k]) / (given[k + 1] - given[k]), 0.0, 1.0)
    return value(k) * (1 - share) + value(k + 1) * share
