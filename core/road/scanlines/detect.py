"""Corners of curbs on normalized scanlines, and boundary lines through them.

Every section of the road is searched for each side, pass and scanner alone. Corners that agree are merged. The others
remain until corners are linked along the road, by the same rules as in the method of profiles.

Source: the paper on normalized scanlines (ISPRS Archives, 2020), section 3 and table 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...execution.phase import THREADS, Executor, Recipe
from ...survey.blocks import sensor_height_of
from ...survey.frame.road_frame import RoadFrame
from ...survey.lattice.scan_lattice import ScanLattice, find_lattice
from ...survey.survey import Survey
from ...survey.weights import READING
from ..common.curb_points import CurbPoints
from ..common.decimation import PointDecimation
from ..common.occlusion import OcclusionGrid
from ..common.pseudo_scanlines import nearest_distance
from ..common.side_curbs import Search, Section, SideSteps, curbs_along, merged_passes, steps_of_roads
from ..common.sides import SIDE_SIGNS, OutermostTrack, expected_height
from ..common.tracking import without_outliers
from ..edges.fit import EdgeCurve, point_table, stretches_of
from ..edges.road_edges import EdgePiece, RoadEdges, edge_sigma, joined_pieces
from ..surface.ground_grid import MeasuredGround
from ..surface.road_look import RoadLook
from ..weights import CURBS, EDGE, PROFILE, SCANLINE
from .candidates import ScanlineBoundarySettings, find_candidates, gap_fill_rows, samples_near
from .corners import CurbCorners, corners_of, plane_fit_rows
from .grid import LINE_SEPARATION, Scanlines, height_grid
from .section_planes import ScanlineSettings, margin_of_meshes, scanline_runs


def curbs_from_scanlines(source: SurveyScanlines | LayerScanlines, settings: ScanlineBoundarySettings = ScanlineBoundarySettings(),
                         block_length: float = 0.0, progress: Progress = Progress(), ground: MeasuredGround | None = None) -> CurbPoints:
    """Bottom and top corners of the curb on each side of every road, one of each per block.

    source : SurveyScanlines or LayerScanlines
    block_length : m of road per corner; 0 = 0.5 to 2.0, shorter in sharp bends
    ground : MeasuredGround of the survey; None where nothing but the scanlines is known of the ground

    Returns CurbPoints, `part` bottom or top. Those of status `occluded` mark places where an object hides the curb, and
    those of status `bridged` lie on the line across a lowered one.
    """
    steps = steps_of_roads(corners_of_section, source, (settings,), {"scanlines": planes_of(source, settings, block_length)}, progress)
    points = curbs_along(source, with_scanner_noise(steps), None if ground is None else partial(RoadLook, ground))["scanlines"]
    tell_corners(points, progress)
    return points


def tell_corners(points: CurbPoints, progress: Progress) -> None:
    """Say in the log how many corners of curbs there are."""
    measured, hidden = (np.count_nonzero((points.part == "bottom") & (points.status == status)) for status in ("measured", "occluded"))
    progress.info(f"Corners of curbs: {measured:,} measured on scanlines, {hidden:,} hidden by objects.")


def planes_of(source: SurveyScanlines | LayerScanlines, settings: ScanlineBoundarySettings, block_length: float) -> Search:
    """The planes of all roads. `block_length` : as of `curbs_from_scanlines`."""
    return Search.of(source.spans(), source.frame, source.interval, settings.limits, block_length, beyond=1)


def corners_of_section(source: SurveyScanlines | LayerScanlines, item: Section,
                       settings: ScanlineBoundarySettings) -> tuple[dict[str, CurbCorners], dict[str, OcclusionGrid]]:
    """The phase of scanlines: corners in one section of a road.

    Returns
        corners : side -> CurbCorners, merged over passes and scanners where they agree
        occlusion : side -> OcclusionGrid of these planes
    """
    interval, (_, road, begin, end) = source.interval, item
    margin = max(plane_fit_rows(interval, settings), SCANLINE.neighbour_lines + gap_fill_rows(interval)) + 1
    tracks = {side: OutermostTrack(source.frame, road, sign) for side, sign in SIDE_SIGNS.items()}
    occlusion = {side: OcclusionGrid(interval, begin, end - begin, CURBS.max_curb_offset) for side in SIDE_SIGNS}
    rows = begin - margin, end + margin
    stations = np.arange(*rows) * interval
    nearest = {side: tracks[side](stations) + PROFILE.min_track_distance for side in SIDE_SIGNS}
    corners_by_side: dict[str, list[CurbCorners]] = {side: [] for side in SIDE_SIGNS}
    for lines in source.runs(road, (rows[0] - 0.5) * interval, (rows[1] - 0.5) * interval):
        heights = lines.z - np.repeat(expected_height(source, road, lines.station), np.diff(lines.first))
        grid = height_grid(lines, heights, rows, interval, min(CURBS.max_curb_offset, source.corridor), settings.clipping_height)
        closed = grid.closed(gap_fill_rows(interval))
        tall = np.flatnonzero(heights > CURBS.min_occluder_height)   # vertices of objects that can hide a curb
        tall_stations = lines.station[np.searchsorted(lines.first, tall, side="right") - 1] + 0.5 * interval
        candidates = {}
        for side, sign in SIDE_SIGNS.items():
            origin = np.floor(nearest[side].min())
            outward = grid.outward(sign, origin)
            occlusion[side].add_points(sign * lines.d[tall], tall_stations, heights[tall], (begin, end), outward.part(margin, margin + end - begin))
            of_side = find_candidates(closed.outward(sign, origin), outward.low, nearest[side], settings)
            candidates[side] = of_side[(of_side.row >= margin) & (of_side.row < margin + end - begin)]
        for side, corners in _corners(lines, heights, rows, interval, candidates, settings):
            corners_by_side[side].append(corners)
    return {side: merged_corners(parts) for side, parts in corners_by_side.items() if parts}, occlusion


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


def merged_corners(seen: Sequence[CurbCorners]) -> CurbCorners:
    """One corner where several passes or scanners measured the same one: their mean, weighted by support.

    seen : CurbCorners of each pass and scanner
    """
    upright, sloped = (merged_passes([part[part.sloped == kind] for part in seen]) for kind in (False, True))
    # where one pass or scanner shows an upright face, what others show less sharply is no other curb
    around = np.arange(-SCANLINE.neighbour_lines, SCANLINE.neighbour_lines + 1)[:, None]
    keys = ((upright.profile + around) * LINE_SEPARATION + upright.u).ravel()
    sloped = sloped[nearest_distance(sloped.profile * LINE_SEPARATION + sloped.u, keys) > SCANLINE.same_curb_distance]
    return CurbCorners.join([upright, sloped])


def with_scanner_noise(steps: dict[str, dict[tuple[int, str], SideSteps]]) -> dict[str, dict[tuple[int, str], SideSteps]]:
    """The same, once the corners of each side of a road have the median noise there for `scanner_noise`."""
    for side in steps.get("scanlines", {}).values():
        if side.steps is not None and len(side.steps):
            corners: Any = side.steps
            corners.scanner_noise = np.full(len(corners), np.clip(np.median(corners.noise), CURBS.min_scanner_noise, SCANLINE.max_usual_noise))
    return steps


def boundary_lines(corners: CurbPoints, frame: RoadFrame, max_gap: float, progress: Progress = Progress()) -> RoadEdges:
    """Smooth lines through corners, separately for bottoms and tops.

    corners : CurbPoints with `part` bottom or top
    max_gap : m between corners that are connected

    Returns RoadEdges along the road, one piece for each stretch of one status:
    measured, bridged (a gap between corners), or occluded (a gap where an object hides the curb). The pieces of one
    line share their end vertices and `chain`.
    """
    pieces: list[EdgePiece] = []
    number = 0
    for road in frame.roads:
        for side in SIDE_SIGNS:
            of_side = corners[(corners.road == road.number) & (corners.side == side)]
            hidden = np.sort(of_side.station[of_side.status == "occluded"])
            for part in ("bottom", "top"):
                measured = point_table(of_side[(of_side.part == part) & (of_side.status == "measured")], frame)
                for points, status in _pieces(without_outliers(measured), hidden, max_gap):
                    curve, passes = EdgeCurve(points), frame.passes_sigma(road.number, points["s"])
                    for i, along, known in stretches_of(points, curve.t, curve.residual, status[1:] != status[:-1]):
                        sigma = edge_sigma(along, curve.t, curve.residual, points["support"], passes=np.interp(along, curve.t, passes))
                        pieces.append(EdgePiece(curve.at(along), road.number, side, str(status[i]), number, part=part, sigma=sigma, **known))
                    number += 1
    lines = joined_pieces(pieces, frame, corners.crs)
    length = {part: lines.length[lines.part == part].sum() for part in ("bottom", "top")}
    progress.info(f"Boundaries: {length['bottom']:.0f} m of bottom lines and {length['top']:.0f} m of top lines.")
    progress.report(1.0)
    return lines


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


# Sources of normalized scanlines: sections of a survey, computed on demand, or a layer.

class SurveyScanlines:
    """The scanlines of a survey, computed on demand.

    sensor_height : m from the trajectory down to the road, 0 = from the data
    lattice : ScanLattice, or None to find it here
    progress : Progress of finding it
    decimation : PointDecimation in whose points the same phase may look for profiles, or None

    frame : RoadFrame
    crs : WKT
    interval, corridor : m, of the settings
    """

    def __init__(self, survey: Survey, settings: ScanlineSettings = ScanlineSettings(), sensor_height: float = 0.0,
                 lattice: ScanLattice | None = None, progress: Progress = Progress(),
                 decimation: PointDecimation | None = None):
        self.settings, self.sensor_height, self.decimation = settings, sensor_height, decimation
        self.survey, self.interval, self.corridor = survey, self.settings.interval, self.settings.corridor
        self.lattice = find_lattice(survey, self.settings.rotation_frequency, progress) if lattice is None else lattice
        self.frame, self.crs = survey.frame, survey.crs
        self.known = self.settings, sensor_height, self.lattice, decimation and decimation.known
        # of the planes beside a section that its corners need, too
        self.reach = max(margin_of_meshes(survey, road.number, self.lattice) for road in survey.frame.roads) \
            + (SCANLINE.neighbour_lines + 4) * self.interval

    @property
    def executor(self) -> Executor:
        """Who runs the phases that read these scanlines."""
        return self.survey.executor

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the scanlines."""
        decimation = None if self.decimation is None else self.decimation.recipe(folder)
        return Recipe("core.road.scanlines.detect:SurveyScanlines", dict(survey=self.survey.recipe(folder), settings=self.settings,
                                                                    sensor_height=self.sensor_height, lattice=self.lattice,
                                                                    decimation=decimation))

    def spans(self) -> dict[int, tuple[float, float]]:
        """{number of a road: stations at which it begins and ends, m}"""
        return {road: self.survey.store.span(road) for road in self.survey.store.roads()}

    def road_height(self, road: int, s: np.ndarray) -> np.ndarray:
        """Expected local z of the road at (N,) stations, (N,) m."""
        if self.sensor_height:
            return self.frame.track_height(road, s) - self.sensor_height
        return self.survey.road_height(road, s)

    def runs(self, road: int, start: float, end: float) -> list[Scanlines]:
        """The scanlines with start <= station < end, apart for each pass and scanner; their intensity is 0."""
        return scanline_runs(self.survey, road, start, end, self.settings, self.lattice, intensity=False)


