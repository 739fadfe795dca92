"""Which scanner measured a point, where a vehicle carries more than one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ...common.errors import RoadExtractionError
from ..store.records import COORDINATE_SCALE, MAX_XY_32_BIT, fill_units
from ..weights import LAS
from .reader import MAX_INTENSITY, CloudHeader, read_blocks
from .samples import FileSample, TimeSlots

EVER = (-np.inf, np.inf)      # s


@dataclass
class ScannerCensus:
    """Times at which each value of the fields that may distinguish scanners was measured: {LAS field: {value: (first, last, count)}}.

    Without times stations along the road stand in their place: scanners measure the same stretches of it, files and tiles do not.
    """

    spans: dict[str, dict[int, tuple[float, float, int]]] = field(default_factory=lambda: {"scanner_channel": {}, "point_source_id": {}})

    def add(self, name: str, values: np.ndarray, time: np.ndarray, span: tuple[float, float] = EVER) -> None:
        """Add a block: (N,) values of one LAS field and (N,) gps_time; times out of the span do not count."""
        self.take(name, times_by_value(values, time, span))

    def take(self, name: str, times: dict[int, tuple[float, float, int]]) -> None:
        """Add the result of `times_by_value` for a block."""
        spans = self.spans[name]
        if len(spans) > 4 * LAS.max_scanners:
            return
        for value, (start, end, number) in times.items():
            first, last, count = spans.get(value, (np.inf, -np.inf, 0))
            spans[value] = min(first, start), max(last, end), count + number

    def join(self, other: ScannerCensus) -> None:
        """Add what was gathered elsewhere."""
        for name, times in other.spans.items():
            self.take(name, times)

    def choose(self, wanted: str | None = "automatic") -> tuple[str | None, list[Any]]:
        """The LAS field that identifies the scanners, None for one scanner, and the values of each scanner, a tuple for several recordings.

        This is `scanner_channel` if it has more than one value, else `point_source_id` if its values overlap in time. LAS defines the latter
        as a flight line or file number; some exporters count frames in it, others number every recording of every scanner.
        RoadExtractionError where the wanted field is unknown or has too many values.
        """
        if wanted not in ("", "automatic", None):
            if wanted not in self.spans:
                raise RoadExtractionError(f"Scanner field {wanted!r} is not known; choose automatic, scanner_channel or point_source_id.")
            values = sorted(self.spans[wanted])
            if len(values) > 4 * LAS.max_scanners:
                raise RoadExtractionError(
                    f"{wanted} has more than {4 * LAS.max_scanners} different values, too many to be scanners. Set the scanner field to automatic.")
            return wanted, values if len(values) <= LAS.max_scanners else _heads(self.spans[wanted])
        channels = self.spans["scanner_channel"]
        if 1 < len(channels) <= LAS.max_scanners:
            return "scanner_channel", sorted(channels)
        sources = self.spans["point_source_id"]
        if 1 < len(sources) <= 4 * LAS.max_scanners and _interleaved(sources.values()):
            heads = _heads(sources)
            if 1 < len(heads) <= LAS.max_scanners:
                return "point_source_id", heads
        return None, [0]


def times_by_value(values: np.ndarray, time: np.ndarray, span: tuple[float, float] = EVER) -> dict[int, tuple[float, float, int]]:
    """{value: (first time, last time, count)} of (N,) small integers and times; incomplete if there are too many values.

    Points at times out of the span do not count: some exporters write a wrong time here and there.
    """
    if not len(values):
        return {}
    ends = float(time.min()), float(time.max())
    if not (ends[0] >= span[0] and ends[1] <= span[1]):
        usable = np.flatnonzero((time >= span[0]) & (time <= span[1]))
        return times_by_value(values[usable], time[usable])
    # a broadcast column has one value
    distinct = values if values.strides[0] else values[:1]
    low, high = int(distinct.min()), int(distinct.max())
    if low == high:
        return {low: (*ends, len(values))}
    present = [low, high] if high - low < 2 else np.flatnonzero(np.bincount(values))[: 4 * LAS.max_scanners + 1].tolist()
    times_of = {value: time[values == value] for value in present}
    return {value: (float(times.min()), float(times.max()), len(times)) for value, times in times_of.items()}


def numbers_by_value(scanners: Sequence[Any], count: int) -> np.ndarray:
    """(count,) uint8 scanner number of each value 0 ... count - 1; `scanners` as returned by `choose`."""
    numbers = np.zeros(count, np.uint8)
    for number, values in enumerate(scanners):
        values = np.atleast_1d(values)
        numbers[values[values < count]] = number
    return numbers


def scanners_of(numbers: np.ndarray, time: np.ndarray, wanted: str | None) -> np.ndarray:
    """(N,) uint8 number of the scanner of points, by their (N, 2) values of SCANNER_FIELDS and (N,) times; `wanted` as of `ScannerCensus.choose`."""
    census = ScannerCensus()
    for name, values in zip(SCANNER_FIELDS, numbers.T):
        census.add(name, values, time)
    field, scanners = census.choose(wanted)
    if field is None:
        return np.zeros(len(time), np.uint8)
    column = numbers[:, SCANNER_FIELDS.index(field)]
    return numbers_by_value(scanners, int(column.max(initial=0)) + 1)[column]


def _heads(spans):
    """Values of a field, ascending; those that measured one after the other are combined into one scanner."""
    heads: list[list[int]] = []
    for value in sorted(spans):
        free = next((head for head in heads if not any(_together(spans[value], spans[member]) for member in head)), None)
        if free is None:
            heads.append([value])
        else:
            free.append(value)
    return [head[0] if len(head) == 1 else tuple(head) for head in heads]


def _together(one, other):
    """Whether the overlap of two time spans is more than half of the shorter one."""
    return min(one[1], other[1]) - max(one[0], other[0]) > 0.5 * min(one[1] - one[0], other[1] - other[0])


def _interleaved(spans):
    """Whether most points have a value whose time span overlaps that of another by at least half of its length."""
    spans, total, shared = list(spans), 0, 0
    for k, (first, last, count) in enumerate(spans):
        longest = max((min(last, b) - max(first, a) for j, (a, b, _) in enumerate(spans) if j != k), default=0.0)
        total += count
        # at the ends of a recording one scanner may see the road alone
        shared += count * (longest > 0 and longest >= 0.5 * (last - first))
    return shared >= LAS.min_interleaved_share * total


# What the intensity of a point is read from, and how: exporters write it with a sign, in decibels, or into an extra field.

SCANNER_FIELDS = "point_source_id", "scanner_channel"
INTENSITY_SOURCES = "intensity", "rgb"
COLOUR_FIELDS = "red", "green", "blue"
LUMINANCE_WEIGHTS = 0.2126, 0.7152, 0.0722   # source: of red, green and blue (ITU-R BT.709-6, section 3.2)
USUAL_FIELDS = "reflect", "amplitude", "intensity"   # parts of names of extra fields that hold what a scanner received, the best first
SIGN = 2**15   # derived: from here on the values of 16 bits are negative, where they have a sign
VALUES_PER_DECIBEL = 1, 10, 100   # source: as exporters store it
MAX_POWER = 290.0         # derived: of ten, with which a double can be multiplied


@dataclass(frozen=True)
class IntensitySource:
    """How the intensity of points is read."""

    field: str = "intensity"   # "intensity", an extra field, or "rgb" for the luminance of colours
    signed: bool = False   # whether values from SIGN on stand for negative ones
    per_decibel: float = 0.0   # values that make a decibel, 0 where they are linear
    zero: float = 0.0   # of linear values, what counts as 0
    factor: float = 1.0   # by which linear values, or those of decibels made linear, are multiplied

    @property
    def layers(self) -> tuple[str, ...]:
        """The LAZ layers that it needs beside that of the intensity."""
        return {"intensity": (), "rgb": ("rgb",)}.get(self.field, ("all_extra_bytes",))

    def of(self, points: Any) -> np.ndarray:
        """Intensities of a laspy point record, (N,) uint16."""
        if self.field == "rgb":
            return luminance(points)
        if self.field != "intensity":
            return self._converted(np.asarray(points[self.field], float))
        raw = points.array["intensity"]
        return self._table.take(raw) if self.signed else raw

    @cached_property
    def _table(self):
        """The intensity of each value of 16 bits."""
        return self._converted(np.arange(MAX_INTENSITY + 1, dtype=np.uint16).view(np.int16).astype(float))

    def _converted(self, values):
        # no decibels are beyond what doubles hold, but the table has values that no file has
        linear = 10.0 ** np.minimum(values / (10.0 * self.per_decibel), MAX_POWER) if self.per_decibel else values - self.zero
        return np.clip(np.rint(np.nan_to_num(linear * self.factor)), 0, MAX_INTENSITY).astype(np.uint16)


def intensity_source_of(samples: Sequence[FileSample], wanted: str) -> tuple[IntensitySource, str]:
    """How the intensities of all files are to be read, and what the user should know of it. wanted : one of INTENSITY_SOURCES"""
    if wanted == "rgb":
        return IntensitySource("rgb"), ""
    values = np.concatenate([sample.intensity for sample in samples])
    if values.min(initial=MAX_INTENSITY) < values.max(initial=0):
        if not _wrapped(values):
            return IntensitySource(), ""
        source = _source("intensity", values.view(np.int16).astype(float), signed=True)
        example = int(values.max())
        return source, (f"The intensities are numbers with a sign, written into 16 bits without one: {example:,} stands for {example - 2 * SIGN:,}. "
                        f"They are read as {_unit(source)}.")
    for name, numbers in _fields_of_intensity(samples):
        source = _source(name, numbers)
        return source, (f"The intensity of all points is the same, {int(values.max(initial=0))}; the extra field {name} is read in its "
                        f"place, as {_unit(source)}.")
    return IntensitySource(), ""


def in_one_scale(files: Sequence[CloudHeader], samples: Sequence[FileSample], wanted: str,
                 drive: np.ndarray | None = None) -> tuple[list[CloudHeader], str]:
    """The files with intensities that have one scale, where some were written with fewer bits than others, and what to tell of them.

    LAS stores a value times 65,536 / the dynamic range of the sensor (ASPRS, LAS specification 1.4 R15, Intensity); some exporters do not multiply.

    wanted : one of INTENSITY_SOURCES
    drive : (M, 2) m, places of the vehicle. What lies far from it is weaker in any scale, so only points near it are compared; None compares all.
    """
    tree = None if drive is None else cKDTree(drive)
    usual = {sample.file.path: float(np.median(values)) for sample in samples
             if len(values := _near(sample, tree)) >= LAS.least_compared and values.min() < values.max()}
    brightest = max(usual, key=lambda path: usual[path], default="")
    factors: dict[str, int] = {}
    other: list[str] = []
    for sample in samples if wanted == INTENSITY_SOURCES[0] else ():
        path, share = sample.file.path, usual.get(sample.file.path, np.inf) / usual.get(brightest, 1.0)
        if share * LAS.other_scale < 1.0:
            bits = int(sample.intensity.max()).bit_length()
            fitting = [2 ** (16 - used) for used in LAS.sensor_bits if used >= bits]
            factor = min(fitting, key=lambda each: abs(np.log(each * share)), default=1)
            if 1.0 / LAS.same_scale < factor * share < LAS.same_scale:
                factors[path] = factor
            else:
                other.append(path)
    if other:
        times = usual[brightest] / usual[other[0]]
        return list(files), (f"The intensities of {other[0]} are about {times:.0f} times weaker than those of {brightest}. Export all files with one "
                             "scale of intensities.")
    note = ""
    if factors:
        path, factor = next(iter(factors.items()))
        note = (f"The intensities of {len(factors)} of {len(files)} files have fewer bits than those of the others, such as {path}: they were "
                f"multiplied by {factor}, so that all have one scale.")
    return [replace(file, brightness=factors.get(file.path, 1)) for file in files], note


def _near(sample, drive):
    """The intensities above 0 of the points of a FileSample near the places of a tree, the drive; of all points where that is None."""
    near = sample.intensity > 0
    if drive is not None:
        near &= np.isfinite(drive.query(sample.places, distance_upper_bound=LAS.near_drive)[0])
    return sample.intensity[near]


def _fields_of_intensity(samples):
    """Yield the extra fields that may hold what a scanner received, the best first: name and finite values, which differ."""
    shared = [name for name in samples[0].fields if all(name in sample.fields for sample in samples)] if samples else []
    for name in (name for part in USUAL_FIELDS for name in shared if part in name.lower()):
        numbers = np.concatenate([sample.fields[name] for sample in samples])
        numbers = numbers[np.isfinite(numbers)]
        if len(np.unique(numbers)) > 1:
            yield name, numbers


def _wrapped(values):
    """Whether (N,) intensities are negative and positive values written without their sign: one body or two, with nothing between.

    A saturated scanner has mostly one value at the upper end, and signs brighter than all else are few.
    """
    quarter = np.bincount(values >> 14, minlength=4) / len(values)
    if quarter[1] + quarter[2] > LAS.empty_middle or quarter[3] < LAS.least_upper_share:
        return False
    counts = np.bincount(values[values >= 3 * SIGN // 2])
    return bool(counts.max() < 0.5 * counts.sum())


def _source(field, values, signed=False):
    """The source that makes linear intensities of (N,) values."""
    low, high = np.quantile(values, [0.005, 0.995])
    spread = float(high - low)
    named = "amplitude" in field.lower() and LAS.usual_spread / 4 < spread <= LAS.max_spread
    decibels = spread <= LAS.max_spread * VALUES_PER_DECIBEL[-1] and (low < 0 or named)
    if not decibels:
        zero = min(float(values.min()), 0.0)
        return IntensitySource(field, signed, zero=zero, factor=LAS.brightest / max(float(high) - zero, 1e-12))
    unit = float(min(VALUES_PER_DECIBEL, key=lambda each: abs(np.log(max(spread, 1e-9) / each / LAS.usual_spread))))
    top = np.ceil(high / unit / LAS.brightest_step) * LAS.brightest_step
    return IntensitySource(field, signed, unit, factor=float(LAS.brightest / 10.0 ** (top / 10.0)))


def _unit(source):
    """What the values of a source are taken for."""
    return f"decibels, {source.per_decibel:g} a dB, and made linear" if source.per_decibel else "linear values"


def luminance(points: Any) -> np.ndarray:
    """(N,) uint16 brightness of points with colours, the weighted sum of their red, green and blue, in the unit of these."""
    return np.rint(sum(weight * np.asarray(points[name], np.float32) for name, weight in zip(COLOUR_FIELDS, LUMINANCE_WEIGHTS))).astype(np.uint16)


def check_coloured(files: Sequence[CloudHeader], taken_from: str) -> None:
    """Raise RoadExtractionError where intensity is taken from "rgb", and a file that has points holds no colours."""
    grey = [file for file in files if file.count and not file.has_colour]
    if grey and taken_from == "rgb":
        raise RoadExtractionError(f"The points of {grey[0].path} have no colours (point format {grey[0].point_format}). Set Intensity from to "
                                  "intensity, or export the points with red, green and blue.")


def without_intensity(files: Sequence[CloudHeader], taken_from: str, fields: Sequence[str] = ()) -> str:
    """A sentence on points that are all equally bright: whether colours, or else extra fields, are a way out; "" where they are not."""
    if taken_from == "rgb":
        return "The colours of the points are all the same, so they do not stand in for intensity."
    if any(_has_colours(file) for file in files):
        return ("The intensity of all points is the same, but they have colours: set Intensity from (INTENSITY_FROM) to rgb, and paint is "
                "looked for in their brightness.")
    return (f"The intensity of all points is the same. If one of their extra fields ({', '.join(fields)}) holds what came back to the scanner, "
            "export it as intensity.") if fields else ""


def _has_colours(file):
    """Whether the first points of a file differ in colour."""
    if not (file.count and file.has_colour):
        return False
    values = luminance(next(read_blocks(file.path, layers=("rgb",))))
    return bool(values.min() < values.max())


# Points that whoever made the cloud marked as none of the survey: withheld ones, which "should not be included in processing (synonymous with
# Deleted)", and noise, classes 7 and 18 (ASPRS, LAS specification 1.4 R15, table 17).

NOISE_CLASSES = 7, 18   # source: as above


def flagged(block: Any) -> bool:
    """Whether any of laspy's points has a flag or a scanner channel: LAS 1.4 keeps them in one byte, and most clouds have none."""
    raw = block.array
    return "classification_flags" not in raw.dtype.names or bool(raw["classification_flags"].max(initial=0))


