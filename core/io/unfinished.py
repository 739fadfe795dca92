"""Files that appear whole or not at all: until a file is finished it has a hidden name of its own beside its place."""

from __future__ import annotations

import os
import shutil
import time
from glob import escape
from pathlib import Path
from uuid import uuid4

ABANDONED_TIME = 24 * 3600.0   # s since the last write to an unfinished file after which its run is taken for dead; a computer may be suspended


def unfinished_path(path: str | os.PathLike[str], suffix: str) -> Path:
    """Where a file is written until it is finished, and then moved to its place by `finish_file`; or where a folder for its parts is made.

    The name is used once, so that of several runs that write the same file each ends well, and the last to end is kept. What killed
    runs left of the file is removed.

    Parameters
    ----------
    path : of the finished file
    suffix : of the unfinished one, such as ".tif"
    """
    target = Path(path)
    for left in target.parent.glob(f".{escape(target.name)}.*.unfinished*"):
        try:
            if time.time() - max(file.stat().st_mtime for file in (left, *left.glob("*"))) > ABANDONED_TIME:
                shutil.rmtree(left) if left.is_dir() else left.unlink()
        except OSError:
            pass   # another run was quicker, or it is held open
    return target.with_name(f".{target.name}.{uuid4().hex}.unfinished{suffix}")


def finish_file(unfinished: str | os.PathLike[str], path: str | os.PathLike[str]) -> None:
    """Give an unfinished file its name, once all of it is on the disk: a power failure leaves the previous file or this one."""
    with open(unfinished, "r+b") as file:
        os.fsync(file.fileno())
    os.replace(unfinished, path)
