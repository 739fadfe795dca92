"""The check of names against PyQt6, here with a small Qt of its own."""

import enum
import sys
import types

import pytest
import qt6_names


class AlignmentFlag(enum.Flag):
    AlignLeft = 1
    AlignTop = 2


class TextFlag(enum.Flag):
    TextWordWrap = 1


@pytest.fixture
def file(tmp_path, monkeypatch):
    module = types.ModuleType("PyQt6.QtCore")
    module.Qt = types.SimpleNamespace(AlignmentFlag=AlignmentFlag, TextFlag=TextFlag)
    monkeypatch.setitem(sys.modules, "PyQt6", types.ModuleType("PyQt6"))
    monkeypatch.setitem(sys.modules, "PyQt6.QtCore", module)
    return lambda text: (tmp_path / "dialog.py").write_text(text, encoding="utf-8") and tmp_path / "dialog.py"


@pytest.mark.parametrize("used", [
    "Qt.AlignmentFlag.AlignLeft", "Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop", "label.setAlignment(Qt.AlignmentFlag.AlignTop)",
])
def test_what_qt_6_knows_passes(file, used):
    assert not qt6_names.complaints(file(f"from qgis.PyQt.QtCore import Qt\n{used}\n"))


@pytest.mark.parametrize(("used", "named"), [
    ("Qt.AlignLeft", "AlignLeft"), ("label.setAlignment(Qt.AlignLeft)", "AlignLeft"),
    ("Qt.AlignmentFlag.AlignLeft | Qt.TextFlag.TextWordWrap", "unsupported operand"), ("int(Qt.AlignmentFlag.AlignLeft)", "int()"),
])
def test_what_qt_6_does_not_know_is_named_with_its_line(file, used, named):
    said, = qt6_names.complaints(file(f"from qgis.PyQt.QtCore import Qt\n\n{used}\n"))
    assert "dialog.py:3" in said and named in said


def test_a_class_that_is_gone_is_named(file):
    said, = qt6_names.complaints(file("from qgis.PyQt.QtCore import QRegExp as Pattern\n"))
    assert "QRegExp" in said
