"""What a run asks again, the next one is not computed again."""

import os
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from lanewright.core.common.progress import Progress, RememberedMessages
from lanewright.core.execution import keep
from lanewright.core.execution.keep import Keep, work_folder
from lanewright.core.execution.kept_run import KeptRun
from lanewright.core.execution.phase import NoSource, Phase, Threads, read_plain
from lanewright.core.markings.outliers import OutlierSettings, kept_of_windows
from lanewright.core.survey.las.samples import TimeSlots
from lanewright.core.survey.store.array_file import new_file


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


def results(kept, items, source=None, arguments=(OutlierSettings(),), state=None):
    return list(kept.run(Phase(doubled, source or NoSource(), arguments, state=state), items))


def test_the_next_runs_compute_what_is_new_in_them():
    asked = Asked()
    kept = Keep(asked)
    assert results(kept, [3, 1, 3, 2]) == [6, 2, 6, 4]
    assert results(kept, [4, 5, 3]) == [8, 10, 6]
    assert results(kept, [5, 1, 2]) == [10, 2, 4]
    assert asked.items == [[3, 1, 2], [4, 5]], "each item once"


def test_items_that_come_together_are_kept_one_by_one_so_that_a_new_one_before_them_changes_nothing():
    asked, phase = Asked(), Phase(doubled_together, NoSource(), (OutlierSettings(),), listed=2)
    kept = Keep(asked)
    first = list(kept.run_together(phase, range(32)))
    assert list(kept.run_together(phase, [100, *range(32)])) == [200, *first]
    assert len(asked.items) == 1, "the new one alone is few, which threads of the program compute"


def test_what_a_later_run_asks_for_a_whole_road_at_once_does_not_wait_for_workers_to_start():
    asked = Asked()
    kept = Keep(asked)
    assert results(kept, [1]) == [2] and not kept.full
    assert results(kept, [2]) == [4] and results(kept, range(3, 30)) == [2 * k for k in range(3, 30)]
    assert asked.items == [[1], list(range(3, 30))], "workers do the first run, and what is much"


def test_other_arguments_are_another_question():
    asked = Asked()
    kept = Keep(asked)
    assert results(kept, [7]) == results(kept, [7], arguments=(OutlierSettings(neighbours=9),)) == [14]
    assert asked.items == [[7], [7]]


@pytest.mark.parametrize("state, asked_again", [(None, [[7], [7]]), (lambda item: "as before", [[7]])])
def test_phases_that_read_from_files_are_run_again_unless_they_say_that_these_are_as_before(state, asked_again):
    asked = Asked()
    kept = Keep(asked)
    for _ in range(2):
        assert results(kept, [7], source=TimeSlots(1), state=state) == [14]
    assert [items for items in asked.items if items] == asked_again


def test_a_window_whose_runs_asked_twice_as_much_as_the_first_begins_anew():
    window, kept, freed = KeptRun(), Keep(Asked()), []
    window.wanted = True
    for count in (2, 4, 5):
        assert window.take()
        window.phases, window.free = kept, lambda: freed.append("points")
        window.keep("survey", "the same", "points")
        results(kept, range(count))
        window.give_back()
        assert window.known("survey", "the same") == (not freed) == (count < 5)


def in_folder(asked, folder, items=(1, 2, 3), phase=None):
    """What an executor gives that keeps results in a folder of the user's."""
    return list(Keep(asked, work_folder(str(folder))).run_together(phase or Phase(doubled, NoSource(), (OutlierSettings(),)), items))


def kept_in(folder):
    return {path: path.stat().st_ino for path in folder.glob("kept-*.plain")}


def test_in_a_folder_another_run_makes_what_is_new_also_where_the_folder_was_moved(tmp_path):
    asked = Asked()
    assert in_folder(asked, tmp_path / "work") == [2, 4, 6]
    (tmp_path / "work").rename(tmp_path / "moved")
    assert in_folder(asked, tmp_path / "moved", [3, 4, 1]) == [6, 8, 2]
    assert asked.items == [[1, 2, 3], [4]] and not list(tmp_path.rglob("*.part*"))


def test_items_of_which_a_function_is_given_lists_lie_in_files_of_their_own(tmp_path):
    asked, phase = Asked(), Phase(doubled_together, NoSource(), (OutlierSettings(),), listed=2)
    in_folder(asked, tmp_path / "work", range(32), phase)
    assert len(kept_in(tmp_path / "work")) == 32
    assert in_folder(asked, tmp_path / "work", [100, *range(32)], phase)[:3] == [200, 0, 2] and asked.items[1:] == [[[100]]]


