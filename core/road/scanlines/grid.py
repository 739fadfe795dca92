"""Heights of normalized scanlines on a grid of section planes and cells across the road."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from ..weights import SCANLINE

LINE_SEPARATION = 1e3   # derived: m between the offsets of consecutive lines in one sorted array, beyond any offset


@dataclass
class HeightGrid:
    """Heights of scanlines at the middles of cells: R section planes, C cells.

    Row r is the plane at station (first + r) * interval. Heights are above the expected road.
    """

    first: int   # number of the first plane
    interval: float   # m between planes
    origin: float   # m, offset at which the first cell begins
    low: np.ndarray   # (R, C) float32 m, height of the lowest line; NaN where there is none

    @property
    def shape(self) -> tuple[int, int]:
        """(R, C)."""
        rows, cells = self.low.shape
        return rows, cells

    def part(self, first: int, last: int) -> HeightGrid:
        """The rows from index `first` to before `last`."""
        return HeightGrid(self.first + first, self.interval, self.origin, self.low[first:last])

    def offset(self, cell: np.ndarray | int) -> np.ndarray:
        """Offsets of the middles of cells, m."""
        return self.origin + (np.asarray(cell) + 0.5) * SCANLINE.scanline_resolution

    def outward(self, sign: int, origin: float) -> HeightGrid:
        """The grid of one side, with cells counted outward.

        sign : 1 for the left side, -1 for the right
        origin : m, outward offset at which it begins, a whole number of cells from the reference line
        """
        low = self.low[:, ::sign]
        skipped = int(round((origin - self.origin) / SCANLINE.scanline_resolution))
        if skipped < 0:
            low = np.concatenate([np.full((len(low), -skipped), np.nan, np.float32), low], axis=1)
        return HeightGrid(self.first, self.interval, origin, np.ascontiguousarray(low[:, max(skipped, 0):]))

    def closed(self, reach: int) -> HeightGrid:
        """The grid with empty cells filled from the nearest of the neighbouring rows.

        Lost pulses and shadows leave different gaps on neighbouring scanlines.

        reach : rows on either side from which a gap is filled
        """
        closed = self.low.copy()
        for ahead in range(1, min(reach, len(closed) - 1) + 1):
            for shifted, empty in ((self.low[ahead:], closed[:-ahead]), (self.low[:-ahead], closed[ahead:])):
                np.copyto(empty, shifted, where=np.isnan(empty))
        return HeightGrid(self.first, self.interval, self.origin, closed)


def height_grid(lines: Scanlines, heights: np.ndarray, rows: tuple[int, int], interval: float, reach: float,
                clipping_height: float) -> HeightGrid:
    """Heights of scanlines across the whole road.

    lines : Scanlines of one pass and scanner, V vertices
    heights : (V,) m above the expected road
    rows : (first, last + 1) numbers of the section planes
    interval : m between planes
    reach : m either side of the reference line
    clipping_height : m above the expected road, up to which points are ground

    Returns HeightGrid with origin -reach, or up to a cell less
    """
    half = int(np.ceil(reach / SCANLINE.scanline_resolution))
    low = np.full((rows[1] - rows[0], 2 * half), np.nan, np.float32)
    grid = HeightGrid(rows[0], interval, -half * SCANLINE.scanline_resolution, low)
    row = row_of_lines(lines, rows, interval)
    if len(heights) < 2:
        return grid
    column = lines.d * (1.0 / SCANLINE.scanline_resolution)
    column += half - 0.5
    floor = np.floor(column)
    np.minimum(np.maximum(floor, -1.0, out=floor), 2.0 * half - 1.0, out=floor)
    cell = floor.astype(np.int32)
    number = np.diff(cell)
    number[lines.first[1:-1] - 1] = 0
    number[np.minimum(heights[1:], heights[:-1]) > clipping_height] = 0
    counts = np.diff(lines.first)
    number *= np.repeat((row >= 0) & (row < len(low)), counts)[:-1]
    segment = np.flatnonzero(number)
    number = number.take(segment)
    slope = np.diff(heights).take(segment)
    slope /= np.diff(column).take(segment)
    end = np.cumsum(number)
    begin = np.repeat(row * (2 * half), counts).take(segment)   # index in the grid at which the row begins
    # of the first height of a segment, less the index of that height
    ahead = begin + cell.take(segment)
    ahead += 1 + number
    ahead -= end
    base = column.take(segment)
    base += begin
    base *= slope
    np.subtract(heights.take(segment), base, out=base)
    owner = np.repeat(np.arange(len(segment)), number)
    index = ahead.take(owner) + np.arange(len(owner))
    height = slope.take(owner)
    height *= index
    height += base.take(owner)
    flat = low.reshape(-1)
    _lower_to(flat, index, height.astype(np.float32))
    flat[(flat > clipping_height) | (flat <= -SCANLINE.max_ground_depth)] = np.nan
    return grid


def _lower_to(flat, place, height):
    """Put heights into cells, the lowest of several into one; NaN where there is none yet."""
    height = np.fmin(height, flat.take(place))
    flat[place] = height
    if (np.diff(place) <= 0).any():
        while len(lower := np.flatnonzero(height < flat[place])):
            place, height = place[lower], height[lower]
            flat[place] = height


def row_of_lines(lines: Scanlines, rows: tuple[int, int], interval: float) -> np.ndarray:
    """Rows of scanlines on a grid of section planes.

    lines : L Scanlines
    rows : (first, last + 1) numbers of the section planes of the grid
    interval : m between planes

    Returns (L,) int, negative or too large outside the grid
    """
    return np.rint(lines.station / interval).astype(np.int64) - rows[0]


# Normalized scanlines: sections of the measured surface by planes across the road, as polylines in the road frame.

@dataclass
class Scanlines:
    """Polylines of one road: L lines with V vertices in all.

    Every line lies in the section plane at its station, perpendicular to the reference line of the road. A line is
    connected: where the surface is interrupted, a new line begins. Lines are sorted by station, pass, scanner and offset.

    station : (L,) float64 m along the road
    pass_number, scanner : (L,) int; a line holds points of one pass and one scanner
    first : (L + 1,) int; vertices first[i]:first[i + 1] belong to line i
    d : (V,) float64 m, offset, left positive, increasing within a line
    z : (V,) float64 m, local height (of the road frame)
    intensity : (V,) float32, raw counts
    """

    station: np.ndarray
    pass_number: np.ndarray
    scanner: np.ndarray
    first: np.ndarray
    d: np.ndarray
    z: np.ndarray
    intensity: np.ndarray

    def __len__(self) -> int:
        return len(self.station)

    @classmethod
    def none(cls) -> Scanlines:
        """No lines."""
        return cls(np.empty(0), np.empty(0, int), np.empty(0, int), np.zeros(1, int), np.empty(0), np.empty(0),
                   np.empty(0, np.float32))

    @classmethod
    def join(cls, parts: Sequence[Scanlines]) -> Scanlines:
        """The lines of several Scanlines of one road, in the order given."""
        parts = [part for part in parts if len(part)]
        if not parts:
            return cls.none()
        values = {f.name: np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(cls) if f.name != "first"}
        counts = np.concatenate([np.diff(part.first) for part in parts])
        return cls(first=np.r_[0, np.cumsum(counts)], **values)

    def runs(self) -> list[Scanlines]:
        """The lines of each pass and scanner."""
        keys = np.c_[self.pass_number, self.scanner]
        values = np.unique(keys, axis=0)
        return [self] if len(values) == 1 else [self[(keys == key).all(1)] for key in values]

    def line_of_vertex(self) -> np.ndarray:
        """(V,) int, number of the line of each vertex."""
        return np.repeat(np.arange(len(self)), np.diff(self.first))

    def __getitem__(self, which: np.ndarray | slice) -> Scanlines:
        """The lines selected by a mask, by numbers or by a slice, in the order given."""
        numbers = np.arange(len(self))[which]
        counts = np.diff(self.first)[numbers]
        first = np.r_[0, np.cumsum(counts)]
        vertices = np.repeat(self.first[numbers] - first[:-1], counts) + np.arange(first[-1])
        return Scanlines(self.station[numbers], self.pass_number[numbers], self.scanner[numbers], first,
                         self.d[vertices], self.z[vertices], self.intensity[vertices])
