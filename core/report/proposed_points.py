"""The report on proposed control points: how they were found, and the two cut-outs of every pair."""

from __future__ import annotations

from typing import TYPE_CHECKING

import cv2
import numpy as np

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
    page = Page("Proposed control points", "The same paint in the image and in the intensity image.")
    for note in found.notes:
        page.warning(note)
    page.heading("Image")
    page.facts((
        ("Image", found.image.path), ("Placed roughly by", found.rough.source),
        ("Found turned by", f"{found.turn_degrees:.1f}° counter-clockwise, from its rows to east"), ("Pixel on the ground", f"{found.size:.4f} m"),
        ("Pairs", f"{len(found)}, of which {int(found.accepted.sum())} accepted"),
        ("RMSE of the accepted pairs, each left out in turn",
         f"{found.rmse:.3f} m, by a polynomial of order {found.order}" if found.accepted.any() else "–")))
    if found.rival is not None:
        page.note(f"The next likely place lies {np.hypot(found.rival.dx, found.rival.dy):.1f} m away: {found.rival.votes_for:.0f} corners "
                  f"speak for the place found, {found.rival.votes_against:.0f} for that one.")
    page.heading("Pairs of cut-outs")
    page.picture(png(pairs_picture(found)), "Left the image, right the intensity image, both 3.2 m wide, north up. Green: accepted. Red: refused by "
                                            "default. Below each: its number, the likeness of the two, and how far off the other pairs place it.")
    page.heading("Points")
    page.table(("Point", "Accepted", "Likeness", "Residual (m)", "Pixel", "Line", "East (m)", "North (m)", "Why not"),
               [(str(k + 1), "yes" if found.accepted[k] else "no", float(found.score[k]), float(found.residual[k]), float(found.pixel[k]),
                 float(found.line[k]), float(found.easting[k]), float(found.northing[k]), found.why[k]) for k in range(len(found))],
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
