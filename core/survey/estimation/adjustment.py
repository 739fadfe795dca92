"""One adjustment of all poses and mountings: every return shall lie on the ray that the mirror had at its time.

Range noise lies along the ray and does not matter; what stands on the road, and whether it is flat, neither. What the returns
leave open is filled by how vehicles move: smoothly, nose ahead, and on average as the road is inclined under them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded
from scipy.ndimage import binary_dilation

from ...common.arrays import Rows
from ...common.progress import Progress
from ...curves.robust import robustly_smoothed
from ..weights import MIRROR, RAYS
from .poses import PITCH, POSE, ROLL, YAW, Poses, X, Y, Z, spline_slopes, spline_weights, vehicle_axes
from .samples import FirstTrack


@dataclass
class Returns(Rows):
    """The returns that are adjusted, in order of intervals."""

    interval: np.ndarray   # interval, share: (N,) place in the splines
    share: np.ndarray
    time: np.ndarray   # (N,) s
    place: np.ndarray   # (N, 3) m
    scanner: np.ndarray   # (N,) numbers
    tick: float = 0.0   # s to which the times are rounded; 0 where they are exact


@dataclass
class Adjusted:
    """The adjusted poses."""

    poses: Poses
    usual: float   # usual, unexplained: m, medians of the misfits and of what the rounding of the times does not explain of them
    unexplained: float
    misfit: np.ndarray   # misfit, noise: (K, S) m, mean misfit of each interval and scanner, NaN without returns, and by which returns were weighted
    noise: np.ndarray
    place_covariance: np.ndarray   # (K, 3, 3) m^2 of each control value's place; includes what the mounting leaves open


def _adjust_poses(poses: Poses, guess: Poses, crossfall: np.ndarray, returns: Returns, noise: np.ndarray,
                  progress: Progress = Progress()) -> Adjusted:
    """Adjust poses and mountings to the returns by Gauss-Newton steps with robust weights.

    poses : near the truth: within a metre, mirror phases within half a radian; guess : with the mounting that the unknown one scatters about
    crossfall : (K,) radians of the road under the vehicle, positive where it rises to the left; noise : (K, S) m off the rays to begin with
    """
    for number in range(RAYS.rounds):
        equations, misfit, by_rounding, count = _equations(poses, guess, crossfall, returns, noise, progress)
        change, common, covariance, follow = equations.solve()
        turn, lean, *lever = common.reshape(-1, MOUNTING).T
        poses = replace(poses, control=poses.control + change, turn=poses.turn + turn, lean=poses.lean + lean, lever=poses.lever + np.array(lever).T)
        calm = np.fmin(noise, np.maximum(RAYS.noise_of_misfit * np.sqrt(np.maximum(misfit**2 - by_rounding**2, 0.0)), RAYS.least_noise))
        settled = np.nanmax(noise / calm) < RAYS.settled and np.abs(change[:, :3]).max() < RAYS.converged
        noise = calm
        progress.report((number + 1) / RAYS.rounds)
        if settled:
            break
    by_mounting = follow[:, :3]
    conditional = equations.variances()[:, :3, :3]
    place_covariance = conditional + np.einsum("kia,ab,kjb->kij", by_mounting, covariance, by_mounting)
    usual = float(np.median(misfit[count > 0]))
    unexplained = float(np.median(np.maximum(misfit - RAYS.most_of_mean * by_rounding, 0.0)[count > 0]))
    return Adjusted(poses, usual, unexplained, misfit, noise, place_covariance)


def _equations(poses, guess, crossfall, returns, noise, progress):
    """_BandedEquations at the poses, and (K, S) misfits, what of them the times' rounding explains, and counts of each interval and scanner."""
    knots, columns = poses.control.shape
    equations = _BandedEquations(knots, columns, MOUNTING * poses.scanners)
    total, count, explained = (np.zeros((knots, poses.scanners)) for _ in range(3))
    turned = 2 * np.pi * np.abs(poses.rate) * returns.tick / np.sqrt(12.0)
    cuts = np.searchsorted(returns.interval, np.arange(0, knots + RAYS.block_intervals, RAYS.block_intervals))
    for first, last in zip(cuts[:-1], cuts[1:]):
        if first == last:
            continue
        rows = slice(first, last)
        interval, share, scanner = returns.interval[rows], returns.share[rows], returns.scanner[rows]
        rounded = turned[scanner]
        uncertain = (noise[interval, scanner], rounded) if returns.tick else None
        residuals = misfits(poses, interval, share, returns.time[rows], returns.place[rows], scanner, uncertain)
        variance = noise[interval, scanner] ** 2 + (RAYS.angle_noise**2 + rounded**2) * residuals.range**2
        weight = (residuals.range > RAYS.min_range) / variance / (1.0 + residuals.off**2 / variance / RAYS.outlier_sigmas**2)
        weights = spline_weights(share)
        starts = np.flatnonzero(np.r_[True, np.diff(interval) > 0, True])
        for a, b in zip(starts[:-1], starts[1:]):
            equations.add_rows(int(interval[a]), np.concatenate([weights[a:b]] * 2), residuals.pose[:, a:b].reshape(2 * (b - a), columns),
                               residuals.mounting[:, a:b].reshape(2 * (b - a), -1), residuals.off[:, a:b].ravel(), weight[:, a:b].ravel())
        size = np.where(residuals.range > RAYS.min_range, np.minimum(np.abs(residuals.off).max(axis=0), RAYS.max_counted_misfit),
                        RAYS.max_counted_misfit)
        np.add.at(total, (interval, scanner), size)
        np.add.at(count, (interval, scanner), 1)
        np.add.at(explained, (interval, scanner), np.minimum(rounded * np.abs(residuals.range), RAYS.max_counted_misfit))
        progress.check_cancelled()
    _add_motion(equations, poses, crossfall)
    _add_mounting(equations, poses, guess)
    with np.errstate(invalid="ignore"):
        return equations, total / count, MEAN_OF_SIGMA * explained / count, count


