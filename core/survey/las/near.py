"""Points about a place. What lies where in a file is noted when it is read first, so that later places take only the ranges that lie there."""

from __future__ import annotations

import os
import threading
from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from ...common.parallel import ordered_map
from ...common.progress import Progress
from ..weights import LAS
from .parallel_reader import ParallelCloudReader
from .reader import CloudHeader, read_headers

State = tuple[str, int, int]   # path of a file, its bytes, and when it was written: a file with another one is another file


def points_near(paths: Iterable[str | os.PathLike[str]], x: float, y: float, radius: float, progress: Progress = Progress()) -> np.ndarray:
    """The points within a square about a place, (N, 4) x, y, z in map coordinates and intensity, in file order.

    Files whose bounds lie elsewhere are not opened beyond their header. A file is read as a whole for its first place alone; who cancels that and
    asks again goes on from there. Only these points, the blocks being read and those of the last places are held in memory.

    paths : of point clouds
    x, y : map coordinates of the middle
    radius : m, half the side of the square

    Raises RoadExtractionError if a file is missing or cannot be read.
    """
    files = _opened(tuple(map(_state, paths)))
    units = files[0].header.units   # of the map, in which the results of these clouds are
    place = units.in_metres((x, y))
    with ParallelCloudReader(("z", "intensity")) as reader:
        ranges = [(file, number) for file in files for number in file.numbers(reader, place, radius)]
        parts = ordered_map(lambda item: item[0].within(item[1], reader, place, radius), ranges, progress)
        points = np.concatenate([np.empty((0, 4)), *parts])
    if not units.metric:
        points[:, :3] = units.in_file(points[:, :3].T).T
    return points


def _state(path):
    try:
        status = os.stat(path)
    except OSError:   # which `read_headers` tells
        return str(path), -1, -1
    return str(path), status.st_size, status.st_mtime_ns


@lru_cache(maxsize=LAS.remembered_surveys)
def _opened(states):
    last = _LastRead()
    return [_RangesOfFile(header, last) for header in read_headers([path for path, _, _ in states])]


@dataclass(frozen=True)
class _Stored:
    """Points as a file stores them, in less memory than their coordinates take."""

    raw: list[np.ndarray]   # 3 of (N,) int32
    intensity: np.ndarray   # (N,) uint16
    scale: np.ndarray   # scale, offset: (3,) m
    offset: np.ndarray

    @classmethod
    def of(cls, blocks):
        """Of laspy point records."""
        *raw, intensity = (np.concatenate([block.array[name] for block in blocks]) for name in ("X", "Y", "Z", "intensity"))
        return cls(raw, intensity, blocks[0].scales, blocks[0].offsets)

    def __len__(self):
        return len(self.intensity)

    def places(self, rows):
        """(3, M) coordinates of some points, m."""
        return np.stack([numbers[rows] * scale + offset for numbers, scale, offset in zip(self.raw, self.scale, self.offset)])

    def within(self, place, radius):
        """(M, 4) x, y, z, m, and intensity of those in a square."""
        near = np.ones(len(self), bool)
        for numbers, middle, scale, offset in zip(self.raw, place, self.scale, self.offset):
            near &= np.abs(numbers - (middle - offset) / scale) <= radius / abs(scale)
        return np.c_[self.places(near).T, self.intensity[near]]


class _LastRead:
    """The ranges that places lie in that were asked for last, LAS.remembered_points at most: the next place mostly lies in the same ones."""

    def __init__(self):
        self._points, self._lock = OrderedDict(), threading.Lock()

    def get(self, key):
        with self._lock:
            if key in self._points:
                self._points.move_to_end(key)
            return self._points.get(key)

    def keep(self, key, points):
        with self._lock:
            self._points[key] = points
            while sum(map(len, self._points.values())) > LAS.remembered_points:
                self._points.popitem(last=False)


@dataclass
class _RangesOfFile:
    """The ranges of points of a file, and of those that were read the bounds in which points lie."""

    header: CloudHeader
    last: _LastRead
    ranges: list[tuple[int, int]] = field(default_factory=list)   # (first, count)
    bounds: dict[int, tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)   # {number of a range: (2,) m, the lowest, and the highest}

    def within(self, number, reader, place, radius):
        """(N, 4) x, y, z, m, and intensity of those points of a range that lie in a square; none where no point of the range lies near it."""
        if not self.may_hold(number, place, radius):   # another thread has read it meanwhile
            return np.empty((0, 4))
        stored = self.last.get((self.header.path, number))
        if stored is None:
            stored = _Stored.of(list(reader.points(self.header, *self.ranges[number], LAS.points_per_range)))
            places = stored.places(slice(None))[:2]
            self.bounds[number] = places.min(axis=1), places.max(axis=1)
            if self.may_hold(number, place, radius):
                self.last.keep((self.header.path, number), stored)
        return stored.within(place, radius)

    def numbers(self, reader, place, radius):
        """Numbers of the ranges in which points of a square may lie."""
        if not self.may_hold(None, place, radius):
            return []
        if not self.ranges:
            self.ranges = [(first, count) for _, first, count in reader.ranges([self.header], LAS.points_per_range)]
        return [number for number in range(len(self.ranges)) if self.may_hold(number, place, radius)]

    def may_hold(self, number, place, radius):
        """Whether points of a range may lie in a square, by its bounds or, where these are not known, by those of the file."""
        low, high = self.bounds.get(number, (self.header.minimum[:2], self.header.maximum[:2]))
        reach = radius + LAS.bounds_tolerance
        return bool(((low <= place + reach) & (place - reach <= high)).all())
