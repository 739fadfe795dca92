"""Places as a layer holds them: station and offset of map coordinates, coordinates to 0.1 mm, and what is unknown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from ...common.features import PASSES, Features
from ..weights import FRAME
from .road_frame import RoadFrame, decimate_by_distance

COORDINATE_DECIMALS = 4  # derived: of coordinates in layers: 0.1 mm


def located(frame: RoadFrame, road: np.ndarray, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stations and offsets of local places on given roads, (V,) metres; NaN where a place has no foot on its road, see `Road.locate`.

    The places are taken as their map coordinates hold them. A layer that was written and read again therefore gives the same stations and offsets,
    and the stages give the same results in one call and one by one.

    road : (V,) int, number of the road of each place; numbers that the frame does not have are allowed
    x, y : (V,) local metres
    """
    s, d = np.full((2, len(x)), np.nan)
    x, y = frame.to_local(x + frame.origin[0], y + frame.origin[1])
    for number in np.unique(road[(road >= 0) & (road < len(frame.roads))]).tolist():
        rows = np.flatnonzero(road == number)
        s[rows], d[rows] = frame.roads[number].locate(x[rows], y[rows])
    return s, d


def as_written(frame: RoadFrame, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, ...]:
    """Local x, y and z, (V,) metres each, of map coordinates that are rounded as in a layer.

    What is computed from them is therefore the same whether a stage got its input in memory or from a file.
    """
    return frame.to_local(*(np.round(values, COORDINATE_DECIMALS) for values in (x, y, z)))


# Lines of a map in the road frame: the one conversion from map coordinates to station and offset that lines go through.

LINE_VERTEX_SPACING = 0.5  # cost: m between vertices at most: straight on the map is not straight in the road frame