MEAN_OF_SIGMA = 0.8        # derived: sqrt(2 / pi), rounded; mean size of errors against their standard deviation


def _add_motion(equations, poses, crossfall):
    """What is known of vehicles and mirrors: smooth motion, nose ahead, level with the road."""
    columns = poses.control.shape[1]
    usual = np.r_[[RAYS.acceleration] * 3, [RAYS.angular_acceleration] * 3, [RAYS.phase_acceleration] * poses.scanners]
    steady = 1.0 / (MIRROR.knot_spacing**2 * usual) ** 2
    begin, slope = spline_weights(0.0), spline_slopes(0.0)
    for drive in poses.drives:
        control = poses.control[drive.first:drive.first + drive.count]
        bend = np.diff(control, 2, axis=0)
        for column in range(columns):
            change = np.zeros((len(bend), 3, columns))
            change[:, :, column] = (1.0, -2.0, 1.0)
            equations.add_each(drive.first, change, bend[:, column], np.full(len(bend), steady[column]))
        size = drive.count - 3
        value = sum(begin[j] * control[j:j + size] for j in range(4))
        speed = sum(slope[j] * control[j:j + size, :3] for j in range(4))
        yaw, flat = value[:, YAW], np.maximum(np.hypot(speed[:, X], speed[:, Y]), RAYS.min_speed)
        cos, sin = np.cos(yaw), np.sin(yaw)
        change = np.zeros((size, 4, columns))
        change[:, :, X], change[:, :, Y] = -sin[:, None] * slope, cos[:, None] * slope
        change[:, :, YAW] = -(cos * speed[:, X] + sin * speed[:, Y])[:, None] * begin
        equations.add_each(drive.first, change, cos * speed[:, Y] - sin * speed[:, X], 1.0 / (RAYS.slip * flat) ** 2)
        change = np.zeros((size, 4, columns))
        change[:, :, PITCH], change[:, :, Z] = flat[:, None] * begin, -slope
        equations.add_each(drive.first, change, value[:, PITCH] * flat - speed[:, Z], 1.0 / (RAYS.pitch_sway * flat) ** 2)
        change = np.zeros((size, 4, columns))
        change[:, :, ROLL] = begin
        tilted = value[:, ROLL] - crossfall[drive.first:drive.first + size]
        equations.add_each(drive.first, change, tilted, np.full(size, 1.0 / RAYS.roll_sway**2))


