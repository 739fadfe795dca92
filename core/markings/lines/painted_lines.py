"""Marking lines as arrays, and their conversion from and to the layer MARKING_LINES."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from ...common.features import MARKING_LINES, Features
from ...curves.base import Curve
from ...survey.frame.placement import FrameLines, line_parts, lines_in_frame
from ...survey.frame.road_frame import RoadFrame

LONG_LISTS = ("knots", "control_x", "control_y")  # parameters of splines


@dataclass(frozen=True)
class FittedPieces:
    """What a fit says of P pieces of marking lines.

    curve : P Curve in local coordinates; the pieces of one line share one
    arc : (P, 2) metres, arc lengths on the curve where the piece begins and ends
    vertices : (V, 3) local metres, the pieces as they are drawn, one after the other
    start : (P + 1,) int, first vertex of each piece, and V
    station, end : (P,) metres
    offset : (P,) metres, median of the paint along the piece; NaN where there is none, as between dashes
    width : (P,) metres
    rmse : (P,) metres, of the paint from the curve; NaN on bridged pieces
    """

    curve: list[Curve]
    arc: np.ndarray
    vertices: np.ndarray
    start: np.ndarray
    station: np.ndarray
    end: np.ndarray
    offset: np.ndarray
    width: np.ndarray
    rmse: np.ndarray

    def linestrings(self, frame: RoadFrame) -> np.ndarray:
        """(P,) shapely lines with Z in map coordinates."""
        owner = np.repeat(np.arange(len(self.curve)), np.diff(self.start))
        found = np.full(len(self.curve), None, object)
        return shapely.linestrings(self.vertices + frame.origin, indices=owner, out=found) if len(owner) else found


@dataclass(frozen=True)
class PaintedLines:
    """Marking lines in P pieces, each of one status and pattern.

    line : (P,) int, number of the line; its pieces share it
    kind : (P,) str objects, edge, lane or centre; "" where unknown
    pattern : (P,) str objects, solid, dashed, double-solid, double-dashed; "" where unknown
    status : (P,) str objects, measured or bridged
    course : FrameLines, one per piece
    fitted : FittedPieces, None for lines that were read from a layer
    crs : WKT, "" where unknown
    rmse, width : (P,) metres, of the paint from the curve and of the paint across; NaN where unknown; None where nothing is known
    unseen : P arrays (K, 3), metres: first and last station of stretches of a bridged piece that lie between two tracks of the scan,
        and the width of the line; None where it was not looked for
    other : (P,) str objects, the second reading of `kind` as JSON, "" where there is none; None where it was not looked for
    """

    line: np.ndarray
    kind: np.ndarray
    pattern: np.ndarray
    status: np.ndarray
    course: FrameLines
    fitted: FittedPieces | None = None
    crs: str = ""
    rmse: np.ndarray | None = None
    width: np.ndarray | None = None
    unseen: list[np.ndarray] | None = None
    other: np.ndarray | None = None

    def __len__(self) -> int:
        return len(self.line)

    def scatter(self) -> dict[int, float]:
        """RMS distance of the paint from the curve of every line where it is known, metres, by the line's number."""
        if self.rmse is None or not len(self):
            return {}
        length = np.diff(self.course.start).astype(float)   # in vertices, which are as far apart on every line
        known = np.isfinite(self.rmse)
        number, row = np.unique(self.line[known], return_inverse=True)
        square = np.bincount(row, length[known] * self.rmse[known] ** 2, len(number)) / np.maximum(np.bincount(row, length[known], len(number)), 1.0)
        return dict(zip(number.tolist(), np.sqrt(square).tolist()))


def lines_to_features(lines: PaintedLines, frame: RoadFrame) -> Features:
    """The layer MARKING_LINES: fitted lines in map coordinates with their fields.

    Parameters
    ----------
    lines : PaintedLines with `fitted`
    frame : RoadFrame, whose origin is added to local coordinates

    Returns
    -------
    Features MARKING_LINES, one row a piece, in the same order. `params` holds the
    numbers of the line's curve in map coordinates as JSON, and the arc lengths `from` and `to` of the piece

    Raises
    ------
    ValueError
        If the lines were not fitted but read from a layer.
    """
    fitted = lines.fitted
    if fitted is None:
        raise ValueError("Lines that were read from a layer have no fitted curves to write.")
    layer = Features("LineStringZ", MARKING_LINES, crs=lines.crs)
    curves: dict[int, tuple[Curve, str]] = {}
    for k, geometry in enumerate(fitted.linestrings(frame)):
        key = id(fitted.curve[k])
        if key not in curves:
            moved = fitted.curve[k].moved(*frame.origin[:2])
            curves[key] = moved, json.dumps(_rounded(moved.params()))[:-1]  # once for all pieces: those of long splines are long
        curve, numbers = curves[key]
        first, last = fitted.arc[k].tolist()
        layer.add(
            geometry, road=int(lines.course.road[k]), line=int(lines.line[k]), kind=lines.kind[k], pattern=lines.pattern[k],
            status=lines.status[k], other=None if lines.other is None else lines.other[k] or None,
            curve=curve.kind, radius_m=float(curve.radius) if curve.kind == "circle" else None,
            rmse_m=_known(fitted.rmse[k]), station_m=float(fitted.station[k]), end_m=float(fitted.end[k]),
            offset_m=_known(fitted.offset[k]), length_m=float(geometry.length), width_m=float(fitted.width[k]),
            pass_sig_m=_known(frame.passes_sigma(int(lines.course.road[k]), np.array([fitted.station[k], fitted.end[k]]), np.nan).mean()),
            params=f'{numbers}, {json.dumps({"from": round(first, 4), "to": round(last, 4)})[1:]}')
    return layer


