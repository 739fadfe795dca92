"""Lanes that open or close beside another one along a taper.

A lane that opens is driven from where it has its full width; up to there traffic stays in the lane beside it, which keeps its width although the
line along its side has moved away already (as exit and turning lanes are laid out, e.g. RAA 6.4, RASt 6.3, AASHTO Green Book 9.7 and 10.9).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..markings.cross_section.candidates import STATIONS_OF_CELL
from ..markings.cross_section.sections import STATION_STEP
from .lane_track import END_WIDTH_LENGTH, INFERRED, LaneTrack, spans_of

LONGEST_TAPER = 100.0     # m
SHOWN_TAPER = 8.0         # m of a taper that show its course where the survey ends before it does
FULL_SHARE = 0.9          # of a lane's width: from there on it is taken to have its full width
LEAST_WIDENING = 0.05     # m: less is how lines are painted
BORDER_BEFORE_LANE = 30.0  # m by which the line between the two may begin before the lane is broad enough to be one: 2 m at one in ten, and a gap
MISSING_SHARE = 0.25      # of a lane's width by which two lanes beside each other may be apart or overlap


def laid_out(tracks: list[LaneTrack]) -> list[LaneTrack]:
    """The same lanes with through lanes as wide along tapers as beside the lanes that open there, and these from their full width on."""
    # each end of a lane with the lanes that lead on beside it, and where
    spans, beside = spans_of(tracks), []
    for k, head in ((k, head) for k in range(len(tracks)) for head in (True, False)):
        before = tracks[k].first - 1 if head else tracks[k].last + 1
        found = [(j, _opening(tracks[k], tracks[j], head)) for j in spans.near(before, before).tolist() if j != k] if before >= 0 else []
        beside.append((k, head, [(j, at) for j, at in found if at is not None]))
    through = [replace(track, d=track.d.copy(), width=track.width.copy(), status=track.status.copy()) for track in tracks]
    for k, head, others in beside:
        for j, at in others:
            _keep_width(through[j], tracks[k], at, head)
    for k, head, others in beside:
        if others:
            through[k] = _from_full_width(through[k], head)
    return through


def _opening(lane, other, head):
    """The station at which a lane that begins (or ends) first lies right beside another one that leads on there; None where it does not.

    The other one may reach over its very beginning: lanes are told apart by intervals, which are coarser than stations.
    """
    end, step = (lane.first, 1) if head else (lane.last, -1)
    if lane.direction != other.direction or not other.first <= end - step <= other.last:
        return None
    for at in range(end, end + step * min(STATIONS_OF_CELL + 1, len(lane)), step):
        (d, width), (d_other, width_other) = lane.at(at), other.at(at)
        if abs(abs(d - d_other) - (width + width_other) / 2) < MISSING_SHARE * width_other:
            return at
    return None


def _keep_width(track, opens, at, head):
    """Make a through lane, in place, that before (or behind) the grid station at which another one lies beside it first no wider than beside that."""
    side = np.sign(opens.at(at)[0] - track.at(at)[0])
    at -= track.first
    near, reach = int(END_WIDTH_LENGTH / STATION_STEP), int(LONGEST_TAPER / STATION_STEP)
    beside = track.width[at:at + near] if head else track.width[max(at - near + 1, 0):at + 1]
    width = float(np.median(beside))
    ahead = np.arange(at - 1, max(at - reach, 0) - 1, -1) if head else np.arange(at + 1, min(at + reach, len(track) - 1) + 1)
    wider = track.width[ahead] > width + LEAST_WIDENING
    begin = int(np.argmax(wider))
    as_wide = np.flatnonzero(~wider[begin:])
    # a lane that is as wide all along divides into two, and has no taper
    if not wider[:int(BORDER_BEFORE_LANE / STATION_STEP)].any() or not (len(as_wide) or _narrows(track.width[ahead[begin:]] - width)):
        return
    ahead = ahead[begin:begin + int(as_wide[0])] if len(as_wide) else ahead[begin:]
    track.d[ahead] -= side * (track.width[ahead] - width) / 2
    track.width[ahead] = width
    track.status[ahead] = np.maximum(track.status[ahead], INFERRED)


def _narrows(excess):
    """Whether a lane that is wider by (N,) m as far as it is known becomes narrower all along, as beside a taper that ends farther on."""
    along = STATION_STEP * np.arange(len(excess))
    if len(excess) < 2 or along[-1] < SHOWN_TAPER:
        return False
    slope = np.polyfit(along, excess, 1)[0]
    return slope < 0.0 and along[-1] + excess[-1] / -slope <= LONGEST_TAPER


def _from_full_width(track, head):
    """A lane less what it is narrower than its full width at its beginning (or end)."""
    reach = int(LONGEST_TAPER / STATION_STEP)
    width = track.width[:reach] if head else track.width[::-1][:reach]
    full = np.flatnonzero(width >= FULL_SHARE * np.median(width))
    first = int(full[0])
    return track.part(first, len(track)) if head else track.part(0, len(track) - first)
