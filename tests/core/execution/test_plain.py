"""Plain values in files: what comes back, and what is refused."""

import json
import zlib

import numpy as np
import pytest
from lanewright.core.execution.phase import CHECKSUM, FORMAT, TEXT_LENGTH, read_plain, write_plain
from lanewright.core.road.common.curb_limits import CurbSettings
from lanewright.core.road.common.occlusion import OcclusionGrid
from lanewright.core.survey.frame.road import Road
from lanewright.core.survey.frame.road_frame import Pass


def there_and_back(tmp_path, value):
    write_plain(tmp_path / "value.plain", value)
    return read_plain(tmp_path / "value.plain")


@pytest.mark.parametrize("value", [None, True, 3, 0.1 + 0.2, float("inf"), "Straße", [], (1, ("a", None)), {(0, 1): [2.5], "k": {}}])
def test_numbers_texts_and_what_holds_them_come_back_as_they_were(tmp_path, value):
    found = there_and_back(tmp_path, value)
    assert found == value and type(found) is type(value)


@pytest.mark.parametrize("array", [np.arange(5, dtype=np.int32), np.empty((0, 3)), np.array([1 + 2j]), np.array([True]), np.zeros(2, "f4,i8")])
def test_arrays_keep_their_type_and_every_bit(tmp_path, array):
    found = there_and_back(tmp_path, [array])[0]
    assert found.dtype == array.dtype and found.tobytes() == array.tobytes() and found.shape == array.shape


def test_arrays_keep_their_order_in_memory(tmp_path):
    rows, columns, part = there_and_back(tmp_path, [np.ones((3, 4)), np.ones((4, 3)).T, np.arange(24.0).reshape(4, 6)[::2, 1:]])
    assert rows.flags.c_contiguous and columns.flags.f_contiguous and not columns.flags.c_contiguous
    assert part.tolist() == [[1, 2, 3, 4, 5], [13, 14, 15, 16, 17]]
    assert all(array.flags.writeable for array in (rows, columns, part))


@pytest.mark.parametrize("texts", [[], ["left", "right", "Straße"]])
def test_columns_of_texts_come_back(tmp_path, texts):
    found = there_and_back(tmp_path, np.array(texts, object))
    assert found.dtype == object and found.shape == (len(texts),) and found.tolist() == texts


def test_a_file_that_ends_early_and_one_of_others_are_refused(tmp_path):
    path = tmp_path / "value.plain"
    write_plain(path, [np.arange(9)])
    whole = path.read_bytes()
    for length in (len(whole) - 8, len(FORMAT) + CHECKSUM.size + TEXT_LENGTH.size + 5, len(FORMAT) + 3):
        path.write_bytes(whole[:length])
        with pytest.raises(OSError, match="ends early"):
            read_plain(path)
    path.write_bytes(b"PK\x03\x04 another program's")
    with pytest.raises(OSError, match="no file of ours"):
        read_plain(path)


@pytest.mark.parametrize("number", [np.float64(0.1 + 0.2), np.float32(0.1), np.float64(-np.inf), np.int64(-2**63), np.uint16(7), np.bool_(True)])
def test_numbers_of_arrays_keep_their_type_and_every_bit(tmp_path, number):
    found = there_and_back(tmp_path, [number])[0]
    assert type(found) is type(number) and found.tobytes() == number.tobytes()
    assert np.isnan(there_and_back(tmp_path, [np.float64("nan")])[0])


def test_settings_and_objects_of_core_come_back(tmp_path):
    grid = OcclusionGrid(0.25, 4, 3, 2.0)
    grid.tall[1, 2] = True
    settings, found = there_and_back(tmp_path, (CurbSettings(slope=45.0), grid))
    assert settings == CurbSettings(slope=45.0)
    assert found.tall[1, 2] and np.isnan(found.ground).all() and found.first == 4


def test_a_road_comes_back_to_the_last_bit_and_a_pass_without_its_tables(tmp_path):
    u = np.linspace(0, 3, 400)
    road, line = Road(2, 30 * np.sin(u), 30 * np.cos(u), -10.0), np.linspace(0, 30, 60)
    driven = Pass(0, 2, 1, line, line, line, line, line, 0.0 * line)
    driven.position(line)
    found, again = there_and_back(tmp_path, [road, driven])
    s = np.linspace(-5, 25, 50)
    assert [v.tobytes() for v in found.to_map(s, 1.0)] == [v.tobytes() for v in road.to_map(s, 1.0)]
    np.testing.assert_array_equal(again.position(line), driven.position(line))
    assert (tmp_path / "value.plain").stat().st_size < 20_000


@pytest.mark.parametrize("value", [object(), np.array([None]), {1, 2}, json.JSONDecoder()], ids=["object", "array of objects", "set", "other class"])
def test_what_is_not_plain_is_refused_and_leaves_no_file(tmp_path, value):
    with pytest.raises(TypeError):
        write_plain(tmp_path / "value.plain", [value])
    assert not list(tmp_path.iterdir())


def test_a_file_that_names_a_class_outside_core_makes_nothing_of_it(tmp_path):
    text = json.dumps([{"object": "os:system", "state": []}, []]).encode()
    content = TEXT_LENGTH.pack(len(text)) + text
    (tmp_path / "value.plain").write_bytes(FORMAT + CHECKSUM.pack(zlib.crc32(content)) + content)
    with pytest.raises(ImportError):
        read_plain(tmp_path / "value.plain")


@pytest.mark.parametrize("place", [3, 9, 16, 30, -1, -3000])
def test_a_file_of_the_right_length_with_other_bytes_is_refused(tmp_path, place):
    path = tmp_path / "value.plain"
    write_plain(path, {"s": np.arange(1.0, 900.0)})
    content = bytearray(path.read_bytes())
    content[place] ^= 0x40
    path.write_bytes(content)
    with pytest.raises(OSError):   # a value that is not the one that was written would be worse
        read_plain(path)
