"""What kind of marking a cluster is, by its size, its direction and its neighbours, or that it is none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import repeat

import numpy as np

from ...common.arrays import overlapping_pairs
from ...common.errors import RoadExtractionError
from ...curves.robust import percentiles
from ...survey.store.records import COORDINATE_SCALE
from ..weights import CLASSES, GROUPS
from .repeating import rows_of_dashes
from .shape import Shape

NOT_PAINT = ""
LINE_KINDS = ("edge", "lane", "centre")


@dataclass(frozen=True)
class ClassSettings:
    """When a cluster is a line to be kept for the marking lines; lengths in metres."""

    min_width: float = 0.06
    max_width: float = 0.35
    min_length: float = 1.0
    min_elongation: float = 4.0
    margin: float = 0.5   # m beyond the road's half width that a marking may still lie

    def __post_init__(self) -> None:
        if not 0 < self.min_width < self.max_width:
            raise RoadExtractionError(
                f"A marking line is {self.min_width} to {self.max_width} m wide; the first must be above 0 m and below the second.")


def too_pale(share: float, kind: str) -> bool:
    """Whether a cluster of such a contrast is no paint, by the class that its shape has."""
    return share < {"stop": CLASSES.min_contrast_of_bars, "edge": CLASSES.min_contrast_of_edge_lines}.get(kind, CLASSES.min_contrast)


def relative_contrast(value: np.ndarray, s: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(K,) how bright clusters are among the bright points of their road: 0 for what only just is brighter than asphalt, 1 for bright paint.

    `value` : (N,) brightness of points, cluster after cluster; `s` : (N,) stations, 0.1 mm; `starts` : (K + 1,) where clusters begin, and the end.
    """
    value, stretch = value[:starts[-1]], np.floor_divide(s[:starts[-1]], int(CLASSES.contrast_stretch / COORDINATE_SCALE))
    if not len(value):
        return np.empty(0)
    order = np.argsort(stretch, kind="stable")
    first, last = int(stretch.min()), int(stretch.max())
    bounds = np.searchsorted(stretch[order], np.arange(first - 1, last + 3))
    ends = np.array([percentiles(value[order[a:b]], [CLASSES.faint_percentile, CLASSES.bright_percentile]) if b > a else (0.0, 1.0)
                     for a, b in zip(bounds[:-3], bounds[3:])])
    del order
    contrasts = []
    for a, b in zip(starts[:-1].tolist(), starts[1:].tolist()):
        low, high = ends[stretch[a:b] - first].T
        contrasts += percentiles((value[a:b] - low) / np.maximum(high - low, 1e-6), [CLASSES.contrast_percentile])
    return np.array(contrasts)


def classify_markings(shapes: list[Shape], half_widths: Sequence[float], settings: ClassSettings = ClassSettings(),
                      covered: float | Sequence[float] = 0.0, blocks: bool | np.ndarray = False) -> list[str]:
    """Class of every cluster of one road, "" for what is not paint. `stripes_of_crossing` took zebra crossings before.

    half_widths : (N,) m from the reference line to the road edge on each cluster's side
    covered : (N,) share of each cluster's points that lie beneath or right beside something standing on the road
    blocks : (N,) bool of `give_way_blocks`, which looks at all roads at once
    """
    if not shapes:
        return []
    column = columns_of(shapes)
    clearance = np.asarray(half_widths) - np.abs(column["offset"])
    curb = np.array([_curb(shape, r) for shape, r in zip(shapes, clearance)])
    zigzag = np.array([shape.legs > 0 for shape in shapes])
    # of a line far off each scan line may show one point only, and no width
    broad = (column["width"] >= settings.min_width) | (column["length"] >= CLASSES.min_solid_length)
    line = column["along"] & broad & (column["width"] <= settings.max_width) & (column["length"] >= settings.min_length) \
        & (column["elongation"] >= settings.min_elongation) & ~curb & ~zigzag
    line |= _dashes_in_rows(shapes, column, clearance, settings)
    line &= ~zigzag
    outside = _beyond_the_edge_line(column, line, clearance)
    doubles = _has_partner(column, line)
    covered_feet = (np.broadcast_to(covered, len(shapes)) > CLASSES.min_covered_share) & ~(line & (column["length"] > CLASSES.max_car_length))
    refused = outside | covered_feet | curb
    kinds = [_kind(*of_one) for of_one in zip(shapes, clearance, line, zigzag, np.broadcast_to(blocks, len(shapes)), doubles, covered_feet, refused,
                                              repeat(settings.margin))]
    for k in _outlines(column, kinds):
        kinds[k] = "hatch"
    for k in _single_bars(column, kinds):
        corner = clearance[k] < CLASSES.curb_corner_clearance and shapes[k].length < CLASSES.max_curb_corner_length
        kinds[k] = NOT_PAINT if corner else "symbol"
    return kinds


