"""Arrays in a file, mapped into memory by whoever reads them."""

import threading

import numpy as np
import pytest
from lanewright.core.execution.phase import is_sealed
from lanewright.core.survey.store import array_file
from lanewright.core.survey.store.array_file import ArrayFile, new_file, opened

RNG = np.random.default_rng(3)
ARRAYS = [RNG.integers(0, 2**31, 1001).astype(np.int32),
          RNG.random(77), np.array([np.nan, -0.0, 0.0], np.float32), RNG.integers(0, 256, 5).astype(np.uint8)]


def put(file, array):
    return file.put([array], array.nbytes)


@pytest.mark.parametrize("named", [False, True])
def test_arrays_come_out_of_the_file_as_they_went_in_to_the_bit_however_much_is_mapped_meanwhile(tmp_path, named, monkeypatch):
    monkeypatch.setattr(array_file, "_mapped", array_file._MappedPages())
    monkeypatch.setattr(array_file, "STORE", type("Weights", (), dict(mapped_bytes=100)))
    file = ArrayFile(tmp_path / "points.bin" if named else None)
    places = [put(file, array) for array in ARRAYS]
    found = [file.get(place, len(array), array.dtype) for place, array in zip(places, ARRAYS)]
    late = put(file, np.arange(9.0))
    assert [values.tobytes() for values in found] == [array.tobytes() for array in ARRAYS]
    assert file.get(late, 9, float).tolist() == list(range(9)) and not len(file.get(late, 0, float))
    with pytest.raises(ValueError, match="read-only"):
        found[0][0] = 1


def test_an_array_that_the_file_does_not_hold_is_an_error_of_the_disk():
    file = ArrayFile()
    place = put(file, ARRAYS[0])
    with pytest.raises(OSError, match="ends early"):
        file.get(place, 2000, np.int32)


def test_several_threads_write_to_one_file():
    file, places = ArrayFile(), {}
    threads = [threading.Thread(target=lambda k=k: places.update({k: [put(file, np.full(100 + k, k)) for _ in range(50)]})) for k in range(6)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert all((file.get(place, 100 + k, int) == k).all() for k, of_thread in places.items() for place in of_thread)


def test_a_finished_file_appears_whole_and_one_that_a_power_failure_damaged_is_known(tmp_path):
    with new_file(tmp_path) as (file, name):
        place = put(file, ARRAYS[1])
        assert not (tmp_path / name).exists()
    with pytest.raises(KeyboardInterrupt), new_file(tmp_path) as (file, _):
        put(file, ARRAYS[0])
        raise KeyboardInterrupt
    assert [path.name for path in tmp_path.iterdir()] == [name] and is_sealed(tmp_path / name)
    assert opened(tmp_path / name).get(place, len(ARRAYS[1]), float).tolist() == ARRAYS[1].tolist()
    whole = (tmp_path / name).read_bytes()
    for damaged in (whole[:-1], b"", whole[:40] + b"?" + whole[41:]):
        (tmp_path / name).write_bytes(damaged)
        assert not is_sealed(tmp_path / name)
