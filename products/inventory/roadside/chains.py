"""Uprights that repeat along the road at a steady offset and height, as chains; what stands in their gaps, and of what kind they are."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from ....core.common.arrays import Rows, linked_groups, members_of
from .uprights import BEHIND, FIRST_BIN, HEIGHT_BIN, SIGHT_MARGIN, TALL, TOP_BIN, UPRIGHT_SLICE, Uprights

STEADY_OFFSET, STEADY_PER_SLICE = 0.30, 0.02   # m across from one slice to a later one, and more for each slice between
HEWN, STEADY_TALL = 1.8, 1.00           # m: what is higher may be rock, which is hewn, not built; m across from one slice to the next
SAME_TOP = 0.35                         # m of height of the tops above the ground, which may be hidden, or of their level
MIN_CHAIN_FILLED = 0.8                  # share of the slices of a chain, but for hidden ones, that hold an upright of it
MIN_PIECE = 3                           # uprights before and after a hidden gap
MAX_HIDDEN = 12.0                       # m along the road that vehicles hide: a lorry, or two cars
SMOOTHED_SLICES = 9                     # over which offsets and heights of a chain are smoothed (median)


@dataclass(frozen=True)
class Chain:
    """Uprights of one line along a road, in order of station."""

    road: int   # road, side: number; 1 left, -1 right
    side: int
    members: Uprights
    d: np.ndarray   # d, ground, top: (N,) m, smoothed
    ground: np.ndarray
    top: np.ndarray
    empty: np.ndarray   # (N,) number of slices after each of them, before the next, that show what lies beyond the line

    @property
    def s(self) -> np.ndarray:
        """(N,) stations, m."""
        return (self.members.slice + 0.5) * UPRIGHT_SLICE

    @property
    def length(self) -> float:
        """m along the road"""
        return float(self.members.slice[-1] - self.members.slice[0] + 1) * UPRIGHT_SLICE

    @property
    def wobble(self) -> float:
        """m, median distance of its uprights from the smoothed line across"""
        return float(np.median(np.abs(self.members.d - self.d)))

    @property
    def roughness(self) -> float:
        """m, median distance of its uprights across from the middle between the two beside them: 0 where it is straight from kink to kink"""
        d = self.members.d
        return float(np.median(np.abs(d[1:-1] - 0.5 * (d[:-2] + d[2:])))) if len(d) > 2 else 0.0

    def part(self, rows: np.ndarray) -> Chain:
        """The Chain of some of its uprights."""
        return replace(self, members=self.members[rows], d=self.d[rows], ground=self.ground[rows], top=self.top[rows], empty=self.empty[rows])

    def pieces(self) -> list[tuple[str, Chain]]:
        """Its measured pieces and, between them, of status bridged and from the last upright before to the first after it, what was not seen of it;
        where it is seen to be open there is none."""
        gaps = np.flatnonzero(np.diff(self.members.slice) > TOLD_GAP)
        pieces = []
        for first, last in zip([0, *(gaps + 1)], [*gaps, len(self.d) - 1]):
            pieces.append(("measured", self.part(np.arange(first, last + 1))))
            if last < len(self.d) - 1 and self.empty[last] < TOLD_GAP:
                pieces.append(("bridged", self.part(np.arange(last, last + 2))))
        return pieces


def find_chains(uprights: Uprights, road: int, side: int, max_gap: float, min_length: float,
                look: Callable[[Gaps], Gaps] | None = None) -> list[Chain]:
    """Chains, no shorter than `min_length` m, of the uprights on one side of a road, which are sorted by slice and offset.

    look : gives gaps with what was seen in them; without it nothing is bridged beyond `max_gap` m
    """
    if len(uprights) < 2:
        return []
    reach = max(int(round(max_gap / UPRIGHT_SLICE)), 1)
    pairs = _linked(uprights, uprights, range(1, reach + 1))
    hidden, empty = np.zeros((2, len(uprights)), np.int64)
    if look is not None:
        gaps = _gaps(uprights, list(_groups(uprights, pairs)), range(reach + 1, int(round(MAX_HIDDEN / UPRIGHT_SLICE)) + 1))
        gaps = look(gaps) if len(gaps) else gaps
        slices = gaps.last - gaps.first + 1
        gaps = gaps[(slices < reach) | (gaps.empty < TOLD_GAP) & (gaps.hidden >= MIN_HIDDEN * slices)]
        hidden[gaps.before], empty[gaps.before] = gaps.hidden, gaps.empty
        pairs = np.concatenate([pairs, np.c_[gaps.before, gaps.after]])
    chains = []
    for rows in _groups(uprights, pairs):
        for kept in _filled(rows, uprights.slice[rows], hidden[rows], empty[rows], min_length):
            members = uprights[kept]
            chains.append(Chain(road, side, members, *along_the_chain(members), empty[kept]))
    return chains


def along_the_chain(members: Uprights) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Offsets, ground and tops of a chain's uprights, (N,) m each, smoothed along it."""
    d, ground, top = (median_filter(values, SMOOTHED_SLICES, mode="nearest") for values in (members.d, members.ground, members.top))
    return d, ground, top


