"""Lines paired into lanes: where, between which lines, how wide."""

import numpy as np

from .boundaries import DOUBLE, STEP
from .settings import NARROWEST, USUAL, WIDEST
from .track import BRIDGED, INFERRED, MEASURED, Track

TRUSTED = 40.0     # m of measured length that make a line as good as any other
SQUEEZE = 0.5      # what two lines too near for a lane between them cost, in lines
STRADDLED = 0.5    # what a line costs that the vehicle drove along, astride
MOST_LANES = 4     # between two outer lines
RESTLESS = 0.8     # m of change of width beyond which a strip is classed place by place
SHORT_LANE = 2.0   # m: shorter, it is where lines end unevenly
SHORT_CLASS = 5.0  # m: a shorter change of class is noise of the width


def chosen_lines(lines, driven):
    """Which of the present lines bound lanes.

    Strokes of symbols, outlines and gutters make lines too, which cut a lane in two
    halves too narrow to be any. At every station the set of lines is taken that
    loses least: every line counts by its measured length, less if the vehicle drove
    astride it, and every gap between neighbours that is neither a lane's nor a
    double line's costs.

    Parameters
    ----------
    lines : Boundaries
    driven : (P, K) offset of the passes, NaN where a pass was not

    Returns
    -------
    (L, K) bool
    """
    present = np.isfinite(lines.d)
    kept = np.zeros_like(present)
    trust = np.clip(lines.seen_length / TRUSTED, 0.02, 1.0)
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
            weight = np.maximum(weight - STRADDLED * (astride.mean(1) > 0.8), 0.01)
        kept[active[_cheapest(d, weight)], window] = True
    return kept


def _cheapest(d, weight):
    """Indices of the best chain through lines ordered from left to right."""
    best, came = weight.copy(), np.full(len(d), -1)
    for j in range(1, len(d)):
        gap = d[:j] - d[j]
        total = best[:j] + weight[j] - SQUEEZE * ((gap > DOUBLE) & (gap < NARROWEST))
        i = int(np.argmax(total))
        if total[i] > best[j]:
            best[j], came[j] = total[i], i
    chain, j = [], int(np.argmax(best))
    while j >= 0:
        chain.append(j)
        j = came[j]
    return chain[::-1]


def runs_of_columns(pattern):
    """(first, last) of the stretches over which the columns of a boolean (L, K) do not change."""
    change = (pattern[:, 1:] != pattern[:, :-1]).any(0)
    cuts = np.r_[0, np.flatnonzero(change) + 1, pattern.shape[1]]
    return [(int(a), int(b) - 1) for a, b in zip(cuts[:-1], cuts[1:])]


def true_runs(mask):
    """(first, last) of the stretches of True in a boolean (K,)."""
    return [(a, b) for a, b in runs_of_columns(np.atleast_2d(mask)) if mask[a]]


def strips(lines, kept):
    """Strips of road between neighbouring lines: (left line, right line, first, last), in order of station."""
    ranked = np.where(kept, -lines.d, np.inf)
    order = np.argsort(ranked, axis=0, kind="stable")
    count = kept.sum(0)
    found = []
    for rank in range(int(count.max(initial=0)) - 1):
        both = count > rank + 1
        pair = np.where(both, order[rank] * len(kept) + order[rank + 1], -1)
        for first, last in runs_of_columns(pair[None, :]):
            if pair[first] >= 0:
                found.append((int(order[rank, first]), int(order[rank + 1, first]), first, last))
    # a strip may change its rank where a line begins beside it
    found.sort(key=lambda strip: (strip[0], strip[1], strip[2]))
    merged = []
    for strip in found:
        if merged and merged[-1][:2] == strip[:2] and merged[-1][3] + 1 == strip[2]:
            merged[-1] = merged[-1][:3] + (strip[3],)
        else:
            merged.append(strip)
    return sorted(merged, key=lambda strip: (strip[2], strip[0], strip[1]))


def classed(lines, strip):
    """Cut a strip where it changes between a lane ("lane"), room for several ("wide") and none.

    Returns
    -------
    list of (what, first, last)
    """
    left, right, first, last = strip
    width = lines.d[left, first:last + 1] - lines.d[right, first:last + 1]
    if np.ptp(np.percentile(width, [5, 95])) < RESTLESS:
        width = np.full(len(width), np.median(width))
    kind = np.where(width < NARROWEST, 0, np.where(width <= WIDEST, 1, 2))
    pieces = [[kind[a], a, b] for a, b in runs_of_columns(kind[None, :])]
    shortest = SHORT_CLASS / STEP
    while len(pieces) > 1:
        k = min(range(len(pieces)), key=lambda i: (pieces[i][2] - pieces[i][1], i))
        if pieces[k][2] - pieces[k][1] + 1 >= shortest:
            break
        into = k - 1 if k else 1
        pieces[into][1:] = min(pieces[k][1], pieces[into][1]), max(pieces[k][2], pieces[into][2])
        del pieces[k]
    names = ("none", "lane", "wide")
    return [(names[kind], first + a, first + b) for kind, a, b in pieces]


