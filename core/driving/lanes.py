"""Lines paired into lanes: where, between which lines, how wide."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..countries.neutral import NEUTRAL
from .cross_section import MIN_BOUNDARY_SPACING, STATION_STEP, CrossSections
from .lane_tracking import BRIDGED, INFERRED, MEASURED, LaneTrack
from .settings import MAX_LANE_WIDTH, MIN_LANE_WIDTH

FULL_TRUST_LENGTH = 40.0          # m of measured length that make a line as good as any other
NARROW_GAP_COST = 0.5             # what two lines too near for a lane between them cost, in lines
STRADDLED_LINE_COST = 0.5         # what a line costs that the vehicle drove along, astride
MAX_LANES = 4                     # between two outer lines
MAX_WIDTH_CHANGE = 0.8            # m of change of width beyond which a strip is classed place by place
MAX_DIVISION_OFFSET_SHARE = 0.25  # share of a lane's width by which a known lane may lie beside its place in a division
MAX_ISOLATED_LINE = 15.0          # m: a shorter line between two that go on both ways needs a reason to part them
ISOLATED_LINE_MARGIN = 5.0        # m that they go on
MAX_DIVIDER_OFFSET = 0.5          # m from where the line between two lanes of a strip should be
MIN_LANE_LENGTH = 2.0             # m: shorter, it is where lines end unevenly
MIN_CLASS_LENGTH = 5.0            # m: a shorter change of class is noise of the width
MAX_SHOULDER_WIDTH = 3.0          # m between two edge lines: a hard shoulder or a row of parking places, unless driven on


Strip = tuple[int, int, int, int]            # left line, right line, first and last grid station
Clear = Callable[[LaneTrack], bool]          # whether a lane can be there


def select_lane_lines(lines: CrossSections, driven: np.ndarray, usual_width: float = NEUTRAL.usual_lane) -> np.ndarray:
    """Which of the present lines bound lanes.

    Strokes of symbols, outlines and gutters make lines too, which cut a lane in two
    halves too narrow to be any. At every station the set of lines is taken that
    loses least: every line counts by its measured length, less if the vehicle drove
    astride it, and every gap between neighbours that is neither a lane's nor a
    double line's costs.

    Parameters
    ----------
    lines : CrossSections
    driven : (P, K) offset of the passes, NaN where a pass was not
    usual_width : metres, of a lane of the country

    Returns
    -------
    (L, K) bool
    """
    present = np.isfinite(lines.d) & ~isolated_lines(lines, usual_width)[:, None]
    bounding = np.zeros_like(present)
    trust = np.clip(lines.seen_length / FULL_TRUST_LENGTH, 0.02, 1.0)
    for first, last in runs_of_columns(present):
        active = np.flatnonzero(present[:, first])
        if not len(active):
            continue
        window = slice(first, last + 1)
        d = np.median(lines.d[active, window], axis=1)
        order = np.argsort(-d, kind="stable")
        active, d = active[order], d[order]
        weight = trust[active] * np.where(lines.seen[active, window].mean(1) < 0.5, 0.5, 1.0)
        if len(driven):
            apart = np.abs(lines.d[active, window][:, None] - driven[None, :, window])
            astride = np.nanmin(np.where(np.isnan(apart), np.inf, apart), axis=1) < 0.4
            weight = np.maximum(weight - STRADDLED_LINE_COST * (astride.mean(1) > 0.8), 0.01)
        bounding[active[_cheapest(d, weight)], window] = True
    return bounding


def isolated_lines(lines: CrossSections, usual_width: float = NEUTRAL.usual_lane) -> np.ndarray:
    """(L,) True for short lines between two longer ones that do not part the road as lanes would."""
    present = np.isfinite(lines.d)
    found = np.zeros(len(present), bool)
    more = int(ISOLATED_LINE_MARGIN / STATION_STEP)
    for k in np.flatnonzero(lines.seen_length < MAX_ISOLATED_LINE):
        columns = np.flatnonzero(present[k])
        if not len(columns):
            continue
        first, last = columns[0] - more, columns[-1] + more
        if first < 0 or last >= len(lines.s):
            continue
        longer = np.flatnonzero(present[:, first:last + 1].all(1))
        apart = np.median(lines.d[longer][:, columns] - lines.d[k, columns], axis=1)
        left, right = apart[apart > MIN_BOUNDARY_SPACING], apart[apart < -MIN_BOUNDARY_SPACING]
        if not len(left) or not len(right) or (np.abs(apart) <= MIN_BOUNDARY_SPACING).any():
            continue
        width = left.min() - right.max()
        count = lane_count(width, usual_width)
        places = width * np.arange(1, count) / max(count, 1)
        found[k] = count > 0 and not (np.abs(places + right.max()) < MAX_DIVIDER_OFFSET).any()
    return found


def _cheapest(d, weight):
    """Indices of the best chain through lines ordered from left to right."""
    best, came = weight.copy(), np.full(len(d), -1)
    for j in range(1, len(d)):
        gap = d[:j] - d[j]
        total = best[:j] + weight[j] - NARROW_GAP_COST * ((gap > MIN_BOUNDARY_SPACING) & (gap < MIN_LANE_WIDTH))
        i = int(np.argmax(total))
        if total[i] > best[j]:
            best[j], came[j] = total[i], i
    chain, j = [], int(np.argmax(best))
    while j >= 0:
        chain.append(j)
        j = came[j]
    return chain[::-1]


def runs_of_columns(pattern: np.ndarray) -> list[tuple[int, int]]:
    """(first, last) of the stretches over which the columns of a boolean (L, K) do not change."""
    change = (pattern[:, 1:] != pattern[:, :-1]).any(0)
    cuts = np.r_[0, np.flatnonzero(change) + 1, pattern.shape[1]]
    return [(int(a), int(b) - 1) for a, b in zip(cuts[:-1], cuts[1:])]


def true_runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """(first, last) of the stretches of True in a boolean (K,)."""
    return [(a, b) for a, b in runs_of_columns(np.atleast_2d(mask)) if mask[a]]


def lane_strips(lines: CrossSections, bounding: np.ndarray) -> list[Strip]:
    """Strips of road between neighbouring lines: (left line, right line, first, last), in order of station."""
    ranked = np.where(bounding, -lines.d, np.inf)
    order = np.argsort(ranked, axis=0, kind="stable")
    count = bounding.sum(0)
    found = []
    for rank in range(int(count.max(initial=0)) - 1):
        both = count > rank + 1
        pair = np.where(both, order[rank] * len(bounding) + order[rank + 1], -1)
        for first, last in runs_of_columns(pair[None, :]):
            if pair[first] >= 0:
                found.append((int(order[rank, first]), int(order[rank + 1, first]), first, last))
    # a strip may change its rank where a line begins beside it
    found.sort(key=lambda strip: (strip[0], strip[1], strip[2]))
    merged: list[Strip] = []
    for strip in found:
        if merged and merged[-1][:2] == strip[:2] and merged[-1][3] + 1 == strip[2]:
            merged[-1] = merged[-1][:3] + (strip[3],)
        else:
            merged.append(strip)
    return sorted(merged, key=lambda strip: (strip[2], strip[0], strip[1]))


def classed(lines: CrossSections, strip: Strip) -> list[tuple[str, int, int]]:
    """Cut a strip where it changes between a lane ("lane"), room for several ("wide") and none.

    Returns
    -------
    list of (what, first, last)
    """
    left, right, first, last = strip
    width = lines.d[left, first:last + 1] - lines.d[right, first:last + 1]
    if np.ptp(np.percentile(width, [5, 95])) < MAX_WIDTH_CHANGE:
        width = np.full(len(width), np.median(width))
    kind = np.where(width < MIN_LANE_WIDTH, 0, np.where(width <= MAX_LANE_WIDTH, 1, 2))
    pieces = [[kind[a], a, b] for a, b in runs_of_columns(kind[None, :])]
    shortest = MIN_CLASS_LENGTH / STATION_STEP
    while len(pieces) > 1:
        k = min(range(len(pieces)), key=lambda i: (pieces[i][2] - pieces[i][1], i))
        if pieces[k][2] - pieces[k][1] + 1 >= shortest:
            break
        into = k - 1 if k else 1
        pieces[into][1:] = min(pieces[k][1], pieces[into][1]), max(pieces[k][2], pieces[into][2])
        del pieces[k]
    names = ("none", "lane", "wide")
    return [(names[kind], first + a, first + b) for kind, a, b in pieces]


def paired_lanes(lines: CrossSections, all_strips: list[Strip], driven: np.ndarray, clear: Clear) -> list[LaneTrack]:
    """A LaneTrack for every strip as wide as one lane; `clear` says where lanes may be."""
    tracks = []
    for left, right, first, last in all_strips:
        for what, a, b in classed(lines, (left, right, first, last)):
            if what == "lane" and b - a + 1 >= MIN_LANE_LENGTH / STATION_STEP and not _shoulder(lines, left, right, a, b, driven):
                tracks.append(_share(lines, left, right, a, b, 0, 1))
    return [track for track in tracks if clear(track)]


def _shoulder(lines, left, right, first, last, driven):
    """Whether a strip lies outside the lanes: narrow, between two edge lines, and nobody drove there."""
    if lines.kinds[left] != "edge" or lines.kinds[right] != "edge":
        return False
    window = slice(first, last + 1)
    dl, dr = lines.d[left, window], lines.d[right, window]
    used = ((driven[:, window] < dl) & (driven[:, window] > dr)).any(0) if len(driven) else np.zeros(1, bool)
    return np.median(dl - dr) < MAX_SHOULDER_WIDTH and used.mean() < 0.5


def _share(lines, left, right, first, last, place, count):
    """The lane number `place` (from the right) of `count` equal ones in a strip."""
    window = slice(first, last + 1)
    dl, dr = lines.d[left, window], lines.d[right, window]
    seen = lines.seen[left, window].astype(int) + lines.seen[right, window]
    status = np.choose(seen, [BRIDGED, INFERRED, MEASURED if count == 1 else INFERRED])
    size = last - first + 1
    return LaneTrack(first, dr + (dl - dr) * (place + 0.5) / count, (dl - dr) / count, status, np.zeros(size, bool),
                 np.full(size, left if place == count - 1 else -1), np.full(size, right if place == 0 else -1))


def divided_strips(lines: CrossSections, all_strips: list[Strip], tracks: list[LaneTrack], driven: np.ndarray, lane_width: float,
                   clear: Clear) -> list[LaneTrack]:
    """Lanes where only the outer lines are painted: their number follows from the distance and the lane width.

    Only where the vehicle drove (a verge between two carriageways has lines on both
    sides too), and only beside lanes that are known to lie as such a division has them.
    """
    found = []
    for left, right, first, last in all_strips:
        for what, a, b in classed(lines, (left, right, first, last)):
            if what != "wide":
                continue
            window = slice(a, b + 1)
            dl, dr = lines.d[left, window], lines.d[right, window]
            count = lane_count(float(np.median(dl - dr)), lane_width)
            inside = ((driven[:, window] < dl) & (driven[:, window] > dr)).any(0) if len(driven) else np.zeros(1)
            if not count or inside.mean() < 0.5 or (lines.seen[left, window] & lines.seen[right, window]).mean() < 0.5:
                continue
            shares = [_share(lines, left, right, a, b, place, count) for place in range(count)]
            for share, free in zip(shares, _free(shares, dl, dr, tracks)):
                found += [share.part(i, j + 1) for i, j in true_runs(free)]
    return [track for track in found if clear(track)]


def _free(shares, dl, dr, tracks):
    """(C, N) where each of the lanes of a divided strip is not yet known, and what is known fits the division."""
    d = np.array([share.d for share in shares])
    width = shares[0].width
    taken, foreign = np.zeros(d.shape, bool), np.zeros(d.shape[1], bool)
    for track in tracks:
        a, b = max(track.first, shares[0].first), min(track.last, shares[0].last)
        if a > b:
            continue
        here = slice(a - shares[0].first, b - shares[0].first + 1)
        known = track.d[a - track.first:b - track.first + 1]
        inside = (known < dl[here]) & (known > dr[here])
        same = np.abs(d[:, here] - known) < MAX_DIVISION_OFFSET_SHARE * width[here]
        taken[:, here] |= same & inside
        foreign[here] |= inside & ~same.any(0)
    return ~taken & ~foreign


def lane_count(width: float, lane_width: float) -> int:
    """How many lanes of plausible width fill a strip; 0 where it is too wide to be one road's lanes."""
    likely = [n for n in range(1, MAX_LANES + 1) if MIN_LANE_WIDTH <= width / n <= MAX_LANE_WIDTH]
    return min(likely, key=lambda n: (abs(width / n - lane_width), n)) if likely else 0


