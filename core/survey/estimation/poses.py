"""Poses of the vehicle as a smooth function of time, and the mounting of its scanners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...curves.robust import robustly_smoothed
from ..lattice.scan_lattice import rotation_spectrum, strongest_rotation
from ..weights import LATTICE, MIRROR, TRACK
from .samples import FirstTrack, Samples, headings_of, thinned

X, Y, Z, ROLL, PITCH, YAW, POSE = range(7)   # derived: columns of the control values, and the first of the phases of the scanners


@dataclass(frozen=True)
class _DriveKnots:
    """The knots of one drive among all: control values first .. first + count - 1, the first interval begins at `start` (s)."""

    start: float
    first: int
    count: int

    def interval(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Number among all intervals, and share of it that has passed, at (N,) times of the drive."""
        since = (np.asarray(time, float) - self.start) / MIRROR.knot_spacing
        number = np.clip(np.floor(since).astype(np.int64), 0, self.count - 4)
        return number + self.first, since - number

    @property
    def middles(self) -> np.ndarray:
        """(count,) s at which each control value weighs most."""
        return self.start + (np.arange(self.count) - 1.0) * MIRROR.knot_spacing


@dataclass(frozen=True)
class Poses:
    """Cubic B-splines of place, attitude and mirror phases, and the mounting of S scanners.

    control : (K, 6 + S) control values: x, y, z (m), roll (right side down), pitch (nose up), yaw (counter-clockwise from east; radians),
        and of each scanner what its direction angle is ahead of 2 pi rate t (radians)
    """

    drives: tuple[_DriveKnots, ...]
    control: np.ndarray
    rate: np.ndarray   # (S,) Hz
    turn: np.ndarray   # (S,) radians by which the scan line is turned counter-clockwise from straight across
    lean: np.ndarray   # (S,) radians by which the scan plane leans, its upper half forward
    lever: np.ndarray   # (S, 3) m ahead, left and up from the place of the pose; their mean is 0

    @property
    def scanners(self) -> int:
        """The number of scanners."""
        return len(self.rate)

    def at(self, interval: np.ndarray, share: np.ndarray) -> np.ndarray:
        """(N, 6 + S) values at N places of the splines."""
        weights = spline_weights(share)
        return sum(weights[:, j, None] * self.control[interval + j] for j in range(4))

    def scan_planes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(S, 3) unit vectors in the vehicle's frame: normal of the plane, its line across, and what stands on both."""
        cos, sin, c, s = np.cos(self.turn), np.sin(self.turn), np.cos(self.lean), np.sin(self.lean)
        zero = np.zeros(self.scanners)
        return (np.stack([c * cos, c * sin, -s], axis=1), np.stack([-sin, cos, zero], axis=1), np.stack([s * cos, s * sin, c], axis=1))


