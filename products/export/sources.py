"""The layers of a road map on their way into another format, checked; and what was read of a map, as layers like ours."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
import shapely
from scipy import ndimage
from scipy.spatial import cKDTree

from ...core.common.arrays import linked_groups, members_of
from ...core.common.errors import RoadExtractionError
from ...core.common.features import COLOUR, DRIVING_LINES, MARKINGS, ROAD_ATTRIBUTES, Features
from ...core.curves.line_segments import SegmentIndex, single_lines
from ...core.driving.layers import Lanes
from ...core.io.crs import check_metric, horizontal_part, parse_crs, plane_wkt, same_crs
from ...core.survey.store.road_points import RoadPoints

MOST_OVERLAP = 0.5       # share of a lane that may lie on lanes of another road: more is two roads at one place
SAME_LEVEL = 2.0         # m of height within which two roads are no bridge
FARTHEST_PLACE = 1e8     # m from the origin of a CRS: twice around the world
LEAST_LED = 0.001        # m
LEAST_CURB = 0.005       # m of height between the bottom and the top of a curb: less is none that a map states
FARTHEST_LAYER = 50.0    # m from the lanes: a layer that lies farther away is of another survey


@dataclass
class RoadMapSource:
    """Lanes with the other layers of their road map, of a survey or of a map from elsewhere.

    middles : (V, 3) of the lanes between their own stripes, vertex by vertex; None where they are the middles of the lanes
    attributes : lane_id -> what is known of ROAD_ATTRIBUTES
    """

    lanes: Lanes   # Lanes in map coordinates
    driving_lines: Features | None = None   # driving_lines, marking_lines, road_edges, markings: Features or None
    marking_lines: Features | None = None
    road_edges: Features | None = None
    markings: Features | None = None
    notes: list[str] = field(default_factory=list)   # sentences for the user
    gaps: np.ndarray | None = None   # (P, 2) metres between the two stripes at the left and right border of each lane, None or 0 where there is one
    middles: np.ndarray | None = None
    signals: Features | None = None
    attributes: dict[str, dict[str, Any]] = field(default_factory=dict)
    left_out: Counter[str] = field(default_factory=Counter)   # what the file of a map has beside all this, and how often

    @classmethod
    def of_map(cls, lanes: Lanes, marking_lines: Features, road_edges: Features, outlines: Iterable[tuple[str, np.ndarray]],
               **others: Any) -> RoadMapSource:
        """A map from elsewhere, not yet checked: driving lines are the middles of driven lanes, markings of (class, (N, 3) corners)."""
        middles, widths, areas = Features("LineStringZ", DRIVING_LINES, crs=lanes.crs), lanes.width, Features("PolygonZ", MARKINGS, crs=lanes.crs)
        for k in np.flatnonzero(np.isin(lanes.type.astype(str), ("driving", "connector"))):
            middle = without_repeats(sum(lanes.borders(k)) / 2)
            if len(middle) > 1:
                middles.add(shapely.linestrings(middle), road=lanes.road[k], lane=lanes.lane[k], kind="lane", direction=lanes.direction[k],
                            pattern=f"{lanes.left_pattern[k] or 'none'}|{lanes.right_pattern[k] or 'none'}", source="pair", status=lanes.status[k],
                            station_m=lanes.station[k], end_m=lanes.end[k], length_m=plan_length(middle), width_m=widths[k])
        for kind, corners in outlines:
            area = shapely.Polygon(corners)
            areas.add(area, **{"road": 1, "class": kind, "use": "keep", "area_m2": area.area})
        return cls(lanes, middles, marking_lines, road_edges, areas, **others)

    def said_left_out(self) -> list[str]:
        """A sentence on what the layers do not hold, none where they hold all."""
        named = ", ".join(f"{count} {what}" for what, count in sorted(self.left_out.items()))
        return [f"Not carried over: {named}."] if named else []

    def lane_areas(self) -> Features:
        """The layer LANES, with the fields of the roads."""
        layer = self.lanes.to_features()
        layer.schema += ROAD_ATTRIBUTES
        for name, row in zip(self.lanes.lane_id, layer.rows):
            row.update(self.attributes.get(name, {}))
        return layer

    def led_to_middles(self) -> np.ndarray:
        """(N, 2) places in the middle of lanes where a border was led along the middle of a double line, away from the lane's own stripe."""
        if self.middles is None:
            return np.empty((0, 2))
        moved = ((self.lanes.left + self.lanes.right) / 2 - self.middles)[:, :2]
        return self.middles[np.hypot(*moved.T) > LEAST_LED, :2]

    def paint_width(self, line: str) -> float:
        """Metres of the paint of a border, by the name of its line in Lanes; NaN where unknown."""
        widths = self._painted(line, "width_m")
        return float(np.median(widths)) if widths else np.nan

    def paint_colour(self, line: str) -> str:
        """"white" or "yellow", the colour of most pieces of a border, by the name of its line in Lanes; "" where unknown."""
        return next(iter(dict(Counter(self._painted(line, COLOUR.name)).most_common(1))), "")

    def _painted(self, line, name):
        """What the pieces of a marking line say in a field, where they say it."""
        rows = self.marking_lines.rows if self.marking_lines is not None and line.startswith("line ") else ()
        return [row[name] for row in rows if str(row.get("line")) == line[5:] and row.get(name) not in (None, "")]