def _known(value: float) -> float | None:
    return None if np.isnan(value) else float(value)


def _rounded(numbers: dict[str, Any]) -> dict[str, Any]:
    """Long lists to 0.1 mm: a spline of a long road stays readable."""
    return {key: [round(v, 4) for v in value] if key in LONG_LISTS else value for key, value in numbers.items()}


def lines_from_features(features: Features, frame: RoadFrame) -> PaintedLines:
    """Read the layer MARKING_LINES.

    Parameters
    ----------
    features : Features with lines in map coordinates; `road`, `line`, `kind`, `pattern`, `status` and `width_m` are used where they are, so
        that lines drawn by hand serve as well

    Returns
    -------
    PaintedLines, one piece a LineString; rows without geometry are left out
    """
    parts, row_of = line_parts(features.geometries)
    rows = [features.rows[k] for k in row_of]
    # rows without a number are lines of their own, numbered behind the others
    numbers = [None if row.get("line") is None else int(row["line"]) for row in rows]
    free = max((number for number in numbers if number is not None), default=0) + 1
    line = np.array([free + k if number is None else number for number, k in zip(numbers, row_of)], int)
    road = [-1 if row.get("road") is None else int(row["road"]) for row in rows]
    kind, pattern, status = (np.array([str(row.get(name) or missing) for row in rows], object)
                             for name, missing in (("kind", ""), ("pattern", ""), ("status", "measured")))
    rmse, width = (np.array([np.nan if row.get(name) is None else float(row[name]) for row in rows]) for name in ("rmse_m", "width_m"))
    return PaintedLines(line, kind, pattern, status, lines_in_frame(parts, road, frame), crs=features.crs, rmse=rmse, width=width)


def painted_lines_of(rows: list[dict[str, Any]], frame: RoadFrame, crs: str) -> PaintedLines:
    """PaintedLines of one row a piece, as `pieces_of_lines` gives them.

    Parameters
    ----------
    rows : dicts of road, line, kind, pattern, status, and of what FittedPieces holds: curve, arc, places (V, 3), station, end, offset, width, rmse;
        and of `unseen`, where it is known
    crs : WKT, "" where unknown
    """
    def column(name: str, kind: Any) -> np.ndarray:
        return np.array([row[name] for row in rows], kind)

    places = [row["places"] for row in rows]
    fitted = FittedPieces([row["curve"] for row in rows], column("arc", float).reshape(-1, 2), np.concatenate([*places, np.empty((0, 3))]),
                          np.append(0, np.cumsum([len(some) for some in places], dtype=int)),
                          *(column(name, float) for name in ("station", "end", "offset", "width", "rmse")))
    course = lines_in_frame(fitted.linestrings(frame), column("road", int), frame)
    return PaintedLines(column("line", int), column("kind", object), column("pattern", object), column("status", object), course, fitted, crs,
                        fitted.rmse, fitted.width, [row.get("unseen", np.empty((0, 3))) for row in rows])


def pieces_of_lines(lines: PaintedLines) -> list[dict[str, Any]]:
    """The pieces of lines that were fitted, one row each, as `painted_lines_of` takes them."""
    fitted = lines.fitted
    if fitted is None:
        raise ValueError("Lines that were read from a layer have no fitted curves.")
    return [dict(road=int(lines.course.road[k]), line=int(lines.line[k]), kind=lines.kind[k], pattern=lines.pattern[k], status=lines.status[k],
                 unseen=np.empty((0, 3)) if lines.unseen is None else lines.unseen[k], curve=fitted.curve[k], arc=fitted.arc[k],
                 places=fitted.vertices[fitted.start[k]:fitted.start[k + 1]],
                 **{name: float(getattr(fitted, name)[k]) for name in ("station", "end", "offset", "width", "rmse")})
            for k in range(len(lines))]
