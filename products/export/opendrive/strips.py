"""Lanes of a road map laid out for OpenDRIVE: cut at common places, side by side in slices, slices end to end in strips."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field

import numpy as np

from ....core.driving.layers import Lanes
from ..shared_borders import SAME_VERTEX, cuts_beside, numbered
from ..sources import LEAST_CURB

SLOPE_REACH = 1.5        # m along a border before and after a place from which its direction there is taken
MOST_TURN = 0.3          # rad from before to after it: more is a corner, which is kept


@dataclass
class Cell:
    """A part of one lane between two cuts, with borders along the road's direction.

    before, after : cells that touch its start and its end along the road, by its lane or by successors
    """

    piece: int   # row of Lanes
    left: np.ndarray   # left, right: (n, 3) local metres
    right: np.ndarray
    left_nodes: tuple[int, ...]   # left_nodes, right_nodes: their numbers
    right_nodes: tuple[int, ...]
    direction: int
    is_connector: bool = False   # whether it is a way through a junction
    before: list[Cell] = field(default_factory=list, repr=False)
    after: list[Cell] = field(default_factory=list, repr=False)

    def beyond(self, at_end: bool) -> list[Cell]:
        """The cells that touch its start or its end."""
        return self.after if at_end else self.before

    @property
    def length(self) -> float:
        """Metres in plan along the middle."""
        return float(np.hypot(*np.diff((self.left + self.right)[:, :2] / 2, axis=0).T).sum())


@dataclass
class Slice:
    """Cells side by side from left to right, all with vertices at the same places."""

    cells: list[Cell]
    at_start: bool = False   # at_start, at_end: whether ways through a junction begin or end within the slice, there
    at_end: bool = False

    @property
    def length(self) -> float:
        """Metres of its longest cell."""
        return max(cell.length for cell in self.cells)

    @property
    def driven(self) -> list[Cell]:
        """Those of its cells that have a direction of travel."""
        return [cell for cell in self.cells if cell.direction]

    def beyond(self, at_end: bool) -> list[Cell]:
        """The cells that touch its start or its end."""
        return [neighbour for cell in self.cells for neighbour in cell.beyond(at_end)]

    def mark(self, at_start: bool) -> None:
        """Note that ways through a junction begin or end within the slice, at its start or its end."""
        self.at_start, self.at_end = self.at_start or at_start, self.at_end or not at_start

    def borders(self) -> list[np.ndarray]:
        """(n, 3) each, from left to right, one more than cells."""
        return [self.cells[0].left, *(cell.right for cell in self.cells)]

    def nodes(self) -> list[tuple[int, ...]]:
        """Numbers of the vertices of its borders, from left to right."""
        return [self.cells[0].left_nodes, *(cell.right_nodes for cell in self.cells)]

    def levels(self, centre: int) -> tuple[np.ndarray, np.ndarray]:
        """((borders, n) heights of the road, (cells, n) metres that cells lie above it): the road goes on below curbs, from border `centre` on."""
        left, right = np.stack([cell.left[:, 2] for cell in self.cells]), np.stack([cell.right[:, 2] for cell in self.cells])
        step = left[1:] - right[:-1]
        lift = np.concatenate([np.zeros((1, left.shape[1])), np.cumsum(np.where(np.abs(step) > LEAST_CURB, step, 0.0), axis=0)])
        lift = lift - lift[min(centre, len(self.cells) - 1)]
        return np.concatenate([left[:1] - lift[:1], right - lift]), lift

    def split(self, row: int) -> tuple[Slice, Slice]:
        """The slice cut at a vertex, linked as it was."""
        parts: tuple[list[Cell], list[Cell]] = ([], [])
        for cell in self.cells:
            first, last = (Cell(cell.piece, cell.left[rows], cell.right[rows], cell.left_nodes[rows], cell.right_nodes[rows], cell.direction,
                                cell.is_connector)
                           for rows in (slice(0, row + 1), slice(row, None)))
            first.before, first.after, last.before, last.after = cell.before, [last], [first], cell.after
            for neighbours, new in ((cell.before, first), (cell.after, last)):
                for neighbour in neighbours:
                    for links in (neighbour.before, neighbour.after):
                        links[:] = [new if link is cell else link for link in links]
            parts[0].append(first)
            parts[1].append(last)
        return Slice(parts[0], self.at_start, False), Slice(parts[1], False, self.at_end)

    def ways(self) -> list[Slice]:
        """A slice for each lane that is driven, with what nobody drives on its right; left of the first one, on its left."""
        driven = [k for k, cell in enumerate(self.cells) if cell.direction]
        cuts = [0, *driven[1:], len(self.cells)]
        return [Slice(self.cells[a:b], self.at_start, self.at_end) for a, b in zip(cuts[:-1], cuts[1:])] if driven else []

    def turned(self) -> Slice:
        """The same slice seen along the opposite direction of the road; its cells are changed."""
        for cell in self.cells:
            cell.left, cell.right = cell.right[::-1], cell.left[::-1]
            cell.left_nodes, cell.right_nodes = cell.right_nodes[::-1], cell.left_nodes[::-1]
            cell.before, cell.after, cell.direction = cell.after, cell.before, -cell.direction
        return Slice(self.cells[::-1], self.at_end, self.at_start)


def cut_into_cells(lanes: Lanes) -> list[Cell]:
    """Every lane, with local coordinates, cut wherever a lane beside it begins, ends or is cut, and linked along the road; connectors are left whole.

    Lanes driven against the road are turned round; connectors run with their traffic.
    """
    numbers, _ = numbered(np.concatenate([lanes.left, lanes.right]))
    left, right = numbers[:len(lanes.left)], numbers[len(lanes.left):]
    ordinary = np.repeat(lanes.type != "connector", np.diff(lanes.start))
    cuts = cuts_beside(lanes, left, right, ordinary)
    cells, first_of, last_of = [], {}, {}
    for k in range(len(lanes)):
        a, b = lanes.start[k], lanes.start[k + 1] - 1
        bounds = [*_rows_to_cut(a, b, left, right, cuts), b] if ordinary[a] else [a, b]
        lane_cells = []
        for first, last in zip(bounds[:-1], bounds[1:]):
            rows = slice(first, last + 1)
            sides = [(lanes.left[rows], tuple(left[rows])), (lanes.right[rows], tuple(right[rows]))]
            direction = int(lanes.direction[k]) if ordinary[a] else 1
            if direction < 0:
                sides = [(line[::-1], nodes[::-1]) for line, nodes in sides[::-1]]
            lane_cells.append(Cell(k, sides[0][0], sides[1][0], sides[0][1], sides[1][1], direction, not ordinary[a]))
        for cell, following in zip(lane_cells[:-1], lane_cells[1:]):
            _link(cell, following)
        first_of[lanes.lane_id[k]], last_of[lanes.lane_id[k]] = lane_cells[0], lane_cells[-1]
        cells += lane_cells
    for k, names in enumerate(lanes.successors):
        for name in names:
            _link(last_of[lanes.lane_id[k]], first_of[name])
    # cells that nobody drives follow each other where they share their ends
    starts = {(cell.left_nodes[0], cell.right_nodes[0]): cell for cell in cells if cell.direction == 0}
    for cell in cells:
        beyond = starts.get((cell.left_nodes[-1], cell.right_nodes[-1])) if cell.direction == 0 else None
        if beyond is not None and beyond is not cell and not cell.after:
            cell.after.append(beyond)
            beyond.before.append(cell)
    return cells


def _rows_to_cut(a, b, left, right, cuts):
    """The row a, and those before b at which a lane is cut: where both borders stand still there is nothing to cut off."""
    rows = [a]
    for row in range(a + 1, b):
        if (left[row] in cuts or right[row] in cuts) and all((left[row], right[row]) != (left[end], right[end]) for end in (rows[-1], b)):
            rows.append(row)
    return rows


def _link(one: Cell, following: Cell) -> None:
    """Join two cells in the direction of travel; what is before and after is told along the road."""
    for cell, neighbour, ahead in ((one, following, True), (following, one, False)):
        side = cell.after if ahead == (cell.direction >= 0) else cell.before
        if not any(linked is neighbour for linked in side):
            side.append(neighbour)


def slices_of(cells: list[Cell]) -> list[Slice]:
    """Cells that share a border side by side; connectors stand alone and are not among them."""
    ordinary = [cell for cell in cells if not cell.is_connector]
    by_left = {cell.left_nodes: cell for cell in ordinary if len(set(cell.left_nodes)) > 1}
    right_of = {id(cell): by_left.get(cell.right_nodes) for cell in ordinary}
    has_left = {id(right) for right in right_of.values() if right is not None}
    slices = []
    for cell in ordinary:
        if id(cell) in has_left:
            continue
        row: list[Cell] = [cell]
        while (neighbour := right_of[id(row[-1])]) is not None and not any(neighbour is member for member in row):
            row.append(neighbour)
        slices.append(Slice(row))
    return slices


def connector_slices(cells: list[Cell], slices: list[Slice]) -> tuple[list[Slice], list[Slice]]:
    """(a slice for every connector with what nobody drives beside it, the slices that are left)."""
    undriven = [part for part in slices if not part.driven]
    by_left = {part.cells[0].left_nodes: part for part in undriven}
    by_right = {part.cells[-1].right_nodes: part for part in undriven}
    used = set()

    def beside(same, turned, nodes):
        for part, against in ((same.get(nodes), False), (turned.get(nodes[::-1]), True)):
            if part is not None and id(part) not in used:
                used.add(id(part))
                return (part.turned() if against else part).cells
        return []

    connectors = [Slice([*beside(by_right, by_left, cell.left_nodes), cell, *beside(by_left, by_right, cell.right_nodes)])
                  for cell in cells if cell.is_connector]
    return connectors, [part for part in slices if id(part) not in used]


def directions_where_met(cells: list[Cell]) -> dict[int, float]:
    """{number of a vertex: radians, either way along}, the direction of borders where some end and others go on: one for all of them, so that no
    lane has a kink where roads meet. Vertices where nothing goes on, or a border turns, are left out.
    """
    ways: dict[int, dict[int, np.ndarray]] = defaultdict(dict)
    for cell in cells:
        for line, nodes in ((cell.left, cell.left_nodes), (cell.right, cell.right_nodes)):
            for step in (1, -1):
                offsets = (line[::step, :2] - line[::step, :2][0])[1:]
                near = np.hypot(*offsets.T) <= SLOPE_REACH
                near[0] = True
                way = offsets[near].sum(0)
                if (length := float(np.hypot(*way))) > SAME_VERTEX:
                    ways[nodes[::step][0]][nodes[::step][1]] = way / length
    directions = {}
    for node, all_ways in ways.items():
        first, *_ = vectors = np.array(list(all_ways.values()))
        ahead, behind = vectors[vectors @ first > 0], -vectors[vectors @ first <= 0]
        if not len(behind):
            continue
        way = ahead.mean(0) + behind.mean(0)
        turned = np.abs(np.arctan2(*np.array([[way[0] * vector[1] - way[1] * vector[0], way @ vector] for vector in (*ahead, *behind)]).T))
        if turned.max() < MOST_TURN / 2:
            directions[node] = float(np.arctan2(way[1], way[0]))
    return directions


def mark_junctions(slices: list[Slice]) -> None:
    """Tell every slice at which of its ends ways through a junction lie beside it: they begin or end there, on its side.

    Where lanes beside each other go on in lanes that are no longer beside each other, there is a junction too: a road has one successor.
    """
    owner = _owners(slices)
    for part in slices:
        for at_end in (False, True):
            # (number of a slice, whether at its start) that the driven cells touch there
            ends = {(owner[id(neighbour)], any(cell is back for back in neighbour.before)) for cell in part.driven
                    for neighbour in cell.beyond(at_end) if id(neighbour) in owner}
            for number, at_start in ends if len(ends) > 1 else ():
                slices[number].mark(at_start)
            # a connector that this slice touches lies beyond its end: beside the slices beyond
            touching = {id(cell) for cell in part.beyond(at_end)}
            if any(cell.is_connector for cell in part.beyond(at_end)):
                for beyond in slices:
                    if not touching.isdisjoint(map(id, beyond.cells)):
                        beyond.mark(at_end)


def _owners(slices):
    """{id of a cell: number of its slice}."""
    return {id(cell): k for k, part in enumerate(slices) for cell in part.cells}


def strips_of(slices: list[Slice], breaks: set[tuple[int, int]]) -> list[list[Slice]]:
    """Slices end to end, each with one before and one after, in order along the road; (id, id of the next) in `breaks` end a strip."""
    owner = _owners(slices)
    pairs = {(k, owner[id(following)]) for k, part in enumerate(slices) for cell in part.cells for following in cell.after
             if id(following) in owner and following.direction * cell.direction >= 0}
    after, before = (Counter(pair[side] for pair in pairs) for side in (0, 1))
    follows = {k: j for k, j in pairs if after[k] == before[j] == 1 and (id(slices[k]), id(slices[j])) not in breaks}
    return _chained(slices, follows)


def _chained(items, follows):
    """Lists of items end to end, those that begin somewhere before rings; `follows`: {number of an item: that of the next one}."""
    leads = set(follows.values())
    chains, used = [], set()
    for k in [k for k in range(len(items)) if k not in leads] + list(range(len(items))):
        chain = []
        number: int | None = k
        while number is not None and number not in used:
            used.add(number)
            chain.append(items[number])
            number = follows.get(number)
        if chain:
            chains.append(chain)
    return chains


def end_to_end(cells: list[Cell]) -> list[list[Cell]]:
    """Single lanes, all in the direction of travel, that follow each other without a fork."""
    number = {id(cell): k for k, cell in enumerate(cells)}
    # what touches no other one there, and is touched by no other
    follows = {k: number[id(cell.after[0])] for k, cell in enumerate(cells) if len(cell.after) == 1 and cell.after[0] is not cell
               and len(cell.after[0].before) == 1 and cell.after[0].before[0] is cell and id(cell.after[0]) in number}
    return sorted(_chained(cells, follows), key=lambda row: min(number[id(cell)] for cell in row))
