"""A store that has its points in files of a folder, from where others open it."""

import numpy as np
import pytest
from lanewright.core.survey.store import array_file, section_store
from lanewright.core.survey.store.records import SURVEY_POINT, point_dtype
from lanewright.core.survey.store.section_store import SectionStore, StoreIndex, opened_store


def appended(store, seed=1, count=20_000):
    rng = np.random.default_rng(seed)
    for road in (0, 2):
        records = np.zeros(count, store.dtype)
        for name in ("x", "y", "z", "s", "d"):
            records[name] = rng.integers(-300_000, 300_000, count)
        records["time"], records["intensity"] = rng.random(count), rng.integers(0, 60_000, count)
        store.append(road, records)
    return store


def filled(folder=None):
    return appended(SectionStore(point_dtype(SURVEY_POINT, 100.0), folder=folder))


def points_of(store):
    return [np.array(store.window(road, *store.span(road)).records) for road in store.roads()]


def keys_of(store):
    return [(road, section) for road in store.roads() for section in store.sections(road)]


def put_in_order(store, keys, folder):
    with SectionStore(store.dtype, store.section_length, folder).part() as part:
        return store.written_in_order(keys, part)


@pytest.mark.parametrize("files", [1, 2])
def test_a_store_put_in_order_in_a_folder_gives_the_same_points_here_and_to_others(tmp_path, files):
    store, moved = filled(), filled()
    keys = keys_of(moved)
    moved.take_over(StoreIndex.join([put_in_order(moved, keys[k::files], tmp_path) for k in range(files)]), tmp_path)
    opened = opened_store(tmp_path, **moved.contents())
    assert opened.count == store.count and [opened.sections(0), opened.roads()] == [store.sections(0), store.roads()]
    assert len(list(tmp_path.iterdir())) == files
    for expected, here, there in zip(points_of(store), points_of(moved), points_of(opened)):
        assert expected.tobytes() == here.tobytes() == there.tobytes()
    for one in (store, moved, opened):
        one.close()


def test_points_that_two_wrote_part_by_part_are_those_of_one(tmp_path, monkeypatch):
    monkeypatch.setattr(section_store, "opened", array_file.opened.__wrapped__)   # as if too many files were open
    whole = SectionStore(point_dtype(SURVEY_POINT, 100.0), folder=tmp_path)
    parts = SectionStore(whole.dtype, folder=tmp_path)
    for seed in (1, 2):
        appended(whole, seed)
        with parts.part() as part:
            appended(part, seed)
        parts.adopt(part.index(), tmp_path)
    assert not list(tmp_path.glob("*.part")) and parts.count == whole.count
    appended(parts, 3)
    for expected, found in zip(points_of(appended(whole, 3)), points_of(parts)):
        assert expected.tobytes() == found.tobytes()


def test_parts_of_a_store_without_a_folder_lie_in_its_own_file():
    whole, parts = filled(), SectionStore(point_dtype(SURVEY_POINT, 100.0))
    with parts.part() as part:
        appended(part)
    parts.adopt(part.index())
    assert list(part.index().files) == [parts._files[False]]
    for expected, found in zip(points_of(whole), points_of(parts)):
        assert expected.tobytes() == found.tobytes()


def test_what_leaves_a_section_empty_is_not_there(tmp_path):
    store = filled()
    store.finish = lambda road, records: np.full(len(records), road == 2)
    store.take_over(put_in_order(store, keys_of(store), tmp_path), tmp_path)
    assert store.roads() == [2]


def test_an_index_of_nothing_opens_as_nothing(tmp_path):
    store = SectionStore(point_dtype(SURVEY_POINT, 100.0), folder=tmp_path)
    with store.part() as part:
        pass
    empty = part.index()
    found = opened_store(tmp_path, **dict(store.contents(), points=StoreIndex.join([empty, empty])))
    assert found.roads() == [] and found.count == 0 and not list(tmp_path.iterdir())
