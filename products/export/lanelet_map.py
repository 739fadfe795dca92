"""A map of Lanelet2: its nodes, ways and lanelets as objects, read from a file, and as layers like ours."""

from __future__ import annotations

import re
from collections import Counter, defaultdict, deque
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely

from ...core.common.errors import RoadExtractionError
from ...core.common.features import MARKING_LINES, ROAD_EDGES, SIGNALS, Features
from ...core.common.progress import Progress
from ...core.driving.layers import Lanes
from ...core.io.crs import parse_crs
from ...core.lazy import pyproj
from .sources import LEAST_LED, LOCAL_CRS, STOP_LINE_HALF, RoadMapSource, add_edge, add_marking_line, metric_wkt, plan_length, utm_of, without_repeats
from .xml_tree import XmlElement, read_xml

OURS = "lanewright:"   # of tags that the format does not have
LANE_ID = OURS + "lane_id"   # of a lanelet: its piece of the layer


@dataclass
class Way:
    """A line of nodes, by their ids. line : in the file, 0 where made."""

    id: int
    nodes: Sequence[int]
    tags: dict[str, str] = field(default_factory=dict)
    line: int = 0


@dataclass
class Lanelet:
    """A relation: members by role, each a list of (type, id); a lanelet has one way left and one right."""

    id: int
    tags: dict[str, str] = field(default_factory=dict)
    members: dict[str, list[tuple[str, int]]] = field(default_factory=dict)
    line: int = 0

    @property
    def name(self) -> str:
        """The lane_id of the lane that it was made of, "" for none."""
        return self.tags.get(LANE_ID, "")

    def way(self, role: str) -> int | None:
        """The id of the only way of a role, None where there is none or more than one."""
        ids = [id for kind, id in self.members.get(role, ()) if kind == "way"]
        return ids[0] if len(ids) == 1 else None


@dataclass
class LaneletMap:
    """A whole file. ways, lanelets, others : by id; others are the remaining relations, such as regulatory elements"""

    node_ids: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))   # (N,) int in order of the file
    degrees: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))   # (N, 2) longitude, latitude
    heights: np.ndarray = field(default_factory=lambda: np.empty(0))   # (N,) metres, NaN where a node has none
    local: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))   # (N, 2) metres of the tags local_x and local_y, NaN where a node has none
    ways: dict[int, Way] = field(default_factory=dict)
    lanelets: dict[int, Lanelet] = field(default_factory=dict)
    others: dict[int, Lanelet] = field(default_factory=dict)
    twice: list[tuple[str, int, int]] = field(default_factory=list)   # ids that were there more than once
    tags_twice: list[tuple[str, int, str]] = field(default_factory=list)   # (kind of element, id, key) of tags that an element has more than once

    def __post_init__(self) -> None:
        self.row_of = {int(id): k for k, id in enumerate(self.node_ids)}

    def rows(self, way: Way) -> np.ndarray:
        """Rows of a way's nodes; nodes that are missing are left out."""
        return np.array([self.row_of[id] for id in way.nodes if id in self.row_of], int)


# The lanelets of a map as places and as a network: which follows which, which lies beside which.

NEVER_DRIVEN = ("crosswalk", "walkway", "stairs")


