"""A table of points stored by column: a step reads the columns that it needs, and no others are copied."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np


class Columns:
    """Arrays of one length by name, used like a structured array.

    `columns["z"]` is one column; `columns[mask]`, `columns[indices]` and `columns[2:5]` are Columns of those rows. Evaluation is lazy: rows are
    taken, and parts are concatenated, only when a column of the result is asked for, since most steps use few columns.

    arrays : {name: (N,) array} of the columns that are in memory already
    dtype : structured dtype that names all columns
    length : N; by default the length of the first array
    load : function of a name that returns the (N,) column
    source : (Columns, (N,) indices) whose rows these are
    parts : Columns that these are the concatenation of
    load_rows : function of a name and (M,) indices within bounds that returns those rows of the column
    kept : whether a column stays in memory once it was loaded; of a long road each would take as much again
    """

    __slots__ = ("_arrays", "_load", "_load_rows", "_source", "_parts", "_ends", "_read_only", "_length", "_kept", "dtype")

    def __init__(self, arrays: dict[str, np.ndarray], dtype: Any, length: int | None = None,
                 load: Callable[[str], np.ndarray] | None = None, source: tuple[Columns, np.ndarray] | None = None,
                 parts: Sequence[Columns] | None = None, load_rows: Callable[[str, np.ndarray], np.ndarray] | None = None, kept: bool = True):
        self._arrays, self._load, self._load_rows = arrays, load, load_rows
        self._source = source
        self._parts = parts
        self._ends: np.ndarray | None = None   # of the parts
        self._read_only, self._kept = False, kept
        self.dtype = np.dtype(dtype)
        self._length: int = len(next(iter(arrays.values()))) if length is None else length

    @classmethod
    def from_records(cls, records: np.ndarray | Columns) -> Columns:
        """Columns of a structured array (copied), or Columns as they are."""
        if isinstance(records, cls):
            return records
        return cls({name: np.ascontiguousarray(records[name]) for name in records.dtype.names or ()}, records.dtype, len(records))

    @classmethod
    def concatenate(cls, parts: Sequence[np.ndarray | Columns], dtype: Any) -> Columns:
        """Several records one after the other; no parts give empty Columns of the dtype."""
        filled = [cls.from_records(part) for part in parts if len(part)]
        if len(filled) == 1:
            return filled[0]
        dtype = np.dtype(dtype)
        if not filled:
            return cls({name: np.empty(0, dtype[name]) for name in dtype.names or ()}, dtype, 0)
        return cls({}, dtype, sum(map(len, filled)), lambda name: np.concatenate([part[name] for part in filled]), parts=filled)

    def __len__(self) -> int:
        return self._length

    @property
    def shape(self) -> tuple[int]:
        """(N,), as of an array."""
        return (self._length,)

    @property
    def names(self) -> tuple[str, ...]:
        return self.dtype.names or ()

    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, str):
            return self._column(which)
        return self._slice(which) if isinstance(which, slice) else self.take(which)

    def _slice(self, rows):
        first, end, step = rows.indices(self._length)
        if self._parts is not None and not self._arrays and step == 1:
            return self._slice_of_parts(first, end)
        if any((self._load_rows, self._parts, self._source)) if step != 1 else not self._kept and self._load_rows is not None:
            return self.take(np.arange(first, end, step))
        length = len(range(first, end, step))
        if self._load is None:
            return Columns({name: array[rows] for name, array in self._arrays.items()}, self.dtype, length)
        return Columns({}, self.dtype, length, lambda name: self[name][rows])

    def _column(self, name):
        column = self._arrays.get(name)
        if column is None:
            if name not in self.names or self._load is None:
                raise KeyError(name)
            column = self._load(name)
            if self._read_only:
                column.flags.writeable = False
            if self._kept:
                self._arrays[name] = column
        return column

    def take(self, which: np.ndarray) -> Columns:
        """The rows of a mask, (N,) bool, which is refused with another length, or of (M,) indices."""
        which = np.asarray(which)
        if which.dtype == bool:
            if which.shape != self.shape:
                raise IndexError(f"A mask of {which.shape} does not fit {self._length} points.")
            which = np.flatnonzero(which)
        source, rows = self, which.astype(np.intp, copy=False)
        if self._source is not None:
            source, rows = self._source[0], self._source[1].take(rows)
        return Columns({}, self.dtype, len(rows), lambda name: source.column_rows(name, rows), (source, rows))

    def column_rows(self, name: str, rows: np.ndarray) -> np.ndarray:
        """(M,) rows of one column by their indices, as cheaply as they can be read."""
        if not len(rows):
            return np.empty(0, self.dtype[name])
        if name not in self._arrays:
            if self._load_rows is not None:
                return self._load_rows(name, rows)
            # the rows are split among the parts only where they ascend within bounds
            if self._parts is not None and rows[0] >= 0 and rows[-1] < self._length and (rows[1:] >= rows[:-1]).all():
                return self._rows_of_parts(name, rows)
        column = self[name]
        # A column of one repeated value has stride 0 and stays one value.
        return column.take(rows) if column.strides[0] else np.broadcast_to(column[0], len(rows))

    def _rows_of_parts(self, name, rows):
        if self._ends is None:
            self._ends = np.cumsum([len(part) for part in self._parts])
        # a marking lies in few of the parts of a long road
        first, last = np.searchsorted(self._ends, rows[[0, -1]], side="right").tolist()
        parts, ends = self._parts[first:last + 1], self._ends[first:last + 1]
        bounds = [0, *np.searchsorted(rows, ends).tolist()]
        pieces = [part.column_rows(name, rows[a:b] - (end - len(part)))
                  for part, end, a, b in zip(parts, ends, bounds[:-1], bounds[1:]) if b > a]
        return pieces[0] if len(pieces) == 1 else np.concatenate(pieces)

    def _slice_of_parts(self, first, end):
        """The rows from first up to end, concatenated from the parts that hold them."""
        slices, start = [], 0
        for part in self._parts or ():
            a, b = max(first - start, 0), min(end - start, len(part))
            if b > a:
                slices.append(part if b - a == len(part) else part[a:b])
            start += len(part)
        return Columns.concatenate(slices, self.dtype)

    def __setitem__(self, name: str, values: Any) -> None:
        if self._read_only:
            raise ValueError("assignment destination is read-only")
        if not self[name].flags.writeable:  # a view of one repeated value
            self._arrays[name] = np.array(self[name])
        self._arrays[name][:] = values

    def unread(self) -> Columns:
        """Rows of other Columns anew, none of whose columns is in memory: what is read of them goes with them. Others as they are."""
        if self._source is None or self._read_only:
            return self
        return Columns({}, self.dtype, self._length, self._load, self._source)

    def read_only(self) -> Columns:
        """These columns, protected from being written to."""
        self._read_only = True
        for array in self._arrays.values():
            array.flags.writeable = False
        return self

    def with_columns(self, **columns: np.ndarray) -> Columns:
        """The same rows with further columns, each (N,); a column of the same name is replaced."""
        dtypes = {**{name: self.dtype[name] for name in self.names}, **{name: array.dtype for name, array in columns.items()}}
        dtype = np.dtype(list(dtypes.items()))
        return Columns(dict(columns), dtype, self._length, lambda name: self[name], load_rows=self.column_rows)

    def __array__(self, dtype=None, copy=None):
        records = np.empty(self._length, self.dtype)
        for name in self.names:
            records[name] = self[name]
        return records
