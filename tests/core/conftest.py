"""Proof that the core works without QGIS, and the sample surveys its tests share."""

import hashlib
import importlib
import os
import sys

import pytest
from lanewright.core.sample.survey import SampleSettings, make_sample_survey


@pytest.fixture(scope="session", autouse=True)
def no_qgis():
    """`make test` runs these tests where qgis cannot be imported; every process of them sees that it is so."""
    if os.environ.get("LANEWRIGHT_WITHOUT_QGIS"):
        for name in ("qgis", "qgis.core"):
            with pytest.raises(ImportError):
                importlib.import_module(name)
        assert not any(name.startswith("qgis.") for name in sys.modules)


@pytest.fixture(scope="session")
def made_survey(made_once):
    """`made_survey(length=60.0, …)` is a sample survey, and its cloud, which is written once for all tests."""
    def made(**settings):
        sample = make_sample_survey(SampleSettings(**settings))
        name = hashlib.sha256(repr(sample.settings).encode()).hexdigest()[:16]
        return sample, made_once(name, lambda folder: sample.write_cloud(folder / "survey.las")) / "survey.las"
    return made
