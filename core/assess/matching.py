"""Places along lines, and how far each is from other lines."""

from dataclasses import dataclass

import numpy as np
import shapely

from ..common.parallel import check_cancelled
from ..common.progress import Progress

STEP = 0.1       # m between compared places along a line
BASE = 0.5       # m to either side over which a line's direction is taken: vertices a decimetre apart jitter
BATCH = 20_000  # places asked for at a time: neighbours within a reach are many


def single_lines(geometries):
    """The lines of any mix of geometries: parts of multi-lines, outlines of polygons; what has no length is left out.

    Returns
    -------
    lines : list of LineString
    owner : (N,) index of the geometry each line comes from
    """
    geometries = np.asarray(geometries, object)
    parts, owner = shapely.get_parts(geometries, return_index=True) if len(geometries) else (geometries, np.empty(0, int))
    is_area = shapely.get_type_id(parts) == shapely.GeometryType.POLYGON
    parts[is_area] = shapely.get_exterior_ring(parts[is_area])
    is_line = np.isin(shapely.get_type_id(parts), (shapely.GeometryType.LINESTRING, shapely.GeometryType.LINEARRING))
    kept = is_line & (shapely.length(parts) > 0)
    return list(parts[kept]), owner[kept]


@dataclass(frozen=True)
class Places:
    """Middles of pieces of at most STEP along lines.

    xy (N, 2); z (N,) NaN where the line has no heights; line (N,) which line; station (N,) metres along it;
    length (N,) of the piece each stands for; heading (N,) radians, the way the line is drawn.
    """

    xy: np.ndarray
    z: np.ndarray
    line: np.ndarray
    station: np.ndarray
    length: np.ndarray
    heading: np.ndarray

    def __len__(self):
        return len(self.xy)

    def only(self, mask):
        return Places(*(getattr(self, name)[mask] for name in ("xy", "z", "line", "station", "length", "heading")))

    def inside(self, area):
        """Those within a shapely polygon; all where it is None."""
        return self if area is None else self.only(shapely.contains_xy(area, self.xy[:, 0], self.xy[:, 1]))


def places_along(lines, step=STEP):
    """Places every `step` metres or less along LineStrings, each the middle of its piece."""
    if not len(lines):
        none = np.empty(0)
        return Places(np.empty((0, 2)), none, np.empty(0, int), none, none, none)
    lines = np.asarray(lines, object)
    total = shapely.length(lines)
    count = np.maximum(np.ceil(total / step - 1e-9).astype(int), 1)
    which = np.repeat(np.arange(len(lines)), count)
    piece = (total / count)[which]
    number = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    segments = Segments(lines)
    station = (number + 0.5) * piece
    xy, z = segments.at(which, station)
    return Places(xy, z, which, station, piece, segments.heading_at(which, station))


def runs_of(places, key):
    """Stretches along the lines in which (N,) integer `key` stays the same.

    Returns
    -------
    first, last : index of the first and the last place of each stretch
    """
    if not len(places):
        return np.empty(0, int), np.empty(0, int)
    apart = np.abs(np.diff(places.station)) > 1.5 * np.maximum(places.length[1:], places.length[:-1])
    cut = np.flatnonzero((np.diff(key) != 0) | (np.diff(places.line) != 0) | apart) + 1
    return np.r_[0, cut], np.r_[cut, len(places)] - 1


def pieces_of(lines, places, first, last):
    """The stretches of the lines from the first to the last place of each run."""
    start = places.station[first] - places.length[first] / 2
    end = places.station[last] + places.length[last] / 2
    found, vertices = [], {}
    for k, a, b in zip(places.line[first].tolist(), start.tolist(), end.tolist()):
        if k not in vertices:
            points = shapely.get_coordinates(lines[k], include_z=shapely.has_z(lines[k]))
            vertices[k] = points, np.r_[0.0, np.cumsum(np.hypot(*np.diff(points[:, :2], axis=0).T))]
        found.append(_cut(*vertices[k], a, b))
    return found


def _cut(points, along, start, end):
    """The part of a line from one station to another."""
    inner = slice(np.searchsorted(along, start + 1e-6, side="right"), np.searchsorted(along, end - 1e-6, side="left"))
    ends = np.stack([np.interp([start, end], along, axis) for axis in points.T], axis=1)
    return shapely.LineString(np.concatenate([ends[:1], points[inner], ends[1:]]))


@dataclass(frozen=True)
class Feet:
    """The nearest spot on some lines for each of N places; distance inf and the rest NaN or -1 where there is none.

    side is +1 where the place lies left of the line as drawn, -1 right of it.
    """

    distance: np.ndarray
    side: np.ndarray
    xy: np.ndarray
    z: np.ndarray
    line: np.ndarray
    station: np.ndarray

    def only(self, mask):
        return Feet(*(getattr(self, name)[mask] for name in Feet.__dataclass_fields__))


