"""A LAS or LAZ file that appears whole or not at all."""

import os
from contextlib import contextmanager
from pathlib import Path

from ..errors import RoadExtractionError


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
