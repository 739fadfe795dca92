"""What runs in the background outlives the window that began it."""

import gc

import pytest
from lanewright.desktop.background import BackgroundRun, end_runs
from lanewright.desktop.dialogs.algorithm_dialog import LanewrightDialog
from qgis.core import QgsApplication
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer
from qgis.PyQt.QtWidgets import QStackedWidget, QTabWidget


@pytest.fixture
def survey(provider, tmp_path):
    """Parameters of a run of seconds."""
    return {"LENGTH": 20.0, "POINT_CLOUD": str(tmp_path / "s.laz"), "TRAJECTORY": str(tmp_path / "drive.gpkg")}


def wait_for(ended):
    clock = QElapsedTimer()
    clock.start()
    while not ended and clock.elapsed() < 60_000:
        QCoreApplication.processEvents()


def test_a_run_that_its_window_forgets_keeps_what_it_works_with_until_it_ends(survey):
    ended = []
    run = BackgroundRun("samplesurvey", survey, lambda run, fine: ended.append(fine))
    del run
    gc.collect()   # without feedback and context the run, and QGIS with it, would end by a segmentation fault
    wait_for(ended)
    assert ended == [True]


def test_a_run_goes_on_where_its_dialog_is_closed_and_another_takes_its_place(survey, monkeypatch):
    from processing.gui import ParametersPanel

    monkeypatch.setattr(ParametersPanel, "iface", None)   # pytest-qgis puts a window of its own in the place of QGIS's
    tabs, ended = QTabWidget(), []
    parent = tabs.findChild(QStackedWidget)   # made by Qt, as the window of QGIS is: Python's word for it comes and goes
    dialog = LanewrightDialog(QgsApplication.processingRegistry().createAlgorithmById("lanewright:samplesurvey"), "Sample survey", parent)
    dialog.setParameters(survey)
    dialog.algorithmFinished.connect(lambda fine, results: ended.append(fine))
    dialog.runAlgorithm()
    dialog.close()
    del dialog, parent
    gc.collect()   # likewise
    wait_for(ended)
    assert ended == [True]


def test_a_run_has_ended_before_the_plugin_goes(survey):
    ended = []
    BackgroundRun("samplesurvey", {**survey, "LENGTH": 2000.0}, lambda run, fine: ended.append(fine))
    end_runs()
    assert ended == [False]
