"""Lanes of a road map as lanelets, nodes and ways that neighbours share, written as Lanelet2."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import NamedTuple

import numpy as np
import shapely

from ...core.common.arrays import linked_groups
from ...core.common.errors import RoadExtractionError
from ...core.common.setting import Limited, setting
from ...core.driving.layers import Lanes
from ...core.io.crs import as_in_file, horizontal_part, parse_crs
from .lanelet_map import KIND_OF_WAY, LANE_ID, OURS, PATTERN_OF_WAY, Lanelet, Way
from .right_of_way import named, rights_of_way
from .shared_borders import SAME_VERTEX, WIDEST_DOUBLE, cuts_beside, numbered
from .sources import LEAST_CURB, LOCAL_CRS, NearestValues, RoadMapSource, is_stated, sigma_of_lanes, stop_lines, walked_crossings, without_repeats
from .xml_tree import file_text

SAME_RISE = 0.1         # m in height between vertices at one place that are one node
HIGH_CURB = 0.10        # m: lower ones can be driven over, as the format means by `low`
THICK_LINE = 0.18       # m of paint from which a line is thick: above the narrow and below the broad lines of most countries
SUBTYPE_OF_LANE = {"driving": "road", "connector": "road", "bicycle": "bicycle_lane", "shoulder": "emergency_lane"}
PARTICIPANTS = {"bicycle": "participant:bicycle", "shoulder": "participant:vehicle:emergency"}
SUBTYPE_OF_PATTERN = {pattern: subtype for subtype, pattern in PATTERN_OF_WAY.items()} | {"double": "solid_solid"}
TURN = 0.5              # rad from which a way through a junction is a turn


@dataclass(frozen=True)
class LaneletSettings(Limited):
    """speed_limit : km/h, 0 writes none; location : urban or nonurban; signal_width : m of lights and signs that say none."""

    speed_limit: int = setting(0, 5, 200, "Speed limit", "km/h", zero="for none")
    location: str = "urban"
    signal_width: float = 0.4


@dataclass
class _LaneletDraft:
    """A map before it gets degrees, with numbers from 0 in place of ids: of nodes, of ways, and of lanelets and rules together."""

    nodes: np.ndarray   # (N, 3) metres in the CRS of the survey
    ways: list[Way] = field(default_factory=list)
    lanelets: list[Lanelet] = field(default_factory=list)
    rules: list[Lanelet] = field(default_factory=list)   # what lanelets obey, numbered after them
    skipped: Counter[str] = field(default_factory=Counter)   # type of lane -> pieces that are no lanelets
    unmet: int = 0   # links of lanes whose ends lie too far apart to be one
    added: int = 0   # links of lanes that meet though the map does not say that they do


def draft_lanelets(source: RoadMapSource, settings: LaneletSettings = LaneletSettings()) -> _LaneletDraft:
    """Lanelets of the lanes that are driven, with crossings and stop lines of the markings.

    A border between neighbours is one way. Where a lane begins or ends beside another, that other one is cut too, at the same place, so
    that every lanelet has one way left and one right.

    source : RoadMapSource, checked
    """
    return _Drafting(source, settings).run()


def _bridged(lanes: Lanes) -> tuple[Lanes, np.ndarray, int]:
    """(lanes of a map from elsewhere that reach those that they are linked to, (V,) whether a vertex was an end before, links that are left out as
    their ends lie too far apart).

    Of corners that links join all are led to one, that of a lane before those of connectors: lanes that miss it begin or end there with a further
    vertex.
    """
    places = np.concatenate([lanes.left, lanes.right])
    nodes, first = numbered(places)
    corners = {(k, end): (row, row + len(lanes.left)) for k in range(len(lanes)) for end, row in ((0, lanes.start[k]), (1, lanes.start[k + 1] - 1))}
    row_of = {name: k for k, name in enumerate(lanes.lane_id)}
    links = np.array([(*corners[k, 1], *corners[row_of[name], 0], k, row_of[name])
                      for k, names in enumerate(lanes.successors) for name in names if name in row_of], int).reshape(-1, 6)
    gaps = np.hypot(*(places[links[:, :2]] - places[links[:, 2:4]]).transpose(2, 0, 1)[:2]).max(1, initial=0.0)
    near, broken = links[gaps <= WIDEST_DOUBLE], set(map(tuple, links[gaps > WIDEST_DOUBLE, 4:].tolist()))
    group = linked_groups(nodes[near[:, :2].ravel()], nodes[near[:, 2:4].ravel()], len(first))[nodes]
    goal_of: dict[int, int] = {}
    for end in sorted(corners, key=lambda end: (lanes.type[end[0]] == "connector", lanes.road[end[0]], end[0])):
        for row in corners[end]:
            goal_of.setdefault(group[row], int(first[nodes[row]]))
    goals = {end: [goal_of[group[row]] for row in rows] for end, rows in corners.items()}
    extra = {end: goals[end] for end, rows in corners.items() if (nodes[goals[end]] != nodes[list(rows)]).any()}
    successors = [tuple(name for name in names if (k, row_of.get(name)) not in broken) for k, names in enumerate(lanes.successors)]
    return *_with_ends(replace(lanes, successors=successors), places, extra), len(broken)


def _with_ends(lanes, places, extra):
    """(lanes with a further vertex at some of their ends, (V,) whether a vertex was such an end before).

    extra : (lane, 0 for its start or 1 for its end) -> rows of `places`, left and right
    """
    ends, was_end = sorted(extra), np.zeros(len(lanes.left), bool)
    was_end[[lanes.start[k + end] - end for k, end in ends]] = True
    rows = [lanes.start[k + end] for k, end in ends]
    left, right = (np.insert(line, rows, places[[extra[end][side] for end in ends]], axis=0) for side, line in enumerate((lanes.left, lanes.right)))
    further = np.bincount(np.array([k for k, _ in ends], int), minlength=len(lanes))
    return replace(lanes, left=left, right=right, start=lanes.start + np.append(0, np.cumsum(further))), np.insert(was_end, rows, False)


class _Drafting:
    def __init__(self, source: RoadMapSource, settings: LaneletSettings) -> None:
        unmet, self.was_end = 0, np.zeros(len(source.lanes.left), bool)
        if is_stated(source.lanes):
            lanes, self.was_end, unmet = _bridged(source.lanes)
            source = replace(source, lanes=lanes, middles=None)
        self.source, self.settings, self.lanes = source, settings, source.lanes
        lanes = source.lanes
        places = np.concatenate([lanes.left, lanes.right])
        numbers, first = numbered(places, LEAST_CURB if is_stated(lanes) else SAME_RISE)
        self.draft = _LaneletDraft(places[first], unmet=unmet)
        self.left, self.right = numbers[:len(lanes.left)], numbers[len(lanes.left):]
        self.way_of: dict[tuple[int, ...], int] = {}
        # beside a double line the bounds meet in its middle, and the line to drive on stays between the stripes
        self.middles = source.middles if source.middles is not None else (lanes.left + lanes.right) / 2
        self.curb_heights = NearestValues(source.road_edges, "height_m")
        self.sigma = sigma_of_lanes(lanes, source.driving_lines)

    def run(self) -> _LaneletDraft:
        lanes = self.lanes
        used = [k for k in range(len(lanes)) if lanes.type[k] in SUBTYPE_OF_LANE]
        self.draft.skipped = Counter(kind for kind in lanes.type if kind not in SUBTYPE_OF_LANE)
        among = np.repeat(np.isin(np.arange(len(lanes)), used), np.diff(lanes.start)) & ~self.was_end
        cuts = cuts_beside(lanes, self.left, self.right, among)
        for k in used:
            bounds, last = [lanes.start[k]], lanes.start[k + 1] - 1
            for row in range(bounds[0] + 1, last):
                # where one border stands still there is no lanelet to cut off
                if among[row] and (self.left[row] in cuts or self.right[row] in cuts) and all(
                        self.left[row] != self.left[end] and self.right[row] != self.right[end] for end in (bounds[-1], last)):
                    bounds.append(row)
            for a, b in zip(bounds, [*bounds[1:], last]):
                self._lanelet(k, slice(a, b + 1))
        self._objects()
        self.draft.added = self._added_links(used)
        return self.draft

    def _added_links(self, used):
        """How many lanes end where one begins that they are not linked to: in this format the one leads to the other."""
        starts = defaultdict(set)
        for k in used:
            starts[self.left[self.lanes.start[k]], self.right[self.lanes.start[k]]].add(self.lanes.lane_id[k])
        ends = ((k, starts[self.left[self.lanes.start[k + 1] - 1], self.right[self.lanes.start[k + 1] - 1]]) for k in used if self.lanes.direction[k])
        return sum(len(names - {self.lanes.lane_id[k], *self.lanes.successors[k]}) for k, names in ends)

    def _lanelet(self, k: int, rows: slice) -> None:
        lanes = self.lanes
        left, right = (tuple(node for node, _ in groupby(side[rows].tolist())) for side in (self.left, self.right))
        if len(left) < 2 or len(right) < 2:   # where a lane tapers away, one border may stand still
            return
        tags = {"type": "lanelet", "subtype": SUBTYPE_OF_LANE[lanes.type[k]], "location": self.settings.location, "one_way": "yes"}
        tags[PARTICIPANTS.get(lanes.type[k], "participant:vehicle")] = "yes"
        known = self.source.attributes.get(lanes.lane_id[k], {})
        if (speed := known.get("speed_kmh") or self.settings.speed_limit) and lanes.type[k] not in PARTICIPANTS:
            tags["speed_limit"] = f"{speed:.4g}"
        tags |= {tag: known[name] for name, tag in (("name", "road_name"), ("surface", "road_surface")) if known.get(name)}
        if lanes.type[k] == "connector":
            tags["turn_direction"] = _turn((lanes.left[rows] + lanes.right[rows]) / 2)
        if np.isfinite(self.sigma[k]):
            tags["lanewright:sigma_m"] = f"{self.sigma[k]:.3f}"
        if lanes.status[k] != "measured":
            tags |= {"lanewright:status": lanes.status[k], "lanewright:confidence": f"{lanes.confidence[k]:.2f}"}
        centre = self._new_nodes(without_repeats(self.middles[rows], SAME_VERTEX))   # at a kink of a map from elsewhere there are two
        self._add_lanelet(tags | {LANE_ID: lanes.lane_id[k]},
                          left=self._border(left, lanes.left_kind[k], lanes.left_pattern[k], lanes.left_line[k]),
                          right=self._border(right, lanes.right_kind[k], lanes.right_pattern[k], lanes.right_line[k]),
                          centerline=self._new_way(centre, {"type": "centerline"}))

    def _new_way(self, nodes: tuple[int, ...], tags: dict[str, str]) -> int:
        """The number of a way of its own."""
        self.draft.ways.append(Way(len(self.draft.ways), nodes, tags))
        return len(self.draft.ways) - 1

    def _add_lanelet(self, tags: dict[str, str], **ways: int) -> None:
        """A lanelet of ways by their roles."""
        self.draft.lanelets.append(Lanelet(len(self.draft.lanelets), tags, {role: [("way", number)] for role, number in ways.items()}))

    def _border(self, nodes: tuple[int, ...], kind: str, pattern: str, line: str) -> int:
        """The number of the way along these nodes, which neighbours share; one that says more about it takes precedence."""
        key = min(nodes, nodes[::-1])
        if key not in self.way_of:
            self.way_of[key] = self._new_way(nodes, {"type": "virtual"})
        way = self.draft.ways[self.way_of[key]]
        turned = way.nodes != nodes
        if way.tags["type"] == "virtual":
            mirrored = turned and "-" in pattern and "double" not in pattern
            way.tags = self._tags(nodes, kind, "-".join(pattern.split("-")[::-1]) if mirrored else pattern, line)
        return way.id

    def _tags(self, nodes, kind, pattern, line):
        places = self.draft.nodes[list(nodes)]
        if kind == "curb":
            height = self.curb_heights.median(places[:, :2])
            tags = {"type": "curbstone", "subtype": "low" if height < HIGH_CURB else "high"}
            return tags | ({} if np.isnan(height) else {"height": f"{height:.2f}"})
        if pattern in SUBTYPE_OF_PATTERN:
            width, colour = self.source.paint_width(line), self.source.paint_colour(line)
            tags = {"type": "line_thick" if width > THICK_LINE else "line_thin", "subtype": SUBTYPE_OF_PATTERN[pattern]}
            return tags | ({} if np.isnan(width) else {"width": f"{width:.2f}"}) | ({"color": colour} if colour else {})
        return {"type": "road_border"} if kind in ("edge", "pavement") else {"type": "virtual"}

    def _new_nodes(self, places: np.ndarray) -> tuple[int, ...]:
        first = len(self.draft.nodes)
        self.draft.nodes = np.concatenate([self.draft.nodes, places])
        return tuple(range(first, first + len(places)))

    def _objects(self) -> None:
        """Stop lines and crossings from the markings, signs from the signals, and rules of who waits at them."""
        for line in stop_lines(self.source.markings):
            self._new_way(self._new_nodes(line), {"type": "stop_line", "subtype": "solid"})
        for sides in walked_crossings(self.source.markings):
            left, right = (self._new_way(self._new_nodes(side), {"type": "pedestrian_marking", "subtype": "dashed"}) for side in sides)
            self._add_lanelet({"type": "lanelet", "subtype": "crosswalk", "location": self.settings.location, "one_way": "no",
                               "participant:pedestrian": "yes"}, left=left, right=right)
        parts = defaultdict(list)
        for lanelet in self.draft.lanelets:
            if lanelet.name:
                parts[lanelet.name].append(lanelet)
        signs = [self._signal(shapely.get_coordinates(point, include_z=True)[0], row, parts) for point, row in self.source.signals or ()]
        self._right_of_way(signs, parts)

    def _right_of_way(self, signs, parts):
        """Rules of who waits for whom, with the sign and the stop line where there are any.

        signs : ways of the signals; parts : name of a lane -> its lanelets, of which the one next to the junction is one of a rule
        """
        lanes, rows = self.lanes, {name: k for k, name in enumerate(self.lanes.lane_id)}
        stops = [way for way in self.draft.ways if way.tags["type"] == "stop_line"]
        for right in rights_of_way(self.source):
            waiting, first = ([parts[name][0 if lanes.type[rows[name]] == "connector" else -1] for name in names if name in parts]
                              for names in (right.waiting, right.first))
            lines = [("way", way.id) for way in stops
                     if right.before.distance(shapely.LineString(self.draft.nodes[list(way.nodes), :2])) < WIDEST_DOUBLE]
            if waiting and first:
                members = {"refers": [("way", signs[number]) for number in right.signs], "yield": [("relation", lanelet.id) for lanelet in waiting],
                           "right_of_way": [("relation", lanelet.id) for lanelet in first], "ref_line": lines}
                self._rule("right_of_way", members, [*waiting, *first])

    def _signal(self, place, row, parts):
        """The number of the way of a light, sign or pole, which is a rule of the lanelets that are nearest to it of each lane that it holds for;
        None of what is no signal."""
        kind, height = row["kind"], row.get("height_m")
        if kind not in KIND_OF_WAY.values():
            return None
        heading, width = np.radians(row.get("heading") or 0.0), row.get("width_m") or self.settings.signal_width
        reach = np.array([0.0, 0.0, height or width]) if kind == "pole" else np.array([np.cos(heading), -np.sin(heading), 0.0]) * width
        nodes = self._new_nodes(np.array([place, place + reach]) - (kind != "pole") * reach / 2)
        tags = {"type": {"sign": "traffic_sign"}.get(kind, kind)}
        if kind != "pole":
            known = {name: f"{row[name]}" for name in ("country", "code", "subcode", "value", "unit", "text") if row.get(name) not in (None, "")}
            code = known.get("country", "") + known.get("code", "") + ("-" + known["subcode"] if "subcode" in known else "")
            tags["subtype"] = "red_yellow_green" if kind == "traffic_light" else code or "unknown"
            tags |= {OURS + name: value for name, value in known.items()} | ({"height": f"{height:.2f}"} if height else {})
        way = self._new_way(nodes, tags)
        held = [parts[name] for name in named(row.get("lanes")) if name in parts]

        def apart(lanelet):
            middle = self.draft.nodes[list(self.draft.ways[lanelet.way("centerline")].nodes), :2]
            return float(np.hypot(*(middle - place[:2]).T).min())

        if held and kind != "pole":
            self._rule(tags["type"], {"refers": [("way", way)]}, [min(lanelets, key=apart) for lanelets in held])
        return way

    def _rule(self, subtype, members, lanelets):
        """A rule of traffic, and that lanelets obey it."""
        number = len(self.draft.lanelets) + len(self.draft.rules)
        self.draft.rules.append(Lanelet(number, {"type": "regulatory_element", "subtype": subtype}, members))
        for lanelet in {lanelet.id: lanelet for lanelet in lanelets}.values():
            lanelet.members.setdefault("regulatory_element", []).append(("relation", number))


def _turn(middle: np.ndarray) -> str:
    """left, right or straight, as Autoware calls the ways through a junction."""
    first, last = middle[1] - middle[0], middle[-1] - middle[-2]
    turn = (np.arctan2(last[1], last[0]) - np.arctan2(first[1], first[0]) + np.pi) % (2 * np.pi) - np.pi
    return "left" if turn > TURN else "right" if turn < -TURN else "straight"


# Writing in the XML of OpenStreetMap, with latitude and longitude.

NO_VERTICAL = "not stated by the survey; heights are written as they are"
SQUARE = 100_000.0     # m: local coordinates of Autoware are those within a square of this size


class Degrees(NamedTuple):
    """How the map's places became latitude and longitude."""

    lonlat: np.ndarray   # (N, 2) degrees of WGS 84
    way: str   # name of the transformation
    accuracy: float   # metres as its authors say, -1 where they do not;
    vertical: str   # what the heights are
    local: bool = False   # whether the map lies nowhere on the earth


