"""Whether GDAL's Python module, which reads and writes the rasters, is installed."""

from importlib.util import find_spec

from ..core.common.errors import RoadExtractionError


def check_gdal(why):
    """Raise RoadExtractionError, with what to install, where GDAL's Python module is missing; `why` it is needed begins the sentence."""
    if find_spec("osgeo") is None:
        raise RoadExtractionError(
            f"{why[0].upper()}{why[1:]}, which needs GDAL's Python module (osgeo), and it is not installed. Install lanewright[gdal] with pip, which "
            "needs GDAL's own library and headers before Python 3.12, or gdal (conda-forge), or python3-gdal (Debian, Ubuntu).")
