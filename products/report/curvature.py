"""Mean curvature of marking points before and after lines were fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ...core.common.parallel import check_cancelled
from ...core.curves.line_segments import SegmentIndex, single_lines
from ...core.survey.store.records import Points

CURVATURE_KERNEL = 0.2   # source: m, radius of the neighbourhood, as in the driving-line thesis
MAX_CANDIDATES = 1800   # derived: marking points, evenly spread, that are tested for being beside a line,
MAX_CURVATURE_POINTS = 600   # derived: and of which so many have their curvature computed
MIN_KERNEL_POINTS = 12   # derived: neighbours, twice the coefficients of a quadric
MAX_PAINT_DISTANCE = 0.25   # m from a fitted line within which a point is its paint
MIN_WIDTH_RATIO = 0.03   # of the variances along the second and the first principal direction: below, neighbours lie in a line
MAX_QUADRIC_CONDITION = 1e3   # condition number of the normal equations of the quadric
KERNELS_PER_BATCH = 100   # derived: neighbourhoods solved at a time
HASHED_CELLS = 2**20   # derived: hash values of cells of the kernel's size
POINTS_LOOKED_AT = 2**18   # derived: marking points looked at together


@dataclass(frozen=True)
class _MarkingCurvature:
    """Mean absolute mean curvature of marking points in a kernel of 0.2 m."""

    before: float   # of the points as measured, 1/m
    after: float   # of the same points at the height of the line fitted to them, 1/m
    points: int   # number of points


def marking_curvature(points: Points, lines: Sequence[Any], origin: Sequence[float]) -> _MarkingCurvature | None:
    """Roughness of line markings before and after fitting.

    The mean curvature of the quadric z = f(x, y) through the neighbours of each point, in the frame of their own plane, as point cloud software
    computes it and the thesis shows it for its fitted markings. It measures how rough the markings are, not how the road curves.

    points : Points on paint; of a few of them columns are read, and all others some at a time
    lines : fitted lines with Z in map coordinates
    origin : (3,) map coordinates of the local origin

    Returns _MarkingCurvature, or None without a line or with too few points beside one
    """
    lines, _ = single_lines(lines)
    if not lines or not len(points):
        return None
    shift = np.asarray(origin, float)
    local = shapely.transform(np.asarray(lines, object), lambda xyz: xyz - shift, include_z=True)
    segments = SegmentIndex(local)
    rows = _spread(len(points), MAX_CANDIDATES)
    candidates = points[rows]
    nearest = segments.nearest(np.c_[candidates.x, candidates.y])
    on_lines = np.flatnonzero((nearest.distance <= MAX_PAINT_DISTANCE) & np.isfinite(nearest.z))
    if len(on_lines) < MIN_KERNEL_POINTS:
        return None
    on_lines = on_lines[_spread(len(on_lines), MAX_CURVATURE_POINTS)]
    kernel_rows = _near(points, rows[on_lines])
    around = points[kernel_rows]
    xyz = np.c_[around.x, around.y, around.z]
    before, after = _before_and_after(xyz, np.searchsorted(kernel_rows, rows[on_lines]), nearest[on_lines], segments)
    finite = np.isfinite(before) & np.isfinite(after)
    if not finite.any():
        return None
    return _MarkingCurvature(float(np.abs(before[finite]).mean()), float(np.abs(after[finite]).mean()), int(finite.sum()))


def _spread(count, most):
    """At most so many of `count` rows, evenly spread."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).astype(int))


def _near(points, which):
    """Ascending rows of all points within the kernel of those at the rows `which`, and of some more."""
    column, row = _cells(points[which])
    marked = np.zeros(HASHED_CELLS, bool)
    steps = np.arange(-1, 2, dtype=np.int32)
    marked[_cell(column[:, None, None] + steps[:, None], row[:, None, None] + steps)] = True
    return np.concatenate([np.empty(0, np.intp), *(first + np.flatnonzero(marked.take(_cell(*_cells(points[first:first + POINTS_LOOKED_AT]))))
                                                   for first in range(0, len(points), POINTS_LOOKED_AT))])


def _cells(points):
    """(N,) int32 column and row of the cells of the kernel's size that points lie in."""
    return [np.floor(axis * (1.0 / CURVATURE_KERNEL)).astype(np.int32) for axis in (points.x, points.y)]


