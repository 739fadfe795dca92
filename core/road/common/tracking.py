"""Steps linked to chains along the road, and the sequence of chains that is the curb.

A single step may be anything; a curb continues. Steps of neighbouring profiles are linked where offset and height continue, and the links make
chains. Among chains side by side the selection along the road weighs the length that they cover against lateral jumps, with a weak preference for
what is near the vehicle.
"""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import Polynomial
from scipy.ndimage import median_filter

from ...common.arrays import ROUNDING_TOLERANCE, linked_groups, stretch_of
from ...common.parallel import check_cancelled
from ...curves.robust import MAD_TO_SIGMA, median, percentiles
from ..weights import CURBS, EDGE
from .corners import CurbSteps
from .curb_limits import CurbLimits

if TYPE_CHECKING:
    from ..surface.road_look import RoadLook

IN_LINE_TURN = CURBS.in_line_across / CURBS.line_fit_length   # rad at most; by more across shorter gaps


@dataclass
class StepChain:
    """Steps of one line.

    steps : (K,) indices into the CurbSteps, sorted by station
    start, end : m, first and last station
    low, sloped : is it lower, or less steep, than what is taken for a curb wherever it is seen?
    scatter : m, of the steps about their line
    method : number of the method that measured the steps
    """

    steps: np.ndarray
    start: float
    end: float
    low: bool = False
    sloped: bool = False
    scatter: float = 0.0
    method: int = 0

    @property
    def faint(self) -> bool:
        """Is it lower or less steep?"""
        return self.low or self.sloped


def link_steps(steps: CurbSteps, profile_width: float) -> np.ndarray:
    """Link steps of neighbouring profiles.

    Each step is linked with the one ahead that continues it best, if that one has no better step behind, so chains do not branch.

    steps : M CurbSteps of one side of one road
    profile_width : m of road per profile

    Returns (M,) number of the chain of every step, numbered by first station
    """
    count = len(steps)
    if not count:
        return np.empty(0, np.int64)
    order = np.lexsort((steps.u, steps.profile))
    sorted_steps = steps[order]
    ahead = _best_partner(sorted_steps, profile_width, 1)
    behind = _best_partner(sorted_steps, profile_width, -1)
    rows = np.flatnonzero(ahead >= 0)
    rows = rows[behind[ahead[rows]] == rows]
    groups = np.empty(count, np.int64)
    groups[order] = linked_groups(rows, ahead[rows], count)
    return groups


def _best_partner(steps, width, direction):
    """Index of the cheapest step in the following (or preceding) profiles, -1 where none fits. The steps are sorted by profile, then outward."""
    profile, u, h, s = steps.profile, steps.u, steps.h, steps.s
    count = len(u)
    span = u.max() - u.min() + 1000.0
    key = profile * span + (u - u.min())
    best, cheapest = np.full(count, -1), np.full(count, np.inf)
    for gap in range(1, max(int(round(CURBS.max_link_length / width)), 1) + 1):
        on = u + steps.skew * direction * gap * width
        wanted = (profile + direction * gap) * span + (on - u.min())
        right = np.searchsorted(key, wanted)
        for candidate in (right - 1, right):
            k = np.clip(candidate, 0, count - 1)
            along = np.abs(s[k] - s)
            turn = 0.5 * (steps.skew + steps.skew[k]) * (s[k] - s)
            across, up = np.abs(u[k] - u - turn), np.abs(h[k] - h)
            fits = (profile[k] == profile + direction * gap) & (across <= CURBS.link_tolerance + CURBS.link_drift * along) \
                & (up <= CURBS.height_tolerance + 0.05 * along)
            cost = np.where(fits, (across / CURBS.link_tolerance) ** 2 + (up / CURBS.height_tolerance) ** 2 + (gap - 1), np.inf)
            better = cost < cheapest
            best[better], cheapest[better] = k[better], cost[better]
    return best