class Segments:
    """All straight pieces of some LineStrings, searchable."""

    def __init__(self, lines):
        lines = np.asarray(lines, object)
        points, owner = shapely.get_coordinates(lines, include_z=True, return_index=True)
        run = np.hypot(*np.diff(points[:, :2], axis=0).T) if len(points) > 1 else np.empty(0)
        along = np.r_[0.0, np.cumsum(run)] if len(points) else run
        own = np.flatnonzero((owner[1:] == owner[:-1]) & (run > 0)) if len(points) > 1 else np.empty(0, int)
        begins = np.searchsorted(owner, np.arange(len(lines)))
        self.a, self.b, self.line = points[own], points[own + 1], owner[own]
        self.length = run[own]
        self.start = along[own] - along[begins[self.line]] if len(own) else np.empty(0)
        self._along = along[own] if len(own) else np.empty(0)
        self._line_start = along[begins] if len(points) else np.empty(0)
        ends = np.searchsorted(owner, np.arange(len(lines)), side="right") - 1
        self._line_length = along[ends] - self._line_start if len(points) else np.empty(0)
        self._heading = None
        self._tree = None

    def at(self, line, station):
        """(xy, z) at stations along the lines of these numbers."""
        k = np.clip(np.searchsorted(self._along, self._line_start[line] + station, side="right") - 1, 0, len(self.a) - 1)
        share = np.clip((station - self.start[k]) / self.length[k], 0.0, 1.0)[:, None]
        spot = self.a[k] + share * (self.b[k] - self.a[k])
        return spot[:, :2], spot[:, 2]

    def heading_at(self, line, station):
        """Direction of the lines there, radians, over BASE metres behind and ahead."""
        behind, ahead = np.maximum(station - BASE, 0.0), np.minimum(station + BASE, self._line_length[line])
        step = self.at(line, ahead)[0] - self.at(line, behind)[0]
        return np.arctan2(step[:, 1], step[:, 0])

    def nearest(self, xy, heading=None, max_angle=None, reach=np.inf, progress=Progress()):
        """Feet of (N, 2) places.

        With `max_angle` (radians) only segments count that run within this angle of the place's `heading`,
        either way round, and lie within `reach` metres.
        """
        if not len(self.a) or not len(xy):
            return _no_feet(len(xy))
        if self._tree is None:
            self._tree = shapely.STRtree(shapely.linestrings(np.stack([self.a[:, :2], self.b[:, :2]], axis=1)))
        parts = []
        for k in range(0, len(xy), BATCH):
            progress.report(k / len(xy))
            check_cancelled()
            some = slice(k, k + BATCH)
            if max_angle is not None and self._heading is None:
                self._heading = self.heading_at(self.line, self.start + self.length / 2)
            if max_angle is None:
                pairs = self._tree.query_nearest(shapely.points(xy[some]), all_matches=False)
            else:
                pairs = self._parallel(xy[some], heading[some], max_angle, reach)
            parts.append(self._feet(xy[some], *pairs))
        return Feet(*(np.concatenate([getattr(part, name) for part in parts]) for name in Feet.__dataclass_fields__))

    def _parallel(self, xy, heading, max_angle, reach):
        """(place, segment) pairs: of the segments within reach that run the same way, the nearest."""
        place, segment = self._tree.query(shapely.points(xy), predicate="dwithin", distance=reach)
        turned = np.abs((heading[place] - self._heading[segment] + np.pi / 2) % np.pi - np.pi / 2)
        place, segment = place[turned <= max_angle], segment[turned <= max_angle]
        order = np.lexsort((segment, self._to(xy[place], segment)[2], place))
        first = order[np.unique(place[order], return_index=True)[1]]
        return place[first], segment[first]

    def _to(self, xy, segment):
        a, b = self.a[segment], self.b[segment]
        step = b - a
        share = np.clip(((xy - a[:, :2]) * step[:, :2]).sum(axis=1) / self.length[segment]**2, 0.0, 1.0)
        foot = a + share[:, None] * step
        off = xy - foot[:, :2]
        return foot, share, np.hypot(off[:, 0], off[:, 1])

    def _feet(self, xy, place, segment):
        found = _no_feet(len(xy))
        foot, share, distance = self._to(xy[place], segment)
        step, off = (self.b - self.a)[segment], xy[place] - self.a[segment, :2]
        found.distance[place] = distance
        found.side[place] = np.where(step[:, 0] * off[:, 1] - step[:, 1] * off[:, 0] >= 0, 1.0, -1.0)
        found.xy[place], found.z[place] = foot[:, :2], foot[:, 2]
        found.line[place] = self.line[segment]
        found.station[place] = self.start[segment] + share * self.length[segment]
        return found


def _no_feet(count):
    return Feet(np.full(count, np.inf), np.full(count, np.nan), np.full((count, 2), np.nan), np.full(count, np.nan),
                np.full(count, -1), np.full(count, np.nan))


