"""Driving lines: the middle of every lane, in the direction of travel, and the curves along them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.progress import Progress
from ..countries.catalogue import country
from ..markings.cross_section.confidence import share_within
from ..markings.cross_section.evidence import point_spacing
from ..markings.cross_section.roads import EstimatedRoad, estimate_roads
from ..markings.cross_section.sections import STATION_STEP, CrossSections, sections_of_edges, sections_of_lines, sections_of_pavement
from ..markings.lines.painted_lines import PaintedLines
from ..markings.objects.marking_objects import MarkingObjects
from ..road.edges.road_edges import RoadEdges
from ..survey.frame.row_table import cuts_where_it_changes
from .alignment import Element, lane_elements
from .centreline import Course, element_of, lane_courses, track_pieces
from .connectors import RoadLanes, connectors_between_roads
from .curve_elements import is_curve
from .driving_layers import CurveElements, DrivingLines
from .heights import lane_heights
from .lane_areas import lane_areas, make_lanes
from .lane_track import LANE_STATUS, LaneTrack, connect
from .lanes import estimated_lanes
from .lanes_layer import Lanes
from .settings import DrivingSettings
from .tapers import laid_out
from .uncertainty import lane_sigma

if TYPE_CHECKING:
    from ..markings.cross_section.confidence import TakenReading
    from ..survey.frame.road_frame import RoadFrame
    from ..survey.store.road_points import RoadPoints

__all__ = ["DrivingSettings", "make_driving_lines"]


def make_driving_lines(marking_lines: PaintedLines, frame: RoadFrame, settings: DrivingSettings = DrivingSettings(),
                       progress: Progress = Progress(), markings: MarkingObjects | None = None, edges: RoadEdges | None = None,
                       road_points: RoadPoints | None = None, taken: Sequence[TakenReading] = ()) -> tuple[DrivingLines, CurveElements, Lanes]:
    """Lines to drive on.

    Lanes are those of the most probable cross-sections of each road (`estimate_roads`); their middle is driven. Gaps of all lines are
    bridged one to one.

    Parameters
    ----------
    marking_lines : PaintedLines
    frame : RoadFrame
    settings : DrivingSettings
    progress : Progress
    markings : MarkingObjects or None: no lane leads along a hatched area
    edges : RoadEdges or None: no lane leads over a curb
    road_points : RoadPoints or None: the heights of the road
    taken : second readings that an analyst took

    Returns
    -------
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
    curbs, pavement = (sections_of_edges(edges), sections_of_pavement(edges)) if edges is not None else (None, {})
    estimates = estimate_roads(sections_of_lines(marking_lines), frame, settings.lane_width or country(settings.country).usual_lane,
                               settings.traffic_side, curbs, markings, road_points, width_asked=bool(settings.lane_width), pavement=pavement,
                               progress=progress.part(0.0, 0.4), taken=taken)
    progress.report(0.4)
    if estimates.roads and not estimates.sure:
        progress.warn(f"The survey hardly shows on which side traffic drives; the {estimates.side} was taken. Set Side of traffic if that is wrong.")
    if estimates.against_arrows:
        progress.warn("The vehicle drove against the arrows painted in its lanes; lanes lead the way it drove. Look at the times of the trajectory, "
                      "or set Side of traffic if the arrows are right.")
    for count, (number, one) in enumerate(estimates.roads.items()):
        part = progress.part(0.4 + 0.6 * count / len(estimates.roads), 0.4 + 0.6 * (count + 1) / len(estimates.roads))
        s = one.lines.s
        passes = frame.passes_sigma(number, s)
        tracks = [replace(track, confidence=track.confidence * share_within(passes[track.first:track.last + 1]))
                  for track in road_lanes(one, settings, estimates.lane_width)]
        part.report(0.25)
        alignment = lane_elements(tracks, s, frame.roads[number])
        part.report(0.5)
        heights = lane_heights(one.lines, road_points, number, tracks, part.part(0.5, 0.7))
        if any(np.isnan(z).any() for z in heights):
            progress.warn("Neither the marking lines nor road points have heights; the trajectory's are used.")
            heights = [frame.track_height(number, s[t.first:t.last + 1]) for t in tracks]
        courses = lane_courses(tracks, s, frame.roads[number], alignment)
        spacing = None if road_points is None else point_spacing(road_points, number, s)
        for lane, (track, course, elements, z) in enumerate(zip(tracks, courses, alignment, heights), start=1):
            sigma = lane_sigma(track, course, frame.roads[number], one, paint, passes[track.first:track.last + 1], spacing)
            rows += [dict(row, road=number, lane=lane) for row in _lane_pieces(track, track.direction, course, elements, one.lines, z, sigma)]
            arcs += [dict(row, road=number, lane=lane) for row in _lane_curves(track.direction, elements)]
            part.report(0.8 + 0.1 * lane / len(tracks))
        tracks = [track.without_jumps(s) for track in tracks]
        areas += lane_areas(one, curbs.get(number) if curbs else None, tracks, heights, frame, number, pavement.get(number))
        lanes[number] = RoadLanes(s, tracks, heights)
        part.report(1.0)
    areas += connectors_between_roads(lanes, frame, areas)
    lines = driving_lines_of(rows, marking_lines.crs)
    _report_lengths(lines, estimates.side, progress)
    return lines, _curve_elements(arcs, marking_lines.crs, settings.country), make_lanes(areas, marking_lines.crs)


