"""How long a computation will still take, told now and then in round figures."""

import math
import time


class Progress:
    """A silent listener; the shell's listener moves the bar, prints, and raises Cancelled.

    Every core function that takes longer than a blink has `progress` as its
    last argument. `report` may raise Cancelled, so call it once per section.
    """

    def report(self, fraction):
        """Report the fraction done, 0 to 1, of this computation."""

    def check_cancelled(self):
        """Raise Cancelled where the work shall stop; the bar stays where it is."""

    def info(self, text):
        """Report a finding or a step in one line."""

    def warn(self, text):
        """Report, once, what is doubtful, with a count."""

    def part(self, start, end):
        """A listener for one part of the work, from fraction `start` to `end`."""
        return _Part(self, start, end)


class _Part(Progress):
    def __init__(self, whole, start, end):
        self.whole, self.start, self.span = whole, start, end - start
        self.info, self.warn, self.check_cancelled = whole.info, whole.warn, whole.check_cancelled

    def report(self, fraction):
        self.whole.report(self.start + self.span * min(max(fraction, 0.0), 1.0))

REMAINING_STEPS = (10, 20, 40, 60, 120, 180, 300, 600, 900, 1200, 1800, 2700, 3600, 7200, 10800, 18000, 28800, 43200, 86400)  # s, what is told
MIN_ELAPSED = 5.0      # s of work before anything is told,
MIN_FRACTION = 0.08        # and share of the work
LONGER_FACTOR = 1.5        # times what was told last, from which on it was wrong and is told anew,
MIN_REPEAT = 20.0     # s after it was told at the earliest


class RemainingTime:
    """Listens to the share that is done and says, when there is something new to say, how long the rest will take.

    The rest takes as long as what was done took, share for share. Told are the steps of a
    coarse scale, each once as the time runs down, so that a run of a minute is told
    of four times; a longer time than was told comes only where it is clearly longer.
    """

    def __init__(self, clock=time.monotonic):
        self._clock, self._began = clock, clock()
        self._told, self._told_at = math.inf, 0.0

    def after(self, fraction):
        """Seconds left, of `REMAINING_STEPS`, where that is new; None where there is nothing to tell.

        Parameters
        ----------
        fraction : done, 0 to 1
        """
        passed = self._clock() - self._began
        if passed < MIN_ELAPSED or not MIN_FRACTION <= fraction < 1.0:
            return None
        left = passed * (1.0 - fraction) / fraction
        step = min(REMAINING_STEPS, key=lambda seconds: abs(math.log(seconds / max(left, 1e-3))))
        longer = step > self._told and left > LONGER_FACTOR * self._told and passed - self._told_at > MIN_REPEAT
        if left < REMAINING_STEPS[0] / 2 or not (step < self._told or longer):
            return None
        self._told, self._told_at = step, passed
        return step
