"""Proof that the core works without QGIS."""

import importlib
import os
import sys

import pytest


@pytest.fixture(scope="session", autouse=True)
def no_qgis():
    """`make test` runs these tests where qgis cannot be imported; every process of them sees that it is so."""
    if os.environ.get("LANEWRIGHT_WITHOUT_QGIS"):
        for name in ("qgis", "qgis.core"):
            with pytest.raises(ImportError):
                importlib.import_module(name)
        assert not any(name.startswith("qgis.") for name in sys.modules)
