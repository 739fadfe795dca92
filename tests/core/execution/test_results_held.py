"""Results of a phase are handed on one after the other: however many there are, few are in memory at a time."""

import weakref
from collections import Counter

import pytest
from lanewright.core.execution.keep import Keep, work_folder
from lanewright.core.execution.phase import NoSource, Phase, Threads
from lanewright.core.survey.las.samples import TimeSlots

ITEMS = 60
THREADS = 2


class Held:
    """Counts the results that are in memory, and the most that were at a time."""

    def __init__(self):
        self.count = Counter()
        self.most = 0

    def result(self, source, item):
        found = TimeSlots(item + 1)   # any object of core
        self.count["now"] += 1
        self.most = max(self.most, self.count["now"])
        weakref.finalize(found, self.gone)
        return found

    def gone(self):
        self.count["now"] -= 1


@pytest.mark.parametrize("kept", [False, True])
def test_a_road_of_any_length_has_few_results_of_a_phase_in_memory(tmp_path, monkeypatch, kept):
    held, executor = Held(), Threads(THREADS)
    # only a named function has a name in a work folder
    monkeypatch.setattr("lanewright.core.execution.keep.name_of", lambda function: "made:here")
    if kept:
        executor = Keep(executor, work_folder(str(tmp_path / "work")))
    strides = [found.stride for found in executor.run(Phase(held.result, NoSource()), range(ITEMS))]
    assert strides == list(range(1, ITEMS + 1))
    # one for each thread, one more ahead, the one that is handed on and the one before it
    assert held.most <= THREADS + 3