def areas_of(lanes: Lanes, rows: Iterable[int]) -> np.ndarray:
    """(N,) valid polygons of lanes in plan."""
    rings = [np.concatenate([left, right[::-1]])[:, :2] for left, right in map(lanes.borders, rows)]
    return np.asarray(shapely.make_valid(np.array([shapely.Polygon(ring) for ring in rings], object)))


def is_stated(lanes: Lanes) -> bool:
    """Whether lanes are of a map from elsewhere, which states its borders and ways: all are sure, and none is of a line or edge of a survey."""
    lines = np.concatenate([lanes.left_line, lanes.right_line])
    return bool((lanes.status == "measured").all() and (lanes.confidence == 1).all() and (lines == "none").all())


def checked(source: RoadMapSource) -> RoadMapSource:
    """The same source without successors that are not there, proven fit for a map.

    Raises RoadExtractionError if there are no lanes, the CRS is not in metres, a lane has no width or borders that cross, heights are missing, two
    lanes have one id, two roads lie at one place, or a layer is of another survey.
    """
    lanes = source.lanes
    if not len(lanes):
        raise RoadExtractionError("The layer of lanes is empty. Run Driving lines or Road map where there are marking lines or road edges.")
    crs = parse_crs(lanes.crs)
    if crs is not None:
        check_metric(crs, "The layer of lanes")
    if not np.isfinite(lanes.left).all() or not np.isfinite(lanes.right).all():
        raise RoadExtractionError("Some lanes have no heights or broken coordinates. Use the layer of lanes that Lanewright wrote.")
    places = np.concatenate([lanes.left, lanes.right])
    if np.abs(places).max() > FARTHEST_PLACE:
        raise RoadExtractionError(f"The lanes reach to {np.abs(places).max():.3g} m from the origin of their CRS, which is not on this world. Choose "
                                  "the layer of lanes that Lanewright wrote, or set its CRS right.")
    if len(set(lanes.lane_id)) < len(lanes):
        name, count = Counter(lanes.lane_id.tolist()).most_common(1)[0]
        raise RoadExtractionError(f"Lane {name} is there {count} times: two roads of the map have one id, so that links to them are not clear. Give "
                                  "each road its own id where the map was made.")
    _check_shapes(lanes)
    if not is_stated(lanes):   # where a map from elsewhere has two roads at one place, it means both
        _check_places(lanes)
    _check_layers(source)
    return _linked(source)


