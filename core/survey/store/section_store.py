"""Points by section of road, in files that every thread, process and machine maps into memory."""

from __future__ import annotations

import hashlib
import math
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple
from uuid import uuid4

import numpy as np

from ...common.arrays import RADIX_BITS, above_least, bucket_argsort, order_by
from ...common.parallel import ScratchBuffers, check_cancelled, column_buffers
from ...execution.phase import THREADS, Executor, Recipe
from ...execution.weights import EXECUTION
from ..weights import STORE
from .array_file import ArrayFile, close_files, new_file, opened
from .columns import Columns
from .records import COORDINATE_SCALE, Points

LEAST_UNIT, MOST_UNIT = -2**31, 2**31 - 1   # of 0.1 mm, in which stations are kept
STRETCH_POINTS = 1_200_000   # points of a stretch that a worker process works on, at most: a second of its time

Key = tuple[int, int]   # numbers of a road and of a section of it
Stretch = tuple[int, int, int]   # number of a road, first and last + 1 number of its sections


@dataclass(frozen=True)
class PartitionedPoints:
    """Points of one road, section by section: those of section `first + k` end before row `ends[k]` of the records."""

    road: int
    records: Columns
    first: int
    ends: list[int]


class _Part(NamedTuple):
    """Points of a section in a file: rows `first` to `first + size` of the `rows` that lie there column by column from the byte `place` on.

    content : hash of them, 0 where that is not known
    """

    file: ArrayFile | Path
    place: int
    rows: int
    first: int
    size: int
    content: int = 0


@dataclass
class _Section:
    """The points of a section in their parts: one part, or none, once they are in order."""

    in_order: bool
    parts: list[_Part]


@dataclass(frozen=True)
class StoreIndex:
    """Where the points of a store lie: all that others need to know of them.

    parts : (K, 9) int64: road, section, number of the file, first byte, rows there, first row, rows and content of the part, whether it is in
        canonical order
    """

    files: tuple[Any, ...]   # names of files of one folder, or the open ArrayFile of a store without a folder
    parts: np.ndarray

    @classmethod
    def of(cls, sections: Iterable[tuple[Key, _Section]]) -> StoreIndex:
        files: dict[Any, int] = {}
        rows = [(*key, files.setdefault(part.file.name if isinstance(part.file, Path) else part.file, len(files)), *part[1:], section.in_order)
                for key, section in sections for part in section.parts]
        return cls(tuple(files), np.array(rows, np.int64).reshape(-1, 9))

    @classmethod
    def join(cls, indexes: Sequence[StoreIndex]) -> StoreIndex:
        before = np.cumsum([0, *(len(index.files) for index in indexes)])
        parts = [index.parts + np.array([0, 0, shift, 0, 0, 0, 0, 0, 0]) for index, shift in zip(indexes, before)]
        return cls(tuple(name for index in indexes for name in index.files), np.concatenate([np.empty((0, 9), np.int64), *parts]))


