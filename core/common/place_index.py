"""Places by squares of the ground: those about a place are looked up there, not among all places of a whole road."""

from __future__ import annotations

import numpy as np


class PlaceIndex:
    """Places by squares.

    Parameters
    ----------
    places : (N, 2) m
    side : m, of the squares

    Attributes
    ----------
    places, side : as given
    """

    def __init__(self, places: np.ndarray, side: float):
        self.places, self.side = places, side
        row, column = (np.floor(values / side).astype(np.int32) for values in places.T)
        # a column more on either side: the neighbours of a square in the last column are none of the next row
        self._first = np.array([values.min() if len(values) else 0 for values in (row, column)], np.int64) - 1
        self._columns = int(column.max(initial=self._first[1]) - self._first[1]) + 2
        key = row - self._first[0]
        key *= self._columns
        key += column - self._first[1]
        order = np.argsort(key, kind="stable")
        key = key[order]
        self._order = order.astype(np.int32)
        self._starts = np.flatnonzero(np.diff(key, prepend=-1))
        self._keys, self._ends = key[self._starts], np.r_[self._starts, len(key)]

    def __getstate__(self) -> dict:
        """The places; the rest follows from them."""
        return dict(places=self.places, side=self.side)

    def __setstate__(self, state: dict) -> None:
        PlaceIndex.__init__(self, **state)

    def _rows(self, first, last):
        """Where the places in the squares from key `first` to `last`, (K,) each, begin and end in the order."""
        begin, end = np.searchsorted(self._keys, first), np.searchsorted(self._keys, last, side="right")
        return self._ends[begin], self._ends[end]

    def windows(self, fewest: int) -> list[np.ndarray]:
        """Rows of the places of every window of 2 by 2 squares, which overlap by half, that has so many places at least."""
        columns = self._columns
        corner = np.unique(np.concatenate([self._keys + step for step in (0, 1, columns, columns + 1)]))   # the last square of each window
        (a, b), (c, d) = (self._rows(corner - step - 1, corner - step) for step in (columns, 0))
        enough = b - a + d - c >= fewest
        return [np.concatenate([self._order[one:two], self._order[three:four]])
                for one, two, three, four in zip(*(ends[enough].tolist() for ends in (a, b, c, d)))]

    def within(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Ascending rows of the places in a box with the corners `low` and `high`, (2,) m each."""
        first, last = (np.floor(np.asarray(corner) / self.side).astype(np.int64) - self._first for corner in (low, high))
        first[1], last[1] = max(first[1], 0), min(last[1], self._columns - 1)
        row = np.arange(max(first[0], 0), last[0] + 1) * self._columns
        rows = np.concatenate([np.empty(0, np.int32), *(self._order[a:b] for a, b in zip(*self._rows(row + first[1], row + last[1])))])
        own = self.places[rows]
        return np.sort(rows[((own >= low) & (own <= high)).all(axis=1)])
