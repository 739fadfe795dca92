"""Lines of a map in the road frame: the one conversion from map coordinates to station and offset that lines go through."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from .placement import located

if TYPE_CHECKING:
    from .road_frame import RoadFrame

LINE_VERTEX_SPACING = 0.5  # m between vertices at most: straight on the map is not straight in the road frame


@dataclass(frozen=True)
class FrameLines:
    """L lines, stored vertex by vertex.

    road : (L,) int, number of the road; -1 where a line lies on none
    start : (L + 1,) int, first vertex of each line, and V
    x, y, z : (V,) local metres (map coordinates less the origin of the frame); z is NaN where there is none
    s, d : (V,) metres, station and offset; NaN where a vertex has no foot on its road
    """

    road: np.ndarray
    start: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    s: np.ndarray
    d: np.ndarray

    def __len__(self) -> int:
        return len(self.road)

    def line(self, k: int) -> slice:
        """The vertices of line k."""
        return slice(int(self.start[k]), int(self.start[k + 1]))

    def __getitem__(self, rows: np.ndarray) -> FrameLines:
        """Some of the lines, by a mask or their numbers."""
        count, first = np.diff(self.start)[rows], self.start[:-1][rows]
        start = np.append(0, np.cumsum(count))
        at = np.repeat(first - start[:-1], count) + np.arange(start[-1])
        return FrameLines(self.road[rows], start, *(values[at] for values in (self.x, self.y, self.z, self.s, self.d)))

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
        found = np.full(len(self), None, object)
        return shapely.linestrings(np.c_[self.x, self.y], indices=self.owner, out=found) if len(self.x) else found

    @staticmethod
    def at(frame: RoadFrame, road: np.ndarray, start: np.ndarray, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> FrameLines:
        """Lines through given vertices; station and offset are found for them."""
        return FrameLines(road, start, x, y, z, *located(frame, np.repeat(road, np.diff(start)), x, y))


def lines_in_frame(lines: Sequence[Any] | np.ndarray, road: Sequence[int] | np.ndarray, frame: RoadFrame,
                   spacing: float | None = LINE_VERTEX_SPACING) -> FrameLines:
    """Lines in map coordinates as FrameLines.

    Parameters
    ----------
    lines : L shapely LineStrings in map coordinates
    road : (L,) int, number of the road of each; where the frame has no such road, the one that most vertices are nearest to
    frame : RoadFrame
    spacing : m between vertices at most; None for the vertices of the lines as they are

    Returns
    -------
    FrameLines
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
    """The LineStrings of lines and multi-lines that are not empty, and the row that each comes from."""
    parts = [(part, row) for row, geometry in enumerate(geometries) if geometry is not None and not geometry.is_empty
             for part in getattr(geometry, "geoms", [geometry])]
    return [part for part, _ in parts], [row for _, row in parts]
