"""Makes the packages in tools/ importable by the tests beside it, and a survey with truth."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))


@pytest.fixture(scope="session")
def short_street(made_once):
    """A folder with one survey, short/, of 30 m."""
    from accuracy.surveys import _make_sample
    from lanewright.simulator.survey import SampleSettings

    return made_once("short_street", lambda folder: _make_sample(
        folder / "short", SampleSettings(length=30.0, speed_kmh=60.0, pulse_rate=120_000.0), "a short street"))
