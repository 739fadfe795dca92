"""What was read of a map, as layers like ours, with its CRS, and how far they lie from those that it was made from."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ...core.common.errors import RoadExtractionError
from ...core.common.features import DRIVING_LINES, MARKING_LINES, ROAD_EDGES, Features
from ...core.driving.layers import Lanes
from ...core.io.crs import check_metric, horizontal_part, parse_crs, plane_wkt, same_crs

STATUS_OF_MAPS = "measured"


@dataclass
class MapLine:
    """A border or a line between borders in the file: a painted line, an edge, or neither."""

    road: int   # number
    what: str   # marking or edge
    kind: str   # edge, lane, centre, curb, dropped or pavement
    pattern: str   # as in MARKING_LINES
    points: np.ndarray   # (N, 3) map coordinates
    width: float = np.nan   # metres, NaN where unknown
    side: str = ""   # left, right or ""
    edge: str = "curb"   # what an edge is, curb or pavement
    height: float = np.nan   # metres of a curb, NaN where unknown


@dataclass
class MapLayers:
    """Lanes and lines of a map in one CRS."""

    lanes: Lanes   # Lanes in map coordinates
    lines: list[MapLine] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)   # sentences for the user

    def lane_areas(self) -> Features:
        """The layer LANES."""
        return self.lanes.to_features()

    def driving_lines(self) -> Features:
        """The middles of driven lanes, as DRIVING_LINES."""
        layer, lanes, widths = Features("LineStringZ", DRIVING_LINES, crs=self.lanes.crs), self.lanes, self.lanes.width
        for k in range(len(lanes)):
            if lanes.type[k] not in ("driving", "connector"):
                continue
            left, right = lanes.borders(k)
            middle = without_repeats((left + right) / 2)
            if len(middle) < 2:
                continue
            layer.add(shapely.linestrings(middle), road=lanes.road[k], lane=lanes.lane[k], kind="lane", direction=lanes.direction[k],
                      pattern=f"{lanes.left_pattern[k] or 'none'}|{lanes.right_pattern[k] or 'none'}", source="pair", status=lanes.status[k],
                      station_m=lanes.station[k], end_m=lanes.end[k], length_m=plan_length(middle), width_m=widths[k])
        return layer

    def marking_lines(self) -> Features:
        """Painted borders, as MARKING_LINES."""
        layer = Features("LineStringZ", MARKING_LINES, crs=self.lanes.crs)
        for number, line in enumerate((line for line in self.lines if line.what == "marking"), start=1):
            layer.add(shapely.linestrings(line.points), road=line.road, line=number, kind=line.kind, pattern=line.pattern, status=STATUS_OF_MAPS,
                      station_m=0.0, end_m=plan_length(line.points), length_m=plan_length(line.points), width_m=line.width)
        return layer

    def road_edges(self) -> Features:
        """Curbs and the outer borders of what is driven on, as ROAD_EDGES."""
        layer = Features("LineStringZ", ROAD_EDGES, crs=self.lanes.crs)
        for number, line in enumerate((line for line in self.lines if line.what == "edge"), start=1):
            layer.add(shapely.linestrings(line.points), road=line.road, side=line.side or None, status=STATUS_OF_MAPS, station_m=0.0,
                      end_m=plan_length(line.points), part="bottom", length_m=plan_length(line.points), kind="main", edge=line.edge, chain=number,
                      height_m=line.height)
        return layer


def plan_length(points: np.ndarray) -> float:
    """Metres in plan along (N, 3) points."""
    return float(np.hypot(*np.diff(points[:, :2], axis=0).T).sum())


def without_repeats(points: np.ndarray, nearest: float = 1e-4) -> np.ndarray:
    """The points of a line without those that lie within a tenth of a millimetre of the one before."""
    keep = np.append(True, np.hypot(*np.diff(points[:, :2], axis=0).T) > nearest)
    return points[keep]


# The CRS of a map from elsewhere.

LOCAL_CRS = "+proj=tmerc +lat_0=0 +lon_0=0 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs"   # of maps that lie nowhere


def crs_of_reference(text: str, given: str) -> tuple[str, str]:
    """(WKT, "" where unknown; a sentence for the user or "") of an OpenDRIVE file with a geoReference (PROJ, WKT, EPSG:n or "").

    A CRS that the user gave, not "", overrules it; RoadExtractionError if that is none in metres.
    """
    if given:
        return metric_wkt(given, "The chosen CRS"), ""
    if not text:
        return "", ("The file has no geoReference: its coordinates were taken as they are and the layers have no CRS. "
                    "Where you know it, give it by the parameter CRS.")
    try:
        return metric_wkt(text, "The map"), ""
    except RoadExtractionError as problem:
        return "", (f"The geoReference of the file cannot be used ({problem}) The layers have no CRS; where you know it, give it by the "
                    "parameter CRS.")


def reference_of_crs(wkt: str) -> str:
    """The text of geoReference for a CRS: PROJ where that says the same, else WKT; "" where unknown."""
    import warnings

    crs = horizontal_part(parse_crs(wkt))
    if crs is None:
        return ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")   # pyproj warns that PROJ texts may lose something: what they lose is looked at here
        text = crs.to_proj4()
        same = bool(text) and same_crs(parse_crs(text), crs)
    return text if same else str(crs.to_wkt())


def metric_wkt(text: str, what: str) -> str:
    """WKT of the horizontal part of a CRS given as a text; refuses one that is not in metres. `what`: subject of the message."""
    crs = parse_crs(text)
    check_metric(crs, what)
    return plane_wkt(text)


def utm_of(longitude: float, latitude: float) -> str:
    """WKT of the UTM zone (WGS 84) of a place in degrees."""
    zone = int(np.clip((longitude + 180) // 6 + 1, 1, 60))
    return metric_wkt(f"EPSG:{(32600 if latitude >= 0 else 32700) + zone}", "The map")


# How well an exported map keeps what it was made from.

NEAR_MIDDLE = 1.0     # m from the middle of a lane within which a driving line is held against it
LEFT_OUT_NEAR = 0.5   # m between a driving line and a place that is left out: lanes have vertices twice as near
SAME_BORDER = 0.05    # m across within which heights are compared
LEAST_CHORD = 1.0     # m of a border's end, along which it goes straight on
BEYOND_END = 10.0     # m: a road of four lanes whose end is cut oblique by 30 degrees


class Misses(NamedTuple):
    """Metres: mean, 95th percentile, largest; at how many places; and the (3,) place of the largest."""

    mean: float
    p95: float
    largest: float
    places: int
    worst: np.ndarray


def border_misses(source: Lanes, exported: Lanes) -> tuple[Misses, Misses]:
    """(across, in height) of the source's border vertices from the borders that are read back, and of theirs from the source's.

    What lies beyond the end of a border of the source is left out: an export ends lanes square to the road.
    """
    source_borders, exported_borders = ([border for k in range(len(lanes)) for border in lanes.borders(k)] for lanes in (source, exported))
    ends = [end for border in _once(source_borders)[0] for end in (_gone_on(border), _gone_on(border[::-1]))]
    misses_of_source = _distances(source_borders, _segments(exported_borders))
    misses_of_exported = _distances(exported_borders, _segments(source_borders, True), apart_from=_segments(ends))
    across, rise, places = (np.concatenate(misses) for misses in zip(misses_of_source, misses_of_exported))
    return _summary(across, places), _summary(rise, places)


def _joined(lines):
    return np.concatenate([np.empty((0, 3)), *lines])


def _once(lines):
    """(the lines without those that repeat another, forth or back, as neighbours do with the border between them; the number of each in them)."""
    first = {min(line.tobytes(), line[::-1].tobytes()): line for line in lines}
    numbers = {key: number for number, key in enumerate(first)}
    return list(first.values()), [numbers[min(line.tobytes(), line[::-1].tobytes())] for line in lines]


def _segments(lines, curved=False):
    """(M, 7) both ends of every segment of lines, and by how much it misses the curve that bends like the lines at its ends, if `curved`."""
    lines, _ = _once(lines)
    places, line = _joined(lines), np.repeat(np.arange(len(lines)), [len(border) for border in lines])
    way, same = np.diff(places[:, :2], axis=0), line[1:] == line[:-1]
    turn = np.abs((np.diff(np.arctan2(way[:, 1], way[:, 0])) + np.pi) % (2 * np.pi) - np.pi)
    turn = np.concatenate([[np.nan], np.where(same[1:] & same[:-1], turn, np.nan), [np.nan]])
    bow = np.nan_to_num(np.fmin(turn[:len(way)], turn[1:len(way) + 1])) * np.hypot(*way.T) / 8 * curved
    return np.c_[places[:-1], places[1:], bow][same]


def _gone_on(line):
    """(2, 3) from the start of a line straight on beyond it."""
    offsets = line - line[0]
    far = np.hypot(*offsets.T[:2]) > LEAST_CHORD
    way = offsets[np.argmax(far) if far.any() else -1]
    return np.stack([line[0], line[0] - way * BEYOND_END / max(float(np.hypot(*way[:2])), 1e-9)])


def driving_line_misses(driving_lines: Features | None, exported: Lanes, measured_only: bool = True,
                        apart_from: np.ndarray | None = None) -> Misses:
    """Across, of driving lines against the middles of the lanes that are read back.

    apart_from : (N, 2) places; what lies within LEFT_OUT_NEAR of one is left out
    """
    middles = [sum(exported.borders(k)) / 2 for k in np.flatnonzero(np.isin(exported.type, ("driving", "connector")))]
    rows = [shapely.get_coordinates(geometry, include_z=True) for geometry, row in driving_lines or ()
            if geometry is not None and (not measured_only or row.get("status") in (None, "measured"))]
    places = np.concatenate([np.empty((0, 3)), *rows])
    if apart_from is not None and len(apart_from) and len(places):
        places = places[cKDTree(apart_from).query(places[:, :2])[0] > LEFT_OUT_NEAR]
    if not len(places) or not middles:
        return _summary(np.empty(0), places)
    across, _, places = _distances([places], _segments(middles), NEAR_MIDDLE)
    return _summary(across, places)


def _distances(lines, segments, farthest=np.inf, apart_from=np.empty((0, 7))):
    """((N,) metres across, (N,) in height, (N, 3) places) of lines from (M, 7) segments, of places from which none lies nearer than `farthest`
    metres infinite.

    apart_from : (K, 7) segments; places to which one of them is nearer are infinite too
    """
    lines, index = _once(lines)
    places, begin = _joined(lines), np.cumsum([0, *map(len, lines)])
    all_segments = np.concatenate([segments, apart_from])
    points, tree = shapely.points(places[:, :2]), shapely.STRtree(shapely.linestrings(all_segments[:, :6].reshape(-1, 2, 3)[:, :, :2]))
    indices, near = tree.query(points, predicate="dwithin", distance=SAME_BORDER)
    first, last = all_segments[near, :3], all_segments[near, 3:6]
    run = (last - first)[:, :2]
    share = np.clip(((places[indices, :2] - first[:, :2]) * run).sum(1) / np.maximum((run**2).sum(1), 1e-12), 0.0, 1.0)
    distance, counted = np.hypot(*(places[indices] - first - share[:, None] * (last - first)).T[:2]), near < len(segments)
    across = _least(len(places), indices[counted], distance[counted] - segments[near[counted], 6])
    left_out = _least(len(places), indices[~counted], distance[~counted])
    far = np.flatnonzero(np.isinf(across) & np.isinf(left_out))   # the nearest of all segments is looked for only where none lies near
    across[left_out < across] = np.inf
    pairs, distance = tree.query_nearest(points[far], max_distance=None if np.isinf(farthest) else farthest, return_distance=True, all_matches=False)
    nearest = pairs[1] < len(segments)
    across[far[pairs[0, nearest]]] = distance[nearest] - segments[pairs[1, nearest], 6]
    # where borders of several roads lie on each other, the one at the place's own height is its own
    rise = _least(len(places), indices[counted], np.abs(places[indices, 2] - first[:, 2] - share * (last - first)[:, 2])[counted])
    rise[np.isinf(across)] = np.inf
    rows = np.concatenate([np.arange(begin[number], begin[number + 1]) for number in index])
    return np.maximum(across, 0.0)[rows], rise[rows], places[rows]


def _least(count, indices, values):
    """(count,) the least of the values of each index, which rise; inf where there is none."""
    least, begin = np.full(count, np.inf), np.flatnonzero(np.diff(indices, prepend=-1))
    if len(begin):
        least[indices[begin]] = np.minimum.reduceat(values, begin)
    return least


def _summary(values, places):
    values, places = values[np.isfinite(values)], places[np.isfinite(values)]
    if not len(values):
        return Misses(np.nan, np.nan, np.nan, 0, np.full(3, np.nan))
    return Misses(float(values.mean()), float(np.percentile(values, 95)), float(values.max()), len(values), places[np.argmax(values)])
