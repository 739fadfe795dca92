"""A few points from several places of every file, by which it shows how coordinates and intensities were written."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import gcd

import numpy as np
import shapely

from ...common.errors import RoadExtractionError
from ...execution.phase import THREADS, Executor, NoSource, Phase
from ..weights import LAS
from .parallel_reader import ParallelCloudReader
from .reader import CloudHeader, read_blocks, states_of


@dataclass(frozen=True)
class FileSample:
    """N points of a file: (N, 3) int64 places as stored, (N, 2) m on the map, (N,) uint16 intensities, (N,) extra fields with one number a point.

    times : (T,) s, finite gps_time of a few points, the last ones among them; none where points have no time
    """

    file: CloudHeader
    times: np.ndarray
    raw: np.ndarray
    places: np.ndarray
    intensity: np.ndarray
    fields: dict[str, np.ndarray]

    @property
    def steps(self) -> np.ndarray:
        """(3,) m between neighbouring values of x, y and z; 0 where they are too few to tell."""
        return np.array([_step(values) for values in self.raw.T]) * np.abs(self.file.scales)


def sample_files(files: Sequence[CloudHeader], executor: Executor = THREADS) -> list[FileSample]:
    """Samples of the files that have points, which the executor looks at; RoadExtractionError where one cannot be read."""
    filled = [file for file in files if file.count]
    phase = Phase(_sample_of_file, NoSource(), (), lambda file: file.path, state=lambda file: states_of([file]))
    seen = executor.run(phase, [replace(file, path=os.path.abspath(file.path), crs="") for file in filled])
    return [FileSample(file, *sample) for file, sample in zip(filled, seen)]


def _sample_of_file(source: NoSource, file: CloudHeader) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, np.ndarray]]:
    """The phase that looks at a file: all but the first of FileSample."""
    reader = ParallelCloudReader(("z", "intensity", "all_extra_bytes"))
    rows = np.linspace(0, file.count - 1, LAS.sampled_places).astype(int).tolist()
    starts = sorted({reader.chunk_start(file, row) for row in rows})
    parts = [_sample(next(reader.following(file, start, LAS.points_per_sample))) for start in starts]
    raw, places, intensity = (np.concatenate([part[k] for part in parts]) for k in range(3))
    return times_of(file), raw, places, intensity, {name: np.concatenate([part[3][name] for part in parts]) for name in parts[0][3]}


def times_of(file: CloudHeader) -> np.ndarray:
    """As of FileSample, of a file that has points."""
    times = ParallelCloudReader(("gps_time",)).times(file) if file.has_time else ()
    return np.concatenate([np.empty(0), *(time[np.isfinite(time)] for time in times)])


def _sample(points):
    """Places as stored and on the map, intensities and extra fields of points, which the next to be read overwrite."""
    one_number = [info.name for info in points.point_format.extra_dimensions if info.num_elements == 1]
    return (np.stack([np.array(points.array[name], np.int64) for name in "XYZ"], axis=1), np.stack([points["x"], points["y"]], axis=1),
            np.array(points.array["intensity"]), {name: np.array(points[name], float) for name in one_number})


def _step(values):
    """Between neighbouring ones of (N,) integers."""
    gaps = np.diff(np.unique(values))
    sufficient = len(values) >= LAS.values_for_step and len(gaps) >= LAS.gaps_for_step
    return float(np.quantile(gaps, LAS.share_of_other_gaps, method="lower")) if sufficient else 0.0


def coarse_coordinates(samples: Sequence[FileSample]) -> tuple[str, float]:
    """What to tell of coordinates in coarse steps, as their numbers hold no finer ones, and what that leaves open: m across, one sigma.

    Edges lie between two points, each of which may be off by half of a step, as may all others of its line: the sum of two uniform errors.
    """
    for sample in samples:
        steps, scales = sample.steps, np.abs(sample.file.scales)
        ends = np.array([sample.file.minimum, sample.file.maximum], np.float32)
        short = (np.abs(steps - np.abs(np.spacing(ends))) <= scales).any(axis=0)
        coarse = steps > LAS.coarse_coordinates
        clear = coarse & (short | np.isclose(steps, scales, rtol=0.01))
        is_raster = bool((coarse & ~clear).any())   # neither explains its steps, as after thinning by voxels
        if not coarse.any() or is_raster and not (coarse[2] and _even(sample.raw[:, 2], steps[2] / scales[2])):
            continue
        k = int(np.argmax(np.where(coarse, steps, 0.0)))
        listed = ", ".join(f"{steps[axis]:.3g} m in {name}" for axis, name in enumerate("xyz") if coarse[axis])
        if is_raster:
            cause = "they were rounded, or points were thinned and moved to a raster"
        elif short[k]:
            cause = f"at {abs(float(ends[0, k])):,.0f} m that is the step of 32-bit numbers, in which some program kept them"
        else:
            cause = f"that is the scale in the header of the file ({scales[k]:g} m)"
        return (f"The coordinates of {sample.file.path} lie in steps of {listed}: {cause}. Export them with 64 bits and a scale of 0.001 m.",
                float(np.where(coarse, steps, 0.0)[:2].max() / np.sqrt(6.0)))
    return "", 0.0


def _even(values, step):
    """Whether nearly all gaps between (N,) integers are multiples of a step."""
    gaps = np.diff(np.unique(values)) / step
    return (np.abs(gaps - np.rint(gaps)) * step > 1.0).mean() < LAS.share_of_other_gaps


# An even sample of a survey's points that keeps neighbours together, whatever the order of the files.


@dataclass(frozen=True)
class TimeSlots:
    """Every `stride`-th slot of time: points of one slot follow each other along a scan line, and slots pass through all parts of a turn."""

    stride: int

    @classmethod
    def for_points(cls, count: int, most: int) -> TimeSlots:
        """The slots of which `count` points fill at most `most`."""
        stride = max(-(-count // most), 1)
        # mirrors turn in 5, 10 or 20 ms: a stride with a common factor would see the same part of every turn
        while stride > 1 and gcd(stride, 10) > 1:
            stride += 1
        return cls(stride)

    def kept(self, time: np.ndarray) -> np.ndarray:
        """(N,) bool of the points in the sample, by (N,) times in seconds."""
        if self.stride == 1:
            return np.ones(len(time), bool)
        slot = np.asarray(time, float) / LAS.slot
        np.floor(slot, out=slot)
        # the nearest multiple of the stride, exact for whole numbers: a remainder takes ten times as long
        nearest = slot * (1.0 / self.stride)
        np.rint(nearest, out=nearest)
        nearest *= self.stride
        with np.errstate(invalid="ignore"):   # infinite times
            nearest -= slot
        return nearest == 0


# Copies of files and of points among the files of a survey: they would count twice.


def without_copies(files: list[CloudHeader], warn: Callable[[str], None]) -> list[CloudHeader]:
    """The files without those that hold the same points as an earlier one, such as a COPC beside the LAZ it was made from.

    Only files with the same number of points and the same bounds are read; `warn` is told of every copy.
    """
    first: dict[tuple, CloudHeader] = {}
    kept, content = [], cache(_content)
    for file in files:
        alike = (file.count, _whole(file.minimum), _whole(file.maximum))
        earlier = first.setdefault(alike, file)
        if earlier is not file and file.count and content(earlier) == content(file):
            warn(f"{file.path} holds the same points as {earlier.path} and is left out, so that none counts twice.")
        else:
            kept.append(file)
    return kept


def may_overlap(files: Sequence[CloudHeader]) -> bool:
    """Whether the bounds of any two files have an area in common."""
    boxes = shapely.box(*np.array([(*file.minimum[:2], *file.maximum[:2]) for file in files if file.count], float).reshape(-1, 4).T)
    first, second = shapely.STRtree(boxes).query(boxes, predicate="intersects")
    once = first < second
    return bool((shapely.area(shapely.intersection(boxes[first[once]], boxes[second[once]])) > 0.0).any())


def distinct_rows(time: np.ndarray, place: np.ndarray) -> np.ndarray:
    """(M,) ascending indices of the points that are no copies of earlier ones, by (N,) times and (N, 3) places."""
    # copies share a hash, which few others do: Knuth's multiplicative one, by 2**64 over the golden ratio; beyond 64 bits numbers start again from 0
    factor, shift = np.uint64(0x9E3779B97F4A7C15), np.uint64(29)
    mixed = (np.asarray(time, float) + 0.0).view(np.uint64)
    for axis in place.T:
        mixed = (mixed ^ (mixed >> shift)) * factor + axis.astype(np.int64).view(np.uint64)
    ordered = np.sort(mixed)
    rows = np.flatnonzero(np.isin(mixed, ordered[1:][ordered[1:] == ordered[:-1]]))
    rows = rows[np.lexsort((*place[rows].T, time[rows]))]
    repeated = (time[rows[1:]] == time[rows[:-1]]) & (place[rows[1:]] == place[rows[:-1]]).all(axis=1)
    return np.delete(np.arange(len(time)), rows[1:][repeated])


def check_measured_once(time: np.ndarray, place: np.ndarray) -> None:
    """Raise RoadExtractionError where points were given twice, a little apart: one drive, exported in two datums.

    Beams that are measured at one time lie apart by all kinds of distances, copies of one point always by the same.

    time : (N,) seconds of points, each given once; place : (N, 3) m
    """
    order = np.argsort(time, kind="stable")
    ordered = time[order]
    for later in (1, 2):   # of two scanners that measure at the same times, the copy of a point comes after the other's
        pairs = np.flatnonzero(ordered[later:] == ordered[:-later])
        if len(pairs) < LAS.least_doubled * len(time):
            return
        apart = place[order[pairs + later]] - place[order[pairs]]
        apart *= np.where(apart[:, [int(np.abs(apart).sum(axis=0).argmax())]] < 0.0, -1.0, 1.0)   # whichever of the two comes first
        east, north, up = usual = np.median(apart, axis=0)
        alike = (np.abs(apart - usual) < LAS.coarse_coordinates).all(axis=1).sum()
        if alike > max(LAS.most_of_pairs * len(pairs), LAS.least_doubled * len(time)) and np.linalg.norm(usual) > LAS.coarse_coordinates:
            raise RoadExtractionError(f"About {200 * alike / len(time):.0f} % of the points were given twice, {east:+.2f} m east, {north:+.2f} m "
                                      f"north and {up:+.2f} m up of each other, as of one drive in two datums. Give one of its exports.")


def _whole(places):
    return tuple(np.rint(np.asarray(places, float) * LAS.places_per_metre).astype(np.int64).tolist())


def _content(file):
    """Sums over a file's places, intensities and times, whatever the order of its points."""
    names = ["x", "y", "z", "intensity"] + ["gps_time"] * file.has_time
    sums = np.zeros(len(names), np.uint64)
    for block in read_blocks(file.path, layers=names[2:], units=file.units):
        for k, name in enumerate(names):
            values = np.asarray(block[name])
            if name == "gps_time":
                values = np.ascontiguousarray(values, np.float64).view(np.uint64)
            elif name != "intensity":
                values = np.rint(values * LAS.places_per_metre).astype(np.int64).view(np.uint64)
            # sums beyond 64 bits start again from 0, in any order the same
            sums[k] += values.sum(dtype=np.uint64)
    return tuple(sums.tolist())
