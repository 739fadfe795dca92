"""The mesh between neighbouring scan lines of one scanner, within a window of the road.

Every point of a line and the two points of the next line between which it stands at the
mirror's phase make a triangle. What the section planes need of it is its rib: the side
from the point to where the same phase lies on the line ahead. The mesh exists for one
window at a time.
"""

from dataclasses import dataclass, fields

import numpy as np

from ...survey.lattice.scan_lattice import time_order
from ...survey.store.records import COORDINATE_SCALE, take_rows

# Where planes cut the mesh, side by side: the vertices of section planes chained into lines.

MAX_BACKWARD = 0.05   # m that a line may go back across the road (noise on a face) before it is parted
MAX_PIECES_BETWEEN = 3       # pieces of something else that may lie between two pieces of one line: a scanner that looks ahead
#                   sees a car and the ground beside it at one phase of its mirror, in different turns
OFFSET_UNIT = 1e-7       # m in which offsets are counted where they are put in order
LINE_OFFSET_UNITS = 2 * 10**10  # of them, 2 km, lie between the offsets of one line and the next
PHASE_STEPS = 65535  # steps of a turn by which vertices are put in order


@dataclass
class PlaneVertices:
    """(N,) vertices of one pass and scanner, by plane and then by mirror phase from right to left.

    across, above : metres from the track where it passes the plane; gap : turns that neighbours may be apart
    """

    plane: np.ndarray
    phase: np.ndarray
    d: np.ndarray
    z: np.ndarray
    across: np.ndarray
    above: np.ndarray
    gap: float

    @classmethod
    def seen_from(cls, p, interval, clock, plane, phase, d, z):
        """The vertices as the track of pass `p` sees them."""
        first = int(plane[0])
        track_d, track_z = p.at_station(np.arange(first, int(plane[-1]) + 1) * interval)
        return cls(plane, phase, d, z, d - track_d[plane - first], z - track_z[plane - first], (MAX_MISSING_PULSES + 1.5) * clock.pulse)

    def __post_init__(self):
        self.away = np.sqrt(self.across * self.across + self.above * self.above)

    def side_by_side(self, i, j):
        """Whether vertices j are the next ones to the left of vertices i on one surface (i and j index alike)."""
        step = self.d[j] - self.d[i]
        side = (self.plane[j] == self.plane[i]) & (step >= -MAX_BACKWARD) & (step <= MAX_EDGE)
        leap = np.abs(self.away[j] - self.away[i])
        # few pairs need a closer look: those with points missing between them, and those with a jump of range
        far = np.flatnonzero(side & (np.abs(self.phase[j] - self.phase[i]) > self.gap))
        side[far] = step[far] ** 2 + (self.z[j] - self.z[i])[far] ** 2 <= MAX_NEIGHBOUR_DISTANCE**2
        # seen from the track one behind the other: the edge of a thing and what lies behind
        jump = np.flatnonzero(side & (leap > RANGE_JUMP))
        across, above, away = ((values[i][jump], values[j][jump]) for values in (self.across, self.above, self.away))
        aside = np.abs(across[1] * above[0] - across[0] * above[1])
        side[jump[aside < GRAZING_TANGENT * leap[jump] * away[0]]] = False
        return side

    def lines(self):
        """(order of the vertices, None where it stays; (L + 1,) first vertex of each line in that order)."""
        count = len(self.d)
        begin = np.r_[0, np.flatnonzero(~self.side_by_side(slice(0, count - 1), slice(1, count))) + 1]
        end = np.r_[begin[1:], count] - 1
        before = np.full(len(begin), -1)   # the piece that a piece goes on from
        ahead = np.zeros(len(begin), bool)
        for lag in range(2, min(MAX_PIECES_BETWEEN + 2, len(begin))):
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


def plane_order(plane, phase):
    """Indices that sort by plane (whole numbers from 0), then phase; short integers are sorted by their digits, in linear time."""
    by_phase = np.argsort((phase * PHASE_STEPS).astype(np.uint16), kind="stable")
    plane = plane[by_phase]
    return by_phase[np.argsort(plane.astype(np.int16) if plane.max() < 2**15 else plane, kind="stable")]


def increasing(d, first):
    """Offsets that do not decrease within a line: midway between the greatest before and the least behind.

    They are counted in whole OFFSET_UNITs, so that those of a line do not depend on how many lines come before it.
    """
    place = np.rint(d / OFFSET_UNIT).astype(np.int64)
    place += np.repeat(np.arange(len(first) - 1) * LINE_OFFSET_UNITS, np.diff(first))
    middle = np.maximum.accumulate(place)
    middle += np.minimum.accumulate(place[::-1])[::-1]
    middle -= np.repeat(np.arange(len(first) - 1) * (2 * LINE_OFFSET_UNITS), np.diff(first))
    return middle * (0.5 * OFFSET_UNIT)

