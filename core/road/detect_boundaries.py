"""Road boundaries by either method or by both; the road map and the algorithms use this file alone."""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import cache, partial
from typing import Any

import numpy as np

from ..common.arrays import mask_runs, stretch_of
from ..common.progress import Progress
from ..common.setting import Limited, choice
from ..execution.in_step import in_step
from ..execution.phase import THREADS
from ..survey.frame.road_frame import RoadFrame
from ..survey.lattice.scan_lattice import lattice_of
from ..survey.open_survey import Survey
from .common.curb_limits import CurbSettings
from .common.curb_points import CurbPoints
from .common.decimation import PointDecimation
from .common.occlusion import OcclusionGrid
from .common.side_curbs import Section, curbs_along, grids_beside, steps_of_roads
from .common.sides import SIDE_SIGNS
from .curb_returns.detect import with_curb_returns
from .edges.fit import EdgeSettings, fit_road_edges
from .edges.road_edges import EdgePiece, RoadEdges, joined_pieces
from .profiles.detect import profiles_of, steps_of_section, tell_points
from .scanlines.candidates import ScanlineBoundarySettings
from .scanlines.detect import SurveyScanlines, corners_of_section, planes_of, tell_corners, with_scanner_noise
from .scanlines.section_planes import ScanlineSettings
from .surface.ground_grid import MeasuredGround
from .surface.pavement_lines import with_pavement_edges
from .surface.road_look import RoadLook
from .weights import BOUNDARY, CURBS

METHODS = ("scanlines", "profiles")   # in the order of trust: three planes are a stricter model of a curb than a profile


@dataclass(frozen=True)
class BoundarySettings(Limited):
    """How road boundaries are found.

    method : "profiles", "scanlines", or "both": one path along the road through what the two see
    curbs : settings of the profiles method
    scanlines : settings of the scanlines method
    planes : settings of the planes in which scanlines lie
    """

    method: str = choice("both", ("profiles", "scanlines", "both"), "The boundary method")
    curbs: CurbSettings = CurbSettings()
    scanlines: ScanlineBoundarySettings = ScanlineBoundarySettings()
    planes: ScanlineSettings = ScanlineSettings()


@dataclass
class _RoadBoundaries:
    """Curb points and the edges through them.

    curb_points : CurbPoints
    edges : RoadEdges
    differences : RoadEdges, where the curbs of the two methods lie apart; None with one method
    length_by_method : method -> m of measured curb; empty with one method
    """

    curb_points: CurbPoints
    edges: RoadEdges
    differences: RoadEdges | None = None
    length_by_method: dict = field(default_factory=dict)


def find_curb_points(survey: Survey, settings: BoundarySettings = BoundarySettings(), progress: Progress = Progress(),
                     ground: MeasuredGround | None = None) -> dict[str, CurbPoints]:
    """Curb points of the methods that the settings name.

    ground : MeasuredGround of the survey, which keeps what is measured here, or None

    Returns {method: CurbPoints}; with both methods, "profiles" and "scanlines" hold the road's own
    curbs as each sees them alone, and "both" those of the best path through the chains of the two. Corners, side streets
    and islands are found in plan, once, and belong to the curbs that are drawn. Points of status `measured` are vertices of the road
    edge; those of status `bridged` lie on the line across a lowered curb, and those of status `occluded` where something hides the curb.
    """
    kept_ground, ground = ground, ground or MeasuredGround(survey)
    with closing(PointDecimation(survey, settings.curbs.profile_width, settings.curbs.point_spacing)) as decimation:
        source: Any = decimation
        searches = {} if settings.method == "scanlines" else {"profiles": profiles_of(decimation, settings.curbs)}
        if settings.method != "profiles":
            part = progress.part(0.0, BOUNDARY.lattice_progress)
            # a later stage looks for edges of the pavement in the profiles of a ground that is kept
            lattice, _ = in_step([lattice_of(survey, settings.planes.rotation_frequency, part), ground.measured_all(kept_ground is not None)],
                                 survey.executor, part)
            source = SurveyScanlines(survey, settings.planes, settings.scanlines.sensor_height, lattice, decimation=decimation)
            searches = {"scanlines": planes_of(source, settings.scanlines, settings.curbs.block_length), **searches}
        steps = with_scanner_noise(steps_of_roads(_steps_of_methods, source, (settings.scanlines, settings.curbs), searches,
                                                  progress.part(BOUNDARY.lattice_progress, BOUNDARY.returns_progress)))
        look_at = cache(partial(RoadLook, ground))
        points = curbs_along(source, steps, look_at)
        for method, tell in (("scanlines", tell_corners), ("profiles", tell_points)):
            if method in points:
                tell(points[method], progress)
        beside = grids_beside(steps["profiles" if "profiles" in steps else "scanlines"])
        points[settings.method] = with_curb_returns(points[settings.method], decimation, settings.curbs,
                                                    progress.part(BOUNDARY.returns_progress, 1.0), beside, look_at)
        return points


def _steps_of_methods(source: Any, section: Section, scanlines: ScanlineBoundarySettings,
                     profiles: CurbSettings) -> tuple[dict[str, Any], dict[str, OcclusionGrid]]:
    """The phase of both methods: what `steps_of_section` or `corners_of_section` finds, by the method of the section."""
    if section[0] == "scanlines":
        return corners_of_section(source, section, scanlines)
    return steps_of_section(getattr(source, "decimation", source), section, profiles)


