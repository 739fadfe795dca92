"""Road edges as an analyst corrected them."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from ..road.edges.road_edges import EdgePiece, RoadEdges, joined_pieces
from .apply import LineKind, apply_corrections
from .corrections import DRAWN, Corrections

if TYPE_CHECKING:
    from ..survey.frame.road_frame import RoadFrame


class _Edges(LineKind):
    """Pieces hold what EdgePiece holds."""

    def columns(self, piece):
        return piece["local"]

    def with_columns(self, piece, columns):
        return dict(piece, local=columns, length=float(np.hypot(*np.diff(columns[:, :2], axis=0).T).sum()))

    def drawn(self, correction, places, like, pieces):
        free = max((piece["chain"] for piece in pieces), default=0) + 1
        blank = dict(road=correction.road, side="left" if correction.offset > 0 else "right", chain=free, station=correction.station,
                     end=correction.station, length=0.0)
        # the two methods say nothing of a place that they did not find
        piece = dict(blank if like is None else like, status=DRAWN, agree=np.nan, rmse=np.nan, sigma=np.nan)
        return self.with_columns(self.with_stations(piece, places), places)


def correct_edges(edges: RoadEdges, frame: RoadFrame, corrections: Corrections) -> RoadEdges:
    """Road edges with the corrections of the target edge; those that something was found for are noted in `corrections`.

    Parameters
    ----------
    edges : RoadEdges
    frame : RoadFrame
    corrections : Corrections

    Returns
    -------
    RoadEdges; the same object where there is nothing to correct
    """
    wanted = corrections.of("edge")
    if not wanted:
        return edges
    places = np.c_[edges.course.x, edges.course.y, edges.course.z]
    kind = _Edges(frame, places)
    pieces, matched, changed = apply_corrections(kind, [_piece_of(edges, k, places) for k in range(len(edges))], wanted)
    corrections.matched |= matched
    if not changed:
        return edges
    return joined_pieces([EdgePiece(**{name: value for name, value in piece.items() if name != "local"}, vertices=piece["local"] + frame.origin)
                          for piece in pieces], frame, edges.crs)


def _piece_of(edges: RoadEdges, k: int, places: np.ndarray) -> dict[str, Any]:
    """A row of RoadEdges as the fields of EdgePiece, with local vertices."""
    names = [one.name for one in fields(EdgePiece) if one.name not in ("vertices", "road")]
    values = {name: getattr(edges, name)[k] for name in names}
    return dict({name: value.item() if hasattr(value, "item") else value for name, value in values.items()}, road=int(edges.road[k]),
                local=places[edges.course.line(k)])
