"""Makes `spoken` importable by the tests beside it, and sample surveys by the real qgis_process."""

import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
QGIS_PROCESS = str(Path(__file__).resolve().parents[2] / "tools" / "qgis_process")


@pytest.fixture(scope="session")
def sample_survey(made_once):
    """`sample_survey(LENGTH=40, …)` is a folder with s.laz and drive.gpkg, made once for all tests."""
    def made(**parameters):
        values = sorted(parameters.items())

        def make(folder):
            run = subprocess.run(
                [QGIS_PROCESS, "run", "lanewright:samplesurvey", *(f"--{name}={value}" for name, value in values),
                 "--POINT_CLOUD=s.laz", "--TRAJECTORY=drive.gpkg"],
                cwd=folder, capture_output=True, text=True, stdin=subprocess.DEVNULL)
            assert run.returncode == 0, run.stderr

        return made_once("_".join(f"{name}={value}" for name, value in values), make)
    return made
