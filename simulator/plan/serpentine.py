"""A mountain road: a steep climb with hairpins, widened and super-elevated, edge lines and no curbs."""

from __future__ import annotations

import numpy as np
import shapely
from scipy.interpolate import LinearNDInterpolator

from ..parts.sides import Side
from .builder import PlanBuilder, strip
from .path import Path, path_of_elements
from .scene import PlanScene

_HAIRPIN = 12.0      # m, radius of the axis in a hairpin
_EASE = 12.0         # m of clothoid before and after the arc
_STRAIGHT = 34.0     # m between hairpins
_HALF = 3.25         # m, half the pavement on the straight
_WIDER = 1.8         # m more on the inner side of a hairpin
_LINE_FROM_EDGE = 0.30  # m from the edge of the pavement to the middle of the edge line
_LINE = 0.12         # m
_CLIMB = 0.08        # m per m
_CROWN, _BANK = 0.025, 0.06  # m per m: fall to both sides, and to the inner side of a hairpin
_BENCH = 1.2         # m beside the pavement that continue its slope
_RUN = 40.0          # m of road beyond both ends
_REACH = 16.0        # m from the axis that are surveyed


def serpentine(length: float, seed: int, radius: float, curb_height: float, gutter: float) -> PlanScene:
    """Build the scene; hairpins have a radius of 12 m, and there are no curbs: `radius`, `curb_height` and `gutter` are not used."""
    axis = _axis(length)
    s = np.arange(0.0, length + 0.1, 0.25)
    area = shapely.buffer(shapely.LineString(axis.at(s)), _REACH, cap_style="flat")
    road = PlanBuilder("serpentine", seed, area)
    turn = _Turn(axis)
    half_line = _LINE_FROM_EDGE

    def left(s):
        return turn.left(s) - half_line

    def right(s):
        return turn.right(s) + half_line

    def middle(s):
        return (left(s) + right(s)) / 2

    road.line("edge line", axis, 0.0, length, left, _LINE)
    road.line("edge line", axis, 0.0, length, right, _LINE)
    road.lane(1, 1, axis, 0.0, length, middle, left, -1)
    road.lane(1, 2, axis, 0.0, length, right, middle, 1)
    carriageway = strip(axis, -_RUN, length + _RUN, turn.right, turn.left)
    road.patch(axis, 0.12 * length, 0.12 * length + 11.0, -2.4, -0.8, 1.4)
    road.patch(axis, 0.7 * length, 0.7 * length + 8.0, 0.5, 2.3, 0.72)
    _objects(road, axis, turn, length)
    verge = Side(1, np.array([0.0, 0.8, 2.0, 24.0]), np.array([0.0, -0.04, -0.10, -0.10]), np.zeros(4), ("shoulder", "verge", "verge"))

    return road.scene(carriageway, _hillside(axis, turn, length), [verge], lambda ring, k: np.zeros(len(ring), dtype=int),
                      lambda ring, k: np.full(len(ring), "main"), [(Path(axis.at(s, -_HALF / 2)), 0.8)])


def _axis(length):
    """Straights and hairpins in turn, left and right."""
    elements, reached, sign = [(_RUN + _STRAIGHT, 0.0, 0.0)], _STRAIGHT, 1.0
    arc = np.pi * _HAIRPIN - _EASE   # a turn of 180 degrees: the two clothoids turn as far as one arc of their length
    while reached < length + _RUN:
        bend = sign / _HAIRPIN
        elements += [(_EASE, 0.0, bend), (arc, bend, bend), (_EASE, bend, 0.0), (_STRAIGHT, 0.0, 0.0)]
        reached += 2 * _EASE + arc + _STRAIGHT
        sign = -sign
    # a road that has to end in a hairpin goes on straight
    left_over, cut = length + 2 * _RUN, []
    for part, low, high in elements:
        whole = min(part, left_over)
        cut.append((whole, low, low + (high - low) * whole / part))
        left_over -= whole
        if left_over <= 0:
            break
    return path_of_elements((0.0, 0.0), np.radians(8.0), cut, -_RUN)


class _Turn:
    """Edges of the pavement beside the axis, m, and its slope."""

    def __init__(self, axis):
        self._s = np.arange(axis.start, axis.end, 0.25)
        bend = axis.curvature(self._s) * _HAIRPIN
        # widening and super-elevation begin before the bend does
        window = np.hanning(65) / np.hanning(65).sum()
        self._bend = np.convolve(np.pad(np.clip(bend, -1, 1), 32, mode="edge"), window, "valid")

    def bend(self, s):
        """1 in a hairpin to the left, -1 in one to the right, 0 on a straight."""
        return np.interp(s, self._s, self._bend)

    def left(self, s):
        return _HALF + _WIDER * np.maximum(self.bend(s), 0.0)

    def right(self, s):
        return -_HALF - _WIDER * np.maximum(-self.bend(s), 0.0)

    def height(self, s, d):
        """Height above the axis's own start, m."""
        bank = np.abs(self.bend(s))
        return _CLIMB * s - (1 - bank) * _CROWN * np.abs(d) - _BANK * self.bend(s) * d


def _hillside(axis, turn, length):
    """Height of the road and of the slopes between its turns."""
    s = np.arange(-_RUN, length + _RUN, 1.0)
    rims = []
    for d in (turn.left(s) + _BENCH, turn.right(s) - _BENCH):
        rims.append(np.column_stack([axis.at(s, d), turn.height(s, d)]))
    # beyond the road the hill goes on as it rises on the whole
    road = np.concatenate(rims)
    low, high = road[:, :2].min(axis=0) - 40.0, road[:, :2].max(axis=0) + 40.0
    plane = np.linalg.lstsq(np.column_stack([road[:, :2], np.ones(len(road))]), road[:, 2], rcond=None)[0]
    x, y = np.meshgrid(np.linspace(low[0], high[0], 9), np.linspace(low[1], high[1], 9))
    frame = np.column_stack([x.ravel(), y.ravel()])
    frame = frame[shapely.distance(shapely.points(frame), shapely.LineString(axis.at(s))) > 24.0]
    hill = np.concatenate([road, np.column_stack([frame, frame @ plane[:2] + plane[2]])])
    slopes = LinearNDInterpolator(hill[:, :2], hill[:, 2], fill_value=float(plane[2]))

    def height(places):
        along, aside = axis.locate(places)
        on = (aside < turn.left(along) + _BENCH) & (aside > turn.right(along) - _BENCH) & (along > -_RUN) & (along < length + _RUN)
        return np.where(on, turn.height(along, aside), slopes(places))

    return height


def _objects(road, axis, turn, length):
    # on the outer side of hairpins and on the side of the valley
    road.rail(axis, 0.0, length, lambda s: np.where(turn.bend(s) > 0.3, turn.right(s) - 0.8, np.where(
        turn.bend(s) < -0.3, turn.left(s) + 0.8, turn.right(s) - 0.8)))
    for place in road.along(axis, 8.0, length - 5.0, 25.0, lambda s: turn.left(s) + 0.6):
        road.pole(place, 1.0)
    for k, station in enumerate(np.arange(6.0, length - 4.0, 11.0)):
        if abs(turn.bend(np.array([station]))[0]) < 0.05:
            road.tree(axis.at(station, 8.0 if k % 2 else -7.6)[0])
