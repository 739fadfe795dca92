"""The reference line of a road: the smoothed track of its longest pass, continued by other passes."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

from ...common.errors import RoadExtractionError
from .passes import LEVEL_SEPARATION, SAME_CARRIAGEWAY, moving_rows

NODE_SPACING = 0.1     # m between nodes of the reference line: 0.02 mm of sagitta at R = 60 m
LINE_SMOOTHING = 2.0   # m, sigma: removes noise from the heading; offsets are measured from the smoothed line
FRAME_EXTENSION = 10.0  # m beyond the driven part: scanners measure ahead and behind
SPARSE_TRACK_SPACING = 2.0  # m between rows: beyond it, chords would cut the bends, so a spline is used
JUNCTION_GAP = 15.0    # m between the end of one pass and the start of the next that continues the road
MAX_LATERAL_JUMP = 6.0  # m to the side: another lane of the same carriageway
MAX_JUNCTION_ANGLE = np.radians(30.0)
LANE_BLEND_LENGTH = 40.0  # m over which a continuing pass in another lane is blended into the line


def track_line(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """(M, 3) positions at least half a metre apart along a track of (N,) x, y and z in metres."""
    rows = moving_rows(x, y)
    return np.c_[x, y, z][rows]


def reference_nodes(line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nodes of the reference line, NODE_SPACING apart, extended by FRAME_EXTENSION at both ends.

    Parameters
    ----------
    line : (N, 2) or (N, 3) positions of the track, m

    Returns
    -------
    x, y : (M,) m

    Raises
    ------
    RoadExtractionError
        If the track does not move.
    """
    x, y = line[:, 0], line[:, 1]
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    unique = np.r_[True, np.diff(driven) > 0]
    driven, x, y = driven[unique], x[unique], y[unique]
    if driven[-1] < 1.0:
        raise RoadExtractionError("The trajectory does not move: at least 1 m of driving is needed to define a road.")
    u = np.arange(0.0, driven[-1] + NODE_SPACING / 2, NODE_SPACING)
    if np.median(np.diff(driven)) > SPARSE_TRACK_SPACING and len(driven) > 3:
        x, y = CubicSpline(driven, x)(u), CubicSpline(driven, y)(u)
    else:
        x, y = np.interp(u, driven, x), np.interp(u, driven, y)
    x, y = _extend(_smooth(x), _smooth(y))
    along = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    u = np.arange(0.0, along[-1], NODE_SPACING)
    return np.interp(u, along, x), np.interp(u, along, y)


def _smooth(values):
    """Gaussian smoothing along the line, point-reflected at the end points so that these stay."""
    pad = min(int(4 * LINE_SMOOTHING / NODE_SPACING), len(values) - 1)
    head = 2 * values[0] - values[1:pad + 1][::-1]
    tail = 2 * values[-1] - values[-pad - 1:-1][::-1]
    return gaussian_filter1d(np.r_[head, values, tail], LINE_SMOOTHING / NODE_SPACING)[pad:pad + len(values)]


def _extend(x, y):
    reach = min(int(3.0 / NODE_SPACING), len(x) - 1)
    steps = np.arange(1, int(round(FRAME_EXTENSION / NODE_SPACING)) + 1) * NODE_SPACING

    def beyond(tip, inner):
        direction = np.array([x[tip] - x[inner], y[tip] - y[inner]])
        direction /= np.hypot(*direction)
        return x[tip] + steps * direction[0], y[tip] + steps * direction[1]

    hx, hy = beyond(0, reach)
    tx, ty = beyond(-1, len(x) - 1 - reach)
    return np.r_[hx[::-1], x, tx], np.r_[hy[::-1], y, ty]


def continue_line(line: np.ndarray, track: np.ndarray) -> np.ndarray | None:
    """A line lengthened by a track that continues it at either end, driven in either direction.

    Parameters
    ----------
    line, track : (N, 3) positions as returned by `track_line`

    Returns
    -------
    (M, 3) positions in the direction of `line`; None if the track does not continue it
    """
    for way in (track, track[::-1]):
        found = _append_track(line, way)
        if found is not None:
            return found
        found = _append_track(line[::-1], way)
        if found is not None:
            return found[::-1]
    return None


def _append_track(line, track):
    direction = _direction(line[::-1]) * -1.0
    ahead = (track[:, :2] - line[-1, :2]) @ direction
    aside = (track[:, :2] - line[-1, :2]) @ np.array([-direction[1], direction[0]])
    if not (-JUNCTION_GAP < ahead[0] < JUNCTION_GAP and abs(aside[0]) < MAX_LATERAL_JUMP and abs(track[0, 2] - line[-1, 2]) < LEVEL_SEPARATION):
        return None
    if np.arccos(np.clip(_direction(track) @ direction, -1, 1)) > MAX_JUNCTION_ANGLE:
        return None
    beyond = track[int(np.argmax(ahead > 1.0)):] if (ahead > 1.0).any() else track[:0]
    if len(beyond) < 3:
        return None
    driven = np.r_[0.0, np.cumsum(np.hypot(*np.diff(beyond[:, :2], axis=0).T))]
    if _comes_back(line, beyond, driven):
        return None
    step = np.gradient(beyond[:, :2], axis=0)
    left = np.c_[-step[:, 1], step[:, 0]] / np.maximum(np.hypot(*step.T), 1e-9)[:, None]
    share = np.clip(1.0 - driven / LANE_BLEND_LENGTH, 0.0, 1.0)
    share = share * share * (3.0 - 2.0 * share)
    beyond = beyond.copy()
    beyond[:, :2] -= left * (aside[0] * share)[:, None]
    return np.concatenate([line, beyond])


def _comes_back(line, beyond, driven):
    """Whether a continuation approaches the line anywhere but at its end: a position would have two stations."""
    left = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line[::-1, :2], axis=0).T))][::-1]
    for old, new in ((line[left > 3 * SAME_CARRIAGEWAY], beyond), (line, beyond[driven > 3 * SAME_CARRIAGEWAY])):
        if len(old) and len(new) and cKDTree(old[:, :2]).query(new[:, :2])[0].min() < SAME_CARRIAGEWAY:
            return True
    return False


def _direction(line):
    """Unit vector of the first five metres of a line."""
    far = np.hypot(*(line[:, :2] - line[0, :2]).T) > 5.0
    step = line[int(np.argmax(far)) if far.any() else -1, :2] - line[0, :2]
    return step / max(np.hypot(*step), 1e-9)
