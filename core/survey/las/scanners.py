"""Which scanner measured a point, where a vehicle carries more than one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...common.errors import RoadExtractionError

MAX_SCANNERS = 8
MIN_INTERLEAVED_SHARE = 0.8   # of the points: their values must overlap in time if the values identify scanners
EVER = (-np.inf, np.inf)      # s


@dataclass
class ScannerCensus:
    """Counts and time spans of scanner_channel and point_source_id, gathered while reading.

    In a cloud without times stations along the road stand in their place: scanners measure the same stretches of it, files and tiles do not.

    spans : {LAS field: {value: (first time, last time, count)}}
    """

    spans: dict[str, dict[int, tuple[float, float, int]]] = field(default_factory=lambda: {"scanner_channel": {}, "point_source_id": {}})

    def add(self, name: str, values: np.ndarray, time: np.ndarray) -> None:
        """Add a block: (N,) values of one LAS field and (N,) gps_time."""
        self.take(name, times_by_value(values, time))

    def take(self, name: str, times: dict[int, tuple[float, float, int]]) -> None:
        """Add the result of `times_by_value` for a block."""
        seen = self.spans[name]
        if len(seen) > 4 * MAX_SCANNERS:
            return
        for value, (start, end, number) in times.items():
            first, last, count = seen.get(value, (np.inf, -np.inf, 0))
            seen[value] = min(first, start), max(last, end), count + number

    def choose(self, wanted: str | None = "automatic") -> tuple[str | None, list[Any]]:
        """The LAS field that identifies the scanners.

        This is `scanner_channel` if it has more than one value, else `point_source_id` if it has 2 to 32 values that
        overlap in time, or along the road where there are no times. LAS defines the latter as a flight line or file number;
        some exporters count frames in it, others number every recording of every scanner.

        Parameters
        ----------
        wanted : "automatic", or the LAS field to use

        Returns
        -------
        name : of the field; None if there is one scanner
        values : one entry per scanner in ascending order, a tuple where successive recordings belong to one scanner

        Raises
        ------
        RoadExtractionError
            If the wanted field is unknown or has too many values.
        """
        if wanted not in ("", "automatic", None):
            if wanted not in self.spans:
                raise RoadExtractionError(
                    f"Scanner field {wanted!r} is not known; choose automatic, scanner_channel or point_source_id.")
            values = sorted(self.spans[wanted])
            if len(values) > 4 * MAX_SCANNERS:
                raise RoadExtractionError(
                    f"{wanted} has more than {4 * MAX_SCANNERS} different values, too many to be scanners. "
                    "Set the scanner field to automatic.")
            return wanted, values if len(values) <= MAX_SCANNERS else _heads(self.spans[wanted])
        channels = self.spans["scanner_channel"]
        if 1 < len(channels) <= MAX_SCANNERS:
            return "scanner_channel", sorted(channels)
        sources = self.spans["point_source_id"]
        if 1 < len(sources) <= 4 * MAX_SCANNERS and _interleaved(sources.values()):
            heads = _heads(sources)
            if 1 < len(heads) <= MAX_SCANNERS:
                return "point_source_id", heads
        return None, [0]


def times_by_value(values: np.ndarray, time: np.ndarray, span: tuple[float, float] = EVER) -> dict[int, tuple[float, float, int]]:
    """{value: (first time, last time, count)} of (N,) small integers and times; incomplete if there are too many values.

    Points at times out of the span, or at none, do not count: some exporters write a wrong time here and there.
    """
    if len(values) and not (time.min() >= span[0] and time.max() <= span[1]):
        usable = np.flatnonzero((time >= span[0]) & (time <= span[1]))
        values, time = values[usable], time[usable]
    if not len(values):
        return {}
    # a broadcast column has one value
    few = values if values.strides[0] else values[:1]
    low, high = int(few.min()), int(few.max())
    present = [low, high][:high - low + 1] if high - low < 2 else np.flatnonzero(np.bincount(values))[: 4 * MAX_SCANNERS + 1].tolist()
    found = {}
    for value in present:
        times = time if low == high else time[values == value]
        found[value] = float(times.min()), float(times.max()), len(times)
    return found


def numbers_by_value(scanners: Sequence[Any], count: int) -> np.ndarray:
    """(count,) uint8 scanner number of each value 0 ... count - 1; `scanners` as returned by `choose`."""
    numbers = np.zeros(count, np.uint8)
    for number, values in enumerate(scanners):
        values = np.atleast_1d(values)
        numbers[values[values < count]] = number
    return numbers


def _heads(spans):
    """Values of a field, ascending; those that measured one after the other are combined into one scanner."""
    heads: list[list[int]] = []
    for value in sorted(spans):
        free = next((head for head in heads if not any(_together(spans[value], spans[other]) for other in head)), None)
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
    return shared >= MIN_INTERLEAVED_SHARE * total
