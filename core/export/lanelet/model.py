"""A map of Lanelet2 as objects: nodes as arrays, ways, lanelets."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np


@dataclass
class Way:
    """A line of nodes, by their ids. line : in the file, 0 where made."""

    id: int
    nodes: list[int]
    tags: dict[str, str] = field(default_factory=dict)
    line: int = 0


@dataclass
class Lanelet:
    """A relation: members by role, each a list of (type, id); a lanelet has one way left and one right."""

    id: int
    tags: dict[str, str] = field(default_factory=dict)
    members: dict[str, list[tuple[str, int]]] = field(default_factory=dict)
    line: int = 0

    def way(self, role: str) -> int | None:
        """The id of the only way of a role, None where there is none or more than one."""
        found = [id for kind, id in self.members.get(role, ()) if kind == "way"]
        return found[0] if len(found) == 1 else None


@dataclass
class LaneletMap:
    """A whole file.

    node_ids : (N,) int in order of the file; degrees : (N, 2) longitude, latitude; heights : (N,) metres, NaN where a node has none
    local : (N, 2) metres of the tags local_x and local_y, NaN where a node has none
    ways, lanelets, others : by id; others are the remaining relations, such as regulatory elements
    twice : ids that were there more than once
    tags : of the file, such as those of MetaInfo
    tags_twice : (kind of element, id, key) of tags that an element has more than once
    """

    node_ids: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    degrees: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    heights: np.ndarray = field(default_factory=lambda: np.empty(0))
    local: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    ways: dict[int, Way] = field(default_factory=dict)
    lanelets: dict[int, Lanelet] = field(default_factory=dict)
    others: dict[int, Lanelet] = field(default_factory=dict)
    twice: list[tuple[str, int, int]] = field(default_factory=list)
    tags_twice: list[tuple[str, int, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.row_of = {int(id): k for k, id in enumerate(self.node_ids)}

    def rows(self, way: Way) -> np.ndarray:
        """Rows of a way's nodes; nodes that are missing are left out."""
        return np.array([self.row_of[id] for id in way.nodes if id in self.row_of], int)


# The lanelets of a map as places and as a network: which follows which, which lies beside which.

NEVER_DRIVEN = ("crosswalk", "walkway", "stairs")


class LaneletNetwork:
    """Lanelets with borders in the direction of travel.

    Parameters
    ----------
    whole : LaneletMap
    places : (N, 3) metres of its nodes

    Attributes
    ----------
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
        starts, by_border = defaultdict(list), defaultdict(list)
        for id in self.left:
            starts[self.ends(id)[0]].append(id)
            for role in ("left", "right"):
                by_border[whole.lanelets[id].way(role)].append((id, role))
        self._starts, self._by_border = starts, by_border

    def _place(self, lanelet: Lanelet) -> None:
        ids = lanelet.way("left"), lanelet.way("right")
        ways = [self.whole.ways.get(id) if id is not None else None for id in ids]
        if ways[0] is None or ways[1] is None:
            return
        left, right = (self.whole.rows(way) for way in ways if way is not None)
        if len(left) < 2 or len(right) < 2:
            return
        turned_right = not same_way(self.places[left], self.places[right])
        area = signed_area(self.places[left], self.places[right[::-1] if turned_right else right])
        turned = area > 0   # left then lies to the right: the lanelet is driven the other way
        self.left[lanelet.id] = left[::-1] if turned else left
        self.right[lanelet.id] = right[::-1] if turned_right != turned else right
        self.reversed_left[lanelet.id], self.reversed_right[lanelet.id] = turned, turned_right != turned

    def ends(self, id: int) -> tuple[tuple[int, int], tuple[int, int]]:
        """((left, right) row of the first nodes, of the last nodes)."""
        left, right = self.left[id], self.right[id]
        return (int(left[0]), int(right[0])), (int(left[-1]), int(right[-1]))

    def following(self, id: int) -> list[int]:
        """Lanelets that begin with the two nodes at which this one ends."""
        return [other for other in self._starts.get(self.ends(id)[1], ()) if other != id]

    def head_on(self) -> list[tuple[int, int]]:
        """Pairs of lanelets that end, or begin, on the same two nodes from either side: no traffic flows so."""
        found = []
        for end in (0, 1):
            at = defaultdict(list)
            for id in self.left:
                at[self.ends(id)[end]].append(id)
            for (left, right), ids in at.items():
                if left < right:
                    found += [(id, other) for id in ids for other in at.get((right, left), ())]
        return found

    def beside(self, id: int) -> list[int]:
        """Lanelets that share a border with this one."""
        lanelet = self.whole.lanelets[id]
        return [other for role in ("left", "right") for other, _ in self._by_border[lanelet.way(role)] if other != id]

    def driven(self, id: int) -> bool:
        """Whether vehicles use it."""
        return self.whole.lanelets[id].tags.get("subtype", "road") not in NEVER_DRIVEN


def same_way(first: np.ndarray, second: np.ndarray) -> bool:
    """Whether two lines beside each other, (N, 2+) and (M, 2+), are drawn the same way."""
    along = np.hypot(*(first[0, :2] - second[0, :2])) + np.hypot(*(first[-1, :2] - second[-1, :2]))
    against = np.hypot(*(first[0, :2] - second[-1, :2])) + np.hypot(*(first[-1, :2] - second[0, :2]))
    return bool(along <= against)


def signed_area(left: np.ndarray, right: np.ndarray) -> float:
    """Square metres between two borders drawn the same way; negative where the first lies to the left."""
    x, y = np.concatenate([left, right[::-1]])[:, :2].T
    x, y = x - x[0], y - y[0]
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2)