def draw_boundaries(points_by_method: dict[str, CurbPoints], frame: RoadFrame, settings: EdgeSettings = EdgeSettings(),
                    progress: Progress = Progress(), survey: Survey | None = None, ground: MeasuredGround | None = None) -> _RoadBoundaries:
    """Edges through the curb points of one method, or of the path through those of two, and edges of the pavement where there is no curb.

    With both methods, `agree` of every piece says how far apart they lie.

    points_by_method : result of `find_curb_points`
    survey : Survey, in which edges of the pavement are looked for; None leaves them out
    ground : MeasuredGround of it that an earlier stage kept, or None
    """
    points = points_by_method["both"] if "both" in points_by_method else next(iter(points_by_method.values()))
    boundaries = _RoadBoundaries(points, fit_road_edges(points, frame, settings, progress.part(0.0, BOUNDARY.curb_edges_progress),
                                                        THREADS if survey is None else survey.executor))
    if "both" in points_by_method:
        first, second = (points_by_method[method] for method in METHODS)
        boundaries.edges, boundaries.differences = measure_agreement(boundaries.edges, first, second, frame)
        for method in METHODS:
            curbs, goes_on = _measured(points_by_method[method])
            boundaries.length_by_method[method] = float(np.diff(curbs.station)[goes_on].sum())
        lengths = boundaries.length_by_method
        if any(lengths.values()):
            progress.info(f"Profiles measured {lengths['profiles']:.0f} m of edges and scanlines {lengths['scanlines']:.0f} m; "
                         f"they lie more than 5 cm apart along {boundaries.differences.length.sum():.0f} m.")
    if survey is not None:
        boundaries.edges = with_pavement_edges(survey, boundaries.edges, settings, progress=progress.part(BOUNDARY.curb_edges_progress, 1.0),
                                               ground=ground)
    return boundaries


# How far apart the curbs of two methods lie, where both see one.


def _measured(points):
    """The measured feet of main curbs, by road, side and station, and (N - 1,) bool, where the curb goes on from one to the next."""
    points = points[points.of_main_curb & (points.part == "bottom") & (points.status == "measured")]
    points = points[np.lexsort((points.station, points.side.astype(str), points.road))]
    same = (points.road[1:] == points.road[:-1]) & (points.side[1:] == points.side[:-1])
    return points, same & (np.diff(points.station) <= CURBS.max_joined_gap)


def _curb_at(points, goes_on, s):
    """(2, N) m, offset and local height of the curb of one side at N stations, NaN where it was not measured."""
    if not goes_on.any():
        return np.full((2, len(s)), np.nan)
    after = np.clip(np.searchsorted(points.station, s), 1, len(goes_on))
    seen = goes_on[after - 1] & (s >= points.station[0]) & (s <= points.station[-1])
    return np.where(seen, [np.interp(s, points.station, values) for values in (points.offset, points.z)], np.nan)


def measure_agreement(edges: RoadEdges, first: CurbPoints, second: CurbPoints, frame: RoadFrame) -> tuple[RoadEdges, RoadEdges]:
    """How far apart the curbs of two methods lie beside every edge, and where that is much.

    The number is the distance that 95 % of the piece does not exceed, NaN where one of the
    two saw no curb. It is measured across the road, every BOUNDARY.comparison_step metres.

    edges : RoadEdges that are drawn
    first, second : CurbPoints of two methods

    Returns
        edges : RoadEdges with `agree`
        differences : RoadEdges, lines along the curb of the first, one for every stretch where the two lie more
            than BOUNDARY.min_reported_difference apart, `agree` their largest distance there
    """
    agree = edges.agree.copy()
    differences: list[EdgePiece] = []
    curbs = [_measured(points) for points in (first, second)]
    for road in frame.roads:
        s = np.arange(np.floor(road.start / BOUNDARY.comparison_step), np.ceil(road.end / BOUNDARY.comparison_step) + 1) * BOUNDARY.comparison_step
        for side in SIDE_SIGNS:
            rows = [np.flatnonzero((points.road == road.number) & (points.side == side)) for points, _ in curbs]
            (d, z), (other, _) = (_curb_at(points[of_side], goes_on[of_side[:-1]], s) for (points, goes_on), of_side in zip(curbs, rows))
            difference = np.abs(d - other)
            for k in np.flatnonzero((edges.road == road.number) & (edges.side == side)):
                distances = difference[stretch_of(s, edges.station[k], edges.end[k])]
                distances = distances[np.isfinite(distances)]
                if len(distances):
                    agree[k] = round(100 * float(np.quantile(distances, BOUNDARY.agreement_quantile)), 1)
            differing = difference > BOUNDARY.min_reported_difference
            for a, b in mask_runs(differing):
                if (b - a) * BOUNDARY.comparison_step < BOUNDARY.min_reported_length:
                    continue
                vertices = np.column_stack(frame.to_map(road.number, s[a:b], d[a:b], z[a:b]))
                differences.append(EdgePiece(vertices, road.number, side, "measured", len(differences), float(s[a]), float(s[b - 1]),
                                             agree=100 * float(difference[a:b].max())))
    return replace(edges, agree=agree), joined_pieces(differences, frame, edges.crs)
