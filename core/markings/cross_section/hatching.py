"""Hatched areas and parking bays: where nobody drives, and the borders that bound the lanes beside."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from scipy.ndimage import grey_closing

from ...survey.frame.placement import located
from ...survey.frame.row_table import RowTable
from ..objects.classify import LINE_KINDS
from ..road_grid import CELL_SIZE
from .candidates import FAR
from .evidence import BIN, BINS
from .sections import STATION_STEP

if TYPE_CHECKING:
    from ...survey.frame.road_frame import RoadFrame
    from ..objects.marking_objects import MarkingObjects

BAR_REACH = 1.6        # m: bars of one hatched area are at most twice as far apart
OUTLINE_SPACING = 0.25 # m between places of an outline
HALF_BORDER = 0.06     # m from the outside of its border line to the middle: half of a narrow line
OUTSIDE_PAINT = CELL_SIZE / 2   # m: outlines are of whole cells, of which paint reaches into the outermost ones by half on average
SHORTEST_AREA = 5.0    # m
BORDER_LINE_REACH = 0.5  # m between the ends of bars and the middle of the border line that they lead to: gap, and half of a broad line
MAX_TIP = 20.0         # m from the last bar to where the borders meet
MAX_TIP_GAP = 2.0      # m of border that is not seen
TIP_COURSE = 4.0       # m of border that give its course


def hatched_places(markings: MarkingObjects, frame: RoadFrame, road: int, s: np.ndarray) -> np.ndarray | None:
    """(K, BINS) bool, where bars of hatched areas are painted; None where there are none."""
    rows = np.flatnonzero((markings.road == road) & (markings.kind == "hatch") & np.isfinite(markings.extent[:, 0]))
    if not len(rows):
        return None
    shape = shapely.union_all(shapely.force_2d(markings.outlines.polygons()[rows]))
    shapely.prepare(shape)
    first, last, low, high = (markings.extent[rows, k] for k in range(4))
    near = np.zeros(len(s), bool)
    for a, b in zip(np.searchsorted(s, first), np.searchsorted(s, last, side="right")):
        near[a:b] = True
    offsets = (np.arange(BINS) + 0.5) * BIN - FAR
    across = np.flatnonzero((offsets >= low.min() - BIN) & (offsets <= high.max() + BIN))
    found, along = np.zeros((len(s), BINS), bool), np.flatnonzero(near)
    if len(along) and len(across):
        at_s, at_d = np.repeat(s[along], len(across)), np.tile(offsets[across], len(along))
        inside = shapely.contains_xy(shape, *frame.road(road).to_map(at_s, at_d))
        found[np.ix_(along, across)] = inside.reshape(len(along), len(across))
    return found


def borders_of_hatching(markings: MarkingObjects, frame: RoadFrame, road: int, s: np.ndarray) -> RowTable:
    """The outer borders of hatched areas: nobody drives between them, and they bound the lanes beside.

    A border is the middle of the line that is painted along the ends of the bars; where there is none, the ends themselves. Where the area narrows
    to a tip, too narrow for bars, the borders go on along their lines to where these meet.

    Parameters
    ----------
    markings : MarkingObjects
    frame : RoadFrame
    road : number of the road
    s : (K,) metres, stations

    Returns
    -------
    RowTable (2 G, K) of metres, the left and the right border of each of G areas and of tips of them, NaN where it is not
    """
    here = markings.road == road
    bars, lines = ([shape for shape in shapely.force_2d(markings.outlines.polygons()[here & kind]) if not shape.is_empty]
                   for kind in (markings.kind == "hatch", np.isin(markings.kind.astype(str), LINE_KINDS)))
    areas = shapely.get_parts(shapely.union_all(shapely.buffer(bars, BAR_REACH))) if bars else np.empty(0, object)
    bars_of, lines_of = _meeting(areas, bars), _meeting(shapely.buffer(areas, MAX_TIP), lines)
    found = []
    for k in range(len(areas)):
        first, reach = _reach([bars[j] for j in bars_of[k]], frame, road, s)
        known = np.flatnonzero(np.isfinite(reach[0]))
        if not len(known) or np.ptp(known) * STATION_STEP < SHORTEST_AREA:
            continue
        borders = np.empty(reach.shape)
        for side, sign in enumerate((1.0, -1.0)):
            # bars touch the border only at their ends
            outer = grey_closing(np.where(np.isfinite(reach[side]), sign * reach[side], -FAR),
                                 size=int(2 * BAR_REACH / STATION_STEP) + 1, mode="nearest")
            borders[side] = sign * (outer - OUTSIDE_PAINT - HALF_BORDER)
        beside = [(begin, along.mean(axis=0)) for begin, along in (_reach([lines[j]], frame, road, s) for j in lines_of[k])]
        for begin, middle in beside:
            low, high = max(begin, first), min(begin + len(middle), first + reach.shape[1])
            if low < high:
                _follow(borders[:, low - first:high - first], middle[low - begin:high - begin])
        before, behind = _tip(borders[:, ::-1], first, -1, beside), _tip(borders, first + reach.shape[1] - 1, 1, beside)
        for begin, rows in ((first - before.shape[1], before[:, ::-1]), (first, borders), (first + reach.shape[1], behind)):
            if rows.size:
                found += [(begin, border) for border in rows]
    return RowTable.of_rows(found, len(s))


def _tip(borders, last, step, lines):
    """Where both borders go on along lines behind the last bar and come nearer to each other: (2, N) m.

    `borders` : (2, M) m, those beside the bars, up to the station of the number `last`; `step` : 1 or -1, the way that stations are counted on;
    `lines` : (number of the first station, (L,) m of its middle) of the lines about the area
    """
    course, count = int(TIP_COURSE / STATION_STEP), int(MAX_TIP / STATION_STEP)
    table = np.full((len(lines), course + count), np.nan)
    for row, (begin, middle) in zip(table, lines):
        at = (begin + np.arange(len(middle)) - last) * step + course - 1
        inside = (at >= 0) & (at < len(row))
        row[at[inside]] = middle[inside]
    found = np.full((2, course + count), np.nan)
    found[:, max(course - borders.shape[1], 0):course] = borders[:, -course:]
    for border in found:
        known = course
        for k in range(course, course + count):
            before = np.arange(known - course, known)
            before = before[np.isfinite(border[before])]
            if k - known > MAX_TIP_GAP / STATION_STEP or len(before) < 2:
                break
            slope, level = np.polyfit(before - k, border[before], 1)
            off = np.abs(table[:, k] - level)
            if np.isfinite(off).any() and np.nanmin(off) <= BORDER_LINE_REACH:
                border[k] = table[np.nanargmin(off), k]
                border[known:k] = np.interp(np.arange(known, k), [known - 1, k], border[[known - 1, k]])
                known = k + 1
    width = found[0] - found[1]
    narrowing = (width[course:] > 0) & (np.diff(width[course - 1:]) <= 0)
    end = course + (len(narrowing) if narrowing.all() else int(np.argmin(narrowing)))
    return found[:, course:end]


def _meeting(areas, shapes):
    """For each area the numbers of the shapes that meet it, ascending."""
    found: list[list[int]] = [[] for _ in areas]
    if len(areas) and shapes:
        for shape, area in sorted(zip(*shapely.STRtree(areas).query(shapes, predicate="intersects").tolist())):
            found[area].append(shape)
    return found


def places_of_bays(rows: list[np.ndarray], s: np.ndarray, driven: np.ndarray) -> tuple[np.ndarray, RowTable]:
    """Where parking bays lie, and their ends towards the lanes.

    Parameters
    ----------
    rows : as `rows_of_bays` gives them
    s : (K,) metres, stations
    driven : (P, K) metres, offset of every pass, NaN where it did not drive

    Returns
    -------
    places : (K, BINS) bool, cells of station and offset that lie in bays
    ends : RowTable (G, K) of metres, offset at which the lines of each row end towards the vehicle, NaN beyond the row
    """
    places, ends = np.zeros((len(s), BINS), bool), []
    offsets = (np.arange(BINS) + 0.5) * BIN - FAR
    for row in rows:
        within = slice(*np.searchsorted(s, [row[0, 0], row[-1, 0]]))
        low, high = (np.interp(s[within], row[:, 0], row[:, k]) for k in (1, 2))
        places[within] |= (offsets > low[:, None]) & (offsets < high[:, None])
        track = driven[:, within][np.isfinite(driven[:, within])]
        ends.append((within.start, high if np.median(row[:, 1:].sum(axis=1)) < 2 * (track.mean() if len(track) else 0.0) else low))
    return places, RowTable.of_rows(ends, len(s))


def _reach(shapes, frame, road, s):
    """Greatest and least offset of outlines, (2, N) m, from a first station on that is given; NaN at stations where there are none."""
    x, y = shapely.get_coordinates(shapely.segmentize(shapes, OUTLINE_SPACING)).T
    station, d = located(frame, np.full(len(x), road), x, y)
    at = np.rint((station - s[0]) / STATION_STEP)
    inside = np.isfinite(at) & (at >= 0) & (at < len(s))
    if not inside.any():
        return 0, np.empty((2, 0))
    at, d = at[inside].astype(int), d[inside]
    first = int(at.min())
    found = np.repeat([[-np.inf], [np.inf]], int(at.max()) - first + 1, axis=1)
    np.maximum.at(found[0], at - first, d)
    np.minimum.at(found[1], at - first, d)
    return first, np.where(np.isfinite(found), found, np.nan)


def _follow(borders, middle):
    """Put borders on the middle of a line that runs along them, (N,) m at the same stations."""
    with np.errstate(invalid="ignore"):
        along = np.abs(borders - middle) < BORDER_LINE_REACH
    for border, near in zip(borders, along):
        border[near] = middle[near]
