"""The class of every point of a survey, by the ground below it and the layers of the road map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
import shapely
from scipy.ndimage import distance_transform_edt, grey_dilation, grey_erosion, map_coordinates
from scipy.spatial import cKDTree

from ...core.common.features import Features
from ...core.common.parallel import check_cancelled
from ...core.common.setting import Limited, setting
from ...core.road.surface.ground_grid import MeasuredGround, windows_of
from ...core.road.weights import SURFACE
from ...core.survey.frame.projection import RoadProjection
from ...core.survey.frame.road_frame import RoadFrame
from ...core.survey.las.point_fields import IntensitySource
from ...core.survey.store.columns import Columns
from ...core.survey.store.records import COORDINATE_SCALE
from ...core.survey.survey import Survey
from ...core.survey.trajectory.time_systems import SECONDS_PER_WEEK, unwrap_week


class PointClass(IntEnum):
    """Classes of points: up to 18 those of ASPRS (LAS 1.4 R15, table 17), from 64 on, where users define them, those of Lanewright."""

    UNCLASSIFIED = 1
    GROUND = 2
    LOW_VEGETATION = 3
    MEDIUM_VEGETATION = 4
    HIGH_VEGETATION = 5
    LOW_NOISE = 7
    ROAD_SURFACE = 11
    HIGH_NOISE = 18
    PAINT = 64
    CURB = 65
    GUARD_RAIL = 66
    BARRIER = 67
    WALL = 68
    FENCE = 69
    POLE = 70
    SIGN = 71


@dataclass(frozen=True)
class CloudSettings(Limited):
    """How near to ground, curbs and things a point of theirs lies. Users are asked for the numbers with limits alone."""

    ground: float = setting(0.05, 0.01, 0.3, "The thickness of the ground", "m")   # m above and below the ground of points that are ground
    curb: float = setting(0.10, 0.02, 0.5, "The width of a curb", "m")   # m either side of a road edge within which its face and top lie
    beside: float = setting(0.30, 0.05, 1.0, "The reach about lines and poles", "m")   # m either side of a rail, or about a shaft
    object_height: float = 0.20   # m: what is narrower than `object_width` and rises so far above its surroundings is no ground, such as a car
    object_width: tuple[float, float] = (6.0, 2.75)   # m along and across the road
    reach: float = 1.0   # m from a measured place of the ground to points whose ground it is
    paint_share: float = 0.8   # of the points in a marking that are no brighter than its paint: some are of worn paint and of asphalt beside it
    paint_from: float = 0.4   # of the way from asphalt about a marking to its paint, from where on a point is paint
    around: float = 0.25   # m about a marking where asphalt is seen
    contrast: float = 2.0   # sixteenths of a doubling: the least by which paint is brighter than asphalt; where it is not, a marking is all paint
    stretch: float = 50.0   # m of road whose points are looked at together
    noise: float = 0.25   # m below the road surface: no scanner sees through asphalt
    level: float = 1.5   # m either side of the reference line whose ground is the level of the road
    curb_share: float = 0.12   # of its height from which on the face of a curb begins, but at least
    curb_rise: float = 0.01   # m above its bottom: what asphalt scatters by
    slack: float = 0.05   # m above the top of a thing
    panel: tuple[float, float] = (0.5, 1.0)   # m about the shaft of a sign, and above its foot, where its panel may hang
    hedge: float = 2.0   # times `beside`: hedges are not as thin as rails
    vegetation: tuple[float, float] = (0.5, 2.0)   # m of height at which medium and high vegetation begin
    spacing: float = 0.05   # m between the vertices of lines that are compared with points


@dataclass(frozen=True)
class CloudLayers:
    """Layers of a road map in map coordinates; None where there is none."""

    road_surface: Features | None = None   # PolygonZ
    road_edges: Features | None = None   # LineStringZ along bottoms of curbs, with the fields height_m and edge
    markings: Features | None = None   # PolygonZ
    roadside: Features | None = None   # LineStringZ along the ground, with the fields kind, foot_m and height_m
    roadside_objects: Features | None = None   # PointZ on the ground, with the fields kind, height_m and diam_m


class _RoadPlaces(NamedTuple):
    """Where N points lie on the road, and their classes."""

    classes: np.ndarray   # (N,) uint8 PointClass; 0 where nothing is known of a point
    road: np.ndarray   # (N,) int, number of the road; -1 beyond the corridor, where the three below are NaN
    s: np.ndarray   # (N,) m, station
    d: np.ndarray   # (N,) m, offset, left positive
    h: np.ndarray   # (N,) m above the road under the reference line at the station


class PointClassifier:
    """Classifies points of a survey that is open, block by block.

    survey : whose files the points are of
    layers : of its road map, in its CRS
    corridor : m either side of the reference line within which points lie on the road
    intensity : how the survey reads the brightness of points
    """

    def __init__(self, survey: Survey, layers: CloudLayers, settings: CloudSettings = CloudSettings(), corridor: float = 25.0,
                 intensity: IntensitySource = IntensitySource()):
        self.survey, self.settings, self.corridor, self.intensity = survey, settings, corridor, intensity
        frame = survey.frame
        self._projection = RoadProjection(frame, corridor) if survey.has_time else None
        self._roads = np.array([p.road for p in frame.passes] + [-1])
        last = max(float(p.time[-1]) for p in frame.passes)
        self._week_ends = survey.has_time and SECONDS_PER_WEEK < last < 2 * SECONDS_PER_WEEK
        self._ground = _Ground(survey, settings)
        self._surface, self._paint = (Areas(layer, frame.origin) for layer in (layers.road_surface, layers.markings))
        self._paint_from = self._levels_of_paint(Areas(layers.markings, frame.origin, settings.around))
        self._edges, self._lines, self._objects = (_Near(layer, frame, settings.spacing) for layer in (
            _curbs_of(layers.road_edges), layers.roadside, layers.roadside_objects))

    def places(self, points: Any, brightness: int = 1) -> _RoadPlaces:
        """Places and classes of a block of N laspy points, whose coordinates are in metres; brightness : as of its `CloudHeader`."""
        origin = self.survey.frame.origin
        x, y, z = (np.asarray(points[name], float) - start for name, start in zip("xyz", origin))
        road, s, d, (x, y, z) = self._placed(points, x, y, z)
        classes, h = np.zeros(len(x), np.uint8), np.full(len(x), np.nan)
        steps = _steps_of(self.intensity.of(points) * np.float32(brightness))
        for number in np.unique(road[road >= 0]).tolist():
            rows = np.flatnonzero(road == number)
            ground, level = self._ground.at(number, s[rows], d[rows])
            h[rows] = z[rows] - level
            classes[rows] = self._classes(x[rows], y[rows], z[rows], z[rows] - ground, steps[rows])
        return _RoadPlaces(classes, road, s, d, h)

    def _placed(self, points, x, y, z):
        """Road, station and offset of points, and where they lie once the passes are laid on each other, as the layers have it."""
        frame = self.survey.frame
        if self._projection is None:
            return *frame.locate_nearest(x, y, self.corridor), (x, y, z)
        time = np.array(points["gps_time"], float)
        if self._week_ends and time.max(initial=0.0) < SECONDS_PER_WEEK:
            time = unwrap_week(time)
        passes, s, d = self._projection.project(x, y, time)
        road = np.where(np.isfinite(s), self._roads[passes], -1)
        if self.survey.moves is not None:
            stations = np.rint(np.nan_to_num(s) / COORDINATE_SCALE).astype(np.int32)
            records = Columns(dict(pass_number=np.where(road >= 0, passes, -1).astype(np.int32), s=stations), [("pass_number", "i4"), ("s", "i4")])
            x, y, z = (values + moved * COORDINATE_SCALE for values, moved in zip((x, y, z), self.survey.moves.units(records)))
            _, s, d = self._projection.project(x, y, time)
            road = np.where(np.isfinite(s), road, -1)
        return road, s, d, (x, y, z)

    def _levels_of_paint(self, around):
        """(P,) the brightness from which on points in each marking are paint, as of `_steps_of`: between asphalt about it and its paint."""
        counts = np.zeros((2, len(self._paint), 16 * 16 + 1), np.int32)
        for road in self.survey.store.roads() if len(self._paint) else ():
            first, last = self.survey.store.span(road) if road >= 0 else (0.0, 0.0)
            for start in np.arange(first, last, self.settings.stretch):
                check_cancelled()
                points = self.survey.window(road, start, min(start + self.settings.stretch, last))
                x, y = points.x, points.y
                low = np.abs(points.z - self._ground.at(road, points.s, points.d)[0]) < self.settings.ground if len(points) else np.zeros(0, bool)
                inside = self._paint.owner(x, y, low)
                for number, owner in enumerate((inside, around.owner(x, y, low & (inside < 0)))):
                    rows = np.flatnonzero(owner >= 0)
                    np.add.at(counts[number], (owner[rows], _steps_of(points.intensity[rows])), 1)
        paint, asphalt = ((of.cumsum(axis=1) < share * of.sum(axis=1, keepdims=True)).sum(axis=1)
                          for of, share in zip(counts, (self.settings.paint_share, 0.5)))
        return np.where(paint - asphalt < self.settings.contrast, 0, asphalt + self.settings.paint_from * (paint - asphalt))

    def _classes(self, x, y, z, h, brightness):
        """Classes of points `h` metres above the ground, NaN where it is not known; a later class overrules an earlier one."""
        chosen, classes = self.settings, np.zeros(len(x), np.uint8)
        low = np.abs(h) < chosen.ground
        deep = h < -chosen.noise
        classes[low] = PointClass.GROUND
        within = self._surface.owner(x, y, low | deep) >= 0
        classes[within & low] = PointClass.ROAD_SURFACE
        classes[within & deep] = PointClass.LOW_NOISE
        rows, near, rise, _ = self._edges.of(x, y, z, ~(np.abs(h) > 1.0), chosen.curb)
        height = self._edges.column("height_m")[near]
        begins = np.maximum(chosen.curb_share * height, chosen.curb_rise)
        classes[rows[(rise > begins) & (rise < height + chosen.slack)]] = PointClass.CURB
        marking = self._paint.owner(x, y, low & (classes != PointClass.CURB))
        painted = np.flatnonzero(marking >= 0)
        classes[painted[brightness[painted] >= self._paint_from[marking[painted]]]] = PointClass.PAINT
        # layers overrule ground: of a rail far away, whose ground is hidden, the lowest points pass for it
        beside = ~within & ~np.isin(classes, (PointClass.CURB, PointClass.PAINT))
        wide = np.where(self._lines.words("hedge"), chosen.hedge, 1.0)
        self._mark_things(classes, x, y, z, beside, self._lines, wide * chosen.beside)
        self._mark_things(classes, x, y, z, beside, self._objects, 0.5 * (np.nan_to_num(self._objects.column("diam_m")) + chosen.beside))
        return classes

    def _mark_things(self, classes, x, y, z, which, things, reach):
        """Mark points on lines or about shafts, `reach` metres (R,) from each; what grows is vegetation by its height above the ground."""
        chosen = self.settings
        rows, near, rise, away = things.of(x, y, z, which, max(reach.max(initial=0.0), chosen.panel[0]))
        panel = things.words("sign")[near] & (rise > chosen.panel[1]) & (away < chosen.panel[0])
        on_it = ((away < reach[near]) | panel) & (rise > chosen.ground) & (rise < things.column("height_m")[near] + chosen.slack)
        rows, near, rise = rows[on_it], near[on_it], rise[on_it]
        for kind in ("guard_rail", "barrier", "wall", "fence", "pole", "sign"):
            classes[rows[things.words(kind)[near]]] = PointClass[kind.upper()]
        grows = (things.words("hedge") | things.words("trunk"))[near]
        classes[rows[grows]] = PointClass.LOW_VEGETATION + np.searchsorted(chosen.vegetation, rise[grows]).astype(np.uint8)


def _steps_of(intensity):
    """(N,) intensities of 16 bits in sixteenths of a doubling, 0 to 256: paint is so many times as bright as asphalt, whatever the scanner."""
    return np.floor(16 * np.log2(np.asarray(intensity, np.float32) + 1)).astype(np.int64)


def _curbs_of(edges):
    """The road edges that are curbs: edges of a pavement have no height."""
    if edges is None:
        return None
    kept = [k for k, row in enumerate(edges.rows) if row.get("edge") != "pavement" and (row.get("height_m") or 0.0) > 0.0]
    return Features(edges.geometry_type, edges.schema, [edges.geometries[k] for k in kept], [edges.rows[k] for k in kept], edges.crs)


class _Ground:
    """Height of the ground below points, without cars and other narrow things on it, and level of the road; local z, m."""

    def __init__(self, survey: Survey, settings: CloudSettings):
        self.survey, self.settings, self.measured = survey, settings, MeasuredGround(survey)
        self._windows = {number: windows_of(survey, number) for number in survey.store.roads() if number >= 0}

    def at(self, road: int, s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The ground below (N,) places, NaN where none was measured near, and the level of the road at their stations."""
        # so far beyond the points that nothing narrow is seen in part
        beyond = 2 * self.settings.object_width[0]
        cells = self._cells(road, s.min() - beyond, s.max() + beyond)
        if cells is None:
            return np.full(len(s), np.nan), self.survey.road_height(road, s)
        stations, offsets = cells.stations, cells.offsets
        prior = self.survey.road_height(road, stations)
        height, known = self._without_objects(cells.height - prior[:, None], cells.row_size, cells.column_size)
        places = (s - stations[0]) / cells.row_size, (d - offsets[0]) / cells.column_size
        ground = map_coordinates(height, places, order=1, mode="nearest")
        row, column = (np.rint(at).astype(int) for at in places)
        inside = (row >= 0) & (row < len(height)) & (column >= 0) & (column < height.shape[1])
        base = self.survey.road_height(road, s)
        ground = np.where(inside & known[row * inside, column * inside], ground + base, np.nan)
        level = np.median(height[:, np.abs(offsets) <= self.settings.level], axis=1)
        return ground, base + np.interp(s, stations, level)

    def _cells(self, road, first, last):
        """GroundCells between two stations; None where nothing was measured."""
        rows = [row for row in self._windows.get(road, ()) if (row + SURFACE.window_rows) * SURFACE.row_length > first
                and row * SURFACE.row_length < last]
        cells = self.measured.windows(road, rows, [False] * len(rows))[0] if rows else None
        return None if cells is None or not np.isfinite(cells.height).any() else cells

    def _without_objects(self, height, row_size, column_size):
        """Heights of all cells, of the nearest ground where a cell has none, and whether that is near enough."""
        sampling, chosen = (row_size, column_size), self.settings
        seen, size = np.isfinite(height), [2 * round(metres / step / 2) + 1 for metres, step in zip(chosen.object_width, sampling)]
        # an opening by seen cells alone: in the shadow of a wall its height would go on
        lowest = np.where(seen, grey_erosion(np.where(seen, height, np.inf), size=size, mode="nearest"), -np.inf)
        bare = seen & (height - grey_dilation(lowest, size=size, mode="nearest") < chosen.object_height)
        if not bare.any():
            return height, bare
        away, nearest = distance_transform_edt(~bare, sampling=sampling, return_indices=True)
        return height[tuple(nearest)], away <= chosen.reach