def _groups(uprights, pairs):
    """Rows of the uprights that hang together, in order of station."""
    return (rows for _, rows in members_of(linked_groups(pairs[:, 0], pairs[:, 1], len(uprights))))


def _gaps(uprights, groups, lags):
    """Gaps within groups of uprights, and those to other groups that follow so many slices later in line with them."""
    ends, begins = [], []
    for rows in groups:
        for k in np.flatnonzero(np.diff(uprights.slice[rows]) > 1).tolist():
            ends.append(rows[max(k + 1 - END_UPRIGHTS, 0):k + 1])
            begins.append(rows[k + 1:k + 1 + END_UPRIGHTS])
    long = [rows for rows in groups if len(rows) >= MIN_PIECE]
    if long:
        last, first = ([rows[part] for rows in long] for part in (slice(-END_UPRIGHTS, None), slice(END_UPRIGHTS)))
        starts = _middles(uprights, first, 0)
        order = np.lexsort((starts.d, starts.slice))
        before, after = _linked(_middles(uprights, last, -1), starts[order], lags).T
        ends += [last[k] for k in before]
        begins += [first[k] for k in order[after]]
    return _gaps_between(uprights, ends, begins)


def _middles(uprights, rows, place):
    """Uprights at one end of pieces, with the median offset and heights of the last ones there."""
    ends = uprights[np.array([members[place] for members in rows])]
    ends.d, ends.ground, ends.top = (np.array([np.median(values[members]) for members in rows])
                                     for values in (uprights.d, uprights.ground, uprights.top))
    return ends


def _filled(rows, slices, hidden, empty, min_length):
    """Those rows of a chain, or of its parts between openings, that fill what was seen of it."""
    count = int(slices[-1] - slices[0] + 1)
    visible = count - int(hidden[:-1].sum())
    if count * UPRIGHT_SLICE >= min_length and len(rows) >= MIN_CHAIN_FILLED * max(visible, min_length / UPRIGHT_SLICE):
        return [rows]
    cuts = np.flatnonzero(empty[:-1] >= TOLD_GAP) + 1
    if not len(cuts):
        return []
    parts = zip(*(np.split(values, cuts) for values in (rows, slices, hidden, empty)))
    return [kept for part in parts for kept in _filled(*part, min_length)]


