"""Two rotating line scanners: their pulses, what those meet first, and what it returns.

The scene intersects pulses with its ground. Obstacles are intersected by their shapes, and the nearest hit counts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .materials import LABEL
from .scene import Hits
from .vehicle import Drive, attitude

if TYPE_CHECKING:
    from .scene import SurveyedScene

# Reflectance of each ground in the near infrared.
_REFLECTANCE = {"road": 0.100, "worn paint": 0.125, "paint": 0.46, "manhole": 0.30, "gutter": 0.21, "curb face": 0.21,
               "curb stone": 0.22, "sidewalk": 0.17, "shoulder": 0.16, "verge": 0.30, "stray": 0.05}
_REFLECTANCE_OF_LABEL = np.zeros(len(LABEL))
for _name, _value in _REFLECTANCE.items():
    _REFLECTANCE_OF_LABEL[LABEL[_name]] = _value
_FULL_SCALE = 64000.0  # counts of a white surface at perpendicular incidence and range 0
_HALF_RANGE = 11.0     # m, at which the strength is one half
OBSTACLE = 99      # `strip` of a hit on an obstacle
LONGEST = 70.0    # m, range of the scanners
_HIGHEST = np.sin(np.radians(50.0))  # steeper upward pulses meet nothing on this street


def cast(scene: SurveyedScene, origin: np.ndarray, direction: np.ndarray, station: float, rng: np.random.Generator, reach: float) -> Hits:
    """Intersect pulses, (3, N) local origins, m, and unit directions, with the scene; the nearest hit of each counts.

    station : m, of the scanner, accurate to 15 m
    rng : decides where pulses meet leaves and which pass through glass
    reach : m; ground farther from the axis is left out
    """
    hits = scene.meet(origin, direction, station, reach)
    flat = np.hypot(direction[0], direction[1])
    here_x, here_y = origin[0].mean(), origin[1].mean()
    highest = origin[2].max()
    for obstacle in scene.obstacles:
        if np.hypot(obstacle.x - here_x, obstacle.y - here_y) > 1.6 * reach:
            continue
        to_x, to_y = obstacle.x - origin[0], obstacle.y - origin[1]
        aside = np.abs(to_x * direction[1] - to_y * direction[0])
        ahead = to_x * direction[0] + to_y * direction[1]
        toward = (aside <= obstacle.reach * flat) & (ahead > 0)
        if obstacle.label == LABEL["car"] and highest > obstacle.top:
            toward &= direction[2] < 0
        near = np.flatnonzero(toward)
        if len(near) == 0:
            continue
        distance, cosine, brightness = obstacle.hits(origin[:, near], direction[:, near], rng)
        first = distance < np.minimum(hits.distance[near], LONGEST)
        near = near[first]
        hits.distance[near], hits.cosine[near] = distance[first], cosine[first]
        hits.brightness[near], hits.label[near] = brightness[first], obstacle.label
        hits.strip[near] = OBSTACLE
    return hits


@dataclass(frozen=True)
class Scanner:
    """A rotating line scanner."""

    number: int   # point_source_id
    rotation_rate: float   # Hz
    pulse_rate: float   # Hz
    yaw: float   # degrees, rotation of its axis from straight ahead, counter-clockwise
    tilt: float   # degrees; negative values tilt the lower half of the scan plane backward
    lever_arm: tuple[float, float, float]   # m ahead, left and up from the reference point of the trajectory
    gain: float   # sensitivity relative to the other scanner

    def line(self) -> tuple[np.ndarray, np.ndarray]:
        """Share of the turn, (N,), and direction in the frame of the vehicle, (3, N), of the pulses of one line."""
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

    def pulses(self, drive: Drive, lines: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """The N pulses of (L,) consecutive turns: (3, N) m, local, origins and unit vectors, (N,) s since the start of the drive, scan angles, °."""
        share, along = self.line()
        x, y, z, roll, pitch, heading = drive.pose(np.append(lines, lines[-1] + 1) / self.rotation_rate)
        turn = attitude(roll, pitch, heading)
        centre = np.stack([x, y, z], axis=1) + turn @ np.array(self.lever_arm)
        # within one turn (5 ms) motion and rotation are linear to a few micrometres
        change, moved = np.diff(turn, axis=0), np.diff(centre, axis=0)
        direction = np.einsum("lij,jn->iln", turn[:-1], along) + np.einsum("lij,jn->iln", change, along * share)
        origin = centre[:-1].T[:, :, None] + moved.T[:, :, None] * share
        times = (lines[:, None] + share) / self.rotation_rate
        angle = np.where(share < 0.5, share, share - 1.0) * 360.0
        return origin.reshape(3, -1), direction.reshape(3, -1), times.ravel(), np.tile(angle, len(lines))


def butterfly(rotation_rate: float, pulse_rate: float, yaw: float) -> list[Scanner]:
    """Left and right scanner behind the reference point of the trajectory, as on the roof of a survey vehicle; rates in Hz.

    `yaw`: degrees, rotation of their planes from straight across, one either way, so that they cross.
    """
    return [Scanner(1, rotation_rate, pulse_rate, -yaw, -20.0, (-2.45, 0.32, 0.0), 1.0),
            Scanner(2, rotation_rate, pulse_rate, yaw, -20.0, (-2.45, -0.32, 0.0), 0.94)]


def label_hits(scene: SurveyedScene, hits: Hits, rows: np.ndarray) -> np.ndarray:
    """(M,) uint8 labels of the hits of these (M,) indices."""
    label = hits.label[rows]
    ground = rows[hits.strip[rows] != OBSTACLE]
    label[hits.strip[rows] != OBSTACLE] = scene.labels(hits.strip[ground], hits.station[ground], hits.offset[ground])
    return label


def brightness_of(scene: SurveyedScene, label: np.ndarray, s: np.ndarray, d: np.ndarray, of_obstacles: np.ndarray) -> np.ndarray:
    """(M,) reflectance of hits with these labels at stations and offsets, m: of the ground with patchy asphalt and repairs."""
    texture = scene.texture
    bright = np.where(_REFLECTANCE_OF_LABEL[label] > 0, _REFLECTANCE_OF_LABEL[label], of_obstacles)
    asphalt = np.flatnonzero((label == LABEL["road"]) | (label == LABEL["worn paint"]))
    at_s, at_d = s[asphalt], d[asphalt]
    patchy = 1.0 + 0.07 * texture.at(at_s, at_d, 1.7) + 0.08 * texture.at(at_s, at_d, 0.06)
    patchy *= scene.repaired(at_s, at_d)
    bright[asphalt] *= np.maximum(patchy, 0.4)
    textured = np.flatnonzero((label == LABEL["paint"]) | (label >= LABEL["gutter"]))
    bright[textured] *= np.maximum(1.0 + 0.10 * texture.at(s[textured], d[textured], 0.05), 0.4)
    return bright


def received(brightness: np.ndarray, distance: np.ndarray, cosine: np.ndarray, gain: float) -> np.ndarray:
    """(M,) counts that are received without noise, from reflectance, distance, m, cosine of incidence and the gain of the scanner.

    The strength is proportional to the brightness and to a power of the cosine below 1, as of rough asphalt. The range law
    1 / (1 + (R / R0)^2) is the inverse square at long range and levels off near the scanner, where the receiver sees
    only a part of the spot.
    """
    return _FULL_SCALE * gain * brightness * np.maximum(cosine, 0.0) ** 0.7 / (1.0 + (distance / _HALF_RANGE) ** 2)
