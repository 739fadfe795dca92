"""Sorting of many 32-bit numbers in linear time, decimation of crowded cells, groups, runs and stretches."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import MISSING, fields, replace
from functools import cache
from typing import Any, TypeVar

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..lazy import shapely

FEW = 500        # cost: numbers that numpy's lexsort takes less time for
RADIX_BITS = 16  # derived: numpy sorts integers of up to 16 bits in linear time (radix sort)


def order_by(*keys: np.ndarray) -> np.ndarray:
    """(N,) indices that sort by several (N,) int32 keys, like `numpy.lexsort`: stable, in linear time; the last is the primary key.

    Each key is split into digits of 16 bits and sorted digit by digit, the least significant first (radix sort), where there are many.
    """
    if keys and len(keys[0]) < FEW:
        return np.lexsort(keys)
    order = None
    for key in keys:
        key = above_least(np.asarray(key, np.int32))
        for shift in range(0, max(int(key.max()).bit_length(), 1), RADIX_BITS):
            digit = (key >> shift).astype(np.uint16)
            order = np.argsort(digit, kind="stable") if order is None else order.take(np.argsort(digit.take(order), kind="stable"))
    if order is None:
        raise ValueError("at least one key is needed")
    return order


def bucket_argsort(cell: np.ndarray, count: int, mask: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Rows, of all or those of a mask (N,), sorted by cell, stable; in linear time for fewer than 2**16 cells.

    cell : (N,) cell numbers, 0 to count - 1

    Returns
        rows : (M,) row numbers, ascending within each cell
        ends : (count,) index in `rows` at which each cell ends
    """
    kind = np.min_scalar_type(count)
    cell = cell.astype(kind)
    if mask is not None:
        cell[~mask] = count
    rows = np.argsort(cell, kind="stable")
    ends = np.searchsorted(cell.take(rows), np.arange(count, dtype=kind), side="right")
    return rows[:ends[-1]], ends


def above_least(values: np.ndarray) -> np.ndarray:
    """(N,) uint32: int32 values minus their minimum."""
    return (values - values.min()).view(np.uint32)


