"""The surface of a survey's roads: breaklines and triangulation, as layers and as a raster of heights."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ...core.common.errors import RoadExtractionError
from ...core.common.features import BREAKLINES, SURFACE_FACES, Features
from ...core.common.progress import Progress
from ...core.common.setting import Limited, setting
from ...core.countries.catalogue import NEUTRAL
from ...core.io.crs import as_in_file
from ...core.io.geotiff import GEOTIFF_TILE, NODATA, new_geotiff
from ...core.survey.survey import Survey
from ..inventory.borders import BorderLayers, RoadBorders
from ..inventory.surface_grid import CROSS_CELL, ROAD_REACH, SLICE_LENGTH
from .breaklines import KINDS, Breakline, lines_to_follow, road_breaklines
from .ground import READ_SLICES, road_ground
from .triangulation import Triangulation, thinned

APART = 0.10            # m by which two breaklines that the triangulation follows are apart at least; an edge's foot and top are nearer
PLAN_TOLERANCE = 0.01   # m in plan by which a breakline may be missed by the edges of the triangulation


@dataclass(frozen=True)
class SurfaceSettings(Limited):
    """How closely the ground is followed, and how far."""

    tolerance: float = setting(0.005, 0.001, 0.2, "The tolerance", "m")   # m, root mean square of what the triangulation misses of the road
    reach: float = setting(2.0, 0.5, 20.0, "The ground beside the road", "m")   # m beyond the edges of the carriageway
    max_gap: float = setting(10.0, 1.0, 100.0, "The gap", "m")   # m along a road over which ground that was not seen is bridged
    cell_size: float = setting(0.25, 0.05, 10.0, "The cell size", "m")   # m, of the raster of heights


@dataclass
class SurfaceModel:
    """The surface; coordinates are local: map coordinates less the origin."""

    surface: Triangulation
    lines: list[Breakline]   # by road and kind
    followed: list[tuple[str, np.ndarray]]   # (kind, (N, 3) m) of the stretches of lines that are edges of the triangulation
    origin: np.ndarray   # (3,)
    crs: str   # WKT, metric, "" where unknown
    rmse: float   # m, of the cells of the carriageway against the triangulation
    points: int   # points of the ground
    cells: np.ndarray   # (C, 3) m, the ground that the triangulation was made for
    notes: list[str] = field(default_factory=list)

    @property
    def places(self) -> np.ndarray:
        """(V, 3) m, vertices in map coordinates."""
        return self.surface.vertices + self.origin

    @property
    def vertices(self) -> int:
        """Number of vertices that are corners of a triangle."""
        return len(np.unique(self.surface.faces))


def make_surface_model(survey: Survey, layers: BorderLayers, settings: SurfaceSettings = SurfaceSettings(),
                       progress: Progress = Progress()) -> SurfaceModel:
    """Make the surface of all roads of a survey.

    layers : BorderLayers, of which the edges must be given
    Raises RoadExtractionError if the edges lie on no road of the survey, or no ground was seen about them
    """
    borders = RoadBorders(layers, survey.frame, NEUTRAL)
    roads, grounds, lines, without = survey.store.roads(), [], [], []
    edges, lane_borders = lines_to_follow(layers, survey.frame)
    for k, road in enumerate(roads):
        ground = road_ground(survey, road, borders, settings.reach, progress.part(0.4 * k / len(roads), 0.4 * (k + 1) / len(roads)))
        if ground is not None and np.isfinite(ground.z).any():
            grounds.append(ground)
        else:
            without.append(str(road))
    _part_roads(grounds, survey)
    outlines = {ground.road: ground.outline(survey.frame, settings.max_gap) for ground in grounds}
    covered, crossed = _covered(grounds, outlines, survey)
    for k, ground in enumerate(grounds):
        part = progress.part(0.4 + 0.2 * k / len(grounds), 0.4 + 0.2 * (k + 1) / len(grounds))
        lines += road_breaklines(survey, ground, edges, lane_borders, part)
    area = shapely.union_all([outlines[road].difference(covered[road]) for road in outlines])
    # what two roads see meets without a seam
    area = area.buffer(SLICE_LENGTH).buffer(-SLICE_LENGTH).simplify(APART)
    if area.is_empty:
        raise RoadExtractionError("No ground was seen between two road edges: the surface needs one on either side of a driven road. Choose the "
                                  "edges of this survey, and lanes or marking lines where an edge was not found.")
    lines = sorted(lines, key=lambda line: (line.road, KINDS.index(line.kind), line.station))
    followed = _followed(lines, covered, area.buffer(-APART), settings.tolerance)
    cells, judged = _cells(grounds, survey.frame, followed, area)
    fixed, segments = _fixed(followed, area, cells, settings.tolerance)
    surface = thinned(cells, judged, fixed, segments, area, settings.tolerance, progress.part(0.6, 1.0))
    miss = surface.heights(*cells[judged, :2].T) - cells[judged, 2]
    rmse = float(np.sqrt(np.nanmean(miss**2))) if np.isfinite(miss).any() else 0.0
    model = SurfaceModel(surface, lines, followed, survey.frame.origin, survey.crs, rmse, sum(ground.points for ground in grounds), cells)
    if without:
        model.notes.append(f"Roads without a surface: {', '.join(without)}. "
                           "No ground was seen there between two road edges, one on either side.")
    if crossed:
        model.notes.append(f"Roads that cross one above the other: {', '.join(crossed)}. The surface has the upper one alone there.")
    if rmse > settings.tolerance:
        model.notes.append(f"The surface misses the ground by {1000 * rmse:.1f} mm (root mean square), more than the tolerance of "
                           f"{1000 * settings.tolerance:g} mm: the ground is rougher than that. A greater tolerance gives fewer triangles.")
    return model


def _part_roads(grounds, survey):
    """Take from each ground the cells that lie nearer to another road of about their height, where that road's ground was seen."""
    seen, nearer = [np.isfinite(ground.z).astype(float) for ground in grounds], []
    for ground in grounds:
        i, j = np.nonzero(np.isfinite(ground.z))
        nearest, s, d = survey.frame.locate_nearest(*survey.frame.road(ground.road).to_map(ground.s[i], ground.d[j]))
        for other, known in zip(grounds, seen):
            rows = np.flatnonzero((nearest == other.road) & (other.road != ground.road))
            rows = rows[other.at(s[rows], d[rows], known) > 0.0]
            rows = rows[np.abs(survey.road_height(other.road, s[rows]) - ground.z[i[rows], j[rows]]) < ROAD_REACH]
            nearer.append((ground, i[rows], j[rows]))
    for ground, i, j in nearer:
        ground.z[i, j] = np.nan


