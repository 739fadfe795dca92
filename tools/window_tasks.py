"""Tasks of a surveyor in a QGIS window, from their own files to a database: each is done with what a user sees, and kept as a picture."""

import os
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

from lanewright.processing_provider.results.road_maps import run_table
from lanewright.processing_provider.texts import tr
from qgis import processing
from qgis.core import QgsProcessingContext, QgsProject, QgsRasterLayer, QgsSettings
from qgis.PyQt.QtCore import QCoreApplication, QEvent, Qt
from qgis.PyQt.QtWidgets import QDockWidget, QProgressBar, QTextEdit
from qgis.utils import iface, plugins
from web_map_tiles import served_tiles
from window import action_of, keep, needed, result, say, settle, wait

POSTGRES = sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
PORT = "54329"
SERVERS = []  # that are stopped at the end


@cache
def survey():
    """A folder as a survey comes: a point cloud, the trajectory as text, and a UAV image with control points."""
    folder = Path(tempfile.mkdtemp()) / "B12"
    folder.mkdir()
    made = processing.run("lanewright:samplesurvey", {
        "LENGTH": 80, "POINT_CLOUD": str(folder / "survey.laz"), "TRAJECTORY": "memory:",
        "UAV_IMAGE": str(folder / "uav_image.tif"), "UAV_GCPS": str(folder / "uav_gcps.gpkg")})
    needed(made["POINTS"] > 0, "the survey is empty")
    with open(folder / "trajectory.csv", "w", encoding="utf-8") as file:
        file.write("time,x,y,z,roll,pitch,heading\n")
        for feature in made["TRAJECTORY"].getFeatures():
            place = feature.geometry().constGet()
            row = (feature["time"], place.x(), place.y(), place.z(), feature["roll"], feature["pitch"], feature["heading"])
            file.write(",".join(f"{value:.6f}" for value in row) + "\n")
    return folder


def run(dialog, seconds):
    """Press Run and wait until the run has ended; the log says how."""
    ended = []
    dialog.algorithmFinished.connect(lambda *results: ended.append(results))
    dialog.runButton().click()
    needed(wait(seconds, lambda: bool(ended)), f"{dialog.windowTitle()} took longer than {seconds} s")
    wait(2)
    said = " ".join(edit.toPlainText() for edit in dialog.findChildren(QTextEdit, "txtLog"))
    needed(ended[0][0], f"{dialog.windowTitle()} failed: {said[-800:]}")


def show_map(output):
    """The map about a result, with the layers beside it and nothing else."""
    layers = None
    for dock in iface.mainWindow().findChildren(QDockWidget):
        if dock.objectName() == "Layers":
            layers = dock
        else:
            dock.hide()
    iface.mainWindow().resizeDocks([layers], [330], Qt.Orientation.Horizontal)
    iface.messageBar().clearWidgets()
    iface.setActiveLayer(result(output))
    iface.zoomToActiveLayer()
    settle(iface.mapCanvas().isDrawing)


def batch():
    """Three surveys in one batch, filled by a list of their point clouds."""
    days = ("monday", "tuesday", "wednesday")
    place = Path(tempfile.mkdtemp()) / "B12"
    for seed, day in enumerate(days):
        (place / day).mkdir(parents=True)
        processing.run("lanewright:samplesurvey", {"LENGTH": 30, "PULSE_RATE": 30000, "SEED": seed, "POINT_CLOUD": str(place / day / "tile.laz"),
                                                   "TRAJECTORY": str(place / day / "trajectory.gpkg")})
    action_of(tr("Road map…")).trigger()
    single = plugins["lanewright"].menu.dialog
    single.runAsBatchButton.click()
    window = single.batch
    panel = window.mainWidget()
    for name, file in (("POINT_CLOUDS", "*.laz"), ("TRAJECTORY", "trajectory.gpkg")):
        column = panel.parameter_to_column[name]
        fill = panel.tblParameters.cellWidget(0, column)
        for row, day in enumerate(days):
            fill.setRowValue(row, str(place / day / file), QgsProcessingContext())
    window.resize(1000, 420)
    (place / "results").mkdir()
    window.save_everything_to(str(place / "results"))
    keep(window, "window_batch")
    if os.environ["LANEWRIGHT_LANG"] != "en":  # the runs are the same in every language
        window.close()
        return
    window.runButton().click()
    needed(wait(900, lambda: all(f"{day}/tile" in run_table() for day in days)), "the batch took longer than 900 s")
    wait(3)
    made = sorted(path.name for path in (place / "results").glob("*.gpkg"))
    needed(made == [f"{day}_tile.gpkg" for day in days], f"the batch made {made}")
    groups = [node.name() for node in QgsProject.instance().layerTreeRoot().findGroups()]
    needed(all(any(f"{day}/tile" in name for name in groups) for day in days), f"the groups are {groups}")
    window.close()