def _kind(shape, clearance, line, zigzag, block, double, covered_feet, refused, margin):
    """The class of a cluster by itself; `refused` is what lies where no paint is, `margin` the m that paint may lie beyond the road's edge."""
    if zigzag and clearance >= -margin and not covered_feet:
        return "zigzag"
    if clearance < -margin or refused or _gutter(shape, clearance, line):
        return NOT_PAINT
    if _speck(shape) and not (line and shape.length >= CLASSES.min_row_of_points) or _round_cover(shape) and not block:
        return NOT_PAINT
    if block:
        return "give_way"
    if not line:
        return _other_kind(shape)
    if clearance < CLASSES.lane_clearance and not double:
        return "edge"
    return "centre" if double or shape.length > CLASSES.min_solid_length else "lane"


def columns_of(shapes: Sequence[Shape]) -> dict[str, np.ndarray]:
    """dict of (N,) arrays, what the Shapes have."""
    return {name: np.array([getattr(shape, name) for shape in shapes])
            for name in ("s0", "s1", "d0", "d1", "offset", "length", "width", "elongation", "direction", "area", "along")}


def _dashes_in_rows(shapes, column, clearance, settings):
    """Short dashes one after the other along the road, away from its rim, where the stones of a curb stand in rows, too."""
    shortest, longest = CLASSES.short_dash_length
    short = column["along"] & (column["length"] >= shortest) & (column["length"] <= longest) & (clearance > CLASSES.rim_clearance) \
        & (column["width"] >= settings.min_width) & (column["width"] <= settings.max_width) & (column["elongation"] >= CLASSES.min_dash_elongation)
    result, rows = np.zeros(len(shapes), bool), np.flatnonzero(short)
    for row in rows_of_dashes([shapes[k] for k in rows]):
        result[rows[row]] = True
    return result


def _has_partner(column, line):
    """Lines with another line beside them, a decimetre or two away over most of their length."""
    rows = np.flatnonzero(line)
    result = np.zeros(len(line), bool)
    s0, s1, d = column["s0"][rows], column["s1"][rows], column["offset"][rows]
    a, b = overlapping_pairs(s0, s1, s0, s1)
    overlap = np.minimum(s1[a], s1[b]) - np.maximum(s0[a], s0[b])
    result[rows[a[(a != b) & (np.abs(d[a] - d[b]) <= CLASSES.max_double_line_spacing) & (overlap > 0.5 * (s1 - s0)[a])]]] = True
    return result


def _beyond_the_edge_line(column, line, clearance):
    """Short strips between a line and the rim of the road: verge, gutter or curb, where nothing is painted."""
    short = column["along"] & (column["s1"] - column["s0"] > column["d1"] - column["d0"])
    rows, lines = np.flatnonzero(short & (clearance < CLASSES.rim_clearance)), np.flatnonzero(line)
    result = np.zeros(len(short), bool)
    s0, s1, d, length = (column[name] for name in ("s0", "s1", "offset", "length"))
    # a double line is as long on either side
    on_edge = clearance < column["width"] / 2 + CLASSES.edge_contact
    longest = np.where(on_edge, 1.0, CLASSES.edge_line_length_ratio) * length
    reach = np.where(clearance < GROUPS.road_edge_clearance, CLASSES.strip_reach_at_road_edge, CLASSES.strip_reach_beyond_edge_line)
    a, b = overlapping_pairs(s0[rows], s1[rows], s0[lines], s1[lines])
    a, b = rows[a], lines[b]
    outward = np.sign(d[a]) * (d[a] - d[b])
    overlap = np.minimum(s1[a], s1[b]) - np.maximum(s0[a], s0[b])
    result[a[(outward > 0.1) & (outward < reach[a]) & (overlap > 0) & (length[b] > longest[a])]] = True
    return result


