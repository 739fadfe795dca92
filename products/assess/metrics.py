"""Precision, recall, F1 and IoU from counts, and statistics of deviations.

The driving-line thesis prints tp / (tp + fn) for precision and 2 tp / (fp + fn) + 1 for F1; its tables
follow the usual formulas, which are used here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

NAN = float("nan")


def f1_of(precision: float, recall: float) -> float:
    """Harmonic mean of precision and recall (both shares or both per cent); 0 where both are 0, NaN where one is unknown."""
    total = precision + recall
    return 2.0 * precision * recall / total if total else 0.0 * total


@dataclass(frozen=True)
class Rates:
    """Counts (cells, intervals, objects or metres) and their shares, 0 to 1.

    found : part of the reference that is in the result; None: equal to `right`. It differs where a
        tolerance matches one point of the result with several of the reference

    A share of nothing is NaN; without any result recall and F1 are still 0.
    """

    right: float   # part of the result that agrees with the reference
    false: float   # part of the result that does not
    missed: float   # part of the reference that is not in the result
    found: float | None = None

    @property
    def _found(self) -> float:
        return self.right if self.found is None else self.found

    @property
    def precision(self) -> float:
        """right / (right + false)"""
        return _share(self.right, self.right + self.false)

    @property
    def recall(self) -> float:
        """found / (found + missed)"""
        return _share(self._found, self._found + self.missed)

    @property
    def f1(self) -> float:
        """2 tp / (2 tp + fp + fn) where right = found, else the harmonic mean of precision and recall."""
        if not self.right + self.false + self._found + self.missed:
            return NAN
        return f1_of(np.nan_to_num(self.precision), np.nan_to_num(self.recall))

    @property
    def iou(self) -> float:
        """Intersection over union: tp / (tp + fp + fn) = F1 / (2 - F1)."""
        return self.f1 / (2.0 - self.f1)

    def __add__(self, other: Rates) -> Rates:
        return Rates(self.right + other.right, self.false + other.false, self.missed + other.missed, self._found + other._found)


@dataclass(frozen=True)
class Errors:
    """Statistics of deviations, metres."""

    count: int   # number of points
    mean: float   # signed
    rmse: float   # root mean square
    p95: float   # p95, maximum: 95th percentile and maximum of the absolute deviations
    maximum: float

    @classmethod
    def of(cls, values: np.ndarray, weights: np.ndarray | None = None) -> Errors:
        """Errors of (N,) signed deviations with (N,) weights (lengths); non-finite deviations are ignored."""
        values = np.asarray(values, float)
        finite = np.isfinite(values)
        if not finite.any():
            return cls(0, NAN, NAN, NAN, NAN)
        values = values[finite]
        weights = np.ones(len(values)) if weights is None else np.asarray(weights, float)[finite]
        size = np.abs(values)
        order = np.argsort(size, kind="stable")
        reached = np.cumsum(weights[order]) / weights.sum()
        p95 = float(size[order][min(np.searchsorted(reached, 0.95), len(size) - 1)])
        mean = float(np.average(values, weights=weights))
        return cls(len(values), mean, float(np.sqrt(np.average(values**2, weights=weights))), p95, float(size.max()))


def _share(part, whole):
    return float(part / whole) if whole else NAN
