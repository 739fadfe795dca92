"""Which of the Python packages we need are missing, in one sentence for the user.

Nothing in this folder imports them when QGIS starts, so that the algorithms are
listed, and can say what they lack, on a machine that has none of them.
"""

from importlib import import_module
from importlib.util import find_spec

from .texts import tr

# What Python imports -> what it is called where one installs it
NEEDED = {"numpy": "numpy", "scipy": "scipy", "laspy": "laspy", "lazrs": "lazrs", "shapely": "shapely",
          "pyproj": "pyproj", "cv2": "opencv-python-headless"}


def missing_packages():
    """One sentence naming what is missing or too old, or "" when everything is there."""
    missing = [package for name, package in NEEDED.items() if find_spec(name) is None]
    if missing:
        return tr("Missing Python package(s): {names}. Install them for the Python of QGIS and start QGIS again.").format(
            names=", ".join(missing)
        )
    shapely = import_module("shapely")
    if int(shapely.__version__.split(".")[0]) < 2:
        return tr("shapely {version} is installed and version 2 or newer is needed.").format(version=shapely.__version__)
    return ""
