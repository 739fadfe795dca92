"""Point density in cubes of 1 m, counted section by section."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Optional

import numpy as np

from .store.records import Points

CUBE_SIDE = 10_000       # derived: units of 0.1 mm: 1 m

CountedCubes = Optional[tuple[np.ndarray, np.ndarray]]   # keys of the occupied cubes, and how many points they hold; None without points


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
    cubes = [points.records[name] // np.int32(CUBE_SIDE) for name in "zyx"]
    low = [int(cube.min()) for cube in cubes]
    shape = [int(cube.max()) - least + 1 for cube, least in zip(cubes, low)]
    place = np.zeros(1, np.int32)
    for cube, least, size in zip(cubes, low, shape):
        place = place * size + (cube - least)
    count = np.bincount(place)
    held = np.flatnonzero(count)
    z, y, x = (cube + least for cube, least in zip(np.unravel_index(held, shape), low))
    half = 2**22   # 4,000 km either side, and 32 km up or down
    return ((z + 2**15) << 46) | ((y + half) << 23) | (x + half), count[held]
