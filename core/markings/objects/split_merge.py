"""Markings that touch are separated, and pieces of one marking are joined.

Where a cluster holds a strip along the road, or a bar across it, and something else beside it, the two are cut free. Pieces that wear has
separated are joined: lines along the road and stop lines across it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import linked_groups, members_of, overlapping_pairs, stretch_of
from ...common.parallel import check_cancelled
from ...lazy import cv2
from ...survey.store.records import COORDINATE_SCALE
from ..road_grid import CELL_SIZE, CELL_UNITS, closed_mask, filled_between_tracks, occupied, track_reach
from ..weights import CLASSES, COMPOUNDS
from .classify import columns_of
from .shape import Shape

MORPHOLOGY_CHUNK = 100.0   # derived: m of road looked at together


def are_compound(s: np.ndarray, d: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(K,) bool, which clusters are so large that they may be several markings.

    s, d : (N,) int, units of 0.1 mm, of points one cluster after the other; starts : (K,) int, where each begins
    """
    ranges = [np.maximum.reduceat(values, starts).astype(np.int64) - np.minimum.reduceat(values, starts) for values in (s, d)]
    length, breadth = (extent * COORDINATE_SCALE for extent in ranges)
    return _of_several(length, breadth) | (length >= COMPOUNDS.min_length_beside_bar) & (breadth >= COMPOUNDS.min_stop_line_piece)


def _of_several(length, breadth):
    """Whether what is so long and so broad, m, is no arrow or letter, and more than a line or a bar."""
    return (length >= COMPOUNDS.compound_length) & (breadth >= COMPOUNDS.compound_breadth) \
        | (length >= COMPOUNDS.min_length_beside_bar) & (breadth >= COMPOUNDS.min_run_across)


