"""Whether a trajectory is that of the scanners: its own shape, and where the scanners rode beside, above and below it.

What can be mended safely is mended before any point is read, and said; what cannot goes into the uncertainty of everything that is drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...common.progress import Progress
from ...io.crs import FOOT
from ..estimation.adjustment import MAX_UNEXPLAINED
from ..frame.road import CORRIDOR
from ..las.reader import CloudHeader
from ..trajectory.shape import shaped_trajectory
from ..trajectory.trajectory import Trajectory, clean_trajectory
from .limits import (
    CLEARLY_BETTER,
    HALF_VEHICLE,
    LOWEST_SENSOR,
    MOST,
    ONE_MOVE,
    PLACE_GAP,
    PLACE_WINDOWS,
    SIGMA_OF_OTHER_HEIGHTS,
    USUAL_AHEAD,
    VEHICLE_HEIGHT,
)
from .mounting import Mounting, read_places, scanner_mountings, usual_lever, vehicle_angles


@dataclass(frozen=True)
class FittedTrajectory:
    """A trajectory as the scanners were carried.

    trajectory : the one given where everything fits
    sigma : m across, one sigma that is left of what did not
    seen : whether the rays of the scanners show where they rode
    """

    trajectory: Trajectory
    sigma: float
    seen: bool


def fitted_trajectory(files: Sequence[CloudHeader], trajectory: Trajectory, scanner_field: str | None = "automatic",
                      progress: Progress = Progress()) -> FittedTrajectory:
    """The trajectory as the scanners were carried, where the one given is not.

    Parameters
    ----------
    files : headers of the clouds
    trajectory : Trajectory in their CRS and, where it has times, in their time system
    scanner_field : as of `ScannerCensus.choose`
    progress : Progress, which hears one warning for each thing that does not fit
    """
    shape = shaped_trajectory(clean_trajectory(trajectory))
    for warning in shape.said:
        progress.warn(warning)
    given = shape.trajectory if shape.said else trajectory
    if not trajectory.has_time or not all(file.has_time for file in files if file.count):
        return FittedTrajectory(given, shape.sigma, False)
    sample = read_places(files, scanner_field)
    mountings = _near(scanner_mountings(sample, shape.trajectory))
    if mountings and _other_heights(sample, shape.trajectory, mountings, progress):
        return FittedTrajectory(given, float(np.hypot(shape.sigma, SIGMA_OF_OTHER_HEIGHTS)), True)
    if not (mountings := _met(mountings)):
        return FittedTrajectory(given, shape.sigma, False)
    moved = _carried(sample, shape.trajectory, mountings, progress)
    return FittedTrajectory(given if moved is shape.trajectory else moved, shape.sigma, True)


def _carried(sample, trajectory, mountings, progress):
    """The trajectory moved to the height and the way of the scanners where it is not theirs; else the same."""
    level = _at_height(trajectory, mountings, progress)
    # a trajectory far above its scanners swings over them, as the vehicle rolls
    return _on_way(level, mountings if level is trajectory else _met(scanner_mountings(sample, level)), progress)


def _near(mountings):
    """Those of the mountings that lie within reach of the trajectory."""
    return [one for one in mountings if np.hypot(*usual_lever([one])[:2]) < CORRIDOR]


def _met(mountings):
    """Those of the mountings whose rays meet in one place."""
    return [one for one in mountings if one.misfit <= MAX_UNEXPLAINED]


def _other_heights(sample, trajectory, mountings, progress):
    """Whether heights are in another unit than places, or upside down; it is said."""
    if max(one.misfit for one in mountings) > MAX_UNEXPLAINED:
        for stretch, said in ((FOOT, "in feet where x and y are in metres"), (1.0 / FOOT, "in metres where x and y are in feet")):
            other = scanner_mountings(sample, trajectory, stretch)
            if len(other) >= len(mountings) and len(_met(other)) == len(other):
                up, height = float(usual_lever(other)[0][2]), float(np.median(trajectory.z))
                # from a trajectory that is stretched alike the scanners lie where they ride on the vehicle
                alone = abs(up) > max(VEHICLE_HEIGHT, abs(up - (1.0 - stretch) * height))
                of = "the cloud alone" if alone else "cloud and trajectory"
                progress.warn(f"The heights of {of} seem to be {said}: the laser beams meet in the scanner only if heights are "
                              f"multiplied by {stretch:.4g}. Curbs are missed, and heights and slopes are wrong by that factor. Convert the heights "
                              f"of {'the cloud' if alone else 'both'}, and run again.")
                return True
    if all(one.ground > 0 for one in mountings):
        progress.warn(f"The road lies {np.mean([one.ground for one in mountings]):.1f} m above the scanners, as if heights were counted downwards or "
                      "turned upside down: curbs, slopes and heights are wrong. Export cloud and trajectory with heights that rise upwards.")
        return True
    return False


def _at_height(trajectory: Trajectory, mountings: Sequence[Mounting], progress: Progress) -> Trajectory:
    """The trajectory moved to the height of the scanners where it runs below the road or higher than vehicles are; else the same."""
    at, lever = _places(mountings)
    above_road = -float(np.mean([one.ground for one in mountings]))
    up = lever[:, 2]
    far = (np.abs(up) > VEHICLE_HEIGHT) | (up > above_road + LOWEST_SENSOR)
    if not far.any():
        return trajectory
    worst = float(up[np.argmax(np.abs(up))])
    where = "" if far.all() else f" at {np.count_nonzero(far)} of {len(far)} places looked at"
    progress.warn(f"The trajectory lies {abs(worst):.2f} m {'below' if worst > 0 else 'above'} the scanners{where}, as their laser beams "
                  f"show: {'below the road' if worst > 0 else 'no vehicle is so high'}. Heights of cloud and trajectory seem to be of two kinds "
                  "(above the ellipsoid and above sea level), or one of them is wrong. The trajectory was moved to the height of the scanners; the "
                  "map has the heights of the cloud. Export both with one kind of heights.")
    metres = np.full(len(trajectory), np.median(up)) if np.ptp(up) < ONE_MOVE * abs(worst) else np.interp(trajectory.time, at, up)
    return replace(trajectory, z=trajectory.z + metres)


def _on_way(trajectory: Trajectory, mountings: Sequence[Mounting], progress: Progress) -> Trajectory:
    """The trajectory moved to the way of the scanners where no vehicle is so wide; else the same."""
    if not mountings:
        return trajectory
    at, lever = _places(mountings)
    far = np.abs(lever[:, 1]) > HALF_VEHICLE
    if not far.any():
        return trajectory
    worst = float(lever[np.argmax(np.abs(lever[:, 1])), 1])
    x, y = (np.interp(at[np.argmax(far)], trajectory.time, getattr(trajectory, name)) for name in "xy")
    where = "" if far.all() else f" at {np.count_nonzero(far)} of {len(far)} places looked at"
    progress.warn(f"The trajectory runs {abs(worst):.2f} m to the {'right' if worst > 0 else 'left'} of the way that the scanners took{where} "
                  f"(first near x {x:.0f}, y {y:.0f}), as their laser beams show; no vehicle is so wide. It may belong to another lane or "
                  "drive, or be in another datum than the cloud. It was moved to where the scanners were; check that both files belong together.")
    return _moved_aside(trajectory, mountings, at, lever[:, 1])


def _windows(mountings):
    """(W,) s of the windows of all scanners, in order, and (W, 3) m from the trajectory to the middle of the scanners then."""
    time = np.concatenate([one.time for one in mountings])
    lever = np.concatenate([one.lever - np.median(one.lever, axis=0) for one in mountings]) + usual_lever(mountings)
    order = np.argsort(time, kind="stable")
    return time[order], lever[order]


def _places(mountings):
    """(P,) s of places that were looked at, and (P, 3) m from the trajectory to the middle of the scanners there."""
    time, lever = _windows(mountings)
    cuts = [0, *(np.flatnonzero(np.diff(time) > PLACE_GAP) + 1).tolist(), len(time)]
    places = [slice(i, j) for i, j in zip(cuts[:-1], cuts[1:]) if j - i > PLACE_WINDOWS / 2] or [slice(0, len(time))]
    return np.array([time[one].mean() for one in places]), np.array([np.median(lever[one], axis=0) for one in places])


def _moved_aside(trajectory, mountings, at, beside):
    """The trajectory moved to where the scanners were; `beside` (P,) m to the left at (P,) times of places.

    What is the same in the vehicle (another lane) or on the map (another datum) is one move, of which the one is taken that leaves less. Where
    neither fits, as with several drives of which one is wrong, the trajectory is moved to the left evenly between the places.
    """
    time, lever = _windows(mountings)
    yaw = vehicle_angles(trajectory)[2]
    here = np.interp(time, trajectory.time, yaw)
    cos, sin, one, none = np.cos(here), np.sin(here), np.ones(len(here)), np.zeros(len(here))
    measured = np.r_[lever[:, 0], lever[:, 1]]
    in_vehicle = np.median(lever[:, 1])
    rows = np.r_[np.c_[cos, sin, one], np.c_[-sin, cos, none]]
    on_map = np.linalg.lstsq(np.r_[rows, [[0.0, 0.0, 1.0 / USUAL_AHEAD]]], np.r_[measured, 0.0], rcond=None)[0]
    left_over = [float(np.quantile(np.abs(off), MOST)) for off in (lever[:, 1] - in_vehicle, measured - rows @ on_map)]
    east, north, metres = 0.0, 0.0, in_vehicle
    if left_over[1] < CLEARLY_BETTER * left_over[0]:
        (east, north), metres = on_map[:2], 0.0
    if min(left_over) > ONE_MOVE:
        east, north, metres = 0.0, 0.0, np.interp(trajectory.time, at, beside)
    return replace(trajectory, x=trajectory.x + east - np.sin(yaw) * metres, y=trajectory.y + north + np.cos(yaw) * metres)
