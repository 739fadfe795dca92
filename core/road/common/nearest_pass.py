"""The pass that drove nearest to a curb: a curb belongs to the road, and that pass measured it best."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...common.features import Features
    from ...survey.frame.road_frame import RoadFrame


def assign_nearest_pass(features: Features, frame: RoadFrame) -> None:
    """Write the number of the pass that drove nearest into `pass` of every row that has none.

    Parameters
    ----------
    features : CURB_POINTS, placed by their station and offset, or ROAD_EDGES, placed by their middle vertex
    frame : RoadFrame
    """
    for road in frame.roads:
        rows = [k for k, row in enumerate(features.rows) if row["road"] == road.number and row.get("pass") is None]
        if not rows:
            continue
        if features.geometry_type == "PointZ":
            s, d = np.array([(features.rows[k]["station_m"], features.rows[k]["offset_m"]) for k in rows], float).T
        else:
            middle = np.array([_middle_vertex(features.geometries[k]) for k in rows])
            x, y = frame.to_local(middle[:, 0], middle[:, 1])
            s, d = road.locate(x, y)
            # the line of a side street may leave the road's frame
            s = np.where(np.isfinite(s), s, [features.rows[k]["station_m"] for k in rows])
            d = np.where(np.isfinite(d), d, 0.0)
        for k, number in zip(rows, frame.nearest_pass(road.number, s, d)):
            features.rows[k]["pass"] = int(number)


def _middle_vertex(line):
    return line.coords[len(line.coords) // 2]
