"""Lanes followed along the road: from the cross-sections that were estimated to tracks with offsets at every station."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..markings.cross_section.candidates import STATIONS_OF_CELL, Boundaries, surface_lane_width
from ..markings.cross_section.estimate import LaneSpan, RoadEstimate, lane_spans
from ..markings.cross_section.weights import OPEN, SURFACE
from .lane_track import BRIDGED, INFERRED, MEASURED, LaneTrack

BETWEEN_LINES = 4       # rank of lanes between two lines that are seen: these are not moved
MAX_STEP_SHARE = 0.35   # of a lane's width by which it may move from one interval to the next


def estimated_lanes(boundaries: Boundaries, estimate: RoadEstimate, lane_width: float, line_distance: float = 0.0) -> list[LaneTrack]:
    """The lanes of a road, each from where it begins to where it ends or its interval has no lanes.

    Parameters
    ----------
    boundaries : Boundaries
    estimate : RoadEstimate over them
    lane_width : metres, of a lane beside which only one line is painted; line_distance : metres from that line to its middle, 0 for half of its width
    """
    open_tracks: list[LaneTrack] = []
    closed: list[LaneTrack] = []
    spans: dict[int, list[LaneSpan]] = {}
    for span in lane_spans(estimate):
        spans.setdefault(span.interval, []).append(span)
    for i, (first, last) in enumerate(zip(estimate.candidates.first.tolist(), estimate.candidates.last.tolist())):
        parts = [part for span in spans.get(i, []) for part in [_part(boundaries, span, first, last, lane_width, line_distance)] if part is not None]
        follows = _followed(open_tracks, parts, first)
        closed += [track for k, track in enumerate(open_tracks) if k not in follows.values()]
        open_tracks = [_appended(open_tracks[follows[k]], part) if k in follows else part for k, part in enumerate(parts)]
    return [_to_its_ends(track, boundaries) for track in closed + open_tracks]


def _to_its_ends(track, boundaries):
    """The track up to where its two borders begin and end: intervals are coarser than stations."""
    for head in (True, False):
        tip = 0 if head else -1
        left, right = int(track.left[tip]), int(track.right[tip])
        if min(left, right) < 0:
            continue
        at = track.first if head else track.last
        reach, last = STATIONS_OF_CELL, len(boundaries.s) - 1
        ahead = np.arange(at - 1, max(at - reach, 0) - 1, -1) if head else np.arange(at + 1, min(at + reach, last) + 1)
        both = np.isfinite(boundaries.d[left, ahead]) & np.isfinite(boundaries.d[right, ahead])
        ahead = ahead[:len(both) if both.all() else int(np.argmin(both))]
        if len(ahead):
            ahead = np.sort(ahead)
            d_left, d_right = boundaries.d[left, ahead], boundaries.d[right, ahead]
            size = len(ahead)
            more = LaneTrack(int(ahead[0]), (d_left + d_right) / 2, d_left - d_right, np.full(size, track.status[tip]),
                             np.full(size, track.offset[tip]), np.full(size, left), np.full(size, right), track.direction,
                             np.full(size, track.confidence[tip]), np.repeat(track.borders[tip][None], size, axis=0))
            track = more.followed_by(track) if head else track.followed_by(more)
    return track


def _rank(track):
    """(N,) how sure the place of a lane is: 1 beside one line, 2 between worn lines, 3 divided, 4 between two lines that are seen."""
    between = (track.left >= 0) & (track.right >= 0)
    return np.select([track.status == MEASURED, between, ~track.offset], [BETWEEN_LINES, 2, 3], 1)


def _appended(track, part):
    """A track and the part that follows it; of the two the one whose place is less sure is moved to meet the other.

    It is moved as far as it is less sure: a stretch between two that are sure ends in both.
    """
    step = track.d[-1] - part.d[0]
    before, after = _rank(track), _rank(part)
    if after[0] < before[-1] or after[0] == before[-1] < BETWEEN_LINES:
        end = _first(after > after[0])
        share = 1.0 if end is None else np.clip(1 - np.arange(len(part)) / end, 0, None)
        part = replace(part, d=part.d + step * share)
    elif after[0] > before[-1]:
        end = _first(before[::-1] > before[-1])
        share = 1.0 if end is None else np.clip(1 - np.arange(len(track)) / end, 0, None)[::-1]
        track = replace(track, d=track.d - step * share)
    return track.followed_by(part)


def _first(mask):
    found = np.flatnonzero(mask)
    return int(found[0]) if len(found) else None


def _part(boundaries, span, first, last, lane_width, line_distance):
    """The LaneTrack of a span, None where neither of its borders is known."""
    rows = slice(first, last + 1)
    left, right = boundaries.d[span.left, rows], boundaries.d[span.right, rows]
    left, right = _filled(left), _filled(right)
    if left is None or right is None:
        return None
    painted = boundaries.bounding[span.left], boundaries.bounding[span.right]
    seen = [boundaries.seen[row, rows] & paint for row, paint in zip((span.left, span.right), painted)]
    size = last - first + 1
    width = (left - right) / span.count
    if painted[0] != painted[1]:
        # beside a curb or the end of the surface a lane is no wider than usual
        other = span.right if painted[0] else span.left
        hidden = boundaries.made_of[other] in (SURFACE, OPEN)
        width = surface_lane_width(left - right, span.count, lane_width, boundaries.bend[rows]) if hidden else np.minimum(width, lane_width)
        width = np.full(size, 2 * line_distance) if line_distance else width
        right = right if painted[1] else left - width * span.count
    d = right + width * (span.place + 0.5)
    offset = np.full(size, painted[0] != painted[1])
    both = seen[0].astype(int) + seen[1]
    status = np.choose(both, [BRIDGED, INFERRED, MEASURED if span.count == 1 else INFERRED])
    at_left, at_right = span.place == span.count - 1, span.place == 0
    borders = [span.left if at_left else -1, span.right if at_right else -1, span.left_border, span.right_border]
    return LaneTrack(first, d, width, status, offset, np.full(size, span.left if boundaries.painted[span.left] and at_left else -1),
                     np.full(size, span.right if boundaries.painted[span.right] and at_right else -1), span.direction, np.full(size, span.confidence),
                     np.repeat([borders], size, axis=0))


def _filled(values):
    """Offsets with those that are missing at the ends of an interval."""
    known = np.flatnonzero(np.isfinite(values))
    return np.interp(np.arange(len(values)), known, values[known]) if len(known) else None


def _followed(tracks, parts, first):
    """{part: track} of the parts that go on as a track which ends right before them, one to one, the nearest first."""
    pairs = []
    for k, part in enumerate(parts):
        for j, track in enumerate(tracks):
            step = abs(part.d[0] - track.d[-1])
            if track.last == first - 1 and track.direction == part.direction \
                    and step < MAX_STEP_SHARE * min(part.width[0], track.width[-1]):
                pairs.append((step, k, j))
    found, used = {}, set()
    for _, k, j in sorted(pairs):
        if k not in found and j not in used:
            found[k] = j
            used.add(j)
    return found
