"""Which linked paint is a line, how far it reaches, and with what dashes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...common.parallel import check_cancelled
from ...countries.catalogue import NEUTRAL
from ...curves.robust import median
from ..weights import LINKS, SELECTION
from .linking import CommonTrend, StretchLookup, lines_beside
from .strands import EdgesBeside, LinkedLine


@dataclass
class SelectedLine:
    """A line with its pieces by status and pattern, and the stations it is drawn between."""

    line: LinkedLine
    pieces: list

    def width(self, piece: _LinePiece) -> float:
        """Metres of paint across, of its own strands, or of those of the whole line where it has none."""
        strands = self.line.strands_between(piece.first, piece.last)
        overlaps = [max(min(strand.last, piece.last) - max(strand.first, piece.first), 0.0) for strand in strands]
        return float(np.average([strand.width for strand in strands], weights=overlaps)) if sum(overlaps) > 0 else self.line.mean_width

    @property
    def span(self) -> tuple[float, float]:
        return self.pieces[0].first, self.pieces[-1].last


def select_lines(lines: list[LinkedLine], trend: CommonTrend, min_paint: float, edges: EdgesBeside,
                 longest_dash: float = NEUTRAL.longest_dash) -> list[SelectedLine]:
    """The lines worth drawing, by station.

    A line needs paint: `min_paint` m of it, or two dashes of a pattern. What runs close beside a much longer line is that line's ragged edge; what
    frames a hatched area belongs to that area. What goes on behind one is the same line, of which nothing is drawn on the area.

    longest_dash : m, longer paint is solid line
    """
    if not lines:
        return []
    neighbours = lines_beside(lines)
    spans = np.array([(strand.first, strand.last) for line in lines for strand in line.strands]).reshape(-1, 2)
    owner, strands = np.repeat(np.arange(len(lines)), [len(line.strands) for line in lines]), StretchLookup(*spans.T)
    parts = [stretches(line, longest_dash) for line in lines]
    level = np.array([median(d - trend.at(s)) for s, d, *_ in (line.places for line in lines)])
    painted = min(line.first for line in lines), max(line.last for line in lines)
    ragged, twins = _beside(lines, neighbours, trend, longest_dash)
    selected = []
    for k, line in enumerate(lines):
        check_cancelled()
        dashed = any(stretch.dashes for stretch in parts[k])
        if ragged[k] or edges.framed(line) or not (line.painted >= min_paint or dashed):
            continue

        def painted_beside(first, last, k=k):
            near = strands.between(first, last)
            return spans[near[(owner[near] != k) & (np.abs(level[owner[near]] - level[k]) <= SELECTION.max_neighbour_offset)]]

        pieces = _extended(_line_pieces(parts[k]), parts[k], painted, painted_beside, line)
        ends = np.array([(piece.first, piece.last) for piece in pieces]).reshape(-1, 2)
        crosses = edges.bars(ends, np.interp(ends, *line.by_station), hatching=True)
        pieces = [piece for piece, hatched in zip(pieces, crosses.tolist()) if piece.status == "measured" or not hatched]
        selected.append(SelectedLine(line, _named_double(pieces, *twins[k])))
    return selected


def _named_double(pieces, stations, beside_twin):
    """Pieces named double where enough of their paint has a twin, and those without paint where it has on both sides of them.

    A double line may go on as a single one, such as dashes. `stations` : m, ascending, of places of the line
    """
    begin, end = np.searchsorted(stations, [[piece.first for piece in pieces], [piece.last for piece in pieces]])
    count, total = end - begin, np.append(0, np.cumsum(beside_twin))
    painted, every = np.flatnonzero(count), np.arange(len(pieces))
    if not len(painted):
        return pieces
    double = (total[end] - total[begin])[painted] > SELECTION.max_ragged_share * count[painted]
    before, behind = np.searchsorted(painted, every, side="right") - 1, np.searchsorted(painted, every)
    double = double[before.clip(0)] & double[behind.clip(max=len(painted) - 1)]
    return [replace(piece, pattern=f"double-{piece.pattern}") if of_piece else piece for piece, of_piece in zip(pieces, double.tolist())]


def _beside(lines, beside, trend, longest_dash):
    """(N,) ragged: a sliver beside a longer line; of each line stations of its places, m, and whether it is one of a double line there."""
    ragged, tracks = np.zeros(len(lines), bool), []
    for line in lines:
        s, d, *_ = line.places
        cell = np.floor(s / 0.5).astype(np.int64)
        cells, first = np.unique(cell, return_index=True)
        tracks.append((cells, (d - trend.at(s))[first]))
    twins = [np.zeros(len(cells), bool) for cells, _ in tracks]
    for k in range(len(lines)):
        check_cancelled()
        for j in beside.between(lines[k].first, lines[k].last).tolist():
            if j == k:
                continue
            a, b = _shared(tracks[k][0], tracks[j][0])
            if len(a) < 3:
                continue
            apart = np.abs(tracks[k][1][a] - tracks[j][1][b])
            spacing = median(apart)
            share = len(a) / len(tracks[k][0])
            if spacing <= LINKS.double_line_spacing[1] and share > SELECTION.min_shared_paint:
                # between two junctions both lines of a double are short, and one of them may go on farther beyond
                beside_it = [strand for strand in lines[j].strands_between(lines[k].first, lines[k].last)
                             if strand.last > lines[k].first and strand.first < lines[k].last]
                min_paint = max(SELECTION.min_twin_paint, SELECTION.min_shared_paint * sum(strand.length for strand in beside_it))
                twin = spacing >= LINKS.double_line_spacing[0] and lines[k].painted >= min_paint
                if not twin and lines[k].painted < SELECTION.max_ragged_share * lines[j].painted and lines[k].painted < longest_dash:
                    ragged[k] = True
                elif spacing >= LINKS.double_line_spacing[0]:
                    near = apart <= LINKS.double_line_spacing[1]
                    twins[k][a[near]] = twins[j][b[near]] = True
    return ragged, [(0.5 * cells + 0.25, twin) for (cells, _), twin in zip(tracks, twins)]


def _shared(one, other):
    """Where in each of two arrays, ascending, the values are that both have."""
    begin, end = max(one[0], other[0]), min(one[-1], other[-1])
    windows = [slice(np.searchsorted(cells, begin), np.searchsorted(cells, end, side="right")) for cells in (one, other)]
    _, a, b = np.intersect1d(one[windows[0]], other[windows[1]], assume_unique=True, return_indices=True)
    return a + windows[0].start, b + windows[1].start


def _extended(drawn, parts, painted, painted_beside, line):
    """A dashed line ends with a gap: its ends go on by one gap, but not past the road's paint, (first, last), or past the ends of lines beside it.

    `painted_beside` tells their paint between two stations.
    """
    for sign, tip, dashes, outermost in ((-1, line.first, parts[0].dashes, painted[0]), (1, line.last, parts[-1].dashes, painted[1])):
        if not dashes:
            continue
        # stations count outwards
        tip, limit = sign * tip, sign * tip + dashes.gap
        inner, outer = sign * painted_beside(*sorted((sign * tip - sign, sign * limit + sign)))[:, ::sign].T
        ended = outer[(outer < limit) & (outer >= tip)]
        running = ((outer >= limit) & (inner < limit - 1.0)).any()
        end = max(min(limit, sign * outermost, ended.max() if len(ended) and not running else np.inf), tip)
        piece = _LinePiece(*sorted((sign * tip, sign * end)), "measured", "dashed")
        drawn = [piece, *drawn] if sign < 0 else [*drawn, piece]
    return merged_pieces(drawn)


# Solid or dashed, and with what dash length and period, from the painted intervals of a line.


@dataclass(frozen=True)
class _DashPattern:
    """Dashes of one length at one period; metres."""

    dash: float
    period: float

    @property
    def gap(self) -> float:
        return self.period - self.dash


@dataclass(frozen=True)
class Stretch:
    """Part of a line of one pattern, from station `first` to `last`; `find_dash_pattern` is None where it is solid."""

    first: float
    last: float
    dashes: _DashPattern | None
    intervals: tuple   # (first, last) of each painted interval

    @property
    def pattern(self) -> str:
        return "dashed" if self.dashes else "solid"


def _painted_intervals(line: LinkedLine) -> np.ndarray:
    """(K, 2) stations between which a line is painted, holes of wear closed."""
    first, last = np.array([span for strand in line.strands for span in _painted(strand)]).T
    last = np.maximum.accumulate(last)
    holes = first[1:] - last[:-1] >= SELECTION.max_worn_hole
    return np.column_stack([first[np.r_[True, holes]], last[np.r_[holes, True]]])


def _painted(strand):
    """(first, last) of the parts of a strand: a strand leaps the gaps of short dashes. Where they are uneven they are wear."""
    holes = np.flatnonzero(np.diff(strand.s) > SELECTION.max_worn_hole)
    if len(holes) + 1 < SELECTION.min_short_dashes:
        return [(strand.first, strand.last)]
    parts = np.column_stack([np.r_[strand.first, strand.s[holes + 1]], np.r_[strand.s[holes], strand.last]])
    length, steps = np.diff(parts, axis=1)[:, 0], np.diff(parts.mean(axis=1))
    if (np.abs(steps - np.median(steps)) > SELECTION.period_tolerance * np.median(steps)).mean() > SELECTION.max_uneven_share \
            or (np.abs(length - np.median(length)) > SELECTION.short_dash_tolerance).mean() > SELECTION.max_uneven_share:
        return [(strand.first, strand.last)]
    return list(map(tuple, parts.tolist()))


def stretches(line: LinkedLine, longest_dash: float = NEUTRAL.longest_dash) -> list[Stretch]:
    """The stretches of a line: dashed where short intervals follow a dash pattern, solid elsewhere; paint longer than `longest_dash`, m, is solid."""
    spans = _painted_intervals(line)
    long = np.diff(spans, axis=1)[:, 0] > longest_dash
    cuts = np.flatnonzero(np.r_[True, np.diff(long.astype(int)) != 0, True])
    groups: list[tuple[np.ndarray, _DashPattern | None]] = []
    for a, b in zip(cuts[:-1], cuts[1:]):
        group = spans[a:b]
        # beside solid stretches a few worn pieces look like dashes by chance
        dashes = None if long[a] or long.any() and len(group) < 3 else find_dash_pattern(group, beside_solid=bool(long.any()))
        if groups and groups[-1][1] is None and dashes is None:
            groups[-1] = (np.vstack([groups[-1][0], group]), None)
        else:
            groups.append((group, dashes))
    return [Stretch(float(group[0, 0]), float(group[-1, 1]), dashes, tuple(map(tuple, group.tolist())))
            for group, dashes in groups]


def find_dash_pattern(spans: np.ndarray, beside_solid: bool = False) -> _DashPattern | None:
    """The _DashPattern of painted intervals (K, 2), or None where they follow none.

    Dashes may be missing: steps between dashes are then whole multiples of the period. Some may be worn at their ends: three of five must have the
    common length. Of three pieces alone all must have it, or their two steps must be equal: by chance one step is soon a multiple of the other. In
    a line that is solid elsewhere (`beside_solid`) all must have it: there three pieces are what wear left of it, and equal steps chance. Wear
    leaves no three pieces of exactly one length: those are dashes, even if they begin anew where roads join.
    """
    if len(spans) < 2:
        return None
    length, steps = spans[:, 1] - spans[:, 0], np.diff(spans.mean(axis=1))
    # the full dashes tell the length; worn ones are only ever shorter
    dash = float(np.median(length[length >= 0.6 * np.percentile(length, 75)]))
    alike = np.abs(length - dash) <= max(0.5, 0.2 * dash)
    if len(spans) == 2:
        gap = float(spans[1, 0] - spans[0, 1])
        # two pieces may be alike by chance: they must be as long as dashes are, and equally long
        even = np.ptp(length) <= max(0.4, 0.12 * dash) and SELECTION.dash_pair_length[0] <= dash <= SELECTION.dash_pair_length[1] \
            and max(SELECTION.min_gap_per_dash * dash, 1.5) <= gap <= 13.0
        return _DashPattern(dash, float(steps[0])) if even else None
    period = _period(steps)
    if period is None and np.ptp(length) <= SELECTION.equal_dashes:
        period = float(np.median(steps))
    if period is None or period - dash < SELECTION.min_gap_per_dash * dash or alike.mean() < 0.55:
        return None
    if len(spans) == 3 and not alike.all():
        # a worn dash keeps one of its ends, or its middle
        steps = np.diff(np.column_stack([spans, spans.mean(axis=1)]), axis=0)
        if beside_solid or np.ptp(steps, axis=0).min() > SELECTION.step_tolerance:
            return None
    return _DashPattern(dash, period)


def _period(steps):
    """The longest period of which most steps are whole multiples (up to 4), or None."""
    best, best_share = None, 0.0
    for start in np.unique(np.round(steps, 1)):
        if start < 2 * SELECTION.max_worn_hole:
            continue
        times = np.maximum(np.round(steps / start), 1.0)
        matching = (np.abs(steps / start - times) <= SELECTION.period_tolerance) & (times <= 4)
        share, single = matching.mean(), (times[matching] == 1).sum()
        # many steps over missing dashes are believed where nearly all fit
        if single < 0.4 * len(steps) and not (single >= 2 and len(steps) >= 5 and share >= 0.85):
            continue
        if share > best_share + 1e-9:
            best, best_share = float(np.sum(steps[matching]) / np.sum(times[matching])), share
    return best if best_share >= 0.65 else None


def same_dash_pattern(before: LinkedLine, after: LinkedLine, longest_dash: float = NEUTRAL.longest_dash) -> bool:
    """Whether two lines are dashed alike and the gap between them is a whole multiple of the period."""
    ends, begins = stretches(before, longest_dash)[-1], stretches(after, longest_dash)[0]
    if not ends.dashes or not begins.dashes:
        return False
    period = (ends.dashes.period + begins.dashes.period) / 2
    if abs(ends.dashes.period - begins.dashes.period) > SELECTION.period_tolerance * period \
            or abs(ends.dashes.dash - begins.dashes.dash) > max(0.6, 0.25 * ends.dashes.dash):
        return False
    step = (np.mean(begins.intervals[0]) - np.mean(ends.intervals[-1])) / period
    return abs(step - round(step)) <= SELECTION.period_tolerance * 1.5


@dataclass(frozen=True)
class _LinePiece:
    """Part of a line of one status and pattern, between two stations."""

    first: float
    last: float
    status: str
    pattern: str


def _line_pieces(parts: list[Stretch]) -> list[_LinePiece]:
    """Cut a line of some stretches where its status or pattern changes.

    A hole longer than the line's own gap, or in a solid line longer than 2.5 m, is bridged.
    """
    pieces = []
    for k, part in enumerate(parts):
        gap = part.dashes.gap * 1.25 + 0.8 if part.dashes else SELECTION.max_solid_gap
        if k:
            # between two patterns: the dashed one's gap, if there is one
            previous = parts[k - 1]
            between = max(gap, previous.dashes.gap * 1.25 + 0.8 if previous.dashes else SELECTION.max_solid_gap)
            measured = part.first - previous.last <= between
            pieces.append(_LinePiece(previous.last, part.first, "measured" if measured else "bridged",
                                     previous.pattern if previous.dashes else part.pattern))
        spans = part.intervals
        for j, (first, last) in enumerate(spans):
            if j:
                pieces.append(_LinePiece(spans[j - 1][1], first, "bridged" if first - spans[j - 1][1] > gap else "measured", part.pattern))
            pieces.append(_LinePiece(first, last, "measured", part.pattern))
    return merged_pieces(pieces)


def merged_pieces(parts: list[_LinePiece]) -> list[_LinePiece]:
    """Pieces with equal neighbours put together; empty ones dropped."""
    merged: list[_LinePiece] = []
    for part in parts:
        if part.last - part.first <= 1e-9:
            continue
        if merged and (merged[-1].status, merged[-1].pattern) == (part.status, part.pattern):
            merged[-1] = _LinePiece(merged[-1].first, part.last, part.status, part.pattern)
        else:
            merged.append(part)
    return merged
