"""The drive cut into passes: one run along a carriageway each."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

STEP = 2.0          # m between the positions that are compared
NEAR = 12.0         # m: closer than this and parallel is the same carriageway
PARALLEL = np.radians(30.0)
RETURN_AFTER = 60.0  # m of driving before coming near one's own track counts as a return
SHORTEST = 10.0     # m: shorter pieces are not worth a pass of their own


@dataclass(frozen=True)
class DrivenPath:
    """A stretch of the trajectory: rows `first` to `last` (exclusive), `length` metres driven."""

    first: int
    last: int
    length: float


def thin_by_distance(x, y, step):
    """Indices of positions at least `step` metres of driving apart; first and last are kept."""
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    if driven[-1] < step:
        return np.unique([0, len(x) - 1])
    cell = np.floor(driven / step)
    keep = np.flatnonzero(np.r_[True, np.diff(cell) > 0])
    if keep[-1] != len(x) - 1:
        keep = np.r_[keep, len(x) - 1]
    return keep


def moving_rows(x, y, jitter=0.05):
    """Indices of the rows that advance: a standing vehicle's jitter adds no length to the road."""
    keep = [0]
    step = np.hypot(np.diff(x), np.diff(y))
    slow = step < jitter
    if not slow.any():
        return np.arange(len(x))
    # Only rows inside slow stretches need the sequential look, and there only the far-moved survive.
    last = 0
    for row in range(1, len(x)):
        if not slow[row - 1] or np.hypot(x[row] - x[last], y[row] - y[last]) >= jitter:
            keep.append(row)
            last = row
    if keep[-1] != len(x) - 1 and len(keep) > 1:
        keep[-1] = len(x) - 1
    return np.array(keep)


def split_into_passes(trajectory):
    """Cut the trajectory where it pauses, turns back, crosses itself or returns to its own track.

    Returns
    -------
    list of DrivenPath in driving order
    """
    pieces = []
    for first, last in _split_at_pauses(trajectory):
        pieces += _split_at_returns(trajectory, first, last)
    return [piece for piece in pieces if piece.length >= SHORTEST] or \
        [max(pieces, key=lambda piece: piece.length)]


def _split_at_pauses(trajectory):
    gaps = np.diff(trajectory.time)
    jump = np.hypot(np.diff(trajectory.x), np.diff(trajectory.y))
    usual = np.median(gaps)
    # A position jump of more than 60 m/s in a gap is another drive even when little time is missing.
    pause = (gaps > max(5.0, 20 * usual)) if trajectory.has_time else jump > max(50.0, 20 * np.median(jump))
    pause |= (jump > 100.0) & (jump > 60.0 * gaps) if trajectory.has_time else False
    cuts = np.r_[0, np.flatnonzero(pause) + 1, len(trajectory)]
    return [(a, b) for a, b in zip(cuts[:-1], cuts[1:]) if b - a >= 2]


def _split_at_returns(trajectory, first, last):
    x, y = trajectory.x[first:last], trajectory.y[first:last]
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    rows = moving_rows(x, y)
    rows = rows[thin_by_distance(x[rows], y[rows], STEP)]
    if len(rows) < 4:
        return [DrivenPath(first, last, float(driven[-1]))]
    px, py = x[rows], y[rows]
    along = np.r_[0.0, np.cumsum(np.hypot(np.diff(px), np.diff(py)))]
    heading = np.unwrap(np.arctan2(np.gradient(py), np.gradient(px)))
    cuts = _return_cuts(px, py, along, heading)
    bounds = np.r_[0, rows[cuts].astype(int), last - first - 1] if len(cuts) else np.array([0, last - first - 1])
    return [DrivenPath(first + int(a), first + int(b) + 1, float(driven[b] - driven[a]))
            for a, b in zip(bounds[:-1], bounds[1:]) if b > a]


def _return_cuts(px, py, along, heading):
    """Positions (indices) at which a new pass begins."""
    pairs = cKDTree(np.c_[px, py]).query_pairs(NEAR, output_type="ndarray")
    if not len(pairs):
        return np.empty(0, int)
    i, j = pairs.min(axis=1), pairs.max(axis=1)
    apart = along[j] - along[i]
    turned = np.abs((heading[j] - heading[i] + np.pi) % (2 * np.pi) - np.pi)
    back = (turned > np.pi - PARALLEL) & (apart > 4 * STEP)
    again = (turned < PARALLEL) & (apart > RETURN_AFTER)
    crossed = (apart > RETURN_AFTER) & (np.hypot(px[i] - px[j], py[i] - py[j]) < STEP)
    use = back | again | crossed
    i, j, back, apart = i[use], j[use], back[use], apart[use]
    order = np.lexsort((-i, j))
    cuts, start = [], 0
    for a, b, is_back, path in zip(i[order], j[order], back[order], apart[order]):
        if a < start:
            continue
        # A turn on the spot is cut at its apex, a return from elsewhere where it comes back.
        start = (a + b) // 2 if is_back and path < RETURN_AFTER + 20 else b
        cuts.append(start)
    return np.array(cuts, int)
