"""How long a computation will still take, told now and then in round figures."""

import math
import time

STEPS = (10, 20, 40, 60, 120, 180, 300, 600, 900, 1200, 1800, 2700, 3600, 7200, 10800, 18000, 28800, 43200, 86400)  # s, what is told
EARLIEST = 5.0      # s of work before anything is told,
LEAST = 0.08        # and share of the work
LONGER = 1.5        # times what was told last, from which on it was wrong and is told anew,
PATIENCE = 20.0     # s after it was told at the earliest


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
        """Seconds left, of `STEPS`, where that is new; None where there is nothing to tell.

        Parameters
        ----------
        fraction : done, 0 to 1
        """
        passed = self._clock() - self._began
        if passed < EARLIEST or not LEAST <= fraction < 1.0:
            return None
        left = passed * (1.0 - fraction) / fraction
        step = min(STEPS, key=lambda seconds: abs(math.log(seconds / max(left, 1e-3))))
        longer = step > self._told and left > LONGER * self._told and passed - self._told_at > PATIENCE
        if left < STEPS[0] / 2 or not (step < self._told or longer):
            return None
        self._told, self._told_at = step, passed
        return step
