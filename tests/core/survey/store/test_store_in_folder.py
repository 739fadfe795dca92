"""A store that keeps its points in a folder, from where others open it."""

import numpy as np
import pytest
from lanewright.core.survey.store.records import SURVEY_POINT, point_dtype
from lanewright.core.survey.store.section_store import SectionStore


def filled(memory_limit, seed=1, count=20_000):
    rng = np.random.default_rng(seed)
    store = SectionStore(point_dtype(SURVEY_POINT, 100.0), memory_limit=memory_limit)
    for road in (0, 2):
        records = np.zeros(count, store.dtype)
        for name in ("x", "y", "z", "s", "d"):
            records[name] = rng.integers(-300_000, 300_000, count)
        records["time"], records["intensity"] = rng.random(count), rng.integers(0, 60_000, count)
        store.append(road, records)
    return store


def points_of(store):
    return [np.array(store.window(road, *store.span(road)).records) for road in store.roads()]


@pytest.mark.parametrize("memory_limit", [1 << 30, 1 << 16], ids=["in memory", "spilled"])
def test_a_store_in_a_folder_gives_the_same_points_here_and_to_others(tmp_path, memory_limit):
    store, moved = filled(memory_limit), filled(memory_limit)
    moved.move_to(tmp_path)
    opened = SectionStore.opened(tmp_path)
    assert opened.count == store.count and [opened.sections(0), opened.roads()] == [store.sections(0), store.roads()]
    for expected, here, there in zip(points_of(store), points_of(moved), points_of(opened)):
        assert expected.tobytes() == here.tobytes() == there.tobytes()
    for one in (store, moved, opened):
        one.close()


def test_what_leaves_a_section_empty_is_not_there(tmp_path):
    store = filled(1 << 16)
    store.finish = lambda road, records: np.full(len(records), road == 2)
    store.move_to(tmp_path)
    assert SectionStore.opened(tmp_path).roads() == [2]