def _cell(column, row):
    """Hash of a cell of the map; some cells that are far apart share it."""
    return (column * np.int32(1031) + row) & np.int32(HASHED_CELLS - 1)


def _before_and_after(xyz, which, nearest, segments):
    """Mean curvature at the rows `which`, (K,) each: of the points, and of these at the height of the line beside them.

    Points in the kernel are brought to the line that is nearest to the middle of the kernel, which on 0.2 m is as good as the line nearest to each.
    """
    tree, result = cKDTree(xyz, balanced_tree=False, compact_nodes=False), np.full((2, len(which)), np.nan)
    heading = segments.heading_at(nearest.line, nearest.station)
    ahead = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    for first in range(0, len(which), KERNELS_PER_BATCH):
        check_cancelled()
        rows = np.arange(first, min(first + KERNELS_PER_BATCH, len(which)))
        around = tree.query_ball_point(xyz[which[rows]], CURVATURE_KERNEL)
        owner, member = np.repeat(np.arange(len(rows)), [len(members) for members in around]), np.concatenate(around).astype(int)
        centre = rows[owner]
        step = xyz[member, :2] - nearest.xy[centre]
        along_line = np.abs(step[:, 1] * ahead[centre, 0] - step[:, 0] * ahead[centre, 1]) <= MAX_PAINT_DISTANCE
        owner, member, centre, step = owner[along_line], member[along_line], centre[along_line], step[along_line]
        count = np.bincount(owner, minlength=len(rows))
        offsets = xyz[member] - xyz[which[centre]]
        result[0, rows] = _quadrics(offsets, count)
        _, height = segments.at(nearest.line[centre], nearest.station[centre] + (step * ahead[centre]).sum(axis=1))
        result[1, rows] = _quadrics(np.c_[offsets[:, :2], height - nearest.z[centre]], count)
    return result


def _quadrics(off, count):
    """Mean curvature of neighbourhoods: (N, 3) points about each one's point, `count` (K,) of them after each other, none empty.

    H = ((1 + fx²) fyy - 2 fx fy fxy + (1 + fy²) fxx) / (2 (1 + fx² + fy²)^1.5) of f(x, y) = a + b x + c y + d x² + e xy + g y², fitted in the frame
    of the neighbours' principal directions; NaN with fewer than 12 neighbours, or if these lie in one or two lines.
    """
    normal, right = np.empty((len(count), 6, 6)), np.empty((len(count), 6))
    radius, terms = CURVATURE_KERNEL, np.ones((7, int(count.max())))
    scale, neighbourhoods = np.array([[radius], [radius], [1.0]]), np.split(off, np.cumsum(count)[:-1])
    # hundreds of neighbours each: a matrix product of a neighbourhood is faster than sums over all of them
    centred = [neighbours - neighbours.mean(axis=0) for neighbours in neighbourhoods]
    values, frames = np.linalg.eigh(np.stack([places.T @ places for places in centred]))
    for k, (neighbours, frame, number) in enumerate(zip(neighbourhoods, frames, count)):
        design = terms[:, :number]
        # in units of the kernel, so that the six columns weigh alike
        u, v, w = (frame.T[::-1] / scale) @ neighbours.T
        design[1], design[2], design[6] = u, v, w
        np.multiply(u, u, out=design[3])
        np.multiply(u, v, out=design[4])
        np.multiply(v, v, out=design[5])
        product = design @ design.T
        normal[k], right[k] = product[:6, :6], product[:6, 6]
    normal += 1e-9 * np.eye(6)
    _, b, c, d, e, g = np.linalg.solve(normal, right[:, :, None])[:, :, 0].T
    fx, fy, fxx, fxy, fyy = b / radius, c / radius, 2 * d / radius**2, e / radius**2, 2 * g / radius**2
    bend = ((1 + fx**2) * fyy - 2 * fx * fy * fxy + (1 + fy**2) * fxx) / (2 * (1 + fx**2 + fy**2)**1.5)
    wide = values[:, 1] > MIN_WIDTH_RATIO * np.maximum(values[:, 2], 1e-12)
    enough = (count >= MIN_KERNEL_POINTS) & wide & (np.linalg.cond(normal) < MAX_QUADRIC_CONDITION)
    return np.where(enough, bend, np.nan)
