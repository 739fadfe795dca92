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
from .grouping import ROAD_EDGE_CLEARANCE
from .repeating import rows_of_dashes
from .shape import Shape

NOT_PAINT = ""
LINE_KINDS = ("edge", "lane", "centre")

# Contrast: sealed seams, joints of bridges and gutters of islands are far paler than the paint beside them
CONTRAST_STRETCH = 100.0                     # m of road, with as much before and after it, whose paint is compared
FAINT_PERCENTILE, BRIGHT_PERCENTILE = 2, 90  # % of the bright points there: the faintest of them, and paint
CONTRAST_PERCENTILE = 75                     # % of a marking's points, whose brightness stands for it
MIN_CONTRAST = 0.20                          # of the way from the faintest to paint: what has less is no paint
MIN_CONTRAST_OF_BARS = 0.30                  # the same of a bar across the road, which is often a joint
MIN_CONTRAST_OF_EDGE_LINES = 0.10            # the same of a line where edge lines lie, which wear most and where seams are rare

# Lines
LANE_CLEARANCE = 2.0             # m: with less between a line and the road edge there is no lane: it is an edge line
MAX_DOUBLE_LINE_SPACING = 0.45   # m between the middles of a double line
MIN_SOLID_LENGTH = 10.0          # m: longer than any dash in town; solid lines inside the road are centre lines
SHORT_DASH_LENGTH = (0.75, 1.5)  # m: dashes of cycle lanes and bus bays, which only their row distinguishes from signs and specks
MIN_DASH_ELONGATION = 3.0        # length by width of such dashes
MIN_ROW_OF_POINTS = 2.0          # m: points in a row of this length are no speck, however few scan lines met it

# Stop lines, hatching, arrows
STOP_LINE_WIDTH = (0.18, 0.90)               # m
MIN_STOP_LINE_LENGTH = 1.5                   # m
MIN_STOP_LINE_FILL = 0.62                    # of length times width: a stop line is a full bar, the outline of hatching with its bars is not
MAX_BAR_TO_OUTLINE = 0.3                     # m from a bar of hatching to its outline
MAX_HATCHING_PITCH = 3.0                     # m between bars of one hatching
MIN_BARS_BEFORE_TIP = 2                      # that make a row which leads to its tip
MIN_HATCHING_LENGTH = 4.0                    # m along the road: what is longer is more than one bar
MIN_ARROW_SHAFT, MAX_ARROW_TIP = 0.20, 0.25  # of an arrow's length: its shaft at least, and at the other end the tip of its head at most

# What is no paint
COVER_DIAMETER = (0.30, 1.15)   # m, manhole covers
MAX_COVER_ELONGATION = 1.7
MIN_COVER_FILL = 0.5            # of the square about it
MAX_SPECK_SIZE = 0.30                # m
MAX_SPECK_AREA = 0.03                # m2
MIN_COVERED_SHARE = 0.8              # of a marking's points beneath or beside something that stands on the road,
MAX_CAR_LENGTH = 6.0                 # m: and no longer than this, it is the foot of a parked car
CURB_CORNER_CLEARANCE = 0.30         # m from the road edge: a single bar so near,
MAX_CURB_CORNER_LENGTH = 2.0         # m: and so short, is the curb or gutter of a corner
RIM_CLEARANCE = 0.60                 # m from the road edge where verge, gutter and curb may look like paint
STRIP_REACH_BEYOND_EDGE_LINE = 0.80  # m outside an edge line where strips are taken for verge
STRIP_REACH_AT_ROAD_EDGE = 3.0       # m: as far outside an edge line as this, since no lane fits there
MIN_STRIP_WIDTH_AT_RIM = 0.10        # m: at the road edge a narrower strip is the top or the face of a curb
MIN_STRIP_WIDTH_ON_EDGE = 0.14       # m: likewise where it reaches the edge itself
EDGE_CONTACT = 0.02                  # m between a strip and the road edge: paint keeps more
EDGE_LINE_LENGTH_RATIO = 2.0         # an edge line is so many times as long as the strips outside it


