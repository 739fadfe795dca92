"""Bottom corners of curbs that run in any direction, measured across their own direction."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..common.corners import BEHIND_LENGTH, FACE_MARGIN, REMEASURE_SKEW, ROAD_SIDE_LENGTH, StepPatches
from ..common.pseudo_scanlines import expand_ranges
from .raster import PLAN_CELL

SHORT_HALF_LENGTH, LONG_HALF_LENGTH = 0.30, 0.90  # m either way along the curb of the points that tell one step: dense scans, sparse ones
LINE_RADIUS = 1.0     # m about a step within which others tell the direction of their line
MIN_LINE_STEPS = 3       # others that do
MAX_LINE_SCATTER = 0.12    # m, scatter across it
MAX_FACE_OFFSET = 0.10    # m that a step may lie from the place where it is looked for
PATCH_HALF_WIDTH = max(ROAD_SIDE_LENGTH + FACE_MARGIN, BEHIND_LENGTH) + MAX_FACE_OFFSET  # m either way across of the points that tell one step
MEASURING_RADIUS = 2.0          # m from where steps are looked for within which they are measured, however they turn
CELL_ROUNDING = 1e-3          # cells: rounding leaves no point out
MEASURING_ROUNDS = 3           # measurements of a step, each turned by what the one before saw
REMEASURE_OFFSET = 0.04         # m from where it was looked for beyond which it is


@dataclass
class PlanSteps:
    """Bottom corners found in plan, one entry each.

    x, y : (M,) local metres; nx, ny : (M,) unit vector across the curb, uphill
    h : (M,) m above the expected road; height : (M,) m of the step; run : (M,) m across of the face
    noise : (M,) m, heights about the road side's line; support, behind : (M,) points of road side and face, of the raised ground
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

    def __len__(self):
        return len(self.x)

    def __getitem__(self, which):
        return PlanSteps(*(getattr(self, name)[which] for name in self.__dataclass_fields__))

    @staticmethod
    def join(parts):
        return PlanSteps(*(np.concatenate([getattr(p, name) for p in parts]) for name in PlanSteps.__dataclass_fields__))


def measure_plan_steps(rasters, x, y, nx, ny, least, highest):
    """The steps at places in plan that prove to be ones.

    Parameters
    ----------
    rasters : list of GroundRaster: views of the ground; what one does not show is sought in the next
    x, y : (M,) local metres near which a step lies
    nx, ny : (M,) unit vectors uphill, good to some 30 degrees
    least, highest : metres

    Returns
    -------
    PlanSteps, at most M
    """
    line_x, line_y, in_line = _line_directions(x, y, nx, ny)
    # the slope of the ground tells the direction where it is densely seen, else the line that the steps make
    found, left = [], np.arange(len(x))
    for raster in rasters:
        points = raster.by_cell(x[left], y[left], MEASURING_RADIUS)
        steps, good = _measured(raster, points, x[left], y[left], nx[left], ny[left], SHORT_HALF_LENGTH, least, highest)
        found.append(steps)
        left = left[~good & in_line[left]]
        for half in (SHORT_HALF_LENGTH, LONG_HALF_LENGTH):
            steps, good = _measured(raster, points, x[left], y[left], line_x[left], line_y[left], half, least, highest)
            found.append(steps)
            left = left[~good]
    return PlanSteps.join(found)


def _measured(raster, points, x, y, nx, ny, half, least, highest):
    """The steps, and (M,) bool: which places proved to be ones; `points` are the raster's by cell."""
    proved, place, found = np.zeros(len(x), bool), np.arange(len(x)), []
    for turn in range(MEASURING_ROUNDS):
        owner, u, v, h = _points_about(raster, points, x, y, nx, ny, half)
        seen = StepPatches(owner, u, v, h, np.full(len(x), raster.noise), least, highest).corners()
        # a step that runs askew or lies aside is measured again, across its own direction and from its own place
        settled = seen["good"] & ((np.abs(seen["skew"]) <= REMEASURE_SKEW) & (np.abs(seen["u"]) <= REMEASURE_OFFSET) | (turn == MEASURING_ROUNDS - 1))
        proved[place[settled]] = True
        # the tangent is uphill turned to the left
        steps = PlanSteps(x + seen["u"] * nx - seen["s"] * ny, y + seen["u"] * ny + seen["s"] * nx, *_turned(nx, ny, seen["skew"]),
                          *(seen[name] for name in ("h", "height", "run", "noise", "support", "behind")))
        found.append(steps[settled])
        again = seen["good"] & ~settled
        if not again.any():
            break
        place, x, y, nx, ny = place[again], *(getattr(steps, name)[again] for name in ("x", "y", "nx", "ny"))
    return PlanSteps.join(found), proved


def _line_directions(x, y, nx, ny):
    """Uphill directions across the line that the places about each one make, and (M,) bool: do they make one?"""
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


def _turned(nx, ny, skew):
    """Uphill unit vectors of faces that run `skew` uphill per metre along."""
    size = np.hypot(1.0, skew)
    return (nx + skew * ny) / size, (ny - skew * nx) / size


def _points_about(raster, points, x, y, nx, ny, half):
    """Ground points near each place: owner, m uphill, m along, height."""
    px, py, ph, starts = points
    rows, columns = raster.low.shape
    reach = int(np.ceil(np.hypot(PATCH_HALF_WIDTH, half) / PLAN_CELL))
    row = np.floor(y / PLAN_CELL - np.rint(raster.y0 / PLAN_CELL)).astype(np.int64)
    column = np.floor(x / PLAN_CELL - np.rint(raster.x0 / PLAN_CELL)).astype(np.int64)
    line = row[:, None] + np.arange(-reach, reach + 1)
    # of every row of cells those between which the oblong about the place lies
    low = raster.y0 + line * PLAN_CELL - y[:, None]
    left, right = _between(nx[:, None], ny[:, None], low, low + PLAN_CELL, half)
    first = np.clip(np.floor((x[:, None] + left - raster.x0) / PLAN_CELL - CELL_ROUNDING), column[:, None] - reach, column[:, None] + reach + 1)
    last = np.clip(np.floor((x[:, None] + right - raster.x0) / PLAN_CELL + CELL_ROUNDING) + 1, column[:, None] - reach, column[:, None] + reach + 1)
    first, last = np.clip(first, 0, columns).astype(np.int64), np.clip(last, 0, columns).astype(np.int64)
    on = (line >= 0) & (line < rows)
    line = np.clip(line, 0, rows - 1) * columns
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
