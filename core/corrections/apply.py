"""Corrections applied to lines of any kind, to road edges, to markings and to lanes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ..common.arrays import mask_runs
from ..curves.model_selection import fit_curve
from ..driving.lane_areas import NO_BORDER, follow, make_lanes
from ..driving.layers import CurveElements, DrivingLines, Lanes
from ..markings.lines.painted_lines import PaintedLines, painted_lines_of, pieces_of_lines
from ..markings.objects.marking_objects import MarkingObjects
from ..road.edges.road_edges import EdgePiece, RoadEdges, joined_pieces
from ..survey.frame.placement import located
from ..survey.frame.road_frame import RoadFrame
from .corrections import ACCEPTED, DRAWN, Correction, Corrections
from .weights import CORRECTING


class _LineKind(ABC):
    """What is the same in all corrections of one kind of line. `known` : (K, 3) local places whose heights are known"""

    reach = 0.5   # m beside a correction within which it is about such a line
    key = "places"   # by which a piece holds (V, C) what it has at every vertex: x, y and more

    def __init__(self, frame: RoadFrame, known: np.ndarray):
        self.frame, self.known = frame, known

    def with_columns(self, piece: dict[str, Any], columns: np.ndarray) -> dict[str, Any]:
        """The piece with other vertices."""
        return {**piece, self.key: columns}

    @abstractmethod
    def drawn(self, correction: Correction, places: np.ndarray, like: dict[str, Any] | None, pieces: Sequence[dict[str, Any]]) -> dict[str, Any]:
        """A piece along (V, 3) local places; `like` is the piece that was moved there, None where there was none."""

    def part(self, piece: dict[str, Any], first: float, last: float) -> dict[str, Any]:
        """The piece from one place along it to another, with its stations."""
        columns = cut(piece[self.key], first, last)
        return self.with_columns(self.with_stations(piece, columns), columns)

    def with_stations(self, piece: dict[str, Any], columns: np.ndarray) -> dict[str, Any]:
        """The piece with the stations of other vertices; as they were where these have no foot on the road."""
        s, _ = located(self.frame, np.full(2, piece["road"]), columns[[0, -1], 0], columns[[0, -1], 1])
        return dict(piece, station=float(s.min()), end=float(s.max())) if np.isfinite(s).all() else dict(piece)

    def accepted(self, piece: dict[str, Any]) -> dict[str, Any]:
        return dict(piece, status=ACCEPTED)

    def taken(self, piece: dict[str, Any], correction: Correction) -> dict[str, Any]:
        """The piece as its second reading says, which a correction takes."""
        return self.accepted(piece)


def apply_corrections(kind: _LineKind, pieces: list[dict[str, Any]], corrections: Sequence[Correction]) -> tuple[list[dict[str, Any]], set[int]]:
    """Pieces of lines as an analyst corrected them, one correction after the other.

    Accepted stretches get the status `accepted`. What is drawn or moved replaces what lies along its new place, has the status `drawn`
    and the heights of the map around it.

    Returns pieces, and the rows of the corrections that something was found for: without any nothing has changed
    """
    matched: set[int] = set()
    for correction in corrections:
        reach = max(CORRECTING.moved_from, kind.reach) if correction.action == "move" else kind.reach
        spans = _spans_along([piece[kind.key][:, :2] for piece in pieces], correction, reach)
        if not (correction.on_a_road if correction.action == "draw" else spans):
            continue
        matched.add(correction.row)
        like = pieces[spans[0][0]] if spans and correction.action == "move" else None
        pieces = _replaced(kind, pieces, spans, correction)
        if correction.draws:
            pieces.append(kind.drawn(correction, _with_heights(kind, correction), like, pieces))
    return pieces, matched


def _replaced(kind, pieces, spans, correction):
    """Pieces without the stretches, or with the stretches accepted."""
    result = []
    for k, piece in enumerate(pieces):
        on_piece = [(a, b) for number, a, b in spans if number == k]
        if not on_piece:
            result.append(piece)
            continue
        length = float(np.hypot(*np.diff(piece[kind.key][:, :2], axis=0).T).sum())
        parts = pieces_of(length, on_piece)
        for a, b, along in parts:
            stretch = piece if len(parts) == 1 else kind.part(piece, a, b)
            if not along:
                result.append(stretch)
            elif correction.action == "accept":
                result.append(kind.accepted(stretch))
            elif correction.action == "take":
                result.append(kind.taken(stretch, correction))
    return result


def _with_heights(kind, correction):
    """(V, 3) the places of a correction with heights."""
    places = correction.places
    if not correction.on_a_road:
        return np.c_[places[:, :2], _heights_for(places, kind.known, np.zeros(len(places)))]
    s, _ = located(kind.frame, np.full(len(places), correction.road), places[:, 0], places[:, 1])
    track = kind.frame.track_height(correction.road, np.where(np.isfinite(s), s, correction.station))
    return np.c_[places[:, :2], _heights_for(places, kind.known, track)]


# Which stretches of lines a correction is about, and lines cut there.

Span = tuple[int, float, float]   # (number of the line, from, to), metres along it


def _spans_along(lines: Sequence[np.ndarray], correction: Correction, reach: float) -> list[Span]:
    """The stretches of lines, (V, 2 or more) each, local x, y, ..., that a correction is about, within `reach` m beside it.

    Of lines beside each other it is the nearest. A point is about the whole of the nearest line.
    """
    places = correction.places[:, :2]
    low, high = places.min(0) - reach, places.max(0) + reach
    near = [k for k, line in enumerate(lines) if len(line) > 1 and (line[:, :2].max(0) >= low).all() and (line[:, :2].min(0) <= high).all()]
    if len(places) == 1:
        candidates = [(float(shapely.distance(shapely.linestrings(lines[k][:, :2]), shapely.points(places[0]))), k) for k in near]
        best = min(candidates, default=(np.inf, -1))
        return [(best[1], 0.0, _arcs(lines[best[1]])[-1])] if best[0] <= reach else []
    stretches = sorted(stretch for k in near for stretch in _beside(lines[k][:, :2], k, places, reach))
    covered: list[tuple[float, float]] = []
    spans = []
    for _, k, a, b, first, last in stretches:
        if sum(max(min(last, v) - max(first, u), 0.0) for u, v in covered) < (last - first) / 2:
            covered.append((first, last))
            spans.append((k, a, b))
    return spans


def _beside(line, number, places, reach):
    """(mean distance, number, from, to, first, last along the correction) of each stretch of a line beside a correction."""
    arcs = _arcs(line)
    along = np.unique(np.r_[np.arange(0.0, arcs[-1], CORRECTING.step), arcs[-1]])
    xy = np.c_[np.interp(along, arcs, line[:, 0]), np.interp(along, arcs, line[:, 1])]
    course = shapely.linestrings(places)
    u = shapely.line_locate_point(course, shapely.points(xy))
    distance = shapely.distance(course, shapely.points(xy))
    head, tail = _excess(xy, places[0], places[1]), _excess(xy, places[-1], places[-2])
    inside = (distance <= reach) & ~((u <= 0) & (head > CORRECTING.step)) & ~((u >= course.length) & (tail > CORRECTING.step))
    least = min(CORRECTING.shortest, course.length / 2)
    for i, j in mask_runs(inside):
        a, b = along[i], along[j - 1]
        first, last = u[i:j].min(), u[i:j].max()
        if b - a < least and b - a < arcs[-1] / 2 or last - first < CORRECTING.along * (b - a) or b <= a:
            continue
        a, b = 0.0 if a < CORRECTING.shortest_rest else a, arcs[-1] if arcs[-1] - b < CORRECTING.shortest_rest else b
        yield float(distance[i:j].mean()), number, float(a), float(b), float(first), float(last)


def _excess(xy, end, inner):
    """(N,) m by which places lie beyond the end of a line, along its last part."""
    way = end - inner
    return (xy - end) @ way / max(np.hypot(*way), 1e-9)


def _arcs(line):
    return np.append(0.0, np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T)))


def cut(columns: np.ndarray, start: float, end: float) -> np.ndarray:
    """(K, C) the rows of (V, C) columns, x and y first, from one place to another, m along them; columns are interpolated at both ends."""
    arcs = _arcs(columns)
    inside = (arcs > start + 1e-6) & (arcs < end - 1e-6)
    along = np.r_[start, arcs[inside], end]
    ends = np.array([[np.interp(distance, arcs, column) for column in columns.T] for distance in (along[0], along[-1])])
    return np.concatenate([ends[:1], columns[inside], ends[1:]])


def pieces_of(length: float, spans: Sequence[tuple[float, float]]) -> list[tuple[float, float, bool]]:
    """(from, to, whether it is a span) of a line that is cut where spans begin and end, in order."""
    result, reached = [], 0.0
    for a, b in sorted(spans):
        a, b = max(a, reached), max(b, reached)
        result += [(reached, a, False), (a, b, True)]
        reached = b
    # sums of lengths differ in their last digits
    return [(a, b, along) for a, b, along in [*result, (reached, length, False)] if b - a > CORRECTING.no_length]


def _heights_for(places: np.ndarray, known: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """(N,) z of (N, 3) places: their own where they have one, else that of the (K, 3) vertices of the map near them, else another."""
    z, known = places[:, 2].copy(), known[np.isfinite(known).all(1)]
    lacking = np.flatnonzero(~np.isfinite(z))
    z[lacking] = otherwise[lacking]
    if len(known):
        count = min(CORRECTING.height_neighbours, len(known))
        distance, row = cKDTree(known[:, :2]).query(places[lacking, :2], count, distance_upper_bound=CORRECTING.near_vertices)
        distance, row = distance.reshape(len(lacking), count), row.reshape(len(lacking), count)
        weight = np.where(np.isfinite(distance), 1.0 / np.maximum(distance, 0.05), 0.0)
        total = weight.sum(1)
        near = total > 0
        heights = np.append(known[:, 2], 0.0)[np.minimum(row, len(known))]
        z[lacking[near]] = (weight * heights).sum(1)[near] / total[near]
    return z


# Road edges as an analyst corrected them.


class _Edges(_LineKind):
    """Pieces hold what EdgePiece holds, but for their vertices, which are local."""

    key = "local"

    def with_columns(self, piece, columns):
        return dict(super().with_columns(piece, columns), length=float(np.hypot(*np.diff(columns[:, :2], axis=0).T).sum()))

    def drawn(self, correction, places, like, pieces):
        free = max((piece["chain"] for piece in pieces), default=0) + 1
        blank = dict(road=correction.road, side="left" if correction.offset > 0 else "right", chain=free, station=correction.station,
                     end=correction.station, length=0.0)
        # the two methods say nothing of a place that they did not find
        piece = dict(blank if like is None else like, status=DRAWN, agree=np.nan, rmse=np.nan, sigma=np.nan)
        if np.isfinite(correction.height):
            piece["height"] = correction.height
        return self.with_columns(self.with_stations(piece, places), places)


def correct_edges(edges: RoadEdges, frame: RoadFrame, corrections: Corrections) -> RoadEdges:
    """Road edges with the corrections of the target edge, which are noted where something was found for them; the same object without any."""
    edge_corrections = corrections.of("edge")
    if not edge_corrections:
        return edges
    places = np.c_[edges.course.x, edges.course.y, edges.course.z]
    kind = _Edges(frame, places)
    names = [field.name for field in fields(EdgePiece) if field.name not in ("vertices", "road")]
    columns = {name: np.asarray(getattr(edges, name)).tolist() for name in names}
    rows = [dict(zip(columns, row)) for row in zip(*columns.values())]
    before = [dict(row, road=int(edges.road[k]), local=places[edges.course.line(k)]) for k, row in enumerate(rows)]
    pieces, matched = apply_corrections(kind, before, edge_corrections)
    corrections.matched |= matched
    if not matched:
        return edges
    return joined_pieces([EdgePiece(**{name: value for name, value in piece.items() if name != "local"}, vertices=piece["local"] + frame.origin)
                          for piece in pieces], frame, edges.crs)


# Markings and marking lines as an analyst corrected them.

USUAL_PATTERN = "solid"


class _Lines(_LineKind):
    """Pieces hold what `pieces_of_lines` gives; of two lines beside each other, such as a double line, the nearer one is meant."""

    def with_columns(self, piece, columns):
        arc, _ = piece["curve"].project(columns[[0, -1], 0], columns[[0, -1], 1])
        return dict(super().with_columns(piece, columns), arc=arc)

    def taken(self, piece, correction):
        return dict(self.accepted(piece), kind=correction.kind)

    def drawn(self, correction, places, like, pieces):
        fit = fit_curve(places[:, 0], places[:, 1])
        free = max((piece["line"] for piece in pieces), default=0) + 1
        widths = [piece["width"] for piece in pieces if np.isfinite(piece["width"])]
        blank = dict(road=correction.road, line=free, pattern=USUAL_PATTERN, station=correction.station, end=correction.station,
                     width=float(np.median(widths)) if widths else np.nan)
        # what the estimate named a line that was moved is no name by hand
        attributes = dict(kind=correction.kind, pattern=correction.pattern or (like or blank)["pattern"])
        u, _ = fit.curve.project(places[[0, -1], 0], places[[0, -1], 1])
        piece = dict(blank if like is None else like, **attributes, status=DRAWN, curve=fit.curve, arc=u, rmse=np.nan,
                     offset=correction.offset, places=places)
        return self.with_stations(piece, places)


def correct_markings(markings: MarkingObjects, corrections: Corrections) -> MarkingObjects:
    """Markings less those that were deleted: lines are then not made of them either; the same object where there are none.

    A correction is about the markings whose middle lies within 0.5 m of its line, or of which its point lies within 0.5 m.
    Corrections that something was found for are noted; to accept a marking changes nothing of it.
    """
    marking_corrections = [row for row in corrections.of("marking") if row.action in ("accept", "delete")]
    if not marking_corrections or not len(markings):
        return markings
    polygons = markings.outlines.polygons()
    middles = shapely.point_on_surface(polygons)
    keep = np.ones(len(markings), bool)
    for correction in marking_corrections:
        alone = len(correction.places) == 1
        drawn = shapely.points(correction.places[0, :2]) if alone else shapely.linestrings(correction.places[:, :2])
        affected = shapely.distance(polygons if alone else middles, drawn) <= _LineKind.reach
        if affected.any():
            corrections.matched.add(correction.row)
            if correction.action == "delete":
                keep &= ~affected
    return markings if keep.all() else markings[keep]


def correct_marking_lines(lines: PaintedLines, frame: RoadFrame, corrections: Corrections, known: np.ndarray) -> PaintedLines:
    """Marking lines with the corrections of the target marking, which are noted where something was found for them; the same object without any.

    Lines that were drawn have no `kind` unless the correction says one. `known` : (K, 3) further local places whose heights are known.
    """
    line_corrections = corrections.of("marking")
    if not line_corrections or lines.fitted is None:
        return lines
    kind = _Lines(frame, np.concatenate([lines.fitted.vertices, known]))
    pieces, matched = apply_corrections(kind, pieces_of_lines(lines), line_corrections)
    corrections.matched |= matched
    return painted_lines_of(pieces, frame, lines.crs) if matched else lines


# Driving lines, lanes and curve elements as an analyst corrected them.

LANE_REACH = 1.0   # derived: m, half of the narrowest lane
NO_LINES = "none|none"
SURE = 1.0   # derived: confidence of what an analyst confirmed or drew


class _DrivingLines(_LineKind):
    """Pieces hold what `DrivingLines.of_pieces` takes."""

    reach = LANE_REACH

    def __init__(self, frame: RoadFrame, known: np.ndarray, lane_width: float):
        super().__init__(frame, known)
        self.lane_width = lane_width
        self.by_correction: dict[int, dict[str, Any]] = {}   # what was drawn, by the id of its correction, whatever became of it afterwards

    def accepted(self, piece):
        return dict(super().accepted(piece), confidence=SURE, other="")

    def drawn(self, correction, places, like, pieces):
        way = _way(self.frame, correction, places) if like is None else like["direction"]
        lanes = [int(piece["lane"]) for piece in pieces if piece["road"] == correction.road]
        blank = dict(road=correction.road, lane=max(lanes, default=0) + 1, pattern=NO_LINES, direction=way, station=correction.station,
                     end=correction.station, width=correction.width if np.isfinite(correction.width) else self.lane_width)
        places = places if _way(self.frame, correction, places) == way else places[::-1]
        fit = fit_curve(places[:, 0], places[:, 1])
        piece = dict(blank if like is None else like, source="drawn", status=DRAWN, confidence=SURE, other="", curve=fit.curve, rmse=np.nan,
                     sigma=np.nan, offset=correction.offset, places=places, design_speed=None)
        self.by_correction[id(correction)] = piece = self.with_stations(piece, places)
        return piece


class _Lanes(_LineKind):
    """Pieces hold what `make_lanes` takes, and in `columns` their middle and both borders side by side."""

    reach, key = LANE_REACH, "columns"

    def __init__(self, frame: RoadFrame, known: np.ndarray, lines: dict[int, dict[str, Any]]):
        super().__init__(frame, known)
        self.lines = lines   # driving lines that were drawn, by the id of the correction: they have its lane and width

    def with_columns(self, piece, columns):
        return dict(super().with_columns(piece, columns), changed=True)

    def accepted(self, piece):
        return dict(super().accepted(piece), confidence=SURE, other="", changed=True)

    def drawn(self, correction, places, like, pieces):
        line = self.lines[id(correction)]
        middle = line["places"]
        way = np.gradient(middle[:, :2], axis=0)
        left = np.c_[-way[:, 1], way[:, 0]] / np.maximum(np.hypot(*way.T), 1e-9)[:, None] * line["width"] / 2
        sides = [np.c_[middle[:, :2] + side * left, middle[:, 2]] for side in (1, -1)]
        piece = dict(road=line["road"], lane=line["lane"], type="driving", direction=line["direction"], about=[NO_BORDER, NO_BORDER], status=DRAWN,
                     confidence=SURE, station=line["station"], end=line["end"], lane_id="")
        return self.with_columns(piece, np.concatenate([middle, *sides], axis=1))


def correct_lanes(lines: DrivingLines, elements: CurveElements, lanes: Lanes, frame: RoadFrame, corrections: Corrections, lane_width: float,
                  known: np.ndarray) -> tuple[DrivingLines, CurveElements, Lanes]:
    """Driving lines, curve elements and lanes with the corrections of the target lane; the same objects without any.

    Corrections that something was found for are noted. Lanes that are cut have as many ids as pieces, and what follows each is found anew on their
    roads. Where half of a curve was taken away its elements go too. `lane_width` : m of a lane that is drawn where its road has none; `known` :
    (K, 3) further local places whose heights are known.
    """
    lane_corrections = corrections.of("lane")
    if not lane_corrections:
        return lines, elements, lanes
    known = np.concatenate([lines.vertices, known])
    width = float(np.median(lines.width)) if len(lines) else lane_width
    names = [field.name for field in fields(lines) if field.name not in ("curve", "vertices", "start", "crs")]
    before = [dict({name: getattr(lines, name)[k] for name in names}, curve=lines.curve[k], places=lines.vertices[lines.start[k]:lines.start[k + 1]])
              for k in range(len(lines))]
    lane_corrections = [part for correction in lane_corrections
                        for part in (_taken(correction, before, frame) if correction.action == "take" else [correction])]
    corrections.matched |= {correction.row for correction in corrections.of("lane")
                            if correction.action == "take" and correction.on_a_road and not correction.lanes}
    kind = _DrivingLines(frame, known, width)
    rows, of_lines = apply_corrections(kind, before, lane_corrections)
    # the area of a lane is drawn about its driving line
    lane_corrections = [correction for correction in lane_corrections if not correction.draws or id(correction) in kind.by_correction]
    areas, of_lanes = apply_corrections(_Lanes(frame, known, kind.by_correction), _rows_of_lanes(lanes), lane_corrections)
    corrections.matched |= of_lines | of_lanes
    if of_lines:
        lines, elements = DrivingLines.of_pieces(rows, lines.crs), _remaining(elements, before, rows)
    return lines, elements, _lanes_of(areas, frame, lanes.crs) if of_lanes else lanes


def _taken(correction, pieces, frame):
    """What a second reading that was taken comes to: each of its lanes is accepted where the estimate made it, drawn where it did not.

    The lane that it was taken for goes, unless it is one of them.
    """
    if not correction.on_a_road or len(correction.places) < 2:
        return [correction]
    road = frame.roads[correction.road]
    s, d = road.locate(*correction.places[:, :2].T)
    if not np.isfinite(d).all():
        return [correction]
    result = [replace(correction, action="delete")]
    for offset, width, way in correction.lanes:
        x, y = road.to_map(s, d + offset - np.median(d))
        order = np.argsort(s * way)
        drawn = replace(correction, action="draw", places=np.c_[x, y, correction.places[:, 2]][order], offset=offset, width=width)
        same_way = [piece["places"] for piece in pieces if piece["direction"] == way]
        length = sum(last - first for _, first, last in _spans_along(same_way, replace(drawn, action="accept"), CORRECTING.taken_reach))
        if length >= CORRECTING.taken_share * np.hypot(*np.diff(drawn.places[:, :2], axis=0).T).sum():
            # what the estimate made is accepted, and not deleted with the lane beside it
            result = [part for part in result if part.action != "delete"]
            result.append(replace(drawn, action="accept"))
        else:
            result.append(drawn)
    return result


def _rows_of_lanes(lanes):
    names = ("road", "lane", "lane_id", "type", "direction", "status", "confidence", "other", "station", "end")
    rows = []
    for k in range(len(lanes)):
        left, right = lanes.borders(k)
        borders = [(lanes.left_line[k], lanes.left_kind[k], lanes.left_pattern[k]),
                   (lanes.right_line[k], lanes.right_kind[k], lanes.right_pattern[k])]
        rows.append(dict({name: getattr(lanes, name)[k] for name in names}, about=borders, successors=lanes.successors[k],
                         columns=np.c_[(left + right) / 2, left, right], changed=False))
    return rows


def _lanes_of(pieces, frame, crs):
    """Lanes of pieces of which some were changed: their ids, and what follows on their roads."""
    changed = {(piece["road"], piece["lane"]) for piece in pieces if piece["changed"]}
    before = {piece["lane_id"] for piece in pieces}
    for road, lane in sorted(changed):
        pieces_of_lane = sorted((piece for piece in pieces if (piece["road"], piece["lane"]) == (road, lane)), key=lambda piece: piece["station"])
        for number, piece in enumerate(pieces_of_lane, start=1):
            piece["lane_id"] = f"{road}.{lane}.{number}"
    for piece in pieces:
        middle, half = piece["columns"], np.hypot(*(piece["columns"][:, 3:5] - piece["columns"][:, 6:8]).T) / 2
        _, d = located(frame, np.full(2, piece["road"]), middle[[0, -1], 0], middle[[0, -1], 1])
        first, last = d if piece["direction"] >= 0 else d[::-1]
        piece.update(first=float(first), last=float(last), width=float(2 * np.median(half)), left=middle[:, 3:6], right=middle[:, 6:9])
        piece.setdefault("successors", ())
    lost_ids = before - {piece["lane_id"] for piece in pieces}
    roads = {road for road, _ in changed} | {piece["road"] for piece in pieces if lost_ids & set(piece["successors"])}
    for road in sorted(roads):
        follow([piece for piece in pieces if piece["road"] == road])
    ids = {piece["lane_id"] for piece in pieces}
    after = {piece["lane_id"]: (piece["lane"], set(piece["successors"]) & ids) for piece in pieces}
    for piece in pieces:
        # behind a short piece lies what follows that piece
        through = {name for follower in after[piece["lane_id"]][1] if after[follower][0] == piece["lane"] for name in after[follower][1]}
        piece["successors"] = tuple(name for name in piece["successors"] if name in ids - through)
    return make_lanes(pieces, crs)


def _remaining(elements: CurveElements, before: list[dict[str, Any]], after: list[dict[str, Any]]) -> CurveElements:
    """Curve elements less those of which half lies on no piece of the lane any more that was there before."""
    keep = np.ones(len(elements), bool)
    for k in range(len(elements)):
        lane = (elements.road[k], elements.lane[k])
        covered, left = (sum(max(min(elements.end[k], row["end"]) - max(elements.station[k], row["station"]), 0.0) for row in rows
                             if (row["road"], row["lane"]) == lane and row["status"] != DRAWN) for rows in (before, after))
        keep[k] = left >= (1 - CORRECTING.most_lost) * covered
    rows = np.flatnonzero(keep)
    arrays = {field.name: getattr(elements, field.name)[rows] for field in fields(elements) if isinstance(getattr(elements, field.name), np.ndarray)}
    return replace(elements, **arrays, arc=[elements.arc[k] for k in rows])


def _way(frame: RoadFrame, correction: Correction, places: np.ndarray) -> int:
    """1 for a line drawn along the road, -1 for one drawn against it: a lane is drawn as it is driven."""
    s, _ = located(frame, np.full(2, correction.road), places[[0, -1], 0], places[[0, -1], 1])
    return -1 if s[1] < s[0] else 1
