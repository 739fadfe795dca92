"""What a user's machine does to a run: cancelled, killed, twice at once, no room, no right to write."""

import os
import shutil
import signal
import sqlite3
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
from spoken import complaints

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
QGIS_PROCESS = str(ROOT / "tools" / "qgis_process")


def start(*arguments, folder, **environment):
    return subprocess.Popen([QGIS_PROCESS, "run", *map(str, arguments)], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, start_new_session=True, env={**os.environ, **environment})


def run(*arguments, folder, **environment):
    process = start(*arguments, folder=folder, **environment)
    out, err = process.communicate()
    return process.returncode, out, err


@pytest.fixture(scope="module")
def survey(sample_survey):
    return sample_survey(LENGTH=30, PULSE_RATE=60000, ROTATION_RATE=100)


def road_map(survey):
    return ("lanewright:roadmap", f"--POINT_CLOUDS={survey / 's.laz'}", f"--TRAJECTORY={survey / 'drive.gpkg'}",
            "--ROAD_EDGES=edges.gpkg", "--MARKINGS=markings.gpkg", "--INTENSITY_IMAGE=image.tif", "--ROAD_POINTS=road.laz",
            "--REPORT=report.html", "--BOUNDARY_METHOD=profiles")


RESULTS = {"edges.gpkg", "markings.gpkg", "image.tif", "road.laz", "report.html"}
BESIDE = {"image.qml", "image.tif.aux.xml"}  # a style, and the statistics QGIS keeps of a raster


def files(folder):
    """What lies in a folder, hidden files too."""
    return {path.name for path in folder.iterdir()}


def scratch(folder):
    """A folder for temporary files, so that what is left behind is seen."""
    (folder / "scratch").mkdir()
    return {"TMPDIR": str(folder / "scratch")}


def ours(folder):
    """Temporary files of ours; QGIS's own are cleaned up by QGIS."""
    return [path.name for path in (folder / "scratch").rglob("*") if "lanewright" in path.name]


@pytest.mark.parametrize("stage", ["Reading the survey", "Extracting markings"])
def test_cancel_leaves_nothing_and_says_so(survey, tmp_path, stage):
    """Ctrl-C reaches the algorithm as Cancel, in whatever stage it is."""
    process = start(*road_map(survey), folder=tmp_path, **scratch(tmp_path))
    for line in process.stdout:
        if stage in line:
            process.send_signal(signal.SIGINT)
            break
    _, err = process.communicate(timeout=60)
    if process.returncode == 0:  # the last stages were done before the signal came
        assert RESULTS <= files(tmp_path)
        return
    assert "Cancelled" in err
    assert files(tmp_path) == {"scratch"} and not ours(tmp_path)


def test_a_killed_run_is_followed_by_whole_ones_and_two_at_once_into_their_own_files_do_not_meet_and_change_no_input(survey, tmp_path):
    """kill -9 can clean up nothing: the next run into the same folder is whole all the same."""
    before = {path: (path.stat().st_mtime_ns, path.read_bytes()) for path in survey.iterdir() if path.suffix == ".laz"}
    folders = [tmp_path / name for name in ("one", "two")]
    for folder in folders:
        folder.mkdir()
    where = scratch(tmp_path)
    process = start(*road_map(survey), folder=folders[0], **where)
    assert any("Making the intensity image" in line for line in process.stdout)
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    processes = [start(*road_map(survey), folder=folder, **where) for folder in folders]
    for process in processes:
        _, err = process.communicate()
        assert process.returncode == 0, err
    assert all(files(folder) - BESIDE >= RESULTS for folder in folders)
    one, two = ((folder / "road.laz").read_bytes() for folder in folders)
    assert one == two
    assert before and all((path.stat().st_mtime_ns, path.read_bytes()) == were for path, were in before.items())


@pytest.fixture
def locked_folder(tmp_path):
    """A folder nobody may write to, not even root."""
    folder = tmp_path / "locked"
    folder.mkdir()
    if os.geteuid():
        folder.chmod(0o555)
        yield folder
        folder.chmod(0o755)
        return
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "ro", "tmpfs", str(folder)], capture_output=True).returncode:
        pytest.skip("a disk root cannot write to needs the right to mount")
    yield folder
    subprocess.run(["umount", "-l", str(folder)], check=True)


