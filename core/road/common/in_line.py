"""Short pieces of curb in line with the curb before and after them.

A short piece of curb may be anything where it stands alone. Between two stretches of curb that were chosen already, a piece
of their height that lies on the smooth line through both is the same curb, seen between what hides the rest of it, such as a
row of parked cars. Its steps are taken one by one, upright or sloped, linked with each other or not: which of them were linked
to a chain hangs on a millimetre. It may scatter more than a curb that nothing else speaks for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from ...common.arrays import stretch_of
from ...common.parallel import check_cancelled
from .corners import CurbSteps
from .tracking import (
    HEIGHT_TOLERANCE,
    LINK_TOLERANCE,
    MAX_CHAIN_SCATTER,
    MAX_JOINED_GAP,
    MAX_LINK_LENGTH,
    MAX_ROAD_ROUGHNESS,
    StepChain,
    seen_stretch,
)

LINE_FIT_LENGTH = 10.0      # m of curb before and after a gap that give the line across it
WEIGHT_LENGTH = 5.0         # m from the gap at which a place counts half
MIN_BEND_LENGTH = 3.0       # m of curb at an end from which its direction is known
MAX_LINE_GAP = 50.0         # m between two stretches of one line: a row of parked cars
IN_LINE_ACROSS = 0.08       # m from that line
IN_LINE_AT_END, IN_LINE_DRIFT = 0.03, 0.01   # m, and m per m from the nearer end: less where a gap begins or ends
IN_LINE_GRADE = 0.01        # m per m to the nearer end that the bottom may differ besides HEIGHT_TOLERANCE
MAX_HEIGHT_RATIO = 1.6      # of the height of a piece over that of the curb before and after it
MIN_PIECE_LENGTH = 0.5      # m
MIN_PIECE_STEPS = 3


def with_pieces_in_line(kept: Sequence[tuple[int, float, float]], chains: Sequence[StepChain], steps: CurbSteps,
                        to_plan: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]) -> list[np.ndarray]:
    """The steps of the chosen intervals and, between them, the pieces of curb that lie in their line.

    Parameters
    ----------
    kept : result of `drop_short_curbs`
    chains : list of StepChain
    steps : CurbSteps to which they refer
    to_plan : function, stations and outward offsets in m -> x and y in m

    Returns
    -------
    list of (K,) indices into the steps, by station, one for every interval and piece, in order along the road
    """
    found = [_between(steps, chains[chain].steps, a - 1e-9, b + 1e-9) for chain, a, b in kept]
    if not found:
        return []
    chosen, others = StepsByStation(steps[np.concatenate(found)]), StepsByStation(steps)
    for (_, _, a), (_, b, _) in zip(kept[:-1], kept[1:]):
        if not MAX_JOINED_GAP < b - a <= MAX_LINE_GAP:
            continue
        check_cancelled()
        before, after = (chosen.steps[chosen.rows(*ends)] for ends in ((a - LINE_FIT_LENGTH, a + 1e-9), (b - 1e-9, b + LINE_FIT_LENGTH)))
        found += [piece.steps for piece in pieces_between(before, after, others, to_plan)]
    return sorted(found, key=lambda members: float(steps.s[members[0]]))


def _between(steps, members, start, end):
    return members[(steps.s[members] >= start) & (steps.s[members] <= end)]


class StepsByStation:
    """CurbSteps of one side, of which those between two stations are looked up."""

    def __init__(self, steps: CurbSteps):
        self.steps = steps
        self._order = np.argsort(steps.s, kind="stable")
        self._station = steps.s[self._order]

    def rows(self, start: float, end: float) -> np.ndarray:
        """(K,) indices, by station, of the steps between two stations, m."""
        return self._order[stretch_of(self._station, start, end)]


@dataclass(frozen=True)
class PieceInLine:
    """A piece of curb on the line across a gap.

    steps : (K,) indices of its steps, by station
    off : m, greatest distance from the line
    start, end : m, first and last station
    """

    steps: np.ndarray
    off: float
    start: float
    end: float


def pieces_between(before: CurbSteps, after: CurbSteps, others: StepsByStation,
                   to_plan: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]) -> list[PieceInLine]:
    """The pieces of curb on the line between two runs of curb.

    Parameters
    ----------
    before, after : CurbSteps on both sides of the gap, or any rows with `s`, `u`, `h` and `height`; not empty
    others : the steps that may lie between
    to_plan : function, stations and outward offsets in m -> x and y in m

    Returns
    -------
    list of PieceInLine
    """
    a, b = before.s.max(), after.s.min()
    rows, steps = others.rows(a + 1e-6, b - 1e-6), others.steps
    if len(rows) < MIN_PIECE_STEPS:
        return []
    line = GapLine(np.array(to_plan(before.s, before.u)), np.array(to_plan(after.s, after.u)))
    (s0, h0, height0), (s1, h1, height1) = ([np.median(v) for v in (end.s, end.h, end.height)] for end in (before, after))
    s = steps.s[rows]
    share = (s - s0) / (s1 - s0)
    off = line.off(*to_plan(s, steps.u[rows]))
    up, from_end = np.abs(steps.h[rows] - h0 - share * (h1 - h0)), np.minimum(s - a, b - s)
    across = np.minimum(IN_LINE_AT_END + IN_LINE_DRIFT * from_end, IN_LINE_ACROSS)
    near = np.flatnonzero((np.abs(off) <= across) & (up <= HEIGHT_TOLERANCE + IN_LINE_GRADE * from_end))
    if not len(near):
        return []
    # of the steps on one profile the one nearest to the line
    near = near[np.lexsort((np.abs(off[near]), steps.profile[rows[near]]))]
    near = near[np.r_[True, np.diff(steps.profile[rows[near]]) > 0]]
    parted = (np.diff(s[near]) > MAX_LINK_LENGTH) | (np.abs(np.diff(off[near])) > LINK_TOLERANCE)
    runs = [run[seen_stretch(steps.profile[rows[run]])] for run in np.split(near, np.flatnonzero(parted) + 1)]
    return [PieceInLine(rows[run], float(np.abs(off[run]).max()), float(s[run[0]]), float(s[run[-1]])) for run in runs
            if len(run) >= MIN_PIECE_STEPS and np.ptp(s[run]) >= MIN_PIECE_LENGTH
            and _is_curb(steps[rows[run]], off[run], across[run].min(), height0 + share[run] * (height1 - height0))]


def _is_curb(piece, off, across, height):
    """Is a run of steps near a line a piece of the curb of that line? `off` : m, from the line; `across` : m that it may lead away from it."""
    ratio = np.median(piece.height / height)
    s = piece.s - piece.s.mean()
    turn, scanner_noise = s @ off / (s @ s), np.median(piece.scanner_noise)
    return bool(1 / MAX_HEIGHT_RATIO <= ratio <= MAX_HEIGHT_RATIO and abs(turn) * np.ptp(s) <= across
                and np.std(off - turn * s) <= MAX_CHAIN_SCATTER + scanner_noise and np.mean(piece.behind >= 2) >= 0.5
                and np.median(piece.noise) <= max(MAX_ROAD_ROUGHNESS, 2 * scanner_noise))


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
