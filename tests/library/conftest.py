"""A street, made without QGIS once for all tests."""

import pytest


@pytest.fixture(scope="session")
def street(made_once):
    """A folder with s.laz and drive.gpkg of 40 m."""
    from lanewright.library import run

    return made_once("library_street", lambda folder: run(
        "samplesurvey", LENGTH=40, PULSE_RATE=60_000, POINT_CLOUD=folder / "s.laz", TRAJECTORY=folder / "drive.gpkg"))
