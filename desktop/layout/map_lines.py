"""The lines of a road map's layers as numbers: places in metres, heights, stations; and how well they are known."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from qgis.core import Qgis, QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsCsException, QgsMapLayer, QgsProject, QgsVectorLayer

from ...processing_provider.texts import tr
from .axes import RoadLine, road_line

LEADING = ("DRIVING_LINES", "MARKING_LINES", "ROAD_EDGES")   # lines that lead an axis, best first


@dataclass(frozen=True)
class MapLine:
    """output : the result that it is of, such as ROAD_EDGES; places : (N, 3) metres, z may be NaN; row : its fields by name."""

    output: str
    places: np.ndarray
    row: dict[str, Any]

    def number(self, name: str) -> float:
        """A field in metres, of a layer in feet too; NaN where it has none."""
        for field, unit in ((f"{name}_m", 1.0), (f"{name}_ft", 0.3048)):
            value = self.row.get(field)
            if isinstance(value, (int, float)):
                return value * unit
        return math.nan


def lines_of(layers: dict[str, QgsMapLayer], crs: QgsCoordinateReferenceSystem, project: QgsProject, unit: float) -> list[MapLine]:
    """The lines of the layers of lines, in a CRS whose unit is so many metres; what cannot be transformed is left out."""
    lines = []
    for output, layer in layers.items():
        if not isinstance(layer, QgsVectorLayer) or layer.geometryType() != Qgis.GeometryType.Line:
            continue
        transform = QgsCoordinateTransform(layer.crs(), crs, project) if layer.crs().isValid() and layer.crs() != crs else None
        names = [field.name() for field in layer.fields()]
        for feature in layer.getFeatures():
            geometry = feature.geometry()
            try:
                if geometry.isEmpty() or (transform is not None and geometry.transform(transform) != Qgis.GeometryOperationResult.Success):
                    continue
            except QgsCsException:
                continue
            row = dict(zip(names, feature.attributes()))
            for part in shapely.get_parts(shapely.from_wkb(bytes(geometry.asWkb()))):
                places = shapely.get_coordinates(part, include_z=True) * unit
                if len(places) > 1:
                    lines.append(MapLine(output, places, row))
    return lines


def road_lines(lines: list[MapLine]) -> list[RoadLine]:
    """Those that run along a road, by the stations in their fields; where none is, the longest line alone, pieces of one line joined."""
    result = []
    for line in lines:
        first, last = line.number("station"), line.number("end")
        if line.output not in LEADING or not (math.isfinite(first) and math.isfinite(last)):
            continue
        places = line.places[::-1] if line.row.get("direction") == -1 else line.places   # driving lines run with the traffic
        road = line.row.get("road")
        made = road_line(road if isinstance(road, int) else 0, LEADING.index(line.output), places, min(first, last), max(first, last))
        result += [made] if made is not None else []
    if result or not lines:
        return result
    best = min(LEADING.index(line.output) if line.output in LEADING else len(LEADING) for line in lines)
    candidates = [line.places for line in lines if (LEADING.index(line.output) if line.output in LEADING else len(LEADING)) == best]
    joined = shapely.get_parts(shapely.line_merge(shapely.multilinestrings([shapely.linestrings(places) for places in candidates])))
    longest = shapely.get_coordinates(max(joined, key=lambda line: line.length), include_z=True)
    made = road_line(0, 0, longest, 0.0, float(np.hypot(*np.diff(longest[:, :2], axis=0).T).sum()))
    return [made] if made is not None else []


def accuracy_of(layers: dict[str, QgsMapLayer]) -> str:
    """What the layers themselves say of their accuracy: the median along the lines of their sigma, and the confidence of the driving lines."""
    sentences = []
    for output, label in (("ROAD_EDGES", tr("road edges")), ("DRIVING_LINES", tr("driving lines"))):
        sigma = _along(layers.get(output), "sigma_m", 0.5)
        if math.isfinite(sigma):
            sentences.append(tr("{what} {number:.1f} cm").format(what=label, number=100 * sigma))
    trust = _along(layers.get("DRIVING_LINES"), "confidence", None)
    if math.isfinite(trust):
        sentences.append(tr("confidence {number:.2f}").format(number=trust))
    return ", ".join(sentences) or tr("not stated")


def _along(layer, name, quantile):
    """The quantile (None: the mean) of a field along the lines of a layer; NaN where there is none."""
    if layer is None or layer.fields().indexOf(name) < 0:
        return math.nan
    rows = [(feature[name], feature.geometry().length()) for feature in layer.getFeatures()]
    values = np.array([row for row in rows if isinstance(row[0], (int, float))], float).reshape(-1, 2)
    values = values[np.isfinite(values).all(axis=1) & (values[:, 1] > 0)]
    if not len(values):
        return math.nan
    if quantile is None:
        return float(np.average(values[:, 0], weights=values[:, 1]))
    values = values[np.argsort(values[:, 0])]
    return float(values[np.searchsorted(np.cumsum(values[:, 1]), quantile * values[:, 1].sum()), 0])
