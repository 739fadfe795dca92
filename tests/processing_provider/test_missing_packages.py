"""QGIS as users have it: whatever Python package is missing, the plugin loads, lists everything, and says what is missing."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from lanewright.algorithms.catalogue import ALGORITHMS

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
START = """
import importlib.abc, importlib.util, os, sys
root, folder, *cases = sys.argv[1:]
blocked = ",".join(cases).split(",")

class Blocked(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in blocked:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Blocked())
from qgis.core import QgsApplication
from qgis.gui import QgsLayerTreeView, QgsMessageBar
from qgis.PyQt.QtWidgets import QMainWindow, QPushButton

# to load QGIS's modules takes as long as all the rest of a start: each start is a copy of this process, which has loaded them
for case in cases:
    start = os.fork()
    if not start:
        break
    with open(f"{folder}/{case}.code", "w") as code:
        code.write(str(os.waitstatus_to_exitcode(os.waitpid(start, 0)[1])))
else:
    sys.exit()
for stream, name in ((1, "out"), (2, "err")):
    os.dup2(os.open(f"{folder}/{case}.{name}", os.O_WRONLY | os.O_CREAT), stream)
blocked = case.split(",")
app = QgsApplication([], True)
app.initQgis()
assert not set(blocked) & set(sys.modules)

class Window:
    main = QMainWindow()
    bar = QgsMessageBar(main)
    mainWindow = lambda self: self.main
    messageBar = lambda self: self.bar
    tree = QgsLayerTreeView(main)
    layerTreeView = lambda self: self.tree
    activeLayer = lambda self: None
    def __getattr__(self, name):
        return lambda *given: None

spec = importlib.util.spec_from_file_location("lanewright", root + "/__init__.py", submodule_search_locations=[root])
lanewright = sys.modules["lanewright"] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(lanewright)
window = Window()
plugin = lanewright.classFactory(window)
plugin.initGui()
print("algorithms", len(plugin.provider.algorithms()), len(plugin.menu.actions))
print("can", plugin.provider.algorithm("roadmap").canExecute()[1])
print("asked", ",".join(f"{algorithm.id()} {one.name()}" for algorithm in plugin.provider.algorithms() for one in algorithm.parameterDefinitions()
                        if one.type() in ("number", "enum") and one.defaultValue() is None and not one.checkValueIsAcceptable(None)))
item = window.bar.currentItem()
print("said", item.text() if item else "")
if item:
    next(button for button in item.findChildren(QPushButton) if button.text() == "Copy command").click()
    print("copied", QgsApplication.clipboard().text())
    plugin.menu.next_doubt(), plugin.menu.open_section(), plugin.menu.open_pairs(), plugin.menu.open_layout()
"""


CALLED = {"numpy,shapely": "numpy, shapely", "shapely": "shapely", "laspy,markupsafe": "laspy, markupsafe", "pyproj,jinja2": "pyproj, jinja2",
          "cv2,osgeo": "opencv-python-headless, gdal", "scipy,lazrs,shapely,pip": "scipy, lazrs, shapely"}


@pytest.fixture(scope="module")
def started_without(tmp_path_factory):
    """`started_without(package)` is what QGIS said when it was started without it."""
    folder, environment = tmp_path_factory.mktemp("starts"), {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    subprocess.run([sys.executable, "-c", START, str(ROOT), str(folder), *CALLED, "fiona"], env=environment, timeout=500, check=True)

    def said(package):
        code, out, err = ((folder / f"{package}.{name}").read_text() for name in ("code", "out", "err"))
        assert code == "0" and "Traceback" not in err, err
        return dict(line.split(" ", 1) for line in out.splitlines() if " " in line)
    return said


@pytest.mark.parametrize("package, called", CALLED.items())
def test_the_plugin_loads_and_says_what_is_missing(started_without, package, called):
    said = started_without(package)
    algorithms, actions = map(int, said["algorithms"].split())
    assert algorithms >= 34 and actions >= 10
    assert said["said"] == f"Missing Python package(s): {called}.", "one short sentence"
    assert f"Missing Python package(s): {called}." in said["can"] and said["copied"] in said["can"]
    assert "install" in said["copied"] and "terminal" not in said["copied"], "nothing but the command"
    assert not said["asked"], "numbers whose default nobody knows are not asked for: that would hide what is missing"
    assert ("python3-pip &&" in said["copied"]) == ("pip" in package.split(",")), "pip is installed before it is called"


def test_a_package_that_qgis_does_without_is_not_missed(started_without):
    said = started_without("fiona")
    models = len(list((ROOT / "resources" / "models").glob("*.model3")))
    assert said["algorithms"].startswith(f"{len(ALGORITHMS) + models} ") and said["can"].strip() == ""
