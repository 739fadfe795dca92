"""Lines of steps in plan: steps that continue each other in place, direction and height are one curb."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import linked_groups
from ..weights import CURBS, RETURN
from .steps import PlanSteps

MAX_LINE_OVERLAP = RETURN.long_half_length   # m that two lines of one curb may: a step of sparse points is known along the curb no better than that


@dataclass
class PlanStepChain:
    """Steps of one line."""

    steps: np.ndarray   # (K,) indices into the PlanSteps, in order, uphill on the right
    closed: bool = False   # does the line go all around an island?


def link_plan_steps(steps: PlanSteps) -> list[PlanStepChain]:
    """Chains of steps; the uphill side of each is on the right of its direction."""
    distinct = without_duplicates(steps)
    ahead = _links(steps[distinct])
    return [PlanStepChain(distinct[members], closed) for members, closed in _paths(ahead)]


def without_duplicates(steps: PlanSteps) -> np.ndarray:
    """Indices of the steps that have no better supported duplicate."""
    if not len(steps):
        return np.empty(0, np.int64)
    a, b = cKDTree(np.c_[steps.x, steps.y]).query_pairs(RETURN.duplicate_along, output_type="ndarray").T
    dx, dy = steps.x[b] - steps.x[a], steps.y[b] - steps.y[a]
    alike = (steps.nx[a] * steps.nx[b] + steps.ny[a] * steps.ny[b] > 0.5) & (np.abs(dx * steps.nx[a] + dy * steps.ny[a]) < RETURN.duplicate_across)
    a, b = a[alike], b[alike]
    # of equal support the place decides, so that the order of the work does not
    rank = np.empty(len(steps), np.int64)
    rank[np.lexsort((steps.y, steps.x, -steps.support))] = np.arange(len(steps))
    beaten = np.zeros(len(steps), bool)
    beaten[np.where(rank[a] > rank[b], a, b)] = True
    return np.flatnonzero(~beaten)


def _links(steps):
    """(M,) index of the step that follows each one, -1 where none does; no two are followed by the same."""
    count = len(steps)
    following = np.full(count, -1)
    if count < 2:
        return following
    pairs = cKDTree(np.c_[steps.x, steps.y]).query_pairs(RETURN.max_plan_link, output_type="ndarray")
    a, b = np.r_[pairs[:, 0], pairs[:, 1]], np.r_[pairs[:, 1], pairs[:, 0]]
    dx, dy = steps.x[b] - steps.x[a], steps.y[b] - steps.y[a]
    # on an arc the chord points in the mean direction of its ends
    nx, ny = steps.nx[a] + steps.nx[b], steps.ny[a] + steps.ny[b]
    size = np.maximum(np.hypot(nx, ny), 1e-9)
    across, along = np.abs(dx * nx + dy * ny) / size, (dy * nx - dx * ny) / size
    turn = np.abs(np.arctan2(steps.nx[a] * steps.ny[b] - steps.ny[a] * steps.nx[b], steps.nx[a] * steps.nx[b] + steps.ny[a] * steps.ny[b]))
    up = np.abs(steps.h[b] - steps.h[a])
    # where a curb bends sharply its direction is less certain
    good = (along > 0.02) & (across <= RETURN.plan_link_tolerance + (RETURN.plan_link_drift + RETURN.drift_per_turn * turn) * along) \
        & (turn <= RETURN.turn_tolerance + along / RETURN.min_curb_radius) \
        & (up <= CURBS.height_tolerance + RETURN.max_height_grade * along)
    a, b, along, across, turn, up = (v[good] for v in (a, b, along, across, turn, up))
    cost = along / 0.3 + (across / RETURN.plan_link_tolerance) ** 2 + (turn / RETURN.turn_tolerance) ** 2 + (up / CURBS.height_tolerance) ** 2
    return _mutual(a, b, cost, count)


def _cheapest(a, b, cost, count):
    """For every a the b of the lowest cost, -1 without."""
    best = np.full(count, -1)
    order = np.lexsort((b, cost, a))
    first = order[np.r_[True, np.diff(a[order]) > 0][:len(order)]]
    best[a[first]] = b[first]
    return best


def _paths(following):
    """Runs of a successor list: list of (indices in order, is it a ring), by their lowest index, at which a ring is opened."""
    left, runs = dict.fromkeys(range(len(following))), []
    for first in [*np.setdiff1d(np.arange(len(following)), following).tolist(), *left]:
        run, k = [], first
        while k in left:
            del left[k]
            run.append(k)
            k = int(following[k])
        if run:
            runs.append((np.array(run), k == first))
    return sorted(runs, key=lambda run: run[0].min())


def join_chains(chains: Sequence[PlanStepChain], steps: PlanSteps) -> list[PlanStepChain]:
    """The chains, those that lie in one line a short gap apart joined to one."""
    open_chains = [c for c in chains if not c.closed]
    tips = LineEnds.of([(steps.x[c.steps], steps.y[c.steps], steps.h[c.steps]) for c in open_chains])
    runs = _paths(tips.successors(RETURN.max_nose_gap))
    return [PlanStepChain(np.concatenate([open_chains[k].steps for k in run]), ring) for run, ring in runs] + [c for c in chains if c.closed]


def group_lines(places: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> np.ndarray:
    """Which polylines continue each other, a short gap apart in any direction or a long one straight on.

    places : list of K polylines (x, y, h), each (N,) local m, all with their uphill side on the same hand

    Returns (K,) number of the line to which each belongs
    """
    ends = LineEnds.of(places)
    long = np.array([np.hypot(np.diff(x), np.diff(y)).sum() >= RETURN.line_direction_length for x, y, _ in places])
    far = LineEnds.of(places, RETURN.line_direction_length).straight_successors(long)
    following = np.r_[ends.successors(overlap=MAX_LINE_OVERLAP), far]
    linked = np.flatnonzero(following >= 0)
    return linked_groups(linked % len(places), following[linked], len(places))


@dataclass
class LineEnds:
    """Both ends of K polylines."""

    heads: np.ndarray   # heads, tails: (K, 5) local x, y and h, m, and the unit vector that points out of the line
    tails: np.ndarray

    @staticmethod
    def of(places: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]], length: float = RETURN.end_direction_length) -> LineEnds:
        """The ends of polylines (x, y, h), whose last `length` metres give the directions."""
        return LineEnds(*(np.array([_tip(x[::step], y[::step], h[::step], length) for x, y, h in places]).reshape(-1, 5) for step in (-1, 1)))

    def straight_successors(self, long: np.ndarray) -> np.ndarray:
        """The line straight ahead of each, up to RETURN.max_straight_gap away; `long` : (K,) bool, lines long enough for a direction.

        Returns (K,) indices, -1 where there is none
        """
        if not len(self.heads):
            return np.empty(0, np.int64)
        a, b, gap, tail, head, (dx, dy), turn = self._gaps(RETURN.max_straight_gap)
        miss = np.maximum(*(np.abs(dx * end[:, 4] - dy * end[:, 3]) for end in (tail, head)))
        good = long[a] & long[b] & (dx * tail[:, 3] + dy * tail[:, 4] > 0) & (turn <= RETURN.max_straight_turn) \
            & (miss <= RETURN.straight_tolerance + RETURN.straight_drift * gap) \
            & (np.abs(head[:, 2] - tail[:, 2]) <= CURBS.height_tolerance + RETURN.straight_grade * gap)
        return _mutual(a[good], b[good], (gap + 10 * miss)[good], len(self.heads))

    def successors(self, nose: float = 0.0, overlap: float = RETURN.max_join_overlap) -> np.ndarray:
        """The line whose head continues the tail of each line.

        nose : m of gap within which a line may bend about its uphill side as sharply as the nose of an island
        overlap : m that two lines may overlap

        Returns (K,) indices, -1 where no line continues
        """
        if not len(self.heads):
            return np.empty(0, np.int64)
        a, b, gap, tail, head, (dx, dy), turn = self._gaps(CURBS.max_joined_gap)
        # the direction in which the one ends and the other begins
        tx, ty = tail[:, 3] - head[:, 3], tail[:, 4] - head[:, 4]
        size = np.maximum(np.hypot(tx, ty), 1e-9)
        # uphill is on the right, so the line bends about it where the way out of the head lies to the left of the tail's
        bend = tail[:, 3] * head[:, 4] - tail[:, 4] * head[:, 3]
        about_nose = (bend > 0) & (gap <= nose)
        max_turn = RETURN.max_join_turn + np.where(about_nose, gap / RETURN.nose_radius, 0.0)
        along, across = (dx * tx + dy * ty) / size, np.abs(dx * ty - dy * tx) / size
        # a square end: one of both goes on to the corner, near which the other begins
        legs = [(dx * end[:, 4] - dy * end[:, 3]) / np.where(bend > 0, bend, np.inf) for end in (head, tail)]
        in_line = (across <= RETURN.join_tolerance + RETURN.join_drift * np.abs(along)) | about_nose & (np.abs(np.minimum(*legs)) <= overlap)
        up = np.abs(head[:, 2] - tail[:, 2])
        good = (along > -overlap) & in_line & (turn <= max_turn) & (up <= CURBS.height_tolerance + RETURN.max_height_grade * gap)
        return _mutual(a[good], b[good], (gap + 2 * across + turn)[good], len(self.heads))

    def _gaps(self, distance):
        """The P gaps of at most so many metres from the tail of one line to the head of another.

        Returns (P,) both lines and m between them, (P, 5) both ends, x and y that the gap leads, and radians that the head turns off the tail
        """
        near = cKDTree(self.tails[:, :2]).sparse_distance_matrix(cKDTree(self.heads[:, :2]), distance, output_type="ndarray")
        near = near[near["i"] != near["j"]]
        tail, head = self.tails[near["i"]], self.heads[near["j"]]
        turn = np.arccos(np.clip(-(tail[:, 3] * head[:, 3] + tail[:, 4] * head[:, 4]), -1, 1))
        return near["i"], near["j"], near["v"], tail, head, (head - tail)[:, :2].T, turn


def _mutual(a, b, cost, count):
    """(count,) for every a the b of the lowest cost where that has no cheaper a; -1 elsewhere."""
    following = np.full(count, -1)
    ahead, behind = _cheapest(a, b, cost, count), _cheapest(b, a, cost, count)
    linked = np.flatnonzero(ahead >= 0)
    linked = linked[behind[ahead[linked]] == linked]
    following[linked] = ahead[linked]
    return following


def _tip(x, y, h, length):
    """Where a line ends, and the unit vector of its direction over its last metres: x, y, h, tx, ty."""
    back = np.hypot(x - x[-1], y - y[-1])
    far = np.flatnonzero(back >= length)
    # of a curb that bends, its last half metre or so gives the direction
    k = int(far[-1]) if len(far) else 0
    tx, ty = x[-1] - x[k], y[-1] - y[k]
    size = max(np.hypot(tx, ty), 1e-9)
    return x[-1], y[-1], h[-1], tx / size, ty / size
