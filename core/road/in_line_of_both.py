"""Pieces of curb of either method in line with what both methods chose.

Between parked cars a curb is seen in pieces of a metre. Which method sees a piece well enough hangs on where its profiles lie, so
each may choose the curb before a gap, behind it, or neither. Together they know more ends of curbs than each alone, and
between these a piece of either of them may lie.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..common.arrays import stretch_of
from .common.curb_points import CurbPoints, curb_points_at
from .common.hidden_curb import hidden_beside
from .common.in_line import LINE_FIT_LENGTH, MAX_LINE_GAP, PieceInLine, StepsByStation, pieces_between
from .common.occlusion import OcclusionGrid
from .common.side_chains import SideChains
from .common.sides import SIDE_SIGNS, expected_height
from .common.tracking import MAX_JOINED_GAP
from .curb_returns.main_curbs import main_curbs_of

if TYPE_CHECKING:
    from ..survey.open_survey import Survey


@dataclass(frozen=True)
class _Ends:
    """Curb points before or behind a gap: (N,) m, station, outward offset, height above the expected road and of the curb."""

    s: np.ndarray
    u: np.ndarray
    h: np.ndarray
    height: np.ndarray

    def __getitem__(self, rows: np.ndarray | slice) -> _Ends:
        return _Ends(self.s[rows], self.u[rows], self.h[rows], self.height[rows])


def with_pieces_of_both(points: CurbPoints, chains: Sequence[Mapping[tuple[int, str], SideChains]],
                        beside: Mapping[int, Mapping[str, OcclusionGrid]], survey: Survey) -> CurbPoints:
    """The curb points, and between them pieces of chains that lie in their line, with the places beside these that are hidden.

    Parameters
    ----------
    points : CurbPoints of the main curbs
    chains : of each method, (number of the road, side) -> SideChains
    beside : number of the road -> side -> OcclusionGrid
    survey : Survey
    """
    found = [points]
    for road in survey.store.roads():
        main, number = main_curbs_of(points, survey, road)
        pieces = CurbPoints.none(points.crs)
        for side in SIDE_SIGNS:
            of_side = [known[road, side] for known in chains if (road, side) in known]
            pieces = CurbPoints.join([pieces, _pieces_of_side(points, of_side, survey, road, side, number + len(pieces))], points.crs)
        if len(pieces):
            found += [pieces, hidden_beside(pieces[pieces.part == "bottom"], main, beside[road], survey, road)]
    return CurbPoints.join(found, points.crs)


def _pieces_of_side(points, chains, survey, road, side, number):
    """CurbPoints of the pieces in the gaps of one main curb, their chains numbered from `number` on."""
    frame, sign = survey.frame, SIDE_SIGNS[side]
    own = points[(points.road == road) & (points.side == side) & points.of_main_curb & (points.part == "bottom") & (points.status == "measured")]
    own = own[np.argsort(own.station, kind="stable")]
    curb = _Ends(own.station, sign * own.offset, own.z - expected_height(survey, road, own.station), own.height)
    rows: list[dict] = []
    gap = np.diff(curb.s)
    begin = np.flatnonzero((gap > MAX_JOINED_GAP) & (gap <= MAX_LINE_GAP))
    gaps = np.column_stack([curb.s[begin], curb.s[begin + 1]])
    of_methods = [StepsByStation(known.steps) for known in chains]

    def to_plan(s, u):
        return frame.road(road).to_map(s, sign * u)

    for a, b in gaps.tolist():
        before, after = curb[stretch_of(curb.s, a - LINE_FIT_LENGTH, a)], curb[stretch_of(curb.s, b, b + LINE_FIT_LENGTH)]
        pieces = [(known, piece) for known, others in zip(chains, of_methods) for piece in pieces_between(before, after, others, to_plan)]
        # of pieces beside each other the one nearest to the line
        chosen: list[PieceInLine] = []
        for known, piece in sorted(pieces, key=lambda found: found[1].off):
            if all(piece.end < other.start or piece.start > other.end for other in chosen):
                chosen.append(piece)
                rows += known.points(piece.steps, number + len(rows))
    s, u, h = (np.array([row[name] for row in rows], float) for name in ("s", "u", "h"))
    places = frame.to_map(road, s, sign * u, h + expected_height(survey, road, s))
    return curb_points_at(frame, road, places, [row["fields"] for row in rows], points.crs, side=side, station=s, offset=sign * u)
