"""A run from the command line that is killed without warning, and begun again."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import fiona
import pytest
from lanewright.library import run

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = "import sys; sys.path.insert(0, {tests!r}); import conftest; from lanewright.library.command_line import main; sys.exit(main())"

pytestmark = [pytest.mark.slow, pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="kill -9 is a way of Unix")]


def edges(path):
    with fiona.open(path) as layer:
        return [(feature.geometry.coordinates, dict(feature.properties)) for feature in layer]


def finished_parts(work):
    return [path for path in work.glob("kept-*.plain") if ".part" not in path.name]


def test_a_killed_run_that_is_begun_again_gives_what_an_undisturbed_one_gives(street, tmp_path):
    inputs = dict(POINT_CLOUDS=[street / "s.laz"], TRAJECTORY=street / "drive.gpkg")
    work, result = tmp_path / "work", tmp_path / "edges.gpkg"
    command = [sys.executable, "-W", "ignore", "-c", PROGRAM.format(tests=str(ROOT / "tests")), "detectboundaries",
               "--POINT_CLOUDS", str(street / "s.laz"), "--TRAJECTORY", str(street / "drive.gpkg"),
               "--WORK_FOLDER", str(work), "--WORKERS", "1", "--ROAD_EDGES", str(result)]
    program = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    while program.poll() is None and not finished_parts(work):
        time.sleep(0.02)
    assert program.poll() is None, "it was still at work"
    program.kill()
    program.wait()
    assert not result.exists()

    finished = {path: path.stat().st_mtime_ns for path in finished_parts(work)}
    run("detectboundaries", **inputs, WORK_FOLDER=work, WORKERS=1, ROAD_EDGES=result)
    assert finished and all(path.stat().st_mtime_ns == when for path, when in finished.items())
    run("detectboundaries", **inputs, ROAD_EDGES=tmp_path / "undisturbed.gpkg")
    assert edges(result) == edges(tmp_path / "undisturbed.gpkg") and edges(result)