@dataclass(frozen=True)
class FrameLines:
    """L lines, stored vertex by vertex."""

    road: np.ndarray   # (L,) int, number of the road; -1 where a line lies on none
    start: np.ndarray   # (L + 1,) int, first vertex of each line, and V
    x: np.ndarray   # x, y, z: (V,) local metres (map coordinates less the origin of the frame); z is NaN where there is none
    y: np.ndarray
    z: np.ndarray
    s: np.ndarray   # s, d: (V,) metres, station and offset; NaN where a vertex has no foot on its road
    d: np.ndarray

    def __len__(self) -> int:
        return len(self.road)

    def line(self, k: int) -> slice:
        return slice(int(self.start[k]), int(self.start[k + 1]))

    def __getitem__(self, rows: np.ndarray) -> FrameLines:
        """Some of the lines, by a mask or their numbers."""
        count, first = np.diff(self.start)[rows], self.start[:-1][rows]
        start = np.append(0, np.cumsum(count))
        vertices = np.repeat(first - start[:-1], count) + np.arange(start[-1])
        return FrameLines(self.road[rows], start, *(values[vertices] for values in (self.x, self.y, self.z, self.s, self.d)))

    def and_lines(self, more: FrameLines) -> FrameLines:
        """These lines and others behind them."""
        start = np.append(self.start, self.start[-1] + more.start[1:])
        return FrameLines(np.append(self.road, more.road), start,
                          *(np.append(getattr(self, name), getattr(more, name)) for name in ("x", "y", "z", "s", "d")))

    @property
    def owner(self) -> np.ndarray:
        """(V,) int, the line of each vertex."""
        return np.repeat(np.arange(len(self)), np.diff(self.start))

    def linestrings(self) -> np.ndarray:
        """(L,) shapely lines in local x, y."""
        lines = np.full(len(self), None, object)
        return shapely.linestrings(np.c_[self.x, self.y], indices=self.owner, out=lines) if len(self.x) else lines

    @staticmethod
    def at(frame: RoadFrame, road: np.ndarray, start: np.ndarray, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> FrameLines:
        """Lines through given vertices; station and offset are found for them."""
        return FrameLines(road, start, x, y, z, *located(frame, np.repeat(road, np.diff(start)), x, y))


def lines_in_frame(lines: Sequence[Any] | np.ndarray, road: Sequence[int] | np.ndarray, frame: RoadFrame,
                   spacing: float | None = LINE_VERTEX_SPACING) -> FrameLines:
    """Shapely lines in map coordinates as FrameLines.

    road : (L,) int, number of the road of each; where the frame has no such road, the one that most vertices are nearest to
    spacing : m between vertices at most; None for the vertices of the lines as they are
    """
    shapes = np.asarray(lines, object) if len(lines) else np.empty(0, object)
    if spacing is not None and len(shapes):
        shapes = shapely.segmentize(shapes, spacing)
    places, owner = shapely.get_coordinates(shapes, include_z=True, return_index=True)
    start = np.append(0, np.cumsum(np.bincount(owner, minlength=len(lines))))
    x, y = frame.to_local(places[:, 0], places[:, 1])
    roads = np.array([int(number) if 0 <= number < len(frame.roads) else _nearest_road(frame, x[a:b], y[a:b])
                      for number, a, b in zip(road, start[:-1], start[1:])], int)
    return FrameLines.at(frame, roads, start, x, y, places[:, 2] - frame.origin[2])


def _nearest_road(frame: RoadFrame, x: np.ndarray, y: np.ndarray) -> int:
    """The road that most places are nearest to, -1 where there is none."""
    numbers, _, _ = frame.locate_nearest(x, y)
    numbers = numbers[numbers >= 0]
    return int(np.bincount(numbers).argmax()) if len(numbers) else -1


def line_parts(geometries: Sequence[Any]) -> tuple[list[Any], list[int]]:
    """The LineStrings of lines and multi-lines that have a length, and the row that each comes from."""
    parts = [(part, row) for row, geometry in enumerate(geometries) if geometry is not None
             for part in getattr(geometry, "geoms", [geometry]) if part.length > 0]
    return [part for part, _ in parts], [row for _, row in parts]


def passes_to_features(frame: RoadFrame, crs: str) -> Features:
    """The layer PASSES in map coordinates: where the vehicle drove, as the run used it.

    One row a pass in order of time, drawn as it was driven with a vertex every half metre.
    """
    layer = Features("LineStringZ", list(PASSES), crs=crs)
    for p in frame.passes:
        rows = decimate_by_distance(p.x, p.y, FRAME.standstill_radius)
        if len(rows) < 2:
            continue
        line = shapely.linestrings(np.round(np.c_[p.x, p.y, p.z][rows] + frame.origin, COORDINATE_DECIMALS))
        layer.add(line, **{"pass": p.number}, road=p.road, direction=p.direction, station_m=p.s.min(), end_m=p.s.max(),
                  length_m=line.length, **(dict(begin_s=p.time[0], finish_s=p.time[-1]) if frame.has_time else {}))
    return layer


# Places by squares of the ground: those about a place are looked up there, not among all places of a whole road.

class PlaceIndex:
    """(N, 2) places in metres by squares of a side in metres, whose numbers are ROW times the row, and the column."""

    ROW = 1 << 32

    def __init__(self, places: np.ndarray, side: float):
        self.places, self.side = places, side
        key = self._square(places) @ [self.ROW, 1]
        self._order = np.argsort(key, kind="stable").astype(np.int32)
        self._key = key[self._order]

    def __getstate__(self) -> dict:
        return dict(places=self.places, side=self.side)

    def _square(self, places):
        """Row and column of the squares of places."""
        return np.floor(np.asarray(places, float) / self.side).astype(np.int64)

    def _rows(self, first, last):
        """Where the places in the squares from number `first` to `last`, (K,) each, begin and end in the order."""
        return np.searchsorted(self._key, first), np.searchsorted(self._key, last, side="right")

    def windows(self, fewest: int) -> list[np.ndarray]:
        """Rows of the places of every window of 2 by 2 squares, which overlap by half, that has so many places at least."""
        held, row = np.unique(self._key), self.ROW
        corner = np.unique(np.concatenate([held + step for step in (0, 1, row, row + 1)]))   # the last square of each window
        (a, b), (c, d) = (self._rows(corner - step - 1, corner - step) for step in (row, 0))
        filled = b - a + d - c >= fewest
        return [np.concatenate([self._order[first:second], self._order[third:fourth]])
                for first, second, third, fourth in zip(*(ends[filled].tolist() for ends in (a, b, c, d)))]

    def within(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Ascending rows of the places in a box with the corners `low` and `high`, (2,) m each."""
        ((first, left), (last, right)), row = self._square([low, high]).tolist(), self.ROW
        numbers = row * np.unique((self._key[slice(*self._rows(row * first - row // 2, row * last + row // 2))] + row // 2) // row)
        rows = np.concatenate([np.empty(0, np.int32), *(self._order[a:b] for a, b in zip(*self._rows(numbers + left, numbers + right)))])
        places = self.places[rows]
        return np.sort(rows[np.logical_and(*((places >= low) & (places <= high)).T)])