def curb_chains(steps: CurbSteps, label: np.ndarray, profile_width: float, limits: CurbLimits) -> list[StepChain]:
    """Chains that look like a curb: long, dense, smooth, steep, with raised ground behind.

    steps : M CurbSteps of one side of one road
    label : (M,) chain of each step
    profile_width : m of road per profile

    Returns a list of StepChain, sorted by start
    """
    if not len(steps):
        return []
    order = np.lexsort((steps.profile, label))
    chains: list[StepChain] = []
    weak: list[StepChain] = []
    for members in np.split(order, np.flatnonzero(np.diff(label[order])) + 1):
        check_cancelled()
        length = (steps.profile[members[-1]] - steps.profile[members[0]] + 1) * profile_width
        # two steps do not show whether they lie in line
        if len(members) >= CURBS.min_piece_steps and length >= CURBS.min_chain_length - 1e-9 \
                and len(members) * profile_width >= CURBS.min_chain_density * length:
            chain, sure = _as_curb(steps, members, length, limits)
            if sure:
                (chains if sure > 1 else weak).append(chain)
    return sorted([*chains, *_continuing(chains, weak, steps)], key=lambda c: (c.start, c.end))


def _as_curb(steps, members, length, limits):
    """A dense chain as StepChain, and 2 where it is a curb by itself, 1 where it is one if it continues another, else 0."""
    s = steps.s[members]
    height, noise, scanner_noise = (median(v[members]) for v in (steps.height, steps.noise, steps.scanner_noise))
    # blur widens a face and never narrows it, so the sharper profiles show its width
    slope = np.arctan2(height, max(percentiles(steps.run[members], (30.0,))[0] - 2 * scanner_noise, 0.0))
    least, scatter = limits.clear_height, _chain_scatter(s, steps.u[members])
    allowance = min(scanner_noise, CURBS.max_noise_allowance * least) if scanner_noise > CURBS.noisy_share * least else 0.0
    chain = StepChain(members, float(s[0]), float(s[-1]), bool(height < least - allowance), bool(slope < limits.clear_slope), scatter)
    if not is_clean(noise, scanner_noise, steps.behind[members], scatter) \
            or chain.sloped and length < CURBS.min_sloped_length:
        return chain, 0
    if not chain.faint:
        return chain, 2
    return chain, limits.automatic * sum(limits.faint(height, slope, noise, len(members), scatter / factor)
                                         for factor in (1.0, CURBS.weak_scatter_factor))


def is_clean(noise: float, scanner_noise: float, behind: np.ndarray, scatter: float) -> bool:
    """Is the road before a line of steps smooth, is ground seen behind most of them, and do they lie in line?

    noise, scanner_noise : m, scatter of heights before the steps, and the scanner's own
    behind : (N,) points of the raised ground of each step
    scatter : m, of the steps about their line
    """
    return bool(noise <= max(CURBS.max_road_roughness, 2 * scanner_noise) and np.mean(behind >= 2) >= 0.5
                and scatter <= CURBS.max_chain_scatter + scanner_noise)


def is_road(roughness: np.ndarray) -> bool:
    """Is ground as even as a road? `roughness` : (N,) of places on it in units of the road's, NaN where it is not known."""
    known = roughness[np.isfinite(roughness)]
    return not len(known) or median(known) <= CURBS.max_road_ratio


def _continuing(chains, weak, steps):
    """Those of the weak chains that continue a chain, or another such one: how much a short chain scatters depends on where profiles are cut."""
    continuing: list[StepChain] = []
    for sign in (1, -1):
        numbered = [*chains, *continuing]
        # by the end that another chain may continue, so that those near a chain are looked up
        tips = sorted((_along(chain, sign)[1], k) for k, chain in enumerate(numbered))
        for chain in sorted(weak, key=lambda chain: _along(chain, sign)[0]):
            begin, end = _along(chain, sign)
            first, last = (bisect_left(tips, (station, -1))
                           for station in (begin - CURBS.max_chain_gap - ROUNDING_TOLERANCE, begin + ROUNDING_TOLERANCE))
            if any(0 < begin - tip <= CURBS.max_chain_gap and _in_line(steps, *(numbered[k].steps, chain.steps)[::sign])[0]
                   for tip, k in tips[first:last]):
                insort(tips, (end, len(numbered)))
                numbered.append(chain)
                continuing.append(chain)
        taken = set(map(id, continuing))
        weak = [chain for chain in weak if id(chain) not in taken]
    return continuing


