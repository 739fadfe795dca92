"""How the road is inclined across under the vehicle, by the returns on its own way."""

from __future__ import annotations

import numpy as np

from .adjustment import Returns
from .poses import KNOT_SPACING, YAW, Poses, X, Y, Z, spline_slopes

UNDER_VEHICLE = 1.5        # m either side of the track: what the vehicle stands on
AHEAD_REACH = 5.0        # m along: nearer than this a road's grade changes little
HEIGHT_BAND = 0.15       # m about the usual height below the track: road, not what stands on it
BESIDE_INTERVALS = 10    # either side that are taken together: a second of driving
MIN_RETURNS, MIN_SPREAD = 50, 0.3   # and m across (standard deviation), or nothing is known
MAX_CROSSFALL = 0.1      # roads are no steeper across


def crossfall_of(poses: Poses, returns: Returns) -> np.ndarray:
    """Crossfall under the vehicle.

    Parameters
    ----------
    poses : Poses
    returns : Returns

    Returns
    -------
    (K,) radians at the start of every interval, positive where the road rises to the left; 0 where it is not seen
    """
    found = np.zeros(len(poses.control))
    for drive in poses.drives:
        rows = slice(*np.searchsorted(returns.interval, [drive.first, drive.first + drive.count]))
        if rows.start < rows.stop:
            found[drive.first:drive.first + drive.count] = _of_drive(poses, drive, returns, rows)
    return np.arctan(np.clip(found, -MAX_CROSSFALL, MAX_CROSSFALL))


def _of_drive(poses, drive, returns, rows):
    interval, share, place = returns.interval[rows], returns.share[rows], returns.place[rows]
    values = poses.at(interval, share)
    slopes = spline_slopes(share)
    speed = sum(slopes[:, j, None] * poses.control[interval + j][:, [X, Y, Z]] for j in range(4))
    flat = np.maximum(np.hypot(speed[:, 0], speed[:, 1]), 0.1)
    cos, sin = np.cos(values[:, YAW]), np.sin(values[:, YAW])
    away = place - values[:, :3]
    ahead, left = away[:, 0] * cos + away[:, 1] * sin, away[:, 1] * cos - away[:, 0] * sin
    # the road keeps to the track's own climb
    below = away[:, 2] - ahead * speed[:, 2] / flat
    near = np.flatnonzero((np.abs(left) < UNDER_VEHICLE) & (np.abs(ahead) < AHEAD_REACH) & (below < 0))
    if not len(near):
        return np.zeros(drive.count)
    near = near[np.abs(below[near] - np.median(below[near])) < HEIGHT_BAND]
    # where the vehicle rolls over them
    cell = np.clip(interval[near] - drive.first + np.rint(ahead[near] / flat[near] / KNOT_SPACING).astype(np.int64), 0, drive.count - 1)
    sums = np.stack([np.bincount(cell, weight, drive.count) for weight in
                     (np.ones(len(near)), left[near], below[near], left[near] ** 2, left[near] * below[near])])
    total = np.concatenate([np.zeros((5, 1)), np.cumsum(sums, axis=1)], axis=1)
    places = np.arange(drive.count)
    count, x, y, xx, xy = (total[:, np.minimum(places + BESIDE_INTERVALS + 1, drive.count)] - total[:, np.maximum(places - BESIDE_INTERVALS, 0)])
    count = np.maximum(count, 1.0)
    spread = xx / count - (x / count) ** 2
    known = (count >= MIN_RETURNS) & (spread > MIN_SPREAD**2)
    slope = (xy / count - x * y / count**2) / np.where(known, spread, 1.0)
    return np.interp(places, places[known], slope[known]) if known.any() else np.zeros(drive.count)
