"""The widgets by which a survey is chosen: point clouds and trajectory."""

import pytest
from copc_files import write_vpc
from lanewright.algorithms.survey_input import cloud_files
from lanewright.core.common.errors import RoadExtractionError
from lanewright.desktop.survey_widgets import PointCloudsWidget, PointCloudsWrapper, TrajectoryWrapper, described, dropped_clouds, trajectory_beside
from qgis.core import QgsApplication, QgsProcessingContext, QgsProcessingModelAlgorithm, QgsVectorLayer
from qgis.gui import QgsProcessingModelerParameterWidget
from qgis.PyQt.QtCore import QMimeData, QUrl


@pytest.fixture
def folder(tmp_path):
    """Two tiles of a survey, a copy that QGIS made of one, and a table."""
    for name in ("tile_2.LAZ", "tile_1.laz", "tile_1.copc.laz", "drive.csv"):
        (tmp_path / name).write_bytes(b"0" * 1_000_000)
    return tmp_path


@pytest.fixture(autouse=True)
def no_window(provider, monkeypatch):
    """Dialogs take what they can from a window, and pytest-qgis puts one of its own in its place."""
    from processing.gui import BatchPanel, ParametersPanel

    for module in (BatchPanel, ParametersPanel):
        monkeypatch.setattr(module, "iface", None)


def layer(project, kind, name, *fields):
    made = QgsVectorLayer(f"{kind}?crs=EPSG:32650&" + "&".join(f"field={field}:double" for field in fields), name, "memory")
    project.addMapLayer(made)
    return made


def dialog_of(algorithm="lanewright:roadmap"):
    from processing.gui.AlgorithmDialog import AlgorithmDialog

    return AlgorithmDialog(QgsApplication.processingRegistry().createAlgorithmById(algorithm))


# -- which files are meant ------------------------------------------------------------------------


@pytest.mark.parametrize("given", ["", "tile_*", "*.[lL][aA][zZ]"])
def test_a_folder_or_wildcard_gives_its_clouds_and_no_point_twice(folder, given):
    assert cloud_files([str(folder / given)], "Point clouds") == [str(folder / name) for name in ("tile_1.laz", "tile_2.LAZ")]


def test_a_copc_that_is_named_or_stands_alone_is_taken(folder):
    named = str(folder / "tile_1.copc.laz")
    assert cloud_files([named], "Point clouds") == [named]
    (folder / "tile_1.laz").unlink()
    assert named in cloud_files([str(folder)], "Point clouds")


@pytest.mark.parametrize("given, said", [("empty", "holds no LAS or LAZ file"), ("x*.laz", "no LAS or LAZ file is called")])
def test_a_folder_or_wildcard_without_a_cloud_is_said(tmp_path, given, said):
    (tmp_path / "empty").mkdir()
    with pytest.raises(RoadExtractionError, match=f"Point clouds: .*{said}"):
        cloud_files([str(tmp_path / given)], "Point clouds")


@pytest.mark.parametrize("names", [
    ["./tile_1.laz", "./tile_2.LAZ"], ["tile_1.laz", "tile_2.LAZ"], ["./..\\{folder}\\tile_1.laz", "./..\\{folder}\\tile_2.LAZ"]])
def test_a_virtual_point_cloud_gives_the_files_that_it_names_and_no_overview(folder, names):
    tiles = [str(folder / name) for name in ("tile_1.laz", "tile_2.LAZ")]
    (folder / "all-overview.copc.laz").touch()
    named = write_vpc(folder / "all.vpc", [name.format(folder=folder.name) for name in names], "./all-overview.copc.laz")
    assert cloud_files([named], "Point clouds") == tiles == cloud_files([named, *tiles], "Point clouds")
    assert cloud_files([str(folder)], "Point clouds") == tiles, "the folder holds the overview beside it"


@pytest.mark.parametrize("given", ["", "*.VPC"])
def test_a_folder_that_holds_but_a_virtual_point_cloud_gives_its_files(folder, given):
    (folder / "shown").mkdir()
    write_vpc(folder / "shown" / "all.VPC", ["./../tile_1.laz", str(folder / "tile_2.LAZ")])
    assert cloud_files([str(folder / "shown" / given)], "Point clouds") == [str(folder / name) for name in ("tile_1.laz", "tile_2.LAZ")]


@pytest.mark.parametrize("names, said", [
    (["./a.laz", "https://tiles.test/b.copc.laz"], "all.vpc names https://tiles.test/b.copc.laz on a server, and nothing is fetched"),
    (["/vsicurl/https://tiles.test/b.laz"], "on a server"), ([], "all.vpc names no point clouds"), (None, "all.vpc names no point clouds")])
