"""Lanes of a road map as a map of OpenDRIVE."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, replace

import numpy as np

from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ..shared_borders import with_driven_middles
from ..sources import NearestValues, RoadMapSource, sigma_of_lanes
from .heights import add_heights, heights_above_road
from .junctions import DraftRoad, link_roads
from .model import OPEN_END, LaneNetwork, MapLane, MapRoad, OpenDriveMap, RoadMark
from .road_objects import add_objects
from .road_shape import add_lanes, centre_of, shape_of
from .strips import (
    Cell,
    Slice,
    connector_slices,
    cut_into_cells,
    directions_where_met,
    end_to_end,
    is_connector,
    mark_junctions,
    slices_of,
    strips_of,
)

ROUND_ORIGIN = 100.0      # m: the false origin is a multiple of it
MIDDLES_SHARE = 0.5       # of the tolerance by which borders are moved to their driving lines
CURVES_SHARE = 0.4        # of it by which widths may miss the moved borders: what is left is for corners, where two roads meet
LONGEST_JUNCTION = 100.0  # m of road between two ends of a junction
SHORTEST_WAY = 2.0        # m at least of a road that is cut off for a way straight on through a junction
LONGEST_WAY = 10.0        # m at most
CURB_WIDTH = 0.15         # m, of a curb stone seen from above
NEAREST_CURB = 0.5        # m from a border within which a road edge tells its height
TYPE_OF_LANE = {"driving": "driving", "connector": "driving", "shoulder": "shoulder", "parking": "parking", "bicycle": "biking",
                "hatched": "restricted", "median": "median"}
MARK_OF_PATTERN = {"solid": "solid", "dashed": "broken", "double-solid": "solid solid", "double": "solid solid", "double-dashed": "broken broken",
                   "solid-dashed": "solid broken", "dashed-solid": "broken solid"}
USUAL_DASH = (3.0, 6.0)   # m of a dash and a gap where the country is not known, as on German roads out of town


@dataclass(frozen=True)
class OpenDriveSettings:
    """tolerance : metres that borders may be missed; version : 1.7 or 1.8; traffic_side : automatic, right or left."""

    tolerance: float = setting(0.02, 0.002, 0.5, "Tolerance", "m")
    version: str = "1.7"
    traffic_side: str = "automatic"
    dash: tuple[float, float] = USUAL_DASH

    def __post_init__(self) -> None:
        check_limits(self)


@dataclass
class OpenDriveDraft:
    """The map, the place of every cell in it, and notes for the user.

    place : id of a cell -> (road, section, lane); cells : list of Cell
    """

    map: OpenDriveMap
    roads: list[DraftRoad] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def draft_opendrive(source: RoadMapSource, settings: OpenDriveSettings = OpenDriveSettings(), progress: Progress = Progress()) -> OpenDriveDraft:
    """Roads with reference line, sections, widths, heights, marks, objects, links and junctions.

    Lanes that share borders lie side by side in one road; it goes on while one slice of lanes follows another. Connectors, and the lanes that
    go straight on beside them, are the roads of a junction, one for each lane.

    Parameters
    ----------
    source : RoadMapSource, checked
    settings : OpenDriveSettings
    progress : told of the share of the roads

    Returns
    -------
    OpenDriveDraft
    """
    source = with_driven_middles(source, MIDDLES_SHARE * settings.tolerance)
    lanes = source.lanes
    places = np.concatenate([lanes.left, lanes.right])
    origin = np.append(np.floor(places[:, :2].mean(0) / ROUND_ORIGIN) * ROUND_ORIGIN, 0.0)
    local = replace(source, lanes=replace(lanes, left=lanes.left - origin, right=lanes.right - origin))
    drafting = _Drafting(local, origin, settings)
    draft = OpenDriveDraft(OpenDriveMap((1, int(settings.version[-1])), "Lanewright", offset=(float(origin[0]), float(origin[1]), 0.0, 0.0)))
    draft.notes += drafting.notes
    strips = drafting.strips()
    directions = directions_where_met([cell for strip, _ in strips for one in strip for cell in one.cells])
    for number, (strip, single) in enumerate(strips, start=1):
        made = drafting.road(strip, number, single, directions)
        draft.roads.append(made)
        draft.map.roads.append(made.road)
        progress.report(number / len(strips))
    draft.notes += link_roads(draft.map, draft.roads)
    draft.notes += _said_open_ends(draft.map)
    add_objects(draft.map, source.markings, origin)
    return draft


class _Drafting:
    def __init__(self, source: RoadMapSource, origin: np.ndarray, settings: OpenDriveSettings) -> None:
        self.source, self.lanes, self.origin, self.settings = source, source.lanes, origin, settings
        self.sigma = sigma_of_lanes(self.lanes, source.driving_lines)
        self.curb_heights = NearestValues(source.road_edges, "height_m")
        self.notes: list[str] = []
        self.cells = cut_into_cells(self.lanes)
        self.connectors, self.slices = connector_slices(self.cells, slices_of(self.cells, self.lanes), self.lanes)
        self.left_hand = self._left_hand()

    def _left_hand(self) -> bool:
        """Whether traffic keeps left: told by roads with both directions."""
        if self.settings.traffic_side != "automatic":
            return self.settings.traffic_side == "left"
        votes = 0.0
        for one in self.slices:
            ways = [cell.direction for cell in one.cells if cell.direction]
            if 1 in ways and -1 in ways:
                votes += one.length * (1 if ways.index(-1) < ways.index(1) else -1)
        if not votes:
            self.notes.append("No road has lanes in both directions; traffic was taken to keep right. Set Side of traffic where it keeps left.")
        return votes < 0

    def strips(self) -> list[tuple[list[Slice], bool]]:
        """(slices of a road, whether it is a way through a junction), ordinary roads first."""
        mark_junctions(self.slices, self.lanes)
        ordinary, inside = [], []
        for one in self.slices:
            if one.at_start and one.at_end and one.length < LONGEST_JUNCTION:
                inside.append(one)
                continue
            for at_end in (False, True):
                row = _cut_row(one, at_end) if (one.at_end if at_end else one.at_start) else 0
                if row:
                    first, last = one.split(row)
                    part, one = (last, first) if at_end else (first, last)
                    inside.append(part)
                elif one.at_end if at_end else one.at_start:   # too short for a way and a road
                    inside.append(one)
                    break
            else:
                ordinary.append(one)
        ordinary, between = _between_junctions(ordinary, {id(cell) for one in inside for cell in one.cells}
                                               | {id(cell) for cell in self.cells if is_connector(cell, self.lanes)})
        inside += between
        owner = {id(cell): one for one in ordinary for cell in one.cells}
        breaks = {(id(one), id(owner[id(other)])) for one in ordinary for cell in one.cells for other in cell.after if id(other) in owner
                  and any(id(near) not in owner for near in cell.after + other.before)}
        found = [([one.turned() for one in strip[::-1]] if _against(strip) else strip, False) for strip in strips_of(ordinary, breaks)]
        parts = [part for one in inside for part in one.ways()] + self.connectors
        lost = sum(len(one.cells) for one in inside if not any(cell.direction for cell in one.cells))
        if lost:
            self.notes.append(f"{lost} pieces that nobody drives lie within junctions, where OpenDRIVE has no place for them.")
        # all run with their traffic
        parts = [one.turned() if any(cell.direction < 0 for cell in one.cells) else one for one in parts]
        part_of = {id(cell): one for one in parts for cell in one.cells if cell.direction}
        for way in end_to_end([cell for one in parts for cell in one.cells if cell.direction]):
            # what comes from nowhere or leads nowhere is no way through
            found.append(([part_of[id(cell)] for cell in way], bool(way[0].before) and bool(way[-1].after)))
        return found

    def road(self, strip: list[Slice], number: int, single: bool, directions: dict[int, float]) -> DraftRoad:
        tolerance = self.settings.tolerance
        centres = [centre_of(one, self.left_hand) for one in strip]
        shape = shape_of(strip, centres, tolerance / 2)
        roads = sorted({int(self.lanes.road[cell.piece]) for one in strip for cell in one.cells})
        road = MapRoad(str(number), shape.plan.length, shape.plan, f"Road {', '.join(map(str, roads))}", rule="LHT" if self.left_hand else "RHT")
        numbers = add_lanes(road, shape, strip, centres, CURVES_SHARE * tolerance, directions)
        add_heights(road, shape, tolerance)
        status: dict[str, float] = defaultdict(float)
        for row, (one, ids, section, centre) in enumerate(zip(strip, numbers, road.sections, centres)):
            for k, (cell, id) in enumerate(zip(one.cells, ids)):
                self._describe(section.lanes[id], cell)
                section.lanes[id].heights = heights_above_road(shape, row, k)
                section.lanes[id].marks = [self._mark_between(one, k if id > 0 else k + 1, id)]
                status[str(self.lanes.status[cell.piece])] += cell.length
            # where lane 0 lies apart from them, the innermost border is that of the empty lane between
            apart = next((id for id in section.lanes if id and id not in ids), 0)
            section.lanes[0].marks = [RoadMark(0.0, "none")]
            section.lanes[apart].marks = [self._mark_between(one, centre, apart)]
            self._add_curbs(section.lanes, one, ids)
            section.order = sorted(section.lanes, reverse=True)
        if set(status) != {"measured"}:
            road.data = {f"lanewright:{name}_m": f"{metres:.1f}" for name, metres in sorted(status.items())}
        return DraftRoad(road, strip, numbers, single)

    def _describe(self, lane: MapLane, cell: Cell) -> None:
        lane.type = TYPE_OF_LANE[self.lanes.type[cell.piece]]
        lane.data = {"lanewright:lane_id": str(self.lanes.lane_id[cell.piece])}
        if np.isfinite(self.sigma[cell.piece]):
            lane.data["lanewright:sigma_m"] = f"{self.sigma[cell.piece]:.3f}"
        if self.lanes.status[cell.piece] != "measured":
            lane.data |= {"lanewright:status": str(self.lanes.status[cell.piece]),
                          "lanewright:confidence": f"{self.lanes.confidence[cell.piece]:.2f}"}

    def _about(self, cell: Cell, left: bool) -> tuple[str, str, str]:
        """(kind, pattern, line) of the border on one side along the road."""
        lanes, k = self.lanes, cell.piece
        side = left if cell.direction >= 0 else not left
        columns = (lanes.left_kind, lanes.left_pattern, lanes.left_line) if side else (lanes.right_kind, lanes.right_pattern, lanes.right_line)
        return columns[0][k], columns[1][k], columns[2][k]

    def _mark(self, cell: Cell, left: bool) -> RoadMark:
        kind, pattern, line = self._about(cell, left)
        if kind == "curb":
            return RoadMark(0.0, "curb" if not pattern else MARK_OF_PATTERN.get(pattern, "none"))
        name = MARK_OF_PATTERN.get(pattern, "edge" if kind == "pavement" else "none")
        mark = RoadMark(0.0, name, "white" if name not in ("none", "edge") else "standard", self._paint_width(line))
        if "broken" in name:
            mark.dash, mark.gap = self.settings.dash
        return mark

    def _mark_between(self, one: Slice, number: int, lane: int) -> RoadMark:
        """The mark of a border of a slice, which is the outer one of `lane`: of two stripes where each of the lanes beside it has its own."""
        left = self._mark(one.cells[number - 1], False) if number else None
        right = self._mark(one.cells[number], True) if number < len(one.cells) else None
        own, other = (right, left) if lane >= 0 else (left, right)
        painted = [mark for mark in (own, other) if mark is not None and mark.type != "none"]
        if not painted:
            return own or other or RoadMark(0.0, "none")
        mark = next((mark for mark in painted if " " in mark.type), painted[0])
        gap = self._gap(one.cells[number - 1], False) if number else 0.0
        if gap and left is not None and right is not None and len(painted) == 2:
            lines = self._about(one.cells[number - 1], False)[2], self._about(one.cells[number], True)[2]
            if " " not in mark.type and "curb" not in (left.type, right.type) and lines[0] != lines[1]:
                # named from the middle of the road outwards, at lane 0 from left to right
                mark.type = f"{right.type} {left.type}" if lane > 0 else f"{left.type} {right.type}"
                mark.dash, mark.gap = next(((one.dash, one.gap) for one in painted if one.dash), (0.0, 0.0))
            mark.apart = round(gap, 3) if " " in mark.type else 0.0
        return mark

    def _gap(self, cell: Cell, left: bool) -> float:
        """Metres between the two stripes of the border on one side along the road."""
        if self.source.gaps is None:
            return 0.0
        return float(self.source.gaps[cell.piece, 0 if left == (cell.direction >= 0) else 1])

    def _paint_width(self, line: str) -> float:
        layer = self.source.marking_lines
        rows = layer.rows if layer is not None and line.startswith("line ") else ()
        widths = [float(row["width_m"]) for row in rows if str(row.get("line")) == line[5:] and row.get("width_m") is not None]
        return round(float(np.median(widths)), 3) if widths else RoadMark(0.0, "none").width

    def _add_curbs(self, lanes: dict[int, MapLane], one: Slice, ids: list[int]) -> None:
        for cell, id, border, left in ((one.cells[0], ids[0], one.cells[0].left, True), (one.cells[-1], ids[-1], one.cells[-1].right, False)):
            if self._about(cell, left)[0] != "curb":
                continue
            beyond = max(lanes) + 1 if left else min(lanes) - 1
            curb = MapLane(beyond, "curb", type(lanes[id].width).constant(CURB_WIDTH), [RoadMark(0.0, "none")])
            heights = self.curb_heights.at(border[:, :2] + self.origin[:2], NEAREST_CURB)
            if np.isfinite(heights).any():
                rise = np.array([0.0, 0.0, round(float(np.nanmedian(heights)), 3)])
                curb.heights = rise + np.array([[at, inner, inner] for at, inner, _ in lanes[id].heights] or [[0.0, 0.0, 0.0]])
            lanes[beyond] = curb


def _said_open_ends(whole: OpenDriveMap) -> list[str]:
    """Say in the file at which ends a driven lane goes on nowhere though its road does; notes for the user."""
    network, count = LaneNetwork(whole), 0
    touched = network.touched()
    for road in whole.roads:
        for number, section in enumerate(road.sections):
            for id, lane in section.lanes.items():
                ends = [end for end in ("start", "end") if id and network.is_open((road.id, number, id), end, touched)]
                if ends:
                    lane.data[OPEN_END] = " ".join(ends)
                    count += len(ends)
    return [f"{count} ends of driven lanes are linked to no lane, since the survey shows none there, though their roads go on; userData of the "
            f"lanes says so."] if count else []


def _between_junctions(slices, inside):
    """(slices, those of them that are too short for a road and lie between ways through junctions)."""
    found = []
    while True:
        more = [one for one in slices if one.length < SHORTEST_WAY and all(
            others and all(id(other) in inside for other in others)
            for others in ([other for cell in one.cells for other in cell.before], [other for cell in one.cells for other in cell.after]))]
        if not more:
            return slices, found
        found += more
        inside = inside | {id(cell) for one in more for cell in one.cells}
        slices = [one for one in slices if not any(one is other for other in more)]


def _against(strip):
    """Whether a road is driven against its direction alone."""
    ways = {cell.direction for one in strip for cell in one.cells}
    return -1 in ways and 1 not in ways


def _cut_row(one: Slice, at_end: bool) -> int:
    """The vertex at which a way through a junction is cut off from a slice: some metres from its end, a third of it at most; 0 where none is."""
    middle = (one.cells[0].left + one.cells[-1].right)[:, :2] / 2
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(middle, axis=0).T)))
    if len(along) < 3 or along[-1] < 2 * SHORTEST_WAY:
        return 0
    wanted = min(max(SHORTEST_WAY, along[-1] / 3), LONGEST_WAY)
    row = int(np.argmin(np.abs(along - (along[-1] - wanted if at_end else wanted))))
    return min(max(row, 1), len(along) - 2)
