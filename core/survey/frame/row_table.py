"""Rows of values along a road, of which each is kept from where it begins to where it ends.

A road of tens of kilometres has thousands of lines, each of which is on a small part of it: a full table of lines by stations would grow with the
square of the road's length.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..weights import FRAME


class RowSpans:
    """Which stations each row of tables is kept for.

    first, count : (R,) int, the first station of each row and how many follow each other; those before station 0 or behind the last are left out
    stations : number of stations of the grid
    """

    def __init__(self, first: np.ndarray, count: np.ndarray, stations: int) -> None:
        first, count = np.asarray(first, int), np.asarray(count, int)
        end = np.minimum(first + count, stations)
        self.first = np.maximum(first, 0)
        self.end = np.maximum(end, self.first)
        self.start = np.append(0, np.cumsum(self.end - self.first))
        self.stations = stations

    def __len__(self) -> int:
        return len(self.first)

    @property
    def size(self) -> int:
        return int(self.start[-1])

    @cached_property
    def owner(self) -> np.ndarray:
        """(V,) int, the row of each value."""
        return np.repeat(np.arange(len(self)), self.end - self.first)

    @cached_property
    def station(self) -> np.ndarray:
        """(V,) int, the station of each value."""
        return np.arange(self.size) - np.repeat(self.start[:-1] - self.first, self.end - self.first)

    def values_of(self, row: int, first: int = 0, end: int | None = None) -> slice:
        """The values of a row at the stations from `first` to `end` (exclusive), as far as it is kept there."""
        begin, stop = self.first.item(row), self.end.item(row)
        low = min(max(first, begin), stop)
        shift = self.start.item(row) - begin
        return slice(low + shift, (stop if end is None else max(min(end, stop), low)) + shift)

    def places(self, rows: Any, stations: Any) -> tuple[np.ndarray, np.ndarray]:
        """Which value belongs to rows and stations, which broadcast together, and whether they are kept; 0 where not."""
        rows, stations = np.asarray(rows), np.asarray(stations)
        first = self.first[rows]
        kept = (stations >= first) & (stations < self.end[rows])
        return np.where(kept, self.start[:-1][rows] + stations - first, 0), kept

    def near(self, first: int, last: int) -> np.ndarray:
        """(N,) int, ascending, the rows that are kept at any of the stations from `first` to `last` (inclusive)."""
        return np.flatnonzero((self.first <= last) & (self.end > first) & (self.end > self.first))


class RowTable:
    """A table of R rows by K stations, indexed as an array of that shape: `table[rows, stations]`.

    values : (V,) of the stations that the rows are kept for, row after row
    missing : what stands elsewhere, one value or (R,) of them
    """

    def __init__(self, spans: RowSpans, values: np.ndarray, missing: Any) -> None:
        self.spans, self.values, self.missing = spans, values, missing

    @classmethod
    def of_rows(cls, rows: Sequence[tuple[int, np.ndarray]], stations: int, missing: Any = np.nan) -> RowTable:
        """A table of rows (first station, values)."""
        spans = RowSpans(np.array([first for first, _ in rows], int), np.array([len(values) for _, values in rows], int), stations)
        kept = [values[max(-first, 0):max(-first, 0) + end - begin] for (first, values), begin, end in zip(rows, spans.first, spans.end)]
        return cls(spans, np.concatenate([np.empty(0), *kept]), missing)

    def __len__(self) -> int:
        return len(self.spans)

    def like(self, values: np.ndarray, missing: Any) -> RowTable:
        """Other values of the same rows and stations."""
        return RowTable(self.spans, values, missing)

    def row(self, row: int) -> np.ndarray:
        """The values that are kept of a row, from station `spans.first[row]` on: a view."""
        return self.values[self.spans.values_of(row)]

    def __getitem__(self, key: tuple[Any, Any]) -> np.ndarray:
        rows, stations = key
        if isinstance(stations, slice):
            if isinstance(rows, (int, np.integer)):
                return self._stretch(int(rows), *stations.indices(self.spans.stations)[:2])
            stations = np.arange(*stations.indices(self.spans.stations))
            rows = np.asarray(rows)[:, None]
        places, kept = self.spans.places(rows, stations)
        missing = self.missing if np.ndim(self.missing) == 0 else self.missing[np.asarray(rows)]
        return np.where(kept, self.values[places], missing).astype(self.values.dtype, copy=False) if self.spans.size \
            else np.broadcast_to(np.asarray(missing, self.values.dtype), kept.shape).copy()

    def _stretch(self, row, first, end):
        """The row at the stations from `first` to `end` (exclusive)."""
        kept = self.spans.values_of(row, first, end)
        if kept.stop - kept.start == end - first:
            return self.values[kept].copy()
        missing = self.missing[row] if isinstance(self.missing, np.ndarray) else self.missing
        values, begin = np.full(max(end - first, 0), missing, self.values.dtype), max(self.spans.first.item(row) - first, 0)
        values[begin:begin + kept.stop - kept.start] = self.values[kept]
        return values

    def __setitem__(self, key: tuple[Any, Any], values: Any) -> None:
        """Only where rows are kept."""
        places, kept = self.spans.places(*key)
        if not kept.all():
            raise IndexError("Stations at which a row is not kept cannot be set.")
        self.values[places] = values

    def shifted(self, by: int, stations: int) -> RowTable:
        """The rows on a grid that begins `by` stations later."""
        spans = RowSpans(self.spans.first - by, self.spans.end - self.spans.first, stations)
        if spans.size == self.spans.size:
            return RowTable(spans, self.values, self.missing)
        return RowTable(spans, self.values[self.spans.places(spans.owner, spans.station + by)[0]], self.missing)


def stacked(tables: Sequence[RowTable]) -> RowTable:
    """The rows of several tables on one grid, one table after the other."""
    spans = RowSpans(np.concatenate([table.spans.first for table in tables]),
                     np.concatenate([table.spans.end - table.spans.first for table in tables]), tables[0].spans.stations)
    missing = np.concatenate([np.broadcast_to(table.missing, len(table)) for table in tables])
    return RowTable(spans, np.concatenate([table.values for table in tables]), missing)


# An uncertainty that changes along a road.


@dataclass(frozen=True)
class SigmaAlong:
    """One sigma by station of a road: `metres` at the rising `stations` of nodes; it changes evenly between them and stays beyond them."""

    stations: tuple[float, ...]
    metres: tuple[float, ...]

    @classmethod
    def everywhere(cls, metres: float) -> SigmaAlong:
        return cls((0.0,), (float(metres),))

    @classmethod
    def through(cls, stations: np.ndarray, metres: np.ndarray) -> SigmaAlong:
        """From (N,) values in metres at (N,) stations in any order, N > 0: the RMS of every stretch of `sigma_stretch`."""
        stations, metres = np.asarray(stations, float), np.asarray(metres, float)
        if np.ptp(metres) == 0.0:
            return cls.everywhere(metres[0])
        _, stretch = np.unique(np.floor(stations / FRAME.sigma_stretch), return_inverse=True)
        count = np.bincount(stretch)
        return cls(tuple((np.bincount(stretch, stations) / count).tolist()), tuple(np.sqrt(np.bincount(stretch, metres**2) / count).tolist()))

    def at(self, s: np.ndarray | float) -> np.ndarray:
        """(N,) m at (N,) stations."""
        return np.interp(s, self.stations, self.metres)

    def at_least(self, metres: float) -> SigmaAlong:
        """The same, nowhere less than some metres."""
        return SigmaAlong(self.stations, tuple(max(sigma, float(metres)) for sigma in self.metres))


def cuts_where_it_changes(along: np.ndarray, sigma: np.ndarray) -> np.ndarray:
    """(K,) rows, without the first, that begin a stretch of a line of which one number tells how uncertain it is; empty where one tells it all.

    From stretches of `sigma_stretch` on, those beside each other become one that differ least, weighted by their lengths (Ward), until every two
    differ by `sigma_cut_factor` times and `least_sigma_change`. `along` : (N,) m along the line, rising; `sigma` : (N,) m, one sigma there.
    """
    count = int((along[-1] - along[0]) / FRAME.sigma_stretch) if len(along) else 0
    if count < 2 or np.ptp(sigma) < FRAME.least_sigma_change:
        return np.empty(0, int)
    begin = np.unique(np.searchsorted(along, along[0] + (along[-1] - along[0]) * np.arange(count) / count))
    size = np.diff(np.append(begin, len(along))).astype(float)
    mean = np.add.reduceat(sigma, begin) / size
    while len(begin) > 1:
        change = np.abs(np.diff(mean))
        differ = (change >= FRAME.least_sigma_change) & (np.maximum(mean[1:], mean[:-1]) >= FRAME.sigma_cut_factor * np.minimum(mean[1:], mean[:-1]))
        if differ.all():
            break
        k = int(np.argmin(np.where(differ, np.inf, size[1:] * size[:-1] / (size[1:] + size[:-1]) * change**2)))
        mean[k] = np.average(mean[k:k + 2], weights=size[k:k + 2])
        size[k] += size[k + 1]
        mean, size, begin = (np.delete(values, k + 1) for values in (mean, size, begin))
    return begin[1:]
