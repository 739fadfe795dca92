"""Lanes of a road map as a map of OpenDRIVE, with links, junctions and objects."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ....core.common.arrays import linked_groups
from ....core.common.progress import Progress
from ....core.common.setting import Limited, setting
from ..right_of_way import rights_of_way
from ..shared_borders import with_driven_middles
from ..sources import NearestValues, RoadMapSource, is_stated, sigma_of_lanes
from .geometry import Cubics
from .model import OPEN_END, STEP, Connection, Junction, LaneNetwork, MapLane, MapRoad, OpenDriveMap, RoadLink, RoadMark
from .objects import LANE_ID, add_objects
from .reference_line import side_by_side
from .road_shape import RoadShape, add_heights, add_lanes, centre_of, fit_borders, heights_above_road, shape_steps
from .strips import Cell, Slice, connector_slices, cut_into_cells, directions_where_met, end_to_end, mark_junctions, slices_of, strips_of
from .xodr import PATTERN_OF_MARK

ROUND_ORIGIN = 100.0      # m: the false origin is a multiple of it
MIDDLES_SHARE = 0.5       # of the tolerance by which borders are moved to their driving lines
CURVES_SHARE = 0.4        # of it by which widths may miss the moved borders: what is left is for corners, where two roads meet
LONGEST_JUNCTION = 100.0  # m of road between two ends of a junction
SHORTEST_WAY = 2.0        # m at least of a road that is cut off for a way straight on through a junction
LONGEST_WAY = 10.0        # m at most
CURB_WIDTH = 0.15         # m, of a curb stone seen from above
TYPE_OF_LANE = {"driving": "driving", "connector": "driving", "shoulder": "shoulder", "parking": "parking", "bicycle": "biking",
                "hatched": "restricted", "median": "median"}
MARK_OF_PATTERN = {pattern: mark for mark, pattern in reversed(PATTERN_OF_MARK.items())} | {"double": "solid solid"}
USUAL_DASH = (3.0, 6.0)   # m of a dash and a gap where the country is not known, as on German roads out of town


@dataclass(frozen=True)
class OpenDriveSettings(Limited):
    """tolerance : metres that borders may be missed; version : 1.7 or 1.8; traffic_side : automatic, right or left."""

    tolerance: float = setting(0.02, 0.002, 0.5, "Tolerance", "m")
    version: str = "1.7"
    traffic_side: str = "automatic"


class _OpenDriveDraft(NamedTuple):
    """The map, and notes for the user."""

    map: OpenDriveMap
    notes: list[str]


def draft_opendrive(source: RoadMapSource, settings: OpenDriveSettings = OpenDriveSettings(), progress: Progress = Progress()) -> _OpenDriveDraft:
    """Roads with reference line, sections, widths, heights, marks, objects, links and junctions.

    Lanes that share borders lie side by side in one road; it goes on while one slice of lanes follows another. Connectors, and the lanes that
    go straight on beside them, are the roads of a junction, one for each lane.

    source : RoadMapSource, checked
    """
    source = with_driven_middles(source, MIDDLES_SHARE * settings.tolerance)
    lanes = source.lanes
    places = np.concatenate([lanes.left, lanes.right])
    origin = np.append(np.floor(places[:, :2].mean(0) / ROUND_ORIGIN) * ROUND_ORIGIN, 0.0)
    local = replace(source, lanes=replace(lanes, left=lanes.left - origin, right=lanes.right - origin))
    drafting = _Drafting(local, origin, settings)
    whole = OpenDriveMap((1, int(settings.version[-1])), "Lanewright", offset=(float(origin[0]), float(origin[1]), 0.0, 0.0))
    strips = drafting.strips()
    directions = directions_where_met([cell for strip, _ in strips for part in strip for cell in part.cells])
    shaped = drafting.shaped([strip for strip, _ in strips], progress.part(0.0, 0.5))
    borders = fit_borders(shaped, CURVES_SHARE * settings.tolerance, directions)
    roads = []
    for number, (shape, functions, (_, single)) in enumerate(zip(shaped, borders, strips), start=1):
        roads.append(drafting.road(*shape, functions, number, single))
        progress.report(0.5 + 0.5 * number / len(strips))
    whole.roads = [road.road for road in roads]
    notes = drafting.notes + _link_roads(whole, roads) + _said_open_ends(whole)
    _add_priorities(whole, source)
    add_objects(whole, source.markings, source.signals, origin)
    return _OpenDriveDraft(whole, notes)


class _Drafting:
    def __init__(self, source: RoadMapSource, origin: np.ndarray, settings: OpenDriveSettings) -> None:
        self.source, self.lanes, self.origin, self.settings = source, source.lanes, origin, settings
        self.sigma = sigma_of_lanes(self.lanes, source.driving_lines)
        self.curb_heights = NearestValues(source.road_edges, "height_m")
        self.notes: list[str] = []
        self.cells = cut_into_cells(self.lanes)
        self.connectors, self.slices = connector_slices(self.cells, slices_of(self.cells))
        self.left_hand = self._left_hand()

    def _left_hand(self) -> bool:
        """Whether traffic keeps left: told by roads with both directions."""
        if self.settings.traffic_side != "automatic":
            return self.settings.traffic_side == "left"
        votes = 0.0
        for part in self.slices:
            ways = [cell.direction for cell in part.cells if cell.direction]
            if 1 in ways and -1 in ways:
                votes += part.length * (1 if ways.index(-1) < ways.index(1) else -1)
        if not votes:
            self.notes.append("No road has lanes in both directions; traffic was taken to keep right. Set Side of traffic where it keeps left.")
        return votes < 0

    def strips(self) -> list[tuple[list[Slice], bool]]:
        """(slices of a road, whether it is a way through a junction), ordinary roads first."""
        mark_junctions(self.slices)
        # slices of ordinary roads, those within junctions, and those that nobody drives and that touch a junction
        ordinary, inside, beside = [], [], []
        for part in self.slices:
            if (part.at_start or part.at_end) and not part.driven:
                beside.append(part)
            elif part.at_start and part.at_end and part.length < LONGEST_JUNCTION:
                inside.append(part)
            else:   # ways through a junction are cut off from the slices in which they begin or end
                ways, rest = _ways_cut_off(part)
                inside += ways
                ordinary += rest
        return (_ordinary_roads(ordinary) + [(strip, False) for strip in strips_of(beside, set())]
                + _ways_through([way for part in inside for way in part.ways()] + self.connectors, is_stated(self.lanes)))

    def shaped(self, strips: list[list[Slice]], progress: Progress) -> list[tuple[RoadShape, list[Slice], list[int]]]:
        """For each road its shape, its slices, and the number of the border in each at which lane 0 lies."""
        centres = [[centre_of(part, self.left_hand) for part in strip] for strip in strips]
        shapes = side_by_side([shape_steps(*road, self.settings.tolerance / 2) for road in zip(strips, centres)], progress)
        if cornered := sum(not shape.follows for shape in shapes):
            progress.info(f"The borders in the middle of {cornered} of {len(shapes)} roads have corners, which no reference line follows: smoother "
                          "lines were tried, so that the export takes longer, and the lane offset leads from them to the borders.")
        return list(zip(shapes, strips, centres))

    def road(self, shape: RoadShape, strip: list[Slice], centres: list[int], borders: list[list[Cubics]], number: int, single: bool) -> _DraftRoad:
        tolerance = self.settings.tolerance
        roads = sorted({int(self.lanes.road[cell.piece]) for part in strip for cell in part.cells})
        names = Counter(known.get("name") or known.get("ref") for known in map(self._known, (cell for part in strip for cell in part.cells)))
        name = names.most_common(1)[0][0] or f"Road {', '.join(map(str, roads))}"
        road = MapRoad(str(number), shape.plan.length, shape.plan, name, rule="LHT" if self.left_hand else "RHT")
        numbers = add_lanes(road, shape, strip, centres, borders)
        add_heights(road, shape, tolerance)
        status: dict[str, float] = defaultdict(float)
        for row, (part, ids, section, centre) in enumerate(zip(strip, numbers, road.sections, centres)):
            for k, (cell, id) in enumerate(zip(part.cells, ids)):
                self._describe(section.lanes[id], cell)
                section.lanes[id].heights = heights_above_road(shape, row, k)
                section.lanes[id].marks = [self._mark_between(part, k if id > 0 else k + 1, id)]
                status[str(self.lanes.status[cell.piece])] += cell.length
            # where lane 0 lies apart from them, the innermost border is that of the empty lane between
            apart = next((id for id in section.lanes if id and id not in ids), 0)
            section.lanes[0].marks = [RoadMark(0.0, "none")]
            section.lanes[apart].marks = [self._mark_between(part, centre, apart)]
            self._add_curbs(section.lanes, part, ids)
            section.order = sorted(section.lanes, reverse=True)
        if set(status) != {"measured"}:
            road.data = {f"lanewright:{name}_m": f"{metres:.1f}" for name, metres in sorted(status.items())}
        speeds = {speed for section in road.sections for lane in section.lanes.values() for _, speed in lane.speeds}
        road.speeds = [(0.0, speed) for speed in speeds if len(speeds) == 1]   # simulators read that of the road
        return _DraftRoad(road, strip, numbers, single)

    def _describe(self, lane: MapLane, cell: Cell) -> None:
        lane.type = TYPE_OF_LANE[self.lanes.type[cell.piece]]
        lane.data = {LANE_ID: str(self.lanes.lane_id[cell.piece])}
        lane.speeds = [(0.0, float(speed)) for speed in [self._known(cell).get("speed_kmh")] if speed]
        if np.isfinite(self.sigma[cell.piece]):
            lane.data["lanewright:sigma_m"] = f"{self.sigma[cell.piece]:.3f}"
        if self.lanes.status[cell.piece] != "measured":
            lane.data |= {"lanewright:status": str(self.lanes.status[cell.piece]),
                          "lanewright:confidence": f"{self.lanes.confidence[cell.piece]:.2f}"}

    def _known(self, cell: Cell) -> dict[str, Any]:
        return self.source.attributes.get(self.lanes.lane_id[cell.piece], {})

    def _about(self, cell: Cell, left: bool) -> tuple[str, str, str]:
        """(kind, pattern, line) of the border on one side along the road."""
        side = "left" if left == (cell.direction >= 0) else "right"
        kind, pattern, line = (getattr(self.lanes, f"{side}_{name}")[cell.piece] for name in ("kind", "pattern", "line"))
        return kind, pattern, line

    def _mark(self, cell: Cell, left: bool) -> RoadMark:
        kind, pattern, line = self._about(cell, left)
        if kind == "curb":
            return RoadMark(0.0, "curb" if not pattern else MARK_OF_PATTERN.get(pattern, "none"))
        name = MARK_OF_PATTERN.get(pattern, "edge" if kind == "pavement" else "none")
        width = self.source.paint_width(line)
        colour = self.source.paint_colour(line) if name not in ("none", "edge") else ""
        mark = RoadMark(0.0, name, colour or RoadMark.colour, RoadMark.width if np.isnan(width) else round(width, 3))
        if "broken" in name:
            mark.dash, mark.gap = USUAL_DASH
        return mark

    def _mark_between(self, one: Slice, number: int, lane: int) -> RoadMark:
        """The mark of a border of a slice, which is the outer one of `lane`: of two stripes where each of the lanes beside it has its own."""
        left, right = (self._mark(cells[0], is_left) if cells else None
                       for cells, is_left in ((one.cells[:number][-1:], False), (one.cells[number:], True)))
        lane_mark, neighbour_mark = (right, left) if lane >= 0 else (left, right)
        painted = [mark for mark in filter(None, (lane_mark, neighbour_mark)) if mark.type != "none"]
        if not painted:
            return next(filter(None, (lane_mark, neighbour_mark)), RoadMark(0.0, "none"))
        mark = next((mark for mark in painted if " " in mark.type), painted[0])
        if len(painted) == 2 and self.source.gaps is not None and (
                gap := float(self.source.gaps[one.cells[number - 1].piece, int(one.cells[number - 1].direction >= 0)])):
            lines = self._about(one.cells[number - 1], False)[2], self._about(one.cells[number], True)[2]
            if lines[0] != lines[1]:
                _make_double(mark, left, right, lane)
            mark.apart = round(gap, 3) * (" " in mark.type)
        return mark

    def _add_curbs(self, lanes: dict[int, MapLane], one: Slice, ids: list[int]) -> None:
        for cell, id, border, left in ((one.cells[0], ids[0], one.cells[0].left, True), (one.cells[-1], ids[-1], one.cells[-1].right, False)):
            if self._about(cell, left)[0] != "curb":
                continue
            beyond = max(lanes) + 1 if left else min(lanes) - 1
            curb = MapLane(beyond, "curb", type(lanes[id].width).constant(CURB_WIDTH), [RoadMark(0.0, "none")])
            if not np.isnan(height := self.curb_heights.median(border[:, :2] + self.origin[:2])):
                rise = np.array([0.0, 0.0, round(height, 3)])
                curb.heights = rise + np.array([[station, inner, inner] for station, inner, _ in lanes[id].heights] or [[0.0, 0.0, 0.0]])
            lanes[beyond] = curb


def _said_open_ends(whole: OpenDriveMap) -> list[str]:
    """Say in the file at which ends a driven lane goes on nowhere though its road does; notes for the user."""
    network, count = LaneNetwork(whole), 0
    for road in whole.roads:
        for number, section in enumerate(road.sections):
            for id, lane in section.lanes.items():
                ends = [end for end in ("start", "end") if id and network.is_open((road.id, number, id), end)]
                if ends:
                    lane.data[OPEN_END] = " ".join(ends)
                    count += len(ends)
    return [f"{count} ends of driven lanes are linked to no lane, since the survey shows none there, though their roads go on; userData of the "
            f"lanes says so."] if count else []


def _ordinary_roads(slices):
    """(slices of a road, False) of the roads between junctions; a road is driven along its direction, but for those with both."""
    owner = {id(cell): part for part in slices for cell in part.cells}
    breaks = {(id(part), id(owner[id(following)])) for part in slices for cell in part.cells for following in cell.after if id(following) in owner
              and any(id(near) not in owner for near in cell.after + following.before)}
    return [(_along_traffic(strip), False) for strip in strips_of(slices, breaks)]


def _ways_through(parts, stated):
    """(slices of a road, whether it is a way through a junction) of single lanes, all along their traffic.

    stated : whether the map states all ways, so that one that comes from nowhere or leads nowhere is a way all the same
    """
    parts = [part for given in parts for part in _along_traffic([given])]
    part_of = {id(cell): part for part in parts for cell in part.driven}
    return [([part_of[id(cell)] for cell in way], bool(way[0].before and way[-1].after or stated and (way[0].before or way[-1].after)))
            for way in end_to_end([cell for part in parts for cell in part.driven])]


def _along_traffic(strip):
    """The slices of a road that is driven against its direction alone turned round."""
    ways = {cell.direction for part in strip for cell in part.cells}
    return [part.turned() for part in strip[::-1]] if -1 in ways and 1 not in ways else strip


def _make_double(mark, left, right, lane):
    """Name a mark by the stripes left and right of a border, the outer one of `lane`, where it is not double and neither is a curb."""
    if " " not in mark.type and "curb" not in (left.type, right.type):
        # named from the middle of the road outwards, at lane 0 from left to right
        mark.type = f"{right.type} {left.type}" if lane > 0 else f"{left.type} {right.type}"
        dashed = next((stripe for stripe in ((right, left) if lane >= 0 else (left, right)) if stripe.dash), RoadMark(0.0, "none"))
        mark.dash, mark.gap = dashed.dash, dashed.gap


def _ways_cut_off(part: Slice) -> tuple[list[Slice], list[Slice]]:
    """(the ways through junctions that begin or end in a slice, what is left of it): all of it is a way where it is too short for both."""
    ways: list[Slice] = []
    for at_end in (False, True):
        if part.at_end if at_end else part.at_start:
            row = _cut_row(part, at_end)
            if not row:
                return [*ways, part], []
            first, last = part.split(row)
            way, part = (last, first) if at_end else (first, last)
            ways.append(way)
    return ways, [part]


def _cut_row(one: Slice, at_end: bool) -> int:
    """The vertex at which a way through a junction is cut off from a slice: some metres from its end, a third of it at most; 0 where none is."""
    middle = (one.cells[0].left + one.cells[-1].right)[:, :2] / 2
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(middle, axis=0).T)))
    if len(along) < 3 or along[-1] < 2 * SHORTEST_WAY:
        return 0
    wanted = min(max(SHORTEST_WAY, along[-1] / 3), LONGEST_WAY)
    row = int(np.argmin(np.abs(along - (along[-1] - wanted if at_end else wanted))))
    return min(max(row, 1), len(along) - 2)


# Links between the roads of an export: lanes of sections, ends of roads, junctions with their connections.

class _DraftRoad(NamedTuple):
    """A road with the cells that its lanes come from."""

    road: MapRoad
    strip: list[Slice]
    numbers: list[list[int]]   # lane of every cell of every slice
    single: bool   # whether it is a way through a junction


class _Touch(NamedTuple):
    """A lane at a road's end and the lane that it touches at an end of another road."""

    lane: int
    other: int
    other_end: str
    other_lane: int


