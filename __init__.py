"""Lanewright: from a mobile laser scanning survey to a road map, inside QGIS.

Importing this package loads nothing, so the `core` works without QGIS; the plugin itself begins in `classFactory`.
"""

import importlib
import os
import sys
import warnings


def add_library_folders(profile=""):
    """Let Python find laspy, lazrs and shapely where users without system packages keep them.

    The folders go to the end of the search path: what QGIS brings (numpy, GDAL, pyproj) must win, or its compiled parts meet a numpy they were not
    built for. `profile` is the folder of the QGIS profile, for a plugin that lies elsewhere.
    """
    here = os.path.dirname(os.path.abspath(__file__))
    folders = os.environ.get("LANEWRIGHT_LIBS", "").split(os.pathsep)
    folders.append(os.path.join(here, "_vendor"))
    # <profile>/python/plugins/lanewright -> <profile>/python/dependencies
    folders += _dependency_folders(os.path.dirname(os.path.dirname(here)))
    if profile:
        folders += _dependency_folders(os.path.join(profile, "python"))
    for folder in folders:
        if folder and os.path.isdir(folder) and folder not in sys.path:
            sys.path.append(folder)


def _dependency_folders(python_folder):
    """Where packages for plugins lie in a profile: in `<profile>/python/dependencies`, or below it as Python's own installation has them.

    The QPIP plugin installs there too, but is not loaded by qgis_process, so we look ourselves.
    """
    prefix = os.path.join(python_folder, "dependencies")
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    return [
        prefix,
        os.path.join(prefix, "Lib", "site-packages"),
        os.path.join(prefix, "lib", version, "site-packages"),
        os.path.join(prefix, "local", "lib", version, "dist-packages"),
        os.path.join(prefix, "lib", version, "dist-packages"),
    ]


def load_shapely():
    """Import shapely so that it calls the GEOS it came with.

    A shapely from PyPI carries its own GEOS. The programs qgis and qgis_process are linked to the system's, and on Linux the symbols of a program win
    over those of a library loaded later: shapely would call into another version of GEOS and crash, in prepared geometries for one. Bound deeply, a
    library looks among its own symbols first.
    """
    if "shapely" in sys.modules or not hasattr(os, "RTLD_DEEPBIND"):
        return
    flags = sys.getdlopenflags()
    sys.setdlopenflags(flags | os.RTLD_DEEPBIND)
    try:
        importlib.import_module("shapely")
    except ImportError:
        return  # every algorithm says so when it is started
    finally:
        sys.setdlopenflags(flags)


def classFactory(iface):
    """Called by QGIS with its interface, which is None in qgis_process."""
    from qgis.core import QgsApplication

    add_library_folders(QgsApplication.qgisSettingsDirPath())
    load_shapely()
    # QGIS shows every warning. Once and here, since filters are those of the whole process, which no thread may change
    # meanwhile: laspy is warned of what Python 3.19 will refuse, and CRSs are compared by their PROJ strings; nothing a user can act on
    warnings.filterwarnings("ignore", category=DeprecationWarning, module="laspy")
    warnings.filterwarnings("ignore", "You will likely lose important projection information", UserWarning)
    from .processing_provider.texts import chosen_language, speak

    speak(chosen_language())
    from .plugin import LanewrightPlugin

    return LanewrightPlugin(iface)
