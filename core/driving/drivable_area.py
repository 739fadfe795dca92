"""Where a lane cannot be: on a curb, or on a hatched area."""

import numpy as np
import shapely

from .settings import NARROWEST

ON_CURB = 0.3       # share of a lane's width: a curb this near its middle runs along the lane
MOSTLY = 0.5        # of its length beside such a curb, and it is no lane
HATCHED = 0.25      # of its middle on the stripes of a hatched area (they cover less than half of it)


class Room:
    """Says of a Track whether it is where a lane can be.

    Parameters
    ----------
    lines : Boundaries of the road
    frame : RoadFrame
    number : of the road
    curbs : Boundaries made from the road edges, or None
    markings : Features MARKINGS or None
    """

    def __init__(self, lines, frame, number, curbs, markings):
        self.s, self.road, self.origin = lines.s, frame.roads[number], frame.origin
        self.curbs = np.empty((0, len(lines.s)))
        if curbs is not None:
            self.curbs = np.array([np.interp(lines.s, curbs.s, row, left=np.nan, right=np.nan) for row in curbs.d])
        hatched = [] if markings is None else [
            shapely.force_2d(geometry) for geometry, row in markings
            if row.get("class") == "hatch" and geometry is not None and not geometry.is_empty]
        self.hatched = shapely.union_all(hatched) if hatched else None
        if self.hatched is not None:
            shapely.prepare(self.hatched)

    def clear(self, track):
        window = slice(track.first, track.last + 1)
        if len(self.curbs):
            with np.errstate(invalid="ignore"):
                beside = (np.abs(self.curbs[:, window] - track.d) < ON_CURB * track.width).any(0)
            if beside.mean() > MOSTLY:
                return False
        if self.hatched is not None:
            x, y = self.road.to_map(self.s[window], track.d)
            return shapely.contains_xy(self.hatched, x + self.origin[0], y + self.origin[1]).mean() < HATCHED
        return True

    def half_lane(self, d, side, half):
        """(K,) metres from a line at offsets d (K,) to the middle of a lane on one side of it: `half`, or less where a curb leaves less.

        A curb counts that is known along most of the line; over its gaps it goes on from end to end.
        """
        beyond = side * (self.curbs - d)
        with np.errstate(invalid="ignore"):
            nearest = np.where(beyond > NARROWEST, beyond, np.inf).min(axis=0, initial=np.inf)
        known = np.flatnonzero(np.isfinite(nearest))
        if len(known) <= MOSTLY * np.isfinite(d).sum():
            return np.full(len(d), half)
        return np.minimum(half, np.interp(np.arange(len(d)), known, nearest[known]) / 2)
