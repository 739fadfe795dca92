"""Solid or dashed, and with what dash length and period, from the painted intervals of a line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...countries.neutral import NEUTRAL

if TYPE_CHECKING:
    from .strands import LinkedLine

MAX_WORN_HOLE = 0.8            # m: a shorter hole is wear within a dash
MIN_GAP_PER_DASH = 0.4         # of the dash length: road markings leave gaps of half a dash (6 m and 3 m) or more
DASH_PAIR_LENGTH = (1.5, 8.0)  # m: dashes of which two alone are taken for a dashed line
PERIOD_TOLERANCE = 0.16        # of the period: how evenly dashes must follow each other
STEP_TOLERANCE = 0.2           # m by which the two steps between three pieces of unequal lengths may differ
MIN_SHORT_DASHES = 4           # dashes of about a metre with gaps as long must be so many
SHORT_DASH_TOLERANCE = 0.25    # m: of such dashes, deviation of the length from the median
MAX_UNEVEN_SHARE = 0.25        # of such dashes: those that deviate more
MAX_SOLID_GAP = 2.5            # m: a longer hole in a solid line is bridged, not measured


@dataclass(frozen=True)
class DashPattern:
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
    dashes: DashPattern | None
    intervals: tuple   # (first, last) of each painted interval

    @property
    def pattern(self) -> str:
        return "dashed" if self.dashes else "solid"


def painted_intervals(line: LinkedLine) -> np.ndarray:
    """(K, 2) stations between which a line is painted, holes of wear closed."""
    spans = [span for strand in line.strands for span in _painted(strand)]
    found = [list(spans[0])]
    for first, last in spans[1:]:
        if first - found[-1][1] < MAX_WORN_HOLE:
            found[-1][1] = max(found[-1][1], last)
        else:
            found.append([first, last])
    return np.array(found)


def _painted(strand):
    """(first, last) of the parts of a strand: a strand leaps the gaps of short dashes. Where they are uneven they are wear."""
    holes = np.flatnonzero(np.diff(strand.s) > MAX_WORN_HOLE)
    if len(holes) + 1 < MIN_SHORT_DASHES:
        return [(strand.first, strand.last)]
    parts = np.column_stack([np.r_[strand.first, strand.s[holes + 1]], np.r_[strand.s[holes], strand.last]])
    length, steps = np.diff(parts, axis=1)[:, 0], np.diff(parts.mean(axis=1))
    if (np.abs(steps - np.median(steps)) > PERIOD_TOLERANCE * np.median(steps)).mean() > MAX_UNEVEN_SHARE \
            or (np.abs(length - np.median(length)) > SHORT_DASH_TOLERANCE).mean() > MAX_UNEVEN_SHARE:
        return [(strand.first, strand.last)]
    return list(map(tuple, parts.tolist()))


def stretches(line: LinkedLine, longest_dash: float = NEUTRAL.longest_dash) -> list[Stretch]:
    """The stretches of a line: dashed where short intervals follow a dash pattern, solid elsewhere.

    longest_dash : metres, longer paint is solid line; of the catalogue of countries
    """
    spans = painted_intervals(line)
    long = np.diff(spans, axis=1)[:, 0] > longest_dash
    cuts = np.flatnonzero(np.r_[True, np.diff(long.astype(int)) != 0, True])
    found: list[tuple[np.ndarray, DashPattern | None]] = []
    for a, b in zip(cuts[:-1], cuts[1:]):
        group = spans[a:b]
        # beside solid stretches a few worn pieces look like dashes by chance
        dashes = None if long[a] or long.any() and len(group) < 3 else find_dash_pattern(group, beside_solid=bool(long.any()))
        if found and found[-1][1] is None and dashes is None:
            found[-1] = (np.vstack([found[-1][0], group]), None)
        else:
            found.append((group, dashes))
    return [Stretch(float(group[0, 0]), float(group[-1, 1]), dashes, tuple(map(tuple, group.tolist())))
            for group, dashes in found]


def find_dash_pattern(spans: np.ndarray, beside_solid: bool = False) -> DashPattern | None:
    """The DashPattern of painted intervals (K, 2), or None where they follow none.

    Dashes may be missing: steps between dashes are then whole multiples of the
    period. Some may be worn at their ends: three of five must have the common length.
    Of three pieces alone all must have it, or their two steps must be equal: by chance
    one step is soon a multiple of the other. In a line that is solid elsewhere (`beside_solid`)
    all must have it: there three pieces are what wear left of it, and equal steps chance.
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
        even = np.ptp(length) <= max(0.4, 0.12 * dash) and DASH_PAIR_LENGTH[0] <= dash <= DASH_PAIR_LENGTH[1] \
            and max(MIN_GAP_PER_DASH * dash, 1.5) <= gap <= 13.0
        return DashPattern(dash, float(steps[0])) if even else None
    period = _period(steps)
    if period is None or period - dash < MIN_GAP_PER_DASH * dash or alike.mean() < 0.55:
        return None
    if len(spans) == 3 and not alike.all():
        # a worn dash keeps one of its ends, or its middle
        steps = np.diff(np.column_stack([spans, spans.mean(axis=1)]), axis=0)
        if beside_solid or np.ptp(steps, axis=0).min() > STEP_TOLERANCE:
            return None
    return DashPattern(dash, period)


