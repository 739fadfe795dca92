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
    """{file of a finished part: its number on the disk, which another one would have}."""
    return {path: path.stat().st_ino for path in work.glob("kept-*.plain") if ".part" not in path.name}


def test_a_run_that_is_killed_twice_makes_nothing_twice_and_gives_what_an_undisturbed_one_gives(street, tmp_path):
    inputs = dict(POINT_CLOUDS=[street / "s.laz"], TRAJECTORY=street / "drive.gpkg", BOUNDARY_METHOD="profiles")
    run("roadmap", **inputs, WORK_FOLDER=tmp_path / "other", WORKERS=1, ROAD_EDGES=tmp_path / "undisturbed.gpkg",
        MARKING_LINES=tmp_path / "lines.gpkg")
    work, results, parts = tmp_path / "work", (tmp_path / "edges.gpkg", tmp_path / "marking_lines.gpkg"), len(finished_parts(tmp_path / "other"))
    command = [sys.executable, "-W", "ignore", "-c", PROGRAM.format(tests=str(ROOT / "tests")), "roadmap",
               "--POINT_CLOUDS", str(street / "s.laz"), "--TRAJECTORY", str(street / "drive.gpkg"), "--BOUNDARY_METHOD", "profiles",
               "--WORK_FOLDER", str(work), "--WORKERS", "1", "--ROAD_EDGES", str(results[0]), "--MARKING_LINES", str(results[1])]
    finished = {}
    for k in range(2):
        program = subprocess.Popen(command, stderr=subprocess.DEVNULL)
        while program.poll() is None and len(finished_parts(work)) <= k * parts // 2:
            time.sleep(0.02)
        assert program.poll() is None, "it was still at work"
        program.kill()
        program.wait()
        now = finished_parts(work)
        assert len(now) > len(finished) and now.items() >= finished.items() and not any(result.exists() for result in results)
        finished = now
    run("roadmap", **inputs, WORK_FOLDER=work, WORKERS=1, ROAD_EDGES=results[0], MARKING_LINES=results[1])
    assert finished_parts(work).items() >= finished.items()
    assert edges(results[0]) == edges(tmp_path / "undisturbed.gpkg") and edges(results[0])
    assert edges(results[1]) == edges(tmp_path / "lines.gpkg") and edges(results[1])
