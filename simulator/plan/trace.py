"""The intersection of pulses with the ground of a plan.

A pulse first goes down to where the ground can begin, by steps that the steepest slope of the terrain allows. From there it is followed
on the exact ground, by steps no longer than the way to the next edge, until it is below; the place between the last two steps is found
by the rule of false position. So the faces of curbs are hit, and raised ground hides what lies behind it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .ground import Ground

_NEAREST, _FARTHEST = 0.08, 0.5   # m, a step over the ground at an edge and far from one
_STEPS = 120          # of each kind at the most
_CLOSE = 2e-5         # m, error in height of a hit
_GRAZING = 0.02       # least sine of the angle towards the steepest ground


def trace(ground: Ground, origin: np.ndarray, direction: np.ndarray, farthest: float) -> np.ndarray:
    """(N,) m at which pulses, (3, N) local origins, m, and unit directions, meet the ground within `farthest` m over it; inf where they do not."""
    distance = np.full(direction.shape[1], np.inf)
    flat = np.hypot(direction[0], direction[1])
    steepest = ground.terrain.steepest
    ray = np.flatnonzero(steepest * flat - direction[2] > _GRAZING)
    limit = np.full(len(distance), np.inf)
    limit[ray] = np.minimum(farthest / np.maximum(flat[ray], 1e-6), 4.0 * farthest)
    t = np.zeros(len(distance))
    live = ray
    for _ in range(_STEPS):
        x, y, z = origin[:, live] + t[live] * direction[:, live]
        free = z - ground.terrain.at(x, y)[0] - ground.highest
        down = free > 0.02
        live = live[down]
        t[live] += free[down] / (steepest * flat[live] - direction[2, live])
        live = live[t[live] < limit[live]]
        if len(live) == 0:
            break
    live = ray[t[ray] < limit[ray]]
    return _follow(ground, origin, direction, t, live, limit, flat, distance)


def _follow(ground, origin, direction, t, live, limit, flat, reached):
    """Steps on the exact ground until below it, then the place between the last two."""
    before, above = t.copy(), np.zeros(len(t))
    below, under = np.full(len(t), np.nan), np.zeros(len(t))
    for _ in range(_STEPS):
        x, y, z = origin[:, live] + t[live] * direction[:, live]
        surface = ground.at(x, y)
        gap = z - surface.z
        hit = gap <= 0
        below[live[hit]], under[live[hit]] = t[live[hit]], gap[hit]
        live, gap, distance = live[~hit], gap[~hit], np.abs(surface.away[~hit])
        before[live], above[live] = t[live], gap
        over = np.clip(0.9 * distance, _NEAREST, np.where(surface.away[~hit] > 0, _FARTHEST, np.inf)) / np.maximum(flat[live], 1e-6)
        fall = 1.02 * (gap + 0.005) / np.maximum(-direction[2, live], _GRAZING)
        t[live] += np.minimum(over, fall)
        live = live[t[live] < limit[live]]
        if len(live) == 0:
            break
    rays = np.flatnonzero(np.isfinite(below) & (above > 0))
    reached[rays] = _between(ground, origin[:, rays], direction[:, rays], before[rays], above[rays], below[rays], under[rays])
    return reached


def _between(ground, origin, direction, low, above, high, under):
    """The rule of false position (Illinois), which halves the height of the end that stays."""
    t = low + (high - low) * above / (above - under)
    live = np.arange(len(t))
    for step in range(24):
        x, y, z = origin[:, live] + t[live] * direction[:, live]
        gap = z - ground.height(x, y)
        over = gap > 0
        up, down = live[over], live[~over]
        low[up], high[down] = t[up], t[down]
        above[up], under[down] = gap[over], gap[~over]
        under[up] *= 0.5
        above[down] *= 0.5
        open_still = np.abs(gap) > _CLOSE
        live = live[open_still]
        if len(live) == 0:
            break
        middle = (low[live] + high[live]) / 2
        t[live] = np.where(step % 6 == 5, middle, low[live] + (high[live] - low[live]) * above[live] / (above[live] - under[live]))
    return t