def _covered(grounds, outlines, survey):
    """({road: where another one lies above it}, which ones do, as text); the ground there is taken away."""
    covered, crossed = {road: shapely.Polygon() for road in outlines}, []
    for one, other in combinations(grounds, 2):
        for overlap in shapely.get_parts(outlines[one.road].intersection(outlines[other.road])):
            place = shapely.get_coordinates(overlap.centroid).T
            low, high = sorted((float(survey.road_height(ground.road, survey.frame.road(ground.road).locate(*place)[0])[0]), ground.road)
                               for ground in (one, other))
            if high[0] - low[0] > ROAD_REACH:
                lower = one if one.road == low[1] else other
                # farther than what is joined without a seam
                covered[lower.road] = covered[lower.road].union(overlap.buffer(3 * SLICE_LENGTH))
                i, j = np.nonzero(np.isfinite(lower.z))
                inside = shapely.contains_xy(covered[lower.road], *lower.cells(survey.frame)[:, :2].T)
                lower.z[i[inside], j[inside]] = np.nan
                crossed.append(f"{one.road} and {other.road}")
    return covered, sorted(set(crossed))


def _followed(lines, covered, inside, tolerance):
    """[(kind, (N, 3) places)] of the stretches of lines that lie inside of an area, under no other road and apart from those of more weight,
    with the vertices they need."""
    order = sorted(range(len(lines)), key=lambda k: KINDS.index(lines[k].kind))
    shapes = np.array([shapely.linestrings(lines[k].places[:, :2]) for k in order], object)
    rank = np.arange(len(shapes))
    one, other = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=APART) if len(shapes) else (rank, rank)
    stretches = []
    for row, k in enumerate(order):
        line, shape = lines[k], shapes[row]
        stronger = other[(one == row) & (other < row)]
        gaps = [CROSS_CELL / 4 if (line.kind, lines[order[j]].kind) == ("edge_top", "edge_bottom") else APART for j in stronger]
        free = shape.intersection(inside).difference(covered[line.road]).difference(shapely.union_all(shapely.buffer(shapes[stronger], gaps)))
        along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line.places[:, :2], axis=0).T))]
        for part in shapely.get_parts(free):
            if part.geom_type == "LineString" and part.length > 2 * APART:
                xy = shapely.get_coordinates(part)
                at = shapely.line_locate_point(shape, shapely.points(xy))
                stretches.append((line.kind, _needed(xy, at, np.interp(at, along, line.places[:, 2]), tolerance)))
    return stretches


