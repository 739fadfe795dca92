"""A LAS or LAZ file that appears whole or not at all."""

import os
from contextlib import contextmanager
from pathlib import Path

from ...common.errors import RoadExtractionError
from ..store.records import COORDINATE_SCALE

REACH = 2**31 - 2    # whole numbers either side of the offset that a LAS file can hold


def scale_for(farthest):
    """Metres that one whole number of a LAS file stands for: 0.1 mm, or the least power of ten times it in which `farthest` metres fit."""
    for finer in (10_000, 1_000, 100, 10):
        if farthest * finer <= REACH:
            return COORDINATE_SCALE if finer == 10_000 else 1 / finer
    raise RoadExtractionError(f"The points lie up to {farthest / 1000:,.0f} km from the start of the survey, farther than a LAS file can hold. "
                              "Check the coordinates of the trajectory, or process the files of each region by themselves.")


@contextmanager
def new_laz(path, header):
    """laspy's writer of a new file, compressed unless `path` ends in .las; the file is there when all is written.

    Raises
    ------
    RoadExtractionError
        Where it cannot be written.
    """
    import laspy

    suffix = ".las" if str(path).lower().endswith(".las") else ".laz"
    unfinished = Path(f"{path}.unfinished{suffix}")
    try:
        # of a file that it opened itself laspy lets go only when the last points went onto the disk
        with open(unfinished, "wb") as stream, laspy.open(
                stream, mode="w", header=header, do_compress=suffix == ".laz", closefd=False) as writer:
            yield writer
        os.replace(unfinished, path)
    except (OSError, RuntimeError) as problem:  # lazrs raises RuntimeErrors
        raise RoadExtractionError(f"{path} cannot be written ({problem}). Choose another folder or free its space.") from problem
    finally:
        unfinished.unlink(missing_ok=True)
