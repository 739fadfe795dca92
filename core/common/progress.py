"""Progress of a computation: fraction done, log messages, cancellation and an estimate of the remaining time."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable

from .setting import table


@table
class PROGRESS:
    """The time that remains, as the log says it."""

    # s, as reported
    remaining_steps: tuple[int, ...] = (10, 20, 40, 60, 120, 180, 300, 600, 900, 1200, 1800, 2700, 3600, 7200, 10800, 18000, 28800, 43200, 86400)
    min_elapsed: float = 5.0   # s of work before the first estimate
    min_fraction: float = 0.08   # of the work that must be done before the first estimate
    longer_factor: float = 1.5   # a longer estimate replaces the last one only if it exceeds it by this factor
    min_repeat: float = 20.0   # s after the last estimate before a longer one may replace it


class Progress:
    """Receives the progress of a computation. This base class passes it on to that of the whole work, or ignores it where there is none.

    A user interface overrides the methods: it moves the bar, prints the messages and raises `Cancelled`.
    Every function of the core that may take longer than a second has `progress` as its last argument.
    """

    whole: Progress | None = None

    def report(self, fraction: float) -> None:
        """Report the fraction of this computation that is done, 0 to 1.

        Raises Cancelled if the user cancelled. Call it at least once per section of road.
        """
        if self.whole is not None:
            self.whole.report(fraction)

    def check_cancelled(self) -> None:
        """Raise `Cancelled` if the user cancelled; the bar does not move."""
        if self.whole is not None:
            self.whole.check_cancelled()

    def info(self, text: str) -> None:
        """Log a result or a step in one line."""
        if self.whole is not None:
            self.whole.info(text)

    def warn(self, text: str) -> None:
        """Log a doubtful finding once, with its count."""
        if self.whole is not None:
            self.whole.warn(text)

    def warn_all(self, texts: Iterable[str]) -> None:
        """Log several of them."""
        for text in texts:
            self.warn(text)

    def part(self, start: float, end: float) -> Progress:
        """The progress of one part of the work, which runs from fraction `start` to `end` of the whole."""
        return _PartOfProgress(self, start, end)


class _PartOfProgress(Progress):
    def __init__(self, whole: Progress, start: float, end: float):
        self.whole, self.start, self.span = whole, start, end - start

    def report(self, fraction: float) -> None:
        super().report(self.start + self.span * min(max(fraction, 0.0), 1.0))


class RememberedMessages(Progress):
    """Passes everything on, and remembers the messages: a list of ("info" or "warn", text)."""

    def __init__(self, whole: Progress = Progress()):
        self.whole = whole
        self.messages: list[tuple[str, str]] = []

    @property
    def warnings(self) -> list[str]:
        return [text for kind, text in self.messages if kind == "warn"]

    def info(self, text: str) -> None:
        self.messages.append(("info", text))
        super().info(text)

    def warn(self, text: str) -> None:
        self.messages.append(("warn", text))
        super().warn(text)


class RemainingTime:
    """Estimates the remaining time from the fraction done, in round steps.

    The remaining work is assumed to advance as fast as the work so far. Each of `PROGRESS.remaining_steps` is returned at most once as the time runs
    down, so a run of one minute gets four estimates. A longer estimate than the last one is returned only if it is clearly longer.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic):
        self._clock, self._began = clock, clock()
        self._last, self._last_at = math.inf, 0.0

    def after(self, fraction: float) -> int | None:
        """Remaining seconds, one of `PROGRESS.remaining_steps`, with a fraction of the work done; None where no new estimate is due."""
        elapsed = self._clock() - self._began
        if elapsed < PROGRESS.min_elapsed or not PROGRESS.min_fraction <= fraction < 1.0:
            return None
        left = elapsed * (1.0 - fraction) / fraction
        step = min(PROGRESS.remaining_steps, key=lambda seconds: abs(math.log(seconds / max(left, 1e-3))))
        longer = step > self._last and left > PROGRESS.longer_factor * self._last and elapsed - self._last_at > PROGRESS.min_repeat
        if left < PROGRESS.remaining_steps[0] / 2 or not (step < self._last or longer):
            return None
        self._last, self._last_at = step, elapsed
        return step