@pytest.mark.parametrize("left", [0, 20])
def test_a_result_that_cannot_be_read_is_made_again(tmp_path, left):
    in_folder(Asked(), tmp_path / "work")
    before = kept_in(tmp_path / "work")
    for path in before:
        path.write_bytes(path.read_bytes()[:left])
    assert in_folder(Asked(), tmp_path / "work") == [2, 4, 6] and kept_in(tmp_path / "work").keys() == before.keys()
    assert in_folder(asked := Asked(), tmp_path / "work") == [2, 4, 6] and not asked.items


def points_of(source, item, folder):
    """A result that names a file of points of the folder, which it writes."""
    with new_file(Path(folder)) as (file, name):
        file.put([np.full(9, item)], 72)
    return name


points_of.__module__, points_of.__qualname__ = kept_of_windows.__module__, kept_of_windows.__qualname__


@pytest.mark.parametrize("damage", [lambda path: path.unlink(), lambda path: path.write_bytes(bytes(76))])
def test_points_that_are_gone_or_damaged_are_made_again(tmp_path, damage):
    phase, work = Phase(points_of, NoSource(), (str(tmp_path / "work"),)), tmp_path / "work"
    first = in_folder(Asked(), work, [1, 2], phase)
    assert in_folder(Asked(), work, [1, 2], phase) == first
    damage(work / first[0])
    again = in_folder(Asked(), work, [1, 2], phase)
    assert again[0] != first[0] and again[1] == first[1] and (work / again[0]).exists()


def test_two_runs_share_a_folder_where_windows_replaces_no_file_that_the_other_reads(tmp_path, monkeypatch):
    class Other(Asked):
        """Another run, which makes the same at once."""

        def run(self, phase, items, progress=Progress(), keep=()):
            in_folder(Asked(), tmp_path / "work")
            monkeypatch.setattr(os, "replace", refused)
            return super().run(phase, items, progress, keep)

    def refused(source, target):
        raise PermissionError(13, "another process uses it", str(source), 5, str(target))

    assert in_folder(Other(), tmp_path / "work") == [2, 4, 6]
    assert len(kept_in(tmp_path / "work")) == 3 and not list(tmp_path.rglob("*.part*"))


def test_a_survey_is_made_once_and_says_again_what_it_said(tmp_path):
    def made(progress):
        progress.warn("The road is narrow.")
        return {"points": 3}

    for make in (made, None):
        heard = RememberedMessages()
        path = Keep(Asked(), work_folder(str(tmp_path / "work"))).made("a.laz", 7, make, heard)
        assert read_plain(path)[0] == {"points": 3} and heard.messages[-1] == ("warn", "The road is narrow.")


def test_where_a_fact_of_the_whole_survey_changes_all_is_made_anew_and_the_fact_is_named(tmp_path):
    asked, heard = Asked(), RememberedMessages()
    for height in (2.5, 2.5, 2.6, 2.5):
        kept = Keep(asked, work_folder(str(tmp_path / "work")))
        kept.stand_on("what follows", {"the CRS": "", "the height of the trajectory": height}, heard)
        assert results(kept, [7], source=TimeSlots(1), state=lambda item: "all of it") == [14]
    assert asked.items == [[7], [7]]
    assert ["the height of the trajectory" in text and "CRS" not in text for _, text in heard.messages if "anew" in text] == [True, True]


def test_of_a_folder_that_fills_its_disk_what_was_not_used_for_a_day_goes_and_nothing_of_others(tmp_path, monkeypatch):
    work = work_folder(str(tmp_path / "work"))
    in_folder(Asked(), work)
    (work / "notes.txt").write_text("of the user")
    old, long_ago = sorted(kept_in(work))[0], time.time() - 90_000
    for path in (old, work / "notes.txt"):
        os.utime(path, (long_ago, long_ago))
    Keep(Asked(), work).made("a.laz", 7, lambda progress: 1, RememberedMessages())
    assert old.exists(), "there is room"
    monkeypatch.setattr(keep.shutil, "disk_usage", lambda folder: SimpleNamespace(free=0))
    Keep(Asked(), work).made("a.laz", 7, None, RememberedMessages())
    assert not old.exists() and len(kept_in(work)) == 3 and (work / "notes.txt").exists()


def test_what_another_user_keeps_in_a_full_folder_stays_and_ends_no_run(tmp_path, monkeypatch):
    work = work_folder(str(tmp_path / "work"))
    in_folder(Asked(), work)
    theirs, mine, *_ = sorted(kept_in(work))
    for path, hours in ((theirs, 40), (mine, 30)):
        os.utime(path, (time.time() - 3600 * hours,) * 2)

    def unlink(path, missing_ok=False):
        if path == theirs:
            raise PermissionError(13, "Permission denied", str(path))
        os.unlink(path)

    monkeypatch.setattr(keep.shutil, "disk_usage", lambda folder: SimpleNamespace(free=0))
    monkeypatch.setattr(Path, "unlink", unlink)
    Keep(Asked(), work).made("a.laz", 7, lambda progress: 1, RememberedMessages())
    assert theirs.exists() and not mine.exists()
