"""The heights of an OpenDRIVE road: an elevation along it, and across it a superelevation or the shape of the cross-section."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..sources import LEAST_CURB
from .geometry import Cubics
from .model import MapRoad
from .profiles import fit_cubics, risen, simplified
from .road_shape import RoadShape
from .surface import shape_height

FLAT = 0.001             # m of height that a cross-section may miss without a crossfall of its own
ROLLED = 0.001           # m by which a superelevation may move a border in plan: readers differ on whether it does
SAME_PLACE_ALONG = 0.05  # m along the road within which two cross-sections are one
SAME_T = 0.01            # m across within which two places of a cross-section are one
SHAPE_ROUNDS = 3
CLOSER = (0.5, 0.25, 0.1, 0.0)   # shares of the tolerance within which cross-sections are left out, until all places are met


class _Profile(NamedTuple):
    """A cross-section. s : metres; t : (n,) metres to the left, rising; z : (n,) metres, heights there."""

    s: float
    t: np.ndarray
    z: np.ndarray


def add_heights(road: MapRoad, shape: RoadShape, tolerance: float) -> None:
    """Give a road its elevation, and a superelevation where the cross-section is a plane, else its shape.

    A superelevation is taken only where its roll moves no border by more than a millimetre: readers differ on whether it does. The shape has
    as many cross-sections as it takes to meet the heights of all vertices.

    Parameters
    ----------
    road : MapRoad, whose elevation, superelevation and shape are set
    shape : RoadShape of the same road
    tolerance : metres by which a height may be missed
    """
    level = np.concatenate([z.ravel() for z in shape.z])
    if np.ptp(level) == 0:
        road.elevation = Cubics.constant(float(level[0]))
        return
    profiles = _profiles(shape, np.zeros(0))
    s = np.array([profile.s for profile in profiles])
    middle = _at_reference(profiles, s)
    road.elevation = simplified(fit_cubics([s], [middle], 0.0, road.length, tolerance / 2)[0])
    if max(float(np.abs(profile.z - level).max()) for profile, level in zip(profiles, middle)) < FLAT:
        return
    if _superelevation(road, profiles, middle, tolerance):
        return
    targets, missed = _targets(road, shape), np.zeros(0)
    for _ in range(SHAPE_ROUNDS):   # cross-sections are where the lanes have vertices; where that is not enough, also where one border has some
        profiles = _profiles(shape, targets[missed > tolerance, 0] if len(missed) else missed)
        levels = road.elevation.at(np.array([profile.s for profile in profiles]))
        profiles = [profile._replace(z=profile.z - level) for profile, level in zip(profiles, levels)]
        for share in CLOSER:
            road.shape = _rows(profiles, _telling(profiles, share * tolerance))
            missed = np.abs(shape_height(road.shape, targets[:, 0], targets[:, 1]) - targets[:, 2])
            if missed.max(initial=0.0) <= tolerance:
                return


def heights_above_road(shape: RoadShape, number: int, cell: int) -> np.ndarray:
    """(N, 3) metres from the start of a slice's section, heights of the inner and outer border of one of its lanes above the road."""
    lift, s = shape.lifts[number][cell], shape.s[number][cell:cell + 2].mean(0) - shape.starts[number]
    rows = [(0.0, lift[0])]
    for at, value in zip(s, lift):
        if abs(value - rows[-1][1]) > LEAST_CURB:
            rows.append((max(float(at), 0.0), value))
    return np.array([(at, value, value) for at, value in rows]) if lift.any() else np.empty((0, 3))


def _at_reference(profiles, s):
    """(N,) heights at the reference line; where lanes lie on one side of it alone, those before and after it: the shape has the rest."""
    height = np.array([_height(profile, np.zeros(1))[0] for profile in profiles])
    there = np.array([profile.t[0] - SAME_T <= 0.0 <= profile.t[-1] + SAME_T for profile in profiles])
    if not there.any():
        return np.array([profile.z[np.argmin(np.abs(profile.t))] for profile in profiles])
    return np.where(there, height, np.interp(s, s[there], height[there]))


