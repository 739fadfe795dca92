"""Bottom and top corners of curbs: where section plane, curb face, and road or sidewalk meet.

About every candidate the vertices of neighbouring scanlines are parted into road,
face and raised ground by their height over the road's own line. Each part gives a
plane by RANSAC; if the three planes are those of a curb, their meeting points with the
section plane are its corners.

References
----------
The scanline paper (ISPRS Archives, 2020), section 3 and table 1, steps c to f. Its
angles from the vertical are the planes' own; here they are those of the normals.
"""

from dataclasses import dataclass

import numpy as np

from ..profiles.corners import Steps
from .planes import SIGMAS, fit_planes

MOST_ROAD, MOST_FACE = 96, 64  # vertices of road, and of raised ground, that give a plane; and of the face
MOST_ROWS = 9         # scanlines of a neighbourhood; narrower intervals leave some out
FEWEST = 15           # inliers of a plane
LEAST_SHARE = 0.5     # inliers of a plane among its vertices
MEAN_SIGMA = 1.2533   # mean distances from the mean of a normal distribution that are its sigma
LOWER, UPPER = 0.30, 0.70  # share of the rise up to which a vertex is road, and from which it is raised ground
FACE = (0.12, 0.88)   # share of the rise within which it may be face
FACE_REACH = 0.12     # m across from the middle of the rise within which the face lies
SLANT = 20.0          # degrees that a scanline's own slope on a face may fall short of the face's
CLEAR = 0.02          # m from the middle of the rise at which road ends and raised ground begins
UNDER, OVER = 0.12, 0.10   # m below the road's line, and above the rise, that belong to it: gutters; slopes
FARTHEST = 0.10       # m from a corner to the nearest inlier
LEAST_MEETING = 0.1   # 1 - product of the slopes: planes that meet flatter give no corner
MOST_SKEW = 1.0       # m outward per m along


@dataclass
class CurbCorners(Steps):
    """Steps measured by planes: besides the bottom corners, the top ones and the scatter about the planes.

    top_u, top_h : (M,) m, outward offset and height of the top corner above the expected road
    residual : (M,) m, scatter of the inliers about their planes
    """

    top_u: np.ndarray
    top_h: np.ndarray
    residual: np.ndarray


def corners_of(side, candidates, settings):
    """Corners at the candidates whose three planes are road, face and raised ground.

    Parameters
    ----------
    side : Samples walked outward
    candidates : Candidates
    settings : ScanlineBoundarySettings

    Returns
    -------
    CurbCorners, at most one for each candidate, in their order; `usual` is the scatter
    about the planes of each, and no better known here
    """
    owner, s, u, h, steep = _neighbourhood(side, candidates, settings)
    # heights over the road's own line, so that its slope does not count as part of the rise
    over = h - candidates.slope.astype(np.float32)[owner] * u
    share = over / candidates.step.astype(np.float32)[owner]
    road = (u < -CLEAR) & (share < LOWER) & (over > -UNDER)
    # where points lie sparse a scanline slants from the last one on the road to the first on the face
    upright = steep > np.tan(np.radians(settings.vertical_angle - SLANT))
    face = upright & (np.abs(u) < FACE_REACH) & (share > FACE[0]) & (share < FACE[1])
    raised = (u > CLEAR) & (share > UPPER) & (over < (candidates.step + OVER).astype(np.float32)[owner])
    count = len(candidates)
    parts = [_Part(np.flatnonzero(part), owner, count) for part in (road, face, raised)]
    # grass behind a curb scatters more than the road before it
    scatter = np.maximum(candidates.rough, _scatter(owner, over, parts[2].vertices, count))
    alive = np.flatnonzero(np.all([part.number >= FEWEST for part in parts], axis=0))
    lean = np.tan(np.radians(settings.horizontal_angle))
    # the fewer points first, and of what they leave the next
    front, front_points, good = _planes(parts[1], alive, MOST_FACE, (u, h, s), candidates.rough, settings)
    with np.errstate(invalid="ignore"):
        # the angle of the face's normal from the vertical: its slope against height makes it lean
        over_run = np.abs(front.coefficients[:, 1] / np.hypot(1.0, front.coefficients[:, 2]))
        good &= (np.degrees(np.arctan2(1.0, over_run)) >= settings.vertical_angle) & (np.abs(front.coefficients[:, 2]) <= MOST_SKEW)
    alive, front, front_points = alive[good], front[good], front_points[good]
    ground, ground_points, good = _planes(parts[0], alive, MOST_ROAD, (h, u, s), candidates.rough, settings)
    good &= ground.steepness() <= lean
    alive, front, front_points, ground, ground_points = (x[good] for x in (alive, front, front_points, ground, ground_points))
    top, top_points, good = _planes(parts[2], alive, MOST_ROAD, (h, u, s), scatter, settings)
    good &= top.steepness() <= lean
    bottom_u, bottom_h, bottom_meets = _meeting(ground, front)
    top_u, top_h, top_meets = _meeting(top, front)
    with np.errstate(invalid="ignore"):
        good &= (bottom_meets & top_meets & (top_h - bottom_h >= settings.min_height) & (top_h - bottom_h <= settings.clipping_height))
    for points, plane, at_u, at_h in ((ground_points, ground, bottom_u, bottom_h), (front_points, front, bottom_u, bottom_h),
                                      (front_points, front, top_u, top_h), (top_points, top, top_u, top_h)):
        good &= _distance(u, h, points, plane.points, at_u, at_h) <= FARTHEST
    total = ground.inliers + front.inliers + top.inliers
    residual = np.sqrt((ground.sigma**2 * ground.inliers + front.sigma**2 * front.inliers + top.sigma**2 * top.inliers)
                       / np.maximum(total, 1))
    candidates = candidates[alive]
    row, noise = side.first + candidates.row, ground.sigma.astype(float)
    found = CurbCorners(profile=row, s=row * side.interval, u=candidates.u + bottom_u, h=candidates.base + bottom_h,
                        skew=front.coefficients[:, 2].astype(float), height=top_h - bottom_h, run=np.maximum(top_u - bottom_u, 0.0),
                        noise=noise, usual=noise, support=ground.inliers + front.inliers, behind=top.inliers,
                        top_u=candidates.u + top_u, top_h=candidates.base + top_h, residual=residual)
    return found[good]


