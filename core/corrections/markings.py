"""Markings and marking lines as an analyst corrected them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from ..curves.model_selection import fit_curve
from ..markings.lines.painted_lines import PaintedLines, painted_lines_of, pieces_of_lines
from ..markings.objects.marking_objects import MarkingObjects
from .apply import LineKind, apply_corrections
from .corrections import DRAWN, Correction, Corrections

if TYPE_CHECKING:
    from ..survey.frame.road_frame import RoadFrame

USUAL_PATTERN = "solid"


class _Lines(LineKind):
    """Pieces hold what `pieces_of_lines` gives; of two lines beside each other, such as a double line, the nearer one is meant."""

    def columns(self, piece):
        return piece["places"]

    def with_columns(self, piece, columns):
        arc, _ = piece["curve"].project(columns[[0, -1], 0], columns[[0, -1], 1])
        return dict(piece, places=columns, arc=arc)

    def taken(self, piece, correction):
        return dict(self.accepted(piece), kind=correction.kind)

    def drawn(self, correction, places, like, pieces):
        fit = fit_curve(places[:, 0], places[:, 1])
        free = max((piece["line"] for piece in pieces), default=0) + 1
        widths = [piece["width"] for piece in pieces if np.isfinite(piece["width"])]
        blank = dict(road=correction.road, line=free, kind="", pattern=USUAL_PATTERN, station=correction.station, end=correction.station,
                     width=float(np.median(widths)) if widths else np.nan)
        said = {name: value for name, value in (("kind", correction.kind), ("pattern", correction.pattern)) if value}
        u, _ = fit.curve.project(places[[0, -1], 0], places[[0, -1], 1])
        piece = dict(blank if like is None else like, **said, status=DRAWN, curve=fit.curve, arc=u, rmse=np.nan,
                     offset=correction.offset, places=places)
        return self.with_stations(piece, places)


def correct_markings(markings: MarkingObjects, corrections: Corrections) -> MarkingObjects:
    """Markings less those that were deleted: lines are then not made of them either.

    A correction is about the markings whose middle lies within 0.5 m of its line, or of which its point lies within 0.5 m.
    Corrections that something was found for are noted; to accept a marking changes nothing of it.

    Parameters
    ----------
    markings : MarkingObjects
    corrections : Corrections

    Returns
    -------
    MarkingObjects; the same object where nothing was deleted
    """
    wanted = [one for one in corrections.of("marking") if one.action in ("accept", "delete")]
    if not wanted or not len(markings):
        return markings
    polygons = markings.outlines.polygons()
    middles = shapely.point_on_surface(polygons)
    keep = np.ones(len(markings), bool)
    for correction in wanted:
        about = _about(correction, polygons, middles)
        if about.any():
            corrections.matched.add(correction.row)
            if correction.action == "delete":
                keep &= ~about
    return markings if keep.all() else markings[keep]


def _about(correction: Correction, polygons: np.ndarray, middles: np.ndarray) -> np.ndarray:
    if len(correction.places) == 1:
        return shapely.distance(polygons, shapely.points(correction.places[0, :2])) <= LineKind.reach
    return shapely.distance(middles, shapely.linestrings(correction.places[:, :2])) <= LineKind.reach


def correct_marking_lines(lines: PaintedLines, frame: RoadFrame, corrections: Corrections, known: np.ndarray) -> PaintedLines:
    """Marking lines with the corrections of the target marking; those that something was found for are noted in `corrections`.

    Parameters
    ----------
    lines : PaintedLines with `fitted`
    frame : RoadFrame
    corrections : Corrections
    known : (K, 3) further local places whose heights are known, as the vertices of road edges

    Returns
    -------
    PaintedLines, lines that were drawn with no `kind` unless the correction says one; the same object where there is nothing to correct
    """
    wanted = corrections.of("marking")
    if not wanted or lines.fitted is None:
        return lines
    kind = _Lines(frame, np.concatenate([lines.fitted.vertices, known]))
    pieces, matched, changed = apply_corrections(kind, pieces_of_lines(lines), wanted)
    corrections.matched |= matched
    return painted_lines_of(pieces, frame, lines.crs) if changed else lines

