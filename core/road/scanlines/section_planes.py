"""Normalized scanlines: the mesh of the scan lattice intersected with planes across the road.

A plane perpendicular to the reference line of the road has one station in the road frame. The ribs of the mesh are
intersected at the stations of the planes, and neighbouring intersections are connected. Planes do not intersect each
other within the road, because the frame limits the offset by the radius of the bend.

References
----------
The paper on normalized scanlines (ISPRS Archives, 2020), section 2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...execution.phase import Phase
from ...survey.lattice.scan_lattice import ScanLattice, find_lattice, scanner_runs
from ..common.sides import fixed_sections
from .from_points import MIN_SLICE_LENGTH, point_scanlines
from .grid import Scanlines
from .mesh import MAX_EDGE, MAX_LINES_AHEAD, MAX_RIB, PlaneVertices, Ribs, increasing, plane_order, ribs_of, scanner_lines, slanting_edges

if TYPE_CHECKING:
    from ...survey.open_survey import Survey
    from ..common.decimation import LevelStrip

MIN_PLANE_LINE_VERTICES = 2  # vertices of a line
MAX_SPEED = 60.0             # m/s: faster is an error of the trajectory


@dataclass(frozen=True)
class ScanlineSettings:
    """Section planes.

    Attributes
    ----------
    interval : m between section planes
    corridor : m either side of the reference line of the road
    rotation_frequency : Hz, scan lines per second of each scanner; 0 = from the data
    """

    interval: float = setting(0.10, 0.01, 10.0, "The interval", "m")
    corridor: float = setting(15.0, 5.0, 100.0, "The corridor", "m")
    rotation_frequency: float = setting(0.0, 5.0, 400.0, "The rotation frequency", "Hz", "to take it from the data")

    def __post_init__(self):
        """Check the limits of all settings."""
        check_limits(self)


def scanlines_of(survey: Survey, road: int, start: float, end: float, settings: ScanlineSettings = ScanlineSettings(),
                 lattice: ScanLattice | None = None) -> Scanlines:
    """The normalized scanlines of the planes with start <= station < end.

    Parameters
    ----------
    survey : Survey
    road : number of the road
    start, end : m; planes lie at whole multiples of the interval
    settings : ScanlineSettings
    lattice : ScanLattice of the survey, or None to find it here

    Returns
    -------
    Scanlines; of scanners without a lattice those of the points near the planes
    """
    lines = Scanlines.join(scanline_runs(survey, road, start, end, settings, lattice))
    if not len(lines):
        return lines
    order = np.lexsort((lines.d[lines.first[:-1]], lines.scanner, lines.pass_number, np.rint(lines.station / settings.interval)))
    return lines if (np.diff(order) == 1).all() else lines[order]


def scanline_runs(survey: Survey, road: int, start: float, end: float, settings: ScanlineSettings = ScanlineSettings(),
                  lattice: ScanLattice | None = None, intensity: bool = True, level: Callable[[int,
                  float, float], LevelStrip | None] | None = None) -> list[Scanlines]:
    """The normalized scanlines of the planes with start <= station < end, apart for each pass and scanner.

    Parameters
    ----------
    survey, road, start, end, settings, lattice : as in `scanlines_of`
    intensity : whether intensities are computed; else they are 0
    level : function of pass number, start and end (m) that returns the LevelStrip to be left out; None uses all points

    Returns
    -------
    list of Scanlines
    """
    interval = settings.interval
    first, last = int(np.ceil(start / interval - 1e-9)), int(np.ceil(end / interval - 1e-9))
    if last <= first:
        return []
    if lattice is None:
        lattice = find_lattice(survey, settings.rotation_frequency)
    parts, apart = [], not lattice.mirror_phases
    if lattice.mirror_phases:
        margin = max(_margin(survey, road, lattice), MIN_SLICE_LENGTH, interval)
        window = first * interval - margin, (last - 1) * interval + margin
        records = survey.window(road, *window).records
        for key, own in scanner_runs(records):
            mirror = lattice.mirror_phases.get(key)
            apart |= mirror is None
            if mirror is not None:
                parts.append(_cut(own, survey.frame.passes[key[0]], key, mirror, (first, last), settings, intensity,
                                  None if level is None else level(key[0], *window)))
    if apart:
        lines = point_scanlines(survey, road, start, end, interval, settings.corridor)
        meshed = [key in lattice.mirror_phases for key in zip(lines.pass_number.tolist(), lines.scanner.tolist())]
        parts += lines[~np.array(meshed, bool)].runs()
    return [part for part in parts if len(part)]


def all_scanlines(survey: Survey, road: int, settings: ScanlineSettings = ScanlineSettings(), lattice: ScanLattice | None = None,
                  progress: Progress = Progress()) -> Iterator[Scanlines]:
    """The normalized scanlines of a whole road, section by section; sections are computed in parallel.

    Parameters
    ----------
    survey, road, settings, lattice : as in `scanlines_of`
    progress : Progress

    Yields
    ------
    Scanlines, in order of station
    """
    if lattice is None:
        lattice = find_lattice(survey, settings.rotation_frequency)
    start, end = survey.store.span(road)
    interval = settings.interval
    sections = fixed_sections(int(np.floor(start / interval)), int(np.ceil(end / interval)) + 1, interval)

    phase = Phase(scanlines_of_section, survey, (road, settings, lattice), lambda section: survey.stretch(road, *section),
                  lambda section: survey.store.points_between(road, *section), Scanlines.join)
    yield from survey.executor.run(phase, [(a * interval, b * interval) for a, b in sections], progress)


def scanlines_of_section(survey: Survey, section: tuple[float, float], road: int, settings: ScanlineSettings, lattice: ScanLattice) -> Scanlines:
    """The phase of normalized scanlines: those of one section, (start, end) in metres of station, of a road; else as in `scanlines_of`."""
    return scanlines_of(survey, road, *section, settings, lattice)


def _margin(survey, road, lattice):
    """m beyond the outer planes within which points are part of their mesh."""
    margin = MAX_RIB
    for (number, _), mirror in lattice.mirror_phases.items():
        p = survey.frame.passes[number]
        if p.road == road:
            speed = np.diff(p.progress_at(p.time)).max(initial=0.0) / np.diff(p.time).min(initial=np.inf)
            margin = max(margin, MAX_LINES_AHEAD * mirror.spacing * min(speed, MAX_SPEED) / abs(mirror.frequency))
    return margin + MAX_EDGE


def _cut(records, p, key, mirror, planes, settings, intensity, level):
    """Scanlines of one pass and scanner."""
    lines = scanner_lines(records, p, mirror, settings.corridor, level, intensity)
    if lines is None:
        return Scanlines.none()
    ribs = Ribs.joined([ribs_of(lines, p.direction, mirror, settings.interval), slanting_edges(lines, mirror, settings.interval)])
    rib, plane = _planes_through(ribs, planes)
    if not len(rib):
        return Scanlines.none()
    near = ribs.near.take(rib)
    crossed = Crossings(ribs.point.take(rib), ribs.ahead.take(rib), ribs.share.take(rib), (plane - near) / (ribs.far.take(rib) - near))
    phase, d, z = (crossed.of(values) for values in (lines.phase, lines.d, lines.z))
    order = plane_order(plane - planes[0], phase if mirror.leftward else 1.0 - phase)
    plane, phase, d, z = (values.take(order) for values in (plane, phase, d, z))
    bright = np.zeros(len(d), np.float32) if lines.intensity is None else crossed.of(lines.intensity.astype(np.float64))[order].astype(np.float32)
    order, first = PlaneVertices.from_track(p, settings.interval, mirror, plane, phase, d, z).lines()
    if order is not None:
        plane, d, z, bright = plane[order], d[order], z[order], bright[order] if intensity else bright
    count = len(first) - 1
    found = Scanlines(plane[first[:-1]] * settings.interval, np.full(count, key[0]), np.full(count, key[1]), first,
                      increasing(d, first), z, bright)
    return found[np.diff(first) >= MIN_PLANE_LINE_VERTICES]


def _planes_through(ribs, planes):
    """(rib, plane) of every intersection of a rib with one of the planes (first, last + 1)."""
    low = np.ceil(np.minimum(ribs.near, ribs.far)).astype(np.int64)
    count = np.ceil(np.maximum(ribs.near, ribs.far)).astype(np.int64)
    count -= low
    ribs_cut, planes_cut = [], []
    for ahead in range(int(count.max(initial=0))):
        # most ribs have one intersection
        again = np.flatnonzero(count > ahead) if ahead else np.arange(len(low))
        plane = low[again] + ahead if ahead else low
        inside = np.flatnonzero((plane >= planes[0]) & (plane < planes[1]) & (count[again] > ahead))
        ribs_cut.append(again[inside])
        planes_cut.append(plane[inside])
    return (np.concatenate(ribs_cut), np.concatenate(planes_cut)) if ribs_cut else (np.empty(0, np.int64),) * 2


@dataclass
class Crossings:
    """M intersections of planes with ribs.

    Attributes
    ----------
    point, ahead, share : (M,) of the ribs, as in Ribs
    along : (M,) 0 to 1, place of the intersection on the rib
    """

    point: np.ndarray
    ahead: np.ndarray
    share: np.ndarray
    along: np.ndarray

    def of(self, values: np.ndarray) -> np.ndarray:
        """(M,) values at the intersections, interpolated from the (N,) values of the points."""
        near, ahead = values.take(self.point), values.take(self.ahead)
        ahead += self.share * (values.take(self.ahead + 1) - ahead)
        ahead -= near
        ahead *= self.along
        return near + ahead
