"""Two scanners that no field tells apart, told apart by where their scan lines lead.

Seen from the vehicle, the lines of one scanner run in one direction over the road. Points that follow each other in time and lie
side by side show it; two scanners whose planes are turned differently give two directions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .poses import Poses
from .rays import MIN_RANGE, misfits
from .rough.first_track import FirstTrack

FOLLOWERS = 4            # points after a point, to which its line may lead
NEAREST_STEP, FARTHEST_STEP = 0.02, 1.5   # m of them apart: nearer, noise turns the direction, farther it is another line
NEAR_TRACK = 8.0         # m from the track
GROUND_BAND_OF_LINES = 0.4   # m either side of the ground
DIRECTIONS = 90          # of half a turn, in which steps are counted
BLURRED = 2              # directions either side that are counted together
MIN_SECOND_SHARE = 0.3   # of the steps of the most frequent direction, that the second one needs
MIN_APART = 10           # directions between the two: 20 degrees
MIN_CLEARNESS = 3.0      # of the second one against what is usual of a direction
MIN_STEPS = 2000         # steps that a judgement needs
DIRECTION_TOLERANCE = 4       # directions off its own that a step may lead


def steps_of(place: np.ndarray, track: FirstTrack, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Steps between points that follow each other in time, on the road near the track.

    Parameters
    ----------
    place : (N, 3) m, in order of time
    track : FirstTrack
    time : (N,) s

    Returns
    -------
    row : (M,) of the first point of every step
    direction : (M,) number of its direction among DIRECTIONS, relative to the way driven
    """
    foot, heading = track.at(time)
    away = place - foot
    near = np.flatnonzero((np.abs(away[:, 2]) < GROUND_BAND_OF_LINES) & (np.hypot(away[:, 0], away[:, 1]) < NEAR_TRACK))
    rows, directions = [], []
    for ahead in range(1, FOLLOWERS + 1):
        a, b = near[:-ahead], near[ahead:]
        close = b - a <= FOLLOWERS
        a, b = a[close], b[close]
        step = away[b, :2] - away[a, :2]
        size = np.hypot(*step.T)
        used = (size > NEAREST_STEP) & (size < FARTHEST_STEP)
        angle = np.arctan2(step[used, 1], step[used, 0]) - heading[a[used]]
        rows.append(a[used])
        directions.append(np.floor(angle % np.pi / np.pi * DIRECTIONS).astype(np.int64) % DIRECTIONS)
    return np.concatenate(rows), np.concatenate(directions)


def two_directions(direction: np.ndarray) -> tuple[int, int] | None:
    """The two directions in which steps lead; None where they lead in one, or in all.

    Parameters
    ----------
    direction : (M,) as of `steps_of`
    """
    if len(direction) < MIN_STEPS:
        return None
    alone = np.bincount(direction, minlength=DIRECTIONS).astype(float)
    count = np.sum([np.roll(alone, shift) for shift in range(-BLURRED, BLURRED + 1)], axis=0)
    first = int(np.argmax(count))
    apart = np.abs((np.arange(DIRECTIONS) - first + DIRECTIONS // 2) % DIRECTIONS - DIRECTIONS // 2)
    second = int(np.argmax(np.where(apart >= MIN_APART, count, -1.0)))
    clear = count[second] >= max(MIN_SECOND_SHARE * count[first], MIN_CLEARNESS * float(np.median(count)))
    return (first, second) if clear else None


def lines_of_two(direction: np.ndarray, row: np.ndarray, size: int, both: tuple[int, int]) -> np.ndarray:
    """(size,) number of the scanner of every point, -1 where its steps do not tell.

    Parameters
    ----------
    direction, row : (M,) as of `steps_of`
    size : number of points
    both : the two directions
    """
    votes = np.zeros((2, size))
    for number, one in enumerate(both):
        off = np.abs((direction - one + DIRECTIONS // 2) % DIRECTIONS - DIRECTIONS // 2)
        votes[number] = np.bincount(row[off <= DIRECTION_TOLERANCE], minlength=size)
    return np.where(votes[0] > votes[1], 0, np.where(votes[1] > votes[0], 1, -1))


@dataclass(frozen=True)
class ScannerSplitter:
    """Tells by the rays which of two scanners measured a point.

    poses : Poses of both
    start : s of time 0 of the poses
    origin : (3,) map coordinates of their places
    """

    poses: Poses
    start: float
    origin: np.ndarray

    def numbers(self, time: np.ndarray, place: np.ndarray) -> np.ndarray:
        """(N,) uint8 number of the scanner on whose ray a point lies nearest; (N,) s and (N, 3) map coordinates."""
        since = np.asarray(time, float) - self.start
        interval, share = self._places(since)
        off = [ray_distance(self.poses, interval, share, since, place - self.origin, number) for number in range(self.poses.scanners)]
        return np.argmin(np.stack(off), axis=0).astype(np.uint8)

    def _places(self, since):
        interval, share = np.zeros(len(since), np.int64), np.zeros(len(since))
        for drive in self.poses.drives:
            own = np.flatnonzero(since >= drive.start) if drive.first else np.arange(len(since))
            interval[own], share[own] = drive.interval(since[own])
        return interval, np.clip(share, 0.0, 1.0)


def ray_distance(poses: Poses, interval: np.ndarray, share: np.ndarray, time: np.ndarray, place: np.ndarray, number: int) -> np.ndarray:
    """(N,) m by which points lie off the rays of one scanner; inf behind it."""
    found = misfits(poses, interval, share, time, place, np.full(len(time), number))
    return np.where(found.range > MIN_RANGE, np.abs(found.off).max(axis=0), np.inf)
