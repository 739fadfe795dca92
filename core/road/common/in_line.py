"""Short pieces of curb in line with the curb before and after them.

A short piece of curb may be anything where it stands alone. Between two stretches of curb that were chosen already, a piece
of their height that lies on the smooth line through both is the same curb, seen between what hides the rest of it, such as a
row of parked cars. It may scatter more than a curb that nothing else speaks for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from ...common.near_pairs import overlapping_pairs
from ...common.parallel import check_cancelled
from ...common.runs import stretch_of
from .corners import CurbSteps
from .tracking import HEIGHT_TOLERANCE, StepChain

LINE_FIT_LENGTH = 10.0      # m of curb before and after a gap that give the line across it
WEIGHT_LENGTH = 5.0         # m from the gap at which a place counts half
MIN_BEND_LENGTH = 3.0       # m of curb at an end from which its direction is known
MAX_LINE_GAP = 50.0         # m between two stretches of one line: a row of parked cars
IN_LINE_ACROSS = 0.08       # m from that line
IN_LINE_GRADE = 0.01        # m per m to the nearer end that the bottom may differ besides HEIGHT_TOLERANCE
MAX_HEIGHT_RATIO = 1.6      # of the height of a piece over that of the curb before and after it
MIN_PIECE_LENGTH = 0.5      # m
MIN_PIECE_STEPS = 3


def with_pieces_in_line(kept: Sequence[tuple[int, float, float]], chains: Sequence[StepChain], steps: CurbSteps,
                        to_plan: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]) -> list[tuple[int, float, float]]:
    """The chosen intervals and, between them, the pieces of other chains that lie in their line.

    Parameters
    ----------
    kept : result of `drop_short_curbs`
    chains : list of StepChain
    steps : CurbSteps to which they refer
    to_plan : function, stations and outward offsets in m -> x and y in m

    Returns
    -------
    list like `kept`, in order along the road
    """
    members = [_between(steps, chains[chain].steps, a - 1e-9, b + 1e-9) for chain, a, b in kept]
    chosen = np.concatenate(members) if members else np.empty(0, np.int64)
    order = np.argsort(steps.s[chosen], kind="stable")
    by_station = steps.s[chosen[order]]
    gaps = [(a, b) for (_, _, a), (_, b, _) in zip(kept[:-1], kept[1:]) if 2 * MIN_PIECE_LENGTH <= b - a <= MAX_LINE_GAP]
    found = list(kept)
    for (a, b), some in zip(gaps, chains_beside(gaps, chains)):
        check_cancelled()
        before, after = (steps[chosen[np.sort(order[stretch_of(by_station, *ends)])]]
                         for ends in ((a - LINE_FIT_LENGTH, a + 1e-9), (b - 1e-9, b + LINE_FIT_LENGTH)))
        pieces = pieces_between(before, after, chains, steps, to_plan, some)
        found += [(piece.chain, piece.start, piece.end) for piece in side_by_side(pieces)]
    return sorted(found, key=lambda part: part[1:])


def chains_beside(gaps: Sequence[tuple[float, float]], chains: Sequence[StepChain]) -> list[list[int]]:
    """Numbers, ascending, of the chains that lie along each gap between two stations, m; some that lie a hair beside it are among them."""
    found: list[list[int]] = [[] for _ in gaps]
    first, last = np.array(gaps, float).reshape(-1, 2).T
    starts, ends = (np.array([getattr(chain, name) for chain in chains], float) for name in ("start", "end"))
    for gap, chain in overlapping_pairs(first, last, starts, ends):
        for g, c in zip(gap.tolist(), chain.tolist()):
            found[g].append(c)
    return [sorted(some) for some in found]


def _between(steps, members, start, end):
    return members[(steps.s[members] >= start) & (steps.s[members] <= end)]


@dataclass(frozen=True, order=True)
class PieceInLine:
    """A piece of a chain on the line across a gap; the better ones sort first.

    weak : is its chain too weak for a curb by itself?
    off : m, greatest distance from the line
    chain, start, end : number of the chain, and the stations between which the piece lies, m
    """

    weak: bool
    off: float
    chain: int
    start: float
    end: float


def pieces_between(before: CurbSteps, after: CurbSteps, chains: Sequence[StepChain], steps: CurbSteps,
                   to_plan: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]], some: Sequence[int]) -> list[PieceInLine]:
    """The pieces of chains that lie on the line between two runs of curb.

    Parameters
    ----------
    before, after : CurbSteps on both sides of the gap, or any rows with `s`, `u`, `h` and `height`; not empty
    chains : list of StepChain
    steps : CurbSteps to which they refer
    to_plan : function, stations and outward offsets in m -> x and y in m
    some : numbers of the chains that are looked at, those of `chains_beside`
    """
    if not some:
        return []
    a, b = before.s.max(), after.s.min()
    line = GapLine(np.array(to_plan(before.s, before.u)), np.array(to_plan(after.s, after.u)))
    (s0, h0, height0), (s1, h1, height1) = ([np.median(v) for v in (end.s, end.h, end.height)] for end in (before, after))
    pieces = []
    for number, chain in ((number, chains[number]) for number in some):
        if chain.end < a + MIN_PIECE_LENGTH or chain.start > b - MIN_PIECE_LENGTH:
            continue
        members = _between(steps, chain.steps, a + 1e-6, b - 1e-6)
        if len(members) < MIN_PIECE_STEPS or np.ptp(steps.s[members]) < MIN_PIECE_LENGTH:
            continue
        s = steps.s[members]
        share = (s - s0) / (s1 - s0)
        off = np.abs(line.off(*to_plan(s, steps.u[members]))).max()
        up = np.abs(steps.h[members] - h0 - share * (h1 - h0)) - IN_LINE_GRADE * np.minimum(s - a, b - s)
        ratio = np.median(steps.height[members] / (height0 + share * (height1 - height0)))
        if off <= IN_LINE_ACROSS and up.max() <= HEIGHT_TOLERANCE and 1 / MAX_HEIGHT_RATIO <= ratio <= MAX_HEIGHT_RATIO:
            pieces.append(PieceInLine(chain.weak, float(off), number, float(s[0]), float(s[-1])))
    return pieces


def side_by_side(pieces: Iterable[PieceInLine]) -> list[PieceInLine]:
    """Of pieces beside each other one that is not weak, and the one nearest to the line."""
    chosen: list[PieceInLine] = []
    for piece in sorted(pieces):
        if all(piece.end < other.start or piece.start > other.end for other in chosen):
            chosen.append(piece)
    return chosen


class GapLine:
    """A polynomial in plan across a gap.

    Parameters
    ----------
    before, after : (2, N) and (2, M) m, x and y of the curb on both sides of the gap, in order; those within LINE_FIT_LENGTH
        of it are used
    max_degree : greatest degree; 2 is an even bend

    Attributes
    ----------
    miss : m, greatest distance of the places that were used from the line
    """

    def __init__(self, before: np.ndarray, after: np.ndarray, max_degree: int = 3):
        ends, weights = [], []
        for part, tip in ((before, before[:, -1:]), (after, after[:, :1])):
            away = np.hypot(*(part - tip))
            near = away <= LINE_FIT_LENGTH
            ends.append(part[:, near])
            # both ends count alike, however many points each has, and near places more than far ones
            weight = 1.0 / (1.0 + (away[near] / WEIGHT_LENGTH) ** 2)
            weights.append(weight / weight.sum())
        known, (first, last) = np.concatenate(ends, axis=1), (end.mean(1) for end in ends)
        self.origin, self.along = first, (last - first) / max(np.hypot(*(last - first)), 1e-9)
        degree = 1 + sum(np.hypot(*(end[:, -1] - end[:, 0])) >= MIN_BEND_LENGTH for end in ends)
        t, v = self.place(*known)
        self.ends = np.c_[before[:, -1], after[:, 0]]
        self.line = Polynomial.fit(t, v, min(degree, max_degree), w=np.sqrt(np.concatenate(weights)))
        self.miss = float(np.abs(v - self.line(t)).max())

    def place(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(N,) m along the chord and left of it."""
        dx, dy = x - self.origin[0], y - self.origin[1]
        return dx * self.along[0] + dy * self.along[1], dy * self.along[0] - dx * self.along[1]

    def between(self, spacing: float) -> np.ndarray:
        """(2, N) m, x and y of places in the gap about so far apart on the line, which is moved to meet the last place before and the first after."""
        t, off = self.place(*self.ends)[0], self.off(*self.ends)
        inner = np.linspace(t[0], t[1], max(int(np.ceil((t[1] - t[0]) / spacing)), 1) + 1)[1:-1]
        v = self.line(inner) + np.interp(inner, t, off)
        return self.origin[:, None] + np.array([inner * self.along[0] - v * self.along[1], inner * self.along[1] + v * self.along[0]])

    def off(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(N,) m from the line, left positive."""
        t, v = self.place(x, y)
        return v - self.line(t)
