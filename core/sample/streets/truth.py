"""The truth of the simulated street, as layers in map coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...common.features import Features
from ..parts.truth import TRUE_BOUNDARIES, TRUE_DRIVING_LINES, TRUE_LANES, TRUE_MARKINGS, TRUE_SURFACE, VERTEX_STEP, Truth, add_lane, densified

if TYPE_CHECKING:
    from .street import Scene

_DROPPED = 0.05   # m: lower curbs are of the kind "dropped"

def truth_of_street(scene: Scene, origin: Sequence[float], crs: str) -> Truth:
    """The true layers of a street.

    Parameters
    ----------
    scene : Scene
    origin : (3,) m, map coordinates of the local origin
    crs : WKT

    Returns
    -------
    Truth
    """
    layers = (true_boundaries, true_markings, true_driving_lines, true_surface, true_lanes)
    return Truth(*(layer(scene, origin, crs) for layer in layers))


def _stations(start, end):
    return np.linspace(start, end, max(2, int(np.ceil((end - start) / VERTEX_STEP)) + 1))


def _coordinates(scene, origin, s, d):
    x, y, z = scene.to_map(s, d)
    return np.column_stack([x + origin[0], y + origin[1], z + origin[2]])


def true_boundaries(scene: Scene, origin: Sequence[float], crs: str) -> Features:
    """Bottoms and tops of the curbs, in pieces of one kind, and the edges of the pavement where there is no curb.

    Parameters
    ----------
    scene : Scene
    origin : (3,) m, map coordinates of the local origin
    crs : WKT

    Returns
    -------
    Features TRUE_BOUNDARIES, LineStringZ
    """
    from shapely import LineString

    layer = Features("LineStringZ", TRUE_BOUNDARIES, crs=crs)
    for side, name in ((scene.left, "left"), (scene.right, "right")):
        for start, end, edge in _edge_pieces(side, scene.length):
            s = _stations(start, end)
            height = float(np.median(side.curb(s)))
            parts = [("bottom", side.borders[0]), ("top", side.borders[1])]
            for part, away in parts[:1] if edge == "pavement" else parts:
                line = LineString(_coordinates(scene, origin, s, side.sign * away))
                layer.add(line, road=1, side=name, part=part, kind="main", edge=edge, station_m=float(start), end_m=float(end),
                          height_m=height, length_m=float(line.length))
    return layer


def _edge_pieces(side, length):
    if not side.curb_height:
        return [(0.0, length, "pavement")]
    s = np.arange(0.0, length + 1e-9, 0.01)
    dropped = side.curb(s) < _DROPPED
    cuts = np.concatenate([[0], np.flatnonzero(np.diff(dropped)) + 1, [len(s) - 1]])
    return [(s[a], s[b], "dropped" if dropped[a] else "curb") for a, b in zip(cuts[:-1], cuts[1:]) if b > a]


def true_markings(scene: Scene, origin: Sequence[float], crs: str) -> Features:
    """Every marking as it was painted, including worn places.

    Parameters
    ----------
    scene : Scene
    origin : (3,) m, map coordinates of the local origin
    crs : WKT

    Returns
    -------
    Features TRUE_MARKINGS, PolygonZ
    """
    from shapely import Polygon

    layer = Features("PolygonZ", TRUE_MARKINGS, crs=crs)
    for marking in scene.paint.markings:
        dash = getattr(marking, "dash", None)
        pattern = None if marking.line is None else "solid" if dash is None else "dashed"
        for outline in marking.outlines():
            ring = densified(outline)
            polygon = Polygon(_coordinates(scene, origin, ring[:, 0], ring[:, 1]))
            layer.add(polygon, road=1, line=marking.line, pattern=pattern, width_m=getattr(marking, "width", None),
                      wear=float(marking.wear), station_m=float(outline[:, 0].min()), end_m=float(outline[:, 0].max()),
                      **{"class": marking.kind})
    return layer


def true_driving_lines(scene: Scene, origin: Sequence[float], crs: str) -> Features:
    """Middles of the lanes, in their direction of travel.

    Parameters
    ----------
    scene : Scene
    origin : (3,) m, map coordinates of the local origin
    crs : WKT

    Returns
    -------
    Features TRUE_DRIVING_LINES, LineStringZ; `radius_m` is that of the sharpest bend
    """
    from shapely import LineString

    layer = Features("LineStringZ", TRUE_DRIVING_LINES, crs=crs)
    for lane in scene.lanes:
        s = _stations(lane.stations[0], lane.stations[-1])
        d = np.interp(s, lane.stations, lane.offsets)
        bend = scene.axis.curvature(s)
        bend = bend / (1.0 - bend * d)
        sharpest = float(np.abs(bend).max())
        line = LineString(_coordinates(scene, origin, s, d)[::lane.direction])
        layer.add(line, road=1, lane=lane.number, direction=lane.direction,
                  radius_m=1.0 / sharpest if sharpest > 1e-6 else None,
                  station_m=float(s[0]), end_m=float(s[-1]), length_m=float(line.length))
    return layer


def true_surface(scene: Scene, origin: Sequence[float], crs: str) -> Features:
    """The carriageway between its edges, over the surveyed stretch.

    Parameters
    ----------
    scene : Scene
    origin : (3,) m, map coordinates of the local origin
    crs : WKT

    Returns
    -------
    Features TRUE_SURFACE, PolygonZ
    """
    from shapely import Polygon

    s = _stations(0.0, scene.length)
    left = _coordinates(scene, origin, s, scene.left.edge)
    right = _coordinates(scene, origin, s[::-1], -scene.right.edge)
    polygon = Polygon(np.vstack([left, right]))
    layer = Features("PolygonZ", TRUE_SURFACE, crs=crs)
    layer.add(polygon, road=1, area_m2=float(polygon.area))
    return layer


def true_lanes(scene: Scene, origin: Sequence[float], crs: str) -> Features:
    """Lanes between the middles of their border lines.

    Parameters
    ----------
    scene : Scene
    origin : (3,) m, map coordinates of the local origin
    crs : WKT

    Returns
    -------
    Features TRUE_LANES, PolygonZ
    """
    layer = Features("PolygonZ", TRUE_LANES, crs=crs)
    for lane in scene.lanes:
        s = _stations(lane.stations[0], lane.stations[-1])
        middle, half = np.interp(s, lane.stations, lane.offsets), np.interp(s, lane.stations, lane.widths) / 2
        left, right = (_coordinates(scene, origin, s, middle + side) for side in (half, -half))
        add_lane(layer, left, right, lane.direction, road=1, lane=lane.number, station_m=float(s[0]), end_m=float(s[-1]))
    return layer