def test_a_read_only_folder_is_told_before_the_work(survey, called, tmp_path, locked_folder):
    done = called("run", *road_map(survey)[:3], f"--ROAD_EDGES={locked_folder / 'edges.gpkg'}", folder=tmp_path)
    assert done.returncode == 1 and "cannot be written" in done.stderr and "Reading" not in done.stdout


@pytest.fixture
def small_disk(tmp_path):
    """A disk of 3 MB."""
    folder = tmp_path / "disk"
    folder.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=3m", "tmpfs", str(folder)], capture_output=True).returncode:
        pytest.skip("making a small disk needs the right to mount")
    yield folder
    subprocess.run(["umount", "-l", str(folder)], check=True)


def test_a_full_disk_is_one_sentence_and_yesterdays_result_stands(survey, tmp_path, small_disk):
    shutil.copy(survey / "drive.gpkg", small_disk / "road.laz.keep")
    (small_disk / "road.laz").write_bytes(b"yesterday")
    (small_disk / "ballast").write_bytes(b"\0" * 1_500_000)
    code, _, err = run(*road_map(survey)[:3], f"--ROAD_POINTS={small_disk / 'road.laz'}", folder=tmp_path)
    said = complaints(err)
    assert code == 1 and len(said) == 1, err
    assert "space" in said.pop()
    assert (small_disk / "road.laz").read_bytes() == b"yesterday"
    assert files(small_disk) == {"road.laz", "road.laz.keep", "ballast"}


HOLDS = """
import sqlite3, sys
layer = sqlite3.connect(sys.argv[1], isolation_level=None)
layer.execute("BEGIN EXCLUSIVE")
print("held", flush=True)
sys.stdin.read()
"""


def test_a_layer_that_another_program_holds_open_is_replaced_or_told_in_one_sentence(survey, called, tmp_path, monkeypatch):
    """As when yesterday's layer is still loaded, and being edited, in another QGIS; nobody waits for it longer than a moment here."""
    monkeypatch.setattr(sqlite3, "connect", partial(sqlite3.connect, timeout=0.1))
    layer = tmp_path / "edges.gpkg"
    stage = "lanewright:importtrajectory", f"--INPUT={survey / 'drive.gpkg'}", f"--OUTPUT={layer}"
    assert called("run", *stage, folder=tmp_path).returncode == 0
    yesterday = layer.read_bytes()
    with subprocess.Popen([sys.executable, "-c", HOLDS, layer], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout.readline()
        done = called("run", *stage, folder=tmp_path)
        other.communicate()
    assert done.returncode == 0 or len(complaints(done.stderr)) == 1, done.stderr
    assert done.returncode == 0 or layer.read_bytes() == yesterday
    assert files(tmp_path) <= {"edges.gpkg", "edges.gpkg-journal"}
    with sqlite3.connect(layer) as whole:
        assert whole.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_a_layer_is_the_one_of_before_or_the_new_one_whenever_a_run_is_killed(tmp_path):
    """Few kills of many: tools/kill_runs.py makes as many as one likes."""
    sys.path.insert(0, str(ROOT / "tools"))
    try:
        import kill_runs
    finally:
        sys.path.pop(0)
    assert kill_runs.check(2, 0, tmp_path) == []


@pytest.mark.parametrize("gib", [1.2, 0.4])
def test_a_run_that_may_not_have_its_memory_ends_with_one_sentence_and_leaves_nothing(survey, tmp_path, gib):
    """As under `ulimit -v` or on a shared computer."""
    if not sys.platform.startswith("linux"):
        pytest.skip("this system limits no address space")
    folder = scratch(tmp_path)
    limited = ["sh", "-c", f'ulimit -v {int(gib * 2**20)}; exec "$@"', "sh", QGIS_PROCESS, "run"]
    call = subprocess.run([*limited, *map(str, road_map(survey))], cwd=tmp_path,
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, env={**os.environ, **folder})
    assert call.returncode == 1, call.stderr
    assert call.stderr.count("memory") == 1 and f"may use {int(gib * 2**20) * 1024 // 10**6} MB" in call.stderr, call.stderr
    assert "Traceback" not in call.stderr
    assert files(tmp_path) == {"scratch"} and not list((tmp_path / "scratch").iterdir())
