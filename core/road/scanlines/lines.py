"""Boundary lines through the corners of curbs: bottom and top, left and right, cut by what was measured."""

import numpy as np
import shapely

from ...features import Features
from ...progress import Progress
from ...schemas import ROAD_EDGES
from ..edges import HIDDEN_SHARE, HIDDEN_STEP, SHARPEST, SHORTEST, STEP_ACROSS, VERTEX, EdgeCurve, without_outliers
from ..nearest_pass import name_passes
from ..profiles.sides import SIDES

MEASURED_GAP = 1.0   # m between corners that follow on each other; wider gaps are joined, but not measured

_POINT = [("s", float), ("d", float), ("x", float), ("y", float), ("z", float), ("height", float), ("chain", int)]


def boundary_lines(corners, frame, max_gap, progress=Progress()):
    """Smooth lines through corners, bottoms and tops apart.

    Parameters
    ----------
    corners : Features CURB_POINTS with `part` bottom or top
    frame : RoadFrame
    max_gap : m between corners that are joined

    Returns
    -------
    Features with the fields of ROAD_EDGES: LineStringZ along the road, one piece for each
    stretch of one status: measured; bridged, a gap between corners; occluded, a gap that
    something hides. Pieces of one line share their end vertices and `chain`.
    """
    lines = Features("LineStringZ", list(ROAD_EDGES), crs=corners.crs)
    number = 0
    for road in frame.roads:
        for side in SIDES:
            hidden = np.sort([row["station_m"] for row in corners.rows
                              if row["road"] == road.number and row["side"] == side and row["status"] == "occluded"])
            for part in ("bottom", "top"):
                for points, status in _pieces(_points(corners, road.number, side, part), hidden, max_gap):
                    _draw(lines, points, status, road=road.number, side=side, part=part, chain=number)
                    number += 1
    name_passes(lines, frame)
    length = {part: sum(row["length_m"] for row in lines.rows if row["part"] == part) for part in ("bottom", "top")}
    progress.say(f"Boundaries: {length['bottom']:.0f} m of bottom lines and {length['top']:.0f} m of top lines.")
    progress.at(1.0)
    return lines


def _points(corners, road, side, part):
    """The measured corners of one kind, sorted by station."""
    rows = [(row["station_m"], row["offset_m"], g.x, g.y, g.z, row.get("height_m") or 0.0, row["chain"]) for g, row in corners
            if row["road"] == road and row["side"] == side and row["part"] == part and row["status"] == "measured"]
    points = np.array(rows, dtype=_POINT)
    return without_outliers(points[np.argsort(points["s"], kind="stable")])


def _pieces(points, hidden, max_gap):
    """Points parted where the line breaks: lists of (points, status of each gap to the next)."""
    if len(points) < 2:
        return []
    gap, across = np.diff(points["s"]), np.abs(np.diff(points["d"]))
    near = gap <= MEASURED_GAP
    joined = (near | (gap <= max_gap)) & (across <= STEP_ACROSS + SHARPEST * gap)
    covered = HIDDEN_STEP * (np.searchsorted(hidden, points["s"][1:]) - np.searchsorted(hidden, points["s"][:-1], side="right"))
    status = np.where(near, "measured", np.where(covered >= HIDDEN_SHARE * gap, "occluded", "bridged"))
    breaks = np.flatnonzero(~joined) + 1
    parts = zip(np.split(points, breaks), np.split(np.append(status, ""), breaks))
    return [(part, flags[:-1]) for part, flags in parts if len(part) >= 2 and part["s"][-1] - part["s"][0] >= SHORTEST]


def _draw(lines, points, status, **fields):
    """Add the pieces of one line."""
    curve = EdgeCurve(points)
    bounds = np.r_[0, np.flatnonzero(status[1:] != status[:-1]) + 1, len(points) - 1]
    for i, j in zip(bounds[:-1], bounds[1:]):
        a, b = curve.t[i], curve.t[j]
        vertices = curve.at(np.linspace(a, b, max(int(np.ceil((b - a) / VERTEX)), 1) + 1))
        rows = points[i:j + 1]
        lines.add(shapely.linestrings(np.round(vertices, 4)), status=str(status[i]), kind="main",
                  station_m=round(float(rows["s"][0]), 3), end_m=round(float(rows["s"][-1]), 3),
                  height_m=round(float(np.median(rows["height"])), 3),
                  length_m=round(float(np.hypot(*np.diff(vertices[:, :2], axis=0).T).sum()), 3),
                  rmse_m=round(float(np.sqrt(np.mean(curve.residual[i:j + 1] ** 2))), 4), **fields)
