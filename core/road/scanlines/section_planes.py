"""Normalized scanlines: the mesh of the scan lattice intersected with planes across the road.

A plane perpendicular to the reference line of the road has one station in the road frame. The ribs of the mesh are
intersected at the stations of the planes, and neighbouring intersections are connected. Planes do not intersect each
other within the road, because the frame limits the offset by the radius of the bend.

Source: the paper on normalized scanlines (ISPRS Archives, 2020), section 2.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...common.progress import Progress
from ...common.setting import Limited, setting
from ...execution.phase import Phase
from ...survey.lattice.scan_lattice import ScanLattice, find_lattice, scanner_runs
from ...survey.open_survey import Survey
from ..common.pseudo_scanlines import pseudo_scan_lines
from ..common.sides import expected_height, fixed_sections
from ..weights import CURBS, SCANLINE
from .grid import Scanlines
from .mesh import PlaneVertices, Ribs, increasing, plane_order, ribs_of, scanner_lines, slanting_edges


@dataclass(frozen=True)
class ScanlineSettings(Limited):
    """Section planes.

    interval : m between section planes
    corridor : m either side of the reference line of the road
    rotation_frequency : Hz, scan lines per second of each scanner; 0 = from the data
    """

    interval: float = setting(0.10, 0.01, 10.0, "The interval", "m")
    corridor: float = setting(15.0, 5.0, 100.0, "The corridor", "m")
    rotation_frequency: float = setting(0.0, 5.0, 400.0, "The rotation frequency", "Hz", "to take it from the data")


def scanlines_of(survey: Survey, road: int, start: float, end: float, settings: ScanlineSettings = ScanlineSettings(),
                 lattice: ScanLattice | None = None) -> Scanlines:
    """The normalized scanlines of the planes with start <= station < end.

    start, end : m; planes lie at whole multiples of the interval
    lattice : ScanLattice of the survey, or None to find it here

    Returns Scanlines; of scanners without a lattice those of the points near the planes
    """
    lines = Scanlines.join(scanline_runs(survey, road, start, end, settings, lattice))
    if not len(lines):
        return lines
    order = np.lexsort((lines.d[lines.first[:-1]], lines.scanner, lines.pass_number, np.rint(lines.station / settings.interval)))
    return lines if (np.diff(order) == 1).all() else lines[order]


def scanline_runs(survey: Survey, road: int, start: float, end: float, settings: ScanlineSettings = ScanlineSettings(),
                  lattice: ScanLattice | None = None, intensity: bool = True) -> list[Scanlines]:
    """The normalized scanlines of the planes with start <= station < end, apart for each pass and scanner.

    survey, road, start, end, settings, lattice : as in `scanlines_of`
    intensity : whether intensities are computed; else they are 0
    """
    interval = settings.interval
    first, last = int(np.ceil(start / interval - 1e-9)), int(np.ceil(end / interval - 1e-9))
    if last <= first:
        return []
    if lattice is None:
        lattice = find_lattice(survey, settings.rotation_frequency)
    parts, unmeshed = [], not lattice.mirror_phases
    if lattice.mirror_phases:
        margin = max(margin_of_meshes(survey, road, lattice), SCANLINE.min_slice_length, interval)
        records = survey.window(road, first * interval - margin, (last - 1) * interval + margin).records
        for key, run in scanner_runs(records):
            mirror = lattice.mirror_phases.get(key)
            unmeshed |= mirror is None
            if mirror is not None:
                parts.append(_cut(run, survey.frame.passes[key[0]], key, mirror, (first, last), settings, intensity))
    if unmeshed:
        lines = point_scanlines(survey, road, start, end, interval, settings.corridor)
        meshed = [key in lattice.mirror_phases for key in zip(lines.pass_number.tolist(), lines.scanner.tolist())]
        parts += lines[~np.array(meshed, bool)].runs()
    return [part for part in parts if len(part)]


def all_scanlines(survey: Survey, road: int, settings: ScanlineSettings = ScanlineSettings(), lattice: ScanLattice | None = None,
                  progress: Progress = Progress()) -> Iterator[Scanlines]:
    """The normalized scanlines of a whole road, section by section; sections are computed in parallel.

    survey, road, settings, lattice : as in `scanlines_of`

    Yields Scanlines, in order of station
    """
    if lattice is None:
        lattice = find_lattice(survey, settings.rotation_frequency)
    start, end = survey.store.span(road)
    interval = settings.interval
    sections = fixed_sections(int(np.floor(start / interval)), int(np.ceil(end / interval)) + 1, interval)

    phase = Phase(_scanlines_of_section, survey, (road, settings, lattice), join=Scanlines.join,
                  **survey.along(lambda section: (road, *section), reach=margin_of_meshes(survey, road, lattice)))
    yield from survey.executor.run(phase, [(a * interval, b * interval) for a, b in sections], progress)


def _scanlines_of_section(survey: Survey, section: tuple[float, float], road: int, settings: ScanlineSettings, lattice: ScanLattice) -> Scanlines:
    """The phase of normalized scanlines: those of one section, (start, end) in metres of station, of a road; else as in `scanlines_of`."""
    return scanlines_of(survey, road, *section, settings, lattice)


def margin_of_meshes(survey: Survey, road: int, lattice: ScanLattice) -> float:
    """m beyond the outer planes of a road within which points are part of their mesh."""
    margin = SCANLINE.max_rib
    for (number, _), mirror in lattice.mirror_phases.items():
        p = survey.frame.passes[number]
        if p.road == road:
            speed = np.diff(p.progress_at(p.time)).max(initial=0.0) / np.diff(p.time).min(initial=np.inf)
            margin = max(margin, SCANLINE.max_lines_ahead * mirror.spacing * min(speed, SCANLINE.max_speed) / abs(mirror.frequency))
    return margin + SCANLINE.max_edge


def _cut(records, p, key, mirror, planes, settings, intensity):
    """Scanlines of one pass and scanner."""
    lines = scanner_lines(records, p, mirror, settings.corridor, intensity)
    if lines is None:
        return Scanlines.none()
    ribs = Ribs.join([ribs_of(lines, p.direction, mirror, settings.interval), slanting_edges(lines, mirror, settings.interval)])
    rib, plane = _planes_through(ribs, planes)
    if not len(rib):
        return Scanlines.none()
    near = ribs.near.take(rib)
    point, ahead, share, along = ribs.point.take(rib), ribs.ahead.take(rib), ribs.share.take(rib), (plane - near) / (ribs.far.take(rib) - near)

    def crossed(values):
        first, last = values.take(point), values.take(ahead)
        last += share * (values.take(ahead + 1) - last)
        last -= first
        last *= along
        return first + last

    phase, d, z = (crossed(values) for values in (lines.phase, lines.d, lines.z))
    order = plane_order(plane - planes[0], phase if mirror.leftward else 1.0 - phase)
    plane, phase, d, z = (values.take(order) for values in (plane, phase, d, z))
    bright = np.zeros(len(d), np.float32) if lines.intensity is None else crossed(lines.intensity.astype(np.float64))[order].astype(np.float32)
    order, first = PlaneVertices.from_track(p, settings.interval, mirror, plane, phase, d, z).lines()
    if order is not None:
        plane, d, z, bright = plane[order], d[order], z[order], bright[order] if intensity else bright
    count = len(first) - 1
    scanlines = Scanlines(plane[first[:-1]] * settings.interval, np.full(count, key[0]), np.full(count, key[1]), first,
                          increasing(d, first), z, bright)
    return scanlines[np.diff(first) >= SCANLINE.min_plane_line_vertices]


def _planes_through(ribs, planes):
    """(rib, plane) of every intersection of a rib with one of the planes (first, last + 1)."""
    low = np.ceil(np.minimum(ribs.near, ribs.far)).astype(np.int64)
    count = np.ceil(np.maximum(ribs.near, ribs.far)).astype(np.int64)
    count -= low
    ribs_cut, planes_cut = [], []
    for ahead in range(int(count.max(initial=0))):
        # most ribs have one intersection
        members = np.flatnonzero(count > ahead) if ahead else np.arange(len(low))
        plane = low[members] + ahead if ahead else low
        inside = np.flatnonzero((plane >= planes[0]) & (plane < planes[1]) & (count[members] > ahead))
        ribs_cut.append(members[inside])
        planes_cut.append(plane[inside])
    return (np.concatenate(ribs_cut), np.concatenate(planes_cut)) if ribs_cut else (np.empty(0, np.int64),) * 2


# Scanlines from points near the section planes, where a cloud has no scan lattice to mesh.
#
# Spinning multi-beam scanners, thinned clouds and clouds without times have no scan lines. The points within a thin slice around each plane are
# binned across the road instead, and the lowest layer of every bin is the ground. Points above the ground are kept as separate lines: they show
# what hides a curb. The method is our own.


def point_scanlines(survey: Survey, road: int, start: float, end: float, interval: float, corridor: float) -> Scanlines:
    """Scanlines of the points near the section planes at k * interval, start <= k * interval < end.

    A slice holds the points within interval / 2 of its plane, or within SCANLINE.min_slice_length / 2 where that is more.

    start, end : m, stations
    interval : m between planes
    corridor : m either side of the reference line
    """
    first, last = int(np.ceil(start / interval - 1e-9)), int(np.ceil(end / interval - 1e-9))
    half = 0.5 * max(SCANLINE.min_slice_length, interval)
    if last <= first:
        return Scanlines.none()
    points = survey.window(road, first * interval - half - SCANLINE.slice_margin, (last - 1) * interval + half + SCANLINE.slice_margin)
    points = points[np.abs(points.d) < corridor]
    s, d = points.s, points.d
    h = points.z - expected_height(survey, road, s)
    key = points.pass_number.astype(np.int64) * 256 + points.scanner
    parts = []
    for value in np.unique(key):
        members = np.flatnonzero(key == value)
        rows, index = _slices(s[members], first, last, interval, half)
        index = members[index]
        # the row replaces the station, so that slices may overlap
        cells = pseudo_scan_lines(d[index], rows + 0.5, h[index], points.intensity[index].astype(float), (first, last), 1.0,
                                  SCANLINE.scanline_resolution, SCANLINE.slice_layer_jump, -corridor, corridor)
        for selected, quantile in ((cells.ground, 0.5), (~cells.ground & (cells.h > CURBS.min_occluder_height), 1.0)):
            row, across, height, intensity = _vertices(cells, np.flatnonzero(selected), quantile)
            parts.append(_joined(row, across, height, intensity, first, interval, int(value) // 256, int(value) % 256))
    lines = Scanlines.join(parts)
    if not len(lines):
        return lines
    lines.z = lines.z + np.repeat(expected_height(survey, road, lines.station), np.diff(lines.first))
    return lines[np.lexsort((lines.d[lines.first[:-1]], lines.scanner, lines.pass_number, np.rint(lines.station / interval)))]


def slice_lines(d: np.ndarray, z: np.ndarray, half_width: float) -> list[np.ndarray]:
    """The ground's scanline through one slice of points whose road is not known, for a look at it.

    d : (N,) m, offsets from the middle of the road, left positive
    z : (N,) m, heights
    half_width : m either side of the middle that are looked at

    Returns a list of (V, 2) offset and height, offsets increasing; a new line begins where the ground is interrupted
    """
    if not len(d):
        return []
    level = float(np.median(z))
    cells = pseudo_scan_lines(d, np.full(len(d), 0.5), z - level, np.zeros(len(d)), (0, 1), 1.0, SCANLINE.scanline_resolution,
                              SCANLINE.slice_layer_jump,
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
    cell_index = np.repeat(np.arange(len(cells.starts) - 1), np.diff(cells.starts))[selected]
    point, h = cells.point[selected], cells.h[selected]
    d, intensity = cells.u[point], cells.along[point]
    if not len(selected):
        return (np.empty(0, np.int64),) + (np.empty(0),) * 3
    begins = np.r_[True, np.diff(cell_index) > 0]
    first = np.flatnonzero(begins)
    cell = np.cumsum(begins) - 1
    lowest, highest = h[first], h[np.r_[first[1:], len(h)] - 1]
    noise = cells.noise[cell_index[first] // count]
    steep = (highest - lowest > np.maximum(SCANLINE.min_steep_rise, SCANLINE.steep_noise_sigmas * noise)) & (quantile < 1.0)
    level = np.where(steep[cell], np.floor((h - lowest[cell]) / SCANLINE.face_vertex_step), 0.0).astype(np.int64)
    begins = begins | np.r_[True, np.diff(level) != 0]
    start = np.flatnonzero(begins)
    number = np.diff(np.r_[start, len(h)])
    middle = start + np.floor(quantile * (number - 1) + 0.5).astype(np.int64)
    across, bright = np.add.reduceat(d, start) / number, np.add.reduceat(intensity, start) / number
    row, column = cell_index[start] // count, cell_index[start] % count
    # offsets increase to the left: upward on a face left of the road, downward on the right
    rise = np.where(column < count // 2, -1, 1) * level[start]
    order = np.lexsort((rise, column, row))
    return row[order], across[order], h[middle][order], bright[order]


def _joined(row, d, h, intensity, first, interval, pass_number, scanner):
    """Lines of consecutive vertices, split where these are far apart."""
    if not len(row):
        return Scanlines.none()
    gap, rise = np.where(np.diff(row) == 0, np.diff(d), np.inf), np.abs(np.diff(h))
    # a line straight across would be the face of a step that nobody saw
    hidden_face = (gap > np.maximum(CURBS.hidden_face_spacings * _spacing_beside(gap), CURBS.max_face_width)) & (rise > SCANLINE.min_steep_rise)
    new = np.r_[True, (gap > SCANLINE.max_vertex_gap) | (rise > 2 * SCANLINE.max_vertex_gap) | hidden_face]
    begins = np.flatnonzero(new)
    count = len(begins)
    # noise disorders the offsets on a face
    d = increasing(d, np.r_[begins, len(row)])
    lines = Scanlines((row[begins] + first) * interval, np.full(count, pass_number), np.full(count, scanner),
                      np.r_[begins, len(row)], d, h, intensity.astype(np.float32))
    return lines[np.diff(lines.first) >= SCANLINE.min_slice_line_vertices]


def _spacing_beside(gap):
    """(N,) m, mean of a few gaps between vertices before or behind each of (N,) gaps, where they are wider."""
    count = SCANLINE.min_cells_behind
    means = np.lib.stride_tricks.sliding_window_view(np.abs(np.pad(gap, count, constant_values=np.inf)), count).mean(1)
    return np.maximum(means[:len(gap)], means[count + 1:])
