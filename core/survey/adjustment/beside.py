"""Carriageways that were driven one by one, as of a motorway: whether their drives agree on the ground between them, place by place.

Such roads share no pass, so nothing lays them on each other. What both drives see is the strip between the two tracks. Its flat places give the
difference in height to millimetres. Across they tell nothing: of a guard rail each drive sees its own side, and rails hide the paint behind them.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np
import shapely

from ...common.parallel import ordered_map
from ...common.progress import Progress
from ..frame.passes import LEVEL_SEPARATION
from .register import CORRECTION_STEP
from .remaining import named_places, stretches_of

FARTHEST_BESIDE = 30.0                    # m between the tracks of two carriageways
LEAST_PARALLEL = np.cos(np.radians(15))  # cosine of the angle between them, at least
SHORTEST_BESIDE = 50.0                    # m beside each other, shorter than which it is a junction
SAME_GROUND, SHARE_ALONG = 12.0, 0.8     # m between tracks over one road, and share of the shorter one that they run along each other
EVEN_RISE = 0.15                          # m by which one may vary in height above the other: navigation drifts by less, ramps climb by more
SHARE_BETWEEN = 0.25, 0.75               # of the way from one track to the other: what both drives see well
HEIGHT_CELL = 0.25                        # m, of the cells that heights are compared in
FLAT_CELL_RANGE = 0.03                    # m between the highest and the lowest point of a flat cell
MIN_FLAT_CELLS = 40                     # flat cells that both drives see, for a difference
MAX_HEIGHT_APART = 0.02                   # m in height that two drives may differ by without a warning


class Beside(NamedTuple):
    """Two roads that run beside each other.

    one, other : their numbers
    stations : (N,) m on the first, middles of windows of CORRECTION_STEP
    places : (N,) m, the same on the second
    apart : (N,) m of offset, left positive, from the first to the second
    up : (N,) m by which the points of the second lie higher, NaN where both hardly see the same
    """

    one: int
    other: int
    stations: np.ndarray
    places: np.ndarray
    apart: np.ndarray
    up: np.ndarray


def compare_carriageways(survey: Any, progress: Progress = Progress()) -> None:
    """Tell how far roads lie apart in height that run beside each other and share no pass.

    Parameters
    ----------
    survey : Survey with times, after its passes were adjusted
    progress : Progress, for the messages
    """
    for pair in roads_beside(survey.frame):
        up = ordered_map(partial(_height_apart, survey, pair), range(len(pair.stations)))
        found = pair._replace(up=np.array(list(up)))
        said, warns = said_of_carriageways(found)
        (progress.warn if warns else progress.info)(said)


def roads_beside(frame: Any) -> list[Beside]:
    """Pairs of roads that run beside each other for SHORTEST_BESIDE and more on one level; `up` is not known yet."""
    found = []
    for one, other, s, place, offset, rise in _parallel(frame):
        known = np.flatnonzero(np.abs(rise) < LEVEL_SEPARATION)
        if len(known) * CORRECTION_STEP >= SHORTEST_BESIDE:
            way = np.sign(np.cos(frame.road(one).heading(s[known]) - frame.road(other).heading(place[known])))
            found.append(Beside(one, other, s[known], place[known], -way * offset[known], np.full(len(known), np.nan)))
    return found


def said_of_levels(frame: Any) -> list[str]:
    """Warnings about roads that were driven along each other at another height, always by the same: one road, with heights of two kinds.

    A bridge or a second deck climbs to its height somewhere, and roads on a slope lie farther apart.
    """
    said = []
    for one, other, s, _, offset, rise in _parallel(frame):
        known = np.flatnonzero((np.abs(offset) < SAME_GROUND) & (np.abs(rise) >= LEVEL_SEPARATION))
        length = min(np.ptp([p.span for p in frame.passes_of(road)]) for road in (one, other))
        if len(known) * CORRECTION_STEP < max(SHORTEST_BESIDE, SHARE_ALONG * length):
            continue
        middle = float(np.median(rise[known]))
        if np.quantile(np.abs(rise[known] - middle), SHARE_ALONG) < EVEN_RISE:
            first, last = s[known].min() - CORRECTION_STEP / 2, s[known].max() + CORRECTION_STEP / 2
            said.append(
                f"Roads {one} and {other} run along each other at stations {first:.0f} to {last:.0f} m of road {one}, and one lies "
                f"{abs(middle):.2f} m above the other all along, as no bridge does. They seem to be one road with heights of two kinds (above the "
                "ellipsoid and above sea level), and the map shows it twice. Bring the drives to one kind of heights, or process the files of each "
                "drive by itself.")
    return said


def _parallel(frame):
    """Yield (road, other road, stations, places, offsets and m that the first lies higher) where roads run beside or above each other."""
    tracks = [shapely.linestrings(np.c_[p.x, p.y]) for p in frame.passes]
    near = shapely.STRtree(tracks).query(tracks, predicate="dwithin", distance=FARTHEST_BESIDE).T
    roads = np.array([p.road for p in frame.passes])
    for one, other in sorted({(int(a), int(b)) for a, b in roads[near] if a < b}):
        spans = np.array([p.span for p in frame.passes_of(one)])
        s = np.arange(np.floor(spans.min() / CORRECTION_STEP), np.ceil(spans.max() / CORRECTION_STEP)) * CORRECTION_STEP + CORRECTION_STEP / 2
        x, y = frame.road(one).to_map(s, np.zeros(len(s)))
        place, offset = frame.road(other).locate(x, y, corridor=FARTHEST_BESIDE)
        known = np.flatnonzero(np.isfinite(offset))
        known = known[np.abs(np.cos(frame.road(one).heading(s[known]) - frame.road(other).heading(place[known]))) > LEAST_PARALLEL]
        rise = frame.track_height(one, s[known]) - frame.track_height(other, place[known])
        yield one, other, s[known], place[known], offset[known], rise


def _height_apart(survey, pair, k):
    """m by which the second road's points lie higher in one window; NaN where too little is seen of both."""
    road, half = survey.frame.road(pair.one), CORRECTION_STEP / 2
    sides, cells = np.sort(pair.apart[k] * np.array(SHARE_BETWEEN)), []
    for number, station in ((pair.one, pair.stations[k]), (pair.other, pair.places[k])):
        points = survey.window(number, station - 1.5 * half, station + 1.5 * half)
        between = np.flatnonzero(np.abs(np.abs(points.d) - 0.5 * abs(pair.apart[k])) < np.ptp(sides) / 2 + 1.0)
        s, d = road.locate(points.x[between], points.y[between], corridor=FARTHEST_BESIDE)
        own = (np.abs(s - pair.stations[k]) < half) & (d > sides[0]) & (d < sides[1])
        cells.append(_flat_cells(s[own] - pair.stations[k] + half, d[own] - sides[0], points.z[between[own]]))
    (one, low), (other, high) = cells
    _, a, b = np.intersect1d(one, other, return_indices=True)
    return float(np.median(high[b] - low[a])) if len(a) >= MIN_FLAT_CELLS else np.nan


