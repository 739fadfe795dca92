"""Drives along streets of known section under scanners with rotating mirrors, every pose known; for surveys without a trajectory."""

from dataclasses import dataclass

import numpy as np
from drives import EAST, NORTH, write_cloud
from lanewright.core.survey.estimation.poses import vehicle_axes
from lanewright.core.survey.trajectory.trajectory import Trajectory

START = 5000.0   # s
ROAD, CURB = 4.0, 0.12
# across and above, from right to left: walls 9 m out, sidewalks behind curbs, a road of which either half falls off by the crown
WALLS = (9.0, 6.0)


def section(crown=0.025, curb=CURB, wall=WALLS):
    """Corners (offset, height) of a street from right to left."""
    half = [(0.0, 0.0), (ROAD, -crown * ROAD), (ROAD, curb - crown * ROAD), (wall[0], curb - crown * ROAD + 0.05), (wall[0], wall[1])]
    return [(-y, z) for y, z in half[:0:-1]] + half


@dataclass(frozen=True)
class Mirror:
    """A scanner: turned and leaning (degrees), its place on the vehicle (m ahead, left, up), Hz and pulses per second."""

    turn: float = 45.0
    lean: float = 20.0
    lever: tuple = (0.0, 0.0, 0.0)
    rate: float = 100.0
    pulses: float = 20_000.0
    ahead: float = 0.3   # turns at the start


@dataclass
class MirrorDrive:
    """What was measured and from where; `poses` is (time) -> x, y, z, roll, pitch, yaw."""

    time: np.ndarray
    place: np.ndarray
    scanner: np.ndarray
    poses: object

    def write(self, path, which=slice(None), with_time=True, merged=False, **fields):
        """The cloud as a file; `merged` without a field that distinguishes the scanners."""
        x, y, z = self.place[which].T + np.array([[EAST], [NORTH], [100.0]])
        time = self.time[which] if with_time else None
        return write_cloud(path, x, y, z, time, source=1 if merged else 1 + self.scanner[which], crs="EPSG:32632", **fields)

    def trajectory(self):
        """The true Trajectory, 50 rows a second."""
        time = np.arange(self.time.min() - 0.5, self.time.max() + 0.5, 0.02)
        x, y, z, roll, pitch, yaw = self.poses(time)
        return Trajectory(time, x + EAST, y + NORTH, z + 100.0, np.degrees(roll), np.degrees(pitch), (90.0 - np.degrees(yaw)) % 360.0)

    def errors(self, trajectory):
        """(N,) m ahead, left and up by which a trajectory lies off the truth."""
        x, y, z, roll, pitch, yaw = self.poses(trajectory.time)
        off = np.stack([trajectory.x - EAST - x, trajectory.y - NORTH - y, trajectory.z - 100.0 - z], axis=1)
        return [(axis * off).sum(axis=1) for axis in vehicle_axes(roll, pitch, yaw)]


def swaying(speed=10.0, offset=-1.5, height=2.5, sway=1.0, crossfall=0.025):
    """Poses of a vehicle that drives along x, to the right of the crown, on springs."""

    def poses(time):
        t = np.asarray(time) - START
        x, y = speed * t + 0.2 * np.sin(0.7 * t), offset + sway * 0.15 * np.sin(0.9 * t)
        z = height + crossfall * offset + sway * 0.01 * np.sin(5.0 * t)
        yaw = np.arctan2(np.gradient(y, t), np.gradient(x, t)) if len(t) > 1 else np.zeros(1)
        roll = crossfall + sway * np.radians(0.4) * np.sin(3.3 * t)
        pitch = sway * np.radians(0.3) * np.sin(2.7 * t + 1.0)
        return x, y, np.broadcast_to(z, x.shape), roll, pitch, yaw

    return poses


def mirror_drive(mirrors=(Mirror(),), seconds=6.0, poses=None, corners=None, noise=0.004, wander=0.0, seed=3):
    """What mirrors see of a street that goes on straight; range noise in metres, the rotation swings by the share `wander`."""
    rng = np.random.default_rng(seed)
    poses, corners = poses or swaying(), np.array(section() if corners is None else corners)
    parts = []
    for number, mirror in enumerate(mirrors):
        time = START + np.arange(0.0, seconds, 1.0 / mirror.pulses)
        x, y, z, roll, pitch, yaw = poses(time)
        axes = vehicle_axes(roll, pitch, yaw)
        place = np.stack([x, y, z], axis=1) + sum(axis * arm for axis, arm in zip(axes, mirror.lever))
        since = time - START
        angle = 2 * np.pi * (mirror.rate * (since + wander * 4.0 / (2 * np.pi) * np.sin(2 * np.pi * since / 4.0)) + mirror.ahead)
        turn, lean = np.radians([mirror.turn, mirror.lean])
        across = np.array([-np.sin(turn), np.cos(turn), 0.0])
        upright = np.array([np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)])
        ray = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * upright
        ray = sum(axis * ray[:, k:k + 1] for k, axis in enumerate(axes))
        reach = np.full(len(time), np.inf)
        for (y0, z0), (y1, z1) in zip(corners[:-1], corners[1:]):
            normal = z0 - z1, y1 - y0
            with np.errstate(divide="ignore", invalid="ignore"):
                r = ((y0 - place[:, 1]) * normal[0] + (z0 - place[:, 2]) * normal[1]) / (ray[:, 1] * normal[0] + ray[:, 2] * normal[1])
                hit_y, hit_z = place[:, 1] + r * ray[:, 1] - y0, place[:, 2] + r * ray[:, 2] - z0
                share = (hit_y * (y1 - y0) + hit_z * (z1 - z0)) / ((y1 - y0) ** 2 + (z1 - z0) ** 2)
            hit = (r > 0.3) & (r < 60.0) & (share >= 0) & (share <= 1) & (r < reach)
            reach = np.where(hit, r, reach)
        seen = np.isfinite(reach)
        found = place[seen] + (reach[seen] + noise * rng.standard_normal(seen.sum()))[:, None] * ray[seen]
        parts.append((time[seen], found, np.full(seen.sum(), number)))
    time, place, scanner = (np.concatenate(column) for column in zip(*parts))
    return MirrorDrive(time, place, scanner, poses)