def paired_lanes(lines, all_strips, room):
    """A Track for every strip as wide as one lane; `room` says where lanes may be."""
    tracks = []
    for left, right, first, last in all_strips:
        for what, a, b in classed(lines, (left, right, first, last)):
            if what == "lane" and b - a + 1 >= SHORT_LANE / STEP:
                tracks.append(_share(lines, left, right, a, b, 0, 1))
    return [track for track in tracks if room(track)]


def _share(lines, left, right, first, last, place, count):
    """The lane number `place` (from the right) of `count` equal ones in a strip."""
    window = slice(first, last + 1)
    dl, dr = lines.d[left, window], lines.d[right, window]
    seen = lines.seen[left, window].astype(int) + lines.seen[right, window]
    status = np.choose(seen, [BRIDGED, INFERRED, MEASURED if count == 1 else INFERRED])
    size = last - first + 1
    return Track(first, dr + (dl - dr) * (place + 0.5) / count, (dl - dr) / count, status, np.zeros(size, bool),
                 np.full(size, left if place == count - 1 else -1), np.full(size, right if place == 0 else -1))


def divided_strips(lines, all_strips, tracks, driven, lane_width, room):
    """Lanes where only the outer lines are painted: their number follows from the distance and the lane width.

    Only where no lane is known already and the vehicle drove: a verge between two
    carriageways has lines on both sides too.
    """
    found = []
    for left, right, first, last in all_strips:
        for what, a, b in classed(lines, (left, right, first, last)):
            if what != "wide":
                continue
            window = slice(a, b + 1)
            free = ~_occupied(lines.d[left, window], lines.d[right, window], tracks, a, b)
            for i, j in true_runs(free):
                i, j = a + i, a + j
                dl, dr = lines.d[left, i:j + 1], lines.d[right, i:j + 1]
                if (lines.seen[left, i:j + 1] & lines.seen[right, i:j + 1]).mean() < 0.5:
                    continue
                inside = ((driven[:, i:j + 1] < dl) & (driven[:, i:j + 1] > dr)).any(0) if len(driven) else np.zeros(1)
                count = lane_count(float(np.median(dl - dr)), lane_width)
                if inside.mean() < 0.5 or not count:
                    continue
                found += [_share(lines, left, right, i, j, place, count) for place in range(count)]
    return [track for track in found if room(track)]


def lane_count(width, lane_width):
    """How many lanes of plausible width fill a strip; 0 where it is too wide to be one road's lanes."""
    likely = [n for n in range(1, MOST_LANES + 1) if NARROWEST <= width / n <= WIDEST]
    return min(likely, key=lambda n: (abs(width / n - lane_width), n)) if likely else 0


def _occupied(dl, dr, tracks, first, last):
    taken = np.zeros(last - first + 1, bool)
    for track in tracks:
        a, b = max(track.first, first), min(track.last, last)
        if a <= b:
            d = track.d[a - track.first:b - track.first + 1]
            taken[a - first:b - first + 1] |= (d < dl[a - first:b - first + 1]) & (d > dr[a - first:b - first + 1])
    return taken


def seen_width(tracks):
    """The median width of lanes between two painted lines, 3.5 m where there is none."""
    widths = [track.width[track.status == MEASURED] for track in tracks]
    widths = np.concatenate(widths) if widths else np.empty(0)
    return float(np.median(widths)) if len(widths) else USUAL


def lone_lanes(lines, kept, tracks, driven, half, shortest, room):
    """Lanes beside a line without partner: where the vehicle drove, and on both sides of a centre line that is alone.

    half : distance of the driving line from the painted one
    shortest : metres; less is a gap between lanes that are known, left open for a reason
    """
    alone = (kept.sum(0) == 1)
    found = []
    for k in range(len(lines.d)):
        for side in (1, -1):
            d = lines.d[k] + side * half
            free = kept[k] & lines.seen[k]
            others = kept.copy()
            others[k] = False
            for other in np.flatnonzero((others & kept[k]).any(1)):
                # with a line on the lane's other side the lane would have been paired or divided
                beyond = side * (lines.d[other] - lines.d[k])
                free &= ~(others[other] & (beyond > 0) & (beyond < 2 * WIDEST))
            for track in tracks + found:
                window = slice(track.first, track.last + 1)
                free[window] &= np.abs(track.d - d[window]) > 0.8 * half + 0.4 * track.width
            for a, b in true_runs(free):
                if b - a + 1 < shortest / STEP:
                    continue
                window = slice(a, b + 1)
                there = np.abs(driven[:, window] - d[window]) < half if len(driven) else np.zeros((1, 1), bool)
                if there.any(0).mean() < 0.5 and not (lines.kinds[k] == "centre" and alone[window].mean() > 0.5):
                    continue
                size = b - a + 1
                near = np.full(size, k)
                track = Track(a, d[window].copy(), np.full(size, 2 * half), np.full(size, INFERRED), np.ones(size, bool),
                              near if side < 0 else np.full(size, -1), near if side > 0 else np.full(size, -1))
                if room(track):
                    found.append(track)
    return found
