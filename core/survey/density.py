"""Point density in cubes of 1 m, counted section by section."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from .store.records import Points

CUBE_SIDE = 10_000       # derived: units of 0.1 mm: 1 m
POINTS_PER_CHUNK = 1 << 15   # cost: points counted at a time: fits the processor cache

CountedCubes = tuple[np.ndarray, np.ndarray] | None   # keys of the occupied cubes, and how many points they hold; None without points


@dataclass(frozen=True)
class CubeDensity:
    """Point density in cubes of 1 m."""

    points: int   # number of points
    mean: float   # points per m³, mean over occupied cubes
    of_a_point: float   # points per m³, mean over points of the density of their own cube


def cube_density(parts: Iterable[CountedCubes]) -> CubeDensity:
    """Density of points that were counted section by section; a cube shared by two sections counts once."""
    counted = [part for part in parts if part is not None]
    if not counted:
        return CubeDensity(0, float("nan"), float("nan"))
    keys, counts = zip(*counted)
    _, cube = np.unique(np.concatenate(keys), return_inverse=True)
    number = np.bincount(cube.ravel(), np.concatenate(counts))
    total = int(number.sum())
    return CubeDensity(total, float(number.mean()), float((number**2).sum() / number.sum()))


def counted_cubes(points: Points) -> CountedCubes:
    """Points in cubes aligned with the local coordinates."""
    if not len(points):
        return None
    low, size = [], []
    for axis in (points.records[name] for name in "xyz"):
        low.append(int(axis.min()) // CUBE_SIDE)
        size.append(int(axis.max()) // CUBE_SIDE - low[-1] + 1)
    counts = np.zeros(size[0] * size[1] * size[2], np.int64)
    for first in range(0, len(points), POINTS_PER_CHUNK):
        x, y, z = (points.records[name][first:first + POINTS_PER_CHUNK] // np.int32(CUBE_SIDE) - np.int32(least) for name, least in zip("xyz", low))
        z *= np.int32(size[1])
        z += y
        z *= np.int32(size[0])
        z += x
        chunk = np.bincount(z)
        counts[:len(chunk)] += chunk
    return _occupied(counts, low, size)


def _occupied(count, low, size):
    """Keys of the cubes that hold points, and how many these are."""
    held = np.flatnonzero(count)
    x, y, z = held % size[0] + low[0], held // size[0] % size[1] + low[1], held // (size[0] * size[1]) + low[2]
    half = 2**22   # 4,000 km either side, and 32 km up or down
    return ((z + 2**15) << 46) | ((y + half) << 23) | (x + half), count[held]