def test_a_virtual_point_cloud_of_a_server_and_one_that_is_none_are_refused_in_one_sentence(tmp_path, names, said):
    path = tmp_path / "all.vpc"
    path.write_text('{"type": "FeatureCollection", "features": [{"assets": [1]}]}') if names is None else write_vpc(path, names)
    with pytest.raises(RoadExtractionError, match=said):
        cloud_files([str(path)], "Point clouds")


# -- the widget ------------------------------------------------------------------------------------


def test_what_was_typed_is_counted_and_what_is_missing_named(qgis_app, folder):
    assert described([str(folder)]) == "2 files, 2.0 MB"
    assert "nowhere.laz" in described([str(folder / "nowhere.laz")])


def test_files_folders_and_only_those_can_be_dropped(qgis_app, folder):
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(path)) for path in (folder, folder / "tile_2.LAZ", folder / "all.vpc", folder / "drive.csv")])
    assert dropped_clouds(mime) == [str(folder), str(folder / "tile_2.LAZ"), str(folder / "all.vpc")]


def test_a_name_is_taken_once(qgis_app):
    widget = PointCloudsWidget()
    widget.set_value(["/a/1.laz", "/a/2.laz"])
    widget.add(["/a/2.laz", "/a/3.laz"])
    assert widget.value() == ["/a/1.laz", "/a/2.laz", "/a/3.laz"]


@pytest.mark.parametrize("given", [["/a/1.laz", "/a/2.laz"], "/a/1.laz;/a/2.laz", ("/a/1.laz", "/a/2.laz")])
def test_a_dialog_opened_from_the_history_holds_the_files_of_that_run(provider, given):
    dialog = dialog_of()
    dialog.setParameters({"POINT_CLOUDS": given})
    wrapper = dialog.mainWidget().wrappers["POINT_CLOUDS"]
    assert isinstance(wrapper, PointCloudsWrapper)
    assert wrapper.parameterValue() == ["/a/1.laz", "/a/2.laz"]


def test_a_model_of_the_stages_asks_with_the_same_widgets(provider):
    model = next(one for one in provider.algorithms() if one.displayName() == "Road map stages")
    wrappers = dialog_of(model.id()).mainWidget().wrappers
    kinds = {type(wrapper) for wrapper in wrappers.values()}
    assert {PointCloudsWrapper, TrajectoryWrapper} <= kinds


def test_the_model_designer_offers_the_inputs_of_the_model(provider):
    from processing.modeler.ModelerParametersDialog import ModelerParametersDialog

    algorithm = QgsApplication.processingRegistry().createAlgorithmById("lanewright:roadmap")
    model = QgsProcessingModelAlgorithm()
    model.initAlgorithm()
    dialog = ModelerParametersDialog(algorithm, model)
    for name in ("POINT_CLOUDS", "TRAJECTORY"):
        assert isinstance(dialog.widget.widget.wrappers[name], QgsProcessingModelerParameterWidget)


def test_each_file_of_a_batch_filled_from_a_list_becomes_a_row(provider, folder):
    from processing.gui.BatchAlgorithmDialog import BatchAlgorithmDialog
    from processing.gui.BatchPanel import BatchPanelFillWidget

    dialog = BatchAlgorithmDialog(QgsApplication.processingRegistry().createAlgorithmById("lanewright:roadmap"))
    panel = dialog.mainWidget()
    column = panel.parameter_to_column["POINT_CLOUDS"]
    fill = panel.tblParameters.cellWidget(0, column)
    assert isinstance(fill, BatchPanelFillWidget) and "*.laz" in fill.parameterDefinition.createFileFilter()
    for row in range(3):
        fill.setRowValue(row, f"/a/{row}.laz", QgsProcessingContext())
    assert [panel.valueForParameter(row, "POINT_CLOUDS") for row in range(3)] == [["/a/0.laz"], ["/a/1.laz"], ["/a/2.laz"]]


# -- the trajectory ----------------------------------------------------------------------------------


def shown(dialog):
    return dialog.mainWidget().wrappers["TRAJECTORY"].parameterValue()


def test_lines_of_a_road_map_are_not_offered_as_trajectory(provider, project):
    layer(project, "LineString", "Driving lines", "road", "lane", "station_m")
    layer(project, "Point", "Curb points", "road", "pass", "station_m")
    assert shown(dialog_of()) is None


