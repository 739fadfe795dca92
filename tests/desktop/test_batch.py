"""Several surveys in one batch, as the batch window runs it."""

import shutil

import pytest
from copc_files import write_vpc
from lanewright.desktop.dialogs.algorithm_dialog import BatchAlgorithmDialog, surveys_in
from lanewright.processing_provider.results.road_maps import road_maps, run_table
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


def wait_for(condition, seconds=400):
    clock = QElapsedTimer()
    clock.start()
    while not condition() and clock.elapsed() < 1000 * seconds:
        QCoreApplication.processEvents()
    return condition()


@pytest.mark.slow
def test_a_batch_of_three_surveys_goes_on_after_one_fails_and_sums_up(surveys, monkeypatch, tmp_path):
    from processing.core.ProcessingResults import resultsList
    from processing.gui import BatchPanel, Postprocessing

    for module in (BatchPanel, Postprocessing):
        monkeypatch.setattr(module, "iface", None)
    dialog = BatchAlgorithmDialog(QgsApplication.processingRegistry().createAlgorithmById("lanewright:roadmap"), "Road map")
    panel = dialog.mainWidget()
    panel.addRow(2)
    for row, (day, drive) in enumerate((("monday", "drive.gpkg"), ("tuesday", "drive.csv"), ("wednesday", "drive.gpkg"))):
        place = lambda name, row=row: panel.wrappers[row][panel.parameter_to_column[name]]  # noqa: E731
        place("POINT_CLOUDS").setParameterValue(str(surveys / day / "cloud.laz"), dialog.processingContext())
        place("TRAJECTORY").setParameterValue(str(surveys / day / drive), dialog.processingContext())
        for output in dialog.algorithm().destinationParameterDefinitions():
            file = {"ROAD_EDGES": "edges.gpkg", "REPORT": "report.html"}.get(output.name())
            value = str(surveys / day / file) if file else ""
            panel.tblParameters.cellWidget(row + 1, panel.parameter_to_column[output.name()]).setValue(value)
    panel.checkLoadLayersOnCompletion.setChecked(True)
    before = len(resultsList.getResults())
    dialog.runAlgorithm()
    assert wait_for(lambda: any("[summary]" in result.name for result in resultsList.getResults()[before:]))
    assert [(surveys / day / "edges.gpkg").exists() for day in ("monday", "tuesday", "wednesday")] == [True, False, True]
    reports = [result.filename for result in resultsList.getResults()[before:] if "[summary]" not in result.name]
    assert sorted(reports) == [str(surveys / day / "report.html") for day in ("monday", "wednesday")]
    shown = [result.name for result in resultsList.getResults()[before:]]
    assert all(any(f"[{day}/report]" in name for name in shown) for day in ("monday", "wednesday")), shown
    groups = [road_map.name for road_map in road_maps(QgsProject.instance())]
    assert len(groups) == 2 and "wednesday/cloud" in groups[0] and "monday/cloud" in groups[1]
    summary = resultsList.getResults()[before:][-1].filename
    text = open(summary, encoding="utf-8").read()
    assert "Length of the roads (m)" in text and "drive.csv" in text
    table = run_table()
    assert all(f"{day}/cloud" in table for day in ("monday", "tuesday", "wednesday")) and "Length of the road edges (m)" in table
    failed = table[table.rindex("tuesday/cloud"):table.rindex("wednesday/cloud")]
    assert "drive.csv" in failed, "the survey that failed, with its sentence"
    QgsProject.instance().clear()


@pytest.fixture
def dialog(provider, monkeypatch, tmp_path):
    """A batch of two surveys called alike, with a cloud each."""
    from processing.gui import BatchPanel

    monkeypatch.setattr(BatchPanel, "iface", None)
    dialog = BatchAlgorithmDialog(QgsApplication.processingRegistry().createAlgorithmById("lanewright:roadmap"), "Road map")
    panel = dialog.mainWidget()
    panel.addRow(1)
    for row, place in enumerate(("north/B12", "south/B12")):
        (tmp_path / place).mkdir(parents=True)
        (tmp_path / place / "cloud.laz").touch()
        panel.wrappers[row][panel.parameter_to_column["POINT_CLOUDS"]].setParameterValue(str(tmp_path / place), dialog.processingContext())
    return dialog


