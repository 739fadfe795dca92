"""Files that appear whole or not at all: until a file is finished it has a hidden name of its own beside its place."""

from __future__ import annotations

import os
import time
from glob import escape
from pathlib import Path
from uuid import uuid4

ABANDONED_TIME = 24 * 3600.0   # s since the last write to an unfinished file after which its run is taken for dead; a computer may be suspended


def unfinished_path(path: str | os.PathLike[str], suffix: str) -> Path:
    """Where a file is written until it is finished, and then moved to its place by `os.replace`.

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
            if time.time() - left.stat().st_mtime > ABANDONED_TIME:
                left.unlink()
        except OSError:
            pass   # another run was quicker, or it is held open
    return target.with_name(f".{target.name}.{uuid4().hex}.unfinished{suffix}")
