"""Two rotating line scanners, and the intersection of their pulses with the simulated street.

A pulse is traced to the carriageway, continued beyond its edges, by three Newton steps. If it arrives beyond an edge, the
borders of the strips there (curb bottom, curb top and so on) are passed one after the other. The pulse hits the first strip
whose outer border it reaches below the ground, at a place found by the secant rule. So the faces of curbs are hit,
and a raised sidewalk hides the ground behind it. Obstacles are intersected by their shapes, and the nearest hit counts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .street import LABEL
from .vehicle import Drive, attitude

if TYPE_CHECKING:
    from .street import Scene

# Reflectance of each ground in the near infrared.
_REFLECTANCE = {"road": 0.100, "worn paint": 0.125, "paint": 0.46, "manhole": 0.30, "gutter": 0.21, "curb face": 0.21,
               "curb stone": 0.22, "sidewalk": 0.17, "shoulder": 0.16, "verge": 0.30, "stray": 0.05}
_REFLECTANCE_OF_LABEL = np.zeros(len(LABEL))
for _name, _value in _REFLECTANCE.items():
    _REFLECTANCE_OF_LABEL[LABEL[_name]] = _value
_FULL_SCALE = 64000.0  # counts of a white surface at perpendicular incidence and range 0
_HALF_RANGE = 11.0     # m, at which the strength is one half
OBSTACLE = 99      # `strip` of a hit on an obstacle
_LONGEST = 70.0    # m, range of the scanners
_GRAZING = 0.02    # sine of the flattest downward direction that is traced
_MARGIN = 1.0      # m around the surveyed stretch, within which the ground is computed
_HIGHEST = np.sin(np.radians(50.0))  # steeper upward pulses meet nothing on this street


@dataclass
class Hits:
    """The first intersection of each of N pulses.

    Attributes
    ----------
    distance : (N,) m, inf where a pulse meets nothing
    station, offset : (N,) m
    cosine : (N,) of the incidence angle
    strip : (N,) int8, 0 for the carriageway, k or -k for the k-th strip beyond the left or right edge, OBSTACLE for obstacles
    label : (N,) uint8 of obstacles, 0 for the ground
    brightness : (N,) 0 to 1, of obstacles
    """

    distance: np.ndarray
    station: np.ndarray
    offset: np.ndarray
    cosine: np.ndarray
    strip: np.ndarray
    label: np.ndarray
    brightness: np.ndarray


def cast(scene: Scene, origin: np.ndarray, direction: np.ndarray, station: float, rng: np.random.Generator, reach: float) -> Hits:
    """Intersect pulses with the scene; the nearest hit of each counts.

    Parameters
    ----------
    scene : Scene
    origin : (3, N) m, local
    direction : (3, N) unit vectors
    station : m, of the scanner, accurate to 15 m
    rng : Generator for the leaves of trees and the glass of cars
    reach : m; ground farther from the axis is left out

    Returns
    -------
    Hits
    """
    hits = cast_ground(scene, origin, direction, station, reach)
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
        if obstacle.label == LABEL["car"] and highest > obstacle.z + obstacle.top:
            toward &= direction[2] < 0
        near = np.flatnonzero(toward)
        if len(near) == 0:
            continue
        distance, cosine, brightness = obstacle.hits(origin[:, near], direction[:, near], rng)
        first = distance < np.minimum(hits.distance[near], _LONGEST)
        near = near[first]
        hits.distance[near], hits.cosine[near] = distance[first], cosine[first]
        hits.brightness[near], hits.label[near] = brightness[first], obstacle.label
        hits.strip[near] = OBSTACLE
    return hits


def cast_ground(scene: Scene, origin: np.ndarray, direction: np.ndarray, station: float, reach: float) -> Hits:
    """Intersect pulses with the ground alone.

    Parameters
    ----------
    scene, origin, direction, station, reach : as in `cast`

    Returns
    -------
    Hits
    """
    count = direction.shape[1]
    hits = Hits(np.full(count, np.inf), np.full(count, station), np.zeros(count), np.zeros(count),
                np.zeros(count, dtype=np.int8), np.zeros(count, dtype=np.uint8), np.zeros(count))
    down = np.flatnonzero(direction[2] < -_GRAZING)
    rays = _Rays(scene.axis, origin[:, down], direction[:, down])
    t = (rays.oz - scene.grade_line(station)) / -rays.vz
    s, d = rays.at(t, np.full(len(t), station), steps=2)
    # only pulses that reach the ground on the surveyed stretch are traced further
    there = (t < _LONGEST) & (s > -4.0) & (s < scene.length + 4.0)
    there &= np.abs(d) < reach + 25.0
    rays, down, t, s, d = rays.some(there), down[there], t[there], s[there], d[there]
    for _ in range(3):
        # Newton step; the slope of the road along the ray follows from its grade and cross slope
        error = rays.oz + t * rays.vz - scene.carriageway(s, d)
        ahead = rays.vx * rays.cos + rays.vy * rays.sin
        aside = rays.vy * rays.cos - rays.vx * rays.sin
        t = t - error / (rays.vz - scene.grade(s) * ahead - scene.cross_slope(d) * aside)
        s, d = rays.at(t, s, steps=1)
    strip = np.zeros(len(t), dtype=np.int8)
    for side in (scene.left, scene.right):
        beyond = np.flatnonzero(side.sign * d > side.edge)
        t[beyond], s[beyond], d[beyond], strip[beyond] = _beyond_edge(
            scene, side, rays.some(beyond), t[beyond], s[beyond], d[beyond])
    good = np.flatnonzero((t < _LONGEST) & (np.abs(d) <= reach) & (s > -_MARGIN) & (s < scene.length + _MARGIN))
    down, strip = down[good], strip[good]
    hits.distance[down], hits.station[down], hits.offset[down] = t[good], s[good], d[good]
    hits.strip[down] = strip
    hits.cosine[down] = _incidence(scene, rays.some(good), s[good], d[good], strip)
    return hits


def _beyond_edge(scene, side, rays, t, s, d):
    """Hits on the strips of one side, of pulses that pass its edge above the ground.

    Returns t, s, d and the signed number of the strip; t is inf where a pulse passes the last border above the ground.
    """
    found_t, found_s, found_d = np.full(len(t), np.inf), s.copy(), d.copy()
    found_strip = np.zeros(len(t), dtype=np.int8)
    outward = side.sign * (rays.vy * rays.cos - rays.vx * rays.sin)
    live = np.flatnonzero(outward > 0.02)
    t, s, away, ray = t[live], s[live], side.sign * d[live], rays.some(live)
    t, s, away = ray.reach(side, side.edge, t, s, away, times=3)
    on = np.flatnonzero((t > 0) & (np.abs(away - side.edge) < 0.01))
    live, ray, t, s, away = live[on], ray.some(on), t[on], s[on], away[on]
    above = ray.oz + t * ray.vz - scene.edge_height(side, s)
    for k in range(1, len(side.borders)):
        next_t, next_s, next_away = ray.reach(side, side.borders[k], t, s, away, times=2 if k < 3 else 3)
        # in a bend a few pulses run along a border without passing it; they are left out
        passed = (next_t >= t) & (np.abs(next_away - side.borders[k]) < 0.01)
        ground = scene.edge_height(side, next_s) + side.border_rise(k, next_s)
        next_above = ray.oz + next_t * ray.vz - ground
        met = np.flatnonzero(passed & (next_above <= 0))
        if len(met):
            at = live[met]
            found_t[at], found_s[at], found_d[at] = _within_strip(
                scene, side, k - 1, ray.some(met), (t[met], above[met]), (next_t[met], next_above[met]), s[met])
            found_strip[at] = side.sign * k
        on = np.flatnonzero(passed & (next_above > 0))
        live, ray = live[on], ray.some(on)
        t, s, away, above = next_t[on], next_s[on], next_away[on], next_above[on]
        if len(live) == 0:
            break
    return found_t, found_s, found_d, found_strip


def _within_strip(scene, side, strip, rays, near, far, s):
    """Hits of pulses on one strip, between a place above it and a place below it.

    The strip is plane except for the bend of the road and a lowered curb, so four secant steps inside the bracket leave an
    error below 0.1 mm.
    """
    (low, f0), (high, f1) = near, far
    t0, t = high, low + (high - low) * f0 / np.where(f0 > f1, f0 - f1, 1.0)
    error0, steps = f1, 2
    for _ in range(4):
        s, d = rays.at(t, s, steps)
        ground = scene.edge_height(side, s) + side.rise_in_strip(strip, s, side.sign * d)
        error = rays.oz + t * rays.vz - ground
        change = error - error0
        usable = np.abs(change) > 1e-13
        step = np.where(usable, error * (t - t0) / np.where(usable, change, 1.0), 0.0)
        t0, error0, steps = t, error, 1
        t = np.clip(t - step, low, high)
    s, d = rays.at(t, s, 1)
    return t, s, d


def _incidence(scene, rays, s, d, strip):
    """Cosine of the angle between a pulse and the normal of the ground."""
    slope = scene.cross_slope(d)
    for side in (scene.left, scene.right):
        beyond = np.flatnonzero(strip * side.sign > 0)
        slope[beyond] = side.sign * side.steepness(np.abs(strip[beyond]) - 1, s[beyond])
    grade = scene.grade(s)
    ahead = rays.vx * rays.cos + rays.vy * rays.sin
    aside = rays.vy * rays.cos - rays.vx * rays.sin
    return (grade * ahead + slope * aside - rays.vz) / np.sqrt(1.0 + slope * slope + grade * grade)


class _Rays:
    """Pulses, with the direction of the road below the place to which they were traced last."""

    def __init__(self, axis, origin, direction, cos=None, sin=None):
        self.axis, self.cos, self.sin = axis, cos, sin
        self.ox, self.oy, self.oz = origin
        self.vx, self.vy, self.vz = direction

    def some(self, which):
        """Some of the pulses, by indices or a mask."""
        if isinstance(which, np.ndarray) and which.dtype == bool:
            which = np.flatnonzero(which)
        return _Rays(self.axis, (self.ox[which], self.oy[which], self.oz[which]),
                     (self.vx[which], self.vy[which], self.vz[which]), self.cos[which], self.sin[which])

    def at(self, t, s, steps):
        """Station and offset at the distance t, from approximate stations."""
        s, d, self.cos, self.sin = self.axis.locate(self.ox + t * self.vx, self.oy + t * self.vy, s, steps)
        return s, d

    def reach(self, side, distance, t, s, away, times):
        """Distance, station and distance from the axis where pulses pass a border, from a place near it."""
        for _ in range(times):
            outward = side.sign * (self.vy * self.cos - self.vx * self.sin)
            t = t + (distance - away) / np.maximum(outward, 0.01)
            s, d = self.at(t, s, steps=2 if times > 2 else 1)
            away = side.sign * d
        return t, s, away


@dataclass(frozen=True)
class Scanner:
    """A rotating line scanner.

    Attributes
    ----------
    number : point_source_id
    rotation_rate : Hz
    pulse_rate : Hz
    yaw : degrees, rotation of its axis from straight ahead, counter-clockwise
    tilt : degrees; negative values tilt the lower half of the scan plane backward
    lever_arm : m ahead, left and up from the reference point of the trajectory
    gain : sensitivity relative to the other scanner
    """

    number: int
    rotation_rate: float
    pulse_rate: float
    yaw: float
    tilt: float
    lever_arm: tuple[float, float, float]
    gain: float

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
        """The N pulses of some turns.

        Parameters
        ----------
        drive : Drive
        lines : (L,) int, consecutive numbers of turns

        Returns
        -------
        origin : (3, N) m, local
        direction : (3, N) unit vectors
        times : (N,) s since the start of the drive
        angle : (N,) degrees, scan angle
        """
        share, along = self.line()
        x, y, z, roll, pitch, heading = drive.pose(np.append(lines, lines[-1] + 1) / self.rotation_rate)
        turn = attitude(roll, pitch, heading)
        place = np.stack([x, y, z], axis=1) + turn @ np.array(self.lever_arm)
        # within one turn (5 ms) motion and rotation are linear to a few micrometres
        change, moved = np.diff(turn, axis=0), np.diff(place, axis=0)
        direction = np.einsum("lij,jn->iln", turn[:-1], along) + np.einsum("lij,jn->iln", change, along * share)
        origin = place[:-1].T[:, :, None] + moved.T[:, :, None] * share
        times = (lines[:, None] + share) / self.rotation_rate
        angle = np.where(share < 0.5, share, share - 1.0) * 360.0
        return origin.reshape(3, -1), direction.reshape(3, -1), times.ravel(), np.tile(angle, len(lines))


def butterfly(rotation_rate: float, pulse_rate: float, yaw: float) -> list[Scanner]:
    """Left and right scanner behind the reference point of the trajectory, their planes crossed, as on the roof of a survey vehicle.

    Parameters
    ----------
    rotation_rate, pulse_rate : Hz
    yaw : degrees, rotation of their planes from straight across, one either way

    Returns
    -------
    list of two Scanner
    """
    return [Scanner(1, rotation_rate, pulse_rate, -yaw, -20.0, (-2.45, 0.32, 0.0), 1.0),
            Scanner(2, rotation_rate, pulse_rate, yaw, -20.0, (-2.45, -0.32, 0.0), 0.94)]


def label_hits(scene: Scene, hits: Hits, found: np.ndarray) -> np.ndarray:
    """Labels of hits.

    Parameters
    ----------
    scene : Scene
    hits : Hits
    found : (M,) int, indices of hits

    Returns
    -------
    (M,) uint8
    """
    strip, label = hits.strip[found], hits.label[found]
    road = strip == 0
    label[road] = scene.carriageway_labels(hits.station[found[road]], hits.offset[found[road]])
    for side in (scene.left, scene.right):
        names = np.array([0] + [LABEL[name] for name in side.strips], dtype=np.uint8)
        beside = (strip * side.sign > 0) & (strip != OBSTACLE)
        label[beside] = names[np.abs(strip[beside])]
    return label


def brightness_of(scene: Scene, label: np.ndarray, s: np.ndarray, d: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Reflectance of hits: that of the ground, with patchy asphalt and repairs.

    Parameters
    ----------
    scene : Scene
    label : (M,) uint8
    s, d : (M,) m, stations and offsets
    own : (M,) reflectance of hits on obstacles

    Returns
    -------
    (M,) 0 to 1
    """
    texture = scene.texture
    bright = np.where(_REFLECTANCE_OF_LABEL[label] > 0, _REFLECTANCE_OF_LABEL[label], own)
    asphalt = np.flatnonzero((label == LABEL["road"]) | (label == LABEL["worn paint"]))
    at_s, at_d = s[asphalt], d[asphalt]
    patchy = 1.0 + 0.07 * texture.at(at_s, at_d, 1.7) + 0.08 * texture.at(at_s, at_d, 0.06)
    if len(at_s):
        near = (scene.repairs[:, 1] > at_s.min()) & (scene.repairs[:, 0] < at_s.max())
        for start, end, right, left, factor in scene.repairs[near]:
            patchy[(at_s >= start) & (at_s <= end) & (at_d >= right) & (at_d <= left)] *= factor
    bright[asphalt] *= np.maximum(patchy, 0.4)
    other = np.flatnonzero((label == LABEL["paint"]) | (label >= LABEL["gutter"]))
    bright[other] *= np.maximum(1.0 + 0.10 * texture.at(s[other], d[other], 0.05), 0.4)
    return bright


def received(brightness: np.ndarray, distance: np.ndarray, cosine: np.ndarray, gain: float) -> np.ndarray:
    """Strength of returns without noise.

    The strength is proportional to the brightness and to a power of the cosine below 1, as of rough asphalt. The range law
    1 / (1 + (R / R0)^2) is the inverse square at long range and levels off near the scanner, where the receiver sees
    only a part of the spot.

    Parameters
    ----------
    brightness : (M,) 0 to 1
    distance : (M,) m
    cosine : (M,) of the incidence angle
    gain : of the scanner

    Returns
    -------
    (M,) counts
    """
    return _FULL_SCALE * gain * brightness * np.maximum(cosine, 0.0) ** 0.7 / (1.0 + (distance / _HALF_RANGE) ** 2)