class _Part:
    """The vertices of one part, road, face or raised ground, about every candidate."""

    def __init__(self, vertices, owner, count):
        self.vertices = vertices
        self.number = np.bincount(owner[vertices], minlength=count)
        self.first = np.cumsum(self.number) - self.number

    def evenly(self, which, most):
        """(len(which), most) vertices of some candidates, evenly chosen where there are more; how many."""
        number, first = self.number[which], self.first[which]
        size = np.minimum(number, most)
        column = np.arange(most)
        place = np.where(column < size[:, None], (column * number[:, None]) // np.maximum(size, 1)[:, None], 0)
        return self.vertices[first[:, None] + place] if len(which) else np.zeros((0, most), np.int64), size


def _planes(part, which, most, coordinates, scatter, settings):
    """Planes of a part of some candidates, the vertices they were made of, and whether enough lie in them."""
    index, number = part.evenly(which, most)
    planes = fit_planes(*(values[index] for values in coordinates), number, settings.ransac_distance, SIGMAS * scatter[which])
    return planes, index, (planes.inliers >= FEWEST) & (planes.inliers >= LEAST_SHARE * planes.points)


def _scatter(owner, values, chosen, count):
    """(count,) spread of the chosen values of each owner, from their mean distance to their mean."""
    owner, values = owner[chosen], values[chosen]
    n = np.maximum(np.bincount(owner, minlength=count), 1)
    middle = np.bincount(owner, values, count) / n
    return MEAN_SIGMA * np.bincount(owner, np.abs(values - middle[owner]), count) / n


def rows_along(interval, settings):
    """Scanlines either side of a candidate from which its planes are made."""
    return max(int(np.floor(settings.distance_along / interval + 1e-9)), 1)


def _neighbourhood(side, candidates, settings):
    """(owner, s, u, h, steepness) of the vertices about every candidate, from its own place."""
    reach = rows_along(side.interval, settings)
    stride = max(int(np.ceil((2 * reach + 1) / MOST_ROWS)), 1)
    key = side.row * 1000.0 + side.u
    ahead = np.arange(-(reach // stride), reach // stride + 1) * stride
    row = candidates.row[:, None] + ahead
    at = row * 1000.0 + candidates.u[:, None]
    start = np.searchsorted(key, at - settings.distance_across)
    end = np.searchsorted(key, at + settings.distance_across)
    length = np.where((row >= 0) & (row < side.rows), end - start, 0).ravel()
    first = start.ravel() - (np.cumsum(length) - length)
    index = np.repeat(first, length)
    index += np.arange(len(index))
    each = length.reshape(row.shape).sum(1)
    owner = np.repeat(np.arange(len(candidates)), each)
    along = np.repeat(np.tile((ahead * side.interval).astype(np.float32), len(candidates)), length)
    u, h = side.u[index], side.h[index]
    u -= np.repeat(candidates.u, each)
    h -= np.repeat(candidates.base, each)
    return owner, along, u.astype(np.float32), h.astype(np.float32), side.steep[index]


def _meeting(level, face):
    """Offset and height where a level plane and a face meet in the section plane, and whether they do."""
    a, b = level.coefficients[:, 0].astype(float), level.coefficients[:, 1].astype(float)
    c, d = face.coefficients[:, 0].astype(float), face.coefficients[:, 1].astype(float)
    det = 1.0 - b * d
    with np.errstate(invalid="ignore", divide="ignore"):
        u = (c + d * a) / det
        return u, a + b * u, np.abs(det) > LEAST_MEETING


def _distance(u, h, points, count, at_u, at_h):
    """(M,) m from a corner to the nearest of its points."""
    if not u.size:
        return np.full(len(at_u), np.inf)
    there = np.arange(points.shape[1]) < count[:, None]
    squared = (u[points] - at_u[:, None]) ** 2 + (h[points] - at_h[:, None]) ** 2
    return np.sqrt(np.where(there, squared, np.inf).min(1))
