"""The intersection of pulses with the ground of a simulated street.

A pulse is traced to the carriageway, continued beyond its edges, by three Newton steps. If it arrives beyond an edge, the
borders of the strips there (curb bottom, curb top and so on) are passed one after the other. The pulse hits the first strip
whose outer border it reaches below the ground, at a place found by the secant rule. So the faces of curbs are hit,
and a raised sidewalk hides the ground behind it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..parts.scanner import LONGEST
from ..parts.scene import Hits

if TYPE_CHECKING:
    from .street import Scene

_GRAZING = 0.02    # sine of the flattest downward direction that is traced
_MARGIN = 1.0      # m around the surveyed stretch, within which the ground is computed


def cast_ground(scene: Scene, origin: np.ndarray, direction: np.ndarray, station: float, reach: float) -> Hits:
    """Intersect pulses with the ground alone.

    Parameters
    ----------
    scene : Scene
    origin : (3, N) m, local
    direction : (3, N) unit vectors
    station : m, of the scanner, accurate to 15 m
    reach : m; ground farther from the axis is left out

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
    there = (t < LONGEST) & (s > -4.0) & (s < scene.length + 4.0)
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
    good = np.flatnonzero((t < LONGEST) & (np.abs(d) <= reach) & (s > -_MARGIN) & (s < scene.length + _MARGIN))
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
