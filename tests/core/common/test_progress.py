"""What the user is told of the time that is left."""

import numpy as np
import pytest
from lanewright.core.common.progress import PROGRESS, RemainingTime


class Clock:
    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


def told(fractions, seconds):
    """[(second, what was told)] over a run whose bar stands at `fractions` after `seconds`."""
    clock = Clock()
    remaining = RemainingTime(clock)
    found = []
    for fraction, passed in zip(fractions, seconds):
        clock.now = 100.0 + passed
        step = remaining.after(fraction)
        if step is not None:
            found.append((passed, step))
    return found


@pytest.mark.parametrize("whole", [40.0, 90.0, 600.0, 7200.0])
def test_an_even_bar_is_told_truly_and_only_shorter(whole):
    seconds = np.linspace(0.0, whole, 4001)
    found = told(seconds / whole, seconds)
    steps = [step for _, step in found]
    assert steps == sorted(set(steps), reverse=True) and steps[-1] == PROGRESS.remaining_steps[0]
    for passed, step in found:
        assert 0.6 < step / (whole - passed) < 1.7


def test_every_step_is_told_once_however_often_the_bar_moves():
    seconds = np.linspace(0.0, 60.0, 100_000)
    assert [step for _, step in told(seconds / 60.0, seconds)] == [60, 40, 20, 10]


def test_a_short_run_is_told_nothing_of():
    seconds = np.linspace(0.0, 6.0, 600)
    assert told(seconds / 6.0, seconds) == []


def test_a_bar_that_stumbles_does_not_make_the_time_flicker():
    seconds = np.linspace(0.0, 300.0, 3001)
    uneven = np.clip(seconds / 300.0 + 0.03 * np.sin(seconds / 7.0), 0.0, 1.0)
    steps = [step for _, step in told(np.maximum.accumulate(uneven), seconds)]
    assert len(steps) <= 8
    assert sum(later > earlier for earlier, later in zip(steps, steps[1:])) <= 1


def test_work_that_turns_out_slow_is_told_anew():
    """Half the bar in 20 s, the other half in 380 s."""
    seconds = np.linspace(0.0, 400.0, 4001)
    fractions = np.where(seconds < 20.0, seconds / 40.0, 0.5 + (seconds - 20.0) / 760.0)
    found = told(fractions, seconds)
    steps = [step for _, step in found]
    assert max(steps[1:]) > steps[0]
    assert len(steps) < 15


def test_nothing_is_told_of_a_bar_that_stands_at_either_end():
    assert told([0.0, 0.0, 1.0, 1.0], [0.0, 30.0, 60.0, 90.0]) == []
