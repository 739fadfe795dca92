"""The mesh between neighbouring scan lines of one scanner, within a window of the road, and the lines of its sections.

A scan line holds the points of one turn of the mirror. Every point of a line forms a triangle with the two points of the
next line between which it lies by the phase of the mirror. Section planes are intersected with the ribs of these
triangles: the side from the point to the place of the same phase on the next line. The intersections in one plane
are then connected to polylines in the order of the phase. The mesh exists for one window at a time.

Source: the paper on normalized scanlines (ISPRS Archives, 2020), section 2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common.arrays import Rows
from ...survey.frame.road_frame import Pass
from ...survey.lattice.scan_lattice import MirrorPhase, time_order
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE
from ..weights import SCANLINE

LINE_OFFSET_UNITS = 2 * 10**10   # derived: 2 km between the offsets of consecutive lines in one sorted array
PHASE_STEPS = 65535   # derived: steps of a turn by which vertices are sorted, 16 bits


@dataclass
class ScannerLines:
    """N points of one pass and scanner in a window, sorted by time, on L scan lines."""

    line: np.ndarray   # (N,) int32, number of the scan line, from 0 without gaps
    phase: np.ndarray   # (N,) turns, phase of the mirror, 0 to 1
    s: np.ndarray   # s, d, z: (N,) m, station, offset and local height
    d: np.ndarray
    z: np.ndarray
    intensity: np.ndarray | None   # (N,) raw counts, or None where they were not asked for
    ranges: np.ndarray   # (N,) float32 m from the vehicle
    joined: np.ndarray   # (N,) bool, whether a point and the next one are neighbours on a surface
    driven: np.ndarray   # (L,) m of road driven during the turn

    def __len__(self) -> int:
        return len(self.line)


@dataclass
class Ribs(Rows):
    """R sides of the mesh that section planes intersect.

    A rib runs from the point `point` to a place between the point `ahead` and the one after it.
    """

    point: np.ndarray   # point, ahead: (R,) int, indices of points
    ahead: np.ndarray
    share: np.ndarray   # (R,) 0 to 1, the place on the way from point `ahead` to the one after it
    near: np.ndarray   # near, far: (R,) stations of both ends, in intervals of the planes
    far: np.ndarray


def scanner_lines(records: Columns | np.ndarray, p: Pass, mirror: MirrorPhase, corridor: float,
                  intensity: bool = True) -> ScannerLines | None:
    """The points of a scanner on their scan lines.

    records : survey points of one pass and scanner
    corridor : m either side of the reference line within which points are used
    intensity : are intensities wanted?

    Returns ScannerLines, or None where there are fewer than two lines
    """
    records = records[np.abs(records["d"]) <= int(round(corridor / COORDINATE_SCALE))]
    if len(records) < 4:
        return None
    time = np.ascontiguousarray(records["time"])
    order = time_order(time)
    time = time.take(order)
    # the rows of a column lie in order where they are read, and only then by time
    columns = {name: records[name].take(order) for name in ("s", "d", "z", *["intensity"] * intensity)}
    first, last = np.floor(mirror.turns_at(time[[0, -1]])).astype(int)
    turns = np.arange(first, last + 2)
    begins = mirror.times_at(turns)
    begins[0], begins[-1] = min(begins[0], time[0]), max(begins[-1], np.nextafter(time[-1], np.inf))
    driven = p.progress_at(begins)
    new = np.floor(driven[:-1] / SCANLINE.min_driven) > np.floor(p.progress_at(mirror.times_at(turns[:-1] - 1)) / SCANLINE.min_driven)
    bounds = np.searchsorted(time, begins)
    counts = np.diff(bounds)
    used = np.flatnonzero(new)
    if len(used) < 2:
        return None
    if not new.all():
        used_points = np.repeat(new, counts)
        columns, time = {name: column[used_points] for name, column in columns.items()}, time[used_points]
        counts = counts[used]
    number = np.repeat(np.arange(len(used)), counts)   # a look-up by it is quicker than numpy's repeat
    phase = (time - begins[:-1][used].take(number)) / (begins[1:] - begins[:-1])[used].take(number)
    s, d, z = (columns[name] * COORDINATE_SCALE for name in ("s", "d", "z"))
    ranges = _ranges(columns, p, begins[:-1][used], number)
    line = number.astype(np.int32)
    joined = _side_by_side(line, phase, ranges, (s, d, z), mirror)
    return ScannerLines(line, phase, s, d, z, columns.get("intensity"), ranges, joined, np.diff(driven)[used])


def _side_by_side(line, phase, ranges, places, mirror):
    """(N,) whether a point and the next one are neighbours on a surface; `places` holds s, d and z."""
    phase_step = np.diff(phase)
    joined = np.zeros(len(phase), bool)
    joined[:-1] = same_line = line[1:] == line[:-1]
    # only pairs with missing points between them or with a jump of range are checked further
    far = np.flatnonzero(same_line & (phase_step > (SCANLINE.max_missing_pulses + 1.5) * mirror.pulse))
    joined[far[sum((c[far + 1] - c[far]) ** 2 for c in places) > SCANLINE.max_neighbour_distance**2]] = False
    leap = np.abs(np.diff(ranges))
    jump = np.flatnonzero(same_line & (leap > SCANLINE.range_jump))
    edge = SCANLINE.grazing_tangent * leap[jump] > 2 * np.pi * phase_step[jump] * ranges[jump]
    for c in places[:2]:
        edge |= np.abs(c[jump + 1] - c[jump]) > SCANLINE.max_edge
    joined[jump[edge]] = False
    return joined


def _ranges(columns, p, time, line):
    """(N,) float32 m from the vehicle to its points; the vehicle is taken as standing during a turn."""
    ranges = np.zeros(len(columns["s"]), np.float32)
    for name, track in (("s", p.s), ("d", p.d), ("z", p.z)):
        stood = np.rint(np.interp(time, p.time, track) / COORDINATE_SCALE).astype(np.int32)
        across = (columns[name] - stood.take(line)).astype(np.float32)
        across *= across
        ranges += across
    np.sqrt(ranges, out=ranges)
    ranges *= np.float32(COORDINATE_SCALE)
    return ranges


def ribs_of(lines: ScannerLines, direction: int, mirror: MirrorPhase, interval: float) -> Ribs:
    """The ribs of the mesh that section planes intersect.

    direction : 1 where the vehicle drove in the direction of the stations, -1 against it
    interval : m between planes
    """
    key = lines.line + lines.phase
    number = np.arange(len(key), dtype=np.float64)
    station = lines.s / interval
    cell = np.ceil(station).astype(np.int32)
    cell_after = np.append(cell[1:], cell[-1:])
    longest = np.maximum(SCANLINE.max_rib, SCANLINE.max_lines_ahead * mirror.spacing * lines.driven) / interval
    ribs, unmatched = [], None   # unmatched: points without a place ahead so far, None for all
    for step in range(1, SCANLINE.max_lines_ahead * mirror.spacing + 1):
        own_key, own_line, own_cell = (values if unmatched is None else values.take(unmatched) for values in (key, lines.line, cell))
        position = np.interp(own_key + step, key, number)
        position += SCANLINE.rib_tolerance
        ahead = position.astype(np.int64)
        hit = lines.joined.take(ahead)
        hit &= lines.line.take(ahead) == own_line + step
        # no plane lies between points of one cell
        cut = cell.take(ahead) != own_cell
        cut |= cell_after.take(ahead) != own_cell
        cut &= hit
        cut = np.flatnonzero(cut)
        ribs.append(_ribs_on_surface(lines, station, longest, direction, cut if unmatched is None else unmatched.take(cut),
                                     ahead.take(cut), position.take(cut)))
        unmatched = np.flatnonzero(~hit) if unmatched is None else unmatched[~hit]
        if not len(unmatched):
            break
    return Ribs.join(ribs)


def _ribs_on_surface(lines, station, longest, direction, point, ahead, place):
    """The ribs from points to places ahead that planes intersect and that lie on a surface."""
    share = place - ahead
    # a rib that ends near a point ends in it, so that no plane passes between this rib and the next one
    share = np.where(share < 2 * SCANLINE.rib_tolerance, 0.0, share - SCANLINE.rib_tolerance)
    after = ahead + 1
    near, far = station.take(point), station.take(ahead)
    far += share * (station.take(after) - far)
    length = far - near
    length *= direction
    difference = lines.ranges.take(ahead)
    difference += share * (lines.ranges.take(after) - difference)
    difference -= lines.ranges.take(point)
    good = np.ceil(near) != np.ceil(far)
    good &= (length > 0) & (length <= longest[lines.line[point]]) & (np.abs(difference) <= SCANLINE.range_jump)
    good = np.flatnonzero(good)
    return Ribs(*(values.take(good) for values in (point, ahead, share, near, far)))


def slanting_edges(lines: ScannerLines, mirror: MirrorPhase, interval: float) -> Ribs:
    """Edges along scan lines that run far along the road, so that a plane may pass between their ends and no rib. interval : m between planes"""
    station = lines.s / interval
    point = np.flatnonzero((np.diff(np.ceil(station)) != 0) & lines.joined[:-1])   # most have no plane between them and the next point
    least = SCANLINE.slant_share * mirror.spacing * lines.driven[lines.line.take(point)]
    point = point[np.abs(lines.s.take(point + 1) - lines.s.take(point)) > least]
    return Ribs(point, point, np.ones(len(point)), station.take(point), station.take(point + 1))


@dataclass
class PlaneVertices:
    """N vertices of one pass and scanner, sorted by plane and by mirror phase from right to left."""

    plane: np.ndarray   # (N,) int, number of the section plane
    phase: np.ndarray   # (N,) turns
    d: np.ndarray   # d, z: (N,) m, offset and local height
    z: np.ndarray
    across: np.ndarray   # across, above: (N,) m from the track where it crosses the plane
    above: np.ndarray
    gap: float   # turns between neighbours without missing pulses, at most

    @classmethod
    def from_track(cls, p: Pass, interval: float, mirror: MirrorPhase, plane: np.ndarray, phase: np.ndarray, d: np.ndarray,
                  z: np.ndarray) -> PlaneVertices:
        """The vertices with their places relative to the track of a pass.

        interval : m between planes
        plane, phase, d, z : (N,) as the attributes
        """
        first = int(plane[0])
        track_d, track_z = p.at_station(np.arange(first, int(plane[-1]) + 1) * interval)
        return cls(plane, phase, d, z, d - track_d[plane - first], z - track_z[plane - first], (SCANLINE.max_missing_pulses + 1.5) * mirror.pulse)

    def __post_init__(self) -> None:
        self.away = np.sqrt(self.across * self.across + self.above * self.above)

    def side_by_side(self, i: np.ndarray | slice, j: np.ndarray | slice) -> np.ndarray:
        """Whether vertices j are the next ones to the left of vertices i on one surface.

        i, j : indices or slices of M vertices

        Returns (M,) bool
        """
        step = self.d[j] - self.d[i]
        side = (self.plane[j] == self.plane[i]) & (step >= -SCANLINE.max_backward) & (step <= SCANLINE.max_edge)
        leap = np.abs(self.away[j] - self.away[i])
        # only pairs with missing points between them or with a jump of range are checked further
        far = np.flatnonzero(side & (np.abs(self.phase[j] - self.phase[i]) > self.gap))
        side[far] = step[far] ** 2 + (self.z[j] - self.z[i])[far] ** 2 <= SCANLINE.max_neighbour_distance**2
        # one behind the other as seen from the track: the edge of an object and its background
        jump = np.flatnonzero(side & (leap > SCANLINE.range_jump))
        across, above, ranges = ((values[i][jump], values[j][jump]) for values in (self.across, self.above, self.away))
        cross_product = np.abs(across[1] * above[0] - across[0] * above[1])
        side[jump[cross_product < SCANLINE.grazing_tangent * leap[jump] * ranges[0]]] = False
        return side

    def lines(self) -> tuple[np.ndarray | None, np.ndarray]:
        """Connect the vertices to L polylines.

        Returns
            order : (N,) int, order of the vertices, or None where it does not change
            first : (L + 1,) int, first vertex of each line in that order
        """
        count = len(self.d)
        begin = np.r_[0, np.flatnonzero(~self.side_by_side(slice(0, count - 1), slice(1, count))) + 1]
        end = np.r_[begin[1:], count] - 1
        before = np.full(len(begin), -1)   # the piece that a piece continues
        ahead = np.zeros(len(begin), bool)
        for lag in range(2, min(SCANLINE.max_pieces_between + 2, len(begin))):
            free = np.flatnonzero(~ahead[:-lag] & (before[lag:] < 0))
            free = free[self.side_by_side(end[free], begin[free + lag])]
            before[free + lag], ahead[free] = free, True
        if not ahead.any():
            return None, np.r_[begin, count]
        head = np.where(before < 0, np.arange(len(begin)), before)
        while (head[head] != head).any():
            head = head[head]
        pieces = np.argsort(head, kind="stable")
        lengths = (end - begin + 1)[pieces]
        starts = np.cumsum(lengths) - lengths
        order = np.repeat(begin[pieces] - starts, lengths) + np.arange(count)
        return order, np.r_[starts[np.r_[True, np.diff(head[pieces]) > 0]], count]


def plane_order(plane: np.ndarray, phase: np.ndarray) -> np.ndarray:
    """Indices that sort by plane, then by phase.

    numpy sorts 16-bit integers by radix, in linear time.

    plane : (N,) int, from 0
    phase : (N,) turns, 0 to 1

    Returns (N,) int
    """
    by_phase = np.argsort((phase * PHASE_STEPS).astype(np.uint16), kind="stable")
    plane = plane.take(by_phase)
    return by_phase.take(np.argsort(plane.astype(np.int16) if plane.max() < 2**15 else plane, kind="stable"))


def increasing(d: np.ndarray, first: np.ndarray) -> np.ndarray:
    """Offsets that do not decrease within a line: the mean of the running maximum and the reverse running minimum.

    They are computed in whole OFFSET_UNITs, so that the result of a line does not depend on the lines before it.

    d : (V,) m
    first : (L + 1,) int, first vertex of each line

    Returns (V,) m
    """
    units = np.rint(d / SCANLINE.offset_unit).astype(np.int64)
    line_offset = np.repeat(np.arange(len(first) - 1) * LINE_OFFSET_UNITS, np.diff(first))
    units += line_offset
    middle = np.maximum.accumulate(units)
    middle += np.minimum.accumulate(units[::-1])[::-1]
    return (middle - 2 * line_offset) * (0.5 * SCANLINE.offset_unit)
