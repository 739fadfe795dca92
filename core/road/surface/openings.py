"""Side streets: where an edge is open, the road goes on through the opening as far as its ground was scanned.

An opening between two edges is closed by a straight line at first. Behind the mouth of a street lies road with its zebra
crossing and its lines: ground as level and as smooth as the road, wide and deep enough for a street, and lower than the
sidewalks on its sides. Behind a dropped curb lies a sidewalk that goes on to both sides at one height. The rules are our own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import median_filter

from .ground_change import ROUGHNESS_FACTOR, ROUGHNESS_FLOOR
from .ground_grid import COLUMN_WIDTH, ROW_LENGTH, GroundCells

if TYPE_CHECKING:
    from ...survey.frame.road_frame import RoadFrame

MIN_MOUTH_WIDTH = 7.0          # m along the road: a lane of 3 m with corners of 2 m radius; driveways and dropped curbs are narrower
MIN_STREET_WIDTH = 2.5         # m: a lane
MIN_MOUTH_DEPTH = 5.0          # m beyond the line that closes the opening in which the street is still as wide: one car's length
FLANK_DEPTH = 2.0              # m beyond that line from which the sides of the street are looked at: nearer, its corners are dropped
FLANK_ROWS = 2                 # 1 m along the road from the outermost cell of the street to the ground beside it
MIN_FLANK_STEP = 0.03          # m between them: the lowest curbs
MAX_LEVEL_FLANKS = 1 / 3       # of the places along its sides that may lie level with the street: driveways and crossings of its own
MAX_UNSEEN_COLUMNS = 5         # 1.25 m across the road between two tracks of the scan, far from the vehicle
STEP_COLUMNS = 2               # 0.5 m of other ground end the street; one cell alone is a thing on it
SMOOTHED_ROWS = 5              # 2.5 m along the road: the far end of the scan frays


def street_ground(cells: GroundCells, ground: np.ndarray, right: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Cells of ground that are no rougher than the road.

    Parameters
    ----------
    cells : GroundCells, R rows and C columns
    ground : (R, C) bool, cells at the height of the road
    right, left : (R,) m, limits of the road; NaN where unknown

    Returns
    -------
    (R, C) bool
    """
    offsets = cells.offsets
    with np.errstate(invalid="ignore"):
        inside = (offsets > right[:, None]) & (offsets < left[:, None]) & np.isfinite(cells.rough)
        usual = np.median(cells.rough[inside]) if inside.any() else 0.0
        return ground & ~(cells.rough > ROUGHNESS_FACTOR * usual + ROUGHNESS_FLOOR)


def cells_driven(frame: RoadFrame, road: int, cells: GroundCells) -> np.ndarray:
    """Cells of one road that the reference lines of the other roads run through.

    Parameters
    ----------
    frame : RoadFrame
    road : number of the road
    cells : GroundCells of it, R rows and C columns

    Returns
    -------
    (R, C) bool
    """
    driven = np.zeros(cells.height.shape, bool)
    for other in frame.roads:
        if other.number == road:
            continue
        s, d = frame.road(road).locate(*other.to_map(np.arange(0.0, other.length, cells.column_size), 0.0))
        found = np.isfinite(s)
        row = np.floor(s[found] / cells.row_size).astype(np.int64) - cells.first_row
        column = np.floor(d[found] / cells.column_size).astype(np.int64) - cells.first_column
        inside = (row >= 0) & (row < driven.shape[0]) & (column >= 0) & (column < driven.shape[1])
        driven[row[inside], column[inside]] = True
    return driven


