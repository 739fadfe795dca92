"""What the drive was: roads, passes, speed, and how high the sensor rode above the road."""

from dataclasses import dataclass

import numpy as np

from .road_frame import build_frame
from .sensor_height import AROUND, height_above

PROFILE_STEP = 2.0  # m of driving between the heights of the profile


@dataclass(frozen=True)
class InspectedDrive:
    """Findings about a trajectory; metres and seconds.

    roads : length of each road
    passes : rows of (number, road, direction, first station, last station, first time, last time)
    driven : metres driven, standstills' tremble left out
    sensor_height : metres from the trajectory down to the road, None where too few points lie on the track
    profile : (M, 3) metres driven, map height of the trajectory, map height of the road (NaN where unseen)
    """

    roads: list
    passes: list
    driven: float
    sensor_height: float
    profile: np.ndarray


def inspect_drive(trajectory, rows, heights):
    """An InspectedDrive.

    Parameters
    ----------
    trajectory : Trajectory, cleaned and in the clouds' CRS
    rows, heights : (N,) for points on the vehicle's track, the trajectory row next to each and its map height
    """
    frame = build_frame(trajectory)
    passes = [(p.number, p.road, p.direction, *(p.span if p.direction > 0 else p.span[::-1]), float(p.time[0]), float(p.time[-1]))
              for p in frame.passes]
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(trajectory.x), np.diff(trajectory.y)))]
    drops = trajectory.z[rows] - heights
    height = height_above(drops)
    profile = _profile(driven, trajectory.z, driven[rows], heights, drops, height)
    return InspectedDrive([road.length for road in frame.roads], passes,
                          float(sum(abs(last - first) for *_, first, last, _, _ in passes)), height, profile)


def _profile(driven, track_z, at, heights, drops, height):
    """Heights of track and road every PROFILE_STEP of driving."""
    places = np.arange(0.0, driven[-1] + PROFILE_STEP, PROFILE_STEP)
    road = np.full(len(places), np.nan)
    if height is not None:
        near = np.abs(drops - height) < AROUND
        cell = np.rint(at[near] / PROFILE_STEP).astype(np.int64)
        order = np.lexsort((heights[near], cell))
        cell, z = cell[order], heights[near][order]
        starts = np.flatnonzero(np.r_[True, np.diff(cell) > 0]) if len(cell) else np.empty(0, np.int64)
        counts = np.diff(np.r_[starts, len(cell)])
        road[cell[starts]] = z[starts + counts // 2]
    return np.c_[places, np.interp(places, driven, track_z), road]
