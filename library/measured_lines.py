"""Lines with measures (M) in vector files: fiona leaves measures out, so GDAL's own Python module reads and writes these."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

from ..algorithms.vector_source import plain_value
from ..core.common.errors import RoadExtractionError
from .gdal_module import check_gdal

DRIVERS = {".gpkg": "GPKG", ".shp": "ESRI Shapefile"}  # formats that keep measures


def available():
    return find_spec("osgeo") is not None


def has_measures(path, table):
    """Whether a layer has measures; False where GDAL's Python module is missing, and nobody can tell."""
    if not available():
        return False
    from osgeo import gdal, ogr

    dataset = gdal.OpenEx(path, gdal.OF_VECTOR)
    layer = None if dataset is None else dataset.GetLayerByName(table)
    return layer is not None and bool(ogr.GT_HasM(layer.GetGeomType()))


def rows(path, table, names, label):
    """(ISO WKB or None, values) of every row, as VectorSource gives them."""
    check_gdal(f"{label} has lines with measures")
    from osgeo import gdal, ogr

    dataset = gdal.OpenEx(path, gdal.OF_VECTOR)
    layer = dataset.GetLayerByName(table)
    for feature in layer:
        geometry = feature.GetGeometryRef()
        wkb = None if geometry is None or geometry.IsEmpty() else bytes(geometry.ExportToIsoWkb(ogr.wkbNDR))
        yield wkb, [feature.GetField(name) for name in names]


def write(path, table, features, check_cancelled):
    """A layer of lines with Z and M into a new file, or as a table of a GeoPackage."""
    check_gdal("lines with measures are written")
    from osgeo import gdal, ogr, osr

    from ..core.io.gdal_errors import gdal_exceptions

    suffix = Path(path).suffix.lower()
    if suffix not in DRIVERS:
        raise RoadExtractionError(f"{Path(path).name} cannot hold lines with measures. Write a GeoPackage (.gpkg).")
    types = {int: ogr.OFTInteger64, float: ogr.OFTReal, str: ogr.OFTString}
    with gdal_exceptions():
        crs = None
        if features.crs:
            crs = osr.SpatialReference()
            crs.SetFromUserInput(features.crs)
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
