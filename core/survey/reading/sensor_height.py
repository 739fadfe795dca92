"""The height of the sensor above the road, from the points on the track of the vehicle itself."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..store.records import COORDINATE_SCALE, to_units

if TYPE_CHECKING:
    from ..frame.road_frame import RoadFrame
    from ..store.columns import Columns

OWN_TRACK_HALF_WIDTH = 1.5       # m either side of the own track: road, not sidewalk
DEFAULT_SENSOR_HEIGHT = 2.6   # m, used where too few points lie on the track
MIN_TRACK_POINTS = 50            # points on the track that an estimate needs (more than)
HEIGHT_RESOLUTION = 0.001           # m: resolution of the histogram
_RESOLUTION_UNITS = round(HEIGHT_RESOLUTION / COORDINATE_SCALE)
HEIGHT_RANGE = 20.0           # m either side of the first estimate covered by the histogram
HEIGHT_PEAK_BIN = 0.1             # m: bin width in which the road makes the peak
MAX_SUSPENSION_TRAVEL = 0.15            # m: no suspension lets a vehicle rise and sink more than this for half of its way
TRACK_CELL_BITS = 8          # of a station in units of 0.1 mm: a track is looked up every 26 mm
OWN_TRACK_HALF_WIDTH_UNITS = round(OWN_TRACK_HALF_WIDTH / COORDINATE_SCALE)
HEIGHT_PEAK_REACH = 0.5           # m either side of the peak that belong to the road


class VehicleTracks:
    """The tracks of the vehicle in the road frame, to find the points that lie on them.

    Parameters
    ----------
    frame : RoadFrame
    """

    def __init__(self, frame: RoadFrame):
        self.frame = frame
        # pass number -> first station cell, offsets and heights of the track at the middle of each cell
        self._tracks: dict[int, tuple[int, np.ndarray, np.ndarray]] = {}
        for p in frame.passes:
            first, last = (int(station / COORDINATE_SCALE) >> TRACK_CELL_BITS for station in p.span)
            middles = ((np.arange(first, last + 1) << TRACK_CELL_BITS) + (1 << TRACK_CELL_BITS) // 2) * COORDINATE_SCALE
            offsets, heights = p.at_station(middles)
            self._tracks[p.number] = first, to_units(offsets), to_units(heights)

    def drops(self, road: int, points: Columns, own: np.ndarray | None = None) -> Iterator[tuple[int, np.ndarray]]:
        """Depths below the trajectory of the points on the own track, pass by pass.

        Parameters
        ----------
        road : number
        points : Columns
        own : (N,) bool, points to use; all by default

        Yields
        ------
        pass number and (M,) int32 units of 0.1 mm from the trajectory down to the points
        """
        if not len(points):
            return
        number, along, across = points["pass_number"], points["s"], points["d"]
        ends = np.array([along.min(), along.max()]) >> TRACK_CELL_BITS
        only = number.strides[0] == 0 or number.min() == number.max()
        for p in self.frame.passes_of(road):
            if only and p.number != number[0]:
                continue
            first, offsets, heights = self._tracks[p.number]
            low, high = np.clip(ends - first, 0, len(offsets) - 1)
            track = offsets[low:high + 1]
            # most points lie beside the whole track
            beside = _between(across, int(track.min()) - OWN_TRACK_HALF_WIDTH_UNITS, int(track.max()) + OWN_TRACK_HALF_WIDTH_UNITS)
            if own is not None:
                beside &= own
            if not only:
                beside &= number == p.number
            rows = np.flatnonzero(beside)
            cell = (along.take(rows) >> TRACK_CELL_BITS) - np.int32(first)
            off = across.take(rows)
            off -= offsets.take(cell, mode="clip")
            on = np.flatnonzero(_between(off, -OWN_TRACK_HALF_WIDTH_UNITS, OWN_TRACK_HALF_WIDTH_UNITS))
            if len(on):
                drops = heights.take(cell.take(on), mode="clip")
                drops -= points["z"].take(rows.take(on))
                yield p.number, drops


def _between(values, least, most):
    """(N,) bool: which int32 values lie between two limits, both included."""
    above = np.subtract(values, np.int32(least))
    return above.view(np.uint32) <= np.uint32(most - least)


def estimate_sensor_height(drops: np.ndarray) -> float | None:
    """A rough sensor height in metres, accurate to one or two decimetres, of (N,) units of 0.1 mm; None for too few points."""
    return float(np.median(drops)) * COORDINATE_SCALE if len(drops) > MIN_TRACK_POINTS else None


class HeightHistogram:
    """Histogram of the depths below the trajectory of points on the track; independent of the order of adding.

    Parameters
    ----------
    passes : numbers of the passes
    about : first estimate of the sensor height, m
    """

    def __init__(self, passes: Iterable[int], about: float):
        self.origin = np.floor(about) - HEIGHT_RANGE
        self.counts = {number: np.zeros(int(2 * HEIGHT_RANGE / HEIGHT_RESOLUTION), np.int64) for number in passes}
        self._lock = threading.Lock()

    def add(self, number: int, drops: np.ndarray) -> None:
        """Count points on the track of a pass; (N,) int32 depths below the trajectory in units of 0.1 mm."""
        size = int(2 * HEIGHT_RANGE / HEIGHT_RESOLUTION)
        k = drops - np.int32(round(self.origin / COORDINATE_SCALE) - _RESOLUTION_UNITS // 2)
        k //= _RESOLUTION_UNITS
        if k.min() < 0 or k.max() >= size:
            k = k[(k >= 0) & (k < size)]
        least = int(k.min(initial=size))
        k -= least
        found = np.bincount(k)
        with self._lock:
            self.counts[number][least:least + len(found)] += found

    def join(self, counts: dict[int, np.ndarray]) -> None:
        """Add the counts of another histogram of the same passes and the same first estimate."""
        for number, found in counts.items():
            self.counts[number] += found

    def heights(self) -> dict[int, float]:
        """Height of the trajectory above the road, one per pass.

        The road makes the peak of the histogram, the fullest decimetre. Its height is the median of the points within
        half a metre of the peak, so that bridges and trees above do not count.

        Returns
        -------
        {pass number: metres, rounded to millimetres}; a pass without points on its own track gets the median of the others.
        """
        found = {number: _road_height(counts, self.origin) for number, counts in self.counts.items()}
        known = [height for height in found.values() if height is not None]
        usual = float(np.median(known)) if known else DEFAULT_SENSOR_HEIGHT
        return {number: usual if height is None else height for number, height in found.items()}

    def uneven(self) -> tuple[float, float] | None:
        """Variation of the height of the trajectory above the road, where it is more than a vehicle can cause.

        Points and trajectory share the errors of navigation, so half of the points on the own track lie within a few
        centimetres of one height below it, whatever is parked or grows on the rest.

        Returns
        -------
        (median absolute deviation from the height, height) in metres, of the pass where it is largest; None if no pass
        exceeds MAX_SUSPENSION_TRAVEL.
        """
        heights = self.heights()
        found = [(_half_within(counts, self.origin, heights[number]), heights[number])
                 for number, counts in self.counts.items() if counts.sum() > MIN_TRACK_POINTS]
        off, height = max(found, default=(0.0, 0.0))
        return (off, height) if off > MAX_SUSPENSION_TRAVEL else None


def _half_within(counts, origin, height):
    """Metres from `height` within which half of the counts of a histogram per millimetre lie."""
    off = np.abs(origin + np.arange(len(counts)) * HEIGHT_RESOLUTION - height)
    order = np.argsort(off, kind="stable")
    near = np.cumsum(counts[order])
    return float(off[order[np.searchsorted(near, (near[-1] + 1) // 2)]])


def sensor_height_of(drops: np.ndarray) -> float | None:
    """Sensor height in metres, of (N,) metres from the trajectory down to points on its track; None for too few points."""
    if len(drops) <= MIN_TRACK_POINTS:
        return None
    origin = np.floor(np.median(drops)) - HEIGHT_RANGE
    size = int(2 * HEIGHT_RANGE / HEIGHT_RESOLUTION)
    k = np.rint((drops - origin) / HEIGHT_RESOLUTION).astype(np.int64)
    return _road_height(np.bincount(k[(k >= 0) & (k < size)], minlength=size), origin)


def _road_height(counts, origin):
    """The median about the fullest decimetre of a histogram per millimetre; None for too few points."""
    if counts.sum() <= MIN_TRACK_POINTS:
        return None
    bins = counts.reshape(-1, int(round(HEIGHT_PEAK_BIN / HEIGHT_RESOLUTION))).sum(axis=1)
    # neighbouring bins count too: the road may lie on the border of two bins
    peak = int(np.argmax(np.convolve(bins, np.ones(3), "same")))
    middle, reach = int((peak + 0.5) * HEIGHT_PEAK_BIN / HEIGHT_RESOLUTION), int(HEIGHT_PEAK_REACH / HEIGHT_RESOLUTION)
    first = max(middle - reach, 0)
    near = np.cumsum(counts[first:middle + reach])
    return round(float(origin + (first + np.searchsorted(near, (near[-1] + 1) // 2)) * HEIGHT_RESOLUTION), 3)
