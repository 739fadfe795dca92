"""Which lines, strands or crossings are at a place along a road: things are compared with those beside them, not with all of the road."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...survey.frame.row_table import RowSpans

if TYPE_CHECKING:
    from .strands import LinkedLine

LOOKUP_CELL = 1.0   # m of station by which they are looked up


class StretchLookup:
    """Stretches of road looked up by station.

    Parameters
    ----------
    first, last : (N,) metres, stations
    """

    def __init__(self, first: np.ndarray, last: np.ndarray) -> None:
        self.first, self.last = np.asarray(first, float), np.asarray(last, float)
        self._origin = int(np.floor(self.first.min(initial=np.inf) / LOOKUP_CELL)) if len(self.first) else 0
        low, high = self._cell(self.first), self._cell(self.last)
        self._spans = RowSpans(low, high - low + 1, int(high.max(initial=0)) + 1)

    def _cell(self, station):
        return np.floor(station / LOOKUP_CELL).astype(int) - self._origin

    def between(self, first: float, last: float) -> np.ndarray:
        """Numbers of those that reach into the road between two stations, ascending."""
        near = self._spans.near(int(self._cell(np.float64(first))), int(self._cell(np.float64(last))))
        return near[(self.first[near] <= last) & (self.last[near] >= first)]


def lines_beside(lines: Sequence[LinkedLine]) -> StretchLookup:
    """StretchLookup of lines."""
    return StretchLookup(np.array([line.first for line in lines]), np.array([line.last for line in lines]))
