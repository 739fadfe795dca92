"""Copies of files and of points among the files of a survey: they would count twice."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import shapely

from .reader import CloudHeader, read_blocks

PER_METRE = 1000.0   # places are compared in millimetres: a copy may store them with other scales and offsets


def without_copies(files: list[CloudHeader], warn: Callable[[str], None]) -> list[CloudHeader]:
    """The files without those that hold the same points as an earlier one, such as a COPC beside the LAZ it was made from.

    Only files with the same number of points and the same bounds are read.

    Parameters
    ----------
    files : headers
    warn : is told of every copy

    Returns
    -------
    headers, in the order given

    Raises
    ------
    RoadExtractionError
        If a file that must be read is damaged.
    """
    first: dict[tuple, CloudHeader] = {}
    contents: dict[str, tuple[int, ...]] = {}

    def content(file):
        if file.path not in contents:
            contents[file.path] = _content(file)
        return contents[file.path]

    kept = []
    for file in files:
        alike = (file.count, _whole(file.minimum), _whole(file.maximum))
        other = first.setdefault(alike, file)
        if other is not file and file.count and content(other) == content(file):
            warn(f"{file.path} holds the same points as {other.path} and is left out, so that none counts twice.")
        else:
            kept.append(file)
    return kept


def may_overlap(files: Sequence[CloudHeader]) -> bool:
    """Whether the bounds of any two files have an area in common."""
    boxes = shapely.box(*np.array([(*file.minimum[:2], *file.maximum[:2]) for file in files if file.count], float).reshape(-1, 4).T)
    one, other = shapely.STRtree(boxes).query(boxes, predicate="intersects")
    apart = one < other
    return bool((shapely.area(shapely.intersection(boxes[one[apart]], boxes[other[apart]])) > 0.0).any())


def distinct_rows(time: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Indices of the points that are no copies of earlier ones.

    Parameters
    ----------
    time : (N,) s
    place : (N, 3) in any unit

    Returns
    -------
    (M,) intp, ascending
    """
    order = np.lexsort((*place.T, time))
    same = (time[order[1:]] == time[order[:-1]]) & (place[order[1:]] == place[order[:-1]]).all(axis=1)
    return np.sort(order[np.r_[True, ~same][:len(order)]])


def _whole(places):
    return tuple(np.rint(np.asarray(places, float) * PER_METRE).astype(np.int64).tolist())


def _content(file):
    """Sums over a file's places, intensities and times, whatever the order of its points."""
    names = ["x", "y", "z", "intensity"] + ["gps_time"] * file.has_time
    sums = np.zeros(len(names), np.uint64)
    for block in read_blocks(file.path, layers=names[2:], units=file.units):
        for k, name in enumerate(names):
            values = np.asarray(block[name])
            if name == "gps_time":
                values = np.ascontiguousarray(values, np.float64).view(np.uint64)
            elif name != "intensity":
                values = np.rint(values * PER_METRE).astype(np.int64).view(np.uint64)
            # sums beyond 64 bits start again from 0, in any order the same
            sums[k] += values.sum(dtype=np.uint64)
    return tuple(sums.tolist())