class LayerScanlines:
    """The scanlines of a layer, in the road frame of the trajectory they were made with.

    lines : dict of road number to Scanlines, each sorted by station
    interval : m between section planes
    sensor_height : m from the trajectory down to the road, 0 = from the data

    frame, interval, crs : as given
    corridor : m, greatest offset of a vertex

    Raises RoadExtractionError if no road has scanlines on two planes.
    """

    def __init__(self, lines: dict[int, Scanlines], frame: RoadFrame, interval: float, crs: str, sensor_height: float = 0.0):
        self.lines = {road: scanlines for road, scanlines in sorted(lines.items()) if len(scanlines)}
        self.executor: Executor = THREADS
        self.frame, self.interval, self.crs = frame, interval, crs
        if not any(len(np.unique(scanlines.station)) > 1 for scanlines in self.lines.values()):
            raise RoadExtractionError("The scanlines of every road lie on fewer than two section planes, so no curb can be followed along "
                                      "the road. Make them with Normalized scanlines along the whole trajectory.")
        self.corridor = max(float(np.abs(scanlines.d).max()) for scanlines in self.lines.values())
        self.heights = {p.number: sensor_height for p in frame.passes} if sensor_height else self._sensor_heights()

    def _sensor_heights(self):
        """m from the trajectory down to the road by pass, where its scanlines cross its own track."""
        heights = {}
        for p in self.frame.passes:
            drops = []
            if p.road in self.lines:
                lines = self.lines[p.road]
                lines = lines[lines.pass_number == p.number]
                drops = _drops(lines, *p.at_station(lines.station))
            height = sensor_height_of(drops)
            if height is not None:
                heights[p.number] = height
        typical = float(np.median(list(heights.values()))) if heights else READING.default_sensor_height
        return {p.number: heights.get(p.number, typical) for p in self.frame.passes}

    def spans(self) -> dict[int, tuple[float, float]]:
        """{number of a road: stations at which it begins and ends, m}"""
        return {road: (float(lines.station[0]), float(lines.station[-1])) for road, lines in self.lines.items()}

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
    crosses_track = (lines.d[lines.first[:-1]] <= track_d) & (lines.d[lines.first[1:] - 1] >= track_d)
    number = np.arange(len(lines)) * LINE_SEPARATION
    z = np.interp(number + track_d, np.repeat(number, np.diff(lines.first)) + lines.d, lines.z)
    return (track_z - z)[crosses_track]
