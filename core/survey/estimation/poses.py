"""Poses of the vehicle as a smooth function of time, and the mounting of its scanners."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

KNOT_SPACING = 0.1   # s between the knots of the splines: suspensions swing at 1 to 3 Hz
X, Y, Z, ROLL, PITCH, YAW = range(6)   # columns of the control values; the phases of the scanners follow
POSE = 6             # columns before the phases


@dataclass(frozen=True)
class DriveKnots:
    """The knots of one drive among all: control values first .. first + count - 1, the first interval begins at `start` (s)."""

    start: float
    first: int
    count: int

    def interval(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Number among all intervals, and share of it that has passed, at (N,) times of the drive."""
        since = (np.asarray(time, float) - self.start) / KNOT_SPACING
        number = np.clip(np.floor(since).astype(np.int64), 0, self.count - 4)
        return number + self.first, since - number

    @property
    def middles(self) -> np.ndarray:
        """(count,) s at which each control value weighs most."""
        return self.start + (np.arange(self.count) - 1.0) * KNOT_SPACING


@dataclass(frozen=True)
class Poses:
    """Cubic B-splines of place, attitude and mirror phases, and the mounting of S scanners.

    Attributes
    ----------
    drives : DriveKnots of each drive
    control : (K, 6 + S) control values: x, y, z (m), roll (right side down), pitch (nose up), yaw (counter-clockwise from east; radians),
        and of each scanner what its direction angle is ahead of 2 pi rate t (radians)
    rate : (S,) Hz
    turn : (S,) radians by which the scan line is turned counter-clockwise from straight across
    lean : (S,) radians by which the scan plane leans, its upper half forward
    lever : (S, 3) m ahead, left and up from the place of the pose; their mean is 0
    """

    drives: tuple[DriveKnots, ...]
    control: np.ndarray
    rate: np.ndarray
    turn: np.ndarray
    lean: np.ndarray
    lever: np.ndarray

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

    def changed(self, control: np.ndarray, mounting: np.ndarray) -> Poses:
        """The poses with (K, 6 + S) added to the control values and (S, 5) to turn, lean and lever."""
        return replace(self, control=self.control + control, turn=self.turn + mounting[:, 0], lean=self.lean + mounting[:, 1],
                       lever=self.lever + mounting[:, 2:])


def spline_weights(share: np.ndarray) -> np.ndarray:
    """(N, 4) weights of the control values around (N,) places in an interval, 0 to 1."""
    u = np.asarray(share, float)
    return np.stack([(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3], axis=-1) / 6.0


def spline_slopes(share: np.ndarray) -> np.ndarray:
    """(N, 4) weights for the change per second."""
    u = np.asarray(share, float)
    return np.stack([-((1 - u) ** 2), 3 * u**2 - 4 * u, -3 * u**2 + 2 * u + 1, u**2], axis=-1) / (2.0 * KNOT_SPACING)


def vehicle_axes(roll: np.ndarray, pitch: np.ndarray, yaw: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(N, 3) unit vectors ahead, left and up of a vehicle; (N,) radians as in Poses."""
    cr, sr, cp, sp, ct, st = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    return (np.stack([ct * cp, st * cp, sp], axis=-1),
            np.stack([-st * cr - ct * sp * sr, ct * cr - st * sp * sr, cp * sr], axis=-1),
            np.stack([st * sr - ct * sp * cr, -ct * sr - st * sp * cr, cp * cr], axis=-1))
