"""Where along the road, and on which side, the places of result and reference lie.

With a trajectory its road frame tells; without, every reference line is its own measure.
"""

from dataclasses import dataclass

import numpy as np
import shapely

from .places import Segments, places_along

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
