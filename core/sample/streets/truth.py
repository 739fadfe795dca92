"""The truth of the simulated street, as layers in map coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..parts.truth import VERTEX_STEP, TruePlaces, Truth, densified

if TYPE_CHECKING:
    from .street import Scene

_DROPPED = 0.05   # m: lower curbs are of the kind "dropped"


def truth_of_street(scene: Scene, origin: Sequence[float], crs: str) -> Truth:
    """The true layers of a street.

    Parameters
    ----------
    scene : Scene
    origin : (3,) m, map coordinates of the local origin
    crs : WKT

    Returns
    -------
    Truth
    """
    def on_map(s, d):
        return np.column_stack(scene.to_map(s, d)) + origin

    s = _stations(0.0, scene.length)
    surface = np.vstack([on_map(s, scene.left.edge), on_map(s[::-1], -scene.right.edge)])
    return TruePlaces(_boundaries(scene, on_map), _markings(scene, on_map), _driving_lines(scene, on_map), [(surface, [])],
                      _lanes(scene, on_map), _roadside(scene, origin)).layers(crs)


def _stations(start, end):
    return np.linspace(start, end, max(2, int(np.ceil((end - start) / VERTEX_STEP)) + 1))


def _boundaries(scene, on_map):
    """Bottoms and tops of the curbs, in pieces of one kind, and the edges of the pavement where there is no curb."""
    for side, name in ((scene.left, "left"), (scene.right, "right")):
        for start, end, edge in _edge_pieces(side, scene.length):
            s = _stations(start, end)
            height = float(np.median(side.curb(s)))
            parts = [("bottom", side.borders[0]), ("top", side.borders[1])]
            for part, away in parts[:1] if edge == "pavement" else parts:
                yield on_map(s, side.sign * away), dict(side=name, part=part, kind="main", edge=edge, station_m=float(start), end_m=float(end),
                                                        height_m=height)


def _edge_pieces(side, length):
    if not side.curb_height:
        return [(0.0, length, "pavement")]
    s = np.arange(0.0, length + 1e-9, 0.01)
    dropped = side.curb(s) < _DROPPED
    cuts = np.concatenate([[0], np.flatnonzero(np.diff(dropped)) + 1, [len(s) - 1]])
    return [(s[a], s[b], "dropped" if dropped[a] else "curb") for a, b in zip(cuts[:-1], cuts[1:]) if b > a]


def _markings(scene, on_map):
    """Every marking as it was painted, including worn places."""
    for marking in scene.paint.markings:
        dash = getattr(marking, "dash", None)
        pattern = None if marking.line is None else "solid" if dash is None else "dashed"
        for outline in marking.outlines():
            yield on_map(*densified(outline).T), {
                "class": marking.kind, "line": marking.line, "pattern": pattern, "width_m": getattr(marking, "width", None),
                "wear": float(marking.wear), "station_m": float(outline[:, 0].min()), "end_m": float(outline[:, 0].max())}


def _about(lane, s):
    return dict(road=1, lane=lane.number, direction=lane.direction, station_m=float(s[0]), end_m=float(s[-1]))


def _driving_lines(scene, on_map):
    """Middles of the lanes."""
    for lane in scene.lanes:
        s = _stations(lane.stations[0], lane.stations[-1])
        d = np.interp(s, lane.stations, lane.offsets)
        bend = scene.axis.curvature(s)
        yield on_map(s, d), float(np.abs(bend / (1.0 - bend * d)).max()), _about(lane, s)


def _lanes(scene, on_map):
    """Lanes between the middles of their border lines."""
    for lane in scene.lanes:
        s = _stations(lane.stations[0], lane.stations[-1])
        middle, half = np.interp(s, lane.stations, lane.offsets), np.interp(s, lane.stations, lane.widths) / 2
        yield on_map(s, middle + half), on_map(s, middle - half), _about(lane, s)


def _roadside(scene, origin):
    """Walls, fences and the like; buildings are none of what is looked for along a road."""
    for thing in scene.running:
        if thing.kind != "building":
            offset = scene.axis.locate(*thing.foot[:1, :2].T, np.array([thing.stations[0]]), steps=3)[1]
            yield thing.foot + origin, dict(side="left" if offset[0] > 0 else "right", **thing.about())
