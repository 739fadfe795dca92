"""The track of a cloud without times: the ridge of its density on the ground."""

from __future__ import annotations

import numpy as np
from scipy import ndimage, sparse

from ....common.errors import RoadExtractionError
from ....curves.robust import robustly_smoothed

CELL = 0.5               # m
LOW_CELL = 2.0           # m in which the low points are ground
LOW_SHARE = 0.2          # of a cell's points lie lower than its ground: also those that wet roads mirror below themselves
GROUND_LAYER = 0.3       # m either side of it
BLUR = 1.0               # m of the density
CREST_WINDOW = 12.0      # m in which the densest cell stands for the crest
MIN_CREST_SHARE = 0.05   # of the crest's density: cells over which a way may lead
MIN_DENSITY_SHARE, DENSE_SHARE = 0.15, 0.9   # of the density that nine cells in ten do not reach: beyond the road there is no crest
END_CREST_SHARE = 0.7    # of the crest's density, where a way may begin and end
CREST_COST = 3           # power by which leaving the crest costs
MIN_RIDGE = 20.0         # m
FIRST_HEIGHT = 2.3       # m of scanners above the road, which the density does not tell
RIDGE_SPACING = 0.5      # m between the places given
RIDGE_STIFFNESS = 200.0
MAX_CELLS = 4_000_000    # of the density: 1 km^2


def ridge_of(place: np.ndarray) -> np.ndarray:
    """The longest way along the ridge of density.

    Parameters
    ----------
    place : (N, 3) m

    Returns
    -------
    (M, 3) m, places of the scanner at a usual height, RIDGE_SPACING apart

    Raises
    ------
    RoadExtractionError
        If there is none.
    """
    ground = place[_on_ground(place)]
    corner = ground[:, :2].min(axis=0)
    column, row = ((ground[:, :2] - corner) / CELL).astype(np.int64).T
    shape = int(row.max()) + 1, int(column.max()) + 1
    if shape[0] * shape[1] > MAX_CELLS:
        raise RoadExtractionError(
            f"The point clouds have no times and cover {shape[1] * CELL / 1000:.1f} by {shape[0] * CELL / 1000:.1f} km; without times a track is "
            f"sought in up to {MAX_CELLS * CELL**2 / 1e6:.0f} km². Give fewer files, or clouds with gps_time.")
    cell = row * shape[1] + column
    count = np.bincount(cell, minlength=shape[0] * shape[1]).reshape(shape).astype(float)
    density = ndimage.gaussian_filter(count, BLUR / CELL)
    crest = density / np.maximum(ndimage.maximum_filter(density, int(CREST_WINDOW / CELL) | 1), 1e-9)
    crest[density < MIN_DENSITY_SHARE * np.quantile(density[count > 0], DENSE_SHARE)] = 0.0
    number = np.full(shape, -1)
    used = crest >= MIN_CREST_SHARE
    number[used] = np.arange(used.sum())
    graph = _graph(number, crest)
    path = _longest_path(graph, crest[used] >= END_CREST_SHARE)
    cells = np.stack(np.nonzero(used), axis=1)[path]
    track = (cells[:, ::-1] + 0.5) * CELL + corner
    driven = np.r_[0.0, np.cumsum(np.hypot(*np.diff(track, axis=0).T))]
    if driven[-1] < MIN_RIDGE:
        raise RoadExtractionError(
            f"No track shows in the density of the points: the longest ridge is {driven[-1]:.0f} m long, and {MIN_RIDGE:.0f} m are needed. "
            "A terrestrial scan and an evenly thinned cloud have none, and these points have no times that would tell more.")
    even = np.arange(0.0, driven[-1], RIDGE_SPACING)
    flat = np.stack([np.interp(even, driven, axis) for axis in track.T], axis=1)
    flat = robustly_smoothed(flat, np.ones(len(flat)), RIDGE_STIFFNESS)
    total = np.maximum(np.bincount(cell, minlength=count.size), 1e-9)
    height = (np.bincount(cell, ground[:, 2], minlength=count.size) / total).reshape(shape)
    c, r = np.clip(((flat - corner) / CELL).astype(np.int64), 0, [shape[1] - 1, shape[0] - 1]).T
    z = robustly_smoothed(height[r, c][:, None], (count[r, c] > 0).astype(float), RIDGE_STIFFNESS)[:, 0]
    return np.column_stack([flat, z + FIRST_HEIGHT])


def _on_ground(place):
    """(N,) bool of the points on the ground of their cell."""
    column, row = ((place[:, :2] - place[:, :2].min(axis=0)) / LOW_CELL).astype(np.int64).T
    cell = row * (int(column.max()) + 1) + column
    order = np.lexsort((place[:, 2], cell))
    first = np.flatnonzero(np.r_[True, np.diff(cell[order]) > 0])
    held = np.diff(np.r_[first, len(cell)])
    ground = np.repeat(place[order[first + (held * LOW_SHARE).astype(np.int64)], 2], held)
    found = np.empty(len(cell), bool)
    found[order] = np.abs(place[order, 2] - ground) <= GROUND_LAYER
    return found


def _graph(number, crest):
    """Sparse costs between neighbouring cells: metres, dearer off the crest."""
    rows, columns, costs = [], [], []
    for dr, dc in ((0, 1), (1, 0), (1, 1), (1, -1)):
        height, width = number.shape
        a = (slice(0, height - dr), slice(max(-dc, 0), width - max(dc, 0)))
        b = (slice(dr, height), slice(max(dc, 0), width + min(dc, 0)))
        both = (number[a] >= 0) & (number[b] >= 0)
        rows.append(number[a][both])
        columns.append(number[b][both])
        costs.append(np.hypot(dr, dc) * CELL * 2.0 / (crest[a][both] ** CREST_COST + crest[b][both] ** CREST_COST))
    size = int(number.max()) + 1
    return sparse.csr_matrix((np.concatenate(costs), (np.concatenate(rows), np.concatenate(columns))), shape=(size, size))


def _longest_path(graph, ends):
    """Cells along the longest of the cheapest ways between cells of which `ends`, (N,) bool, says that a way may end there."""
    _, part = sparse.csgraph.connected_components(graph, directed=False)
    size = np.bincount(part[ends])
    allowed = ends & (part == size.argmax())
    # the farthest from anywhere is an end; the farthest from that is the other
    start = int(np.argmax(allowed))
    for _ in range(2):
        cost, before = sparse.csgraph.dijkstra(graph, directed=False, indices=start, return_predecessors=True)
        other, start = start, int(np.argmax(np.where(allowed, cost, -1.0)))
    path = [start]
    while path[-1] != other and before[path[-1]] >= 0:
        path.append(int(before[path[-1]]))
    return np.array(path)