def _along(chain, sign):
    """Begin and end of a chain along the road (1), or against it (-1)."""
    return (chain.start, chain.end) if sign > 0 else (-chain.end, -chain.start)


def select_along_road(chains: Sequence[StepChain], steps: CurbSteps, near: Callable[..., np.ndarray],
                      look: RoadLook | None = None) -> list[tuple[int, float, float]]:
    """Which chain is the curb at every station: the sequence of chains of the highest value, by dynamic programming, and what continues it.

    chains : list of StepChain of one side
    steps : CurbSteps to which they refer
    near : function, station in m -> outward offset of the outermost track on that side, m
    look : RoadLook of the side, None where nothing is known of the ground

    Returns a list of (chain index, first station, last station), in order along the road
    """
    paths = _Paths(chains, steps, near, look)
    cuts = np.unique(np.r_[paths.starts, paths.ends])
    for a, b in zip(cuts[:-1], cuts[1:]):
        check_cancelled()
        paths.lead_on(a, b)
    last = paths.path[int(np.argmax(paths.value))] if len(chains) else None
    selected: list[tuple[int, float, float]] = []
    while last:
        chain, a, b, last = last
        # adjacent intervals of one chain are one
        goes_on = selected and selected[-1][:2] == (chain, b)
        selected.append((chain, a, selected.pop()[2] if goes_on else b))
    return _continued(selected[::-1], chains, steps)