def _linked(ends, begins, lags):
    """(P, 2) pairs of uprights of which the second follows the first so many slices later, each with one successor and one predecessor at most;
    `begins` in order of slice and offset."""
    key = begins.slice * 1e4 + begins.d
    taken_next, taken_before = np.zeros(len(ends), bool), np.zeros(len(begins), bool)
    pairs = [np.empty((0, 2), np.int64)]
    for lag in lags:
        before = np.flatnonzero(~taken_next)
        wanted = (ends.slice[before] + lag) * 1e4 + ends.d[before]
        right = np.clip(np.searchsorted(key, wanted), 0, len(key) - 1)
        left = np.maximum(right - 1, 0)
        after = np.where(np.abs(key[left] - wanted) <= np.abs(key[right] - wanted), left, right)
        apart = np.abs(key[after] - wanted)
        lower, higher = np.minimum(ends.top[before], begins.top[after]), np.maximum(ends.top[before], begins.top[after])
        level = np.abs(begins.top[after] + begins.ground[after] - ends.top[before] - ends.ground[before])
        steady = (apart < STEADY_OFFSET + STEADY_PER_SLICE * (lag - 1)) & (np.minimum(higher - lower, level) < SAME_TOP)
        fits = np.where(lower > HEWN, apart < STEADY_TALL, steady)
        fits &= (begins.slice[after] == ends.slice[before] + lag) & ~taken_before[after]
        before, after, apart = before[fits], after[fits], apart[fits]
        # of several that want the same successor the nearest has it
        order = np.lexsort((apart, after))
        first = np.r_[True, np.diff(after[order]) > 0] if len(order) else np.empty(0, bool)
        before, after = before[order][first], after[order][first]
        taken_next[before], taken_before[after] = True, True
        pairs.append(np.c_[before, after])
    return np.concatenate(pairs)


# What was seen in the gaps of a line beside the road: a vehicle hides what stands behind it, through a gate one sees what lies beyond.

TOLD_GAP = 3             # slices (1.5 m) without an upright of a gap that is told; shorter ones belong to the line
END_UPRIGHTS = 3         # at the end of a piece, whose median offset and heights count
MIN_PASSED = 3           # pulses seen through a slice of a gap, from which it may be open
EXPECTED, FEWER = 10.0, 0.25  # pulses that would have met the thing there, from which it is open where at most this share did
MIN_STOPPED = 3          # pulses that something before it stopped, from which a slice is hidden
MIN_HIDDEN = 0.8         # share of the slices of a gap that are hidden, where no opening is
SIGHT_REACH = 12.0       # m along the road from a gap of points whose line of sight may pass it: planes of scanners are turned by 45 degrees


@dataclass
class Gaps(Rows):
    """G gaps between two uprights of what may be one line.

    d, low, high : (G, 2) m, offset and heights of the lower and upper end of the line before and after the gap; local z, or above the road
    """

    before: np.ndarray   # before, after: (G,) int, rows of the uprights
    after: np.ndarray
    first: np.ndarray   # first, last: (G,) int, the first and the last slice without one
    last: np.ndarray
    d: np.ndarray
    low: np.ndarray
    high: np.ndarray
    share: np.ndarray   # (G,) share of the pulses that reach the line which it stops
    empty: np.ndarray   # (G,) number of slices that show what lies beyond
    hidden: np.ndarray   # (G,) number of slices that something before the line hides


def _gaps_between(uprights: Uprights, ends: list[np.ndarray], begins: list[np.ndarray]) -> Gaps:
    """Gaps between pieces of lines."""
    sides = [[_end(uprights[rows]) for rows in pieces] for pieces in (ends, begins)]
    d, low, high, points, behind = np.array(sides, float).reshape(2, len(ends), 5).transpose(2, 1, 0)
    before, after = (np.array([rows[k] for rows in pieces], np.int64) for pieces, k in ((ends, -1), (begins, 0)))
    points, behind = points.sum(axis=1), behind.sum(axis=1)
    none = np.zeros(len(ends), np.int64)
    return Gaps(before, after, uprights.slice[before] + 1, uprights.slice[after] - 1, d, low, high, points / np.maximum(points + behind, 1.0),
                none, none)


def _end(uprights):
    top = float(np.median(uprights.ground + uprights.top))
    low = float(np.median(uprights.ground)) + FIRST_BIN * HEIGHT_BIN
    return float(np.median(uprights.d)), low, top - SIGHT_MARGIN, uprights.points.sum(), uprights.behind.sum()


