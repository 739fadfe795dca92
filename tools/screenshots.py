"""Run by QGIS itself (qgis --code): does what a newcomer does, and keeps a picture of each step."""

import os
import sys
import tempfile
import traceback
from pathlib import Path

from lanewright.processing_provider.results.road_maps import last_report
from lanewright.processing_provider.texts import tr
from qgis.core import QgsCoordinateTransform, QgsPointXY, QgsProject
from qgis.PyQt.QtCore import Qt, QTimer
from qgis.PyQt.QtGui import QAction, QGuiApplication
from qgis.PyQt.QtWidgets import QApplication, QDockWidget
from qgis.utils import iface, plugins

sys.path.insert(0, str(Path(os.environ["LANEWRIGHT_ROOT"]) / "tools"))

from window import action_of, keep, needed, result, save, say, wait  # noqa: E402
from window_tasks import SERVERS, batch, database, layout, orthoimage, own_survey, web_map  # noqa: E402


def toolbox():
    dock = next(dock for dock in iface.mainWindow().findChildren(QDockWidget) if dock.objectName() == "ProcessingToolbox")
    dock.show()
    dock.raise_()
    dock.setFloating(True)
    dock.resize(420, 870)
    tree = dock.findChild(type(dock.algorithmTree)) if hasattr(dock, "algorithmTree") else None
    wait(0.5)
    view = tree or dock.algorithmTree
    model = view.model()
    for row in range(model.rowCount()):
        index = model.index(row, 0)
        if "Lanewright" in str(index.data()):
            view.expand(index)
            for child in range(model.rowCount(index)):
                view.expand(model.index(child, 0, index))
            view.scrollTo(index, view.ScrollHint.PositionAtTop)
            needed(model.rowCount(index) >= 5, "the toolbox lists too few groups")
    keep(dock, "window_toolbox")
    dock.hide()


def dialog():
    """The road map dialog as the toolbar button opens it."""
    plugins["lanewright"].menu.actions[0].trigger()
    wait(1.5)
    window = plugins["lanewright"].menu.dialog
    needed(window is not None and window.isVisible(), "the road map dialog did not open")
    window.resize(1000, 820)
    keep(window, "window_dialog")
    window.close()


def columns():
    """A trajectory without names in its file: its columns, and what was understood."""
    import math

    from qgis import processing

    path = Path(tempfile.mkdtemp()) / "drive.txt"
    with open(path, "w", encoding="utf-8") as file:
        for k in range(4000):
            bend = k / 2000
            file.write(f"{518204.0 + k / 50:.3f} {5400000 + 400 * math.sin(bend):.3f} {500000 + 400 * bend:.3f} "
                       f"{78 + math.sin(k / 300):.3f} {0.4 * math.sin(k / 60):.3f} {0.3 * math.cos(k / 70):.3f} {k % 7}\n")
    window = processing.createAlgorithmDialog("lanewright:importtrajectory", {"INPUT": str(path), "COLUMNS": "time,y,x,z,roll,pitch,-"})
    window.resize(1000, 760)
    window.show()
    wait(1.5)
    widget = window.mainWidget().wrappers["COLUMNS"].widget
    needed(len(widget.boxes) == 7 and "000 " in widget.message.text(), f"the columns are not shown: {widget.message.text()}")
    keep(window, "window_columns")
    window.close()


def menu():
    """The plugin menu, opened as by a click, with what the window shows around it."""
    iface.messageBar().clearWidgets()
    bar = iface.mainWindow().menuBar()
    bar.setActiveAction(next(action for action in bar.actions() if action.menu() == iface.pluginMenu()))
    ours = next(a for a in iface.pluginMenu().actions() if a.menu() and "Lanewright" in a.menu().title())
    iface.pluginMenu().setActiveAction(ours)
    needed(wait(5, ours.menu().isVisible), "the plugin menu did not open")
    wait(0.7)
    corner = ours.menu().mapToGlobal(ours.menu().rect().bottomRight())
    save(QGuiApplication.primaryScreen().grabWindow(0, 0, 0, corner.x() + 120, corner.y() + 40), "window_menu")
    ours.menu().close()
    iface.pluginMenu().close()


