"""Points about a place, for a look at it."""

from __future__ import annotations

import os
from collections.abc import Iterable

import numpy as np

from ...common.progress import Progress
from .reader import read_blocks, read_headers


def points_near(paths: Iterable[str | os.PathLike[str]], x: float, y: float, radius: float, progress: Progress = Progress()) -> np.ndarray:
    """The points within a square about a place.

    Parameters
    ----------
    paths : of point clouds; those whose bounds lie elsewhere are not opened beyond their header
    x, y : map coordinates of the middle
    radius : m, half the side of the square
    progress : Progress

    Returns
    -------
    (N, 4) x, y, z in map coordinates and intensity, in file order. Only these are held in memory, and the block being read.

    Raises
    ------
    RoadExtractionError
        If a file is missing or cannot be read.
    """
    files = read_headers(paths, progress.warn)
    units = files[0].units   # of the map, in which the results of these clouds are
    x, y = units.in_metres((x, y))
    files = [file for file in files if file.count and file.minimum[0] <= x + radius and file.maximum[0] >= x - radius
             and file.minimum[1] <= y + radius and file.maximum[1] >= y - radius]
    total, read = sum(file.count for file in files), 0
    found = [np.empty((0, 4))]
    for file in files:
        for block in read_blocks(file.path, layers=("z", "intensity"), units=file.units):
            read += len(block)
            progress.report(read / total)
            near = np.flatnonzero((np.abs(np.asarray(block.x) - x) <= radius) & (np.abs(np.asarray(block.y) - y) <= radius))
            if len(near):
                places = np.c_[np.asarray(block.x)[near], np.asarray(block.y)[near], np.asarray(block.z)[near]]
                found.append(np.c_[places if units.metric else units.in_file(places), np.asarray(block.intensity)[near]])
    return np.concatenate(found)
