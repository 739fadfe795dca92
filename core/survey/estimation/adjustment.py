"""One adjustment of all poses and mountings: every return shall lie on the ray that the mirror had at its time.

Range noise lies along the ray and does not matter; what stands on the road, and whether it is flat, neither. What the returns
leave open is filled by how vehicles move: smoothly, nose ahead, and on average as the road is inclined under them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common.progress import Progress
from .normal_equations import BandedEquations
from .poses import KNOT_SPACING, PITCH, ROLL, YAW, Poses, X, Y, Z, spline_slopes, spline_weights
from .rays import MIN_RANGE, MOUNTING, misfits

ACCELERATION = 3.0          # m/s^2, usual of a vehicle on the road
ANGULAR_ACCELERATION = 0.5  # rad/s^2
PHASE_ACCELERATION = 10.0   # rad/s^2: a rotation rate of 100 Hz that swings by 1 % within seconds
SLIP = np.radians(3.0)      # between nose and way
PITCH_SWAY = np.radians(1.0)  # between nose and climb of the way
ROLL_SWAY = np.radians(2.0)   # between the vehicle and the crossfall under it
MIN_SPEED = 1.0             # m/s: slower, the way says little about the attitude
TURN_PRIOR, LEAN_PRIOR = np.radians(30.0), np.radians(20.0)  # of mountings about the first guess
LEVER_PRIOR = 1.0           # m between scanners
ANGLE_NOISE = 2e-4          # radians of a ray's direction
FIRST_NOISE, LEAST_NOISE = 0.1, 0.002   # m, of places across the ray
OUTLIER_SIGMAS = 3.0        # at which a return has half its weight
ADJUSTMENT_ROUNDS = 12
CONVERGED = 2e-4            # m
BLOCK_INTERVALS = 200       # intervals of one block of returns
PER_INTERVAL = 300          # returns of a scanner that are used of each interval


@dataclass
class Returns:
    """The returns that are adjusted, in order of intervals.

    interval, share : (N,) place in the splines
    time : (N,) s
    place : (N, 3) m
    scanner : (N,)
    tick : s to which the times are rounded; 0 where they are exact
    """

    interval: np.ndarray
    share: np.ndarray
    time: np.ndarray
    place: np.ndarray
    scanner: np.ndarray
    tick: float = 0.0

    def __getitem__(self, which: np.ndarray) -> Returns:
        return Returns(self.interval[which], self.share[which], self.time[which], self.place[which], self.scanner[which], self.tick)


@dataclass
class Adjusted:
    """The adjusted poses.

    poses : Poses
    usual : m, median of the misfits
    unexplained : m, median of what the rounding of the times does not explain of them
    misfit : (K, S) m, mean misfit of each interval and scanner; NaN without returns
    noise : (K, S) m, by which returns were weighted
    place_covariance : (K, 3, 3) m^2 of each control value's place; includes what the mounting leaves open
    mounting_sigma : (S, 5) radians and metres
    """

    poses: Poses
    usual: float
    unexplained: float
    misfit: np.ndarray
    noise: np.ndarray
    place_covariance: np.ndarray
    mounting_sigma: np.ndarray


def adjust_poses(poses: Poses, guess: Poses, crossfall: np.ndarray, returns: Returns, noise: np.ndarray, progress: Progress = Progress()) -> Adjusted:
    """Adjust poses and mountings to the returns by Gauss-Newton steps with robust weights.

    Parameters
    ----------
    poses : Poses near the truth: within a metre, mirror phases within half a radian
    guess : Poses with the mounting that the unknown one scatters about
    crossfall : (K,) radians of the road under the vehicle at every interval, positive where it rises to the left
    returns : Returns
    noise : (K, S) m, how far returns of each interval and scanner may lie off their rays to begin with
    progress : Progress
    """
    for number in range(ADJUSTMENT_ROUNDS):
        equations, misfit, by_rounding, count = _equations(poses, guess, crossfall, returns, noise, progress)
        change, common, covariance, follow = equations.solve()
        poses = poses.changed(change, common.reshape(-1, MOUNTING))
        with np.errstate(invalid="ignore"):
            calm = np.fmin(noise, np.maximum(NOISE_OF_MISFIT * np.sqrt(np.maximum(misfit**2 - by_rounding**2, 0.0)), LEAST_NOISE))
        settled = np.nanmax(noise / calm) < SETTLED and np.abs(change[:, :3]).max() < CONVERGED
        noise = calm
        progress.report((number + 1) / ADJUSTMENT_ROUNDS)
        if settled:
            break
    by_mounting = follow[:, :3]
    own = equations.variances()[:, :3, :3]
    place = own + np.einsum("kia,ab,kjb->kij", by_mounting, covariance, by_mounting)
    usual = float(np.median(misfit[count > 0]))
    unexplained = float(np.median(np.maximum(misfit - MOST_OF_MEAN * by_rounding, 0.0)[count > 0]))
    return Adjusted(poses, usual, unexplained, misfit, noise, place, np.sqrt(np.diag(covariance)).reshape(-1, MOUNTING))


def _equations(poses, guess, crossfall, returns, noise, progress):
    """BandedEquations at the poses, and (K, S) misfits, what of them the times' rounding explains, and counts of each interval and scanner."""
    knots, columns = poses.control.shape
    equations = BandedEquations(knots, columns, MOUNTING * poses.scanners)
    total, count, known = (np.zeros((knots, poses.scanners)) for _ in range(3))
    turned = 2 * np.pi * np.abs(poses.rate) * returns.tick / np.sqrt(12.0)
    cuts = np.searchsorted(returns.interval, np.arange(0, knots + BLOCK_INTERVALS, BLOCK_INTERVALS))
    for first, last in zip(cuts[:-1], cuts[1:]):
        if first == last:
            continue
        own = slice(first, last)
        interval, share, scanner = returns.interval[own], returns.share[own], returns.scanner[own]
        rounded = turned[scanner]
        uncertain = (noise[interval, scanner], rounded) if returns.tick else None
        found = misfits(poses, interval, share, returns.time[own], returns.place[own], scanner, uncertain)
        variance = noise[interval, scanner] ** 2 + (ANGLE_NOISE**2 + rounded**2) * found.range**2
        weight = (found.range > MIN_RANGE) / variance / (1.0 + found.off**2 / variance / OUTLIER_SIGMAS**2)
        weights = spline_weights(share)
        starts = np.flatnonzero(np.r_[True, np.diff(interval) > 0, True])
        for a, b in zip(starts[:-1], starts[1:]):
            equations.add_rows(int(interval[a]), np.concatenate([weights[a:b]] * 2), found.pose[:, a:b].reshape(2 * (b - a), columns),
                               found.mounting[:, a:b].reshape(2 * (b - a), -1), found.off[:, a:b].ravel(), weight[:, a:b].ravel())
        size = np.where(found.range > MIN_RANGE, np.minimum(np.abs(found.off).max(axis=0), MAX_COUNTED_MISFIT), MAX_COUNTED_MISFIT)
        np.add.at(total, (interval, scanner), size)
        np.add.at(count, (interval, scanner), 1)
        np.add.at(known, (interval, scanner), np.minimum(rounded * np.abs(found.range), MAX_COUNTED_MISFIT))
        progress.check_cancelled()
    _add_motion(equations, poses, crossfall)
    _add_mounting(equations, poses, guess)
    with np.errstate(invalid="ignore"):
        return equations, total / count, MEAN_OF_SIGMA * known / count, count