def sample():
    """The sample survey, run from the menu, until its layers are there."""
    ours = plugins["lanewright"].menu
    ours.actions[1].trigger()
    needed(wait(400, lambda: ours.sample.running is None), "the sample survey took longer than 400 s")
    wait(2)
    from processing.core.ProcessingResults import resultsList

    needed(any(Path(result.filename).is_file() for result in resultsList.getResults()), "the report is not in the Results Viewer")
    needed(last_report(), "the menu knows no report")
    names = {layer.name() for layer in QgsProject.instance().mapLayers().values()}
    needed(len(names) >= 6, f"the sample left only {sorted(names)}")
    groups = [node.name() for node in QgsProject.instance().layerTreeRoot().findGroups()]
    say(f"groups: {groups}, layers: {sorted(names)}")
    for dock in iface.mainWindow().findChildren(QDockWidget):
        if dock.objectName() not in ("Layers",):
            dock.hide()
    iface.mainWindow().resize(1380, 860)
    iface.messageBar().clearWidgets()
    iface.setActiveLayer(result("ROAD_SURFACE"))
    iface.zoomToActiveLayer()
    keep(iface.mainWindow(), "window_result")


def doubts():
    """The next doubtful place, with the section of the road there."""
    ours = plugins["lanewright"].menu
    window = iface.mainWindow()
    action_of(tr("Cross-section")).trigger()
    action_of(tr("Next doubtful place")).trigger()
    places = ours.doubts
    needed(places.place is not None, "no place of the sample is doubtful")
    dock = ours.section
    window.resizeDocks([dock], [330], Qt.Orientation.Vertical)
    needed(wait(60, lambda: dock.task is None and len(dock.view.points)), f"no points in the section: {dock.view.message}")
    wait(2)
    keep(window, "window_section")
    curb_in_section(dock, places)
    corrections(places)
    iface.messageBar().clearWidgets()
    dock.hide()
    action_of(tr("Steps of the road map")).trigger()
    places.steps.tree.topLevelItem(len(places.steps.steps) - 1).setExpanded(True)
    needed(any(step.state == tr("stale") for step in places.steps.steps), "the corrections make no step stale")
    keep(window, "window_steps")
    places.hide()


def curb_in_section(dock, places):
    """A curb drawn in two sections, by three clicks."""
    folder = Path(tempfile.mkdtemp())
    dock.ask_for_file = places.ask_for_file = lambda: str(folder / "corrections.gpkg")
    edges = result("ROAD_EDGES")
    curb = max((row for row in edges.getFeatures() if row["edge"] == "curb"), key=lambda row: row.geometry().length()).geometry()
    middle = curb.interpolate(curb.length() / 2).asPoint()
    dock.show_at(middle, edges.crs())
    to_map = QgsCoordinateTransform(edges.crs(), iface.mapCanvas().mapSettings().destinationCrs(), QgsProject.instance())
    iface.mapCanvas().setCenter(to_map.transform(middle))
    iface.mapCanvas().zoomScale(300)
    needed(wait(60, lambda: dock.task is None and len(dock.view.points)), f"no points in the section: {dock.view.message}")
    for clicks in (2, 1):
        place = curb.nearestPoint(dock.section.line()).asPoint()
        for _ in range(clicks):
            dock.view.clicked.emit(dock.section.offset(place.x(), place.y()))
            wait(1)
        if clicks == 2:
            needed(places.layer is not None and places.layer.featureCount() == 1, f"no curb was added: {dock.said.text()}")
            for _ in range(4):
                dock.step(1.0)
    keep(iface.mainWindow(), "window_section_curb")
    say(dock.said.text())
    dock.view.undone.emit(), dock.view.undone.emit()
    needed(places.layer.featureCount() == 0, "the curb was not taken back")


def corrections(dock):
    """Three decisions in the window of doubtful places, the map being made again with them, and the dialog that would do so."""

    def kept(count):
        needed(wait(60, lambda: dock.layer is not None and dock.layer.featureCount() >= count), f"correction {count} was not kept")

    dock.accept_button.click()
    kept(1)
    wait(1)
    # a zebra crossing has no edge lines
    at, row = next((at, row) for at, place in enumerate(dock.places) for row, piece in enumerate(place.pieces) if piece.target == "marking")
    dock.at = at - 1
    dock.go(dock.road_map)
    dock.list.setCurrentRow(row)
    dock.note.setText({"de": "Zebrastreifen"}.get(os.environ["LANEWRIGHT_LANG"], "zebra crossing"))
    dock.delete_button.click()
    kept(2)
    wait(1)
    dock.go(dock.road_map)
    line = dock.place.pieces[0].line
    dock.begin("draw", "edge")
    to_map = QgsCoordinateTransform(dock.place.crs, iface.mapCanvas().mapSettings().destinationCrs(), QgsProject.instance())
    for share in (0.1, 0.5, 0.9):
        dock.tool.add(to_map.transform(line.interpolate(share * line.length()).asPoint()))
    wait(1)
    dock.tool.finish()
    kept(3)
    dock.at = at - 1
    dock.go(dock.road_map)  # the crossing, with what was decided there
    wait(2)
    keep(iface.mainWindow(), "window_corrections")
    dock.run_button.click()
    needed(wait(5, lambda: dock.remaking.isVisible() and dock.remaking.bar.value()), "the map is not made again")
    keep(dock, "window_made_again")
    dock.remaking.cancel()
    needed(wait(60, lambda: dock.remaking.run is None), "the run was not cancelled")
    dock.steps.run_wanted.emit()
    window = plugins["lanewright"].menu.dialog
    needed(wait(5, window.isVisible), "the road map dialog did not open for the corrections")
    values = window.createProcessingParameters()
    needed(all(values.get(name) for name in ("CORRECTIONS", "POINT_CLOUDS", "TRAJECTORY")), f"the dialog lacks something: {values}")
    say(f"made again from: {sorted(name for name, value in values.items() if value not in (None, '', False))}")
    window.close()


