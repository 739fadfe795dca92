"""The page for users of Python does what it says."""

import re
import shlex
from pathlib import Path

import pytest
from lanewright.library import algorithms
from lanewright.library.command_line import parser_of

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "python.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_examples_run_as_they_are_printed(tmp_path, monkeypatch, capsys):
    pytest.importorskip("osgeo")
    monkeypatch.chdir(tmp_path)
    examples = re.findall(r"^```python\n(.*?)^```", PAGE, re.M | re.S)
    assert len(examples) > 2
    exec(compile("\n".join(examples), "docs/python.md", "exec"), {"__name__": "example"})
    printed = capsys.readouterr().out
    assert "measured" in printed and "MAX_GAP" in printed and "100%" in printed
    assert {"street.laz", "drive.gpkg", "map.gpkg", "report.html", "curbs.gpkg"} == {path.name for path in tmp_path.iterdir()}


def test_the_command_names_parameters_that_there_are():
    commands = [shlex.split(text.replace("\\\n", " ")) for text in re.findall(r"^```\n(lanewright .*?)^```", PAGE, re.M | re.S)]
    assert commands
    for _, name, *options in commands:
        assert parser_of(algorithms()[name]).parse_args(options).POINT_CLOUDS == ["tile1.laz", "tile2.laz"]
