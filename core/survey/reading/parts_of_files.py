"""The phase of reading: ranges of points of the files, each decoded, placed and written to the store's folder by whoever is given it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...common.parallel import check_cancelled
from ...execution.phase import Recipe
from ..frame.road_frame import RoadFrame
from ..las.parallel_reader import ParallelCloudReader
from ..las.reader import CloudHeader
from ..las.samples import TimeSlots
from ..store.section_store import SectionStore
from ..store.spill_file import StoreIndex
from .blocks import BlockReader, BlockSummary, PointChoice

PART_POINTS = 1_200_000   # points of a part, about: a second or two of a worker's time, some 20 MB of its file


@dataclass(frozen=True)
class PartOfFiles:
    """What was found in a range of points.

    index : where those lie that were kept
    found : what all of them contribute to the knowledge of the cloud
    drops : {pass number: counts of its HeightHistogram}
    times, places : (N,) s and (N, 3) units of 0.1 mm of the sampled points
    """

    index: StoreIndex
    found: BlockSummary
    drops: dict[int, np.ndarray]
    times: np.ndarray
    places: np.ndarray


class PartsOfFiles:
    """Files whose points are read part by part into the folder of a store; several threads may do so.

    Parameters
    ----------
    files : CloudHeaders
    frame : RoadFrame
    store : SectionStore, of which dtype, section length, memory limit and folder count
    choice : PointChoice
    slots : TimeSlots of the points that are sampled
    drop : m from the trajectory down to the road, about
    ranges : (B, 3) number of a file, index of the first point and points of every block
    block : points of a block, about
    """

    def __init__(self, files: Sequence[CloudHeader], frame: RoadFrame, store: SectionStore, choice: PointChoice, slots: TimeSlots, drop: float,
                 ranges: np.ndarray, block: int):
        self.files, self.store, self.drop, self.ranges, self.block = files, store, drop, ranges, block
        self.reader = BlockReader(frame, choice, slots)
        self.clouds = ParallelCloudReader(choice.layers)
        self.ground = self.reader.ground(drop)

    def recipe(self, folder: Path) -> Recipe:
        """How other processes read the same."""
        store = self.store
        files = [replace(file, path=os.path.abspath(file.path), crs="") for file in self.files]
        return Recipe("survey.reading.parts_of_files:parts_of_files", dict(
            files=files, frame=self.reader.frame, columns=[list(column) for column in store.dtype.descr], section_length=store.section_length,
            memory_limit=store.memory_limit, folder=str(store.folder), choice=self.reader.choice, slots=self.reader.slots, drop=self.drop,
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
        other = "" if last == number else f" of {Path(self.files[last].path).name}"
        return f"{Path(self.files[number].path).name}, points {first + 1:,} to {begin + count:,}{other}"

    def size(self, item: tuple[int, int]) -> float:
        """Points of blocks."""
        return float(self.ranges[item[0]:item[1], 2].sum())


def parts_of_files(columns: list[list[str]], section_length: float, memory_limit: int, folder: str, **others: Any) -> PartsOfFiles:
    """What `PartsOfFiles.recipe` describes."""
    store = SectionStore([tuple(column) for column in columns], section_length, memory_limit, folder=Path(folder))
    return PartsOfFiles(store=store, **others)


def read_part(source: PartsOfFiles, item: tuple[int, int]) -> PartOfFiles:
    """The phase of reading: the points of some blocks that lie near the road.

    Parameters
    ----------
    source : PartsOfFiles
    item : (first, last + 1) numbers of blocks
    """
    chosen, found = source.reader.chosen(source.drop), BlockSummary()
    with source.store.part() as store:
        for number, first, count in source.ranges[item[0]:item[1]].tolist():
            for points in source.clouds.points(source.files[number], first, count, source.block):
                check_cancelled()
                for part in source.reader.read(points, found, source.ground, chosen, store):
                    store.add(part)
        index = store.index()
    sampled = list(zip(*chosen.sampled)) or [[np.empty(0)], [np.empty((0, 3), np.int32)]]
    return PartOfFiles(index, found, chosen.histogram.counts, *(np.concatenate(column) for column in sampled))


def join_parts(parts: list[PartOfFiles]) -> PartOfFiles:
    """One part of several that follow each other."""
    found = BlockSummary()
    drops: dict[int, np.ndarray] = {}
    for part in parts:
        found.join(part.found)
        drops = {number: counts + drops.get(number, 0) for number, counts in part.drops.items()}
    return PartOfFiles(StoreIndex.join([part.index for part in parts]), found, drops, *(np.concatenate([getattr(part, name) for part in parts])
                                                                                   for name in ("times", "places")))
