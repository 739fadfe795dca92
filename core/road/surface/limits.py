"""How far the road reaches on each side: to the road edge, and where none was found as far as edges before and after say."""

import numpy as np
import shapely

from ...common.schemas import of_main_curb

MAX_OPENING = 30.0   # m of missing edge across which the road keeps the line from one end to the other
EDGE_CONTINUATION = 5.0     # m that an edge's offset holds on before its first and after its last vertex


def edge_offsets(edges, frame, road, stations):
    """Offsets of the road edges at stations.

    Parameters
    ----------
    edges : Features ROAD_EDGES, or None
    frame : RoadFrame
    road : number
    stations : (N,) metres, ascending

    Returns
    -------
    dict side -> (offset (N,), seen (N,)): offset is NaN where no edge tells it,
    `seen` is where a measured or bridged edge does: not an inferred one, and not
    one carried on across an opening.
    """
    found = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        offset = np.full(len(stations), np.nan)
        seen = np.zeros(len(stations), bool)
        for geometry, row in edges or ():
            if row.get("side") != side or row.get("part", "bottom") == "top" or not of_main_curb(row) \
                    or (row.get("road") or 0) != road:
                continue
            s, d = _along(geometry, frame, road)
            if len(s) < 2:
                continue
            inside = (stations >= s[0]) & (stations <= s[-1])
            here = np.interp(stations, s, d)
            # where two lines run side by side the outer one bounds the road
            take = inside & ~(sign * offset > sign * here)
            offset[take] = here[take]
            seen[take] = row.get("status") != "inferred"
        found[side] = _continued(stations, offset), seen
    return found


def _along(geometry, frame, road):
    """Stations and offsets of a line's vertices, ascending."""
    parts = getattr(geometry, "geoms", [geometry])
    places = np.concatenate([shapely.get_coordinates(part) for part in parts]) if geometry is not None else np.empty((0, 2))
    s, d = frame.road(road).locate(*frame.to_local(*places.T)) if len(places) else (np.empty(0), np.empty(0))
    good = np.isfinite(s)
    s, d = s[good], d[good]
    order = np.argsort(s, kind="stable")
    return s[order], d[order]


def _continued(stations, offset):
    """Offsets with short openings closed by a straight line and the ends held on a little."""
    known = np.flatnonzero(np.isfinite(offset))
    if not len(known):
        return offset
    filled = np.interp(stations, stations[known], offset[known])
    after = np.searchsorted(stations[known], stations)
    s0 = stations[known][np.maximum(after - 1, 0)]
    s1 = stations[known][np.minimum(after, len(known) - 1)]
    between = (after > 0) & (after < len(known))
    near = np.minimum(np.abs(stations - s0), np.abs(stations - s1)) <= EDGE_CONTINUATION
    return np.where(np.isfinite(offset), offset, np.where((between & (s1 - s0 <= MAX_OPENING)) | near, filled, np.nan))
