"""Corners of curbs on normalized scanlines, and boundary lines through them.

Every section of the road is searched for each side, pass and scanner alone. Corners that agree are merged. The others
remain until corners are linked along the road, by the same rules as in the method of profiles.

References
----------
The paper on normalized scanlines (ISPRS Archives, 2020), section 3 and table 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...execution.phase import THREADS, Executor, Phase, Recipe
from ...survey.blocks import sensor_height_of
from ...survey.lattice.scan_lattice import ScanLattice, find_lattice
from ...survey.weights import READING
from ..common.curb_points import CurbPoints, curb_points_at
from ..common.occlusion import OcclusionGrid
from ..common.sides import SIDE_SIGNS, OutermostTrack, expected_height, fixed_sections, hidden_points, join_sections
from ..common.tracking import SideChains, curb_chains, drop_short_curbs, link_apart, select_along_road, with_pieces_in_line
from ..edges.fit import EdgeCurve, without_outliers
from ..edges.road_edges import EdgePiece, RoadEdges, edge_sigma, joined_pieces
from ..profiles.detect import block_bounds, block_numbers
from ..weights import CURBS, EDGE, PROFILE, SCANLINE
from .candidates import ScanlineBoundarySettings, find_candidates, gap_fill_rows, samples_near
from .corners import CurbCorners, corners_of, plane_fit_rows
from .grid import LINE_SEPARATION, Scanlines, height_grid, nearest_distance
from .section_planes import ScanlineSettings, scanline_runs

if TYPE_CHECKING:
    from ...survey.frame.road_frame import RoadFrame
    from ...survey.survey import Survey
    from ..common.decimation import LevelGround


_POINT = [("s", float), ("d", float), ("x", float), ("y", float), ("z", float), ("height", float), ("chain", int),
          ("support", int)]


def curbs_from_scanlines(source: SurveyScanlines | LayerScanlines, settings: ScanlineBoundarySettings = ScanlineBoundarySettings(),
                         block_length: float = 0.0, progress: Progress = Progress(),
                         beside: dict[int, dict[str, OcclusionGrid]] | None = None,
                         side_chains: dict[tuple[int, str], SideChains] | None = None) -> CurbPoints:
    """Bottom and top corners of the curb on each side of every road, one of each per block.

    Parameters
    ----------
    source : SurveyScanlines or LayerScanlines
    settings : ScanlineBoundarySettings
    block_length : m of road per corner; 0 = 0.5 to 2.0, shorter in sharp bends
    progress : Progress
    beside : is given what was seen beside each road: number of the road -> side -> OcclusionGrid
    side_chains : is given all chains that were found: (number of the road, side) -> SideChains

    Returns
    -------
    CurbPoints, `part` bottom or top. Those of status `occluded` mark places where an object hides the curb.
    """
    parts, side_chains = [], {} if side_chains is None else side_chains
    roads = source.roads()
    for i, road in enumerate(roads):
        part = progress.part(i / len(roads), (i + 1) / len(roads))
        corners, occlusion = _corners_of_road(source, road, settings, part)
        if beside is not None:
            beside[road] = occlusion
        for side in SIDE_SIGNS:
            if corners[side] is not None and len(corners[side]):
                known = side_chains[road, side] = _chains_of_side(source, road, corners[side], settings, block_length)
                parts.append(_points_of_side(source, road, side, known, occlusion[side]))
    found = CurbPoints.join(parts, source.crs)
    measured, hidden = (np.count_nonzero((found.part == "bottom") & (found.status == status)) for status in ("measured", "occluded"))
    progress.info(f"Corners of curbs: {measured:,} measured on scanlines, {hidden:,} hidden by objects.")
    return found


def _corners_of_road(source, road, settings, progress):
    """Corners of each side, merged over passes and scanners where they agree, and what was measured beside the road."""
    interval = source.interval
    start, end = source.span(road)
    sections = fixed_sections(int(np.floor(start / interval)), int(np.ceil(end / interval)) + 1, interval)
    first, last = sections[0][0], sections[-1][1]
    occlusion = {side: OcclusionGrid(interval, first, last - first, CURBS.max_curb_offset) for side in SIDE_SIGNS}
    phase = Phase(corners_of_section, source, (road, settings), lambda section: source.stretch(road, *(k * interval for k in section)),
                  lambda section: source.points_between(road, *(k * interval for k in section)), join_sections, CURBS.sections_together)
    parts = {side: [] for side in SIDE_SIGNS}
    for found, beside in source.executor.run(phase, sections, progress):
        for side, corners in found.items():
            parts[side].append(corners)
        for side, seen in beside.items():
            occlusion[side].add(seen)
    return {side: _with_scanner_noise(CurbCorners.join(found)) if found else None for side, found in parts.items()}, occlusion


def corners_of_section(source: SurveyScanlines | LayerScanlines, section: tuple[int, int], road: int,
                       settings: ScanlineBoundarySettings) -> tuple[dict[str, CurbCorners], dict[str, OcclusionGrid]]:
    """The phase of scanlines: corners in one section of a road.

    Parameters
    ----------
    source : SurveyScanlines or LayerScanlines
    section : (first, last + 1) numbers of planes
    road : number of the road
    settings : ScanlineBoundarySettings

    Returns
    -------
    corners : side -> CurbCorners, merged over passes and scanners where they agree
    occlusion : side -> OcclusionGrid of these planes
    """
    interval, (begin, end) = source.interval, section
    margin = max(plane_fit_rows(interval, settings), SCANLINE.neighbour_lines + gap_fill_rows(interval)) + 1
    tracks = {side: OutermostTrack(source.frame, road, sign) for side, sign in SIDE_SIGNS.items()}
    occlusion = {side: OcclusionGrid(interval, begin, end - begin, CURBS.max_curb_offset) for side in SIDE_SIGNS}
    rows = begin - margin, end + margin
    stations = np.arange(*rows) * interval
    nearest = {side: tracks[side](stations) + PROFILE.min_track_distance for side in SIDE_SIGNS}
    found: dict[str, list[CurbCorners]] = {side: [] for side in SIDE_SIGNS}
    for lines in source.runs(road, (rows[0] - 0.5) * interval, (rows[1] - 0.5) * interval):
        heights = lines.z - np.repeat(expected_height(source, road, lines.station), np.diff(lines.first))
        grid = height_grid(lines, heights, rows, interval, min(CURBS.max_curb_offset, source.corridor), settings.clipping_height)
        closed = grid.closed(gap_fill_rows(interval))
        tall = _tall(lines, heights, interval)
        candidates, strip = {}, _level_beside(source, road, int(lines.pass_number[0]), stations[margin:-margin])
        for side, sign in SIDE_SIGNS.items():
            origin = np.floor(nearest[side].min())
            outward = grid.outward(sign, origin)
            occlusion[side].add_points(sign * tall[0], tall[1], tall[2], section, outward.part(margin, margin + end - begin))
            if strip is not None:
                occlusion[side].add_level_ground(section, *strip[sign])
            of_side = find_candidates(closed.outward(sign, origin), outward.low, nearest[side], settings)
            candidates[side] = of_side[(of_side.row >= margin) & (of_side.row < margin + end - begin)]
        for side, corners in _corners(lines, heights, rows, interval, candidates, settings):
            found[side].append(corners)
    return {side: merged_corners(parts) for side, parts in found.items() if parts}, occlusion


def _level_beside(source, road, number, stations):
    """{sign of the side: (nearest, farthest, height)} of the ground left out beside the track of a pass, (R,) m each."""
    if source.level is None:
        return None
    low, high, height = source.level(road, number, stations[0], stations[-1] + source.interval).at(stations)
    height = height - expected_height(source, road, stations)
    return {1: (low, high, height), -1: (-high, -low, height)}


def _tall(lines, heights, interval):
    """(d, s, h) of the vertices of objects that can hide a curb."""
    vertex = np.flatnonzero(heights > CURBS.min_occluder_height)
    line = np.searchsorted(lines.first, vertex, side="right") - 1
    return lines.d[vertex], lines.station[line] + 0.5 * interval, heights[vertex]


def _corners(lines, heights, rows, interval, candidates, settings):
    """Yield (side, corners of its candidates) of one pass and scanner."""
    if not any(map(len, candidates.values())):
        return
    places = (np.concatenate([c.row for c in candidates.values()]), np.concatenate([SIDE_SIGNS[side] * c.u for side, c in candidates.items()]))
    samples = samples_near(lines, heights, rows, interval, places, settings.distance_across, plane_fit_rows(interval, settings),
                           settings.clipping_height)
    for side, of_side in candidates.items():
        if len(of_side):
            yield side, corners_of(samples.outward(SIDE_SIGNS[side]), of_side, settings)


def merged_corners(found: Sequence[CurbCorners]) -> CurbCorners:
    """One corner where several passes or scanners measured the same one: their mean, weighted by support.

    Parameters
    ----------
    found : CurbCorners of each pass and scanner

    Returns
    -------
    CurbCorners
    """
    upright, sloped = (_merged([part[part.sloped == kind] for part in found]) for kind in (False, True))
    # where one pass or scanner shows an upright face, what others show less sharply is no other curb
    around = np.arange(-SCANLINE.neighbour_lines, SCANLINE.neighbour_lines + 1)[:, None]
    keys = ((upright.profile + around) * LINE_SEPARATION + upright.u).ravel()
    sloped = sloped[nearest_distance(sloped.profile * LINE_SEPARATION + sloped.u, keys) > SCANLINE.same_curb_distance]
    return CurbCorners.join([upright, sloped])


def _merged(found):
    """The mean of corners that lie beside each other in one plane, weighted by support."""
    corners = CurbCorners.join(found)
    if len(found) < 2 or not len(corners):
        return corners
    corners = corners[np.lexsort((corners.u, corners.profile))]
    apart = (np.diff(corners.profile) > 0) | (np.diff(corners.u) > PROFILE.pass_merge_across) \
        | (np.abs(np.diff(corners.h)) > PROFILE.pass_merge_height)
    group = np.r_[0, np.cumsum(apart)]
    weight = np.sqrt(np.maximum(corners.support, 1))
    total = np.bincount(group, weight)
    values = {name: np.bincount(group, weight * getattr(corners, name)) / total
              for name in ("s", "u", "h", "skew", "height", "run", "noise", "scanner_noise", "top_u", "top_h", "residual")}
    return CurbCorners(profile=corners.profile[np.r_[True, apart]], **values, sloped=corners.sloped[np.r_[True, apart]],
                       support=np.bincount(group, corners.support).astype(np.int64),
                       behind=np.bincount(group, corners.behind).astype(np.int64))


def _with_scanner_noise(corners):
    """The corners with `scanner_noise` set to the median noise of this road."""
    if len(corners):
        corners.scanner_noise = np.full(len(corners), np.clip(np.median(corners.noise), CURBS.min_scanner_noise, SCANLINE.max_usual_noise))
    return corners


def _chains_of_side(source, road, corners, settings, block_length):
    """The SideChains of the corners of one side of one road."""
    edges = block_bounds(source.frame.road(road), *source.span(road), block_length)
    chains = curb_chains(corners, link_apart(corners, source.interval, ~corners.sloped), source.interval, settings.limits)
    return SideChains(corners, chains, lambda members, number: _block_points(members, edges, number))


def _points_of_side(source, road, side, known, occlusion):
    """The bottom and top corners of one side of one road, measured and hidden, sorted by station."""
    frame, sign, corners, chains = source.frame, SIDE_SIGNS[side], known.steps, known.chains
    track = OutermostTrack(frame, road, sign)
    stretches = drop_short_curbs(select_along_road(chains, corners, track), chains, corners)
    stretches = with_pieces_in_line(stretches, chains, corners, lambda s, u: frame.road(road).to_map(s, sign * u))
    rows = [row for number, part in enumerate(stretches) for row in known.points(part, number)]
    bottoms = np.array([(r["s"], r["u"], r["h"]) for r in rows if r["fields"]["part"] == "bottom"]).reshape(-1, 3)
    rows += [{**r, "fields": dict(r["fields"], part="bottom")} for r in hidden_points(bottoms, occlusion, track)]
    rows.sort(key=lambda r: (r["s"], r["fields"]["part"]))
    s, u, h = (np.array([r[name] for r in rows], float) for name in ("s", "u", "h"))
    x, y, z = frame.to_map(road, s, sign * u, h + expected_height(source, road, s))
    return curb_points_at(frame, road, (x, y, z), [row["fields"] for row in rows], side=side, station=s, offset=sign * u)


def _block_points(corners, edges, chain):
    """A bottom and a top corner per block: the means of the corners of one line."""
    if not len(corners):
        return []
    names, member = np.unique(block_numbers(corners, edges), return_inverse=True)
    n = np.bincount(member)
    mean = {name: np.bincount(member, getattr(corners, name)) / n for name in ("s", "u", "h", "top_u", "top_h", "height")}
    deviation = corners.u - np.interp(corners.s, mean["s"], mean["u"])
    residual, support = np.sqrt(np.bincount(member, deviation**2) / n), np.bincount(member, corners.support)
    rows = []
    for k in range(len(names)):
        fields = dict(status="measured", height=round(float(mean["height"][k]), 4), chain=chain,
                      residual=round(float(residual[k]), 4), support=int(support[k]))
        for part, u, h in (("bottom", "u", "h"), ("top", "top_u", "top_h")):
            rows.append(dict(s=float(mean["s"][k]), u=float(mean[u][k]), h=float(mean[h][k]), fields=dict(fields, part=part)))
    return rows


def boundary_lines(corners: CurbPoints, frame: RoadFrame, max_gap: float, progress: Progress = Progress()) -> RoadEdges:
    """Smooth lines through corners, separately for bottoms and tops.

    Parameters
    ----------
    corners : CurbPoints with `part` bottom or top
    frame : RoadFrame
    max_gap : m between corners that are connected
    progress : Progress

    Returns
    -------
    RoadEdges along the road, one piece for each stretch of one status:
    measured, bridged (a gap between corners), or occluded (a gap where an object hides the curb). The pieces of one
    line share their end vertices and `chain`.
    """
    pieces: list[EdgePiece] = []
    number = 0
    for road in frame.roads:
        for side in SIDE_SIGNS:
            own = corners[(corners.road == road.number) & (corners.side == side)]
            hidden = np.sort(own.station[own.status == "occluded"])
            for part in ("bottom", "top"):
                for points, status in _pieces(_points(own[own.part == part], frame), hidden, max_gap):
                    passes = frame.passes_sigma(road.number, points["s"])
                    _draw(pieces, points, status, passes, road=road.number, side=side, part=part, chain=number)
                    number += 1
    lines = joined_pieces(pieces, frame, corners.crs)
    length = {part: lines.length[lines.part == part].sum() for part in ("bottom", "top")}
    progress.info(f"Boundaries: {length['bottom']:.0f} m of bottom lines and {length['top']:.0f} m of top lines.")
    progress.report(1.0)
    return lines


def _points(corners, frame):
    """The measured corners of one kind in map coordinates, sorted by station."""
    measured = corners[corners.status == "measured"]
    points, (x, y, z) = np.empty(len(measured), dtype=_POINT), measured.map_places(frame).T
    for name, values in dict(s=measured.station, d=measured.offset, x=x, y=y, z=z, height=np.nan_to_num(measured.height),
                             chain=measured.chain, support=measured.support).items():
        points[name] = values
    return without_outliers(points[np.argsort(points["s"], kind="stable")])


def _pieces(points, hidden, max_gap):
    """Points of connected lines: list of (points, status of the gap between each point and the next)."""
    if len(points) < 2:
        return []
    gap, across = np.diff(points["s"]), np.abs(np.diff(points["d"]))
    near = gap <= SCANLINE.max_measured_gap
    joined = (near | (gap <= max_gap)) & (across <= EDGE.max_edge_jump + EDGE.max_edge_skew * gap)
    covered = CURBS.hidden_point_spacing * (np.searchsorted(hidden, points["s"][1:]) - np.searchsorted(hidden, points["s"][:-1], side="right"))
    status = np.where(near, "measured", np.where(covered >= EDGE.min_hidden_share * gap, "occluded", "bridged"))
    breaks = np.flatnonzero(~joined) + 1
    parts = zip(np.split(points, breaks), np.split(np.append(status, ""), breaks))
    return [(part, flags[:-1]) for part, flags in parts if len(part) >= 2 and part["s"][-1] - part["s"][0] >= EDGE.min_edge_length]


def _draw(pieces, points, status, passes, **fields):
    """Add the pieces of one line."""
    curve = EdgeCurve(points)
    bounds = np.r_[0, np.flatnonzero(status[1:] != status[:-1]) + 1, len(points) - 1]
    for i, j in zip(bounds[:-1], bounds[1:]):
        a, b = curve.t[i], curve.t[j]
        along = np.linspace(a, b, max(int(np.ceil((b - a) / EDGE.edge_vertex_spacing)), 1) + 1)
        vertices, rows = curve.at(along), points[i:j + 1]
        pieces.append(EdgePiece(vertices, status=str(status[i]), station=float(rows["s"][0]), end=float(rows["s"][-1]),
                                length=float(np.hypot(*np.diff(vertices[:, :2], axis=0).T).sum()), height=float(np.median(rows["height"])),
                                rmse=float(np.sqrt(np.mean(curve.residual[i:j + 1] ** 2))),
                                sigma=edge_sigma(along, curve.t, curve.residual, points["support"], passes=np.interp(along, curve.t, passes)),
                                **fields))


# Sources of normalized scanlines: sections of a survey, computed on demand, or a layer.

class SurveyScanlines:
    """The scanlines of a survey, computed on demand.

    Parameters
    ----------
    survey : Survey
    settings : ScanlineSettings
    sensor_height : m from the trajectory down to the road, 0 = from the data
    lattice : ScanLattice, or None to find it here
    progress : Progress of finding it
    level : LevelGround that is left out; None uses all points

    Attributes
    ----------
    frame : RoadFrame
    crs : WKT
    interval, corridor : m, of the settings
    """

    def __init__(self, survey: Survey, settings: ScanlineSettings = ScanlineSettings(), sensor_height: float = 0.0,
                 lattice: ScanLattice | None = None, progress: Progress = Progress(), level: LevelGround | None = None):
        self.settings, self.sensor_height, self.level = settings, sensor_height, level
        self.survey, self.interval, self.corridor = survey, self.settings.interval, self.settings.corridor
        self.lattice = find_lattice(survey, self.settings.rotation_frequency, progress) if lattice is None else lattice
        self.frame, self.crs = survey.frame, survey.crs

    @property
    def executor(self) -> Executor:
        """Who runs the phases that read these scanlines."""
        return self.survey.executor

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the scanlines."""
        level = None if self.level is None else self.level.recipe(folder)
        return Recipe("core.road.scanlines.detect:SurveyScanlines", dict(survey=self.survey.recipe(folder), settings=self.settings, level=level,
                                                                    sensor_height=self.sensor_height, lattice=self.lattice))

    def stretch(self, road: int, start: float, end: float) -> str:
        """What messages call the road between two stations, m."""
        return self.survey.stretch(road, start, end)

    def points_between(self, road: int, start: float, end: float) -> int:
        """About how many points lie between two stations (m)."""
        return self.survey.store.points_between(road, start, end)

    def roads(self) -> list[int]:
        """Numbers of the roads."""
        return self.survey.store.roads()

    def span(self, road: int) -> tuple[float, float]:
        """Stations at which a road begins and ends, m."""
        return self.survey.store.span(road)

    def road_height(self, road: int, s: np.ndarray) -> np.ndarray:
        """Expected local z of the road at (N,) stations, (N,) m."""
        if self.sensor_height:
            return self.frame.track_height(road, s) - self.sensor_height
        return self.survey.road_height(road, s)

    def runs(self, road: int, start: float, end: float) -> list[Scanlines]:
        """The scanlines with start <= station < end, apart for each pass and scanner; their intensity is 0."""
        level = None if self.level is None else partial(self.level, road)
        return scanline_runs(self.survey, road, start, end, self.settings, self.lattice, intensity=False, level=level)


