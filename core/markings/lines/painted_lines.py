"""Marking lines as arrays, which stages hand each other and which the layer MARKING_LINES holds."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
import shapely

from ...common.features import MARKING_LINES, Features
from ...common.layer_rows import LayerRows, column
from ...curves.base import Curve
from ...survey.frame.placement import FrameLines, line_parts, lines_in_frame
from ...survey.frame.road_frame import RoadFrame

CONFIRMED, DRAWN = "accepted", "drawn"   # statuses of a line that an analyst looked at, and of one that an analyst drew
LONG_LISTS = ("knots", "control_x", "control_y")  # parameters of splines


@dataclass(frozen=True)
class _FittedPieces:
    """What a fit says of P pieces of marking lines."""

    curve: list[Curve]   # P Curve in local coordinates; the pieces of one line share one
    arc: np.ndarray   # (P, 2) m, arc lengths on it where the piece begins and ends
    vertices: np.ndarray   # (V, 3) local m, the pieces as they are drawn, one after the other
    start: np.ndarray   # (P + 1,) int, first vertex of each piece, and V
    station: np.ndarray
    end: np.ndarray
    offset: np.ndarray   # (P,) m, median of the paint along the piece; NaN where there is none, as between dashes
    width: np.ndarray
    rmse: np.ndarray   # (P,) m, of the paint from the curve; NaN on bridged pieces

    def linestrings(self, frame: RoadFrame) -> np.ndarray:
        """(P,) shapely lines with Z in map coordinates."""
        owner = np.repeat(np.arange(len(self.curve)), np.diff(self.start))
        result = np.full(len(self.curve), None, object)
        return shapely.linestrings(self.vertices + frame.origin, indices=owner, out=result) if len(owner) else result


@dataclass(frozen=True)
class PaintedLines(LayerRows):
    """Marking lines in P pieces, each of one status and pattern.

    rmse, width : (P,) metres, of the paint from the curve and of the paint across; NaN where unknown; None where nothing is known
    unseen : P arrays (K, 3), metres: first and last station of stretches of a bridged piece that lie between two tracks of the scan, and the width
        of the line; None where it was not looked for
    other : (P,) str objects, the second reading of `kind` as JSON, "" where there is none; None where it was not looked for
    """

    GEOMETRY_TYPE, SCHEMA = "LineStringZ", MARKING_LINES

    line: np.ndarray = field(metadata=column(unknown=-1))   # (P,) int, number of the line; its pieces share it
    kind: np.ndarray = field(metadata=column(unknown=""))   # (P,) str objects, edge, lane or centre; "" where unknown
    pattern: np.ndarray = field(metadata=column(unknown=""))   # (P,) str objects, solid, dashed, double-solid, double-dashed; "" where unknown
    status: np.ndarray = field(metadata=column(unknown="measured"))   # (P,) str objects, measured or bridged
    course: FrameLines   # FrameLines, one per piece
    fitted: _FittedPieces | None = None   # _FittedPieces, None for lines that were read from a layer
    crs: str = ""   # WKT, "" where unknown
    rmse: np.ndarray | None = None
    width: np.ndarray | None = None
    unseen: list[np.ndarray] | None = None
    other: np.ndarray | None = None

    @property
    def told(self) -> np.ndarray:
        """(P,) str objects, `kind` of what was drawn or confirmed by hand; "" of what was fitted, which an estimate named from the same lines."""
        fitted = np.empty(0) if self.rmse is None else self.line[np.isfinite(self.rmse)]   # bridged pieces of these have no rmse
        return np.where(np.isin(self.line, fitted) & ~np.isin(self.status.astype(str), (CONFIRMED, DRAWN)), "", self.kind)

    def scatter(self) -> dict[int, float]:
        """RMS distance of the paint from the curve of every line where it is known, metres, by the line's number."""
        if self.rmse is None or not len(self):
            return {}
        length = np.diff(self.course.start).astype(float)   # in vertices, which are as far apart on every line
        has_rmse = np.isfinite(self.rmse)
        number, row = np.unique(self.line[has_rmse], return_inverse=True)
        square = np.bincount(row, length[has_rmse] * self.rmse[has_rmse] ** 2, len(number)) \
            / np.maximum(np.bincount(row, length[has_rmse], len(number)), 1.0)
        return dict(zip(number.tolist(), np.sqrt(square).tolist()))

    def on_map(self, frame: RoadFrame) -> np.ndarray:
        """(P,) fitted lines with Z in map coordinates.

        Raises ValueError if the lines were not fitted but read from a layer.
        """
        if self.fitted is None:
            raise ValueError("Lines that were read from a layer have no fitted curves to write.")
        return self.fitted.linestrings(frame)

    def derived(self, frame: RoadFrame) -> dict[str, Any]:
        """The road, and what the fit says: `params` holds the numbers of the line's curve in map coordinates as JSON, and the arc lengths
        `from` and `to` of the piece."""
        lines, fitted, road = self.on_map(frame), cast(_FittedPieces, self.fitted), self.course.road
        numbers: dict[int, str] = {}   # by curve: once for all pieces, since those of long splines are long
        for curve in fitted.curve:
            if id(curve) not in numbers:
                moved = curve.moved(*frame.origin[:2]).params()
                # to 0.1 mm: a spline of a long road stays readable
                moved.update({name: [round(value, 4) for value in moved[name]] for name in LONG_LISTS if name in moved})
                numbers[id(curve)] = json.dumps(moved)[:-1]
        return dict(
            road=road, other=[None] * len(self) if self.other is None else [text or None for text in self.other],
            curve=[curve.kind for curve in fitted.curve], radius_m=[curve.radius if curve.kind == "circle" else None for curve in fitted.curve],
            rmse_m=fitted.rmse, station_m=fitted.station, end_m=fitted.end, offset_m=fitted.offset, length_m=shapely.length(lines),
            width_m=fitted.width, pass_sig_m=[frame.passes_sigma(number, np.array(ends), np.nan).mean()
                                              for number, *ends in zip(road.tolist(), fitted.station, fitted.end)],
            params=[f'{numbers[id(curve)]}, {json.dumps({"from": round(first, 4), "to": round(last, 4)})[1:]}'
                    for curve, (first, last) in zip(fitted.curve, fitted.arc.tolist())])

    @staticmethod
    def from_features(features: Features, frame: RoadFrame) -> PaintedLines:
        """The lines of a layer MARKING_LINES in map coordinates, one piece a LineString; rows without geometry are left out.

        `road`, `line`, `kind`, `pattern`, `status` and `width_m` are used where they are, so that lines drawn by hand serve as well.
        """
        parts, row_of = line_parts(features.geometries)
        rows = [features.rows[k] for k in row_of]
        columns = PaintedLines.read_columns(rows)
        # rows without a number are lines of their own, numbered behind the others
        unnumbered, line = np.array([row.get("line") is None for row in rows], bool), columns["line"]
        columns["line"] = np.where(unnumbered, line[~unnumbered].max(initial=0) + 1 + np.array(row_of, int), line)
        road = [-1 if row.get("road") is None else int(row["road"]) for row in rows]
        rmse, width = (np.array([np.nan if row.get(name) is None else float(row[name]) for row in rows]) for name in ("rmse_m", "width_m"))
        return PaintedLines(**columns, course=lines_in_frame(parts, road, frame), crs=features.crs, rmse=rmse, width=width)


