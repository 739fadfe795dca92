"""Files read by GDAL and fiona without anything being fetched from a network, whatever a file says.

A file may be another than its name tells: a description (VRT, WMS) of data elsewhere, or a layer whose CRS is a web address. So only
formats that hold their data themselves are read, and while a file is read GDAL may not ask a server.
"""

from __future__ import annotations

import json
import os
import shutil
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from glob import escape
from pathlib import Path
from typing import Any
from uuid import uuid4

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..lazy import gdal, ogr
from .weights import IO

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
    before = {name: gdal.GetThreadLocalConfigOption(name) for name in OFFLINE}
    try:
        for name, value in OFFLINE.items():
            gdal.SetThreadLocalConfigOption(name, value)
        yield
    finally:
        for name, value in before.items():
            gdal.SetThreadLocalConfigOption(name, value)


def open_raster(path: str | Path, give: str = "Give a TIFF, JPEG or PNG.") -> Any:
    """The gdal.Dataset of a raster file, within `gdal_exceptions`; RoadExtractionError if its format does not hold its pixels itself.

    give : what to try then, a sentence
    """
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
    with offline():
        return gdal.OpenEx(str(path), gdal.OF_VECTOR, allowed_drivers=list(VECTOR_DRIVERS))


def gdal_work(work: Callable[[Callable[..., int]], Any], progress: Progress) -> Any:
    """What `work` returns, which hands GDAL the callback that it is called with, so that GDAL reports to `progress`.

    GDAL passes no exception through its own code: what the report raises, as Cancelled, stops GDAL's work and is raised afterwards, without
    GDAL's own error, which would keep its datasets alive.
    """
    stopped: list[Exception] = []

    def report(share: float, *_: Any) -> int:
        try:
            progress.report(share)
        except Exception as reason:
            stopped.append(reason)
        return int(not stopped)

    result = None
    try:
        result = work(report)
    except RuntimeError:
        if not stopped:
            raise
    if stopped:
        raise stopped[0]
    return result


# GDAL's errors as Python exceptions, and no network, for Lanewright's own calls alone.

_lock = threading.Lock()
_active = 0       # blocks of all threads that run at present, before GDAL 3.7
_enabled: list[Any] = []    # GDAL's modules whose exceptions the first of them enabled


@contextmanager
def gdal_exceptions() -> Iterator[None]:
    """A context, or a decorator of a function, in which GDAL raises RuntimeError and asks no server; afterwards it is as it was before.

    Whether GDAL raises is a state of the whole process, which all plugins of QGIS share. Since GDAL 3.7 a thread may have a state of its own, and
    only that is changed; with older versions, the state is restored when the last thread leaves.
    """
    modules = (gdal, ogr)
    with ExitStack() as stack:
        stack.enter_context(offline())
        if hasattr(gdal, "ExceptionMgr"):
            for module in modules:
                stack.enter_context(module.ExceptionMgr(useExceptions=True))
            # otherwise GDAL raises an earlier error once more when the state is restored
            stack.callback(gdal.ErrorReset)
        else:
            stack.enter_context(_for_all_threads(modules))
        yield


@contextmanager
def _for_all_threads(modules):
    global _active
    with _lock:
        if not _active:
            _enabled[:] = [module for module in modules if not module.GetUseExceptions()]
            for module in _enabled:
                module.UseExceptions()
        _active += 1
    try:
        yield
    finally:
        with _lock:
            _active -= 1
            if not _active:
                # each module keeps the error handler that was there before it: the last is removed first
                with suppress(RuntimeError):  # another plugin enabled a further module meanwhile, which must stay so
                    for module in reversed(_enabled):
                        module.DontUseExceptions()
                _enabled.clear()


# Files that appear whole or not at all: until a file is finished it has a hidden name of its own beside its place.


def unfinished_path(path: str | os.PathLike[str], suffix: str) -> Path:
    """Where a file is written until it is finished, and then moved to its place by `finish_file`; or where a folder for its parts is made.

    The name is used once, so that of several runs that write the same file each ends well, and the last to end is kept. What killed
    runs left of the file is removed. suffix : of the unfinished file, such as ".tif"
    """
    target = Path(path)
    for left in target.parent.glob(f".{escape(target.name)}.*.unfinished*"):
        with suppress(OSError):   # another run was quicker, or it is held open
            if time.time() - max(file.stat().st_mtime for file in (left, *left.glob("*"))) > IO.abandoned_time:
                shutil.rmtree(left) if left.is_dir() else left.unlink()
    return target.with_name(f".{target.name}.{uuid4().hex}.unfinished{suffix}")


def finish_file(unfinished: str | os.PathLike[str], path: str | os.PathLike[str]) -> None:
    """Give an unfinished file its name, once all of it is on the disk: a power failure leaves the previous file or this one."""
    with open(unfinished, "r+b") as file:
        os.fsync(file.fileno())
    os.replace(unfinished, path)
