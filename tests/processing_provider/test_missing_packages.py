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
import importlib.abc, sys
blocked = sys.argv[1].split(",")

class Blocked(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in blocked:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Blocked())
import importlib.util
from qgis.core import QgsApplication
from qgis.gui import QgsLayerTreeView, QgsMessageBar
from qgis.PyQt.QtWidgets import QMainWindow, QPushButton
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

spec = importlib.util.spec_from_file_location("lanewright", sys.argv[2] + "/__init__.py", submodule_search_locations=[sys.argv[2]])
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


def started_without(package):
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    done = subprocess.run([sys.executable, "-c", START, package, str(ROOT)], capture_output=True, text=True, env=environment, timeout=300)
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr, done.stderr
    return dict(line.split(" ", 1) for line in done.stdout.splitlines() if " " in line)


@pytest.mark.parametrize("package, called", [
    ("numpy,shapely", "numpy, shapely"), ("shapely", "shapely"), ("laspy,markupsafe", "laspy, markupsafe"),
    ("pyproj,jinja2", "pyproj, jinja2"), ("cv2,osgeo", "opencv-python-headless, gdal"), ("scipy,lazrs,shapely,pip", "scipy, lazrs, shapely")])
def test_the_plugin_loads_and_says_what_is_missing(package, called):
    said = started_without(package)
    algorithms, actions = map(int, said["algorithms"].split())
    assert algorithms >= 34 and actions >= 10
    assert said["said"] == f"Missing Python package(s): {called}.", "one short sentence"
    assert f"Missing Python package(s): {called}." in said["can"] and said["copied"] in said["can"]
    assert "install" in said["copied"] and "terminal" not in said["copied"], "nothing but the command"
    assert not said["asked"], "numbers whose default nobody knows are not asked for: that would hide what is missing"
    assert ("python3-pip &&" in said["copied"]) == ("pip" in package.split(",")), "pip is installed before it is called"


def test_a_package_that_qgis_does_without_is_not_missed():
    said = started_without("fiona")
    models = len(list((ROOT / "resources" / "models").glob("*.model3")))
    assert said["algorithms"].startswith(f"{len(ALGORITHMS) + models} ") and said["can"].strip() == ""
