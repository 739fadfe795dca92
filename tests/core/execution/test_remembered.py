"""What a run asks again, the next one is not computed again."""

import pytest
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


def doubled_together(source, items, *arguments):
    return [2 * item for item in items]


doubled_together.__module__, doubled_together.__qualname__ = doubled.__module__, doubled.__qualname__


def results(remembered, items, source=None, arguments=(OutlierSettings(),), state=None):
    return list(remembered.run(Phase(doubled, source or NoSource(), arguments, state=state), items))


def test_the_next_runs_compute_what_is_new_in_them():
    asked = Asked()
    remembered = RememberedResults(asked)
    assert results(remembered, [3, 1, 3, 2]) == [6, 2, 6, 4]
    assert results(remembered, [4, 5, 3]) == [8, 10, 6]
    assert results(remembered, [5, 1, 2]) == [10, 2, 4]
    assert asked.items == [[3, 1, 2], [4, 5]], "each item once"


def test_items_that_come_together_are_remembered_one_by_one_so_that_a_new_one_before_them_changes_nothing():
    asked, phase = Asked(), Phase(doubled_together, NoSource(), (OutlierSettings(),), listed=2)
    remembered = RememberedResults(asked)
    first = list(remembered.run_together(phase, range(32)))
    assert list(remembered.run_together(phase, [100, *range(32)])) == [200, *first]
    assert len(asked.items) == 1, "the new one alone is few, which threads of the program compute"


def test_what_a_later_run_asks_for_a_whole_road_at_once_does_not_wait_for_workers_to_start():
    asked = Asked()
    remembered = RememberedResults(asked)
    assert results(remembered, [1]) == [2] and not remembered.full
    assert results(remembered, [2]) == [4] and results(remembered, range(3, 30)) == [2 * k for k in range(3, 30)]
    assert asked.items == [[1], list(range(3, 30))], "workers do the first run, and what is much"


def test_other_arguments_are_another_question():
    asked = Asked()
    remembered = RememberedResults(asked)
    assert results(remembered, [7]) == results(remembered, [7], arguments=(OutlierSettings(neighbours=9),)) == [14]
    assert asked.items == [[7], [7]]


@pytest.mark.parametrize("state, asked_again", [(None, [[7], [7]]), (lambda item: "as before", [[7]])])
def test_phases_that_read_from_files_are_run_again_unless_they_say_that_these_are_as_before(state, asked_again):
    asked = Asked()
    remembered = RememberedResults(asked)
    for _ in range(2):
        assert results(remembered, [7], source=TimeSlots(1), state=state) == [14]
    assert [items for items in asked.items if items] == asked_again


def test_what_many_runs_asked_is_forgotten_together_with_the_files_of_it(tmp_path):
    asked = Asked()
    asked.folder = tmp_path
    (tmp_path / "points-1.bin").touch()
    remembered = RememberedResults(asked)
    results(remembered, [1, 2])
    assert not remembered.full
    results(remembered, [3, 4, 5])
    assert remembered.full
    remembered.clear()
    assert not any(tmp_path.iterdir()) and results(remembered, [1]) == [2] and asked.items[-1] == [1]
