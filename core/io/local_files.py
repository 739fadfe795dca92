"""Files read by GDAL and fiona without anything being fetched from a network, whatever a file says.

A file may be another than its name tells: a description (VRT, WMS) of data elsewhere, or a layer whose CRS is a web address. So only
formats that hold their data themselves are read, and while a file is read GDAL may not ask a server.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..common.errors import RoadExtractionError

# Formats that hold their pixels themselves; a VRT, which names other files, is read where its name says that it is one
RASTER_DRIVERS = ("GTiff", "JPEG", "PNG", "HFA", "JP2OpenJPEG", "JP2KAK", "JP2ECW", "JP2MrSID", "JPEG2000", "ECW", "MrSID", "HEIF", "AVIF",
                  "WEBP", "GIF", "BIGGIF", "BMP", "PNM", "JPEGXL", "GPKG", "MBTiles", "AAIGrid", "XYZ", "ENVI", "EHdr", "ILWIS", "PCIDSK", "RST",
                  "SAGA", "ERS", "RMF", "GSAG", "GSBG", "GS7BG", "netCDF", "MEM")
VECTOR_DRIVERS = ("GPKG", "FlatGeobuf", "ESRI Shapefile", "GeoJSON", "GeoJSONSeq", "TopoJSON", "CSV", "GML", "GPX", "LIBKML", "KML",
                  "MapInfo File", "SQLite", "OpenFileGDB", "DXF", "DGN", "CAD", "XLSX", "ODS", "Parquet", "Arrow", "Memory")
# Formats that name servers, or other files, which may be anything
DESCRIBING_DRIVERS = ("VRT", "OGR_VRT", "WMS", "WMTS", "WCS", "WFS", "OAPIF", "OGCAPI", "CSW", "GeoRSS", "STACTA", "STACIT", "EEDA", "EEDAI",
                      "DAAS", "NGW", "PLSCENES", "PLMOSAIC", "MRF", "ESRIC", "Elasticsearch", "Carto", "AmigoCloud", "MapML",
                      "GMLAS", "GTI", "HTTP")
# curl knows no such kind of proxy and asks nobody; nor is any address of the name that the network file systems are left
OFFLINE = {"GDAL_HTTP_PROXY": "none://", "GDAL_HTTPS_PROXY": "none://", "CPL_VSIL_CURL_ALLOWED_FILENAME": "none"}


@contextmanager
def offline() -> Iterator[None]:
    """A context in which GDAL asks no server in this thread; other threads, QGIS's among them, may."""
    from osgeo import gdal

    before = {name: gdal.GetThreadLocalConfigOption(name) for name in OFFLINE}
    try:
        for name, value in OFFLINE.items():
            gdal.SetThreadLocalConfigOption(name, value)
        yield
    finally:
        for name, value in before.items():
            gdal.SetThreadLocalConfigOption(name, value)


def open_raster(path: str | Path, give: str = "Give a TIFF, JPEG or PNG.") -> Any:
    """The gdal.Dataset of a raster file, within `gdal_exceptions`.

    Parameters
    ----------
    path : of the file
    give : what to try where it is none, a sentence

    Raises
    ------
    RoadExtractionError
        If it is none of the formats that hold their pixels themselves.
    """
    from osgeo import gdal

    drivers = RASTER_DRIVERS + ("VRT",) * (Path(path).suffix.lower() == ".vrt")
    try:
        return gdal.OpenEx(str(path), gdal.OF_RASTER | gdal.OF_VERBOSE_ERROR, allowed_drivers=list(drivers))
    except RuntimeError as problem:
        raise RoadExtractionError(f"{path} cannot be read as an image ({problem}). {give}") from problem


@contextmanager
def reading(path: str | Path) -> Iterator[None]:
    """A context in which GDAL's RuntimeError, as of a damaged file, becomes a RoadExtractionError that names the file."""
    try:
        yield
    except RuntimeError as problem:
        raise RoadExtractionError(f"{path} cannot be read to its end ({problem}). Copy it again, or export it as a GeoTIFF.") from problem


def check_local(path: str | Path) -> None:
    """Raise RoadExtractionError where a file that another program, such as QGIS, is to open describes data elsewhere."""
    from osgeo import gdal

    with offline():
        driver = gdal.IdentifyDriverEx(str(path), gdal.OF_VECTOR | gdal.OF_RASTER)
        name = "" if driver is None else driver.ShortName
        if name in DESCRIBING_DRIVERS and not (name == "VRT" and Path(path).suffix.lower() == ".vrt"):
            raise RoadExtractionError(f"{path} only says where data are ({name}), and nothing is fetched. Give the file that holds them.")
        if name == "GeoJSON":
            dataset = gdal.OpenEx(str(path), gdal.OF_VECTOR, allowed_drivers=[name], open_options=["NATIVE_DATA=YES"])
            for number in range(dataset.GetLayerCount() if dataset else 0):
                check_crs_of_geojson(path, dataset.GetLayer(number).GetMetadataItem("NATIVE_DATA", "NATIVE_DATA"))


def check_crs_of_geojson(path: str | Path, members: str | None) -> None:
    """Raise RoadExtractionError where the CRS of a GeoJSON, among the members that GDAL tells, is a web address: GDAL would take WGS 84."""
    crs = json.loads(members or "{}").get("crs")
    if isinstance(crs, dict) and crs.get("type") not in ("name", "EPSG"):
        raise RoadExtractionError(f"{path} names its CRS by an address, and nothing is fetched. Export the layer with a named CRS, as a GeoPackage.")


def open_vector(path: str | Path) -> Any:
    """The gdal.Dataset of a vector file; None, or within `gdal_exceptions` a RuntimeError, where it is none of `VECTOR_DRIVERS`."""
    from osgeo import gdal

    with offline():
        return gdal.OpenEx(str(path), gdal.OF_VECTOR, allowed_drivers=list(VECTOR_DRIVERS))
