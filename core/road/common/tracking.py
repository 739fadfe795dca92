"""Chains of steps along the road, and the one chain after another that is the curb.

A single step may be anything; a curb goes on. Steps of neighbouring profiles are
linked where offset and height continue, and the links make chains. Of chains that
lie side by side the choice along the road weighs the length covered against
lateral jumps, with a weak preference for what is near the vehicle.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

MAX_LINK_LENGTH = 1.0       # m along the road that a link may span
LINK_DRIFT = 0.20           # m across per m along that a link may differ from the faces' own direction
LINK_TOLERANCE = 0.05           # m across that two steps of one line may differ anyway
HEIGHT_TOLERANCE = 0.03    # m that bottom heights of neighbours may differ
MIN_CHAIN_LENGTH = 0.75        # m of a chain that counts
MIN_CURB_LENGTH = 4.0            # m of chains that lie in one line and make a curb
MAX_CHAIN_GAP = 8.0         # m between chains of one line
MAX_JOINED_GAP = 2.5   # m along a curb between points, chains or lines that are joined without a sign of something in between
END_DIRECTION_STEPS = 5          # at the end of a chain that give its direction
MAX_EXTRAPOLATION = 3.0       # m that a chain is drawn on in its own direction
MIN_CHAIN_DENSITY = 0.5          # share of its profiles in which a chain must be seen
MAX_CHAIN_SCATTER = 0.02          # m, scatter about its own running line beyond the scanner's noise
NOISY_SHARE = 0.125          # share of MIN_HEIGHT: a scanner whose heights spread more does not show a curb in one profile
MAX_NOISE_ALLOWANCE = 0.3            # share of MIN_HEIGHT by which such a scanner may have seen a curb too low
MAX_ROAD_ROUGHNESS = 0.010     # m about the road side's line, if the scanner's noise is less than half of it
JUMP_COST = 4.0        # m of curb that a lateral jump of 1 m must bring to pay
CLIMB_COST = 60.0      # the same for 1 m of height: ground behind a curb is higher
MAX_JUMP_COST = 10.0        # m of curb that any jump costs at most
DISTANCE_PENALTY = 0.03        # share of a metre's worth lost for each metre farther out
TRACKING_MEMORY = 40.0          # m of road after which a chain is forgotten


@dataclass
class StepChain:
    """Steps of one line, sorted by station: indices into the steps, first and last station."""

    steps: np.ndarray
    start: float
    end: float


def link_steps(steps, profile_width):
    """(M,) number of the chain of every step, numbered by first station.

    Each step is linked with the one ahead that continues it best, if that one has
    no better step behind: so chains never branch.
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
    graph = coo_matrix((np.ones(len(rows)), (rows, ahead[rows])), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    found = np.empty(count, np.int64)
    found[order] = label
    return found


def _best_partner(steps, width, direction):
    """Index of the cheapest step in the following (or preceding) profiles, -1 where none fits.

    The steps are sorted by profile, then outward.
    """
    profile, u, h, s = steps.profile, steps.u, steps.h, steps.s
    count = len(u)
    span = u.max() - u.min() + 1000.0
    key = profile * span + (u - u.min())
    best, cheapest = np.full(count, -1), np.full(count, np.inf)
    for gap in range(1, max(int(round(MAX_LINK_LENGTH / width)), 1) + 1):
        on = u + steps.skew * direction * gap * width
        wanted = (profile + direction * gap) * span + (on - u.min())
        right = np.searchsorted(key, wanted)
        for candidate in (right - 1, right):
            k = np.clip(candidate, 0, count - 1)
            along = np.abs(s[k] - s)
            turn = 0.5 * (steps.skew + steps.skew[k]) * (s[k] - s)
            across, up = np.abs(u[k] - u - turn), np.abs(h[k] - h)
            fits = (profile[k] == profile + direction * gap) & (across <= LINK_TOLERANCE + LINK_DRIFT * along) \
                & (up <= HEIGHT_TOLERANCE + 0.05 * along)
            cost = np.where(fits, (across / LINK_TOLERANCE) ** 2 + (up / HEIGHT_TOLERANCE) ** 2 + (gap - 1), np.inf)
            better = cost < cheapest
            best[better], cheapest[better] = k[better], cost[better]
    return best


def curb_chains(steps, label, profile_width, least, slope):
    """Chains that look like a curb: long, dense, straight in the small, steep, with raised ground behind.

    Parameters
    ----------
    steps : Steps of one side of one road
    label : (M,) chain of each step
    least : m, median height that a chain must have
    slope : radians, least angle of the face

    Returns
    -------
    list of StepChain, sorted by start
    """
    order = np.lexsort((steps.profile, label))
    cuts = np.flatnonzero(np.diff(label[order])) + 1
    chains = []
    for members in np.split(order, cuts):
        s = steps.s[members]
        length = (steps.profile[members[-1]] - steps.profile[members[0]] + 1) * profile_width
        if length < MIN_CHAIN_LENGTH - 1e-9 or len(members) * profile_width < MIN_CHAIN_DENSITY * length:
            continue
        height, scanner_noise = np.median(steps.height[members]), np.median(steps.scanner_noise[members])
        # blur widens a face and never narrows it, so the sharper profiles tell
        sharp = max(np.quantile(steps.run[members], 0.3) - 2 * scanner_noise, 0.0)
        doubt = min(scanner_noise, MAX_NOISE_ALLOWANCE * least) if scanner_noise > NOISY_SHARE * least else 0.0
        if height < least - doubt or np.arctan2(height, sharp) < slope:
            continue
        if np.median(steps.noise[members]) > max(MAX_ROAD_ROUGHNESS, 2 * scanner_noise):
            continue
        if np.mean(steps.behind[members] >= 2) < 0.5:
            continue
        if len(members) > 2 and _wander(s, steps.u[members]) > MAX_CHAIN_SCATTER + scanner_noise:
            continue
        chains.append(StepChain(members, float(s[0]), float(s[-1])))
    return sorted(chains, key=lambda c: (c.start, c.end))


def select_along_road(chains, steps, near):
    """The chain that is the curb, along the road.

    Parameters
    ----------
    chains : list of StepChain of one side
    near : function, station -> outward offset of the outermost track on that side

    Returns
    -------
    list of (chain index, from station, to station), in order along the road
    """
    places = [(steps.s[c.steps], steps.u[c.steps], steps.h[c.steps]) for c in chains]
    starts, ends = np.array([c.start for c in chains]), np.array([c.end for c in chains])
    cuts = np.unique(np.r_[starts, ends])
    tips = np.array([_directions(steps, c.steps) for c in chains]).reshape(-1, 2)
    worth = np.full(len(chains), -np.inf)  # of the best way that is on this chain, or was on it last
    way = [None] * len(chains)             # that way: (chain, from, to, way before)
    old_worth, old_way = 0.0, None         # the best of what is forgotten; at first, no curb at all
    for a, b in zip(cuts[:-1], cuts[1:]):
        for c in np.flatnonzero((ends + TRACKING_MEMORY < a) & np.isfinite(worth)):
            if worth[c] > old_worth:
                old_worth, old_way = worth[c], way[c]
            worth[c] = -np.inf
        active = np.flatnonzero((starts <= a) & (ends >= b))
        known = np.flatnonzero(np.isfinite(worth))
        there = np.array([[np.interp(a, places[k][0], v) for v in places[k][1:]] for k in known]).reshape(-1, 2)
        middle, found = 0.5 * (a + b), []
        for c in active:
            farther = max(np.interp(middle, *places[c][:2]) - near(middle), 0.0)
            gain = (b - a) * max(1.0 - DISTANCE_PENALTY * farther, 0.1)
            u, h = (np.interp(a, places[c][0], v) for v in places[c][1:])
            gap = np.maximum(a - ends[known], 0.0)
            # a gap is crossed in the direction in which the one ended and the other begins
            turn = np.minimum(gap, MAX_EXTRAPOLATION) * 0.5 * (tips[known, 1] + (tips[c, 0] if a <= starts[c] else 0.0))
            jump = np.maximum(np.abs(u - there[:, 0] - np.where(gap > 0, turn, 0.0)) - 0.05 - 0.1 * gap, 0.0)
            climb = np.maximum(np.abs(h - there[:, 1]) - 0.03 - 0.003 * gap, 0.0)
            value = worth[known] - np.where(known == c, 0.0, np.minimum(JUMP_COST * jump + CLIMB_COST * climb, MAX_JUMP_COST))
            best, before = old_worth - (MAX_JUMP_COST / 2 if old_way else 0.0), old_way
            if len(known) and value.max() >= best:
                k = int(np.argmax(value))
                best, before = value[k], way[known[k]]
            found.append((c, best + gain, (int(c), float(a), float(b), before)))
        for c, value, step in found:
            worth[c], way[c] = value, step
    if len(chains) and worth.max() >= old_worth:
        old_way = way[int(np.argmax(worth))]
    path = []
    while old_way:
        path.append(old_way[:3])
        old_way = old_way[3]
    return _merged(path[::-1])


def drop_short_curbs(chosen, chains, steps):
    """Chosen chains that make a curb: those in line with each other add up to a length that counts.

    A curb between parked cars is seen in pieces; a piece with nothing in line with it may be anything.
    """
    kept, group, covered, last = [], [], 0.0, None
    for piece in chosen + [None]:
        members = None
        if piece is not None:
            members = chains[piece[0]].steps
            members = members[(steps.s[members] >= piece[1]) & (steps.s[members] <= piece[2])]
        if piece is None or last is not None and not _in_line(steps, last, members):
            kept += group if covered >= MIN_CURB_LENGTH else []
            group, covered = [], 0.0
        if piece is not None:
            group.append(piece)
            covered += piece[2] - piece[1]
            last = members
    return kept


def _in_line(steps, before, after):
    """Does one run of steps go on in the other?"""
    a, b = before[-1], after[0]
    gap = steps.s[b] - steps.s[a]
    turn = min(gap, MAX_EXTRAPOLATION) * 0.5 * (_directions(steps, before)[1] + _directions(steps, after)[0])
    return gap <= MAX_CHAIN_GAP and abs(steps.u[b] - steps.u[a] - turn) <= 0.15 + 0.15 * gap \
        and abs(steps.h[b] - steps.h[a]) <= HEIGHT_TOLERANCE + 0.02 * gap


def _directions(steps, members):
    """How a run of steps begins and ends: m outward per m along, over its outermost metre or so."""
    found = []
    for tip in (members[:END_DIRECTION_STEPS], members[-END_DIRECTION_STEPS:]):
        ds = steps.s[tip] - steps.s[tip].mean()
        found.append(float(ds @ steps.u[tip] / (ds @ ds + 0.05)))
    return found


def _wander(s, u):
    """Median distance of the steps of a chain from the chord of their neighbours."""
    f = (s[1:-1] - s[:-2]) / np.maximum(s[2:] - s[:-2], 1e-6)
    return np.median(np.abs(u[1:-1] - u[:-2] - f * (u[2:] - u[:-2])))


def _merged(path):
    """Touching intervals of one chain made one."""
    merged = []
    for chain, a, b in path:
        if merged and merged[-1][0] == chain and merged[-1][2] == a:
            merged[-1] = (chain, merged[-1][1], b)
        else:
            merged.append((chain, a, b))
    return merged