class LaneletNetwork:
    """Lanelets with borders in the direction of travel.

    places : (N, 3) metres of its nodes

    left, right : id -> rows of nodes, in the direction of travel
    reversed_left, reversed_right : id -> whether the way runs against the direction of travel
    """

    def __init__(self, whole: LaneletMap, places: np.ndarray) -> None:
        self.whole, self.places = whole, places
        self.left: dict[int, np.ndarray] = {}
        self.right: dict[int, np.ndarray] = {}
        self.reversed_left: dict[int, bool] = {}
        self.reversed_right: dict[int, bool] = {}
        for lanelet in whole.lanelets.values():
            self._place(lanelet)
        starts, goals, by_border = defaultdict(list), defaultdict(list), defaultdict(list)
        for id in self.left:
            starts[self.ends(id)[0]].append(id)
            goals[self.ends(id)[1]].append(id)
            for role in ("left", "right"):
                by_border[whole.lanelets[id].way(role)].append((id, role))
        self._starts, self._goals, self._by_border = starts, goals, by_border

    def _place(self, lanelet: Lanelet) -> None:
        ids = lanelet.way("left"), lanelet.way("right")
        left, right = (self.whole.rows(self.whole.ways[id]) if id in self.whole.ways else np.empty(0, int) for id in ids)
        if len(left) < 2 or len(right) < 2:
            return
        turned_right = not same_way(self.places[left], self.places[right])
        ring = self.places[np.concatenate([left, right if turned_right else right[::-1]]), :2]
        x, y = (ring - ring[0]).T
        turned = np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) > 0   # left then lies to the right: the lanelet is driven the other way
        self.left[lanelet.id] = left[::-1] if turned else left
        self.right[lanelet.id] = right[::-1] if turned_right != turned else right
        self.reversed_left[lanelet.id], self.reversed_right[lanelet.id] = turned, turned_right != turned

    def ends(self, id: int) -> tuple[tuple[int, int], tuple[int, int]]:
        """((left, right) row of the first nodes, of the last nodes)."""
        left, right = self.left[id], self.right[id]
        return (int(left[0]), int(right[0])), (int(left[-1]), int(right[-1]))

    def following(self, id: int) -> list[int]:
        """Lanelets that begin with the two nodes at which this one ends."""
        return [next_id for next_id in self._starts.get(self.ends(id)[1], ()) if next_id != id]

    def head_on(self) -> list[tuple[int, int]]:
        """Pairs of lanelets that end, or begin, on the same two nodes from either side: no traffic flows so."""
        pairs = []
        for end in (0, 1):
            by_nodes = defaultdict(list)
            for id in self.left:
                by_nodes[self.ends(id)[end]].append(id)
            for (left, right), ids in by_nodes.items():
                if left < right:
                    pairs += [(id, opposite) for id in ids for opposite in by_nodes.get((right, left), ())]
        return pairs

    def abreast(self, id: int) -> list[tuple[int, bool]]:
        """(lanelet that shares a border with this one, whether it is driven the same way)."""
        lanelet, turned = self.whole.lanelets[id], {"left": self.reversed_left, "right": self.reversed_right}
        return [(neighbour, turned[role][id] == turned[other][neighbour]) for role in turned
                for neighbour, other in self._by_border[lanelet.way(role)] if neighbour != id]

    def crosses(self, id: int) -> bool:
        """Whether it is a way through a junction: the map says how it turns, or others begin where it does and others end where it does."""
        forks, meets = (len(by_ends[self.ends(id)[k]]) > 1 for k, by_ends in ((0, self._starts), (1, self._goals)))
        return self.driven(id) and ("turn_direction" in self.whole.lanelets[id].tags or forks and meets)

    def driven(self, id: int) -> bool:
        """Whether vehicles use it."""
        return self.whole.lanelets[id].tags.get("subtype", "road") not in NEVER_DRIVEN


def same_way(first: np.ndarray, second: np.ndarray) -> bool:
    """Whether two lines beside each other, (N, 2+) and (M, 2+), are drawn the same way."""
    along = np.hypot(*(first[0, :2] - second[0, :2])) + np.hypot(*(first[-1, :2] - second[-1, :2]))
    against = np.hypot(*(first[0, :2] - second[-1, :2])) + np.hypot(*(first[-1, :2] - second[0, :2]))
    return bool(along <= against)


# Reading from the XML of OpenStreetMap.

OSM_KIND = "a Lanelet2 map in the XML of OpenStreetMap"
MAX_ID = 2**63   # ids are whole numbers of 64 bits with a sign; those that editors give to what is new are negative
ALL_IDS = 2**64   # of 64 bits; without a sign, as some programs write them, the larger ones are negative ones


def read_lanelet2(path: str, progress: Progress = Progress()) -> LaneletMap:
    """Read an .osm file; RoadExtractionError if it is no map of this kind, hostile, or has no lanelet."""
    whole = _lanelets_of(read_xml(path, "osm", OSM_KIND, progress))
    if not whole.lanelets:
        raise RoadExtractionError(f"{path} has no relation of type lanelet. Maps of OpenStreetMap have roads without lanes; choose a Lanelet2 map.")
    return whole