def _outlines(column, kinds):
    """What looked like a sign, and is the outline of hatching: a bar runs into it."""
    kinds = np.array(kinds, dtype=object)
    bars, rows = np.flatnonzero(kinds == "hatch"), np.flatnonzero(kinds == "symbol")
    touched = np.zeros(len(kinds), bool)
    a, b = overlapping_pairs(column["s0"][rows], column["s1"][rows], column["s0"][bars], column["s1"][bars], CLASSES.max_bar_to_outline)
    a, b = rows[a], bars[b]
    touch = np.ones(len(a), bool)
    for low, high in (("s0", "s1"), ("d0", "d1")):
        touch &= (column[low][a] < column[high][b] + CLASSES.max_bar_to_outline) & (column[high][a] > column[low][b] - CLASSES.max_bar_to_outline)
    touched[a[touch]] = True
    return np.flatnonzero(touched)


def _single_bars(column, kinds):
    """What looked like a bar of hatching and has no other bar near it."""
    rows = np.flatnonzero(np.array([kind == "hatch" for kind in kinds], bool))
    first, last = column["s0"][rows], column["s1"][rows]
    single = last - first < CLASSES.min_hatching_length
    a, b = overlapping_pairs(first, last, first, last, CLASSES.max_hatching_pitch)
    gap = np.zeros(len(a))
    for low, high in (("s0", "s1"), ("d0", "d1")):
        low, high = column[low][rows], column[high][rows]
        gap = np.maximum(gap, np.maximum(low[a], low[b]) - np.minimum(high[a], high[b]))
    single[a[(a != b) & (gap < CLASSES.max_hatching_pitch)]] = False
    return rows[single]


def _speck(shape):
    return shape.area < CLASSES.max_speck_area or max(shape.length, shape.width) < CLASSES.max_speck_size


def _round_cover(shape):
    along, across = shape.s1 - shape.s0, shape.d1 - shape.d0
    longer, shorter = max(along, across), min(along, across)
    # an oblique dash fills a square, too
    return CLASSES.cover_diameter[0] <= longer <= CLASSES.cover_diameter[1] and shorter > 0.7 * longer \
        and shape.closed_area > CLASSES.min_cover_fill * along * across and shape.elongation < CLASSES.max_cover_elongation


def filled(shapes: Sequence[Shape]) -> np.ndarray:
    """(N,) bool, whether most of the smallest rectangle about each is painted."""
    return np.array([shape.closed_area > CLASSES.min_cover_fill * shape.sides[0] * shape.sides[1] for shape in shapes], bool)


def _curb(shape, clearance):
    """A hair of brightness along the very edge of the road."""
    on_edge = clearance < shape.width / 2 + CLASSES.edge_contact / 2
    # seen on two tracks of the scan it looks as broad as they lie apart
    narrowest = (CLASSES.min_strip_width_on_edge if on_edge else CLASSES.min_strip_width_at_rim) + shape.spacing
    return shape.along and clearance < GROUPS.road_edge_clearance and shape.width < narrowest


def _gutter(shape, clearance, line):
    """A broad bright strip that reaches the road edge: concrete, not paint."""
    return shape.along and not line and shape.length > 2.0 and shape.elongation > 3 and clearance < shape.width


def _other_kind(shape):
    turn = abs(shape.direction)
    if shape.across and CLASSES.stop_line_width[0] <= shape.width <= CLASSES.stop_line_width[1] and shape.length >= CLASSES.min_stop_line_length \
            and shape.closed_area >= CLASSES.min_stop_line_fill * shape.length * shape.width:
        return "stop"
    along, across = shape.s1 - shape.s0, shape.d1 - shape.d0
    if 1.5 <= along <= 8.0 and 0.3 <= across <= 1.8 and shape.area < 0.7 * along * across and turn < np.radians(25):
        return "arrow" if max(shape.stems) >= CLASSES.min_arrow_shaft and min(shape.stems) <= CLASSES.max_arrow_tip else "symbol"
    if (np.radians(20) < turn <= np.radians(75) and shape.elongation > 2) or (along > 4 and across > 0.8):
        return "hatch"
    return "symbol"
