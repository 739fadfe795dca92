"""The check of a Lanelet2 map: what is there, what is shared, what is driven where, and tags that the format does not know.

Source: Lanelet2, documents LaneletAndAreaTagging, LinestringTagging and RegulatoryElementTagging; Autoware's extensions of them.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping

import numpy as np
import shapely

from ....core.common.progress import Progress
from ..lanelet_map import NEVER_DRIVEN, Lanelet, LaneletMap, LaneletNetwork, Way, kmh, length_of_tag, same_way
from ..sources import LEAST_CURB, wrapped
from .findings import WORDS, Findings, metres

LEAST_LANE_WIDTH, MOST_LANE_WIDTH = 0.5, 30.0   # m: beyond them a border belongs to another lane; areas of junctions are wide
NEAR_NODES = 0.001        # m between two nodes of a way that are one place
SPIKE_TURN = 2.6          # rad: a border that turns back
SPIKE_SIDE, SPIKE_REST = 1.2, 0.35   # rad of turn at a node that lies aside, and that remains of it with those at its neighbours
SPIKE_RISE, SPIKE_SLOPE = 0.3, 0.5   # m and share of the distance to both neighbours that a node lies above or below them
MOST_SPIKES = 20          # of one way
JOIN_DISTANCE = 0.3       # m within which an end was meant to be the next lanelet's beginning
TWIN_DISTANCE = 0.02      # m between two ways that are one border
LONGEST_FORK = 2.0          # m near an end of a border within which another that parts from it there may lie on it
JOIN_ANGLE = 0.7          # rad between lanelets that may follow each other
USUAL_SHARE = 0.9         # of the lanelets, which show the habit of a map of drawing borders
LEAST_HABIT = 10          # lanelets that are a habit
SUBTYPES = {"line_thin": WORDS["line"], "line_thick": WORDS["line"], "curbstone": WORDS["curbstone"]}   # type of a way -> its own


def check_lanelets(whole: LaneletMap, places: np.ndarray, crs: str = "", progress: Progress = Progress()) -> Findings:
    """Everything that is wrong with a map, whose nodes lie at (N, 3) metres as `node_places` gives them in `crs`."""
    check = _LaneletCheck(whole, places, Findings(crs=crs))
    for kind, id, line in whole.twice:
        check.findings.add("id twice", f"{kind} {id}", f"Line {line}: there is another {kind} of this id.", np.zeros(3))
    check.numbering()
    check.heights()
    for way in whole.ways.values():
        check.way(way)
    progress.report(0.3)
    for lanelet in whole.lanelets.values():
        check.lanelet(lanelet)
    for relation in whole.others.values():
        check.members(relation)
    check.rules()
    progress.report(0.6)
    check.sides()
    check.joints()
    check.twins()
    check.count()
    progress.report(1.0)
    return check.findings


class _LaneletCheck:
    def __init__(self, whole: LaneletMap, places: np.ndarray, findings: Findings) -> None:
        self.whole, self.places, self.findings = whole, places, findings
        self.network = LaneletNetwork(whole, places)
        self.known = {"node": set(whole.row_of), "way": set(whole.ways), "relation": {*whole.lanelets, *whole.others}}
        self.borders = {id for lanelet in whole.lanelets.values() for role in ("left", "right") for _, id in lanelet.members.get(role, ())}

    def at(self, way: Way) -> np.ndarray:
        rows = self.whole.rows(way)
        return self.places[rows[0]] if len(rows) else np.zeros(3)

    def numbering(self) -> None:
        """Ids and tags that other programs read otherwise."""
        whole = self.whole
        for kind, ids in (("node", whole.node_ids), ("way", whole.ways), ("relation", [*whole.lanelets, *whole.others])):
            low = [int(id) for id in ids if id <= 0]
            if low:
                self.findings.add("id not positive", f"{kind} {low[0]}", f"{len(low)} ids of a {kind} are 0 or below.", np.zeros(3))
        for kind, id, key in whole.tags_twice:
            self.findings.add("id twice", f"{kind} {id}", f"It has the tag {key} more than once.", np.zeros(3))
        finite = np.isfinite(whole.local).all(1)
        if finite.any() and not finite.all():
            row = int(np.flatnonzero(finite != (finite.mean() > 0.5))[0])
            self.findings.add("local coordinates", f"node {whole.node_ids[row]}",
                              f"{int(finite.sum())} of {len(finite)} nodes have local_x and local_y.", self.places[row])

    def heights(self) -> None:
        missing = ~np.isfinite(self.whole.heights)
        if missing.any() and not missing.all():
            for k in np.flatnonzero(missing)[:1000]:
                self.findings.add("missing height", f"node {self.whole.node_ids[k]}", "It has no tag ele.", self.places[k])

    def way(self, way: Way) -> None:
        name, place = f"way {way.id}", self.at(way)
        for id in way.nodes:
            if id not in self.whole.row_of:
                self.findings.add("missing node", name, f"There is no node {id}.", place)
        rows = self.whole.rows(way)
        if len(way.nodes) < 2:
            self.findings.add("short way", name, f"It has {len(way.nodes)} node.", place)
        elif len(rows) > 1:
            near = np.flatnonzero(np.linalg.norm(np.diff(self.places[rows], axis=0), axis=1) < NEAR_NODES)
            if len(near):
                self.findings.add("repeated node", name, f"Nodes {self.whole.node_ids[rows[near[0]]]} and {self.whole.node_ids[rows[near[0] + 1]]} "
                                                         "lie at one place.", self.places[rows[near[0]]])
        if way.id in self.borders and len(rows) > 2:
            self._spikes(name, rows)
        self._tags(way, name, place)

    def _tags(self, way, name, place):
        for key, value in way.tags.items():
            is_change = key == "lane_change" or key.startswith("lane_change:")
            if is_change and value not in YES_OR_NO or key in ("width", "height") and not 0 <= length_of_tag(value) < 1000:
                self.findings.add("way tag", name, f"{key} is {value!r}.", place)
        kind, subtype = way.tags.get("type", ""), way.tags.get("subtype", "")
        if way.id in self.borders and kind in WORDS["way that is no border"]:
            self.findings.add("way type", name, f"It is the border of a lanelet and a {kind}.", place)
        if kind not in WORDS["way"] and (kind or way.id in self.borders):
            self.findings.add("way type", name, f"The type is {kind!r}.", place)
        elif subtype not in SUBTYPES.get(kind, (subtype,)):
            self.findings.add("way subtype", name, f"The subtype of the {kind} is {subtype!r}.", place)

    def _spikes(self, name: str, rows: np.ndarray) -> None:
        """Nodes that a border leaves and comes back from."""
        line = self.places[rows]
        step = np.diff(line, axis=0)
        run = np.maximum(np.hypot(*step[:, :2].T), NEAR_NODES)
        heading = np.arctan2(step[:, 1], step[:, 0])
        turn = wrapped(np.diff(heading))
        back = np.abs(turn) > SPIKE_TURN
        if len(turn) > 2:   # out at one node, back at the next but one
            around = np.abs(np.convolve(turn, np.ones(3), mode="valid"))
            out = (np.abs(turn[1:-1]) > SPIKE_SIDE) & (around < SPIKE_REST) & (turn[1:-1] * turn[:-2] < 0) & (turn[1:-1] * turn[2:] < 0)
            back[1:-1] |= out & (np.minimum(np.abs(turn[:-2]), np.abs(turn[2:])) > SPIKE_REST)
        rise = step[:, 2]
        up = (np.abs(rise[:-1]) > SPIKE_RISE) & (np.abs(rise[1:]) > SPIKE_RISE) & (rise[:-1] * rise[1:] < 0)
        up &= (np.abs(rise[:-1]) > SPIKE_SLOPE * run[:-1]) & (np.abs(rise[1:]) > SPIKE_SLOPE * run[1:])
        for spikes, direction in ((back, "to the side"), (up, "up or down")):
            for k in np.flatnonzero(spikes)[:MOST_SPIKES]:
                self.findings.add("spike", name, f"Node {self.whole.node_ids[rows[k + 1]]} lies {direction} of those beside it.", line[k + 1])

    def members(self, relation: Lanelet) -> bool:
        """Whether all members are there."""
        missing = [(kind, id) for group in relation.members.values() for kind, id in group if id not in self.known.get(kind, ())]
        for kind, id in missing:
            self.findings.add("missing member", f"relation {relation.id}", f"There is no {kind} {id}.", self.place_of(relation))
        return not missing

    def place_of(self, relation: Lanelet) -> np.ndarray:
        """Where a relation begins."""
        ways = [self.whole.ways[id] for group in relation.members.values() for kind, id in group if kind == "way" and id in self.whole.ways]
        return next((self.at(way) for way in ways if len(self.whole.rows(way))), np.zeros(3))

    def lanelet(self, lanelet: Lanelet) -> None:
        name, place, tags = f"lanelet {lanelet.id}", self.place_of(lanelet), lanelet.tags
        whole = self.members(lanelet)
        for role in ("left", "right"):
            members = lanelet.members.get(role, ())
            if len(members) != 1 or members[0][0] != "way":
                kinds = " and ".join(kind for kind, _ in members) or "nothing"
                self.findings.add("border missing", name, f"It has {kinds} as {role}; one way is needed.", place)
        if len(lanelet.members.get("centerline", ())) > 1:
            self.findings.add("centre line", name, f"It has {len(lanelet.members['centerline'])} centre lines.", place)
        for text in _lanelet_tags(tags):
            self.findings.add("lanelet tag", name, text, place)
        if whole and lanelet.id in self.network.left:
            self._shape(lanelet, name, place)

    def _shape(self, lanelet, name, place):
        left, right = (shapely.linestrings(self.places[rows[lanelet.id]][:, :2]) for rows in (self.network.left, self.network.right))
        for line, role in ((left, "left"), (right, "right")):
            if not line.is_simple and not line.is_ring:
                self.findings.add("border crosses", name, f"The {role} border crosses itself.", place)
        if left.crosses(right):
            self.findings.add("border crosses", name, "The borders cross each other.", place)
            return
        along = np.linspace(0.1, 0.9, 9)
        width = shapely.distance(shapely.line_interpolate_point(left, along, normalized=True), right)
        if self.network.driven(lanelet.id) and (np.median(width) < LEAST_LANE_WIDTH or np.median(width) > MOST_LANE_WIDTH):
            self.findings.add("lane width", name, f"It is {np.median(width):.2f} m wide.", place)
        self._centre(lanelet, name, place, left, right)

    def _centre(self, lanelet, name, place, left, right):
        centre = lanelet.way("centerline")
        rows = self.whole.rows(self.whole.ways[centre]) if centre in self.whole.ways else np.empty(0, int)
        if len(rows) > 1:
            area = shapely.make_valid(shapely.polygons(np.concatenate([shapely.get_coordinates(left), shapely.get_coordinates(right)[::-1]])))
            if not shapely.buffer(area, 0.01).covers(shapely.linestrings(self.places[rows][:, :2])):
                self.findings.add("centre line outside", name, "The centre line leaves the lanelet.", place)
            if not same_way(self.places[rows], self.places[self.network.left[lanelet.id]]):
                self.findings.add("centre line", name, "The centre line runs against it.", place)

    def rules(self) -> None:
        """Relations that are no lanelets: rules of traffic, areas, and lanelets whose type is misspelt."""
        used = {id for lanelet in (*self.whole.lanelets.values(), *self.whole.others.values())
                for kind, id in lanelet.members.get("regulatory_element", ()) if kind == "relation"}
        for relation in self.whole.others.values():
            name, kind, place = f"relation {relation.id}", relation.tags.get("type", ""), self.place_of(relation)
            if kind == "regulatory_element":
                for text in _rule(relation, relation.id in used):
                    self.findings.add("regulatory element", name, text, place)
            elif kind == "multipolygon":   # the outer ways, in any order and direction, make rings
                ways = [self.whole.ways[id] for kind, id in relation.members.get("outer", ()) if kind == "way" and id in self.whole.ways]
                ends = Counter(way.nodes[row] for way in ways if way.nodes for row in (0, -1))
                if not ends or any(count % 2 for count in ends.values()):
                    self.findings.add("open area", name, "The ways of its outline do not come back to where they begin.", place)
            elif "left" in relation.members and "right" in relation.members:
                self.findings.add("lanelet tag", name, f"It has borders left and right, but its type is {kind!r}.", place)

    def sides(self) -> None:
        """Left and right by the habit of the map: a border runs with the traffic, unless it is the left one of both directions."""
        odd = []
        for id in self.network.left:
            lanelet = self.whole.lanelets[id]
            shared = [neighbour for neighbour, _ in self.network.abreast(id)
                      if lanelet.way("left") in (self.whole.lanelets[neighbour].way("left"), self.whole.lanelets[neighbour].way("right"))]
            if self.network.reversed_right[id] or self.network.reversed_left[id] and not shared:
                odd.append(id)
        total = len(self.network.left)
        if total >= LEAST_HABIT and len(odd) >= USUAL_SHARE * total:
            self.findings.add("sides swapped", f"{len(odd)} lanelets", "Nearly all borders run against their lanelets: left and right, or latitude "
                                                                      "and longitude, are swapped.", self.place_of(self.whole.lanelets[odd[0]]))
        if len(odd) <= (1 - USUAL_SHARE) * total:
            for id in odd:
                self.findings.add("sides swapped", f"lanelet {id}", "Its borders run against it, unlike those of the other lanelets.",
                                  self.place_of(self.whole.lanelets[id]))

    def joints(self) -> None:
        """Ends of lanelets that meet: they share their nodes and are driven on."""
        for id, opposite in self.network.head_on():
            if self.network.driven(id) and self.network.driven(opposite):
                self.findings.add("head on", f"lanelets {id} and {opposite}", "Both begin or end where they meet: one of them has left and right "
                                                                              "swapped.", self.places[self.network.ends(id)[1][0]])
        ids = [id for id in self.network.left if self.network.driven(id)]
        if ids:
            self._not_joined(ids)

    def _not_joined(self, ids):
        starts, stops = self.places[np.array([self.network.ends(id) for id in ids]).transpose(1, 0, 2), :2]
        first, last = (np.array([self._heading(id, end) for id in ids]) for end in (0, -1))
        tree = shapely.STRtree(shapely.points(starts.mean(1)))
        pairs = tree.query(shapely.buffer(shapely.points(stops.mean(1)), JOIN_DISTANCE), predicate="intersects").T
        for k, j in pairs:
            apart = np.hypot(*(stops[k] - starts[j]).T)
            turn = abs(wrapped(last[k] - first[j]))
            if k != j and (apart < JOIN_DISTANCE).all() and turn < JOIN_ANGLE and ids[j] not in self.network.following(ids[k]):
                self.findings.add("not joined", f"lanelets {ids[k]} and {ids[j]}", f"{metres(float(apart.max()))} apart, with nodes of their own.",
                                  self.places[self.network.ends(ids[k])[1][0]])

    def _heading(self, id, at):
        middle = [self.places[rows[id]][:, :2] for rows in (self.network.left, self.network.right)]
        d = sum((line[1] - line[0] if at == 0 else line[-1] - line[-2]) for line in middle)
        return float(np.arctan2(d[1], d[0]))

    def _one_height(self, way: Way, other: Way) -> bool:
        """Whether two ways at one place are no bottom and top of a curb."""
        places, line = self.places[self.whole.rows(way)], shapely.linestrings(self.places[self.whole.rows(other)])
        feet = shapely.line_interpolate_point(line, shapely.line_locate_point(line, shapely.points(places)))
        rise = places[:, 2] - shapely.get_z(feet)
        return not np.median(np.abs(rise)) > LEAST_CURB

    def twins(self) -> None:
        """Borders that lie on each other and are two ways, and lanelets between the same borders."""
        between: dict[tuple[int | None, int | None], int] = {}
        for id in self.network.left:
            key = self.whole.lanelets[id].way("left"), self.whole.lanelets[id].way("right")
            if key in between:
                self.findings.add("two at one place", f"lanelets {between[key]} and {id}", "They have the same borders.",
                                  self.place_of(self.whole.lanelets[id]))
            between.setdefault(key, id)
        ways = [way for id in sorted(self.borders) if (way := self.whole.ways.get(id)) is not None and len(self.whole.rows(way)) > 1]
        if ways:
            self._twice(ways)

    def _twice(self, ways):
        lines = [shapely.linestrings(self.places[self.whole.rows(way)][:, :2]) for way in ways]
        tree = shapely.STRtree(shapely.buffer(np.array(lines, object), TWIN_DISTANCE))
        for k, j in tree.query(lines, predicate="within").T:
            if k == j or not self._one_height(ways[k], ways[j]):
                continue
            if (k < j or not shapely.within(lines[j], shapely.buffer(lines[k], TWIN_DISTANCE))) and not (
                    lines[k].length < LONGEST_FORK and lines[k].distance(lines[j].boundary) < LONGEST_FORK):
                self.findings.add("border twice", f"ways {ways[k].id} and {ways[j].id}", "They lie at one place; neighbours should share one.",
                                  self.at(ways[k]))

    def count(self) -> None:
        driven = [id for id in self.network.left if self.network.driven(id)]
        self.findings.lanes = len(driven)
        self.findings.successors = sum(len(self.network.following(id)) for id in driven)
        self.findings.neighbours = len({(min(id, neighbour), max(id, neighbour)) for id in driven for neighbour, _ in self.network.abreast(id)})


# Tags, rules of traffic and areas, held against what the format knows.

YES, NO = {"yes", "true", "1"}, {"no", "false", "0"}
YES_OR_NO = YES | NO
MOTOR = re.compile("vehicle(?!:emergency$)")   # participants who have no way where others walk
# kind of a rule -> roles of which it needs at least one member; tags of which one does as well
RULES: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    **dict.fromkeys(WORDS["rule about members"], (("refers",), ())),
    "speed_limit": (("refers",), ("sign_type",)), "right_of_way": (("right_of_way", "yield"), ()), "all_way_stop": (("yield",), ()),
    "roundabout": ((), ())}


def _lanelet_tags(tags: Mapping[str, str]) -> Iterator[str]:
    """Sentences on tags of a lanelet that are missing or have values that no reader knows."""
    for key, allowed in (("subtype", WORDS["lanelet"]), ("location", WORDS["location"]), ("one_way", YES_OR_NO)):
        if (key in tags or key == "subtype") and tags.get(key) not in allowed:
            yield f"{key} is {tags.get(key, '')!r}."
    yield from _participant_tags(tags, tags.get("subtype") in NEVER_DRIVEN)
    if not 0 < (kmh(tags.get("speed_limit", "1")) or 0.0) < 500:
        yield f"speed_limit is {tags['speed_limit']!r}."


def _participant_tags(tags, walked):
    """Sentences on who may use a lanelet; `walked`: whether it is made for those on foot."""
    participants = {key[len("participant:"):]: value for key, value in tags.items() if key.startswith("participant:")}
    for name, value in participants.items():
        if name not in WORDS["participant"]:
            yield f"The participant {name!r} is not known."
        if value not in YES_OR_NO:
            yield f"participant:{name} is {value!r}."
        if walked and MOTOR.match(name) and value in YES:
            yield f"Its subtype is {tags.get('subtype')!r}, and vehicles may use it."
    if not walked and set() < set(participants.values()) <= NO:
        yield "Nobody may use it."


def _rule(relation, used):
    subtype = relation.tags.get("subtype", "")
    if subtype not in RULES:
        yield f"The subtype is {subtype!r}."
        return
    roles, tags = RULES[subtype]
    named = {role for role, members in relation.members.items() if members}
    if roles and not named.intersection(roles) and not relation.tags.keys() & {*tags}:
        yield f"A {subtype} needs {' or '.join([*map('a member {}'.format, roles), *map('a tag {}'.format, tags)])}."
    for role in relation.members:
        if role not in WORDS["role"]:
            yield f"The role {role!r} is not known."
    if not used:
        yield "No lanelet obeys it."
