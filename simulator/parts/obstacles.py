"""Objects on the street that hide the ground behind them: cars, trees and poles.

Every class has `hits(origin, direction, rng)`: distance (m; inf where the ray passes), cosine of incidence and brightness,
(N,) each, for rays with (3, N) local origins in m and (3, N) unit directions. `rng` is a numpy Generator.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .materials import LABEL


@dataclass(frozen=True)
class _Body:
    """A convex body: the points p with normals @ p <= limits, in the frame of the object (x ahead, y left, z up)."""

    normals: np.ndarray   # (F, 3) outward unit normals of the faces
    limits: np.ndarray   # (F,) m
    brightness: float   # 0 to 1, reflectance
    transparency: float = 0.0   # 0 to 1, share of the pulses without a return (glass)


@dataclass(frozen=True)
class Solid:
    """A car, or a straight piece of a wall, barrier, fence, hedge or building, which climbs with the ground."""

    x: float   # x, y, z: m, local place of the ground below its middle
    y: float
    z: float
    heading: float   # radians counter-clockwise from east
    bodies: tuple[_Body, ...]   # its parts, upright on level ground
    reach: float   # m, radius of the circle around it
    top: float   # m, local z of its upper edge
    label: int
    slope: float = 0.0   # m per m, of its climb ahead
    returned: float = 1.0   # 0 to 1, share of the pulses that it returns; the others go through
    depth: float = 0.0   # m that a pulse travels in it on average

    def hits(self, origin: np.ndarray, direction: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Distance, cosine of incidence and brightness of each ray; `rng` decides which pulses go through glass, wires or between leaves."""
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        # what climbs is upright where heights count from the climbing line
        turn = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [-self.slope * cos, -self.slope * sin, 1.0]])
        o = turn @ (origin - np.array([[self.x], [self.y], [self.z]]))
        v = turn @ direction
        distance, cosine, brightness = (np.full(v.shape[1], value) for value in (np.inf, 0.0, 0.0))
        for part in self.bodies:
            t, c = _entered(part, o, v)
            if part.transparency:
                c = np.where(rng.random(len(t)) < part.transparency, 0.0, c)
            first = t < distance
            distance[first], cosine[first], brightness[first] = t[first], c[first], part.brightness
        if self.returned < 1.0:
            distance[rng.random(len(distance)) >= self.returned] = np.inf
        if self.depth:
            distance += rng.exponential(self.depth, len(distance))
            cosine = np.where(cosine > 0, rng.uniform(0.3, 1.0, len(cosine)), 0.0)
        return distance, cosine, brightness