def _flat_cells(along, across, z):
    """Numbers of the flat cells that points lie in, rising, and their mean heights, m."""
    if not len(z):
        return np.empty(0, int), np.empty(0)
    cell = (along / HEIGHT_CELL).astype(int) * 1000 + (across / HEIGHT_CELL).astype(int)
    order = np.argsort(cell, kind="stable")
    numbers, first = np.unique(cell[order], return_index=True)
    z = z[order]
    flat = np.maximum.reduceat(z, first) - np.minimum.reduceat(z, first) < FLAT_CELL_RANGE
    return numbers[flat], (np.add.reduceat(z, first) / np.diff(np.append(first, len(z))))[flat]


def said_of_carriageways(pair: Beside) -> tuple[str, bool]:
    """What is said of two roads beside each other, and whether it is a warning."""
    known = np.isfinite(pair.up)
    far = known & (np.abs(pair.up) > MAX_HEIGHT_APART)
    where = (f"Road {pair.other} runs beside road {pair.one} at its stations {pair.stations.min() - CORRECTION_STEP / 2:.0f} to "
             f"{pair.stations.max() + CORRECTION_STEP / 2:.0f} m, and no drive measured both")
    if far.any():
        return (f"{where}. Their drives differ in height at "
                f"{named_places(stretches_of(dict(zip(pair.stations[far].tolist(), np.abs(pair.up[far]).tolist()))), 'by up to {:.1f} cm')}. "
                "They stay as they were measured, and nothing that both see shows how far they lie apart across: adjust the trajectories of the "
                "drives to each other, or measure control points on both, if these centimetres matter.", True)
    if not known.any():
        return f"{where}: nothing that both see shows how far they lie apart.", False
    return (f"{where}: in height they agree within {100 * np.abs(pair.up[known]).max():.1f} cm; how far they lie apart across is not known.", False)
