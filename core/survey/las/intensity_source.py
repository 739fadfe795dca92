"""What the intensity of a point is read from, and how: exporters write it with a sign, in decibels, or into an extra field."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ...common.errors import RoadExtractionError
from .reader import CloudHeader, read_blocks

if TYPE_CHECKING:
    from .samples import FileSample

INTENSITY_SOURCES = "intensity", "rgb"
COLOUR_FIELDS = "red", "green", "blue"
LUMINANCE_WEIGHTS = 0.2126, 0.7152, 0.0722   # of red, green and blue (ITU-R BT.709-6, section 3.2)
USUAL_FIELDS = "reflect", "amplitude", "intensity"   # parts of names of extra fields that hold what a scanner received, the best first
MAX_INTENSITY = 65535
SIGN = 2**15
EMPTY_MIDDLE = 0.001      # share of values in the middle half of 16 bits, at most, where values with a sign were wrapped
LEAST_SHARE = 0.01        # of values in the uppermost quarter, which were negative
USUAL_SPREAD = 20.0       # dB between dark asphalt and paint or signs, at one range and another
MAX_SPREAD = 60.0         # dB that no survey exceeds
VALUES_PER_DECIBEL = 1, 10, 100   # as exporters store it
MAX_POWER = 290.0         # of ten, with which a double can be multiplied
TOP, TOP_STEP = 30_000, 5.0   # intensity of the brightest points, and dB to which they are rounded, so that samples agree


@dataclass(frozen=True)
class IntensitySource:
    """How the intensity of points is read.

    field : of the points: "intensity", an extra field, or "rgb" for the luminance of their colours
    signed : whether values from SIGN on stand for negative ones
    per_decibel : values that make a decibel; 0 where they are linear
    zero : of linear values, what counts as 0
    factor : by which linear values, or those of decibels made linear, are multiplied
    """

    field: str = "intensity"
    signed: bool = False
    per_decibel: float = 0.0
    zero: float = 0.0
    factor: float = 1.0

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
    """How the intensities of files are to be read.

    Parameters
    ----------
    samples : of all files
    wanted : one of INTENSITY_SOURCES

    Returns
    -------
    source : IntensitySource
    note : what the user should know of it, "" where intensities are read as they are
    """
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
    names = [name for part in USUAL_FIELDS for name in samples[0].fields if part in name.lower()] if samples else []
    for name in dict.fromkeys(names):
        if all(name in sample.fields for sample in samples):
            numbers = np.concatenate([sample.fields[name] for sample in samples])
            numbers = numbers[np.isfinite(numbers)]
            if len(numbers) and numbers.min() < numbers.max():
                source = _source(name, numbers)
                return source, (f"The intensity of all points is the same, {int(values.max(initial=0))}; the extra field {name} is read in its "
                                f"place, as {_unit(source)}.")
    return IntensitySource(), ""


def _wrapped(values):
    """Whether (N,) intensities are negative and positive values that were written without their sign: one body or two, with nothing between.

    What a saturated scanner has at the upper end is mostly one value, and signs brighter than all else are few.
    """
    quarter = np.bincount(values >> 14, minlength=4) / len(values)
    if quarter[1] + quarter[2] > EMPTY_MIDDLE or quarter[3] < LEAST_SHARE:
        return False
    counts = np.bincount(values[values >= 3 * SIGN // 2])
    return bool(counts.max() < 0.5 * counts.sum())


def _source(field, values, signed=False):
    """The source that makes linear intensities of (N,) values."""
    low, high = np.quantile(values, [0.005, 0.995])
    spread = float(high - low)
    decibels = spread <= MAX_SPREAD * VALUES_PER_DECIBEL[-1] and (low < 0 or "amplitude" in field.lower() and USUAL_SPREAD / 4 < spread <= MAX_SPREAD)
    if not decibels:
        zero = min(float(values.min()), 0.0)
        return IntensitySource(field, signed, zero=zero, factor=TOP / max(float(high) - zero, 1e-12))
    unit = float(min(VALUES_PER_DECIBEL, key=lambda each: abs(np.log(max(spread, 1e-9) / each / USUAL_SPREAD))))
    top = np.ceil(high / unit / TOP_STEP) * TOP_STEP
    return IntensitySource(field, signed, unit, factor=float(TOP / 10.0 ** (top / 10.0)))


def _unit(source):
    """What the values of a source are taken for."""
    return f"decibels, {source.per_decibel:g} a dB, and made linear" if source.per_decibel else "linear values"


def luminance(points: Any) -> np.ndarray:
    """Brightness of coloured points, the weighted sum of their colours.

    Parameters
    ----------
    points : laspy point record with red, green and blue

    Returns
    -------
    (N,) uint16, in the unit of the colours
    """
    return np.rint(sum(weight * np.asarray(points[name], np.float32) for name, weight in zip(COLOUR_FIELDS, LUMINANCE_WEIGHTS))).astype(np.uint16)


def check_coloured(files: Sequence[CloudHeader]) -> None:
    """Refuse files whose points have no colours.

    Raises
    ------
    RoadExtractionError
        If the point format of a file that has points holds no colours.
    """
    grey = [file for file in files if file.count and not file.has_colour]
    if grey:
        raise RoadExtractionError(
            f"The points of {grey[0].path} have no colours (point format {grey[0].point_format}), from which the intensity was to be taken. "
            "Set Intensity from to intensity, or export the points with red, green and blue.")


def without_intensity(files: Sequence[CloudHeader], taken_from: str, fields: Sequence[str] = ()) -> str:
    """What to say of a cloud whose points are all equally bright.

    Parameters
    ----------
    files : headers of the clouds
    taken_from : one of INTENSITY_SOURCES, what was read as intensity
    fields : extra fields of the points

    Returns
    -------
    A sentence that names the colours, or else the extra fields, where they are a way out; "" where they are not
    """
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
