"""Places of a road map that want a look, each with how many metres of it are likely to be wrong."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from qgis.core import NULL, Qgis, QgsCoordinateReferenceSystem, QgsGeometry, QgsLineString, QgsPointXY, QgsRectangle

from ...core.common.texts import places_in
from ...processing_provider.results.road_maps import RoadMap
from ...processing_provider.styling import WORDS, second_reading
from ...processing_provider.texts import told, tr
from .section import titles_of

TARGETS = {"ROAD_EDGES": "edge", "MARKING_LINES": "marking", "DRIVING_LINES": "lane", "LANES": "lane"}  # what a correction calls them
GUESSED = ("bridged", "inferred")
DECIDED = ("accepted", "drawn")  # an analyst has seen these
UNSURE = 0.85       # confidence below which a piece is doubtful: more than one in seven of those are wrong
APART = 5.0         # cm between the two boundary methods, as in the report
SHORTEST = 2.0      # m: shorter pieces are not worth a stop
SAME_PLACE = 10.0   # m of station within which doubts are looked at together


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
    def doubt(self) -> float:
        """m that are likely to be wrong."""
        return sum(piece.doubt for piece in self.pieces)


def doubts_of(road_map: RoadMap, kinds: Iterable[str] = (), shortest: float = 0.0) -> list[Doubt]:
    """The doubtful places, of some kinds of DoubtfulPiece or of all, along the roads of a map; doubts that lie together are one.

    shortest : m; shorter pieces are left out, but not what has no length, such as the end of a lane
    """
    rows = {output: _rows(road_map.layer(output)) for output in (*ALONG, "ROAD_SURFACE", "LANES")}
    pieces = [piece for output in ("ROAD_EDGES", "MARKING_LINES", "DRIVING_LINES") for piece in _doubtful_rows(road_map, output, rows)]
    # a lane is looked at once: its area only where its driving line says nothing
    if road_map.layer("DRIVING_LINES") is None or not any(piece.kind == "lane" for piece in pieces):
        pieces += _doubtful_rows(road_map, "LANES", rows)
    for extra in (_missing_edges(rows), _grown_surface(rows), _lane_ends(rows), _warned_places(rows, road_map.provenance.warnings)):
        pieces += extra
    kept_kinds = set(kinds)
    return _gathered(sorted((piece for piece in pieces if (not kept_kinds or piece.kind in kept_kinds)
                             and not 0.0 < piece.length < shortest), key=lambda piece: (piece.road, piece.station)), road_map.vectors[0].crs())


def _doubtful_rows(road_map, output, rows):
    title, target = titles_of(road_map.layer(output)) if rows[output] else None, TARGETS[output]
    for row, feature, road, _, _ in rows[output]:
        why, share = reason(row)
        if why:
            reading = str(row.get("other") or "")
            if reading:
                why += tr("; almost as likely: {reading}").format(reading=second_reading(reading))
            length = _number(row.get("length_m")) or 0.0
            yield DoubtfulPiece(f"{title(feature)}: {why}", target, course_of(feature.geometry()), road, _number(row["station_m"]),
                                length, length * share, target, _number(row.get("offset_m")), reading)


def reason(row: dict) -> tuple[str, float]:
    """Why a feature of these fields is doubtful, "" where it is not, and the share of it that is likely to be wrong."""
    apart, sure = _number(row.get("agree_cm")), _number(row.get("confidence"))
    if (_number(row.get("length_m")) or 0.0) < SHORTEST or row.get("status") in DECIDED:
        return "", 0.0
    if apart is not None and apart > APART:
        return tr("the two boundary methods lie {apart:.0f} cm apart").format(apart=apart), LIKELY_WRONG["apart"]
    share = LIKELY_WRONG["guessed"] if sure is None else 1.0 - sure
    if sure is not None and sure < UNSURE:
        return tr("confidence {sure:.2f}").format(sure=sure), share
    return tr("not measured") if row.get("status") in GUESSED else "", share


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


# What a road map does not hold: edges that were not found, surface without an edge, ends of lanes, and what a run warned of.

LEAST_GAP = 15.0   # m without an edge, or of grown surface, that are a place: as far as edges are bridged by default; mouths of side streets are less
ROAD_END = 10.0    # m from the end of a road within which a lane may end
ALONG = ("PASSES", "DRIVING_LINES", "MARKING_LINES", "ROAD_EDGES")  # lines that say where a station lies, best first
AWAY = ("corner", "side_street", "island")  # edges that do not run along the road
# Share that is likely to be wrong, by which places are ranked, and m where there is no stretch: of two methods that differ one is wrong; bridged
# and inferred pieces are as an unsure one where they have no confidence (else 1 - confidence); an edge that is not drawn is missing or not there;
# of grown surface one margin of two is; a lane ends or goes on; and who reads a warning looks there first.
LIKELY_WRONG = {"apart": 0.5, "guessed": 1.0 - UNSURE, "gap": 0.5, "grown": 0.5, "lane_end": 5.0, "warning": 1.0}


@dataclass(frozen=True)
class DoubtfulPiece:
    """One piece of a line or lane that is doubtful, or something that is not there."""

    text: str   # what is doubtful
    kind: str   # edge, marking, lane, surface or warning
    line: QgsGeometry   # its course
    road: int   # road, station: where it begins along the road
    station: float
    length: float   # m; 0 of what is a place, such as the end of a lane
    doubt: float   # m of it that are likely to be wrong
    target: str = ""   # what a correction calls it; "" where there is nothing that a correction could be about, but a note that it was seen
    offset: float | None = None   # where it begins across the road
    other: str = ""   # the second reading of the program, as the layer holds it; "" where there is none


def _missing_edges(rows):
    """Stretches along which one side of a road has no edge."""
    covered = defaultdict(list)
    for fields, _, road, start, end in rows["ROAD_EDGES"]:
        if "side" in fields and fields.get("kind") != "island":
            covered[road, fields["side"]].append((start, end))
    for road, (start, end) in sorted(_roads(rows).items()):
        for side in ("left", "right") if covered else ():
            for first, last in _uncovered(covered[road, side], start, end):
                line = _along(rows, road, first, last) if last - first >= LEAST_GAP else None
                if line is not None:
                    text = tr("No road edge on the {side} for {length:.0f} m").format(side=WORDS["side"][side], length=last - first)
                    yield DoubtfulPiece(text, "edge", line, road, first, last - first, LIKELY_WRONG["gap"] * (last - first))


def _grown_surface(rows):
    """Surface that ends at no edge."""
    for fields, feature, road, start, end in rows["ROAD_SURFACE"]:
        if fields.get("status") == "grown" and end - start >= LEAST_GAP:
            geometry = feature.geometry()   # lives as long as its parts
            rim = QgsGeometry(next(geometry.constParts()).exteriorRing().clone())
            text = tr("Road surface, {length:.0f} m: grown, no edge was found on one side at least").format(length=end - start)
            yield DoubtfulPiece(text, "surface", rim, road, start, end - start, LIKELY_WRONG["grown"] * (end - start))


def _lane_ends(rows):
    """Driven lanes that end before their road does."""
    roads = _roads(rows)
    for fields, _, road, start, end in rows["LANES"]:
        direction = fields.get("direction")
        if fields.get("type") != "driving" or direction not in (1, -1) or fields.get("successors") not in (None, NULL, ""):
            continue
        station, left = (end, roads[road][1] - end) if direction == 1 else (start, start - roads[road][0])
        line = _along(rows, road, station - 1.0, station + 1.0) if left > ROAD_END else None
        if line is not None:
            text = tr("Lane {lane} ends here, {left:.0f} m before the end of the road").format(lane=fields.get("lane"), left=left)
            yield DoubtfulPiece(text, "lane", line, road, station, 0.0, LIKELY_WRONG["lane_end"])


def _warned_places(rows, warnings):
    """Places that the warnings of the run name."""
    for text in warnings:
        for place in places_in(text):
            line = _along(rows, place.road, place.start, max(place.end, place.start + 1.0))
            if line is not None:
                yield DoubtfulPiece(tr("Warning: {text}").format(text=told(text)), "warning", line, place.road, place.start,
                                    place.end - place.start, LIKELY_WRONG["warning"] * max(place.end - place.start, 1.0))


def _along(rows, road, start, end):
    """The part of a line along a road between two stations, of the first kind of line that covers most of it; None where there is none."""
    best, most = None, 0.0
    for output in ALONG:
        for fields, feature, its_road, first, last in rows[output]:
            inside = min(last, end) - max(first, start)
            if its_road == road and last > first and inside > most and fields.get("kind") not in AWAY:
                best, most = (fields, feature.geometry(), first, last), inside
        if most > 0.9 * (end - start):
            break
    return None if best is None else _part(*best, start, end)


def _part(fields, geometry, first, last, start, end):
    """The part of a line between two stations, of which it covers `first` to `last`."""
    curve = next(geometry.constParts())
    scale = curve.length() / (last - first)
    begin, finish = (max(first, start) - first) * scale, (min(last, end) - first) * scale
    if fields.get("direction") == -1:
        begin, finish = curve.length() - finish, curve.length() - begin
    part = QgsGeometry(curve.curveSubstring(max(begin, 0.0), min(finish, curve.length())))
    part.get().dropZValue()
    return part


def _rows(layer):
    """[({field: value}, feature, road, first and last station)] of a layer; rows that do not say where they lie are passed over."""
    names = [] if layer is None else [field.name() for field in layer.fields()]
    rows = []
    for feature in layer.getFeatures() if {"road", "station_m"} <= set(names) else ():
        fields = dict(zip(names, feature.attributes()))
        road, start, end = (_number(fields.get(name)) for name in ("road", "station_m", "end_m"))
        if None not in (road, start) and not feature.geometry().isEmpty():
            end = start if end is None else end
            rows.append((fields, feature, int(road), min(start, end), max(start, end)))
    return rows


def _roads(rows):
    """{road: (first, last station)} that what is drawn of it covers; passes begin before the first points and end behind the last."""
    extents: dict[int, tuple[float, float]] = {}
    for output in (*ALONG[1:], "ROAD_SURFACE", "LANES"):
        for _, _, road, start, end in rows[output]:
            extent = extents.get(road, (start, end))
            extents[road] = min(extent[0], start), max(extent[1], end)
    return extents


def _uncovered(covered, start, end):
    """Gaps of intervals between two stations."""
    reached = start
    for first, last in sorted(covered):
        if first > reached:
            yield reached, min(first, end)
        reached = max(reached, last)
    if end > reached:
        yield reached, end
