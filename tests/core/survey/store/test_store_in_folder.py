"""A store that has its points in files of a folder, from where others open it."""

import numpy as np
import pytest
from lanewright.core.survey.store import spill_file
from lanewright.core.survey.store.records import SURVEY_POINT, point_dtype
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.store.spill_file import StoreIndex

IN_MEMORY, SPILLED = 1 << 30, 1 << 16


def appended(store, seed=1, count=20_000):
    rng = np.random.default_rng(seed)
    for road in (0, 2):
        records = np.zeros(count, store.dtype)
        for name in ("x", "y", "z", "s", "d"):
            records[name] = rng.integers(-300_000, 300_000, count)
        records["time"], records["intensity"] = rng.random(count), rng.integers(0, 60_000, count)
        store.append(road, records)
    return store


def filled(memory_limit, folder=None):
    return appended(SectionStore(point_dtype(SURVEY_POINT, 100.0), memory_limit=memory_limit, folder=folder))


def points_of(store):
    return [np.array(store.window(road, *store.span(road)).records) for road in store.roads()]


def keys_of(store):
    return [(road, section) for road in store.roads() for section in store.sections(road)]


@pytest.mark.parametrize("memory_limit", [IN_MEMORY, SPILLED], ids=["in memory", "spilled"])
@pytest.mark.parametrize("files", [1, 2])
def test_a_store_put_in_order_in_a_folder_gives_the_same_points_here_and_to_others(tmp_path, memory_limit, files):
    store, moved = filled(memory_limit), filled(memory_limit)
    keys = keys_of(moved)
    moved.take_over(StoreIndex.join([moved.write_in_order(keys[k::files], tmp_path) for k in range(files)]), tmp_path)
    opened = SectionStore.opened(tmp_path, **moved.contents())
    assert opened.count == store.count and [opened.sections(0), opened.roads()] == [store.sections(0), store.roads()]
    assert len(list(tmp_path.iterdir())) == files
    for expected, here, there in zip(points_of(store), points_of(moved), points_of(opened)):
        assert expected.tobytes() == here.tobytes() == there.tobytes()
    for one in (store, moved, opened):
        one.close()


@pytest.mark.parametrize("memory_limit", [IN_MEMORY, SPILLED], ids=["in memory", "spilled"])
def test_points_that_two_wrote_part_by_part_are_those_of_one(tmp_path, memory_limit, monkeypatch):
    monkeypatch.setattr(spill_file, "_opened", spill_file._opened.__wrapped__)   # as if too many files were open
    whole = SectionStore(point_dtype(SURVEY_POINT, 100.0), memory_limit=memory_limit, folder=tmp_path)
    parts = SectionStore(whole.dtype, memory_limit=memory_limit, folder=tmp_path)
    for seed in (1, 2):
        appended(whole, seed)
        with parts.part() as part:
            appended(part, seed)
            index = part.index()
        parts.adopt(index, tmp_path)
    assert not list(tmp_path.glob("*.part")) and parts.count == whole.count
    appended(parts, 3)
    for expected, found in zip(points_of(appended(whole, 3)), points_of(parts)):
        assert expected.tobytes() == found.tobytes()


def test_a_part_that_is_not_finished_leaves_no_file(tmp_path):
    store = filled(SPILLED, tmp_path)
    before = set(tmp_path.iterdir())
    with pytest.raises(KeyboardInterrupt), store.part() as part:
        appended(part)
        part.index()
        raise KeyboardInterrupt
    assert set(tmp_path.iterdir()) == before


def test_what_leaves_a_section_empty_is_not_there(tmp_path):
    store = filled(SPILLED)
    store.finish = lambda road, records: np.full(len(records), road == 2)
    store.take_over(store.write_in_order(keys_of(store), tmp_path), tmp_path)
    assert store.roads() == [2]


def test_an_index_of_nothing_opens_as_nothing(tmp_path):
    store = SectionStore(point_dtype(SURVEY_POINT, 100.0), folder=tmp_path)
    with store.part() as part:
        empty = part.index()
    found = SectionStore.opened(tmp_path, **dict(store.contents(), points=StoreIndex.join([empty, empty])))
    assert found.roads() == [] and found.count == 0 and not list(tmp_path.iterdir())
