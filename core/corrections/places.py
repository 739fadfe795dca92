"""Which stretches of lines a correction is about, and lines cut there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ..common.arrays import mask_runs
from .corrections import Correction

STEP = 0.25            # m between the places at which a line is compared with a correction
SHORTEST = 1.0         # m of a line along a correction that counts: a line that only crosses it does not
SHORTEST_REST = 0.5    # m: a shorter rest of a line goes with the stretch that is cut from it
NO_LENGTH = 1e-3      # m
ALONG = 0.5            # share of its length by which a stretch advances along the correction: one that crosses it does not
MOVED_FROM = 2.0       # m beside its new place at most that a line is moved from; half of a lane is more than that
NEAR_VERTICES = 10.0    # m within which the map's own vertices tell the height of what was drawn
HEIGHT_NEIGHBOURS = 8  # vertices whose heights are averaged, by the inverse of their distance

Span = tuple[int, float, float]   # (number of the line, from, to), metres along it


def distance_of(correction: Correction, reach: float) -> float:
    """m beside a correction within which it is about a line."""
    return max(MOVED_FROM, reach) if correction.action == "move" else reach


def spans_along(lines: Sequence[np.ndarray], correction: Correction, reach: float) -> list[Span]:
    """The stretches of lines that a correction is about.

    Of lines beside each other it is the nearest. A point is about the whole of the nearest line.

    Parameters
    ----------
    lines : (V, 2 or more) each, local x, y, ...
    correction : Correction
    reach : m beside it

    Returns
    -------
    list of Span
    """
    places = correction.places[:, :2]
    low, high = places.min(0) - reach, places.max(0) + reach
    near = [k for k, line in enumerate(lines) if len(line) > 1 and (line[:, :2].max(0) >= low).all() and (line[:, :2].min(0) <= high).all()]
    if len(places) == 1:
        found = [(float(shapely.distance(shapely.linestrings(lines[k][:, :2]), shapely.points(places[0]))), k) for k in near]
        best = min(found, default=(np.inf, -1))
        return [(best[1], 0.0, _arcs(lines[best[1]])[-1])] if best[0] <= reach else []
    stretches = sorted(stretch for k in near for stretch in _beside(lines[k][:, :2], k, places, reach))
    taken: list[tuple[float, float]] = []
    spans = []
    for _, k, a, b, first, last in stretches:
        if sum(max(min(last, v) - max(first, u), 0.0) for u, v in taken) < (last - first) / 2:
            taken.append((first, last))
            spans.append((k, a, b))
    return spans


def _beside(line, number, places, reach):
    """(mean distance, number, from, to, first, last along the correction) of each stretch of a line beside a correction."""
    arcs = _arcs(line)
    at = np.unique(np.r_[np.arange(0.0, arcs[-1], STEP), arcs[-1]])
    xy = np.c_[np.interp(at, arcs, line[:, 0]), np.interp(at, arcs, line[:, 1])]
    course = shapely.linestrings(places)
    u = shapely.line_locate_point(course, shapely.points(xy))
    away = shapely.distance(course, shapely.points(xy))
    head, tail = _excess(xy, places[0], places[1]), _excess(xy, places[-1], places[-2])
    inside = (away <= reach) & ~((u <= 0) & (head > STEP)) & ~((u >= course.length) & (tail > STEP))
    least = min(SHORTEST, course.length / 2)
    for i, j in mask_runs(inside):
        a, b = at[i], at[j - 1]
        first, last = u[i:j].min(), u[i:j].max()
        if b - a < least and b - a < arcs[-1] / 2 or last - first < ALONG * (b - a) or b <= a:
            continue
        a, b = 0.0 if a < SHORTEST_REST else a, arcs[-1] if arcs[-1] - b < SHORTEST_REST else b
        yield float(away[i:j].mean()), number, float(a), float(b), float(first), float(last)


def _excess(xy, end, inner):
    """(N,) m by which places lie beyond the end of a line, along its last part."""
    way = end - inner
    return (xy - end) @ way / max(np.hypot(*way), 1e-9)


def _arcs(line):
    return np.append(0.0, np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T)))


def cut(columns: np.ndarray, start: float, end: float) -> np.ndarray:
    """(K, C) the rows of (V, C) columns, of which the first two are x and y, from one place along them to another.

    Columns are interpolated at both ends, given in metres along the line.
    """
    arcs = _arcs(columns)
    inside = (arcs > start + 1e-6) & (arcs < end - 1e-6)
    at = np.r_[start, arcs[inside], end]
    ends = np.array([[np.interp(place, arcs, column) for column in columns.T] for place in (at[0], at[-1])])
    return np.concatenate([ends[:1], columns[inside], ends[1:]])


def pieces_of(length: float, spans: Sequence[tuple[float, float]]) -> list[tuple[float, float, bool]]:
    """(from, to, whether it is a span) of a line that is cut where spans begin and end, in order."""
    found, at = [], 0.0
    for a, b in sorted(spans):
        a, b = max(a, at), max(b, at)
        found += [(at, a, False), (a, b, True)]
        at = b
    # sums of lengths differ in their last digits
    return [(a, b, along) for a, b, along in [*found, (at, length, False)] if b - a > NO_LENGTH]


def heights_for(places: np.ndarray, known: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """(N,) z of (N, 3) places: their own where they have one, else that of the map's vertices near them.

    Parameters
    ----------
    places : (N, 3) local metres, z NaN where there is none
    known : (K, 3) vertices of the map
    otherwise : (N,) z where there is no vertex near
    """
    z, known = places[:, 2].copy(), known[np.isfinite(known).all(1)]
    lacking = np.flatnonzero(~np.isfinite(z))
    if not len(lacking):
        return z
    z[lacking] = otherwise[lacking]
    if len(known):
        count = min(HEIGHT_NEIGHBOURS, len(known))
        away, row = cKDTree(known[:, :2]).query(places[lacking, :2], count, distance_upper_bound=NEAR_VERTICES)
        away, row = away.reshape(len(lacking), count), row.reshape(len(lacking), count)
        weight = np.where(np.isfinite(away), 1.0 / np.maximum(away, 0.05), 0.0)
        total = weight.sum(1)
        near = total > 0
        heights = np.append(known[:, 2], 0.0)[np.minimum(row, len(known))]
        z[lacking[near]] = (weight * heights).sum(1)[near] / total[near]
    return z
