"""How high the trajectory runs above the road, from the points on the vehicle's own track."""

import threading

import numpy as np

from .store.records import COORDINATE_SCALE, to_units

OWN_TRACK_HALF_WIDTH = 1.5       # m either side of the vehicle's own track: road, not sidewalk
DEFAULT_SENSOR_HEIGHT = 2.6   # m, where too few points lie on the track
MIN_TRACK_POINTS = 50            # points that make a height
HEIGHT_RESOLUTION = 0.001           # m to which a height is told
_RESOLUTION_UNITS = round(HEIGHT_RESOLUTION / COORDINATE_SCALE)
HEIGHT_RANGE = 20.0           # m either side of the first estimate that is counted
HEIGHT_PEAK_BIN = 0.1             # m: width of the bins in which the road stands out
MAX_SUSPENSION_TRAVEL = 0.15            # m: no springs let a vehicle rise and sink more than this for half of its way
TRACK_CELL_BITS = 8          # of a station in units of 0.1 mm: a track is looked up every 26 mm
OWN_TRACK_HALF_WIDTH_UNITS = round(OWN_TRACK_HALF_WIDTH / COORDINATE_SCALE)
HEIGHT_PEAK_REACH = 0.5           # m either side of the peak that belong to the road


class VehicleTracks:
    """The vehicle's own tracks in the road frame, for asking which points lie on them."""

    def __init__(self, frame):
        self.frame = frame
        self._tracks = {}  # pass number -> first cell of station, offsets and heights of the track in the middle of each
        for p in frame.passes:
            first, last = (int(station / COORDINATE_SCALE) >> TRACK_CELL_BITS for station in p.span)
            middles = ((np.arange(first, last + 1) << TRACK_CELL_BITS) + (1 << TRACK_CELL_BITS) // 2) * COORDINATE_SCALE
            self._tracks[p.number] = first, *map(to_units, p.at_station(middles))

    def drops(self, road, points, own=None):
        """Per pass over a road: (pass number, (N,) int32 units from the trajectory down to the points on its own track).

        Parameters
        ----------
        points : Columns
        own : (N,) bool, which of them are meant; all by default
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
            # most lie beside all of the track
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
    """(N,) bool: which of (N,) int32 lie between two others, both included."""
    above = np.subtract(values, np.int32(least))
    return above.view(np.uint32) <= np.uint32(most - least)


def estimate_sensor_height(drops):
    """Metres from the trajectory down to the road, good to a decimetre or two, of (N,) units; None of too few points."""
    return float(np.median(drops)) * COORDINATE_SCALE if len(drops) > MIN_TRACK_POINTS else None


class HeightHistogram:
    """Counts points on the tracks by their depth below the trajectory; no order of adding shows.

    Parameters
    ----------
    passes : numbers of the passes
    about : metres, a first estimate of the sensor's height
    """

    def __init__(self, passes, about):
        self.origin = np.floor(about) - HEIGHT_RANGE
        self.counts = {number: np.zeros(int(2 * HEIGHT_RANGE / HEIGHT_RESOLUTION), np.int64) for number in passes}
        self._lock = threading.Lock()

    def add(self, number, drops):
        """Count (N,) int32 units below the trajectory of points on the track of one pass."""
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

    def heights(self):
        """Height of the trajectory above the road, one per pass.

        The road is where most points on the track lie: the fullest decimetre of
        height. Its height is the median of the points within half a metre of it, so
        that a bridge or trees above do not count, nor how many of them were kept.

        Returns
        -------
        {pass number: metres, a whole number of millimetres}; a pass without points
        on its own track gets the median of the others.
        """
        found = {number: _road_height(counts, self.origin) for number, counts in self.counts.items()}
        known = [height for height in found.values() if height is not None]
        usual = float(np.median(known)) if known else DEFAULT_SENSOR_HEIGHT
        return {number: usual if height is None else height for number, height in found.items()}


    def uneven(self):
        """How far the trajectory strays from its height above the road, where that is more than a vehicle can.

        Points and trajectory share the errors of navigation, so half of the points on a vehicle's own track lie
        within a few centimetres of one height below it, whatever is parked or grows on the rest.

        Returns
        -------
        (metres off the height that half of the points stay within, that height) of the pass where it is most;
        None where every pass keeps to MAX_SUSPENSION_TRAVEL.
        """
        found = [(_half_within(counts, self.origin, height), height)
                 for counts, height in zip(self.counts.values(), map(self.heights().get, self.counts)) if counts.sum() > MIN_TRACK_POINTS]
        off, height = max(found, default=(0.0, 0.0))
        return (off, height) if off > MAX_SUSPENSION_TRAVEL else None


def _half_within(counts, origin, height):
    """Metres from `height` within which half of (M,) counts per millimetre lie."""
    off = np.abs(origin + np.arange(len(counts)) * HEIGHT_RESOLUTION - height)
    order = np.argsort(off, kind="stable")
    near = np.cumsum(counts[order])
    return float(off[order[np.searchsorted(near, (near[-1] + 1) // 2)]])


def sensor_height_of(drops):
    """Height above the road of (N,) metres from the trajectory down to points on its track; None of too few points."""
    if len(drops) <= MIN_TRACK_POINTS:
        return None
    origin = np.floor(np.median(drops)) - HEIGHT_RANGE
    size = int(2 * HEIGHT_RANGE / HEIGHT_RESOLUTION)
    k = np.rint((drops - origin) / HEIGHT_RESOLUTION).astype(np.int64)
    return _road_height(np.bincount(k[(k >= 0) & (k < size)], minlength=size), origin)


def _road_height(counts, origin):
    """The median about the fullest decimetre of (M,) counts per millimetre, None of too few points."""
    if counts.sum() <= MIN_TRACK_POINTS:
        return None
    bins = counts.reshape(-1, int(round(HEIGHT_PEAK_BIN / HEIGHT_RESOLUTION))).sum(axis=1)
    # neighbours count too: a road right on the border of two bins is one road
    peak = int(np.argmax(np.convolve(bins, np.ones(3), "same")))
    middle, reach = int((peak + 0.5) * HEIGHT_PEAK_BIN / HEIGHT_RESOLUTION), int(HEIGHT_PEAK_REACH / HEIGHT_RESOLUTION)
    first = max(middle - reach, 0)
    near = np.cumsum(counts[first:middle + reach])
    return round(float(origin + (first + np.searchsorted(near, (near[-1] + 1) // 2)) * HEIGHT_RESOLUTION), 3)