MAX_COUNTED_MISFIT = 0.3   # m: a ghost counts no more than this
NOISE_OF_MISFIT = 1.5      # noise against the mean misfit of an interval
MEAN_OF_SIGMA = 0.8        # mean size of errors against their standard deviation
MOST_OF_MEAN = 1.25        # that rounding explains, of its mean: an interval's returns lie at uneven distances
SETTLED = 1.1              # factor by which the noise still falls


def _add_motion(equations, poses, crossfall):
    """What is known of vehicles and mirrors: smooth motion, nose ahead, level with the road."""
    columns = poses.control.shape[1]
    steady = 1.0 / (KNOT_SPACING**2 * np.r_[[ACCELERATION] * 3, [ANGULAR_ACCELERATION] * 3, [PHASE_ACCELERATION] * poses.scanners]) ** 2
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
        yaw, flat = value[:, YAW], np.maximum(np.hypot(speed[:, X], speed[:, Y]), MIN_SPEED)
        cos, sin = np.cos(yaw), np.sin(yaw)
        change = np.zeros((size, 4, columns))
        change[:, :, X], change[:, :, Y] = -sin[:, None] * slope, cos[:, None] * slope
        change[:, :, YAW] = -(cos * speed[:, X] + sin * speed[:, Y])[:, None] * begin
        equations.add_each(drive.first, change, cos * speed[:, Y] - sin * speed[:, X], 1.0 / (SLIP * flat) ** 2)
        change = np.zeros((size, 4, columns))
        change[:, :, PITCH], change[:, :, Z] = flat[:, None] * begin, -slope
        equations.add_each(drive.first, change, value[:, PITCH] * flat - speed[:, Z], 1.0 / (PITCH_SWAY * flat) ** 2)
        change = np.zeros((size, 4, columns))
        change[:, :, ROLL] = begin
        tilted = value[:, ROLL] - crossfall[drive.first:drive.first + size]
        equations.add_each(drive.first, change, tilted, np.full(size, 1.0 / ROLL_SWAY**2))


def _add_mounting(equations, poses, guess):
    """Weak knowledge of the mounting; the levers' mean is held at 0."""
    sigma = np.array([TURN_PRIOR, LEAN_PRIOR, LEVER_PRIOR, LEVER_PRIOR, LEVER_PRIOR])
    off = np.column_stack([poses.turn - guess.turn, poses.lean - guess.lean, poses.lever - guess.lever])
    for number in range(poses.scanners):
        own = MOUNTING * number + np.arange(MOUNTING)
        equations.corner[own, own] += 1.0 / sigma**2
        equations.common[own] -= off[number] / sigma**2
    for axis in range(3):
        every = MOUNTING * np.arange(poses.scanners) + 2 + axis
        equations.corner[np.ix_(every, every)] += HELD
        equations.common[every] -= HELD * poses.lever[:, axis].sum()


HELD = 1e8  # weight of what is held