def packed_returns(block: Any) -> np.ndarray:
    """(N,) return number + 16 * number of returns of a block."""
    return np.asarray(block["return_number"]) | (np.asarray(block["number_of_returns"]) << 4)


def valid_points(block: Any) -> np.ndarray | None:
    """(N,) bool: the points of a block that are neither withheld nor noise; None for all. Its layers `flags` and `classification` are decoded."""
    has_withheld = flagged(block) and "withheld" in block.point_format.dimension_names
    withheld = np.asarray(block["withheld"]) != 0 if has_withheld else np.zeros(1, bool)
    classes = np.asarray(block["classification"])
    noise = (classes == NOISE_CLASSES[0]) | (classes == NOISE_CLASSES[1])
    if not noise.any():
        return ~withheld if withheld.any() else None
    return ~(noise | withheld)


def first_returns(block: Any, slots: TimeSlots | None = None, origin: Sequence[float] | np.ndarray = (0.0, 0.0, 0.0)) -> tuple[np.ndarray, ...]:
    """(N,) gps_time, (N, 3) m from the origin, and (N, 2) values of SCANNER_FIELDS, of the usable first returns of a block.

    slots : those in the sample alone; None for all
    """
    raw, names = block.array, set(block.point_format.dimension_names)
    time = raw["gps_time"].astype(float) if "gps_time" in raw.dtype.names else np.zeros(len(raw))
    first = np.flatnonzero(np.asarray(block["return_number"]) <= 1)
    if slots is not None:
        # without times neighbours in the file stay together no better than others
        first = first[slots.kept(time[first])] if len(time) and time.min() < time.max() else first[::slots.stride]
    if (valid := valid_points(block)) is not None:
        first = first[valid[first]]
    first = first[np.isfinite(time[first])]
    place = np.stack([raw[name][first] * scale + (offset - start)
                      for name, scale, offset, start in zip("XYZ", block.scales, block.offsets, origin)], axis=1)
    channel = np.asarray(block["scanner_channel"])[first] if "scanner_channel" in names else np.zeros(len(first), np.int64)
    return time[first], place, np.stack([raw["point_source_id"][first], channel], axis=1).astype(np.int64)


