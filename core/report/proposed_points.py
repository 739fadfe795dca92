"""The report on proposed control points: how they were found, and the two cut-outs of every pair."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..common.texts import told, tr
from ..lazy import cv2
from ..overlay.pair_cutouts import pair_cutouts
from .map_figure import png
from .page import Page

if TYPE_CHECKING:
    from ..overlay.matching.propose import Proposal

CUT_SIDE = 110       # px, of a cut-out
PAIRS_PER_ROW = 5    # pairs side by side
_GAP, _TEXT = 8, 20
_ACCEPTED, _REFUSED = (80, 150, 40), (50, 50, 210)  # blue, green, red


def proposed_points_report(found: Proposal) -> str:
    """The report of a Proposal as HTML."""
    page = Page(tr("Proposed control points"), tr("The same paint in the image and in the intensity image."))
    for note in found.notes:
        page.warning(told(note))
    page.heading(tr("Image"))
    page.facts((
        (tr("Image"), found.image.path), (tr("Placed roughly by"), told(found.rough.source)),
        (tr("Found turned by"), tr("{turn:.1f}° counter-clockwise, from its rows to east").format(turn=found.turn_degrees)),
        (tr("Pixel on the ground"), f"{found.size:.4f} m"),
        (tr("Pairs"), tr("{count}, of which {accepted} accepted").format(count=len(found), accepted=int(found.accepted.sum()))),
        (tr("RMSE of the accepted pairs, each left out in turn"),
         tr("{rmse:.3f} m, by a polynomial of order {order}").format(rmse=found.rmse, order=found.order) if found.accepted.any() else "–")))
    if found.rival is not None:
        page.note(tr("The next likely place lies {away:.1f} m away: {here:.0f} corners speak for the place found, {there:.0f} for that one.").format(
            away=np.hypot(found.rival.dx, found.rival.dy), here=found.rival.votes_for, there=found.rival.votes_against))
    page.heading(tr("Pairs of cut-outs"))
    page.picture(png(pairs_picture(found)), tr(
        "Left the image, right the intensity image, both 3.2 m wide, north up. Green: accepted. Red: refused by "
        "default. Below each: its number, the likeness of the two, and how far off the other pairs place it."))
    page.heading(tr("Points"))
    page.table((tr("Point"), tr("Accepted"), tr("Likeness"), tr("Residual (m)"), tr("Pixel"), tr("Line, downwards"), tr("East (m)"), tr("North (m)"),
                tr("Why not")),
               [(str(k + 1), tr("yes") if found.accepted[k] else tr("no"), float(found.score[k]), float(found.residual[k]), float(found.pixel[k]),
                 float(found.line[k]), float(found.easting[k]), float(found.northing[k]), tr(found.why[k]) if found.why[k] else "")
                for k in range(len(found))],
               (None, None, 2, 3, 2, 2, 3, 3, None))
    return page.html()


def pairs_picture(found: Proposal) -> np.ndarray:
    """(H, W, 3) uint8, blue, green, red: all pairs of cut-outs in rows."""
    width, height = 2 * CUT_SIDE + 3 * _GAP, CUT_SIDE + _TEXT + 2 * _GAP
    rows = -(-len(found) // PAIRS_PER_ROW)
    canvas = np.full((rows * height, PAIRS_PER_ROW * width, 3), 255, np.uint8)
    cuts = pair_cutouts(found.image, found.intensity, found.pixel, found.line, found.easting, found.northing, side=CUT_SIDE)
    for k, pair in enumerate(cuts):
        left, top = (k % PAIRS_PER_ROW) * width + _GAP, (k // PAIRS_PER_ROW) * height + _GAP
        tint = _ACCEPTED if found.accepted[k] else _REFUSED
        for number, cut in enumerate(pair):
            x = left + number * (CUT_SIDE + _GAP // 2)
            canvas[top:top + CUT_SIDE, x:x + CUT_SIDE] = cut[..., ::-1]
            middle = (x + CUT_SIDE // 2, top + CUT_SIDE // 2)
            cv2.drawMarker(canvas, middle, (0, 220, 255), cv2.MARKER_CROSS, 16, 1, cv2.LINE_AA)
        cv2.rectangle(canvas, (left - 2, top - 2), (left + 2 * CUT_SIDE + _GAP // 2 + 1, top + CUT_SIDE + 1), tint, 2)
        text = f"{k + 1}   {found.score[k]:.2f}   {100 * found.residual[k]:.1f} cm"
        cv2.putText(canvas, text, (left, top + CUT_SIDE + _TEXT - 4), cv2.FONT_HERSHEY_SIMPLEX, 0.42, tint, 1, cv2.LINE_AA)
    return canvas
