"""Normalized scanlines: the mesh of the scan lattice cut by planes across the road.

A plane perpendicular to the road's reference line is, in the road frame, a station. The ribs of the
mesh are cut at the stations of the planes, and what lies side by side at the mirror's phase is joined.
Planes never meet within the road, since the frame limits the offset by the bend's radius.

References
----------
The scanline paper (ISPRS Archives, 2020), section 2.
"""

from dataclasses import dataclass

import numpy as np

from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...survey.lattice.scan_lattice import find_lattice, scanner_runs
from ..common.sides import BLOCK_SECTION_LENGTH
from .from_points import MIN_SLICE_LENGTH, point_scanlines
from .mesh import MAX_EDGE, MAX_LINES_AHEAD, MAX_RIB, PlaneVertices, Ribs, increasing, plane_order, ribs_of, scanner_lines, slanting_edges
from .scanlines import Scanlines

MIN_PLANE_LINE_VERTICES = 2  # vertices of a line


@dataclass(frozen=True)
class ScanlineSettings:
    """Where planes are laid.

    interval : m between section planes
    corridor : m either side of the road's reference line
    rotation_frequency : Hz, scan lines per second of each scanner; 0 = from the data
    """

    interval: float = setting(0.10, 0.01, 10.0, "The interval", "m")
    corridor: float = setting(15.0, 5.0, 100.0, "The corridor", "m")
    rotation_frequency: float = setting(0.0, 5.0, 400.0, "The rotation frequency", "Hz", "to take it from the data")

    def __post_init__(self):
        check_limits(self)


def scanlines_of(survey, road, start, end, settings=ScanlineSettings(), lattice=None):
    """The normalized scanlines of planes with start <= station < end.

    Parameters
    ----------
    survey : Survey
    road : number
    start, end : metres; planes lie at whole multiples of the interval
    settings : ScanlineSettings
    lattice : ScanLattice of the survey; found here where it is not given

    Returns
    -------
    Scanlines: where a scanner has no lattice, those of the points near the planes
    """
    lines = Scanlines.join(scanline_runs(survey, road, start, end, settings, lattice))
    if not len(lines):
        return lines
    order = np.lexsort((lines.d[lines.first[:-1]], lines.scanner, lines.pass_number, np.rint(lines.station / settings.interval)))
    return lines if (np.diff(order) == 1).all() else lines[order]


def scanline_runs(survey, road, start, end, settings=ScanlineSettings(), lattice=None, intensity=True, level=None):
    """The scanlines of `scanlines_of` as a list, each of one pass and scanner.

    intensity : whether theirs is wanted, else it is 0
    level : function of pass number, start and end (metres): the LevelStrip that the mesh leaves out; None leaves nothing out
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
            clock = lattice.mirror_phases.get(key)
            apart |= clock is None
            if clock is not None:
                parts.append(_cut(own, survey.frame.passes[key[0]], key, clock, (first, last), settings, intensity,
                                  None if level is None else level(key[0], *window)))
    if apart:
        lines = point_scanlines(survey, road, start, end, interval, settings.corridor)
        meshed = [key in lattice.mirror_phases for key in zip(lines.pass_number.tolist(), lines.scanner.tolist())]
        parts += lines[~np.array(meshed, bool)].runs()
    return [part for part in parts if len(part)]


def all_scanlines(survey, road, settings=ScanlineSettings(), lattice=None, progress=Progress()):
    """Yield the Scanlines of a whole road, section by section in order of station; sections are worked side by side."""
    if lattice is None:
        lattice = find_lattice(survey, settings.rotation_frequency)
    start, end = survey.store.span(road)
    bounds = np.linspace(start, end, max(int(np.ceil((end - start) / BLOCK_SECTION_LENGTH)), 1) + 1)

    def work(section):
        return scanlines_of(survey, road, *section, settings, lattice)

    yield from ordered_map(work, list(zip(bounds[:-1].tolist(), bounds[1:].tolist())), progress)


def _margin(survey, road, lattice):
    """m beyond the outer planes within which points have a part in them."""
    margin = MAX_RIB
    for (number, _), clock in lattice.mirror_phases.items():
        p = survey.frame.passes[number]
        if p.road == road:
            speed = np.diff(p.progress_at(p.time)).max(initial=0.0) / np.diff(p.time).min(initial=np.inf)
            margin = max(margin, MAX_LINES_AHEAD * clock.spacing * min(speed, 60.0) / abs(clock.frequency))
    return margin + MAX_EDGE


def _cut(records, p, key, clock, planes, settings, intensity, level):
    """Scanlines of one pass and scanner."""
    lines = scanner_lines(records, p, clock, settings.corridor, level)
    if lines is None:
        return Scanlines.none()
    ribs = Ribs.joined([ribs_of(lines, p.direction, clock, settings.interval), slanting_edges(lines, clock, settings.interval)])
    rib, plane = _planes_through(ribs, planes)
    if not len(rib):
        return Scanlines.none()
    near = ribs.near[rib]
    crossed = Crossings(ribs.point[rib], ribs.ahead[rib], ribs.share[rib], (plane - near) / (ribs.far[rib] - near))
    phase, d, z = (crossed.of(values) for values in (lines.phase, lines.d, lines.z))
    order = plane_order(plane - planes[0], phase if clock.leftward else 1.0 - phase)
    plane, phase, d, z = (values[order] for values in (plane, phase, d, z))
    bright = crossed.of(lines.intensity.astype(np.float64))[order].astype(np.float32) if intensity else np.zeros(len(d), np.float32)
    order, first = PlaneVertices.seen_from(p, settings.interval, clock, plane, phase, d, z).lines()
    if order is not None:
        plane, d, z, bright = plane[order], d[order], z[order], bright[order] if intensity else bright
    count = len(first) - 1
    found = Scanlines(plane[first[:-1]] * settings.interval, np.full(count, key[0]), np.full(count, key[1]), first,
                      increasing(d, first), z, bright)
    return found[np.diff(first) >= MIN_PLANE_LINE_VERTICES]


def _planes_through(ribs, planes):
    """(rib, plane) of every plane that cuts a rib, among planes (first, last + 1)."""
    low = np.ceil(np.minimum(ribs.near, ribs.far)).astype(np.int64)
    count = np.ceil(np.maximum(ribs.near, ribs.far)).astype(np.int64)
    count -= low
    ribs_cut, planes_cut, some = [], [], None
    for ahead in range(int(count.max(initial=0))):
        # most ribs are cut once
        some = np.flatnonzero(count > ahead) if ahead else np.arange(len(low))
        plane = low[some] + ahead if ahead else low
        inside = np.flatnonzero((plane >= planes[0]) & (plane < planes[1]) & (count[some] > ahead))
        ribs_cut.append(some[inside])
        planes_cut.append(plane[inside])
    return (np.concatenate(ribs_cut), np.concatenate(planes_cut)) if ribs_cut else (np.empty(0, np.int64),) * 2


@dataclass
class Crossings:
    """Where planes cut ribs: a share `along` of each."""

    point: np.ndarray
    ahead: np.ndarray
    share: np.ndarray
    along: np.ndarray

    def of(self, values):
        """Values at the crossings, from those of the points."""
        near, ahead = values[self.point], values[self.ahead]
        ahead += self.share * (values[self.ahead + 1] - ahead)
        ahead -= near
        ahead *= self.along
        return near + ahead