def road_lanes(road: EstimatedRoad, settings: DrivingSettings, lane_width: float) -> list[LaneTrack]:
    """The lanes of one road as a list of LaneTrack, by first station, then from right to left.

    Parameters
    ----------
    road : EstimatedRoad
    settings : DrivingSettings
    lane_width : metres, of lanes beside which only one line is painted
    """
    tracks = estimated_lanes(road.boundaries, road.estimate, lane_width, settings.line_distance)
    tracks = connect(tracks, road.lines, settings.max_bridge, settings.max_inferred, _shown(road.boundaries))
    known = [track.without_doubtful_ends() for track in laid_out(tracks)]
    tracks = [replace(track, confidence=track.said_confidence()) for track in known
              if track is not None and len(track) * STATION_STEP >= settings.shortest]
    return sorted(tracks, key=lambda track: (track.first, float(track.d[0])))


def _shown(boundaries):
    """(K,) bool, whether any line is seen at a grid station."""
    spans, found = boundaries.d.spans, np.zeros(len(boundaries.s), bool)
    found[spans.station[boundaries.seen.values & boundaries.painted[spans.owner]]] = True
    return found


def _lane_pieces(track: LaneTrack, way: int, course: Course, elements: list[Element], road_lines: CrossSections,
                 z: np.ndarray, sigma: np.ndarray) -> Iterator[dict[str, Any]]:
    """The pieces of one lane by status and uncertainty, in order of station."""
    s = road_lines.s
    grid = s[track.first:track.last + 1]
    for code, start, end in _cut_by_sigma(track_pieces(track, s), grid, sigma):
        rows = slice(np.searchsorted(grid, start), np.searchsorted(grid, end) + 1)
        x, y, at = _between(course, start, end, code_first=start == grid[0], code_last=end == grid[-1])
        if len(x) < 2:
            continue
        places = np.c_[x, y, np.interp(at, grid, z)]
        element = element_of(elements, start, end)
        yield dict(
            pattern=_patterns(track, rows, way, road_lines), direction=way, source="offset" if track.offset[rows].mean() > 0.5 else "pair",
            status=LANE_STATUS[code], **track.said(rows),
            curve=element.arc if element is not None else course.curve, rmse=course.rmse,
            sigma=sigma[rows].mean(), station=start, end=end,
            offset=np.median(track.d[rows]), width=np.median(track.width[rows]), places=places[::-1] if way < 0 else places)


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
    found = []
    for side in (track.left[rows], track.right[rows])[::way]:
        painted = (side >= 0) & (side < len(lines.d))
        row = np.where(painted, side, 0)
        drawn = lines.drawn[row, columns]
        drawn = np.where(painted, np.where(drawn < 0, lines.usual[row], drawn), len(lines.names))
        found.append(names[np.bincount(drawn).argmax()] or "none")
    return "|".join(found)


def _between(course, start, end, code_first, code_last):
    """Vertices of a course from one station to another, with a vertex of its own at every cut."""
    s = course.s
    inside = slice(np.searchsorted(s, start + 0.02, side="right"), np.searchsorted(s, end - 0.02))
    at = np.r_[s[0] if code_first else start, s[inside], s[-1] if code_last else end]
    at = at[np.r_[True, np.diff(at) > 0]]
    return np.interp(at, s, course.x), np.interp(at, s, course.y), at


def _lane_curves(way: int, elements: list[Element]) -> Iterator[dict[str, Any]]:
    """The circular curves of one lane."""
    for element in elements:
        arc = element.arc if way > 0 else element.arc.reversed()
        if is_curve(arc):
            yield dict(arc=arc, complete=element.complete, rmse=element.rmse, station=element.start, end=element.end)


def _column(rows: list[dict[str, Any]], name: str, kind: Any) -> np.ndarray:
    return np.array([row[name] for row in rows], kind)


def driving_lines_of(rows: list[dict[str, Any]], crs: str) -> DrivingLines:
    """DrivingLines of one row a piece: dicts of the columns of DrivingLines, `curve`, and `places` (V, 3) in the direction of travel."""
    places = [row["places"] for row in rows]
    return DrivingLines(
        _column(rows, "road", int), _column(rows, "lane", int), _column(rows, "pattern", object), _column(rows, "direction", int),
        _column(rows, "source", object), _column(rows, "status", object), _column(rows, "confidence", float), [row["curve"] for row in rows],
        _column(rows, "rmse", float), _column(rows, "station", float), _column(rows, "end", float), _column(rows, "offset", float),
        _column(rows, "width", float), _column(rows, "sigma", float), np.concatenate([*places, np.empty((0, 3))]),
        np.append(0, np.cumsum([len(some) for some in places], dtype=int)), crs, np.array([row.get("other", "") for row in rows], object))


def _curve_elements(rows: list[dict[str, Any]], crs: str, country_name: str) -> CurveElements:
    return CurveElements(
        _column(rows, "road", int), _column(rows, "lane", int), _column(rows, "station", float), _column(rows, "end", float),
        [row["arc"] for row in rows], _column(rows, "complete", bool), _column(rows, "rmse", float), crs, country_name)


def _report_lengths(lines: DrivingLines, side: str, progress: Progress) -> None:
    if not len(lines):
        progress.warn("No lane was found: that takes marking lines with room for a lane beside them. So there are no driving lines.")
        return
    lanes = len(set(zip(lines.road.tolist(), lines.lane.tolist())))
    length = {name: float(lines.length[lines.status == name].sum()) for name in LANE_STATUS}
    progress.info(f"Driving lines: {lanes} lanes, {side}-hand traffic: "
                 + ", ".join(f"{metres:.0f} m {name}" for name, metres in length.items() if metres))
