"""Scanlines from points near the section planes, where a cloud has no scan lattice to mesh.

Spinning multi-beam scanners, thinned clouds and clouds without times have no scan lines. The points within a thin slice
around each plane are binned across the road instead, and the lowest layer of every bin is the ground. Points above the
ground are kept as separate lines: they show what hides a curb. The method is our own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..common.occlusion import MIN_OCCLUDER_HEIGHT
from ..common.pseudo_scanlines import pseudo_scan_lines
from ..common.sides import expected_height
from .grid import SCANLINE_RESOLUTION, Scanlines
from .mesh import increasing

if TYPE_CHECKING:
    from ...survey.open_survey import Survey

SLICE_LAYER_JUMP = 0.05   # m of height between the ground and the layer above it
MIN_STEEP_RISE, STEEP_NOISE_SIGMAS = 0.02, 6.0  # m of height within one cell, and times the noise: more is a face,
FACE_VERTEX_STEP = 0.01       # m of height between the vertices of a face
MAX_VERTEX_GAP = 0.30     # m between neighbouring vertices of one line
MIN_SLICE_LINE_VERTICES = 3  # vertices of a line
SLICE_MARGIN = 0.01       # m read beyond the slices; the slices then select their points exactly
MIN_SLICE_LENGTH = 0.20   # m along the road: thinner slices may lie between two turns of a scanner


def point_scanlines(survey: Survey, road: int, start: float, end: float, interval: float, corridor: float) -> Scanlines:
    """Scanlines of the points near the section planes at k * interval, start <= k * interval < end.

    A slice holds the points within interval / 2 of its plane, or within MIN_SLICE_LENGTH / 2 where that is more.

    Parameters
    ----------
    survey : Survey
    road : number of the road
    start, end : m, stations
    interval : m between planes
    corridor : m either side of the reference line

    Returns
    -------
    Scanlines
    """
    first, last = int(np.ceil(start / interval - 1e-9)), int(np.ceil(end / interval - 1e-9))
    half = 0.5 * max(MIN_SLICE_LENGTH, interval)
    if last <= first:
        return Scanlines.none()
    points = survey.window(road, first * interval - half - SLICE_MARGIN, (last - 1) * interval + half + SLICE_MARGIN)
    points = points[np.abs(points.d) < corridor]
    s, d = points.s, points.d
    h = points.z - expected_height(survey, road, s)
    key = points.pass_number.astype(np.int64) * 256 + points.scanner
    parts = []
    for value in np.unique(key):
        own = np.flatnonzero(key == value)
        rows, index = _slices(s[own], first, last, interval, half)
        index = own[index]
        # the row replaces the station, so that slices may overlap
        cells = pseudo_scan_lines(d[index], rows + 0.5, h[index], points.intensity[index].astype(float), (first, last), 1.0,
                                  SCANLINE_RESOLUTION, SLICE_LAYER_JUMP, -corridor, corridor)
        for selected, quantile in ((cells.ground, 0.5), (~cells.ground & (cells.h > MIN_OCCLUDER_HEIGHT), 1.0)):
            row, across, height, intensity = _vertices(cells, np.flatnonzero(selected), quantile)
            parts.append(_joined(row, across, height, intensity, first, interval, int(value) // 256, int(value) % 256))
    lines = Scanlines.join(parts)
    if not len(lines):
        return lines
    lines.z = lines.z + np.repeat(expected_height(survey, road, lines.station), np.diff(lines.first))
    return lines[np.lexsort((lines.d[lines.first[:-1]], lines.scanner, lines.pass_number, np.rint(lines.station / interval)))]


def slice_lines(d: np.ndarray, z: np.ndarray, half_width: float) -> list[np.ndarray]:
    """The ground's scanline through one slice of points whose road is not known, for a look at it.

    Parameters
    ----------
    d : (N,) m, offsets from the middle of the road, left positive
    z : (N,) m, heights
    half_width : m either side of the middle that are looked at

    Returns
    -------
    list of (V, 2) offset and height, offsets increasing; a new line begins where the ground is interrupted
    """
    if not len(d):
        return []
    level = float(np.median(z))
    cells = pseudo_scan_lines(d, np.full(len(d), 0.5), z - level, np.zeros(len(d)), (0, 1), 1.0, SCANLINE_RESOLUTION, SLICE_LAYER_JUMP,
                              -half_width, half_width)
    row, across, height, bright = _vertices(cells, np.flatnonzero(cells.ground), 0.5)
    lines = _joined(row, across, height, bright, 0, 1.0, 0, 0)
    return [np.c_[lines.d[begin:end], lines.z[begin:end] + level] for begin, end in zip(lines.first[:-1], lines.first[1:])]


def _slices(s, first, last, interval, half):
    """(row, index) of every point within `half` metres of a section plane, once for each such plane."""
    low = np.maximum(np.ceil((s - half) / interval).astype(np.int64), first)
    high = np.minimum(np.floor((s + half) / interval).astype(np.int64), last - 1)
    count = np.maximum(high - low + 1, 0)
    index = np.repeat(np.arange(len(s)), count)
    return np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count) + low[index], index


def _vertices(cells, selected, quantile):
    """Row, offset, height and intensity of the vertices: one per occupied cell, several per cell on a face.

    The height of a level cell is a quantile of its heights: the median of ground, the maximum of tall objects.
    """
    count = cells.shape[1]
    place = np.repeat(np.arange(len(cells.starts) - 1), np.diff(cells.starts))[selected]
    point, h = cells.point[selected], cells.h[selected]
    d, intensity = cells.u[point], cells.along[point]
    if not len(selected):
        return (np.empty(0, np.int64),) + (np.empty(0),) * 3
    begins = np.r_[True, np.diff(place) > 0]
    first = np.flatnonzero(begins)
    cell = np.cumsum(begins) - 1
    lowest, highest = h[first], h[np.r_[first[1:], len(h)] - 1]
    noise = cells.noise[place[first] // count]
    steep = (highest - lowest > np.maximum(MIN_STEEP_RISE, STEEP_NOISE_SIGMAS * noise)) & (quantile < 1.0)
    level = np.where(steep[cell], np.floor((h - lowest[cell]) / FACE_VERTEX_STEP), 0.0).astype(np.int64)
    begins = begins | np.r_[True, np.diff(level) != 0]
    start = np.flatnonzero(begins)
    number = np.diff(np.r_[start, len(h)])
    middle = start + np.floor(quantile * (number - 1) + 0.5).astype(np.int64)
    across, bright = np.add.reduceat(d, start) / number, np.add.reduceat(intensity, start) / number
    row, column = place[start] // count, place[start] % count
    # offsets increase to the left: upward on a face left of the road, downward on the right
    rise = np.where(column < count // 2, -1, 1) * level[start]
    order = np.lexsort((rise, column, row))
    return row[order], across[order], h[middle][order], bright[order]


def _joined(row, d, h, intensity, first, interval, pass_number, scanner):
    """Lines of consecutive vertices, split where these are far apart."""
    if not len(row):
        return Scanlines.none()
    new = np.r_[True, (np.diff(row) != 0) | (np.diff(d) > MAX_VERTEX_GAP) | (np.abs(np.diff(h)) > 2 * MAX_VERTEX_GAP)]
    begins = np.flatnonzero(new)
    count = len(begins)
    # noise disorders the offsets on a face
    d = increasing(d, np.r_[begins, len(row)])
    lines = Scanlines((row[begins] + first) * interval, np.full(count, pass_number), np.full(count, scanner),
                      np.r_[begins, len(row)], d, h, intensity.astype(np.float32))
    return lines[np.diff(lines.first) >= MIN_SLICE_LINE_VERTICES]