def _entered(body: _Body, o: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance (m; inf where the ray passes) and cosine of incidence, (N,) each, where rays enter a convex body: the last plane crossed inward.

    `o`, `v`: (3, N) origins, m, and directions in the frame of the object.
    """
    toward = body.normals @ v
    clearance = body.limits[:, None] - body.normals @ o
    with np.errstate(divide="ignore", invalid="ignore"):
        t = clearance / toward
    incoming, outgoing = toward < 0, toward > 0
    enter = np.where(incoming, t, -np.inf)
    plane = np.argmax(enter, axis=0)
    rays = np.arange(v.shape[1])
    start = enter[plane, rays]
    leave = np.where(outgoing, t, np.inf).min(axis=0)
    outside = ((~incoming) & (~outgoing) & (clearance < 0)).any(axis=0)
    hit = (start > 0) & (start <= leave) & ~outside
    return np.where(hit, start, np.inf), np.where(hit, -toward[plane, rays], 0.0)


def body(faces: Sequence[Sequence[float]], brightness: float, transparency: float = 0.0) -> _Body:
    """A _Body from rows (nx, ny, nz, point x, y, z on the face)."""
    rows = np.array(faces, dtype=float)
    normals = rows[:, :3] / np.linalg.norm(rows[:, :3], axis=1, keepdims=True)
    return _Body(normals, np.sum(normals * rows[:, 3:], axis=1), brightness, transparency)


def _car_bodies(length: float, width: float, height: float, brightness: float) -> tuple[_Body, ...]:
    """Bodies of a car, m and reflectance of its paint: a shell with rounded corners, a cabin with inclined screens, a roof and four wheels."""
    a, b, waist, floor = length / 2, width / 2, 0.58 * height, 0.19
    shell = [(1, 0, 0, a, 0, 0), (-1, 0, 0, -a, 0, 0), (0, 1, 0, 0, b, 0), (0, -1, 0, 0, -b, 0),
             (0, 0, 1, 0, 0, waist), (0, 0, -1, 0, 0, floor)]
    for nx, ny in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        shell += [(nx, ny, 0, nx * (a - 0.22), ny * b, 0), (2 * nx, ny, 0, nx * (a - 0.06), ny * (b - 0.28), 0)]
    for nx, ny in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        rounding = 0.12 if nx else 0.07
        shell.append((nx, ny, 1, nx * a, ny * b, waist - rounding))
    cabin = [(0.9, 0, 0.7, 0.16 * length, 0, waist), (-0.9, 0, 0.45, -0.42 * length, 0, waist),
             (0, 1, 0.35, 0, b - 0.05, waist), (0, -1, 0.35, 0, 0.05 - b, waist),
             (0, 0, -1, 0, 0, waist - 0.02), (0, 0, 1, 0, 0, height - 0.03)]
    roof = [*cabin[:4], (0, 0, -1, 0, 0, height - 0.04), (0, 0, 1, 0, 0, height)]
    bodies = [body(shell, brightness), body(cabin, 0.12, 0.6), body(roof, brightness)]
    for x in (0.30 * length, -0.31 * length):
        for y in (b - 0.22, 0.22 - b):
            wheel = [(0, 1, 0, x, y + 0.2, 0), (0, -1, 0, x, y - 0.2, 0)]
            for angle in np.arange(8) * np.pi / 4:
                nx, nz = np.cos(angle), np.sin(angle)
                wheel.append((nx, 0, nz, x + 0.31 * nx, y, 0.31 + 0.31 * nz))
            bodies.append(body(wheel, 0.05))
    return tuple(bodies)


@dataclass(frozen=True)
class Post:
    """A vertical cylinder: a pole or a trunk."""

    x: float   # x, y, z: m, local place of its foot
    y: float
    z: float
    top: float   # m, local z of its upper end
    radius: float   # m
    label: int   # of its points
    brightness: float   # 0 to 1, reflectance

    @property
    def reach(self) -> float:
        """m, radius of the circle around it."""
        return self.radius

    def hits(self, origin: np.ndarray, direction: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Distance, cosine of incidence and brightness of each ray."""
        dx, dy = origin[0] - self.x, origin[1] - self.y
        square = direction[0] ** 2 + direction[1] ** 2
        half = dx * direction[0] + dy * direction[1]
        inside = half**2 - square * (dx**2 + dy**2 - self.radius**2)
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (-half - np.sqrt(inside)) / square
        height = origin[2] + t * direction[2]
        # outside the surveyed stretch the ground is not computed, so the foot is checked here
        hit = (inside > 0) & (t > 0) & (height <= self.top) & (height >= self.z - 0.03)
        # the incidence angle grows from the middle of the post to its rim
        cosine = np.sqrt(np.maximum(inside, 0.0)) / self.radius
        return np.where(hit, t, np.inf), np.where(hit, cosine, 0.0), np.full(len(t), self.brightness)


@dataclass(frozen=True)
class Crown:
    """The leaves of a tree: an ellipsoid in which a pulse travels a random distance before it meets a leaf."""

    x: float   # x, y, z: m, local place of its middle
    y: float
    z: float
    reach: float   # m, horizontal radius
    half_height: float   # m, vertical radius
    free_way: float = 0.8   # m, mean distance that a pulse travels between leaves
    label: int = LABEL["tree"]   # of its points
    brightness: float = 0.34   # 0 to 1, reflectance

    @property
    def top(self) -> float:
        """m, local z of its upper end."""
        return self.z + self.half_height

    def hits(self, origin: np.ndarray, direction: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Distance, cosine of incidence and brightness of each ray; `rng` decides where a pulse meets a leaf."""
        scale = np.array([[1 / self.reach], [1 / self.reach], [1 / self.half_height]])
        o = (origin - np.array([[self.x], [self.y], [self.z]])) * scale
        v = direction * scale
        square, half = (v * v).sum(0), (o * v).sum(0)
        inside = half**2 - square * ((o * o).sum(0) - 1.0)
        root = np.sqrt(np.maximum(inside, 0.0))
        enter, leave = (-half - root) / square, (-half + root) / square
        t = np.maximum(enter, 0.0) + rng.exponential(self.free_way, len(square))
        hit = (inside > 0) & (t < leave)
        return np.where(hit, t, np.inf), np.where(hit, rng.uniform(0.3, 1.0, len(t)), 0.0), np.full(len(t), self.brightness)


@dataclass(frozen=True)
class Rail:
    """One length of a guard rail: an upright strip between two places."""

    x: float   # x, y, z: m, local place of the ground below its middle
    y: float
    z: float
    heading: float   # radians counter-clockwise from east
    length: float   # m
    slope: float   # m per m, of its climb ahead
    low: float = 0.45   # low, high: m above the ground
    high: float = 0.75
    label: int = LABEL["rail"]   # of its points
    brightness: float = 0.40   # 0 to 1, reflectance

    @property
    def reach(self) -> float:
        """m, radius of the circle around it."""
        return self.length / 2

    @property
    def top(self) -> float:
        """m, local z of its upper edge."""
        return self.z + self.high + abs(self.slope) * self.reach

    def hits(self, origin: np.ndarray, direction: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Distance, cosine of incidence and brightness of each ray."""
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        across = direction[1] * cos - direction[0] * sin
        dx, dy = origin[0] - self.x, origin[1] - self.y
        with np.errstate(divide="ignore", invalid="ignore"):
            t = -(dy * cos - dx * sin) / across
            along = dx * cos + dy * sin + t * (direction[0] * cos + direction[1] * sin)
            above = origin[2] + t * direction[2] - self.z - self.slope * along
        hit = (t > 0) & (np.abs(along) <= self.length / 2) & (above >= self.low) & (above <= self.high)
        return np.where(hit, t, np.inf), np.where(hit, np.abs(across), 0.0), np.full(len(t), self.brightness)


def standing(kind: str, x: float, y: float, z: float, heading: float, shape: Sequence[float]) -> list[Solid | Post | Crown]:
    """The obstacles of a car (length, width, height, brightness), a pole (radius, height) or a tree (radius of the trunk, radius, half height and
    height of the middle of the crown) on the ground at x, y, z; m."""
    if kind == "car":
        return [Solid(x, y, z, heading, _car_bodies(*shape), 2.6, z + 1.6, LABEL["car"])]
    if kind == "pole":
        return [Post(x, y, z, z + shape[1], shape[0], LABEL["pole"], 0.35)]
    trunk, reach, half, middle = shape
    return [Post(x, y, z, z + middle, trunk, LABEL["tree"], 0.18), Crown(x, y, z + middle, reach, half)]
