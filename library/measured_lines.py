"""Lines with measures (M) in vector files: fiona leaves measures out, so GDAL's own Python module reads and writes these."""

import sqlite3
from contextlib import closing
from importlib.util import find_spec
from pathlib import Path

from ..algorithms.vector_source import crs_to_write, plain_value
from ..core.common.errors import RoadExtractionError
from ..core.io.local_files import gdal_exceptions, open_vector
from ..core.lazy import gdal, ogr, osr

DRIVERS = {".gpkg": "GPKG", ".shp": "ESRI Shapefile"}  # formats that keep measures


def check_gdal(why):
    """Raise RoadExtractionError, with what to install, where GDAL's Python module is missing; `why` it is needed begins the sentence."""
    if find_spec("osgeo") is None:
        raise RoadExtractionError(
            f"{why[0].upper()}{why[1:]}, which needs GDAL's Python module (osgeo), and it is not installed. Install lanewright[gdal] with pip, gdal "
            "from conda-forge, or python3-gdal on Debian and Ubuntu.")


def may_have_measures(path, table):
    """Whether a layer of lines has measures; where GDAL's Python module is missing, also True where nobody can tell."""
    if find_spec("osgeo") is not None:
        dataset = open_vector(path)
        layer = None if dataset is None else dataset.GetLayerByName(table)
        return layer is not None and bool(ogr.GT_HasM(layer.GetGeomType()))
    suffix = Path(path).suffix.lower()
    if suffix == ".gpkg":
        with closing(sqlite3.connect(f"{Path(path).absolute().as_uri()}?mode=ro", uri=True)) as database:
            row = database.execute("SELECT m FROM gpkg_geometry_columns WHERE table_name = ?", (table,)).fetchone()
        return bool(row and row[0])
    return suffix not in (".geojson", ".json")


def check_format(path, label):
    """Raise RoadExtractionError, before the work, where lines with measures cannot be written to a file."""
    check_gdal(f"{label} are lines with measures")
    if Path(path).suffix.lower() not in DRIVERS:
        raise RoadExtractionError(f"{label} was to be written to {path}, but they are lines with measures. Write a GeoPackage (.gpkg).")


def rows(path, table, names, label):
    """(feature id, ISO WKB or None, values) of every row, as VectorSource gives them."""
    check_gdal(f"{label} has lines with measures")

    dataset = open_vector(path)
    layer = dataset.GetLayerByName(table)
    for feature in layer:
        geometry = feature.GetGeometryRef()
        wkb = None if geometry is None or geometry.IsEmpty() else bytes(geometry.ExportToIsoWkb(ogr.wkbNDR))
        yield feature.GetFID(), wkb, [feature.GetField(name) for name in names]


def write(path, table, features, check_cancelled):
    """A layer of lines with Z and M into a new file, or as a table of a GeoPackage."""
    suffix = Path(path).suffix.lower()
    types = {int: ogr.OFTInteger64, float: ogr.OFTReal, str: ogr.OFTString}
    with gdal_exceptions():
        crs = None
        if wkt := crs_to_write(features, DRIVERS[suffix]):
            crs = osr.SpatialReference()
            crs.SetFromUserInput(wkt)
            crs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        dataset = gdal.OpenEx(path, gdal.OF_VECTOR | gdal.OF_UPDATE) if Path(path).exists() else \
            ogr.GetDriverByName(DRIVERS[suffix]).CreateDataSource(path)
        layer = dataset.CreateLayer(table or Path(path).stem, crs, ogr.wkbLineStringZM, ["OVERWRITE=YES"] if suffix == ".gpkg" else [])
        for field in features.schema:
            layer.CreateField(ogr.FieldDefn(field.name, types[field.type]))
        layer.StartTransaction()
        for number, (wkb, row) in enumerate(features):
            if number % 5000 == 0:
                check_cancelled()
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetGeometry(ogr.CreateGeometryFromWkb(wkb))
            for field in features.schema:
                value = plain_value(row.get(field.name))
                if value is not None:
                    feature.SetField(field.name, value)
            layer.CreateFeature(feature)
        layer.CommitTransaction()
        del layer, dataset