# Where along the road, and on which side, the places of result and reference lie.

REACH = 2.5         # m: farther from every reference line, a result counts along itself
APART = 2.0         # m between the outermost reference lines below which they have no sides
BREADTH = 30.0      # m from the longest reference line within which others have a side


@dataclass(frozen=True)
class Stations:
    """unit (N,): the road or line along which a place is measured, -1 where none; station (N,) metres along it;
    side (N,): 1 left, -1 right, 0 untold; offset (N,) metres from the trajectory, NaN without one."""

    unit: np.ndarray
    station: np.ndarray
    side: np.ndarray
    offset: np.ndarray


class AlongTrajectory:
    """Stations of a RoadFrame; left and right are those of the drive."""

    title = "the trajectory"
    signed = "positive away from the trajectory"

    def __init__(self, frame, corridor):
        self.frame, self.corridor = frame, corridor

    def of_reference(self, places):
        road, station, offset = self.frame.locate_nearest(*self.frame.to_local(*places.xy.T), corridor=self.corridor)
        return Stations(road, station, np.sign(np.nan_to_num(offset)).astype(int), offset)

    def of_result(self, places, feet):
        return self.of_reference(places)

    def outward(self, places, feet, stations):
        """+1 where a place lies farther from the trajectory than its foot on the reference, else -1."""
        foot = self.frame.locate_nearest(*self.frame.to_local(*np.nan_to_num(feet.xy).T), corridor=self.corridor)[2]
        return np.where(np.abs(stations.offset) >= np.abs(np.nan_to_num(foot)), 1.0, -1.0)


class AlongReference:
    """Each reference line measures itself, and what lies within REACH of it."""

    title = "the reference lines"
    signed = "positive left of the reference line as it is drawn"

    def __init__(self, lines, sides=None):
        """`sides`: 1, -1 or 0 of every line as its layer says; by default found from how the lines lie."""
        self.side = sides_of(lines) if sides is None else np.asarray(sides, int)
        self.count = len(lines)
        self.length = shapely.length(np.asarray(lines, object)) if self.count else np.empty(0)

    def of_reference(self, places):
        return Stations(places.line, places.station, self.side[places.line], np.full(len(places), np.nan))

    def of_result(self, places, feet):
        # what lies beyond the end of a line is not beside it
        beside = (feet.station > 1e-6) & (feet.station < self.length[feet.line] - 1e-6) if self.count else False
        near = (feet.distance <= REACH) & beside
        side = np.where(feet.line >= 0, self.side[feet.line] if self.count else 0, 0)
        return Stations(np.where(near, feet.line, self.count + places.line), np.where(near, feet.station, places.station),
                        side, np.full(len(places), np.nan))

    def outward(self, places, feet, stations):
        return feet.side


def sides_of(lines):
    """1 (left), -1 (right) or 0 (untold) of every line, seen along the longest as it is drawn.

    The middle of the road is taken halfway between the outermost lines; lines less
    than 2 m apart, or a single one, have no sides.
    """
    if len(lines) < 2:
        return np.zeros(len(lines), int)
    length = shapely.length(np.asarray(lines, object))
    axis = Segments([lines[int(np.argmax(length))]])
    places = places_along(lines, 2.0)
    feet = axis.nearest(places.xy)
    offset = np.bincount(places.line, feet.side * feet.distance, len(lines)) / np.bincount(places.line, minlength=len(lines))
    near = np.abs(offset) <= BREADTH
    low, high = offset[near].min(), offset[near].max()
    if high - low < APART:
        return np.zeros(len(lines), int)
    return np.where(near, np.where(offset > (low + high) / 2, 1, -1), 0)


def stations_of_match(match, frame=None):
    """((N,) station of the result's places, (M,) of the reference's, NaN where untold), and what they are measured along."""
    if frame is not None:
        along = AlongTrajectory(frame, BREADTH)
        return tuple(along.of_reference(places).station for places in (match.mine, match.theirs)), along.title
    feet = Segments(match.reference).nearest(match.mine.xy)
    return (feet.station, match.theirs.station), AlongReference.title


def stations_of_blocks(blocks, frame=None):
    """(N,) station of places (N, 2+), and what it is measured along: without a trajectory the longer way through them."""
    if not len(blocks):
        return np.empty(0), AlongTrajectory.title
    xy = blocks[:, :2]
    if frame is not None:
        return frame.locate_nearest(*frame.to_local(*xy.T), corridor=BREADTH)[1], AlongTrajectory.title
    centre = xy.mean(axis=0)
    axis = np.linalg.eigh(np.cov((xy - centre).T) if len(xy) > 1 else np.eye(2))[1][:, -1]
    axis = axis if axis[np.argmax(np.abs(axis))] > 0 else -axis
    along = (xy - centre) @ axis
    return along - along.min(), "the longer side of the layers"
