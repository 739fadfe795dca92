"""The height of a many-beam head: each of its beams keeps its angle of elevation, on whatever it falls.

A beam draws a ring on the road and lines on walls, cars and trunks, at many distances, and seen from the head all of them have one elevation.
Seen from too high or too low they have not, and the elevations of all points smear. The height sought is that from which they lie
closest together. Ground, and the slope of the road, come from the points about each turn.
"""

from __future__ import annotations

import numpy as np

from ...curves.robust import MAD_TO_SIGMA
from .rough.first_track import FirstTrack
from .rough.samples import Samples
from .turning_head import HeadTrack

MAX_HEIGHT_POINTS = 200_000       # of a survey that are looked at
TURNS_OF_GROUP = 10        # consecutive turns over which the vehicle tilts alike
PLANE_REACH, OBJECT_REACH = 12.0, 40.0       # m from the head, of points on the road and on what stands about
OWN_VEHICLE_REACH = 3.0    # m from the head: nearer lies the vehicle itself
LEAST_GROUND_POINTS = 30   # of a turn
GROUND_ROUNDS = 15
FIRST_GROUND_SCALE, GROUND_SCALE = 0.3, 0.05   # m from the ground at which a point's weight is one half, in the first rounds and later
ABOVE_GROUND = 0.3         # m: higher points are on something; those on a level road would be rings seen from any height
MIN_OBJECTS = 0.1          # share of the points that must be on something
FIRST_HEAD_HEIGHT = 1.9    # m
# fineness of elevations and the steps of height (m) and of tilts in which the sharpest is looked for, from coarse to fine
SEARCH = [(np.radians(0.3), 0.1, np.radians(0.3)), (np.radians(0.15), 0.05, np.radians(0.15)),
          (np.radians(0.08), 0.03, np.radians(0.08)), (np.radians(0.05), 0.02, np.radians(0.04))]
SEARCH_STEPS, SEARCH_ROUNDS = 5, 3
COARSE = np.radians(1.5)   # of elevation: what lies within it is spread as walls and trees are, whatever the beams
MIN_SHARING = 1.15       # times as many points share a fine interval as would by chance
LEAST_HEIGHT_SIGMA = 0.15  # m: the beams of a head leave it up to two decimetres above the place that its maker calls its own
MAX_HEIGHT_SIGMA = 0.30    # m: what is known less well is not known
HEIGHTS = 1.0, 4.5         # m above the road at which heads are mounted