MIN_DRIVEN = 0.01          # m of driving between lines: nearer ones, of a vehicle that waits, tell nothing new
MAX_RIB = 0.30   # m, or MAX_LINES_AHEAD times what was driven during a turn where that is more
MAX_LINES_AHEAD = 3      # at which a point of the same phase is sought
MAX_MISSING_PULSES = 3          # pulses that may be missing between neighbours on a line,
MAX_NEIGHBOUR_DISTANCE = 0.15    # or m between them, whatever is missing
MAX_EDGE = 1.0   # m along a line: ground seen at so flat an angle tells little
RANGE_JUMP = 0.30    # m
RIB_TOLERANCE = 1e-6          # of the way between two points: nearer is the point itself
SLANT_SHARE = 0.5          # of what was driven during a turn
GRAZING_TANGENT = 0.09       # tangent of the angle to the beam below which a jump of range is the edge of something, not ground


@dataclass
class ScannerLines:
    """Points of one pass and scanner in a window, in order of time.

    line is compact and counts kept lines of the window; phase is the mirror's, in turns; reach is how far
    from the vehicle, metres; joined says whether a point and the next one are neighbours on the surface.
    """

    line: np.ndarray
    phase: np.ndarray
    s: np.ndarray
    d: np.ndarray
    z: np.ndarray
    intensity: np.ndarray
    reach: np.ndarray
    joined: np.ndarray
    driven: np.ndarray     # (lines,) m of road during the turn

    def __len__(self):
        return len(self.line)


@dataclass
class Ribs:
    """Sides of the mesh that planes cut: from `point` to a share of the way from point `ahead` to the one after it.

    near, far : stations of their ends in intervals of the planes
    """

    point: np.ndarray
    ahead: np.ndarray
    share: np.ndarray
    near: np.ndarray
    far: np.ndarray

    @classmethod
    def joined(cls, parts):
        return cls(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(cls)))


def scanner_lines(records, p, clock, corridor, level=None):
    """The points of a scanner as lines.

    Parameters
    ----------
    records : survey points of one pass and scanner
    p : Pass
    clock : MirrorPhase
    corridor : m either side within which points are used
    level : LevelStrip in which none are used, None uses all

    Returns
    -------
    ScannerLines, or None where fewer than two lines are there
    """
    d = records["d"]
    used = np.abs(d) <= int(round(corridor / COORDINATE_SCALE))
    if level is not None:
        used &= ~level.holds(records["s"], d)
    records = take_rows(records, used)
    if len(records) < 4:
        return None
    time = np.ascontiguousarray(records["time"])
    order = time_order(time)
    records, time = take_rows(records, order), time[order]
    first, last = np.floor(clock.turns_at(time[[0, -1]])).astype(int)
    turns = np.arange(first, last + 2)
    begins = clock.times_at(turns)
    begins[0], begins[-1] = min(begins[0], time[0]), max(begins[-1], np.nextafter(time[-1], np.inf))
    driven = p.progress_at(begins)
    new = np.floor(driven[:-1] / MIN_DRIVEN) > np.floor(p.progress_at(clock.times_at(turns[:-1] - 1)) / MIN_DRIVEN)
    bounds = np.searchsorted(time, begins)
    counts = np.diff(bounds)
    used = np.flatnonzero(new)
    if len(used) < 2:
        return None
    if not new.all():
        kept = np.repeat(new, counts)
        records, time = take_rows(records, kept), time[kept]
        counts = counts[used]
    line = np.repeat(np.arange(len(used), dtype=np.int32), counts)
    length = (begins[1:] - begins[:-1])[used]
    phase = (time - np.repeat(begins[:-1][used], counts)) / np.repeat(length, counts)
    s, d, z = (records[name] * COORDINATE_SCALE for name in ("s", "d", "z"))
    reach = _reach(records, p, begins[:-1][used], counts)
    joined = _side_by_side(line, phase, reach, (s, d, z), clock)
    return ScannerLines(line, phase, s, d, z, records["intensity"], reach, joined, np.diff(driven)[used])