def _link_roads(whole: OpenDriveMap, drafts: list[_DraftRoad]) -> list[str]:
    """Fill in the links of lanes and roads, and the junctions; sentences on what OpenDRIVE cannot say."""
    # where cells are: (draft, section, lane)
    places = [(cell, (k, j, number)) for k, draft in enumerate(drafts) for j, (part, ids) in enumerate(zip(draft.strip, draft.numbers))
              for cell, number in zip(part.cells, ids)]
    place_of = {id(cell): place for cell, place in places}
    touches: dict[tuple[int, str], list[_Touch]] = defaultdict(list)
    for cell, place in places:
        for end, neighbours in (("end", cell.after), ("start", cell.before)):
            for neighbour in neighbours:
                if id(neighbour) in place_of:
                    other_end = "start" if any(cell is back for back in neighbour.before) else "end"
                    _link(drafts, touches, place, end, place_of[id(neighbour)], other_end)
    junction = _junctions(drafts, touches)
    notes = {note for k, end in touches for note in _end_link(drafts, k, end, touches, junction)}
    _connect(whole, drafts, touches, junction)
    return sorted(notes)


def _link(drafts, touches, here, end, there, other_end):
    """One touch: of lanes of neighbouring sections at once, of ends of roads for later."""
    (draft, section, lane), (other, other_section, other_lane) = here, there
    sections = drafts[draft].road.sections
    beyond = section + STEP[end]
    if draft == other and other_section == beyond:
        linked = sections[section].lanes[lane].links[end]
        if other_lane not in linked:
            linked.append(other_lane)
    elif not 0 <= beyond < len(sections):
        touch = _Touch(lane, other, other_end, other_lane)
        if touch not in touches[draft, end]:
            touches[draft, end].append(touch)


