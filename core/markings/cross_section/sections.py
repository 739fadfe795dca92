"""Lines as offsets d(s) at common stations: what lanes are made of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...curves.robust import median
from ...road.edges.road_edges import RoadEdges
from ...survey.frame.frame_lines import FrameLines

if TYPE_CHECKING:
    from ..lines.painted_lines import PaintedLines

STATION_STEP = 0.5                             # m of station between places where lanes are looked for
MAX_LINE_OBLIQUITY = np.tan(np.radians(25.0))  # a line that runs more across the road than this bounds no lane
MIN_BOUNDARY_SPACING = 0.8                     # m: lines nearer than this are one boundary, a lane ends at the nearer one
MAX_LINE_JUMP = 0.3                         # m across by which a line may jump where it goes on as another
CLOSED_ISLAND = 1.0                            # m between the ends of a line round an island that closes
PARTING = 0.1                                  # m by which a line must leave one neighbour more than the other to run along that one
MAX_DASH_GAP = 9.5                             # m that a dashed line may be silent at its ends before it is known to end


@dataclass
class CrossSections:
    """All lines of one road on a common grid of stations.

    s : (K,) stations; d, z : (L, K) offset and height of each line, NaN where it is not;
    seen : (L, K) False where the line itself was bridged; kinds, patterns : per line, of its longest piece
    drawn : (L, K) how it is drawn at each place, a row of `names`; -1 where that is not known
    number : (L, K) number of the line in its layer at each place; -1 where that is not known
    width : (L, K) m of paint across; NaN where that is not known
    """

    s: np.ndarray
    d: np.ndarray
    z: np.ndarray
    seen: np.ndarray
    kinds: list
    patterns: list
    drawn: np.ndarray
    names: list
    number: np.ndarray
    width: np.ndarray


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
    pieces: dict[int, dict[int, list[_Piece]]] = {}
    for k in range(len(lines)):
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
    course, of = _sides_of_islands(edges.course.take(rows), edges.kind[rows] == "island")
    rows = rows[of]
    # a number of its own for every side
    count = int(edges.edge.max(initial=-1)) + 1
    key = np.where(edges.edge[rows] < 0, -1, edges.edge[rows] + count * (np.arange(len(of)) - np.searchsorted(of, of)))
    found = cross_sections(course, key, edges.kind[rows], np.full(len(rows), "", object), edges.status[rows] != "bridged")
    chain = np.full(count + 1, -1)
    known = edges.edge >= 0
    chain[edges.edge[known]] = edges.chain[known]
    for sections in found.values():
        sections.number = chain[np.where(sections.number < 0, -1, sections.number % max(count, 1))]
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


@dataclass
class _Piece:
    """Part of a line with rising stations: s, d, z (N,) metres, how it is drawn, and how broad, metres."""

    s: np.ndarray
    d: np.ndarray
    z: np.ndarray
    kind: str
    pattern: str
    seen: bool
    width: float


def _piece(s, d, z, kind, pattern, seen, width):
    """A _Piece of the vertices of a line, None where it bounds no lane."""
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
    return _Piece(s, d, z, kind, pattern, seen, width)


def _on_grid(lines: dict[int, list[_Piece]]) -> CrossSections:
    first = np.ceil(min(p.s[0] for pieces in lines.values() for p in pieces) / STATION_STEP)
    last = np.floor(max(p.s[-1] for pieces in lines.values() for p in pieces) / STATION_STEP)
    s = STATION_STEP * np.arange(first, last + 1)
    # the order of the layer's rows must not matter
    order = sorted(lines, key=lambda key: (min(p.s[0] for p in lines[key]), np.median(lines[key][0].d), key))
    d, z, width = np.full((3, len(order), len(s)), np.nan)
    seen, (drawn, number) = np.zeros((len(order), len(s)), bool), np.full((2, len(order), len(s)), -1, np.int32)
    names = sorted({p.pattern for pieces in lines.values() for p in pieces})
    kinds, patterns = [], []
    for k, key in enumerate(order):
        pieces = sorted(lines[key], key=lambda p: (p.s[0], p.s[-1]))
        for p in pieces:
            # pieces of one line touch: a grid station between their ends belongs to the line too
            inside = slice(np.searchsorted(s, p.s[0] - 1e-6), np.searchsorted(s, p.s[-1] + 1e-6, side="right"))
            d[k, inside] = np.interp(s[inside], p.s, p.d)
            z[k, inside] = np.interp(s[inside], p.s, p.z)
            seen[k, inside] |= p.seen
            drawn[k, inside] = names.index(p.pattern)
            number[k, inside] = key
            width[k, inside] = p.width
        longest = max(pieces, key=lambda p: (p.seen, p.s[-1] - p.s[0]))
        kinds.append(longest.kind)
        patterns.append(longest.pattern)
    found, gaps = _joined(CrossSections(s, d, z, seen, kinds, patterns, drawn, names, number, width))
    _even_doubles(found, _lead_over(found, gaps))
    _lengthen_dashed(found)
    return found


def _joined(lines):
    """Lines that go on as another line after at most a dash gap, in one row: a dashed line turns solid at a junction.

    Returns the CrossSections, and of each gap that was closed the row, the stations (as columns) on both its sides and
    whether the line is double there.
    """
    rows, gaps = list(range(len(lines.d))), []
    ends = {k: np.flatnonzero(np.isfinite(lines.d[k])) for k in rows}
    owner = dict(enumerate(rows))  # the line that a row ends as
    rows = [k for k in rows if len(ends[k])]
    # columns in which rows end and their offsets there, NaN where there is no row any more
    end, at_end = np.zeros(len(lines.d), int), np.full(len(lines.d), np.nan)
    end[rows] = [ends[k][-1] for k in rows]
    at_end[rows] = lines.d[rows, end[rows]]
    for k in sorted(rows, key=lambda k: (ends[k][0], k)):
        last = ends[k][0]
        away = np.abs(lines.d[k, last] - at_end)
        gap = (last - end) * STATION_STEP
        behind = np.flatnonzero((gap > 0) & (gap <= MAX_DASH_GAP) & (away <= MAX_LINE_JUMP))
        if not len(behind):
            continue
        j = int(behind[np.argmin(away[behind])])
        first = end[j]
        gaps.append((j, first, last, *("double" in lines.patterns[owner[i]] for i in (j, k))))
        owner[j] = owner[k]
        gap = np.arange(first + 1, last)
        for values in (lines.d, lines.z):
            values[j, last:] = np.where(np.isfinite(values[k, last:]), values[k, last:], values[j, last:])
            values[j, gap] = np.interp(gap, [first, last], values[j, [first, last]])
        lines.seen[j, last:] |= lines.seen[k, last:]
        lines.drawn[j, last:] = lines.drawn[k, last:]
        lines.number[j, last:] = lines.number[k, last:]
        lines.width[j, last:] = lines.width[k, last:]
        # a gap of a dashed line is no gap
        lines.seen[j, gap] = any(lines.patterns[i].startswith("dash") for i in (j, k))
        end[j], at_end[j], at_end[k] = end[k], lines.d[j, end[k]], np.nan
        rows.remove(k)
    found = CrossSections(lines.s, lines.d[rows], lines.z[rows], lines.seen[rows], [lines.kinds[k] for k in rows],
                          [lines.patterns[k] for k in rows], lines.drawn[rows], lines.names, lines.number[rows], lines.width[rows])
    return found, [(rows.index(j), *gap) for j, *gap in gaps]


def _lead_over(lines, gaps):
    """Where a double line goes on as a single one, both of its lines lead over to it: lanes on either side end at that one.

    Returns the ends of lines that were led on, as (row, 1 where it ended or -1 where it began).
    """
    reach, led = int(MAX_DASH_GAP / STATION_STEP), set()
    for j, last, first, before, after in gaps:
        if before == after:
            continue
        # from the double line's own end to where the single one begins, in whichever direction
        own, other, step = (last, first, 1) if before else (first, last, -1)
        for k in np.flatnonzero(["double" in pattern for pattern in lines.patterns]):
            columns = np.flatnonzero(np.isfinite(lines.d[k]))
            if k == j or not len(columns):
                continue
            end = columns[-1 if step > 0 else 0]
            if not 0 <= (own - end) * step <= reach or abs(lines.d[k, end] - lines.d[j, end]) >= MIN_BOUNDARY_SPACING:
                continue
            beside, gap = np.arange(end + step, own + step, step), np.arange(own + step, other, step)
            for values in (lines.d, lines.z):
                apart = values[k, end] - values[j, end]
                values[k, beside] = values[j, beside] + apart
                values[k, gap] = values[j, gap] + apart * (other - gap) / (other - own)
            for columns in (beside, gap):
                lines.seen[k, columns] = lines.seen[j, columns]
            led.add((int(k), step))
    return led


def _even_doubles(lines, led):
    """The two lines of a double line begin and end together: the shorter goes on beside the longer, a dash gap at most.

    Else a lane would reach for the farther of the two where the nearer is worn away.
    """
    present = np.isfinite(lines.d)
    reach = int(MAX_DASH_GAP / STATION_STEP)
    for k in np.flatnonzero(["double" in pattern for pattern in lines.patterns]):
        columns = np.flatnonzero(present[k])
        if not len(columns):
            continue
        for end, step in ((columns[-1], 1), (columns[0], -1)):
            if (k, step) in led:
                continue
            beside = np.abs(np.where(present[:, end], lines.d[:, end], np.nan) - lines.d[k, end])
            beside[k] = np.nan
            twin = _nearest(beside < MIN_BOUNDARY_SPACING, beside)
            if twin is None:
                continue
            ahead = end + step * np.arange(1, reach + 1)
            ahead = ahead[(ahead >= 0) & (ahead < len(lines.s))]
            go = present[twin, ahead] & ~present[k, ahead]
            ahead = ahead[:len(go) if go.all() else int(np.argmin(go))]
            for values in (lines.d, lines.z):
                values[k, ahead] = values[twin, ahead] + (values[k, end] - values[twin, end])
            lines.seen[k, ahead] = lines.seen[twin, ahead]


def _lengthen_dashed(lines):
    """A dashed line goes on by up to one gap where lines on both its sides do.

    Where the last dash ends says nothing of where the line does: the next dash is only
    missed after a gap's length.
    """
    present = np.isfinite(lines.d)
    reach = int(MAX_DASH_GAP / STATION_STEP)
    for k in np.flatnonzero([pattern.startswith("dash") for pattern in lines.patterns]):
        columns = np.flatnonzero(present[k])
        if len(columns) < 2:
            continue
        for end, step in ((columns[-1], 1), (columns[0], -1)):
            others = present[:, end].copy()
            others[k] = False
            offsets = np.where(others, lines.d[:, end] - lines.d[k, end], np.nan)
            left = _nearest(offsets > MIN_BOUNDARY_SPACING, np.abs(offsets))
            right = _nearest(offsets < -MIN_BOUNDARY_SPACING, np.abs(offsets))
            if left is None or right is None:
                continue
            ahead = end + step * np.arange(1, reach + 1)
            ahead = ahead[(ahead >= 0) & (ahead < len(lines.s))]
            go = present[left, ahead] & present[right, ahead] & lines.seen[left, ahead] & lines.seen[right, ahead]
            ahead = ahead[:len(go) if go.all() else int(np.argmin(go))]
            share = _share_across(lines.d, k, left, right, end - step * np.arange(reach + 1))
            for values in (lines.d, lines.z):
                beside = values[left] * share + values[right] * (1 - share)
                values[k, ahead] = beside[ahead] + values[k, end] - beside[end]
            lines.seen[k, ahead] = True


def _share_across(d, k, left, right, inner):
    """How a line lies between two others, 0 on the right one and 1 on the left one: where they part, as they do along a taper, it keeps to one.

    `inner` are columns of stations at its end, from there on.
    """
    inner = inner[(inner >= 0) & (inner < d.shape[1])]
    apart = np.abs(d[[left, right]][:, inner] - d[k, inner])
    apart = apart[:, np.isfinite(apart).all(axis=0)]
    away = np.ptp(apart, axis=1)
    if abs(away[0] - away[1]) > PARTING:
        return float(away[0] < away[1])
    return apart[1, 0] / (apart[0, 0] + apart[1, 0])


def _nearest(which, distance):
    rows = np.flatnonzero(which)
    return rows[np.argmin(distance[rows])] if len(rows) else None