def test_the_trajectory_of_the_project_is_offered(provider, project):
    layer(project, "LineString", "Driving lines", "road", "lane", "station_m")
    driven = layer(project, "Point", "drive", "gps_time", "roll", "heading")
    assert shown(dialog_of()) == driven.id()


def test_of_two_trajectories_none_is_chosen_for_the_user(provider, project):
    for name in ("monday", "tuesday"):
        layer(project, "Point", name, "time")
    assert shown(dialog_of()) is None


def test_an_optional_trajectory_stays_empty(provider, project):
    layer(project, "Point", "drive", "time")
    assert shown(dialog_of("lanewright:assessboundaries")) is None


def test_a_file_can_be_given_as_trajectory(provider, tmp_path):
    dialog = dialog_of()
    dialog.setParameters({"TRAJECTORY": str(tmp_path / "drive.csv")})
    assert shown(dialog) == str(tmp_path / "drive.csv")


def test_a_cloud_as_trajectory_is_refused_as_what_it_is(provider, folder):
    algorithm = provider.algorithm("roadmap").create()
    fine, said = algorithm.checkParameterValues({"POINT_CLOUDS": [str(folder / "tile_1.laz")], "TRAJECTORY": str(folder / "tile_1.laz")},
                                                QgsProcessingContext())
    assert not fine and "tile_1.laz holds neither a layer nor a table of positions" in said


# -- what lies beside the point clouds -------------------------------------------------------------


@pytest.fixture
def surveyed(tmp_path):
    """A survey in a folder with its trajectory as a table, and a text that is none."""
    from processing import run

    run("lanewright:samplesurvey", {
        "LENGTH": 20, "PULSE_RATE": 20000, "POINT_CLOUD": str(tmp_path / "s.laz"), "TRAJECTORY": str(tmp_path / "d.gpkg")})
    places = [(feature["time"], feature.geometry()) for feature in QgsVectorLayer(str(tmp_path / "d.gpkg"), "d").getFeatures()]
    rows = [f"{time},{place.constGet().x()},{place.constGet().y()},{place.constGet().z()}" for time, place in places]
    (tmp_path / "d.gpkg").unlink()
    (tmp_path / "drive.csv").write_text("\n".join(["time,x,y,z", *rows]))
    (tmp_path / "notes.txt").write_text("rain in the morning")
    return tmp_path


def test_the_trajectory_beside_the_point_clouds_is_offered_and_one_that_was_chosen_stays(surveyed, project):
    dialog = dialog_of()
    wrappers = dialog.mainWidget().wrappers
    dialog.setParameters({"POINT_CLOUDS": [str(surveyed / "s.laz")]})
    assert wrappers["TRAJECTORY"].parameterValue() == str(surveyed / "drive.csv")
    dialog.setParameters({"POINT_CLOUDS": ["/elsewhere/s.laz"]})
    assert not wrappers["TRAJECTORY"].parameterValue(), "it is not that of another survey"
    dialog.setParameters({"TRAJECTORY": str(surveyed / "notes.txt"), "POINT_CLOUDS": [str(surveyed / "s.laz")]})
    assert wrappers["TRAJECTORY"].parameterValue() == str(surveyed / "notes.txt")


def test_a_trajectory_in_two_dresses_is_one_and_two_drives_are_none(surveyed, project):
    clouds, rows = [str(surveyed / "s.laz")], (surveyed / "drive.csv").read_text().splitlines()
    (surveyed / "export.txt").write_text("\n".join(row.replace(",", ";") for row in rows))
    assert trajectory_beside(clouds) == str(surveyed / "drive.csv")
    (surveyed / "back.txt").write_text("\n".join(rows[:1] + rows[:0:-1]))
    assert trajectory_beside(clouds) == ""


def test_points_extent_crs_and_time_of_the_clouds_are_said(surveyed):
    said = described([str(surveyed / "s.laz")])
    assert " points, " in said and " m, EPSG:32650" in said and ("scanned 20" in said or "times " in said), said


def test_a_long_trajectory_is_known_by_how_it_begins(surveyed, project):
    """What lies behind some thousand positions is not read before the run, be it damaged or not."""
    lines = (surveyed / "drive.csv").read_text()
    rows = lines + "\n" + lines.partition("\n")[2] * (400_000 // len(lines))
    (surveyed / "drive.csv").write_bytes(rows.encode() + b"\0\xff\xfe" * 400_000)
    assert trajectory_beside([str(surveyed / "s.laz")]) == str(surveyed / "drive.csv")
