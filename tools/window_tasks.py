"""Tasks of a surveyor in a QGIS window, from their own files to a database: each is done with what a user sees, and kept as a picture."""

import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import processing
from qgis.core import QgsDataSourceUri, QgsProject
from qgis.PyQt.QtWidgets import QDockWidget, QTextEdit
from qgis.utils import iface, plugins
from window import keep, needed, say, wait

POSTGRES = sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
PORT = "54329"


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


def show_map(name):
    for dock in iface.mainWindow().findChildren(QDockWidget):
        if dock.objectName() != "Layers":
            dock.hide()
    iface.messageBar().clearWidgets()
    iface.setActiveLayer(next(layer for layer in QgsProject.instance().mapLayers().values() if layer.name() == name))
    iface.zoomToActiveLayer()
    wait(3)


def own_survey():
    """A first map of own files: the button of the toolbar, a folder, the trajectory, one place for the results, Run."""
    folder = survey()
    QgsProject.instance().clear()
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
    needed(any(name.startswith("B12/survey") for name in groups), f"the groups are {groups}")


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
    needed(node.parent().name().startswith("B12/survey"), f"the orthoimage is in {node.parent().name()!r}, not with the map it lies under")
    for layer in project.mapLayers().values():
        if layer.name() in ("Road surface", "Intensity image"):
            project.layerTreeRoot().findLayer(layer.id()).setItemVisibilityChecked(False)
    show_map("Road edges")
    keep(iface.mainWindow(), "window_orthoimage")


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
    """Road map with its layers as tables of a schema."""
    QgsProject.instance().clear()
    place = QgsDataSourceUri()
    place.setConnection(host, PORT, "postgres", "lane", "")
    table = {name: f'postgres://{place.connectionInfo(False)} table="roads"."{name.lower()}" (geom)'
             for name in ("ROAD_EDGES", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "LANES")}
    window = processing.createAlgorithmDialog("lanewright:roadmap", {
        "POINT_CLOUDS": [str(folder / "survey.laz")], "TRAJECTORY": str(folder / "trajectory.csv"), **table})
    window.show()
    run(window, 300)
    window.close()
    layers = [layer for layer in QgsProject.instance().mapLayers().values() if layer.providerType() == "postgres"]
    say(f"in the database: {sorted((layer.name(), layer.featureCount()) for layer in layers)}")
    needed(len(layers) == len(table), "not all layers are in the database")
    show_map("Road edges")
    keep(iface.mainWindow(), "window_database")
