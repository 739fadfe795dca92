"""The first track: in every short window of time, the place around which points lie densest, on the ridge of density."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....curves.robust import robustly_smoothed

WINDOW = 0.1             # s: the vehicle gets a few metres, every mirror turns once at least
MIN_WINDOW_SAMPLES = 30
MAX_WINDOW_SAMPLES = 1000   # used of a window
MIN_STEP = 0.02          # m in a window: below, the direction is noise and the vehicle stands
BACKING_STEP = 2.0       # m: no vehicle turns about within that
DENSITY_WIDTH = 2.6      # m: the half width of the density under a scanner at its usual height
GROUND_WEIGHT_DEPTH = 0.4       # m either side of the ground: points there weigh at least a half
LOWEST_SHARE = 0.25      # of a window's points lie below the ground as first guessed
DENSITY_ROUNDS = 15
TRACK_STIFFNESS = 300.0  # (0.5 m of scatter / 0.03 m by which a braking vehicle's place differs from even motion in a window)^2


@dataclass
class FirstTrack:
    """The rough track of one drive.

    time : (W,) s, middles of windows
    foot : (W, 3) m, on the ground
    heading : (W,) radians, where the vehicle looked ahead, counter-clockwise from east, continuous
    count : (W,) samples
    reach : (W,) m, median horizontal distance of the samples from the densest place
    """

    time: np.ndarray
    foot: np.ndarray
    heading: np.ndarray
    count: np.ndarray
    reach: np.ndarray

    def at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(N, 3) feet and (N,) headings at (N,) times."""
        return (np.stack([np.interp(time, self.time, column) for column in self.foot.T], axis=1),
                np.interp(time, self.time, self.heading))


def first_track(time: np.ndarray, place: np.ndarray) -> FirstTrack:
    """The ridge of density of one drive.

    On a flat road the density of a scan line falls off with the distance x from the scanner's foot as
    h / (h^2 + x^2): a Cauchy distribution, whose place is estimated by its likelihood.

    Parameters
    ----------
    time : (N,) s, ascending
    place : (N, 3) m
    """
    begin = float(time[0])
    window = ((time - begin) / WINDOW).astype(np.int64)
    size = int(window[-1]) + 1
    rank = np.arange(len(window)) - np.searchsorted(window, window)
    kept = rank % -(-np.bincount(window) // MAX_WINDOW_SAMPLES)[window] == 0
    time, place, window = time[kept], place[kept], window[kept]
    count = np.bincount(window, minlength=size)
    start = np.r_[0, np.cumsum(count)[:-1]]
    middle, low = (np.minimum(start + (count * share).astype(np.int64), len(time) - 1) for share in (0.5, LOWEST_SHARE))
    foot = np.stack([column[np.lexsort((column, window))][rank] for column, rank in zip(place.T, (middle, middle, low))], axis=1)
    for _ in range(DENSITY_ROUNDS):
        away = place - foot[window]
        weight = 1.0 / ((1.0 + (away[:, :2] ** 2).sum(axis=1) / DENSITY_WIDTH**2) * (1.0 + (away[:, 2] / GROUND_WEIGHT_DEPTH) ** 2))
        total = np.maximum(np.bincount(window, weight, size), 1e-9)
        foot = np.stack([np.bincount(window, weight * column, size) / total for column in place.T], axis=1)
    track = robustly_smoothed(foot, (count >= MIN_WINDOW_SAMPLES).astype(float), TRACK_STIFFNESS)
    far = np.hypot(*(place - foot[window])[:, :2].T)
    order = np.lexsort((far, window))
    start = np.r_[0, np.cumsum(count)[:-1]]
    reach = np.where(count > 0, far[order][np.minimum(start + count // 2, len(far) - 1)], np.nan)
    middles = begin + (np.arange(size) + 0.5) * WINDOW
    return FirstTrack(middles, track, headings_of(track), count, reach)


def headings_of(track: np.ndarray, about: np.ndarray | None = None) -> np.ndarray:
    """(N,) continuous headings, radians counter-clockwise from east, of a track of (N, 2 or more) evenly timed places.

    Where the vehicle stands, it keeps the heading in which it came; where it backs up, it keeps looking ahead.

    Parameters
    ----------
    track : (N, 2 or more) m
    about : (N,) radians, headings known to less than a right angle; None for those of the track itself
    """
    velocity = np.gradient(track[:, :2], axis=0) if len(track) > 1 else np.zeros((len(track), 2))
    step = np.hypot(*velocity.T)
    moving = np.flatnonzero(step > MIN_STEP)
    if not len(moving):
        return np.zeros(len(track))
    way = np.arctan2(velocity[moving, 1], velocity[moving, 0])
    about = _headings_by_distance(track) if about is None else about
    # of the two ways along a line, the one that is nearer
    heading = np.unwrap(way) if about is None else about[moving] + (way - about[moving] + np.pi / 2) % np.pi - np.pi / 2
    return np.interp(np.arange(len(track)), moving, heading)


def _headings_by_distance(track):
    """(N,) continuous headings between places BACKING_STEP apart; None for a track that is shorter.

    A vehicle that goes back within so short a way has not turned about but changed its gear. More of the way is driven forward.
    """
    row, (x0, y0) = [0], track[0, :2]
    for number, (x, y) in enumerate(track[:, :2].tolist()):
        if (x - x0) ** 2 + (y - y0) ** 2 >= BACKING_STEP**2:
            row.append(number)
            x0, y0 = x, y
    if len(row) < 2:
        return None
    way = np.arctan2(*np.diff(track[row, :2], axis=0).T[::-1])
    backward = np.r_[0, np.cumsum(np.cos(np.diff(way)) < 0)] % 2
    backward = 1 - backward if backward.mean() > 0.5 else backward
    return np.interp(np.arange(len(track)), 0.5 * (np.array(row[:-1]) + row[1:]), np.unwrap(way + np.pi * backward))
