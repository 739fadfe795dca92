"""How high the trajectory runs above the road, from the points on the vehicle's own track."""

import numpy as np

from .points import UNIT

NEAR_TRACK = 1.5       # m either side of the vehicle's own track: road, not sidewalk
DEFAULT_HEIGHT = 2.6   # m, where too few points lie on the track
FEWEST = 50            # points that make a height
STEP = 0.001           # m to which a height is told
RANGE = 20.0           # m either side of the first estimate that is counted
PEAK = 0.1             # m: width of the bins in which the road stands out
AROUND = 0.5           # m either side of the peak that belong to the road


def drops_on_track(frame, road, records):
    """Per pass over a road: (pass number, (N,) metres from the trajectory down to the points on its own track)."""
    s, d, z = (records[name] * UNIT for name in ("s", "d", "z"))
    for p in frame.passes_of(road):
        m = np.flatnonzero(records["pass_number"] == p.number)
        if len(m):
            track_d, track_z = p.at_station(s[m])
            yield p.number, (track_z - z[m])[np.abs(d[m] - track_d) < NEAR_TRACK]


def first_estimate(drops):
    """Metres from the trajectory down to the road, good to a decimetre or two; None of too few points."""
    return float(np.median(drops)) if len(drops) > FEWEST else None


def sensor_heights(frame, store, about):
    """Height of the trajectory above the road, one per pass.

    The road is where most points on the track lie: the fullest decimetre of
    height. Its height is the median of the points within half a metre of it, so
    that a bridge or trees above do not count, nor how many of them were kept.

    Parameters
    ----------
    about : metres, a first estimate

    Returns
    -------
    {pass number: metres, a whole number of millimetres}; a pass without points
    on its own track gets the median of the others.
    """
    origin = np.floor(about) - RANGE
    size = int(2 * RANGE / STEP)
    tally = {p.number: np.zeros(size, np.int64) for p in frame.passes}
    for road in store.roads():
        for section in store.sections(road):
            for number, drops in drops_on_track(frame, road, store.section(road, section)):
                k = np.rint((drops - origin) / STEP).astype(np.int64)
                tally[number] += np.bincount(k[(k >= 0) & (k < size)], minlength=size)
    found = {number: _road_height(counts, origin) for number, counts in tally.items()}
    known = [height for height in found.values() if height is not None]
    usual = float(np.median(known)) if known else DEFAULT_HEIGHT
    return {number: usual if height is None else height for number, height in found.items()}


def height_above(drops):
    """Height above the road of (N,) metres from the trajectory down to points on its track; None of too few points."""
    if len(drops) <= FEWEST:
        return None
    origin = np.floor(np.median(drops)) - RANGE
    size = int(2 * RANGE / STEP)
    k = np.rint((drops - origin) / STEP).astype(np.int64)
    return _road_height(np.bincount(k[(k >= 0) & (k < size)], minlength=size), origin)


def _road_height(counts, origin):
    """The median about the fullest decimetre of (M,) counts per millimetre, None of too few points."""
    if counts.sum() <= FEWEST:
        return None
    bins = counts.reshape(-1, int(round(PEAK / STEP))).sum(axis=1)
    # neighbours count too: a road right on the border of two bins is one road
    peak = int(np.argmax(np.convolve(bins, np.ones(3), "same")))
    middle, reach = int((peak + 0.5) * PEAK / STEP), int(AROUND / STEP)
    first = max(middle - reach, 0)
    near = np.cumsum(counts[first:middle + reach])
    return round(float(origin + (first + np.searchsorted(near, (near[-1] + 1) // 2)) * STEP), 3)
