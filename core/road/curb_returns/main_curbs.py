"""The main curbs of a road as the search in plan needs them: where they run, and how far out is searched beside them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ...survey.frame.road import Road
from ...survey.open_survey import Survey
from ...survey.weights import FRAME
from ..common.curb_points import CurbPoints
from ..common.sides import SIDE_SIGNS, expected_height
from ..weights import CURBS, RETURN
from .steps import PlanSteps


def main_curbs_of(curb_points: CurbPoints, survey: Survey, road: int) -> tuple[dict[str, np.ndarray], int]:
    """Main curbs of a road and the first free chain number: side -> (N, 4) station, offset, height above the expected road in m, and 1 where it was
    measured, 0 where it is hidden; by station."""
    main, curbs = {}, curb_points[curb_points.road == road]
    for side in SIDE_SIGNS:
        of_side = curbs[(curbs.side == side) & (curbs.part == "bottom")]
        rows = np.c_[of_side.station, of_side.offset, of_side.z, of_side.status == "measured"]
        rows = rows[np.argsort(rows[:, 0], kind="stable")]
        if len(rows):
            rows[:, 2] -= expected_height(survey, road, rows[:, 0])
        main[side] = rows
    return main, int(curbs.chain.max(initial=-1)) + 1


def usual_height(curb_points: CurbPoints) -> float:
    """m, height of the curbs of a road as they are where nothing lowers them; NaN where none was measured."""
    heights = curb_points.height[(curb_points.part == "bottom") & (curb_points.status == "measured")]
    heights = heights[np.isfinite(heights)]
    return float(np.quantile(heights, RETURN.full_height)) if len(heights) else np.nan


class SearchLimit:
    """How far out one side is searched: to a little behind the main curb, and everywhere at openings.

    points : (N, 4) of the main curb, as of `main_curbs_of`
    sign : of the side's offsets
    """

    def __init__(self, points: np.ndarray, sign: int):
        self.sign = sign
        self.s, self.u = points[:, 0], sign * points[:, 1]
        cuts = np.flatnonzero(np.diff(self.s) > RETURN.min_opening_length) + 1
        # where runs of curb begin and end, both ascending: which of them is near a place is looked up
        self.begins, self.ends = (np.array([part[k] for part in np.split(self.s, cuts) if len(part)], float) for k in (0, -1))

    def __call__(self, s: np.ndarray, behind: float = RETURN.search_behind_curb, at_opening: float = RETURN.opening_margin) -> np.ndarray:
        """(N,) m, largest outward offset at (N,) stations: `behind` metres behind the curb, except for its last metres beside openings."""
        if not len(self.s):
            return np.full(len(s), FRAME.corridor)
        k = np.searchsorted(self.begins + at_opening, s) - 1
        bounded = (k >= 0) & (s < self.ends[k] - at_opening)
        return np.where(bounded, np.interp(s, self.s, self.u) + behind, FRAME.corridor)

    def outward(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) m from the main curb outward to places at (N,) stations and offsets; at openings from the end of what is searched."""
        return self.sign * d - self(s, 0.0, 0.0)

    def behind(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) bool, do places at (N,) stations and offsets lie behind the main curb? Those of a side street lie beyond its end.

        A side street leaves at 45° or more: what lies as far out from the curb as its end is away may belong to one.
        """
        out = self.outward(s, d)
        if not len(self.begins):
            return np.zeros(len(s), bool)
        k = np.searchsorted(self.begins, s, side="right") - 1
        return (out > 0.0) & (k >= 0) & (out < np.minimum(s - self.begins[k], self.ends[k] - s))

    def far_from(self, s: np.ndarray, distance: float) -> np.ndarray:
        """(N,) bool, is no main curb known within a distance along the road of (N,) stations?"""
        if not len(self.begins):
            return np.ones(len(s), bool)
        k = np.searchsorted(self.begins - distance, s, side="right") - 1
        return (k < 0) | (s > self.ends[k] + distance)


def places_along(line: Road, main: Mapping[str, np.ndarray], gap: float) -> np.ndarray:
    """(N, 2) local places along the main curbs, with gaps of up to `gap` metres between their points closed."""
    places = [np.empty((0, 2))]
    for points in main.values():
        for run in _split(points, gap):
            s = np.arange(run[0, 0], run[-1, 0] + RETURN.plan_cell, RETURN.plan_cell)
            places.append(np.c_[line.to_map(s, np.interp(s, run[:, 0], run[:, 1]))])
    return np.concatenate(places)


def _split(points, gap=CURBS.max_joined_gap):
    if not len(points):
        return []
    breaks = (np.diff(points[:, 0]) > gap) | (np.abs(np.diff(points[:, 1])) > RETURN.max_run_jump + np.diff(points[:, 0]))
    return np.split(points, np.flatnonzero(breaks) + 1)


def main_runs(main: Mapping[str, np.ndarray], line: Road) -> list[tuple]:
    """Main curbs as polylines in plan with uphill on the right: list of (side, (x, y, h))."""
    runs = []
    for side, points in main.items():
        for run in _split(points):
            if len(run) > 1:
                run = run[::-1] if side == "left" else run
                runs.append((side, (*line.to_map(run[:, 0], run[:, 1]), run[:, 2])))
    return runs


class KnownPlaces:
    """Places along main curbs, where no other curb is looked for. places : (N, 2) local metres"""

    def __init__(self, places: np.ndarray):
        self._trees = [cKDTree(places)]

    def __getstate__(self) -> dict:
        return dict(places=np.concatenate([tree.data for tree in self._trees]))

    def and_places(self, x: np.ndarray, y: np.ndarray) -> KnownPlaces:
        """These and (N,) further places; what is known of these is not made anew for every few that come."""
        result = KnownPlaces(np.c_[x, y])
        result._trees = self._trees + result._trees
        # trees of like size are joined, so that a place is put into few of them, and few are asked
        while len(result._trees) > 1 and 2 * result._trees[-1].n >= result._trees[-2].n:
            result._trees[-2:] = [cKDTree(np.concatenate([tree.data for tree in result._trees[-2:]]))]
        return result

    def and_steps(self, lines: Sequence[PlanSteps]) -> KnownPlaces:
        """These and the places of lines of steps."""
        return self.and_places(*(np.concatenate([np.empty(0), *(getattr(steps, axis) for steps in lines)]) for axis in "xy"))

    def within(self, x: np.ndarray, y: np.ndarray, distance: float) -> np.ndarray:
        """(N,) bool, is one of the places within a distance of (N,) local places?"""
        inside = np.zeros(len(x), bool)
        for tree in self._trees if len(x) else ():
            if tree.n:
                # the tree finds what is nearer than its bound
                inside |= tree.query(np.c_[x, y], distance_upper_bound=np.nextafter(distance, np.inf))[0] <= distance
        return inside


# Lines of curb in plan, among which those near a place are looked up: a long road has many of them.


def tips_of(runs: Sequence[tuple]) -> cKDTree:
    """Local x, y of both ends of main curbs as of `main_runs`."""
    return cKDTree(np.concatenate([np.empty((0, 2)), *(np.c_[x, y][[0, -1]] for _, (x, y, _) in runs)]))


def line_tree(lines: Sequence[tuple[np.ndarray, np.ndarray]]) -> shapely.STRtree:
    """Lines (x, y), each (N,) local m."""
    return shapely.STRtree([shapely.linestrings(x, y) for x, y in lines if len(x) > 1])


def median_distance(lines: shapely.STRtree, x: np.ndarray, y: np.ndarray) -> float:
    """m from (N,) places to the nearest line, the median; infinite where there is none."""
    _, distance = lines.query_nearest(shapely.points(x, y), return_distance=True, all_matches=False)
    return float(np.median(distance)) if len(distance) else np.inf
