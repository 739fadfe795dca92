"""Bottom corners of curbs of any direction, measured across their own direction."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import Rows
from ..common.corners import StepPatches
from ..common.pseudo_scanlines import expand_ranges
from ..weights import CURBS, RETURN
from .ground_raster import GroundRaster, diamond, grown

# m either way across of the points that measure one step
PATCH_HALF_WIDTH = max(CURBS.road_side_length + CURBS.face_margin, CURBS.behind_length) + RETURN.max_face_offset
CELL_ROUNDING = 1e-3   # derived: cells, so that rounding leaves no point out


@dataclass
class PlanSteps(Rows):
    """Bottom corners found in plan, one entry each."""

    x: np.ndarray   # x, y: (M,) local m
    y: np.ndarray
    nx: np.ndarray   # nx, ny: (M,) unit vector across the curb, uphill
    ny: np.ndarray
    h: np.ndarray   # (M,) m above the expected road
    height: np.ndarray   # (M,) m of the step
    run: np.ndarray   # (M,) m across of the face
    noise: np.ndarray   # (M,) m, scatter of heights about the line of the road side
    support: np.ndarray   # support, behind: (M,) points of road side and face, and of the raised ground
    behind: np.ndarray

    @staticmethod
    def none() -> PlanSteps:
        """No steps."""
        return PlanSteps(*(np.empty(0, np.int64 if name in ("support", "behind") else float) for name in PlanSteps.__dataclass_fields__))


def measure_plan_steps(rasters: Sequence[GroundRaster], x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray,
                       min_height: float, max_height: float) -> PlanSteps:
    """The steps at those places in plan where the points prove one.

    rasters : list of GroundRaster, views of the ground; what one does not show is looked for in the next
    x, y : (M,) local m near which a step lies
    nx, ny : (M,) unit vectors uphill, good to some 30 degrees
    min_height, max_height : m, of a step

    Returns PlanSteps, at most M
    """
    if not len(x):
        return PlanSteps.none()
    line_x, line_y, in_line = line_directions(x, y, nx, ny)
    # the slope of the ground gives the direction where points are dense, else the line that the steps make
    parts, left = [], np.arange(len(x))
    for raster in rasters:
        points = raster.by_cell
        steps, good = _measured(raster, points, x[left], y[left], nx[left], ny[left], RETURN.short_half_length, min_height, max_height)
        parts.append(steps)
        left = left[~good & in_line[left]]
        for half in (RETURN.short_half_length, RETURN.long_half_length):
            if not len(left):
                return PlanSteps.join(parts)
            steps, good = _measured(raster, points, x[left], y[left], line_x[left], line_y[left], half, min_height, max_height)
            parts.append(steps)
            left = left[~good]
    return PlanSteps.join(parts)


def _measured(raster, points, x, y, nx, ny, half, min_height, max_height):
    """The steps, and (M,) bool: which places proved to be steps; `points` are the raster's by cell."""
    proved, candidate, parts = np.zeros(len(x), bool), np.arange(len(x)), []
    for turn in range(RETURN.measuring_rounds):
        corners, steps = steps_of_points(points_about(raster, points, x, y, nx, ny, half), x, y, nx, ny, raster.noise, min_height, max_height)
        # a step of another direction or place is measured again, across its own direction and from its own place
        settled = corners["good"] & ((np.abs(corners["skew"]) <= CURBS.remeasure_skew) & (np.abs(corners["u"]) <= RETURN.remeasure_offset)
                                     | (turn == RETURN.measuring_rounds - 1))
        proved[candidate[settled]] = True
        parts.append(steps[settled])
        unsettled = corners["good"] & ~settled
        if not unsettled.any():
            break
        candidate, x, y, nx, ny = candidate[unsettled], steps.x[unsettled], steps.y[unsettled], steps.nx[unsettled], steps.ny[unsettled]
    return PlanSteps.join(parts), proved


