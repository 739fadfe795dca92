"""Planes about many candidates at once, by RANSAC and least squares.

A plane is written as the coordinate it faces, v = c0 + c1 * p + c2 * q: height over
offset and station for the road and the sidewalk, offset over height and station for
a curb's face. Every set of points draws its trials from the same fixed table of random
numbers, so that a plane depends on its own points alone: not on what else is worked
on, nor on the order or number of the sections.

References
----------
Fischler and Bolles (1981), Communications of the ACM 24(6); the scanline paper
(ISPRS Archives, 2020), section 3, steps c and d.
"""

from dataclasses import dataclass

import numpy as np

TRIALS = 32          # the points are parted by height before, so most of them are of the plane
SEED = 20
SCORED = 48          # points by which trials are told apart
SIGMAS = 1.5         # inliers lie within so many sigmas of the plane, or the given distance
WHOLE_SIGMA = 1.35   # a normal distribution's sigma over that of its part within SIGMAS
REFITS = 3
BATCH = 96           # sets of points worked on at once, few enough for the processor's cache
LEAST_SPREAD = 1e-6  # m², keeps the plane of points in one line from tilting

_TABLE = np.random.default_rng(SEED).random((TRIALS, 3))


@dataclass
class Planes:
    """Planes v = c0 + c1 p + c2 q, one for each set of points.

    coefficients : (M, 3); sigma : (M,) m, scatter of the inliers about it
    inliers, points : (M,) counts; plane rows with fewer than three points hold NaN
    """

    coefficients: np.ndarray
    sigma: np.ndarray
    inliers: np.ndarray
    points: np.ndarray

    def __getitem__(self, which):
        return Planes(self.coefficients[which], self.sigma[which], self.inliers[which], self.points[which])

    def steepness(self):
        """(M,) rise over run of the plane against the coordinates it stands on."""
        return np.hypot(self.coefficients[:, 1], self.coefficients[:, 2])


def fit_planes(v, p, q, count, distance, tolerance=0.0):
    """A plane through each set of points.

    Parameters
    ----------
    v, p, q : (M, N) float32, metres about a place of each set's own; the first count[i]
        of a row are points, the rest is padding
    count : (M,) int
    distance : m from a plane within which points are inliers
    tolerance : (M,) m or a number, the same where the points are noisier

    Returns
    -------
    Planes
    """
    sets = len(v)
    coefficients, sigma = np.full((sets, 3), np.nan), np.full(sets, np.nan)
    inliers = np.zeros(sets, np.int64)
    reach = np.broadcast_to(np.maximum(distance, tolerance), sets)
    for first in range(0, sets, BATCH):
        part = slice(first, first + BATCH)
        found = _fit_batch(v[part], p[part], q[part], count[part], reach[part].astype(np.float32), np.float32(distance))
        coefficients[part], sigma[part], inliers[part] = found
    return Planes(coefficients, sigma, inliers, count)


def _fit_batch(v, p, q, count, reach, distance):
    there = np.arange(v.shape[1]) < count[:, None]
    coefficients = _best_trial(v, p, q, count, reach)
    for _ in range(REFITS):
        off = v - coefficients[:, :1]
        off -= coefficients[:, 1:2] * p
        off -= coefficients[:, 2:] * q
        np.abs(off, out=off)
        off /= np.sqrt(1 + coefficients[:, 1:2] ** 2 + coefficients[:, 2:] ** 2)
        inside = there & (off <= reach[:, None])
        coefficients, sigma = _least_squares(v, p, q, inside.astype(np.float32))
        reach = np.maximum(distance, SIGMAS * WHOLE_SIGMA * sigma)
    few = count < 3
    coefficients[few], sigma[few] = np.nan, np.nan
    return coefficients, sigma, np.where(few, 0, inside.sum(1))


def _best_trial(v, p, q, count, reach):
    """(B, 3) the plane through three points, of TRIALS, that has the most points near it."""
    first = np.arange(0, v.size, v.shape[1])[:, None]
    drawn = (_TABLE[None] * np.maximum(count, 1)[:, None, None]).astype(np.int64) + first[:, None]
    dv, dp, dq = (values.take(drawn) for values in (v, p, q))
    v1, v2 = dv[..., 1] - dv[..., 0], dv[..., 2] - dv[..., 0]
    p1, p2 = dp[..., 1] - dp[..., 0], dp[..., 2] - dp[..., 0]
    q1, q2 = dq[..., 1] - dq[..., 0], dq[..., 2] - dq[..., 0]
    det = p1 * q2 - p2 * q1
    good = np.abs(det) > 1e-7
    det = np.where(good, det, 1)
    c1, c2 = (v1 * q2 - v2 * q1) / det, (p1 * v2 - p2 * v1) / det
    c0 = dv[..., 0] - c1 * dp[..., 0] - c2 * dq[..., 0]
    # an even choice of the points tells the trials apart
    size = min(SCORED, v.shape[1])
    told = (np.arange(size) * np.maximum(count, 1)[:, None]) // size + first
    points = np.stack([np.ones(told.shape, np.float32), p.take(told), q.take(told)], axis=1)
    off = np.matmul(np.stack([c0, c1, c2], axis=-1).astype(np.float32), points)
    off -= v.take(told)[:, None]
    np.abs(off, out=off)
    limit = reach[:, None] * np.sqrt(1 + c1 * c1 + c2 * c2)
    # near points cost less, so that of two planes with the same points the one through their middle wins
    off /= limit[..., None]
    cost = np.minimum(off, 1, out=off).sum(-1)
    best = np.argmin(np.where(good, cost, np.inf), axis=1)[:, None]
    return np.concatenate([np.take_along_axis(c, best, 1) for c in (c0, c1, c2)], axis=1)


def _least_squares(v, p, q, weight):
    """(B, 3) planes through weighted points, and their scatter."""
    n = np.maximum(weight.sum(1), 1)
    mv, mp, mq = ((weight * values).sum(1) / n for values in (v, p, q))
    dv, dp, dq = v - mv[:, None], p - mp[:, None], q - mq[:, None]
    wp, wq, wv = weight * dp, weight * dq, weight * dv
    spp, spq, sqq = (wp * dp).sum(1) / n + LEAST_SPREAD, (wp * dq).sum(1) / n, (wq * dq).sum(1) / n + LEAST_SPREAD
    spv, sqv = (wp * dv).sum(1) / n, (wq * dv).sum(1) / n
    det = spp * sqq - spq * spq
    c1, c2 = (spv * sqq - sqv * spq) / det, (sqv * spp - spv * spq) / det
    off = wv - c1[:, None] * wp - c2[:, None] * wq
    sigma = np.sqrt((off * off).sum(1) / np.maximum(n - 3, 1))
    sigma = sigma / np.sqrt(1 + c1 * c1 + c2 * c2)
    return np.stack([mv - c1 * mp - c2 * mq, c1, c2], axis=1), sigma
