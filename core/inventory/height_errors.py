"""Errors in height that passes and scanners show against each other, estimated where they overlap.

A scanner that is mounted, or a vehicle that is levelled, a little wrong measures the road too high by a constant and tilted across:
``e = a + b (d - t)``, with d the offset of a point and t that of the vehicle. Steps and differences in tilt between two groups (pass and
scanner) are measured where both saw the road. The tilt has a part that stays with the scanner on its vehicle (boresight): it changes sides
with the direction of driving, so passes in opposite directions reveal it, and no others do.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

from ..survey.frame.passes import Pass
from .surface_grid import CROSS_CELL, SurfaceGrid

MIN_OVERLAP_CELLS = 40         # cells of a window that two groups share, for a step between them
MIN_OVERLAP_POINTS = 3         # of either group in such a cell
MIN_OVERLAP_WIDTH = 1.0        # m across over which they are shared, for a difference in tilt
MAX_STEP = 0.05                # m: what lies farther apart is not the same surface
STEP_SIGMA = 0.0005            # m, of a measured step: texture that the two beams see differently
TILT_SIGMA = 0.0003            # m/m, of a measured difference in tilt over MIN_OVERLAP_WIDTH
STEP_PRIOR, STEP_CHANGE = 0.05, 0.001      # m, the error of a group, and its change from window to window (navigation)
TILT_PRIOR, TILT_CHANGE = 0.0005, 0.0001   # m/m, the same of the tilt: 0.03 degrees of roll, slowly drifting
BORESIGHT_PRIOR = 0.01         # m/m, of a scanner's tilt on its vehicle
STEP_OUTLIER = 0.002           # m of residual at which a step has half its weight (Cauchy)
REWEIGHTINGS = 4
OPPOSITE_WINDOWS = 3           # windows in which opposite passes overlap, before their common tilt counts as known


@dataclass(frozen=True)
class Overlap:
    """What two groups differ by in one window: one less the other.

    window : number
    one, other : groups (pass number, scanner)
    at : m, offset at which the step counts
    step : m
    tilt : m/m across, NaN where the overlap is too narrow
    width : m across that both saw
    station : m, the middle of the window
    """

    window: int
    one: tuple[int, int]
    other: tuple[int, int]
    at: float
    step: float
    tilt: float
    width: float
    station: float


@dataclass
class HeightErrors:
    """Errors of every group in every window.

    windows : (W,) m, ascending, middles of the windows
    groups : {(pass number, scanner): row}
    step, tilt : (G, W) m and m/m: error = step + tilt * (d - offset of the vehicle)
    opposite : whether passes in opposite directions revealed the common tilt
    largest_step : m, the median over the windows of the largest step between two groups
    """

    windows: np.ndarray = field(default_factory=lambda: np.empty(0))
    groups: dict[tuple[int, int], int] = field(default_factory=dict)
    step: np.ndarray = field(default_factory=lambda: np.empty((0, 0)))
    tilt: np.ndarray = field(default_factory=lambda: np.empty((0, 0)))
    opposite: bool = False
    largest_step: float = 0.0

    def of(self, group: tuple[int, int], s: np.ndarray, across: np.ndarray) -> np.ndarray:
        """Error of a group, (N,) m, at (N,) stations and `across` m left of its vehicle; 0 where nothing is known of it."""
        row = self.groups.get(group)
        if row is None or not len(self.windows):
            return np.zeros(np.shape(across))
        return np.interp(s, self.windows, self.step[row]) + np.interp(s, self.windows, self.tilt[row]) * across


def overlaps_of(grid: SurfaceGrid, window: int) -> list[Overlap]:
    """Steps and differences in tilt between the groups of a grid."""
    found = []
    station = float(grid.s.mean())
    for a in range(len(grid.groups)):
        for b in range(a + 1, len(grid.groups)):
            apart = grid.height[a] - grid.height[b]
            _, j = shared = np.nonzero((np.abs(apart) < MAX_STEP) & (np.minimum(grid.count[a], grid.count[b]) >= MIN_OVERLAP_POINTS))
            if len(j) < MIN_OVERLAP_CELLS:
                continue
            values, d = apart[shared], grid.d[j]
            at, width = float(d.mean()), float(np.ptp(d)) + CROSS_CELL
            step, tilt = _line(d - at, values)
            found.append(Overlap(window, grid.groups[a], grid.groups[b], at, step, tilt if width >= MIN_OVERLAP_WIDTH else np.nan, width, station))
    return found


def _line(x, y):
    """Height at 0 and slope of the line through (N,) values, robust against what only one group saw."""
    weight = np.ones(len(x))
    for _ in range(REWEIGHTINGS):
        mean = np.average(x, weights=weight), np.average(y, weights=weight)
        slope = (weight * (x - mean[0]) * (y - mean[1])).sum() / max((weight * (x - mean[0]) ** 2).sum(), 1e-9)
        level = mean[1] - slope * mean[0]
        off = y - level - slope * x
        weight = 1.0 / (1.0 + (off / max(2.0 * float(np.median(np.abs(off))), STEP_SIGMA)) ** 2)
    return float(level), float(slope)


def solve_height_errors(overlaps: Iterable[Overlap], passes: list[Pass]) -> HeightErrors:
    """The errors that explain the overlaps best: least squares with the priors above, robust against single windows.

    Parameters
    ----------
    overlaps : of one road
    passes : all passes of the survey, by number

    Returns
    -------
    HeightErrors; without overlaps, an empty one
    """
    overlaps = list(overlaps)
    if not overlaps:
        return HeightErrors()
    groups = sorted({group for one in overlaps for group in (one.one, one.other)})
    scanners = sorted({scanner for _, scanner in groups})
    numbers, place = np.unique([one.window for one in overlaps], return_inverse=True)
    stations = np.zeros(len(numbers))
    stations[place.ravel()] = [one.station for one in overlaps]
    G, W = len(groups), len(numbers)
    direction = np.array([passes[number].direction for number, _ in groups])
    track = np.array([passes[number].at_station(stations)[0] for number, _ in groups])
    steps, tilts, boresight = 0, G * W, 2 * G * W   # where the unknowns of each kind begin
    rows: list[tuple[list[int], list[float], float, float]] = []  # columns, factors, value, sigma
    for one, w in zip(overlaps, place.ravel().tolist()):
        a, b = groups.index(one.one), groups.index(one.other)
        level: tuple[list[int], list[float]] = ([], [])
        tilt: tuple[list[int], list[float]] = ([], [])
        for g, sign in ((a, 1.0), (b, -1.0)):
            arm = one.at - track[g, w]
            columns = [steps + g * W + w, tilts + g * W + w, boresight + scanners.index(groups[g][1])]
            level[0].extend(columns)
            level[1].extend([sign, sign * arm, sign * arm * direction[g]])
            tilt[0].extend(columns[1:])
            tilt[1].extend([sign, sign * direction[g]])
        rows.append((*level, one.step, STEP_SIGMA))
        if np.isfinite(one.tilt):
            rows.append((*tilt, one.tilt, TILT_SIGMA * max(MIN_OVERLAP_WIDTH / one.width, 0.2)))
    size = 2 * G * W + len(scanners)
    of = np.repeat(np.arange(len(rows)), [len(row[0]) for row in rows])
    design = sparse.csr_matrix((np.concatenate([row[1] for row in rows]), (of, np.concatenate([row[0] for row in rows]))), (len(rows), size))
    value, sigma = (np.array([row[k] for row in rows]) for k in (2, 3))
    prior = _prior(G, W, len(scanners))
    weight, x = np.ones(len(rows)), np.zeros(size)
    for _ in range(REWEIGHTINGS):
        precision = sparse.diags(weight / sigma**2)
        x = spsolve((design.T @ precision @ design + prior).tocsc(), design.T @ (precision @ value))
        weight = 1.0 / (1.0 + ((design @ x - value) / (STEP_OUTLIER / STEP_SIGMA * sigma)) ** 2)
    own = x[boresight + np.searchsorted(scanners, [scanner for _, scanner in groups])]
    tilt_of = x[tilts:boresight].reshape(G, W) + (direction * own)[:, None]
    opposite = {one.window for one in overlaps if passes[one.one[0]].direction != passes[one.other[0]].direction and np.isfinite(one.tilt)}
    largest = np.zeros(W)
    np.maximum.at(largest, place.ravel(), np.abs([one.step for one in overlaps]))
    return HeightErrors(stations, {group: g for g, group in enumerate(groups)}, x[:tilts].reshape(G, W), tilt_of,
                        len(opposite) >= OPPOSITE_WINDOWS, float(np.median(largest)))


def _prior(G, W, S):
    """The normal matrix of what is known beforehand."""
    change = sparse.diags([-np.ones(W), np.ones(W)], [0, 1], shape=(max(W - 1, 0), W))
    parts = [sparse.kron(sparse.identity(G), sparse.identity(W) / prior**2 + change.T @ change / drift**2)
             for prior, drift in ((STEP_PRIOR, STEP_CHANGE), (TILT_PRIOR, TILT_CHANGE))]
    return sparse.block_diag([*parts, sparse.identity(S) / BORESIGHT_PRIOR**2])
