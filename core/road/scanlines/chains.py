"""Where planes cut the mesh, side by side: the vertices of section planes chained into lines."""

from dataclasses import dataclass

import numpy as np

from .mesh import GRAZING, LONGEST_EDGE, MISSING, NEIGHBOURS, RANGE_JUMP

BACKWARD = 0.05   # m that a line may go back across the road (noise on a face) before it is parted
BETWEEN = 3       # pieces of something else that may lie between two pieces of one line: a scanner that looks ahead
#                   sees a car and the ground beside it at one phase of its mirror, in different turns
STEP = 1e-7       # m in which offsets are counted where they are put in order
APART = 2 * 10**10  # of them, 2 km, lie between the offsets of one line and the next
FINENESS = 65535  # steps of a turn by which vertices are put in order


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
        return cls(plane, phase, d, z, d - track_d[plane - first], z - track_z[plane - first], (MISSING + 1.5) * clock.pulse)

    def __post_init__(self):
        self.away = np.sqrt(self.across * self.across + self.above * self.above)

    def side_by_side(self, i, j):
        """Whether vertices j are the next ones to the left of vertices i on one surface (i and j index alike)."""
        step = self.d[j] - self.d[i]
        side = (self.plane[j] == self.plane[i]) & (step >= -BACKWARD) & (step <= LONGEST_EDGE)
        leap = np.abs(self.away[j] - self.away[i])
        # few pairs need a closer look: those with points missing between them, and those with a jump of range
        far = np.flatnonzero(side & (np.abs(self.phase[j] - self.phase[i]) > self.gap))
        side[far] = step[far] ** 2 + (self.z[j] - self.z[i])[far] ** 2 <= NEIGHBOURS**2
        # seen from the track one behind the other: the edge of a thing and what lies behind
        jump = np.flatnonzero(side & (leap > RANGE_JUMP))
        across, above, away = ((values[i][jump], values[j][jump]) for values in (self.across, self.above, self.away))
        aside = np.abs(across[1] * above[0] - across[0] * above[1])
        side[jump[aside < GRAZING * leap[jump] * away[0]]] = False
        return side

    def lines(self):
        """(order of the vertices, None where it stays; (L + 1,) first vertex of each line in that order)."""
        count = len(self.d)
        begin = np.r_[0, np.flatnonzero(~self.side_by_side(slice(0, count - 1), slice(1, count))) + 1]
        end = np.r_[begin[1:], count] - 1
        before = np.full(len(begin), -1)   # the piece that a piece goes on from
        ahead = np.zeros(len(begin), bool)
        for lag in range(2, min(BETWEEN + 2, len(begin))):
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
    by_phase = np.argsort((phase * FINENESS).astype(np.uint16), kind="stable")
    plane = plane[by_phase]
    return by_phase[np.argsort(plane.astype(np.int16) if plane.max() < 2**15 else plane, kind="stable")]


def increasing(d, first):
    """Offsets that do not decrease within a line: midway between the greatest before and the least behind.

    They are counted in whole STEPs, so that those of a line do not depend on how many lines come before it.
    """
    place = np.rint(d / STEP).astype(np.int64)
    place += np.repeat(np.arange(len(first) - 1) * APART, np.diff(first))
    middle = np.maximum.accumulate(place)
    middle += np.minimum.accumulate(place[::-1])[::-1]
    middle -= np.repeat(np.arange(len(first) - 1) * (2 * APART), np.diff(first))
    return middle * (0.5 * STEP)
