"""Reading point cloud files into the section store, part by part, by whoever runs phases.

The height of the road is estimated from the first blocks, which are looked at here.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..common.parallel import check_cancelled
from ..common.progress import Progress
from ..execution.phase import Executor, Phase, Recipe
from .blocks import BlockReader, BlockSummary, CountedCells, HeightFilter, PointChoice
from .estimation.interleaved import ScannerSplitter
from .frame.road_frame import RoadFrame
from .las.parallel_reader import ParallelCloudReader
from .las.point_fields import numbers_by_value
from .las.reader import CloudHeader
from .las.samples import TimeSlots
from .store.array_file import close_files
from .store.columns import Columns
from .store.records import COORDINATE_SCALE, road_of
from .store.section_store import SectionStore, StoreIndex, Stretch
from .weights import READING


@dataclass(frozen=True)
class PointsRead:
    """Points in a section store, and what they say of the whole survey."""

    store: SectionStore
    summary: BlockSummary   # of all points
    slots: TimeSlots   # of the points by which scanners are distinguished that no field distinguishes
    sampled: list[tuple[np.ndarray, np.ndarray]]   # their (N,) times and (N, 3) units of 0.1 mm, in no order; without times none
    heights: dict[int, float]   # {pass number: metres from the trajectory down to the road}
    moved: str   # moved, holes: as of `Coverage.warnings`
    holes: str


def read_points(files: list[CloudHeader], frame: RoadFrame, store: SectionStore, choice: PointChoice, block: int, executor: Executor,
                progress: Progress) -> PointsRead:
    """Read all files into a store as a phase, `block` points at a time, after a look at the first of them."""
    slots = TimeSlots.for_points(sum(file.count for file in files), READING.max_split_samples)
    blocks, summary, sampled = BlockReader(frame, choice, slots), BlockSummary(), []
    with ParallelCloudReader(choice.layers) as readers:
        ranges = list(readers.ranges(files, block))
        drop = blocks.rough_drop(points for number, *part in ranges for points in readers.points(files[number], *part, block))
    chosen, source = blocks.chosen(drop), _PartsOfFiles(files, store, blocks, drop, np.array(ranges, np.int64).reshape(-1, 3), block)
    phase = Phase(_read_part, source, (), source.place, _join_parts)
    points = block if store.folder is None else READING.part_points   # threads read block by block
    if store.folder is not None:
        store.folder.mkdir(exist_ok=True)
    for part in executor.run(phase, source.items(points), progress):
        summary.join(part.summary)
        chosen.histogram.join(part.drops)
        chosen.coverage.join(part.coverage)
        sampled.append((part.times, part.places))
        store.adopt(part.index, store.folder)
    return PointsRead(store, summary, slots, sampled, chosen.histogram.heights(), *chosen.coverage.warnings())


# The phase of reading: ranges of points of the files, each decoded, placed and written to the store's folder by whoever is given it.


@dataclass(frozen=True)
class _PartOfFiles:
    """What a range of points shows: where those lie that were kept, and what all contribute to the knowledge of the cloud."""

    index: StoreIndex
    summary: BlockSummary
    drops: dict[int, np.ndarray]   # {pass number: counts of its HeightHistogram}
    coverage: list[CountedCells]   # of its Coverage
    times: np.ndarray   # times, places: (N,) s and (N, 3) units of 0.1 mm of the sampled points
    places: np.ndarray


class _PartsOfFiles:
    """Files whose points are read part by part into the folder of a store; several threads may do so.

    store : of which dtype, section length and folder count; drop : m from the trajectory down to the road, about
    ranges : (B, 3) number of a file, index of the first point and points of every block, which has about `block` points
    """

    def __init__(self, files: Sequence[CloudHeader], store: SectionStore, reader: BlockReader, drop: float, ranges: np.ndarray, block: int):
        self.files, self.store, self.reader = files, store, reader
        self.ground = HeightFilter(reader.frame, drop, reader.choice.above_road)
        self.drop, self.ranges, self.block = drop, ranges, block
        self.clouds = ParallelCloudReader(reader.choice.layers)

    def recipe(self, folder: Path) -> Recipe:
        """How other processes read the same."""
        store = self.store
        files = [replace(file, path=os.path.abspath(file.path), crs="") for file in self.files]
        return Recipe("core.survey.survey_reader:_parts_of_files", dict(
            files=files, frame=self.reader.frame, columns=[list(column) for column in store.dtype.descr], section_length=store.section_length,
            folder=str(store.folder), choice=self.reader.choice, slots=self.reader.slots, drop=self.drop,
            ranges=self.ranges, block=self.block))

    def items(self, points: int) -> list[tuple[int, int]]:
        """(first, last + 1) numbers of blocks that have about so many points together."""
        ends = np.cumsum(self.ranges[:, 2])
        cuts = np.searchsorted(ends, np.arange(points, self.ranges[:, 2].sum(), points)) + 1
        bounds = np.unique(np.r_[0, cuts, len(ends)]).tolist()
        return list(zip(bounds[:-1], bounds[1:]))

    def place(self, item: tuple[int, int]) -> str:
        """What messages call blocks."""
        number, first, _ = self.ranges[item[0]].tolist()
        last, begin, count = self.ranges[item[1] - 1].tolist()
        last_file = "" if last == number else f" of {Path(self.files[last].path).name}"
        return f"{Path(self.files[number].path).name}, points {first + 1:,} to {begin + count:,}{last_file}"


def _parts_of_files(columns: list[list[str]], section_length: float, folder: str, frame: RoadFrame, choice: PointChoice, slots: TimeSlots,
                    drop: float, **others: Any) -> _PartsOfFiles:
    """What `_PartsOfFiles.recipe` describes."""
    store = SectionStore([tuple(column) for column in columns], section_length, Path(folder))
    reader = BlockReader(frame, choice, slots)
    return _PartsOfFiles(store=store, reader=reader, drop=drop, **others)


def _read_part(source: _PartsOfFiles, item: tuple[int, int]) -> _PartOfFiles:
    """The phase of reading: the points of some blocks, (first, last + 1) of their numbers, that lie near the road."""
    chosen, summary = source.reader.chosen(source.drop), BlockSummary()
    with source.store.part() as store:
        for number, first, count in source.ranges[item[0]:item[1]].tolist():
            for points in source.clouds.points(source.files[number], first, count, source.block):
                check_cancelled()
                for part in source.reader.read(points, summary, source.ground, chosen, store):
                    store.add(part)
    index = store.index()
    sampled = list(zip(*chosen.sampled)) or [[np.empty(0)], [np.empty((0, 3), np.int32)]]
    return _PartOfFiles(index, summary, chosen.histogram.counts, chosen.coverage.counted(), *(np.concatenate(column) for column in sampled))


def _join_parts(parts: list[_PartOfFiles]) -> _PartOfFiles:
    """One part of several that follow each other."""
    summary = BlockSummary()
    drops: dict[int, np.ndarray] = {}
    for part in parts:
        summary.join(part.summary)
        drops = {number: counts + drops.get(number, 0) for number, counts in part.drops.items()}
    coverage = [cells for part in parts for cells in part.coverage]
    return _PartOfFiles(StoreIndex.join([part.index for part in parts]), summary, drops, coverage,
                        *(np.concatenate([getattr(part, name) for part in parts]) for name in ("times", "places")))


# The phase that puts points in order: sections are read from where they were stored, finished, sorted, and written to a folder.

class UnorderedPoints:
    """Points of a store, which workers must see, to be put in order in a folder, finished with `finishing`, None where they are."""

    def __init__(self, store: SectionStore, finishing: Finishing | None, folder: str | Path):
        self.store, self.finishing, self.folder = store, finishing, Path(folder)
        store.finish = finishing

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the points."""
        store = Recipe("core.survey.store.section_store:opened_store", dict(folder=str(self.store.folder), **self.store.contents()))
        return Recipe("core.survey.survey_reader:UnorderedPoints", dict(store=store, finishing=self.finishing, folder=str(self.folder)))

    def put_in_order(self, executor: Executor, place: Callable[[int, float, float], str], progress: Progress) -> None:
        """Put all points in order; the store has them from the folder, from then on. place : names the stretch of a road between two stations (m)"""
        length = self.store.section_length
        phase = Phase(_order_sections, self, (), lambda item: place(item[0], item[1] * length, item[2] * length))
        parts = list(executor.run(phase, self.store.stretches(self.store.numbers()), progress))
        self.store.take_over(StoreIndex.join(parts), self.folder)


