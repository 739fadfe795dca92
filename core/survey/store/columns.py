"""Points column by column: a step reads the columns it needs, and no others are moved."""

import numpy as np

AT_ONCE = 1 << 14      # rows turned into columns at a time: what fits the processor's cache
FETCH = 8              # fetching rows of a column costs as much as this part of all of them, and then by the row


class Columns:
    """Arrays of one length under names, used like a structured array.

    `columns["z"]` is one column, `columns[mask]`, `columns[indices]` and
    `columns[2:5]` are Columns of those rows. Rows are chosen, and parts joined,
    only when a column of the result is asked for: most steps look at few.

    `make` is a function of a name that fetches a column, and `pick` one of a name
    and rows, (M,) within bounds, that fetches those rows alone.
    """

    __slots__ = ("_arrays", "_make", "_pick", "_picked", "_chosen", "_parts", "_locked", "_length", "dtype")

    def __init__(self, arrays, dtype, length=None, make=None, chosen=None, parts=None, pick=None):
        self._arrays, self._make, self._pick = arrays, make, pick
        self._picked = {}   # what fetching rows has cost by name, in rows; beyond half of the column it is fetched whole
        self._chosen = chosen  # (Columns, rows) that these were chosen from
        self._parts = parts    # Columns that these are joined of
        self._locked = False
        self.dtype = np.dtype(dtype)
        self._length = len(next(iter(arrays.values()))) if length is None else length

    @classmethod
    def of(cls, records):
        """Columns of a structured array (copied), or Columns as they are."""
        if isinstance(records, cls):
            return records
        return cls({name: np.ascontiguousarray(records[name]) for name in records.dtype.names}, records.dtype, len(records))

    @classmethod
    def concatenate(cls, parts, dtype):
        """Several Columns one after the other (none at all give an empty one)."""
        parts = [part for part in parts if len(part)]
        if len(parts) == 1:
            return parts[0]
        dtype = np.dtype(dtype)
        if not parts:
            return cls({name: np.empty(0, dtype[name]) for name in dtype.names}, dtype, 0)
        return cls({}, dtype, sum(map(len, parts)), lambda name: np.concatenate([part[name] for part in parts]), parts=parts)

    def __len__(self):
        return self._length

    @property
    def shape(self):
        return (self._length,)

    @property
    def nbytes(self):
        return self._length * self.dtype.itemsize

    def __getitem__(self, which):
        if isinstance(which, str):
            found = self._arrays.get(which)
            if found is None:
                if which not in self.dtype.names:
                    raise KeyError(which)
                found = self._make(which)
                if self._locked:
                    found.flags.writeable = False
                self._arrays[which] = found
            return found
        if isinstance(which, slice):
            if self._parts is not None and not self._arrays and which.step in (None, 1):
                return self._joined_slice(*which.indices(self._length)[:2])
            if which.step not in (None, 1) and (self._pick or self._parts or self._chosen):
                return self.take(np.arange(*which.indices(self._length)))
            length = len(range(*which.indices(self._length)))
            if self._make is None:
                return Columns({name: array[which] for name, array in self._arrays.items()}, self.dtype, length)
            return Columns({}, self.dtype, length, lambda name: self[name][which])
        return self.take(which)

    def take(self, which):
        """The rows of a mask or index array."""
        which = np.asarray(which)
        if which.dtype == bool:
            if which.shape != self.shape:
                raise IndexError(f"A mask of {which.shape} does not fit {self._length} points.")
            which = np.flatnonzero(which)
        source, rows = self, which.astype(np.intp, copy=False)
        if self._chosen is not None:
            source, rows = self._chosen[0], self._chosen[1].take(rows)
        return Columns({}, self.dtype, len(rows), lambda name: source._rows(name, rows), (source, rows))

    def _rows(self, name, rows):
        """Rows of one column; of joined parts only those are asked that the rows lie in, and few rows are fetched alone."""
        if self._pick is not None and name not in self._arrays:
            cost = self._picked.get(name, 0) + len(rows) + self._length // FETCH
            if 2 * cost <= self._length and (not len(rows) or rows.min() >= 0 and rows.max() < self._length):
                self._picked[name] = cost
                return self._pick(name, rows)
        # taken apart only where rows ascend within bounds
        if self._parts is None or name in self._arrays or not len(rows) or rows[0] < 0 or rows[-1] >= self._length \
                or (rows[1:] < rows[:-1]).any():
            column = self[name]
            # of what all have the same nothing need be fetched
            return column.take(rows) if column.strides[0] or not len(rows) else np.broadcast_to(column[0], len(rows))
        ends = np.cumsum([len(part) for part in self._parts])
        bounds = [0, *np.searchsorted(rows, ends).tolist()]
        found = [part._rows(name, rows[a:b] - (end - len(part)))
                 for part, end, a, b in zip(self._parts, ends, bounds[:-1], bounds[1:]) if b > a]
        return found[0] if len(found) == 1 else np.concatenate(found)

    def run(self, first, end):
        """The rows from first to end; few of them are fetched alone, of many the column."""
        return self[first:end] if 2 * (end - first) > self._length else self.take(np.arange(first, end))

    def _joined_slice(self, first, end):
        """The rows from first to end, joined of what of the parts lies there."""
        parts, start = [], 0
        for part in self._parts:
            a, b = max(first - start, 0), min(end - start, len(part))
            if b > a:
                parts.append(part if b - a == len(part) else part[a:b])
            start += len(part)
        return Columns.concatenate(parts, self.dtype)

    def __setitem__(self, name, values):
        if self._locked:
            raise ValueError("assignment destination is read-only")
        if not self[name].flags.writeable:  # a view of one value
            self._arrays[name] = np.array(self[name])
        self._arrays[name][:] = values

    def whole(self):
        """These columns, every one of them made, and what they were made of let go."""
        for name in self.dtype.names:
            self[name]
        self._make = self._pick = self._chosen = self._parts = None  # arrays are there for every name, so it is not missed
        return self

    def locked(self):
        """The same, not to be written to."""
        self._locked = True
        for array in self._arrays.values():
            array.flags.writeable = False
        return self

    def copy(self):
        """Columns of their own, which may be written to."""
        return Columns({name: self[name].copy() for name in self.dtype.names}, self.dtype, self._length)

    def with_columns(self, **columns):
        """The same points with further columns, or others in their place."""
        kinds = {**{name: self.dtype[name] for name in self.dtype.names}, **{name: array.dtype for name, array in columns.items()}}
        dtype = np.dtype(list(kinds.items()))
        return Columns(dict(columns), dtype, self._length, lambda name: self[name], pick=self._rows)

    def __array__(self, dtype=None, copy=None):
        records = np.empty(self._length, self.dtype)
        for name in self.dtype.names:
            records[name] = self[name]
        return records


def in_columns(records, order):
    """Columns of the rows of a structured array, in an order (indices): each row is fetched once."""
    dtype = records.dtype
    arrays = {name: np.empty(len(order), dtype[name]) for name in dtype.names}
    buffer = np.empty(min(len(order), AT_ONCE), dtype)
    for first in range(0, len(order), AT_ONCE):
        rows = order[first:first + AT_ONCE]
        some = np.take(records, rows, out=buffer[:len(rows)], mode="clip")
        for name, array in arrays.items():
            array[first:first + len(rows)] = some[name]
    return Columns(arrays, dtype, len(order))
