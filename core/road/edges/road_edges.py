"""Road edges as arrays, which stages hand each other and which the layer ROAD_EDGES holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
import shapely

from ...common.features import NEAREST_PASS, ROAD_EDGES, SIGMA, Features
from ...common.layer_rows import LayerRows, column
from ...survey.frame.placement import COORDINATE_DECIMALS, FrameLines, as_written, line_parts, lines_in_frame
from ...survey.frame.road_frame import RoadFrame
from ...survey.frame.row_table import cuts_where_it_changes
from ..weights import CURBS, EDGE

EDGE_DECIMALS = dict(station=3, end=3, height=3, length=3, rmse=4, sigma=4, agree=1)   # derived: of numbers in the layer, finer than they are known


@dataclass(frozen=True)
class EdgePiece:
    """A line of one status that is to be drawn."""

    vertices: np.ndarray   # (V, 3) x, y and z in map coordinates
    road: int   # number
    side: str   # side, status, part, kind, what: as in RoadEdges
    status: str
    chain: int   # number of the line; its pieces share it
    station: float   # station, end, height, length, rmse: metres, as in RoadEdges
    end: float
    length: float = np.nan   # of the vertices in plan where nothing else is given
    height: float = np.nan
    rmse: float = np.nan
    part: str = "bottom"
    kind: str = "main"
    what: str = "curb"
    agree: float = np.nan
    sigma: np.ndarray | float = np.nan   # m, as in RoadEdges; or (V,) at every vertex, and the piece is cut where it changes

    def __post_init__(self) -> None:
        if np.isnan(self.length):
            object.__setattr__(self, "length", float(np.hypot(*np.diff(self.vertices[:, :2], axis=0).T).sum()))

    def cut_by_sigma(self) -> list[EdgePiece]:
        """The pieces of which one sigma speaks, the mean along them: the worst places of a piece do not speak for all."""
        sigma = np.asarray(self.sigma, float)
        if sigma.ndim == 0:
            return [self]
        along = np.append(0.0, np.cumsum(np.hypot(*np.diff(self.vertices[:, :2], axis=0).T)))
        if not len(cuts := cuts_where_it_changes(along, sigma)):
            return [replace(self, sigma=float(sigma.mean()))]
        bounds = [0, *cuts.tolist(), len(along) - 1]
        stations = np.interp(along[bounds], along[[0, -1]], [self.station, self.end]).tolist()
        return [replace(self, vertices=self.vertices[a:b + 1], station=stations[k], end=stations[k + 1], length=float(along[b] - along[a]),
                        sigma=float(sigma[a:b + 1].mean())) for k, (a, b) in enumerate(zip(bounds[:-1], bounds[1:]))]


@dataclass(frozen=True)
class RoadEdges(LayerRows):
    """E pieces of road edges, each of one status.

    kind : (E,) str objects: main for the road's own edges; corner, side_street and island for what leads away from it or stands in it
    what : (E,) str objects: curb, dropped, or pavement where the pavement ends without a curb
    height, length, rmse : (E,) metres: of the curb, along the line in plan, of the curb points from the line

    Numbers that are unknown are -1 or NaN.
    """

    GEOMETRY_TYPE, SCHEMA = "LineStringZ", ROAD_EDGES

    edge: np.ndarray   # (E,) int, row of the layer that the piece comes from or goes to
    nearest_pass: np.ndarray = field(metadata=column(NEAREST_PASS.name))   # (E,) int, number of the pass that drove nearest
    side: np.ndarray = field(metadata=column())   # (E,) str objects, left or right
    status: np.ndarray = field(metadata=column(unknown="measured"))   # (E,) str objects, measured, bridged, inferred
    part: np.ndarray = field(metadata=column(unknown="bottom"))   # (E,) str objects, bottom or top
    kind: np.ndarray = field(metadata=column(unknown="main"))
    what: np.ndarray = field(metadata=column("edge", unknown="curb"))
    chain: np.ndarray = field(metadata=column())   # (E,) int, the pieces of one line share it
    station: np.ndarray = field(metadata=column("station_m"))   # station, end: (E,) metres along the road
    end: np.ndarray = field(metadata=column("end_m"))
    height: np.ndarray = field(metadata=column("height_m"))
    length: np.ndarray = field(metadata=column("length_m"))
    rmse: np.ndarray = field(metadata=column("rmse_m"))
    agree: np.ndarray = field(metadata=column("agree_cm"))   # (E,) centimetres that two methods lie apart, at 95 % of the piece
    sigma: np.ndarray = field(metadata=column(SIGMA.name))   # (E,) metres, uncertainty of the place across the line, one sigma, see `uncertainty.py`
    course: FrameLines   # FrameLines, one per piece
    crs: str = ""   # WKT, "" where unknown

    @property
    def road(self) -> np.ndarray:
        """(E,) int, number of the road."""
        return self.course.road

    @property
    def of_main_curb(self) -> np.ndarray:
        """(E,) bool: does the edge belong to a curb along the road?"""
        return self.kind == "main"

    @property
    def of_curb(self) -> np.ndarray:
        """(E,) bool: is the edge a curb, not an edge of the pavement alone?"""
        return self.what != "pavement"

    def and_pieces(self, pieces: Sequence[EdgePiece], frame: RoadFrame) -> RoadEdges:
        """These edges and further pieces, whose chains are numbered on."""
        if not pieces:
            return self
        added = joined_pieces(pieces, frame, self.crs)
        added = replace(added, chain=added.chain + max(self.chain.max(initial=-1), -1) + 1)
        columns: dict[str, Any] = {name: np.append(getattr(self, name), getattr(added, name)) for name in self.names() if name != "course"}
        columns.update(edge=np.arange(len(self) + len(added)), course=self.course.and_lines(added.course))
        return replace(self, **columns)

    def on_map(self, frame: RoadFrame) -> np.ndarray:
        """(E,) shapely lines with Z in map coordinates, as the layer holds them."""
        course = self.course
        places = np.round(np.c_[course.x, course.y, course.z] + frame.origin, COORDINATE_DECIMALS)
        lines = np.full(len(self), None, object)
        return shapely.linestrings(places, indices=course.owner, out=lines) if len(places) else lines

    def derived(self, frame: RoadFrame) -> dict[str, np.ndarray]:
        """The road, which the course knows."""
        return {"road": np.where(self.road < 0, None, self.road)}  # type: ignore[call-overload]

    @staticmethod
    def from_features(features: Features, frame: RoadFrame) -> RoadEdges:
        """The edges of a layer ROAD_EDGES in map coordinates, one piece a LineString, with the vertices of the layer.

        Fields may be missing: rows without `kind` are main edges, without `edge` curbs and without `status` measured; a row without `road`
        belongs to the road that most of its vertices are nearest to. Rows without geometry are left out.
        """
        parts, row_of = line_parts(features.geometries)
        rows = [features.rows[k] for k in row_of]
        road = [-1 if row.get("road") is None else int(row["road"]) for row in rows]
        return RoadEdges(edge=np.array(row_of, int), **RoadEdges.read_columns(rows), course=lines_in_frame(parts, road, frame, spacing=None),
                         crs=features.crs)

    def densified(self, frame: RoadFrame) -> RoadEdges:
        """The same edges with vertices at most LINE_VERTEX_SPACING apart: what is straight on the map is not straight in the road frame."""
        return replace(self, course=lines_in_frame(self.on_map(frame), self.road, frame))


def joined_pieces(pieces: Sequence[EdgePiece], frame: RoadFrame, crs: str = "") -> RoadEdges:
    """Pieces as RoadEdges in the same order.

    The pass that drove nearest is that of the middle vertex. Numbers are rounded to EDGE_DECIMALS and vertices to 0.1 mm,
    as the layer holds them. A piece is cut where its uncertainty changes much.
    """
    pieces = [part for piece in pieces for part in piece.cut_by_sigma()]
    x, y, z = as_written(frame, *np.concatenate([piece.vertices for piece in pieces] or [np.empty((0, 3))]).T)
    start = np.append(0, np.cumsum([len(piece.vertices) for piece in pieces], dtype=int))
    course = FrameLines.at(frame, np.array([piece.road for piece in pieces], int), start, x, y, z)
    columns = {field.name: _column(pieces, field.name) for field in fields(EdgePiece) if field.name not in ("vertices", "road")}
    return RoadEdges(edge=np.arange(len(pieces)), nearest_pass=_nearest_passes(course, columns["station"], frame), **columns, course=course, crs=crs)


def _column(pieces, name):
    """(E,) values of an attribute of pieces, as the layer holds them."""
    values, decimals = [getattr(piece, name) for piece in pieces], EDGE_DECIMALS.get(name)
    return RoadEdges.array_of(name, values if decimals is None else [round(value, decimals) for value in values])


def _nearest_passes(course, station, frame):
    """(E,) number of the pass that drove nearest to the middle vertex of each line."""
    middle = course.start[:-1] + np.diff(course.start) // 2
    s, d = course.s[middle], course.d[middle]
    # the line of a side street may leave the road's frame
    s, d = np.where(np.isfinite(s), s, station), np.where(np.isfinite(d), d, 0.0)
    numbers = np.full(len(course), -1)
    for road in np.unique(course.road).tolist():
        rows = course.road == road
        numbers[rows] = frame.nearest_pass(road, s[rows], d[rows])
    return numbers


# How uncertain the place of a road edge is: one sigma across it.
#
# Errors of curb points go on over metres, so a line through them averages little out: it is off by as much as they scatter about it, and by what the
# laser points on each of them leave open, less with their number; its ends are held from one side only. What adds up with it as squares: a bridge is
# an even bend led across a gap, and off by what the bend changes in it, which grows with the third power of the gap; passes that were driven apart
# and laid on each other agree on a middle of which nobody knows how far off it is; and where a line was fitted as a whole to few laser points, its
# curb points are off together by what the fit says. It holds against the points of the survey: what they are off as a whole, with their trajectory,
# is in it only where the accuracy of the trajectory was told, since one pass does not show it.


def edge_sigma(at: np.ndarray, places: np.ndarray, residual: np.ndarray, support: np.ndarray | None = None, foot: float = 0.0,
               passes: np.ndarray | float = 0.0, shared: np.ndarray | float = 0.0) -> np.ndarray:
    """One sigma across an edge at places along it; on a bridge with the bend that its curb may have.

    at : (K,) m along the line, where it is looked at
    places : (N,) m along the line of all its curb points, rising
    residual : (N,) m, distances of the curb points from the line
    support : (N,) laser points of each; below 1, or None, where that is unknown
    foot : m, one sigma of a curb's foot, however many points are on it
    passes : m, one sigma of the middle of the passes, see `RoadFrame.pass_sigma`; one for all or (K,)
    shared : m, one sigma that neighbouring curb points share, as those of a line that was fitted as a whole: they do not scatter about
        it; one for all or (K,)

    Returns (K,) m
    """
    first, last = np.searchsorted(places, at - EDGE.scatter_reach), np.searchsorted(places, at + EDGE.scatter_reach, side="right")
    # of a line as long as the road, only the points about the piece
    near = slice(int(first.min()), int(last.max()))
    square = np.square(residual[near])
    if support is not None:
        square += np.where(support[near] > 0, EDGE.point_sigma**2 / np.maximum(support[near], 1), 0.0)
    scatter = np.diff(np.append(0.0, np.cumsum(square))[[first - near.start, last - near.start]], axis=0)[0] / np.maximum(last - first, 1)
    k = np.clip(np.searchsorted(places, at), 1, len(places) - 1)
    length, into = places[k] - places[k - 1], at - places[k - 1]
    bridge = np.where(length > CURBS.max_joined_gap, 4.0 * EDGE.bridge_bend * length * np.clip(into * (length - into), 0.0, None), 0.0)
    end = np.clip(np.minimum(at - places[0], places[-1] - at), 0.0, None)
    # derived: a straight line through places along it has four times the variance at its ends that it has in its middle
    held = 1.0 + 3.0 * np.exp(-end / EDGE.end_length)
    return np.sqrt((foot**2 + scatter) * held + bridge**2 + passes**2 + shared**2)
