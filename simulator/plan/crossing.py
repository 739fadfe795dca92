"""A signalised crossing of four arms, with turning lanes, arrows, stop lines, zebra crossings and dropped curbs.

Each arm has its own path, from the middle of the crossing outward, so that traffic towards the crossing is on the left of the path.
"""

from __future__ import annotations

import numpy as np
import shapely

from ..parts.paint import left_arrow, rectangle, turn_arrow, zebra_bars
from ..parts.sides import sidewalk
from .builder import PlanBuilder, strip
from .path import path_of_elements, path_through
from .scene import PlanScene

# Offsets on an arm, m
_IN_CURB, _OUT_CURB = 7.0, -4.4      # curbs beside the traffic towards and away from the crossing
_IN_LINE, _OUT_LINE = 6.5, -3.95     # edge lines
_BETWEEN = 3.25                      # line between the lane to the left and the one straight on and to the right
_CORNER = 8.0        # m, radius of the curbs
# m from the middle of the crossing: the curbs beside the traffic towards and away from it turn there, and the lanes end
_IN_MOUTH, _OUT_MOUTH = _CORNER - _OUT_CURB, _CORNER + _IN_CURB
_ZEBRA = (16.2, 19.4)    # m from the middle of the crossing
_STOP = (20.6, 21.1)
_DROPPED = 0.5       # m of dropped curb beyond both ends of a zebra crossing, before the ramp
_SOLID = 42.0        # m from the middle of the crossing: lines are solid up to here
_LINE = 0.12         # m
_FALL = 0.02         # m per m, across the arms
_RUN = 45.0          # m of road beyond the surveyed area
_REACH = 18.0        # m beside the passes that are surveyed


def crossing(length: float, seed: int, radius: float, curb_height: float, gutter: float) -> PlanScene:
    """Build the scene: arms of half the length each; `radius` is not used."""
    arm = max(length / 2, _STOP[1] + 8.0)
    # to the east, north, west and south, a little turned so that nothing runs along a row of the grid
    turned = np.radians(9.0)
    arms = [path_of_elements((0.0, 0.0), turned + k * np.pi / 2, [(arm + _RUN, 0.0, 0.0)]) for k in range(4)]
    east, north, west, south = arms
    straight = path_through(np.concatenate([west.at(np.arange(arm, 20.0, -4.0), 4.875), east.at(np.arange(18.0, arm + 2.0, 4.0), -1.95)]))
    bend = path_through(np.concatenate([south.at(np.arange(arm, 10.0, -4.0), 1.65), west.at(np.arange(12.0, arm + 2.0, 4.0), -1.95)]))
    passes = [(straight, 1.2), (bend, 1.0)]
    tracks = [shapely.LineString(path.at(np.arange(0.0, path.end, 0.5))) for path, _ in passes]
    area = shapely.union_all([shapely.buffer(track, _REACH, cap_style="flat") for track in tracks])
    road = PlanBuilder("crossing", seed, area)
    lowered = []
    for k, path in enumerate(arms):
        lowered.append(strip(path, _ZEBRA[0] - _DROPPED, _ZEBRA[1] + _DROPPED, _OUT_CURB - 1.0, _IN_CURB + 1.0))
        _paint(road, k + 1, path, arm)
        _objects(road, path, arm, k)
    road.manholes += [(*middle, 0.35) for middle in (west.at(9.0, 2.1)[0], east.at(31.0, -1.7)[0], south.at(26.0, 4.6)[0])]
    road.patch(west, 27.0, 36.0, 3.9, 5.8, 1.4)
    road.patch(east, 24.0, 31.0, -3.3, -0.7, 0.72)
    bare = shapely.union_all([strip(path, 0.0, arm + _RUN, _OUT_CURB, _IN_CURB) for path in arms])
    # the wedges between the curbs of neighbouring arms get round corners
    carriageway = shapely.buffer(shapely.buffer(bare, _CORNER, quad_segs=64), -_CORNER, quad_segs=64)

    def height(places):
        distances = [np.abs(path.locate(places)[1]) for path in (east, north)]
        return 0.010 * places[:, 0] + 0.006 * places[:, 1] - _FALL * np.minimum(*distances)

    def where(ring, k):
        out = np.max([path.locate(ring)[0] for path in arms], axis=0)
        main = np.max([path.locate(ring)[0] for path in (east, west)], axis=0) == out
        tangent = np.where(_leftward(arms, ring), _IN_MOUTH, _OUT_MOUTH)
        return np.where(out < tangent + 0.1, "corner", np.where(main, "main", "side_street"))

    return road.scene(carriageway, height, [sidewalk(1, 0.0, curb_height)], lambda ring, k: np.zeros(len(ring), dtype=int), where, passes,
                      curb_height, lowered, gutter)