def view3d():
    """The sample street in QGIS's 3D view, with the points about the place."""
    from lanewright.desktop.view3d import TASKS

    iface.mapCanvas().zoomScale(300)
    action_of(tr("Road map in 3D")).trigger()
    needed(wait(120, lambda: not TASKS), "the points of the 3D view took longer than 120 s")
    view = next(window for window in QApplication.topLevelWidgets()
                if any(child.metaObject().className() == "Qgs3DMapCanvasWidget" for child in window.children()))
    view.setGeometry(0, 0, 1000, 620)
    wait(30)  # the octree is read and drawn in the background, of which nothing tells when it is done
    save(QGuiApplication.primaryScreen().grabWindow(view.winId()), "window_3d")
    view.close()
    wait(3)  # QGIS ends where points go while a view still loads them


def pairs():
    """The UAV image of the sample survey and the intensity image of its road map: pairs of cut-outs, accepted and refused."""
    from lanewright.simulator.orthophoto import write_uav_image
    from lanewright.simulator.survey import make_sample_survey

    path = Path(tempfile.mkdtemp()) / "flight_0031.tif"
    write_uav_image(make_sample_survey(), path)
    action_of(tr("Control points from paint")).trigger()
    window = plugins["lanewright"].menu.pairs
    window.add([str(path)])
    window.point()
    asked = window.two_points
    # the zebra crossing, the arrows
    for view, places in zip(asked.views, (((0.25, 0.5), (0.71, 0.46)), ((0.48, 0.22), (0.6, 0.7)))):
        wait(2)
        for across, up in places:
            extent = view.extent()
            asked.point_at(view, QgsPointXY(extent.xMinimum() + across * extent.width(), extent.yMinimum() + up * extent.height()))
    needed(asked.layer is not None, "the two points were not taken")
    keep(asked, "window_two_points")
    asked.reject()
    window.propose()
    needed(wait(240, lambda: window._run is None), "the control points took longer than 240 s")
    needed(window.images[0].order == 2, f"too few pairs were accepted: {window.images[0].summary()}")
    say(window.images[0].summary())
    window.pairs.scrollToBottom()  # the doubtful ones come last
    keep(window, "window_pairs")
    window.place()
    needed(wait(240, lambda: window._run is None), "the image took longer than 240 s")
    needed(any(layer.source().endswith("_map.tif") for layer in QgsProject.instance().mapLayers().values()), "the image is not on the map")
    window.close()


def manual():
    plugins["lanewright"].menu.actions[-1].trigger()
    window = plugins["lanewright"].menu.manual
    wait(1)
    needed(len(window.browser.toPlainText()) > 500, "the manual is empty")
    keep(window, "window_manual")
    window.close()


def designer():
    """The chain as a model, in the model designer."""
    ours = plugins["lanewright"].menu
    action = next((action for action in ours.models.actions() if action.text() == tr("Road map stages")), None)
    needed(action is not None, "the model is not in the menu")
    action.trigger()
    window = ours.designer
    window.resize(1380, 860)
    wait(1)
    window.findChild(QAction, "mActionZoomToItems").trigger()
    keep(window, "window_model")
    window.close()


STEPS = (menu, toolbox, dialog, columns, sample, doubts, view3d, pairs, manual, designer, web_map, own_survey, layout, orthoimage, database, batch)


def drive():
    try:
        iface.mainWindow().resize(1380, 860)
        wait(2)
        wanted = os.environ.get("LANEWRIGHT_STEPS", "").split()
        for step in STEPS:
            if not wanted or step.__name__ in wanted:
                step()
        say("finished")
    except BaseException:
        say(traceback.format_exc())
    QgsProject.instance().clear()
    for server in SERVERS:
        server.kill()
    os._exit(0)


if "lanewright" not in plugins:
    say(f"The plugin is not loaded: {sorted(plugins)}")
    os._exit(1)
QTimer.singleShot(1500, drive)
