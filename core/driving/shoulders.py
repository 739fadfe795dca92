"""Shoulders: the paved strips between the edge line of the outermost lane and the edge of the pavement."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.arrays import mask_runs
from ..markings.cross_section.sections import STATION_STEP, CrossSections
from ..markings.cross_section.weights import EDGE_LINE
from .lane_track import LaneTrack, spans_of

if TYPE_CHECKING:
    from ..markings.cross_section.roads import EstimatedRoad
    from ..survey.frame.road_frame import RoadFrame

STRIP_WIDTH = 0.3, 4.0       # m of a strip at any place: the widest paved shoulders are 12 ft (AASHTO, A Policy on Geometric Design, 4.4.2)
LEAST_SHOULDER = 1.0         # m, median: what is narrower is the marginal strip of the carriageway (0.5 to 0.75 m, RAA)
SHORTEST_SHOULDER = 10.0     # m


def shoulders(road: EstimatedRoad, tracks: list[LaneTrack], borders: list[list[np.ndarray]], pavement: CrossSections, frame: RoadFrame,
              number: int) -> list[dict[str, Any]]:
    """Areas between the edge lines of lanes and the edges of the pavement beside them.

    Where a curb bounds the road the strip beside the line may be for parking, cycling or nothing, so it is not named.

    Parameters
    ----------
    road : EstimatedRoad
    tracks : list of LaneTrack
    borders : the left and the right border of each track along the road, (N, 3) local metres each
    pavement : CrossSections of the edges of the pavement without a curb
    frame : RoadFrame
    number : of the road

    Returns
    -------
    rows of Lanes without numbers, left and right along the road; each has the vertices of the lane beside it
    """
    s, lines = road.lines.s, road.lines
    shift = int(np.rint((s[0] - pavement.s[0]) / STATION_STEP))   # stations by which the grid of the lines begins behind that of the pavement
    rows, spans = [], spans_of(tracks)
    for track, (left, right) in zip(tracks, borders):
        columns = np.arange(track.first, track.last + 1)
        for sign, own, use, border in ((1, track.left, track.left_use, left), (-1, track.right, track.right_use, right)):
            inner = track.d + sign * track.width / 2
            nearest, width = _nearest_edge(pavement, columns[0] + shift, inner, sign)
            others = [tracks[k] for k in spans.near(track.first, track.last).tolist()]
            wide = np.isfinite(width) & (use == EDGE_LINE) & (own >= 0) & (own < len(lines.d)) & ~_taken(others, track, inner, sign)
            for a, b in mask_runs(wide):
                if (b - a - 1) * STATION_STEP < SHORTEST_SHOULDER or np.median(width[a:b]) < LEAST_SHOULDER:
                    continue
                part, edge = slice(a, b), nearest[a:b]
                places = columns[part] + shift
                x, y = frame.roads[number].to_map(s[columns[part]], inner[part] + sign * width[part])
                z = pavement.z[edge, places]
                outer = np.c_[x, y, np.where(np.isfinite(z), z, border[part, 2])]
                seen = bool(pavement.seen[edge, places].mean() > 0.5)
                middle = inner[part] + sign * width[part] / 2
                drawn = lines.drawn[own[part], columns[part]]
                about = [(f"line {_usual(lines.number[own[part], columns[part]])}", "edge", lines.names[_usual(drawn)]),
                         (f"edge {_usual(pavement.number[edge, places])}", "pavement", "")]
                strip = [border[part], outer]
                rows.append(dict(
                    road=number, type="shoulder", direction=0, left=strip[sign > 0], right=strip[sign < 0], about=about[::-sign],
                    status="measured" if seen else "inferred", confidence=float(track.confidence[part].mean()), station=float(s[columns[a]]),
                    end=float(s[columns[b - 1]]), first=float(middle[0]), last=float(middle[-1]), width=float(np.median(width[part]))))
    return rows


def _nearest_edge(pavement, first, inner, sign):
    """Which edge of the pavement lies nearest beside a border, (N,) m from station `first` on, and how far, m; inf where none does."""
    nearest, width = np.zeros(len(inner), int), np.full(len(inner), np.inf)
    spans = pavement.d.spans
    for row in spans.near(int(first), int(first) + len(inner) - 1).tolist():
        own = slice(max(int(spans.first[row] - first), 0), min(int(spans.end[row] - first), len(inner)))
        away = sign * (pavement.d[row, own.start + first:own.stop + first] - inner[own])
        nearer = (away >= STRIP_WIDTH[0]) & (away <= STRIP_WIDTH[1]) & (away < width[own])
        nearest[own], width[own] = np.where(nearer, row, nearest[own]), np.where(nearer, away, width[own])
    return nearest, width


def _usual(numbers):
    """The most frequent of some numbers, those below 0 left out; 0 where there are no others."""
    known = numbers[numbers >= 0]
    return int(np.bincount(known).argmax()) if len(known) else 0


def _taken(tracks, own, inner, sign):
    """(N,) bool, where another lane lies on the far side of a border of this one."""
    found = np.zeros(len(own), bool)
    for other in tracks:
        a, b = max(own.first, other.first), min(own.last, other.last)
        if other is own or a > b:
            continue
        here, there = slice(a - own.first, b - own.first + 1), slice(a - other.first, b - other.first + 1)
        apart = sign * (other.d[there] - inner[here])
        found[here] |= (apart > 0) & (apart < STRIP_WIDTH[1] + other.width[there] / 2)
    return found
