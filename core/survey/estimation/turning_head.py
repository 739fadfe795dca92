"""The track of a many-beam head that turns about an upright axis: every return lies in the direction in which the head looked at its time.

In one turn the direction is phi + omega t, so that the place c of the head is a resection from thousands of bearings: of every return at p,
the bearing of p - c equals phi + omega t. Solved for place, speed, phi and omega of every turn by iteratively reweighted least squares; the
speed is nothing where the turns were moved to one place each already, as driving programs do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...curves.robust import MAD_TO_SIGMA
from ..weights import HEAD
from .samples import FirstTrack, Samples, headings_of, thinned


@dataclass
class HeadTrack:
    """Places of the head, one a turn."""

    time: np.ndarray   # (T,) s
    place: np.ndarray   # (T, 2) m
    sigma: np.ndarray   # (T,) m
    heading: np.ndarray   # (T,) radians counter-clockwise from east
    speed: np.ndarray   # (T, 2) m/s by which the head moves in a turn; nothing in clouds whose turns were moved to one place each
    noise: float   # radians, usual residual of a bearing
    rate: float   # turns per second, negative clockwise


def turning_heads(samples: Samples, tracks: list[FirstTrack]) -> list[HeadTrack] | None:
    """The places of a many-beam head in every drive; None where the points are not those of one."""
    rate = _turning_rate(samples, tracks)
    if rate is None:
        return None
    heads = []
    for drive, track in zip(samples.drives, tracks):
        head = _head_track(samples.time[drive], samples.place[drive], track, rate)
        if head is None or len(head.time) < 2 or head.noise > HEAD.max_bearing_noise:
            return None
        heads.append(head)
    return heads


def _turning_rate(samples: Samples, tracks: list[FirstTrack]) -> float | None:
    """Turns per second of a head, negative where it turns clockwise; None where bearings do not turn steadily."""
    drive, track = max(zip(samples.drives, tracks), key=lambda pair: pair[0].stop - pair[0].start)
    middle = 0.5 * (samples.time[drive.start] + samples.time[drive.stop - 1])
    rows = drive.start + np.flatnonzero(np.abs(samples.time[drive] - middle) <= HEAD.rate_seconds / 2)
    offset = samples.place[rows, :2] - track.at(samples.time[rows])[0][:, :2]
    rows, offset = rows[far := np.hypot(*offset.T) > HEAD.far_from_track], offset[far]
    kept = slice(None, None, max(len(rows) // HEAD.max_rate_samples, 1))
    if len(rows) < HEAD.min_turn_samples:
        return None
    time, bearing = samples.time[rows][kept] - middle, np.exp(1j * np.arctan2(offset[kept, 1], offset[kept, 0]))
    rates = np.arange(*HEAD.turning_rates, HEAD.rate_step)
    rates = np.concatenate([rates, -rates])
    coherence = np.array([abs(np.mean(bearing * np.exp(-2j * np.pi * rate * time))) for rate in rates])
    return float(rates[coherence.argmax()]) if coherence.max() >= HEAD.min_coherence else None


def _head_track(time: np.ndarray, place: np.ndarray, track: FirstTrack, rate: float) -> HeadTrack | None:
    """The places of the head in one drive, of (N,) ascending times (s) and (N, 3) places (m); None where no whole turn was seen."""
    time, flat, turn = _turns(time, place[:, :2], 1.0 / abs(rate))
    if not len(time):
        return None
    count = int(turn[-1]) + 1
    begin, end = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(begin, turn, time)
    np.maximum.at(end, turn, time)
    middle = 0.5 * (begin + end)
    since = time - middle[turn]
    head = track.at(middle)[0][:, :2].copy()
    speed, omega = np.zeros((count, 2)), np.full(count, 2 * np.pi * rate)
    rays = flat - head[turn]
    first = np.exp(1j * (np.arctan2(rays[:, 1], rays[:, 0]) - omega[turn] * since))
    phi = np.angle(np.bincount(turn, first.real, count) + 1j * np.bincount(turn, first.imag, count))
    for number in range(HEAD.rounds):
        rays = flat - head[turn] - speed[turn] * since[:, None]
        square = np.maximum((rays**2).sum(axis=1), 1e-6)
        off = np.angle(np.exp(1j * (np.arctan2(rays[:, 1], rays[:, 0]) - phi[turn] - omega[turn] * since)))
        noise = max(1.4826 * float(np.median(np.abs(off))), HEAD.least_bearing_noise)
        weight = (square > (HEAD.nearest_at_first if number < HEAD.first_rounds else HEAD.nearest_return) ** 2) / (1.0 + (off / noise) ** 2)
        by_x, by_y, by_time = rays[:, 1] / square, -rays[:, 0] / square, since * HEAD.rate_scale
        slopes = [by_x, by_y, -np.ones(len(off)), -by_time, by_x * by_time, by_y * by_time]
        weighted = [weight * a for a in slopes]
        normal = np.array([[np.bincount(turn, a * b, count) for b in slopes] for a in weighted]).transpose(2, 0, 1)
        # a weak prior keeps turns solvable that saw one side alone, and their speed small
        normal += np.diag([1e-3, 1e-3, 1e-3, 1e-3, 1.0, 1.0])
        right = np.array([np.bincount(turn, a * off, count) for a in weighted]).T
        step = -np.linalg.solve(normal, right[..., None])[..., 0]
        head += np.clip(step[:, :2], -HEAD.max_step, HEAD.max_step)
        phi, omega = phi + step[:, 2], omega + step[:, 3] * HEAD.rate_scale
        speed += np.clip(step[:, 4:] * HEAD.rate_scale, -HEAD.max_step / 0.1, HEAD.max_step / 0.1)
    misfit = np.sqrt(np.bincount(turn, weight * off**2, count) / np.maximum(np.bincount(turn, weight, count), 1e-9))
    usual = float(np.median(misfit))
    covariance = np.linalg.inv(normal) * usual**2
    sigma = np.sqrt(covariance[:, 0, 0] + covariance[:, 1, 1] + HEAD.least_sigma**2)
    good = misfit <= HEAD.max_turn_misfit * usual
    return HeadTrack(middle[good], head[good], sigma[good], _headings(middle[good], head[good]), speed[good], usual, rate)


def _turns(time, flat, period):
    """(N,) times, (N, 2) places and (N,) numbers of the turns that were seen long enough, thinned."""
    cuts = np.flatnonzero(np.diff(time) > HEAD.min_gap_of_turn * period) + 1
    group = np.searchsorted(cuts, np.arange(len(time)), side="right")
    begun = time[np.r_[0, cuts]][group]
    raw = np.cumsum(np.r_[0, (np.diff(group) > 0) | (np.diff(np.floor((time - begun) / period + 1e-6)) != 0)])
    size = np.bincount(raw)
    first = np.r_[0, np.cumsum(size)[:-1]]
    complete = (time[first + size - 1] - time[first] >= HEAD.min_seen_share_of_turn * period) & (size >= HEAD.min_turn_samples)
    kept = complete[raw] & thinned(raw, HEAD.max_turn_samples)
    return time[kept], flat[kept], (np.cumsum(complete) - 1)[raw[kept]]


def _headings(time, place):
    """(T,) headings of the way driven at uneven times."""
    if len(time) < 2:
        return np.zeros(len(time))
    even = np.linspace(time[0], time[-1], max(int((time[-1] - time[0]) / 0.1), 1) + 1)
    return np.interp(time, even, headings_of(np.stack([np.interp(even, time, axis) for axis in place.T], axis=1)))


# The height of a many-beam head: each of its beams keeps its angle of elevation, on whatever it falls.
#
# A beam draws a ring on the road and lines on walls, cars and trunks, at many distances, and seen from the head all of them have one elevation.
# Seen from too high or too low they have not, and the elevations of all points smear. The height sought is that from which they lie closest
# together. Ground, and the slope of the road, come from the points about each turn.


def head_heights(samples: Samples, tracks: list[FirstTrack], heads: list[HeadTrack]) -> tuple[list[np.ndarray], float | None, float]:
    """Ground beneath the head, (T,) m for each drive, and its height above it with one sigma, m; None where the beams do not tell it."""
    ground, parts, turns = [], [], 0
    share = max(sum(drive.stop - drive.start for drive in samples.drives) // HEAD.max_height_points, 1)
    for drive, track, head in zip(samples.drives, tracks, heads):
        turn, rays, z = _seen_from(samples.time[drive], samples.place[drive], head, share)
        plane = _ground_planes(turn, rays, z, track.at(head.time)[0][:, 2])
        ground.append(plane[:, 0])
        reach = np.hypot(*rays.T)
        above = z - plane[turn, 0] - (plane[turn, 1:] * rays).sum(axis=1)
        near = (reach > HEAD.own_vehicle_reach) & (reach < HEAD.object_reach)
        bearing = np.arctan2(rays[near, 1], rays[near, 0]) - head.heading[turn[near]]
        parts.append((turns + turn[near], reach[near], above[near], bearing))
        turns += -(-len(head.time) // HEAD.turns_of_group) * HEAD.turns_of_group
    turn, reach, above, bearing = (np.concatenate(column) for column in zip(*parts))
    objects = above > HEAD.above_ground
    if objects.mean() < HEAD.min_objects:
        return ground, None, np.nan
    height, sigma = _sharpest(turn[objects], turns // HEAD.turns_of_group, reach[objects], above[objects], bearing[objects])
    return ground, height, sigma


def _seen_from(time, place, head, share):
    """Turn of each point, its (N, 2) place as seen from the head at its time, and its height; those near no turn are left out."""
    rows = np.arange(0, len(time), share)
    turn = np.clip(np.searchsorted(head.time, time[rows]), 1, len(head.time) - 1)
    turn -= time[rows] - head.time[turn - 1] < head.time[turn] - time[rows]
    since = time[rows] - head.time[turn]
    near = np.abs(since) <= 0.5 / abs(head.rate)
    rows, turn, since = rows[near], turn[near], since[near]
    return turn, place[rows, :2] - head.place[turn] - head.speed[turn] * since[:, None], place[rows, 2]


def _ground_planes(turn: np.ndarray, away: np.ndarray, z: np.ndarray, first: np.ndarray) -> np.ndarray:
    """The road about every turn as a plane, (T, 3) height beneath the head and slopes to the east and north, by robust least squares.

    turn, away, z : (N,) numbers, (N, 2) m from the head, (N,) m; first : (T,) m, heights to begin with, which stay where few points are
    """
    near = np.hypot(*away.T) < HEAD.plane_reach
    turn, z = turn[near], z[near]
    design = np.column_stack([np.ones(len(turn)), away[near]])
    count = len(first)
    planes = np.column_stack([first, np.zeros((count, 2))])
    solvable = np.bincount(turn, minlength=count) >= HEAD.least_ground_points
    for number in range(HEAD.ground_rounds):
        off = z - (planes[turn] * design).sum(axis=1)
        # what stands on the road lies above it, so points above lose their weight sooner than those below
        scale = HEAD.first_ground_scale if number < HEAD.ground_rounds // 3 else HEAD.ground_scale
        weight = 1.0 / (1.0 + (np.where(off > 0, 2.0 * off, off) / scale) ** 2) ** 2
        normal = np.array([[np.bincount(turn, weight * a * b, count) for b in design.T] for a in design.T]).transpose(2, 0, 1)
        right = np.array([np.bincount(turn, weight * a * off, count) for a in design.T]).T
        # slopes of roads are small
        normal += np.diag([1e-6, 1.0, 1.0])
        planes += np.where(solvable[:, None], np.linalg.solve(normal, right[..., None])[..., 0], 0.0)
    return planes


def _sharpest(turn, groups, reach, above, bearing):
    """Height from which elevations lie closest together in every turn, and its sigma by those of groups of turns; None where they hardly do."""
    ahead, left, group = np.cos(bearing), np.sin(bearing), turn // HEAD.turns_of_group
    height, tilt = HEAD.first_height, np.zeros((groups, 2))

    def sharpness(height, ahead_tilt, left_tilt, fine):
        elevation = np.arctan((above - height) / reach + ahead_tilt[group] * ahead + left_tilt[group] * left)
        return _pairs(elevation, turn, groups, fine)

    def best(values):
        return np.argmax(values, axis=0)

    for fine, up, lean in HEAD.search:
        steps = np.arange(-HEAD.search_steps, HEAD.search_steps + 1)
        for _ in range(HEAD.search_rounds):
            height += up * steps[best([_pooled(sharpness(height + up * step, *tilt.T, fine)) for step in steps])]
            for axis in (0, 1):
                moved = [tilt + lean * step * np.eye(2)[axis] for step in steps]
                tilt[:, axis] += lean * steps[best([_ratio(sharpness(height, *tilts.T, fine)) for tilts in moved])]
    fine, up, _ = HEAD.search[-1]
    if not HEAD.heights[0] < height < HEAD.heights[1] or _pooled(sharpness(height, *tilt.T, fine)) < HEAD.min_sharing:
        return None, np.nan
    around = up * np.arange(-4 * HEAD.search_steps, 4 * HEAD.search_steps + 1)
    shifts = around[best([_ratio(sharpness(height + shift, *tilt.T, fine)) for shift in around])]
    sigma = float(np.hypot(MAD_TO_SIGMA * np.median(np.abs(shifts)) / np.sqrt(groups), HEAD.least_height_sigma))
    return (float(height), sigma) if sigma <= HEAD.max_height_sigma else (None, np.nan)


def _pairs(elevation, turn, groups, fine):
    """(2, G) pairs of points of one turn in one fine interval of elevation, and as many as there would be by chance within a coarse one."""
    ratio = int(round(HEAD.coarse / fine))
    cell = np.floor(elevation / fine).astype(np.int64)
    cell -= cell.min()
    size = (int(cell.max()) // ratio + 1) * ratio
    turns = groups * HEAD.turns_of_group
    count = np.bincount(turn * size + cell, minlength=turns * size).reshape(turns, size).astype(float)
    wide = count.reshape(turns, -1, ratio).sum(axis=2)
    total = count.sum(axis=1)
    pairs = np.array([(count**2).sum(axis=1) - total, ((wide**2).sum(axis=1) - total) / ratio])
    return pairs.reshape(2, groups, HEAD.turns_of_group).sum(axis=2)


def _ratio(pairs):
    return pairs[0] / np.maximum(pairs[1], 1e-9)


def _pooled(pairs):
    return float(pairs[0].sum() / max(pairs[1].sum(), 1e-9))