def steps_of_points(about: tuple[np.ndarray, ...], x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray, noise: float,
                    min_height: float, max_height: float, graded: bool = False) -> tuple[dict[str, np.ndarray], PlanSteps]:
    """What the points about each place show across a direction.

    about : result of `points_about`
    x, y : (M,) local m
    nx, ny : (M,) unit vectors uphill
    noise, min_height, max_height : m, of the scanner, and of a step
    graded : as of StepPatches

    Returns the result of `StepPatches.corners`, and M PlanSteps, of which those are steps that are `good`
    """
    owner, u, v, h = about
    corners = StepPatches(owner, u, v, h, np.full(len(x), noise), min_height, max_height, graded=graded).corners()
    skew = corners["skew"]   # m that a face runs uphill per m along
    size = np.hypot(1.0, skew)
    # the tangent is the uphill direction turned to the left
    return corners, PlanSteps(x + corners["u"] * nx - corners["s"] * ny, y + corners["u"] * ny + corners["s"] * nx,
                              (nx + skew * ny) / size, (ny - skew * nx) / size,
                              *(corners[name] for name in ("h", "height", "run", "noise", "support", "behind")))


def line_directions(x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Uphill unit vectors across the line that the places about each place make, and (M,) bool: do they make a line?

    x, y : (M,) local m; nx, ny : (M,) unit vectors uphill, good to some 30 degrees
    """
    pairs = cKDTree(np.c_[x, y]).query_pairs(RETURN.line_radius, output_type="ndarray")
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
    return side * lx, side * ly, (n >= RETURN.min_line_steps) & (across <= RETURN.max_line_scatter**2)


def points_about(raster: GroundRaster, points: tuple[np.ndarray, ...], x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray,
                 half: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Ground points near each place: owner, m uphill, m along, height.

    points : of the raster, result of `by_cell`
    x, y, nx, ny : as of `steps_of_points`
    half : m either way along the curb of the points that are used
    """
    px, py, ph, starts = points
    rows, columns = raster.low.shape
    reach = int(np.ceil(np.hypot(PATCH_HALF_WIDTH, half) / RETURN.plan_cell))
    row, column = raster.cells_at(x, y)
    line = row[:, None] + np.arange(-reach, reach + 1)
    # the columns that the rectangle about the place covers in every row of cells
    low = raster.y0 + line * RETURN.plan_cell - y[:, None]
    left, right = _between(nx[:, None], ny[:, None], low, low + RETURN.plan_cell, half)
    first = np.floor((x[:, None] + left - raster.x0) / RETURN.plan_cell - CELL_ROUNDING)
    last = np.floor((x[:, None] + right - raster.x0) / RETURN.plan_cell + CELL_ROUNDING) + 1
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
    for along_x, along_y, reach in ((nx, ny, PATCH_HALF_WIDTH), (-ny, nx, half)):
        along_x = np.where(np.abs(along_x) < 1e-9, 1e-9, along_x)
        middles, width = (-along_y * low / along_x, -along_y * high / along_x), reach / np.abs(along_x)
        left, right = np.maximum(left, np.minimum(*middles) - width), np.minimum(right, np.maximum(*middles) + width)
    return left, right


# Places where the ground rises beside driven ground, in any direction.


def step_places(raster: GroundRaster, slopes: Sequence[np.ndarray], driven: np.ndarray, stepped: np.ndarray, min_height: float,
                max_height: float, wanted: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None) -> tuple[np.ndarray, ...]:
    """Where the ground rises beside driven ground: place and direction, at most one for every square of two cells.

    slopes : result of `ground_slopes`
    driven, stepped : result of `driven_ground`
    min_height, max_height : m, of a step
    wanted : function, local x, y -> (N,) bool: only these are returned, and squares without such a cell are not looked at

    Returns
        x, y : (M,) local m
        nx, ny : (M,) unit vector uphill
    """
    near_road = grown(driven, diamond(RETURN.max_cells_from_road))
    row, column = np.nonzero(stepped & near_road)
    in_reach = np.ones(len(row), bool)
    if wanted is not None:
        x, y = raster.middle(row, column)
        in_reach = wanted(x, y)
        _, square = np.unique(_squares(x, y), return_inverse=True)
        kept = np.flatnonzero(np.bincount(square, in_reach)[square])
        row, column, in_reach = row[kept], column[kept], in_reach[kept]
    ground = np.pad(raster.low, RETURN.patch_cells, constant_values=np.nan)
    parts = [_rises_at(raster, ground, slopes, row[a:a + RETURN.steps_per_batch], column[a:a + RETURN.steps_per_batch], min_height, max_height)
             for a in range(0, len(row), RETURN.steps_per_batch)]
    good, rises = (np.concatenate(column, axis=-1) for column in zip(*parts)) if parts else (np.empty(0, bool), np.empty((5, 0)))
    x, y, nx, ny, cost = rises
    # the cheapest place of every square, squares in order
    key = _squares(x, y)
    order = np.lexsort((cost, key))
    best = order[np.r_[True, np.diff(key[order]) > 0][:len(order)]]
    best = best[in_reach[good][best]]
    return x[best], y[best], nx[best], ny[best]


def _rises_at(raster, ground, slopes, row, column, min_height, max_height):
    """Which cells rise like a step, and of these x, y, unit vector uphill, and how far the middle of the step is off, (5, M).

    ground : of the raster, padded by RETURN.patch_cells empty cells
    """
    reach = np.arange(-RETURN.patch_cells, RETURN.patch_cells + 1)
    down, along = (v.ravel() for v in np.meshgrid(reach, reach, indexing="ij"))
    width = ground.shape[1]
    around = ground.ravel().take(((row + RETURN.patch_cells) * width + column + RETURN.patch_cells)[:, None] + (down * width + along))
    dx, dy = along * RETURN.plan_cell, down * RETURN.plan_cell
    sx, sy = (v[row, column] for v in slopes)
    around -= sx[:, None] * dx + sy[:, None] * dy
    # heights of the step at this cell, without the wall behind a curb and the ground below a bridge
    near = np.isfinite(around) & (np.abs(around - raster.low[row, column][:, None]) <= max_height + 0.05)
    gx, gy = _gradient(around, near, dx, dy)
    size = np.maximum(np.hypot(gx, gy), 1e-9)
    nx, ny = gx / size, gy / size
    u, v = nx[:, None] * dx + ny[:, None] * dy, ny[:, None] * dx - nx[:, None] * dy
    strip = near & (np.abs(v) <= RETURN.patch_half_length)
    before, after, middle = (_mean(around, strip & m) for m in ((u < -RETURN.step_half_width), (u > RETURN.step_half_width),
                                                                (np.abs(u) < RETURN.step_half_width)))
    rise = after - before
    rough = np.sqrt(_mean((around - before[:, None]) ** 2, strip & (u < -RETURN.step_half_width)))
    with np.errstate(invalid="ignore", divide="ignore"):
        part = (middle - before) / rise
        good = (part > 0.15) & (part < 0.85) & (rise >= RETURN.min_plan_rise_share * min_height) & (rise <= max_height + 0.05) \
            & (rough <= RETURN.max_plan_roughness_share * rise)
    # the middle of the step, not of the cell
    return good, np.array([*raster.middle(row[good], column[good]), nx[good], ny[good], np.abs(part - 0.5)[good]])


def _gradient(values, mask, dx, dy):
    """Slope of the plane through masked values of every row."""
    z = np.where(mask, values, 0.0)
    n = mask.sum(1)
    # two products in place of seven: each reads all patches, and OpenBLAS may start threads of its own for each
    sums = mask.astype(float) @ np.stack([dx, dy, dx * dx, dy * dy, dx * dy], axis=1)
    moments = z @ np.stack([dx, dy], axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        (mx, my, xx, yy, xy), (mxz, myz), mz = sums.T / n, moments.T / n, z.sum(1) / n
        xx, yy, xy = xx - mx * mx, yy - my * my, xy - mx * my
        xz, yz = mxz - mx * mz, myz - my * mz
        det = xx * yy - xy * xy + 1e-9
        return (yy * xz - xy * yz) / det, (xx * yz - xy * xz) / det


def _mean(values, mask):
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(mask, values, 0.0).sum(1) / mask.sum(1)


def _squares(x, y):
    """(N,) number of the square of two cells in which places lie."""
    return np.floor(y / (2 * RETURN.plan_cell)).astype(np.int64) * 10_000_000 + np.floor(x / (2 * RETURN.plan_cell)).astype(np.int64)