def _add_mounting(equations, poses, guess):
    """Weak knowledge of the mounting; the levers' mean is held at 0."""
    sigma = np.array([RAYS.turn_prior, RAYS.lean_prior, RAYS.lever_prior, RAYS.lever_prior, RAYS.lever_prior])
    off = np.column_stack([poses.turn - guess.turn, poses.lean - guess.lean, poses.lever - guess.lever])
    for number in range(poses.scanners):
        columns = MOUNTING * number + np.arange(MOUNTING)
        equations.corner[columns, columns] += 1.0 / sigma**2
        equations.common[columns] -= off[number] / sigma**2
    for axis in range(3):
        every = MOUNTING * np.arange(poses.scanners) + 2 + axis
        equations.corner[np.ix_(every, every)] += RAYS.held
        equations.common[every] -= RAYS.held * poses.lever[:, axis].sum()


# The adjustment, begun where the poses are known well enough and grown along time from there.


def grown_poses(poses: Poses, known: np.ndarray, returns: Returns, progress: Progress = Progress()) -> Adjusted:
    """Adjust poses to the returns, from the (K, S) intervals of each scanner on that are `known` to be near the truth.

    The misfit of the result is NaN in the intervals of scanners whose returns were not used.
    """
    guess, crossfall = poses, np.zeros(len(poses.control))
    held = np.zeros(known.shape, bool)
    held[returns.interval, returns.scanner] = True
    tries = known.astype(int)
    noise = np.full(known.shape, RAYS.first_noise)
    sample = returns[np.arange(0, len(returns.interval), RAYS.growth_stride)]
    for number in range(RAYS.max_growths):
        part = progress.part(number / (RAYS.max_growths + 2), (number + 1) / (RAYS.max_growths + 2))
        adjusted = _adjust_poses(poses, guess, crossfall, sample[known[sample.interval, sample.scanner]], noise, part)
        limit = max(RAYS.max_ray_misfit, RAYS.max_times_usual * adjusted.usual)
        good = known & (adjusted.misfit <= limit)
        fresh = _reached(adjusted.poses, good) & held & ~good & (tries < RAYS.max_tries)
        poses = _carried_on(adjusted.poses, good)
        crossfall = _crossfall_of(poses, sample[good[sample.interval, sample.scanner]])
        noise = np.where(good, adjusted.noise, RAYS.first_noise)
        if not fresh.any():
            break
        tries += fresh
        known = good | fresh
    return _adjust_poses(poses, guess, crossfall, returns[good[returns.interval, returns.scanner]], noise,
                        progress.part(RAYS.max_growths / (RAYS.max_growths + 2), 1.0))


def _reached(poses, good):
    """Intervals within reach of good ones of their drive."""
    reached = np.zeros(good.shape, bool)
    for drive in poses.drives:
        rows = slice(drive.first, drive.first + drive.count - 3)
        reached[rows] = binary_dilation(good[rows], np.ones((2 * RAYS.reach + 1, 1)))
    return reached


def _carried_on(poses: Poses, good: np.ndarray) -> Poses:
    """The poses with values where no interval is `good`, (K, S) bool, replaced by smooth continuation."""
    control = poses.control.copy()
    for drive in poses.drives:
        span = slice(drive.first, drive.first + drive.count)
        # a control value is known where one of the four intervals that it belongs to is
        supported = np.zeros((drive.count, poses.scanners), bool)
        for step in range(4):
            supported[step:] |= good[span][:drive.count - step]
        parts = [(slice(0, POSE), supported.any(axis=1), RAYS.pose_stiffness)]
        parts += [(slice(POSE + k, POSE + k + 1), supported[:, k], RAYS.phase_stiffness) for k in range(poses.scanners)]
        for columns, rows, stiffness in parts:
            if rows.any() and not rows.all():
                values = control[span, columns]
                bridged = robustly_smoothed(values, rows.astype(float), stiffness)
                control[span, columns] = np.where(rows[:, None], values, bridged)
    return replace(poses, control=control)