def _order_sections(source: UnorderedPoints, item: Stretch) -> StoreIndex:
    """The phase: the points of some sections, in order, in a file of the folder."""
    try:
        with SectionStore(source.store.dtype, source.store.section_length, source.folder).part() as part:
            return source.store.written_in_order(source.store.in_stretch(item), part)
    finally:
        # they are removed when all is in order, which Windows refuses for files that are open
        close_files()


# What is done with the points of a section before they are put in order: scanners are numbered, and those far above or below the road go.


@dataclass(frozen=True)
class Finishing:
    """Finishes the points of sections: numbers their scanners from 0, and tells those near the height of the road.

    scanner_field, scanners : LAS field that identifies the scanners, None if there is one, and its values, see `ScannerCensus.choose`
    """

    frame: RoadFrame
    sensor_height: dict[int, float]   # {pass number: metres from the trajectory down to the road}
    scanner_field: str | None
    scanners: list[Any]
    splitter: ScannerSplitter | None   # distinguishes scanners that no field distinguishes; None where there is no need
    above_road: float   # metres above the road up to which points are kept

    def __call__(self, road: int, records: Columns) -> np.ndarray | None:
        """Number the scanners of (N,) records of a section, N > 0, and tell which lie near the height of the road: (N,) bool, None for all."""
        if self.splitter is not None:
            records["scanner"] = self.splitter.numbers(records["time"], np.stack([records[name] for name in "xyz"], axis=1) * COORDINATE_SCALE)
        elif self.scanner_field is None:
            records["scanner"] = 0
        else:
            numbers = records["source" if self.scanner_field == "point_source_id" else "scanner"]
            records["scanner"] = numbers_by_value(self.scanners, int(numbers.max()) + 1).take(numbers)
        # only records near the limits are compared with the height at their own station
        z = records["z"]
        below, above = (READING.kept_below_road, self.above_road) if road >= 0 else (READING.level_height, READING.level_height)
        # heights of the road at fixed stations, of which `first` is the number of the first
        first, last = (int(np.floor(end * COORDINATE_SCALE / READING.road_height_step)) for end in (records["s"].min(), records["s"].max()))
        nodes = self.frame.track_height(road_of(road), np.arange(first, last + 2) * READING.road_height_step, self.sensor_height)
        doubtful = np.flatnonzero((z < (nodes.max() - below) / COORDINATE_SCALE + 1)
                                  | (z > (nodes.min() + above) / COORDINATE_SCALE - 1))
        node = records["s"][doubtful] * COORDINATE_SCALE / READING.road_height_step - first
        k = node.astype(np.int64)
        h = z[doubtful] * COORDINATE_SCALE - (nodes[k] + (node - k) * (nodes[k + 1] - nodes[k]))
        near = np.ones(len(records), bool)
        near[doubtful] = (h > -below) & (h < above)
        return None if near[doubtful].all() else near