def _leftward(arms, places):
    """Whether places lie left of the arm that they are farthest out on."""
    located = np.array([path.locate(places) for path in arms])
    return np.take_along_axis(located[:, 1], located[:, 0].argmax(axis=0)[None], axis=0)[0] > 0


def _paint(road, number, path, arm):
    end = arm + 1.0
    road.line("centre line", path, _STOP[1], min(_SOLID, end), 0.0, _LINE)
    road.line("centre line", path, _SOLID + 3.0, end, 0.0, _LINE, dash=(3.0, 6.0))
    road.line("lane line", path, _STOP[1], min(_SOLID, end), _BETWEEN, _LINE)
    road.line("lane line", path, _SOLID + 3.0, end, _BETWEEN, _LINE, dash=(3.0, 6.0))
    road.line("edge line", path, _STOP[1], end, _IN_LINE, _LINE)
    road.line("edge line", path, _ZEBRA[1] + 0.5, end, _OUT_LINE, _LINE)
    road.figure("stop line", [rectangle(*_STOP, _LINE, _IN_LINE - 0.1)], path)
    road.figure("zebra crossing", zebra_bars(*_ZEBRA, _OUT_CURB + 0.35, _IN_CURB - 0.35, bar=0.5, gap=0.5), path)
    for tip in (26.0, 38.0):
        # arrows point towards the crossing, against the path
        road.figure("arrow", [left_arrow(tip + 4.5, _BETWEEN / 2, -1)], path)
        road.figure("arrow", [turn_arrow(tip + 4.5, (_BETWEEN + _IN_LINE) / 2, -1)], path)
    road.lane(number, 1, path, _IN_MOUTH, end, 0.0, _BETWEEN, -1)
    road.lane(number, 2, path, _IN_MOUTH, end, _BETWEEN, _IN_LINE, -1)
    road.lane(number, 3, path, _OUT_MOUTH, end, _OUT_LINE, 0.0, 1)


def _objects(road, path, arm, k):
    for place in (path.at(_STOP[0], _IN_CURB + 0.7)[0], path.at(_ZEBRA[0] - 0.8, _OUT_CURB - 0.7)[0]):
        road.pole(place, 3.6, 0.07)
    for place in road.along(path, 27.0, arm + 8.0, 12.0, _IN_CURB + 2.6):
        road.tree(place)
    for place in road.along(path, 31.0, arm + 8.0, 14.0, _OUT_CURB - 2.6):
        road.tree(place)
    # cars that wait in the arms where nobody surveys, and one in the lane to the left of the arm opposite
    heading = float(path.heading(0.0)[0]) + np.pi
    if k in (0, 1):
        road.car(path.at(_STOP[1] + 3.6, _BETWEEN / 2)[0], heading)
    if k == 1:
        road.car(path.at(_STOP[1] + 10.2, _BETWEEN / 2)[0], heading)
        road.car(path.at(_STOP[1] + 3.9, (_BETWEEN + _IN_LINE) / 2)[0], heading)
