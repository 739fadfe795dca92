"""Results that appear whole or not at all.

A file is written beside its destination under a temporary name and renamed when
everything else went well, so a failed or cancelled run leaves yesterday's result.
"""

import os
import re
import tempfile
from pathlib import Path

from qgis.core import QgsProcessingParameterFileDestination, QgsProcessingParameterRasterDestination

from ..core.errors import RoadExtractionError
from .texts import tr

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


def check_suffix(path, definition):
    """Raise RoadExtractionError where the name promises a kind of file that is not written."""
    if isinstance(definition, QgsProcessingParameterRasterDestination):
        kinds = (".tif", ".tiff")
    elif isinstance(definition, QgsProcessingParameterFileDestination):
        kinds = (".html", ".htm") if "html" in definition.fileFilter() else (".laz", ".las")
    else:
        return
    name = path.name.lower()
    if not name.endswith(kinds) or name.endswith((".copc.laz", ".copc.las")):
        raise RoadExtractionError(
            tr("{label} was to be written to {path}, but it is written as {kinds} only. Name the file so.").format(
                label=definition.description(), path=path, kinds=tr(" or ").join(kinds[:2])
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

    def discard(self):
        """Remove everything that was begun and not committed."""
        self._remove(list(self._waiting))

    def _remove(self, pairs):
        for pair in pairs:
            for leftover in (pair[0], Path(f"{pair[0]}.aux.xml")):
                leftover.unlink(missing_ok=True)
            self._waiting.remove(pair)


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
