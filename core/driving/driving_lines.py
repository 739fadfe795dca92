"""Driving lines: the middle of every lane, in the direction of travel, and the curves along them."""

import json

import numpy as np
import shapely

from ..common.features import Features
from ..common.progress import Progress
from ..common.schemas import CURVE_ELEMENTS, DRIVING_LINES, of_main_curb
from .alignment import lane_elements
from .centreline import element_of, lane_courses, pieces, settled
from .cross_section import STEP, road_boundaries
from .curve_elements import element_row
from .direction import divide, driven_offsets, lane_directions, side_votes
from .drivable_area import Room
from .heights import lane_heights
from .lane_tracking import STATUS, connect, extend
from .lanes import chosen_lines, divided_strips, lone_lanes, paired_lanes, strips, usual_width
from .settings import DrivingSettings

__all__ = ["DrivingSettings", "driving_lines"]


def driving_lines(marking_lines, frame, settings=DrivingSettings(), progress=Progress(),
                  markings=None, edges=None, road_points=None):
    """Lines to drive on.

    Neighbouring marking lines as far apart as a lane is wide make a lane; its middle
    is driven. Where a line is missing the lane goes on beside the other one; where
    only outer lines are painted they are divided by the lane width (both `inferred`);
    gaps of all lines are bridged one to one.

    Parameters
    ----------
    marking_lines : Features MARKING_LINES
    frame : RoadFrame
    markings : Features MARKINGS or None: no lane leads along a hatched area
    edges : Features ROAD_EDGES or None: no lane leads over a curb
    road_points : RoadPoints or None: the heights of the road

    Returns
    -------
    lines : Features DRIVING_LINES, digitised in the direction of travel. Lanes are
        numbered from 1 on every road by where they begin, from right to left. A lane is cut into pieces
        by `status`; pieces of one lane touch. `radius_m` and `curve` are the piece's
        own, `params` the function of the arc, the straight or the
        whole lane that the piece is on, in map coordinates, along the road.
    elements : Features CURVE_ELEMENTS, a row per arc of every lane
    """
    lines = Features("LineStringZ", DRIVING_LINES, crs=marking_lines.crs)
    elements = Features("None", CURVE_ELEMENTS, crs=marking_lines.crs)
    curbs = road_boundaries([(g, r) for g, r in edges or () if of_main_curb(r)], frame)
    found = {}
    boundaries = road_boundaries(marking_lines, frame)
    for count, (number, road_lines) in enumerate(boundaries.items()):
        driven, directions = driven_offsets(frame, number, road_lines.s)
        room = Room(road_lines, frame, number, curbs.get(number), markings)
        tracks = road_lanes(road_lines, driven, settings, room)
        found[number] = road_lines, tracks, driven, directions, divide(road_lines, tracks, driven, directions)
        progress.at(0.4 * (count + 1) / len(boundaries))
    side = _traffic_side(found, settings, progress)
    for count, (number, (road_lines, tracks, driven, directions, middle)) in enumerate(found.items()):
        ways = lane_directions(tracks, middle, driven, directions, side, settings.traffic_side != "automatic")
        alignment = lane_elements(tracks, road_lines.s, frame.roads[number])
        heights = lane_heights(road_lines, road_points, number, tracks)
        if any(np.isnan(z).any() for z in heights):
            progress.warn("Neither the marking lines nor road points have heights; the trajectory's are used.")
            heights = [frame.track_height(number, road_lines.s[t.first:t.last + 1]) for t in tracks]
        courses = lane_courses(tracks, road_lines.s, frame.roads[number], alignment)
        for lane, (track, way, course, found_elements, z) in enumerate(zip(tracks, ways, courses, alignment, heights), start=1):
            _write_lane(lines, lane, track, way, course, found_elements, road_lines, z, frame, number)
            _write_elements(elements, lane, way, found_elements, number, frame.origin)
        progress.at(0.4 + 0.6 * (count + 1) / len(found))
    _say(lines, side, progress)
    return lines, elements


def road_lanes(lines, driven, settings, where):
    """The lanes of one road as a list of Track, by first station, then from right to left.

    Parameters
    ----------
    lines : Boundaries
    driven : (P, K) offset of the passes on the grid, NaN where they were not
    where : Room
    """
    room = where.clear
    kept = chosen_lines(lines, driven)
    all_strips = strips(lines, kept)
    tracks = paired_lanes(lines, all_strips, driven, room)
    lane_width = settings.lane_width or usual_width(tracks)
    gaps = settings.max_bridge, settings.max_inferred
    tracks = connect(tracks, lines, 0.0, 0.0)
    tracks = [track for track in tracks if len(track) * STEP >= settings.shortest]
    tracks = connect(tracks, lines, 0.0, settings.max_inferred)
    tracks = connect(extend(tracks, lines, kept, room, settings.max_bridge), lines, *gaps)
    tracks += divided_strips(lines, all_strips, tracks, driven, lane_width, room)
    tracks = connect(tracks, lines, *gaps)
    tracks = connect(extend(tracks, lines, kept, room, settings.max_bridge), lines, *gaps)
    half = (usual_width(tracks, painted=False) if tracks else lane_width) / 2

    def half_lane(d, side):
        return np.full(len(d), settings.line_distance) if settings.line_distance else where.half_lane(d, side, half)

    tracks = connect(tracks + lone_lanes(lines, kept, tracks, driven, half_lane, settings.max_bridge, room), lines, *gaps)
    tracks = [track.without_bridged_ends() for track in tracks]
    tracks = [track for track in tracks if track is not None and len(track) * STEP >= settings.shortest]
    return sorted(tracks, key=lambda track: (track.first, float(track.d[0])))