class _Paths:
    """The best path over chains that ends, or last was, on each chain: its value in m of curb, and (chain, first, last station, path before)."""

    def __init__(self, chains, steps, near, look):
        self.chains, self.near, self.look = chains, near, look
        self.places = [(steps.s[c.steps], steps.u[c.steps], steps.h[c.steps]) for c in chains]
        self.tips = np.array([_end_directions(steps, c.steps) for c in chains]).reshape(-1, 2)
        self.method = np.array([c.method for c in chains], np.int64)
        self.methods = len(np.unique(self.method))
        self.starts, self.ends = np.array([c.start for c in chains]), np.array([c.end for c in chains])
        self.value, self.path = np.full(len(chains), -np.inf), [None] * len(chains)
        self.waiting = np.argsort(-self.starts, kind="stable").tolist()   # the next to begin is the last
        self.active: list[int] = []      # chains beside the road at a place, by number, and
        self.continued: list[int] = []   # those that a path ends on which may be continued: few, however long the road is

    def lead_on(self, a, b):
        """From one station to the next, between which no chain begins or ends."""
        self._forget(a)
        while self.waiting and self.starts[self.waiting[-1]] <= a:
            insort(self.active, self.waiting.pop())
        self.active = [c for c in self.active if self.ends[c] >= b]
        members = np.array(self.continued, np.int64)
        positions = np.array([[np.interp(a, self.places[k][0], v) for v in self.places[k][1:]] for k in members]).reshape(-1, 2)
        middle = 0.5 * (a + b)
        offset, near = {c: float(np.interp(middle, *self.places[c][:2])) for c in self.active}, self.near(middle)
        steps = []
        for c in self.active:
            farther = max(offset[c] - near, 0.0)
            gain = (b - a) * max(1.0 - CURBS.distance_penalty * farther, 0.1)
            # what all chains of one curb show of it: does any show it clearly, and which share of the methods see it? And how sharply this one does
            of_curb = [k for k in self.active if abs(offset[k] - offset[c]) <= CURBS.same_curb_distance]
            gain *= CURBS.faint_gain if all(self.chains[k].faint for k in of_curb) else 1.0
            gain *= len({self.method[k] for k in of_curb}) / self.methods * max(1.0 - self.chains[c].scatter / CURBS.link_tolerance, 0.1)
            best, before = self._before(c, a, members, positions)
            steps.append((c, best + gain, (int(c), float(a), float(b), before)))
        for c, value, step in steps:
            self.value[c], self.path[c] = value, step
        self.continued = sorted({*self.continued, *self.active})

    def _forget(self, a):
        """Of the chains that ended long ago the best alone is continued."""
        old = [k for k in self.continued if self.ends[k] + CURBS.tracking_memory < a]
        best = max(self.value[old], default=-np.inf)
        self.value[[k for k in old if self.value[k] < best]] = -np.inf
        self.continued = [k for k in self.continued if np.isfinite(self.value[k])]

    def _before(self, c, a, known, at):
        """The best path that chain c may continue from station a on, and its value; 0 where a path begins here."""
        u, h = (np.interp(a, self.places[c][0], v) for v in self.places[c][1:])
        gap = np.maximum(a - self.ends[known], 0.0)
        # a gap is crossed in the mean direction of the end before and the start after it
        turn = np.minimum(gap, CURBS.max_extrapolation) * 0.5 * (self.tips[known, 1] + (self.tips[c, 0] if a <= self.starts[c] else 0.0))
        jump = np.maximum(np.abs(u - at[:, 0] - np.where(gap > 0, turn, 0.0)) - 0.05 - 0.1 * gap, 0.0)
        climb = np.maximum(np.abs(h - at[:, 1]) - 0.03 - 0.003 * gap, 0.0)
        cost = CURBS.jump_cost * jump + CURBS.climb_cost * climb
        costly = np.flatnonzero((jump > 0.0) & (known != c))
        if self.look is not None and len(costly):
            cost[costly] = np.fmin(cost[costly], self._across_the_road(np.minimum(a, self.ends[known[costly]]), *at[costly].T, a, u, h,
                                                                       gap[costly], jump[costly]))
        cost = np.where(known == c, 0.0, np.minimum(cost, CURBS.max_jump_cost))
        # beside the end of one method's chain another method goes on only where that is worth the change
        cost[(self.method[known] != self.method[c]) & (gap <= CURBS.max_link_length)] += CURBS.method_change_cost
        total = self.value[known] - cost
        if not len(known) or total.max() < 0.0:
            return 0.0, None
        k = int(np.argmax(total))
        return total[k], self.path[known[k]]

    def _across_the_road(self, s, u, h, end_s, end_u, end_h, gap, jump):
        """(N,) costs of going on from (N,) places to another one over ground that is road all the way, infinite where it is not.

        The road's own crossfall is no climb.
        """
        foot = np.array(CURBS.road_before_curb[1])   # on the road before the curb
        level = self.look.level_to(s, u - foot, end_s, end_u - foot)
        above, end_above = h - self.look.road_height(s, u - foot), end_h - self.look.road_height(np.array(end_s), end_u - foot)
        climb = np.maximum(np.abs(end_above - above) - 0.03 - 0.003 * gap, 0.0)
        return np.where(level, CURBS.level_jump_cost * jump + CURBS.climb_cost * climb, np.inf)


def _continued(selected, chains, steps):
    """The selection with the chains that go on from a selected one where nothing else was selected.

    To the selection a long gap allows a larger jump: that a curb goes on before the jump must not speak against the curb.
    """
    free = sorted({*range(len(chains))} - {chain for chain, _, _ in selected}, key=lambda k: (chains[k].start, k))
    for sign in (1, -1):
        for number in free[::sign]:
            chain = chains[number]
            position = bisect_left([start for _, start, _ in selected], chain.start)
            if any(a < chain.end and b > chain.start for _, a, b in selected[max(position - 1, 0):position + 1]):
                continue
            parts = selected[position - 1:position] if sign > 0 else selected[position:position + 1]
            if parts and _goes_on(steps, chains, parts[0], chain, sign):
                selected.insert(position, (number, chain.start, chain.end))
    return selected


