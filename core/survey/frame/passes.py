"""The drive cut into passes: one run along a carriageway each."""

from bisect import bisect_left
from dataclasses import dataclass, field
from math import hypot

import numpy as np
from scipy.spatial import cKDTree

TRACK_STEP = 2.0          # m between the positions that are compared
SAME_CARRIAGEWAY = 12.0         # m: closer than this and parallel is the same carriageway
LEVEL_SEPARATION = 3.0         # m of height: farther above is another level of a ramp or bridge
PARALLEL_ANGLE = np.radians(30.0)
MIN_LOOP_LENGTH = 60.0  # m of driving before coming near one's own track counts as a return
MIN_PASS_LENGTH = 10.0     # m: shorter pieces are not worth a pass of their own
MAX_ROAD_LENGTH = 200_000.0  # m of one road: its stations have 32 bits; what is longer becomes several roads
STANDSTILL_RADIUS = 0.5    # m that a standing vehicle's position may tremble
TURN_ANGLE = np.radians(75.0)   # off the apex's heading: where a turn on the spot begins and ends
TURN_REACH = 40.0   # m either side of its apex


@dataclass(frozen=True)
class DrivenPath:
    """A stretch of the trajectory: rows `first` to `last` (exclusive), `length` metres driven.

    Rows `line_first` to `line_last` leave out the halves of turns on the spot at
    its ends: the vehicle turned there, the road does not.
    """

    first: int
    last: int
    length: float
    line_first: int
    line_last: int


def decimate_by_distance(x, y, step):
    """Indices of positions at least `step` metres of driving apart; first and last are kept."""
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    if driven[-1] < step:
        return np.unique([0, len(x) - 1])
    cell = np.floor(driven / step)
    keep = np.flatnonzero(np.r_[True, np.diff(cell) > 0])
    if keep[-1] != len(x) - 1:
        keep = np.r_[keep, len(x) - 1]
    return keep


def moving_rows(x, y, step=STANDSTILL_RADIUS):
    """Indices of rows that lie at least `step` metres from the one kept before: trembling adds no length to the road.

    First and last row are kept (the last in place of the one before where that is nearer than `step`).
    """
    count = len(x)
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))].tolist()
    px, py = x.tolist(), y.tolist()
    keep, last = [0], 0
    while True:
        # Nothing nearer than `step` along the track can be `step` away from it
        row = bisect_left(driven, driven[last] + step, last + 1)
        reach = 64
        while row < count and hypot(px[row] - px[last], py[row] - py[last]) < step:
            far = np.flatnonzero(np.hypot(x[row:row + reach] - x[last], y[row:row + reach] - y[last]) >= step)
            if len(far):
                row += int(far[0])
                break
            row, reach = row + reach, 2 * reach
        if row >= count:
            break
        keep.append(row)
        last = row
    if keep[-1] != count - 1:
        keep = keep[:-1] + [count - 1] if len(keep) > 1 else keep + [count - 1]
    return np.array(keep)


def split_into_passes(trajectory):
    """Cut the trajectory where it pauses, turns back, crosses itself or returns to its own track, and what is longer than MAX_ROAD_LENGTH.

    Returns
    -------
    list of DrivenPath in driving order
    """
    pieces = []
    for first, last in _split_at_pauses(trajectory):
        pieces += _split_at_returns(trajectory, first, last)
    return [piece for piece in pieces if piece.length >= MIN_PASS_LENGTH] or \
        [max(pieces, key=lambda piece: piece.length)]


def _split_at_pauses(trajectory):
    gaps = np.diff(trajectory.time)
    jump = np.hypot(np.diff(trajectory.x), np.diff(trajectory.y))
    usual = np.median(gaps)
    # A position jump of more than 60 m/s in a gap is another drive even when little time is missing.
    pause = (gaps > max(5.0, 20 * usual)) if trajectory.has_time else jump > max(50.0, 20 * np.median(jump))
    pause |= (jump > 100.0) & (jump > 60.0 * gaps) if trajectory.has_time else False
    cuts = np.r_[0, np.flatnonzero(pause) + 1, len(trajectory)]
    return [(int(a), int(b)) for a, b in zip(cuts[:-1], cuts[1:]) if b - a >= 2]


