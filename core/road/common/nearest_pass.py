"""Which drive to look at beside a curb: a curb belongs to the road, and the pass that drove nearest saw it best."""

import numpy as np


def assign_nearest_pass(features, frame):
    """Write into `pass` of every row that has none the number of the pass that drove nearest.

    Parameters
    ----------
    features : Features CURB_POINTS (taken at their station and offset) or ROAD_EDGES (at the vertex in their middle)
    frame : RoadFrame
    """
    for road in frame.roads:
        rows = [k for k, row in enumerate(features.rows) if row["road"] == road.number and row.get("pass") is None]
        if not rows:
            continue
        if features.geometry_type == "PointZ":
            s, d = np.array([(features.rows[k]["station_m"], features.rows[k]["offset_m"]) for k in rows], float).T
        else:
            middle = np.array([_middle(features.geometries[k]) for k in rows])
            s, d = road.locate(*frame.to_local(*middle.T[:2]))
            # an arm of a side street may leave the road's frame
            s = np.where(np.isfinite(s), s, [features.rows[k]["station_m"] for k in rows])
            d = np.where(np.isfinite(d), d, 0.0)
        for k, number in zip(rows, frame.nearest_pass(road.number, s, d)):
            features.rows[k]["pass"] = int(number)


def _middle(line):
    return line.coords[len(line.coords) // 2]