def _period(steps):
    """The longest period of which most steps are whole multiples (up to 4), or None."""
    best, best_share = None, 0.0
    for start in np.unique(np.round(steps, 1)):
        if start < 2 * MAX_WORN_HOLE:
            continue
        times = np.maximum(np.round(steps / start), 1.0)
        good = (np.abs(steps / start - times) <= PERIOD_TOLERANCE) & (times <= 4)
        share, single = good.mean(), (times[good] == 1).sum()
        # many steps over missing dashes are believed where nearly all fit
        if single < 0.4 * len(steps) and not (single >= 2 and len(steps) >= 5 and share >= 0.85):
            continue
        if share > best_share + 1e-9:
            best, best_share = float(np.sum(steps[good]) / np.sum(times[good])), share
    return best if best_share >= 0.65 else None


def same_dash_pattern(before: LinkedLine, after: LinkedLine, longest_dash: float = NEUTRAL.longest_dash) -> bool:
    """Whether two lines are dashed alike and the gap between them is a whole multiple of the period."""
    ends, begins = stretches(before, longest_dash)[-1], stretches(after, longest_dash)[0]
    if not ends.dashes or not begins.dashes:
        return False
    period = (ends.dashes.period + begins.dashes.period) / 2
    if abs(ends.dashes.period - begins.dashes.period) > PERIOD_TOLERANCE * period \
            or abs(ends.dashes.dash - begins.dashes.dash) > max(0.6, 0.25 * ends.dashes.dash):
        return False
    step = (np.mean(begins.intervals[0]) - np.mean(ends.intervals[-1])) / period
    return abs(step - round(step)) <= PERIOD_TOLERANCE * 1.5


@dataclass(frozen=True)
class LinePiece:
    """Part of a line of one status and pattern, between two stations."""

    first: float
    last: float
    status: str
    pattern: str


def line_pieces(parts: list[Stretch]) -> list[LinePiece]:
    """Cut a line of some stretches where its status or pattern changes.

    A regular gap between dashes is part of the dashed line; a hole longer than the
    line's own gap, or in a solid line longer than 2.5 m, is bridged.
    """
    found = []
    for k, part in enumerate(parts):
        gap = part.dashes.gap * 1.25 + 0.8 if part.dashes else MAX_SOLID_GAP
        if k:
            # between two patterns: the dashed one's gap, if there is one
            other = parts[k - 1]
            between = max(gap, other.dashes.gap * 1.25 + 0.8 if other.dashes else MAX_SOLID_GAP)
            measured = part.first - other.last <= between
            found.append(LinePiece(other.last, part.first, "measured" if measured else "bridged",
                               other.pattern if other.dashes else part.pattern))
        spans = part.intervals
        for j, (first, last) in enumerate(spans):
            if j and first - spans[j - 1][1] > gap:
                found.append(LinePiece(spans[j - 1][1], first, "bridged", part.pattern))
            elif j:
                found.append(LinePiece(spans[j - 1][1], first, "measured", part.pattern))
            found.append(LinePiece(first, last, "measured", part.pattern))
    return merged_pieces(found)


def merged_pieces(parts: list[LinePiece]) -> list[LinePiece]:
    """Pieces with equal neighbours put together; empty ones dropped."""
    found: list[LinePiece] = []
    for part in parts:
        if part.last - part.first <= 1e-9:
            continue
        if found and (found[-1].status, found[-1].pattern) == (part.status, part.pattern):
            found[-1] = LinePiece(found[-1].first, part.last, part.status, part.pattern)
        else:
            found.append(part)
    return found
