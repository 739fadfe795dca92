"""Libraries from PyPI inside the real programs of QGIS, which bring other versions of what those carry."""

import os
import subprocess
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
PROBE = """
import importlib.util, os, sys

def classFactory(iface):
    spec = importlib.util.spec_from_file_location("lanewright_face", os.environ["FACE"])
    face = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(face)
    face.add_library_folders()
    face.load_shapely()
    return Probe()

class Probe:
    def initProcessing(self):
        import numpy as np
        import shapely
        hatching = shapely.MultiPolygon([shapely.box(3 * k, 0, 3 * k + 2, 10 + 0.1 * k) for k in range(20)])
        shapely.prepare(hatching)
        x, y = np.meshgrid(np.linspace(-1, 61, 400), np.linspace(-1, 13, 100))
        inside = shapely.contains_xy(hatching, x.ravel(), y.ravel())
        exact = np.zeros(inside.shape, bool)
        for box in hatching.geoms:
            a, b, c, d = box.bounds
            exact |= (x.ravel() > a) & (x.ravel() < c) & (y.ravel() > b) & (y.ravel() < d)
        with open(os.environ["ANSWER"], "w") as stream:
            stream.write(f"{(inside == exact).all()} {shapely.geos_version_string}")

    def initGui(self):
        pass

    def unload(self):
        pass
"""


def test_shapely_calls_its_own_geos_inside_qgis_process(tmp_path):
    plugin = tmp_path / "plugins" / "probe"
    plugin.mkdir(parents=True)
    (plugin / "__init__.py").write_text(PROBE)
    (plugin / "metadata.txt").write_text(
        "[general]\nname=Probe\nqgisMinimumVersion=3.40\ndescription=x\nversion=1\nauthor=x\nemail=x@example.org\nhasProcessingProvider=yes\n"
    )
    libraries = next((ROOT / "build" / "venv" / "lib").glob("python3*/site-packages"))
    environment = {
        **os.environ, "QGIS_PLUGINPATH": str(tmp_path / "plugins"), "QGIS_CUSTOM_CONFIG_PATH": str(tmp_path / "profile"),
        "QT_QPA_PLATFORM": "offscreen", "LANEWRIGHT_LIBS": str(libraries), "FACE": str(ROOT / "__init__.py"),
        "ANSWER": str(tmp_path / "answer.txt"),
    }
    enabled = tmp_path / "profile" / "profiles" / "default" / "QGIS" / "QGIS3.ini"
    enabled.parent.mkdir(parents=True)
    enabled.write_text("[PythonPlugins]\nprobe=true\n")
    run = subprocess.run(["qgis_process", "list"], env=environment, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert run.returncode == 0, run.stderr
    right, version = (tmp_path / "answer.txt").read_text().split()
    assert right == "True" and version
