"""Tables of one GeoPackage put into another that stays where it is, since programs have it open."""

from ..core.common.errors import RoadExtractionError
from ..core.io.local_files import gdal_exceptions
from .texts import tr


def add_tables(written, path):
    """Put all tables of a database into another, in one transaction: whatever ends the program leaves those of before or these.

    Tables of the same names are replaced. Programs that have the database open, this QGIS too, read the new tables from then on.

    Parameters
    ----------
    written, path : Path

    Raises RoadExtractionError if another program keeps the database locked, or there is no room; then the tables of before stand.
    """
    from osgeo import gdal

    try:
        with gdal_exceptions():
            target = gdal.OpenEx(str(path), gdal.OF_VECTOR | gdal.OF_UPDATE)
            # one transaction from the first table to the last, and none in between
            gdal.VectorTranslate(target, str(written), accessMode="overwrite", options=["-preserve_fid", "-gt", "unlimited"])
            target = None
    except RuntimeError as problem:
        raise RoadExtractionError(
            tr("The result could not be written: {reason}. Is the disk full or the file open elsewhere?").format(reason=problem)) from problem
