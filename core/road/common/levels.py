"""Levels of the ground on either side of every place of averaged profiles."""

from __future__ import annotations

from functools import partial

import numpy as np

ROAD_FIT_LENGTH = 0.35        # m of road to which a level is fitted
BEHIND_FIT_LENGTH = 0.25      # m of ground behind: a hedge may stand close
BLURRED_FACE_HALF_WIDTH = 0.09    # m on either side of a step left out of both levels: the blurred face
STEEP_HALF_WIDTH = 0.07       # m on either side of a step within which most of the rise must lie
MIN_STEEP_SHARE = 0.65        # share of the height; an even rise from level to level has less
MIN_FILLED_SHARE = 0.6        # share of the cells of a level that must hold ground
MAX_AVERAGED_SCATTER = 0.008  # m, scatter of averaged heights about their level: verges and banks have more


class RunningSums:
    """Running sums over the cells of every profile; differences of them give the line through any range of cells.

    Parameters
    ----------
    shape : (P, C), profiles and cells
    spacing : m, width of a cell
    """

    def __init__(self, shape: tuple[int, int], spacing: float):
        self.cells, self.spacing, self.u = shape[1], spacing, np.arange(shape[1]) * spacing
        # a window may reach beyond the first and the last cell
        self.pad = int(round((BLURRED_FACE_HALF_WIDTH + ROAD_FIT_LENGTH) / spacing)) + 2
        self.totals = np.zeros((6, shape[0], self.cells + 2 * self.pad))

    def add(self, value: np.ndarray) -> None:
        """Sum the heights of cells, (P, C), NaN where there is none."""
        there = np.isfinite(value)
        h, u = np.where(there, value, 0.0), there * self.u
        own = slice(self.pad, self.pad + self.cells)
        for total, v in zip(self.totals, (there * 1.0, h, h * h, u, u * u, u * h)):
            np.cumsum(v, axis=1, out=total[:, own])
            total[:, own.stop:] = total[:, own.stop - 1:own.stop]

    def window(self, which: int, first: int, last: int) -> np.ndarray:
        """Sum of the cells from `first` to `last` beside every cell."""
        total, start, end = self.totals[which], self.pad - 1 + first, self.pad + last
        return total[:, end:end + self.cells] - total[:, start:start + self.cells]

    def window_at(self, which: int, first: int, last: int, cells: np.ndarray) -> np.ndarray:
        """The same at some cells."""
        row, cell = np.divmod(cells, self.cells)
        total = self.totals[which]
        return total[row, cell + self.pad + last] - total[row, cell + self.pad - 1 + first]

    def mean(self, first: int, last: int) -> np.ndarray:
        """Mean of the occupied cells from `first` to `last` beside every cell."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.window(1, first, last) / self.window(0, first, last)

    def line(self, first: int, last: int) -> SideLines:
        """Line through the cells from `first` to `last` beside every cell."""
        return SideLines(self, first, last)


class SideLines:
    """Lines through the cells beside every cell: height at the cell (`level`), slope, number of cells (`n`), each (P, C)."""

    def __init__(self, sums: RunningSums, first: int, last: int):
        self.n, sz, su, suu, suz = (sums.window(k, first, last) for k in (0, 1, 3, 4, 5))
        with np.errstate(invalid="ignore", divide="ignore"):
            mu, self.mz = su / self.n, sz / self.n
            vuu, self.vuz = suu / self.n - mu * mu, suz / self.n - mu * self.mz
            self.slope = np.where(vuu > 1e-4, self.vuz / vuu, 0.0)
            self.level = self.mz + self.slope * (sums.u - mu)
        self._squares = partial(sums.window_at, 2, first, last)

    def deviation(self, cells: np.ndarray) -> np.ndarray:
        """(M,) standard deviation of heights at some cells."""
        return np.sqrt(np.maximum(self._squares(cells) / self.n.take(cells) - self.mz.take(cells)**2, 0.0))

    def scatter(self, cells: np.ndarray) -> np.ndarray:
        """(M,) scatter of heights about the line at some cells."""
        n, mz = self.n.take(cells), self.mz.take(cells)
        with np.errstate(invalid="ignore", divide="ignore"):
            vzz = self._squares(cells) / n - mz * mz
        return np.sqrt(np.maximum(vzz - self.slope.take(cells) * self.vuz.take(cells), 0.0) * n / np.maximum(n - 2, 1))
