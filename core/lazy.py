"""Libraries that are imported when they are first used: QGIS need not wait for them at its start, and some may be missing."""

from __future__ import annotations

from importlib import import_module
from typing import Any


class LazyModule:
    """A module that is imported when one of its names is first used.

    QGIS asks every algorithm for its parameters when it starts, and their defaults stand in the files of the
    stages; what those files compute with is needed only when a stage runs.

    name : of the module; ImportError at the first use where it is not installed
    """

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, attribute: str) -> Any:
        # asked once for each name: what is known of an object is no longer asked here
        value = self.__dict__[attribute] = getattr(import_module(self._name), attribute)
        return value


cv2: Any = LazyModule("cv2")
fiona: Any = LazyModule("fiona")
gdal: Any = LazyModule("osgeo.gdal")
laspy: Any = LazyModule("laspy")
lazrs: Any = LazyModule("lazrs")
np: Any = LazyModule("numpy")   # for what is loaded without it, to say what is missing; the work imports it
ogr: Any = LazyModule("osgeo.ogr")
osr: Any = LazyModule("osgeo.osr")
pyproj: Any = LazyModule("pyproj")
shapely: Any = LazyModule("shapely")
