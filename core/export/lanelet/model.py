"""A map of Lanelet2 as objects: nodes as arrays, ways, lanelets."""

from __future__ import annotations

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
