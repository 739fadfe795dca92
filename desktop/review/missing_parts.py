"""What a road map does not hold: edges that were not found, surface without an edge, ends of lanes, and what a run warned of."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

from qgis.core import NULL, QgsFeature, QgsGeometry, QgsMapLayer

from ...core.common.texts import places_in
from ...processing_provider.results.attributes import WORDS
from ...processing_provider.results.road_maps import RoadMap
from ...processing_provider.texts import told, tr

LEAST_GAP = 15.0   # m without an edge, or of grown surface, that are a place: as far as edges are bridged by default; mouths of side streets are less
ROAD_END = 10.0    # m from the end of a road within which a lane may end
ALONG = ("PASSES", "DRIVING_LINES", "MARKING_LINES", "ROAD_EDGES")  # lines that say where a station lies, best first
AWAY = ("corner", "side_street", "island")  # edges that do not run along the road
# Share of a stretch that is likely to be wrong, by which places are ranked, and m where there is no stretch: an edge that is not drawn
# is missing or not there, of grown surface one margin of two is, a lane ends or goes on, and who reads a warning looks there first.
LIKELY_WRONG = {"gap": 0.5, "grown": 0.5, "lane_end": 5.0, "warning": 1.0}


@dataclass(frozen=True)
class DoubtfulPiece:
    """One piece of a line or lane that is doubtful, or something that is not there."""

    text: str   # what is doubtful
    kind: str   # edge, marking, lane, surface or warning
    line: QgsGeometry   # its course
    road: int   # road, station: where it begins along the road
    station: float
    doubt: float   # m of it that are likely to be wrong
    target: str = ""   # what a correction calls it; "" where there is nothing that a correction could be about
    offset: float | None = None   # where it begins across the road
    other: str = ""   # the second reading of the program, as the layer holds it; "" where there is none

    @property
    def key(self) -> str:
        """By which the piece is known when the places are made again."""
        return f"{self.kind} {self.road} {self.station:.1f} {'' if self.offset is None else f'{self.offset:.1f}'}"


def missing_edges(road_map: RoadMap) -> Iterator[DoubtfulPiece]:
    """Stretches along which one side of a road has no edge."""
    covered = defaultdict(list)
    for feature, road, start, end in _rows(road_map.layer("ROAD_EDGES"), "side"):
        if _value(feature, "kind") != "island":
            covered[road, feature["side"]].append((start, end))
    for road, (start, end) in sorted(_roads(road_map).items()):
        for side in ("left", "right") if covered else ():
            for first, last in _uncovered(covered[road, side], start, end):
                line = along(road_map, road, first, last) if last - first >= LEAST_GAP else None
                if line is not None:
                    text = tr("No road edge on the {side} for {length:.0f} m").format(side=WORDS["side"][side], length=last - first)
                    yield DoubtfulPiece(text, "edge", line, road, first, LIKELY_WRONG["gap"] * (last - first))


def grown_surface(road_map: RoadMap) -> Iterator[DoubtfulPiece]:
    """Surface that ends at no edge."""
    for feature, road, start, end in _rows(road_map.layer("ROAD_SURFACE"), "status"):
        if feature["status"] == "grown" and end - start >= LEAST_GAP:
            geometry = feature.geometry()  # its parts live no longer than it
            rim = QgsGeometry(next(geometry.constParts()).exteriorRing().clone())
            text = tr("Road surface, {length:.0f} m: grown, no edge was found on one side at least").format(length=end - start)
            yield DoubtfulPiece(text, "surface", rim, road, start, LIKELY_WRONG["grown"] * (end - start))


def lane_ends(road_map: RoadMap) -> Iterator[DoubtfulPiece]:
    """Driven lanes that end before their road does."""
    roads = _roads(road_map)
    for feature, road, start, end in _rows(road_map.layer("LANES"), "direction", "successors", "type", "lane"):
        direction = feature["direction"]
        if feature["type"] != "driving" or direction not in (1, -1) or feature["successors"] not in (None, NULL, ""):
            continue
        station, left = (end, roads[road][1] - end) if direction == 1 else (start, start - roads[road][0])
        line = along(road_map, road, station - 1.0, station + 1.0) if left > ROAD_END else None
        if line is not None:
            text = tr("Lane {lane} ends here, {left:.0f} m before the end of the road").format(lane=feature["lane"], left=left)
            yield DoubtfulPiece(text, "lane", line, road, station, LIKELY_WRONG["lane_end"])


def warned_places(road_map: RoadMap) -> Iterator[DoubtfulPiece]:
    """Places that the warnings of the run name."""
    for text in road_map.provenance.warnings:
        for place in places_in(text):
            line = along(road_map, place.road, place.start, max(place.end, place.start + 1.0))
            if line is not None:
                yield DoubtfulPiece(tr("Warning: {text}").format(text=told(text)), "warning", line, place.road, place.start,
                                    LIKELY_WRONG["warning"] * max(place.end - place.start, 1.0))


def along(road_map: RoadMap, road: int, start: float, end: float) -> QgsGeometry | None:
    """The part of a line along a road between two stations, of the first kind of line that covers most of it; None where there is none."""
    best, most = None, 0.0
    for output in ALONG:
        for feature, its_road, first, last in _rows(road_map.layer(output)):
            inside = min(last, end) - max(first, start)
            if its_road == road and last > first and inside > most and _value(feature, "kind") not in AWAY:
                best, most = _part(feature, first, last, max(first, start), min(last, end)), inside
        if most > 0.9 * (end - start):
            break
    return best


def _part(feature, first, last, start, end):
    """The part of a feature's line between two stations, of which it covers `first` to `last`."""
    geometry = feature.geometry()  # its parts live no longer than it
    curve = next(geometry.constParts())
    scale = curve.length() / (last - first)
    begin, finish = (start - first) * scale, (end - first) * scale
    if _value(feature, "direction") == -1:
        begin, finish = curve.length() - finish, curve.length() - begin
    part = QgsGeometry(curve.curveSubstring(max(begin, 0.0), min(finish, curve.length())))
    part.get().dropZValue()
    return part


def _rows(layer: QgsMapLayer | None, *needed: str) -> Iterator[tuple[QgsFeature, int, float, float]]:
    """(feature, road, first and last station) of a layer that has these fields; rows that do not say where they lie are passed over."""
    names = set() if layer is None else {field.name() for field in layer.fields()}
    for feature in layer.getFeatures() if {"road", "station_m", "end_m", *needed} <= names else ():
        location = [feature["road"], feature["station_m"], feature["end_m"]]
        if not any(value in (None, NULL) for value in location) and not feature.geometry().isEmpty():
            yield feature, int(location[0]), min(location[1:]), max(location[1:])


def _value(feature, name):
    """The value of a field, None where there is no such field."""
    return feature[name] if feature.fieldNameIndex(name) >= 0 else None


def _roads(road_map):
    """{road: (first, last station)} that what is drawn of it covers; passes begin before the first points and end behind the last."""
    extents: dict[int, tuple[float, float]] = {}
    for output in (*ALONG[1:], "ROAD_SURFACE", "LANES"):
        for _, road, start, end in _rows(road_map.layer(output)):
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
