"""Which way each lane is driven."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .cross_section import STATION_STEP

if TYPE_CHECKING:
    from ..survey.frame.road_frame import RoadFrame
    from .cross_section import CrossSections
    from .lane_tracking import LaneTrack

MAX_DIVIDE_PAUSE = 30.0     # m: where a centre line pauses for less, the divide goes on from end to end
MIN_DRIVEN_SHARE = 0.6


def driven_offsets(frame: RoadFrame, road: int, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the vehicle drove.

    Parameters
    ----------
    frame : RoadFrame
    road : int, number of the road
    s : (K,) metres, stations

    Returns
    -------
    d : (P, K) metres, offset of every pass; NaN where it did not drive
    direction : (P,) int, 1 along the road's reference line, -1 against it
    """
    passes = frame.passes_of(road)
    d = np.full((len(passes), len(s)), np.nan)
    for row, p in zip(d, passes):
        first, last = p.span
        there = (s >= first) & (s <= last)
        row[there] = p.at_station(s[there])[0]
    return d, np.array([p.direction for p in passes], int)


def divide(lines: CrossSections, tracks: list[LaneTrack], driven: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(K,) metres, offset of what separates the two directions of traffic, NaN where nothing does.

    A line called centre line or drawn double with lanes on both sides; passes that
    drove against each other; else the middle between an even number of lanes.
    """
    lanes_left, lanes_right = np.zeros((2,) + lines.d.shape, bool)
    middles = _lane_offsets(tracks, len(lines.s))
    for row in middles:
        with np.errstate(invalid="ignore"):
            lanes_left |= row > lines.d
            lanes_right |= row < lines.d
    central = np.array(["double" in pattern or kind == "centre" for kind, pattern in zip(lines.kinds, lines.patterns)])
    shown = central[:, None] & lanes_left & lanes_right
    count = shown.sum(0)
    with np.errstate(invalid="ignore", divide="ignore"):
        found = np.where(count, np.where(shown, lines.d, 0.0).sum(0) / count, np.nan)
    for fallback in (_between_passes(driven, directions, middles), _middle_of_lanes(middles, driven, directions)):
        found = _bridged(found)
        found = np.where(np.isnan(found), fallback, found)
    return found


def _lane_offsets(tracks, count):
    """(T, K) offsets of the lanes."""
    d = np.full((len(tracks), count), np.nan)
    for row, track in zip(d, tracks):
        row[track.first:track.last + 1] = track.d
    return d


def _bridged(values):
    known = np.flatnonzero(np.isfinite(values))
    if not len(known):
        return values
    every = np.arange(len(values))
    nearest = np.abs(every - known[np.searchsorted(known, every).clip(0, len(known) - 1)])
    before = known[(np.searchsorted(known, every, "right") - 1).clip(0)]
    gap = np.minimum(nearest, np.abs(every - before))
    return np.where(gap * STATION_STEP <= MAX_DIVIDE_PAUSE, np.interp(every, known, values[known]), np.nan)


def _between_passes(driven, directions, middles):
    along, against = (_mean(driven[directions == way]) for way in (1, -1))
    middle = (along + against) / 2
    middle[np.abs(along - against) < 1.5] = np.nan
    return _snapped(middle, middles)


def _snapped(middle, middles):
    """The middle of the two neighbouring lanes between which a place lies, where it lies between two."""
    if not len(middles):
        return middle
    with np.errstate(invalid="ignore"):
        above = np.where(middles > middle, middles, np.inf).min(0)
        below = np.where(middles < middle, middles, -np.inf).max(0)
    both = np.isfinite(above) & np.isfinite(below)
    return np.where(both, (np.where(both, above, 0) + np.where(both, below, 0)) / 2, middle)


def _mean(rows):
    present = np.isfinite(rows)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(present, rows, 0.0).sum(0) / present.sum(0)


def _middle_of_lanes(middles, driven, directions):
    """Half of the lanes to each side; NaN where one-way traffic is seen on both sides of it."""
    if not len(middles):
        return np.full(middles.shape[1] if middles.ndim == 2 else 0, np.nan)
    count = np.isfinite(middles).sum(0)
    ranked = np.sort(np.where(np.isfinite(middles), middles, np.inf), axis=0)
    half = np.clip(count // 2, 1, max(len(middles) - 1, 1))
    columns = np.arange(middles.shape[1])
    even = (count >= 2) & (count % 2 == 0)
    upper = ranked[np.minimum(half, len(ranked) - 1), columns]
    with np.errstate(invalid="ignore"):
        found = np.where(even, (ranked[half - 1, columns] + upper) / 2, np.nan)
    for way in (1, -1):
        sides = np.sign(driven[directions == way] - found)
        if (sides > 0).any() and (sides < 0).any():
            left, right = (sides > 0).sum(), (sides < 0).sum()
            if min(left, right) > 0.3 * max(left, right):
                return np.full(len(found), np.nan)
    return found


def side_votes(middle: np.ndarray, driven: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Metres driven right and left of the divide, as seen by the driver."""
    with np.errstate(invalid="ignore"):
        right = (driven - middle) * directions[:, None] < -0.3
        left = (driven - middle) * directions[:, None] > 0.3
    return STATION_STEP * np.array([right.sum(), left.sum()])


def lane_directions(tracks: list[LaneTrack], middle: np.ndarray, driven: np.ndarray, directions: np.ndarray, side: str, asked: bool) -> list[int]:
    """(T,) direction of each lane, 1 along the road's reference, -1 against it.

    side : "right" or "left"; asked : True where the user named it, which then counts
    more than what the vehicle did
    """
    found = []
    for track in tracks:
        window = slice(track.first, track.last + 1)
        with np.errstate(invalid="ignore"):
            inside = np.abs(driven[:, window] - track.d) < 0.5 * track.width
        share = inside.mean(1) if len(inside) else np.zeros(0)
        # the lane that the vehicle drove in needs no reasoning
        used = directions[share > MIN_DRIVEN_SHARE] if len(share) else np.zeros(0)
        offset = (track.d - middle[window])[np.isfinite(middle[window])]
        if len(used) and not asked and abs(used.sum()) == len(used):
            found.append(int(used[0]))
        elif len(offset):
            left = np.median(offset) > 0
            found.append(1 if left == (side == "left") else -1)
        else:
            found.append(_beside_vehicle(track, driven[:, window], directions, side))
    return found


def _beside_vehicle(track, driven, directions, side):
    """No divide is known: lanes on the driver's outer side go his way; so does a lane alone on its road."""
    known = np.isfinite(driven).any(1) if len(driven) else np.zeros(0, bool)
    if not known.any():
        return 1
    return int(directions[known][0])
