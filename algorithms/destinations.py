"""Results that appear whole or not at all.

A file is written in a hidden folder beside its destination and moved when everything
else went well, so a failed or cancelled run leaves the previous file.
"""

import os
import re
import shutil
import sqlite3
import tempfile
from contextlib import closing, contextmanager
from pathlib import Path

from ..core.common.errors import RoadExtractionError
from ..core.io.local_files import finish_file, unfinished_path
from .texts import tr

SUFFIXES = {"cloud": (".laz", ".las"), "raster": (".tif", ".tiff"), "report": (".html", ".htm")}
SHAPEFILE = (".shp", ".shx", ".dbf", ".prj", ".cpg", ".qix", ".sbn", ".sbx")
# QGIS puts a stroke before an apostrophe in the path; people leave it out
DATABASE = re.compile(r"dbname='(?P<path>.+?)(?<!\\)'(?=\s|$)(?: *table=\"(?P<table>[^\"]+)\")?")


def package_and_table(value):
    """(path, table or "") of `ogr:dbname='map.gpkg' table="lanes" (geom)`, QGIS's way to name a layer of a GeoPackage; None of other values."""
    database = DATABASE.search(value) if value.startswith("ogr:") else None
    return None if database is None else (re.sub(r"\\([\\'])", r"\1", database["path"]), database["table"] or "")


def table_of(path, table):
    """The destination that names a table of a GeoPackage."""
    return f"ogr:dbname='{_quoted(path)}' table=\"{table}\" (geom)"


def _quoted(path):
    return str(path).replace("\\", "\\\\").replace("'", "\\'")


def destination_path(value):
    """The file a destination value names, or None where it is no file (memory layers, databases)."""
    package = package_and_table(value or "")
    text = package[0] if package else (value or "").split("|")[0]
    if not text or text == "TEMPORARY_OUTPUT" or text.startswith(("memory:", "postgres:", "ogr:", "mssql:", "oracle:")):
        return None
    return Path(text)


def at_path(value, path):
    """(destination value with another file, the file that it named as text)."""
    package = package_and_table(value)
    if package is None:
        file = value.split("|")[0]
        return f"{path}{value[len(file):]}", file
    start, end = DATABASE.search(value).span("path")
    return f"{value[:start]}{_quoted(path)}{value[end:]}", package[0]


def check_suffix(path, spec, vector_suffixes):
    """Raise RoadExtractionError where the name promises a kind of file that is not written; suffixes of vector formats have no dot."""
    name, suffix, kinds = path.name.lower(), path.suffix.lower().lstrip("."), spec.suffixes or SUFFIXES.get(spec.kind, ())
    if spec.kind == "layer" and suffix == "dxf":
        raise RoadExtractionError(tr("{label} was to be written to {path}, but a DXF has no fields. Write a GeoPackage and bring it to DXF with the "
                                     "QGIS algorithm “Export layers to DXF”.", label=spec.label, path=path))
    if spec.kind == "layer" and suffix not in vector_suffixes:
        raise RoadExtractionError(tr("{label} was to be written to {path}, whose ending names no format that QGIS writes. Use .gpkg, .fgb or .shp.",
                                     label=spec.label, path=path))
    if spec.kind != "layer" and (not name.endswith(kinds) or name.endswith((".copc.laz", ".copc.las"))):
        raise RoadExtractionError(tr("{label} was to be written to {path}, but it is written as {kinds} only. Name the file so.", label=spec.label,
                                     path=path, kinds=tr(" or ").join(kinds)))


def check_writable(path, label):
    """Raise RoadExtractionError, before any work, where `path` cannot be written."""
    folder = path.absolute().parent
    if not folder.is_dir():
        raise RoadExtractionError(tr("{label} was to be written to {path}, but there is no folder {folder}. Create it or choose another.",
                                     label=label, path=path, folder=folder))
    if path.is_dir():
        raise RoadExtractionError(tr("{label} was to be written to {path}, which is a folder. Name a file in it.", label=label, path=path))
    try:
        # Asking is not enough: a read-only disk and a share say yes and then refuse
        with tempfile.TemporaryFile(dir=folder):
            pass
        if path.exists():
            with open(path, "r+b"):
                pass
    except OSError as error:
        raise RoadExtractionError(tr("{label} cannot be written to {path}: {reason}. Choose another place, or close the program that holds it.",
                                     label=label, path=path, reason=error.strerror)) from error