def _goes_on(steps, chains, part, chain, sign):
    """Does a chain continue a selected interval, along the road (1) or against it (-1), and keep to its offset?"""
    number, a, b = part
    members = _between(steps, chains[number].steps, a, b)
    if not len(members) or np.abs(steps.u[chain.steps] - steps.u[members[::sign][-1]]).max() > CURBS.max_steady_jump:
        return False
    return any(_in_line(steps, *(members, chain.steps)[::sign]))


def drop_short_curbs(selected: Sequence[tuple[int, float, float]], chains: Sequence[StepChain],
                     steps: CurbSteps) -> list[tuple[int, float, float]]:
    """Selected intervals that make a curb: intervals in line with each other cover CURBS.min_curb_length together, faint ones CURBS.min_faint_length.

    A curb between parked cars is seen in pieces; a piece with nothing in line with it may be anything. A piece farther away, up to
    CURBS.max_steady_gap, belongs to what is a curb by itself. A short piece that is much higher than all curb about it is a thing at the curb.

    selected : result of `select_along_road`
    steps : CurbSteps to which they refer

    Returns list like `selected`
    """
    selected = _without_things_at_the_curb(selected, chains, steps)
    members = [_between(steps, chains[chain].steps, a, b) for chain, a, b in selected]
    group, steady = np.zeros(len(selected), int), np.zeros(len(selected), bool)
    for k in range(1, len(selected)):
        near, steady[k] = _in_line(steps, members[k - 1], members[k])
        group[k] = group[k - 1] + (not near)
    length = np.bincount(group, [b - a for _, a, b in selected])
    upright = np.bincount(group, [not chains[chain].faint for chain, _, _ in selected]) > 0
    curb = length >= np.where(upright, CURBS.min_curb_length, CURBS.min_faint_length)
    # from one group to the next, along the road and back
    for order in (range(1, len(selected)), range(len(selected) - 1, 0, -1)):
        for k in order:
            if steady[k] and curb[group[k - 1]] != curb[group[k]]:
                curb[group[k - 1:k + 1]] = True
    return [part for part, number in zip(selected, group) if curb[number]]


def _without_things_at_the_curb(selected, chains, steps):
    """The selected intervals but for short ones that are much higher than all curb within CURBS.line_fit_length before and behind them."""
    height = np.array([median(steps.height[_between(steps, chains[chain].steps, a, b)]) for chain, a, b in selected])
    start, end = np.array([part[1:] for part in selected]).reshape(-1, 2).T

    def is_thing(k):
        before = height[:k][end[:k] > start[k] - CURBS.line_fit_length]
        behind = height[k + 1:][start[k + 1:] < end[k] + CURBS.line_fit_length]
        return len(before) and len(behind) and height[k] > CURBS.max_height_ratio * max(before.max(), behind.max())

    return [part for k, part in enumerate(selected) if end[k] - start[k] >= CURBS.min_curb_length or not is_thing(k)]


def _in_line(steps, before, after):
    """Does one run of steps continue the other a short gap away, and does it do so steadily a longer one away?"""
    a, b = before[-1], after[0]
    gap = steps.s[b] - steps.s[a]
    turn = min(gap, CURBS.max_extrapolation) * 0.5 * (_end_directions(steps, before)[1] + _end_directions(steps, after)[0])
    jump, level = abs(steps.u[b] - steps.u[a] - turn), abs(steps.h[b] - steps.h[a]) <= CURBS.height_tolerance + 0.02 * gap
    return level and gap <= CURBS.max_chain_gap and jump <= 0.15 + 0.15 * gap, level and gap <= CURBS.max_steady_gap and jump <= CURBS.max_steady_jump


def _end_directions(steps, members):
    """Directions in which a run of steps begins and ends, m outward per m along, of its CURBS.end_direction_steps outermost steps."""
    directions = []
    for tip in (members[:CURBS.end_direction_steps], members[-CURBS.end_direction_steps:]):
        ds = steps.s[tip] - steps.s[tip].mean()
        directions.append(float(ds @ steps.u[tip] / (ds @ ds + 0.05)))
    return directions


