"""What a work folder believes of what lies in it."""

import json

import pytest
from lanewright.core.execution.work_folder import WorkFolder

MESSAGES = [("warn", "The road is narrow."), ("info", "Straße")]


@pytest.fixture
def work(tmp_path):
    work = WorkFolder(str(tmp_path / "work"))
    folder = work.begin("survey-1")
    folder.mkdir()
    (folder / "survey.plain").write_bytes(bytes(range(1, 251)) * 40)
    (folder / "points.bin").write_bytes(b"points")
    work.finish("survey-1", folder, MESSAGES)
    return work


def folder_of(work):
    return next(path for path in work.path.iterdir() if path.is_dir())


def test_what_was_finished_is_found_with_what_was_said(work):
    assert work.finished("survey-1") == (folder_of(work), MESSAGES)
    assert work.finished("survey-2") is None


def test_zeros_in_a_file_as_after_a_power_failure_make_it_none(work):
    content = bytearray((folder_of(work) / "survey.plain").read_bytes())
    content[4096:8192] = bytes(4096)
    (folder_of(work) / "survey.plain").write_bytes(content)
    assert work.finished("survey-1") is None


@pytest.mark.parametrize("name", ["survey.plain", "points.bin"])
def test_a_missing_file_makes_it_none(work, name):
    (folder_of(work) / name).unlink()
    assert work.finished("survey-1") is None


@pytest.mark.parametrize("note", [
    b"", b"[]", b"7", b"null", b'"text"', b"{}", b"\x00" * 4096, b"\xff\xfe{}", b"[" * 100_000, b'{"folder": 3, "messages": [], "files": {}}',
    b'{"folder": null, "messages": [], "files": {}}', b'{"folder": "..", "messages": [], "files": {}}', b"1" * 5000, b" " * (1 << 25)],
    ids=lambda note: repr(note[:60]))
def test_any_other_note_makes_it_none(work, note):
    (work.path / "survey-1.json").write_bytes(note)
    assert work.finished("survey-1") is None


@pytest.mark.parametrize("changed", [{"messages": 5}, {"messages": [3]}, {"messages": [["warn"]]}, {"messages": None}, {"files": []}, {"files": None},
                                     {"files": {"survey.plain": "big"}}, {"folder": ["a"]}, {"folder": "a\0b"}])
def test_a_note_of_other_types_makes_it_none(work, changed):
    path = work.path / "survey-1.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), **changed}))
    assert work.finished("survey-1") is None
