"""Which scanner measured a point, when a vehicle carries more than one."""

from dataclasses import dataclass, field

import numpy as np

from ..common.errors import RoadExtractionError

MAX_SCANNERS = 8
MIN_INTERLEAVED_SHARE = 0.8   # share of the points whose numbers interleave where numbers tell scanners


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
        if len(seen) > 4 * MAX_SCANNERS:
            return
        for value, (start, end, number) in times.items():
            first, last, count = seen.get(value, (np.inf, -np.inf, 0))
            seen[value] = min(first, start), max(last, end), count + number

    def choose(self, wanted="automatic"):
        """The LAS field that tells the scanners apart, or None where there is one scanner.

        `scanner_channel` where it holds more than one value, else `point_source_id`
        when it has 2 to 32 values that interleave in time (LAS defines it as a flight
        line or file number, some exporters count frames in it, and others give every
        recording of every scanner a number of its own).

        Returns
        -------
        (field name or None, list of its values in ascending order; a tuple of them where recordings
        one after the other are those of one scanner)
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


def times_by_value(values, time):
    """{value: (first time, last time, count)} of (N,) small integers and times; of many values those that show there are many."""
    if not len(values):
        return {}
    # of what all have the same one tells
    few = values if values.strides[0] else values[:1]
    low, high = int(few.min()), int(few.max())
    present = [low, high][:high - low + 1] if high - low < 2 else np.flatnonzero(np.bincount(values))[: 4 * MAX_SCANNERS + 1].tolist()
    found = {}
    for value in present:
        times = time if low == high else time[values == value]
        found[value] = float(times.min()), float(times.max()), len(times)
    return found


def numbers_by_value(scanners, count):
    """(count,) uint8: the number of the scanner that each value 0 ... count - 1 stands for; scanners as `choose` gives them."""
    numbers = np.zeros(count, np.uint8)
    for number, values in enumerate(scanners):
        values = np.atleast_1d(values)
        numbers[values[values < count]] = number
    return numbers


def _heads(spans):
    """Values of a field, ascending, those that measured one after the other taken together as one scanner's."""
    heads = []
    for value in sorted(spans):
        free = next((head for head in heads if not any(_together(spans[value], spans[other]) for other in head)), None)
        if free is None:
            heads.append([value])
        else:
            free.append(value)
    return [head[0] if len(head) == 1 else tuple(head) for head in heads]


def _together(one, other):
    """Whether the shorter of two spans of time shares more than half of its length with the other."""
    return min(one[1], other[1]) - max(one[0], other[0]) > 0.5 * min(one[1] - one[0], other[1] - other[0])


def _interleaved(spans):
    """Whether most points have a value whose span of time shares more than half of its length with that of some other."""
    spans, total, shared = list(spans), 0, 0
    for k, (first, last, count) in enumerate(spans):
        longest = max((min(last, b) - max(first, a) for j, (a, b, _) in enumerate(spans) if j != k), default=0.0)
        total += count
        # where a recording begins or ends one scanner may see the road alone
        shared += count * (longest > 0 and longest >= 0.5 * (last - first))
    return shared >= MIN_INTERLEAVED_SHARE * total
