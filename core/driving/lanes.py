"""Lanes followed along the road, from the estimated cross-sections to tracks with offsets at every station, and their tapers."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import binary_dilation

from ..common.parallel import check_cancelled
from ..markings.cross_section.candidates import STATIONS_OF_CELL, Boundaries
from ..markings.cross_section.estimate import LaneSpan, RoadEstimate, lane_spans
from ..markings.cross_section.sections import STATION_STEP
from ..markings.cross_section.sequence import beside_island, beside_surface_end, lane_places
from .lane_track import BRIDGED, INFERRED, MEASURED, LaneTrack, spans_of
from .weights import TRACKS

BESIDE_ONE, BETWEEN_WORN, DIVIDED, BETWEEN_LINES = 1, 2, 3, 4   # ranks of lanes by how sure their place is; those between two lines are not moved
STATIONS_OF_STEP = int(TRACKS.step_length / STATION_STEP) + STATIONS_OF_CELL   # derived: of a lane's end that are looked at where it goes on


def estimated_lanes(boundaries: Boundaries, estimate: RoadEstimate, lane_width: float, line_distance: float = 0.0) -> list[LaneTrack]:
    """The lanes of a road, each from where it begins to where it ends or its interval has no lanes.

    `lane_width` : m, of a lane beside which only one line is painted; `line_distance` : m from that line to its middle, 0 for half of its width.
    """
    open_tracks: list[_OpenLane] = []
    closed: list[LaneTrack] = []
    spans: dict[int, list[LaneSpan]] = {}
    for span in lane_spans(estimate):
        spans.setdefault(span.interval, []).append(span)
    for i, (first, last) in enumerate(zip(estimate.candidates.first.tolist(), estimate.candidates.last.tolist())):
        parts = [part for span in spans.get(i, []) for part in [_part(boundaries, span, first, last, lane_width, line_distance)] if part is not None]
        follows = _followed(open_tracks, parts, first)
        closed += [LaneTrack.joined(lane.parts) for k, lane in enumerate(open_tracks) if k not in follows.values()]
        open_tracks = [_appended(open_tracks[follows[k]], part) if k in follows else _OpenLane([part], np.zeros(2)) for k, part in enumerate(parts)]
        check_cancelled()
    return [_to_its_ends(track, boundaries) for track in closed + [LaneTrack.joined(lane.parts) for lane in open_tracks]]


@dataclass
class _OpenLane:
    """A lane as far as it was followed: LaneTracks one after the other, and by how much its end is moved, m across and of width."""

    parts: list[LaneTrack]
    moved: np.ndarray

    def tail(self, stations: int) -> LaneTrack:
        """The last stations of the lane, so many of them as there are, which become its last part."""
        parts: list[LaneTrack] = []
        while self.parts and stations > 0:
            part = self.parts.pop()
            cut = max(len(part) - stations, 0)
            if cut:
                self.parts.append(part.part(0, cut))
            parts.insert(0, part.part(cut, len(part)))
            stations -= len(part) - cut
        self.parts.append(LaneTrack.joined(parts))
        return self.parts[-1]

    def since_surer(self, rank: int) -> int:
        """How many stations at its end there are from the last one on whose rank is above `rank`."""
        count = 0
        for part in reversed(self.parts):
            surer = np.flatnonzero(_rank(part) > rank)
            count += len(part) - (int(surer[-1]) if len(surer) else 0)
            if len(surer):
                break
        return count


def _to_its_ends(track, boundaries):
    """The track up to where its two borders begin and end: intervals are coarser than stations."""
    track = _within_its_borders(track, boundaries)
    for head in (True, False):
        tip = 0 if head else -1
        left, right = int(track.left[tip]), int(track.right[tip])
        if min(left, right) < 0 or not boundaries.painted[[left, right]].all():
            continue
        end = track.first if head else track.last
        reach, last = STATIONS_OF_CELL, len(boundaries.s) - 1
        ahead = np.arange(end - 1, max(end - reach, 0) - 1, -1) if head else np.arange(end + 1, min(end + reach, last) + 1)
        bounded = np.isfinite(boundaries.d[left, ahead]) & np.isfinite(boundaries.d[right, ahead])
        ahead = ahead[:len(bounded) if bounded.all() else int(np.argmin(bounded))]
        if len(ahead):
            ahead = np.sort(ahead)
            d_left, d_right = boundaries.d[left, ahead], boundaries.d[right, ahead]
            more = track.stretched(int(ahead[0]), (d_left + d_right) / 2, d_left - d_right, tip)
            track = LaneTrack.joined([more, track] if head else [track, more])
    return track


def _within_its_borders(track, boundaries):
    """The track less the stations at its ends where a painted border has ended more than a station before."""
    columns, bounded = np.arange(track.first, track.last + 1), np.ones(len(track), bool)
    for rows in (track.left, track.right):
        bounding = (rows >= 0) & boundaries.bounding[rows]
        bounded &= ~bounding | np.isfinite(boundaries.d[rows, columns])
    present = np.flatnonzero(binary_dilation(bounded))
    return track.part(present[0], present[-1] + 1) if len(present) else track


def _rank(track):
    """(N,) how sure the place of a lane is: beside one line, between worn ones, in a strip of several lanes, or between two lines that are seen."""
    between = (track.left >= 0) & (track.right >= 0)
    return np.where(track.status == MEASURED, BETWEEN_LINES, np.where(track.offset, BESIDE_ONE, np.where(between, BETWEEN_WORN, DIVIDED)))


def _appended(found, part):
    """A track and the part that follows it; of the two the one whose place is less sure is moved to meet the other, and takes its width.

    It is moved as far as it is less sure: a stretch between two that are sure ends in both. A border that is a line in both stays on it. Of two
    that are as sure as each other the second stays moved as the first was (`moved`, m across and of width), and what else they differ by, as
    where a line between them steps aside, is evened out there. What is given is the lane with the part.
    """
    # between lines that are seen on both sides of the joint nothing is moved
    if found.parts[-1].status[-1] == part.status[0] == MEASURED:
        return _OpenLane([*found.parts, part], np.zeros(2))
    track, moved = found.tail(STATIONS_OF_STEP), found.moved
    step = np.array([track.d[-1] - part.d[0], track.width[-1] - part.width[0]])
    before, after = _rank(track), _rank(part)
    before, after = _with_lines_up_to(before[::-1], after)[::-1], _with_lines_up_to(after, before[::-1])
    if after[0] > before[-1]:
        # the lane is moved back to where its place was surer
        track = found.tail(found.since_surer(before[-1]))
        return _OpenLane([*found.parts[:-1], _shifted(track, -step, _held(_rank(track)[::-1])[::-1]), part], np.zeros(2))
    weights = _held(after)
    if after[0] < before[-1] or after[0] == BESIDE_ONE:
        return _OpenLane([*found.parts, _shifted(part, step, weights)], step * weights[-1])
    shift = (step - moved) / 2
    track = _shifted(track, -shift, _evened(before[::-1])[::-1])
    return _OpenLane([*found.parts[:-1], track, _shifted(_shifted(part, moved, weights), shift, _evened(after))], moved * weights[-1])


def _with_lines_up_to(rank, other):
    """(N,) ranks from a joint on, with the lane as sure as between its lines up to where these end, if the `other` (M,) beyond the joint is divided.

    Intervals are coarser than stations: that the lines end within one is no gap between two stretches of them, but why the strip beyond is divided.
    """
    lines = np.flatnonzero(rank == BETWEEN_LINES)
    if other[0] != DIVIDED or not len(lines) or lines[0] >= STATIONS_OF_CELL or (rank[:lines[0]] != BETWEEN_WORN).any():
        return rank
    return np.r_[np.full(lines[0], BETWEEN_LINES), rank[lines[0]:]]


def _shifted(track, step, share):
    """A track moved across and widened by shares, (N,), of a step: m across and of width."""
    return replace(track, d=track.d + step[0] * share, width=track.width + step[1] * share, aside=track.aside + step[0] * share)


def _held(rank):
    """(N,) share of a step at their first place by which places of some rank are moved: all of it, or less and less up to a surer place."""
    surer = np.flatnonzero(rank > rank[0])
    return np.clip(1 - np.arange(len(rank)) / (surer[0] if len(surer) else np.inf), 0, None)


def _evened(rank):
    """(N,) the same of a step that is evened out where it is."""
    return np.minimum(_held(rank), np.clip(1 - np.arange(len(rank)) * STATION_STEP / TRACKS.step_length, 0, None))


def _part(boundaries, span, first, last, lane_width, line_distance):
    """The LaneTrack of a span, None where one of its borders is not known."""
    rows, sides = slice(first, last + 1), (span.left, span.right)
    left, right = (_filled(boundaries.d[row, rows]) for row in sides)
    if left is None or right is None:
        return None
    painted = [bool(boundaries.bounding[row]) for row in sides]
    made_of = [int(np.bincount(boundaries.patterns[row, rows]).argmax()) for row in sides]
    seen = np.stack([boundaries.seen[row, rows] for row in sides])
    begin, width = lane_places(left, right, *made_of, span.count, lane_width, boundaries.bend[rows])
    between_both = all(painted) or not line_distance and _has_all_room(made_of, seen, left - right - span.count * width)
    beside_one = any(painted) and not between_both
    if beside_one and (line_distance or beside_surface_end(*made_of)):
        # the end of the surface is ragged, a lane is not
        width = np.full(len(left), 2 * line_distance or np.median(width))
        begin = left if painted[0] else right + width * span.count
    d = begin - width * (span.count - span.place - 0.5)
    shown = seen.sum(axis=0) if between_both else seen[painted].sum(axis=0)
    status = np.choose(shown, [BRIDGED, INFERRED, MEASURED if span.count == 1 else INFERRED])
    return _track_of(span, first, d, width, status, beside_one)


def _has_all_room(made_of, seen, left_over):
    """Whether a lane has all the room between a line and the curb of an island: it is placed by both."""
    return bool(beside_island(*made_of)) and seen.mean(axis=1).min() > 0.5 and float(np.median(np.abs(left_over))) < TRACKS.full_room


def _track_of(span, first, d, width, status, beside_one):
    """The LaneTrack of a span at some places, (N,) m; `beside_one` : whether the place comes from one line only."""
    left = span.left if span.place == span.count - 1 else -1
    right = span.right if span.place == 0 else -1
    values = (beside_one, left, right, span.left_border, span.right_border, span.probability, span.confidence, span.directed)
    second = np.full(len(d), None, object)
    second[:] = [span.second] * len(d)
    return LaneTrack(first, d, width, status, *(np.full(len(d), value) for value in values), span.direction, second)


def _filled(values):
    """Offsets with those that are missing at the ends of an interval."""
    finite = np.flatnonzero(np.isfinite(values))
    return np.interp(np.arange(len(values)), finite, values[finite]) if len(finite) else None


def _followed(found, parts, first):
    """{part: track} of the parts that go on as a track which ends right before them, one to one, the nearest first.

    An end that was moved to meet a surer stretch before it is no farther from what follows than where it was seen.
    """
    pairs = []
    for k, part in enumerate(parts):
        for j, lane in enumerate(found):
            track = lane.parts[-1]
            step = min(abs(part.d[0] - track.d[-1]), abs(part.d[0] - track.d[-1] + lane.moved[0]))
            if track.last == first - 1 and track.direction == part.direction \
                    and step < TRACKS.max_lane_jump_share * min(part.width[0], track.width[-1]):
                pairs.append((step, k, j))
    follows, used = {}, set()
    for _, k, j in sorted(pairs):
        if k not in follows and j not in used:
            follows[k] = j
            used.add(j)
    return follows


# Lanes that open or close beside another one along a taper.
#
# A lane that opens is driven from where it has its full width; up to there traffic stays in the lane beside it, which keeps its width although the
# line along its side has moved away already (as exit and turning lanes are laid out, e.g. RAA 6.4, RASt 6.3, AASHTO Green Book 9.7 and 10.9).


def laid_out(tracks: list[LaneTrack]) -> list[LaneTrack]:
    """The same lanes with through lanes as wide along tapers as beside the lanes that open there, and these from their full width on."""
    # each end of a lane with the lanes that lead on beside it, and where
    spans, openings = spans_of(tracks), []
    for k, head in ((k, head) for k in range(len(tracks)) for head in (True, False)):
        before = tracks[k].first - 1 if head else tracks[k].last + 1
        neighbours = [(j, _opening(tracks[k], tracks[j], head)) for j in spans.near(before, before).tolist() if j != k] if before >= 0 else []
        openings.append((k, head, [(j, station) for j, station in neighbours if station is not None]))
    through = [replace(track, d=track.d.copy(), width=track.width.copy(), status=track.status.copy()) for track in tracks]
    for k, head, opening_lanes in openings:
        for j, station in opening_lanes:
            _keep_width(through[j], tracks[k], station, head)
    for k, head, opening_lanes in openings:
        if opening_lanes:
            through[k] = _from_full_width(through[k], head)
    return through


def _opening(lane, other, head):
    """The station at which a lane that begins (or ends) first lies right beside another one that continues there; None where it does not.

    The other one may reach over its very beginning: lanes are distinguished by intervals, which are coarser than stations.
    """
    end, step = (lane.first, 1) if head else (lane.last, -1)
    if lane.direction != other.direction or not other.first <= end - step <= other.last:
        return None
    for station in range(end, end + step * min(STATIONS_OF_CELL + 1, len(lane)), step):
        (d, width), (d_other, width_other) = lane.at(station), other.at(station)
        if abs(abs(d - d_other) - (width + width_other) / 2) < TRACKS.missing_share * width_other:
            return station
    return None


def _keep_width(track, opens, at, head):
    """Make a through lane, in place, that before (or behind) the grid station at which another one lies beside it first no wider than beside that."""
    side = np.sign(opens.at(at)[0] - track.at(at)[0])
    at -= track.first
    margin, reach = int(TRACKS.end_width_length / STATION_STEP), int(TRACKS.longest_taper / STATION_STEP)
    widths = track.width[at:at + margin] if head else track.width[max(at - margin + 1, 0):at + 1]
    width = float(np.median(widths))
    ahead = np.arange(at - 1, max(at - reach, 0) - 1, -1) if head else np.arange(at + 1, min(at + reach, len(track) - 1) + 1)
    wider = track.width[ahead] > width + TRACKS.least_widening
    begin = int(np.argmax(wider))
    as_wide = np.flatnonzero(~wider[begin:])
    # a lane that is as wide all along divides into two, and has no taper
    if not wider[:int(TRACKS.border_before_lane / STATION_STEP)].any() or not (len(as_wide) or _narrows(track.width[ahead[begin:]] - width)):
        return
    ahead = ahead[begin:begin + int(as_wide[0])] if len(as_wide) else ahead[begin:]
    track.d[ahead] -= side * (track.width[ahead] - width) / 2
    track.width[ahead] = width
    track.status[ahead] = np.maximum(track.status[ahead], INFERRED)


def _narrows(excess):
    """Whether a lane that is wider by (N,) m as far as it is known becomes narrower all along, as beside a taper that ends farther on."""
    distance = STATION_STEP * np.arange(len(excess))
    if len(excess) < 2 or distance[-1] < TRACKS.shown_taper:
        return False
    slope = np.polyfit(distance, excess, 1)[0]
    return slope < 0.0 and distance[-1] + excess[-1] / -slope <= TRACKS.longest_taper


def _from_full_width(track, head):
    """A lane less what it is narrower than its full width at its beginning (or end)."""
    reach = int(TRACKS.longest_taper / STATION_STEP)
    width = track.width[:reach] if head else track.width[::-1][:reach]
    full = np.flatnonzero(width >= TRACKS.full_share * np.median(width))
    first = int(full[0])
    return track.part(first, len(track)) if head else track.part(0, len(track) - first)
