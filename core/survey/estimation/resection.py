"""Where one scanner was in short windows of time, from the angles its mirror turned through between points.

In the scan plane a return lies on the ray that the mirror had at its time. Two directions are as far apart as the mirror
turned in between, so many returns fix the place of the scanner as a resection does: whatever stands around, and however
many points are missing. With place (a, b), direction angle t + phi and rays' origin (u, v)::

    (a - u) sin(t + phi) - (b - v) cos(t + phi) = 0

is linear and homogeneous in cos(phi), sin(phi) and two combinations of them with u and v; the smallest eigenvector solves it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..lattice.scan_lattice import MIN_ROTATION_PEAK, ROTATION_WINDOW, rotation_spectrum, strongest_rotation
from .rough.first_track import MIN_WINDOW_SAMPLES, WINDOW, FirstTrack

EXPECTED_HEIGHT = 2.3        # m of the scanner above the ground, to tell in which direction and how fast its mirror turns
ROTATION_SAMPLES_PER_DRIVE = 8   # windows in which the rate is sought
MIN_SPECTRUM_SAMPLES = 200
NEAR_FOOT = 8.0              # m from the track, within which ground points show the direction of the scan lines
GROUND_BAND = 0.4            # m either side of the ground
HEIGHT_RANGE_ABOVE = 0.6, 15.0   # m of a scanner on a vehicle above the ground; of clouds in feet that do not say so, too
MIN_SHARE_IN_FRONT = 0.95    # of the points lie before the scanner, not behind it
MAX_WORSE = 4.0              # times the median misfit: windows beyond are not used
MAX_WINDOW_POINTS = 400      # used of a window
RESECTION_ROUNDS = 3


@dataclass
class Fixes:
    """Places of one scanner in windows of one drive; only windows with a good one.

    time : (W,) s, middles
    place : (W, 3) m, as if the scan plane stood upright
    phase : (W,) radians that the direction of a point was ahead of 2 pi rate t, in the plane, 0 to the left, from the middle of the window
    yaw : (W,) radians by which the scan line is turned, counter-clockwise, from straight across
    misfit : (W,) m
    """

    time: np.ndarray
    place: np.ndarray
    phase: np.ndarray
    yaw: np.ndarray
    misfit: np.ndarray


def rotation_rate_of(runs: list[tuple[np.ndarray, np.ndarray, FirstTrack]]) -> float | None:
    """The rate at which one scanner's mirror turns, Hz; None where its points show none.

    Parameters
    ----------
    runs : per drive (N,) times, (N, 3) places and the drive's FirstTrack
    """
    spectra = []
    for time, place, track in runs:
        for middle in np.linspace(track.time[0], track.time[-1], ROTATION_SAMPLES_PER_DRIVE + 2)[1:-1]:
            own = slice(*np.searchsorted(time, [middle - ROTATION_WINDOW / 2, middle + ROTATION_WINDOW / 2]))
            if own.stop - own.start < MIN_SPECTRUM_SAMPLES:
                continue
            foot, heading = track.at(time[own])
            away = place[own] - foot
            across = away[:, 1] * np.cos(heading) - away[:, 0] * np.sin(heading)
            phasor = away[:, 2] - EXPECTED_HEIGHT + 1j * across
            spectra.append(rotation_spectrum(time[own], phasor / np.maximum(np.abs(phasor), 1e-9)))
    if not spectra:
        return None
    rate, peak = strongest_rotation(spectra)
    return abs(rate) if peak >= MIN_ROTATION_PEAK else None


def fixes_of(time: np.ndarray, place: np.ndarray, track: FirstTrack, rate: float) -> Fixes:
    """The places of one scanner in the windows of one drive.

    Parameters
    ----------
    time : (N,) s, ascending
    place : (N, 3) m
    track : FirstTrack of the drive, against which the vehicle's motion within a window is removed
    rate : Hz, positive where directions turn counter-clockwise seen from ahead, looking back
    """
    window = np.clip(((time - track.time[0] + WINDOW / 2) / WINDOW).astype(np.int64), 0, len(track.time) - 1)
    rank = np.arange(len(window)) - np.searchsorted(window, window)
    held = np.bincount(window, minlength=len(track.time))
    kept = rank % -(-held // MAX_WINDOW_POINTS)[window] == 0
    time, place, window = time[kept], place[kept], window[kept]
    size = len(track.time)
    foot, heading = track.at(time)
    away = place - foot
    near = np.flatnonzero((np.abs(away[:, 2]) < GROUND_BAND) & (np.hypot(away[:, 0], away[:, 1]) < NEAR_FOOT))
    direction, middle, grounded = _line_directions(away[near, :2], window[near], size)
    # scan lines run to the left of the way driven
    yaw = (direction - track.heading + 0.0) % np.pi - np.pi / 2
    direction = track.heading + np.pi / 2 + yaw
    beside = middle[:, 1] * np.cos(direction) - middle[:, 0] * np.sin(direction)
    along = away[:, 0] * np.cos(direction)[window] + away[:, 1] * np.sin(direction)[window]
    angle = 2 * np.pi * rate * (time - track.time[window])
    u, v, phase, misfit, in_front = resected(along, away[:, 2], angle, window, size)
    found = track.foot + np.stack([u * np.cos(direction) - beside * np.sin(direction), u * np.sin(direction) + beside * np.cos(direction), v], axis=1)
    count = np.bincount(window, minlength=size)
    good = (count >= MIN_WINDOW_SAMPLES) & (grounded >= MIN_WINDOW_SAMPLES / 2) & (in_front >= MIN_SHARE_IN_FRONT)
    good &= (v > HEIGHT_RANGE_ABOVE[0]) & (v < HEIGHT_RANGE_ABOVE[1])
    if good.any():
        good &= misfit <= MAX_WORSE * np.median(misfit[good])
    return Fixes(track.time[good], found[good], phase[good], yaw[good], misfit[good])


def _line_directions(place, window, size):
    """Direction of the longer axis, middle (size, 2) and number of the points of every window."""
    count = np.bincount(window, minlength=size)
    total = np.maximum(count, 1)
    middle = np.stack([np.bincount(window, column, size) / total for column in place.T], axis=1)
    x, y = (place - middle[window]).T
    xx, xy, yy = (np.bincount(window, product, size) for product in (x * x, x * y, y * y))
    return 0.5 * np.arctan2(2 * xy, xx - yy), middle, count


def resected(a: np.ndarray, b: np.ndarray, angle: np.ndarray, window: np.ndarray, size: int) -> tuple[np.ndarray, ...]:
    """The places from which the rays of windows lead.

    Parameters
    ----------
    a, b : (N,) m, places of returns in the scan plane
    angle : (N,) radians that the mirror has turned through, from any start in each window
    window : (N,) number of the window, below `size`

    Returns
    -------
    u, v, phase, misfit, in_front : (size,) m of the place, radians of the angle's start, m, and share of the returns that lie before the place
    """
    sin, cos = np.sin(angle), np.cos(angle)
    rows = (a * sin - b * cos, a * cos + b * sin, -sin, -cos)
    weight = np.ones(len(a))
    for _ in range(RESECTION_ROUNDS):
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
