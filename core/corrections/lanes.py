"""Driving lines, lanes and curve elements as an analyst corrected them."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np

from ..curves.model_selection import fit_curve
from ..driving.lane_areas import NO_BORDER, follow, make_lanes
from ..driving.layers import CurveElements, DrivingLines, Lanes
from ..survey.frame.placement import located
from ..survey.frame.road_frame import RoadFrame
from .apply import LineKind, apply_corrections, spans_along
from .corrections import DRAWN, Correction, Corrections
from .weights import CORRECTING

LANE_REACH = 1.0   # derived: m, half of the narrowest lane
NO_LINES = "none|none"
SURE = 1.0   # derived: confidence of what an analyst confirmed or drew


class _DrivingLines(LineKind):
    """Pieces hold what `DrivingLines.of_pieces` takes."""

    reach = LANE_REACH

    def __init__(self, frame: RoadFrame, known: np.ndarray, lane_width: float):
        super().__init__(frame, known)
        self.lane_width = lane_width

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
        return self.with_stations(dict(piece, drawn_by=correction), places)


class _Lanes(LineKind):
    """Pieces hold what `make_lanes` takes, and in `columns` their middle and both borders side by side."""

    reach, key = LANE_REACH, "columns"

    def __init__(self, frame: RoadFrame, known: np.ndarray, lines: list[dict[str, Any]]):
        super().__init__(frame, known)
        self.lines = lines   # driving lines, already corrected: what was drawn has its lane and width there

    def with_columns(self, piece, columns):
        return dict(super().with_columns(piece, columns), changed=True)

    def accepted(self, piece):
        return dict(super().accepted(piece), confidence=SURE, other="", changed=True)

    def drawn(self, correction, places, like, pieces):
        line = next(candidate for candidate in self.lines if candidate.get("drawn_by") is correction)
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
    rows, of_lines = apply_corrections(_DrivingLines(frame, known, width), before, lane_corrections)
    # the area of a lane is drawn about its driving line
    lane_corrections = [correction for correction in lane_corrections if not correction.draws or correction.row in of_lines]
    areas, of_lanes = apply_corrections(_Lanes(frame, known, rows), _rows_of_lanes(lanes), lane_corrections)
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
        length = sum(last - first for _, first, last in spans_along(same_way, replace(drawn, action="accept"), CORRECTING.taken_reach))
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
