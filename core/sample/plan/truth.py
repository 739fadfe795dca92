"""The truth of a plan, as layers in map coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import shapely

from ..parts.truth import VERTEX_STEP, TruePlaces, Truth, densified

if TYPE_CHECKING:
    from .scene import PlanScene

_FACE = 0.025    # m across the face of a curb
_LEAST = 4       # vertices of an edge that is worth a line


def truth_of_plan(scene: PlanScene, origin: Sequence[float], crs: str) -> Truth:
    """The true layers of a plan, as far as it is surveyed.

    Parameters
    ----------
    scene : PlanScene
    origin : (3,) m, map coordinates of the local origin
    crs : WKT

    Returns
    -------
    Truth
    """
    def on_map(places, rise=0.0):
        return np.column_stack([places, scene.ground.height(*places.T) + rise]) + origin

    return TruePlaces(_boundaries(scene, on_map), _markings(scene, on_map), _driving_lines(scene, on_map), _surface(scene, on_map),
                      _lanes(scene, on_map), _roadside(scene, on_map)).layers(crs)


def _boundaries(scene, on_map):
    """Bottoms and tops of curbs, and edges of the pavement, in pieces of one kind."""
    for ring, height, where, edge in zip(scene.ground.rings, scene.ground.heights, scene.where, scene.edges):
        for some in _runs(ring, where, edge, scene.area):
            bottom, tall = ring[some], height[some]
            side = _side(scene, bottom[len(bottom) // 2])
            lines = [("bottom", on_map(bottom))]
            if edge[some[0]] != "pavement":
                top = bottom + _FACE * _outward(ring)[some]
                lines.append(("top", np.column_stack([on_map(top)[:, :2], lines[0][1][:, 2] + tall])))
            for part, places in lines:
                yield places, dict(side=side, part=part, kind=str(where[some[0]]), edge=str(edge[some[0]]), height_m=float(np.median(tall)))


def _outward(ring):
    """(K, 2) unit vectors away from the carriageway, at the vertices of a ring."""
    way = np.roll(ring, -1, axis=0) - np.roll(ring, 1, axis=0)
    return np.column_stack([way[:, 1], -way[:, 0]]) / np.hypot(way[:, 0], way[:, 1])[:, None]


def _runs(ring, where, edge, area):
    """Indices of neighbouring vertices in the area with one kind of edge; where two kinds meet, both have the vertex between."""
    count = len(ring)
    inside = shapely.contains_xy(area, ring)
    name = np.array([f"{a}|{b}" if here else "" for a, b, here in zip(where, edge, inside)])
    changes = np.flatnonzero(name != np.roll(name, 1))
    if len(changes) == 0:
        return [np.append(np.arange(count), 0)] if inside.all() else []
    runs = []
    for start, end in zip(changes, np.append(changes[1:], changes[0] + count)):
        if inside[start]:
            last = end if inside[end % count] else end - 1
            if last - start >= _LEAST:
                runs.append(np.arange(start, last + 1) % count)
    return runs


def _side(scene, place):
    """Side of a place as seen from the pass that drove nearest, in its direction of travel."""
    nearest = min((way.path.locate(place[None]) for way, _ in scene.ways), key=lambda found: abs(found[1][0]))
    return "left" if nearest[1][0] > 0 else "right"


def _markings(scene, on_map):
    for mark in scene.paint.markings:
        for outline in mark.outlines:
            yield on_map(densified(outline)), {
                "class": mark.kind, "line": mark.line, "pattern": mark.pattern, "width_m": mark.width, "wear": float(mark.wear)}


def _about(lane):
    return dict(road=lane.road, lane=lane.number, direction=lane.direction, station_m=float(lane.stations[0]), end_m=float(lane.stations[-1]))


def _driving_lines(scene, on_map):
    for lane in scene.lanes:
        middle = (lane.left + lane.right) / 2
        bend = lane.path.curvature(lane.stations)
        yield on_map(lane.path.at(lane.stations, middle)), float(np.abs(bend / (1.0 - bend * middle)).max()), _about(lane)


def _surface(scene, on_map):
    for part in shapely.get_parts(shapely.intersection(scene.carriageway, scene.area)):
        ring, *holes = (on_map(densified(shapely.get_coordinates(ring)[:-1])) for ring in (part.exterior, *part.interiors))
        yield ring, holes


def _lanes(scene, on_map):
    for lane in scene.lanes:
        yield *(on_map(lane.path.at(lane.stations, border)) for border in (lane.left, lane.right)), _about(lane)


def _roadside(scene, on_map):
    """Guard rails, as far as they stand in the surveyed area."""
    for places, height, low in scene.rails:
        for part in shapely.get_parts(shapely.line_merge(shapely.intersection(shapely.linestrings(places), scene.area))):
            foot = shapely.get_coordinates(shapely.segmentize(part, VERTEX_STEP))
            yield on_map(foot), dict(kind="guard_rail", side=_side(scene, foot[len(foot) // 2]), height_m=height, foot_m=low)