def _lanelets_of(root: XmlElement) -> LaneletMap:
    """The map of the element <osm>."""
    ids, places, local, twice, ways = [], [], [], [], {}
    tags_twice: list[tuple[str, int, str]] = []
    lanelets: dict[int, Lanelet] = {}
    relations: dict[int, Lanelet] = {}
    seen = set()
    for element in root.children:
        if element.tag not in ("node", "way", "relation") or element.get("action") == "delete":
            continue
        id, keys = _id(element, "id"), [child.get("k") for child in element.all("tag")]
        tags = {child.get("k"): child.get("v") for child in element.all("tag")}
        if len(keys) > len(tags):
            tags_twice += [(element.tag, id, key) for key in tags if keys.count(key) > 1]
        if (element.tag, id) in seen:
            twice.append((element.tag, id, element.line))
            continue
        seen.add((element.tag, id))
        if element.tag == "node":
            ids.append(id)
            # maps in local coordinates leave latitude and longitude out, or empty
            degrees = (element.number(name, np.nan) if element.get(name) else np.nan for name in ("lon", "lat"))
            places.append((*degrees, _tag_number(tags, "ele", element)))
            local.append((_tag_number(tags, "local_x", element), _tag_number(tags, "local_y", element)))
        elif element.tag == "way":
            ways[id] = Way(id, [_id(child, "ref") for child in element.all("nd")], tags, element.line)
        else:
            members: dict[str, list[tuple[str, int]]] = {}
            for child in element.all("member"):
                members.setdefault(child.get("role"), []).append((child.get("type"), _id(child, "ref")))
            (lanelets if tags.get("type") == "lanelet" else relations)[id] = Lanelet(id, tags, members, element.line)
    places_array = np.array(places, float).reshape(-1, 3)
    wrong = np.flatnonzero((np.abs(places_array[:, :2]) > (180, 90)).any(1))
    if len(wrong):
        lon, lat, _ = places_array[wrong[0]]
        raise RoadExtractionError(f"Node {ids[wrong[0]]} lies at lon {lon:g}, lat {lat:g}; degrees up to 180 and 90 are needed. "
                                  "Is the map in another CRS?")
    return LaneletMap(np.array(ids, np.int64), places_array[:, :2], places_array[:, 2], np.array(local, float).reshape(-1, 2), ways, lanelets,
                      relations, twice, tags_twice)


def _id(element, name):
    text = element.get(name)
    try:
        value = int(text) if len(text) <= 20 else ALL_IDS
    except ValueError:
        value = ALL_IDS
    if not -MAX_ID < value < ALL_IDS:
        raise RoadExtractionError(f"Line {element.line}: {name} of <{element.tag}> is {text[:40]!r}; a whole number of 64 bits is needed.")
    return value if value < MAX_ID else value - ALL_IDS


def _tag_number(tags, name, element):
    """A tag's number, NaN where there is none."""
    return XmlElement("tag", {name: tags[name]}, element.line).number(name) if name in tags else np.nan


# The lanelets and lines of a Lanelet2 map as layers like ours.

PATTERN_OF_WAY = {"solid": "solid", "dashed": "dashed", "solid_solid": "double-solid",
                  "dashed_dashed": "double-dashed", "solid_dashed": "solid-dashed", "dashed_solid": "dashed-solid"}
KIND_OF_WAY = {"traffic_light": "traffic_light", "traffic_sign": "sign", "pole": "pole", "post": "pole"}
CARRIED = ("traffic_light", "traffic_sign", "speed_limit", "right_of_way")   # rules of traffic that layers hold
PAINTED_WAYS = ("line_thin", "line_thick")
EDGE_WAYS = ("curbstone", "road_border", "guard_rail", "wall", "fence")
NO_LAND = 1.0   # degrees from latitude and longitude 0
LANE_TYPE_OF_LANELET = {"bicycle_lane": "bicycle", "emergency_lane": "shoulder", "parking": "parking", "road_shoulder": "shoulder"}


