"""Lines as offsets d(s) at common stations: what lanes are made of."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ...common.parallel import check_cancelled
from ...curves.robust import median
from ...road.edges.road_edges import RoadEdges
from ...survey.frame.placement import FrameLines
from ...survey.frame.row_table import RowTable
from .grid_lines import STATION_STEP, GridLines, PieceOfLine, even_doubles, joined, lead_over, lengthen_dashed, lines_on_grid

if TYPE_CHECKING:
    from ..lines.painted_lines import PaintedLines

__all__ = ["STATION_STEP", "CrossSections", "cross_sections", "sections_of_edges", "sections_of_lines", "sections_of_pavement"]

MAX_LINE_OBLIQUITY = np.tan(np.radians(25.0))  # a line that runs more across the road than this bounds no lane
CLOSED_ISLAND = 1.0                            # m between the ends of a line round an island that closes


@dataclass
class CrossSections:
    """All lines of one road on a common grid of stations.

    s : (K,) stations; d, z : RowTable of (L, K), offset and height of each line, NaN where it is not;
    seen : (L, K) False where the line itself was bridged; kinds, patterns : per line, of its longest piece
    drawn : (L, K) how it is drawn at each place, a row of `names`; -1 where that is not known
    number : (L, K) number of the line in its layer at each place; -1 where that is not known
    width : (L, K) m of paint across; NaN where that is not known
    """

    s: np.ndarray
    d: RowTable
    z: RowTable
    seen: RowTable
    kinds: list
    patterns: list
    drawn: RowTable
    names: list
    number: RowTable
    width: RowTable

    @cached_property
    def usual(self) -> np.ndarray:
        """(L,) int, how most of each line is drawn, a row of `names`."""
        return np.array([self.names.index(pattern) for pattern in self.patterns], int)


def cross_sections(lines: FrameLines, number: np.ndarray, kind: np.ndarray, pattern: np.ndarray, seen: np.ndarray,
                   width: np.ndarray | None = None) -> dict[int, CrossSections]:
    """Lines of every road as offsets at common stations.

    Parameters
    ----------
    lines : FrameLines of P pieces
    number : (P,) int, the pieces of one line share a number
    kind, pattern : (P,) str objects, "" where unknown
    seen : (P,) bool, False for pieces that are bridged
    width : (P,) m of paint across, NaN where unknown; or None

    Returns
    -------
    dict of road number to CrossSections
    """
    pieces: dict[int, dict[int, list[PieceOfLine]]] = {}
    for k in range(len(lines)):
        check_cancelled()
        road, window = int(lines.road[k]), lines.line(k)
        piece = _piece(lines.s[window], lines.d[window], lines.z[window], kind[k], pattern[k], bool(seen[k]),
                       np.nan if width is None else float(width[k]))
        if piece is not None:
            pieces.setdefault(road, {}).setdefault(int(number[k]), []).append(piece)
    return {road: _on_grid(found) for road, found in sorted(pieces.items())}


def sections_of_lines(lines: PaintedLines) -> dict[int, CrossSections]:
    """CrossSections of marking lines, by road number."""
    return cross_sections(lines.course, lines.line, lines.kind, lines.pattern, lines.status != "bridged", lines.width)


def sections_of_edges(edges: RoadEdges) -> dict[int, CrossSections]:
    """CrossSections of the curbs along the road and about islands in it, by road number; where the pavement ends without one, the surface ends.

    Both sides of an island are rows of their own with one `number`.
    """
    return _named_by_chain(edges, np.flatnonzero(np.isin(edges.kind, ("main", "island")) & edges.of_curb))


def sections_of_pavement(edges: RoadEdges) -> dict[int, CrossSections]:
    """CrossSections of the edges of the pavement without a curb, by road number."""
    return _named_by_chain(edges, np.flatnonzero((edges.kind == "main") & ~edges.of_curb))


def _named_by_chain(edges, rows):
    """CrossSections of some edges; the layer names a line by its chain, -1 stays -1."""
    course, of = _sides_of_islands(edges.course[rows], edges.kind[rows] == "island")
    rows = rows[of]
    # a number of its own for every side
    count = int(edges.edge.max(initial=-1)) + 1
    key = np.where(edges.edge[rows] < 0, -1, edges.edge[rows] + count * (np.arange(len(of)) - np.searchsorted(of, of)))
    found = cross_sections(course, key, edges.kind[rows], np.full(len(rows), "", object), edges.status[rows] != "bridged")
    chain = np.full(count + 1, -1)
    known = edges.edge >= 0
    chain[edges.edge[known]] = edges.chain[known]
    for sections in found.values():
        number = sections.number.values
        sections.number = sections.number.like(chain[np.where(number < 0, -1, number % max(count, 1))], -1)
    return found


def _sides_of_islands(course, island):
    """Lines as FrameLines whose stations rise or fall throughout, islands side by side, and the line that each comes from."""
    rows, of = [], []
    for k in range(len(course)):
        places = np.arange(course.start[k], course.start[k + 1])
        sides = [places]
        if island[k] and (known := np.isfinite(course.s[places])).sum() > 1:
            places = places[known]
            first, last = places[[0, -1]]
            if np.hypot(course.x[first] - course.x[last], course.y[first] - course.y[last]) < CLOSED_ISLAND:
                places = np.roll(places, -int(np.argmin(course.s[places])))
            turns = sorted({0, int(np.argmin(course.s[places])), int(np.argmax(course.s[places])), len(places) - 1})
            sides = [places[a:b + 1] for a, b in zip(turns[:-1], turns[1:])]
        rows += sides
        of += [k] * len(sides)
    start, at = np.append(0, np.cumsum([len(side) for side in rows], dtype=int)), np.concatenate([np.empty(0, int), *rows])
    return FrameLines(course.road[of], start, *(values[at] for values in (course.x, course.y, course.z, course.s, course.d))), np.array(of, int)


def _piece(s, d, z, kind, pattern, seen, width):
    """A PieceOfLine of the vertices of a line, None where it bounds no lane."""
    good = np.isfinite(s)
    if not good.all():
        s, d, z = s[good], d[good], z[good]
    if len(s) < 2:
        return None
    if s[-1] < s[0]:
        s, d, z = s[::-1], d[::-1], z[::-1]
    rising = np.append(True, s[1:] > np.maximum.accumulate(s)[:-1])
    if not rising.all():
        s, d, z = s[rising], d[rising], z[rising]
    if len(s) < 2 or median(np.abs(np.diff(d)) / np.diff(s)) > MAX_LINE_OBLIQUITY:
        return None
    return PieceOfLine(s, d, z, kind, pattern, seen, width)


def _on_grid(pieces: dict[int, list[PieceOfLine]]) -> CrossSections:
    """CrossSections of the lines of one road, which go on over short gaps."""
    found, gaps = joined(lines_on_grid(pieces))
    even_doubles(found, lead_over(found, gaps))
    lengthen_dashed(found)
    return _sections(found)


def _sections(lines: GridLines) -> CrossSections:
    tables = lines.tables()
    return CrossSections(lines.s, tables["d"], tables["z"], tables["seen"], [row.kind for row in lines.rows], [row.pattern for row in lines.rows],
                         tables["drawn"], lines.names, tables["number"], tables["width"])
