"""A roundabout of four arms: a ring, an island, splitter islands cut by zebra crossings, and give-way blocks at the entries.

Each arm has its own path, from the middle of the ring outward, so that traffic towards the ring is on the left of the path.
"""

from __future__ import annotations

import numpy as np
import shapely

from ..parts.paint import rectangle, zebra_bars
from ..parts.sides import Side, sidewalk
from .builder import PlanBuilder, strip
from .path import path_of_elements, path_through
from .scene import PlanScene

_RING, _ISLAND = 14.0, 7.5     # m, radii of the ring's outer curb and of the island
_DRIVEN = 10.8       # m, radius of the track
_CORNER = 10.0       # m, radius of the curbs between the ring and the arms
_HALF, _BROAD = 4.2, 5.5       # m from the middle of an arm to its curbs, far out and at the ring
_WIDENS = (24.0, 42.0)         # m from the middle of the ring
_LINE_FROM_CURB = 0.40         # m
_ZEBRA = (20.0, 24.0)          # m from the middle of the ring
_SPLITTERS = ((16.6, 19.6), (24.4, 34.0))  # m, before and after the zebra crossing
_SPLITTER_HALF = (1.50, 0.45)  # m, half the width of the island at the ring and at its far end
_TIP = 0.35          # m, radius of the corners of islands
_GIVE_WAY = 14.6     # m from the middle of the ring to the middle of the give-way blocks
_BLOCK, _GAP = 0.5, 0.3        # m
_LINE = 0.12         # m
_SOLID = 12.0        # m of solid centre line before the splitter island
_RUN = 45.0          # m of road beyond the surveyed area
_REACH = 18.0        # m beside the passes that are surveyed


def roundabout(length: float, seed: int, radius: float, curb_height: float, gutter: float) -> PlanScene:
    """Build the scene: arms that reach half the length from the middle; `radius` is not used."""
    arm = max(length / 2, _SPLITTERS[1][1] + 6.0)
    turned = np.radians(14.0)
    arms = [path_of_elements((0.0, 0.0), turned + k * np.pi / 2, [(arm + _RUN, 0.0, 0.0)]) for k in range(4)]
    passes = [(_driven(arms, 2, 0, arm, turned), 1.1), (_driven(arms, 3, 2, arm, turned), 0.9)]
    tracks = [shapely.LineString(path.at(np.arange(0.0, path.end, 0.5))) for path, _ in passes]
    area = shapely.union_all([shapely.buffer(track, _REACH, cap_style="flat") for track in tracks])
    road = PlanBuilder("roundabout", seed, area)
    centre = shapely.Point(0.0, 0.0)
    bare = [shapely.buffer(centre, _RING, quad_segs=64)]
    islands = [shapely.buffer(centre, _ISLAND, quad_segs=64)]
    lowered = []
    for k, path in enumerate(arms):
        bare.append(strip(path, 0.0, arm + _RUN, lambda u: -_half(u), _half))
        islands += [shapely.buffer(shapely.buffer(strip(path, *ends, lambda u: -_splitter(u), _splitter), -_TIP), _TIP, quad_segs=32)
                    for ends in _SPLITTERS]
        lowered.append(strip(path, _ZEBRA[0] - 0.5, _ZEBRA[1] + 0.5, 4.0, _BROAD + 1.0))
        lowered.append(strip(path, _ZEBRA[0] - 0.5, _ZEBRA[1] + 0.5, -_BROAD - 1.0, -4.0))
        _paint(road, k + 1, path, arm)
        _objects(road, path, arm)
    _give_way(road, arms)
    outer = shapely.buffer(shapely.buffer(shapely.union_all(bare), _CORNER, quad_segs=64), -_CORNER, quad_segs=64)
    carriageway = shapely.difference(outer, shapely.union_all(islands))
    road.manholes += [(*arms[2].at(29.0, 2.2)[0], 0.35), (*arms[0].at(10.5, 1.2)[0], 0.4)]
    road.patch(arms[3], 37.0, 46.0, 0.8, 2.4, 1.4)
    for angle in np.radians([20.0, 140.0, 250.0]):
        road.tree(4.2 * np.array([np.cos(angle), np.sin(angle)]))

    def height(places):
        radial = np.hypot(*places.T)
        # the ring falls outward; the arms fall to both sides, more and more beyond the ring
        aside = np.min([np.abs(path.locate(places)[1]) for path in arms[:2]], axis=0)
        share = np.clip((radial - _RING) / 12.0, 0.0, 1.0)
        return 0.008 * places[:, 0] - 0.005 * places[:, 1] - 0.02 * (1 - share) * radial - share * (0.02 * _RING + 0.02 * aside)

    grass = Side(1, np.array([0.0, 0.025, 0.175, 1.4, 24.0]), np.array([0.0, 0.0, 0.003, 0.03, 1.2]), np.array([0.0, 1.0, 1.0, 1.0, 1.0]),
                 ("curb face", "curb stone", "verge", "verge"), curb_height)
    stone = Side(1, np.array([0.0, 0.025, 0.175, 24.0]), np.array([0.0, 0.0, 0.003, 0.10]), np.array([0.0, 1.0, 1.0, 1.0]),
                 ("curb face", "curb stone", "sidewalk"), curb_height)

    def profile(ring, k):
        within = np.hypot(*ring.T).max() < _RING
        return np.full(len(ring), 0 if k == 0 else 1 if within else 2)

    def where(ring, k):
        return np.where(np.hypot(*ring.T) < _WIDENS[0], "corner", "main") if k == 0 else np.full(len(ring), "island")

    return road.scene(carriageway, height, [sidewalk(1, 0.0, curb_height), grass, stone], profile, where, passes, curb_height, lowered, gutter)


