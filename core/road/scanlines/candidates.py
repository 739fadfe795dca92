"""Candidates of curbs on normalized scanlines: rises of the height within a short distance across the road.

Every scanline is searched outward from the vehicle for a rise of at least `min_height` within `search_width` that begins
on road and is followed by raised ground. A rise that is not on the neighbouring scanlines too is no candidate. The
vertices around the candidates are then resampled for the planes of `corners`.

Source: the paper on normalized scanlines (ISPRS Archives, 2020), section 3 and table 1, steps b and g.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common.arrays import Rows, best_within
from ...common.errors import RoadExtractionError
from ...common.setting import check_limits, setting
from ...lazy import cv2
from ..common.corners import road_before
from ..common.curb_limits import CurbLimits
from ..weights import SCANLINE
from .grid import LINE_SEPARATION, HeightGrid, Scanlines, row_of_lines


@dataclass(frozen=True)
class ScanlineBoundarySettings:
    """The parameters of table 1 of the paper.

    distance_across, distance_along : m on either side of a candidate from which its planes are fitted
    vertical_angle, horizontal_angle : degrees between the normal of a plane and Z: at least that of a face, at most
        that of road and sidewalk; 0 for the face = as the noise allows
    """

    search_width: float = setting(0.10, 0.04, 0.5, "The search width", "m")   # m across within which the height must change
    sensor_height: float = setting(0.0, 0.0, 10.0, "The sensor height", "m")   # m from the trajectory down to the road; 0 = from the data
    clipping_height: float = setting(0.45, 0.05, 2.0, "The clipping height", "m")   # m above the road; higher points are not used
    min_height: float = setting(0.0, 0.01, 0.5, "The minimum height", "m", "for automatic")   # m of height change; 0 = as the noise allows
    distance_across: float = setting(0.50, 0.15, 2.0, "The distance across", "m")
    distance_along: float = setting(0.40, 0.1, 2.0, "The distance along", "m")
    ransac_distance: float = setting(0.005, 0.001, 0.1, "The RANSAC distance", "m")   # m from a plane to its inliers
    vertical_angle: float = setting(0.0, 20.0, 90.0, "The vertical angle", "°", "for automatic")
    horizontal_angle: float = setting(20.0, 1.0, 45.0, "The horizontal angle", "°")
    max_gap: float = setting(2.5, 0.0, 100.0, "The longest connected gap", "m")   # m between corners that are connected

    def __post_init__(self):
        """Check the limits of all settings, and that pairs of settings are in order."""
        check_limits(self)
        if self.clipping_height <= self.min_height:
            raise RoadExtractionError(f"The clipping height is {self.clipping_height} m and the minimum height {self.min_height} m; "
                                      "the clipping height must be above the minimum height.")
        if 0 < self.vertical_angle <= self.horizontal_angle:
            raise RoadExtractionError(f"The vertical angle is {self.vertical_angle}° and the horizontal angle {self.horizontal_angle}°; "
                                      "the vertical angle must be above the horizontal one.")

    @property
    def limits(self) -> CurbLimits:
        """The least height and slope of curbs."""
        return CurbLimits.of(self.min_height, self.vertical_angle, min(SCANLINE.usual_step_height, self.clipping_height), SCANLINE.usual_angle)


@dataclass
class CurbCandidates(Rows):
    """M rises on the scanlines of one side, pass and scanner, sorted by row, then outward."""

    row: np.ndarray   # row, cell: (M,) int, cell of the grid in which the middle of the rise is crossed
    cell: np.ndarray
    u: np.ndarray   # (M,) m, outward offset of that cell
    base: np.ndarray   # (M,) m above the expected road, height there of the line through the road before the rise
    slope: np.ndarray   # (M,) m per m, slope of that line
    step: np.ndarray   # (M,) m, height of the rise
    rough: np.ndarray   # (M,) m, standard deviation of the road about the line


def find_candidates(side: HeightGrid, measured: np.ndarray, nearest: np.ndarray, settings: ScanlineBoundarySettings) -> CurbCandidates:
    """Rises of at least `min_height` within `search_width`, and not higher than `clipping_height`.

    side : HeightGrid of one side, counted outward, with gaps filled
    measured : (R, C) m, heights before the gaps were filled
    nearest : (R,) m, outward offset on each row from which rises are searched
    """
    low = side.low
    span = max(int(round(settings.search_width / SCANLINE.scanline_resolution)), 2)
    row, cell, before, top = _rising(low, span, SCANLINE.min_rise_share * settings.limits.least_height)
    outside = side.offset(cell) > np.asarray(nearest)[row]
    row, cell, before, top = (values[outside] for values in (row, cell, before, top))
    filled = np.nonzero(np.isfinite(low))
    base, slope, rough, count = road_before(low, low[filled].astype(float), filled[1] * SCANLINE.scanline_resolution, SCANLINE.scanline_resolution,
                                            row, cell)
    step = top - base
    middle = base + 0.5 * step
    rising = np.flatnonzero((count >= SCANLINE.min_road_cells) & (step >= SCANLINE.min_rise_share * settings.limits.least_height)
                            & (step <= settings.clipping_height)
                            & (rough <= SCANLINE.max_roughness_share * step) & (low[row, cell] >= middle) & (before < middle))
    best = rising[best_within((row * low.shape[1] + cell)[rising], row[rising], (step - 2 * rough)[rising], span)]
    row, cell = row[best], cell[best]
    candidates = CurbCandidates(row, cell, side.offset(cell), *(values[best].astype(float) for values in (base, slope, step, rough)))
    # filled gaps alone would extend a curb beyond its end
    about = np.clip(cell[:, None] + np.arange(-span, span + 1), 0, low.shape[1] - 1)
    candidates = candidates[_stays_up(low, candidates) & np.isfinite(measured[row[:, None], about]).any(1)]
    return candidates[_persistent(candidates)]


def _rising(low, span, least):
    """(row, cell, height before, height reached ahead) of cells in which half of a rise of `least` metres may be crossed."""
    measured = np.isfinite(low)
    filled = np.where(measured, low, np.float32(-LINE_SEPARATION))
    top = cv2.dilate(filled, np.ones((1, span + 1), np.uint8), anchor=(0, 0))
    # height of the nearest occupied cell before each occupied one, within the span
    before = np.empty_like(low)
    before[:, :1], before[:, 1:] = np.nan, low[:, :-1]
    empty = np.flatnonzero(measured & np.isnan(before))
    flat, column = low.reshape(-1), empty % low.shape[1]
    for k in range(2, span + 1):
        enough = column >= k
        empty, column = empty[enough], column[enough]
        height = flat[empty - k]
        before.reshape(-1)[empty] = height
        missed = np.isnan(height)
        empty, column = empty[missed], column[missed]
    rising = (top - before > 0.5 * least) & (low > before)
    indices = np.flatnonzero(rising)
    row = indices // low.shape[1]
    return row, indices - row * low.shape[1], before.reshape(-1)[indices], top.reshape(-1)[indices]


def gap_fill_rows(interval: float) -> int:
    """Scanlines on either side from which the gaps of a scanline are filled. interval : m between section planes"""
    return max(int(round(SCANLINE.gap_fill_reach / interval)), 1)


def _stays_up(low, candidates):
    """Whether the ground behind stays above half the rise."""
    first, last = (int(round(reach / SCANLINE.scanline_resolution)) for reach in SCANLINE.behind_rise)
    cells = candidates.cell[:, None] + np.arange(first, last + 1)
    heights = np.where(cells < low.shape[1], low[candidates.row[:, None], np.minimum(cells, low.shape[1] - 1)], np.nan)
    occupied = np.isfinite(heights).sum(1)
    sunk = (heights < (candidates.base + 0.5 * candidates.step)[:, None]).sum(1)
    return (occupied >= SCANLINE.min_cells_behind) & (sunk <= SCANLINE.max_sunk_share * occupied)


def _persistent(candidates):
    """Whether enough of the neighbouring scanlines have a candidate at the same place."""
    count = len(candidates)
    if not count:
        return np.zeros(0, bool)
    span = 1000.0
    order = np.lexsort((candidates.u, candidates.row))
    key = (candidates.row * span + candidates.u)[order]
    showing = np.ones(count, np.int64)
    for ahead in range(-SCANLINE.neighbour_lines, SCANLINE.neighbour_lines + 1):
        if not ahead:
            continue
        right = np.searchsorted(key, (candidates.row + ahead) * span + candidates.u)
        partner = np.zeros(count, bool)
        for k in (np.clip(right - 1, 0, count - 1), np.clip(right, 0, count - 1)):
            neighbour = order[k]
            partner |= (candidates.row[neighbour] == candidates.row + ahead) \
                & (np.abs(candidates.u[neighbour] - candidates.u) <= SCANLINE.match_across * max(abs(ahead), 1)) \
                & (np.abs(candidates.base[neighbour] - candidates.base) <= SCANLINE.match_up)
        showing += partner
    return showing >= SCANLINE.min_lines_showing


@dataclass
class ScanlineSamples:
    """N vertices of resampled scanlines, in the order of the lines or, of one side, by row and outward offset."""

    first: int   # first, interval, rows: number of the first section plane, m between planes, count of planes
    interval: float
    rows: int
    row: np.ndarray   # (N,) int, from 0
    u: np.ndarray   # (N,) m, offset; outward offset where they are of one side
    h: np.ndarray   # (N,) m above the expected road
    steep: np.ndarray   # (N,) m per m, slope between the neighbours of each vertex, without sign

    def outward(self, sign: int) -> ScanlineSamples:
        """The samples of one side, 1 left or -1 right, sorted by row and outward offset."""
        u = sign * self.u[::sign]
        row = self.row[::sign]
        order = np.argsort(row * LINE_SEPARATION + u, kind="stable")
        return ScanlineSamples(self.first, self.interval, self.rows, row[order], u[order], self.h[::sign][order], self.steep[::sign][order])


def samples_near(lines: Scanlines, heights: np.ndarray, rows: tuple[int, int], interval: float, places: tuple[np.ndarray, np.ndarray],
                 across: float, along: int, clipping_height: float) -> ScanlineSamples:
    """Scanlines resampled near some places, at the height of the road.

    A line is sampled at equal steps from its first vertex, so the samples do not depend on the places.

    lines : Scanlines of one pass and scanner, V vertices
    heights : (V,) m above the expected road
    rows : (first, last + 1) numbers of the section planes
    interval : m between planes
    places : (row, d), (M,) int and (M,) m
    across, along : m and rows around the places
    clipping_height : m above the expected road, up to which vertices are used

    Returns ScanlineSamples: all samples that near, and some farther away
    """
    row = row_of_lines(lines, rows, interval)
    segments, line = _segments_near(lines, row, rows[1] - rows[0], *places, across, along)
    line, d, h, steep = _at_equal_steps(lines, heights, segments, line)
    near_ground = np.flatnonzero((h > -SCANLINE.max_ground_depth) & (h <= clipping_height))
    return ScanlineSamples(rows[0], interval, rows[1] - rows[0], row[line[near_ground]], d[near_ground], h[near_ground], steep[near_ground])


def _segments_near(lines, row, count, place_row, place_d, across, along):
    """First vertices of the line segments that cross marked cells, and their lines."""
    low, high = lines.d.min(), lines.d.max()
    cells = int((high - low) / SCANLINE.place_cell) + 1
    mask = np.zeros((count, cells), np.uint8)
    mask[place_row, np.clip(((place_d - low) / SCANLINE.place_cell).astype(np.int64), 0, cells - 1)] = 1
    # one cell more, so that every sample has both neighbours, from which its slope is computed
    cells_across = int(np.ceil(across / SCANLINE.place_cell)) + 2
    mask = cv2.dilate(mask, np.ones((2 * along + 1, 2 * cells_across + 1), np.uint8))
    before = np.zeros((count, cells + 1), np.int32)
    np.cumsum(mask, axis=1, out=before[:, 1:])
    cell = ((lines.d - low) * (1.0 / SCANLINE.place_cell)).astype(np.int32)
    inside = (row >= 0) & (row < count)
    line = np.repeat(np.arange(len(lines)), np.diff(lines.first))
    cell += (np.where(inside, row, 0) * (cells + 1)).astype(np.int32).take(line)
    flat, cell = before.reshape(-1), cell.astype(np.intp)
    near = flat.take(cell[1:] + 1) > flat.take(cell[:-1])
    near &= (line[1:] == line[:-1]) & inside.take(line[:-1])
    segments = np.flatnonzero(near)
    return segments, line.take(segments)


def _at_equal_steps(lines, heights, segment, line):
    """(line, d, h, slope) at equal steps along some segments of lines; a metre of height counts as SCANLINE.height_weight metres."""
    step = np.abs(np.diff(lines.d))
    step += SCANLINE.height_weight * np.abs(np.diff(heights))
    step[lines.first[1:-1] - 1] = 0.0
    along = np.concatenate([[0.0], np.cumsum(step)])
    begin, end = along.take(segment), along.take(segment + 1)
    start = along.take(lines.first[:-1]).take(line)
    begin, end = begin - start, end - start
    first = np.ceil(begin / SCANLINE.scanline_resolution - 1e-9).astype(np.int64)
    last = np.ceil(end / SCANLINE.scanline_resolution - 1e-9).astype(np.int64)
    # the end of a line is a sample where a step falls on it
    closing = (segment + 2 == lines.first[1:][line]) & (last * SCANLINE.scanline_resolution <= end)
    number = last + closing - first
    owner = np.repeat(np.arange(len(segment)), number)
    count = np.arange(len(owner)) + (first - (np.cumsum(number) - number)).take(owner)
    share = np.clip((count * SCANLINE.scanline_resolution - begin.take(owner)) / np.maximum(end - begin, 1e-9).take(owner), 0.0, 1.0)
    d0, h0 = lines.d.take(segment), heights.take(segment)
    d = d0.take(owner) + share * (lines.d.take(segment + 1) - d0).take(owner)
    h = h0.take(owner) + share * (heights.take(segment + 1) - h0).take(owner)
    line = line.take(owner)
    return line, d, h, _steepness(line, count, d, h)


def _steepness(line, count, d, h):
    """(N,) slope without sign from the sample before to the one after on the same line."""
    if len(line) < 2:
        return np.zeros(len(line))
    parted = (np.diff(line) != 0) | (np.diff(count) != 1)
    before, after = np.arange(-1, len(line) - 1), np.arange(1, len(line) + 1)
    before[0], after[-1] = 0, len(line) - 1
    before[1:] += parted
    after[:-1] -= parted
    return np.abs(h.take(after) - h.take(before)) / np.maximum(np.abs(d.take(after) - d.take(before)), 1e-6)