def _split_at_returns(trajectory, first, last):
    x, y = trajectory.x[first:last], trajectory.y[first:last]
    rows = moving_rows(x, y)
    driven = np.interp(np.arange(last - first), rows, np.r_[0.0, np.cumsum(np.hypot(np.diff(x[rows]), np.diff(y[rows])))])
    rows = rows[decimate_by_distance(x[rows], y[rows], TRACK_STEP)]
    cuts = []
    if len(rows) >= 4:
        px, py = x[rows], y[rows]
        along = np.r_[0.0, np.cumsum(np.hypot(np.diff(px), np.diff(py)))]
        heading = np.unwrap(np.arctan2(np.gradient(py), np.gradient(px)))
        cuts = [(int(rows[k]), *(int(rows[m]) for m in (_turn_ends(heading, along, k) if is_turn else (k, k))))
                for k, is_turn in _return_cuts(px, py, along, heading)]
    count = last - first
    cuts = _split_long_pieces(_drop_short_pieces(cuts, driven), driven)
    starts = [(0, 0)] + [(row, after) for row, _, after in cuts]
    ends = [(row + 1, before + 1) for row, before, _ in cuts] + [(count, count)]
    return [DrivenPath(first + a, first + b, float(driven[b - 1] - driven[a]), first + line_a, first + line_b)
            for (a, line_a), (b, line_b) in zip(starts, ends) if b - a > 1]


def _drop_short_pieces(cuts, driven):
    """The cuts without those that leave a piece too short for a pass: its rows stay with the piece before."""
    kept, begins = [], 0.0
    for cut in cuts:
        if driven[cut[0]] - begins >= MIN_PASS_LENGTH:
            kept.append(cut)
            begins = driven[cut[0]]
    while kept and driven[-1] - driven[kept[-1][0]] < MIN_PASS_LENGTH:
        kept.pop()
    return kept


def _split_long_pieces(cuts, driven):
    """The cuts with further ones, by which pieces longer than MAX_ROAD_LENGTH become equal parts."""
    ends = [0, *(row for row, _, _ in cuts), len(driven) - 1]
    found = []
    for first, last in zip(ends[:-1], ends[1:]):
        length = driven[last] - driven[first]
        parts = int(np.ceil(length / MAX_ROAD_LENGTH))
        rows = np.searchsorted(driven, driven[first] + length * np.arange(1, parts) / max(parts, 1)).tolist()
        found += [(row, row, row) for row in rows if first < row < last]
    return sorted([*cuts, *found])


def _turn_ends(heading, along, apex):
    """Indices before and after the apex of a turn on the spot at which the vehicle is back in its lane's direction."""
    off = np.abs(heading - heading[apex])
    straight = (off >= TURN_ANGLE) & (np.abs(along - along[apex]) <= TURN_REACH)
    before, after = np.flatnonzero(straight[:apex]), np.flatnonzero(straight[apex:])
    return (before[-1] if len(before) else apex), (apex + after[0] if len(after) else apex)


def _apex(px, py, heading, a, b):
    """Index of the position farthest out between two that face opposite ways: of an arc or of a reversal alike."""
    out_x, out_y = np.cos(heading[a]) - np.cos(heading[b]), np.sin(heading[a]) - np.sin(heading[b])
    return a + int(np.argmax(px[a:b + 1] * out_x + py[a:b + 1] * out_y))