def _traffic_side(found, settings, progress):
    if settings.traffic_side != "automatic":
        return settings.traffic_side
    right, left = sum((side_votes(middle, driven, directions) for _, _, driven, directions, middle in found.values()),
                      np.zeros(2))
    if found and not right + left:
        progress.warn("The trajectory does not tell the side of traffic; the right was assumed. Set Side of traffic "
                      "where it is the left.")
    return "left" if left > right else "right"


def _write_lane(lines, lane, track, way, course, elements, road_lines, z, frame, number):
    origin, s = frame.origin, road_lines.s
    grid = s[track.first:track.last + 1]
    status = settled(track.status)
    functions = {}   # of curves by identity: those of long splines are long, and many pieces share one
    for code, start, end in pieces(status, track.first, s):
        rows = slice(np.searchsorted(grid, start), np.searchsorted(grid, end) + 1)
        x, y, at = _between(course, start, end, code_first=start == grid[0], code_last=end == grid[-1])
        if len(x) < 2:
            continue
        places = np.c_[x + origin[0], y + origin[1], np.interp(at, grid, z) + origin[2]]
        if way < 0:
            places = places[::-1]
        element = element_of(elements, start, end)
        curve = element.arc if element is not None else course.curve
        if id(curve) not in functions:
            functions[id(curve)] = _function(curve.moved(*origin[:2]))
        length = float(np.hypot(*np.diff(places[:, :2], axis=0).T).sum())
        lines.add(shapely.linestrings(places), road=number, lane=lane, kind="lane",
                  pattern=_patterns(track, rows, way, road_lines), direction=way,
                  source="offset" if track.offset[rows].mean() > 0.5 else "pair", status=STATUS[code], curve=curve.kind,
                  radius_m=float(curve.radius) if np.isfinite(curve.radius) else None, rmse_m=float(course.rmse),
                  station_m=start, end_m=end, offset_m=float(np.median(track.d[rows])), length_m=length,
                  width_m=float(np.median(track.width[rows])), params=functions[id(curve)])


def _patterns(track, rows, way, lines):
    """How the lines left and right of a stretch of lane are drawn in the direction of travel, as "dashed|solid"; "none" where there is no line.

    A line may be drawn otherwise farther on: the pattern is that of most places of the stretch.
    """
    names, columns = [*lines.names, "none"], np.arange(track.first, track.first + len(track))[rows]
    usual = np.array([lines.names.index(pattern) for pattern in lines.patterns], int)
    found = []
    for side in (track.left[rows], track.right[rows])[::way]:
        drawn = lines.drawn[side, columns]
        drawn = np.where(side < 0, len(lines.names), np.where(drawn < 0, usual[side], drawn))
        found.append(names[np.bincount(drawn).argmax()] or "none")
    return "|".join(found)


def _between(course, start, end, code_first, code_last):
    """Vertices of a course from one station to another, with a vertex of its own at every cut."""
    s = course.s
    inside = (s > start + 0.02) & (s < end - 0.02)
    at = np.r_[s[0] if code_first else start, s[inside], s[-1] if code_last else end]
    at = at[np.r_[True, np.diff(at) > 0]]
    return np.interp(at, s, course.x), np.interp(at, s, course.y), at


def _function(curve):
    """The numbers of a curve as JSON, those of long splines to 0.1 mm."""
    return json.dumps({name: [round(v, 4) for v in value] if isinstance(value, list) and len(value) > 4 else value
                       for name, value in curve.params().items()})


def _write_elements(elements, lane, way, found, number, origin):
    for element in found:
        arc = element.arc if way > 0 else element.arc.reversed()
        row = element_row(arc, element.complete, element.rmse, origin)
        if row is not None:
            elements.add(None, road=number, lane=lane, station_m=float(element.start), end_m=float(element.end), **row)


def _say(lines, side, progress):
    length = {name: sum(m for m, s in zip(lines.column("length_m"), lines.column("status")) if s == name) for name in STATUS}
    if len(lines):
        progress.say(f"Driving lines: {len({(r['road'], r['lane']) for r in lines.rows})} lanes, {side}-hand traffic: "
                     + ", ".join(f"{metres:.0f} m {name}" for name, metres in length.items() if metres))
    else:
        progress.warn("No two marking lines lie a lane's width apart, so there are no driving lines.")