def _needed(xy, along, z, tolerance):
    """(N, 3) the fewest vertices of a line that keep to it in plan and height."""
    plan = shapely.get_coordinates(shapely.simplify(shapely.linestrings(xy), PLAN_TOLERANCE))
    height = shapely.get_coordinates(shapely.simplify(shapely.linestrings(along, z), tolerance))[:, 0]
    kept = np.isin(xy[:, 0] + 1j * xy[:, 1], plan[:, 0] + 1j * plan[:, 1]) | np.isin(along, height)
    kept[::READ_SLICES] = True   # an edge of half a kilometre would cross many triangles
    return np.c_[xy, z][kept]


def _cells(grounds, frame, followed, area):
    """((C, 3) cells of the ground that lie on one side of every edge, (C,) whether on the carriageway)."""
    edges = np.array([shapely.linestrings(places[:, :2]) for kind, places in followed if kind.startswith("edge")], object)
    tree = shapely.STRtree(edges)
    kept, judged = [], []
    for ground in grounds:
        i, j = np.nonzero(np.isfinite(ground.z))
        cells, road = ground.cells(frame), frame.road(ground.road)
        # places on the edges half a slice apart at most
        along = shapely.get_coordinates(shapely.segmentize(edges, SLICE_LENGTH / 2))
        near = cKDTree(along).query(cells[:, :2], distance_upper_bound=SLICE_LENGTH)[0] if len(edges) else np.full(len(cells), np.inf)
        rows = np.flatnonzero(np.isfinite(near))
        ends = [np.stack(road.to_map(ground.s[i[rows]] + way * SLICE_LENGTH / 2, ground.d[j[rows]]), axis=1) for way in (-1, 1)]
        mixed = np.zeros(len(cells), bool)
        mixed[rows[tree.query(shapely.linestrings(np.stack(ends, axis=1)), predicate="dwithin", distance=CROSS_CELL)[0]]] = True
        mixed |= ~shapely.contains_xy(area.buffer(APART), *cells[:, :2].T)
        kept.append(cells[~mixed])
        judged.append(((ground.d[j] > ground.right[i]) & (ground.d[j] < ground.left[i]))[~mixed])
    return np.concatenate(kept), np.concatenate(judged)