def _return_cuts(px, py, along, heading):
    """[(index, is it a turn on the spot)] of the positions at which a new pass begins."""
    pairs = cKDTree(np.c_[px, py]).query_pairs(SAME_CARRIAGEWAY, output_type="ndarray")
    if not len(pairs):
        return []
    i, j = pairs.min(axis=1), pairs.max(axis=1)
    apart = along[j] - along[i]
    turned = np.abs((heading[j] - heading[i] + np.pi) % (2 * np.pi) - np.pi)
    back = (turned > np.pi - PARALLEL_ANGLE) & (apart > 4 * TRACK_STEP)
    again = (turned < PARALLEL_ANGLE) & (apart > MIN_LOOP_LENGTH)
    crossed = (apart > MIN_LOOP_LENGTH) & (np.hypot(px[i] - px[j], py[i] - py[j]) < TRACK_STEP)
    use = back | again | crossed
    order = np.flatnonzero(use)[np.lexsort((-i[use], j[use]))]
    cuts, start = [], 0
    for a, b, is_back, joins, path in zip(i[order].tolist(), j[order].tolist(), back[order], (back | again)[order], apart[order]):
        if a < start:
            continue
        # A turn on the spot is cut at its apex, a return from elsewhere where it comes back, and a loop that crosses
        # itself half way round: neither part then has two stations at the crossing, on whatever levels they meet
        is_turn = bool(is_back and path < MIN_LOOP_LENGTH + 20)
        if is_turn:
            start = _apex(px, py, heading, a, b)
        else:
            start = b if joins else int(np.searchsorted(along, (along[a] + along[b]) / 2))
        cuts.append((start, is_turn))
    return cuts


# One run of the vehicle along a road: where it was at any time, and at any station.

TIME_TICK = 0.005       # s between the times at which a pass is looked up
MAX_TICKS = 20_000_000


@dataclass
class Pass:
    """One run of the vehicle along a road.

    time, x, y, z (local), s, d: (N,) the vehicle's own samples in the road's frame.
    direction: +1 along the reference line, -1 against it. attitude: (3, N) roll, pitch, heading (radians), 0 where unknown, or None.
    """

    number: int
    road: int
    direction: int
    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    s: np.ndarray
    d: np.ndarray
    attitude: np.ndarray = field(default=None, repr=False)
    _by_station: tuple = field(default=None, repr=False)
    _progress: np.ndarray = field(default=None, repr=False)
    _by_tick: dict = field(default_factory=dict, repr=False)

    def at(self, time, *names):
        """What the vehicle did at (N,) times: (N,) values of each of "x", "y", "z", "s", "d", as at its ends beyond them.

        Values lie on a line between ticks of 5 ms, so that many times in any order cost little.
        """
        if not self._by_tick:
            span = self.time[-1] - self.time[0]
            tick = max(TIME_TICK, span / MAX_TICKS)
            self._by_tick["time"] = tick, self.time[0] + tick * np.arange(int(np.ceil(span / tick)) + 2)
        tick, times = self._by_tick["time"]
        at = (np.asarray(time, float) - times[0]) * (1.0 / tick)
        np.clip(at, 0.0, len(times) - 1.5, out=at)
        k = at.astype(np.intp)
        at -= k
        found = []
        for name in names:
            if name not in self._by_tick:
                self._by_tick[name] = np.interp(times, self.time, getattr(self, name))
            table = self._by_tick[name]
            here = table.take(k, mode="clip")
            step = table[1:].take(k, mode="clip")
            step -= here
            step *= at
            here += step
            found.append(here)
        return found

    def position(self, time):
        """Local x, y, z of the vehicle at the given times."""
        return tuple(self.at(time, "x", "y", "z"))

    def station_at(self, time):
        """Road station of the vehicle at the given times."""
        return self.at(time, "s")[0]

    def progress_at(self, time):
        """Metres of road gained since the pass began: stands still while the vehicle waits, trembles or backs up."""
        if self._progress is None:
            self._progress = np.maximum.accumulate(self.direction * self.s) - self.direction * self.s[0]
        return np.interp(time, self.time, self._progress)

    def at_station(self, s):
        """Offset and height of the vehicle's track where it passes station s."""
        stations, d, z = self._track_by_station()
        return np.interp(s, stations, d), np.interp(s, stations, z)

    def height_at_station(self, s):
        """Height of the vehicle's track where it passes station s."""
        stations, _, z = self._track_by_station()
        return np.interp(s, stations, z)

    def _track_by_station(self):
        if self._by_station is None:
            order = np.argsort(self.s, kind="stable")
            self._by_station = self.s[order], self.d[order], self.z[order]
        return self._by_station

    @property
    def span(self):
        """(first, last) station driven."""
        return float(self.s.min()), float(self.s.max())