def _side_by_side(line, phase, reach, places, clock):
    """(N,) whether a point and the next one are neighbours on a surface; `places` are its three coordinates."""
    apart = np.diff(phase)
    joined = np.zeros(len(phase), bool)
    joined[:-1] = same = line[1:] == line[:-1]
    # few pairs need a closer look: those with points missing between them, and those with a jump of range
    far = np.flatnonzero(same & (apart > (MAX_MISSING_PULSES + 1.5) * clock.pulse))
    joined[far[sum((c[far + 1] - c[far]) ** 2 for c in places) > MAX_NEIGHBOUR_DISTANCE**2]] = False
    leap = np.abs(np.diff(reach))
    jump = np.flatnonzero(same & (leap > RANGE_JUMP))
    edge = GRAZING_TANGENT * leap[jump] > 2 * np.pi * apart[jump] * reach[jump]
    for c in places[:2]:
        edge |= np.abs(c[jump + 1] - c[jump]) > MAX_EDGE
    joined[jump[edge]] = False
    return joined


def _reach(records, p, time, counts):
    """(N,) float32 m from the vehicle to its points; within a line the vehicle counts as standing."""
    away = np.zeros(len(records), np.float32)
    for name, track in (("s", p.s), ("d", p.d), ("z", p.z)):
        stood = np.rint(np.interp(time, p.time, track) / COORDINATE_SCALE).astype(np.int32)
        across = (records[name] - np.repeat(stood, counts)).astype(np.float32)
        across *= across
        away += across
    np.sqrt(away, out=away)
    away *= np.float32(COORDINATE_SCALE)
    return away


def ribs_of(lines, direction, clock, interval):
    """The ribs of the mesh that planes cut, from points that have neighbours ahead.

    Parameters
    ----------
    lines : ScannerLines
    direction : 1 where the vehicle drove along the road's stations, -1 against them
    clock : MirrorPhase
    interval : m between planes

    Returns
    -------
    Ribs
    """
    key = lines.line + lines.phase
    number = np.arange(len(key), dtype=np.float64)
    station = lines.s / interval
    cell = np.ceil(station).astype(np.int32)
    cell_after = np.append(cell[1:], cell[-1:])
    longest = np.maximum(MAX_RIB, MAX_LINES_AHEAD * clock.spacing * lines.driven) / interval
    found, rest = [], None   # rest: points that have no neighbour ahead yet, None for all
    for step in range(1, MAX_LINES_AHEAD * clock.spacing + 1):
        own_key, own_line, own_cell = (values if rest is None else values[rest] for values in (key, lines.line, cell))
        place = np.interp(own_key + step, key, number)
        place += RIB_TOLERANCE
        ahead = place.astype(np.int64)
        hit = lines.joined.take(ahead)
        hit &= lines.line.take(ahead) == own_line + step
        # between points of one cell no plane passes
        cut = cell.take(ahead) != own_cell
        cut |= cell_after.take(ahead) != own_cell
        cut &= hit
        cut = np.flatnonzero(cut)
        found.append(_steep_enough(lines, station, longest, direction, cut if rest is None else rest[cut], ahead[cut], place[cut]))
        rest = np.flatnonzero(~hit) if rest is None else rest[~hit]
        if not len(rest):
            break
    return Ribs.joined(found)


def _steep_enough(lines, station, longest, direction, point, ahead, place):
    """The Ribs from points to places ahead of them that planes cut and that lie on a surface."""
    share = place - ahead
    # a rib that meets a point ends in it exactly, so that no plane slips through between it and the next one
    share = np.where(share < 2 * RIB_TOLERANCE, 0.0, share - RIB_TOLERANCE)
    near, far = station[point], station[ahead]
    far += share * (station[ahead + 1] - far)
    onward = far - near
    onward *= direction
    reach = lines.reach[ahead]
    reach += share * (lines.reach[ahead + 1] - reach)
    reach -= lines.reach[point]
    good = np.ceil(near) != np.ceil(far)
    good &= (onward > 0) & (onward <= longest[lines.line[point]]) & (np.abs(reach) <= RANGE_JUMP)
    good = np.flatnonzero(good)
    return Ribs(point[good], ahead[good], share[good], near[good], far[good])


def slanting_edges(lines, clock, interval):
    """The sides along lines that go so far along the road that a plane may pass between their ends and no rib."""
    far = np.abs(np.diff(lines.s)) > SLANT_SHARE * clock.spacing * lines.driven[lines.line[:-1]]
    point = np.flatnonzero(far & lines.joined[:-1])
    return Ribs(point, point, np.ones(len(point)), lines.s[point] / interval, lines.s[point + 1] / interval)
