"""What a run says on a terminal or in a log, and Ctrl-C as Cancel."""

from __future__ import annotations

import signal
import sys
from contextlib import contextmanager

from ..algorithms.progress import time_left
from ..algorithms.texts import told, tr
from ..core.common.errors import Cancelled
from ..core.common.progress import Progress, RemainingTime

PERCENT_STEP = 10  # between two lines about the share that is done


class TextProgress(Progress):
    """Writes findings and, every tenth of the work, the share that is done; raises Cancelled once `cancelled` is set."""

    def __init__(self, stream=None, remaining=None):
        self.stream = sys.stderr if stream is None else stream
        self.cancelled = False
        self._remaining = remaining or RemainingTime()
        self._written = 0

    def check_cancelled(self):
        if self.cancelled:
            raise Cancelled

    def report(self, fraction):
        self.check_cancelled()
        left = self._remaining.after(fraction)
        remaining = "" if left is None else time_left(left)
        percent = PERCENT_STEP * int(100 * fraction / PERCENT_STEP)
        if percent > self._written or left is not None:
            self._written = max(percent, self._written)
            self._write(f"{100 * fraction:.0f} %" + (remaining and f", {remaining[0].lower()}{remaining[1:]}"))

    def info(self, text):
        self._write(told(text))

    def warn(self, text):
        self._write(tr("Warning: {text}").format(text=told(text)))

    def _write(self, text):
        print(text, file=self.stream, flush=True)


@contextmanager
def cancelled_by_signals(progress):
    """While this lasts, Ctrl-C and a polite kill end the run at its next question; a second one ends the program at once."""

    def cancel(number, frame):
        progress.cancelled = True
        signal.signal(number, before[number])

    before = {number: signal.signal(number, cancel) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
