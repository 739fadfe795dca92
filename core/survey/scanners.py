"""Which scanner measured a point, when a vehicle carries more than one."""

from dataclasses import dataclass, field

import numpy as np

from ..errors import RoadExtractionError

MOST_SCANNERS = 8


@dataclass
class ScannerCensus:
    """Counts and time spans of scanner_channel and point_source_id, gathered while reading."""

    spans: dict = field(default_factory=lambda: {"scanner_channel": {}, "point_source_id": {}})

    def add(self, name, values, time):
        """Take note of a block: (N,) values of one LAS field and (N,) gps_time."""
        self.take(name, times_by_value(values, time))

    def take(self, name, times):
        """Take note of what `times_by_value` found in a block."""
        seen = self.spans[name]
        if len(seen) > 4 * MOST_SCANNERS:
            return
        for value, (start, end, number) in times.items():
            first, last, count = seen.get(value, (np.inf, -np.inf, 0))
            seen[value] = min(first, start), max(last, end), count + number

    def choose(self, wanted="automatic"):
        """The LAS field that tells the scanners apart, or None where there is one scanner.

        `scanner_channel` where it holds more than one value, else `point_source_id`
        when it has 2 to 8 values that interleave in time (LAS defines it as a flight
        line or file number, and some exporters count frames in it).

        Returns
        -------
        (field name or None, list of its values in ascending order)
        """
        if wanted not in ("", "automatic", None):
            if wanted not in self.spans:
                raise RoadExtractionError(
                    f"Scanner field {wanted!r} is not known; choose automatic, scanner_channel or point_source_id.")
            values = sorted(self.spans[wanted])
            if len(values) > 4 * MOST_SCANNERS:
                raise RoadExtractionError(
                    f"{wanted} has more than {4 * MOST_SCANNERS} different values, too many to be scanners. "
                    "Set the scanner field to automatic.")
            return wanted, values
        channels = self.spans["scanner_channel"]
        if 1 < len(channels) <= MOST_SCANNERS:
            return "scanner_channel", sorted(channels)
        sources = self.spans["point_source_id"]
        if 1 < len(sources) <= MOST_SCANNERS and _interleaved(sources.values()):
            return "point_source_id", sorted(sources)
        return None, [0]


def times_by_value(values, time):
    """{value: (first time, last time, count)} of (N,) small integers and times; of many values those that show there are many."""
    if not len(values):
        return {}
    # of what all have the same one tells
    few = values if values.strides[0] else values[:1]
    low, high = int(few.min()), int(few.max())
    present = [low, high][:high - low + 1] if high - low < 2 else np.flatnonzero(np.bincount(values))[: 4 * MOST_SCANNERS + 1].tolist()
    found = {}
    for value in present:
        times = time if low == high else time[values == value]
        found[value] = float(times.min()), float(times.max()), len(times)
    return found


def _interleaved(spans):
    """True where each span of time shares more than half of its length with some other."""
    spans = [(first, last) for first, last, _ in spans]
    for k, (first, last) in enumerate(spans):
        shared = max((min(last, b) - max(first, a) for j, (a, b) in enumerate(spans) if j != k), default=0.0)
        if shared < 0.5 * (last - first):
            return False
    return True