def to_degrees(places: np.ndarray, crs: str) -> Degrees:
    """Latitude and longitude of (N, 2+) places; those without CRS about the origin of their coordinates become a local map about 0, 0.

    Raises RoadExtractionError if the CRS is unknown and the coordinates are not local, or the places lie outside of the CRS.
    """
    from pyproj.transformer import Transformer, TransformerGroup

    parsed = parse_crs(crs)
    if parsed is None and np.abs(places[:, :2]).max(initial=0.0) < SQUARE:
        lon, lat = Transformer.from_crs(LOCAL_CRS, "EPSG:4326", always_xy=True).transform(places[:, 0], places[:, 1])
        return Degrees(np.c_[lon, lat], "local coordinates about latitude and longitude 0", -1.0, NO_VERTICAL, True)
    if parsed is None:
        raise RoadExtractionError("The layer of lanes has no CRS, so its latitude and longitude are unknown. Set the CRS of the layer and run again.")
    transformer = TransformerGroup(horizontal_part(parsed), "EPSG:4326", always_xy=True).transformers[0]
    lon, lat = transformer.transform(places[:, 0], places[:, 1])
    if not (np.isfinite(lon).all() and np.isfinite(lat).all()):
        raise RoadExtractionError(f"The lanes do not lie where their CRS {horizontal_part(parsed).name} holds. Check the CRS of the layer.")
    vertical = parsed.sub_crs_list[-1].name if parsed.is_compound else NO_VERTICAL
    if as_in_file(crs)[1].up != 1.0:
        vertical += ", in metres"
    return Degrees(np.c_[lon, lat], transformer.description, transformer.accuracy if transformer.accuracy is not None else -1.0, vertical)


def lanelet2_text(draft: _LaneletDraft, degrees: Degrees, local: bool = False) -> str:
    """The file as text, of a draft and the degrees of its nodes.

    `local`: also write the tags local_x and local_y, metres within a square of 100 km, as Autoware reads them.
    """
    used = sorted(set().union(*(way.nodes for way in draft.ways)))
    id_of = {node: k for k, node in enumerate(used, start=1)}
    square = np.floor(draft.nodes[used, :2].min(0) / SQUARE) * SQUARE if used and not degrees.local else np.zeros(2)
    nodes = np.c_[degrees.lonlat[used], draft.nodes[used] - np.append(square, 0.0)].tolist()
    first = {"way": len(used) + 1, "relation": len(used) + 1 + len(draft.ways)}
    return file_text("lanelet2.xml", local=local or degrees.local, nodes=nodes, draft=draft, id_of=id_of, first=first)
