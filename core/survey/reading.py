"""Point cloud files into the section store, block by block in several threads."""

import os
from collections import deque
from concurrent.futures import ThreadPoolExecutor, wait

import numpy as np

from ..parallel import PATIENCE
from .block_points import BlockPoints, BlockReading, Ground
from .cloud_blocks import CloudReaders
from .kept_arrays import KeptArrays
from .scanners import ScannerCensus
from .sensor_height import DEFAULT_HEIGHT, HeightTally, Tracks, first_estimate

LAYERS = ("z", "intensity", "point_source_id", "gps_time", "flags")  # what is decoded of a LAZ file
WAITING = 4_000_000    # points kept back at most until the height of the road is known
SAMPLES = 5_000        # points on the track that tell it
THREADS = 4            # at most: each has blocks decoded, by all cores (lazrs keeps the others waiting), and places their points
QUEUE = 3              # blocks for each of them that are begun or wait: what keeps them busy while sections are put into the temporary file


class SurveyReader:
    """Reads files into a store and learns on the way what must be known of the whole survey.

    Attributes, complete after `read`
    ---------------------------------
    census : ScannerCensus
    darkest, brightest : the lowest and the highest intensity
    unplaced_time : points whose time no pass has
    heights : {pass number: metres from the trajectory down to the road}
    """

    def __init__(self, frame, store, corridor, has_time, week_ends=False):
        self.frame, self.store = frame, store
        self.census, self.darkest, self.brightest, self.unplaced_time = ScannerCensus(), 65535, 0, 0
        self.tracks = Tracks(frame)
        self._blocks = BlockReading(frame, corridor, has_time, week_ends)
        self._ground = None        # made, as the tally of heights, when the rough height of the road is known
        self._tally = None
        self._waiting, self._samples = [], []  # parts of blocks until it is known

    def read(self, files, block, progress):
        """Read all files, `block` points at a time."""
        total, done = sum(file.count for file in files), 0
        threads = min(THREADS, os.cpu_count() or 1)
        with CloudReaders(LAYERS) as readers, ThreadPoolExecutor(threads) as pool:
            waiting = deque()

            def take():
                nonlocal done
                while not wait([waiting[0]], PATIENCE).done:
                    progress.at(done / total)
                done += self._take(*waiting.popleft().result())
                progress.at(done / total)

            try:
                for load in readers.blocks(files, block):
                    waiting.append(pool.submit(self._read_block, load))
                    # the first blocks tell the road's height, which the others are chosen by
                    while len(waiting) > (QUEUE * threads if self._ground else 0):
                        take()
                while waiting:
                    take()
            finally:
                for coming in waiting:
                    coming.cancel()
        self._settle()
        self.heights, self.uneven = self._tally.heights(), self._tally.uneven()

    def _read_block(self, load):
        """What the block says of the whole cloud, its points, whether these were chosen by height and parted, and their number in the block."""
        block, ground, found, parts = load(), self._ground, BlockPoints(), []
        for road, points, own in self._blocks.read(block, found, ground):
            parts.append((road, _copied(points, own)) if ground is None else self._parted(road, points, own))
        return found, parts, ground is not None, len(block)

    def _parted(self, road, points, own):
        """Points by section, for the store; those on the track are counted."""
        for number, drops in self.tracks.drops(road, points, own):
            self._tally.add(number, drops)
        return self.store.parted(road, points, own)

    def _take(self, found, parts, parted, count):
        """One block, in the order of the files."""
        self.darkest, self.brightest = min(self.darkest, found.darkest), max(self.brightest, found.brightest)
        self.unplaced_time += found.without_time
        for name, times in found.scanners.items():
            self.census.take(name, times)
        if parted:
            for part in parts:
                self.store.add(part)
        elif self._ground is not None:
            self._choose(parts)
        else:
            self._waiting += parts
            self._samples += [drops[::7] for road, points in parts for _, drops in self.tracks.drops(road, points)]
            if sum(map(len, self._samples)) > SAMPLES or sum(len(points) for _, points in self._waiting) > WAITING:
                self._settle()
        return count

    def _settle(self):
        """Settle the rough height of the road and store what waited for it."""
        if self._ground is not None:
            return
        drop = first_estimate(np.concatenate(self._samples)) if self._samples else None
        drop = DEFAULT_HEIGHT if drop is None else drop
        self._tally = HeightTally([p.number for p in self.frame.passes], drop)
        self._ground = Ground(self.frame, drop)
        waiting, self._waiting, self._samples = self._waiting, [], []
        self._choose(waiting)

    def _choose(self, parts):
        """Choose by height what was placed before that was known, and store it."""
        for road, points in parts:
            kept = KeptArrays().of(len(points))
            near = self._ground.near(road, points["s"], points["z"], kept)
            if near.any():
                self.store.add(self._parted(road, points, near))


def _copied(points, own):
    """Points that are meant (None for all) as Columns that stay."""
    return points.copy() if own is None else points.take(own).whole()
