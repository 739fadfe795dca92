"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class _ProgressWeights:
    """The time that remains, as the log says it."""

    # s, as reported
    remaining_steps: tuple[int, ...] = (10, 20, 40, 60, 120, 180, 300, 600, 900, 1200, 1800, 2700, 3600, 7200, 10800, 18000, 28800, 43200, 86400)
    min_elapsed: float = 5.0   # s of work before the first estimate
    min_fraction: float = 0.08   # of the work that must be done before the first estimate
    longer_factor: float = 1.5   # a longer estimate replaces the last one only if it exceeds it by this factor
    min_repeat: float = 20.0   # s after the last estimate before a longer one may replace it


PROGRESS = _ProgressWeights()