def _chain_scatter(s, u):
    """Median distance of the steps of a chain from the chord of their neighbours, m; 0 where there are two."""
    if len(s) < 3:
        return 0.0
    f = (s[1:-1] - s[:-2]) / np.maximum(s[2:] - s[:-2], 1e-6)
    return np.median(np.abs(u[1:-1] - u[:-2] - f * (u[2:] - u[:-2])))


# Short pieces of curb in line with the curb before and after them.
#
# A short piece of curb may be anything where it stands alone. Between two stretches of curb that were chosen already, a piece of their height that
# lies on the smooth line through both is the same curb, seen between what hides the rest of it, such as a row of parked cars. Its steps are taken
# one by one, upright or sloped, linked with each other or not: which of them were linked to a chain depends on a millimetre. It may scatter more than
# a curb that nothing else speaks for.


def with_pieces_in_line(kept: Sequence[tuple[int, float, float]], chains: Sequence[StepChain], steps: CurbSteps,
                        to_plan: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]], first: Sequence[int] = ()) -> list[np.ndarray]:
    """The steps of the chosen intervals and, between them, the pieces of curb that lie in their line.

    kept : result of `drop_short_curbs`
    steps : CurbSteps to which they refer, method by method
    to_plan : function, stations and outward offsets in m -> x and y in m
    first : numbers of the first step of each method but the first one

    Returns a list of (K,) indices into the steps, by station, one for every interval and piece, in order along the road
    """
    pieces = [_between(steps, chains[chain].steps, a - 1e-9, b + 1e-9) for chain, a, b in kept]
    if not pieces:
        return []
    # by station, so that those between two stations are looked up
    chosen, *of_methods = (rows[np.argsort(steps.s[rows], kind="stable")]
                           for rows in (np.concatenate(pieces), *np.split(np.arange(len(steps)), first)))
    stations, *stations_of_methods = (steps.s[rows] for rows in (chosen, *of_methods))
    for (_, _, a), (_, b, _) in zip(kept[:-1], kept[1:]):
        if not CURBS.max_link_length < b - a <= CURBS.max_line_gap:
            continue
        check_cancelled()
        before, after = (steps[chosen[stretch_of(stations, *ends)]]
                         for ends in ((a - CURBS.line_fit_length, a + 1e-9), (b - 1e-9, b + CURBS.line_fit_length)))
        gap = before.s.max() + 1e-6, after.s.min() - 1e-6
        in_line = [piece for rows, s in zip(of_methods, stations_of_methods)
                   for piece in pieces_between(before, after, steps, rows[stretch_of(s, *gap)], to_plan)]
        # of pieces beside each other the one nearest to the line
        nearest: list[np.ndarray] = []
        for _, piece in sorted(in_line, key=lambda off_and_piece: off_and_piece[0]):
            if all(steps.s[piece[-1]] < steps.s[other[0]] or steps.s[piece[0]] > steps.s[other[-1]] for other in nearest):
                nearest.append(piece)
        pieces += nearest
    return sorted(pieces, key=lambda members: float(steps.s[members[0]]))


def _between(steps, members, start, end):
    return members[(steps.s[members] >= start) & (steps.s[members] <= end)]


