"""`tools/survey_results.sh` and `tools/compare_results.sh`, as one uses them before and after a change of the code."""

import subprocess
from pathlib import Path

import laspy
import pytest
from lanewright.simulator.scenes import SCENES

pytestmark = pytest.mark.slow

TOOLS = Path(__file__).resolve().parents[2] / "tools"
FILES = {"edges.gpkg", "surface.gpkg", "markings.gpkg", "lines.gpkg", "driving.gpkg", "elements.gpkg", "curb_points.gpkg", "road.laz",
         "intensity.tif", "report.html", "log.txt"}


def call(tool, *arguments):
    return subprocess.run([str(TOOLS / tool), *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL)


@pytest.fixture(scope="module")
def surveys(sample_survey, tmp_path_factory):
    """A folder with a short street whose cloud has no CRS, a survey whose cloud is damaged, and a folder that is no survey."""
    folder = tmp_path_factory.mktemp("surveys")
    for name in ("street", "broken", "notes"):
        (folder / name).mkdir()
    sample = sample_survey(LENGTH=30, PULSE_RATE=60000, ROTATION_RATE=100)
    cloud = laspy.read(sample / "s.laz")
    cloud.vlrs.clear()
    cloud.write(folder / "street" / "cloud.laz")
    table = folder / "street" / "trajectory.csv"
    subprocess.run(["ogr2ogr", "-f", "CSV", "-sql", "SELECT time, ST_X(geom) x, ST_Y(geom) y, ST_Z(geom) z FROM drive", table,
                    sample / "drive.gpkg"], check=True, capture_output=True)
    (folder / "broken" / "cloud.laz").write_bytes(b"LASF and no more")
    (folder / "broken" / "trajectory.csv").write_bytes(table.read_bytes())
    return folder


def test_every_survey_has_its_results_and_a_log_one_that_fails_stops_no_other_and_a_second_run_gives_the_same(surveys, tmp_path):
    stale = tmp_path / "first" / "broken" / "edges.gpkg"
    stale.parent.mkdir(parents=True)
    stale.touch()
    run = call("survey_results.sh", tmp_path / "first", "--surveys", surveys, "--only", "street,broken")
    assert run.returncode == 1 and "1 of 2 surveys failed" in run.stderr
    broken, street = run.stdout.splitlines()
    assert broken.startswith("broken") and "failed: " in broken and street.startswith("street") and street.endswith("made")
    assert FILES <= {path.name for path in (tmp_path / "first" / "street").iterdir()}
    assert not stale.exists() and "cloud.laz" in (tmp_path / "first" / "broken" / "log.txt").read_text()
    said = (tmp_path / "first" / "street" / "log.txt").read_text().splitlines()
    assert said[0].startswith("warning: ") and [line for line in said if line.startswith("warning: The point cloud carries no CRS")]
    assert said[-1].startswith("info: "), "it begins with what was warned of"

    assert call("survey_results.sh", tmp_path / "second", "--surveys", surveys, "--only", "street").returncode == 0
    same = call("compare_results.sh", tmp_path / "first" / "street", tmp_path / "second" / "street")
    assert same.returncode == 0, same.stdout + same.stderr
    (tmp_path / "second" / "street" / "edges.gpkg").unlink()
    different = call("compare_results.sh", tmp_path / "first" / "street", tmp_path / "second" / "street")
    assert different.returncode == 1 and "different  edges.gpkg: only in the first folder" in different.stdout.splitlines()


def test_a_name_that_no_survey_has_is_refused_with_those_there_are(surveys, tmp_path):
    run = call("survey_results.sh", tmp_path / "results", "--surveys", surveys, "--only", "street,avenue")
    assert run.returncode == 1 and not (tmp_path / "results").exists()
    scenes = ", ".join(f"sample_{scene}" for scene in SCENES)
    assert run.stderr.strip() == f"There is no survey avenue; there are broken, street, {scenes}."


def test_a_folder_without_surveys_is_refused(surveys, tmp_path):
    run = call("survey_results.sh", tmp_path / "results", "--surveys", surveys / "notes")
    assert run.returncode == 1 and "holds no survey: a folder with cloud.laz and trajectory.csv" in run.stderr