def spline_weights(share: np.ndarray) -> np.ndarray:
    """(N, 4) weights of the control values around (N,) places in an interval, 0 to 1."""
    u = np.asarray(share, float)
    return np.stack([(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3], axis=-1) / 6.0


def spline_slopes(share: np.ndarray) -> np.ndarray:
    """(N, 4) weights for the change per second."""
    u = np.asarray(share, float)
    return np.stack([-((1 - u) ** 2), 3 * u**2 - 4 * u, -3 * u**2 + 2 * u + 1, u**2], axis=-1) / (2.0 * MIRROR.knot_spacing)


def vehicle_axes(roll: np.ndarray, pitch: np.ndarray, yaw: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(N, 3) unit vectors ahead, left and up of a vehicle; (N,) radians as in Poses."""
    cr, sr, cp, sp, ct, st = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    return (np.stack([ct * cp, st * cp, sp], axis=-1),
            np.stack([-st * cr - ct * sp * sr, ct * cr - st * sp * sr, cp * sr], axis=-1),
            np.stack([st * sr - ct * sp * cr, -ct * sr - st * sp * cr, cp * cr], axis=-1))


# Where one scanner was in short windows of time, from the angles its mirror turned through between points.
#
# In the scan plane a return lies on the ray that the mirror had at its time. Two directions are as far apart as the mirror turned in between, so
# many returns fix the place of the scanner as a resection does: whatever stands around, and however many points are missing. With place (a, b),
# direction angle t + phi and rays' origin (u, v)::
#
# (a - u) sin(t + phi) - (b - v) cos(t + phi) = 0
#
# is linear and homogeneous in cos(phi), sin(phi) and two combinations of them with u and v; the smallest eigenvector solves it.


@dataclass
class _Fixes:
    """Places of one scanner in windows of one drive; only windows with a good one.

    phase : (W,) radians that the direction of a point was ahead of 2 pi rate t, in the plane, 0 to the left, from the middle of the window
    """

    time: np.ndarray   # time, place: (W,) s, middles, and (W, 3) m, as if the scan plane stood upright
    place: np.ndarray
    phase: np.ndarray
    yaw: np.ndarray   # (W,) radians by which the scan line is turned, counter-clockwise, from straight across
    misfit: np.ndarray   # (W,) m


def _rotation_rate_of(runs: list[tuple[np.ndarray, np.ndarray, FirstTrack]]) -> float | None:
    """Hz of one scanner's mirror, by (N,) times, (N, 3) places and the FirstTrack of every drive; None where its points show none."""
    spectra = []
    for time, place, track in runs:
        for middle in np.linspace(track.time[0], track.time[-1], MIRROR.rotation_samples_per_drive + 2)[1:-1]:
            window = slice(*np.searchsorted(time, [middle - LATTICE.rotation_window / 2, middle + LATTICE.rotation_window / 2]))
            if window.stop - window.start < MIRROR.min_spectrum_samples:
                continue
            foot, heading = track.at(time[window])
            offset = place[window] - foot
            across = offset[:, 1] * np.cos(heading) - offset[:, 0] * np.sin(heading)
            phasor = offset[:, 2] - TRACK.usual_height + 1j * across
            spectra.append(rotation_spectrum(time[window], phasor / np.maximum(np.abs(phasor), 1e-9)))
    if not spectra:
        return None
    rate, peak = strongest_rotation(spectra)
    return abs(rate) if peak >= LATTICE.min_rotation_peak else None


def _fixes_of(time: np.ndarray, place: np.ndarray, track: FirstTrack, rate: float) -> _Fixes:
    """The places of one scanner in the windows of one drive, by (N,) ascending times and (N, 3) places.

    track : FirstTrack of the drive, against which the vehicle's motion within a window is removed
    rate : Hz, positive where directions turn counter-clockwise seen from ahead, looking back
    """
    window = np.clip(((time - track.time[0] + TRACK.window / 2) / TRACK.window).astype(np.int64), 0, len(track.time) - 1)
    kept = thinned(window, MIRROR.max_window_points)
    time, place, window = time[kept], place[kept], window[kept]
    size = len(track.time)
    foot, heading = track.at(time)
    offset = place - foot
    near = np.flatnonzero((np.abs(offset[:, 2]) < MIRROR.ground_band) & (np.hypot(offset[:, 0], offset[:, 1]) < MIRROR.near_foot))
    direction, middle, grounded = _line_directions(offset[near, :2], window[near], size)
    # scan lines run to the left of the way driven
    yaw = (direction - track.heading + 0.0) % np.pi - np.pi / 2
    direction = track.heading + np.pi / 2 + yaw
    aside = middle[:, 1] * np.cos(direction) - middle[:, 0] * np.sin(direction)
    along = offset[:, 0] * np.cos(direction)[window] + offset[:, 1] * np.sin(direction)[window]
    angle = 2 * np.pi * rate * (time - track.time[window])
    u, v, phase, misfit, in_front = resected(along, offset[:, 2], angle, window, size)
    places = track.foot + np.stack([u * np.cos(direction) - aside * np.sin(direction), u * np.sin(direction) + aside * np.cos(direction), v], axis=1)
    count = np.bincount(window, minlength=size)
    good = (count >= TRACK.min_window_samples) & (grounded >= TRACK.min_window_samples / 2) & (in_front >= MIRROR.min_share_in_front)
    good &= (v > MIRROR.heights[0]) & (v < MIRROR.heights[1])
    if good.any():
        good &= misfit <= MIRROR.max_worse * np.median(misfit[good])
    return _Fixes(track.time[good], places[good], phase[good], yaw[good], misfit[good])


def _line_directions(place, window, size):
    """Direction of the longer axis, middle (size, 2) and number of the points of every window."""
    count = np.bincount(window, minlength=size)
    total = np.maximum(count, 1)
    middle = np.stack([np.bincount(window, column, size) / total for column in place.T], axis=1)
    x, y = (place - middle[window]).T
    xx, xy, yy = (np.bincount(window, product, size) for product in (x * x, x * y, y * y))
    return 0.5 * np.arctan2(2 * xy, xx - yy), middle, count


def resected(a: np.ndarray, b: np.ndarray, angle: np.ndarray, window: np.ndarray, size: int) -> tuple[np.ndarray, ...]:
    """The places from which the rays of `size` windows lead.

    a, b : (N,) m, places of returns in the scan plane; angle : (N,) radians that the mirror has turned through, from any start in each window;
    window : (N,) its number. Returns (size,) m of the places u and v, radians of the angle's start, misfit (m), and share of the returns in front
    """
    sin, cos = np.sin(angle), np.cos(angle)
    rows = (a * sin - b * cos, a * cos + b * sin, -sin, -cos)
    weight = np.ones(len(a))
    for _ in range(MIRROR.resection_rounds):
        total = np.empty((size, 4, 4))
        for i in range(4):
            for j in range(i, 4):
                total[:, i, j] = total[:, j, i] = np.bincount(window, weight * rows[i] * rows[j], size)
        inner, mixed = total[:, 2:, 2:] + 1e-9 * np.eye(2), total[:, 2:, :2]
        carried = np.linalg.solve(inner, mixed)
        turn = np.linalg.eigh(total[:, :2, :2] - mixed.transpose(0, 2, 1) @ carried)[1][:, :, 0]
        moved = -np.einsum("wij,wj->wi", carried, turn)
        (c, s), (g1, g2) = turn.T, moved.T
        off = rows[0] * c[window] + rows[1] * s[window] + rows[2] * g1[window] + rows[3] * g2[window]
        misfit = np.sqrt(np.bincount(window, weight * off**2, size) / np.maximum(np.bincount(window, weight, size), 1e-9))
        weight = 1.0 / (1.0 + (off / (2.0 * misfit[window] + 1e-6)) ** 2)
    u, v, phase = g1 * c + g2 * s, g1 * s - g2 * c, np.arctan2(s, c)
    forward = (a - u[window]) * np.cos(angle + phase[window]) + (b - v[window]) * np.sin(angle + phase[window])
    ahead = np.bincount(window, forward > 0, size) / np.maximum(np.bincount(window, minlength=size), 1)
    # a direction and its opposite lie on one line
    return u, v, phase + np.pi * (ahead < 0.5), misfit, np.maximum(ahead, 1.0 - ahead)


# Poses to start the adjustment from, of the fixes of every scanner.


@dataclass
class Spinning:
    """A scanner whose mirror was seen to turn: its number, signed rate (Hz), and fixes of each drive."""

    number: int
    rate: float
    fixes: list[_Fixes]


def spinning_scanners(samples: Samples, tracks: list[FirstTrack]) -> list[Spinning]:
    """The scanners with a mirror that turns, and where they were."""
    scanners = []
    for number in range(samples.scanners):
        runs = []
        for drive, track in zip(samples.drives, tracks):
            rows = drive.start + np.flatnonzero(samples.scanner[drive] == number)
            runs.append((samples.time[rows], samples.place[rows], track))
        rate = _rotation_rate_of([run for run in runs if len(run[0])])
        if rate is None:
            continue
        # seen from either side a mirror turns either way: the true way gives more windows that make sense, and a smaller misfit
        candidates = [Spinning(number, sign * rate, [_fixes_of(*run, sign * rate) if len(run[0]) else EMPTY for run in runs]) for sign in (1, -1)]
        best = max(candidates, key=lambda one: _quality(one.fixes))
        if sum(len(fixes.time) for fixes in best.fixes) >= MIRROR.min_fixes:
            scanners.append(_with_true_rate(best))
    return scanners


EMPTY = _Fixes(np.empty(0), np.empty((0, 3)), np.empty(0), np.empty(0), np.empty(0))   # derived: of places in three dimensions


def _quality(fixes):
    misfit = np.concatenate([fix.misfit for fix in fixes])
    return len(misfit) / (float(np.median(misfit)) + 1e-3) if len(misfit) else 0.0


def _with_true_rate(one):
    """The scanner with its mean rate, by which the phases of neighbouring windows agree."""
    change = []   # radians by which the phase gains on an even rate between neighbouring windows
    for fixes in one.fixes:
        seconds = np.diff(fixes.time)
        step = np.diff(fixes.phase) - 2 * np.pi * one.rate * seconds
        change += ((step + np.pi) % (2 * np.pi) - np.pi)[seconds < 1.5 * TRACK.window].tolist()
    return Spinning(one.number, one.rate + float(np.median(change)) / (2 * np.pi * TRACK.window), one.fixes) if len(change) else one


def first_poses(samples: Samples, tracks: list[FirstTrack], scanners: list[Spinning]) -> Poses:
    """Poses through the fixes of all scanners that spin, which are numbered anew in this order; mountings upright."""
    turn = np.array([np.median(np.concatenate([fixes.yaw for fixes in scanner.fixes])) for scanner in scanners])
    lever = _levers(tracks, scanners)
    drives, control, first = [], [], 0
    for number, (drive, track) in enumerate(zip(samples.drives, tracks)):
        start = float(samples.time[drive.start]) - MIRROR.knot_spacing / 2
        count = int(np.ceil((samples.time[drive.stop - 1] - start) / MIRROR.knot_spacing)) + 4
        knots = _DriveKnots(start, first, count)
        values = np.zeros((count, POSE + len(scanners)))
        values[:, :3] = _places(track, [scanner.fixes[number] for scanner in scanners], lever, knots.middles)
        values[:, YAW] = headings_of(values[:, :2], track.at(knots.middles)[1])
        for k, scanner in enumerate(scanners):
            values[:, POSE + k] = _phases(scanner.fixes[number], scanner.rate, knots.middles)
        drives.append(knots)
        control.append(values)
        first += count
    return Poses(tuple(drives), np.concatenate(control), np.array([scanner.rate for scanner in scanners]), turn, np.zeros(len(scanners)), lever)


def _levers(tracks, scanners):
    """(S, 3) m ahead, left and up of every scanner from their middle."""
    lever = np.zeros((len(scanners), 3))
    for k, scanner in enumerate(scanners[1:], 1):
        parts = [np.empty((0, 3))]
        for track, base, fixes in zip(tracks, scanners[0].fixes, scanner.fixes):
            if len(base.time) and len(fixes.time):
                heading = np.interp(fixes.time, track.time, track.heading)
                offset = fixes.place - np.stack([np.interp(fixes.time, base.time, column) for column in base.place.T], axis=1)
                cos, sin = np.cos(heading), np.sin(heading)
                parts.append(np.stack([offset[:, 0] * cos + offset[:, 1] * sin, offset[:, 1] * cos - offset[:, 0] * sin, offset[:, 2]], axis=1))
        offsets = np.concatenate(parts)
        lever[k] = np.median(offsets, axis=0) if len(offsets) else 0.0
    return lever - lever.mean(axis=0)


def _places(track, fixes, lever, middles):
    """(K, 3) m of the pose at times of the drive."""
    cells = len(middles)
    total, weight = np.zeros((cells, 3)), np.zeros(cells)
    for fix, arm in zip(fixes, lever):
        if not len(fix.time):
            continue
        heading = np.interp(fix.time, track.time, track.heading)
        cos, sin = np.cos(heading), np.sin(heading)
        place = fix.place - np.stack([cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1], np.full(len(cos), arm[2])], axis=1)
        cell = np.clip(np.rint((fix.time - middles[0]) / MIRROR.knot_spacing).astype(np.int64), 0, cells - 1)
        # a window's middle lies off the knot; the track tells how far the vehicle got in between
        place[:, :2] += (track.at(middles[cell])[0] - track.at(fix.time)[0])[:, :2]
        total += np.stack([np.bincount(cell, column, cells) for column in place.T], axis=1)
        weight += np.bincount(cell, minlength=cells)
    if not weight.any():
        return track.at(middles)[0] + [0.0, 0.0, 2.0]
    return robustly_smoothed(total / np.maximum(weight, 1)[:, None], weight, MIRROR.fix_stiffness)


def _phases(fixes, rate, middles):
    """(K,) radians that the direction was ahead of 2 pi rate t at times of the drive."""
    if not len(fixes.time):
        return np.zeros(len(middles))
    ahead = np.unwrap(fixes.phase - 2 * np.pi * rate * fixes.time)
    cell = np.clip(np.rint((fixes.time - middles[0]) / MIRROR.knot_spacing).astype(np.int64), 0, len(middles) - 1)
    values, weight = np.zeros((len(middles), 1)), np.zeros(len(middles))
    values[cell, 0], weight[cell] = ahead, 1.0
    curves = [robustly_smoothed(values, weight, stiffness) for stiffness in MIRROR.phase_stiffnesses]
    off = [float(np.median(np.abs(curve - values)[weight > 0])) for curve in curves]
    return next(curve for curve, residual in zip(curves, off) if residual <= MIRROR.max_worse_phases * off[-1] + 1e-3)[:, 0]


def known_intervals(poses: Poses, scanners: list[Spinning]) -> np.ndarray:
    """(K, S) bool: the intervals of the poses in or beside which a scanner has a fix."""
    fixed = np.zeros((len(poses.control), len(scanners)), bool)
    for k, scanner in enumerate(scanners):
        for knots, fixes in zip(poses.drives, scanner.fixes):
            if len(fixes.time):
                interval = knots.interval(fixes.time)[0]
                for step in (-1, 0, 1):
                    fixed[np.clip(interval + step, knots.first, knots.first + knots.count - 4), k] = True
    return fixed
