"""Bottom corners of curbs of any direction, measured across their own direction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import Rows
from ..common.corners import BEHIND_LENGTH, FACE_MARGIN, REMEASURE_SKEW, ROAD_SIDE_LENGTH, StepPatches
from ..common.pseudo_scanlines import expand_ranges
from .ground.raster import PLAN_CELL, GroundRaster

SHORT_HALF_LENGTH = 0.30      # m either way along the curb of the points that measure one step, in dense scans,
LONG_HALF_LENGTH = 0.90       # m, and in sparse ones
LINE_RADIUS = 1.0             # m about a step within which others give the direction of their line
MIN_LINE_STEPS = 3            # others that this needs
MAX_LINE_SCATTER = 0.12       # m, scatter across that line
MAX_FACE_OFFSET = 0.10        # m that a step may lie from the place where it is looked for
# m either way across of the points that measure one step
PATCH_HALF_WIDTH = max(ROAD_SIDE_LENGTH + FACE_MARGIN, BEHIND_LENGTH) + MAX_FACE_OFFSET
CELL_ROUNDING = 1e-3          # cells, so that rounding leaves no point out
MEASURING_ROUNDS = 3          # measurements of a step, each across the direction that the one before gave
REMEASURE_OFFSET = 0.04       # m from where it was looked for above which a step is measured again


@dataclass
class PlanSteps(Rows):
    """Bottom corners found in plan, one entry each.

    Attributes
    ----------
    x, y : (M,) local m
    nx, ny : (M,) unit vector across the curb, uphill
    h : (M,) m above the expected road
    height : (M,) m of the step
    run : (M,) m across of the face
    noise : (M,) m, scatter of heights about the line of the road side
    support, behind : (M,) points of road side and face, and of the raised ground
    """

    x: np.ndarray
    y: np.ndarray
    nx: np.ndarray
    ny: np.ndarray
    h: np.ndarray
    height: np.ndarray
    run: np.ndarray
    noise: np.ndarray
    support: np.ndarray
    behind: np.ndarray

    @staticmethod
    def none() -> PlanSteps:
        """No steps."""
        return PlanSteps(*(np.empty(0, np.int64 if name in ("support", "behind") else float) for name in PlanSteps.__dataclass_fields__))


def measure_plan_steps(rasters: Sequence[GroundRaster], x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray,
                       min_height: float, max_height: float) -> PlanSteps:
    """The steps at those places in plan where the points prove one.

    Parameters
    ----------
    rasters : list of GroundRaster, views of the ground; what one does not show is looked for in the next
    x, y : (M,) local m near which a step lies
    nx, ny : (M,) unit vectors uphill, good to some 30 degrees
    min_height, max_height : m, of a step

    Returns
    -------
    PlanSteps, at most M
    """
    if not len(x):
        return PlanSteps.none()
    line_x, line_y, in_line = line_directions(x, y, nx, ny)
    # the slope of the ground gives the direction where points are dense, else the line that the steps make
    found, left = [], np.arange(len(x))
    for raster in rasters:
        points = raster.by_cell
        steps, good = _measured(raster, points, x[left], y[left], nx[left], ny[left], SHORT_HALF_LENGTH, min_height, max_height)
        found.append(steps)
        left = left[~good & in_line[left]]
        for half in (SHORT_HALF_LENGTH, LONG_HALF_LENGTH):
            if not len(left):
                return PlanSteps.join(found)
            steps, good = _measured(raster, points, x[left], y[left], line_x[left], line_y[left], half, min_height, max_height)
            found.append(steps)
            left = left[~good]
    return PlanSteps.join(found)


def _measured(raster, points, x, y, nx, ny, half, min_height, max_height):
    """The steps, and (M,) bool: which places proved to be steps; `points` are the raster's by cell."""
    proved, place, found = np.zeros(len(x), bool), np.arange(len(x)), []
    for turn in range(MEASURING_ROUNDS):
        seen, steps = seen_at(raster, points, x, y, nx, ny, half, min_height, max_height)
        # a step of another direction or place is measured again, across its own direction and from its own place
        settled = seen["good"] & ((np.abs(seen["skew"]) <= REMEASURE_SKEW) & (np.abs(seen["u"]) <= REMEASURE_OFFSET) | (turn == MEASURING_ROUNDS - 1))
        proved[place[settled]] = True
        found.append(steps[settled])
        again = seen["good"] & ~settled
        if not again.any():
            break
        place, x, y, nx, ny = place[again], steps.x[again], steps.y[again], steps.nx[again], steps.ny[again]
    return PlanSteps.join(found), proved


def seen_at(raster: GroundRaster, points: tuple[np.ndarray, ...], x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray, half: float,
            min_height: float, max_height: float) -> tuple[dict[str, np.ndarray], PlanSteps]:
    """What the points about each place show across a direction.

    Parameters
    ----------
    raster : GroundRaster
    points : of it, result of `by_cell`
    x, y : (M,) local m
    nx, ny : (M,) unit vectors uphill
    half : m either way along the curb of the points that are used
    min_height, max_height : m, of a step

    Returns
    -------
    result of `StepPatches.corners`, and M PlanSteps, of which those are steps that are `good`
    """
    return steps_of_points(points_about(raster, points, x, y, nx, ny, half), x, y, nx, ny, raster.noise, min_height, max_height)


