"""A bounded store of points by road section: memory up to a limit, then a temporary file."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np

from ...common.arrays import RADIX_BITS, above_least, bucket_argsort, order_by
from ...common.parallel import ScratchBuffers, check_cancelled, column_buffers
from ..weights import STORE
from .columns import Columns, columns_in_order
from .records import COORDINATE_SCALE, Points, take_rows
from .spill_file import Key, SpillFile, StoredColumn, StoreIndex, close_parts, new_part

LEAST_UNIT, MOST_UNIT = -2**31, 2**31 - 1   # of 0.1 mm, in which stations are kept
STRETCH_POINTS = 1_200_000   # points of a stretch that a worker process works on, about: a second of its time

Stretch = tuple[int, int, int]   # number of a road, first and last + 1 number of its sections


@dataclass(frozen=True)
class PartitionedPoints:
    """Points of one road, section by section: those of section `first + k` end before row `ends[k]` of the records."""

    road: int
    records: Columns
    first: int
    ends: list[int]


class SectionStore:
    """Points of all roads, appended in any order, read back by station.

    A section is a fixed interval of station of one road, counted from 0. What is read
    back is sorted by station, offset, height and time, so it does not depend on
    the order of appending, and a window is a range of rows. A section is sorted
    once, when it is first read.

    Parameters
    ----------
    dtype : structured dtype of the points, with at least the columns of SURVEY_POINT where points are appended
    section_length : metres
    memory_limit : bytes of points in memory
    finish : function of a road and the Columns of one section, in no order; it is called once, before they
        are sorted, may change them, and returns a mask of the points to keep, or None for all
    cache_limit : bytes of spilled sections that are cached as last read
    folder : where the points go that are not kept in memory, so that others can read them; None for a temporary file without a name
    """

    def __init__(self, dtype: Any, section_length: float = STORE.section_length, memory_limit: int = STORE.memory_limit,
                 finish: Callable[[int, Columns], np.ndarray | None] | None = None, cache_limit: int = STORE.cache_limit, folder: Path | None = None):
        self.dtype = np.dtype(dtype)
        self.section_length = section_length
        self.memory_limit = memory_limit
        self.finish, self.folder = finish, folder
        self._buffers = ScratchBuffers()
        self._sections: dict[tuple[int, int], _StoredSection] = {}
        self._cache: OrderedDict[tuple[int, int], Columns] = OrderedDict()   # the spilled sections read last
        self._cache_bytes, self._cache_limit = 0, cache_limit
        self._lock = threading.Lock()       # sections are read by several threads
        self._section_locks = [threading.Lock() for _ in range(STORE.section_locks)]
        self._waiting_bytes = 0
        self._file: SpillFile | None = None
        self._count = 0
        self.at_close: Callable[[], None] | None = None   # called once the points are released

    @property
    def count(self) -> int:
        return self._count

    def append(self, road: int, records: np.ndarray | Columns) -> None:
        """Add (N,) records of one road; each goes to the section of its station."""
        if len(records):
            self.add(self.partition(road, records))

    def partition(self, road: int, records: np.ndarray | Columns, mask: np.ndarray | None = None) -> PartitionedPoints:
        """Partition points of a road, N > 0, by section: the part of `append` that any thread may do. `mask` : (N,) bool, the points to take."""
        strip = np.multiply(records["s"], COORDINATE_SCALE, out=self._buffers.of(len(records))("strip"))
        strip /= self.section_length
        low, high = int(np.floor(strip.min())), int(np.floor(strip.max()))
        strip *= STORE.strips_per_section
        np.floor(strip, out=strip)
        strip -= STORE.strips_per_section * low
        order, ends = bucket_argsort(strip, STORE.strips_per_section * (high + 1 - low), mask)
        columns = records.take(order).load_all() if isinstance(records, Columns) else columns_in_order(records, order)
        return PartitionedPoints(int(road), columns, low, ends[STORE.strips_per_section - 1::STORE.strips_per_section].tolist())

    def add(self, points: PartitionedPoints) -> None:
        for k, (first, end) in enumerate(zip([0, *points.ends], points.ends)):
            if end > first:
                self._add_part((points.road, points.first + k), points.records[first:end], False)
        self._spill_beyond_limit()

    def put(self, road: int, section: int, records: Any) -> None:
        """Set the (N,) Columns of one section, in canonical order; no more points are added to it."""
        if len(records):
            self._add_part((int(road), int(section)), records.load_all(), True)
            self._spill_beyond_limit()

    def _add_part(self, key, records, in_order):
        section = self._sections.setdefault(key, _StoredSection(self.dtype, in_order))
        section.in_order = in_order and not section.parts
        section.parts.append(records)
        self._drop_from_cache(key)
        self._count += len(records) if key[0] >= 0 else 0
        self._waiting_bytes += records.nbytes

    def _spill_beyond_limit(self):
        if self._waiting_bytes <= self.memory_limit:
            return
        self._spill()

    def _spill(self):
        file = self._own_file()
        for section in self._sections.values():
            section.spill(file)
        self._waiting_bytes = 0

    def _own_file(self):
        with self._lock:
            if self._file is None:
                self._file = SpillFile(self.folder and self.folder / f"points-{uuid4().hex}.bin")
            return self._file

    def roads(self) -> list[int]:
        """Numbers of the roads that have points, ascending."""
        return [road for road in self.numbers() if road >= 0]

    def numbers(self) -> list[int]:
        """The same, and of what lies beside roads, see `beside_road`."""
        return sorted({road for road, _ in self._sections})

    def sections(self, road: int) -> list[int]:
        """Numbers of the sections of a road that have points, ascending."""
        return sorted(section for number, section in self._sections if number == road)

    def size(self, road: int, section: int) -> int:
        """Points of a section, before `finish` removes any."""
        return self._sections[road, section].size

    def stretches(self, points: int = 0, numbers: Sequence[int] | None = None) -> list[Stretch]:
        """All sections, as stretches of road with about so many points each; every section by itself for 0. Of all roads, or of some `numbers`."""
        stretches: list[Stretch] = []
        for road in self.roads() if numbers is None else numbers:
            sections = np.array(self.sections(road))
            ends = np.cumsum([self.size(road, number) for number in sections.tolist()])
            cuts = sections[np.searchsorted(ends, np.arange(points, ends[-1], points))] + 1 if points else sections
            bounds = np.unique(np.r_[sections[0], cuts, sections[-1] + 1]).tolist()
            stretches += [(road, first, end) for first, end in zip(bounds[:-1], bounds[1:])]
        return stretches

    def in_stretch(self, stretch: Stretch) -> list[Key]:
        """(road, number) of the sections of a stretch that have points."""
        road, first, end = stretch
        return [(road, number) for number in range(first, end) if (road, number) in self._sections]

    def section(self, road: int, section: int) -> Columns:
        """The Columns of one section in canonical order, read-only; empty where there are no points."""
        check_cancelled()
        key = (road, section)
        with self._section_locks[hash(key) % STORE.section_locks]:
            with self._lock:
                records = self._cache.get(key)
                if records is not None:
                    self._cache.move_to_end(key)
                    return records
            records, cacheable = self._read(road, section)
            if cacheable:
                self._add_to_cache(key, records)
            return records.read_only()

    def _read(self, road, section):
        """The Columns of a section, and whether they are worth caching (those in memory are not)."""
        stored = self._sections.get((road, section))
        if stored is not None and not stored.in_order:
            before = stored.nbytes
            file = None if all(isinstance(part, Columns) for part in stored.parts) else self._own_file()
            stored.sort(file, self.finish and partial(self.finish, road))
            with self._lock:
                self._waiting_bytes += stored.nbytes - before
        if stored is None or not stored.parts:
            return Columns.concatenate([], self.dtype), False
        records = stored.parts[0]
        return (records, False) if isinstance(records, Columns) else (self._columns_of_file(records), True)

    def column(self, road: int, section: int, name: str, rows: np.ndarray) -> np.ndarray:
        """(M,) rows of one column of a section that was read before; nothing else is read or cached."""
        part = self._sections[road, section].parts[0]
        return part[name].take(rows, mode="clip") if isinstance(part, Columns) else _from_file(part[name], rows)

    def first_unit(self, section: int) -> int:
        """The least station, in units of 0.1 mm, that lies in a section."""
        unit = int(round(section * self.section_length / COORDINATE_SCALE))
        while np.floor((unit - 1) * COORDINATE_SCALE / self.section_length) >= section:
            unit -= 1
        while np.floor(unit * COORDINATE_SCALE / self.section_length) < section:
            unit += 1
        return unit

    def _columns_of_file(self, stored):
        return Columns({}, self.dtype, stored[self.dtype.names[0]].packing.size, lambda name: _from_file(stored[name]),
                       load_rows=lambda name, rows: _from_file(stored[name], rows))

    def _add_to_cache(self, key, records):
        with self._lock:
            self._cache[key] = records
            self._cache_bytes += records.nbytes
            while self._cache_bytes > self._cache_limit and len(self._cache) > 1:
                self._cache_bytes -= self._cache.popitem(last=False)[1].nbytes

    def _drop_from_cache(self, key):
        with self._lock:
            records = self._cache.pop(key, None)
            self._cache_bytes -= 0 if records is None else records.nbytes

    def window(self, road: int, start: float, end: float) -> Points:
        """Points of a road with start <= station < end (metres), in canonical order."""
        first = int(np.floor(start / self.section_length))
        last = int(np.floor(np.nextafter(end, -np.inf) / self.section_length))
        parts = []
        for number in range(first, last + 1):
            records = self.section(road, number)
            # The stations of a section that lies inside the window need not be searched.
            low, high = self.first_unit(number) * COORDINATE_SCALE, (self.first_unit(number + 1) - 1) * COORDINATE_SCALE
            if len(records) and (low < start or high >= end):
                a, b = np.searchsorted(records["s"], np.array([_unit_at(start), _unit_at(end)], records["s"].dtype)).tolist()
                records = records if b - a == len(records) else records.row_range(a, b)
            parts.append(records)
        return Points(Columns.concatenate(parts, self.dtype))

    def span(self, road: int) -> tuple[float, float]:
        """Stations (metres) between which the points of a road lie, start <= station < end; (0, 0) where there are none."""
        sections = self.sections(road)
        ends = []
        for numbers, row in ((sections, 0), (sections[::-1], -1)):
            # `finish` may have removed all points of a section.
            stations = next((s for number in numbers if len(s := self.section(road, number)["s"])), None)
            if stations is None:
                return 0.0, 0.0
            ends.append(int(stations[row]))
        return ends[0] * COORDINATE_SCALE, (ends[1] + 1) * COORDINATE_SCALE

    def points_between(self, road: int, start: float, end: float) -> int:
        """Points in the sections that reach between two stations (m), before `finish` removes any."""
        first, last = (int(np.floor(station / self.section_length)) for station in (start, end))
        return sum(self._sections[road, number].size for number in range(first, last + 1) if (road, number) in self._sections)

    def with_column(self, name: str, folder: Path | None = None) -> SectionStore:
        """A store of the same points in which one column is set anew, section by section; it shares all other columns with this one."""

        return ColumnOverlay(self, name, folder)

    def clear_cache(self) -> None:
        with self._lock:
            self._cache.clear()
            self._cache_bytes = 0

    @contextmanager
    def part(self) -> Iterator[SectionStore]:
        """A store like this one, without points, which are written to one new file of the same folder; it appears at the end."""
        if self.folder is None:
            raise ValueError("a part of a store lies in its folder")
        with new_part(self.folder) as file:
            store = SectionStore(self.dtype, self.section_length, self.memory_limit, folder=self.folder)
            store._file = file
            yield store

    def index(self) -> StoreIndex:
        """Put all points into the folder of this store, and tell where they lie there."""
        if self._waiting_bytes:
            self._spill()
        return StoreIndex.of((key, section.in_order, section.parts) for key, section in sorted(self._sections.items()))

    def write_in_order(self, keys: Sequence[Key], folder: Path) -> StoreIndex:
        """Write sections, (road, number) each, in canonical order to a new file of a folder; this store stays as it is."""
        parts = []
        with new_part(folder) as file:
            for key in keys:
                check_cancelled()
                stored = self._sections[key].written_in_order(file, self.finish and partial(self.finish, key[0]))
                if stored is not None:
                    parts.append((key, True, [stored]))
        return StoreIndex.of(parts)

    def contents(self) -> dict[str, Any]:
        """What another process needs to open this store by `opened`, whose points lie in its folder then; plain values."""
        return dict(columns=[list(column) for column in self.dtype.descr], section_length=self.section_length, points=self.index())

    @classmethod
    def opened(cls, folder: Path, columns: list[list[str]], section_length: float, points: StoreIndex) -> SectionStore:
        """The store of `contents`, whose points lie in a folder."""
        store = cls([tuple(column) for column in columns], section_length, folder=folder)
        store.adopt(points, folder)
        return store

    def adopt(self, index: StoreIndex, folder: Path) -> None:
        """Add the points that others wrote to files of a folder."""
        for key, in_order, stored in index.stored(folder, self.dtype):
            section = self._sections.setdefault(key, _StoredSection(self.dtype, in_order))
            section.in_order = in_order and not section.parts
            section.parts.append(stored)
            self._drop_from_cache(key)
        self._count += index.count

    def take_over(self, index: StoreIndex, folder: Path) -> None:
        """Keep the points that others wrote in order to files of a folder, from now on, instead of those that are here."""
        count = self._count
        self._release()
        self.folder = folder
        self.adopt(index, folder)
        self._count = count

    def close(self) -> None:
        self._release()
        close_parts()
        if self.at_close is not None:
            self.at_close()

    def _release(self):
        self.clear_cache()
        self._sections.clear()
        self._waiting_bytes = 0
        if self._file is not None:
            self._file.close()
            self._file = None


def _from_file(stored, rows=None):
    return stored.file.get(stored, rows=rows)


def _unit_at(station):
    """The least whole number of units of 0.1 mm whose station is not less than some metres."""
    unit = int(np.ceil(station / COORDINATE_SCALE))
    while (unit - 1) * COORDINATE_SCALE >= station:
        unit -= 1
    while unit * COORDINATE_SCALE < station:
        unit += 1
    return min(max(unit, LEAST_UNIT), MOST_UNIT)


# The points of one section of a store, before and after they are sorted.

class _StoredSection:
    """The points of one section: some parts in memory, others in files; one part once they are sorted.

    Points are moved column by column, since a column that was just read is still in the processor's cache.

    Attributes
    ----------
    dtype : structured dtype of the points
    in_order : whether the points are in canonical order
    parts : Columns of points in memory, and {name: StoredColumn} of points in files
    """

    __slots__ = ("parts", "in_order", "dtype")

    def __init__(self, dtype: np.dtype, in_order: bool):
        self.dtype, self.in_order = dtype, in_order
        self.parts: list[Columns | dict[str, StoredColumn]] = []

    @property
    def nbytes(self) -> int:
        """Bytes in memory."""
        return sum(part.nbytes for part in self.parts if isinstance(part, Columns))

    @property
    def size(self) -> int:
        """Points."""
        return sum(map(self._count, self.parts))

    def spill(self, file: SpillFile) -> None:
        waiting = [part for part in self.parts if isinstance(part, Columns)]
        if waiting:
            stored = {name: file.put(_concatenate_into_buffer([part[name] for part in waiting])) for name in self.dtype.names or ()}
            self.parts = [part for part in self.parts if not isinstance(part, Columns)]
            self.parts.append(stored)

    def sort(self, file: SpillFile | None, finish: Callable[[Columns], np.ndarray | None] | None) -> None:
        """Finish the points and sort them into one part, which is in the file if any of them were in one.

        `finish` is a function of Columns, in no order, which it may change; it gives a mask of the points to keep, or None for all.
        """
        records, order = self._sorted(finish)
        spilled = [part for part in self.parts if not isinstance(part, Columns)]
        arrays: dict[str, np.ndarray] = {}
        stored: dict[str, StoredColumn] = {}
        sorted_buffer = column_buffers.of(len(order))
        for name in self.dtype.names or () if len(order) else ():
            column = records[name]
            if file is None or not spilled:
                arrays[name] = column.take(order)
                continue
            for part in spilled:
                part[name].file.release(part[name])
            stored[name] = file.put(np.take(column, order, out=sorted_buffer("moved", column.dtype), mode="clip"))
        self.parts, self.in_order = [], True
        if len(order):
            self.parts = [stored if spilled else Columns(arrays, self.dtype)]

    def written_in_order(self, file: SpillFile, finish: Callable[[Columns], np.ndarray | None] | None) -> dict[str, StoredColumn] | None:
        """Write the points, in canonical order, to a file; this section stays as it is. None where `finish`, as of `sort`, keeps no point."""
        if self.in_order:
            return {name: file.put(part[name] if isinstance(part, Columns) else part[name].file.get(part[name]))
                    for part in self.parts for name in self.dtype.names or ()} or None
        records, order = self._sorted(finish)
        buffer = column_buffers.of(len(order))
        return {name: file.put(np.take(records[name], order, out=buffer("moved", self.dtype[name]), mode="clip"))
                for name in self.dtype.names or () if len(order)} or None

    def _sorted(self, finish):
        """The points of all parts, finished, in working memory of this thread, and the rows to keep, in canonical order."""
        count = self.size
        buffer = column_buffers.of(count)
        records = Columns({}, self.dtype, count, lambda name: self._fill(name, buffer(name, self.dtype[name])))
        mask = None if finish is None else finish(records)
        return records, canonical_order(records, mask)

    def _count(self, part):
        return len(part) if isinstance(part, Columns) else part[self.dtype.names[0]].packing.size

    def _fill(self, name, column):
        """Fill a column with the values of all parts."""
        first = 0
        for part in self.parts:
            out = column[first:first + self._count(part)]
            if isinstance(part, Columns):
                out[:] = part[name]
            else:
                part[name].file.get(part[name], out)
            first += len(out)
        return column


def _concatenate_into_buffer(columns):
    """Arrays of a column one after the other, in a buffer of this thread that the next call overwrites."""
    return np.concatenate(columns, out=column_buffers.of(sum(map(len, columns)))("column", columns[0].dtype))


# The order in which a section returns its points, each once: it does not depend on the order of the files, nor on how far these overlap.

# Sort keys, the most significant last: the first set differs between nearly all points, the second between all that are not identical.
PLACE_KEYS = "z", "d", "s"
ALL_KEYS = "returns", "source", "y", "x", "intensity", "time", *PLACE_KEYS


def canonical_order(records: np.ndarray | Columns, mask: np.ndarray | None = None) -> np.ndarray:
    """(M,) indices that sort (N,) records, of at least the columns `ALL_KEYS`, by station, offset, height, time and the remaining columns.

    A record that is the same as another in all of them is the same point from two files, as where tiles overlap: one of them is taken. `mask` : (N,)
    bool, the records to be sorted.
    """
    if not len(records):
        return np.empty(0, np.intp)
    along, across = records["s"], records["d"]
    cell = above_least(along)
    cell >>= max(int(cell.max()).bit_length() - STORE.station_cell_bits, 0)
    order, ends = bucket_argsort(cell, 2**STORE.station_cell_bits, mask)
    tied_parts, first = [np.empty(0, np.intp)], 0
    for end in _chunk_ends(ends):
        rows = order[first:end]
        s, d = above_least(along.take(rows)), above_least(across.take(rows))
        d >>= max(int(d.max()).bit_length() - RADIX_BITS, 0)
        by_place = order_by(d, s)
        order[first:end] = rows.take(by_place)
        tied_parts.append(_same_as_next(s.take(by_place), d.take(by_place)) + first)
        first = end
    # Few points share the station and the leading bits of the offset: only these are sorted by the other columns.
    tied = np.concatenate(tied_parts)
    for names in (PLACE_KEYS, ALL_KEYS):
        if len(tied):
            places = np.union1d(tied, tied + 1)
            tied_rows = take_rows(records, order[places])
            keys = [tied_rows[name] for name in names]
            by_keys = np.lexsort(keys)
            order[places] = order[places[by_keys]]
            tied = places[_same_as_next(*(key[by_keys] for key in keys))]
    return np.delete(order, tied) if len(tied) else order


def _same_as_next(*keys):
    """Indices of the rows whose keys equal those of the next row."""
    return np.flatnonzero(np.logical_and.reduce([key[1:] == key[:-1] for key in keys]))


def _chunk_ends(ends):
    """Where runs of cells end that hold about `sort_chunk` points each."""
    last = np.searchsorted(ends, np.arange(STORE.sort_chunk, ends[-1] + STORE.sort_chunk, STORE.sort_chunk))
    return np.unique(ends[last.clip(max=len(ends) - 1)]).tolist()


# A store of which one column is set anew.

class DerivedStore(SectionStore):
    """Points of another store with columns of their own. They are closed with this one; no points can be appended.

    points : the other store
    """

    def __init__(self, dtype: Any, points: SectionStore):
        super().__init__(dtype, points.section_length, points.memory_limit)
        self.points = points

    def _parts(self) -> tuple[SectionStore, ...]:
        """The stores it consists of; the first of them has the same sections."""
        raise NotImplementedError

    def append(self, road: int, records: Any) -> None:
        raise TypeError("The points of this store are those of another; columns can be put, points cannot be added.")

    def roads(self) -> list[int]:
        return self._parts()[0].roads()

    def sections(self, road: int) -> list[int]:
        return self._parts()[0].sections(road)

    def in_stretch(self, stretch: Stretch) -> list[Key]:
        return self._parts()[0].in_stretch(stretch)

    def size(self, road: int, section: int) -> int:
        return self._parts()[0].size(road, section)

    def clear_cache(self) -> None:
        super().clear_cache()
        for store in self._parts():
            store.clear_cache()

    def close(self) -> None:
        super().close()
        for store in self._parts():
            store.close()


class ColumnOverlay(DerivedStore):
    """All points of a store with one column replaced; it holds no points itself and joins two stores.

    points : SectionStore
    name : of the column
    folder : where its values go that are not kept in memory, so that others can read them; None for a temporary file without a name
    """

    def __init__(self, points: SectionStore, name: str, folder: Path | None = None):
        super().__init__(points.dtype, points)
        self._name = name
        # of as many points as the store keeps ready, not of as many bytes
        share = points.dtype[name].itemsize / points.dtype.itemsize
        self._column = SectionStore([(name, points.dtype[name])], points.section_length, points.memory_limit, folder=folder,
                                    cache_limit=int(share * STORE.cache_limit))

    @property
    def count(self) -> int:
        return self._column.count

    def put(self, road: int, section: int, records: np.ndarray) -> None:
        self._column.put(road, section, Columns({self._name: records}, self._column.dtype))

    def _parts(self) -> tuple[SectionStore, ...]:
        return self.points, self._column

    def shared(self) -> dict[str, Any]:
        """As `SectionStore.contents` of the column alone, and the folder that its values lie in then."""
        return dict(column=self._column.index(), folder=str(self._column.folder))

    def adopt_shared(self, column: StoreIndex, folder: str) -> None:
        self._column.adopt(column, Path(folder))

    def _read(self, road, section):
        column, points = self._column.section(road, section), self.points.section(road, section)

        def of(name):
            return column if name == self._name else points

        return Columns({}, self.dtype, len(points), lambda name: of(name)[name],
                       load_rows=lambda name, rows: of(name).column_rows(name, rows)), False

    def column(self, road: int, section: int, name: str, rows: np.ndarray) -> np.ndarray:
        return self.section(road, section).take(rows)[name]
