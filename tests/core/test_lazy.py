"""Libraries that are loaded when they are first used."""

import subprocess
import sys
from pathlib import Path

import pytest
from lanewright.core.lazy import LazyModule

ROOT = Path(__file__).resolve().parents[2]
PARAMETERS_OF_ALL = """
import importlib.util, sys
sys.modules["qgis"] = None
spec = importlib.util.spec_from_file_location("lanewright", {init!r}, submodule_search_locations=[{root!r}])
sys.modules["lanewright"] = package = importlib.util.module_from_spec(spec)
spec.loader.exec_module(package)
from lanewright.algorithms.catalogue import ALGORITHMS
defaults = sum(parameter.default is not None for declaration in ALGORITHMS for parameter in declaration().parameters)
print(defaults, *sys.modules)
"""


def test_names_of_a_library_are_those_of_the_library():
    import fractions
    assert LazyModule("fractions").Fraction is fractions.Fraction


def test_a_library_that_is_not_installed_says_so_when_it_is_used():
    absent = LazyModule("no_such_library")
    with pytest.raises(ImportError, match="no_such_library"):
        absent.name  # noqa: B018


def test_the_defaults_of_all_parameters_are_known_without_loading_opencv_or_the_largest_parts_of_scipy():
    """QGIS asks for them at its start, every run loads what they need, and each of these takes a quarter of a second or more."""
    program = PARAMETERS_OF_ALL.format(init=str(ROOT / "__init__.py"), root=str(ROOT))
    defaults, *modules = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
    assert int(defaults) > 100 and "lanewright.core.survey.open_survey" in modules
    assert not {"cv2", "scipy.signal", "scipy.stats"} & set(modules)
