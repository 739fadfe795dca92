"""Poses of the vehicle as a smooth function of time, the mounting of its scanners, and the track of a head of many beams."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...curves.robust import MAD_TO_SIGMA, robustly_smoothed
from ..lattice.scan_lattice import rotation_spectrum, strongest_rotation
from ..weights import HEAD, LATTICE, MIRROR, TRACK
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
            interval = knots.interval(fixes.time)[0]
            for step in (-1, 0, 1):
                fixed[np.clip(interval + step, knots.first, knots.first + knots.count - 4), k] = True
    return fixed


# The track of a many-beam head that turns about an upright axis: every return lies in the direction in which the head looked at its time.
#
# In one turn the direction is phi + omega t, so that the place c of the head is a resection from thousands of bearings: of every return at p,
# the bearing of p - c equals phi + omega t. Solved for place, speed, phi and omega of every turn by iteratively reweighted least squares; the
# speed is nothing where the turns were moved to one place each already, as driving programs do.

@dataclass
class HeadTrack:
    """Places of the head, one a turn."""

    time: np.ndarray   # (T,) s
    place: np.ndarray   # (T, 2) m
    sigma: np.ndarray   # (T,) m
    heading: np.ndarray   # (T,) radians counter-clockwise from east
    speed: np.ndarray   # (T, 2) m/s by which the head moves in a turn; nothing in clouds whose turns were moved to one place each
    noise: float   # radians, usual residual of a bearing
    rate: float   # turns per second, negative clockwise


def turning_heads(samples: Samples, tracks: list[FirstTrack]) -> list[HeadTrack] | None:
    """The places of a many-beam head in every drive; None where the points are not those of one."""
    rate = _turning_rate(samples, tracks)
    if rate is None:
        return None
    heads = []
    for drive, track in zip(samples.drives, tracks):
        head = _head_track(samples.time[drive], samples.place[drive], track, rate)
        if head is None or len(head.time) < 2 or head.noise > HEAD.max_bearing_noise:
            return None
        heads.append(head)
    return heads


def _turning_rate(samples: Samples, tracks: list[FirstTrack]) -> float | None:
    """Turns per second of a head, negative where it turns clockwise; None where bearings do not turn steadily."""
    drive, track = max(zip(samples.drives, tracks), key=lambda pair: pair[0].stop - pair[0].start)
    middle = 0.5 * (samples.time[drive.start] + samples.time[drive.stop - 1])
    rows = drive.start + np.flatnonzero(np.abs(samples.time[drive] - middle) <= HEAD.rate_seconds / 2)
    offset = samples.place[rows, :2] - track.at(samples.time[rows])[0][:, :2]
    rows, offset = rows[(far := np.hypot(*offset.T) > HEAD.far_from_track)], offset[far]
    kept = slice(None, None, max(len(rows) // HEAD.max_rate_samples, 1))
    if len(rows) < HEAD.min_turn_samples:
        return None
    time, bearing = samples.time[rows][kept] - middle, np.exp(1j * np.arctan2(offset[kept, 1], offset[kept, 0]))
    rates = np.arange(*HEAD.turning_rates, HEAD.rate_step)
    rates = np.concatenate([rates, -rates])
    coherence = np.array([abs(np.mean(bearing * np.exp(-2j * np.pi * rate * time))) for rate in rates])
    return float(rates[coherence.argmax()]) if coherence.max() >= HEAD.min_coherence else None


def _head_track(time: np.ndarray, place: np.ndarray, track: FirstTrack, rate: float) -> HeadTrack | None:
    """The places of the head in one drive, of (N,) ascending times (s) and (N, 3) places (m); None where no whole turn was seen."""
    time, flat, turn = _turns(time, place[:, :2], 1.0 / abs(rate))
    if not len(time):
        return None
    count = int(turn[-1]) + 1
    begin, end = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(begin, turn, time)
    np.maximum.at(end, turn, time)
    middle = 0.5 * (begin + end)
    since = time - middle[turn]
    head = track.at(middle)[0][:, :2].copy()
    speed, omega = np.zeros((count, 2)), np.full(count, 2 * np.pi * rate)
    rays = flat - head[turn]
    first = np.exp(1j * (np.arctan2(rays[:, 1], rays[:, 0]) - omega[turn] * since))
    phi = np.angle(np.bincount(turn, first.real, count) + 1j * np.bincount(turn, first.imag, count))
    for number in range(HEAD.rounds):
        rays = flat - head[turn] - speed[turn] * since[:, None]
        square = np.maximum((rays**2).sum(axis=1), 1e-6)
        off = np.angle(np.exp(1j * (np.arctan2(rays[:, 1], rays[:, 0]) - phi[turn] - omega[turn] * since)))
        noise = max(1.4826 * float(np.median(np.abs(off))), HEAD.least_bearing_noise)
        weight = (square > (HEAD.nearest_at_first if number < HEAD.first_rounds else HEAD.nearest_return) ** 2) / (1.0 + (off / noise) ** 2)
        by_x, by_y, by_time = rays[:, 1] / square, -rays[:, 0] / square, since * HEAD.rate_scale
        slopes = [by_x, by_y, -np.ones(len(off)), -by_time, by_x * by_time, by_y * by_time]
        weighted = [weight * a for a in slopes]
        normal = np.array([[np.bincount(turn, a * b, count) for b in slopes] for a in weighted]).transpose(2, 0, 1)
        # a weak prior keeps turns solvable that saw one side alone, and their speed small
        normal += np.diag([1e-3, 1e-3, 1e-3, 1e-3, 1.0, 1.0])
        right = np.array([np.bincount(turn, a * off, count) for a in weighted]).T
        step = -np.linalg.solve(normal, right[..., None])[..., 0]
        head += np.clip(step[:, :2], -HEAD.max_step, HEAD.max_step)
        phi, omega = phi + step[:, 2], omega + step[:, 3] * HEAD.rate_scale
        speed += np.clip(step[:, 4:] * HEAD.rate_scale, -HEAD.max_step / 0.1, HEAD.max_step / 0.1)
    misfit = np.sqrt(np.bincount(turn, weight * off**2, count) / np.maximum(np.bincount(turn, weight, count), 1e-9))
    usual = float(np.median(misfit))
    covariance = np.linalg.inv(normal) * usual**2
    sigma = np.sqrt(covariance[:, 0, 0] + covariance[:, 1, 1] + HEAD.least_sigma**2)
    good = misfit <= HEAD.max_turn_misfit * usual
    return HeadTrack(middle[good], head[good], sigma[good], _headings(middle[good], head[good]), speed[good], usual, rate)


def _turns(time, flat, period):
    """(N,) times, (N, 2) places and (N,) numbers of the turns that were seen long enough, thinned."""
    cuts = np.flatnonzero(np.diff(time) > HEAD.min_gap_of_turn * period) + 1
    group = np.searchsorted(cuts, np.arange(len(time)), side="right")
    begun = time[np.r_[0, cuts]][group]
    raw = np.cumsum(np.r_[0, (np.diff(group) > 0) | (np.diff(np.floor((time - begun) / period + 1e-6)) != 0)])
    size = np.bincount(raw)
    first = np.r_[0, np.cumsum(size)[:-1]]
    complete = (time[first + size - 1] - time[first] >= HEAD.min_seen_share_of_turn * period) & (size >= HEAD.min_turn_samples)
    kept = complete[raw] & thinned(raw, HEAD.max_turn_samples)
    return time[kept], flat[kept], (np.cumsum(complete) - 1)[raw[kept]]


def _headings(time, place):
    """(T,) headings of the way driven at uneven times."""
    if len(time) < 2:
        return np.zeros(len(time))
    even = np.linspace(time[0], time[-1], max(int((time[-1] - time[0]) / 0.1), 1) + 1)
    return np.interp(time, even, headings_of(np.stack([np.interp(even, time, axis) for axis in place.T], axis=1)))


# The height of a many-beam head: each of its beams keeps its angle of elevation, on whatever it falls.
#
# A beam draws a ring on the road and lines on walls, cars and trunks, at many distances, and seen from the head all of them have one elevation.
# Seen from too high or too low they have not, and the elevations of all points smear. The height sought is that from which they lie closest
# together. Ground, and the slope of the road, come from the points about each turn.


def head_heights(samples: Samples, tracks: list[FirstTrack], heads: list[HeadTrack]) -> tuple[list[np.ndarray], float | None, float]:
    """Ground beneath the head, (T,) m for each drive, and its height above it with one sigma, m; None where the beams do not tell it."""
    ground, parts, turns = [], [], 0
    share = max(sum(drive.stop - drive.start for drive in samples.drives) // HEAD.max_height_points, 1)
    for drive, track, head in zip(samples.drives, tracks, heads):
        turn, rays, z = _seen_from(samples.time[drive], samples.place[drive], head, share)
        plane = _ground_planes(turn, rays, z, track.at(head.time)[0][:, 2])
        ground.append(plane[:, 0])
        reach = np.hypot(*rays.T)
        above = z - plane[turn, 0] - (plane[turn, 1:] * rays).sum(axis=1)
        near = (reach > HEAD.own_vehicle_reach) & (reach < HEAD.object_reach)
        bearing = np.arctan2(rays[near, 1], rays[near, 0]) - head.heading[turn[near]]
        parts.append((turns + turn[near], reach[near], above[near], bearing))
        turns += -(-len(head.time) // HEAD.turns_of_group) * HEAD.turns_of_group
    turn, reach, above, bearing = (np.concatenate(column) for column in zip(*parts))
    objects = above > HEAD.above_ground
    if objects.mean() < HEAD.min_objects:
        return ground, None, np.nan
    height, sigma = _sharpest(turn[objects], turns // HEAD.turns_of_group, reach[objects], above[objects], bearing[objects])
    return ground, height, sigma


def _seen_from(time, place, head, share):
    """Turn of each point, its (N, 2) place as seen from the head at its time, and its height; those near no turn are left out."""
    rows = np.arange(0, len(time), share)
    turn = np.clip(np.searchsorted(head.time, time[rows]), 1, len(head.time) - 1)
    turn -= time[rows] - head.time[turn - 1] < head.time[turn] - time[rows]
    since = time[rows] - head.time[turn]
    near = np.abs(since) <= 0.5 / abs(head.rate)
    rows, turn, since = rows[near], turn[near], since[near]
    return turn, place[rows, :2] - head.place[turn] - head.speed[turn] * since[:, None], place[rows, 2]


def _ground_planes(turn: np.ndarray, away: np.ndarray, z: np.ndarray, first: np.ndarray) -> np.ndarray:
    """The road about every turn as a plane, (T, 3) height beneath the head and slopes to the east and north, by robust least squares.

    turn, away, z : (N,) numbers, (N, 2) m from the head, (N,) m; first : (T,) m, heights to begin with, which stay where few points are
    """
    near = np.hypot(*away.T) < HEAD.plane_reach
    turn, z = turn[near], z[near]
    design = np.column_stack([np.ones(len(turn)), away[near]])
    count = len(first)
    planes = np.column_stack([first, np.zeros((count, 2))])
    solvable = np.bincount(turn, minlength=count) >= HEAD.least_ground_points
    for number in range(HEAD.ground_rounds):
        off = z - (planes[turn] * design).sum(axis=1)
        # what stands on the road lies above it, so points above lose their weight sooner than those below
        scale = HEAD.first_ground_scale if number < HEAD.ground_rounds // 3 else HEAD.ground_scale
        weight = 1.0 / (1.0 + (np.where(off > 0, 2.0 * off, off) / scale) ** 2) ** 2
        normal = np.array([[np.bincount(turn, weight * a * b, count) for b in design.T] for a in design.T]).transpose(2, 0, 1)
        right = np.array([np.bincount(turn, weight * a * off, count) for a in design.T]).T
        # slopes of roads are small
        normal += np.diag([1e-6, 1.0, 1.0])
        planes += np.where(solvable[:, None], np.linalg.solve(normal, right[..., None])[..., 0], 0.0)
    return planes


def _sharpest(turn, groups, reach, above, bearing):
    """Height from which elevations lie closest together in every turn, and its sigma by those of groups of turns; None where they hardly do."""
    ahead, left, group = np.cos(bearing), np.sin(bearing), turn // HEAD.turns_of_group
    height, tilt = HEAD.first_height, np.zeros((groups, 2))

    def sharpness(height, ahead_tilt, left_tilt, fine):
        elevation = np.arctan((above - height) / reach + ahead_tilt[group] * ahead + left_tilt[group] * left)
        return _pairs(elevation, turn, groups, fine)

    def best(values):
        return np.argmax(values, axis=0)

    for fine, up, lean in HEAD.search:
        steps = np.arange(-HEAD.search_steps, HEAD.search_steps + 1)
        for _ in range(HEAD.search_rounds):
            height += up * steps[best([_pooled(sharpness(height + up * step, *tilt.T, fine)) for step in steps])]
            for axis in (0, 1):
                moved = [tilt + lean * step * np.eye(2)[axis] for step in steps]
                tilt[:, axis] += lean * steps[best([_ratio(sharpness(height, *tilts.T, fine)) for tilts in moved])]
    fine, up, _ = HEAD.search[-1]
    if not HEAD.heights[0] < height < HEAD.heights[1] or _pooled(sharpness(height, *tilt.T, fine)) < HEAD.min_sharing:
        return None, np.nan
    around = up * np.arange(-4 * HEAD.search_steps, 4 * HEAD.search_steps + 1)
    shifts = around[best([_ratio(sharpness(height + shift, *tilt.T, fine)) for shift in around])]
    sigma = float(np.hypot(MAD_TO_SIGMA * np.median(np.abs(shifts)) / np.sqrt(groups), HEAD.least_height_sigma))
    return (float(height), sigma) if sigma <= HEAD.max_height_sigma else (None, np.nan)


def _pairs(elevation, turn, groups, fine):
    """(2, G) pairs of points of one turn in one fine interval of elevation, and as many as there would be by chance within a coarse one."""
    ratio = int(round(HEAD.coarse / fine))
    cell = np.floor(elevation / fine).astype(np.int64)
    cell -= cell.min()
    size = (int(cell.max()) // ratio + 1) * ratio
    turns = groups * HEAD.turns_of_group
    count = np.bincount(turn * size + cell, minlength=turns * size).reshape(turns, size).astype(float)
    wide = count.reshape(turns, -1, ratio).sum(axis=2)
    total = count.sum(axis=1)
    pairs = np.array([(count**2).sum(axis=1) - total, ((wide**2).sum(axis=1) - total) / ratio])
    return pairs.reshape(2, groups, HEAD.turns_of_group).sum(axis=2)


def _ratio(pairs):
    return pairs[0] / np.maximum(pairs[1], 1e-9)


def _pooled(pairs):
    return float(pairs[0].sum() / max(pairs[1].sum(), 1e-9))