class Areas:
    """Polygons of a layer, of which many points are asked whether they lie inside. origin : map coordinates of the local ones"""

    def __init__(self, layer: Features | None, origin: np.ndarray, wider: float = 0.0):
        shapes = [] if layer is None else [shapely.force_2d(shape) for shape in layer.geometries if shape is not None]
        self._shapes = shapely.transform(np.array(shapes, object), lambda places: places - origin[:2])
        self._shapes = shapely.buffer(self._shapes, wider) if wider else self._shapes
        shapely.prepare(self._shapes)
        self._tree = shapely.STRtree(self._shapes)

    def __len__(self) -> int:
        return len(self._shapes)

    def owner(self, x: np.ndarray, y: np.ndarray, which: np.ndarray) -> np.ndarray:
        """(N,) int: the polygon in which each of the points `which`, (N,) bool, lies, -1 for none. Local coordinates in metres."""
        inside, rows = np.full(len(x), -1), np.flatnonzero(which)
        if not len(rows) or not len(self._shapes):
            return inside
        low, high = (np.array([end(x[rows]), end(y[rows])]) for end in (np.min, np.max))
        main = int(np.argmax(high - low))   # along this axis a polygon meets the fewest points
        rows = rows[np.argsort((x, y)[main][rows])]
        x, y = x[rows], y[rows]
        along = (x, y)[main]
        for number in self._tree.query(shapely.box(*low, *high)).tolist():
            shape = self._shapes[number]
            first, last = np.searchsorted(along, [shape.bounds[main], shape.bounds[main + 2]])
            span = slice(first, last + 1)
            inside[rows[span][shapely.contains_xy(shape, x[span], y[span])]] = number
        return inside