# How far returns lie off the rays that the mirror had at their times, and how that changes with the poses.

MOUNTING = 5          # derived: unknowns of a scanner's mounting: turn, lean and lever


@dataclass
class _Misfits:
    """Of N returns: off the scan plane and, within it, off the ray, (2, N) m, and the range along the ray, negative behind the scanner.

    pose, mounting : (2, N, 6 + S) and (2, N, 5 S) change per change of the values of the spline, and of turn, lean and lever of each scanner
    """

    off: np.ndarray
    pose: np.ndarray
    mounting: np.ndarray
    range: np.ndarray


def misfits(poses: Poses, interval: np.ndarray, share: np.ndarray, time: np.ndarray, place: np.ndarray, scanner: np.ndarray,
            noise: tuple[np.ndarray, np.ndarray] | None = None) -> _Misfits:
    """The _Misfits of returns at places in the splines, (N,) s, (N, 3) m and (N,) numbers of scanners.

    noise : (N,) m of the returns' places and (N,) radians of the rays' directions; None where the directions are exact
    """
    values = poses.at(interval, share)
    ahead, left, up = vehicle_axes(values[:, ROLL], values[:, PITCH], values[:, YAW])
    rays = place - values[:, :3]
    in_vehicle = np.stack([(axis * rays).sum(axis=1) for axis in (ahead, left, up)], axis=1) - poses.lever[scanner]
    normal, across, upright = (axes[scanner] for axes in poses.scan_planes())
    rows = np.arange(len(time))
    angle = 2 * np.pi * poses.rate[scanner] * time + values[rows, POSE + scanner]
    along, above = (in_vehicle * across).sum(axis=1), (in_vehicle * upright).sum(axis=1)
    reach, aside = along * np.cos(angle) + above * np.sin(angle), above * np.cos(angle) - along * np.sin(angle)
    if noise is not None:
        # where the direction is uncertain, the return lies somewhere between it and the direction in which it is seen; taken by the ray
        # alone, returns that all lie far ahead would draw the scanner towards them
        turned = (noise[1] * reach) ** 2
        angle = angle + np.arctan2(aside, reach) * turned / (noise[0] ** 2 + turned)
    cos, sin = np.cos(angle), np.sin(angle)
    sides = (normal, cos[:, None] * upright - sin[:, None] * across)
    off = np.stack([(in_vehicle * normal).sum(axis=1), aside])
    by_pose = np.zeros((2, len(time), values.shape[1]))
    by_mounting = np.zeros((2, len(time), MOUNTING * poses.scanners))
    level_right = np.stack([np.sin(values[:, YAW]), -np.cos(values[:, YAW]), np.zeros(len(time))], axis=1)
    first = MOUNTING * scanner.astype(np.int64)
    for k, side in enumerate(sides):
        on_map = side[:, :1] * ahead + side[:, 1:2] * left + side[:, 2:] * up
        torque = np.cross(on_map, rays)
        by_pose[k, :, :3] = -on_map
        for column, axis in ((ROLL, ahead), (PITCH, level_right)):
            by_pose[k, :, column] = (axis * torque).sum(axis=1)
        by_pose[k, :, YAW] = torque[:, 2]
        torque = np.cross(side, in_vehicle)
        by_mounting[k, rows, first] = torque[:, 2]
        by_mounting[k, rows, first + 1] = (torque * across).sum(axis=1)
        for j in range(3):
            by_mounting[k, rows, first + 2 + j] = -side[:, j]
    by_pose[1, rows, POSE + scanner] = -(along * cos + above * sin)
    return _Misfits(off, by_pose, by_mounting, reach)


# Normal equations of splines with a few common unknowns: a band along time with a border.