class LayerScanlines:
    """The scanlines of a layer, in the road frame of the trajectory they were made with.

    Parameters
    ----------
    lines : dict of road number to Scanlines, each sorted by station
    frame : RoadFrame
    interval : m between section planes
    crs : WKT
    sensor_height : m from the trajectory down to the road, 0 = from the data

    Attributes
    ----------
    frame, interval, crs : as given
    corridor : m, greatest offset of a vertex
    level : None; all points are used

    Raises
    ------
    RoadExtractionError
        If no road has scanlines on two planes.
    """

    def __init__(self, lines: dict[int, Scanlines], frame: RoadFrame, interval: float, crs: str, sensor_height: float = 0.0):
        self.lines = {road: found for road, found in sorted(lines.items()) if len(found)}
        self.level: LevelGround | None = None
        self.executor: Executor = THREADS
        self.frame, self.interval, self.crs = frame, interval, crs
        if not any(len(np.unique(found.station)) > 1 for found in self.lines.values()):
            raise RoadExtractionError("The scanlines of every road lie on fewer than two section planes, so no curb can be followed along "
                                      "the road. Make them with Normalized scanlines along the whole trajectory.")
        self.corridor = max(float(np.abs(found.d).max()) for found in self.lines.values())
        self.heights = {p.number: sensor_height for p in frame.passes} if sensor_height else self._sensor_heights()

    def _sensor_heights(self):
        """m from the trajectory down to the road by pass, where its scanlines cross its own track."""
        known = {}
        for p in self.frame.passes:
            drops = []
            if p.road in self.lines:
                lines = self.lines[p.road]
                lines = lines[lines.pass_number == p.number]
                drops = _drops(lines, *p.at_station(lines.station))
            height = sensor_height_of(drops)
            if height is not None:
                known[p.number] = height
        typical = float(np.median(list(known.values()))) if known else READING.default_sensor_height
        return {p.number: known.get(p.number, typical) for p in self.frame.passes}

    def stretch(self, road: int, start: float, end: float) -> str:
        """What messages call the road between two stations, m."""
        return f"road {road}, {start:.0f} to {end:.0f} m"

    def points_between(self, road: int, start: float, end: float) -> int:
        """Points are not known; 0."""
        return 0

    def roads(self) -> list[int]:
        """Numbers of the roads."""
        return list(self.lines)

    def span(self, road: int) -> tuple[float, float]:
        """Stations at which a road begins and ends, m."""
        stations = self.lines[road].station
        return float(stations[0]), float(stations[-1])

    def road_height(self, road: int, s: np.ndarray) -> np.ndarray:
        """Expected local z of the road at (N,) stations, (N,) m."""
        return self.frame.track_height(road, s, self.heights)

    def runs(self, road: int, start: float, end: float) -> list[Scanlines]:
        """The scanlines with start <= station < end, apart for each pass and scanner."""
        first, last = np.searchsorted(self.lines[road].station, (start, end))
        return self.lines[road][first:last].runs()


def _drops(lines, track_d, track_z):
    """m from the track down to every line that it crosses."""
    if not len(lines):
        return np.empty(0)
    under = (lines.d[lines.first[:-1]] <= track_d) & (lines.d[lines.first[1:] - 1] >= track_d)
    number = np.arange(len(lines)) * LINE_SEPARATION
    z = np.interp(number + track_d, np.repeat(number, np.diff(lines.first)) + lines.d, lines.z)
    return (track_z - z)[under]
