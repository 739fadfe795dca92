"""Rows of dashes: short pieces that follow on each other at an even pace, each along the row.

One bright spot of half a metre may be anything. Four of them in a line, evenly
spaced and all pointing along it, were painted, or are the stones of one curb.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from ...common.groups import linked_groups, members_of
from ..road_grid import CELL_SIZE

if TYPE_CHECKING:
    from .shape import Shape

MAX_DASH_SPACING = 3.0                      # m between the middles of neighbours in a row
MIN_DASH_SPACING = 0.25                     # m between them at least
MAX_DASH_BREADTH = 0.45                     # m that a dash may reach across its row
MAX_DASH_OFFSET = 0.12                      # m off the line through its neighbours
MAX_GAP_PER_DASH = 3.0                      # times the length of the longer dash: no gap of a row is longer
MAX_STEP_RATIO = 2.5                        # times: how much one step of a row may be longer than the next, a dash worn away between them
MIN_STEP_COSINE = np.cos(np.radians(12.0))  # by which a row may turn from dash to dash
MIN_DASHES_IN_ROW = 4
MAX_DASH_LENGTH_RATIO = 2.0                 # times: a dash that leads a row on to the usual one of the row, either way
MIN_NEXT_STEP = 2 / 3                       # of the usual step of a row: the next dash lies no nearer

# Blocks of give-way lines
MIN_BLOCKS_IN_ROW = 3
BLOCK_SIZE = 0.30, 0.80        # m, either way
MAX_BLOCK_RATIO = 1.35         # times: the longer side of a block to the shorter, and the size of one to the next
BLOCK_SPACING = 1.4, 3.2       # block sizes from middle to middle
MAX_BLOCK_STEP_RATIO = 1.25    # times: one step of a row to the next
MAX_BLOCK_OFFSET = 0.15        # m off the line through its neighbours
MAX_PACE_ERROR = 0.10          # of the step of a row: two squares so far apart are two blocks of another such row
MAX_END_RATIO = 1.5            # times: the longer side of a piece that goes on with a row to the usual one of its blocks, either way
MAX_END_OFFSET = 0.2           # of the step that its middle lies off the place of the next block at most
LEAST_STRIP = 1.2              # m: three of the smallest blocks
LEAST_GAP = 2                  # cells between the blocks of a strip
PAINTED_SHARE = 0.25           # of a strip's usual breadth: with less paint across it there is a gap


def rows_of_dashes(shapes: Sequence[Shape]) -> list[np.ndarray]:
    """Pieces that stand in rows.

    Parameters
    ----------
    shapes : list of N Shape

    Returns
    -------
    list of ascending int arrays, the pieces of each row; a piece where rows meet is in several
    """
    if len(shapes) < MIN_DASHES_IN_ROW:
        return []
    middle = np.array([((shape.s0 + shape.s1) / 2, (shape.d0 + shape.d1) / 2) for shape in shapes])
    length, width, turn = (np.array([getattr(shape, name) for shape in shapes]) for name in ("length", "width", "direction"))
    pairs = cKDTree(middle).query_pairs(MAX_DASH_SPACING, output_type="ndarray")
    pairs = np.concatenate([pairs, pairs[:, ::-1]])
    pairs = pairs[np.lexsort(pairs.T[::-1])]
    step = middle[pairs[:, 1]] - middle[pairs[:, 0]]
    apart = np.hypot(*step.T)
    ways = step / np.maximum(apart, 1e-9)[:, None]
    links = _narrow(length, width, turn, pairs, ways) & (apart >= MIN_DASH_SPACING) \
        & (apart - length[pairs].mean(axis=1) <= MAX_GAP_PER_DASH * length[pairs].max(axis=1))
    return _chains(pairs[links], apart[links], ways[links])


def dashes_beyond(row: Sequence[Shape], others: Sequence[Shape]) -> list[int]:
    """Pieces that lead a row of dashes on beyond its ends.

    A row that is sure says where its next dash lies: in line with its last dashes, one step ahead, or two where a dash is
    worn away. The nearest piece there that is about as long as a dash of the row is the next one, and so on. By our own rule.

    Parameters
    ----------
    row : Shapes of the dashes of a row, at least two, in any order; metres and radians
    others : list of N Shape, those of the row may be among them

    Returns
    -------
    list of int, numbers of the pieces in `others`, from the row outwards
    """
    if not others:
        return []
    middle, place = (np.array([((shape.s0 + shape.s1) / 2, (shape.d0 + shape.d1) / 2) for shape in shapes]) for shapes in (row, others))
    length, width, turn = (np.array([getattr(shape, name) for shape in others]) for name in ("length", "width", "direction"))
    usual = np.median([shape.length for shape in row])
    alike = np.maximum(length, usual) <= MAX_DASH_LENGTH_RATIO * np.minimum(length, usual)
    along = np.argsort((middle - middle.mean(axis=0)) @ _way(middle))
    pace = float(np.median(np.hypot(*np.diff(middle[along], axis=0).T)))
    found: list[int] = []
    for outwards in (along, along[::-1]):
        known = list(middle[outwards])
        while True:
            last = np.array(known[-MIN_DASHES_IN_ROW:])
            way = _way(last)
            ahead, off = (place - last[-1]) @ way, np.abs((place - last.mean(axis=0)) @ (-way[1], way[0]))
            askew = turn - np.arctan2(way[1], way[0])
            narrow = length * np.abs(np.sin(askew)) + width * np.abs(np.cos(askew)) <= MAX_DASH_BREADTH
            follows = np.flatnonzero(alike & narrow & (off <= MAX_DASH_OFFSET) & (ahead >= max(MIN_NEXT_STEP * pace, MIN_DASH_SPACING))
                                     & (ahead <= MAX_STEP_RATIO * pace))
            if not len(follows):
                break
            found.append(int(follows[np.argmin(ahead[follows])]))
            known.append(place[found[-1]])
    return found


def _way(places):
    """(2,) unit vector of the straight line through places, from the first to the last."""
    way = np.linalg.svd(places - places.mean(axis=0))[2][0]
    return way * np.sign(way @ (places[-1] - places[0]) or 1.0)


def give_way_blocks(filled: np.ndarray, sides: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """Which pieces are blocks of give-way lines: filled squares in rows.

    Where no more of a row was seen than two squares, they count if they lie at the pace of a sure row. A row goes on where a piece lies at its pace
    and in line with it, though wear or stray points leave it no square.

    Parameters
    ----------
    filled : (N,) bool, whether most of the smallest rectangle about a piece is painted
    sides : (N, 2) m, of that rectangle; 0 for what is larger than any block
    middle : (N, 2) m, in one frame

    Returns
    -------
    (N,) bool
    """
    squares = np.flatnonzero(filled)
    rows = [squares[row] for row in rows_of_blocks(sides[squares], middle[squares])]
    result = np.zeros(len(filled), bool)
    if not rows:
        return result
    sure = np.unique(np.concatenate(rows))
    rest = np.setdiff1d(squares, sure)
    pairs, size, apart = _pairs_of_squares(sides[rest], middle[rest])
    at_pace = np.zeros(len(pairs), bool)
    for row in rows:
        usual, pace = sides[row].mean(), _pace(middle[row])
        at_pace |= (np.maximum(size.max(axis=1), usual) <= MAX_BLOCK_RATIO * np.minimum(size.min(axis=1), usual)) \
            & (np.abs(apart - pace) <= MAX_PACE_ERROR * pace)
    larger = sides.max(axis=1)
    small = np.flatnonzero(larger > 0)
    tree = cKDTree(middle[small])
    for row in [*rows, *rest[pairs[at_pace]]]:
        result[row] = True
        usual = sides[row].mean()

        def likely(place, reach, usual=usual):
            near = small[sorted(tree.query_ball_point(place, reach))]
            return near[(larger[near] >= usual / MAX_END_RATIO) & (larger[near] <= MAX_END_RATIO * usual)]

        result[_led_on(middle[row], middle, likely)] = True
    return result


def _led_on(row, middle, likely):
    """Pieces at the pace of a row of (K, 2) places beyond its ends; `likely` gives those that may be, within a distance of a place."""
    way, pace, found = _way(row), _pace(row), []
    along = (row - row.mean(axis=0)) @ way
    for sign, place in ((1.0, row[np.argmax(along)]), (-1.0, row[np.argmin(along)])):
        while True:
            place = place + sign * pace * way
            near = likely(place, MAX_END_OFFSET * pace)
            if not len(near):
                break
            found.append(int(near[np.argmin(np.hypot(*(middle[near] - place).T))]))
    return found


def _pace(middle):
    """Median distance from one place of a row to the next."""
    return float(np.median(np.hypot(*np.diff(middle[np.argsort((middle - middle.mean(axis=0)) @ _way(middle))], axis=0).T)))


def blocks_of_strip(cells: np.ndarray) -> np.ndarray | None:
    """The blocks of a give-way line that was taken for one piece: along the road scan lines join what lies so near.

    Parameters
    ----------
    cells : (K, 2) int, different ones, of a frame in which the line is straight

    Returns
    -------
    (K,) the number of each cell's block along the line; None where the cells are no row of blocks
    """
    direction = np.linalg.eigh(np.cov(cells.T))[1][:, 1]
    places = cells @ np.array([[direction[0], -direction[1]], [direction[1], direction[0]]])
    if np.ptp(places[:, 0]) * CELL_SIZE < LEAST_STRIP or not BLOCK_SIZE[0] <= np.ptp(places[:, 1]) * CELL_SIZE <= BLOCK_SIZE[1]:
        return None
    step = np.floor(places[:, 0] - places[:, 0].min()).astype(np.int64)
    count = np.bincount(step)
    painted = np.flatnonzero(count >= PAINTED_SHARE * np.percentile(count[count > 0], 75))
    gaps = np.diff(painted)
    apart = np.flatnonzero(gaps > max(gaps.max(initial=0) / 2, LEAST_GAP))
    if len(apart) < MIN_BLOCKS_IN_ROW - 1:
        return None
    number = np.searchsorted((painted[apart] + painted[apart + 1]) / 2, step)
    low, high = np.full((2, len(apart) + 1), np.inf), np.full((2, len(apart) + 1), -np.inf)
    rows = np.flatnonzero(np.isin(step, painted))
    for k in range(2):
        np.minimum.at(low[k], number[rows], places[rows, k])
        np.maximum.at(high[k], number[rows], places[rows, k])
    found = rows_of_blocks((high - low + 1).T * CELL_SIZE, (low + high).T / 2 * CELL_SIZE)
    # those at the ends may be cut off
    return number if sum(map(len, found)) >= max(len(apart) - 1, MIN_BLOCKS_IN_ROW) else None


def rows_of_blocks(sides: np.ndarray, middle: np.ndarray) -> list[np.ndarray]:
    """Filled squares that stand in rows: the blocks of give-way lines.

    A single square may be a manhole cover. Three of one size at an even pitch in a line were painted.

    Parameters
    ----------
    sides : (N, 2) m along the road and across it of filled pieces
    middle : (N, 2) m, their middles

    Returns
    -------
    list of ascending int arrays, the pieces of each row
    """
    pairs, of_pair, apart = _pairs_of_squares(sides, middle)
    links = (of_pair.max(axis=1) <= MAX_BLOCK_RATIO * of_pair.min(axis=1)) \
        & (apart >= BLOCK_SPACING[0] * of_pair.mean(axis=1)) & (apart <= BLOCK_SPACING[1] * of_pair.mean(axis=1))
    ways = (middle[pairs[:, 1]] - middle[pairs[:, 0]]) / np.maximum(apart, 1e-9)[:, None]
    return _chains(pairs[links], apart[links], ways[links], MIN_BLOCKS_IN_ROW, MAX_BLOCK_STEP_RATIO, MAX_BLOCK_OFFSET)


def _pairs_of_squares(sides, middle):
    """(P, 2) squares near each other, either way, (P, 2) m their sizes, and (P,) m between their middles."""
    square = np.flatnonzero((sides.min(axis=1, initial=np.inf) >= BLOCK_SIZE[0]) & (sides.max(axis=1, initial=0.0) <= BLOCK_SIZE[1])
                            & (sides.max(axis=1, initial=0.0) <= MAX_BLOCK_RATIO * np.maximum(sides.min(axis=1, initial=np.inf), 1e-3)))
    if len(square) < 2:
        return np.empty((0, 2), np.int64), np.empty((0, 2)), np.empty(0)
    pairs = square[cKDTree(middle[square]).query_pairs(BLOCK_SPACING[1] * BLOCK_SIZE[1], output_type="ndarray")].reshape(-1, 2)
    pairs = np.concatenate([pairs, pairs[:, ::-1]])
    pairs = pairs[np.lexsort(pairs.T[::-1])]
    return pairs, sides.mean(axis=1)[pairs], np.hypot(*(middle[pairs[:, 1]] - middle[pairs[:, 0]]).T)


def _narrow(length, width, turn, pairs, ways):
    """(P,) whether both pieces of each pair are narrow across the way from one to the other."""
    heading = np.arctan2(ways[:, 1], ways[:, 0])
    narrow = np.ones(len(pairs), bool)
    for k in pairs.T:
        off = turn[k] - heading
        narrow &= length[k] * np.abs(np.sin(off)) + width[k] * np.abs(np.cos(off)) <= MAX_DASH_BREADTH
    return narrow


def _chains(pairs, apart, ways, fewest=MIN_DASHES_IN_ROW, max_step_ratio=MAX_STEP_RATIO, max_offset=MAX_DASH_OFFSET):
    """Arrays of the pieces of each row, from steps between neighbours."""
    # a step from i to j goes on in one from j to k
    order = np.argsort(pairs[:, 0], kind="stable")
    first, last = (np.searchsorted(pairs[order, 0], pairs[:, 1], side=side) for side in ("left", "right"))
    count = last - first
    before = np.repeat(np.arange(len(pairs)), count)
    after = order[np.arange(len(before)) - np.repeat(np.cumsum(count) - count - first, count)]
    even = np.maximum(apart[before], apart[after]) <= max_step_ratio * np.minimum(apart[before], apart[after])
    straight = (ways[before] * ways[after]).sum(axis=1) >= MIN_STEP_COSINE
    off = apart[after] * np.abs(ways[before, 0] * ways[after, 1] - ways[before, 1] * ways[after, 0])
    joined = even & straight & (off <= max_offset)
    row = linked_groups(before[joined], after[joined], len(pairs))
    # a row is found twice, forwards and backwards
    found = {tuple(np.unique(pairs[steps]).tolist()) for _, steps in members_of(row) if len(steps) >= fewest - 1}
    return [np.array(members) for members in sorted(found) if len(members) >= fewest]
