"""Driving lines: the middle of every lane, in the direction of travel, the curves along them, and one sigma of their place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt, gaussian_filter1d, uniform_filter1d

from ..common.progress import Progress
from ..countries.catalogue import Country, country
from ..curves.robust import median
from ..execution.in_step import in_step
from ..execution.phase import THREADS
from ..markings.cross_section.evidence import point_spacing
from ..markings.cross_section.roads import EstimatedRoad, RoadEstimates, estimate_roads, usual_side
from ..markings.cross_section.sections import STATION_STEP, CrossSections, EdgeSections
from ..markings.cross_section.weights import HATCHING, OUTSIDE, EstimateWeights, TakenReading, share_within
from ..markings.lines.painted_lines import PaintedLines
from ..markings.objects.marking_objects import MarkingObjects
from ..road.edges.road_edges import RoadEdges
from ..survey.frame.road_frame import Road, RoadFrame
from ..survey.frame.row_table import cuts_where_it_changes
from ..survey.store.road_points import RoadPoints
from .alignment import Course, Element, LanesOfRoad, design_check, element_of, fitted_lanes, is_curve, track_pieces
from .heights import lane_heights, road_heights
from .lane_areas import RoadLanes, connectors_between_roads, follow_over_roads, lane_areas, make_lanes
from .lane_track import LANE_STATUS, MEASURED, LaneTrack, connect
from .lanes import beyond_paint, estimated_lanes, laid_out
from .layers import CurveElements, DrivingLines, Lanes
from .settings import DrivingSettings
from .shared_lanes import lanes_once
from .weights import SIGMA

__all__ = ["DrivingSettings", "make_driving_lines"]


def estimate_lanes(marking_lines: PaintedLines, frame: RoadFrame, settings: DrivingSettings = DrivingSettings(),
                   progress: Progress = Progress(), markings: MarkingObjects | None = None, edges: RoadEdges | EdgeSections | None = None,
                   road_points: RoadPoints | None = None, taken: Sequence[TakenReading] = ()) -> RoadEstimates:
    """What `estimate_roads` gives by the settings for lanes: with markings no lane leads along a hatched area, with edges none over a curb."""
    return estimate_roads(marking_lines, frame, settings.usual_width, settings.traffic_side, edges, markings, road_points,
                          width_asked=bool(settings.lane_width), progress=progress, taken=taken)


def make_driving_lines(marking_lines: PaintedLines, frame: RoadFrame, settings: DrivingSettings = DrivingSettings(),
                       progress: Progress = Progress(), markings: MarkingObjects | None = None, edges: RoadEdges | EdgeSections | None = None,
                       road_points: RoadPoints | None = None, estimates: RoadEstimates | None = None) -> tuple[DrivingLines, CurveElements, Lanes]:
    """Lines to drive on.

    Lanes are those of the most probable cross-sections of each road; their middle is driven. Gaps of all lines are bridged one to one.

    markings, edges, road_points : as of `estimate_lanes`; the last show the heights of the road too
    estimates : what `estimate_lanes` gave for these lines; None makes them here

    Returns
        lines : DrivingLines. Lanes are numbered from 1 on every road by where they begin, from right to left. A lane is cut
            into pieces by `status`, and where its uncertainty changes much; pieces of one lane touch
        elements : CurveElements of every lane
        lanes : Lanes, the areas of the same pieces, and connectors between them where the vehicle drove on without lines
    """
    rows: list[dict[str, Any]] = []
    arcs: list[dict[str, Any]] = []
    areas: list[dict[str, Any]] = []
    lanes: dict[int, RoadLanes] = {}
    paint = marking_lines.scatter()
    if estimates is None:
        estimates = estimate_lanes(marking_lines, frame, settings, progress.part(0.0, 0.4), markings, edges, road_points)
        progress = progress.part(0.4, 1.0)
    curbs, pavement = EdgeSections.of(edges)
    if estimates.roads and settings.traffic_side == "automatic" and (usual := usual_side(frame)):
        progress.info(f"Side of traffic: where the survey lies traffic drives on the {usual}, which counts a little.")
    if estimates.roads and not estimates.sure:
        progress.warn(f"The survey hardly shows on which side traffic drives; the {estimates.side} was taken. Set Side of traffic if that is wrong.")
    if estimates.against_arrows:
        progress.warn("The vehicle drove against the arrows painted in its lanes; lanes lead the way it drove. Look at the times of the trajectory.")
    roads = lanes_once([LanesOfRoad(_road_lanes(estimated, settings, estimates.lane_width), estimated.lines.s, frame.roads[number])
                        for number, estimated in estimates.roads.items()], frame, settings.shortest)
    progress.report(0.1)
    works = fitted_lanes(roads), road_heights(road_points, [(number, road.s, road.tracks) for number, road in zip(estimates.roads, roads)])
    fitted, measured = in_step(works, THREADS if road_points is None else road_points.executor, progress.part(0.1, 0.8))
    for count, ((number, estimated), road, z_of_road, (courses, alignment)) in enumerate(zip(estimates.roads.items(), roads, measured, fitted)):
        part = progress.part(0.8 + 0.2 * count / len(roads), 0.8 + 0.2 * (count + 1) / len(roads))
        s = road.s
        passes = frame.passes_sigma(number, s)
        tracks = [replace(track, confidence=track.confidence * share_within(passes[track.first:track.last + 1])) for track in road.tracks]
        heights = lane_heights(estimated.lines, tracks, z_of_road)
        if any(np.isnan(z).any() for z in heights):
            progress.warn("Neither the marking lines nor road points have heights; the trajectory's are used.")
            heights = [frame.track_height(number, s[t.first:t.last + 1]) for t in tracks]
        spacing = None if road_points is None else point_spacing(road_points, number, s)
        for lane, (track, course, elements, z) in enumerate(zip(tracks, courses, alignment, heights), start=1):
            sigma = lane_sigma(track, course, road.road, estimated, paint, passes[track.first:track.last + 1], spacing)
            # no lane is surer than its place
            tracks[lane - 1] = track = replace(track, confidence=np.minimum(track.confidence, share_within(sigma)))
            rows += [dict(row, road=number, lane=lane) for row in _lane_pieces(
                track, track.direction, course, elements, estimated.lines, z, sigma, country(settings.country))]
            arcs += [dict(arc=arc, complete=element.complete, rmse=element.rmse, station=element.start, end=element.end, road=number, lane=lane)
                     for element in elements if is_curve(arc := element.arc if track.direction > 0 else element.arc.reversed())]
            part.report(0.9 * lane / len(tracks))
        tracks = [track.without_jumps(s) for track in tracks]
        areas += lane_areas(estimated, curbs.get(number) if curbs else None, tracks, heights, frame, number, pavement.get(number), road.of_others)
        lanes[number] = RoadLanes(s, tracks, heights)
        part.report(1.0)
    follow_over_roads(areas)
    areas += connectors_between_roads(lanes, frame, areas)
    lines = DrivingLines.of_pieces(rows, marking_lines.crs)
    _report_lengths(lines, estimates.side, progress)
    curves = CurveElements(**CurveElements.gathered(arcs), arc=[row["arc"] for row in arcs],
                           complete=np.array([row["complete"] for row in arcs], bool), crs=marking_lines.crs, country=settings.country)
    return lines, curves, make_lanes(areas, marking_lines.crs)


def _road_lanes(road: EstimatedRoad, settings: DrivingSettings, lane_width: float) -> list[LaneTrack]:
    """The lanes of one road as a list of LaneTrack; `lane_width` where only one line is painted."""
    tracks = estimated_lanes(road.boundaries, road.estimate, lane_width, settings.line_distance)
    tracks = beyond_paint(connect(tracks, settings.max_bridge), road.boundaries, road.estimate)
    clear = [track.without_doubtful_ends() for track in laid_out(tracks)]
    return [replace(track, confidence=track.said_confidence()) for track in clear
            if track is not None and len(track) * STATION_STEP >= settings.shortest]


def _lane_pieces(track: LaneTrack, way: int, course: Course, elements: list[Element], road_lines: CrossSections,
                 z: np.ndarray, sigma: np.ndarray, national: Country) -> Iterator[dict[str, Any]]:
    """The pieces of one lane by status and uncertainty, in order of station."""
    s = road_lines.s
    grid = s[track.first:track.last + 1]
    for code, start, end in _cut_by_sigma(track_pieces(track, s), grid, sigma):
        rows = slice(np.searchsorted(grid, start), np.searchsorted(grid, end) + 1)
        x, y, stations = _between(course, start, end, code_first=start == grid[0], code_last=end == grid[-1])
        if len(x) < 2:
            continue
        vertices = np.column_stack([x, y, np.interp(stations, grid, z)])
        element = element_of(elements, start, end)
        speed = None if element is None or not is_curve(arc := element.arc) else design_check(arc.radius, arc.length, element.complete, national)[0]
        yield dict(
            pattern=_patterns(track, rows, way, road_lines), direction=way, source="offset" if track.offset[rows].mean() > 0.5 else "pair",
            status=LANE_STATUS[code], **track.said(rows),
            curve=element.arc if element is not None else course.curve, rmse=course.rmse, design_speed=speed,
            sigma=sigma[rows].mean(), station=start, end=end,
            offset=median(track.d[rows]), width=median(track.width[rows]), places=vertices[::-1] if way < 0 else vertices)


def _cut_by_sigma(pieces, grid, sigma):
    """(status, start station, end station) of pieces that are cut where the uncertainty along the lane changes much."""
    for code, start, end in pieces:
        rows = slice(np.searchsorted(grid, start), np.searchsorted(grid, end) + 1)
        bounds = [start, *grid[rows][cuts_where_it_changes(grid[rows], sigma[rows])].tolist(), end]
        yield from ((code, first, last) for first, last in zip(bounds[:-1], bounds[1:]))


def _patterns(track, rows, way, lines):
    """How the lines left and right of a stretch of lane are drawn in the direction of travel, as "dashed|solid"; "none" where there is no line.

    A line may be drawn otherwise farther on: the pattern is that of most places of the stretch.
    """
    names, columns = [*lines.names, "none"], np.arange(track.first, track.first + len(track))[rows]
    patterns = []
    for side in (track.left[rows], track.right[rows])[::way]:
        painted = (side >= 0) & (side < len(lines.d))
        drawn = np.full(len(side), len(lines.names))
        at_place, usual = lines.drawn[side[painted], columns[painted]], lines.usual[side[painted]]
        drawn[painted] = np.where(at_place < 0, usual, at_place)
        patterns.append(names[np.bincount(drawn).argmax()] or "none")
    return "|".join(patterns)


def _between(course, start, end, code_first, code_last):
    """Vertices of a course from one station to another, with a vertex of its own at every cut."""
    s = course.s
    inside = slice(np.searchsorted(s, start + 0.02, side="right"), np.searchsorted(s, end - 0.02))
    stations = np.concatenate([s[:1] if code_first else [start], s[inside], s[-1:] if code_last else [end]])
    stations = stations[np.append(True, np.diff(stations) > 0)]
    return np.interp(stations, s, course.x), np.interp(stations, s, course.y), stations


def _report_lengths(lines: DrivingLines, side: str, progress: Progress) -> None:
    if not len(lines):
        progress.warn("No lane was found: that takes marking lines with room for a lane beside them, or a drive between two borders. So there are no "
                      "driving lines.")
        return
    lanes = len(set(zip(lines.road.tolist(), lines.lane.tolist())))
    length = {name: float(lines.length[lines.status == name].sum()) for name in LANE_STATUS}
    progress.info(f"Driving lines: {lanes} lanes, {side}-hand traffic: "
                 + ", ".join(f"{metres:.0f} m {name}" for name, metres in length.items() if metres))


# How uncertain the place of a driving line is: one sigma across it.
#
# What adds up as squares: how well the borders of the lane are placed, and how well the line follows the lane.
#
# A painted border is found to some millimetres however many points show it, and worse with the spacing of the points; and it is off by a share of the
# scatter of its paint about its curve, most of which averages out along the curve. How much these are was found on simulated streets with truth
# (docs/accuracy.md). More is added with the distance to its next paint, where it is bridged. The border of a hatched area is known as well as the
# outline of its bars. Between two borders the middle takes half of the error of each; where two lanes lie between them with nothing painted in the
# middle of the road, it takes three quarters of one and one quarter of the other. Beside one border alone it takes all of it, and half of what is
# left over beside the lane: nothing but its scatter, or a gutter, which is as probable as a second reading that is not worth a word may be.
#
# The line is off by most of what the places of its lane lie beside it on average over some metres: the borders show the lane there and the line
# passes it. Where the curvature changes, as from a straight into a hairpin bend, places and line are as good as an arc over some metres, which lies
# beside the lane. A place that is a guess is off by what the guess may be: as far as the lane was moved from where its own borders show it, and,
# where a second reading of the road is almost as probable, as far as the lanes of that one lie beside, with its probability. What passes differ by
# that were laid on each other comes last.
#
# A piece of a line says the mean along it, and a line is cut where it changes much. It holds against the points of the survey: what they are off as
# a whole, with their trajectory, is in it only where the accuracy of the trajectory was told, since one pass does not show it.


def lane_sigma(track: LaneTrack, course: Course, road: Road, known: EstimatedRoad, paint: dict[int, float], passes: np.ndarray | float = 0.0,
               spacing: np.ndarray | None = None) -> np.ndarray:
    """(N,) m, one sigma across a driving line at each place of its lane.

    known : EstimatedRoad of the road's lines, on whose stations the track runs, and of its boundaries, between which it lies
    paint : {number of a line: m, RMS distance of its paint from its curve}
    passes : m, one sigma of the middle of the passes, see `RoadFrame.pass_sigma`: one for all, or (N,)
    spacing : (K,) m between points at the stations of `known`, NaN where unknown; None if nothing says it
    """
    lines = known.lines
    apart = np.full(len(track), np.nan) if spacing is None else spacing[track.first:track.last + 1]
    apart = np.where(np.isnan(apart), SIGMA.usual_spacing, apart)
    return np.sqrt(_mean_square_of_borders(track, known, paint, apart) + _mean_square_misfit(track, course, road, lines)
                   + _mean_square_bias(track, course, lines) + _mean_square_guess(track) + passes**2)


def _mean_square_of_borders(track, known, paint, spacing):
    """(N,) m², of the middle of a lane from what its borders are off by."""
    lines, made_of = known.lines, np.append(known.boundaries.made_of, OUTSIDE)
    painted, square, distance = (np.stack(sides) for sides in zip(*(_border(track, lines, paint, rows) for rows in (track.left, track.right))))
    hatched = np.stack([made_of[rows] == HATCHING for rows in (track.left, track.right)])
    bounding = painted | hatched
    finite = np.isfinite(square)
    mean = np.where(finite, square, 0.0).sum(axis=0) / np.maximum(finite.sum(axis=0), 1)
    usual = np.median(mean[finite.any(axis=0)]) if finite.any() else SIGMA.usual_scatter**2
    scatter = np.where(finite, square, np.where(finite.any(axis=0), mean, usual))
    line_error = SIGMA.border_sigma**2 + (SIGMA.spacing_share * spacing) ** 2 + SIGMA.border_share**2 * scatter
    error = np.where(hatched, SIGMA.hatching_sigma**2, line_error + (SIGMA.gap_share * distance) ** 2)
    share = np.where(bounding.sum(axis=0) == 1, np.where(bounding, SIGMA.own_border, SIGMA.far_border), SIGMA.between_borders)
    beside_curb = (track.left >= 0) & (track.right >= 0) & (bounding.sum(axis=0) == 1)
    share = np.where((track.offset | beside_curb) & bounding.any(axis=0), bounding / np.maximum(bounding.sum(axis=0), 1), share)
    measured = track.status == MEASURED
    unbounded = np.where(bounding.any(axis=0), 0.0, SIGMA.gap_share * _distance_to(measured))
    by_width = np.where(~measured & (track.offset | beside_curb), _left_over_beside(), 0.0)
    square = (share**2 * error).sum(axis=0)
    if bounding.any():   # beyond all borders it is no surer than at the last place that has one
        square = np.maximum(square, square[distance_transform_edt(~bounding.any(axis=0), return_distances=False, return_indices=True)[0]])
    return square + unbounded**2 + by_width**2


def _left_over_beside():
    """m, one sigma of the middle of a lane beside one border alone."""
    (_, scatter, _), (gutter, of_gutter, _), *_ = EstimateWeights.left_over_beside
    doubt = 1.0 / (1.0 + np.exp(EstimateWeights.doubt))
    return 0.5 * np.sqrt((1.0 - doubt) * scatter**2 + doubt * (gutter**2 + of_gutter**2))


def _mean_square_misfit(track, course, road, lines):
    """(N,) m², of the smooth line from the mean of the lane's places over MISFIT_WINDOW, over MISFIT_REACH either way."""
    s = lines.s[track.first:track.last + 1]
    drawn = road.locate(np.interp(s, course.s, course.x), np.interp(s, course.s, course.y), s)[1]
    misfit = uniform_filter1d(np.nan_to_num(drawn - track.d), int(SIGMA.misfit_window / STATION_STEP), mode="nearest")
    return SIGMA.misfit_share**2 * uniform_filter1d(misfit**2, int(2 * SIGMA.misfit_reach / STATION_STEP), mode="nearest")