class _Near:
    """Lines or points of a layer as close vertices, to find what points lie near."""

    def __init__(self, layer: Features | None, frame: RoadFrame, spacing: float):
        self._rows: Sequence[dict[str, Any]] = [] if layer is None else layer.rows
        shapes = np.array([] if layer is None else layer.geometries, object)
        places, self._owner = shapely.get_coordinates(shapely.segmentize(shapes, spacing), include_z=True, return_index=True)
        places = places.reshape(-1, 3) - frame.origin
        self._z, self._tree = places[:, 2], cKDTree(places[:, :2]) if len(places) else None

    def column(self, name: str) -> np.ndarray:
        """The numbers of a field, (R,) by row of the layer; NaN where there is none."""
        return np.array([np.nan if row.get(name) is None else row[name] for row in self._rows], float)

    def words(self, kind: str) -> np.ndarray:
        """(R,) bool: which rows are of a kind."""
        return np.array([row.get("kind") == kind for row in self._rows], bool)

    def of(self, x: np.ndarray, y: np.ndarray, z: np.ndarray, which: np.ndarray, reach: float) -> tuple[np.ndarray, ...]:
        """Of the points `which` those within `reach` metres: their indices, the row that is nearest, metres above it and metres away."""
        rows = np.flatnonzero(which)
        if self._tree is None or not len(rows):
            return np.empty(0, int), np.empty(0, int), np.empty(0), np.empty(0)
        away, vertex = self._tree.query(np.c_[x[rows], y[rows]], distance_upper_bound=reach)
        near = np.flatnonzero(np.isfinite(away))
        rows, vertex = rows[near], vertex[near]
        return rows, self._owner[vertex], z[rows] - self._z[vertex], away[near]
