"""Corrections applied to lines of any kind."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..survey.frame.placement import located
from .corrections import ACCEPTED, Correction
from .places import cut, distance_of, heights_for, pieces_of, spans_along

if TYPE_CHECKING:
    from ..survey.frame.road_frame import RoadFrame


class LineKind(ABC):
    """What is the same in all corrections of one kind of line.

    frame : RoadFrame
    reach : m beside a correction within which it is about such a line
    known : (K, 3) local places whose heights are known
    """

    reach = 0.5

    def __init__(self, frame: RoadFrame, known: np.ndarray):
        self.frame, self.known = frame, known

    @abstractmethod
    def columns(self, piece: dict[str, Any]) -> np.ndarray:
        """(V, C) what a piece has at every vertex: x, y and more."""

    @abstractmethod
    def with_columns(self, piece: dict[str, Any], columns: np.ndarray) -> dict[str, Any]:
        """The piece with other vertices."""

    @abstractmethod
    def drawn(self, correction: Correction, places: np.ndarray, like: dict[str, Any] | None, pieces: Sequence[dict[str, Any]]) -> dict[str, Any]:
        """A piece along (V, 3) local places; `like` is the piece that was moved there, None where there was none."""

    def part(self, piece: dict[str, Any], first: float, last: float) -> dict[str, Any]:
        """The piece from one place along it to another, with its stations."""
        columns = cut(self.columns(piece), first, last)
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


def apply_corrections(kind: LineKind, pieces: list[dict[str, Any]], corrections: Sequence[Correction]) -> tuple[list[dict[str, Any]], set[int], bool]:
    """Pieces of lines as an analyst corrected them, one correction after the other.

    Accepted stretches get the status `accepted`. What is drawn or moved replaces what lies along its new place, has the status `drawn`
    and the heights of the map around it.

    Returns
    -------
    pieces, the rows of the corrections that something was found for, and whether anything changed
    """
    matched: set[int] = set()
    changed = False
    for correction in corrections:
        spans = spans_along([kind.columns(piece)[:, :2] for piece in pieces], correction, distance_of(correction, kind.reach))
        if correction.action == "draw" and not correction.on_a_road or correction.action != "draw" and not spans:
            continue
        matched.add(correction.row)
        like = pieces[spans[0][0]] if spans and correction.action == "move" else None
        pieces, changed = _replaced(kind, pieces, spans, correction), True
        if correction.draws:
            pieces.append(kind.drawn(correction, _with_heights(kind, correction), like, pieces))
    return pieces, matched, changed


def _replaced(kind, pieces, spans, correction):
    """Pieces without the stretches, or with the stretches accepted."""
    of: dict[int, list[tuple[float, float]]] = {}
    for k, a, b in spans:
        of.setdefault(k, []).append((a, b))
    found = []
    for k, piece in enumerate(pieces):
        if k not in of:
            found.append(piece)
            continue
        line = kind.columns(piece)
        length = float(np.hypot(*np.diff(line[:, :2], axis=0).T).sum())
        parts = pieces_of(length, of[k])
        for a, b, along in parts:
            one = piece if len(parts) == 1 else kind.part(piece, a, b)
            if not along:
                found.append(one)
            elif correction.action == "accept":
                found.append(kind.accepted(one))
            elif correction.action == "take":
                found.append(kind.taken(one, correction))
    return found


def _with_heights(kind, correction):
    """(V, 3) the places of a correction with heights."""
    places = correction.places
    if not correction.on_a_road:
        return np.c_[places[:, :2], heights_for(places, kind.known, np.zeros(len(places)))]
    s, _ = located(kind.frame, np.full(len(places), correction.road), places[:, 0], places[:, 1])
    track = kind.frame.track_height(correction.road, np.where(np.isfinite(s), s, correction.station))
    return np.c_[places[:, :2], heights_for(places, kind.known, track)]
