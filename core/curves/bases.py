"""Cubic B-splines through places of many lines at once: the equations of their control points."""

from functools import lru_cache

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dpbsv
from scipy.sparse import csc_matrix, csr_matrix

from .fit import F_SCALE, medians

DEGREE = 3


def pieces_of(length, bandwidth):
    return max(1, int(np.ceil(length / max(bandwidth, 1.0))))


class Bases:
    """The cubic B-splines on even knots that places lie in, four a place, with their penalty, of several lines and bandwidths.

    The equations of all of them are solved as one system in which they do not touch: most
    lines have a few hundred places, and numpy takes longer to be called than to compute.

    lines : list of (t, bandwidths): (N,) rising from 0, and (B,). There is a block of N places for every bandwidth,
        one after the other.
    """

    def __init__(self, lines):
        each = [(t, b) for t, bandwidths in lines for b in bandwidths]
        lengths = np.array([float(t[-1]) for t, _ in each])
        pieces = np.array([pieces_of(length, b) for length, (_, b) in zip(lengths.tolist(), each)])
        steps = lengths / pieces
        self.knots = [step * np.arange(-DEGREE, count + DEGREE + 1) for step, count in zip(steps, pieces.tolist())]
        self.counts, self.sizes = pieces + DEGREE, np.array([len(t) for t, _ in each])
        self.starts, self.rows = np.cumsum(self.counts) - self.counts, np.cumsum(self.sizes) - self.sizes
        whole, size = int(self.counts.sum()), int(self.sizes.sum())
        step, most = np.repeat(steps, self.sizes), np.repeat(pieces, self.sizes)
        inside = np.clip(np.concatenate([t for t, _ in each]) / step, 0.0, most)
        piece = np.minimum(inside.astype(np.int32), most - 1)
        f = inside - piece
        g = 1 - f
        values = np.stack([g**3, (3 * f - 6) * f * f + 4, ((3 - 3 * f) * f + 3) * f + 1, f**3], axis=1) / 6
        slopes = np.stack([-g * g, (3 * f - 4) * f, (2 - 3 * f) * f + 1, f * f], axis=1) / (2 * step[:, None])
        at = (piece + np.repeat(self.starts, self.sizes)).astype(np.int32)[:, None] + np.arange(4, dtype=np.int32)
        four = np.arange(0, 4 * size + 1, 4, dtype=np.int32)
        self._values = csr_matrix((values.ravel(), at.ravel(), four), (size, whole))
        self._slopes = csr_matrix((slopes.ravel(), at.ravel(), four), (size, whole))
        self._turned = self._values.T
        # what each place adds to the upper banded form of the normal matrix, wherever two of its four meet
        first, second = np.triu_indices(4)
        ten = np.arange(0, 10 * size + 1, 10, dtype=np.int32)
        band = 4 * at[:, second] + (DEGREE - (second - first)).astype(np.int32)
        self._products = csc_matrix(((values[:, first] * values[:, second]).ravel(), band.ravel(), ten), (4 * whole, size))
        scale = self.sizes / np.maximum(lengths, 1e-6) * np.array([b for _, b in each]) ** 6 / steps**5
        self._penalty = np.concatenate([_roughness(count) * by for count, by in zip(self.counts.tolist(), scale.tolist())])

    def solve(self, weight, values):
        """(K, C) control points of all blocks, one after the other, that follow (N, C) values with (N,) weights, smoothly."""
        bands = (self._products @ weight).reshape(-1, 4)
        bands += self._penalty
        # a breath of ridge keeps control points in a gap from being undetermined
        bands[:, DEGREE] += np.repeat(1e-9 * np.maximum.reduceat(bands[:, DEGREE], self.starts), self.counts)
        right = self._turned @ (values * weight[:, None])
        # solveh_banded checks more than it computes
        _, control, trouble = dpbsv(bands.T, right, overwrite_ab=1)
        if trouble:
            raise LinAlgError(f"The spline's equations cannot be solved ({trouble}).")
        return control

    def of(self, control):
        """(N, C) what control points (K, C) give at the places, and the slopes there."""
        return self._values @ control, self._slopes @ control

    def part(self, control, k):
        """The control points of one block."""
        return control[self.starts[k]:self.starts[k] + self.counts[k]]

    def weights(self, residuals):
        """`robust_weights` of (N,) residuals, of every block by its own scale."""
        found, size = np.empty(len(residuals)), np.abs(residuals)
        k = 0
        while k < len(self.sizes):
            # blocks of one length stand as rows of a table
            count, alike = self.sizes[k], k + 1
            while alike < len(self.sizes) and self.sizes[alike] == count:
                alike += 1
            rows = slice(self.rows[k], self.rows[k] + count * (alike - k))
            scale = np.maximum(F_SCALE, 1.4826 * medians(size[rows].reshape(-1, count)))
            found[rows] = (size[rows].reshape(-1, count) / scale).ravel()
            k = alike
        found *= found
        found += 1.0
        return 1.0 / np.sqrt(found, out=found)


@lru_cache(maxsize=64)
def _roughness(count):
    """(K, 4), the upper banded form, turned, of D'D with D the third differences of K control points."""
    inner = max(count - 8, 0)
    small = np.zeros((DEGREE + 1, count - inner))
    difference = np.array([-1.0, 3.0, -3.0, 1.0])
    for row in range(4):
        for column in range(row, 4):
            small[DEGREE - (column - row), column:column + count - inner - 3] += difference[row] * difference[column]
    bands = np.repeat(small.T, np.r_[1, 1, 1, 1 + inner, np.ones(max(len(small.T) - 4, 0), int)][:len(small.T)], axis=0)
    bands.flags.writeable = False
    return bands