def check_folder(path, label):
    """Raise RoadExtractionError, before any work, where files cannot be written into a folder, which need not be there."""
    if path.exists() and not path.is_dir():
        raise RoadExtractionError(tr("{label} was to be written to {path}, which is a file. Name a folder.", label=label, path=path))
    check_writable(path / ".new" if path.is_dir() else path, label)


class Unfinished:
    """Results being written: each under its own name, which names its layer and its parts, in a hidden folder beside its place."""

    def __init__(self):
        self._folders = {}  # destination -> hidden folder

    def begin(self, destination):
        """The path to write the file of a destination to; of several tables of one file the same."""
        destination = Path(destination).absolute()
        if destination not in self._folders:
            self._folders[destination] = unfinished_path(destination, "")
            self._folders[destination].mkdir()
        return self._folders[destination] / destination.name

    def begun(self):
        return [folder / destination.name for destination, folder in self._folders.items()]

    def forget(self, destination):
        shutil.rmtree(self._folders.pop(Path(destination).absolute()), ignore_errors=True)

    def begin_copy(self, destination):
        """The same with the tables that there are, for a program that adds one to them."""
        unfinished = self.begin(destination)
        if Path(destination).exists() and not unfinished.exists():
            with _opened(destination) as database, closing(sqlite3.connect(unfinished)) as copy:
                database.backup(copy)  # what a journal beside it holds too
        return unfinished

    def commit(self, added_to=(), add=None):
        """Give every file its name; `add(unfinished, destination)` puts the tables into those of `added_to`, and into one that cannot be replaced."""
        for destination, folder in self._folders.items():
            if add is not None and destination.exists() and (destination in added_to or _is_held(destination)):
                add(folder / destination.name, destination)
            else:
                _give_place(folder, destination)
        self.discard()

    def in_users_names(self, text):
        """A text with every temporary path replaced by its destination."""
        for destination, folder in self._folders.items():
            text = text.replace(str(folder), str(destination.parent))
        return text

    def discard(self):
        for folder in self._folders.values():
            shutil.rmtree(folder, ignore_errors=True)
        self._folders = {}


def _give_place(folder, destination):
    """Move the parts of a result to their place.

    A file of its own replaces the previous one in one step. The parts of a Shapefile cannot: its .shp is taken away first and
    comes last, so that there is no moment at which parts of two layers would be read as one.
    """
    statistics = folder / f"{destination.name}.aux.xml"   # GDAL's, of an image
    parts = sorted({*folder.iterdir()} - {statistics}, key=lambda part: part.name == destination.name)
    # the files there are of it: those of one stem for a shapefile, a database's journals for a GeoPackage
    names = [destination.with_suffix(suffix) for suffix in SHAPEFILE] if destination.suffix.lower() == ".shp" else \
        [destination.with_name(destination.name + suffix) for suffix in ("", "-wal", "-shm", "-journal")]
    previous = [file for file in names if file.is_file()]
    if destination in previous and len(previous) > 1 and destination.suffix.lower() != ".shp":
        with _opened(destination) as database:   # what its journal holds goes into it: one that outlives its database is played into the next
            database.execute("SELECT count(*) FROM sqlite_master").fetchone()
            database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    if len(parts) > 1:
        destination.unlink(missing_ok=True)
    for part in parts + [statistics] * statistics.exists():
        finish_file(part, destination.parent / part.name)
    # the index or journal of a file that is gone
    for file in set(previous) - {destination.parent / part.name for part in parts}:
        file.unlink(missing_ok=True)


def _is_held(path):
    """Whether a program has a database open and the system, which is Windows, lets nobody replace it meanwhile."""
    try:
        os.rename(path, path)
    except PermissionError:
        return path.suffix.lower() == ".gpkg"
    return False


@contextmanager
def _opened(path):
    """A database as sqlite3 has it; raises RoadExtractionError where it cannot be worked with."""
    try:
        with closing(sqlite3.connect(path)) as database:
            yield database
    except sqlite3.Error as problem:
        raise RoadExtractionError(tr("{path} cannot be written: {reason}. Close the program that holds it, or choose another file.", path=path,
                                     reason=problem)) from problem
