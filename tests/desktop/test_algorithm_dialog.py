"""The dialog of our algorithms: its title, one place for all results, presets; and the order of the toolbox."""

import pytest
from lanewright.algorithms.catalogue import ALGORITHMS
from lanewright.desktop.dialogs.algorithm_dialog import LanewrightDialog, destinations, presets_of
from qgis.core import QgsApplication, QgsVectorLayer
from qgis.PyQt.QtWidgets import QDialogButtonBox, QTextBrowser


@pytest.fixture(autouse=True)
def no_window(provider, monkeypatch):
    """Dialogs take what they can from a window, and pytest-qgis puts one of its own in its place."""
    from processing.gui import ParametersPanel

    monkeypatch.setattr(ParametersPanel, "iface", None)


def algorithm_of(ID):
    return QgsApplication.processingRegistry().createAlgorithmById(f"lanewright:{ID}")


@pytest.fixture
def dialog():
    dialog = algorithm_of("roadmap").createCustomParametersWidget()
    yield dialog
    for name in list(presets_of("roadmap")):
        dialog.remove_preset(name)


def test_the_dialog_opens_under_the_plain_title(dialog):
    assert isinstance(dialog, LanewrightDialog) and dialog.windowTitle() == "Road map"
    assert "5.1" not in dialog.findChild(QTextBrowser, "textShortHelp").toPlainText()
    assert algorithm_of("roadmapstages").createCustomParametersWidget().windowTitle() == "Road map stages"


def test_the_toolbox_lists_groups_and_algorithms_in_the_order_of_the_work(provider):
    listed = sorted((algorithm for algorithm in provider.algorithms() if hasattr(algorithm, "declaration")),
                    key=lambda algorithm: (algorithm.group(), algorithm.displayName()))
    by_number = [algorithm.declaration.ID for algorithm in listed]
    wanted = sorted(ALGORITHMS, key=lambda declared: algorithm_of(declared.ID).group())  # within a group as in the catalogue
    assert by_number == [declared.ID for declared in wanted]


def test_every_algorithm_has_a_picture_of_its_own(provider):
    icons = {algorithm.name(): algorithm.icon() for algorithm in provider.algorithms() if hasattr(algorithm, "declaration")}
    pictures = {name: icon.pixmap(24, 24).toImage() for name, icon in icons.items()}
    assert not [name for name, picture in pictures.items() if picture.isNull()]
    assert len({bytes(picture.bits().asstring(picture.sizeInBytes())) for picture in pictures.values()}) == len(pictures)


def test_everything_goes_to_one_geopackage_and_its_folder(dialog, tmp_path):
    dialog.setParameters({"POINT_CLOUDS": ["a.laz"], "TRAJECTORY": "drive.csv"})
    dialog.save_everything_to(str(tmp_path))
    parameters = dialog.createProcessingParameters()
    edges, lanes = (parameters[name].sink.staticValue() for name in ("ROAD_EDGES", "DRIVING_LINES"))
    assert edges == f"ogr:dbname='{tmp_path}/roadmap.gpkg' table=\"road_edges\" (geom)" and "driving_lines" in lanes
    assert parameters["REPORT"] == f"{tmp_path}/report.html"
    assert parameters["INTENSITY_IMAGE"].sink.staticValue() == f"{tmp_path}/intensity_image.tif"
    assert not parameters.get("ROAD_POINTS"), "what is not made by default stays out"


def test_it_says_where_everything_goes_and_that_an_earlier_run_is_replaced(dialog, tmp_path):
    said = lambda: dialog.messageBar().currentItem().text()  # noqa: E731
    dialog.save_everything_to(str(tmp_path))
    assert str(tmp_path) in said() and "replaced" not in said()
    (tmp_path / "roadmap.gpkg").touch()
    dialog.save_everything_to(str(tmp_path))
    assert "roadmap.gpkg will be replaced" in said()


