"""The layers of a road map on their way into another format: checked before anything is written."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import shapely

from ..common.errors import RoadExtractionError
from ..common.features import Features
from ..driving.layers import Lanes
from ..io.crs import check_metric, parse_crs

MOST_OVERLAP = 0.5       # share of a lane that may lie on lanes of another road: more is two roads at one place
SAME_LEVEL = 2.0         # m of height within which two roads are no bridge
FARTHEST_PLACE = 1e8     # m from the origin of a CRS: twice around the world
LEAST_LED = 0.001        # m
LEAST_CURB = 0.005       # m of height between the bottom and the top of a curb: less is none that a map states
FARTHEST_LAYER = 50.0    # m from the lanes: a layer that lies farther away is of another survey


@dataclass
class RoadMapSource:
    """Lanes with the other layers of their road map.

    lanes : Lanes in map coordinates
    driving_lines, marking_lines, road_edges, markings : Features or None
    notes : sentences for the user, filled by `checked`
    gaps : (P, 2) metres between the two stripes at the left and right border of each lane, None or 0 where there is one
    middles : (V, 3) of the lanes between their own stripes, vertex by vertex; None where they are the middles of the lanes
    """

    lanes: Lanes
    driving_lines: Features | None = None
    marking_lines: Features | None = None
    road_edges: Features | None = None
    markings: Features | None = None
    notes: list[str] = field(default_factory=list)
    gaps: np.ndarray | None = None
    middles: np.ndarray | None = None

    def led_to_middles(self) -> np.ndarray:
        """(N, 2) places in the middle of lanes where a border was led along the middle of a double line, away from the lane's own stripe."""
        if self.middles is None:
            return np.empty((0, 2))
        moved = ((self.lanes.left + self.lanes.right) / 2 - self.middles)[:, :2]
        return self.middles[np.hypot(*moved.T) > LEAST_LED, :2]

    def others(self) -> Iterator[tuple[str, Features]]:
        """(what messages call it, layer) of the layers beside the lanes that there are."""
        for label, layer in (("Driving lines", self.driving_lines), ("Marking lines", self.marking_lines), ("Road edges", self.road_edges),
                             ("Markings", self.markings)):
            if layer is not None and len(layer):
                yield label, layer


def is_stated(lanes: Lanes) -> bool:
    """Whether lanes are of a map from elsewhere, which states its borders and ways: all are sure, and none is of a line or edge of a survey."""
    lines = np.concatenate([lanes.left_line, lanes.right_line])
    return bool((lanes.status == "measured").all() and (lanes.confidence == 1).all() and (lines == "none").all())


def checked(source: RoadMapSource) -> RoadMapSource:
    """The same source without successors that are not there, proven fit for a map.

    Raises
    ------
    RoadExtractionError
        If there are no lanes, the CRS is not in metres, a lane has no width or borders that cross, heights are missing, two roads lie at
        one place, or a layer is of another survey.
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
    _check_shapes(lanes)
    if not is_stated(lanes):   # where a map from elsewhere has two roads at one place, it means both
        _check_places(lanes)
    _check_layers(source)
    known = set(lanes.lane_id)
    lost = sum(name not in known for names in lanes.successors for name in names)
    notes = list(source.notes)
    if lost:
        notes.append(f"{lost} successors name lanes that are not in the layer; these links were left out.")
    own = sum(name in names for name, names in zip(lanes.lane_id, lanes.successors))
    if own:
        notes.append(f"{own} lanes name themselves as their successors; these links were left out.")
    kept = [tuple(name for name in names if name in known and name != own_name) for own_name, names in zip(lanes.lane_id, lanes.successors)]
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
    if not len(rows):
        return
    rings = [np.concatenate([left, right[::-1]])[:, :2] for left, right in (lanes.borders(k) for k in rows)]
    shapes = shapely.make_valid(np.array([shapely.Polygon(ring) for ring in rings], object))
    height = np.array([lanes.borders(k)[0][:, 2].mean() for k in rows])
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
    for label, layer in source.others():
        west, south, east, north = shapely.total_bounds(np.array([g for g in layer.geometries if g is not None], object))
        if west > high[0] or east < low[0] or south > high[1] or north < low[1]:
            raise RoadExtractionError(f"{label} do not lie where the lanes are: they begin at x {west:.0f}, y {south:.0f}, the lanes at "
                                      f"x {low[0] + FARTHEST_LAYER:.0f}, y {low[1] + FARTHEST_LAYER:.0f}. Choose the layers of one survey.")


class NearestValues:
    """A number of the line or area of a layer that is nearest to a place.

    Parameters
    ----------
    layer : Features, or None
    name : of the field; features without a value are left out
    """

    def __init__(self, layer: Features | None, name: str) -> None:
        rows: list[tuple[Any, float]] = [] if layer is None else [(g, float(row[name])) for g, row in layer
                                                                  if g is not None and row.get(name) is not None]
        # of long lines the tree finds the nearest segment much sooner than the nearest line
        parts, values = [], []
        for geometry, value in rows:
            places = shapely.get_coordinates(geometry)
            pieces = shapely.linestrings(np.stack([places[:-1], places[1:]], axis=1)) if geometry.geom_type == "LineString" else [geometry]
            parts += list(pieces)
            values += [value] * len(pieces)
        self._tree, self._values = shapely.STRtree(parts), np.array(values)

    def at(self, points: np.ndarray, farthest: float = 0.5) -> np.ndarray:
        """(N,) numbers nearest to (N, 2) points, NaN where none lies within `farthest` metres."""
        found = np.full(len(points), np.nan)
        if len(self._values) and len(points):
            which, part = self._tree.query_nearest(shapely.points(points), max_distance=farthest, all_matches=False)
            found[which] = self._values[part]
        return found


# The uncertainty that driving lines carry, lane by lane.

MIN_SHARED = 0.5   # m along the road that a lane and its driving line must share


def sigma_of_lanes(lanes: Lanes, driving_lines: Features | None) -> np.ndarray:
    """One sigma across each piece of a lane, the RMS over the driving lines along it.

    Parameters
    ----------
    lanes : Lanes
    driving_lines : Features DRIVING_LINES with `sigma_m`, or None

    Returns
    -------
    (P,) m, NaN where no driving line of the same road and lane says it
    """
    square, length = np.zeros(len(lanes)), np.zeros(len(lanes))
    for row in driving_lines.rows if driving_lines is not None else ():
        if any(row.get(name) is None for name in ("sigma_m", "road", "lane", "station_m", "end_m")):
            continue
        own = (lanes.road == int(row["road"])) & (lanes.lane == int(row["lane"]))
        shared = np.minimum(lanes.end, float(row["end_m"])) - np.maximum(lanes.station, float(row["station_m"]))
        shared = np.where(own & (shared > MIN_SHARED), shared, 0.0)
        square += shared * float(row["sigma_m"]) ** 2
        length += shared
    return np.sqrt(np.divide(square, length, out=np.full(len(lanes), np.nan), where=length > 0))