def steps_of_points(about: tuple[np.ndarray, ...], x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray, noise: float,
                    min_height: float, max_height: float, graded: bool = False) -> tuple[dict[str, np.ndarray], PlanSteps]:
    """`seen_at` of points that are known: `about` is the result of `points_about`; `noise` in m; `graded` as of StepPatches."""
    owner, u, v, h = about
    seen = StepPatches(owner, u, v, h, np.full(len(x), noise), min_height, max_height, graded=graded).corners()
    # the tangent is the uphill direction turned to the left
    return seen, PlanSteps(x + seen["u"] * nx - seen["s"] * ny, y + seen["u"] * ny + seen["s"] * nx, *_rotated(nx, ny, seen["skew"]),
                           *(seen[name] for name in ("h", "height", "run", "noise", "support", "behind")))


def line_directions(x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Uphill unit vectors across the line that the places about each place make, and (M,) bool: do they make a line?

    x, y : (M,) local m; nx, ny : (M,) unit vectors uphill, good to some 30 degrees
    """
    pairs = cKDTree(np.c_[x, y]).query_pairs(LINE_RADIUS, output_type="ndarray")
    # places on the other side of an island face the other way
    pairs = pairs[nx[pairs[:, 0]] * nx[pairs[:, 1]] + ny[pairs[:, 0]] * ny[pairs[:, 1]] > 0.3]
    a, b = np.r_[pairs[:, 0], pairs[:, 1]], np.r_[pairs[:, 1], pairs[:, 0]]
    dx, dy = x[b] - x[a], y[b] - y[a]
    n, sx, sy, sxx, syy, sxy = (np.bincount(a, w, len(x)) for w in (np.ones(len(a)), dx, dy, dx * dx, dy * dy, dx * dy))
    k = n + 1
    sxx, syy, sxy = sxx - sx * sx / k, syy - sy * sy / k, sxy - sx * sy / k
    along = 0.5 * np.arctan2(2 * sxy, sxx - syy)
    lx, ly = -np.sin(along), np.cos(along)
    side = np.where(lx * nx + ly * ny < 0, -1.0, 1.0)
    across = 0.5 * (sxx + syy - np.hypot(sxx - syy, 2 * sxy)) / np.maximum(k, 1)
    return side * lx, side * ly, (n >= MIN_LINE_STEPS) & (across <= MAX_LINE_SCATTER**2)


def _rotated(nx, ny, skew):
    """Uphill unit vectors of faces that run `skew` uphill per metre along."""
    size = np.hypot(1.0, skew)
    return (nx + skew * ny) / size, (ny - skew * nx) / size


def points_about(raster: GroundRaster, points: tuple[np.ndarray, ...], x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray,
                 half: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Ground points near each place: owner, m uphill, m along, height; the parameters are those of `seen_at`."""
    px, py, ph, starts = points
    rows, columns = raster.low.shape
    reach = int(np.ceil(np.hypot(PATCH_HALF_WIDTH, half) / PLAN_CELL))
    row = np.floor(y / PLAN_CELL - np.rint(raster.y0 / PLAN_CELL)).astype(np.int64)
    column = np.floor(x / PLAN_CELL - np.rint(raster.x0 / PLAN_CELL)).astype(np.int64)
    line = row[:, None] + np.arange(-reach, reach + 1)
    # the columns that the rectangle about the place covers in every row of cells
    low = raster.y0 + line * PLAN_CELL - y[:, None]
    left, right = _between(nx[:, None], ny[:, None], low, low + PLAN_CELL, half)
    first = np.floor((x[:, None] + left - raster.x0) / PLAN_CELL - CELL_ROUNDING)
    last = np.floor((x[:, None] + right - raster.x0) / PLAN_CELL + CELL_ROUNDING) + 1
    # the columns of the patch that the raster has; np.clip takes five times as long on few values
    lowest, highest = (np.minimum(np.maximum(column[:, None] + end, 0), columns) for end in (-reach, reach + 1))
    first, last = (np.minimum(np.maximum(ends, lowest), highest).astype(np.int64) for ends in (first, last))
    on = (line >= 0) & (line < rows)
    line = np.minimum(np.maximum(line, 0), rows - 1) * columns
    start = starts[line + first]
    end = np.where(on, starts[line + np.maximum(first, last)], start)
    owner, index = expand_ranges(start.ravel(), end.ravel())
    owner //= 2 * reach + 1
    dx, dy = px.take(index) - x.take(owner), py.take(index) - y.take(owner)
    ex, ey = nx.take(owner), ny.take(owner)
    u, v = ex * dx + ey * dy, ex * dy - ey * dx
    near = np.flatnonzero((np.abs(v) <= half) & (np.abs(u) <= PATCH_HALF_WIDTH))
    return owner.take(near), u.take(near), v.take(near), ph.take(index.take(near))


def _between(nx, ny, low, high, half):
    """Metres along x between which |u| <= PATCH_HALF_WIDTH and |v| <= half somewhere between `low` and `high` along y."""
    left, right = -np.inf, np.inf
    for along_x, along_y, most in ((nx, ny, PATCH_HALF_WIDTH), (-ny, nx, half)):
        along_x = np.where(np.abs(along_x) < 1e-9, 1e-9, along_x)
        middles, width = (-along_y * low / along_x, -along_y * high / along_x), most / np.abs(along_x)
        left, right = np.maximum(left, np.minimum(*middles) - width), np.minimum(right, np.maximum(*middles) + width)
    return left, right
