"""Lanewright: from a mobile laser scanning survey to a road map, inside QGIS.

Importing this package loads nothing, so the `core` works without QGIS; the
plugin itself begins in `classFactory`.
"""

import os
import sys


def add_library_folders():
    """Let Python find laspy, lazrs and shapely where users without system packages keep them.

    The folders go to the end of the search path: what QGIS brings (numpy, GDAL,
    pyproj) must win, or its compiled parts meet a numpy they were not built for.
    """
    here = os.path.dirname(os.path.abspath(__file__))
    folders = os.environ.get("LANEWRIGHT_LIBS", "").split(os.pathsep)
    folders.append(os.path.join(here, "_vendor"))
    folders += _qpip_folders(here)
    for folder in folders:
        if folder and os.path.isdir(folder) and folder not in sys.path:
            sys.path.append(folder)


def _qpip_folders(plugin_folder):
    """Where the QPIP plugin installs: `<profile>/python/dependencies`.

    QPIP itself is not loaded by qgis_process, so we look there ourselves.
    """
    # <profile>/python/plugins/lanewright -> <profile>/python/dependencies
    python_folder = os.path.dirname(os.path.dirname(plugin_folder))
    prefix = os.path.join(python_folder, "dependencies")
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    return [
        os.path.join(prefix, "Lib", "site-packages"),
        os.path.join(prefix, "lib", version, "site-packages"),
        os.path.join(prefix, "local", "lib", version, "dist-packages"),
        os.path.join(prefix, "lib", version, "dist-packages"),
    ]


def classFactory(iface):
    """Called by QGIS with its interface, which is None in qgis_process."""
    add_library_folders()
    from .plugin import LanewrightPlugin

    return LanewrightPlugin(iface)
