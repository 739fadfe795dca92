"""Which of the Python packages we need are missing, and how to install them on this system.

Nothing in this folder imports them when QGIS starts, so that the algorithms are listed, and can say what they lack, on a machine that has none of
them. Nothing is ever installed from here: the user is told the command.
"""

import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

from qgis.core import QgsApplication

from .texts import tr

# What Python imports -> what it is called where one installs it
NEEDED = {"numpy": "numpy", "scipy": "scipy", "laspy": "laspy", "lazrs": "lazrs", "shapely": "shapely",
          "pyproj": "pyproj", "cv2": "opencv-python-headless", "jinja2": "jinja2", "markupsafe": "markupsafe", "osgeo": "gdal"}
# Debian's and Ubuntu's own, built for the numpy and PROJ that their QGIS uses
DEBIAN = {"numpy": "python3-numpy", "scipy": "python3-scipy", "pyproj": "python3-pyproj", "cv2": "python3-opencv",
          "jinja2": "python3-jinja2", "markupsafe": "python3-markupsafe", "osgeo": "python3-gdal"}
OLDEST_SHAPELY = 2
LIMITS = {"shapely": '"shapely>=2"', "cv2": '"opencv-python-headless<4.12"'}   # how pip is asked for these


def missing_packages():
    """One sentence naming what is missing or too old, and the way on; "" when everything is there."""
    missing = missing_in_short()
    return missing and tr("{missing} To install: {command}{where}. Then start QGIS again.",
        missing=missing, command=install_command(), where=_where())


def missing_in_short():
    """What is missing or too old, in a few words; "" when everything is there."""
    names = _missing()
    if names:
        return tr("Missing Python package(s): {names}.", names=", ".join(NEEDED[name] for name in names))
    version = _shapely_version()
    if int(version.split(".")[0]) < OLDEST_SHAPELY:
        return tr("shapely {version} is installed and version 2 or newer is needed.", version=version)
    return ""


def how_to_install():
    """What is missing and the commands, for this system and this QGIS, as a text to copy from."""
    return "\n\n".join((missing_packages(), tr(
        "The packages go into a folder of your QGIS profile that only Lanewright looks into, after everything QGIS brings. "
        "The QPIP plugin can install them as well: it reads the requirements.txt of Lanewright."
    ), install_command() + _where()))


def _missing():
    return [name for name in NEEDED if not _is_there(name)]


def _is_there(name):
    """Whether Python finds a package; one that is hidden from it makes it raise."""
    try:
        return find_spec(name) is not None
    except (ImportError, ValueError):
        return False


def _shapely_version():
    """The version of shapely; "0" of one that is there and cannot be loaded."""
    try:
        return import_module("shapely").__version__
    except (ImportError, AttributeError, OSError):
        return "0"


def install_command():
    """The command that installs what is missing for the Python of this QGIS, pip included."""
    names = _missing() or ["shapely"]
    debian = Path("/etc/debian_version").exists()
    system = [DEBIAN[name] for name in names if debian and name in DEBIAN]
    by_pip = [name for name in names if not debian or name not in DEBIAN]
    commands = []
    if by_pip and not _is_there("pip"):
        if debian:
            system.append("python3-pip")
        else:
            commands.append(f"{_python()} -m ensurepip --user")
    if system:
        commands.append(f"sudo apt install {' '.join(system)}")
    if by_pip:
        packages = " ".join(LIMITS.get(name, NEEDED[name]) for name in by_pip)
        commands.append(f'{_python()} -m pip install --no-deps --target "{library_folder()}" {packages}')
    return " && ".join(commands)


def _where():
    return tr(" (in the OSGeo4W Shell)") if sys.platform == "win32" else tr(" (in a terminal)")


def _python():
    """The interpreter of this QGIS as one calls it in a terminal: inside QGIS on Windows sys.executable is QGIS."""
    if sys.platform == "win32":
        return "python"
    name = f"python{sys.version_info.major}.{sys.version_info.minor}"
    return str(Path(sys.prefix) / "bin" / name) if sys.platform == "darwin" else "/usr/bin/python3"


def library_folder():
    """Where packages for Lanewright alone belong: in the profile, beside the plugins, so that updates keep them."""
    python = f"python{sys.version_info.major}.{sys.version_info.minor}"
    packages = ("Lib",) if sys.platform == "win32" else ("lib", python)
    return Path(QgsApplication.qgisSettingsDirPath(), "python", "dependencies", *packages, "site-packages")
