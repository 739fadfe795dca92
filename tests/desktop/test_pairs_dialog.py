"""The window that places UAV images by paint."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from lanewright.desktop.overlay.pairs_dialog import PairsDialog
from paint_from_above import Ground, Overhead, about, street
from qgis.core import QgsFeatureRequest, QgsLayerTreeModel, QgsPointXY, QgsProject, QgsRasterLayer, QgsVectorLayer
from qgis.gui import QgsLayerTreeView, QgsMapCanvas
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer, Qt
from qgis.PyQt.QtWidgets import QDialogButtonBox, QMainWindow

CAMERA = Overhead(turn=0.2, width=1500, height=500)


@pytest.fixture(scope="module")
def flight(tmp_path_factory):
    """(paths of two images of a flight and one of a meadow, with world files a few metres off; path of the intensity image)."""
    folder = tmp_path_factory.mktemp("flight")
    ground, paths = Ground(street()), []
    for name, camera, seen in (("first", CAMERA, ground), ("second", Overhead(x=CAMERA.x + 6, turn=0.1, width=1500, height=500), ground),
                               ("meadow", CAMERA, Ground([]))):
        seen.photo(folder / f"{name}.png", camera)
        rough = about(camera, dx=2.0, dy=-1.5, turn=0.01, size=1.005)
        cos, sin = np.cos(rough.turn) * rough.size, np.sin(rough.turn) * rough.size
        left = rough.x - cos * camera.width / 2 - sin * camera.height / 2
        top = rough.y - sin * camera.width / 2 + cos * camera.height / 2
        (folder / f"{name}.pgw").write_text(f"{cos}\n{sin}\n{sin}\n{-cos}\n{left + (cos + sin) / 2}\n{top + (sin - cos) / 2}\n")
        paths.append(str(folder / f"{name}.png"))
    return paths, ground.intensity_image(folder / "intensity.tif").path


@pytest.fixture
def window(provider, flight, qgis_iface, monkeypatch):
    project = QgsProject.instance()
    project.clear()
    project.addMapLayer(QgsRasterLayer(flight[1], "Intensity image"))
    main = QMainWindow()
    tree = QgsLayerTreeView(main)  # QGIS since 3.44 puts results into a real one
    tree.setModel(QgsLayerTreeModel(project.layerTreeRoot(), tree))
    monkeypatch.setattr(qgis_iface, "layerTreeView", lambda: tree)
    canvas = QgsMapCanvas(main)
    canvas.setDestinationCrs(project.mapLayersByName("Intensity image")[0].crs())
    dialog = PairsDialog(SimpleNamespace(mainWindow=lambda: main, mapCanvas=lambda: canvas))
    yield dialog
    dialog.close()
    canvas.stopRendering()
    project.clear()
    QCoreApplication.processEvents()


def finished(window):
    clock = QElapsedTimer()
    clock.start()
    while window._run is not None and clock.elapsed() < 120_000:
        QCoreApplication.processEvents()
    assert window._run is None


@pytest.fixture(scope="module")
def pairs_of_first(provider, flight, tmp_path_factory):
    """The pairs of the first image, found once for the tests that go on from there."""
    from qgis import processing

    path = str(tmp_path_factory.mktemp("pairs") / "pairs.gpkg")
    processing.run("lanewright:proposecontrolpoints", {"IMAGE": flight[0][0], "INTENSITY_IMAGE": flight[1], "CONTROL_POINTS": path})
    return path


@pytest.fixture
def proposed(window, flight, pairs_of_first):
    """The window as it is when the pairs of one image were found."""
    layer = QgsVectorLayer(pairs_of_first, "pairs").materialize(QgsFeatureRequest())
    QgsProject.instance().addMapLayer(layer)
    window.add(flight[0][:1])
    window.images[0].found(layer)
    window._show_pairs()
    return window


def test_pairs_are_shown_with_both_cut_outs_and_a_tick(proposed):
    first = proposed.images[0]
    assert proposed.pairs.count() == len(first.rows()) >= 15
    item = proposed.pairs.item(0)
    assert item.checkState() == Qt.CheckState.Checked and "likeness" in item.text()
    picture = item.icon().pixmap(proposed.pairs.iconSize()).toImage()
    left, right = (np.array([[picture.pixelColor(x + shift, y).lightness() for x in range(4, 110, 5)] for y in range(4, 110, 5)]).ravel()
                   for shift in (0, 120))
    assert np.corrcoef(left, right)[0, 1] > 0.5
    assert "pairs accepted, RMSE" in proposed.list.item(0).text()


def test_a_tick_taken_away_refuses_the_pair_and_judges_the_others_anew(proposed):
    first = proposed.images[0]
    accepted, before = sum(row["accepted"] for row in first.rows()), [row["residual"] for row in first.rows()]
    proposed.pairs.item(0).setCheckState(Qt.CheckState.Unchecked)
    rows = first.rows()
    assert sum(row["accepted"] for row in rows) == accepted - 1 and not rows[0]["accepted"]
    assert [row["residual"] for row in rows] != before
    proposed.pairs.selectAll()
    proposed.accept_selected(False)
    assert "0 of" in first.summary() and not proposed.place_button.isEnabled()
    proposed.accept_selected(True)
    assert all(row["accepted"] for row in first.rows()) and proposed.place_button.isEnabled()


def test_a_double_click_shows_the_pair_on_the_map(proposed):
    proposed.pairs.itemDoubleClicked.emit(proposed.pairs.item(0))
    at = proposed.images[0].rows()[0].geometry().asPoint()
    assert proposed.iface.mapCanvas().extent().contains(at) and proposed.iface.mapCanvas().extent().width() < 100


@pytest.mark.slow
def test_several_images_of_a_flight_are_placed_side_by_side_and_one_that_fails_says_why(window, flight):
    window.add(flight[0])
    window.add(flight[0])
    assert len(window.images) == 3
    window.propose()
    finished(window)
    assert [bool(one.order) for one in window.images] == [True, True, False]
    assert "do not fit each other" in window.list.item(2).text()
    window.place()
    finished(window)
    assert "On the map: first_map" in window.list.item(0).text() and "On the map" not in window.list.item(2).text()
    drawn = [layer for layer in QgsProject.instance().mapLayers().values() if layer.source().endswith("_map.tif")]
    assert len(drawn) == 2 and all(layer.crs().authid() == "EPSG:32650" for layer in drawn)
    between = [layer.extent().center().x() for layer in sorted(drawn, key=lambda layer: layer.source())]
    assert between[1] - between[0] == pytest.approx(6.0, abs=0.5)


def test_a_layer_that_was_taken_out_of_the_project_is_looked_for_anew(proposed):
    QgsProject.instance().removeMapLayer(proposed.images[0].layer.id())
    assert proposed.images[0].rows() == [] and proposed.images[0].order == 0
    assert "not looked for" in proposed.images[0].summary()


@pytest.mark.slow
def test_an_image_that_says_nothing_is_placed_by_two_clicks_in_each_image(window, flight, tmp_path):
    bare = tmp_path / "bare.png"
    bare.write_bytes(Path(flight[0][0]).read_bytes())
    window.add([str(bare)])
    window.point()
    asked = window.two_points
    photo, known = asked.views
    ok = asked.buttons.button(QDialogButtonBox.StandardButton.Ok)
    for pixel, line, off in ((80.0, 260.0, 0.8), (1420.0, 240.0, -0.7)):
        assert not ok.isEnabled()
        asked.point_at(photo, QgsPointXY(asked.photo.extent().xMinimum() + pixel, asked.photo.extent().yMaximum() - line))
        east, north = (float(value[0]) for value in CAMERA.to_map(np.array([pixel]), np.array([line])))
        asked.point_at(known, QgsPointXY(east + off, north + off))
    assert ok.isEnabled() and len(asked.marks) == 4
    asked.accept()
    assert "two points given" in window.list.item(0).text()
    window.propose()
    finished(window)
    assert window.images[0].order and window.images[0].failed == ""


def test_points_can_be_begun_again(window, flight):
    window.add(flight[0][:1])
    window.point()
    asked = window.two_points
    asked.point_at(asked.views[0], asked.photo.extent().center())
    asked.begin()
    assert asked.layer is None and not asked.marks and "image: 0" in asked.message.text()
    asked.reject()
    assert window.two_points is None and window.images[0].rough is None


def test_a_base_map_above_the_intensity_image_is_no_error_and_the_image_is_chosen(provider, flight, project):
    project.addMapLayer(QgsRasterLayer(flight[0][0], "A base map"))
    project.addMapLayer(QgsRasterLayer(flight[1], "Intensity image"))
    main = QMainWindow()
    dialog = PairsDialog(SimpleNamespace(mainWindow=lambda: main))
    assert dialog.intensity.currentLayer().source() == flight[1]
    dialog.close()
