"""Mean curvature of marking points before and after lines were fitted, and curvature along driving lines."""

from dataclasses import dataclass

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ..common.parallel import check_cancelled
from .matching import Segments, single_lines

KERNEL = 0.2         # m, radius of the neighbourhood, as the driving-line thesis has it
TRIED = 1800         # marking points, spread evenly, that are looked at for being beside a line,
SAMPLE = 600         # and how many of these have their curvature taken
LEAST = 12           # neighbours that a quadric of six coefficients needs to mean something
FLAT = 0.03          # least share of the second principal direction: below, the neighbours lie in a line
STEADY = 1e3         # largest condition of the equations for the quadric
BESIDE = 0.25        # m from a fitted line within which a point is its paint
BLOCK = 100          # neighbourhoods solved at a time
CELLS = 2**20        # numbers of cells of the kernel's size
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
    x, y, z = points.x, points.y, points.z
    segments = Segments(local)
    which = _spread(len(x), TRIED)
    feet = segments.nearest(np.c_[x[which], y[which]])
    beside = np.flatnonzero((feet.distance <= BESIDE) & np.isfinite(feet.z))
    if len(beside) < LEAST:
        return None
    beside = beside[_spread(len(beside), SAMPLE)]
    near = _near(x, y, which[beside])
    xyz = np.c_[x[near], y[near], z[near]]
    before, after = _before_and_after(xyz, np.searchsorted(near, which[beside]), feet.only(beside), segments)
    known = np.isfinite(before) & np.isfinite(after)
    if not known.any():
        return None
    return MarkingCurvature(float(np.abs(before[known]).mean()), float(np.abs(after[known]).mean()), int(known.sum()))


def _spread(count, most):
    """At most so many of `count` rows, evenly spread."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).astype(int))


def _near(x, y, which):
    """Rows of all points within the kernel of those at the rows `which`, and of some more, ascending."""
    column, row = (np.floor(axis * (1.0 / KERNEL)).astype(np.int32) for axis in (x, y))
    marked = np.zeros(CELLS, bool)
    for right in (-1, 0, 1):
        for up in (-1, 0, 1):
            marked[_cell(column[which] + np.int32(right), row[which] + np.int32(up))] = True
    return np.flatnonzero(marked.take(_cell(column, row)))


def _cell(column, row):
    """Number of a cell of the map, the same for some that are far apart."""
    return (column * np.int32(1031) + row) & np.int32(CELLS - 1)


def _before_and_after(xyz, which, feet, segments):
    """Mean curvature at the rows `which`, (K,) each: of the points, and of these at the height of the line beside them.

    Points in the kernel are brought to the line that is nearest to the middle of the kernel, which on
    0.2 m is as good as the line nearest to each.
    """
    tree, found = _tree(xyz), np.full((2, len(which)), np.nan)
    heading = segments.heading_at(feet.line, feet.station)
    ahead = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    for first in range(0, len(which), BLOCK):
        check_cancelled()
        rows = np.arange(first, min(first + BLOCK, len(which)))
        owner, member = _around(tree, xyz, which[rows], KERNEL)
        own = rows[owner]
        step = xyz[member, :2] - feet.xy[own]
        beside = np.abs(step[:, 1] * ahead[own, 0] - step[:, 0] * ahead[own, 1]) <= BESIDE
        owner, member, own, step = owner[beside], member[beside], own[beside], step[beside]
        count = np.bincount(owner, minlength=len(rows))
        off = xyz[member] - xyz[which[own]]
        found[0, rows] = _quadrics(off, count, KERNEL)
        _, height = segments.at(feet.line[own], feet.station[own] + (step * ahead[own]).sum(axis=1))
        found[1, rows] = _quadrics(np.c_[off[:, :2], height - feet.z[own]], count, KERNEL)
    return found


def mean_curvature(xyz, which, radius=KERNEL):
    """(K,) mean curvature, 1/m, of points at the rows `which`; NaN with fewer than 12 neighbours, or where these lie in a line or two.

    ::

        H = ((1 + fx²) fyy - 2 fx fy fxy + (1 + fy²) fxx) / (2 (1 + fx² + fy²)^1.5)

    of f(x, y) = a + b x + c y + d x² + e xy + g y², fitted in the frame of the neighbours' principal directions.
    """
    tree, found = _tree(xyz), np.full(len(which), np.nan)
    for first in range(0, len(which), BLOCK):
        some = which[first:first + BLOCK]
        owner, member = _around(tree, xyz, some, radius)
        found[first:first + BLOCK] = _quadrics(xyz[member] - xyz[some][owner], np.bincount(owner, minlength=len(some)), radius)
    return found


def _tree(xyz):
    return cKDTree(xyz, balanced_tree=False, compact_nodes=False)


def _around(tree, xyz, which, radius):
    """(owner, member): which of the rows `which` has which point in its kernel, owner by owner."""
    around = tree.query_ball_point(xyz[which], radius)
    return np.repeat(np.arange(len(which)), [len(rows) for rows in around]), np.concatenate(around).astype(int)


def _quadrics(off, count, radius):
    """Mean curvature of neighbourhoods: (N, 3) places about each one's point, `count` (K,) of them after each other, none empty."""
    values, normal, right = np.empty((len(count), 3)), np.empty((len(count), 6, 6)), np.empty((len(count), 6))
    terms, scale = np.ones((7, int(count.max()))), np.array([[radius], [radius], [1.0]])
    # hundreds of neighbours each: a matrix product of a neighbourhood is faster than sums over all of them
    for k, (first, number) in enumerate(zip(np.cumsum(count) - count, count)):
        own = off[first:first + number]
        centred = own - own.mean(axis=0)
        values[k], frame = np.linalg.eigh(centred.T @ centred)
        some = terms[:, :number]
        # in units of the kernel, so that the six columns weigh alike
        u, v, w = (frame.T[::-1] / scale) @ own.T
        some[1], some[2], some[6] = u, v, w
        np.multiply(u, u, out=some[3])
        np.multiply(u, v, out=some[4])
        np.multiply(v, v, out=some[5])
        product = some @ some.T
        normal[k], right[k] = product[:6, :6], product[:6, 6]
    normal += 1e-9 * np.eye(6)
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