def node_places(whole: LaneletMap, crs: str = "") -> tuple[np.ndarray, str]:
    """The nodes in metres.

    crs : WKT or EPSG:n to compute them in; "" takes the UTM zone of the map
    Returns
        places : (N, 3) metres; a height of 0 where a node has none. A map without latitudes, or with all of them about 0, where there is nothing
            but sea, has local coordinates: local_x and local_y, or metres from latitude and longitude 0
        crs : WKT, "" where coordinates are local
    Raises RoadExtractionError if the CRS is not in metres, or nodes have neither latitude nor local coordinates.
    """
    located = np.isfinite(whole.degrees).all(1)
    heights = np.nan_to_num(whole.heights)
    at_sea = located.any() and np.abs(whole.degrees[located]).max() < NO_LAND
    if not located.all() or at_sea:
        if np.isfinite(whole.local).all():
            return np.c_[whole.local, heights], ""
        if not located.all():
            raise RoadExtractionError(f"Node {whole.node_ids[~located][0]} has neither lat and lon nor local_x and local_y. "
                                      "Export the map with them.")
        if not crs:
            x, y = pyproj.Transformer.from_crs("EPSG:4326", LOCAL_CRS, always_xy=True).transform(*whole.degrees.T)
            return np.c_[x, y, heights], ""
    target = metric_wkt(crs, "The chosen CRS") if crs else utm_of(*whole.degrees.mean(0))
    x, y = pyproj.Transformer.from_crs("EPSG:4326", parse_crs(target), always_xy=True).transform(*whole.degrees.T)
    places = np.c_[x, y, heights]
    if not np.isfinite(places).all():
        raise RoadExtractionError("The map does not lie where the chosen CRS holds. Choose the CRS of its country, or leave it empty.")
    return places, target


def layers_of_lanelets(whole: LaneletMap, crs: str = "", progress: Progress = Progress()) -> RoadMapSource:
    """Lanes, painted borders and edges of a map in a CRS, WKT or EPSG:n; "" takes the UTM zone of the map.

    `lane_id` of a lane is the lanelet's id; footways are left out; a way of the type of a line is a marking line, curbs and borders of the road
    are edges. Raises RoadExtractionError as `node_places`.
    """
    places, crs = node_places(whole, crs)
    network, rows = LaneletNetwork(whole, places), {}
    shown = [id for id in network.left if network.driven(id)]
    number_of = {id: number for number, id in enumerate(shown, start=1)}
    for along in _along_roads(network, shown):
        for id, (left, right) in _borders_abreast(network, along).items():
            rows[id] = {**_lane_row(network, id, left, right, along[id]), "lane": number_of[id]}
            progress.report(len(rows) / len(shown))
    lines, edges = _lines(whole, places, crs)
    layers = RoadMapSource.of_map(
        Lanes.of_pieces([rows[id] for id in shown], crs), lines, edges, _outlines(whole, places, network),
        attributes={str(id): known for id in shown if (known := _known(whole, whole.lanelets[id]))}, signals=_signals(whole, places, crs),
        left_out=_left_out(whole))
    if not crs:
        layers.notes.append("The map has local coordinates: its place on the earth is not known, and the layers have no CRS.")
    left_out = len(whole.lanelets) - len(network.left)
    if left_out:
        layers.notes.append(f"{left_out} lanelets lack a border or its nodes and were left out.")
    if len(whole.heights) and not np.isfinite(whole.heights).all():
        layers.notes.append(f"{int((~np.isfinite(whole.heights)).sum())} nodes have no height (ele); theirs is 0.")
    return layers


def _lines(whole, places, crs):
    """(MARKING_LINES, ROAD_EDGES) of the painted borders and edges among the ways of a map."""
    lines, edges = Features("LineStringZ", MARKING_LINES, crs=crs), Features("LineStringZ", ROAD_EDGES, crs=crs)
    for way in whole.ways.values():
        kind = way.tags.get("type", "")
        points = without_repeats(places[whole.rows(way)]) if kind in (*PAINTED_WAYS, *EDGE_WAYS) and len(whole.rows(way)) > 1 else ()
        if len(points) > 1 and kind in EDGE_WAYS:
            add_edge(edges, points, 1, "curb" if kind == "curbstone" else "pavement")
        elif len(points) > 1:
            add_marking_line(lines, points, 1, "lane", PATTERN_OF_WAY.get(way.tags.get("subtype", ""), ""))
    return lines, edges