def head_heights(samples: Samples, tracks: list[FirstTrack], heads: list[HeadTrack]) -> tuple[list[np.ndarray], float | None, float]:
    """Ground beneath the head, and its height above it.

    Parameters
    ----------
    samples : Samples with times
    tracks : FirstTrack of each drive
    heads : HeadTrack of each drive

    Returns
    -------
    ground : (T,) m for each head, height of the road beneath it at every turn
    height : m of the head above it; None where the beams do not tell it
    sigma : m, of the height
    """
    ground, parts, turns = [], [], 0
    share = max(sum(drive.stop - drive.start for drive in samples.drives) // MAX_HEIGHT_POINTS, 1)
    for drive, track, head in zip(samples.drives, tracks, heads):
        turn, away, z = _seen_from(samples.time[drive], samples.place[drive], head, share)
        plane = ground_planes(turn, away, z, track.at(head.time)[0][:, 2])
        ground.append(plane[:, 0])
        reach = np.hypot(*away.T)
        above = z - plane[turn, 0] - (plane[turn, 1:] * away).sum(axis=1)
        near = (reach > OWN_VEHICLE_REACH) & (reach < OBJECT_REACH)
        bearing = np.arctan2(away[near, 1], away[near, 0]) - head.heading[turn[near]]
        parts.append((turns + turn[near], reach[near], above[near], bearing))
        turns += -(-len(head.time) // TURNS_OF_GROUP) * TURNS_OF_GROUP
    turn, reach, above, bearing = (np.concatenate(column) for column in zip(*parts))
    objects = above > ABOVE_GROUND
    if objects.mean() < MIN_OBJECTS:
        return ground, None, np.nan
    height, sigma = _sharpest(turn[objects], turns // TURNS_OF_GROUP, reach[objects], above[objects], bearing[objects])
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


def ground_planes(turn: np.ndarray, away: np.ndarray, z: np.ndarray, first: np.ndarray) -> np.ndarray:
    """The road about every turn as a plane, by robust least squares from a first height.

    Parameters
    ----------
    turn : (N,) int; away : (N, 2) m from the head; z : (N,) m
    first : (T,) m, heights to begin with

    Returns
    -------
    (T, 3) height beneath the head and slopes to the east and north; level at the first height where few points are
    """
    near = np.hypot(*away.T) < PLANE_REACH
    turn, z = turn[near], z[near]
    design = np.column_stack([np.ones(len(turn)), away[near]])
    count = len(first)
    planes = np.column_stack([first, np.zeros((count, 2))])
    enough = np.bincount(turn, minlength=count) >= LEAST_GROUND_POINTS
    for number in range(GROUND_ROUNDS):
        off = z - (planes[turn] * design).sum(axis=1)
        # what stands on the road lies above it, so points above lose their weight sooner than those below
        scale = FIRST_GROUND_SCALE if number < GROUND_ROUNDS // 3 else GROUND_SCALE
        weight = 1.0 / (1.0 + (np.where(off > 0, 2.0 * off, off) / scale) ** 2) ** 2
        normal = np.array([[np.bincount(turn, weight * a * b, count) for b in design.T] for a in design.T]).transpose(2, 0, 1)
        right = np.array([np.bincount(turn, weight * a * off, count) for a in design.T]).T
        # slopes of roads are small
        normal += np.diag([1e-6, 1.0, 1.0])
        planes += np.where(enough[:, None], np.linalg.solve(normal, right[..., None])[..., 0], 0.0)
    return planes


def _sharpest(turn, groups, reach, above, bearing):
    """Height from which elevations lie closest together in every turn, and its sigma by those of groups of turns; None where they hardly do."""
    ahead, left, group = np.cos(bearing), np.sin(bearing), turn // TURNS_OF_GROUP
    height, tilt = FIRST_HEAD_HEIGHT, np.zeros((groups, 2))

    def sharpness(height, ahead_tilt, left_tilt, fine):
        elevation = np.arctan((above - height) / reach + ahead_tilt[group] * ahead + left_tilt[group] * left)
        return _pairs(elevation, turn, groups, fine)

    def best(values):
        return np.argmax(values, axis=0)

    for fine, up, lean in SEARCH:
        steps = np.arange(-SEARCH_STEPS, SEARCH_STEPS + 1)
        for _ in range(SEARCH_ROUNDS):
            height += up * steps[best([_pooled(sharpness(height + up * step, *tilt.T, fine)) for step in steps])]
            for axis in (0, 1):
                moved = [tilt + lean * step * np.eye(2)[axis] for step in steps]
                tilt[:, axis] += lean * steps[best([_ratio(sharpness(height, *one.T, fine)) for one in moved])]
    fine, up, _ = SEARCH[-1]
    if not HEIGHTS[0] < height < HEIGHTS[1] or _pooled(sharpness(height, *tilt.T, fine)) < MIN_SHARING:
        return None, np.nan
    around = up * np.arange(-4 * SEARCH_STEPS, 4 * SEARCH_STEPS + 1)
    own = around[best([_ratio(sharpness(height + shift, *tilt.T, fine)) for shift in around])]
    sigma = float(np.hypot(MAD_TO_SIGMA * np.median(np.abs(own)) / np.sqrt(groups), LEAST_HEIGHT_SIGMA))
    return (float(height), sigma) if sigma <= MAX_HEIGHT_SIGMA else (None, np.nan)


def _pairs(elevation, turn, groups, fine):
    """(2, G) pairs of points of one turn in one fine interval of elevation, and as many as there would be by chance within COARSE."""
    ratio = int(round(COARSE / fine))
    cell = np.floor(elevation / fine).astype(np.int64)
    cell -= cell.min()
    size = (int(cell.max()) // ratio + 1) * ratio
    turns = groups * TURNS_OF_GROUP
    count = np.bincount(turn * size + cell, minlength=turns * size).reshape(turns, size).astype(float)
    wide = count.reshape(turns, -1, ratio).sum(axis=2)
    total = count.sum(axis=1)
    pairs = np.array([(count**2).sum(axis=1) - total, ((wide**2).sum(axis=1) - total) / ratio])
    return pairs.reshape(2, groups, TURNS_OF_GROUP).sum(axis=2)


def _ratio(pairs):
    return pairs[0] / np.maximum(pairs[1], 1e-9)


def _pooled(pairs):
    return float(pairs[0].sum() / max(pairs[1].sum(), 1e-9))
