"""Where a lane can be: not on a curb, and not on a hatched area."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from ..markings.objects.marking_objects import MarkingObjects
from .cross_section import CrossSections
from .lane_tracking import LaneTrack
from .settings import MIN_LANE_WIDTH

if TYPE_CHECKING:
    from ..survey.frame.road_frame import RoadFrame

CURB_CLEARANCE_SHARE = 0.3  # share of a lane's width: a curb this near its middle runs along the lane
MAX_CURB_SHARE = 0.5        # of its length beside such a curb, and it is no lane
MAX_HATCHED_SHARE = 0.25    # of its middle on the stripes of a hatched area (they cover less than half of it)


class DrivableArea:
    """Answers whether a LaneTrack is where a lane can be.

    Parameters
    ----------
    lines : CrossSections of the road
    frame : RoadFrame
    number : of the road
    curbs : CrossSections of the road edges, or None
    markings : MarkingObjects or None
    """

    def __init__(self, lines: CrossSections, frame: RoadFrame, number: int, curbs: CrossSections | None,
                 markings: MarkingObjects | None) -> None:
        self.s, self.road = lines.s, frame.roads[number]
        self.curbs = np.empty((0, len(lines.s)))
        if curbs is not None:
            self.curbs = np.array([np.interp(lines.s, curbs.s, row, left=np.nan, right=np.nan) for row in curbs.d])
        self.hatched = None
        if markings is not None and (markings.kind == "hatch").any():
            self.hatched = shapely.union_all(shapely.force_2d(markings.outlines.polygons()[markings.kind == "hatch"]))
            shapely.prepare(self.hatched)

    def clear(self, track: LaneTrack) -> bool:
        """Whether neither a curb nor a hatched area lies in the way of a LaneTrack."""
        window = slice(track.first, track.last + 1)
        if len(self.curbs):
            with np.errstate(invalid="ignore"):
                beside = (np.abs(self.curbs[:, window] - track.d) < CURB_CLEARANCE_SHARE * track.width).any(0)
            if beside.mean() > MAX_CURB_SHARE:
                return False
        if self.hatched is not None:
            return bool(shapely.contains_xy(self.hatched, *self.road.to_map(self.s[window], track.d)).mean() < MAX_HATCHED_SHARE)
        return True

    def half_lane(self, d: np.ndarray, side: int, half: float) -> np.ndarray:
        """Distance from a line to the middle of a lane on one side of it: `half`, or less where a curb leaves less.

        Parameters
        ----------
        d : (K,) metres, offsets of the line at the stations of the road, NaN where it is not
        side : 1 for the lane on the left, -1 on the right
        half : metres

        Returns
        -------
        (K,) metres. A curb counts that is known along most of the line; over its gaps it goes on from end to end.
        """
        beyond = side * (self.curbs - d)
        with np.errstate(invalid="ignore"):
            nearest = np.where(beyond > MIN_LANE_WIDTH, beyond, np.inf).min(axis=0, initial=np.inf)
        known = np.flatnonzero(np.isfinite(nearest))
        if len(known) <= MAX_CURB_SHARE * np.isfinite(d).sum():
            return np.full(len(d), half)
        return np.minimum(half, np.interp(np.arange(len(d)), known, nearest[known]) / 2)
