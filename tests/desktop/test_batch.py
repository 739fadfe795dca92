"""Several surveys in one batch, as the batch window runs it."""

import shutil

import pytest
from lanewright.processing_provider.results.layer_tree import road_maps
from lanewright.processing_provider.results.run_table import run_table
from qgis.core import QgsApplication, QgsProject
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer


@pytest.fixture
def surveys(provider, tmp_path):
    """Three folders with a cloud.laz each; the trajectory of the second is missing."""
    import processing

    for day, seed in (("monday", 1), ("tuesday", 2), ("wednesday", 3)):
        folder = tmp_path / day
        folder.mkdir()
        processing.run("lanewright:samplesurvey", {
            "LENGTH": 20, "PULSE_RATE": 20000, "SEED": seed, "POINT_CLOUD": str(folder / "cloud.laz"), "TRAJECTORY": str(folder / "drive.gpkg")})
    shutil.copy(tmp_path / "monday" / "drive.gpkg", tmp_path / "tuesday" / "drive.csv")  # no table
    return tmp_path


def wait_for(condition, seconds=120):
    clock = QElapsedTimer()
    clock.start()
    while not condition() and clock.elapsed() < 1000 * seconds:
        QCoreApplication.processEvents()
    return condition()


@pytest.mark.slow
def test_a_batch_of_three_surveys_goes_on_after_one_fails_and_sums_up(surveys, monkeypatch, tmp_path):
    from processing.core.ProcessingResults import resultsList
    from processing.gui import BatchPanel, Postprocessing
    from processing.gui.BatchAlgorithmDialog import BatchAlgorithmDialog

    for module in (BatchPanel, Postprocessing):
        monkeypatch.setattr(module, "iface", None)
    dialog = BatchAlgorithmDialog(QgsApplication.processingRegistry().createAlgorithmById("lanewright:roadmap"))
    panel = dialog.mainWidget()
    panel.addRow(2)
    for row, (day, drive) in enumerate((("monday", "drive.gpkg"), ("tuesday", "drive.csv"), ("wednesday", "drive.gpkg"))):
        place = lambda name, row=row: panel.wrappers[row][panel.parameter_to_column[name]]  # noqa: E731
        place("POINT_CLOUDS").setParameterValue(str(surveys / day / "cloud.laz"), dialog.processingContext())
        place("TRAJECTORY").setParameterValue(str(surveys / day / drive), dialog.processingContext())
        for output in dialog.algorithm().destinationParameterDefinitions():
            value = str(surveys / day / "edges.gpkg") if output.name() == "ROAD_EDGES" else ""
            panel.tblParameters.cellWidget(row + 1, panel.parameter_to_column[output.name()]).setValue(value)
    panel.checkLoadLayersOnCompletion.setChecked(True)
    before = len(resultsList.getResults())
    dialog.runAlgorithm()
    assert wait_for(lambda: any("[summary]" in result.name for result in resultsList.getResults()[before:]))
    assert [(surveys / day / "edges.gpkg").exists() for day in ("monday", "tuesday", "wednesday")] == [True, False, True]
    groups = [group.name() for group in road_maps(QgsProject.instance().layerTreeRoot())]
    assert len(groups) == 2 and "wednesday/cloud" in groups[0] and "monday/cloud" in groups[1]
    summary = resultsList.getResults()[before:][-1].filename
    text = open(summary, encoding="utf-8").read()
    assert "Length of the roads (m)" in text and "drive.csv" in text
    table = run_table()
    assert all(f"{day}/cloud" in table for day in ("monday", "tuesday", "wednesday")) and "Length of the road edges (m)" in table
    failed = table[table.rindex("tuesday/cloud"):table.rindex("wednesday/cloud")]
    assert "drive.csv" in failed, "the survey that failed, with its sentence"
    QgsProject.instance().clear()