class SectionStore:
    """Points of all roads, appended in any order, read back by station.

    A section is a fixed interval of station of one road, counted from 0. What is read back is sorted by station, offset, height and time, so it does
    not depend on the order of appending, and a window is a range of rows. A section is sorted once, when it is first read.

    dtype : structured dtype of the points, with at least the columns of SURVEY_POINT where points are appended
    section_length : metres
    folder : where the points go, so that others can read them; None for temporary files without a name
    constants : {name: value} of the columns that have one value for all points
    base : another store of the same points, which has the columns that are not `stored`
    """

    def __init__(self, dtype: Any, section_length: float = STORE.section_length, folder: Path | None = None,
                 constants: Mapping[str, Any] | None = None, base: SectionStore | None = None, stored: Sequence[str] = ()):
        self.dtype, self.section_length, self.folder = np.dtype(dtype), section_length, folder
        self.constants, self.base = dict(constants or {}), base
        # the widest numbers come first, so that each begins at a multiple of its own bytes
        names = [name for name in stored or self.dtype.names or () if name not in self.constants]
        self._stored = sorted(names, key=lambda name: -self.dtype[name].itemsize)
        sizes = [self.dtype[name].itemsize for name in self._stored]
        self._row_bytes, self._before = sum(sizes), dict(zip(self._stored, np.cumsum([0, *sizes]).tolist()))
        # called once for each section before it is sorted: (road, Columns in no order, which it may change) -> mask of points to keep, None for all
        self.finish: Callable[[int, Columns], np.ndarray | None] | None = None
        self.at_close: Callable[[], None] | None = None   # called once the points are released
        self._sections: dict[Key, _Section] = {}
        self._files: dict[bool, ArrayFile] = {}   # whether its points are in order: the file that points are written to
        self._buffers, self._lock = ScratchBuffers(), threading.Lock()
        self._section_locks = [threading.Lock() for _ in range(STORE.section_locks)]   # sections are read by several threads
        self._count = 0

    @property
    def count(self) -> int:
        """Points that have a station."""
        return self._count

    def append(self, road: int, records: np.ndarray | Columns) -> None:
        """Add (N,) records of one road; each goes to the section of its station."""
        if len(records):
            self.add(self.partition(road, records), True)

    def partition(self, road: int, records: np.ndarray | Columns, mask: np.ndarray | None = None) -> PartitionedPoints:
        """Partition points of a road, N > 0, by section: the part of `append` that any thread may do. `mask` : (N,) bool, the points to take."""
        strip = np.multiply(records["s"], COORDINATE_SCALE, out=self._buffers.of(len(records))("strip"))
        strip /= self.section_length
        low, high = int(np.floor(strip.min())), int(np.floor(strip.max()))
        strip *= STORE.strips_per_section
        np.floor(strip, out=strip)
        strip -= STORE.strips_per_section * low
        order, ends = bucket_argsort(strip, STORE.strips_per_section * (high + 1 - low), mask)
        columns = Columns.from_records(records).take(order)
        return PartitionedPoints(int(road), columns, low, ends[STORE.strips_per_section - 1::STORE.strips_per_section].tolist())

    def add(self, points: PartitionedPoints, hashed: bool = False) -> None:
        """Add what `partition` gave; `hashed` : whether `state` is to tell the points by what they are."""
        rows = len(points.records)
        hashes = [hashlib.sha256() if hashed else None for _ in points.ends]
        file, place = self._written(False, rows, self._columns_of(points.records, points.ends, hashes))
        for k, (first, end, sha) in enumerate(zip([0, *points.ends], points.ends, hashes)):
            if end > first:
                self._add_part((points.road, points.first + k), _Part(file, place, rows, first, end - first, _number(sha)), False)

    def put(self, road: int, section: int, records: Any) -> None:
        """Set the stored columns of the (N,) points of one section, in canonical order; no more points are added to it."""
        if len(records):
            rows, sha = len(records), hashlib.sha256()
            file, place = self._written(True, rows, self._columns_of(records, [rows], [sha]))
            self._add_part((int(road), int(section)), _Part(file, place, rows, 0, rows, _number(sha)), True)

    def _columns_of(self, records, ends, hashes):
        """The stored columns, which go into the hashes of the parts that end at these rows."""
        for name in self._stored:
            column = records[name]
            for first, end, sha in zip([0, *ends], ends, hashes):
                if sha is not None:
                    sha.update(name.encode())
                    sha.update(np.ascontiguousarray(column[first:end]).data)
            yield column

    def _written(self, in_order, rows, columns):
        """The file and the first byte at which columns are written."""
        with self._lock:
            if in_order not in self._files:
                self._files[in_order] = ArrayFile(self.folder and self.folder / f"store-{uuid4().hex}.bin")
            file = self._files[in_order]
        return file if file.path is None else file.path, file.put(columns, rows * self._row_bytes)

    def _add_part(self, key, part, in_order):
        section = self._sections.setdefault(key, _Section(in_order, []))
        section.in_order = in_order and not section.parts
        section.parts.append(part)
        self._count += part.size if key[0] >= 0 else 0

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
        return sum(part.size for part in self._sections[road, section].parts)

    def stretches(self, numbers: Sequence[int] | None = None) -> list[Stretch]:
        """Stretches of road with STRETCH_POINTS at most, or fewer where there would be few stretches: of all roads, or of some `numbers`.

        A road is halved, and its halves again, at section numbers that depend on no points, so that others in one place change no stretch elsewhere.
        """
        stretches: list[Stretch] = []
        most = min(STRETCH_POINTS, 1 << (self._count // EXECUTION.least_tasks).bit_length())
        for road in self.roads() if numbers is None else numbers:
            sections = np.array(self.sections(road))
            sizes, bits = np.array([self.size(road, number) for number in sections.tolist()]), np.zeros(len(sections), int)
            for more in range(1, int(np.ptp(sections)).bit_length() + 2):
                group = (sections >> more) - (sections[0] >> more)
                bits[np.bincount(group, sizes)[group] <= most] = more
            begins = np.flatnonzero((np.diff(bits) != 0) | (np.diff(sections >> bits) != 0)) + 1
            bounds = [*sections[np.r_[0, begins]].tolist(), int(sections[-1]) + 1]
            stretches += [(road, first, end) for first, end in zip(bounds[:-1], bounds[1:])]
        return stretches

    def in_stretch(self, stretch: Stretch) -> list[Key]:
        """(road, number) of the sections of a stretch that have points."""
        road, first, end = stretch
        return [(road, number) for number in range(first, end) if (road, number) in self._sections]

    def state(self, stretch: Stretch) -> list[Any]:
        """Plain values that differ where the points of a stretch are others: their hash, or in which files they lie, and where there."""
        parts = [[*key, *([part.content] if part.content else [part.file.name, part.place, part.first]), part.size]
                 for key in self.in_stretch(stretch) for part in self._sections[key].parts]
        return parts + (self.base.state(stretch) if self.base is not None else [])

    def section(self, road: int, section: int) -> Columns:
        """The Columns of one section in canonical order, read-only; empty where there are no points."""
        check_cancelled()
        part = self._part((road, section))
        if part is None:
            return Columns.concatenate([], self.dtype)
        return Columns({}, self.dtype, part.size, partial(self._column, (road, section))).read_only()

    def _part(self, key):
        """The points of a section, put in order if they were not; None where there are none."""
        section = self._sections.get(key)
        if section is not None and not section.in_order:
            # the file with points in no order goes when its last section was put in order
            self._files.pop(False, None)
            with self._section_locks[hash(key) % STORE.section_locks]:
                if not section.in_order:
                    section.parts, section.in_order = self._in_order(key, self), True
        return section.parts[0] if section is not None and section.parts else None

    def _in_order(self, key, target):
        """[_Part] the points of a section, finished and in canonical order, as they were written to another store, or to this one."""
        section = self._sections[key]
        count = sum(part.size for part in section.parts)
        buffer = column_buffers.of(count)
        records = Columns({}, self.dtype, count, lambda name: self._gathered(section.parts, name, buffer(name, self.dtype[name])))
        # of what is in order already, all is kept
        order = slice(None) if section.in_order else canonical_order(records, self.finish and self.finish(key[0], records))
        rows = count if section.in_order else len(order)
        if not rows:
            return []
        file, place = target._written(True, rows, (records[name][order] if section.in_order else np.take(
            records[name], order, out=buffer("moved", self.dtype[name])[:rows], mode="clip") for name in self._stored))
        return [_Part(file, place, rows, 0, rows)]

    def _gathered(self, parts, name, out):
        """Fill a column with the values of all parts."""
        first = 0
        for part in parts:
            out[first:first + part.size] = self._values(part, name)
            first += part.size
        return out

    def _values(self, part, name):
        """(N,) read-only values of a stored column."""
        file = opened(part.file) if isinstance(part.file, Path) else part.file
        return file.get(part.place + part.rows * self._before[name] + part.first * self.dtype[name].itemsize, part.size, self.dtype[name])

    def _column(self, key, name):
        """(N,) read-only column of a section in order."""
        part = self._part(key)
        if name in self.constants:
            return np.broadcast_to(np.array(self.constants[name], self.dtype[name]), part.size)
        return self._values(part, name) if name in self._before else self.base._column(key, name)

    def first_unit(self, section: int) -> int:
        """The least station, in units of 0.1 mm, that lies in a section."""
        return _least(int(round(section * self.section_length / COORDINATE_SCALE)),
                      lambda unit: math.floor(unit * COORDINATE_SCALE / self.section_length) >= section)

    def window(self, road: int, start: float, end: float) -> Points:
        """Points of a road with start <= station < end (metres), in canonical order."""
        first, last = math.floor(start / self.section_length), math.floor(np.nextafter(end, -np.inf) / self.section_length)
        parts = []
        for number in range(first, last + 1):
            records = self.section(road, number)
            # The stations of a section that lies inside the window need not be searched.
            low, high = self.first_unit(number) * COORDINATE_SCALE, (self.first_unit(number + 1) - 1) * COORDINATE_SCALE
            if len(records) and (low < start or high >= end):
                a, b = np.searchsorted(records["s"], np.array([_unit_at(start), _unit_at(end)], records["s"].dtype)).tolist()
                records = records[a:b]
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

    def with_column(self, name: str, folder: Path | None = None) -> SectionStore:
        """A store of the same points in which one column is put anew, section by section; it shares all other columns with this one."""
        constants = {constant: value for constant, value in self.constants.items() if constant != name}
        return SectionStore(self.dtype, self.section_length, folder, constants, self, (name,))

    @contextmanager
    def part(self) -> Iterator[SectionStore]:
        """A store like this one, without points, to be filled and told by its `index`; of a folder, in one new file that appears at the end."""
        part = SectionStore(self.dtype, self.section_length, self.folder, self.constants, self.base, self._stored)
        if self.folder is None:
            part._files, part._lock = self._files, self._lock
            yield part
            return
        with new_file(self.folder) as (file, name):
            file.path = self.folder / name   # by which it will be known
            part._files = dict.fromkeys((False, True), file)
            yield part

    def paths(self) -> list[Path]:
        """The files with names in which the points lie."""
        return sorted({part.file for section in self._sections.values() for part in section.parts if isinstance(part.file, Path)})

    def index(self) -> StoreIndex:
        """Where the points lie."""
        return StoreIndex.of(sorted(self._sections.items()))

    def written_in_order(self, keys: Sequence[Key], part: SectionStore) -> StoreIndex:
        """Write some sections in canonical order to a `part` of a store; they stay here as they are."""
        for key in keys:
            check_cancelled()
            for written in self._in_order(key, part):
                part._add_part(key, written, True)
        return part.index()

    def contents(self) -> dict[str, Any]:
        """What another process needs to open this store by `opened_store`, whose points lie in its folder; plain values."""
        return dict(columns=[list(column) for column in self.dtype.descr], section_length=self.section_length, points=self.index(),
                    constants=self.constants, stored=self._stored, base=self.base and dict(self.base.contents(), folder=str(self.base.folder)))

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open this store, whose points lie in its folder."""
        return Recipe("core.survey.store.section_store:opened_store", dict(folder=str(self.folder), **self.contents()))

    def readers(self, executor: Executor) -> Executor:
        """Those of an executor, if they can read the points; else threads of this process."""
        return executor if executor.folder is None or self.folder is not None else THREADS

    def adopt(self, index: StoreIndex, folder: Path | None = None) -> None:
        """Add the points that others wrote, to files of a folder where these have names."""
        files = [folder / file if folder is not None and isinstance(file, str) else file for file in index.files]
        for road, section, number, *part, in_order in index.parts.tolist():
            self._add_part((road, section), _Part(files[number], *part), bool(in_order))

    def take_over(self, index: StoreIndex, folder: Path | None) -> None:
        """Keep the points that others wrote in order to files of a folder, from now on, instead of those that are here."""
        count = self._count
        self._release()
        self.folder = folder
        self.adopt(index, folder)
        self._count = count

    def close(self) -> None:
        self._release()
        if self.base is not None:
            self.base.close()
        close_files()
        if self.at_close is not None:
            self.at_close()

    def _release(self):
        self._sections.clear()
        for file in self._files.values():
            file.close()
        self._files.clear()


def opened_store(folder: str | Path, columns: list[list[str]], section_length: float, points: StoreIndex, constants: dict[str, Any],
                 stored: Sequence[str], base: dict[str, Any] | None) -> SectionStore:
    """The store of `SectionStore.contents`, whose points lie in a folder."""
    store = SectionStore([tuple(column) for column in columns], section_length, Path(folder), constants, opened_store(**base) if base else None,
                         stored)
    store.adopt(points, Path(folder))
    return store


def _unit_at(station):
    """The least whole number of units of 0.1 mm whose station is not less than some metres."""
    unit = _least(int(np.ceil(station / COORDINATE_SCALE)), lambda unit: unit * COORDINATE_SCALE >= station)
    return min(max(unit, LEAST_UNIT), MOST_UNIT)


def _number(sha):
    """A hash as the content of a _Part, 0 where there is none."""
    return 0 if sha is None else int.from_bytes(sha.digest()[:8], "little", signed=True)


def _least(unit, enough):
    """The least whole number, near a given one, from which on it is enough."""
    while enough(unit - 1):
        unit -= 1
    while not enough(unit):
        unit += 1
    return unit


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
            tied_rows = records[order[places]]
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