def _linked(source):
    """The source without successors that are not there, with a note for each kind of them."""
    lanes = source.lanes
    lane_ids = set(lanes.lane_id)
    lost = sum(name not in lane_ids for names in lanes.successors for name in names)
    notes = list(source.notes)
    if lost:
        notes.append(f"{lost} successors name lanes that are not in the layer; these links were left out.")
    loops = sum(name in names for name, names in zip(lanes.lane_id, lanes.successors))
    if loops:
        notes.append(f"{loops} lanes name themselves as their successors; these links were left out.")
    kept = [tuple(name for name in names if name in lane_ids and name != own_name) for own_name, names in zip(lanes.lane_id, lanes.successors)]
    return replace(source, notes=notes, lanes=replace(lanes, successors=kept))


def _check_shapes(lanes):
    for k in range(len(lanes)):
        left, right = lanes.borders(k)
        width = float(np.hypot(*(left - right)[:, :2].T).max())
        if width < 0.01 or np.hypot(*np.diff(left[[0, -1]], axis=0)[0, :2]) + np.hypot(*np.diff(right[[0, -1]], axis=0)[0, :2]) < 0.01:
            raise RoadExtractionError(f"Lane {lanes.lane_id[k]} has no two borders: it is {width:.2f} m wide. Delete it, or draw it as a strip.")
        for border, side in ((left, "left"), (right, "right")):
            if (back := _runs_back(left, right, border)) is not None and not shapely.linestrings(border[:, :2]).is_simple:
                raise RoadExtractionError(f"The {side} border of lane {lanes.lane_id[k]} runs back and crosses itself near x {back[0]:.1f}, "
                                          f"y {back[1]:.1f}. Mend it in the layer of lanes.")
        if shapely.linestrings(left[:, :2]).crosses(shapely.linestrings(right[:, :2])):
            raise RoadExtractionError(f"The borders of lane {lanes.lane_id[k]} cross each other near x {left[0, 0]:.1f}, y {left[0, 1]:.1f}. "
                                      "Mend it in the layer of lanes.")


def _runs_back(left, right, border):
    """Where a border runs against the direction of its lane, None where it does nowhere. Ramps may well cross themselves."""
    across, step = (left - right)[:-1, :2] + (left - right)[1:, :2], np.diff(border[:, :2], axis=0)
    ahead = step[:, 0] * across[:, 1] - step[:, 1] * across[:, 0]
    back = np.flatnonzero((ahead < 0) & (np.hypot(*step.T) > LEAST_LED) & (np.hypot(*across.T) > LEAST_LED))
    return border[back[0]] if len(back) else None


def _check_places(lanes):
    """Refuse two roads at one place; connectors may cross, and bridges."""
    rows = np.flatnonzero(lanes.type == "driving")
    shapes, height = areas_of(lanes, rows), np.array([lanes.borders(k)[0][:, 2].mean() for k in rows])
    for first, second in shapely.STRtree(shapes).query(shapes, predicate="intersects").T:
        a, b = rows[first], rows[second]
        if first >= second or lanes.road[a] == lanes.road[b] or abs(height[first] - height[second]) > SAME_LEVEL:
            continue
        common, least = shapes[first].intersection(shapes[second]).area, min(shapes[first].area, shapes[second].area)
        if common > MOST_OVERLAP * least:
            raise RoadExtractionError(f"Roads {lanes.road[a]} and {lanes.road[b]} lie at one place: lanes {lanes.lane_id[a]} and "
                                      f"{lanes.lane_id[b]} share {common:.0f} m². Keep the lanes of one of them.")


def _check_layers(source):
    lanes = source.lanes
    low, high = lanes.left.min(0)[:2] - FARTHEST_LAYER, lanes.left.max(0)[:2] + FARTHEST_LAYER
    for label, layer in (("Driving lines", source.driving_lines), ("Marking lines", source.marking_lines), ("Road edges", source.road_edges),
                         ("Markings", source.markings), ("Signals and poles", source.signals)):
        if not layer:
            continue
        west, south, east, north = shapely.total_bounds(np.array([g for g in layer.geometries if g is not None], object))
        if west > high[0] or east < low[0] or south > high[1] or north < low[1]:
            raise RoadExtractionError(f"{label} do not lie where the lanes are: they begin at x {west:.0f}, y {south:.0f}, the lanes at "
                                      f"x {low[0] + FARTHEST_LAYER:.0f}, y {low[1] + FARTHEST_LAYER:.0f}. Choose the layers of one survey.")