def web_map():
    """A new project with a web map, as most begin; it is served by this computer."""
    QgsProject.instance().clear()
    url, server = served_tiles(survey())
    SERVERS.append(server)
    layer = QgsRasterLayer(f"type=xyz&url={url}&zmax=19&zmin=12", {"de": "Web-Karte"}.get(os.environ["LANEWRIGHT_LANG"], "Web map"), "wms")
    needed(layer.isValid(), "the web map is not valid")
    metadata = layer.metadata()
    metadata.setRights(["© Survey office, 2026"])
    layer.setMetadata(metadata)
    QgsProject.instance().addMapLayer(layer)
    wait(1)


def own_survey():
    """A first map of own files: the button of the toolbar, a folder, the trajectory, one place for the results, Run."""
    folder = survey()
    plugins["lanewright"].menu.actions[0].trigger()
    window = plugins["lanewright"].menu.dialog
    window.resize(1000, 820)
    wrappers = window.mainWidget().wrappers
    wrappers["POINT_CLOUDS"].widget.add([str(folder)])
    wrappers["TRAJECTORY"].setValue(str(folder / "trajectory.csv"))
    results = folder.parent / "results"
    results.mkdir()
    window.save_everything_to(str(results))
    keep(window, "window_own_survey")
    run(window, 300)
    window.close()
    made = sorted(path.name for path in results.iterdir())
    say(f"own survey: {made}")
    needed({"roadmap.gpkg", "report.html", "intensity_image.tif"} <= set(made), f"saving everything made {made}")
    groups = [node.name() for node in QgsProject.instance().layerTreeRoot().findGroups()]
    needed(any("B12/survey" in name for name in groups), f"the groups are {groups}")
    show_map("ROAD_SURFACE")
    say(f"map in {iface.mapCanvas().mapSettings().destinationCrs().authid()}, layers from above: "
        f"{[node.name() for node in QgsProject.instance().layerTreeRoot().children()]}")
    keep(iface.mainWindow(), "window_web_map")


