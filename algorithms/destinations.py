"""Results that appear whole or not at all.

A file is written beside its destination under a temporary name and renamed when
everything else went well, so a failed or cancelled run leaves the previous file.
"""

import os
import re
import tempfile
from pathlib import Path

from ..core.common.errors import RoadExtractionError
from .parameters import FileOutput, LayerOutput, RasterOutput, ReportOutput
from .texts import tr

SHAPEFILE = (".shp", ".shx", ".dbf", ".prj", ".cpg", ".qix", ".sbn", ".sbx")
DATABASE = re.compile(r"dbname='(?P<path>[^']+)'")


def destination_path(value):
    """The file a destination value names, or None where it is no file (memory layers, databases)."""
    text = value or ""
    database = DATABASE.search(text)
    if database:
        text = database["path"] if text.startswith("ogr:") else ""
    text = text.split("|")[0]
    if not text or text == "TEMPORARY_OUTPUT" or text.startswith(("memory:", "postgres:", "ogr:", "mssql:", "oracle:")):
        return None
    return Path(text)


def check_suffix(path, spec, vector_suffixes):
    """Raise RoadExtractionError where the name promises a kind of file that is not written.

    Parameters
    ----------
    path : Path
    spec : OutputSpec
    vector_suffixes : the endings, without dot, of the vector formats that the program writes
    """
    if isinstance(spec, LayerOutput):
        _check_vector_suffix(path, spec.label, vector_suffixes)
        return
    kinds = (".tif", ".tiff") if isinstance(spec, RasterOutput) else (".html", ".htm") if isinstance(spec, ReportOutput) else \
        spec.suffixes if isinstance(spec, FileOutput) else (".laz", ".las")
    name = path.name.lower()
    if not name.endswith(kinds) or name.endswith((".copc.laz", ".copc.las")):
        raise RoadExtractionError(
            tr("{label} was to be written to {path}, but it is written as {kinds} only. Name the file so.").format(
                label=spec.label, path=path, kinds=tr(" or ").join(kinds)
            )
        )


def _check_vector_suffix(path, label, suffixes):
    """Layers need a format that is written and that has fields."""
    suffix = path.suffix.lower().lstrip(".")
    if suffix == "dxf":
        raise RoadExtractionError(
            tr("{label} was to be written to {path}, but a DXF has no fields. Write a GeoPackage and bring it to DXF with the "
               "QGIS algorithm “Export layers to DXF”.").format(label=label, path=path)
        )
    if suffix not in suffixes:
        raise RoadExtractionError(
            tr("{label} was to be written to {path}, whose ending names no format that QGIS writes. Use .gpkg, .fgb or .shp.").format(
                label=label, path=path
            )
        )


def check_writable(path, label):
    """Raise RoadExtractionError, before any work, where `path` cannot be written."""
    folder = path.absolute().parent
    if not folder.is_dir():
        raise RoadExtractionError(
            tr("{label} was to be written to {path}, but there is no folder {folder}. Create it or choose another.").format(
                label=label, path=path, folder=folder
            )
        )
    if path.is_dir():
        raise RoadExtractionError(
            tr("{label} was to be written to {path}, which is a folder. Name a file in it.").format(label=label, path=path)
        )
    try:
        # Asking is not enough: a read-only disk and a share say yes and then refuse
        with tempfile.TemporaryFile(dir=folder):
            pass
        if path.exists():
            with open(path, "r+b"):
                pass
    except OSError as error:
        raise RoadExtractionError(
            tr("{label} cannot be written to {path}: {reason}. Choose another place, or close the program that holds it.").format(
                label=label, path=path, reason=error.strerror
            )
        ) from error


class UnfinishedFiles:
    """Files being written under a temporary name."""

    def __init__(self):
        self._waiting = []

    def begin(self, destination):
        """The temporary path to write to; its suffix is the destination's, for drivers that go by it."""
        destination = Path(destination).absolute()
        # .copc.laz and .tif alike keep what follows the first dot of the name
        suffix = "".join(destination.suffixes[-2:]) if destination.name.endswith(".copc.laz") else destination.suffix
        handle, name = tempfile.mkstemp(prefix=f".{destination.stem}-", suffix=suffix, dir=destination.parent)
        os.close(handle)
        # mkstemp makes it private; a result should be as readable as any new file
        os.chmod(name, 0o666 & ~_umask())
        self._waiting.append((Path(name), destination))
        return name

    def unfinished(self):
        """The temporary paths that were begun."""
        return [temporary for temporary, _ in self._waiting]

    def commit(self):
        """Give every file its name."""
        for temporary, destination in self._waiting:
            os.replace(temporary, destination)
            sidecar = Path(f"{temporary}.aux.xml")
            if sidecar.exists():
                os.replace(sidecar, f"{destination}.aux.xml")
        self._waiting = []

    def forget(self, destination):
        """Remove what was begun for one destination."""
        destination = Path(destination).absolute()
        self._remove([pair for pair in self._waiting if pair[1] == destination])

    def in_users_names(self, text):
        """A text with every temporary path replaced by its destination."""
        for temporary, destination in self._waiting:
            text = text.replace(str(temporary), str(destination))
        return text

    def discard(self):
        """Remove everything that was begun and not committed."""
        self._remove(list(self._waiting))

    def _remove(self, pairs):
        for pair in pairs:
            for leftover in (pair[0], Path(f"{pair[0]}.aux.xml")):
                leftover.unlink(missing_ok=True)
            self._waiting.remove(pair)


class ReplacedFiles:
    """The previous layers, set aside while new ones are written in their place."""

    def __init__(self):
        self._aside, self._new = [], []

    def set_aside(self, value):
        """Make room for the layer file that a destination value names."""
        path = destination_path(value)
        if path is None:
            return
        if value.startswith("ogr:"):
            # One layer of a database: the others stay where they are
            self._new += [] if path.exists() else [path]
            return
        for file in files_of(path):
            aside = file.with_name(f".{file.name}.previous")
            try:
                os.replace(file, aside)
            except OSError:  # held by a program: it can be replaced only by its own driver
                return
            self._aside.append((aside, file))
        self._new.append(path)

    def forget(self):
        """The new layers are whole: drop the previous ones."""
        for aside, _ in self._aside:
            aside.unlink(missing_ok=True)

    def put_back(self):
        """Writing failed: remove what there is of the new layers and restore the previous ones."""
        for path in self._new:
            for file in files_of(path):
                file.unlink(missing_ok=True)
        for aside, file in self._aside:
            os.replace(aside, file)


def files_of(path):
    """The files there are of a layer: those of one stem for a shapefile, a database's journals for a GeoPackage."""
    beside = [path.with_suffix(suffix) for suffix in SHAPEFILE] if path.suffix.lower() == ".shp" else \
        [path.with_name(path.name + suffix) for suffix in ("", "-wal", "-shm", "-journal")]
    return [file for file in beside if file.is_file()]


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