def typical_lane_width(tracks: list[LaneTrack], painted: bool = True, usual_width: float = NEUTRAL.usual_lane) -> float:
    """The median width of lanes (of those between two painted lines), `usual_width` where there is none."""
    widths = [track.width[track.status == MEASURED] if painted else track.width for track in tracks]
    every = np.concatenate([*widths, np.empty(0)])
    return float(np.median(every)) if len(every) else usual_width


def single_line_lanes(lines: CrossSections, bounding: np.ndarray, tracks: list[LaneTrack], driven: np.ndarray,
                      half_lane: Callable[[np.ndarray, int], np.ndarray], shortest: float, clear: Clear) -> list[LaneTrack]:
    """Lanes with a line on one side only: where the vehicle drove, and on both sides of a centre line that is alone.

    half_lane : a function of offsets (K,) of a painted line and a side, 1 or -1, that gives the (K,) distance of the
        driving line from it
    shortest : metres; less is a gap between lanes that are known, left open for a reason
    """
    alone = (bounding.sum(0) == 1)
    found: list[LaneTrack] = []
    for k in range(len(lines.d)):
        for side in (1, -1):
            half = half_lane(lines.d[k], side)
            d = lines.d[k] + side * half
            free = bounding[k] & lines.seen[k]
            others = bounding.copy()
            others[k] = False
            for other in np.flatnonzero((others & bounding[k]).any(1)):
                # with a line on the lane's other side the lane would have been paired or divided
                beyond = side * (lines.d[other] - lines.d[k])
                free &= ~(others[other] & (beyond > 0) & (beyond < 2 * MAX_LANE_WIDTH))
            for track in tracks + found:
                window = slice(track.first, track.last + 1)
                free[window] &= np.abs(track.d - d[window]) > 0.8 * half[window] + 0.4 * track.width
            for a, b in true_runs(free):
                if b - a + 1 < shortest / STATION_STEP:
                    continue
                window = slice(a, b + 1)
                there = np.abs(driven[:, window] - d[window]) < half[window] if len(driven) else np.zeros((1, 1), bool)
                if there.any(0).mean() < 0.5 and not (lines.kinds[k] == "centre" and alone[window].mean() > 0.5):
                    continue
                size = b - a + 1
                near = np.full(size, k)
                track = LaneTrack(a, d[window].copy(), 2 * half[window], np.full(size, INFERRED), np.ones(size, bool),
                              near if side < 0 else np.full(size, -1), near if side > 0 else np.full(size, -1))
                if clear(track):
                    found.append(track)
    return found
