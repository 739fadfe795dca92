"""Reading point cloud files into the section store: by threads of this process, or part by part by whoever runs phases.

The height of the road is estimated from the first blocks, which are always read here.
"""

from __future__ import annotations

import os
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import TYPE_CHECKING, Any

import numpy as np

from ...common.parallel import POLL_INTERVAL
from ...common.progress import Progress
from ...execution.phase import Executor, Phase
from ..las.parallel_reader import ParallelCloudReader
from ..las.point_fields import ScannerCensus
from ..las.samples import TimeSlots
from .blocks import BlockReader, BlockSummary, ChosenPoints, HeightFilter, PointChoice
from .parts_of_files import PART_POINTS, PartsOfFiles, join_parts, read_part
from .sensor_height import DEFAULT_SENSOR_HEIGHT, estimate_sensor_height

if TYPE_CHECKING:
    from ..frame.road_frame import RoadFrame
    from ..las.reader import CloudHeader
    from ..store.columns import Columns
    from ..store.section_store import SectionStore

MAX_WAITING_POINTS = 4_000_000  # points held back at most until the height of the road is known
HEIGHT_SAMPLES = 5_000     # points on the own track from which the rough height is estimated
MAX_INGEST_THREADS = 4     # each decodes blocks with all cores (lazrs keeps the others waiting) and projects their points
BLOCKS_PER_THREAD = 3      # begun or queued per thread: keeps the threads busy while sections are written to the temporary file
MAX_SPLIT_SAMPLES = 1_500_000   # points sampled, by which two scanners are told apart


class SurveyReader:
    """Reads files into a section store and gathers statistics of the whole survey.

    Parameters
    ----------
    frame : RoadFrame
    store : SectionStore that the points are added to
    choice : PointChoice

    Attributes, complete after `read` or `read_in_parts`
    ----------------------------------------------------
    census : ScannerCensus
    darkest, brightest : lowest and highest intensity
    unplaced_time : number of points at a time of no pass
    excluded : number of points that are withheld or classified as noise
    heights : {pass number: metres from the trajectory down to the road}
    uneven : see `HeightHistogram.uneven`
    slots : TimeSlots of the points sampled, to tell scanners apart that no field distinguishes
    sampled : their (N,) times and (N, 3) units of 0.1 mm, in no order; without times none
    """

    def __init__(self, frame: RoadFrame, store: SectionStore, choice: PointChoice):
        self.frame, self.store, self.choice = frame, store, choice
        self.census, self.darkest, self.brightest, self.unplaced_time, self.excluded = ScannerCensus(), 65535, 0, 0, 0
        self.slots = TimeSlots(1)
        self._blocks: BlockReader
        # both are created once the rough height of the road is known; until then parts of blocks wait
        self._ground: HeightFilter | None = None
        self._chosen: ChosenPoints
        self._drop = DEFAULT_SENSOR_HEIGHT
        self._waiting: list[tuple[int, Columns]] = []
        self._samples: list[np.ndarray] = []

    @property
    def sampled(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """See above."""
        return self._chosen.sampled

    def read(self, files: list[CloudHeader], block: int, progress: Progress) -> None:
        """Read all files, `block` points at a time, in several threads of this process."""
        total, done = self._begin(files), 0
        threads = min(MAX_INGEST_THREADS, os.cpu_count() or 1)
        with ParallelCloudReader(self.choice.layers) as readers, ThreadPoolExecutor(threads) as pool:
            waiting: deque[Future] = deque()

            def take():
                nonlocal done
                while not wait([waiting[0]], POLL_INTERVAL).done:
                    progress.report(done / total)
                done += self._take(*waiting.popleft().result())
                progress.report(done / total)

            try:
                for load in readers.blocks(files, block):
                    waiting.append(pool.submit(self._read_block, load))
                    # the height of the road is estimated from the first blocks and filters the others
                    while len(waiting) > (BLOCKS_PER_THREAD * threads if self._ground else 0):
                        take()
                while waiting:
                    take()
            finally:
                for coming in waiting:
                    coming.cancel()
        self._end()

    def read_in_parts(self, files: list[CloudHeader], block: int, executor: Executor, progress: Progress) -> None:
        """Read all files, `block` points at a time: what follows the first blocks as a phase, into the folder of the store."""
        total, done = self._begin(files), 0
        with ParallelCloudReader(self.choice.layers) as readers:
            ranges = deque(readers.ranges(files, block))
            while ranges and self._ground is None:
                number, first, count = ranges.popleft()
                for points in readers.points(files[number], first, count, block):
                    done += self._take(*self._read_block(lambda points=points: points))
                    progress.report(done / total)
        self._settle()
        source = PartsOfFiles(files, self.frame, self.store, self.choice, self.slots, self._drop, np.array(ranges, np.int64).reshape(-1, 3), block)
        phase = Phase(read_part, source, (), source.place, source.size, join_parts)
        for part in executor.run(phase, source.items(PART_POINTS), progress.part(done / total, 1.0)):
            self._take_part(part)
        self._end()

    def _begin(self, files):
        """Prepare for the points of files; how many there are."""
        total = sum(file.count for file in files)
        self.slots = TimeSlots.for_points(total, MAX_SPLIT_SAMPLES)
        self._blocks = BlockReader(self.frame, self.choice, self.slots)
        return total

    def _end(self):
        self._settle()
        self.heights, self.uneven = self._chosen.histogram.heights(), self._chosen.histogram.uneven()

    def _read_block(self, load):
        """BlockSummary, points by road, whether these are filtered by height and partitioned, and the size of the block."""
        block, ground, found = load(), self._ground, BlockSummary()
        parts: Any = self._blocks.unfiltered(block, found) if ground is None else self._blocks.read(block, found, ground, self._chosen, self.store)
        return found, parts, ground is not None, len(block)

    def _take(self, found, parts, parted, count):
        """Take the result of a block, in the order of the files."""
        self._hear(found)
        if parted:
            for part in parts:
                self.store.add(part)
        elif self._ground is not None:
            self._choose(parts)
        else:
            self._waiting += parts
            self._samples += [drops[::7] for road, points in parts if road >= 0 for _, drops in self._blocks.tracks.drops(road, points)]
            if sum(map(len, self._samples)) > HEIGHT_SAMPLES or sum(len(points) for _, points in self._waiting) > MAX_WAITING_POINTS:
                self._settle()
        return count

    def _take_part(self, part):
        """Take a part that somebody else read, in the order of the files."""
        self._hear(part.found)
        self._chosen.histogram.join(part.drops)
        self._chosen.sampled.append((part.times, part.places))
        if self.store.folder is not None:
            self.store.adopt(part.index, self.store.folder)

    def _hear(self, found):
        self.darkest, self.brightest = min(self.darkest, found.darkest), max(self.brightest, found.brightest)
        self.unplaced_time += found.without_time
        self.excluded += found.excluded
        for name, times in found.scanners.items():
            self.census.take(name, times)

    def _settle(self):
        """Estimate the rough height of the road and store the points that waited for it."""
        if self._ground is not None:
            return
        drop = estimate_sensor_height(np.concatenate(self._samples)) if self._samples else None
        self._drop = DEFAULT_SENSOR_HEIGHT if drop is None else drop
        self._ground, self._chosen = self._blocks.ground(self._drop), self._blocks.chosen(self._drop)
        waiting, self._waiting, self._samples = self._waiting, [], []
        self._choose(waiting)

    def _choose(self, parts):
        """Filter by height the points that were projected before it was known, and store them."""
        for points in self._blocks.filtered(parts, self._ground, self._chosen, self.store):
            self.store.add(points)
