"""Places of a road map that want a look: pieces that were not measured, that are uncertain, or where the two boundary methods differ."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.core import Qgis, QgsGeometry, QgsLineString, QgsPointXY, QgsRectangle

from ...processing_provider.results.road_maps import RoadMap
from ...processing_provider.texts import tr
from .section import title_of

OUTPUTS = ("ROAD_EDGES", "MARKING_LINES", "DRIVING_LINES", "LANES")
TARGETS = {"ROAD_EDGES": "edge", "MARKING_LINES": "marking", "DRIVING_LINES": "lane", "LANES": "lane"}  # what a correction calls them
GUESSED = ("bridged", "inferred")
DECIDED = ("accepted", "drawn")  # an analyst has seen these
UNSURE = 0.85       # confidence below which a piece is doubtful: more than one in seven of those are wrong
APART = 5.0         # cm between the two boundary methods, as in the report
SHORTEST = 2.0      # m: shorter pieces are not worth a stop
SAME_PLACE = 10.0   # m of station within which doubts are looked at together


@dataclass(frozen=True)
class DoubtfulPiece:
    """One piece of a line or lane: what is doubtful, its target for a correction, its course, and where it begins along the road."""

    text: str
    target: str
    line: QgsGeometry
    road: int
    station: float
    offset: float | None


@dataclass(frozen=True)
class Doubt:
    """One place: the pieces that are doubtful there, where along the road, and its extent and middle in the CRS of the layers."""

    pieces: tuple[DoubtfulPiece, ...]
    road: int
    station: float
    extent: QgsRectangle
    middle: QgsPointXY
    crs: object

    @property
    def reasons(self) -> tuple[str, ...]:
        """What is doubtful there, one line a piece."""
        return tuple(piece.text for piece in self.pieces)


def doubts_of(road_map: RoadMap) -> list[Doubt]:
    """The doubtful places of a road map along its roads; doubts that lie together are one place."""
    found = []
    for output in OUTPUTS:
        layer = road_map.layer(output)
        names = [] if layer is None else [field.name() for field in layer.fields()]
        if "station_m" not in names or "road" not in names:
            continue
        for feature in layer.getFeatures():
            row = dict(zip(names, feature.attributes()))
            why = reason(row)
            if why and not feature.geometry().isEmpty():
                found.append(_doubt(f"{title_of(layer, feature)}: {why}", row, feature.geometry(), layer, output))
    return _gathered(sorted(found, key=lambda doubt: (doubt.road, doubt.station)))


def reason(row: dict) -> str:
    """Why a feature is doubtful, "" where it is not.

    row : {field: value}; what a layer does not have says nothing
    """
    if (_number(row.get("length_m")) or 0.0) < SHORTEST or row.get("status") in DECIDED:
        return ""
    apart, sure = _number(row.get("agree_cm")), _number(row.get("confidence"))
    if apart is not None and apart > APART:
        return tr("the two boundary methods lie {apart:.0f} cm apart").format(apart=apart)
    if sure is not None and sure < UNSURE:
        return tr("confidence {sure:.2f}").format(sure=sure)
    return tr("not measured") if row.get("status") in GUESSED else ""


def _number(value):
    try:
        return float(value)
    except (TypeError, ValueError):  # NULL too
        return None


def _doubt(text, row, geometry, layer, output):
    middle = geometry.interpolate(geometry.length() / 2).asPoint() if layer.geometryType() == Qgis.GeometryType.Line else \
        geometry.pointOnSurface().asPoint()
    road, station = int(_number(row.get("road")) or 0), _number(row.get("station_m")) or 0.0
    piece = DoubtfulPiece(text, TARGETS[output], course_of(geometry), road, station, _number(row.get("offset_m")))
    return Doubt((piece,), road, station, geometry.boundingBox(), middle, layer.crs())


def course_of(geometry: QgsGeometry) -> QgsGeometry:
    """The line of a feature without heights; of a lane's area, the middle between its borders, along which its ring runs there and back."""
    if geometry.type() == Qgis.GeometryType.Polygon:
        ring = [vertex for vertex in next(geometry.constParts()).exteriorRing().vertices()][:-1]
        left, right = ring[:len(ring) // 2], ring[len(ring) // 2:][::-1]
        return QgsGeometry(QgsLineString([(a.x() + b.x()) / 2 for a, b in zip(left, right)], [(a.y() + b.y()) / 2 for a, b in zip(left, right)]))
    flat = QgsGeometry(geometry)
    flat.get().dropZValue()
    return flat


def _gathered(doubts):
    """Doubts that begin within SAME_PLACE of the first of them are one."""
    places: list[Doubt] = []
    for doubt in doubts:
        last = places[-1] if places else None
        if last is not None and last.road == doubt.road and doubt.station - last.station <= SAME_PLACE:
            extent = QgsRectangle(last.extent)
            extent.combineExtentWith(doubt.extent)
            places[-1] = Doubt(last.pieces + doubt.pieces, last.road, last.station, extent, last.middle, last.crs)
        else:
            places.append(doubt)
    return places
