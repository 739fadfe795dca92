"""Painted streets of known shape, and the drive through them."""

import numpy as np
from lanewright.core.common.features import MARKING_LINES, Features
from lanewright.core.driving.driving_lines import DrivingSettings, make_driving_lines
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.markings.objects.marking_objects import MarkingObjects
from lanewright.core.road.edges.road_edges import RoadEdges
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.trajectory.trajectory import Trajectory
from shapely.geometry import LineString

EAST, NORTH, HEIGHT = 500_000.0, 5_400_000.0, 50.0


class Street:
    """A straight street eastward, or with `radius` one that bends left about (EAST, NORTH + radius).

    Stations are those of the axis, offsets are left positive. The vehicle drives
    the whole length at offset `vehicle`, backwards with `backwards`; `again` are the
    offsets of later passes, driven the other way, `along` of passes driven the same way.
    """

    def __init__(self, length=120.0, radius=None, vehicle=-1.75, backwards=False, again=(), along=()):
        self.length, self.radius = length, radius
        drives = [self._drive(vehicle, backwards, 0.0)]
        later = [(offset, not backwards) for offset in again] + [(offset, backwards) for offset in along]
        drives += [self._drive(offset, back, 1000.0 * (k + 1)) for k, (offset, back) in enumerate(later)]
        time, x, y = (np.concatenate(parts) for parts in zip(*drives))
        self.frame = build_frame(Trajectory(time, x, y, np.full(len(x), HEIGHT + 2.5)))
        self.lines = Features("LineStringZ", MARKING_LINES)

    def places(self, station, offset):
        """(N, 2) map coordinates."""
        station, offset = np.broadcast_arrays(np.asarray(station, float), np.asarray(offset, float))
        if self.radius is None:
            return np.c_[EAST + station, NORTH + offset]
        angle = station / self.radius
        return np.c_[EAST + (self.radius - offset) * np.sin(angle), NORTH + self.radius - (self.radius - offset) * np.cos(angle)]

    def _drive(self, offset, backwards, start):
        station = np.arange(0.0, self.length + 0.05, 0.1)
        places = self.places(station[::-1] if backwards else station, offset)
        return start + station / 10.0, places[:, 0], places[:, 1]

    def paint(self, offset, first=5.0, last=None, kind="lane", pattern="solid", status="measured", line=None, z=HEIGHT, width=None):
        """A line at an offset: a number, or a function of station."""
        last = self.length - 5.0 if last is None else last
        station = np.unique(np.r_[np.arange(first, last, 0.25), last])
        places = self.places(station, offset(station) if callable(offset) else offset)
        self.lines.add(LineString(np.c_[places, np.full(len(places), z)]), road=0, kind=kind, pattern=pattern, status=status,
                       line=len(self.lines) + 1 if line is None else line, width_m=width)
        return self

    def lanes(self, **settings):
        """Driving lines and curve elements; inputs beside the lines are named."""
        inputs = {name: settings.pop(name) for name in ("markings", "edges", "road_points") if name in settings}
        return driving_layers(self.lines, self.frame, DrivingSettings(**settings), **inputs)

    def offsets(self, line):
        """(N,) offsets of a line's vertices from the axis, left positive."""
        x, y = np.asarray(line.coords)[:, :2].T
        if self.radius is None:
            return y - NORTH
        return self.radius - np.hypot(x - EAST, y - NORTH - self.radius)


def driving_layers(lines, frame, settings=DrivingSettings(), markings=None, edges=None, road_points=None):
    """The layers of driving lines and curve elements made from layers."""
    found, elements, _ = make_driving_lines(
        PaintedLines.from_features(lines, frame), frame, settings,
        markings=None if markings is None else MarkingObjects.from_features(markings, frame),
        edges=None if edges is None else RoadEdges.from_features(edges, frame), road_points=road_points)
    return found.to_features(frame), elements.to_features(frame)


def middle(street, found):
    """Median offset of each piece, in the order of the layer."""
    return [round(float(np.median(street.offsets(line))), 3) for line, _ in found]
