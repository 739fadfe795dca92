"""Scanners that no field distinguishes, distinguished by where their scan lines lead.

Seen from the vehicle, the lines of one scanner run in one direction over the road. Points that follow each other in time and lie
side by side show it; scanners whose planes are turned differently give as many directions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..weights import MIRROR, RAYS
from .adjustment import misfits
from .poses import Poses
from .samples import FirstTrack


def told_apart(scanners: int) -> str:
    """What the user is told about so many scanners that no field distinguishes."""
    return f"The points are of {scanners} scanners that no field distinguishes; they were distinguished by where their scan lines lead."


def steps_of(place: np.ndarray, track: FirstTrack, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Steps between points that follow each other in time, on the road near the track: (M,) rows of their first points, and (M,) directions.

    place, time : (N, 3) m and (N,) s, ascending. A direction is a number among those of half a turn, relative to the way driven
    """
    foot, heading = track.at(time)
    offset = place - foot
    near = np.flatnonzero((np.abs(offset[:, 2]) < MIRROR.ground_band) & (np.hypot(offset[:, 0], offset[:, 1]) < MIRROR.near_foot))
    rows, directions = [], []
    for ahead in range(1, MIRROR.followers + 1):
        a, b = near[:-ahead], near[ahead:]
        close = b - a <= MIRROR.followers
        a, b = a[close], b[close]
        step = offset[b, :2] - offset[a, :2]
        size = np.hypot(*step.T)
        used = (size > MIRROR.nearest_step) & (size < MIRROR.farthest_step)
        angle = np.arctan2(step[used, 1], step[used, 0]) - heading[a[used]]
        rows.append(a[used].astype(np.int32))
        directions.append(np.floor(angle % np.pi / np.pi * MIRROR.directions).astype(np.int16) % MIRROR.directions)
    return np.concatenate(rows), np.concatenate(directions)


def scan_line_directions(direction: np.ndarray) -> list[int]:
    """The directions in which (M,) steps lead, the most frequent first; one where the points are of one scanner, none where they lead anywhere."""
    if len(direction) < MIRROR.min_steps:
        return []
    unblurred = np.bincount(direction, minlength=MIRROR.directions).astype(float)
    count = np.sum([np.roll(unblurred, shift) for shift in range(-MIRROR.blurred, MIRROR.blurred + 1)], axis=0)
    most, usual = float(count.max()), float(np.median(count))
    needed = min(max(share * most, clearness * usual) for share, clearness in MIRROR.clear_directions)
    directions: list[int] = []
    while len(directions) < MIRROR.max_directions:
        best = int(np.argmax(count))
        if count[best] < needed:
            break
        directions.append(best)
        count[_apart(np.arange(MIRROR.directions), best) < MIRROR.min_apart] = -1.0
    return directions


def _apart(direction, one):
    """Directions from one to others, either way round."""
    return np.abs((direction - one + MIRROR.directions // 2) % MIRROR.directions - MIRROR.directions // 2)


def lines_of_each(direction: np.ndarray, row: np.ndarray, size: int, ways: list[int]) -> np.ndarray:
    """(size,) number of the scanner of every point, among the directions `ways` of their scan lines; -1 where its steps do not tell."""
    votes = np.stack([np.bincount(row[_apart(direction, way) <= MIRROR.direction_tolerance], minlength=size) for way in ways])
    first = votes.argmax(axis=0)
    most = votes.max(axis=0)
    return np.where((votes == most).sum(axis=0) == 1, first, -1)


@dataclass(frozen=True)
class ScannerSplitter:
    """Tells by the rays which of several scanners measured a point."""

    poses: Poses   # with all of them
    start: float   # s of time 0 of the poses
    origin: np.ndarray   # (3,) map coordinates of their places

    def numbers(self, time: np.ndarray, place: np.ndarray) -> np.ndarray:
        """(N,) uint8 number of the scanner on whose ray a point lies nearest; (N,) s and (N, 3) map coordinates."""
        since = np.asarray(time, float) - self.start
        interval, share = self._places(since)
        off = []   # m off the rays of each scanner
        for number in range(self.poses.scanners):
            off_rays = misfits(self.poses, interval, share, since, place - self.origin, np.full(len(since), number))
            off.append(np.where(off_rays.range > RAYS.min_range, np.abs(off_rays.off).max(axis=0), np.inf))
        return np.argmin(np.stack(off), axis=0).astype(np.uint8)

    def _places(self, since):
        interval, share = np.zeros(len(since), np.int64), np.zeros(len(since))
        for drive in self.poses.drives:
            rows = np.flatnonzero(since >= drive.start) if drive.first else np.arange(len(since))
            interval[rows], share[rows] = drive.interval(since[rows])
        return interval, np.clip(share, 0.0, 1.0)
