"""The adjustment, begun where the poses are known well enough and grown along time from there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...common.progress import Progress
from ...curves.robust import robustly_smoothed
from .adjustment import FIRST_NOISE, Adjusted, Returns, adjust_poses
from .crossfall import crossfall_of
from .poses import POSE, Poses

REACH = 10            # intervals that poses are carried on at a time: for a second a vehicle's motion is foreseen within decimetres
MAX_GROWTHS = 12
GROWTH_STRIDE = 3     # every n-th return is enough while growing
MAX_TRIES = 4         # of an interval: with longer known motion beside it, it may come right after failing
MAX_RAY_MISFIT = 0.03     # m: an interval of a scanner whose returns lie farther off the rays is not understood
MAX_UNEXPLAINED = 0.05    # m: where returns usually lie farther off, the rays are not those of these scanners
MAX_TIMES_USUAL = 10.0  # times the usual misfit, where that is larger
POSE_STIFFNESS, PHASE_STIFFNESS = 10.0, 1e3   # of the curves by which they are carried on


def grown_poses(poses: Poses, known: np.ndarray, returns: Returns, progress: Progress = Progress()) -> Adjusted:
    """Adjust poses to the returns, from the known intervals on.

    Parameters
    ----------
    poses : Poses to start from
    known : (K, S) bool, intervals of each scanner where they are near the truth
    returns : Returns
    progress : Progress

    Returns
    -------
    Adjusted; its misfit is NaN in the intervals of scanners whose returns were not used
    """
    guess, crossfall = poses, np.zeros(len(poses.control))
    held = np.zeros(known.shape, bool)
    held[returns.interval, returns.scanner] = True
    tries = known.astype(int)
    noise = np.full(known.shape, FIRST_NOISE)
    some = returns[np.arange(0, len(returns.interval), GROWTH_STRIDE)]
    for number in range(MAX_GROWTHS):
        part = progress.part(number / (MAX_GROWTHS + 2), (number + 1) / (MAX_GROWTHS + 2))
        found = adjust_poses(poses, guess, crossfall, some[known[some.interval, some.scanner]], noise, part)
        limit = max(MAX_RAY_MISFIT, MAX_TIMES_USUAL * found.usual)
        with np.errstate(invalid="ignore"):
            good = known & (found.misfit <= limit)
        fresh = _reached(found.poses, good) & held & ~good & (tries < MAX_TRIES)
        poses = carried_on(found.poses, good)
        crossfall = crossfall_of(poses, some[good[some.interval, some.scanner]])
        noise = np.where(good, found.noise, FIRST_NOISE)
        if not fresh.any():
            break
        tries += fresh
        known = good | fresh
    return adjust_poses(poses, guess, crossfall, returns[good[returns.interval, returns.scanner]], noise,
                        progress.part(MAX_GROWTHS / (MAX_GROWTHS + 2), 1.0))


def _reached(poses, good):
    """Intervals within REACH of good ones of their drive."""
    reached = np.zeros(good.shape, bool)
    for drive in poses.drives:
        own = slice(drive.first, drive.first + drive.count - 3)
        total = np.concatenate([np.zeros((1, good.shape[1]), int), np.cumsum(good[own], axis=0)])
        places = np.arange(drive.count - 3)
        low, high = np.maximum(places - REACH, 0), np.minimum(places + REACH + 1, drive.count - 3)
        reached[own] = total[high] > total[low]
    return reached


def carried_on(poses: Poses, good: np.ndarray) -> Poses:
    """The poses with values where no interval is good replaced by smooth continuation.

    Parameters
    ----------
    poses : Poses
    good : (K, S) bool of intervals
    """
    control = poses.control.copy()
    for drive in poses.drives:
        own = slice(drive.first, drive.first + drive.count)
        # a control value is known where one of the four intervals that it belongs to is
        known = np.zeros((drive.count, poses.scanners), bool)
        for step in range(4):
            known[step:] |= good[own][:drive.count - step]
        parts = [(slice(0, POSE), known.any(axis=1), POSE_STIFFNESS)]
        parts += [(slice(POSE + k, POSE + k + 1), known[:, k], PHASE_STIFFNESS) for k in range(poses.scanners)]
        for columns, rows, stiffness in parts:
            if rows.any() and not rows.all():
                values = control[own, columns]
                bridged = robustly_smoothed(values, rows.astype(float), stiffness)
                control[own, columns] = np.where(rows[:, None], values, bridged)
    return replace(poses, control=control)