def _junctions(drafts, touches):
    """{way through a junction: id of that}: ways at one road's end, or end to end, are of one. Roads and junctions share one space of ids in some
    readers."""
    pairs = []
    for (k, _), touched in touches.items():
        cluster = [way for way in (*(touch.other for touch in touched), k) if drafts[way].single]
        pairs += [(cluster[0], way) for way in cluster[1:]]
    group = linked_groups(*np.array(pairs, int).reshape(-1, 2).T, len(drafts))
    ids: dict[int, str] = {}
    return {k: ids.setdefault(int(group[k]), str(len(drafts) + 1 + len(ids))) for k, draft in enumerate(drafts) if draft.single}


def _end_link(drafts, k, end, touches, junction):
    """Link one end of a road to its junction, or to the road of its touches with the most lanes there: OpenDRIVE has one link an end. Sentences on
    what cannot be linked."""
    road, touched = drafts[k].road, touches[k, end]
    ways = [touch.other for touch in touched if touch.other in junction]
    if ways and k not in junction:
        road.links[end] = RoadLink("junction", junction[ways[0]])
        return []
    # a junction lies between this road and those whose ends are linked to it
    touched = [touch for touch in touched
               if k in junction or not any(back.other in junction for back in touches.get((touch.other, touch.other_end), ()))]
    lanes = Counter((touch.other, touch.other_end) for touch in touched)
    if not lanes:
        return []
    (neighbour, neighbour_end), *others = sorted(lanes, key=lambda way: (-lanes[way], way))
    road.links[end] = RoadLink("road", drafts[neighbour].road.id, neighbour_end)
    for touch in touched:
        if (touch.other, touch.other_end) == (neighbour, neighbour_end):
            road.lanes_at(end)[touch.lane].links[end].append(touch.other_lane)
    return [f"Road {road.id} touches {len(lanes)} roads at its {end} without a connector; it is linked to road {drafts[neighbour].road.id} alone."
            ] if others else []


