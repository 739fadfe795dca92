"""How far returns lie off the rays that the mirror had at their times, and how that changes with the poses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .poses import PITCH, POSE, ROLL, YAW, Poses, vehicle_axes

MIN_RANGE = 0.3       # m: nearer than this no scanner measures
MOUNTING = 5          # unknowns of a scanner's mounting: turn, lean and lever


@dataclass
class Misfits:
    """Of N returns: off the scan plane and, within it, off the ray.

    off : (2, N) m
    pose : (2, N, 6 + S) change per change of the values of the spline
    mounting : (2, N, 5 S) change per change of turn, lean and lever of each scanner
    range : (N,) m along the ray; negative behind the scanner
    """

    off: np.ndarray
    pose: np.ndarray
    mounting: np.ndarray
    range: np.ndarray


def misfits(poses: Poses, interval: np.ndarray, share: np.ndarray, time: np.ndarray, place: np.ndarray, scanner: np.ndarray,
            noise: tuple[np.ndarray, np.ndarray] | None = None) -> Misfits:
    """The Misfits of returns.

    Parameters
    ----------
    poses : Poses
    interval, share : (N,) place in the splines
    time : (N,) s
    place : (N, 3) m
    scanner : (N,) numbers
    noise : (N,) m of the returns' places and (N,) radians of the rays' directions; None where the directions are exact
    """
    values = poses.at(interval, share)
    ahead, left, up = vehicle_axes(values[:, ROLL], values[:, PITCH], values[:, YAW])
    away = place - values[:, :3]
    seen = np.stack([(axis * away).sum(axis=1) for axis in (ahead, left, up)], axis=1) - poses.lever[scanner]
    normal, across, upright = (axes[scanner] for axes in poses.scan_planes())
    rows = np.arange(len(time))
    angle = 2 * np.pi * poses.rate[scanner] * time + values[rows, POSE + scanner]
    along, above = (seen * across).sum(axis=1), (seen * upright).sum(axis=1)
    reach, beside = along * np.cos(angle) + above * np.sin(angle), above * np.cos(angle) - along * np.sin(angle)
    if noise is not None:
        # where the direction is uncertain, the return lies somewhere between it and the direction in which it is seen; taken by the ray
        # alone, returns that all lie far ahead would draw the scanner towards them
        turned = (noise[1] * reach) ** 2
        angle = angle + np.arctan2(beside, reach) * turned / (noise[0] ** 2 + turned)
    cos, sin = np.cos(angle), np.sin(angle)
    sides = (normal, cos[:, None] * upright - sin[:, None] * across)
    off = np.stack([(seen * normal).sum(axis=1), beside])
    by_pose = np.zeros((2, len(time), values.shape[1]))
    by_mounting = np.zeros((2, len(time), MOUNTING * poses.scanners))
    level_right = np.stack([np.sin(values[:, YAW]), -np.cos(values[:, YAW]), np.zeros(len(time))], axis=1)
    first = MOUNTING * scanner.astype(np.int64)
    for k, side in enumerate(sides):
        on_map = side[:, :1] * ahead + side[:, 1:2] * left + side[:, 2:] * up
        torque = np.cross(on_map, away)
        by_pose[k, :, :3] = -on_map
        for column, axis in ((ROLL, ahead), (PITCH, level_right)):
            by_pose[k, :, column] = (axis * torque).sum(axis=1)
        by_pose[k, :, YAW] = torque[:, 2]
        torque = np.cross(side, seen)
        by_mounting[k, rows, first] = torque[:, 2]
        by_mounting[k, rows, first + 1] = (torque * across).sum(axis=1)
        for j in range(3):
            by_mounting[k, rows, first + 2 + j] = -side[:, j]
    by_pose[1, rows, POSE + scanner] = -(along * cos + above * sin)
    return Misfits(off, by_pose, by_mounting, reach)