def _mean_square_bias(track, course, lines):
    """(N,) m², of what an arc over ARC_REACH either way misses of a line whose curvature changes.

    Where it changes by c per metre, the line leaves its arc by c u³ / 6 at u metres. The best parabola over -L to L leaves of that the third
    Legendre polynomial, with an RMS of c L³ / (15 sqrt 7).
    """
    s = lines.s[track.first:track.last + 1]
    if len(s) < 3:
        return np.zeros(len(s))
    dx, dy = (np.gradient(np.interp(s, course.s, values)) for values in (course.x, course.y))
    step = np.maximum(np.hypot(dx, dy), 0.1 * STATION_STEP)
    smooth = SIGMA.curvature_sigma / STATION_STEP
    heading = gaussian_filter1d(np.unwrap(np.arctan2(dy, dx)), smooth, mode="nearest")
    change = np.gradient(gaussian_filter1d(np.gradient(heading) / step, smooth, mode="nearest")) / step
    square = np.maximum(uniform_filter1d(change**2, int(SIGMA.curvature_window / STATION_STEP) + 1, mode="nearest"), 0.0)
    return square * (SIGMA.arc_reach**3 / (15.0 * np.sqrt(7.0))) ** 2


def _mean_square_guess(track):
    """(N,) m², of a place that is a guess: from where its borders show the lane, and from the lanes of a second reading, about the place drawn."""
    square, doubt = track.aside**2, track.in_doubt
    for k in np.flatnonzero(doubt).tolist():
        second = track.second[k]
        if second is not None and second.lanes:
            square[k] += min(abs(d - track.d[k]) for d, _, _ in second.lanes) ** 2 / (1.0 + np.exp(second.nats))
    return square


