"""The alignment that the lanes of a road have in common: its straights, arcs and clothoids."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..curves.base import Arc
from ..curves.clothoid import fit_clothoids
from ..curves.model_selection import MAX_MISFIT, select_each
from ..curves.segmentation import element_ranges
from ..markings.cross_section.sections import STATION_STEP
from .lane_track import BRIDGED
from .settings import MIN_PLACES_PER_FIT

if TYPE_CHECKING:
    from ..survey.frame.road import Road
    from .lane_track import LaneTrack

MAX_PARALLEL_DEVIATION = 0.06  # m: 95 % of a lane's places are nearer than this to a parallel of the others
MIN_SHARED_LANE_LENGTH = 10.0       # m that a lane must share with others to be compared
MIN_ARC_LENGTH = 25.0          # m: a shorter arc may be a stair of a transition
MAX_TRANSITION_MISFIT = 0.02   # m
DIVISION_SPACING = 1.0         # m between places that are divided: fitted lines err alike over metres


@dataclass(frozen=True)
class Element:
    """An arc or a straight of one lane, from station `start` to `end`.

    arc : Arc in the road's direction, local metres; rmse : of the lane's places to it, metres
    complete : False where the lane or the road's lines end before the element does
    """

    start: float
    end: float
    arc: Arc
    rmse: float
    complete: bool


def lane_elements(tracks: list[LaneTrack], s: np.ndarray, road: Road) -> list[list[Element]]:
    """Arcs and straights of every lane.

    Lanes of a road run parallel, so that their bends are concentric: what they have
    in common (the mean of their offsets, each less its own) is divided into elements
    once, with all of their evidence, and each lane's elements are the parallels. A
    lane that is not parallel to the others is divided alone.

    Parameters
    ----------
    tracks : list of LaneTrack
    s : (K,) grid stations
    road : Road

    Returns
    -------
    list, for every track, of lists of Element in order of station
    """
    found: list[list[Element]] = [[] for _ in tracks]
    groups = []
    waiting = sorted(range(len(tracks)), key=lambda i: (-len(tracks[i]), i))
    while waiting:
        groups.append(_parallel_lanes([(i, tracks[i]) for i in waiting]))
        waiting = [i for i in waiting if i not in dict(groups[-1][0])]
    for (members, _, _), divided in zip(groups, _divided([_Axis.of(s, axis, first, road) for _, axis, first in groups])):
        for i, offset in members:
            found[i] = _of_lane(tracks[i], offset, divided, s, road)
    return found


def _parallel_lanes(tracks):
    """The longest lane and all that are parallel to it, directly or through others.

    Returns
    -------
    members : list of (index, offset from the axis)
    axis : (N,) offset of the common axis from the grid station `first` on
    """
    size = max(track.last for _, track in tracks) + 1
    total, weight = np.zeros(size), np.zeros(size)
    members, rest = [], list(tracks)
    added = True
    while added:
        added = False
        for i, track in rest:
            rows = np.arange(track.first, track.last + 1)
            shared = weight[rows] > 0
            offset = float(np.median(track.d))
            if members:
                if shared.sum() * STATION_STEP < min(MIN_SHARED_LANE_LENGTH, 0.5 * len(track) * STATION_STEP):
                    continue
                apart = track.d[shared] - total[rows[shared]] / weight[rows[shared]]
                offset = float(np.median(apart))
                if np.percentile(np.abs(apart - offset), 95) > MAX_PARALLEL_DEVIATION:
                    continue
            # a bridged place says little, but more than nothing where it is alone
            w = np.where(track.status == BRIDGED, 1e-3, 1.0)
            total[rows] += w * (track.d - offset)
            weight[rows] += w
            members.append((i, offset))
            added = True
        rest = [(i, track) for i, track in rest if i not in dict(members)]
    covered = np.flatnonzero(weight)
    first, last = covered[0], covered[-1]
    return members, total[first:last + 1] / weight[first:last + 1], int(first)


@dataclass(frozen=True)
class _Axis:
    """Places x, y (N,) of what lanes have in common, their stations and lengths `u` along it."""

    at: np.ndarray
    x: np.ndarray
    y: np.ndarray
    u: np.ndarray

    @classmethod
    def of(cls, s, d, first, road):
        at = s[first:first + len(d)]
        x, y = road.to_map(at, d)
        return cls(at, x, y, np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))])

    @property
    def thinned(self):
        """x, y of places a metre apart."""
        rows = np.unique(np.r_[np.arange(0, len(self.x), int(DIVISION_SPACING / STATION_STEP)), len(self.x) - 1])
        return self.x[rows], self.y[rows]

    def part(self, first, last):
        """x, y of the places between two lengths."""
        inside = slice(np.searchsorted(self.u, first), np.searchsorted(self.u, last, side="right"))
        return self.x[inside], self.y[inside]


def _divided(axes):
    """[(start station, end station, curve)] of each of some axes, whose parts are fitted together."""
    long = [k for k, axis in enumerate(axes) if len(axis.at) >= MIN_PLACES_PER_FIT]
    cuts = element_ranges([axes[k].thinned for k in long])
    parts = [(k, first, last) for k, bounds in zip(long, cuts) for first, last in bounds]
    choices = select_each([axes[k].part(first, last) for k, first, last in parts])
    found = [[] for _ in axes]
    for (k, first, last), choice in zip(parts, choices):
        found[k].append((first, last, choice.best))
    found = _without_steps(axes, found)
    return [[(*map(float, np.interp([first, last], axis.u, axis.at)), best.curve) for first, last, best in parts]
            for axis, parts in zip(axes, found)]


def _without_steps(axes, found):
    """Divisions in which no transition is a staircase of short arcs.

    A short arc and its neighbour make way for one clothoid where that keeps within
    2 cm of the places: on the road an arc this short, with no straight around it, is
    half a transition.
    """
    found, joints = list(found), [{} for _ in axes]
    open_ones = range(len(axes))
    while open_ones:
        pairs = {k: _steps(found[k]) for k in open_ones}
        new = [(k, first, last) for k, steps in pairs.items() for _, first, last in steps if (first, last) not in joints[k]]
        for (k, first, last), joint in zip(new, fit_clothoids([axes[k].part(first, last) for k, first, last in new], MAX_MISFIT)):
            joints[k][first, last] = joint
        for k, steps in pairs.items():
            merged = [(joints[k][first, last].residual_p95, j, joints[k][first, last]) for j, first, last in steps]
            merged = [one for one in merged if one[0] < MAX_TRANSITION_MISFIT]
            if merged:
                _, j, joint = min(merged, key=lambda one: one[:2])
                found[k] = found[k][:j] + [(found[k][j][0], found[k][j + 1][1], joint)] + found[k][j + 2:]
            else:
                pairs[k] = []
        open_ones = [k for k, steps in pairs.items() if steps]
    return found


def _steps(found):
    """(number, first, last) of an element that, with the next, may be half a transition each."""
    steps = []
    for j in range(len(found) - 1):
        (first, middle, a), (_, last, b) = found[j:j + 2]
        arcs = [q for q, length in ((a, middle - first), (b, last - middle))
                if q.curve.kind == "circle" and length < MIN_ARC_LENGTH]
        if arcs and not ({a.curve.kind, b.curve.kind} == {"circle", "line"} and last - first > 2 * MIN_ARC_LENGTH):
            steps.append((j, first, last))
    return steps


def _of_lane(track, offset, divided, s, road):
    at = s[track.first:track.last + 1]
    x, y = road.to_map(at, track.d)
    elements = []
    for k, (start, end, curve) in enumerate(divided):
        if not isinstance(curve, Arc):
            continue
        a, b = max(start, at[0]), min(end, at[-1])
        inside = (at >= a) & (at <= b)
        if inside.sum() < MIN_PLACES_PER_FIT:
            continue
        u, e = curve.parallel(offset).project(x[inside], y[inside])
        arc = curve.parallel(offset + float(np.median(e)))
        u, e = arc.project(x[inside], y[inside])
        complete = 0 < k < len(divided) - 1 and start >= at[0] and end <= at[-1]
        elements.append(Element(a, b, _cut(arc, float(u[0]), float(u[-1])), float(np.sqrt(np.mean(e**2))), complete))
    return elements


def _cut(arc, first, last):
    (x, y), = arc.at(np.array([first]))
    return Arc(float(x), float(y), float(arc.heading(first)), arc.bend, last - first)