@pytest.fixture
def connection(kept_connection):
    """A connection to PostGIS that QGIS keeps, to a server that need not run."""
    return kept_connection("B12", "dbname='roads' host=/nowhere port=5432 user='lane'", saveUsername=True)


def test_all_layers_go_to_tables_of_one_schema(dialog, connection):
    dialog.setParameters({"POINT_CLOUDS": ["a.laz"]})
    dialog.save_layers_to(connection, "survey_7", "north_")
    parameters = dialog.createProcessingParameters()
    edges, lanes = (parameters[name].sink.staticValue() for name in ("ROAD_EDGES", "DRIVING_LINES"))
    assert edges.startswith("postgres://") and "dbname='roads'" in edges and edges.endswith('table="survey_7"."north_road_edges" (geom)')
    assert "north_driving_lines" in lanes and "host=/nowhere" in lanes and "survey_7" in dialog.messageBar().currentItem().text()
    assert parameters["CURVE_ELEMENTS"].sink.staticValue().endswith('table="survey_7"."north_curve_elements"'), "a table without geometry"
    assert parameters["REPORT"] == "TEMPORARY_OUTPUT", "files keep their destination"


def test_without_a_connection_the_way_to_one_is_shown(dialog):
    dialog.choose_database()
    assert "New connection" in dialog.database.problem.text() and not ready(dialog.database)
    dialog.database.reject()


def test_a_server_that_does_not_answer_is_said(dialog, connection):
    dialog.choose_database()
    assert dialog.database.choice[0] == connection and "roads" in dialog.database.problem.text() and not ready(dialog.database)
    dialog.database.reject()


def ready(database):
    return database.buttons.button(QDialogButtonBox.StandardButton.Ok).isEnabled()


def test_a_run_writes_what_save_everything_names(provider, tmp_path):
    import processing

    algorithm = algorithm_of("samplesurvey")
    places = destinations(algorithm, str(tmp_path))
    processing.run("lanewright:samplesurvey", {"LENGTH": 20, "PULSE_RATE": 20000, **places})
    package = QgsVectorLayer(str(tmp_path / "samplesurvey.gpkg"), "all", "ogr")
    tables = {layer.split("!!::!!")[1] for layer in package.dataProvider().subLayers()}
    assert tables == {definition.name().lower() for definition in algorithm.destinationParameterDefinitions()
                      if definition.type() == "sink" and definition.createByDefault()}
    assert (tmp_path / "point_cloud.laz").is_file()


def test_a_preset_brings_the_settings_back_and_leaves_the_data(dialog):
    dialog.setParameters({"POINT_CLOUDS": ["a.laz"], "MIN_HEIGHT": 0.08, "BOUNDARY_METHOD": "profiles"})
    dialog.save_preset("low curbs")
    other = algorithm_of("roadmap").createCustomParametersWidget()
    other.setParameters({"POINT_CLOUDS": ["b.laz"]})
    other.load_preset("low curbs")
    wrappers = other.mainWidget().wrappers
    assert [wrappers[name].parameterValue() for name in ("MIN_HEIGHT", "BOUNDARY_METHOD", "POINT_CLOUDS")] == [0.08, "profiles", ["b.laz"]]


def test_a_removed_preset_is_gone(dialog):
    dialog.save_preset("one")
    dialog.remove_preset("one")
    assert "one" not in presets_of("roadmap")


def test_many_results_are_folded_away_and_few_stand_open(dialog):
    assert dialog.folded.isCollapsed()
    assert dialog.folded.isAncestorOf(dialog.mainWidget().wrappers["ROAD_EDGES"].wrappedWidget())
    assert not dialog.folded.isAncestorOf(dialog.mainWidget().wrappers["POINT_CLOUDS"].widget)
    assert not hasattr(algorithm_of("drivinglines").createCustomParametersWidget(), "folded")


def test_the_first_parameter_has_the_focus_when_the_dialog_opens(dialog):
    dialog.show()
    assert dialog.mainWidget().wrappers["POINT_CLOUDS"].widget.isAncestorOf(dialog.focusWidget())
    dialog.close()
