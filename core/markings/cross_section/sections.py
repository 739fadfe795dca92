"""Lines as offsets d(s) at common stations: what lanes are made of."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...common.parallel import check_cancelled
from ...curves.robust import median
from ...road.common.pseudo_scanlines import expand_ranges
from ...road.edges.road_edges import RoadEdges
from ...survey.frame.placement import FrameLines
from ...survey.frame.row_table import RowSpans, RowTable
from ...survey.store.records import STATION_STEP
from ..weights import SECTIONS

if TYPE_CHECKING:
    from ..lines.painted_lines import PaintedLines


@dataclass
class CrossSections:
    """All lines of one road on a common grid of stations."""

    s: np.ndarray   # (K,) stations
    d: RowTable   # RowTable of (L, K), offset and height of each line, NaN where it is not
    z: RowTable
    seen: RowTable   # (L, K) False where the line itself was bridged
    kinds: list   # per line, of its longest piece that has one
    patterns: list   # per line, of its longest piece
    drawn: RowTable   # (L, K) how it is drawn at each place, a row of `names`; -1 where that is not known
    names: list
    number: RowTable   # (L, K) number of the line in its layer at each place; -1 where that is not known
    width: RowTable   # (L, K) m of paint across; NaN where that is not known

    @cached_property
    def usual(self) -> np.ndarray:
        """(L,) int, how most of each line is drawn, a row of `names`."""
        return np.array([self.names.index(pattern) for pattern in self.patterns], int)


def _no_row(missing, kind=float):
    return RowTable(RowSpans(np.empty(0, int), np.empty(0, int), 0), np.empty(0, kind), missing)


def no_lines() -> CrossSections:
    """CrossSections of a road without paint, on no stations."""
    return CrossSections(np.empty(0), _no_row(np.nan), _no_row(np.nan), _no_row(False, bool), [], [], _no_row(-1, int), [], _no_row(-1, int),
                         _no_row(np.nan))


def cross_sections(lines: FrameLines, number: np.ndarray, kind: np.ndarray, pattern: np.ndarray, seen: np.ndarray,
                   width: np.ndarray | None = None) -> dict[int, CrossSections]:
    """CrossSections by number of the road: lines as offsets at common stations.

    lines : FrameLines of P pieces; number : (P,) int, the pieces of one line share it
    kind, pattern : (P,) str objects, "" where unknown
    seen : (P,) bool, False for pieces that are bridged
    width : (P,) m of paint across, NaN where unknown; or None
    """
    pieces: dict[int, dict[int, list[_PieceOfLine]]] = {}
    plain = _plain(lines)
    for k in range(len(lines)):
        check_cancelled()
        window = lines.line(k)
        places = lines.s[window], lines.d[window], lines.z[window]
        if plain[k] or (places := _bounding(*places)) is not None:
            pieces.setdefault(int(lines.road[k]), {}).setdefault(int(number[k]), []).append(
                _PieceOfLine(*places, kind[k], pattern[k], bool(seen[k]), np.nan if width is None else float(width[k])))
    return {road: _on_grid(of_road) for road, of_road in sorted(pieces.items())}


def _plain(lines):
    """(P,) bool, lines whose stations rise throughout and that are nowhere oblique, as most are: they are as `_bounding` leaves them."""
    owner = np.repeat(np.arange(len(lines)), np.diff(lines.start))
    with np.errstate(invalid="ignore", divide="ignore"):
        steps = np.diff(lines.s)
        unlike = ~((steps > 0) & (np.abs(np.diff(lines.d)) / steps <= SECTIONS.max_line_obliquity))
    return (np.diff(lines.start) > 1) & (np.bincount(owner[1:], unlike & (owner[1:] == owner[:-1]), len(lines)) == 0)


def sections_of_lines(lines: PaintedLines) -> dict[int, CrossSections]:
    """CrossSections of marking lines, by road number, with the kinds that were told by hand."""
    return cross_sections(lines.course, lines.line, lines.told, lines.pattern, lines.status != "bridged", lines.width)


class EdgeSections(NamedTuple):
    """CrossSections of road edges, by road number.

    curbs : those along the road and about islands in it, None where no edges are known; where the pavement ends without one, the surface ends. Both
        sides of an island are rows of their own with one `number`
    pavement : the edges of the pavement without a curb
    """

    curbs: dict[int, CrossSections] | None
    pavement: dict[int, CrossSections]

    @classmethod
    def of(cls, edges: RoadEdges | EdgeSections | None) -> EdgeSections:
        """Those of RoadEdges, of which there may be none, or what was made of them before."""
        if isinstance(edges, EdgeSections):
            return edges
        if edges is None:
            return cls(None, {})
        return cls(_named_by_chain(edges, np.flatnonzero(np.isin(edges.kind, ("main", "island")) & edges.of_curb)),
                   _named_by_chain(edges, np.flatnonzero((edges.kind == "main") & ~edges.of_curb)))


def _named_by_chain(edges, rows):
    """CrossSections of some edges; the layer names a line by its chain, -1 stays -1."""
    course, of = _sides_of_islands(edges.course[rows], edges.kind[rows] == "island")
    rows = rows[of]
    # a number of its own for every side
    count = int(edges.edge.max(initial=-1)) + 1
    key = np.where(edges.edge[rows] < 0, -1, edges.edge[rows] + count * (np.arange(len(of)) - np.searchsorted(of, of)))
    result = cross_sections(course, key, edges.kind[rows], np.full(len(rows), "", object), edges.status[rows] != "bridged")
    chain = np.full(count + 1, -1)
    numbered = edges.edge >= 0
    chain[edges.edge[numbered]] = edges.chain[numbered]
    for sections in result.values():
        number = sections.number.values
        sections.number = sections.number.like(chain[np.where(number < 0, -1, number % max(count, 1))], -1)
    return result


def _sides_of_islands(course, island):
    """Lines as FrameLines whose stations rise or fall throughout, islands side by side, and the line that each comes from."""
    rows, of = [], []
    for k in range(len(course)):
        ring = np.arange(course.start[k], course.start[k + 1])
        sides = [ring]
        if island[k] and (finite := np.isfinite(course.s[ring])).sum() > 1:
            ring = ring[finite]
            first, last = ring[[0, -1]]
            if np.hypot(course.x[first] - course.x[last], course.y[first] - course.y[last]) < SECTIONS.closed_island:
                ring = np.roll(ring, -int(np.argmin(course.s[ring])))
            turns = sorted({0, int(np.argmin(course.s[ring])), int(np.argmax(course.s[ring])), len(ring) - 1})
            sides = [ring[a:b + 1] for a, b in zip(turns[:-1], turns[1:])]
        rows += sides
        of += [k] * len(sides)
    start, vertices = np.append(0, np.cumsum([len(side) for side in rows], dtype=int)), np.concatenate([np.empty(0, int), *rows])
    return FrameLines(course.road[of], start, *(values[vertices] for values in (course.x, course.y, course.z, course.s, course.d))), np.array(of, int)


def _bounding(s, d, z):
    """Vertices of a line at rising stations, None where it bounds no lane."""
    finite = np.isfinite(s)
    if not finite.all():
        s, d, z = s[finite], d[finite], z[finite]
    if len(s) < 2:
        return None
    if s[-1] < s[0]:
        s, d, z = s[::-1], d[::-1], z[::-1]
    rising = np.append(True, s[1:] > np.maximum.accumulate(s)[:-1])
    if not rising.all():
        s, d, z = s[rising], d[rising], z[rising]
    if len(s) < 2 or median(np.abs(np.diff(d)) / np.diff(s)) > SECTIONS.max_line_obliquity:
        return None
    return s, d, z


def _on_grid(pieces: dict[int, list[_PieceOfLine]]) -> CrossSections:
    """CrossSections of the lines of one road, which go on over short gaps."""
    lines, leads = joined(_lines_on_grid(pieces))
    _lead_over(lines, leads)
    lengthen_dashed(lines)
    tables = lines.tables()
    return CrossSections(lines.s, tables["d"], tables["z"], tables["seen"], [row.kind for row in lines.rows], [row.pattern for row in lines.rows],
                         tables["drawn"], lines.names, tables["number"], tables["width"])


# Lines resampled to common stations: short gaps are bridged, and lines that continue each other are merged.

GAP_REACH = int(SECTIONS.max_dash_gap / STATION_STEP)   # derived: the same in stations
# what is known of a line at each station, and what stands where it is not
MISSING = dict(d=np.float64(np.nan), z=np.float64(np.nan), seen=np.bool_(False), drawn=np.int32(-1), number=np.int32(-1), width=np.float64(np.nan))


@dataclass
class _PieceOfLine:
    """Part of a line with rising stations: s, d, z (N,) metres, how it is drawn, and how broad, metres."""

    s: np.ndarray
    d: np.ndarray
    z: np.ndarray
    kind: str
    pattern: str
    seen: bool
    width: float


class _GridRow:
    """One line at the stations from `first` on, which is there from station `begin` to `end`: columns d, z, seen, drawn, number and width."""

    def __init__(self, kind: str, pattern: str, first: int, columns: dict[str, np.ndarray]) -> None:
        self.kind, self.pattern, self.first, self.columns = kind, pattern, first, columns
        finite = np.flatnonzero(np.isfinite(columns["d"]))
        self.begin, self.end = (first + int(finite[0]), first + int(finite[-1])) if len(finite) else (first, first - 1)

    @classmethod
    def empty(cls, kind: str, pattern: str, first: int, size: int) -> _GridRow:
        return cls(kind, pattern, first, {name: np.full(size, missing) for name, missing in MISSING.items()})

    def at(self, name: str, stations: np.ndarray) -> np.ndarray:
        """(N,) values of a column."""
        values = self.columns[name]
        index = np.asarray(stations) - self.first
        inside = (index >= 0) & (index < len(values))
        return np.where(inside, values[np.where(inside, index, 0)], MISSING[name]) if len(values) else np.full(index.shape, MISSING[name])

    def put(self, name: str, stations: np.ndarray, values: np.ndarray | bool) -> None:
        """Set values of a column at some stations, which the row is lengthened to."""
        if not len(stations):
            return
        self._reach(int(stations.min()), int(stations.max()))
        self.columns[name][stations - self.first] = values
        if name == "d" and (measured := stations[np.isfinite(values)]).size:
            self.begin, self.end = min(self.begin, int(measured.min())), max(self.end, int(measured.max()))

    def _reach(self, low, high):
        before, behind = max(self.first - low, 0), max(high + 1 - self.first - len(self.columns["d"]), 0)
        if before or behind:
            self.columns = {name: np.concatenate([np.full(before, MISSING[name]), values, np.full(behind, MISSING[name])])
                            for name, values in self.columns.items()}
            self.first -= before


class _GridLines:
    """The lines of one road at (K,) stations; `names` are the patterns that `drawn` counts."""

    def __init__(self, s: np.ndarray, rows: list[_GridRow], names: list[str]) -> None:
        self.s, self.rows, self.names = s, rows, names

    def tables(self) -> dict[str, RowTable]:
        """{name: (L, K)} of the columns, each row from where the line begins to where it ends."""
        spans = RowSpans(np.array([row.begin for row in self.rows], int), np.array([row.end + 1 - row.begin for row in self.rows], int), len(self.s))
        columns = {name: np.concatenate([np.empty(0, missing.dtype), *(
            row.columns[name][row.begin - row.first:row.end + 1 - row.first] for row in self.rows)]) for name, missing in MISSING.items()}
        columns["seen"] &= np.isfinite(columns["d"])
        return {name: RowTable(spans, values, MISSING[name]) for name, values in columns.items()}


def _lines_on_grid(lines: dict[int, list[_PieceOfLine]]) -> _GridLines:
    """Lines of one road, given as their pieces by number, on the stations from their first to their last place."""
    # the order of the layer's rows must not matter
    order = sorted(lines, key=lambda key: (min(p.s[0] for p in lines[key]), median(lines[key][0].d), key))
    by_line = [sorted(lines[key], key=lambda p: (p.s[0], p.s[-1])) for key in order]
    pieces, line = [*chain.from_iterable(by_line)], np.repeat(np.arange(len(order)), [*map(len, by_line)])
    ends, names = np.array([(p.s[0], p.s[-1]) for p in pieces]), sorted({p.pattern for p in pieces})
    s = STATION_STEP * np.arange(np.ceil(ends[:, 0].min() / STATION_STEP), np.floor(ends[:, 1].max() / STATION_STEP) + 1)
    # pieces of one line touch: a grid station between their ends belongs to the line too
    begin, end = np.searchsorted(s, ends[:, 0] - 1e-6), np.searchsorted(s, ends[:, 1] + 1e-6, side="right")
    begins = np.flatnonzero(np.diff(line, prepend=-1))
    first = np.minimum.reduceat(begin, begins)
    start = np.append(0, np.cumsum(np.maximum(np.maximum.reduceat(end, begins) - first, 0)))
    columns = _columns_on_grid(pieces, np.array(order)[line], names, s, begin, end, (start[:-1] - first)[line], int(start[-1]))
    rows = [_GridRow(_longest([p for p in of_line if p.kind] or of_line).kind, _longest(of_line).pattern, at,
                     {name: values[a:b] for name, values in columns.items()})
            for of_line, at, a, b in zip(by_line, first.tolist(), start[:-1].tolist(), start[1:].tolist())]
    return _GridLines(s, rows, names)


def _longest(pieces):
    return max(pieces, key=lambda p: (p.seen, p.s[-1] - p.s[0]))


def _columns_on_grid(pieces, number, names, s, begin, end, shift, size):
    """{name: (size,)} of the columns of rows one after the other: a piece stands at the stations from `begin` to before `end`, `shift` farther."""
    columns = {name: np.full(size, missing) for name, missing in MISSING.items()}
    of, station = expand_ranges(begin, end)
    place, stretches = station + shift[of], [s[a:b] for a, b in zip(begin.tolist(), end.tolist())]
    for name, of_pieces in (("drawn", map(names.index, (p.pattern for p in pieces))), ("number", number), ("width", (p.width for p in pieces))):
        columns[name][place] = np.array([*of_pieces])[of]
    for name in ("d", "z"):
        # to 0.1 mm, as points are: paint that changes somewhere moves a fitted line by less everywhere
        columns[name][place] = np.round(np.concatenate([np.interp(at, p.s, getattr(p, name)) for at, p in zip(stretches, pieces)]), 4)
    columns["seen"][place[np.array([p.seen for p in pieces])[of]]] = True
    return columns


def joined(lines: _GridLines) -> tuple[_GridLines, list[tuple[int, int, int]]]:
    """Lines that go on as another line after at most a dash gap, in one row: a dashed line turns solid at a junction.

    Returns the lines, and where a double line goes on as a single one: the station where it ends, and the row and station where that one begins.
    """
    rows = lines.rows
    present = [k for k, row in enumerate(rows) if row.end >= row.begin]
    leads: list[tuple[int, int, int]] = []
    chains = {k: [k] for k in present}     # the lines that a row is made of, by the number of its first one
    ending = defaultdict(set)           # rows by the station that they end at
    for k in present:
        ending[rows[k].end].add(k)
    for k in sorted(present, key=lambda k: (rows[k].begin, k)):
        check_cancelled()
        last, d = rows[k].begin, rows[k].columns["d"][rows[k].begin - rows[k].first]
        behind = np.array(sorted(j for end in range(last - GAP_REACH, last) for j in ending.get(end, ())), int)
        steps = np.array([abs(d - rows[chains[j][-1]].at("d", np.array([rows[chains[j][-1]].end]))[0]) for j in behind.tolist()])
        behind, steps = behind[steps <= SECTIONS.max_line_jump], steps[steps <= SECTIONS.max_line_jump]
        if not len(behind):
            continue
        j = int(behind[np.argmin(steps)])
        before = rows[chains[j][-1]]
        double = ["double" in row.pattern for row in (before, rows[k])]
        if double[0] != double[1]:
            leads.append((before.end, j, last) if double[0] else (last, j, before.end))
        ending[before.end].remove(j)
        ending[rows[k].end].remove(k)
        ending[rows[k].end].add(j)
        chains[j] += chains.pop(k)
    number = {j: k for k, j in enumerate(sorted(chains))}
    return (_GridLines(lines.s, [_chained([rows[k] for k in chains[j]]) for j in sorted(chains)], lines.names),
            [(end, number[j], begin) for end, j, begin in leads])


def _chained(rows):
    """Rows that follow each other as one; the gaps between them are closed."""
    head = rows[0]
    if len(rows) == 1:
        return head
    result = _GridRow.empty(head.kind, head.pattern, head.begin, rows[-1].end + 1 - head.begin)
    for k, row in enumerate(rows):
        window = slice(row.begin - head.begin, row.end + 1 - head.begin)
        for name, values in result.columns.items():
            values[window] = row.columns[name][row.begin - row.first:row.end + 1 - row.first]
        if k:
            first, last = rows[k - 1].end - head.begin, window.start
            gap = np.arange(first + 1, last)
            for name in ("d", "z"):
                result.columns[name][gap] = np.interp(gap, [first, last], result.columns[name][[first, last]])
            # a gap of a dashed line is no gap
            result.columns["seen"][gap] = head.pattern.startswith("dash") or row.pattern.startswith("dash")
    return _GridRow(next((row.kind for row in rows if row.kind), ""), head.pattern, head.begin, result.columns)


def _lead_over(lines: _GridLines, leads: list[tuple[int, int, int]]) -> None:
    """Where a double line goes on as a single one, as `joined` says, both of its lines lead over to it: lanes on either side end at that one."""
    for double_end, k, begin in leads:
        step = 1 if begin > double_end else -1
        for other, row in enumerate(lines.rows):
            end = row.end if step > 0 else row.begin
            if other == k or "double" not in row.pattern or not 0 <= (double_end - end) * step <= GAP_REACH:
                continue
            gap, ends = np.arange(end + step, begin, step), np.array([end, begin])
            values = {name: np.array([row.at(name, ends)[0], lines.rows[k].at(name, ends)[1]]) for name in ("d", "z")}
            if abs(np.diff(values["d"])[0]) < SECTIONS.min_boundary_spacing:
                for name in values:
                    row.put(name, gap, np.interp(gap * step, ends * step, values[name]))
                row.put("seen", gap, lines.rows[k].at("seen", gap))


def lengthen_dashed(lines: _GridLines) -> None:
    """A dashed line goes on by up to one gap where lines on both its sides do, beside the one it keeps to: it is only missed after a gap's length."""
    tables = lines.tables()
    d, seen = tables["d"], tables["seen"]
    for k, row in enumerate(lines.rows):
        if not row.pattern.startswith("dash") or row.end == row.begin:
            continue
        for end, step in ((row.end, 1), (row.begin, -1)):
            beside = np.array([j for j in d.spans.near(end, end).tolist() if j != k], int)
            offset = d[beside, end] - d[k, end]
            sides = [beside[there][np.argmin(np.abs(offset[there]))] for side in (1, -1)
                     if (there := side * offset > SECTIONS.min_boundary_spacing).any()]
            ahead, inner = (stations[(stations >= 0) & (stations < len(lines.s))] for stations in (
                end + step * np.arange(1, GAP_REACH + 1), end - step * np.arange(GAP_REACH + 1)))
            if len(sides) < 2:
                continue
            # where they part, as they do along a taper, it keeps to one
            changes = [np.ptp(apart[np.isfinite(apart)]) for apart in d[np.array(sides)[:, None], inner] - d[k, inner]]
            go = np.array([np.isfinite(d[j, ahead]) & seen[j, ahead] for j in sides]).all(axis=0)
            ahead, along = ahead[:len(go) if go.all() else int(np.argmin(go))], sides[int(np.argmin(changes))]
            for name in ("d", "z"):
                row.put(name, ahead, tables[name][along, ahead] + tables[name][k, end] - tables[name][along, end])
            row.put("seen", ahead, True)
