"""Passes: the drive split into single runs along a carriageway, and the position of the vehicle on each.

The trajectory is split where it pauses, turns back, crosses itself or returns to its own track.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, field, fields
from functools import cached_property
from math import hypot

import numpy as np
from scipy.spatial import cKDTree

from ..trajectory.trajectory import Trajectory
from ..weights import FRAME

MAX_ROAD_LENGTH = 200_000.0  # derived: m: stations have 32 bits of 0.1 mm; a longer road becomes several


@dataclass(frozen=True)
class _DrivenPath:
    """A stretch of the trajectory."""

    first: int   # first, last: trajectory rows, `last` exclusive
    last: int
    length: float   # metres driven
    line_first: int   # line_first, line_last: rows without the halves of turns on the spot, where the road does not turn; `line_last` exclusive
    line_last: int


def decimate_by_distance(x: np.ndarray, y: np.ndarray, step: float) -> np.ndarray:
    """(M,) indices of (N,) positions at least `step` metres of driving apart, with the first and the last."""
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    return np.union1d(np.flatnonzero(np.r_[True, np.diff(np.floor(driven / step)) > 0]), [len(x) - 1])


def moving_rows(x: np.ndarray, y: np.ndarray, step: float = FRAME.standstill_radius) -> np.ndarray:
    """(M,) indices of (N,) positions at least `step` metres from the previous one, so that position noise adds no length.

    The first and the last row are included (the last replaces the one before it if that is nearer than `step`).
    """
    count = len(x)
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))].tolist()
    px, py = x.tolist(), y.tolist()
    keep, last = [0], 0
    while True:
        # a position less than `step` along the track is also less than `step` away
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


def split_into_passes(trajectory: Trajectory) -> list[_DrivenPath]:
    """Split the trajectory where it pauses, turns back, crosses itself or returns to its own track, in driving order.

    Pieces longer than MAX_ROAD_LENGTH are split into equal parts.
    """
    pieces = []
    for first, last in _split_at_pauses(trajectory):
        pieces += _split_at_returns(trajectory, first, last)
    return [piece for piece in pieces if piece.length >= FRAME.min_pass_length] or \
        [max(pieces, key=lambda piece: piece.length)]


def _split_at_pauses(trajectory):
    gaps = np.diff(trajectory.time)
    jump = np.hypot(np.diff(trajectory.x), np.diff(trajectory.y))
    usual = np.median(gaps)
    # a jump in position of more than 60 m/s starts another drive, even if little time is missing
    pause = (gaps > max(5.0, 20 * usual)) if trajectory.has_time else jump > max(50.0, 20 * np.median(jump))
    pause |= (jump > 100.0) & (jump > 60.0 * gaps) if trajectory.has_time else False
    cuts = np.r_[0, np.flatnonzero(pause) + 1, len(trajectory)]
    return [(int(a), int(b)) for a, b in zip(cuts[:-1], cuts[1:]) if b - a >= 2]


def _split_at_returns(trajectory, first, last):
    x, y = trajectory.x[first:last], trajectory.y[first:last]
    rows = moving_rows(x, y)
    driven = np.interp(np.arange(last - first), rows, np.r_[0.0, np.cumsum(np.hypot(np.diff(x[rows]), np.diff(y[rows])))])
    rows = rows[decimate_by_distance(x[rows], y[rows], FRAME.track_step)]
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
    return [_DrivenPath(first + a, first + b, float(driven[b - 1] - driven[a]), first + line_a, first + line_b)
            for (a, line_a), (b, line_b) in zip(starts, ends) if b - a > 1]


def _drop_short_pieces(cuts, driven):
    """The cuts without those that would leave too short a piece; its rows stay with the piece before."""
    kept, begins = [], 0.0
    for cut in cuts:
        if driven[cut[0]] - begins >= FRAME.min_pass_length:
            kept.append(cut)
            begins = driven[cut[0]]
    while kept and driven[-1] - driven[kept[-1][0]] < FRAME.min_pass_length:
        kept.pop()
    return kept


def _split_long_pieces(cuts, driven):
    """The cuts with additional ones that split pieces longer than MAX_ROAD_LENGTH into equal parts."""
    ends = [0, *(row for row, _, _ in cuts), len(driven) - 1]
    further = []
    for first, last in zip(ends[:-1], ends[1:]):
        length = driven[last] - driven[first]
        parts = int(np.ceil(length / MAX_ROAD_LENGTH))
        rows = np.searchsorted(driven, driven[first] + length * np.arange(1, parts) / max(parts, 1)).tolist()
        further += [(row, row, row) for row in rows if first < row < last]
    return sorted([*cuts, *further])


def _turn_ends(heading, along, apex):
    """Indices before and after the apex of a turn on the spot where the vehicle drives in the direction of its lane."""
    off = np.abs(heading - heading[apex])
    straight = (off >= FRAME.turn_angle) & (np.abs(along - along[apex]) <= FRAME.turn_reach)
    before, after = np.flatnonzero(straight[:apex]), np.flatnonzero(straight[apex:])
    return (before[-1] if len(before) else apex), (apex + after[0] if len(after) else apex)


def _return_cuts(px, py, along, heading):
    """[(index, whether it is a turn on the spot)] of the positions at which a new pass begins."""
    pairs = cKDTree(np.c_[px, py]).query_pairs(FRAME.same_carriageway, output_type="ndarray")
    if not len(pairs):
        return []
    i, j = pairs.min(axis=1), pairs.max(axis=1)
    path_between = along[j] - along[i]
    turned = np.abs((heading[j] - heading[i] + np.pi) % (2 * np.pi) - np.pi)
    back = (turned > np.pi - FRAME.parallel_angle) & (path_between > 4 * FRAME.track_step)
    met_again = (turned < FRAME.parallel_angle) & (path_between > FRAME.min_loop_length)
    crossed = (path_between > FRAME.min_loop_length) & (np.hypot(px[i] - px[j], py[i] - py[j]) < FRAME.track_step)
    use = back | met_again | crossed
    order = np.flatnonzero(use)[np.lexsort((-i[use], j[use]))]
    cuts, start = [], 0
    for a, b, is_back, joins, path in zip(i[order].tolist(), j[order].tolist(), back[order], (back | met_again)[order], path_between[order]):
        if a < start:
            continue
        # Split a turn on the spot at its apex, a return where the track is met again, and a loop that crosses itself half way
        # round, so that neither part has two stations at the crossing, also where it crosses on another level
        is_turn = bool(is_back and path < FRAME.min_loop_length + 20)
        if is_turn:
            # the farthest position between two with opposite headings
            out_x, out_y = np.cos(heading[a]) - np.cos(heading[b]), np.sin(heading[a]) - np.sin(heading[b])
            start = a + int(np.argmax(px[a:b + 1] * out_x + py[a:b + 1] * out_y))
        else:
            start = b if joins else int(np.searchsorted(along, (along[a] + along[b]) / 2))
        cuts.append((start, is_turn))
    return cuts


@dataclass
class Pass:
    """One run of the vehicle along a road."""

    number: int   # of the pass, in order of time
    road: int   # number of its road
    direction: int   # +1 along the reference line, -1 against it
    time: np.ndarray   # (N,) s, ascending
    x: np.ndarray   # x, y, z: (N,) local coordinates of the vehicle, m
    y: np.ndarray
    z: np.ndarray
    s: np.ndarray   # s, d: (N,) station and offset of the vehicle on the road, m
    d: np.ndarray
    attitude: np.ndarray | None = field(default=None, repr=False)   # (3, N) roll, pitch and heading in radians, 0 where unknown; None without

    def __getstate__(self) -> dict:
        """What was driven, without the tables that speed up its use."""
        return {attribute.name: getattr(self, attribute.name) for attribute in fields(self)}

    def __setstate__(self, state: dict) -> None:
        Pass.__init__(self, **state)

    def at(self, time: np.ndarray, *names: str) -> list[np.ndarray]:
        """The state of the vehicle at (N,) times, (N,) metres for each of the `names` among "x", "y", "z", "s", "d".

        It is constant before the first and after the last sample, and interpolated linearly in tables with a step of 5 ms, so that many times in any
        order are fast.
        """
        tick, times, tables = self._by_tick
        ticks = (np.asarray(time, float) - times[0]) * (1.0 / tick)
        np.clip(ticks, 0.0, len(times) - 1.5, out=ticks)
        k = ticks.astype(np.intp)
        ticks -= k
        columns = []
        for name in names:
            if name not in tables:
                tables[name] = np.interp(times, self.time, getattr(self, name))
            table = tables[name]
            values = table.take(k, mode="clip")
            step = table[1:].take(k, mode="clip")
            step -= values
            step *= ticks
            values += step
            columns.append(values)
        return columns

    @cached_property
    def _by_tick(self):
        """s from tick to tick, their times, and {name: what `at` gives at these}, as far as it was asked for."""
        span = self.time[-1] - self.time[0]
        tick = max(FRAME.time_tick, span / FRAME.max_ticks)
        return tick, self.time[0] + tick * np.arange(int(np.ceil(span / tick)) + 2), {}

    def position(self, time: np.ndarray) -> tuple[np.ndarray, ...]:
        """Local x, y, z of the vehicle, (N,) m each, at (N,) times."""
        return tuple(self.at(time, "x", "y", "z"))

    def station_at(self, time: np.ndarray) -> np.ndarray:
        return self.at(time, "s")[0]

    def progress_at(self, time: np.ndarray) -> np.ndarray:
        """Metres of road driven since the pass began, at (N,) times; never decreases, also where the vehicle reverses."""
        return np.interp(time, self.time, self._progress)

    @cached_property
    def _progress(self):
        return np.maximum.accumulate(self.direction * self.s) - self.direction * self.s[0]

    def at_station(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Offset and local height of the track, (N,) m each, at (N,) stations."""
        stations, d, z = self._by_station
        return np.interp(s, stations, d), np.interp(s, stations, z)

    def height_at_station(self, s: np.ndarray) -> np.ndarray:
        """Local height of the track, (N,) m, at (N,) stations."""
        stations, _, z = self._by_station
        return np.interp(s, stations, z)

    @cached_property
    def _by_station(self):
        order = np.argsort(self.s, kind="stable")
        return self.s[order], self.d[order], self.z[order]

    @cached_property
    def span(self) -> tuple[float, float]:
        """(first, last) station of the pass, m."""
        return float(self.s.min()), float(self.s.max())