class _BandedEquations:
    """Sums of the normal equations of (knots, columns) control values, which only meet those up to three knots away, and of common unknowns."""

    def __init__(self, knots: int, columns: int, common: int):
        self.band = np.zeros((knots, 4, columns, columns))  # of knot k with knot k + j
        self.right = np.zeros((knots, columns))
        self.border = np.zeros((knots, columns, common))
        self.corner, self.common = np.zeros((common, common)), np.zeros(common)

    def add_rows(self, interval: int, weights: np.ndarray, pose: np.ndarray, common: np.ndarray, off: np.ndarray, weight: np.ndarray) -> None:
        """N observations of one interval.

        weights : (N, 4) of the spline; off, weight : (N,) misfit and its weight
        pose, common : (N, columns) and (N, common) change per change of the spline's values and of the common unknowns
        """
        columns = pose.shape[1]
        rows = (weights[:, :, None] * pose[:, None, :]).reshape(len(off), 4 * columns)
        weighted = rows * weight[:, None]
        product = (rows.T @ weighted).reshape(4, columns, 4, columns)
        for i in range(4):
            for j in range(i, 4):
                self.band[interval + i, j - i] += product[i, :, j, :]
        self.right[interval:interval + 4] -= (weighted.T @ off).reshape(4, columns)
        self.border[interval:interval + 4] += (weighted.T @ common).reshape(4, columns, -1)
        self.corner += common.T @ (common * weight[:, None])
        self.common -= common.T @ (weight * off)

    def add_each(self, first: int, change: np.ndarray, off: np.ndarray, weight: np.ndarray) -> None:
        """One observation, (M,) misfit and weight, for each of M intervals; `change`, (M, W, columns), per change of its first W control values."""
        size, width = change.shape[:2]
        for i in range(width):
            for j in range(i, width):
                self.band[first + i:first + i + size, j - i] += weight[:, None, None] * change[:, i, :, None] * change[:, j, None, :]
            self.right[first + i:first + i + size] -= (weight * off)[:, None] * change[:, i]

    def _lower(self):
        """The band as `cholesky_banded` takes it."""
        knots, _, columns, _ = self.band.shape
        lower = np.zeros((4 * columns, knots * columns))
        for step in range(4):
            for a in range(columns):
                for b in range(columns):
                    below = step * columns + b - a
                    if below >= 0:
                        lower[below, a:(knots - step) * columns:columns] = self.band[:knots - step, step, a, b]
        lower[0] += RAYS.tiny
        return lower

    def solve(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Changes of the control values (knots, columns) and of the common unknowns (common,), the covariance of the latter, and
        (knots, columns, common) how control values follow from them."""
        knots, _, columns, _ = self.band.shape
        lower = self._lower()
        factor = (cholesky_banded(lower, lower=True, overwrite_ab=True, check_finite=False), True)
        border = self.border.reshape(knots * columns, -1)
        solved = cho_solve_banded(factor, np.concatenate([self.right.reshape(-1, 1), border], axis=1), check_finite=False)
        free, follow = solved[:, 0], solved[:, 1:]
        covariance = np.linalg.inv(self.corner - border.T @ follow)
        common = covariance @ (self.common - border.T @ free)
        return (free - follow @ common).reshape(knots, columns), common, covariance, -follow.reshape(knots, columns, -1)

    def variances(self) -> np.ndarray:
        """(knots, columns, columns) covariance of each knot's control values, common unknowns held.

        Blocks of three knots form a block-tridiagonal matrix; the diagonal blocks of its inverse follow from one sweep from either end.
        """
        knots, _, columns, _ = self.band.shape
        blocks, side = -(-knots // 3), 3 * columns
        lower = np.pad(self._lower(), ((0, 0), (0, blocks * side - knots * columns)))
        lower[0, knots * columns:] = 1.0
        row, column = np.indices((side, side))

        def below(step):
            """The blocks so many rows below the diagonal."""
            depth = row - column + step
            values = lower[np.clip(depth, 0, len(lower) - 1), (side * np.arange(blocks))[:, None, None] + column]
            return np.where((depth >= 0) & (depth < len(lower)), values, 0.0)

        diagonal, next_ = below(0), below(side).transpose(0, 2, 1)
        diagonal += np.tril(diagonal, -1).transpose(0, 2, 1)
        ahead, behind = diagonal.copy(), diagonal.copy()
        for k in range(1, blocks):
            ahead[k] -= next_[k - 1].T @ np.linalg.solve(ahead[k - 1], next_[k - 1])
        for k in range(blocks - 2, -1, -1):
            behind[k] -= next_[k] @ np.linalg.solve(behind[k + 1], next_[k].T)
        inverse = np.linalg.inv(ahead + behind - diagonal)
        return np.concatenate([inverse[:, i * columns:(i + 1) * columns, i * columns:(i + 1) * columns][:, None] for i in range(3)],
                              axis=1).reshape(3 * blocks, columns, columns)[:knots]


# How the road is inclined across under the vehicle, by the returns on its own way.


def _crossfall_of(poses: Poses, returns: Returns) -> np.ndarray:
    """(K,) radians of crossfall under the vehicle at every interval, positive where the road rises to the left; 0 where it is not seen."""
    slopes = np.zeros(len(poses.control))
    for drive in poses.drives:
        rows = slice(*np.searchsorted(returns.interval, [drive.first, drive.first + drive.count]))
        if rows.start < rows.stop:
            slopes[drive.first:drive.first + drive.count] = _of_drive(poses, drive, returns, rows)
    return np.arctan(np.clip(slopes, -RAYS.max_crossfall, RAYS.max_crossfall))


def _of_drive(poses, drive, returns, rows):
    interval, share, place = returns.interval[rows], returns.share[rows], returns.place[rows]
    values = poses.at(interval, share)
    slopes = spline_slopes(share)
    speed = sum(slopes[:, j, None] * poses.control[interval + j][:, [X, Y, Z]] for j in range(4))
    flat = np.maximum(np.hypot(speed[:, 0], speed[:, 1]), 0.1)
    cos, sin = np.cos(values[:, YAW]), np.sin(values[:, YAW])
    rays = place - values[:, :3]
    ahead, left = rays[:, 0] * cos + rays[:, 1] * sin, rays[:, 1] * cos - rays[:, 0] * sin
    # the road keeps to the track's own climb
    below = rays[:, 2] - ahead * speed[:, 2] / flat
    near = np.flatnonzero((np.abs(left) < RAYS.under_vehicle) & (np.abs(ahead) < RAYS.ahead_reach) & (below < 0))
    if not len(near):
        return np.zeros(drive.count)
    near = near[np.abs(below[near] - np.median(below[near])) < RAYS.height_band]
    # where the vehicle rolls over them
    cell = np.clip(interval[near] - drive.first + np.rint(ahead[near] / flat[near] / MIRROR.knot_spacing).astype(np.int64), 0, drive.count - 1)
    sums = np.stack([np.bincount(cell, weight, drive.count) for weight in
                     (np.ones(len(near)), left[near], below[near], left[near] ** 2, left[near] * below[near])])
    total = np.concatenate([np.zeros((5, 1)), np.cumsum(sums, axis=1)], axis=1)
    places = np.arange(drive.count)
    low, high = np.maximum(places - RAYS.beside_intervals, 0), np.minimum(places + RAYS.beside_intervals + 1, drive.count)
    count, x, y, xx, xy = total[:, high] - total[:, low]
    count = np.maximum(count, 1.0)
    spread = xx / count - (x / count) ** 2
    covered = (count >= RAYS.min_returns) & (spread > RAYS.min_spread**2)
    slope = (xy / count - x * y / count**2) / np.where(covered, spread, 1.0)
    return np.interp(places, places[covered], slope[covered]) if covered.any() else np.zeros(drive.count)


# Scanners that no field distinguishes, distinguished by where their scan lines lead.
#
# Seen from the vehicle, the lines of one scanner run in one direction over the road. Points that follow each other in time and lie
# side by side show it; scanners whose planes are turned differently give as many directions.

def told_apart(scanners: int) -> str:
    """What the user is told about so many scanners that no field distinguishes."""
    return f"The points are of {scanners} scanners that no field distinguishes; they were distinguished by where their scan lines lead."


def steps_of(place: np.ndarray, track: FirstTrack, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Steps between points that follow each other in time, on the road near the track: (M,) rows of their first points, and (M,) directions.

    place, time : (N, 3) m and (N,) s, ascending. A direction is a number among those of half a turn, relative to the way driven
    """
    foot, heading = track.at(time)
    offset = place - foot
    near = np.flatnonzero((np.abs(offset[:, 2]) < MIRROR.ground_band) & (np.hypot(offset[:, 0], offset[:, 1]) < MIRROR.near_foot))
    rows, directions = [], []
    for ahead in range(1, MIRROR.followers + 1):
        a, b = near[:-ahead], near[ahead:]
        close = b - a <= MIRROR.followers
        a, b = a[close], b[close]
        step = offset[b, :2] - offset[a, :2]
        size = np.hypot(*step.T)
        used = (size > MIRROR.nearest_step) & (size < MIRROR.farthest_step)
        angle = np.arctan2(step[used, 1], step[used, 0]) - heading[a[used]]
        rows.append(a[used].astype(np.int32))
        directions.append(np.floor(angle % np.pi / np.pi * MIRROR.directions).astype(np.int16) % MIRROR.directions)
    return np.concatenate(rows), np.concatenate(directions)


def scan_line_directions(direction: np.ndarray) -> list[int]:
    """The directions in which (M,) steps lead, the most frequent first; one where the points are of one scanner, none where they lead anywhere."""
    if len(direction) < MIRROR.min_steps:
        return []
    unblurred = np.bincount(direction, minlength=MIRROR.directions).astype(float)
    count = np.sum([np.roll(unblurred, shift) for shift in range(-MIRROR.blurred, MIRROR.blurred + 1)], axis=0)
    most, usual = float(count.max()), float(np.median(count))
    needed = min(max(share * most, clearness * usual) for share, clearness in MIRROR.clear_directions)
    directions: list[int] = []
    while len(directions) < MIRROR.max_directions:
        best = int(np.argmax(count))
        if count[best] < needed:
            break
        directions.append(best)
        count[_apart(np.arange(MIRROR.directions), best) < MIRROR.min_apart] = -1.0
    return directions


def _apart(direction, one):
    """Directions from one to others, either way round."""
    return np.abs((direction - one + MIRROR.directions // 2) % MIRROR.directions - MIRROR.directions // 2)


def lines_of_each(direction: np.ndarray, row: np.ndarray, size: int, ways: list[int]) -> np.ndarray:
    """(size,) number of the scanner of every point, among the directions `ways` of their scan lines; -1 where its steps do not tell."""
    votes = np.stack([np.bincount(row[_apart(direction, way) <= MIRROR.direction_tolerance], minlength=size) for way in ways])
    first = votes.argmax(axis=0)
    most = votes.max(axis=0)
    return np.where((votes == most).sum(axis=0) == 1, first, -1)


@dataclass(frozen=True)
class ScannerSplitter:
    """Tells by the rays which of several scanners measured a point."""

    poses: Poses   # with all of them
    start: float   # s of time 0 of the poses
    origin: np.ndarray   # (3,) map coordinates of their places

    def numbers(self, time: np.ndarray, place: np.ndarray) -> np.ndarray:
        """(N,) uint8 number of the scanner on whose ray a point lies nearest; (N,) s and (N, 3) map coordinates."""
        since = np.asarray(time, float) - self.start
        interval, share = self._places(since)
        off = []   # m off the rays of each scanner
        for number in range(self.poses.scanners):
            off_rays = misfits(self.poses, interval, share, since, place - self.origin, np.full(len(since), number))
            off.append(np.where(off_rays.range > RAYS.min_range, np.abs(off_rays.off).max(axis=0), np.inf))
        return np.argmin(np.stack(off), axis=0).astype(np.uint8)

    def _places(self, since):
        interval, share = np.zeros(len(since), np.int64), np.zeros(len(since))
        for drive in self.poses.drives:
            rows = np.flatnonzero(since >= drive.start) if drive.first else np.arange(len(since))
            interval[rows], share[rows] = drive.interval(since[rows])
        return interval, np.clip(share, 0.0, 1.0)
