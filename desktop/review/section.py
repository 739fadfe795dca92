"""A section across the road: where it lies, and what the layers of a road map have on it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from qgis.core import (
    Qgis,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeature,
    QgsGeometry,
    QgsPoint,
    QgsPointXY,
    QgsRectangle,
    QgsVectorLayer,
)

from ...processing_provider.results.road_maps import output_of
from ...processing_provider.styling import title_of as title_expression

HALF_WIDTH = 20.0     # m of the section either side
REACH = 60.0          # m about a place within which the road's direction is sought
LEADING = ("DRIVING_LINES", "ROAD_EDGES", "BOUNDARIES", "MARKING_LINES", "TRAJECTORY")  # lines that run along the road, best first
CORNERS = ("CURB_POINTS", "CORNERS")
CORNERS_WITHIN = 0.5  # m along the road
TOUCHES = 0.002       # m before a section at which a line may end that crosses it: one that was drawn in sections ends in one
DRAWN = {"ROAD_EDGES": "#e31a1c", "BOUNDARIES": "#e31a1c", "MARKING_LINES": "#2166ff", "DRIVING_LINES": "#00a651",
         "CORRECTIONS": "#d0006f"}


@dataclass(frozen=True)
class Section:
    """A vertical plane across the road."""

    x: float   # x, y: map coordinates of its middle
    y: float
    azimuth: float   # direction of the road, degrees clockwise from grid north

    @property
    def left(self) -> tuple[float, float]:
        """Unit vector to the left of the road."""
        angle = math.radians(self.azimuth)
        return -math.cos(angle), math.sin(angle)

    @property
    def ahead(self) -> tuple[float, float]:
        """Unit vector along the road."""
        angle = math.radians(self.azimuth)
        return math.sin(angle), math.cos(angle)

    def line(self) -> QgsGeometry:
        """From left to right on the map."""
        (lx, ly), w = self.left, HALF_WIDTH
        return QgsGeometry.fromPolylineXY([QgsPointXY(self.x + w * lx, self.y + w * ly), QgsPointXY(self.x - w * lx, self.y - w * ly)])

    def offset(self, x: float, y: float) -> float:
        """m left of the middle of a place on the section."""
        return (x - self.x) * self.left[0] + (y - self.y) * self.left[1]

    def moved(self, metres: float) -> tuple[float, float]:
        """The place so many metres farther along the road."""
        return self.x + metres * self.ahead[0], self.y + metres * self.ahead[1]

    def cut(self, points: np.ndarray, thickness: float) -> np.ndarray:
        """(K, 3) offset (left positive), z and intensity of those of (N, 4) points that lie within `thickness` m along the road."""
        dx, dy = points[:, 0] - self.x, points[:, 1] - self.y
        along = dx * self.ahead[0] + dy * self.ahead[1]
        across = dx * self.left[0] + dy * self.left[1]
        rows = (np.abs(along) <= thickness / 2) & (np.abs(across) <= HALF_WIDTH)
        return np.c_[across[rows], points[rows, 2:]]


@dataclass(frozen=True)
class Crossing:
    """Where a line crosses the section: m left of its middle, height, what it is, colour; of a curb, the height of its top (else NaN)."""

    offset: float
    z: float
    title: str
    colour: str
    top: float = math.nan


def section_at(x: float, y: float, layers: Iterable[QgsVectorLayer]) -> Section | None:
    """The section through a place, across the nearest line of the best kind there is; None where there is no line near.

    It looks along the road, so that its left is the left of the layers' fields, whichever way the traffic of the nearest lane goes.
    """
    point = QgsGeometry.fromPointXY(QgsPointXY(x, y))
    for output in LEADING:
        nearest, azimuth = REACH, None
        for layer in layers:
            if output_of(layer) != output or layer.geometryType() != Qgis.GeometryType.Line:
                continue
            for feature in layer.getFeatures(QgsRectangle(x - REACH, y - REACH, x + REACH, y + REACH)):
                geometry = feature.geometry()
                distance = geometry.distance(point)
                if distance < nearest:
                    along = math.degrees(geometry.interpolateAngle(geometry.lineLocatePoint(point)))
                    # driving lines run with the traffic
                    nearest, azimuth = distance, along + (180.0 if feature.attributeMap().get("direction") == -1 else 0.0)
        if azimuth is not None:
            return Section(x, y, azimuth % 360.0)
    return None


def crossings(section: Section, layers: Iterable[QgsVectorLayer]) -> list[Crossing]:
    """Lines that cross the section, from left to right."""
    line, result = section.line(), []
    for layer in layers:
        colour = DRAWN.get(output_of(layer))
        if colour is None or layer.geometryType() != Qgis.GeometryType.Line:
            continue
        title = titles_of(layer)
        for feature in layer.getFeatures(line.boundingBox().buffered(TOUCHES)):
            intersection = feature.geometry().extendLine(TOUCHES, TOUCHES).intersection(line)
            for vertex in intersection.vertices() if not intersection.isEmpty() else ():
                z = _height(feature.geometry(), vertex)
                result.append(Crossing(section.offset(vertex.x(), vertex.y()), z, title(feature), colour, z + _curb_height(feature)))
    return sorted(result, key=lambda crossing: -crossing.offset)


def corners(section: Section, layers: Iterable[QgsVectorLayer], along: float = CORNERS_WITHIN) -> list[tuple[float, float, str]]:
    """(offset, z, part) of the corners of curbs, bottom and top, that lie within `along` m of the section; of layers of curb points."""
    result, box = [], section.line().boundingBox().buffered(along)
    for layer in layers:
        if output_of(layer) not in CORNERS or layer.geometryType() != Qgis.GeometryType.Point:
            continue
        for feature in layer.getFeatures(box):
            geometry = feature.geometry()
            point = geometry.constGet()
            if abs((point.x() - section.x) * section.ahead[0] + (point.y() - section.y) * section.ahead[1]) <= along and point.is3D():
                result.append((section.offset(point.x(), point.y()), point.z(), str(feature.attribute("part") or "bottom")))
    return result


def middle_of(crossings: Iterable[Crossing]) -> float:
    """m left of the section's middle: about where the middle of the road is, by the lines that cross."""
    offsets = [crossing.offset for crossing in crossings]
    return (min(offsets) + max(offsets)) / 2 if offsets else 0.0


def _curb_height(feature):
    """m from the bottom to the top of a curb; NaN of other lines and of edges without one."""
    names = {field.name() for field in feature.fields()}
    if not {"height_m", "part"} <= names or feature["part"] == "top" or "edge" in names and feature["edge"] == "pavement":
        return math.nan
    try:
        return float(feature["height_m"])
    except (TypeError, ValueError):  # NULL
        return math.nan


def _height(geometry, vertex):
    """z of a line at a place on it; NaN where it has none, as of one that was drawn in the map, where it is 0."""
    along = geometry.lineLocatePoint(QgsGeometry(QgsPoint(vertex.x(), vertex.y())))
    on_line = geometry.interpolate(along)  # its point lives no longer than it
    point = on_line.constGet()
    return point.z() if point is not None and point.is3D() and point.z() != 0.0 else math.nan


def titles_of(layer: QgsVectorLayer) -> Callable[[QgsFeature], str]:
    """What says of a feature what it is: in the words of the result that its layer is, else by the display expression of the layer."""
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
    expression = QgsExpression(title_expression(output_of(layer), {field.name() for field in layer.fields()}) or layer.displayExpression())
    expression.prepare(context)

    def title(feature):
        context.setFeature(feature)
        return str(expression.evaluate(context) or layer.name())

    return title
