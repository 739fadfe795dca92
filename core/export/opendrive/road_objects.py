"""Crossings, stop lines, arrows, bicycle symbols, the word BUS and hatched areas as objects of the roads that they lie on."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from ...common.features import Features
from ..painted_objects import stop_lines, walked_crossings
from .model import MapRoad, OpenDriveMap

SAMPLES = 1.0          # m between places of reference lines that objects are held against
FARTHEST = 25.0        # m from a reference line
SIMPLER = 0.02         # m by which an outline may be straightened
STOP_LINE_HALF = 0.15  # m, half of the breadth of a stop line whose outline is not known
THINNEST = 0.01        # m of an object's length and width at the least: the format has none of 0
NAME_OF_CLASS = {"hatch": ("roadMark", "hatched area"), "arrow": ("roadMark", "arrow"), "bicycle": ("roadMark", "bicycle symbol"),
                 "bus": ("roadMark", "word BUS")}


def add_objects(whole: OpenDriveMap, markings: Features | None, origin: np.ndarray) -> None:
    """Give the roads the objects that lie on them.

    Parameters
    ----------
    whole : OpenDriveMap with its roads
    markings : the layer MARKINGS in map coordinates, or None
    origin : (3,) metres of the file's false origin
    """
    shapes: list[tuple[str, str, np.ndarray]] = []
    for left, right in walked_crossings(markings):
        shapes.append(("crosswalk", "zebra crossing", np.concatenate([left, right[::-1]])))
    for line in stop_lines(markings):
        way = line[1] - line[0]
        across = np.array([-way[1], way[0], 0.0]) / max(float(np.hypot(*way[:2])), 1e-6) * STOP_LINE_HALF
        shapes.append(("roadMark", "stop line", np.array([line[0] - across, line[1] - across, line[1] + across, line[0] + across])))
    for geometry, row in markings if markings is not None else ():
        known = NAME_OF_CLASS.get(next((name for name in NAME_OF_CLASS if str(row.get("class")).startswith(name)), ""))
        if known is not None and geometry is not None and not geometry.is_empty:
            shapes += [(*known, shapely.get_coordinates(shapely.simplify(part, SIMPLER).exterior, include_z=True)[:-1])
                       for part in shapely.get_parts(geometry)]
    if not shapes:
        return
    roads = [road for road in whole.roads if road.junction == "-1"] or whole.roads
    tree, owner, station = _places(roads)
    for number, (kind, name, corners) in enumerate(shapes):
        local = corners - origin
        near = tree.query_nearest(shapely.Point(local[:, :2].mean(0)), max_distance=FARTHEST, all_matches=False)
        if len(near):
            roads[owner[near[0]]].objects.append(_object(number, kind, name, local, roads[owner[near[0]]], float(station[near[0]])))


def _places(roads: list[MapRoad]) -> tuple[shapely.STRtree, np.ndarray, np.ndarray]:
    """(tree of places on reference lines, road of each, s of each)."""
    stations = [np.linspace(0, road.plan.length, max(int(road.plan.length / SAMPLES), 1) + 1) for road in roads]
    places = np.concatenate([road.plan.at(s)[0] for road, s in zip(roads, stations)])
    owner = np.repeat(np.arange(len(roads)), [len(s) for s in stations])
    return shapely.STRtree(shapely.points(places)), owner, np.concatenate(stations)


def _object(number: int, kind: str, name: str, corners: np.ndarray, road: MapRoad, near: float) -> dict[str, Any]:
    """The attributes of an object; its outline is told along the road, or beside its own place where it reaches beyond the road's end."""
    s, t = road.plan.feet(corners[:, :2], np.full(len(corners), near))
    at, aside = float(np.clip(s.mean(), 0.0, road.length)), float(t.mean())
    local = bool(s.min() < 0.0 or s.max() > road.length)
    if local:
        (place,), (heading,), _ = road.plan.at(np.array([at]))
        way = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
        u, v = ((corners[:, :2] - place) @ way).T
        outline = np.c_[u, v - aside, corners[:, 2] - road.elevation.at(at)]
    else:
        outline = np.c_[s, t, corners[:, 2] - road.elevation.at(s)]
    outline[:, 2] = np.round(outline[:, 2], 4)
    length, width = (max(float(size), THINNEST) for size in np.ptp(outline[:, :2], axis=0))
    return {"id": str(number), "type": kind, "subtype": "", "name": name, "orientation": "none", "s": at, "t": aside, "zOffset": 0.0,
            "length": length, "width": width, "hdg": 0.0, "height": 0.0, "corners": outline, "local": local}