def painted_lines_of(rows: list[dict[str, Any]], frame: RoadFrame, crs: str) -> PaintedLines:
    """PaintedLines of one row a piece, as `pieces_of_lines` gives them; `unseen` may be missing."""
    def column(name: str, kind: Any) -> np.ndarray:
        return np.array([row[name] for row in rows], kind)

    places = [row["places"] for row in rows]
    fitted = _FittedPieces([row["curve"] for row in rows], column("arc", float).reshape(-1, 2), np.concatenate([*places, np.empty((0, 3))]),
                           np.append(0, np.cumsum([len(vertices) for vertices in places], dtype=int)),
                           *(column(name, float) for name in ("station", "end", "offset", "width", "rmse")))
    course = lines_in_frame(fitted.linestrings(frame), column("road", int), frame)
    return PaintedLines(column("line", int), column("kind", object), column("pattern", object), column("status", object), course, fitted, crs,
                        fitted.rmse, fitted.width, [row.get("unseen", np.empty((0, 3))) for row in rows])


def pieces_of_lines(lines: PaintedLines) -> list[dict[str, Any]]:
    """The pieces of lines that were fitted, one row each, as `painted_lines_of` takes them."""
    fitted = cast(_FittedPieces, lines.fitted)
    return [dict(road=int(lines.course.road[k]), line=int(lines.line[k]), kind=lines.kind[k], pattern=lines.pattern[k], status=lines.status[k],
                 unseen=np.empty((0, 3)) if lines.unseen is None else lines.unseen[k], curve=fitted.curve[k], arc=fitted.arc[k],
                 places=fitted.vertices[fitted.start[k]:fitted.start[k + 1]],
                 **{name: float(getattr(fitted, name)[k]) for name in ("station", "end", "offset", "width", "rmse")})
            for k in range(len(lines))]
