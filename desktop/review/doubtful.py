"""Places of a road map that want a look, each with how many metres of it are likely to be wrong."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from qgis.core import Qgis, QgsCoordinateReferenceSystem, QgsGeometry, QgsLineString, QgsPointXY, QgsRectangle

from ...processing_provider.results.attributes import second_reading
from ...processing_provider.results.road_maps import RoadMap
from ...processing_provider.texts import tr
from .missing_parts import DoubtfulPiece, grown_surface, lane_ends, missing_edges, warned_places
from .section import title_of

TARGETS = {"ROAD_EDGES": "edge", "MARKING_LINES": "marking", "DRIVING_LINES": "lane", "LANES": "lane"}  # what a correction calls them
GUESSED = ("bridged", "inferred")
DECIDED = ("accepted", "drawn")  # an analyst has seen these
UNSURE = 0.85       # confidence below which a piece is doubtful: more than one in seven of those are wrong
APART = 5.0         # cm between the two boundary methods, as in the report
SHORTEST = 2.0      # m: shorter pieces are not worth a stop
SAME_PLACE = 10.0   # m of station within which doubts are looked at together

# Share of a piece that is likely to be wrong, by which places are ranked. Of a piece with a confidence it is 1 - confidence.
# Methods that differ: one of the two is wrong. Bridged and inferred pieces without a confidence: as an unsure one.
LIKELY_WRONG = {"apart": 0.5, "guessed": 1.0 - UNSURE}


@dataclass(frozen=True)
class Doubt:
    """One place: the pieces that are doubtful there, where along the road, and its extent and middle in the CRS of the layers."""

    pieces: tuple[DoubtfulPiece, ...]
    road: int
    station: float
    extent: QgsRectangle
    middle: QgsPointXY
    crs: QgsCoordinateReferenceSystem

    @property
    def reasons(self) -> tuple[str, ...]:
        """What is doubtful there, one line a piece."""
        return tuple(piece.text for piece in self.pieces)

    @property
    def doubt(self) -> float:
        """m that are likely to be wrong."""
        return sum(piece.doubt for piece in self.pieces)


def doubts_of(road_map: RoadMap, kinds: Iterable[str] = ()) -> list[Doubt]:
    """The doubtful places of a road map along its roads; doubts that lie together are one place.

    kinds : those of DoubtfulPiece that are wanted; none for all
    """
    pieces = [piece for output in ("ROAD_EDGES", "MARKING_LINES", "DRIVING_LINES") for piece in _doubtful_rows(road_map, output)]
    # a lane is looked at once: its area only where its driving line says nothing
    lanes = [(piece.road, piece.station) for piece in pieces if piece.kind == "lane"]
    if road_map.layer("DRIVING_LINES") is None or not lanes:
        pieces += _doubtful_rows(road_map, "LANES")
    for extra in (missing_edges(road_map), grown_surface(road_map), lane_ends(road_map), warned_places(road_map)):
        pieces += extra
    kept_kinds = set(kinds)
    crs = road_map.vectors[0].crs()
    return _gathered(sorted((piece for piece in pieces if not kept_kinds or piece.kind in kept_kinds),
                            key=lambda piece: (piece.road, piece.station)), crs)


def _doubtful_rows(road_map, output):
    layer = road_map.layer(output)
    names = [] if layer is None else [field.name() for field in layer.fields()]
    result = []
    for feature in layer.getFeatures() if {"station_m", "road"} <= set(names) else ():
        row = dict(zip(names, feature.attributes()))
        why = reason(row)
        if why and not feature.geometry().isEmpty():
            target = TARGETS[output]
            reading = str(row.get("other") or "")
            if reading:
                why += tr("; almost as likely: {reading}").format(reading=second_reading(reading))
            result.append(DoubtfulPiece(f"{title_of(layer, feature)}: {why}", target, course_of(feature.geometry()),
                                        int(_number(row.get("road")) or 0), _number(row.get("station_m")) or 0.0,
                                        (_number(row.get("length_m")) or 0.0) * _share_wrong(row), target, _number(row.get("offset_m")), reading))
    return result


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


def _share_wrong(row):
    apart, sure = _number(row.get("agree_cm")), _number(row.get("confidence"))
    if apart is not None and apart > APART:
        return LIKELY_WRONG["apart"]
    return LIKELY_WRONG["guessed"] if sure is None else 1.0 - sure


def _number(value):
    try:
        number = float(value)
    except (TypeError, ValueError):  # NULL too
        return None
    return number if math.isfinite(number) else None


def course_of(geometry: QgsGeometry) -> QgsGeometry:
    """The line of a feature without heights; of a lane's area, the middle between its borders, along which its ring runs there and back."""
    if geometry.type() == Qgis.GeometryType.Polygon:
        ring = [vertex for vertex in next(geometry.constParts()).exteriorRing().vertices()][:-1]
        left, right = ring[:len(ring) // 2], ring[len(ring) // 2:][::-1]
        return QgsGeometry(QgsLineString([(a.x() + b.x()) / 2 for a, b in zip(left, right)], [(a.y() + b.y()) / 2 for a, b in zip(left, right)]))
    flat = QgsGeometry(geometry)
    flat.get().dropZValue()
    return flat


def _gathered(pieces, crs):
    """Pieces that begin within SAME_PLACE of the first of them are one place, in which a warning that names both sides of a road stands once."""
    groups: list[list[DoubtfulPiece]] = []
    for piece in pieces:
        first = groups[-1][0] if groups else None
        if first is not None and first.road == piece.road and piece.station - first.station <= SAME_PLACE:
            if piece.kind != "warning" or piece.text not in [earlier.text for earlier in groups[-1]]:
                groups[-1].append(piece)
        else:
            groups.append([piece])
    return [_place(group, crs) for group in groups]


def _place(pieces, crs):
    extent = QgsRectangle(pieces[0].line.boundingBox())
    for piece in pieces[1:]:
        extent.combineExtentWith(piece.line.boundingBox())
    first = max(pieces, key=lambda piece: piece.doubt)
    middle = first.line.interpolate(first.line.length() / 2).asPoint() if first.line.length() > 0 else first.line.centroid().asPoint()
    ordered = tuple(sorted(pieces, key=lambda piece: -piece.doubt))
    return Doubt(ordered, pieces[0].road, pieces[0].station, extent, middle, crs)