def _outlines(whole, places, network):
    """(class as in MARKINGS, corners) of crossings and stop lines."""
    for id in network.left:
        if whole.lanelets[id].tags.get("subtype") == "crosswalk":
            yield "crosswalk", np.concatenate([places[network.left[id]], places[network.right[id]][::-1]])
    for way in whole.ways.values():
        ends = places[whole.rows(way)[[0, -1]]] if way.tags.get("type") == "stop_line" and len(whole.rows(way)) > 1 else np.zeros((2, 3))
        if (length := plan_length(ends)) > LEAST_LED:
            aside = np.array([ends[0, 1] - ends[1, 1], ends[1, 0] - ends[0, 0], 0.0]) / length
            aside *= np.nan_to_num(length_of_tag(way.tags.get("width")), nan=2 * STOP_LINE_HALF) / 2
            yield "stop_line", np.concatenate([ends - aside, ends[::-1] + aside])


def _signals(whole, places, crs):
    """The layer SIGNALS of the ways of lights, signs and poles, with the lanelets that obey them."""
    layer, obeying = Features("PointZ", SIGNALS, crs=crs), defaultdict(dict)
    for lanelet in whole.lanelets.values():
        for rule in (whole.others.get(id) for _, id in lanelet.members.get("regulatory_element", ())):
            waits = rule is not None and ("relation", lanelet.id) not in rule.members.get("right_of_way", ())
            for _, id in rule.members.get("refers", ()) if waits else ():
                obeying[id][str(lanelet.id)] = rule
    for way in whole.ways.values():
        points, kind = places[whole.rows(way)], KIND_OF_WAY.get(way.tags.get("type", ""))
        if kind and len(points):
            (x, y), width = (points[-1] - points[0])[:2], plan_length(points[[0, -1]])
            heading = (90 - np.degrees(np.arctan2(x, -y))) % 360 if width > LEAST_LED else np.nan   # a light is drawn from left to right
            height = np.ptp(points[:, 2]) if kind == "pole" else length_of_tag(way.tags.get("height"))
            named = re.fullmatch(r"([A-Za-z]{2})(\w+?)(?:-(.+))?", way.tags.get("subtype", "")) if kind == "sign" else None
            code = dict(zip(("country", "code", "subcode"), named.groups())) if named else {}
            about = {name[len(OURS):]: value for name, value in way.tags.items() if name.startswith(OURS)}
            layer.add(shapely.Point(*points[:, :2].mean(0), points[:, 2].min()), kind=kind, lanes=",".join(obeying[way.id]), heading=heading,
                      height_m=height or np.nan, width_m=width if width > LEAST_LED else np.nan,
                      **{**code, **about, "value": length_of_tag(about.get("value"))})
    return layer


def _known(whole, lanelet):
    """What a map says of the road of a lanelet, as ROAD_ATTRIBUTES."""
    tags, rules = lanelet.tags, [whole.others[id] for _, id in lanelet.members.get("regulatory_element", ()) if id in whole.others]
    signs = [rule.tags.get("sign_type", "") for rule in rules if rule.tags.get("subtype") == "speed_limit"]
    speed = kmh(tags.get("speed_limit", "")) or next((kmh(sign.rpartition("-")[2]) for sign in signs), None)
    first = dict.fromkeys(str(id) for rule in rules if ("relation", lanelet.id) in rule.members.get("yield", ())
                          for _, id in rule.members.get("right_of_way", ()))
    known = {"speed_kmh": speed, "name": tags.get("road_name"), "surface": tags.get("road_surface"), "yields_to": ",".join(first)}
    return {name: value for name, value in known.items() if value}


def _left_out(whole):
    """How often a map has what no layer of ours holds."""
    count = Counter(f"{lanelet.tags['subtype']} lanelet" for lanelet in whole.lanelets.values()
                    if lanelet.tags.get("subtype") in NEVER_DRIVEN and lanelet.tags["subtype"] != "crosswalk")
    return count + Counter(f"{kind} {relation.tags.get('subtype', '')}".strip() for relation in whole.others.values()
                           if (kind := relation.tags.get("type", "relation")) != "regulatory_element" or relation.tags.get("subtype") not in CARRIED)


def kmh(text: str) -> float | None:
    """A speed of a tag in km/h, with or without a unit; None where it is no number."""
    match = re.fullmatch(r"(\d+(?:\.\d+)?) ?(km/h|kmh|kph|mph|m/s|mps)?", text.strip().lower())
    return float(match[1]) * {"mph": 1.609344, "m/s": 3.6, "mps": 3.6}.get(match[2], 1.0) if match else None


