"""One lane followed along the road, and how stretches of lanes become one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .cross_section import STATION_STEP

if TYPE_CHECKING:
    from .cross_section import CrossSections

MEASURED, INFERRED, BRIDGED = 0, 1, 2
LANE_STATUS = ("measured", "inferred", "bridged")
MAX_LANE_JUMP_SHARE = 0.35       # share of a lane's width by which it may jump from one stretch to the next
GAP_NEIGHBOURHOOD = 10.0         # m around a gap within which other lanes tell of a split or merge
MIN_LANE_SEPARATION_SHARE = 0.6  # share of a lane's width that lanes keep from each other
INTRUSION_SHARE = 0.3            # share of a lane's width within which a line makes it another lane
MAX_EXTENSION_RATIO = 4          # times its own length that a lane is led on beside one line
END_WIDTH_LENGTH = 10.0          # m over which a lane's width at its end is taken


@dataclass
class LaneTrack:
    """A lane from grid station `first` on.

    d, width : (N,) metres; status : (N,) of MEASURED, INFERRED, BRIDGED; offset : (N,) True
    where the place comes from one line only; left, right : (N,) index of the bounding lines, -1 for none
    """

    first: int
    d: np.ndarray
    width: np.ndarray
    status: np.ndarray
    offset: np.ndarray
    left: np.ndarray
    right: np.ndarray

    @property
    def last(self) -> int:
        return self.first + len(self.d) - 1

    def __len__(self) -> int:
        return len(self.d)

    def part(self, a: int, b: int) -> LaneTrack:
        """Rows a to b (exclusive) as a track of their own."""
        return LaneTrack(self.first + a, *(v[a:b] for v in self._columns()))

    def _columns(self):
        return self.d, self.width, self.status, self.offset, self.left, self.right

    def followed_by(self, other: LaneTrack) -> LaneTrack:
        """This track and one that begins at the next station."""
        return LaneTrack(self.first, *(np.concatenate(pair) for pair in zip(self._columns(), other._columns())))

    def at(self, k: int) -> tuple[float, float]:
        """Offset and width at grid station k; NaN where the lane is not."""
        if self.first <= k <= self.last:
            return float(self.d[k - self.first]), float(self.width[k - self.first])
        return np.nan, np.nan

    def end_width(self, head: bool) -> float:
        rows = int(END_WIDTH_LENGTH / STATION_STEP)
        return float(np.median(self.width[:rows] if head else self.width[-rows:]))

    def without_bridged_ends(self) -> LaneTrack | None:
        """The track less bridged stretches at its ends, where nothing follows; None if nothing is left."""
        known = np.flatnonzero(self.status != BRIDGED)
        return self.part(known[0], known[-1] + 1) if len(known) else None


def _filler(count, d, width, status, offset, left=-1, right=-1):
    return (np.asarray(d, float), np.asarray(width, float), np.full(count, status), np.full(count, offset),
            np.full(count, left), np.full(count, right))


def connect(tracks: list[LaneTrack], lines: CrossSections, most_bridged: float, most_inferred: float) -> list[LaneTrack]:
    """Join lanes end to start, one to one.

    Without a gap they are joined where they meet; across a gap where one lane faces
    exactly one other: never across a split or merge. Where a measured line or another
    lane leads through the gap its course is followed (inferred, or as the other lane
    was found), elsewhere the gap is bridged.
    """
    while True:
        count = len(tracks)
        tracks = _connected(tracks, lines, most_bridged, most_inferred)
        # a lane that is whole now may guide another
        if len(tracks) == count:
            return tracks


def _connected(tracks, lines, most_bridged, most_inferred):
    tracks = sorted(tracks, key=lambda t: (t.first, float(t.d[0])))
    reach = int(max(most_bridged, most_inferred) / STATION_STEP)
    firsts = np.array([track.first for track in tracks])
    pairs = []
    for i, a in enumerate(tracks):
        low, high = np.searchsorted(firsts, [a.last + 1, a.last + 1 + reach + 1])
        for j in range(low, high):
            join = _join(a, tracks[j], tracks, lines, most_bridged, most_inferred)
            if join is not None:
                pairs.append((tracks[j].first - a.last, abs(join[0]), i, j, join[1]))
    after, before, fill = {}, set(), {}
    for _, _, i, j, middle in sorted(pairs, key=lambda p: p[:4]):
        if i not in after and j not in before:
            after[i], fill[i] = j, middle
            before.add(j)
    joined = []
    for i in range(len(tracks)):
        if i in before:
            continue
        track = tracks[i]
        while i in after:
            if fill[i] is not None:
                track = track.followed_by(fill[i])
            i = after[i]
            track = track.followed_by(tracks[i])
        joined.append(track)
    return joined


def _join(a, b, tracks, lines, most_bridged, most_inferred):
    """(lateral jump, the LaneTrack between or None), or None where a and b are not one lane."""
    count = b.first - a.last - 1
    wa, wb = a.end_width(False), b.end_width(True)
    course, status = _guide(a, b, lines, [t for t in tracks if t is not a and t is not b]) if count else (None, None)
    if count * STATION_STEP > (most_bridged if course is None else most_inferred):
        return None
    path = course if course is not None else np.zeros(count + 2)
    jump = (b.d[0] - path[-1]) - (a.d[-1] - path[0])
    if abs(jump) > MAX_LANE_JUMP_SHARE * min(wa, wb) or abs(wa - wb) > 2 * MAX_LANE_JUMP_SHARE * max(wa, wb):
        return None
    if not _one_to_one(a, b, wa, wb, tracks):
        return None
    if not count:
        return jump, None
    share = np.arange(1, count + 1) / (count + 1)
    # the road's own shape is in the frame; a bridge only has to leave and arrive smoothly
    d = _hermite(a, b, count) if course is None else a.d[-1] - path[0] + jump * share + path[1:-1]
    between = LaneTrack(a.last + 1, *_filler(count, d, wa + (wb - wa) * share, BRIDGED, True))
    if course is not None:
        between.status[:] = status[1:-1]
    if any(_crowded(between, t) for t in tracks if t is not a and t is not b):
        return None
    return jump, between


def _hermite(a, b, count):
    rows = int(END_WIDTH_LENGTH / STATION_STEP)
    slopes = [np.polyfit(np.arange(len(v)), v, 1)[0] if len(v) > 4 else 0.0 for v in (a.d[-rows:], b.d[:rows])]
    span = count + 1
    t = np.arange(1, count + 1) / span
    return (a.d[-1] * (1 + 2 * t) * (1 - t) ** 2 + b.d[0] * t**2 * (3 - 2 * t)
            + span * (slopes[0] * t * (1 - t) ** 2 - slopes[1] * t**2 * (1 - t)))


def _guide(a, b, lines, others):
    """Course (N,) and status (N,) of what leads through a gap: the nearest measured line, else the nearest lane; or None."""
    window = slice(a.last, b.first + 1)
    through = np.flatnonzero((np.isfinite(lines.d[:, window]) & lines.seen[:, window]).all(1))
    if len(through):
        nearest = through[np.argmin(np.abs(lines.d[through, a.last] - a.d[-1]))]
        return lines.d[nearest, window], np.full(b.first + 1 - a.last, INFERRED)
    through = [t for t in others if t.first <= a.last and t.last >= b.first]
    if not through:
        return None, None
    nearest = min(through, key=lambda t: abs(t.at(a.last)[0] - a.d[-1]))
    rows = slice(a.last - nearest.first, b.first + 1 - nearest.first)
    return nearest.d[rows], np.maximum(nearest.status[rows], INFERRED)


def _one_to_one(a, b, wa, wb, tracks):
    near = int(GAP_NEIGHBOURHOOD / STATION_STEP)
    starts = [t.d[max(b.first - t.first, 0)] for t in tracks
              if t is not a and a.last < t.first <= b.first + near and t.last >= b.first]
    ends = [t.d[min(a.last - t.first, len(t) - 1)] for t in tracks
            if t is not b and a.last - near <= t.last < b.first and t.first <= a.last]
    faced = sum(abs(d - a.d[-1]) < 0.5 * wa + 0.2 for d in starts)
    facing = sum(abs(d - b.d[0]) < 0.5 * wb + 0.2 for d in ends)
    return faced == 1 and facing == 1


def _crowded(track, other):
    a, b = max(track.first, other.first), min(track.last, other.last)
    if a > b:
        return False
    apart = np.abs(track.d[a - track.first:b - track.first + 1] - other.d[a - other.first:b - other.first + 1])
    return bool((apart < MIN_LANE_SEPARATION_SHARE * track.width[a - track.first:b - track.first + 1]).any())


def extend(tracks: list[LaneTrack], lines: CrossSections, bounding: np.ndarray, clear: Callable[[LaneTrack], bool],
           most_bridged: float) -> list[LaneTrack]:
    """Lead lanes on beside the one of their lines that goes on, as wide as they were.

    A lane stops where another lane is or a line cuts into it. Where that is within
    the length of a gap, the lane splits or merges in the gap, and there is no telling
    where: it is left open.
    """
    tracks = sorted(tracks, key=lambda t: (t.first, float(t.d[0])))
    for i in range(len(tracks)):
        for head in (False, True):
            more = _extension(tracks[i], tracks[:i] + tracks[i + 1:], lines, bounding, head, most_bridged)
            if more is not None and clear(more):
                tracks[i] = more.followed_by(tracks[i]) if head else tracks[i].followed_by(more)
    return tracks


def _extension(track, others, lines, bounding, head, most_bridged):
    tip = 0 if head else -1
    if track.status[tip] == BRIDGED:
        return None
    width = track.end_width(head)
    start = track.first if head else track.last
    ahead = np.arange(start - 1, -1, -1) if head else np.arange(start + 1, len(lines.s))
    best, best_line = 0, None
    for line in {int(track.left[tip]), int(track.right[tip])} - {-1}:
        length = _first_false(bounding[line, ahead] & lines.seen[line, ahead])
        if length > best and not _outside(track, lines, line, tip, start):
            best, best_line = length, line
    if best_line is None:
        return None
    # a short stretch of lane does not rule a long road
    best = min(best, int(max(most_bridged / STATION_STEP, MAX_EXTENSION_RATIO * np.count_nonzero(track.status != BRIDGED))))
    ahead = ahead[:best]
    # the lane keeps its place beside the line; half its width to the side it was on
    beside = track.d[tip] - lines.d[best_line, start]
    d = lines.d[best_line, ahead] + beside
    free = np.ones(best, bool)
    for other in others:
        inside = (ahead >= other.first) & (ahead <= other.last)
        free[inside] &= np.abs(other.d[ahead[inside] - other.first] - d[inside]) >= MIN_LANE_SEPARATION_SHARE * width
    cutting = bounding[:, ahead] & (np.abs(lines.d[:, ahead] - d) < INTRUSION_SHARE * width)
    free &= ~cutting.any(0)
    length = _first_false(free)
    if not length or length < best and length * STATION_STEP <= most_bridged and not _arrives(track, others, ahead[length], d[length], width):
        return None
    rows = slice(None, length)
    more = LaneTrack(int(min(ahead[rows])), *_filler(
        length, d[rows], np.full(length, width), INFERRED, True,
        best_line if best_line == track.left[tip] else -1, best_line if best_line == track.right[tip] else -1))
    return LaneTrack(more.first, *(v[::-1] for v in more._columns())) if head else more


def _outside(track, lines, line, tip, start):
    """Whether a lane lies outside an edge line: where another line bounds it, it may be one, but not beyond that."""
    edge = lines.d[line, start]
    return lines.kinds[line] == "edge" and (track.d[tip] - edge) * edge > 0


def _arrives(track, others, k, d, width):
    """Does the lane meet, at grid station k, another that is its own continuation?"""
    return any(abs(other.at(k)[0] - d) < MAX_LANE_JUMP_SHARE * min(width, other.at(k)[1]) for other in others)


def _first_false(mask):
    return len(mask) if mask.all() else int(np.argmin(mask))
