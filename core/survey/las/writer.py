"""Writing a LAS or LAZ file whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.crs import as_in_file, parse_crs
from ...io.local_files import unfinished_path
from ..store.records import COORDINATE_SCALE

MAX_LAS_INTEGER = 2**31 - 2    # largest coordinate, as an integer about the offset, in a LAS file


def scale_for(farthest: float) -> float:
    """The coordinate scale of a LAS file: 0.1 mm, or the least power of ten times it with which all points fit.

    Parameters
    ----------
    farthest : metres, the largest coordinate counted from the offset of the file

    Returns
    -------
    Metres per integer

    Raises
    ------
    RoadExtractionError
        If even 0.1 m is too fine.
    """
    for per_metre in (10_000, 1_000, 100, 10):
        if farthest * per_metre <= MAX_LAS_INTEGER:
            return COORDINATE_SCALE if per_metre == 10_000 else 1 / per_metre
    raise RoadExtractionError(f"The points lie up to {farthest / 1000:,.0f} km from the start of the survey, farther than a LAS file can hold. "
                              "Check the coordinates of the trajectory, or process the files of each region separately.")


def place_in_file(header: Any, origin: np.ndarray, crs: str, farthest: float) -> None:
    """Set the scales, offsets and CRS of a new file, in the units of the survey's own CRS.

    Parameters
    ----------
    header : laspy.LasHeader
    origin : (3,) metres, map coordinates of the local origin
    crs : WKT, metric, "" where unknown
    farthest : metres, the largest local coordinate
    """
    file_wkt, units = as_in_file(crs)
    header.scales = np.full(3, scale_for(farthest / min(units.across, units.up)))
    header.offsets = np.asarray(origin, float) if units.metric else units.in_file(origin)
    if file_wkt:
        header.add_crs(parse_crs(file_wkt))


def metres_of_file(header: Any, crs: str) -> list[float]:
    """Metres per integer of x, y and z in a new file of a survey."""
    units = as_in_file(crs)[1]
    return (header.scales if units.metric else units.in_metres(header.scales)).tolist()


@contextmanager
def new_laz(path: str | os.PathLike[str], header: Any) -> Iterator[Any]:
    """A laspy writer of a new file, which appears at its path only when all is written.

    Parameters
    ----------
    path : of the file; compressed unless it ends in .las
    header : laspy.LasHeader

    Raises
    ------
    RoadExtractionError
        If the file cannot be written.
    """
    import laspy

    suffix = ".las" if str(path).lower().endswith(".las") else ".laz"
    unfinished = unfinished_path(path, suffix)
    try:
        # A file that laspy opened itself would stay open when its last points cannot be written.
        with open(unfinished, "wb") as stream, laspy.open(
                stream, mode="w", header=header, do_compress=suffix == ".laz", closefd=False) as writer:
            yield writer
        os.replace(unfinished, path)
    except (OSError, RuntimeError) as problem:  # lazrs raises RuntimeErrors
        raise RoadExtractionError(f"{path} cannot be written ({problem}). Choose another folder or free some disk space.") from problem
    finally:
        unfinished.unlink(missing_ok=True)