def layout():
    """The road map on paper, over the web map."""
    action_of(tr("Sheets along the road…")).trigger()
    window = plugins["lanewright"].menu.dialog
    window.resize(1000, 820)
    window.setParameters({"OFFICE": "Musterstadt", "OUTPUT": str(survey().parent / "results" / "sheets.pdf")})
    say(f"sheets: {window.createProcessingParameters()}")
    keep(window, "window_layout_dialog")
    run(window, 120)
    window.close()
    iface.openLayoutDesigner(QgsProject.instance().layoutManager().printLayouts()[0])
    wait(3)
    designers = iface.openLayoutDesigners()
    needed(designers, "no layout was opened")
    window = designers[0].window()
    window.resize(1300, 800)
    designers[0].view().zoomFull()
    settle(lambda: any(bar.isVisible() for bar in window.findChildren(QProgressBar)), calm=4)
    keep(window, "window_layout")
    designers[0].close()
    # QGIS ends with an error where a project is closed before the window is gone
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def orthoimage():
    """A UAV image placed by its control points, under the lines of the map."""
    folder = survey()
    window = processing.createAlgorithmDialog("lanewright:georeferenceimage", {
        "IMAGE": str(folder / "uav_image.tif"), "GCPS": str(folder / "uav_gcps.gpkg"), "OUTPUT": str(folder.parent / "orthoimage.tif")})
    window.resize(1000, 820)
    window.show()
    run(window, 120)
    window.close()
    project = QgsProject.instance()
    image = next(layer for layer in project.mapLayers().values() if layer.source().endswith("orthoimage.tif"))
    node = project.layerTreeRoot().findLayer(image.id())
    needed(image.crs().isValid() and result("RESIDUALS").crs().isValid(), "the orthoimage has no CRS")
    needed("B12/survey" in node.parent().name(), f"the orthoimage is in {node.parent().name()!r}, not with the map it lies under")
    for output in ("ROAD_SURFACE", "INTENSITY_IMAGE", "RESIDUALS"):
        project.layerTreeRoot().findLayer(result(output).id()).setItemVisibilityChecked(False)
    show_map("ROAD_EDGES")
    keep(iface.mainWindow(), "window_orthoimage")
    action_of(tr("Compare two images")).trigger()
    swipe = plugins["lanewright"].menu.swipe
    needed(wait(60, swipe.halves.isVisible), "the two images are not shown")
    swipe.halves.divide(swipe.halves.width() // 2)
    iface.messageBar().clearWidgets()
    keep(iface.mainWindow(), "window_swipe")
    swipe.end()


def database():
    """The map straight into tables of PostGIS; left out where there is none on this computer."""
    if not POSTGRES or not list(Path("/usr/share/postgresql").glob("*/extension/postgis.control")):
        say("no PostGIS on this computer: apt install postgresql postgresql-postgis")
        return
    folder = survey()
    server = Path(tempfile.mkdtemp(prefix="lanewright-pg-"))
    shutil.chown(server, "postgres")

    def tool(name, *arguments):
        subprocess.run(["runuser", "-u", "postgres", "--", str(POSTGRES[0] / name), *arguments], cwd=server, check=True, stdout=subprocess.DEVNULL)

    tool("initdb", "-D", str(server / "data"), "-U", "lane", "--auth=trust", "-E", "UTF8", "--locale=C.UTF-8")
    tool("pg_ctl", "-D", str(server / "data"), "-w", "-l", str(server / "log"), "start", "-o", f"-k {server} -p {PORT} -c listen_addresses=''")
    try:
        subprocess.run(["psql", "-h", str(server), "-p", PORT, "-U", "lane", "-d", "postgres", "-qc",
                        "CREATE EXTENSION postgis; CREATE SCHEMA roads"], check=True)
        into_database(folder, str(server))
    finally:
        QgsProject.instance().clear()
        tool("pg_ctl", "-D", str(server / "data"), "-m", "immediate", "stop")
        shutil.rmtree(server, ignore_errors=True)


def into_database(folder, host):
    """Road map with its layers as tables of a schema, by a connection that QGIS knows."""
    QgsProject.instance().clear()
    settings = QgsSettings()
    for name, value in {"host": host, "port": PORT, "database": "postgres", "username": "lane", "saveUsername": "true"}.items():
        settings.setValue(f"PostgreSQL/connections/B12/{name}", value)
    window = processing.createAlgorithmDialog("lanewright:roadmap", {
        "POINT_CLOUDS": [str(folder / "survey.laz")], "TRAJECTORY": str(folder / "trajectory.csv")})
    window.resize(1000, 820)
    window.show()
    window.choose_database()
    asked = window.database
    asked.schema.setCurrentText("roads")
    needed(asked.choice == ("B12", "roads", ""), f"the connection is not offered: {asked.choice}, {asked.problem.text()}")
    keep(asked, "window_database_dialog")
    asked.accept()
    run(window, 300)
    window.close()
    layers = [layer for layer in QgsProject.instance().mapLayers().values() if layer.providerType() == "postgres"]
    say(f"in the database: {sorted((layer.name(), layer.featureCount()) for layer in layers)}")
    needed(len(layers) >= 8, "not all layers are in the database")
    show_map("ROAD_EDGES")
    keep(iface.mainWindow(), "window_database")