def _profiles(shape, more):
    """A cross-section wherever the lanes have vertices, at both ends of every slice, and at (N,) more s, in order; of two at one place one."""
    found = []
    for number, (first, last) in enumerate(zip(shape.starts[:-1], shape.starts[1:])):
        places = np.sort(np.append(shape.s[number].mean(0), more))
        places = places[risen(places)]
        places = places[(places > first + SAME_PLACE_ALONG) & (places < last - SAME_PLACE_ALONG)]
        places = np.concatenate([[first], places, [last]])
        t, z = (np.stack([np.interp(places, course[0], course[row]) for course in shape.courses[number]]) for row in (1, 2))
        order = np.argsort(t, axis=0, kind="stable")
        t, z = np.take_along_axis(t, order, 0), np.take_along_axis(z, order, 0)
        made = [_Profile(float(s), t[:, k], z[:, k]) for k, s in enumerate(places)]
        if found:
            made[0] = _joined(found.pop(), made[0])
        found += made
    return [_apart(profile) for profile in found]


def _joined(one, other):
    """The cross-section where two slices meet."""
    t, z = np.concatenate([one.t, other.t]), np.concatenate([one.z, other.z])
    order = np.argsort(t, kind="stable")
    return _Profile(one.s, t[order], z[order])


def _apart(profile):
    """A cross-section whose places lie apart from each other."""
    keep = np.append(True, np.diff(np.maximum.accumulate(profile.t)) > SAME_T)
    return profile._replace(t=profile.t[keep], z=profile.z[keep])


def _superelevation(road, profiles, middle, tolerance):
    """Roll the road where every cross-section is a plane; whether it could be."""
    slopes = np.array([float((profile.t @ (profile.z - level)) / max(profile.t @ profile.t, 1e-9)) for profile, level in zip(profiles, middle)])
    missed = max(float(np.abs(profile.z - level - profile.t * slope).max()) for profile, level, slope in zip(profiles, middle, slopes))
    widest = max(float(np.abs(profile.t).max()) for profile in profiles)
    if missed > tolerance / 4 or widest * (1 - np.cos(np.arctan(np.abs(slopes).max()))) > ROLLED:
        return False
    s = np.array([profile.s for profile in profiles])
    road.superelevation = simplified(fit_cubics([s], [np.arctan(slopes)], 0.0, road.length, tolerance / 4 / max(widest, 1.0))[0])
    return True


def _targets(road, shape):
    """(N, 3) s, t and height above the elevation of all vertices along the road."""
    s, t, z = (np.concatenate([values.ravel() for values in of]) for of in (shape.s, shape.t, shape.z))
    inside = (s >= 0.0) & (s <= road.length)
    return np.c_[s, t, z - road.elevation.at(s)][inside]


def _rows(profiles, kept):
    """(N, 6) s, t, a, b, c, d of the cross-sections of these numbers: straight from place to place, and beyond them."""
    rows = []
    for k in kept:
        s, t, z = profiles[k]
        rows += [[s, a, b, c, 0.0, 0.0] for a, b, c in zip(t, z, _slopes(t, z))]
    return np.array(rows)


def _slopes(t, z):
    """(n,) of the straight piece that begins at each place; the last one's goes on."""
    slope = np.diff(z) / np.diff(t) if len(t) > 1 else np.zeros(1)
    return np.append(slope, slope[-1])[:len(t)]


def _telling(profiles, tolerance):
    """Numbers of the cross-sections between which all others are interpolated within a tolerance."""
    kept, last = [0], len(profiles) - 1
    while kept[-1] < last:
        first, step = kept[-1], 1
        while first + 2 * step <= last and _between(profiles, first, first + 2 * step, tolerance):
            step *= 2
        good, bad = first + step, min(first + 2 * step, last + 1)
        while bad - good > 1:
            tried = (good + bad) // 2
            good, bad = (tried, bad) if _between(profiles, first, tried, tolerance) else (good, tried)
        kept.append(good)
    return kept


def _between(profiles, first, last, tolerance):
    """Whether the cross-sections between two are what the format interpolates there: along the road at equal offsets."""
    a, b = profiles[first], profiles[last]
    middle = profiles[first + 1:last]
    count = [len(profile.t) for profile in middle]
    t, z = (np.concatenate([profile[row] for profile in middle]) for row in (1, 2))
    share = np.repeat([(profile.s - a.s) / max(b.s - a.s, 1e-9) for profile in middle], count)
    return bool(np.abs((1 - share) * _height(a, t) + share * _height(b, t) - z).max() <= tolerance)


def _height(profile, t):
    """(N,) heights of a cross-section at (N,) offsets."""
    _, x, z = profile
    slope = _slopes(x, z)
    return np.interp(t, x, z) + slope[0] * np.minimum(t - x[0], 0.0) + slope[-1] * np.maximum(t - x[-1], 0.0)
