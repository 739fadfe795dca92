"""Mean curvature of marking points before and after lines were fitted, and curvature along driving lines."""

from dataclasses import dataclass

import numpy as np
import shapely
from scipy.spatial import cKDTree

from .places import Segments, single_lines

KERNEL = 0.2         # m, radius of the neighbourhood, as the driving-line thesis has it
SAMPLE = 1500        # marking points whose curvature is taken, spread evenly
LEAST = 12           # neighbours that a quadric of six coefficients needs to mean something
FLAT = 0.03          # least share of the second principal direction: below, the neighbours lie in a line
STEADY = 1e3         # largest condition of the equations for the quadric
BESIDE = 0.25        # m from a fitted line within which a point is its paint
BLOCK = 250          # neighbourhoods solved at a time
DIAGRAM_STEP = 1.0   # m between the values of a curvature diagram
DIAGRAM_BASE = 5.0   # m to either side over which a heading changes


@dataclass(frozen=True)
class MarkingCurvature:
    """Mean of the absolute mean curvature (1/m) at marking points in a kernel of 0.2 m: of the points as measured,
    and of the same points brought to the height of the line fitted to them. `points`: how many were looked at."""

    before: float
    after: float
    points: int


def marking_curvature(points, lines, origin):
    """Curvature of line markings.

    The mean curvature of the quadric z = f(x, y) through the neighbours of each point, in the frame of their own
    plane, as point cloud software takes it; the thesis shows it in its figure of fitted markings. It tells how
    rough the markings are, not how the road bends.

    Parameters
    ----------
    points : object with x, y, z (local metres), the paint
    lines : fitted lines with Z in map coordinates
    origin : what local coordinates leave out

    Returns
    -------
    MarkingCurvature, or None where there is no line or too little paint beside one
    """
    lines, _ = single_lines(lines)
    if not lines or not len(points):
        return None
    shift = np.asarray(origin, float)
    local = shapely.transform(np.asarray(lines, object), lambda xyz: xyz - shift, include_z=True)
    xyz = np.c_[points.x, points.y, points.z]
    feet = Segments(local).nearest(xyz[:, :2])
    near = (feet.distance <= BESIDE) & np.isfinite(feet.z)
    if near.sum() < LEAST:
        return None
    fitted = np.c_[xyz[near, :2], feet.z[near]]
    which = np.unique(np.linspace(0, near.sum() - 1, min(int(near.sum()), SAMPLE)).astype(int))
    before, after = mean_curvature(xyz[near], which), mean_curvature(fitted, which)
    known = np.isfinite(before) & np.isfinite(after)
    if not known.any():
        return None
    return MarkingCurvature(float(np.abs(before[known]).mean()), float(np.abs(after[known]).mean()), int(known.sum()))


def mean_curvature(xyz, which, radius=KERNEL):
    """(K,) mean curvature, 1/m, of points at the rows `which`; NaN with fewer than 12 neighbours, or where these lie in a line or two.

    ::

        H = ((1 + fx²) fyy - 2 fx fy fxy + (1 + fy²) fxx) / (2 (1 + fx² + fy²)^1.5)

    of f(x, y) = a + b x + c y + d x² + e xy + g y², fitted in the frame of the neighbours' principal directions.
    """
    tree, found = cKDTree(xyz), np.full(len(which), np.nan)
    for first in range(0, len(which), BLOCK):
        rows = slice(first, first + BLOCK)
        found[rows] = _quadrics(xyz, which[rows], tree, radius)
    return found


def _quadrics(xyz, which, tree, radius):
    around = tree.query_ball_point(xyz[which], radius)
    count = np.fromiter((len(rows) for rows in around), int, len(around))
    owner, member = np.repeat(np.arange(len(which)), count), np.concatenate(around).astype(int)
    off = xyz[member] - xyz[which][owner]
    starts = np.cumsum(count) - count
    mean = np.add.reduceat(off, starts) / count[:, None]
    centred = off - mean[owner]
    spread = np.add.reduceat(centred[:, :, None] * centred[:, None, :], starts)
    values, frame = np.linalg.eigh(spread)
    u, v, w = (np.einsum("ij,ij->i", off, frame[owner, :, k]) for k in (2, 1, 0))
    # in units of the kernel, so that the six columns weigh alike
    terms = np.stack([np.ones(len(u)), u / radius, v / radius, (u / radius)**2, u * v / radius**2, (v / radius)**2], axis=1)
    normal = np.add.reduceat(terms[:, :, None] * terms[:, None, :], starts) + 1e-9 * np.eye(6)
    right = np.add.reduceat(terms * w[:, None], starts)
    _, b, c, d, e, g = np.linalg.solve(normal, right[:, :, None])[:, :, 0].T
    fx, fy, fxx, fxy, fyy = b / radius, c / radius, 2 * d / radius**2, e / radius**2, 2 * g / radius**2
    bend = ((1 + fx**2) * fyy - 2 * fx * fy * fxy + (1 + fy**2) * fxx) / (2 * (1 + fx**2 + fy**2)**1.5)
    enough = (count >= LEAST) & (values[:, 1] > FLAT * np.maximum(values[:, 2], 1e-12)) & (np.linalg.cond(normal) < STEADY)
    return np.where(enough, bend, np.nan)


def curvature_along(line, step=DIAGRAM_STEP, base=DIAGRAM_BASE):
    """Curvature along a line, in the direction it is drawn.

    Returns
    -------
    station : (N,) metres along the line
    curvature : (N,) 1/m, positive where it turns left: change of heading between the chords of `base` metres
        behind and ahead. Empty where the line is shorter than two chords.
    """
    length = line.length
    station = np.arange(base, length - base + 1e-9, step)
    if not len(station):
        return np.empty(0), np.empty(0)
    behind, at, ahead = (shapely.get_coordinates(shapely.line_interpolate_point(line, station + k)) for k in (-base, 0.0, base))
    first, second = np.arctan2(*(at - behind).T[::-1]), np.arctan2(*(ahead - at).T[::-1])
    turn = (second - first + np.pi) % (2 * np.pi) - np.pi
    return station, turn / base