def gaps_by_window(gaps: Gaps, length: float) -> dict[int, list[int]]:
    """Rows of the gaps of which the points of windows may tell, by the number of the window, of a length in m, counted from station 0."""
    first, last = (gaps.first - 1) * UPRIGHT_SLICE - SIGHT_REACH, (gaps.last + 2) * UPRIGHT_SLICE + SIGHT_REACH
    result: dict[int, list[int]] = {}
    for k, (a, b) in enumerate(zip(first // length, last // length)):
        for window in range(int(a), int(b) + 1):
            result.setdefault(window, []).append(k)
    return result


def pulses_at(gaps: Gaps, side: int, s: np.ndarray, d: np.ndarray, h: np.ndarray, across: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Pulses that reached the places of gaps on one side of a road, or would have.

    s, d, h : (N,) m, station (rising), offset and height of points of that side, which count as those of the gaps
    across : (2, N) m from the point to the scanner, ahead and left along the road
    up : (N,) m that the scanner is higher above the road
    Returns (3, K) pulses that passed each slice of all gaps, one after the other, that met something there, and that something before it stopped
    """
    length = gaps.last - gaps.first + 1
    start = np.cumsum(length) - length
    counts = np.zeros((3, int(length.sum())), np.int64)
    for k in range(len(gaps)):
        s0, s1 = (gaps.first[k] - 0.5) * UPRIGHT_SLICE, (gaps.last[k] + 1.5) * UPRIGHT_SLICE
        near = slice(*np.searchsorted(s, (s0 - SIGHT_REACH, s1 + SIGHT_REACH)))
        ds, dd = s1 - s0, float(gaps.d[k, 1] - gaps.d[k, 0])
        ahead, left = across[:, near]
        cross = (s[near] - s0) * dd - (d[near] - gaps.d[k, 0]) * ds
        with np.errstate(divide="ignore", invalid="ignore"):
            part = -cross / (ahead * dd - left * ds)   # of the way from the point to the scanner, where it crosses the line
        station = s[near] + part * ahead
        row = np.floor(station / UPRIGHT_SLICE)
        share = (station - s0) / ds
        height = h[near] + part * up[near]
        low, high = (ends[k, 0] + share * (ends[k, 1] - ends[k, 0]) for ends in (gaps.low, gaps.high))
        inside = (row >= gaps.first[k]) & (row <= gaps.last[k]) & (height > low) & (height < high)
        beyond = -side * cross / np.hypot(ds, dd)
        for kind, mask in enumerate(((beyond > BEHIND[0]) & (part < 1.0), np.abs(beyond) <= BEHIND[0], (beyond < -BEHIND[0]) & (part < 0.0))):
            slices = row[inside & mask].astype(np.int64) - gaps.first[k]
            counts[kind, start[k]:start[k] + length[k]] += np.bincount(slices, minlength=length[k])
    return counts


def judged(gaps: Gaps, parts: Iterable[tuple[list[int], np.ndarray]]) -> Gaps:
    """Gaps with what pulses tell of them: `parts` are rows of some of the gaps, and their pulses as `pulses_at` counts them."""
    length = gaps.last - gaps.first + 1
    owner = np.repeat(np.arange(len(gaps)), length)
    start = np.cumsum(length) - length
    passed, met, stopped = counts = np.zeros((3, len(owner)), np.int64)
    for rows, pulses in parts:
        counts[:, np.concatenate([start[k] + np.arange(length[k]) for k in rows])] += pulses
    odds = np.clip(gaps.share, 0.05, 0.95)[owner]
    expected = passed * odds / (1.0 - odds)
    empty = (passed >= MIN_PASSED) & (expected >= EXPECTED) & (met < FEWER * expected)
    hidden = ~empty & (stopped >= MIN_STOPPED)
    return replace(gaps, empty=np.bincount(owner[empty], minlength=len(gaps)), hidden=np.bincount(owner[hidden], minlength=len(gaps)))


# What a line beside the road is, told by its section.

BUILDING_TOP, LOW_ROCK = 4.2, 0.25  # m: what rises higher is a building; share of a rock face, whose top goes up and down, that does not
RAIL_TOP = 0.55, 1.15        # m: tops of guard rails, with tolerance for the ground (EN 1317 systems: 0.70 to 1.00 m)
BEAM = 0.20, 0.40            # m below the top: to the first a beam fills everything, before the second it ends (EN 1317: 0.31 m, W beam)
BEAM_GAP = 0.35              # of the points of the beam, what fewer remain in a free bin below it: posts
FREE_BELOW = 0.45            # share of the height that is free below ropes or pipes of a rail
BARRIER_TOP = 0.6, 1.35      # m: tops of concrete barriers
MIN_BATTER = 0.08            # m per m by which the face of a barrier leans back
BARRIER_DEPTH = 0.30         # m of thickness of its face at most
OPEN_HEDGE = 1.0             # points seen behind, for each on it, from which a rough thing is no hedge
OPEN_FENCE = 0.45                  # points seen behind, for each on it, from which it is a fence whatever its section
SEEN_THROUGH = 0.12          # the same, from which a thin thing is no wall
SEEN_THROUGH_TALL = 0.3      # the same of what is TALL: rock stands back here and there
SCATTERED = 8.0                # the same, from which there is nothing but scattered points
THICK_HEDGE, ROUGH_HEDGE = 0.08, 0.015  # m of thickness, and across from one point to the next higher one, from which a solid line is a hedge:
#                              the face of a wall is plane, that of a fence on a wall is plane and thick
THIN_LINE = 0.20                  # m of thickness of rails and fences at most
MAX_BATTER = 0.35            # m per m: more is an embankment
MIN_UPRIGHT_POINTS = 5, 3    # on an upright, median; on one of a straight line
STRAIGHT_LINE = 0.02         # m of roughness of such a line
MAX_WOBBLE = 0.06            # m, of everything that is built
STEADY_TOP, STEADY_SHARE = 0.30, 0.75  # m of change of the top over a car's half length, kept by this share: cars go up and down more
CAR_HALF = 4                 # slices
MAX_EMPTY = 0.08             # share of a line's length that is open in short gaps: a row of cars has as many of them as cars
LEAST_MEASURED = 0.3         # share of its length that was measured


def kind_of(chain: Chain) -> str | None:
    """guard_rail, barrier, wall, fence or hedge; None for what is none of them, or may be none: buildings, rows of parked cars, embankments."""
    members = chain.members
    top = float(np.median(chain.top))
    tall = top > TALL
    batter, thickness = float(np.median(members.batter)), float(np.median(members.thickness))
    through = float(members.behind.sum() / max(members.points.sum(), 1.0))
    if np.median(members.points) < MIN_UPRIGHT_POINTS[chain.roughness < STRAIGHT_LINE] or members.above_view.mean() > 0.5:
        return None
    if _is_row(chain):
        return None
    if np.quantile(chain.top, LOW_ROCK) > BUILDING_TOP or abs(batter) > MAX_BATTER or through > SCATTERED or not tall and _restless(members.top):
        return None
    if tall:
        return "wall" if through < SEEN_THROUGH_TALL else None
    built = chain.wobble < MAX_WOBBLE
    # the beams of a rail are straight: in a bend its line has a kink at every post or so
    if (built or chain.roughness < MAX_WOBBLE) and thickness < THIN_LINE and RAIL_TOP[0] < top < RAIL_TOP[1] and _is_rail(members, top, through):
        return "guard_rail"
    if built and BARRIER_TOP[0] < top < BARRIER_TOP[1] and batter > MIN_BATTER and thickness < BARRIER_DEPTH and through < SEEN_THROUGH:
        return "barrier"
    if thickness > THICK_HEDGE and np.median(members.rough) > ROUGH_HEDGE and through < OPEN_HEDGE:
        return "hedge"
    if not built or through > OPEN_FENCE and thickness > THIN_LINE:
        return None
    return "fence" if through > SEEN_THROUGH else "wall"


def _is_rail(members, top, through):
    """Whether there is a beam with free height below, above the ground or another beam, or ropes that leave much of the height free."""
    points = members.below_top.sum(axis=0)
    beam, end = (int(round(depth / TOP_BIN)) for depth in BEAM)
    # a W beam has a fold that few pulses reach: every tenth of a metre counts, not every bin
    filled = points[:beam].reshape(-1, 2).mean(axis=1)
    is_beam = filled.min() > 0.5 * filled.mean() and points[end - 2:end].mean() < BEAM_GAP * filled.mean()
    return is_beam or through > OPEN_FENCE and float(np.median(members.foot)) > FREE_BELOW * top


def _is_row(chain):
    """Whether short gaps again and again show what lies beyond, as between parked cars, or most of it is hidden."""
    slices = chain.members.slice[-1] - chain.members.slice[0] + 1
    short = chain.empty[:-1] < TOLD_GAP
    return chain.empty[:-1][short].sum() > MAX_EMPTY * slices or len(chain.members) < LEAST_MEASURED * slices


def _restless(tops):
    """Whether the top goes up and down as bonnets and roofs do."""
    if len(tops) <= CAR_HALF:
        return False
    return float(np.quantile(np.abs(tops[CAR_HALF:] - tops[:-CAR_HALF]), STEADY_SHARE)) > STEADY_TOP


# A chain of uprights divided where one thing ends and the next begins in line with it: garden walls, fences and hedges follow one another.

TOP_CHANGE, THICKNESS_CHANGE, THROUGH_CHANGE = 0.15, 0.05, 0.15  # m, m and share of pulses by which the sections of two things differ at least
THICKEST, HIGHEST = 0.5, 3.0     # m: what is thicker or higher counts as this, for single uprights hold a crown or a window


def things_of(chain: Chain, min_length: float) -> list[tuple[str, Chain]]:
    """The things of a chain with their kinds; what is none of the kinds is left out.

    The chain is halved where height, thickness and what is seen through it change most, as long as both parts are `min_length` m long and
    differ by more than their own scatter; neighbours of one kind are one thing all the same.
    """
    members = chain.members
    through = members.behind / np.maximum(members.behind + members.points, 1.0)
    # what distinguishes things, in units of what their sections differ by at least
    sections = np.c_[np.minimum(members.top, HIGHEST) / TOP_CHANGE, np.minimum(members.thickness, THICKEST) / THICKNESS_CHANGE,
                     through / THROUGH_CHANGE]
    cuts = [0, *_cuts(sections, members.slice, 0, len(members), min_length), len(members)]
    kinds = [kind_of(chain.part(np.arange(a, b))) for a, b in zip(cuts[:-1], cuts[1:])]
    first = np.flatnonzero([k == 0 or kind != kinds[k - 1] for k, kind in enumerate(kinds)])
    result = []
    for k, after in zip(first, [*first[1:], len(kinds)]):
        whole = chain.part(np.arange(cuts[k], cuts[after]))
        # joined again, a row of cars shows that it is one
        kind = kind_of(whole) if after - k > 1 else kinds[k]
        if kind is not None:
            result.append((kind, whole))
    return result


def _cuts(sections, slices, first, last, min_length):
    """Where the members from `first` to `last` are divided, rising."""
    least = int(np.ceil(min_length / UPRIGHT_SLICE))
    rows = np.arange(first + 1, last)
    rows = rows[(slices[rows - 1] - slices[first] + 1 >= least) & (slices[last - 1] - slices[rows] + 1 >= least)]
    if not len(rows):
        return []
    members = sections[first:last]
    sums, squares = (np.vstack([np.zeros(members.shape[1]), np.cumsum(values, axis=0)]) for values in (members, members**2))
    left, right = (rows - first)[:, None], (last - rows)[:, None]
    before, after = sums[rows - first] / left, (sums[-1] - sums[rows - first]) / right
    gain = ((after - before) ** 2 * left * right / (left + right)).sum(axis=1)
    k = int(gain.argmax())
    scatter = np.sqrt(np.maximum(squares[-1] - before[k] ** 2 * left[k] - after[k] ** 2 * right[k], 0.0) / len(members))
    if not (np.abs(after[k] - before[k]) > np.maximum(1.0, scatter)).any():
        return []
    cut = int(rows[k])
    return [*_cuts(sections, slices, first, cut, min_length), cut, *_cuts(sections, slices, cut, last, min_length)]
