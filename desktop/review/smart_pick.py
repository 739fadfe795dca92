"""What a click or a drawn line means, by the points there: the curb or paint itself, with what evidence there is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsTask,
    QgsUnitTypes,
    QgsVectorLayer,
)

from ...core.corrections.pick import Seen, pick_line, snap_line
from ...processing_provider.results.road_maps import RoadMap, clouds_of, output_of
from ...processing_provider.texts import tr
from ..background import with_points
from .section import section_at

AROUND = 30.0      # m about a click within which a line is followed
BESIDE = 2.0       # m about a drawn line that are read
SAME_LINE = 0.3    # m: what the map has that near is the line itself
LINES = {"edge": ("ROAD_EDGES", "BOUNDARIES"), "marking": ("MARKING_LINES",)}
KNOWN = ("measured", "accepted", "drawn")  # statuses of lines that need no other


def pick(road_map: RoadMap, corrections: QgsVectorLayer | None, point: QgsPointXY, crs: QgsCoordinateReferenceSystem,
         ready: Callable[[QgsTask, Seen | None, QgsGeometry, str], None]) -> QgsTask | None:
    """Look for a curb or painted line at a click, in the background; None where the point clouds of the road map are not there.

    corrections : layer whose drawn lines count as known
    ready : called with the task, what was seen and its line in the CRS of the road map's layers without what the map has of it; with None, an empty
        geometry and a sentence where there is nothing to add
    """
    layers = road_map.vectors
    place = QgsCoordinateTransform(crs, layers[0].crs(), QgsProject.instance()).transform(point)
    section = section_at(place.x(), place.y(), layers)
    work = partial(pick_line, x=place.x(), y=place.y(), azimuth=section.azimuth if section else 0.0)

    def looked(task, seen, problem):
        line = QgsGeometry() if seen is None else _unmapped(seen, layers, corrections, QgsGeometry.fromPointXY(place))
        if seen is None:
            problem = problem or tr("No step and no paint is seen in the points within a metre. Click nearer, or draw it by hand.")
        elif line.isEmpty():
            problem = tr("The map has this line already.")
        ready(task, None if problem else seen, line, problem)

    return _look(road_map, place, AROUND, partial(in_metres, work, metres_of(road_map)), looked)


def prepare(road_map: RoadMap, point: QgsPointXY, crs: QgsCoordinateReferenceSystem) -> QgsTask | None:
    """Read what clicks about a place will need, in the background; None as of `pick`."""
    place = QgsCoordinateTransform(crs, road_map.vectors[0].crs(), QgsProject.instance()).transform(point)
    return _look(road_map, place, AROUND, len, lambda task, count, problem: None)


def snap(road_map: RoadMap, line: QgsGeometry, crs: QgsCoordinateReferenceSystem, target: str,
         ready: Callable[[QgsTask, Seen | None, QgsGeometry, str], None]) -> QgsTask | None:
    """Lay a drawn line onto faces or paint, in the background; as `pick`, and where nothing is seen along it `ready` has the line as it was drawn."""
    drawn = QgsGeometry(line)
    drawn.transform(QgsCoordinateTransform(crs, road_map.vectors[0].crs(), QgsProject.instance()))
    box = drawn.boundingBox()
    work = partial(snap_line, places=np.array([(vertex.x(), vertex.y()) for vertex in drawn.vertices()]), target=target)

    def looked(task, seen, problem):
        kept = "" if seen else tr("Kept as it was drawn: nothing is seen along it.")
        ready(task, seen, _line_of(seen) if seen else drawn, problem or kept)

    metres = metres_of(road_map)
    return _look(road_map, box.center(), max(box.width(), box.height()) / 2 * metres + BESIDE, partial(in_metres, work, metres), looked)


def metres_of(road_map: RoadMap) -> float:
    """m of a unit of the map."""
    return QgsUnitTypes.fromUnitToUnitFactor(road_map.vectors[0].crs().mapUnits(), Qgis.DistanceUnit.Meters)


def _look(road_map, place, radius, work, ready):
    clouds, missing = clouds_of(road_map, QgsProject.instance())
    if missing or not clouds:
        return None
    return with_points(tr("Smart pick"), clouds, (place.x(), place.y()), radius, work, ready)


def in_metres(work: partial, metres: float, points: np.ndarray) -> Any:
    """What the core finds in metres about a place or along places, in the units of the map; None where it finds nothing."""
    scale = np.array([metres, metres, metres, 1.0])
    given = {name: value * metres if name in ("x", "y", "places") else value for name, value in work.keywords.items()}
    seen = work.func(points * scale, **given)
    return None if seen is None else replace(seen, places=seen.places / metres)


def _line_of(seen):
    return QgsGeometry.fromPolylineXY([QgsPointXY(x, y) for x, y in seen.places])


def _unmapped(seen, layers, corrections, click):
    """The part of a line nearest to the click that the map does not have as measured or drawn yet; empty where it has what was clicked."""
    line, before = _line_of(seen), _line_of(seen)
    known = {layer: lambda row: row["status"] in KNOWN for layer in layers if output_of(layer) in LINES[seen.target]}
    if corrections is not None and corrections.crs() == layers[0].crs():
        known[corrections] = lambda row: (row["action"], row["target"]) == ("draw", seen.target)
    for layer, is_known in known.items():
        for feature in layer.getFeatures(before.boundingBox().buffered(SAME_LINE)):
            if is_known(feature):
                line = line.difference(feature.geometry().buffer(SAME_LINE, 8))
    parts = [QgsGeometry(part.clone()) for part in line.constParts()] if not line.isEmpty() else []
    nearest = min(parts, key=lambda part: part.distance(click), default=QgsGeometry())
    return nearest if parts and nearest.distance(click) < before.distance(click) + 2 * SAME_LINE else QgsGeometry()


def evidence(seen: Seen) -> str:
    """What was seen, for the person and for the note of the correction."""
    values = dict(step=100 * seen.step, length=seen.length, seen=seen.seen, points=seen.points, scatter=100 * seen.scatter, width=100 * seen.width,
                  brightness=seen.brightness)
    text = tr("Curb of {step:.0f} cm over {length:.1f} m, from {points} points, ± {scatter:.1f} cm") if seen.target == "edge" else \
        tr("Paint {width:.0f} cm wide, {brightness:.1f} times as bright as the road, {seen:.1f} of {length:.1f} m seen, ± {scatter:.1f} cm")
    return text.format(**values)
