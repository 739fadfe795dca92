"""The motion of the survey vehicle: passes along the simulated road."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .scene import Followed

SENSOR_HEIGHT = 2.6  # m from the ground to the reference point of the trajectory
_RUN_OUT = 15.0      # m driven before and after the surveyed stretch


@dataclass(frozen=True)
class Drive:
    """One pass: position and attitude as smooth functions of the time since its start."""

    way: Followed
    direction: int   # 1 along the axis, -1 against it
    offset: float   # m, mean offset of the vehicle
    speed: float   # m/s, mean
    start_time: float   # s, GPS time of its first moment
    phase: float   # radians, phase of the sway of this pass

    @property
    def duration(self) -> float:
        """Duration, s, a whole number of trajectory intervals of 5 ms."""
        return float(np.ceil((self.way.length + 2 * _RUN_OUT) / self.speed * 200.0) / 200.0)

    def station(self, t: np.ndarray) -> np.ndarray:
        """Station of the vehicle, m, at times t; its speed varies by 3 percent."""
        swing = 0.03 * 17.0 / (2 * np.pi)
        way = self.speed * (t + swing * (np.cos(self.phase) - np.cos(2 * np.pi * t / 17.0 + self.phase)))
        return way - _RUN_OUT if self.direction > 0 else self.way.length + _RUN_OUT - way

    def _ground_track(self, t):
        s = self.station(t)
        d = self.offset + 0.12 * np.sin(s / 11.0 + self.phase) + 0.04 * np.sin(s / 3.7 + 2 * self.phase)
        x, y = self.way.place(s, d)
        return s, d, x, y

    def pose(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """x, y, z, m, local, and roll, pitch, heading, radians, of the vehicle at (N,) s since the start, (N,) each.

        Roll is positive with the right side down, pitch with the nose up, heading clockwise from grid north.
        """
        s, d, x, y = self._ground_track(t)
        *_, ahead_x, ahead_y = self._ground_track(t + 0.01)
        *_, behind_x, behind_y = self._ground_track(t - 0.01)
        heading = np.arctan2(ahead_x - behind_x, ahead_y - behind_y)
        sway = self.phase
        z, grade, cross_slope = self.way.under(s, d)
        z = z + SENSOR_HEIGHT + 0.010 * np.sin(2 * np.pi * t / 1.3 + sway)
        # a road that falls to the left has a negative slope and a negative roll
        roll = (self.direction * np.arctan(cross_slope)
                + np.radians(0.35) * np.sin(2 * np.pi * t / 1.9 + sway) + np.radians(0.08) * np.sin(2 * np.pi * t / 0.7))
        pitch = (self.direction * np.arctan(grade)
                 + np.radians(0.25) * np.sin(2 * np.pi * t / 2.3 + 2 * sway) + np.radians(0.06) * np.sin(2 * np.pi * t / 0.9))
        heading = heading + np.radians(0.20) * np.sin(2 * np.pi * t / 3.1 + sway)
        return x, y, z, roll, pitch, heading % (2 * np.pi)


def attitude(roll: np.ndarray, pitch: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """(N, 3, 3) rotations from the frame of the vehicle (x ahead, y left, z up) to the map, of angles as in `Drive.pose`."""
    turn = np.pi / 2 - heading
    cr, sr, cp, sp, ct, st = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch), np.cos(turn), np.sin(turn)
    ahead = np.stack([ct * cp, st * cp, sp])
    left = np.stack([-st * cr - ct * sp * sr, ct * cr - st * sp * sr, cp * sr])
    up = np.stack([st * sr - ct * sp * cr, -ct * sr - st * sp * cr, cp * cr])
    return np.moveaxis(np.stack([ahead, left, up], axis=1), 2, 0)
