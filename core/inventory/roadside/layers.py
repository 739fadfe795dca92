"""The roadside as layers: lines along its foot, and points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from ...common.features import ROADSIDE, ROADSIDE_OBJECTS, Features
from .uprights import FIRST_BIN, HEIGHT_BIN

if TYPE_CHECKING:
    from .shared import Roadside

DRAWN_TOLERANCE = 0.03   # m to which lines are simplified
ON_GROUND = (FIRST_BIN + 1) * HEIGHT_BIN  # m: what is seen from here down stands on the ground, for grass hides the rest


def roadside_to_features(found: Roadside) -> tuple[Features, Features]:
    """The layers ROADSIDE (the pieces of lines with Z along the foot, on the ground) and ROADSIDE_OBJECTS (points on the ground)."""
    lines, points = Features("LineStringZ", ROADSIDE, crs=found.crs), Features("PointZ", ROADSIDE_OBJECTS, crs=found.crs)
    for number, line in enumerate(found.lines):
        road, side = line.chain.road, line.chain.side
        for status, piece in line.chain.pieces():
            places = np.stack(found.frame.to_map(road, piece.s, piece.d, piece.ground), axis=1)
            if len(places) < 2:  # the slice of a single upright
                continue
            shape = shapely.linestrings(places[_vertices(piece.s, places, found.settings.interval)])
            lines.add(shape, road=road, side=_side(side), line=number, kind=line.kind, status=status, station_m=piece.s[0],
                      end_m=piece.s[-1], offset_m=np.median(piece.d), edge_m=found.edges[road].beyond(side, piece.s, piece.d),
                      height_m=np.median(line.chain.top), foot_m=line.foot if line.foot > ON_GROUND else 0.0, length_m=shape.length)
    for road, poles in found.poles.items():
        for pole in poles:
            x, y, z = found.frame.to_map(road, np.array([pole.s]), np.array([pole.d]), np.array([pole.z]))
            side = 1 if pole.d > float(found.edges[road].middle(np.array([pole.s]))[0]) else -1
            points.add(shapely.Point(x[0], y[0], z[0]), road=road, side=_side(side), kind=pole.kind, station_m=pole.s,
                       offset_m=pole.d, edge_m=found.edges[road].beyond(side, np.array([pole.s]), np.array([pole.d])),
                       height_m=pole.height, diam_m=pole.diameter)
    return lines, points


def _vertices(s, places, interval):
    """Indices of the vertices that a line needs in plan and in height, and of one every interval."""
    needed = np.zeros(len(s), bool)
    for across in (places[:, :2], np.c_[s, places[:, 2]]):
        kept = shapely.get_coordinates(shapely.simplify(shapely.linestrings(across), DRAWN_TOLERANCE))
        needed |= np.isin(across[:, 0] + 1j * across[:, 1], kept[:, 0] + 1j * kept[:, 1])
    return np.flatnonzero(needed | np.r_[True, np.diff(np.floor(s / interval)) > 0])


def _side(side):
    return "left" if side > 0 else "right"
