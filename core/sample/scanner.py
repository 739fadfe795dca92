"""Two rotating line scanners on the roof, their planes crossed like the wings of a butterfly."""

from dataclasses import dataclass

import numpy as np

from .drive import attitude

_HIGHEST = np.sin(np.radians(50.0))  # pulses steeper upwards meet nothing on this street


@dataclass(frozen=True)
class Scanner:
    """A line scanner: one pulse after the other around its axis.

    Attributes
    ----------
    number : point_source_id
    rotation_rate : turns per second
    pulse_rate : pulses per second
    yaw : degrees, the axis turned from straight ahead, counter-clockwise
    tilt : degrees, negative leans the lower half of the scan plane backwards
    lever_arm : m ahead, left and up of the trajectory's point
    gain : its sensitivity beside the other's
    """

    number: int
    rotation_rate: float
    pulse_rate: float
    yaw: float
    tilt: float
    lever_arm: tuple
    gain: float

    def line(self):
        """Share of the turn and direction in the vehicle's frame, (N,) and (3, N), of the pulses of one line."""
        count = int(round(self.pulse_rate / self.rotation_rate))
        share = np.arange(count) / count
        angle = 2 * np.pi * share
        yaw, tilt = np.radians(self.yaw), np.radians(self.tilt)
        plane = np.stack([np.zeros(count), np.sin(angle), -np.cos(angle)])
        lean = np.array([[np.cos(tilt), 0, -np.sin(tilt)], [0, 1, 0], [np.sin(tilt), 0, np.cos(tilt)]])
        turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
        directions = turn @ lean @ plane
        used = directions[2] < _HIGHEST
        return share[used], directions[:, used]

    def pulses(self, drive, lines):
        """Origins, directions ((3, N), local), times since the start and scan angles of some turns."""
        share, along = self.line()
        x, y, z, roll, pitch, heading = drive.pose(np.append(lines, lines[-1] + 1) / self.rotation_rate)
        turn = attitude(roll, pitch, heading)
        place = np.stack([x, y, z], axis=1) + turn @ np.array(self.lever_arm)
        # Within one turn (5 ms) the vehicle moves straight and turns evenly, to a few micrometres.
        change, moved = np.diff(turn, axis=0), np.diff(place, axis=0)
        direction = np.einsum("lij,jn->iln", turn[:-1], along) + np.einsum("lij,jn->iln", change, along * share)
        origin = place[:-1].T[:, :, None] + moved.T[:, :, None] * share
        times = (lines[:, None] + share) / self.rotation_rate
        angle = np.where(share < 0.5, share, share - 1.0) * 360.0
        return origin.reshape(3, -1), direction.reshape(3, -1), times.ravel(), np.tile(angle, len(lines))


def butterfly(rotation_rate, pulse_rate, yaw):
    """Left and right scanner behind and above the trajectory's point, as on a roof-mounted two-scanner system.

    yaw : degrees by which their planes are turned from straight across, one either way
    """
    return [Scanner(1, rotation_rate, pulse_rate, -yaw, -20.0, (-2.45, 0.32, 0.0), 1.0),
            Scanner(2, rotation_rate, pulse_rate, yaw, -20.0, (-2.45, -0.32, 0.0), 0.94)]