@dataclass(frozen=True)
class ClassSettings:
    """When a cluster is a line to be kept for the marking lines.

    min_width, max_width, min_length : m; min_elongation : length over width
    margin : m beyond the road's half width that a marking may still lie
    """

    min_width: float = 0.06
    max_width: float = 0.35
    min_length: float = 1.0
    min_elongation: float = 4.0
    margin: float = 0.5

    def __post_init__(self) -> None:
        if not 0 < self.min_width < self.max_width:
            raise RoadExtractionError(
                f"A marking line is {self.min_width} to {self.max_width} m wide; the first must be above 0 m and below the second.")


def too_pale(share: float, kind: str) -> bool:
    """Whether a cluster of such a contrast is no paint, by the class that its shape has."""
    return share < {"stop": MIN_CONTRAST_OF_BARS, "edge": MIN_CONTRAST_OF_EDGE_LINES}.get(kind, MIN_CONTRAST)


def relative_contrast(value: np.ndarray, s: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """How bright clusters are among the bright points of their road.

    Parameters
    ----------
    value : (N,) brightness of points, cluster after cluster
    s : (N,) their stations, units of 0.1 mm
    starts : (K + 1,) where the clusters begin and the last one ends

    Returns
    -------
    (K,) 0 for what only just is brighter than asphalt, 1 for bright paint
    """
    value, stretch = value[:starts[-1]], np.floor_divide(s[:starts[-1]], int(CONTRAST_STRETCH / COORDINATE_SCALE))
    if not len(value):
        return np.empty(0)
    order = np.argsort(stretch, kind="stable")
    first, last = int(stretch.min()), int(stretch.max())
    bounds = np.searchsorted(stretch[order], np.arange(first - 1, last + 3))
    ends = np.array([percentiles(value[order[a:b]], [FAINT_PERCENTILE, BRIGHT_PERCENTILE]) if b > a else (0.0, 1.0)
                     for a, b in zip(bounds[:-3], bounds[3:])])
    del order
    found = []
    for a, b in zip(starts[:-1].tolist(), starts[1:].tolist()):
        low, high = ends[stretch[a:b] - first].T
        found += percentiles((value[a:b] - low) / np.maximum(high - low, 1e-6), [CONTRAST_PERCENTILE])
    return np.array(found)


def classify_markings(shapes: list[Shape], half_widths: Sequence[float], settings: ClassSettings = ClassSettings(),
                      covered: float | Sequence[float] = 0.0, blocks: bool | np.ndarray = False) -> list[tuple[str, str]]:
    """Class of every cluster of one road.

    Parameters
    ----------
    shapes : list of Shape
    half_widths : (N,) m from the reference line to the road edge on each cluster's side
    covered : (N,) share of each cluster's points that lie beneath or right beside something standing on the road
    blocks : (N,) bool of `give_way_blocks`, which looks at all roads at once

    Returns
    -------
    list of (class, use): class "" for what is not paint; use "keep" or "other"
    """
    if not shapes:
        return []
    column = columns_of(shapes)
    clearance = np.asarray(half_widths) - np.abs(column["offset"])
    curb = np.array([_curb(shape, r) for shape, r in zip(shapes, clearance)])
    zigzag = np.array([shape.legs > 0 for shape in shapes])
    line = _is_line(column, settings) & ~curb & ~zigzag
    line |= _dashes_in_rows(shapes, column, clearance, settings)
    line &= ~zigzag
    outside = _beyond_the_edge_line(column, line, clearance)
    doubles = _has_partner(column, line)
    covered_feet = (np.broadcast_to(covered, len(shapes)) > MIN_COVERED_SHARE) & ~(line & (column["length"] > MAX_CAR_LENGTH))
    refused = outside | covered_feet | curb
    kinds = [_kind(*of_one) for of_one in zip(shapes, clearance, line, zigzag, np.broadcast_to(blocks, len(shapes)), doubles, covered_feet, refused,
                                              repeat(settings.margin))]
    found = [(kind, "keep" if kind in LINE_KINDS else "other") for kind in kinds]
    for looked_like in (_outlines, _tips):
        for k in looked_like(column, [kind for kind, _ in found]):
            found[k] = "hatch", "other"
    for k in _single_bars(column, [kind for kind, _ in found]):
        found[k] = NOT_PAINT if clearance[k] < CURB_CORNER_CLEARANCE and shapes[k].length < MAX_CURB_CORNER_LENGTH else "symbol", "other"
    return found


def _kind(shape, clearance, line, zigzag, block, double, covered_feet, refused, margin):
    """The class of a cluster by itself; `refused` is what lies where no paint is, `margin` the m that paint may lie beyond the road's edge."""
    if zigzag and clearance >= -margin and not covered_feet:
        return "zigzag"
    if clearance < -margin or refused or _gutter(shape, clearance, line):
        return NOT_PAINT
    if _speck(shape) and not (line and shape.length >= MIN_ROW_OF_POINTS) or _round_cover(shape) and not block:
        return NOT_PAINT
    if block:
        return "give_way"
    return _line_kind(shape, clearance, double) if line else _other_kind(shape)


def columns_of(shapes: Sequence[Shape]) -> dict[str, np.ndarray]:
    """dict of (N,) arrays, what the Shapes have."""
    return {name: np.array([getattr(shape, name) for shape in shapes])
            for name in ("s0", "s1", "d0", "d1", "offset", "length", "width", "elongation", "direction", "area", "along")}


def _is_line(column, settings):
    # of a line far off each scan line may show one point only, and no width
    width, thin = column["width"], column["length"] >= MIN_SOLID_LENGTH
    return column["along"] & ((width >= settings.min_width) | thin) & (width <= settings.max_width) \
        & (column["length"] >= settings.min_length) & (column["elongation"] >= settings.min_elongation)


def _dashes_in_rows(shapes, column, clearance, settings):
    """Short dashes one after the other along the road, away from its rim, where the stones of a curb stand in rows, too."""
    short = column["along"] & (column["length"] >= SHORT_DASH_LENGTH[0]) & (column["length"] <= SHORT_DASH_LENGTH[1]) & (clearance > RIM_CLEARANCE) \
        & (column["width"] >= settings.min_width) & (column["width"] <= settings.max_width) & (column["elongation"] >= MIN_DASH_ELONGATION)
    result, rows = np.zeros(len(shapes), bool), np.flatnonzero(short)
    for row in rows_of_dashes([shapes[k] for k in rows]):
        result[rows[row]] = True
    return result


def _has_partner(column, line):
    """Lines with another line beside them, a decimetre or two away over most of their length."""
    rows = np.flatnonzero(line)
    result = np.zeros(len(line), bool)
    s0, s1, d = column["s0"][rows], column["s1"][rows], column["offset"][rows]
    for a, b in overlapping_pairs(s0, s1, s0, s1):
        overlap = np.minimum(s1[a], s1[b]) - np.maximum(s0[a], s0[b])
        result[rows[a[(a != b) & (np.abs(d[a] - d[b]) <= MAX_DOUBLE_LINE_SPACING) & (overlap > 0.5 * (s1 - s0)[a])]]] = True
    return result


def _beyond_the_edge_line(column, line, clearance):
    """Short strips between a line and the rim of the road: verge, gutter or curb, where nothing is painted."""
    short = column["along"] & (column["s1"] - column["s0"] > column["d1"] - column["d0"])
    rows, lines = np.flatnonzero(short & (clearance < RIM_CLEARANCE)), np.flatnonzero(line)
    result = np.zeros(len(short), bool)
    s0, s1, d, length = (column[name] for name in ("s0", "s1", "offset", "length"))
    # a double line is as long on either side
    on_edge = clearance < column["width"] / 2 + EDGE_CONTACT
    longest = np.where(on_edge, 1.0, EDGE_LINE_LENGTH_RATIO) * length
    reach = np.where(clearance < ROAD_EDGE_CLEARANCE, STRIP_REACH_AT_ROAD_EDGE, STRIP_REACH_BEYOND_EDGE_LINE)
    for a, b in overlapping_pairs(s0[rows], s1[rows], s0[lines], s1[lines]):
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
    for a, b in overlapping_pairs(column["s0"][rows], column["s1"][rows], column["s0"][bars], column["s1"][bars], MAX_BAR_TO_OUTLINE):
        a, b = rows[a], bars[b]
        touch = np.ones(len(a), bool)
        for low, high in (("s0", "s1"), ("d0", "d1")):
            touch &= (column[low][a] < column[high][b] + MAX_BAR_TO_OUTLINE) & (column[high][a] > column[low][b] - MAX_BAR_TO_OUTLINE)
        touched[a[touch]] = True
    return np.flatnonzero(touched)


def _tips(column, kinds):
    """What looked like an arrow, and is the last bar of hatching with the borders that meet behind it: it stands in the row of bars."""
    kinds = np.array(kinds, dtype=object)
    bars, rows = np.flatnonzero((kinds == "hatch") & (column["s1"] - column["s0"] < MIN_HATCHING_LENGTH)), np.flatnonzero(kinds == "arrow")
    count = np.zeros(len(kinds), int)
    for a, b in overlapping_pairs(column["s0"][rows], column["s1"][rows], column["s0"][bars], column["s1"][bars], MAX_HATCHING_PITCH):
        a, b = rows[a], bars[b]
        np.add.at(count, a[(column["d0"][a] < column["d1"][b]) & (column["d1"][a] > column["d0"][b])], 1)
    return np.flatnonzero(count >= MIN_BARS_BEFORE_TIP)


def _single_bars(column, kinds):
    """What looked like a bar of hatching and has no other bar near it."""
    rows = np.flatnonzero(np.array([kind == "hatch" for kind in kinds], bool))
    first, last = column["s0"][rows], column["s1"][rows]
    single = last - first < MIN_HATCHING_LENGTH
    for a, b in overlapping_pairs(first, last, first, last, MAX_HATCHING_PITCH):
        away = np.zeros(len(a))
        for low, high in (("s0", "s1"), ("d0", "d1")):
            low, high = column[low][rows], column[high][rows]
            away = np.maximum(away, np.maximum(low[a], low[b]) - np.minimum(high[a], high[b]))
        single[a[(a != b) & (away < MAX_HATCHING_PITCH)]] = False
    return rows[single]


def _line_kind(shape, clearance, double):
    if clearance < LANE_CLEARANCE and not double:
        return "edge"
    return "centre" if double or shape.length > MIN_SOLID_LENGTH else "lane"


def _speck(shape):
    return shape.area < MAX_SPECK_AREA or max(shape.length, shape.width) < MAX_SPECK_SIZE


def _round_cover(shape):
    along, across = shape.s1 - shape.s0, shape.d1 - shape.d0
    longer, shorter = max(along, across), min(along, across)
    # a dash askew fills a square, too
    return COVER_DIAMETER[0] <= longer <= COVER_DIAMETER[1] and shorter > 0.7 * longer and shape.closed_area > MIN_COVER_FILL * along * across \
        and shape.elongation < MAX_COVER_ELONGATION


def filled(shapes: Sequence[Shape]) -> np.ndarray:
    """(N,) bool, whether most of the smallest rectangle about each is painted."""
    return np.array([shape.closed_area > MIN_COVER_FILL * shape.sides[0] * shape.sides[1] for shape in shapes], bool)


def _curb(shape, clearance):
    """A hair of brightness along the very edge of the road."""
    on_edge = clearance < shape.width / 2 + EDGE_CONTACT / 2
    # seen on two tracks of the scan it looks as broad as they lie apart
    narrowest = (MIN_STRIP_WIDTH_ON_EDGE if on_edge else MIN_STRIP_WIDTH_AT_RIM) + shape.spacing
    return shape.along and clearance < ROAD_EDGE_CLEARANCE and shape.width < narrowest


def _gutter(shape, clearance, line):
    """A broad bright strip that reaches the road edge: concrete, not paint."""
    return shape.along and not line and shape.length > 2.0 and shape.elongation > 3 and clearance < shape.width


def _other_kind(shape):
    turn = abs(shape.direction)
    if shape.across and STOP_LINE_WIDTH[0] <= shape.width <= STOP_LINE_WIDTH[1] and shape.length >= MIN_STOP_LINE_LENGTH \
            and shape.closed_area >= MIN_STOP_LINE_FILL * shape.length * shape.width:
        return "stop"
    along, across = shape.s1 - shape.s0, shape.d1 - shape.d0
    if 1.5 <= along <= 8.0 and 0.3 <= across <= 1.8 and shape.area < 0.7 * along * across and turn < np.radians(25):
        return "arrow" if max(shape.stems) >= MIN_ARROW_SHAFT and min(shape.stems) <= MAX_ARROW_TIP else "symbol"
    if (np.radians(20) < turn <= np.radians(75) and shape.elongation > 2) or (along > 4 and across > 0.8):
        return "hatch"
    return "symbol"
