"""The road frame: the roads and passes of a survey, and the conversion between map coordinates and theirs.

Both published methods use this frame, and every stage works in it. The drive is split into passes, single runs along a carriageway, where it
pauses, turns back, crosses itself or returns to its own track.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from math import dist

import numpy as np
from scipy.ndimage import binary_closing
from scipy.spatial import cKDTree

from ...common.arrays import stretch_of
from ..trajectory.trajectory import Trajectory, clean_trajectory, shaped_trajectory
from ..weights import FRAME
from .road import Road, continue_line, continue_straight, reference_nodes
from .row_table import SigmaAlong

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


def runs_through(low: Sequence[float], high: Sequence[float], x: np.ndarray, y: np.ndarray, reach: float) -> bool:
    """Whether a drive through (N,) positions comes within `reach` m of a box with the corners `low` and `high`."""
    return bool(((x > low[0] - reach) & (x < high[0] + reach) & (y > low[1] - reach) & (y < high[1] + reach)).any())


def _moving_rows(x: np.ndarray, y: np.ndarray, step: float = FRAME.standstill_radius) -> np.ndarray:
    """(M,) indices of (N,) positions at least `step` metres from the previous one, so that position noise adds no length.

    The first and the last row are included (the last replaces the one before it if that is nearer than `step`).
    """
    places, keep, count, row = list(zip(x.tolist(), y.tolist())), [0], len(x), 1
    # no position lies farther from another than was driven between them, but for rounding
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))].tolist()
    while (row := bisect_left(driven, driven[keep[-1]] + 0.999 * step, row)) < count:
        if dist(places[row], places[keep[-1]]) >= step:
            keep.append(row)
        row += 1
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
    rows = _moving_rows(x, y)
    driven = np.interp(np.arange(last - first), rows, np.r_[0.0, np.cumsum(np.hypot(np.diff(x[rows]), np.diff(y[rows])))])
    rows = rows[decimate_by_distance(x[rows], y[rows], FRAME.track_step)]
    cuts = []
    if len(rows) >= 4:
        px, py = x[rows], y[rows]
        along = np.r_[0.0, np.cumsum(np.hypot(np.diff(px), np.diff(py)))]
        heading = np.unwrap(np.arctan2(np.gradient(py), np.gradient(px)))
        cuts = [tuple(rows[list(cut)].tolist()) for cut in _return_cuts(px, py, along, heading)]
    count = last - first
    cuts = _split_long_pieces(_drop_short_pieces(cuts, driven), driven)
    starts = [(0, 0)] + [(row, after) for row, _, after in cuts]
    ends = [(row + 1, before + 1) for row, before, _ in cuts] + [(count, count)]
    pieces = []
    for (a, line_a), (b, line_b) in zip(starts, ends):
        if line_b - 1 <= line_a or driven[line_b - 1] - driven[line_a] < FRAME.min_pass_length:
            line_a, line_b = a, b
        if b - a > 1:
            pieces.append(_DrivenPath(first + a, first + b, float(driven[b - 1] - driven[a]), first + line_a, first + line_b))
    return pieces


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


def _last_in_a_row(rows):
    """The last of the first run of (N,) ascending rows without a gap."""
    return int(rows[np.argmax(np.diff(rows, append=rows[-1] + 2) > 1)])


def _return_cuts(px, py, along, heading):
    """[(index, last index of the lane before it, first of the lane after it)] of the positions at which a new pass begins."""
    pairs = cKDTree(np.c_[px, py]).query_pairs(FRAME.same_carriageway, output_type="ndarray")
    i, j = pairs.min(axis=1), pairs.max(axis=1)
    path_between = along[j] - along[i]
    turned = np.abs((heading[j] - heading[i] + np.pi) % (2 * np.pi) - np.pi)
    back = (turned > np.pi - FRAME.parallel_angle) & (path_between > 4 * FRAME.track_step)
    met_again = (turned < FRAME.parallel_angle) & (path_between > FRAME.min_loop_length)
    crossed = (path_between > FRAME.min_loop_length) & (np.hypot(px[i] - px[j], py[i] - py[j]) < FRAME.track_step)
    order = np.flatnonzero(back | met_again | crossed)
    order = order[np.lexsort((-i[order], j[order]))]
    i, j, back, met_again, path_between = (values[order] for values in (i, j, back, met_again, path_between))
    across = np.maximum(*(np.abs((px[j] - px[i]) * np.cos(heading[k]) + (py[j] - py[i]) * np.sin(heading[k])) for k in (i, j))) < FRAME.track_step
    cuts, start = [], 0
    for a, b, is_back, joins, path in zip(i.tolist(), j.tolist(), back, back | met_again, path_between):
        if a < start:
            continue
        # Split a turn on the spot or round a roundabout at its apex, a return where the track is met again, and a loop that crosses itself
        # half way round, so that neither part has two stations at the crossing, also where it crosses on another level
        out_x, out_y = np.cos(heading[a]) - np.cos(heading[b]), np.sin(heading[a]) - np.sin(heading[b])
        width = np.ptp(py[a:b + 1] * out_x - px[a:b + 1] * out_y) / np.hypot(out_x, out_y) if is_back else np.inf
        if max(width, path / np.pi) < FRAME.turn_reach:
            # the farthest position between two with opposite headings
            start = a + int(np.argmax(px[a:b + 1] * out_x + py[a:b + 1] * out_y))
            # its lanes end where the drive is no longer beside itself, seen from outside: round a roundabout it is so again, across the island
            near = stretch_of(j, start, np.searchsorted(along, along[b] + FRAME.turn_reach) - 1)
            beside = across[near] & back[near] & (i[near] <= start) & (along[a] - along[i[near]] < FRAME.turn_reach)
            ends = (_last_in_a_row(np.unique(way * of[near][beside])) * way for way, of in ((1, i), (-1, j)))
            cuts.append((start, *ends) if beside.any() else (start, a, b))
        else:
            start = b if joins else int(np.searchsorted(along, (along[a] + along[b]) / 2))
            cuts.append((start, start, start))
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


MAX_POINT_DISTANCE = 200.0    # derived: m from the track: exceeds the widest corridor and the extension at the ends of a road


@dataclass
class RoadFrame:
    """All roads and passes of a survey."""

    origin: np.ndarray   # (3,) map coordinates of the local origin, m
    roads: list[Road]   # list of Road, by number
    passes: list[Pass]   # list of Pass, by number
    crs: str = ""   # WKT, "" where unknown
    has_time: bool = True   # whether points are assigned to passes by their time
    notes: Sequence[str] = ()   # remarks on the trajectory, for the log
    # {road number: one sigma across of the middle of its passes}, by what they differ or by the accuracy of the trajectory where it was told,
    # whichever is more; without entry where both are unknown
    pass_sigma: dict[int, SigmaAlong] = field(default_factory=dict)
    way_known: bool = True   # whether the direction of its passes is that of the drive, which an estimated trajectory may not know

    def road(self, number: int) -> Road:
        return self.roads[number]

    def passes_of(self, road: int) -> list[Pass]:
        return [p for p in self.passes if p.road == road]

    def passes_sigma(self, road: int, s: np.ndarray, unknown: float = 0.0) -> np.ndarray:
        """(N,) m, one sigma across of the middle of the passes at (N,) stations of a road; `unknown` where nothing says it."""
        along = self.pass_sigma.get(road)
        return np.full(np.shape(s), unknown) if along is None else along.at(s)

    @property
    def farthest(self) -> float:
        """The largest |local x| or |local y| that a point in the frame can have, m."""
        return max(max(np.abs(p.x).max(), np.abs(p.y).max()) for p in self.passes) + MAX_POINT_DISTANCE

    def to_local(self, x: np.ndarray, y: np.ndarray, z: np.ndarray | None = None) -> tuple[np.ndarray, ...]:
        """Local coordinates of map coordinates: x, y, and z if given."""
        local = np.asarray(x, float) - self.origin[0], np.asarray(y, float) - self.origin[1]
        return local if z is None else local + (np.asarray(z, float) - self.origin[2],)

    def to_map(self, road: int, s: np.ndarray, d: np.ndarray | float, z: np.ndarray | None = None) -> tuple[np.ndarray, ...]:
        """Map coordinates of stations and offsets on a road: x, y, and z if a local z is given."""
        x, y = self.roads[road].to_map(s, d)
        on_map = x + self.origin[0], y + self.origin[1]
        return on_map if z is None else on_map + (np.asarray(z, float) + self.origin[2],)

    def track_height(self, road: int, s: np.ndarray, below: dict[int, float] | None = None) -> np.ndarray:
        """Height of the trajectory, (N,) local z in metres, at (N,) stations of a road: the mean of the passes there, else the nearest pass.

        Towards its end a pass counts less and less, so that the mean makes no step where one in another lane ends.
        below : {pass number: metres to subtract}, such as the sensor heights
        """
        s = np.asarray(s, float)
        below = below or {}
        total, count = np.zeros(s.shape), np.zeros(s.shape)
        passes = self.passes_of(road)
        for p in passes:
            first, last = p.span
            share = np.where((s >= first) & (s <= last), np.clip(np.minimum(s - first, last - s), FRAME.least_share, FRAME.lane_blend_length), 0.0)
            total += share * (p.height_at_station(s) - below.get(p.number, 0.0))
            count += share
        if not count.all():
            # beyond the driven part and between two passes: the pass that ends nearest
            nearest = np.argmin([np.maximum(np.maximum(p.span[0] - s, s - p.span[1]), 0.0) for p in passes], axis=0)
            for k, p in enumerate(passes):
                undriven = (count == 0) & (nearest == k)
                total[undriven], count[undriven] = p.height_at_station(s[undriven]) - below.get(p.number, 0.0), 1
        return total / count

    def nearest_pass(self, road: int, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) number of the pass whose track is nearest to (N,) stations and offsets, of those that drove there."""
        s, d = np.asarray(s, float), np.asarray(d, float)
        passes = self.passes_of(road)
        distances = [np.where((s >= p.span[0]) & (s <= p.span[1]), 0.0, 1e6) + np.abs(p.at_station(s)[0] - d) for p in passes]
        return np.array([p.number for p in passes])[np.argmin(distances, axis=0)]

    def locate_nearest(self, x: np.ndarray, y: np.ndarray, corridor: float = FRAME.corridor) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Road number, station and offset of the nearest point on any road, (N,) each; -1 and NaN where there is none."""
        x, y = np.asarray(x, float), np.asarray(y, float)
        best_road = np.full(len(x), -1)
        best_s, best_d = np.full(len(x), np.nan), np.full(len(x), np.nan)
        for road in self.roads:
            s, d = road.locate(x, y, corridor=corridor)
            better = np.isfinite(d) & ~(np.abs(d) >= np.abs(np.where(np.isnan(best_d), np.inf, best_d)))
            best_road[better], best_s[better], best_d[better] = road.number, s[better], d[better]
        return best_road, best_s, best_d


# Roads and passes of a trajectory: which parts of the drive run over the same road, and along which line.


def build_frame(trajectory: Trajectory) -> RoadFrame:
    """Roads and passes of a trajectory in a projected CRS in metres, which is refused if it does not move.

    The drive is split into passes. The longest becomes the reference line of the first road, lengthened by passes that
    continue it, up to MAX_ROAD_LENGTH. Passes parallel to it within 12 m, in either direction, are further passes over
    the same road. The remaining passes make the next road.
    """
    trajectory = shaped_trajectory(clean_trajectory(trajectory)).trajectory
    origin = np.floor([trajectory.x.min(), trajectory.y.min(), trajectory.z.min()])
    track = np.c_[trajectory.x - origin[0], trajectory.y - origin[1], trajectory.z - origin[2]]
    pieces = split_into_passes(trajectory)
    turning = np.zeros(len(track), bool)
    for piece in pieces:
        turning[piece.first:piece.line_first] = turning[piece.line_last:piece.last] = True
    moved = np.unique(np.concatenate([piece.first + _moving_rows(*track[piece.first:piece.last, :2].T) for piece in pieces]))
    # metres driven up to the last row that moved; a jump between two pieces lies before the later one's first row
    driven = np.r_[0.0, np.cumsum(np.hypot(*np.diff(track[moved, :2], axis=0).T))]
    driven = driven[np.searchsorted(moved, np.arange(len(track)), side="right") - 1]
    waiting = [(piece.first, piece.last) for piece in pieces]
    roads: list[Road] = []
    passes: list[Pass] = []
    while waiting:
        waiting = _longest_first(waiting, driven)
        longest = waiting[0]
        if roads and _length(longest, driven) < FRAME.min_shared_length:
            break
        road, members, waiting = _grow_road(len(roads), track, turning, moved, driven, waiting)
        roads.append(road)
        passes += [replace(_make_pass(road, trajectory.time[a:b], *track[a:b].T),
                           attitude=trajectory.rows(slice(a, b)).attitude()) for a, b in sorted(members)]
    passes.sort(key=lambda p: p.time[0])
    for number, p in enumerate(passes):
        p.number = number
    return RoadFrame(origin, roads, passes, trajectory.crs, trajectory.has_time, trajectory.notes, way_known=trajectory.way_known)


def _length(rows, driven):
    return float(driven[rows[1] - 1] - driven[rows[0]])


def _longest_first(ranges, driven):
    # to the centimetre: of equals the earlier comes first, whatever the rounding of coordinates
    return sorted(ranges, key=lambda rows: (-round(_length(rows, driven), 2), rows))


def _line_of(track, turning, rows):
    """The track of a range of rows as a line, which goes on straight beside the halves of turns at its ends."""
    straight = np.flatnonzero(~turning[rows[0]:rows[1]]) + rows[0]
    if len(straight) < 2:
        straight = np.arange(*rows)
    line = track[straight[0]:straight[-1] + 1]
    line = line[_moving_rows(*line[:, :2].T)]
    for half, way in ((track[rows[0]:straight[0]], -1), (track[straight[-1] + 1:rows[1]], 1)):
        line = continue_straight(line[::way], half)[::way]
    return line


def _grow_road(number, track, turning, moved, driven, waiting):
    """(Road, row ranges of its passes, remaining row ranges), starting with the first of the ranges."""
    longest, line = waiting[0], _line_of(track, turning, waiting[0])
    while True:
        road = Road(number, *reference_nodes(line), -FRAME.frame_extension)
        members, rest = [], []
        for rows in waiting:
            shared, left = ([rows], []) if rows == longest else _shared_with(road, line, track, moved, rows)
            members += shared
            rest += left
        for rows in _longest_first(rest, driven):
            if _length(rows, driven) >= FRAME.min_shared_length and _ends_near(line, track, rows):
                longer = continue_line(line, _line_of(track, turning, rows))
                if longer is not None and np.hypot(*np.diff(longer[:, :2], axis=0).T).sum() <= MAX_ROAD_LENGTH:
                    line = longer
                    break
        else:
            return road, members, rest


def _ends_near(line, track, rows):
    """Whether a range of rows begins or ends near an end of a line, within the reach of a turn on the spot."""
    ends = track[[rows[0], rows[1] - 1], None, :2] - line[None, [0, -1], :2]
    return bool((np.hypot(ends[..., 0], ends[..., 1]) < FRAME.junction_gap + FRAME.turn_reach).any())


def _away(line, places):
    """Whether positions lie wholly outside the bounding box of a line."""
    return bool((places.min(axis=0) > line.max(axis=0) + FRAME.max_lane_distance).any()
                or (places.max(axis=0) < line.min(axis=0) - FRAME.max_lane_distance).any())


def _shared_with(road, line, track, moved, rows):
    """The row ranges that run along a road, and those that do not."""
    a, b = rows
    if _away(line[:, :2], track[a:b, :2]):
        return [], [rows]
    kept = np.unique(np.r_[a, moved[(moved >= a) & (moved < b)], b - 1])
    kept = kept[decimate_by_distance(*track[kept, :2].T, 2.0)]
    x, y, z = track[kept].T
    s, d = road.locate(x, y, corridor=FRAME.max_lane_distance)
    level = np.abs(z - line[cKDTree(line[:, :2]).query(np.c_[x, y])[1], 2]) < FRAME.level_separation
    direction = np.arctan2(np.gradient(y), np.gradient(x)) if len(kept) > 1 else np.zeros(len(kept))
    turned = np.abs((direction - road.heading(np.where(np.isnan(s), 0, s)) + np.pi / 2) % np.pi - np.pi / 2)
    along = np.isfinite(d) & (turned < FRAME.parallel_angle) & level
    if len(kept) < FRAME.min_shared_length:
        along[:] = 2 * along.sum() > len(along)
    leaps, shortest = _leaps(s, x, y), int(FRAME.min_shared_length / 2)
    along = _fill_runs(along, shortest)
    if not along.all():
        along = ~_fill_runs(~along, shortest)
    for i, j in _runs(along):
        if along[i] and np.median(np.nan_to_num(np.abs(d[i:j]), nan=np.inf)) > FRAME.same_carriageway:
            along[i:j] = False
        elif along[i]:
            first, last = _without_leaps(leaps[i:j - 1], shortest, i > 0, j < len(along))
            along[i:i + first] = along[i + last:j] = False
    return _ranges_of(along, rows, kept, leaps)


def _ranges_of(along, rows, kept, leaps):
    """The row ranges of the kept rows that run along a road, and those of the others; `leaps` as of `_leaps`."""
    (a, b), shared, left = rows, [], []
    for i, j in _runs(along):
        ends = [int(kept[i]) if i else a, int(kept[j]) if j < len(kept) else b]
        if not along[i]:
            left.append(tuple(ends))
            continue
        # on a circuit, each round is a pass: split where the station jumps back
        cuts = [int(kept[i + k]) for k in _jumps(leaps[i:j - 1])]
        shared += list(zip([ends[0], *cuts], [*cuts, ends[1]]))
    return shared, left


def _jumps(leaps):
    """Rows at which the station leaps, at least half of `min_shared_length` from the ends and from each other."""
    shortest, kept, last = int(FRAME.min_shared_length / 2), [], 0
    for k in (np.flatnonzero(leaps) + 1).tolist():
        if k - last >= shortest and len(leaps) + 1 - k >= shortest:
            kept.append(k)
            last = k
    return kept


def _without_leaps(leaps, shortest, joins, leaves):
    """(first, end) of a run along a road, without a leap near its beginning, where the drive `joins` the road, or its end, where it `leaves` it.

    On a small roundabout the arms lie side by side, and before the leap the drive is still on another one.
    """
    rows, count = np.flatnonzero(leaps) + 1, len(leaps) + 1
    return (max(rows[rows < shortest], default=0) if joins else 0,
            min(rows[rows > count - shortest], default=count) if leaves else count)


def _leaps(s, x, y):
    """(N - 1,) bool, whether the station differs between (N,) successive positions by more than the way between them can, even in a bend."""
    return np.abs(np.diff(s)) > np.maximum(FRAME.least_leap, np.hypot(np.diff(x), np.diff(y)) / FRAME.bend_stretch[0])


def _runs(mask):
    """[(first, end)] of the runs of equal values."""
    cuts = np.r_[0, np.flatnonzero(np.diff(mask.astype(int))) + 1, len(mask)]
    return list(zip(cuts[:-1].tolist(), cuts[1:].tolist()))


def _fill_runs(mask, shortest):
    """Turn runs of False shorter than `shortest` into True."""
    return binary_closing(np.pad(mask, shortest, constant_values=True), np.ones(shortest))[shortest:-shortest]


def _make_pass(road, time, x, y, z):
    """A Pass; stations are propagated from row to row, so that they do not jump to another part of the road."""
    kept = _moving_rows(x, y)
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x[kept]), np.diff(y[kept])))]
    s, _ = road.locate(x[kept], y[kept], corridor=2 * FRAME.same_carriageway)
    rows = np.arange(len(x))
    run = _longest_run(s, _leaps(s, x[kept], y[kept]))
    if run is None:
        hint = np.clip(road.nearest_station(x, y, np.inf), road.start, road.end)
        direction = 1 if hint[-1] >= hint[0] else -1
    else:
        i, j = run
        direction = 1 if s[j - 1] >= s[i] else -1
        before, after = driven[:i] - driven[i], driven[j:] - driven[j - 1]
        walked = np.r_[s[i] + direction * before, s[i:j], s[j - 1] + direction * after]
        hint = np.interp(rows, kept, walked)
    s, d = road.locate(x, y, hint, corridor=2 * FRAME.same_carriageway)
    good = np.isfinite(s)
    if not good.any():
        return Pass(0, road.number, direction, time, x, y, z, np.clip(hint, road.start, road.end), np.zeros(len(x)))
    s, d = np.interp(rows, rows[good], s[good]), np.interp(rows, rows[good], d[good])
    return Pass(0, road.number, direction, time, x, y, z, s, d)


def _longest_run(s, leaps):
    """(first, end) of the longest run of known stations without jumps; None where none is known."""
    unknown = ~np.isfinite(s)
    cuts = np.r_[0, np.flatnonzero(unknown[1:] | unknown[:-1] | leaps) + 1, len(s)]
    runs = [(int(i), int(j)) for i, j in zip(cuts[:-1], cuts[1:]) if np.isfinite(s[i])]
    return max(runs, key=lambda run: (run[1] - run[0], -run[0])) if runs else None