def parts_of_compound(s: np.ndarray, d: np.ndarray, spacing: np.ndarray) -> np.ndarray:
    """The part of every point of one cluster, (N,) int from 0 on.

    `s`, `d` : (N,) int, units of 0.1 mm; `spacing` : (N,) int, mm between the tracks of the scan.
    """
    cells, member = occupied(s // CELL_UNITS, d // CELL_UNITS)
    reach = np.zeros(len(cells))
    reach[member] = track_reach(spacing)
    if not reach.any():
        return np.unique(_parts(cells)[member], return_inverse=True)[1]
    mask, first = filled_between_tracks(cells, reach)
    filled = np.flatnonzero(mask)
    parts = _parts(np.column_stack(np.divmod(filled, mask.shape[1])) + first)
    cell_index = np.ravel_multi_index(tuple((cells - first).T), mask.shape)
    return np.unique(parts[np.searchsorted(filled, cell_index)][member], return_inverse=True)[1]


def _parts(cells):
    """(K,) the part of every cell, numbered from 0; cells without gaps between tracks of the scan, sorted along the road."""
    size = CELL_UNITS * COORDINATE_SCALE
    even, width = even_strip(cells)
    if even.all() and width * size <= COMPOUNDS.max_width_alone:
        return np.zeros(len(cells), np.int64)
    if not _of_several(*(np.ptp(cells, axis=0) * size).tolist()):
        return bar_with_lines(cells)
    parts, count = np.full(len(cells), -1), 0
    for window, min_length in COMPOUNDS.strip_windows:
        rest = np.flatnonzero(parts < 0)
        strip = rest[_in_lines(cells[rest], COMPOUNDS.max_scan_gap, window)]
        before, count = count, _number_strips(parts, count, cells, strip, COMPOUNDS.max_scan_gap, size, min_length)
        for _, inside in members_of(np.where(parts >= before, parts, -1)):
            even, _ = even_strip(cells[inside])
            parts[inside[~even]] = -1
            # without what touched it the strip may be several, such as the lines before and behind an island
            several = parts.copy()
            if (end := _number_strips(several, count, cells, inside[even], min_length, COMPOUNDS.max_scan_gap, min_length)) > count + 1:
                parts, count = several, end
    rest, turned = np.flatnonzero(parts < 0), cells[:, ::-1]
    # scan lines lie apart within a bar
    bars = rest[_in_runs(turned[rest], COMPOUNDS.max_paint_gap, COMPOUNDS.min_run_across)]
    before, count = count, _number_strips(parts, count, turned, bars, COMPOUNDS.max_paint_gap, COMPOUNDS.max_scan_gap, COMPOUNDS.min_run_across)
    along = np.ascontiguousarray(cells[:, 0])
    for _, bar in members_of(np.where(parts >= before, parts, -1)):
        complete_bar(parts, bar, turned, along)
    if not count:
        return bar_with_lines(cells)
    rest = np.flatnonzero(parts < 0)
    pieces = _linked(cells[rest], COMPOUNDS.max_scan_gap / size, 3.0)
    number = int(pieces.max(initial=-1))
    for _, members in members_of(pieces):
        inner = bar_with_lines(cells[rest[members]])
        pieces[members[inner > 0]] = number + inner[inner > 0]
        number += int(inner.max())
    areas = np.bincount(pieces) * size**2 if len(pieces) else np.empty(0)
    large = areas >= COMPOUNDS.min_leftover_area
    later = np.where(large, count + np.cumsum(large) - 1, -1)
    parts[rest] = later[pieces]
    lost = parts < 0
    if lost.any():
        owned = np.flatnonzero(~lost)
        parts[lost] = parts[owned[cKDTree(cells[owned]).query(cells[lost])[1]]]
    return parts


def _in_lines(cells, longest_gap, window):
    """(K,) whether a cell lies on a straight line roughly along the road that is painted over most of `window` metres; cells are sorted along it.

    Bars, letters and the stripes of a crossing are shorter than the window; the line itself may be worn and oblique.
    """
    result = np.zeros(len(cells), bool)
    size = CELL_UNITS * COORDINATE_SCALE
    steps = int(COMPOUNDS.max_border_slope * window / COMPOUNDS.max_border_drift)
    gap, length, chunk = round(longest_gap / size) // 2 * 2, round(window / size) | 1, int(MORPHOLOGY_CHUNK / size)
    along = np.ascontiguousarray(cells[:, 0])
    for number in np.unique(along // chunk).tolist():
        check_cancelled()
        first = number * chunk - 2 * length
        rows = stretch_of(along, first, (number + 1) * chunk + 2 * length - 1)
        column, across = along[rows] - first, cells[rows, 1]
        # most lines run along the road: fewer and fewer cells are looked for, and none that lie too far from them to matter
        sought, nearby = np.flatnonzero(along[rows] // chunk == number), np.arange(len(column))
        for slope in sorted(range(-steps, steps + 1), key=abs):
            painted = np.zeros(len(column), bool)
            painted[nearby] = _painted_along(column[nearby], across[nearby], slope * (COMPOUNDS.max_border_drift / window), gap, length)
            result[rows.start + sought[painted[sought]]] = True
            sought = sought[~painted[sought]]
            if not len(sought):
                break
            nearby = np.flatnonzero(_within(column, column[sought], length + gap))
    return result


def _within(values, others, reach):
    """(N,) whether integers lie at most `reach` from some others."""
    others = np.unique(others)
    after = np.searchsorted(others, values)
    return (others[np.maximum(after - 1, 0)] + reach >= values) & (after > 0) | (others[np.minimum(after, len(others) - 1)] - reach <= values)


def _painted_along(column, across, slope, gap, length):
    """(K,) whether a cell lies in `length` cells along a slope of which LINE_SHARE is painted; gaps of `gap` cells are closed."""
    row = across - np.rint(slope * column).astype(np.int64)
    # Rows that are so far apart are one: their cells have nothing to do with each other, as they lie far apart along the road, too.
    height = int(np.ptp(across)) + int(np.ceil(2 * abs(slope) * (length + gap))) + 4
    row = (row - row.min() + 1) % height
    column = column - max(int(column.min()) - gap - 1, 0)
    mask = np.zeros((min(height, int(row.max()) + 2), int(column.max()) + 1), np.uint8)
    mask[row, column] = 1
    closed = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, np.ones((1, gap + 1), np.uint8))
    # a line may leave its row of cells by one
    joined = cv2.dilate(cv2.copyMakeBorder(closed, 1, 1, 0, 0, cv2.BORDER_WRAP), np.ones((3, 1), np.uint8))[1:-1]
    full = (_sums_along(joined, length) >= COMPOUNDS.line_share * length).astype(np.uint8)
    return _sums_along(full, length)[row, column] > 0


def _sums_along(mask, length):
    """Sums of `length` cells about each cell, along the road."""
    return cv2.boxFilter(mask, cv2.CV_16U, (length, 1), normalize=False, borderType=cv2.BORDER_CONSTANT)


def _number_strips(parts, count, cells, rows, gap, gap_across, least):
    """Number in `parts` the strips of at least `least` m that the cells `rows` make, from `count` on; returns the next number.

    `cells` : (K, 2) along the strips and across them; `gap`, `gap_across` : m between cells of one.
    """
    size = CELL_UNITS * COORDINATE_SCALE
    strips = _linked(cells[rows], gap / size, gap_across / size)
    long = np.array([np.ptp(cells[rows[members], 0]) for _, members in members_of(strips)]) * size >= least
    parts[rows] = np.where(long, count + np.cumsum(long) - 1, -1)[strips]
    return count + int(long.sum())


def _in_runs(cells, longest_gap, shortest_run):
    """(K,) whether a cell lies in a run of paint along the first axis, across the road; gaps are closed, cells are sorted by the second axis."""
    size = CELL_UNITS * COORDINATE_SCALE
    # OpenCV moves what an even number of cells closes or opens
    gap, run, chunk = round(longest_gap / size) // 2 * 2, round(shortest_run / size) | 1, int(MORPHOLOGY_CHUNK / size)
    halo = 2 * (gap + run)
    result = np.zeros(len(cells), bool)
    along = np.ascontiguousarray(cells[:, 1])
    for number in np.unique(along // chunk).tolist():
        check_cancelled()
        rows = stretch_of(along, number * chunk - 1, (number + 1) * chunk)
        column, row = cells[rows, 0] - cells[rows, 0].min() + halo, along[rows] - along[rows.start]
        mask = np.zeros((row[-1] + 1, column.max() + halo + 1), np.uint8)
        mask[row, column] = 1
        # a line may leave its row of cells by one: the road's frame is not the paint's
        joined = cv2.dilate(cv2.morphologyEx(mask, cv2.MORPH_CLOSE, np.ones((1, gap + 1), np.uint8)), np.ones((3, 1), np.uint8))
        runs = cv2.morphologyEx(joined, cv2.MORPH_OPEN, np.ones((1, run), np.uint8))
        inner = np.flatnonzero(along[rows] // chunk == number)
        result[rows.start + inner] = runs[row[inner], column[inner]] > 0
    return result


def _linked(cells, along, across):
    """Connected components of different cells no farther apart than `along` and `across` cells, numbered in the order of the cells."""
    if not len(cells):
        return np.empty(0, np.int64)
    order = np.lexsort(cells.T)
    (column, row), reach = (cells[order] - cells.min(axis=0)).T, int(along)
    key = row * (int(column.max()) + 2 * reach + 1) + column
    pairs = []
    # of a row of cells the first and the last within reach are enough: those between them are linked with one of the two
    for step in range(int(across) + 1):
        near = key + step * (int(column.max()) + 2 * reach + 1)
        first, last = np.searchsorted(key, near - reach), np.searchsorted(key, near + reach, side="right") - 1
        some = np.flatnonzero(first <= last)
        pairs += [(order[some], order[other[some]]) for other in (first, last)]
    return linked_groups(*np.concatenate(pairs, axis=1), len(cells)).astype(np.int64)


def join_fragments(shapes: Sequence[Shape], max_width: float) -> np.ndarray:
    """(N,) int, the same number for pieces that continue each other over a worn spot; `max_width` : m, a line's.

    Narrow pieces along the road are joined where one begins up to 0.9 m after the end of another on the same line, farther where tracks of the scan
    cross it obliquely; pieces of a bar across the road over 0.3 m where their front and rear are the same.
    """
    if len(shapes) < 2:
        return np.arange(len(shapes))
    column = columns_of(shapes)
    pairs = np.concatenate([_along(shapes, max_width), _bars(column)])
    return linked_groups(pairs[:, 0], pairs[:, 1], len(shapes))


def _along(shapes, max_width):
    """(P, 2) narrow pieces, the second of which goes on where the first ends."""
    narrow = np.array([k for k, shape in enumerate(shapes) if shape.width <= max_width and shape.along or shape.d1 - shape.d0 <= max_width], np.int64)
    if len(narrow) < 2:
        return np.empty((0, 2), np.int64)
    begins = np.array([(shapes[k].s0, shapes[k].begin) for k in narrow])
    ends = np.array([(shapes[k].s1, shapes[k].finish) for k in narrow])
    # a line that the tracks of the scan cross obliquely shows on each of them for a while
    spacing = np.array([shapes[k].spacing for k in narrow])
    longest = np.clip(COMPOUNDS.tracks_per_gap * spacing, COMPOUNDS.max_worn_gap, COMPOUNDS.max_gap_between_tracks)
    # a box of -0.2 to 2 m along and 8 cm either way across about each end
    scale = np.array([(COMPOUNDS.max_gap_between_tracks + COMPOUNDS.max_fragment_overlap) / 2, COMPOUNDS.max_fragment_offset])
    boxes = (ends + np.array([(COMPOUNDS.max_gap_between_tracks - COMPOUNDS.max_fragment_overlap) / 2, 0.0])) / scale
    neighbours = cKDTree(begins / scale).query_ball_point(boxes, 1.0, p=np.inf)
    pairs = np.array([(a, b) for a, beginnings in enumerate(neighbours) for b in beginnings if a != b], np.int64).reshape(-1, 2)
    gap = begins[pairs[:, 1], 0] - ends[pairs[:, 0], 0]
    return np.concatenate([narrow[pairs[gap <= longest[pairs].min(axis=1)]], _unseen_gaps(shapes, narrow)])


def _unseen_gaps(shapes, narrow):
    """(P, 2) pieces of one line with a gap that was not seen: a track of the scan leaves the line sideways before it, or comes in so after it."""
    sparse = np.array([k for k in narrow.tolist() if shapes[k].spacing > 0 and max(shapes[k].oblique) >= COMPOUNDS.min_oblique], np.int64)
    if len(sparse) < 2:
        return np.empty((0, 2), np.int64)
    first, last, offset = (np.array([getattr(shapes[k], name) for k in sparse]) for name in ("s0", "s1", "offset"))
    sideways = np.array([shapes[k].oblique for k in sparse]) >= COMPOUNDS.min_oblique
    a, b = overlapping_pairs(first, last, first, last, COMPOUNDS.max_unseen_gap)
    gap = first[b] - last[a]
    unseen = (a != b) & (gap >= 0) & (gap <= COMPOUNDS.max_unseen_gap) & (sideways[a, 1] | sideways[b, 0])
    return sparse[np.column_stack([a, b])[unseen & (np.abs(offset[a] - offset[b]) <= COMPOUNDS.max_unseen_offset)]]


def _bars(column):
    """(P, 2) neighbouring pieces of bars across the road."""
    s0, s1, d0, d1 = (column[name] for name in ("s0", "s1", "d0", "d1"))
    thick, broad = s1 - s0, d1 - d0
    rows = np.flatnonzero((thick >= CLASSES.stop_line_width[0]) & (thick <= CLASSES.stop_line_width[1]) & (broad >= COMPOUNDS.max_stop_line_gap))
    # nearly the same front and rear
    pairs = cKDTree(np.column_stack([s0, s1])[rows]).query_pairs(COMPOUNDS.max_side_shift, p=np.inf, output_type="ndarray").reshape(-1, 2)
    a, b = rows[pairs].T
    gap = np.maximum(d0[a], d0[b]) - np.minimum(d1[a], d1[b])
    return np.column_stack([a, b])[(gap <= COMPOUNDS.max_stop_line_gap) & (np.maximum(broad[a], broad[b]) >= COMPOUNDS.min_stop_line_piece)]


# Bars across the road, as stop lines are, and the lines that end at them. Such a cluster is short, so the bar is known by its own form: as thick as
# stop lines are, full, and the line leaves its front or its rear.


def even_strip(cells: np.ndarray) -> tuple[np.ndarray, float]:
    """Which cells of a strip, (K, 2) along it and across it, lie within its usual width, in cells, about its middle, as what touches it does not."""
    step = (cells[:, 0] - cells[:, 0].min()) // COMPOUNDS.width_step
    count = int(step.max()) + 1
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, step, cells[:, 1])
    np.maximum.at(high, step, cells[:, 1])
    painted = np.isfinite(low)
    usual = np.median((high - low)[painted])
    even = np.flatnonzero(painted & (high - low <= usual + COMPOUNDS.width_tolerance))
    middle = np.interp(step, even, (low[even] + high[even]) / 2)
    return np.abs(cells[:, 1] - middle) <= (usual + COMPOUNDS.width_tolerance) / 2, usual


def complete_bar(parts: np.ndarray, bar: np.ndarray, turned: np.ndarray, along: np.ndarray) -> None:
    """Give a bar, in `parts`, what is left over between its front and its rear: where it is worn it is no less its paint.

    parts : (K,) int, the part of every cell, below 0 for what is left over; bar : (N,) the numbers of the bar's cells, ascending
    turned : (K, 2) int cells, across the road first, sorted along it; along : (K,) its second column
    """
    bar_cells = turned[bar]
    (left, front), (right, rear) = bar_cells.min(axis=0), bar_cells.max(axis=0)
    window = stretch_of(along, front, rear)
    leftover = window.start + np.flatnonzero((parts[window] < 0) & (turned[window, 0] >= left) & (turned[window, 0] <= right))
    rows = np.sort(np.concatenate([bar, leftover]))
    inside, _ = even_strip(turned[rows])
    parts[rows[inside & (parts[rows] < 0)]] = parts[bar[0]]


def bar_with_lines(cells: np.ndarray) -> np.ndarray:
    """Cut a bar from the lines that end at it or cross it, if that is all there is. The head of an arrow is no bar: it is longer or has a tip.

    `cells` : (K, 2) int, along the road and across it, different ones. Returns (K,) int, the part of every cell from 0 on.
    """
    undivided = np.zeros(len(cells), np.int64)
    if not len(cells):
        return undivided
    mask, first = closed_mask(cells, (int(round(COMPOUNDS.max_scan_gap / CELL_SIZE)), int(round(COMPOUNDS.max_paint_gap / CELL_SIZE))))
    reach = np.where(mask.any(axis=1), mask.shape[1] - mask[:, ::-1].argmax(axis=1) - mask.argmax(axis=1), 0)
    broad = np.flatnonzero(reach * CELL_SIZE > COMPOUNDS.max_width_alone)
    if not len(broad):
        return undivided
    front, rear = broad[0], broad[-1] + 1
    across = np.flatnonzero(mask[front:rear].any(axis=0))
    box = mask[front:rear, across[0]:across[-1] + 1]
    thin, thick = CLASSES.stop_line_width
    short = box.shape[1] * CELL_SIZE < COMPOUNDS.min_stop_line_piece
    if not thin <= len(box) * CELL_SIZE <= thick or short or box.mean() < CLASSES.min_stop_line_fill:
        return undivided
    row, parts = cells[:, 0] - first[0], undivided.copy()
    for side, length in ((row < front, front * CELL_SIZE), (row >= rear, (len(mask) - rear) * CELL_SIZE)):
        if COMPOUNDS.ragged_rim < length < COMPOUNDS.min_length_beside_bar:
            return undivided
        if length > COMPOUNDS.ragged_rim:
            parts[side] = parts.max() + 1
    return parts