def test_each_survey_of_a_batch_gets_a_geopackage_of_its_own_in_one_folder(dialog, tmp_path):
    panel = dialog.mainWidget()
    assert panel.wrappers[0][panel.parameter_to_column["POINT_CLOUDS"]].widget.message is None, "it stands in a table"
    assert dialog.surveys() == ["B12_cloud", "B12_cloud_2"] and dialog.windowTitle() == "Batch: Road map"
    dialog.save_everything_to(str(tmp_path))
    first, second = (dialog.mainWidget().parametersForRow(row, dialog.processingContext(), warnOnInvalid=False)[0] for row in (0, 1))
    assert first["ROAD_EDGES"].sink.staticValue() == f"ogr:dbname='{tmp_path}/B12_cloud.gpkg' table=\"road_edges\" (geom)"
    assert first["REPORT"] == f"{tmp_path}/B12_cloud_report.html" and second["REPORT"] == f"{tmp_path}/B12_cloud_2_report.html"
    assert not first["ROAD_POINTS"], "what is not made by default stays out"


def test_a_row_that_names_no_place_makes_temporary_layers(dialog, monkeypatch):
    given = []
    monkeypatch.setattr(dialog, "execute", given.extend)
    dialog._place(1, "MARKINGS").setValue("markings.gpkg")
    dialog.runAlgorithm()
    first, second = given
    assert first["DRIVING_LINES"].sink.staticValue() == first["REPORT"] == "TEMPORARY_OUTPUT" and not first["CURB_POINTS"].sink.staticValue()
    assert first["DRIVING_LINES"].destinationProject is not None
    assert second["MARKINGS"].sink.staticValue() == "markings.gpkg" and not second["REPORT"]


def test_a_virtual_point_cloud_is_a_survey_of_its_own_where_no_folder_is_one_already(tmp_path):
    for place in ("north", "elsewhere", "shown"):
        (tmp_path / place).mkdir()
        (tmp_path / place / "tile.laz").touch()
    (tmp_path / "shown" / "tile.laz").rename(tmp_path / "elsewhere" / "other.laz")
    write_vpc(tmp_path / "north.vpc", ["./north/tile.laz"])  # made to show the tiles
    far = write_vpc(tmp_path / "shown" / "far.vpc", ["./../../elsewhere/tile.laz"])
    (tmp_path / "shown" / "broken.vpc").touch()
    (tmp_path / "elsewhere").rename(tmp_path.parent / f"{tmp_path.name}_elsewhere")
    assert surveys_in(str(tmp_path)) == [str(tmp_path / "north"), str(tmp_path / "shown" / "broken.vpc"), far]


def test_a_folder_of_surveys_gives_a_row_each_with_its_trajectory_and_nothing_else(dialog, tmp_path):
    table = "time,x,y,z\n" + "".join(f"{100 + k / 10},{500000 + k},{5400000},100\n" for k in range(60))
    for place in ("north/B12", "south/B12", "empty"):
        (tmp_path / place).mkdir(parents=True, exist_ok=True)
        (tmp_path / place / "corrections.gpkg-wal").touch()
        (tmp_path / place / "readme.txt").write_text("what was scanned and when\n")
    (tmp_path / "north/B12/drive.csv").write_text(table)
    (tmp_path / "north/B12/tile_2.LAZ").touch()
    panel = dialog.mainWidget()
    value = lambda row, name: panel.wrappers[row][panel.parameter_to_column[name]].parameterValue()  # noqa: E731
    panel.clear()
    dialog.add_surveys(str(tmp_path))
    assert panel.batchRowCount() == 2
    assert [value(row, "POINT_CLOUDS") for row in (0, 1)] == [[str(tmp_path / "north/B12")], [str(tmp_path / "south/B12")]]
    assert value(0, "TRAJECTORY") == str(tmp_path / "north/B12/drive.csv") and not value(1, "TRAJECTORY")
