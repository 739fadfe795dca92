"""The point clouds that files, folders and wildcards name."""

from __future__ import annotations

import os
from collections.abc import Iterable
from glob import glob, has_magic
from pathlib import Path

from ..core.common.errors import RoadExtractionError
from .texts import tr

SUFFIXES = (".las", ".laz")
COPC = ".copc.laz"


def cloud_files(given: Iterable[str], label: str) -> list[str]:
    """The files of a survey.

    Parameters
    ----------
    given : files, folders (their LAS and LAZ files, without those of folders inside) and names with the wildcards * ? [ ]
    label : what messages call the parameter

    Returns list of paths, each once, those of a folder or wildcard by name. A file that is named is not looked for. Of a folder or wildcard,
    `a.copc.laz` is left out where `a.laz` or `a.las` is among it: QGIS makes such a copy of a cloud that it shows, and no point shall count twice.

    Raises RoadExtractionError if a folder or wildcard holds no point cloud.
    """
    files: list[str] = []
    for name in filter(None, given):
        path = Path(name)
        if path.is_file():
            files.append(name)
        elif path.is_dir():
            files += _clouds(path.iterdir(), tr("{label}: the folder {name} holds no LAS or LAZ file.").format(label=label, name=name))
        elif has_magic(name):
            files += _clouds(map(Path, glob(name)), tr("{label}: no LAS or LAZ file is called {name}.").format(label=label, name=name))
        else:
            files.append(name)
    return list(dict.fromkeys(files))


def survey_name(clouds: list[str]) -> str:
    """What a survey is called: the folder of its point clouds and what their names have in common, such as B12/tile."""
    stems = [Path(path).stem.removesuffix(".copc") for path in clouds]
    folders = {Path(path).absolute().parent for path in clouds}
    folder = folders.pop().name if len(folders) == 1 else ""
    name = os.path.commonprefix(stems).rstrip("_-. 0123456789") if len(set(stems)) > 1 else "".join(stems[:1])
    return "/".join(part for part in dict.fromkeys((folder, name)) if part)


def _clouds(paths, none_found):
    """Point clouds among paths, by name; raises RoadExtractionError with `none_found` where there is none."""
    clouds = {str(path) for path in paths if path.suffix.lower() in SUFFIXES and path.is_file()}
    copies = {name for name in clouds if name.lower().endswith(COPC)
              and any(name[:-len(COPC)] + suffix in clouds for suffix in SUFFIXES)}
    if not clouds:
        raise RoadExtractionError(none_found)
    return sorted(clouds - copies)
