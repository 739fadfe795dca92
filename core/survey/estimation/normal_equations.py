"""Normal equations of splines with a few common unknowns: a band along time with a border."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded


class BandedEquations:
    """Sums of the normal equations; control values of one drive only meet those up to three knots away.

    Parameters
    ----------
    knots, columns : control values are (knots, columns)
    common : number of common unknowns
    """

    def __init__(self, knots: int, columns: int, common: int):
        self.band = np.zeros((knots, 4, columns, columns))  # of knot k with knot k + j
        self.right = np.zeros((knots, columns))
        self.border = np.zeros((knots, columns, common))
        self.corner, self.common = np.zeros((common, common)), np.zeros(common)

    def add_rows(self, interval: int, weights: np.ndarray, pose: np.ndarray, common: np.ndarray, off: np.ndarray, weight: np.ndarray) -> None:
        """Observations of one interval.

        Parameters
        ----------
        interval : number
        weights : (N, 4) of the spline
        pose : (N, columns) change per change of the spline's values
        common : (N, common) change per change of the common unknowns
        off : (N,) misfit
        weight : (N,)
        """
        columns = pose.shape[1]
        rows = (weights[:, :, None] * pose[:, None, :]).reshape(len(off), 4 * columns)
        weighted = rows * weight[:, None]
        product = (rows.T @ weighted).reshape(4, columns, 4, columns)
        for i in range(4):
            for j in range(i, 4):
                self.band[interval + i, j - i] += product[i, :, j, :]
        self.right[interval:interval + 4] -= (weighted.T @ off).reshape(4, columns)
        self.border[interval:interval + 4] += (weighted.T @ common).reshape(4, columns, -1)
        self.corner += common.T @ (common * weight[:, None])
        self.common -= common.T @ (weight * off)

    def add_each(self, first: int, change: np.ndarray, off: np.ndarray, weight: np.ndarray) -> None:
        """One observation for each of M consecutive intervals.

        Parameters
        ----------
        first : number of the first interval
        change : (M, W, columns) change per change of its first W control values
        off, weight : (M,)
        """
        size, width = change.shape[:2]
        for i in range(width):
            for j in range(i, width):
                self.band[first + i:first + i + size, j - i] += weight[:, None, None] * change[:, i, :, None] * change[:, j, None, :]
            self.right[first + i:first + i + size] -= (weight * off)[:, None] * change[:, i]

    def solve(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Changes of the control values (knots, columns) and of the common unknowns (common,), the covariance of the latter, and
        (knots, columns, common) how control values follow from them."""
        knots, _, columns, _ = self.band.shape
        lower = np.zeros((4 * columns, knots * columns))
        for step in range(4):
            for a in range(columns):
                for b in range(columns):
                    below = step * columns + b - a
                    if below >= 0:
                        lower[below, a:(knots - step) * columns:columns] = self.band[:knots - step, step, a, b]
        lower[0] += TINY
        factor = (cholesky_banded(lower, lower=True, overwrite_ab=True, check_finite=False), True)
        border = self.border.reshape(knots * columns, -1)
        solved = cho_solve_banded(factor, np.concatenate([self.right.reshape(-1, 1), border], axis=1), check_finite=False)
        free, follow = solved[:, 0], solved[:, 1:]
        covariance = np.linalg.inv(self.corner - border.T @ follow)
        common = covariance @ (self.common - border.T @ free)
        return (free - follow @ common).reshape(knots, columns), common, covariance, -follow.reshape(knots, columns, -1)

    def variances(self) -> np.ndarray:
        """(knots, columns, columns) covariance of each knot's control values, common unknowns held.

        Blocks of three knots form a block-tridiagonal matrix, the diagonal blocks of whose inverse follow from one sweep
        from either end.
        """
        knots, _, columns, _ = self.band.shape
        blocks = -(-knots // 3)
        side = 3 * columns
        own, next_ = np.zeros((blocks, side, side)), np.zeros((blocks, side, side))
        for knot in range(3 * blocks):
            at = slice((knot % 3) * columns, (knot % 3 + 1) * columns)
            if knot >= knots:
                own[knot // 3, at, at] = np.eye(columns)
                continue
            for step in range(min(4, knots - knot)):
                other = knot + step
                to = slice((other % 3) * columns, (other % 3 + 1) * columns)
                part = self.band[knot, step] + (step == 0) * TINY * np.eye(columns)
                if other // 3 == knot // 3:
                    own[knot // 3, at, to] += part
                    if step:
                        own[knot // 3, to, at] += part.T
                else:
                    next_[knot // 3, at, to] += part
        ahead, behind = own.copy(), own.copy()
        for k in range(1, blocks):
            ahead[k] -= next_[k - 1].T @ np.linalg.solve(ahead[k - 1], next_[k - 1])
        for k in range(blocks - 2, -1, -1):
            behind[k] -= next_[k] @ np.linalg.solve(behind[k + 1], next_[k].T)
        inverse = np.linalg.inv(ahead + behind - own)
        return np.concatenate([inverse[:, i * columns:(i + 1) * columns, i * columns:(i + 1) * columns][:, None] for i in range(3)],
                              axis=1).reshape(3 * blocks, columns, columns)[:knots]


TINY = 1e-6  # added to the diagonal: keeps a control value that nothing determines where it is