def _border(track, lines, paint, rows):
    """Of one side of a lane, (N,) each: is its border painted; m², mean square scatter of its paint, NaN where unknown; m to its next paint."""
    columns = np.arange(track.first, track.last + 1)
    painted = (rows >= 0) & (rows < len(lines.d))
    if not painted.any():
        return painted, np.full(len(track), np.nan), np.zeros(len(track))
    names, of = np.unique(np.where(painted, lines.number[np.where(painted, rows, 0), columns], -1), return_inverse=True)
    square = np.array([paint.get(name, np.nan) ** 2 if name >= 0 else np.nan for name in names.tolist()])[of]
    distance = np.zeros(len(track))
    for row in np.unique(rows[painted]).tolist():
        seen, at = lines.seen.spans.first[row] + np.flatnonzero(lines.seen.row(row)), columns[painted & (rows == row)]
        if len(seen):
            after = np.searchsorted(seen, at)
            stations = np.minimum(np.abs(seen[(after - 1).clip(0)] - at), np.abs(seen[after.clip(max=len(seen) - 1)] - at))
            distance[at - track.first] = np.minimum(stations * STATION_STEP, SIGMA.max_gap_distance)
    return painted, square, distance


def _distance_to(known):
    """(N,) m to the nearest of the grid stations that are known, MAX_GAP_DISTANCE at most; 0 where none is."""
    if not known.any():
        return np.zeros(len(known))
    return np.minimum(distance_transform_edt(~known) * STATION_STEP, SIGMA.max_gap_distance)
