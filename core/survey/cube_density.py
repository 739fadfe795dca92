"""Points per cubic metre, counted section by section."""

from dataclasses import dataclass

import numpy as np

from ..parallel import in_order
from ..progress import Progress

CUBE = 1.0  # m


@dataclass(frozen=True)
class CubeDensity:
    """Points per m³ in cubes of 1 m.

    mean : over occupied cubes; of_a_point : mean over points of the number in their own cube, what a point sees
    """

    points: int
    mean: float
    of_a_point: float


def cube_density(sections, points_of=lambda section: section, progress=Progress()):
    """CubeDensity of points, counted side by side.

    A cube that two sections share counts once: the cubes are those of the map, and only their numbers are kept.

    Parameters
    ----------
    sections : one for each section of road
    points_of : function of one of them that returns its points, an object with x, y, z (local metres)
    """
    keys, counts = [], []
    for found in in_order(lambda section: _counted(points_of(section)), sections, progress):
        if found is not None:
            keys.append(found[0])
            counts.append(found[1])
    if not keys:
        return CubeDensity(0, float("nan"), float("nan"))
    _, place = np.unique(np.concatenate(keys), return_inverse=True)
    number = np.bincount(place.ravel(), np.concatenate(counts)) / CUBE**3
    total = int(number.sum() * CUBE**3)
    return CubeDensity(total, float(number.mean()), float((number**2).sum() / number.sum()))


def _counted(points):
    """Keys of the occupied cubes and how many points each holds; None without points."""
    if not len(points):
        return None
    cell = [np.floor(axis / CUBE).astype(np.int32) for axis in (points.x, points.y, points.z)]
    low = [int(axis.min()) for axis in cell]
    size = [int(axis.max()) - first + 1 for axis, first in zip(cell, low)]
    flat = ((cell[2] - low[2]) * size[1] + (cell[1] - low[1])) * size[0] + (cell[0] - low[0])
    count = np.bincount(flat)
    held = np.flatnonzero(count)
    x, y, z = held % size[0] + low[0], held // size[0] % size[1] + low[1], held // (size[0] * size[1]) + low[2]
    half = 2**20
    return ((z + half) << 42) | ((y + half) << 21) | (x + half), count[held]
