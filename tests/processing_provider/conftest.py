"""Sample surveys through Processing, and the road map of one."""

import pytest


@pytest.fixture(scope="session")
def sample_survey(provider, made_once):
    """`sample_survey(LENGTH=40, …)` is the algorithm's result, made once for all tests."""
    import processing

    def results(folder):
        return {"POINT_CLOUD": str(folder / "s.laz"), "TRAJECTORY": str(folder / "drive.gpkg")}

    def made(**parameters):
        name = "_".join(f"{name}={value}" for name, value in sorted(parameters.items()))
        return results(made_once(name, lambda folder: processing.run("lanewright:samplesurvey", {**parameters, **results(folder)})))
    return made


@pytest.fixture(scope="session")
def street(sample_survey):
    """A survey of 40 m, thin, but dense enough for the whole chain."""
    return sample_survey(LENGTH=40, PULSE_RATE=60000, ROTATION_RATE=100)


@pytest.fixture(scope="session")
def street_map(street, made_once):
    """Files of the road map of `street`, made once for all tests: paths by output."""
    import processing

    def results(folder):
        return {output: str(folder / name) for output, name in (
            ("ROAD_EDGES", "edges.gpkg"), ("ROAD_SURFACE", "surface.gpkg"), ("MARKINGS", "markings.gpkg"), ("ROAD_POINTS", "road.laz"),
            ("INTENSITY_IMAGE", "image.tif"))}

    return results(made_once("street_map", lambda folder: processing.run("lanewright:roadmap", {
        "POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"], **results(folder)})))
