"""Makes `spoken` and `words` importable by the tests beside it, and sample surveys."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(scope="session")
def sample_survey(provider, made_once):
    """`sample_survey(LENGTH=40, …)` is a folder with s.laz and drive.gpkg, made once for all tests."""
    from words import call

    def made(**parameters):
        values = sorted(parameters.items())

        def make(folder):
            run = call("run", "lanewright:samplesurvey", *(f"--{name}={value}" for name, value in values),
                       "--POINT_CLOUD=s.laz", "--TRAJECTORY=drive.gpkg", folder=folder)
            assert run.returncode == 0, run.stderr

        return made_once("_".join(f"{name}={value}" for name, value in values), make)
    return made


@pytest.fixture
def called(provider, capfd):
    """`called("run", "lanewright:…", "--NAME=value", …, folder=…)`: `words.call`, with what the process itself was made to say."""
    from words import call

    def made(*words, folder):
        capfd.readouterr()
        run = call(*words, folder=folder)
        out, err = capfd.readouterr()
        run.stdout, run.stderr = run.stdout + out, run.stderr + err
        return run
    return made
