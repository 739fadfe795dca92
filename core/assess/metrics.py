"""Precision, recall and their kin from counts.

The thesis prints tp / (tp + fn) for precision and 2 tp / (fp + fn) + 1 for F1; its tables
obey the usual formulas, which are the ones here.
"""

from dataclasses import dataclass

import numpy as np

NAN = float("nan")


def f1_of(precision, recall):
    """Harmonic mean of precision and recall (both shares or both per cent); 0 where both are 0, NaN where one is unknown."""
    together = precision + recall
    return 2.0 * precision * recall / together if together else 0.0 * together


@dataclass(frozen=True)
class Rates:
    """Counts (cells, intervals, objects or metres) and the shares they make, 0 to 1.

    right : of the result, what agrees with the reference
    false : of the result, what does not
    missed : of the reference, what the result does not have
    found : of the reference, what the result has; equals `right` unless a tolerance
        lets one place of the one answer for several of the other

    A share of nothing is NaN; without any result recall and F1 are still 0.
    """

    right: float
    false: float
    missed: float
    found: float = None

    @property
    def _found(self):
        return self.right if self.found is None else self.found

    @property
    def precision(self):
        """right / (right + false)"""
        return _share(self.right, self.right + self.false)

    @property
    def recall(self):
        """found / (found + missed)"""
        return _share(self._found, self._found + self.missed)

    @property
    def f1(self):
        """2 tp / (2 tp + fp + fn) where right = found, else the harmonic mean of precision and recall."""
        if not self.right + self.false + self._found + self.missed:
            return NAN
        return f1_of(np.nan_to_num(self.precision), np.nan_to_num(self.recall))

    @property
    def iou(self):
        """Intersection over union: tp / (tp + fp + fn) = F1 / (2 - F1)."""
        return self.f1 / (2.0 - self.f1)

    def __add__(self, other):
        return Rates(self.right + other.right, self.false + other.false, self.missed + other.missed, self._found + other._found)


@dataclass(frozen=True)
class Errors:
    """Deviations in metres over `count` places: signed mean, root mean square, 95th percentile and maximum of the size."""

    count: int
    mean: float
    rmse: float
    p95: float
    maximum: float

    @classmethod
    def of(cls, values, weights=None):
        """Of (N,) signed deviations, non-finite ones left out, each counting with its weight (length)."""
        values = np.asarray(values, float)
        known = np.isfinite(values)
        if not known.any():
            return cls(0, NAN, NAN, NAN, NAN)
        values = values[known]
        weights = np.ones(len(values)) if weights is None else np.asarray(weights, float)[known]
        size = np.abs(values)
        order = np.argsort(size, kind="stable")
        reached = np.cumsum(weights[order]) / weights.sum()
        p95 = float(size[order][min(np.searchsorted(reached, 0.95), len(size) - 1)])
        mean = float(np.average(values, weights=weights))
        return cls(len(values), mean, float(np.sqrt(np.average(values**2, weights=weights))), p95, float(size.max()))


def _share(part, whole):
    return float(part / whole) if whole else NAN
