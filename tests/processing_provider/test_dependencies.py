"""A machine without the Python packages is told what to do, and nothing is installed behind its back."""

import pytest
from lanewright.processing_provider import dependencies
from qgis.core import QgsProcessingContext, QgsProcessingException, QgsProcessingFeedback


@pytest.fixture
def bare(monkeypatch):
    """A Python without laspy and shapely."""
    monkeypatch.setattr(dependencies, "find_spec", lambda name: None if name in ("laspy", "shapely") else True)


def test_nothing_is_said_where_everything_is_there(qgis_app):
    assert dependencies.missing_packages() == ""


def test_one_sentence_names_what_is_missing_and_the_command(bare):
    said = dependencies.missing_packages()
    assert "laspy, shapely" in said and "scipy" not in said
    assert "-m pip install --no-deps --target" in said and 'laspy "shapely>=2"' in said


def test_outside_debian_a_python_without_pip_gets_it_first(monkeypatch):
    monkeypatch.setattr(dependencies, "find_spec", lambda name: None if name in ("scipy", "shapely", "pip") else True)
    monkeypatch.setattr(dependencies.Path, "exists", lambda path: False)
    first, second = dependencies.install_command().split(" && ")
    assert first.endswith("-m ensurepip --user") and second.endswith('scipy "shapely>=2"')


def test_the_command_installs_where_the_plugin_looks(bare, tmp_path, monkeypatch):
    import sys

    import lanewright

    folder = dependencies.library_folder()
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(lanewright.os.path, "isdir", lambda path: True)
    from qgis.core import QgsApplication

    lanewright.add_library_folders(QgsApplication.qgisSettingsDirPath())
    assert str(folder) in [path.replace("//", "/") for path in sys.path]


def test_every_algorithm_is_still_listed_and_says_the_same(provider, bare):
    algorithm = provider.algorithm("detectcurbs")
    able, reason = algorithm.canExecute()
    assert not able and "laspy" in reason
    with pytest.raises(QgsProcessingException, match="laspy, shapely"):
        algorithm.create().processAlgorithm({}, QgsProcessingContext(), QgsProcessingFeedback())