def _half(u):
    """Distance of the curbs from the middle of an arm, m, by the distance from the middle of the ring."""
    share = np.clip((u - _WIDENS[0]) / (_WIDENS[1] - _WIDENS[0]), 0.0, 1.0)
    return _BROAD + (_HALF - _BROAD) * share * share * (3 - 2 * share)


def _splitter(u):
    """Half the width of a splitter island, m."""
    return np.interp(u, [_SPLITTERS[0][0], _SPLITTERS[1][1]], _SPLITTER_HALF)


def _driven(arms, entry, leaves, arm, turned):
    """The track in along one arm, counter-clockwise round the ring, and out along another."""
    first, last = turned + entry * np.pi / 2 + np.radians(40.0), turned + leaves * np.pi / 2 - np.radians(40.0)
    last += 2 * np.pi * np.ceil((first - last) / (2 * np.pi))
    angles = np.linspace(first, last, max(3, int(round((last - first) * _DRIVEN / 2.0))))
    into, out = arms[entry], arms[leaves]
    u = np.arange(arm, 20.0, -4.0)
    return path_through(np.concatenate([
        into.at(u, (_half(u) + _border(u)) / 2), into.at(17.5, 3.3), _DRIVEN * np.column_stack([np.cos(angles), np.sin(angles)]),
        out.at(17.5, -3.3), out.at(u[::-1], -(_half(u[::-1]) + _border(u[::-1])) / 2)]))


def _border(u):
    """Where the lanes of an arm begin, m from its middle: at the splitter island, at the centre line before it."""
    return np.where(u < _SPLITTERS[1][1], _splitter(u), np.interp(u, [_SPLITTERS[1][1], _SPLITTERS[1][1] + 4.0], [_SPLITTER_HALF[1], 0.0]))


def _paint(road, number, path, arm):
    end, far = arm + 1.0, _SPLITTERS[1][1]
    mouth = float(np.sqrt((_RING + _CORNER) ** 2 - (_BROAD + _CORNER) ** 2))   # where the curbs begin to turn, and the lanes end
    road.line("centre line", path, far + 0.8, far + _SOLID, 0.0, _LINE)
    road.line("centre line", path, far + _SOLID + 3.0, end, 0.0, _LINE, dash=(3.0, 6.0))
    road.line("edge line", path, _ZEBRA[1] + 1.0, end, lambda u: _half(u) - _LINE_FROM_CURB, _LINE)
    road.line("edge line", path, _ZEBRA[1] + 1.0, end, lambda u: _LINE_FROM_CURB - _half(u), _LINE)
    for side in (1, -1):
        low, high = sorted((side * (_splitter(_ZEBRA[0]) + 0.25), side * (_BROAD - 0.3)))
        road.figure("zebra crossing", zebra_bars(*_ZEBRA, low, high, bar=0.5, gap=0.5), path)
    road.lane(number, 1, path, mouth, end, _border, lambda u: _half(u) - _LINE_FROM_CURB, -1)
    road.lane(number, 2, path, mouth, end, lambda u: _LINE_FROM_CURB - _half(u), lambda u: -_border(u), 1)


def _give_way(road, arms):
    """Rows of blocks across the entries, along the ring."""
    square = rectangle(-_BLOCK / 2, _BLOCK / 2, -_BLOCK / 2, _BLOCK / 2)
    step = (_BLOCK + _GAP) / _GIVE_WAY
    for path in arms:
        along = float(path.heading(0.0)[0])
        angles = along + np.arcsin(2.1 / _GIVE_WAY) + step * np.arange(int((_BROAD - 2.1) / (_BLOCK + _GAP)) + 1)
        blocks = []
        for angle in angles:
            out = np.array([np.cos(angle), np.sin(angle)])
            blocks.append(_GIVE_WAY * out + square[:, :1] * out + square[:, 1:] * np.array([-out[1], out[0]]))
        road.figure("stop line", blocks)


def _objects(road, path, arm):
    for place in (path.at(_ZEBRA[1] + 0.9, _BROAD + 0.8)[0], path.at(_ZEBRA[0] - 0.9, -_BROAD - 0.8)[0]):
        road.pole(place, 2.6, 0.05)
    road.pole(path.at(_SPLITTERS[1][1] - 1.0, 0.0)[0], 1.2, 0.06)
    for place in road.along(path, 31.0, arm + 8.0, 13.0, 8.2):
        road.tree(place)
    for place in road.along(path, 36.0, arm + 8.0, 15.0, -8.4):
        road.tree(place)