def decimate_cells(cell: np.ndarray, most: int) -> np.ndarray:
    """(M,) indices of at most about `most` members of every cell, evenly spaced in their order; sorted by cell, (N,) int32 numbers from 0."""
    count = np.bincount(cell)
    step = -(-count // most)
    order = order_by(cell)
    if step.max(initial=0) > 1:
        first = np.cumsum(count) - count
        rank = np.arange(len(order), dtype=np.int32) - np.repeat(first.astype(np.int32), count)
        order = order[rank % np.repeat(step.astype(np.int32), count) == 0]
    return order


def quantile_in_order(values: np.ndarray, count: int, share: float) -> float:
    """One quantile of the first `count` of sorted values, interpolated as by `numpy.quantile`."""
    rank = share * (count - 1)
    k = int(rank)
    a, b = float(values[k]), float(values[min(k + 1, count - 1)])
    share = rank - k
    return a + (b - a) * share if share < 0.5 else b - (b - a) * (1.0 - share)


def round_step(least: float) -> float:
    """The smallest of 1, 2, 5, 10, 20, 50 … (and their tenths) that is not below `least`, above 0."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(power * step for step in (1, 2, 5, 10) if power * step >= least * (1 - 1e-9))


# What hangs together: groups of things of which pairs are linked.

def linked_groups(first: np.ndarray, second: np.ndarray, count: int) -> np.ndarray:
    """(count,) int32, the group of each thing: those that links lead to from each other, in either direction, over any others.

    The links are two (P,) arrays of things; one may be named twice. Groups are numbered from 0 in the order of their first things.
    """
    graph = coo_matrix((np.ones(len(first), bool), (first, second)), shape=(count, count))
    return connected_components(graph, directed=False)[1]


def members_of(number: np.ndarray) -> Iterator[tuple[int, np.ndarray]]:
    """Yield (number, (M,) ascending members) of all groups, ascending; `number` (N,) is the group of each thing, below 0 where it is of none.

    They are found by sorting: a search of its members for every group compares everything with everything.
    """
    grouped = np.flatnonzero(number >= 0)
    keys = number[grouped]
    if (keys[1:] < keys[:-1]).any():
        order = np.argsort(keys, kind="stable")
        grouped, keys = grouped[order], keys[order]
    starts = np.flatnonzero(np.diff(keys, prepend=-1))
    for begin, end in zip(starts.tolist(), [*starts[1:].tolist(), len(keys)]):
        yield int(keys[begin]), grouped[begin:end]


# Runs of True in a mask, stretches of ascending places, and the greatest of neighbours in a row of cells.

def mask_runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """(first, last + 1) of every run of True in (N,) bool."""
    change = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    return list(zip(change[::2].tolist(), change[1::2].tolist()))


def stretch_of(places: np.ndarray, start: float, end: float) -> slice:
    """Those of (N,) ascending places that lie from `start` to `end`, both included: looked up, since a long road has many stretches."""
    return slice(int(np.searchsorted(places, start, side="left")), int(np.searchsorted(places, end, side="right")))


def best_within(place: np.ndarray, row: np.ndarray, score: np.ndarray, span: int) -> np.ndarray:
    """(N,) bool, which scores are the greatest of their surroundings; equal ones all are.

    place : (N,) cells, counted row by row, ascending
    row : (N,) rows of cells
    span : cells of a row on either side that are compared
    """
    best = np.ones(len(place), bool)
    for lag in range(1, min(span, len(place) - 1) + 1):
        near = (place[lag:] - place[:-lag] <= span) & (row[lag:] == row[:-lag])
        best[:-lag] &= ~near | (score[:-lag] >= score[lag:])
        best[lag:] &= ~near | (score[lag:] >= score[:-lag])
    return best


# Which of many stretches of a road meet.

ROUNDING_TOLERANCE = 1e-6  # derived: m, more than coordinates are rounded by


def overlapping_pairs(first: np.ndarray, last: np.ndarray, other_first: np.ndarray, other_last: np.ndarray,
                      apart: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """(P,) indices a, b of all pairs of stretches that overlap, touch or lie no farther than `apart` metres from each other, by a, then by b.

    A stretch is paired with itself too; some that lie a hair farther apart are among them. A tree finds them: a long survey needs no table of all.

    first, last : (N,) m, first <= last
    other_first, other_last : (M,) m, likewise
    """
    reach = apart + ROUNDING_TOLERANCE
    a, b = shapely.STRtree(shapely.box(other_first, 0.0, other_last, 1.0)).query(shapely.box(first - reach, 0.0, last + reach, 1.0))
    order = np.lexsort((b, a))
    return a[order], b[order]


# Things of one kind as columns: dataclasses of arrays that have one entry for each of them.

AnyRows = TypeVar("AnyRows", bound="Rows")


class Rows:
    """Base of a dataclass of things of one kind: how many there are, some of them, and those of several joined.

    Fields without a default are arrays of one length, or what is indexed as they are; a field with a default holds for all things.
    """

    @classmethod
    def names(cls) -> tuple[str, ...]:
        return _names_of(cls)

    def columns(self) -> list[np.ndarray]:
        return [getattr(self, name) for name in self.names()]

    def __len__(self) -> int:
        return len(self.columns()[0])

    def __getitem__(self: AnyRows, which: Any) -> AnyRows:
        return replace(self, **{name: getattr(self, name)[which] for name in self.names()})  # type: ignore[type-var]

    @classmethod
    def join(cls: type[AnyRows], parts: Sequence[AnyRows]) -> AnyRows:
        return cls(*map(np.concatenate, zip(*(part.columns() for part in parts))))


_names_of: Callable[[type], tuple[str, ...]] = cache(lambda kind: tuple(one.name for one in fields(kind) if one.default is MISSING))