def known_of_roads(areas: Features) -> dict[str, dict[str, Any]]:
    """lane_id -> what is known of ROAD_ATTRIBUTES, of the layer LANES with these fields."""
    return {str(row.get("lane_id")): known for row in areas.rows
            if (known := {one.name: row[one.name] for one in ROAD_ATTRIBUTES if row.get(one.name) not in (None, "")})}


def wrapped(angle: Any) -> Any:
    """Radians, a number or an array of them, in [-pi, pi)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


class NearestValues:
    """A number of the line of a layer that is nearest to a place; features without a value in the field `name` are left out."""

    def __init__(self, layer: Features | None, name: str) -> None:
        rows = [(g, float(row[name])) for g, row in layer or () if g is not None and row.get(name) is not None]
        lines, owner = single_lines([geometry for geometry, _ in rows])
        self._lines, self._values = SegmentIndex(lines), np.array([value for _, value in rows])[owner]

    def median(self, points: np.ndarray) -> float:
        """Of the numbers nearest to (N, 2) points within half a metre; NaN where there are none."""
        nearest = self._lines.nearest(points)
        near = nearest.line[nearest.distance <= 0.5]
        return float(np.median(self._values[near])) if len(near) else np.nan


# The uncertainty that driving lines carry, lane by lane.

MIN_SHARED = 0.5   # m along the road that a lane and its driving line must share


def sigma_of_lanes(lanes: Lanes, driving_lines: Features | None) -> np.ndarray:
    """One sigma across each piece of a lane, the RMS over the driving lines along it.

    driving_lines : Features DRIVING_LINES with `sigma_m`, or None
    Returns (P,) m, NaN where no driving line of the same road and lane says it
    """
    square, length = np.zeros(len(lanes)), np.zeros(len(lanes))
    for row in driving_lines.rows if driving_lines is not None else ():
        if any(row.get(name) is None for name in ("sigma_m", "road", "lane", "station_m", "end_m")):
            continue
        same_lane = (lanes.road == int(row["road"])) & (lanes.lane == int(row["lane"]))
        shared = np.minimum(lanes.end, float(row["end_m"])) - np.maximum(lanes.station, float(row["station_m"]))
        shared = np.where(same_lane & (shared > MIN_SHARED), shared, 0.0)
        square += shared * float(row["sigma_m"]) ** 2
        length += shared
    return np.sqrt(np.divide(square, length, out=np.full(len(lanes), np.nan), where=length > 0))


# Heights of the lanes' borders from the points of the road's surface.

SURFACE_REACH = 0.3          # m about a vertex within which the surface is flat enough for a median
FEWEST_POINTS = 5    # about a vertex
MOST_CHANGE = 0.5    # m: a surface farther above or below is another one, such as a bridge's


def with_surface_heights(lanes: Lanes, road_points: RoadPoints) -> tuple[Lanes, float]:
    """Lanes in map coordinates with borders at the median height of the road points about each vertex.

    lanes : Lanes in map coordinates
    road_points : RoadPoints of the same survey
    Returns
        lanes : Lanes; vertices without points are raised or lowered as those before and after them on the border, and keep their heights on a
            border without any
        share : 0 to 1, of the vertices that have points
    Raises RoadExtractionError if no vertex has points.
    """
    vertices = np.concatenate([lanes.left, lanes.right])
    origin = road_points.origin
    same, location = np.unique(np.round(vertices[:, :2], 3), axis=0, return_inverse=True)   # those of neighbours lie at one place
    location, tree = location.ravel(), cKDTree(same - origin[:2])
    owners, heights = [], []
    for key in road_points.all_sections():
        points = road_points.section(*key)
        _, nearest = tree.query(np.c_[points.x, points.y], distance_upper_bound=SURFACE_REACH)
        near = nearest < len(same)
        owners.append(nearest[near])
        heights.append(np.asarray(points.z, float)[near])
    owner, height = np.concatenate([np.empty(0, int), *owners]), np.concatenate([np.empty(0), *heights]) + origin[2]
    enough = np.bincount(owner, minlength=len(same)) >= FEWEST_POINTS
    if not enough.any():
        raise RoadExtractionError("Road points do not lie where the lanes are: no border has any beside it. Choose the road points of the same "
                                  "survey, or leave them out.")
    median = np.full(len(same), np.nan)
    median[enough] = ndimage.median(height, owner, np.flatnonzero(enough))
    change = median[location] - vertices[:, 2]
    change[~(np.abs(change) < MOST_CHANGE)] = np.nan
    borders = np.c_[vertices[:, :2], vertices[:, 2] + _along_borders(change, vertices, lanes.start)]
    return replace(lanes, left=borders[:len(lanes.left)], right=borders[len(lanes.left):]), float(enough[location].mean())


def _along_borders(change, vertices, start):
    """(V,) the changes of the vertices of left and right borders; NaN is filled in from those before and after it on its border."""
    filled = np.nan_to_num(change)
    count = len(change) // 2
    for side in (0, count):
        for a, b in zip(start[:-1] + side, start[1:] + side):
            finite = np.isfinite(change[a:b])
            if finite.any() and not finite.all():
                along = np.append(0.0, np.cumsum(np.hypot(*np.diff(vertices[a:b, :2], axis=0).T)))
                filled[a:b] = np.interp(along, along[finite], change[a:b][finite])
    return filled


# Crossings and stop lines of the layer MARKINGS, as lines across and along the road.

STRIPE_GAP = 1.5     # m between stripes of one crossing: a gap of one stripe, worn on both sides
LEAST_CROSSING = 3   # stripes
STOP_LINE_HALF = 0.15   # m, half of the breadth of a stop line whose outline is not known


def stop_lines(markings: Features | None) -> list[np.ndarray]:
    """(2, 3) the middle line of every stop line."""
    return [(corners[[0, 1]] + corners[[3, 2]]) / 2 for corners in map(_corners, _shapes(markings, ("stop", "stop_line")))]


def walked_crossings(markings: Features | None) -> list[tuple[np.ndarray, np.ndarray]]:
    """((2, 3) left, (2, 3) right) sides of every zebra crossing, along the way of those who cross: over the row of its stripes."""
    stripes = _shapes(markings, ("zebra", "zebra_crossing"))
    groups = [group for group in _groups(stripes) if len(group) >= LEAST_CROSSING or len(stripes) < LEAST_CROSSING]
    crossings = []
    for group in groups + [[whole] for whole in _shapes(markings, ("crosswalk",))]:
        corners = _corners(shapely.unary_union(group)) if len(group) > 1 else _corners(group[0])
        across = np.mean([_long_side(stripe) for stripe in group], axis=0)
        along = corners[1] - corners[0]
        if len(group) > 1 and abs(along[:2] @ across) > abs((corners[2] - corners[1])[:2] @ across):
            corners = corners[[1, 2, 3, 0]]   # walkers go from stripe to stripe, which lie along the road
        crossings.append((corners[[3, 2]], corners[[0, 1]]))
    return crossings


def _shapes(markings: Features | None, classes: tuple[str, ...]) -> list[Any]:
    """The markings of some classes that have a length and a breadth."""
    return [geometry for geometry, row in markings or () if geometry is not None and not geometry.is_empty and row.get("class") in classes
            and shapely.force_2d(geometry).minimum_rotated_rectangle.geom_type == "Polygon"]


def _groups(shapes: list[Any]) -> list[list[Any]]:
    """Shapes that lie together."""
    flat = shapely.force_2d(np.array(shapes, object))
    group = linked_groups(*shapely.STRtree(flat).query(flat, predicate="dwithin", distance=STRIPE_GAP), len(shapes))
    return [[shapes[k] for k in rows] for _, rows in members_of(group)]


def _corners(shape: Any) -> np.ndarray:
    """(4, 3) corners of the rectangle about a shape, its long side first, counter-clockwise; heights are those of the nearest vertices."""
    rectangle = shapely.force_2d(shape).minimum_rotated_rectangle
    corners = shapely.get_coordinates(shapely.geometry.polygon.orient(rectangle).exterior)[:4]
    if np.hypot(*(corners[1] - corners[0])) < np.hypot(*(corners[2] - corners[1])):
        corners = corners[[1, 2, 3, 0]]
    vertices = shapely.get_coordinates(shape, include_z=True)
    nearest = np.argmin(np.hypot(*(corners[:, None] - vertices[None, :, :2]).transpose(2, 0, 1)), axis=1)
    return np.c_[corners, np.nan_to_num(vertices[nearest, 2])]


def _long_side(shape):
    corners = _corners(shape)
    side = (corners[1] - corners[0])[:2]
    return side * (1 if side[0] > 0 or side[0] == 0 and side[1] > 0 else -1)


# What was read of a map from elsewhere, as layers like ours.

def add_marking_line(layer: Features, points: np.ndarray, road: int, kind: str, pattern: str, width: float = np.nan) -> None:
    """Add a painted border, (N, 3) map coordinates, to the layer MARKING_LINES."""
    _add_line(layer, points, road=road, line=len(layer) + 1, kind=kind, pattern=pattern, width_m=width)


def add_edge(layer: Features, points: np.ndarray, road: int, edge: str = "curb", side: str | None = None, height: float = np.nan) -> None:
    """Add a curb or the end of a pavement, as `edge` says, to the layer ROAD_EDGES."""
    _add_line(layer, points, road=road, side=side, part="bottom", kind="main", edge=edge, chain=len(layer) + 1, height_m=height)


def _add_line(layer, points, **values):
    length = plan_length(points)
    layer.add(shapely.linestrings(points), status="measured", station_m=0.0, end_m=length, length_m=length, **values)


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


class _Misses(NamedTuple):
    """Metres: mean, 95th percentile, largest; at how many places; and the (3,) place of the largest."""

    mean: float
    p95: float
    largest: float
    places: int
    worst: np.ndarray


def border_misses(source: Lanes, exported: Lanes) -> tuple[_Misses, _Misses]:
    """(across, in height) of the source's border vertices from the borders that are read back, and of theirs from the source's.

    What lies beyond the end of a border of the source is left out: an export ends lanes square to the road.
    """
    source_borders, exported_borders = ([border for k in range(len(lanes)) for border in lanes.borders(k)] for lanes in (source, exported))
    ends = [end for border in _once(source_borders)[0] for end in (_gone_on(border), _gone_on(border[::-1]))]
    misses_of_source = _distances(source_borders, _segments(exported_borders))
    misses_of_exported = _distances(exported_borders, _segments(source_borders, True), apart_from=_segments(ends))
    across, rise, places = (np.concatenate(misses) for misses in zip(misses_of_source, misses_of_exported))
    return _summary(across, places), _summary(rise, places)


def _once(lines):
    """(the lines without those that repeat another, forth or back, as neighbours do with the border between them; the number of each in them)."""
    first = {min(line.tobytes(), line[::-1].tobytes()): line for line in lines}
    numbers = {key: number for number, key in enumerate(first)}
    return list(first.values()), [numbers[min(line.tobytes(), line[::-1].tobytes())] for line in lines]


def _segments(lines, curved=False):
    """(M, 7) both ends of every segment of lines, and by how much it misses the curve that bends like the lines at its ends, if `curved`."""
    lines, _ = _once(lines)
    places, line = np.concatenate([np.empty((0, 3)), *lines]), np.repeat(np.arange(len(lines)), [len(border) for border in lines])
    way, same = np.diff(places[:, :2], axis=0), line[1:] == line[:-1]
    turn = np.abs(wrapped(np.diff(np.arctan2(way[:, 1], way[:, 0]))))
    turn = np.concatenate([[np.nan], np.where(same[1:] & same[:-1], turn, np.nan), [np.nan]])
    bow = np.nan_to_num(np.fmin(turn[:len(way)], turn[1:len(way) + 1])) * np.hypot(*way.T) / 8 * curved
    return np.c_[places[:-1], places[1:], bow][same]


def _gone_on(line):
    """(2, 3) from the start of a line straight on beyond it."""
    offsets = line - line[0]
    far = np.hypot(*offsets.T[:2]) > LEAST_CHORD
    way = offsets[np.argmax(far) if far.any() else -1]
    return np.stack([line[0], line[0] - way * BEYOND_END / max(float(np.hypot(*way[:2])), 1e-9)])


def driving_line_misses(driving_lines: Features | None, exported: Lanes, apart_from: np.ndarray | None = None) -> _Misses:
    """Across, of driving lines against the middles of the lanes that are read back.

    apart_from : (N, 2) places; what lies within LEFT_OUT_NEAR of one is left out
    """
    middles = [sum(exported.borders(k)) / 2 for k in np.flatnonzero(np.isin(exported.type, ("driving", "connector")))]
    rows = [shapely.get_coordinates(geometry, include_z=True) for geometry, row in driving_lines or ()
            if geometry is not None and row.get("status") in (None, "measured")]
    places = np.concatenate([np.empty((0, 3)), *rows])
    if apart_from is not None and len(apart_from) and len(places):
        places = places[cKDTree(apart_from).query(places[:, :2])[0] > LEFT_OUT_NEAR]
    across, _, places = _distances([places], _segments(middles), NEAR_MIDDLE)
    return _summary(across, places)


def _distances(lines, segments, farthest=np.inf, apart_from=np.empty((0, 7))):
    """((N,) metres across, (N,) in height, (N, 3) places) of lines from (M, 7) segments, of places from which none lies nearer than `farthest`
    metres infinite.

    apart_from : (K, 7) segments; places to which one of them is nearer are infinite too
    """
    lines, index = _once(lines)
    places, begin = np.concatenate([np.empty((0, 3)), *lines]), np.cumsum([0, *map(len, lines)])
    drawn = shapely.linestrings(np.concatenate([segments, apart_from])[:, :6].reshape(-1, 2, 3))
    points, tree = shapely.points(places[:, :2]), shapely.STRtree(drawn)
    place, near = np.concatenate([tree.query_nearest(points, max_distance=None if np.isinf(farthest) else farthest, all_matches=False),
                                  tree.query(points, predicate="dwithin", distance=SAME_BORDER)], axis=1)
    distance, counted = shapely.distance(drawn[near], points[place]), near < len(segments)
    across, left_out, rise = np.full((3, len(places)), np.inf)
    np.minimum.at(across, place[counted], distance[counted] - segments[near[counted], 6])
    np.minimum.at(left_out, place[~counted], distance[~counted])
    across[left_out < across] = np.inf
    # where borders of several roads lie on each other, the one at the place's own height is its own
    close = counted & (distance < SAME_BORDER) & np.isfinite(across[place])
    place, line = place[close], drawn[near[close]]
    feet = shapely.line_interpolate_point(line, shapely.line_locate_point(line, points[place]))
    np.minimum.at(rise, place, np.abs(places[place, 2] - shapely.get_z(feet)))
    rows = np.concatenate([np.arange(begin[number], begin[number + 1]) for number in index])
    return np.maximum(across, 0.0)[rows], rise[rows], places[rows]


def _summary(values, places):
    values, places = values[np.isfinite(values)], places[np.isfinite(values)]
    if not len(values):
        return _Misses(np.nan, np.nan, np.nan, 0, np.full(3, np.nan))
    return _Misses(float(values.mean()), float(np.percentile(values, 95)), float(values.max()), len(values), places[np.argmax(values)])