# Coordinates of a LAS file, stored as integers, converted to the local integers of a record.


class LasAxis:
    """One coordinate axis of a file, "X", "Y" or "Z": its integers, with scale and offset in metres, converted to units of 0.1 mm from an origin."""

    def __init__(self, name: str, scale: float, offset: float, origin: float, dtype: np.dtype | type = np.int32):
        self._dtype = np.dtype(dtype)
        self.name, self.scale, self.shift = name, scale, offset - origin
        step, start = scale / COORDINATE_SCALE, self.shift / COORDINATE_SCALE
        # For nearly every file the units follow from the file's integers by integer arithmetic.
        self._integer = abs(step - round(step)) <= 1e-13 * abs(step) and abs(start - round(start)) < 1e-3
        unsigned = np.dtype(f"u{self._dtype.itemsize}")
        modulus = 2**(8 * unsigned.itemsize)
        self._step, self._start = (np.array(round(value) % modulus if self._integer else 0, unsigned).view(self._dtype)
                                   for value in (step, start))

        # the file's integers of places that are no outliers
        farthest = LAS.farthest_place if self._dtype != np.int32 else LAS.farthest_height if name == "Z" else MAX_XY_32_BIT
        limits = sorted((sign * farthest - self.shift) / scale for sign in (-1, 1))
        self._least, self._most = np.ceil(limits[0]), np.floor(limits[1])

    def units(self, raw: np.ndarray, buffer: Callable[..., np.ndarray]) -> tuple[np.ndarray, np.ndarray | None]:
        """Local coordinates of (N,) raw points in units of 0.1 mm, and (N,) bool of those that are no outliers, None for all.

        buffer : function of a name and a dtype (float64 by default) that returns an (N,) working array
        """
        numbers = buffer(self.name, self._dtype)
        np.copyto(numbers, raw[self.name])
        valid = None
        if len(numbers) and not (numbers.min() >= self._least and numbers.max() <= self._most):
            valid = (numbers >= self._least) & (numbers <= self._most)
        if not self._integer:
            metres = np.multiply(numbers, self.scale, out=buffer("metres"))
            metres += self.shift
            return fill_units(metres, numbers), valid
        # Integer overflow in between cancels: the result is right modulo 2**bits, and fits.
        numbers *= self._step
        numbers += self._start
        return numbers, valid