def pieces_between(before: CurbSteps, after: CurbSteps, steps: CurbSteps, rows: np.ndarray,
                   to_plan: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]) -> list[tuple[float, np.ndarray]]:
    """The pieces of curb on the line between two runs of curb.

    before, after : CurbSteps on both sides of the gap, or any rows with `s`, `u`, `h` and `height`; not empty
    steps, rows : CurbSteps, and (N,) indices, by station, of those that lie between
    to_plan : function, stations and outward offsets in m -> x and y in m

    Returns m, greatest distance from the line, and (K,) indices of the steps, by station, of each piece
    """
    a, b = before.s.max(), after.s.min()
    if len(rows) < CURBS.min_piece_steps:
        return []
    line = GapLine(np.array(to_plan(before.s, before.u)), np.array(to_plan(after.s, after.u)))
    (s0, h0, height0), (s1, h1, height1) = ([median(v) for v in (end.s, end.h, end.height)] for end in (before, after))
    s = steps.s[rows]
    share = (s - s0) / (s1 - s0)
    off = line.off(*to_plan(s, steps.u[rows]))
    up, from_end = np.abs(steps.h[rows] - h0 - share * (h1 - h0)), np.minimum(s - a, b - s)
    across = np.minimum(CURBS.in_line_at_end + CURBS.in_line_drift * from_end, CURBS.in_line_across)
    near = np.flatnonzero((np.abs(off) <= across) & (up <= CURBS.height_tolerance + CURBS.in_line_grade * from_end))
    if not len(near):
        return []
    # of the steps on one profile the one nearest to the line
    near = near[np.lexsort((np.abs(off[near]), steps.profile[rows[near]]))]
    near = near[np.r_[True, np.diff(steps.profile[rows[near]]) > 0]]
    parted = (np.diff(s[near]) > CURBS.max_link_length) | (np.abs(np.diff(off[near])) > CURBS.link_tolerance)
    runs = np.split(near, np.flatnonzero(parted) + 1)
    return [(float(np.abs(off[run]).max()), rows[run]) for run in runs
            if len(run) >= CURBS.min_piece_steps and np.ptp(s[run]) >= CURBS.min_piece_length
            and _is_curb(steps[rows[run]], off[run], across[run].min(), height0 + share[run] * (height1 - height0))]


def _is_curb(piece, off, across, height):
    """Is a run of steps near a line a piece of the curb of that line? `off` : m, from the line; `across` : m that it may lead away from it."""
    ratio = median(piece.height / height)
    s = piece.s - piece.s.mean()
    turn = s @ off / (s @ s)
    return bool(1 / CURBS.max_height_ratio <= ratio <= CURBS.max_height_ratio and abs(turn) * np.ptp(s) <= across
                and is_clean(median(piece.noise), median(piece.scanner_noise), piece.behind, np.std(off - turn * s)))