def _fixed(followed, area, cells, tolerance):
    """(vertices, segments) of the lines that are followed and of the outline, whose heights are those of the nearest cells."""
    tree, chains = cKDTree(cells[:, :2]), [places for _, places in followed]
    for ring in (ring for polygon in shapely.get_parts(area) for ring in (polygon.exterior, *polygon.interiors)):
        corners, xy = shapely.get_coordinates(ring), shapely.get_coordinates(shapely.segmentize(ring, APART))
        away, cell = tree.query(xy)
        # beside a road that climbs, what lies between two slices has the height of neither
        seen = (away < APART) | np.isin(xy[:, 0] + 1j * xy[:, 1], corners[:, 0] + 1j * corners[:, 1])
        xy, cell = xy[seen], cell[seen]
        along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(xy, axis=0).T))]
        chains.append(_needed(xy, along, cells[cell, 2], 2 * tolerance))
    start = np.append(0, np.cumsum([len(chain) for chain in chains]))
    segments = np.concatenate([np.stack([np.arange(a, b - 1), np.arange(a + 1, b)], axis=1) for a, b in zip(start[:-1], start[1:])])
    places = np.concatenate(chains)
    _, first, number = np.unique(np.round(places[:, :2], 4), axis=0, return_index=True, return_inverse=True)
    segments = np.unique(np.sort(number.ravel()[segments], axis=1), axis=0)
    return places[first], segments[segments[:, 0] != segments[:, 1]]


# The surface as layers, and as a raster.

def surface_to_features(model: SurfaceModel) -> tuple[Features, Features]:
    """The layers BREAKLINES and TIN, in map coordinates."""
    lines, faces = Features("LineStringZ", list(BREAKLINES), crs=model.crs), Features("PolygonZ", list(SURFACE_FACES), crs=model.crs)
    for line in model.lines:
        shape = shapely.linestrings(line.places + model.origin)
        lines.add(shape, road=line.road, kind=line.kind, station_m=line.station[0], end_m=line.station[1], sigma_z_m=line.sigma,
                  height_m=None if np.isnan(line.step) else line.step, length_m=shape.length)
    corners = model.surface.vertices[model.surface.faces]
    away = cKDTree(model.cells[:, :2]).query(corners.mean(axis=1)[:, :2])[0]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    slope = np.hypot(normal[:, 0], normal[:, 1]) / np.maximum(normal[:, 2], 1e-9)
    for shape, far, steep, double in zip(shapely.polygons(model.places[model.surface.faces]), away, slope, normal[:, 2]):
        faces.add(shape, status="bridged" if far > SLICE_LENGTH else "measured", slope_pct=100 * steep, area_m2=0.5 * double)
    return lines, faces


def write_heights(model: SurfaceModel, path: str | os.PathLike[str], cell_size: float, progress: Progress = Progress()) -> None:
    """Write the heights of the surface as a GeoTIFF with cells of a size in m; heights have the unit of the survey's own CRS."""
    used = model.surface.vertices[np.unique(model.surface.faces)]
    left, bottom = np.floor((used[:, :2].min(axis=0) + model.origin[:2]) / cell_size) * cell_size
    right, top = np.ceil((used[:, :2].max(axis=0) + model.origin[:2]) / cell_size) * cell_size
    width, height = (max(int(round(side / cell_size)), 1) for side in (right - left, top - bottom))
    up, faces = as_in_file(model.crs)[1].up, shapely.STRtree(shapely.polygons(model.surface.vertices[model.surface.faces][:, :, :2]))
    tiles = [(column, row) for row in range(0, height, GEOTIFF_TILE) for column in range(0, width, GEOTIFF_TILE)]
    with new_geotiff(path, width, height, (left, cell_size, 0.0, top, 0.0, -cell_size), model.crs) as image:
        for k, (column, row) in enumerate(tiles):
            wide, high = min(GEOTIFF_TILE, width - column), min(GEOTIFF_TILE, height - row)
            x = left + (column + np.arange(wide) + 0.5) * cell_size - model.origin[0]
            y = top - (row + np.arange(high) + 0.5) * cell_size - model.origin[1]
            if len(faces.query(shapely.box(x[0], y[-1], x[-1], y[0]))):
                z = model.surface.heights(*(values.ravel() for values in np.meshgrid(x, y))) + model.origin[2]
                image.write(column, row, np.where(np.isfinite(z), z / up, NODATA).reshape(high, wide))
            progress.report((k + 1) / len(tiles))
