"""Bottom and top corners of curbs: intersections of section plane, curb face, and road or sidewalk.

The samples around every candidate are classified as road, face and raised ground by their height above the line of the
road. A plane is fitted to each class by RANSAC and least squares. Where the three planes are those of a curb, the corners
are the intersections of the face with the two others in the section plane.

Source: the paper on normalized scanlines (ISPRS Archives, 2020), section 3 and table 1, steps c to f. The angles of the
paper are those between the planes and the vertical; here they are those between the normals and the vertical.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common.arrays import Rows
from ..common.corners import CurbSteps
from ..common.pseudo_scanlines import SIGMA_PER_MEAN_DEVIATION, expand_ranges, nearest_distance
from ..weights import CURBS, SCANLINE
from .candidates import CurbCandidates, ScanlineBoundarySettings, ScanlineSamples
from .grid import LINE_SEPARATION

TRUNCATED_SIGMA_FACTOR = 1.35   # derived: sigma of a normal distribution over that of its part within SCANLINE.inlier_sigmas


_RANSAC_DRAWS = np.random.default_rng(SCANLINE.ransac_seed).random((SCANLINE.ransac_trials, 3))   # derived: the same draws in every run
@dataclass
class Planes(Rows):
    """M planes v = c0 + c1 p + c2 q, one through each set of points."""

    coefficients: np.ndarray   # (M, 3); NaN where a set has fewer than three points
    sigma: np.ndarray   # (M,) m, standard deviation of the inliers about the plane
    inliers: np.ndarray   # inliers, points: (M,) int
    points: np.ndarray

    def steepness(self) -> np.ndarray:
        """(M,) m per m, greatest slope of each plane over p and q."""
        return np.hypot(self.coefficients[:, 1], self.coefficients[:, 2])


def _fit_planes(v: np.ndarray, p: np.ndarray, q: np.ndarray, count: np.ndarray, distance: float,
               tolerance: np.ndarray | float = 0.0) -> Planes:
    """A plane through each of M sets of points, by RANSAC and least squares.

    v, p, q : (M, N) float32 m, coordinates about an origin of each set; the first count[i] of a row are points, the rest is padding
    count : (M,) int
    distance : m, RANSAC distance: points nearer to the plane are inliers
    tolerance : (M,) m or a number; it replaces `distance` where it is larger
    """
    sets = len(v)
    coefficients, sigma = np.full((sets, 3), np.nan), np.full(sets, np.nan)
    inliers = np.zeros(sets, np.int64)
    reach = np.broadcast_to(np.maximum(distance, tolerance), sets)
    for first in range(0, sets, SCANLINE.sets_per_batch):
        part = slice(first, first + SCANLINE.sets_per_batch)
        planes = _fit_batch(v[part], p[part], q[part], count[part], reach[part].astype(np.float32), np.float32(distance))
        coefficients[part], sigma[part], inliers[part] = planes
    return Planes(coefficients, sigma, inliers, count)


def _fit_batch(v, p, q, count, reach, distance):
    valid = np.arange(v.shape[1]) < count[:, None]
    coefficients = _best_trial(v, p, q, count, reach)
    for _ in range(SCANLINE.ransac_refits):
        off = v - coefficients[:, :1]
        off -= coefficients[:, 1:2] * p
        off -= coefficients[:, 2:] * q
        np.abs(off, out=off)
        off /= np.sqrt(1 + coefficients[:, 1:2] ** 2 + coefficients[:, 2:] ** 2)
        inside = valid & (off <= reach[:, None])
        coefficients, sigma = _least_squares(v, p, q, inside.astype(np.float32))
        reach = np.maximum(distance, SCANLINE.inlier_sigmas * TRUNCATED_SIGMA_FACTOR * sigma)
    few = count < 3
    coefficients[few], sigma[few] = np.nan, np.nan
    return coefficients, sigma, np.where(few, 0, inside.sum(1))


def _best_trial(v, p, q, count, reach):
    """(B, 3) the plane through three random points, of SCANLINE.ransac_trials, that has the lowest cost."""
    first = np.arange(0, v.size, v.shape[1])[:, None]
    drawn = (_RANSAC_DRAWS[None] * np.maximum(count, 1)[:, None, None]).astype(np.int64) + first[:, None]
    dv, dp, dq = (values.take(drawn) for values in (v, p, q))
    v1, v2 = dv[..., 1] - dv[..., 0], dv[..., 2] - dv[..., 0]
    p1, p2 = dp[..., 1] - dp[..., 0], dp[..., 2] - dp[..., 0]
    q1, q2 = dq[..., 1] - dq[..., 0], dq[..., 2] - dq[..., 0]
    det = p1 * q2 - p2 * q1
    good = np.abs(det) > 1e-7
    det = np.where(good, det, 1)
    c1, c2 = (v1 * q2 - v2 * q1) / det, (p1 * v2 - p2 * v1) / det
    c0 = dv[..., 0] - c1 * dp[..., 0] - c2 * dq[..., 0]
    # the trials are compared on an even subset of the points
    size = min(SCANLINE.scored_points, v.shape[1])
    scored = (np.arange(size) * np.maximum(count, 1)[:, None]) // size + first
    points = np.stack([np.ones(scored.shape, np.float32), p.take(scored), q.take(scored)], axis=1)
    off = np.matmul(np.stack([c0, c1, c2], axis=-1).astype(np.float32), points)
    off -= v.take(scored)[:, None]
    np.abs(off, out=off)
    limit = reach[:, None] * np.sqrt(1 + c1 * c1 + c2 * c2)
    # MSAC cost: of two planes with the same inliers the one through their middle is better
    off /= limit[..., None]
    cost = np.minimum(off, 1, out=off).sum(-1)
    best = np.argmin(np.where(good, cost, np.inf), axis=1)[:, None]
    return np.concatenate([np.take_along_axis(c, best, 1) for c in (c0, c1, c2)], axis=1)


def _least_squares(v, p, q, weight):
    """(B, 3) planes through weighted points, and their standard deviation."""
    n = np.maximum(weight.sum(1), 1)
    mv, mp, mq = ((weight * values).sum(1) / n for values in (v, p, q))
    dv, dp, dq = v - mv[:, None], p - mp[:, None], q - mq[:, None]
    wp, wq, wv = weight * dp, weight * dq, weight * dv
    spp, spq, sqq = (wp * dp).sum(1) / n + SCANLINE.min_plane_variance, (wp * dq).sum(1) / n, (wq * dq).sum(1) / n + SCANLINE.min_plane_variance
    spv, sqv = (wp * dv).sum(1) / n, (wq * dv).sum(1) / n
    det = spp * sqq - spq * spq
    c1, c2 = (spv * sqq - sqv * spq) / det, (sqv * spp - spv * spq) / det
    off = wv - c1[:, None] * wp - c2[:, None] * wq
    sigma = np.sqrt((off * off).sum(1) / np.maximum(n - 3, 1))
    sigma = sigma / np.sqrt(1 + c1 * c1 + c2 * c2)
    return np.stack([mv - c1 * mp - c2 * mq, c1, c2], axis=1), sigma


@dataclass
class CurbCorners(CurbSteps):
    """M corners measured with planes: bottom corners as CurbSteps, and the top corners."""

    PARTS = (*CurbSteps.PARTS, ("top", "top_u", "top_h"))

    top_u: np.ndarray   # top_u, top_h: (M,) m, outward offset and height above the expected road of the top corner
    top_h: np.ndarray
    residual: np.ndarray   # (M,) m, standard deviation of the inliers about the three planes
    sloped: np.ndarray   # (M,) bool, is the face less steep than an upright one?

    @property
    def upright(self) -> np.ndarray:
        """(M,) bool, is the face as steep as is usual?"""
        return ~self.sloped


def corners_of(side: ScanlineSamples, candidates: CurbCandidates, settings: ScanlineBoundarySettings) -> CurbCorners:
    """Corners of the candidates whose three planes are those of road, face and raised ground.

    side : ScanlineSamples of one side, sorted outward

    Returns CurbCorners, at most one per candidate, in the order of the candidates; `scanner_noise` equals `noise` here
    """
    limits = settings.limits
    near = _Surroundings(side, candidates, settings)
    usual = _corners_with_face(near, np.ones(len(candidates), bool), limits.clear_slope)
    if not limits.automatic_slope:
        return usual
    # a sloped face is looked for where no upright one is
    wanted = (side.first + candidates.row) * LINE_SEPARATION + candidates.u
    without_corner = nearest_distance(wanted, usual.profile * LINE_SEPARATION + usual.u) >= SCANLINE.face_half_width
    sloped = _corners_with_face(near, without_corner, limits.least_slope)
    sloped.sloped[:] = True
    corners = CurbCorners.join([usual, sloped])
    return corners[np.lexsort((corners.u, corners.profile))]


class _Surroundings:
    """The samples around the candidates of one side, by what they are: road, face, of any steepness, and raised ground."""

    def __init__(self, side: ScanlineSamples, candidates: CurbCandidates, settings: ScanlineBoundarySettings):
        self.side, self.candidates, self.settings, count = side, candidates, settings, len(candidates)
        self.owner, self.s, self.u, self.h, self.steep = owner, _, u, h, _ = _neighbourhood(side, candidates, settings)
        # heights above the line of the road, so that its slope is no part of the rise
        above = h - candidates.slope.astype(np.float32).take(owner) * u
        share = above / candidates.step.astype(np.float32).take(owner)
        road = (u < -SCANLINE.face_clearance) & (share < SCANLINE.max_road_share) & (above > -SCANLINE.gutter_depth)
        self.face = np.flatnonzero((np.abs(u) < SCANLINE.face_half_width) & (share > SCANLINE.face_share[0]) & (share < SCANLINE.face_share[1]))
        raised = (u > SCANLINE.face_clearance) & (share > SCANLINE.min_raised_share) \
            & (above < (candidates.step + SCANLINE.raised_margin).astype(np.float32).take(owner))
        self.road, self.raised = (_VertexSet(np.flatnonzero(part), owner, count) for part in (road, raised))
        # grass behind a curb scatters more than the road before it
        self.scatter = np.maximum(candidates.rough, _scatter(owner, above, self.raised.vertices, count))

    def faces(self, least_slope: float) -> _VertexSet:
        """The samples of faces with at least this slope, radians."""
        # between sparse points a scanline is less steep than the face
        upright = self.steep.take(self.face) > np.tan(max(least_slope - np.radians(SCANLINE.face_slope_tolerance), 0.0))
        return _VertexSet(self.face[upright], self.owner, len(self.candidates))


def _corners_with_face(near, which, least_slope):
    """`corners_of` some candidates, whose faces have at least this slope, radians; `which` : (M,) bool."""
    side, candidates, settings, s, u, h, scatter = near.side, near.candidates, near.settings, near.s, near.u, near.h, near.scatter
    parts = [near.road, near.faces(least_slope), near.raised]
    alive = np.flatnonzero(np.all([which, *(part.number >= SCANLINE.min_plane_inliers for part in parts)], axis=0))
    lean = np.tan(np.radians(settings.horizontal_angle))
    # the face first: it has the fewest samples and rejects most candidates
    front, front_points, good = _planes(parts[1], alive, SCANLINE.max_face_vertices, (u, h, s), candidates.rough, settings)
    with np.errstate(invalid="ignore"):
        # angle between the normal of the face and the vertical
        over_run = np.abs(front.coefficients[:, 1] / np.hypot(1.0, front.coefficients[:, 2]))
        good &= (np.arctan2(1.0, over_run) >= least_slope) & (np.abs(front.coefficients[:, 2]) <= CURBS.max_face_skew)
    alive, front, front_points = alive[good], front[good], front_points[good]
    ground, ground_points, good = _planes(parts[0], alive, SCANLINE.max_level_vertices, (h, u, s), candidates.rough, settings)
    good &= ground.steepness() <= lean
    alive, front, front_points, ground, ground_points = (x[good] for x in (alive, front, front_points, ground, ground_points))
    top, top_points, good = _planes(parts[2], alive, SCANLINE.max_level_vertices, (h, u, s), scatter, settings)
    good &= top.steepness() <= lean
    bottom_u, bottom_h, bottom_meets = _meeting(ground, front)
    top_u, top_h, top_meets = _meeting(top, front)
    good &= (bottom_meets & top_meets & (top_h - bottom_h >= settings.limits.least_height) & (top_h - bottom_h <= settings.clipping_height))
    for points, plane, at_u, at_h in ((ground_points, ground, bottom_u, bottom_h), (front_points, front, bottom_u, bottom_h),
                                      (front_points, front, top_u, top_h), (top_points, top, top_u, top_h)):
        good &= _distance(u, h, points, plane.points, at_u, at_h) <= SCANLINE.max_corner_distance
    total = ground.inliers + front.inliers + top.inliers
    residual = np.sqrt((ground.sigma**2 * ground.inliers + front.sigma**2 * front.inliers + top.sigma**2 * top.inliers)
                       / np.maximum(total, 1))
    candidates = candidates[alive]
    row, noise = side.first + candidates.row, ground.sigma.astype(float)
    corners = CurbCorners(profile=row, s=row * side.interval, u=candidates.u + bottom_u, h=candidates.base + bottom_h,
                          skew=front.coefficients[:, 2].astype(float), height=top_h - bottom_h, run=np.maximum(top_u - bottom_u, 0.0),
                          noise=noise, scanner_noise=noise, support=ground.inliers + front.inliers, behind=top.inliers, hidden=np.zeros(len(row)),
                          top_u=candidates.u + top_u, top_h=candidates.base + top_h, residual=residual, sloped=np.zeros(len(row), bool))
    return corners[good]


class _VertexSet:
    """The samples of one class (road, face or raised ground) of every candidate."""

    def __init__(self, vertices, owner, count):
        self.vertices = vertices
        self.number = np.bincount(owner[vertices], minlength=count)
        self.first = np.cumsum(self.number) - self.number

    def evenly(self, which, most):
        """(len(which), most) samples of some candidates, an even subset where there are more, and the count of each."""
        number, first = self.number[which], self.first[which]
        size = np.minimum(number, most)
        column = np.arange(most)
        index = np.where(column < size[:, None], (column * number[:, None]) // np.maximum(size, 1)[:, None], 0)
        return self.vertices.take(first[:, None] + index) if len(which) else np.zeros((0, most), np.int64), size


def _planes(part, which, most, coordinates, scatter, settings):
    """Planes of one class of some candidates, their samples, and whether enough of these are inliers."""
    index, number = part.evenly(which, most)
    planes = _fit_planes(*(values.take(index) for values in coordinates), number, settings.ransac_distance, SCANLINE.inlier_sigmas * scatter[which])
    return planes, index, (planes.inliers >= SCANLINE.min_plane_inliers) & (planes.inliers >= SCANLINE.min_inlier_share * planes.points)


def _scatter(owner, values, selected, count):
    """(count,) standard deviation of the selected values of each owner, from their mean absolute deviation."""
    owner, values = owner[selected], values[selected]
    n = np.maximum(np.bincount(owner, minlength=count), 1)
    middle = np.bincount(owner, values, count) / n
    return SIGMA_PER_MEAN_DEVIATION * np.bincount(owner, np.abs(values - middle[owner]), count) / n


def plane_fit_rows(interval: float, settings: ScanlineBoundarySettings) -> int:
    """Scanlines on either side of a candidate from which its planes are fitted. interval : m between section planes"""
    return max(int(np.floor(settings.distance_along / interval + 1e-9)), 1)


def _neighbourhood(side, candidates, settings):
    """(owner, s, u, h, slope) of the samples around every candidate, relative to its place."""
    reach = plane_fit_rows(side.interval, settings)
    stride = max(int(np.ceil((2 * reach + 1) / SCANLINE.max_plane_rows)), 1)
    key = side.row * 1000.0 + side.u
    ahead = np.arange(-(reach // stride), reach // stride + 1) * stride
    row = candidates.row[:, None] + ahead
    middle = row * 1000.0 + candidates.u[:, None]
    start = np.searchsorted(key, middle - settings.distance_across)
    end = np.searchsorted(key, middle + settings.distance_across)
    length = np.where((row >= 0) & (row < side.rows), end - start, 0).ravel()
    # what all samples of a range or of a candidate have is looked up by its number, which is quicker than numpy's repeat
    part, index = expand_ranges(start.ravel(), start.ravel() + length)
    owner = np.repeat(np.arange(len(candidates)), length.reshape(row.shape).sum(1))
    along = np.tile((ahead * side.interval).astype(np.float32), len(candidates)).take(part)
    u, h = side.u.take(index), side.h.take(index)
    u -= candidates.u.take(owner)
    h -= candidates.base.take(owner)
    return owner, along, u.astype(np.float32), h.astype(np.float32), side.steep.take(index)


def _meeting(level, face):
    """Offset and height of the intersection of a level plane and a face in the section plane, and whether it is reliable."""
    a, b = level.coefficients[:, 0].astype(float), level.coefficients[:, 1].astype(float)
    c, d = face.coefficients[:, 0].astype(float), face.coefficients[:, 1].astype(float)
    det = 1.0 - b * d
    with np.errstate(invalid="ignore", divide="ignore"):
        u = (c + d * a) / det
        return u, a + b * u, np.abs(det) > SCANLINE.min_meeting


def _distance(u, h, points, count, at_u, at_h):
    """(M,) m from each corner to the nearest of its samples."""
    if not u.size:
        return np.full(len(at_u), np.inf)
    valid = np.arange(points.shape[1]) < count[:, None]
    squared = (u.take(points) - at_u[:, None]) ** 2 + (h.take(points) - at_h[:, None]) ** 2
    return np.sqrt(np.where(valid, squared, np.inf).min(1))
