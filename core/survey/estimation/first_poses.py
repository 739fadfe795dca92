"""Poses to start the adjustment from, of the fixes of every scanner."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...curves.robust import robustly_smoothed
from .poses import KNOT_SPACING, POSE, YAW, DriveKnots, Poses
from .resection import Fixes, fixes_of, rotation_rate_of
from .rough.first_track import WINDOW, FirstTrack, headings_of
from .rough.samples import Samples

MIN_FIXES = 5             # good windows of a scanner, or it is left out
FIX_STIFFNESS = 10.0      # (0.1 m of scatter / 0.03 m, see TRACK_STIFFNESS)^2
PHASE_STIFFNESSES = 1e8, 1e6, 1e4, 1e2, 0.1   # from a mirror that turns evenly for seconds to one whose rate swings from window to window
MAX_WORSE_PHASES = 1.5    # times the median deviation of the most flexible curve: a stiffer one deviates no more than this


@dataclass
class Spinning:
    """A scanner whose mirror was seen to turn.

    number : of the scanner
    rate : Hz, signed
    fixes : of each drive
    """

    number: int
    rate: float
    fixes: list[Fixes]


def spinning_scanners(samples: Samples, tracks: list[FirstTrack]) -> list[Spinning]:
    """The scanners with a mirror that turns, and where they were."""
    found = []
    for number in range(samples.scanners):
        runs = []
        for drive, track in zip(samples.drives, tracks):
            own = drive.start + np.flatnonzero(samples.scanner[drive] == number)
            runs.append((samples.time[own], samples.place[own], track))
        rate = rotation_rate_of([run for run in runs if len(run[0])])
        if rate is None:
            continue
        # seen from either side a mirror turns either way: the true way gives more windows that make sense, and a smaller misfit
        both = [Spinning(number, sign * rate, [fixes_of(*run, sign * rate) if len(run[0]) else EMPTY for run in runs]) for sign in (1, -1)]
        best = max(both, key=lambda one: _quality(one.fixes))
        if sum(len(fixes.time) for fixes in best.fixes) >= MIN_FIXES:
            found.append(_with_true_rate(best))
    return found


EMPTY = Fixes(np.empty(0), np.empty((0, 3)), np.empty(0), np.empty(0), np.empty(0))


def _quality(fixes):
    misfit = np.concatenate([one.misfit for one in fixes])
    return len(misfit) / (float(np.median(misfit)) + 1e-3) if len(misfit) else 0.0


def _with_true_rate(one):
    """The scanner with its mean rate, by which the phases of neighbouring windows agree."""
    change = np.concatenate([_phase_steps(fixes, one.rate) for fixes in one.fixes])
    return Spinning(one.number, one.rate + float(np.median(change)) / (2 * np.pi * WINDOW), one.fixes) if len(change) else one


def _phase_steps(fixes, rate):
    """(M,) radians by which the phase gains on an even rate between neighbouring windows."""
    apart = np.diff(fixes.time)
    step = np.diff(fixes.phase) - 2 * np.pi * rate * apart
    return ((step + np.pi) % (2 * np.pi) - np.pi)[apart < 1.5 * WINDOW]


def first_poses(samples: Samples, tracks: list[FirstTrack], scanners: list[Spinning]) -> Poses:
    """Poses through the fixes of all scanners; mountings upright.

    Parameters
    ----------
    samples : Samples
    tracks : FirstTrack of each drive
    scanners : those that spin; they are numbered anew in this order
    """
    turn = np.array([np.median(np.concatenate([fixes.yaw for fixes in one.fixes])) for one in scanners])
    lever = _levers(tracks, scanners)
    drives, control, first = [], [], 0
    for number, (drive, track) in enumerate(zip(samples.drives, tracks)):
        start = float(samples.time[drive.start]) - KNOT_SPACING / 2
        count = int(np.ceil((samples.time[drive.stop - 1] - start) / KNOT_SPACING)) + 4
        knots = DriveKnots(start, first, count)
        values = np.zeros((count, POSE + len(scanners)))
        values[:, :3] = _places(track, [one.fixes[number] for one in scanners], lever, knots.middles)
        values[:, YAW] = headings_of(values[:, :2], track.at(knots.middles)[1])
        for k, one in enumerate(scanners):
            values[:, POSE + k] = _phases(one.fixes[number], one.rate, knots.middles)
        drives.append(knots)
        control.append(values)
        first += count
    return Poses(tuple(drives), np.concatenate(control), np.array([one.rate for one in scanners]), turn, np.zeros(len(scanners)), lever)


def _levers(tracks, scanners):
    """(S, 3) m ahead, left and up of every scanner from their middle."""
    lever = np.zeros((len(scanners), 3))
    for k, one in enumerate(scanners[1:], 1):
        apart = [np.empty((0, 3))]
        for track, base, fixes in zip(tracks, scanners[0].fixes, one.fixes):
            if len(base.time) and len(fixes.time):
                heading = np.interp(fixes.time, track.time, track.heading)
                away = fixes.place - np.stack([np.interp(fixes.time, base.time, column) for column in base.place.T], axis=1)
                cos, sin = np.cos(heading), np.sin(heading)
                apart.append(np.stack([away[:, 0] * cos + away[:, 1] * sin, away[:, 1] * cos - away[:, 0] * sin, away[:, 2]], axis=1))
        together = np.concatenate(apart)
        lever[k] = np.median(together, axis=0) if len(together) else 0.0
    return lever - lever.mean(axis=0)


def _places(track, fixes, lever, middles):
    """(K, 3) m of the pose at times of the drive."""
    cells = len(middles)
    total, weight = np.zeros((cells, 3)), np.zeros(cells)
    for own, arm in zip(fixes, lever):
        if not len(own.time):
            continue
        heading = np.interp(own.time, track.time, track.heading)
        cos, sin = np.cos(heading), np.sin(heading)
        place = own.place - np.stack([cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1], np.full(len(cos), arm[2])], axis=1)
        cell = np.clip(np.rint((own.time - middles[0]) / KNOT_SPACING).astype(np.int64), 0, cells - 1)
        # a window's middle lies off the knot; the track tells how far the vehicle got in between
        place[:, :2] += (track.at(middles[cell])[0] - track.at(own.time)[0])[:, :2]
        total += np.stack([np.bincount(cell, column, cells) for column in place.T], axis=1)
        weight += np.bincount(cell, minlength=cells)
    if not weight.any():
        return track.at(middles)[0] + [0.0, 0.0, 2.0]
    return robustly_smoothed(total / np.maximum(weight, 1)[:, None], weight, FIX_STIFFNESS)


def _phases(fixes, rate, middles):
    """(K,) radians that the direction was ahead of 2 pi rate t at times of the drive."""
    if not len(fixes.time):
        return np.zeros(len(middles))
    ahead = np.unwrap(fixes.phase - 2 * np.pi * rate * fixes.time)
    cell = np.clip(np.rint((fixes.time - middles[0]) / KNOT_SPACING).astype(np.int64), 0, len(middles) - 1)
    values, weight = np.zeros((len(middles), 1)), np.zeros(len(middles))
    values[cell, 0], weight[cell] = ahead, 1.0
    curves = [robustly_smoothed(values, weight, stiffness) for stiffness in PHASE_STIFFNESSES]
    off = [float(np.median(np.abs(curve - values)[weight > 0])) for curve in curves]
    return next(curve for curve, one in zip(curves, off) if one <= MAX_WORSE_PHASES * off[-1] + 1e-3)[:, 0]


def known_intervals(poses: Poses, scanners: list[Spinning]) -> np.ndarray:
    """(K, S) bool: the intervals of the poses in or beside which a scanner has a fix."""
    known = np.zeros((len(poses.control), len(scanners)), bool)
    for k, one in enumerate(scanners):
        for knots, fixes in zip(poses.drives, one.fixes):
            if len(fixes.time):
                interval = knots.interval(fixes.time)[0]
                for step in (-1, 0, 1):
                    known[np.clip(interval + step, knots.first, knots.first + knots.count - 4), k] = True
    return known