def length_of_tag(text: str | None) -> float:
    """A length of a tag in metres, NaN where it is no number."""
    try:
        return float(str(text).removesuffix("m"))
    except ValueError:
        return np.nan


def _lane_row(network, id, left, right, way):
    """The values of a lane, its borders in the direction of travel; where nobody drives they are those along the road."""
    lanelet, turned = network.whole.lanelets[id], (network.reversed_left[id], network.reversed_right[id])
    kind = LANE_TYPE_OF_LANELET.get(lanelet.tags.get("subtype", ""), "connector" if network.crosses(id) else "driving")
    sides = [(line, *_border(network.whole.ways[lanelet.way(role) or 0].tags, back))
             for role, line, back in zip(("left", "right"), (left, right), turned)]
    driven = kind in ("driving", "connector")
    if not driven and way < 0:
        sides = [(line[::-1], *about) for line, *about in sides[::-1]]
    following = [other for other in network.following(id) * driven if network.driven(other)]
    return {"road": 1, "lane_id": str(id), "direction": way * driven, "type": kind, "successors": list(map(str, following)),
            **{side + name: value for side, about in zip(("left", "right"), sides) for name, value in zip(("", "_kind", "_pattern"), about)}}


def _along_roads(network, shown):
    """For lanelets that lie side by side id -> 1 or -1, the way they are driven along the road; what follows them is driven the same way along."""
    roads, direction = [], {}
    waiting = deque()
    for first in shown:
        waiting.append((first, 1))
        while waiting:
            id, way = waiting.popleft()
            if id in direction:
                continue
            road, beside = {id: way}, deque([id])
            while beside:
                here = beside.popleft()
                for neighbour, same in network.abreast(here):
                    if neighbour not in road and network.driven(neighbour):
                        road[neighbour] = road[here] * (1 if same else -1)
                        beside.append(neighbour)
            direction |= road
            roads.append(road)
            waiting += [(following, road[member]) for member in road for following in network.following(member) if network.driven(following)]
    return roads


def _borders_abreast(network, along):
    """id -> (left, right) of lanelets side by side, with vertices at the same places along all of them, so that neighbours share them."""
    lines = {}
    for id, way in along.items():
        for role, rows in (("left", network.left[id]), ("right", network.right[id])):
            lines[network.whole.lanelets[id].way(role)] = network.places[rows[::way]]
    if len({len(line) for line in lines.values()}) > 1 or not all(
            _is_abreast(*(network.places[side[id]] for side in (network.left, network.right))) for id in along):
        lines = dict(zip(lines, matched(*lines.values())))
    return {id: tuple(lines[network.whole.lanelets[id].way(role)][::way] for role in ("left", "right")) for id, way in along.items()}


def _is_abreast(left, right):
    """Whether the vertices of two borders lie across from each other, one by one."""
    across, ahead = (right - left)[:, :2], np.gradient((left + right)[:, :2], axis=0)
    return bool((np.abs((across * ahead).sum(1)) <= np.abs(across[:, 0] * ahead[:, 1] - across[:, 1] * ahead[:, 0]) + LEAST_LED).all())


def matched(*borders: np.ndarray) -> tuple[np.ndarray, ...]:
    """Borders with vertices at the same shares of their lengths, so that each has those of all."""
    shares = []
    for border in borders:
        along = np.append(0.0, np.cumsum(np.hypot(*np.diff(border[:, :2], axis=0).T)))
        shares.append(along / along[-1] if along[-1] > 0 else np.linspace(0, 1, len(border)))
    merged = np.unique(np.concatenate(shares))
    merged = merged[np.append(True, np.diff(merged) > 1e-9)]
    merged[-1] = 1.0
    return tuple(np.stack([np.interp(merged, share, values) for values in border.T], axis=1) for border, share in zip(borders, shares))


def _border(tags, turned):
    """(kind, pattern) of a way, seen in the direction of travel."""
    named = tags.get("type", "")
    kind = {"curbstone": "curb", "road_border": "pavement"}.get(named, "edge" if named in EDGE_WAYS else "lane")
    pattern = PATTERN_OF_WAY.get(tags.get("subtype", ""), "") if named in PAINTED_WAYS else ""
    return kind, "-".join(pattern.split("-")[::-1]) if turned and "-" in pattern and not pattern.startswith("double") else pattern
