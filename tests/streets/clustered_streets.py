"""Streets of clustered paint whose lines are known, and the marking lines found on them."""

import numpy as np
import shapely
from lanewright.core.common.features import MARKINGS, ROAD_EDGES, Features
from lanewright.core.common.progress import Progress
from lanewright.core.markings.lines.fit import MarkingLineSettings, fit_marking_lines
from lanewright.core.markings.objects.marking_objects import MarkingObjects
from lanewright.core.road.edges.road_edges import RoadEdges
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.records import ROAD_POINT, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.trajectory.trajectory import Trajectory

RADIUS = 140.0
EAST, NORTH, UP = 500000.0, 5400000.0, 30.0


class ClusteredStreet:
    """A left-hand bend of 140 m radius (or a straight street); paint is laid by station and offset of its axis.

    The carriageway reaches `half_width` metres to either side.
    """

    def __init__(self, length=120.0, radius=RADIUS, weave=0.0, backwards=False, seed=1, half_width=5.0):
        self.length, self.radius, self.half_width = length, radius, half_width
        self.rng = np.random.default_rng(seed)
        s = np.arange(0.0, length + 0.05, 0.1)
        driven = self.place(s, weave * np.sin(s / 25.0) - 1.6)
        time = np.arange(len(s)) * 0.01
        driven = driven[::-1] if backwards else driven
        angle = np.zeros(len(s))
        self.frame = build_frame(Trajectory(time, driven[:, 0], driven[:, 1], np.full(len(s), UP + 2.0), angle, angle, angle))
        self.points, self.rows = [], []

    def drive_again(self, offset, way):
        """One more pass along the street, at an offset of the axis; `way` is -1 against the first."""
        s = np.arange(0.0, self.length + 0.05, 0.1)[::way]
        places = np.concatenate([self.place(s[::way], -1.6), self.place(s, offset)])
        time = np.concatenate([0.01 * np.arange(len(s)), 1000.0 + 0.01 * np.arange(len(s))])
        self.frame = build_frame(Trajectory(time, places[:, 0], places[:, 1], np.full(len(places), UP + 2.0)))

    def place(self, s, d):
        """(N, 2) map coordinates of stations and offsets of the axis."""
        s, d = np.broadcast_arrays(np.asarray(s, float), np.asarray(d, float))
        if not self.radius:
            return np.c_[EAST + s, NORTH + d]
        turn = s / self.radius
        return np.c_[EAST + (self.radius - d) * np.sin(turn), NORTH + self.radius - (self.radius - d) * np.cos(turn)]

    def paint(self, first, last, offset, width=0.15, kind="lane", use="keep", across=None, density=1500, noise=0.008):
        """One painted patch, its own cluster; `across` makes it reach from `offset` to there."""
        far = offset + width / 2 if across is None else across
        near = offset - width / 2 if across is None else offset
        count = int(density * (last - first) * abs(far - near)) + 20
        s = self.rng.uniform(first, last, count)
        d = self.rng.uniform(near, far, count) + self.rng.normal(0, noise, count)
        self.points.append((np.full(count, len(self.rows) + 1), s, d))
        self.rows.append({"class": kind, "use": use, "length_m": max(last - first, abs(far - near)), "width_m": width})
        return self

    def dashes(self, dash, gap, offset, first=1.0, last=None, missing=(), **kind):
        """Dashes of one line; those whose number is in `missing` are worn away."""
        starts = np.arange(first, (last or self.length) - dash + 1e-9, dash + gap)
        for k, s in enumerate(starts):
            if k not in missing:
                self.paint(s, s + dash, offset, **kind)
        return self

    def pavement(self, offset):
        """RoadEdges of an edge of the pavement at an offset, a function of station."""
        station = np.arange(0.0, self.length, 0.5)
        edges = Features("LineStringZ", list(ROAD_EDGES))
        edges.add(shapely.linestrings(np.c_[self.place(station, offset(station)), np.full(len(station), UP)]), road=0, kind="main",
                  edge="pavement", status="measured", part="bottom", chain=1, side="left")
        return RoadEdges.from_features(edges, self.frame)

    def lines(self, settings=MarkingLineSettings(), progress=Progress(), edges=None):
        """The layer of the marking lines found."""
        return self.painted_lines(settings, progress, edges).to_features(self.frame)

    def painted_lines(self, settings=MarkingLineSettings(), progress=Progress(), edges=None):
        """The marking lines found."""
        points = RoadPoints.empty_like(origin=self.frame.origin)
        points.has_cluster = True
        cluster, s, d = (np.concatenate(parts) for parts in zip(*self.points))
        place = self.place(s, d)
        x, y = self.frame.to_local(place[:, 0], place[:, 1])
        records = np.zeros(len(s), ROAD_POINT)
        station, offset = self.frame.roads[0].locate(x, y)
        inside = np.isfinite(station)
        records["x"], records["y"] = to_units(x), to_units(y)
        records["z"] = to_units(UP + self.rng.normal(0, 0.005, len(s)) - self.frame.origin[2])
        records["time"], records["cluster"] = np.arange(len(s)) * 1e-5, cluster
        records["half_width"] = np.rint((self.half_width + np.sign(offset) * (offset - d)).clip(0, 20) * 1000)
        records = records[inside]
        records["s"], records["d"] = to_units(station[inside]), to_units(offset[inside])
        points.store.append(0, records)
        markings = Features("PolygonZ", MARKINGS)
        for k, row in enumerate(self.rows):
            mine = inside & (cluster == k + 1)
            # half a metre at a time, so that it bends with the street; cells of an image reach 2 cm beyond the paint
            steps = np.split(place[mine][order := np.argsort(s[mine])], np.flatnonzero(np.diff(s[mine][order] // 0.5)) + 1)
            outline = shapely.union_all(shapely.buffer(shapely.convex_hull(list(map(shapely.multipoints, steps))), 0.02, join_style="mitre"))
            markings.add(shapely.force_3d(outline, UP), road=0, cluster=k + 1, station_m=float(station[mine].min()),
                         offset_m=float(np.median(offset[mine])), **row)
        return fit_marking_lines(points, MarkingObjects.from_features(markings, self.frame), self.frame, settings, progress, edges)

    def distance(self, geometry, offset):
        """(M,) distances in plan of a drawn line's vertices to the axis' parallel."""
        x, y = shapely.get_coordinates(geometry).T
        if not self.radius:
            return np.abs(y - NORTH - offset)
        return np.abs(np.hypot(x - EAST, y - NORTH - self.radius) - (self.radius - offset))


def told(lines, *names):
    """The values of fields, one tuple a piece."""
    return [tuple(row[name] for name in names) for row in lines.rows]
