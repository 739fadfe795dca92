"""Streets with known paint, as road points in the road's own frame."""

import numpy as np
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.records import ROAD_POINT, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.trajectory.trajectory import Trajectory

ASPHALT, PAINT = 1000.0, 4000.0
EAST, NORTH = 500_000.0, 5_400_000.0
DENSITY = 600  # points per square metre


def drive(length=90.0, radius=np.inf, east=EAST):
    """A drive along an arc, 2 m above the road."""
    s = np.arange(0.0, length, 0.1)
    turn = s / radius if np.isfinite(radius) else np.zeros(len(s))
    x = np.concatenate([[0.0], np.cumsum(0.1 * np.cos(turn[:-1]))])
    y = np.concatenate([[0.0], np.cumsum(0.1 * np.sin(turn[:-1]))])
    return build_frame(Trajectory(s / 10.0, x + east, y + NORTH, np.full(len(s), 102.0)))


def strip(s0, s1, d0, d1):
    """Paint from station s0 to s1 and offset d0 to d1."""
    return between(s0, s1, lambda s, d: (s >= s0) & (s < s1) & (d >= d0) & (d < d1))


def disc(s0, d0, diameter):
    return between(s0 - diameter / 2, s0 + diameter / 2, lambda s, d: np.hypot(s - s0, d - d0) < diameter / 2)


def oblique_bar(way, beside, length, width, s0=30.0):
    """A bar `length` long `way` degrees left of the road's direction, whose middle line passes station `s0` of the axis `beside` m to its left."""
    c, n = np.cos(np.radians(way)), np.sin(np.radians(way))
    reach = length + width + abs(beside)
    return between(s0 - reach, s0 + reach, lambda s, d: (np.abs((s - s0) * c + d * n) < length / 2)
                   & (np.abs(d * c - (s - s0) * n - beside) < width / 2))


def between(first, last, mark):
    """A mark, of which is known that it lies between two stations: no others are looked at."""
    mark.stations = first, last
    return mark


def painted_by(marks, s, d):
    """(N,) whether places, sorted by station, are painted."""
    painted = np.zeros(len(s), bool)
    for mark in marks:
        rows = slice(*np.searchsorted(s, getattr(mark, "stations", (-np.inf, np.inf))))
        painted[rows] |= mark(s[rows], d[rows])
    return painted


def strewn(length, left, right, density, seed=1, start=0.0):
    """Stations from `start` on, in order, and offsets strewn evenly over a carriageway from offset `right` to `left`."""
    rng = np.random.default_rng(seed)
    count = int(length * (left - right) * density)
    ahead = np.cumsum(rng.standard_exponential(count + 1))  # as far apart as evenly strewn places in order are: nothing is sorted
    return start + ahead[:-1] / ahead[-1] * length, rng.uniform(right, left, count)


def street(frame, marks=(), length=60.0, left=4.0, right=-4.0, density=DENSITY, noise=0.08, level=None, seed=1):
    """(N,) ROAD_POINT records of a carriageway; `level(s, d)` is asphalt's brightness as a factor."""
    s, d = strewn(length, left, right, density, seed)
    painted = painted_by(marks, s, d)
    rng = np.random.default_rng(seed + 1)
    brightness = np.where(painted, PAINT, ASPHALT * (1.0 if level is None else level(s, d)))
    return records_at(frame, s, d, brightness * rng.normal(1.0, noise, len(s)), max(left, -right))


def paint(frame, marks, density=1500, length=80.0, reach=6.0, seed=1):
    """Records of the painted points alone."""
    stations = np.array([getattr(mark, "stations", (0.0, length)) for mark in marks])
    first, last = max(stations.min(), 0.0), min(stations.max(), length)
    s, d = strewn(last - first, reach, -reach, density, seed, first)
    painted = painted_by(marks, s, d)
    return records_at(frame, s[painted], d[painted], np.full(painted.sum(), PAINT), reach)


def records_at(frame, s, d, brightness, half_width):
    records = np.zeros(len(s), ROAD_POINT)
    order = np.argsort(s, kind="stable")
    s, d, brightness = s[order], d[order], brightness[order]
    x, y = frame.road(0).to_map(s, d)
    records["x"], records["y"], records["z"] = to_units(x), to_units(y), to_units(0.02 * d)
    records["s"], records["d"] = to_units(s), to_units(d)
    records["time"] = s / 10.0
    records["intensity"] = np.clip(brightness, 0, 65535)
    records["corrected"] = np.nan
    records["half_width"] = int(1000 * half_width)
    return records


def road_points(records, frame, section_length=20.0):
    found = RoadPoints(SectionStore(ROAD_POINT, section_length), frame.origin)
    found.store.append(0, records)
    return found


def shuffled(records, seed=5):
    return records[np.random.default_rng(seed).permutation(len(records))]


def assert_same_points(records, others):
    """To the bit, in whatever order sections gave them."""
    assert len(records) == len(others)
    records, others = (r[np.lexsort((r["y"], r["x"], r["time"]))] for r in (records, others))
    for name in records.dtype.names:
        np.testing.assert_array_equal(records[name], others[name], err_msg=name)
