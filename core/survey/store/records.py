"""The compact record of a point, with coordinates as integers, and its metric view."""

from __future__ import annotations

from typing import Any

import numpy as np

from .columns import Columns

COORDINATE_SCALE = 1e-4  # derived: m: coordinates are integers of 0.1 mm, exact for every LAS scale in use
MAX_XY_32_BIT = 2e5      # derived: m from the origin: up to here x and y have 32 bits

# Coordinates are local (map minus the frame's origin); s and d are the road's
# station and offset. `source` is point_source_id, so that a written cloud
# can be traced back; `returns` is return number + 16 * number of returns.
SURVEY_POINT = np.dtype([
    ("time", "f8"), ("x", "i4"), ("y", "i4"), ("z", "i4"), ("s", "i4"), ("d", "i4"),
    ("intensity", "u2"), ("source", "u2"), ("pass_number", "u2"), ("scanner", "u1"), ("returns", "u1"),
])

# `half_width` is in millimetres; `corrected` is NaN where intensity was not corrected;
# `cluster` is 0 before clustering; `covered` is 1 beneath objects on the road and directly beside them;
# `spacing`, in millimetres, is that of the tracks of the scan across the road, 0 where it is less than a cell or not known.
ROAD_POINT = np.dtype(SURVEY_POINT.descr + [("corrected", "f4"), ("half_width", "u2"), ("cluster", "i4"), ("covered", "u1"), ("spacing", "u2")])


def point_dtype(dtype: np.dtype, farthest: float) -> np.dtype:
    """SURVEY_POINT or ROAD_POINT, with 64 bits for x and y of points that lie farther from the origin than MAX_XY_32_BIT; `farthest` in metres."""
    wide = {"x": "i8", "y": "i8"} if farthest > MAX_XY_32_BIT else {}
    return np.dtype([(name, wide.get(name, dtype[name])) for name in dtype.names or ()])


def to_units(metres: np.ndarray) -> np.ndarray:
    """(N,) metres as (N,) int32 of 0.1 mm."""
    return np.rint(np.asarray(metres) / COORDINATE_SCALE).astype(np.int32)


def fill_units(metres: np.ndarray, units: np.ndarray) -> np.ndarray:
    """Fill and return (N,) integers of 0.1 mm from (N,) metres; the metres are overwritten."""
    metres /= COORDINATE_SCALE
    with np.errstate(invalid="ignore"):
        np.copyto(units, np.rint(metres, out=metres), casting="unsafe")
    return units


def points_of_scanners(records: Any) -> np.ndarray:
    """(256,) how many of some records each scanner has."""
    return np.bincount(records["scanner"], minlength=256)


def beside_road(road: int) -> int:
    """The number under which a store keeps ground beyond the corridor of a road, by the station of the vehicle that saw it."""
    return -1 - road


def road_of(number: int) -> int:
    """The road of such a number, or of its own."""
    return number if number >= 0 else -1 - number


class Points:
    """A metric view of the records of points; metres are computed on access.

    records : (N,) Columns or structured array
    x, y, z, s, d : (N,) float64, metres
    half_width, spacing : (N,) float64, metres
    time : (N,) float64, seconds
    intensity, corrected, source, pass_number, scanner, returns, cluster, covered : (N,) the columns as they are
    """

    METRIC = frozenset("xyzsd")
    MILLIMETRES = frozenset(("half_width", "spacing"))

    def __init__(self, records: np.ndarray | Columns):
        self.records = records

    def __len__(self) -> int:
        return len(self.records)

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("_") or name == "records":
            raise AttributeError(name)
        if name in self.METRIC:
            return self.records[name] * COORDINATE_SCALE
        if name in self.MILLIMETRES:
            return self.records[name] * 1e-3
        if name in (self.records.dtype.names or ()):
            return self.records[name]
        raise AttributeError(f"points have no column {name!r}")

    def __getitem__(self, which: Any) -> Points:
        """The points of a mask, slice or index array."""
        return Points(self.records[which])

    @property
    def value(self) -> np.ndarray:
        """(N,) float32: corrected intensity where there is one, raw intensity elsewhere."""
        corrected = self.records["corrected"]
        missing = np.isnan(corrected)
        return np.where(missing, self.records["intensity"].astype(np.float32), corrected) if missing.any() else corrected


# What the points of a section show of the surface of their road: where it was scanned, and where it ends.

STATION_STEP = 0.5   # derived: m of station between places where lanes are looked for
BIN = 0.2   # derived: m across, of what is seen of the surface and of hatching
FAR = 30.0   # derived: m: beyond any road
BINS = int(round(2 * FAR / BIN))   # derived

Seen = tuple[int, np.ndarray, np.ndarray, np.ndarray]


def seen_in_section(records: Any) -> Seen:
    """Where the surface was scanned in one section of road points.

    Returns the number of the first of the N stations of the grid that it shows; (N, BINS) bool, the bins with points; (N, 2) sums of half widths (mm)
    and (N, 2) numbers of points on the left and on the right.
    """
    step, wide, reach = (int(round(length / COORDINATE_SCALE)) for length in (STATION_STEP, BIN, FAR))
    k, d = (records["s"] + step // 2) // step, records["d"]
    inside = np.abs(d) < reach
    if not inside.any():
        return 0, np.zeros((0, BINS), bool), np.zeros((0, 2)), np.zeros((0, 2))
    half_width = records["half_width"]
    if not inside.all():
        k, d, half_width = k[inside], d[inside], half_width[inside]
    begin = int(k.min())
    k -= begin
    stations = int(k.max()) + 1
    covered = np.zeros((stations, BINS), bool)
    covered.reshape(-1)[k * BINS + (d + reach) // wide] = True
    side = 2 * k + (d < 0)
    total, number = (np.bincount(side, weights, 2 * stations).reshape(-1, 2) for weights in (half_width, None))
    return begin, covered, total, number
