"""What a run asks again, the next one is not computed again."""

from lanewright.core.common.progress import Progress
from lanewright.core.execution.phase import NoSource, Phase, Threads
from lanewright.core.execution.remembered import RememberedResults
from lanewright.core.markings.outliers import OutlierSettings, kept_of_windows
from lanewright.core.survey.las.samples import TimeSlots


class Asked(Threads):
    """Threads that tell which items they were given."""

    def __init__(self):
        super().__init__(2)
        self.items = []

    def run(self, phase, items, progress=Progress(), keep=()):
        self.items.append(list(items))
        return super().run(phase, items, progress, keep)


def doubled(source, item, *arguments):
    return 2 * item


doubled.__module__, doubled.__qualname__ = kept_of_windows.__module__, kept_of_windows.__qualname__   # only a named function has a name


def results(remembered, items, source=None, arguments=(OutlierSettings(),)):
    return list(remembered.run(Phase(doubled, source or NoSource(), arguments), items))


def test_the_next_run_computes_what_is_new_in_it_and_the_one_after_it_knows_both():
    asked, remembered = Asked(), RememberedResults()
    assert results(remembered.of_next_run(asked), [3, 1, 3, 2]) == [6, 2, 6, 4]
    assert results(remembered.of_next_run(asked), [1, 5, 3]) == [2, 10, 6]
    assert results(remembered.of_next_run(asked), [5, 1, 2]) == [10, 2, 4]
    assert asked.items == [[3, 1, 2], [5], [2]], "each item once, and no longer than the next run"


def test_a_run_that_asks_nothing_forgets_nothing_and_other_arguments_are_another_question():
    asked, remembered = Asked(), RememberedResults()
    results(remembered.of_next_run(asked), [7])
    remembered.of_next_run(asked)
    assert results(remembered.of_next_run(asked), [7]) == [14]
    assert results(remembered, [7], arguments=(OutlierSettings(neighbours=9),)) == [14]
    assert asked.items == [[7], [], [7]]


def test_phases_that_read_from_files_are_always_run():
    asked, remembered = Asked(), RememberedResults()
    for _ in range(2):
        assert results(remembered.of_next_run(asked), [7], source=TimeSlots(1)) == [14]
    assert asked.items == [[7], [7]]