def _connect(whole, drafts, touches, junction):
    """The junctions with what drives into them; what roads say of one that nobody drives into is dropped."""
    junctions = {id: Junction(id) for id in junction.values()}
    for k, id in junction.items():
        drafts[k].road.junction = id
    for (k, end), touched in sorted(touches.items()):
        road, lanes = drafts[k].road, defaultdict(list)
        for touch in touched:
            if k not in junction and touch.other in junction and road.way_out(touch.lane) == end:
                lanes[touch.other, touch.other_end].append((touch.lane, touch.other_lane))
        for (way, way_end), links in sorted(lanes.items()):
            connections = junctions[junction[way]].connections
            connections.append(Connection(str(len(connections)), road.id, drafts[way].road.id, way_end, links))
    whole.junctions = [formed for formed in junctions.values() if formed.connections]
    known = {formed.id for formed in whole.junctions}
    for road in whole.roads:
        road.links = {end: link for end, link in road.links.items() if link.element != "junction" or link.id in known}
        road.junction = road.junction if road.junction in known else "-1"


def _add_priorities(whole, source):
    """Say in the junctions which of the ways through them goes first."""
    ways = {lane.data.get(LANE_ID): road for road in whole.roads if road.junction != "-1" for section in road.sections
            for lane in section.lanes.values()}
    junctions = {junction.id: junction for junction in whole.junctions}
    for right in rights_of_way(source):
        for low, high in [[ways.get(source.lanes.lane_id[row]) for row in pair] for pair in right.conflicts]:
            if low and high and low.junction == high.junction and (high.id, low.id) not in junctions[low.junction].priorities:
                junctions[low.junction].priorities.append((high.id, low.id))