class GapLine:
    """A polynomial in plan across a gap.

    before, after : (2, N) and (2, M) m, x and y of the curb on both sides of the gap, in order; those within CURBS.line_fit_length of it are used
    max_degree : greatest degree; 2 is an even bend

    miss : m, greatest distance of the places that were used from the line
    """

    def __init__(self, before: np.ndarray, after: np.ndarray, max_degree: int = 3):
        ends, weights = [], []
        for part, tip in ((before, before[:, -1:]), (after, after[:, :1])):
            distance = np.hypot(*(part - tip))
            near = distance <= CURBS.line_fit_length
            ends.append(part[:, near])
            # both ends count alike, however many points each has, and near places more than far ones
            weight = 1.0 / (1.0 + (distance[near] / CURBS.weight_length) ** 2)
            weights.append(weight / weight.sum())
        points, (first, last) = np.concatenate(ends, axis=1), (end.mean(1) for end in ends)
        self.origin, self.along = first, (last - first) / max(np.hypot(*(last - first)), 1e-9)
        degree = 1 + sum(np.hypot(*(end[:, -1] - end[:, 0])) >= CURBS.min_bend_length for end in ends)
        t, v = self.place(*points)
        self.ends = np.c_[before[:, -1], after[:, 0]]
        self.line = Polynomial.fit(t, v, min(degree, max_degree), w=np.sqrt(np.concatenate(weights)))
        self.miss = float(np.abs(v - self.line(t)).max())

    def place(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(N,) m along the chord and left of it."""
        dx, dy = x - self.origin[0], y - self.origin[1]
        return dx * self.along[0] + dy * self.along[1], dy * self.along[0] - dx * self.along[1]

    def between(self, spacing: float) -> np.ndarray:
        """(2, N) m, x and y of places in the gap about so far apart on the line, moved to the places next to the gap."""
        t, off = self.place(*self.ends)[0], self.off(*self.ends)
        inner = np.linspace(t[0], t[1], max(int(np.ceil((t[1] - t[0]) / spacing)), 1) + 1)[1:-1]
        v = self.line(inner) + np.interp(inner, t, off)
        return self.origin[:, None] + np.array([inner * self.along[0] - v * self.along[1], inner * self.along[1] + v * self.along[0]])

    def off(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(N,) m from the line, left positive."""
        t, v = self.place(x, y)
        return v - self.line(t)


def line_across(points: np.ndarray, s: np.ndarray, k: int, max_degree: int = 2) -> tuple[float, GapLine | None, str]:
    """The even bend that leads best across a gap, which begins at point k, on the map or as seen from the road.

    points : (N,) structured array of curb points, by station, with the fields x, y, s and d in m
    s : (N,) m, their stations
    max_degree : 1 of a straight line, 2 of an even bend

    Returns
        turn : radians that the curb on both sides turns off it
        line : GapLine, None where too little of the curb is seen
        axes : "xy" or "sd", the fields that are its axes

    Where a bend begins or ends behind a row of parked cars no even bend leads through both sides; the road itself bends there alike.
    A bay is only as long as the cars in it: its curb turns aside next to the gap, and where the last ten metres are not in one line the last
    three tell where it leads.
    """
    best: tuple[float, GapLine | None, str] = np.inf, None, ""
    for reach in (CURBS.line_fit_length, CURBS.min_bend_length):
        if best[0] <= IN_LINE_TURN:
            break
        parts = points[stretch_of(s, s[k] - reach, s[k])], points[stretch_of(s, s[k + 1], s[k + 1] + reach)]
        if reach == CURBS.line_fit_length and max(np.ptp(part["s"]) for part in parts) < CURBS.min_bend_length:
            break
        for axes in ("xy", "sd"):
            before, behind = (np.array([part[axis] for axis in axes]) for part in parts)
            line = GapLine(before, behind, max_degree)
            best = min(best, (line.miss / reach, line, axes), key=lambda fitted: fitted[0])
    return best


def is_lowered(points: np.ndarray, s: np.ndarray) -> np.ndarray:
    """(N,) bool, is the curb at a point much lower than before it and behind it?

    points : (N,) structured array, by station, with the field `height` (m); s : (N,) m, their stations
    """
    low = (points["height"] > 0.0) & (points["height"] <= EDGE.lowered_share * points["height"].max(initial=0.0))
    for k in np.flatnonzero(low):
        before, behind = (points["height"][stretch_of(s, *ends)].max()
                          for ends in ((s[k] - CURBS.line_fit_length, s[k]), (s[k], s[k] + CURBS.line_fit_length)))
        low[k] = points["height"][k] <= EDGE.lowered_share * min(before, behind)
    return low


def without_outliers(points: np.ndarray) -> np.ndarray:
    """Points near the running median of the offsets of their chain.

    points : (N,) structured array, by station, with the fields `chain`, `s` and `d` (m)

    Returns (K,) of the same type
    """
    inliers = np.ones(len(points), bool)
    order = np.argsort(points["chain"], kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(points["chain"][order])) + 1):
        if len(rows) < 5:
            continue
        s, d = points["s"][rows], points["d"][rows]
        spacing = np.median(np.diff(s))
        window = int(np.clip(2 * round(0.5 * EDGE.median_window / max(spacing, 0.05)) + 1, 3, len(rows) | 1))
        # an edge that changes direction is no outlier: its own running direction is subtracted first
        direction = median_filter(np.diff(d) / np.maximum(np.diff(s), 0.05), window, mode="nearest")
        off = d - np.r_[0.0, np.cumsum(direction * np.diff(s))]
        deviation = np.abs(off - median_filter(off, window, mode="nearest"))
        limit = max(EDGE.outlier_mads * MAD_TO_SIGMA * np.median(deviation), EDGE.outlier_floor)
        inliers[rows] = deviation <= limit
    return points[inliers]
