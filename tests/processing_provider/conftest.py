"""Makes the writer of COPC files importable here, and sample surveys through Processing."""


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