def opened_limits(limit: np.ndarray, closed: np.ndarray, height: np.ndarray, ground: np.ndarray, offsets: np.ndarray,
                  farthest: np.ndarray, driven: np.ndarray) -> np.ndarray:
    """Limits of one side that follow the ground through the mouths of side streets.

    A street that was driven itself is another road of the survey, and is left to it.

    Parameters
    ----------
    limit : (R,) m outward from the reference line, of every row
    closed : (R,) bool, rows in which the limit only closes an opening
    height : (R, C) m, of the ground in cells; NaN where none was measured
    ground : (R, C) bool, cells of `street_ground`
    offsets : (C,) m outward, ascending
    farthest : (R,) m outward, beyond which nothing belongs to the road
    driven : (R, C) bool, cells of `cells_driven`

    Returns
    -------
    (R,) m, `limit` or farther
    """
    result = limit.copy()
    starts = np.flatnonzero(closed & ~np.r_[False, closed[:-1]])
    ends = np.flatnonzero(closed & ~np.r_[closed[1:], False]) + 1
    for first, end in zip(starts, ends):
        rows = slice(first, end)
        if (end - first) * ROW_LENGTH < MIN_MOUTH_WIDTH and not _goes_on_wider(limit, first, end):
            continue
        beyond = (offsets > limit[rows, None]) & (offsets < farthest[rows, None])
        street = _street(beyond, np.isfinite(height[rows]), ground[rows])
        # between the two sides of the street an island may stand in it
        between = np.logical_or.accumulate(street, axis=0) & np.logical_or.accumulate(street[::-1], axis=0)[::-1]
        if (between & driven[rows]).any():
            continue
        deep = between & (offsets > limit[rows, None] + MIN_MOUTH_DEPTH)
        if deep.sum(axis=0).max() * ROW_LENGTH < MIN_STREET_WIDTH or _level_share(between, first, height, limit, offsets) > MAX_LEVEL_FLANKS:
            continue
        reach = median_filter(_outermost(between & ground[rows], offsets), SMOOTHED_ROWS, mode="nearest")
        result[rows] = np.fmax(limit[rows], np.minimum(reach, farthest[rows]))
    return result


def _goes_on_wider(limit, first, end):
    """Whether the road before or after some rows is known to be as much wider as a mouth is deep."""
    beside = limit[[k for k in (first - 1, end) if 0 <= k < len(limit)]]
    return bool((beside > limit[first:end].max() + MIN_MOUTH_DEPTH).any())


def _street(beyond, seen, ground):
    """(N, C) bool, ground that goes on from the limit of each row without a step and without a long gap."""
    street = np.zeros(beyond.shape, bool)
    unseen, other = np.zeros((2, len(beyond)), np.int64)
    going = np.ones(len(beyond), bool)
    for column in np.flatnonzero(beyond.any(axis=0)):
        here = beyond[:, column] & going
        unseen = np.where(here, np.where(seen[:, column], 0, unseen + 1), unseen)
        other = np.where(here & seen[:, column], np.where(ground[:, column], 0, other + 1), other)
        going &= (unseen <= MAX_UNSEEN_COLUMNS) & (other < STEP_COLUMNS)
        street[:, column] = here & going & ground[:, column]
    return street


def _level_share(street, first, height, limit, offsets):
    """Share of the places along both sides of a street, (N, C) cells from row `first` on, where the ground beside it is level with it."""
    level = []
    for column in np.flatnonzero(street.any(axis=0)):
        rows = first + np.flatnonzero(street[:, column])[[0, -1]]
        beside = rows + [-FLANK_ROWS, FLANK_ROWS]
        known = (beside >= 0) & (beside < len(height))
        known[known] = (offsets[column] > limit[beside[known]]) & (offsets[column] > limit[rows[known]] + FLANK_DEPTH)
        level.append(height[rows[known], column] - height[beside[known], column])
    apart = np.abs(np.concatenate(level)) if level else np.empty(0)
    apart = apart[np.isfinite(apart)]
    return float((apart < MIN_FLANK_STEP).mean()) if len(apart) else 0.0


def _outermost(cells, offsets):
    """(N,) m, the outer end of the outermost cell of each row that is on; minus infinity where none is."""
    return np.where(cells, offsets + COLUMN_WIDTH / 2, -np.inf).max(axis=1)
