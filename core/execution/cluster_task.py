"""What runs on the workers of a Dask cluster: the look around before the work, and items of phases.

The caller keeps a folder that all of them see. A phase is wanted as long as its file is there; the caller itself is alive as long as
it touches the file BEAT, and where it does no longer, the workers remove the folder.
"""

from __future__ import annotations

import os
import shutil
import threading
import time
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from uuid import uuid4

from ..common.errors import Cancelled
from ..common.parallel import cancellation_scope, reuse_freed_memory, trim_heap
from ..common.progress import Progress
from .interpreter import IMPORTED
from .tasks import Tasks
from .work_folder import code_digest

BEAT = "beat"          # file that the caller touches; it holds the seconds after which a caller is taken for dead that did not
LOOK_TIME = 0.5        # s between two looks whether a phase is still wanted
WATCH_TIME = 2.0       # s between two looks at BEAT

_tasks = Tasks()
_watched: set[str] = set()
_lock = threading.Lock()


def look_around(folder: str, word: str, dask_worker: Any = None) -> dict[str, Any]:
    """What the caller must know of a worker.

    Parameters
    ----------
    folder : of the caller
    word : file in it that the worker must see
    dask_worker : the worker itself, given by Dask

    Returns
    -------
    code : digest of the worker's Lanewright
    problem : why the folder is of no use, "" where it can be read and written
    memory : bytes that the worker may take, 0 where nothing limits it
    """
    problem = ""
    _watch(folder)
    try:
        if not (Path(folder) / word).exists():
            problem = "it is not there"
        trial = Path(folder) / uuid4().hex
        trial.touch()
        trial.unlink()
    except OSError as error:
        problem = problem or error.strerror or str(error)
    return dict(code=code_digest(), problem=problem, memory=int(dask_worker.memory_manager.memory_limit or 0))


def sees_files(sizes: dict[str, int]) -> bool:
    """Whether this worker finds files of these sizes (bytes by path) and can decode point clouds."""
    return all(find_spec(name) is not None for name in IMPORTED) and all(
        os.path.exists(path) and os.path.getsize(path) == size for path, size in sizes.items())


def items_done(phase: str, items: Sequence[str], results: Sequence[str], code: str) -> dict[str, str]:
    """Compute some items of a phase, one after the other, but for those whose results are there.

    Parameters
    ----------
    phase : file as in `Tasks.answer`
    items, results : as many files, likewise
    code : digest of the caller's Lanewright

    Returns
    -------
    as `Tasks.answer`, with the number of the item that it is about as "at"; those before it are computed, those after it not. Also {"code": ...}
    where the worker's Lanewright is another
    """
    left = [k for k, result in enumerate(results) if not Path(result).exists()]
    if not left:
        return {}
    if code_digest() != code:
        return {"code": code_digest()}
    _watch(str(Path(phase).parent))
    reuse_freed_memory()
    answer: dict[str, str] = {}
    with cancellation_scope(_WhileWanted(Path(phase))):
        for k in left:
            answer = _tasks.answer(Path(phase), Path(items[k]), Path(results[k]))
            if answer:
                answer["at"] = str(k)
                break
    # a worker whose memory seems full pauses
    trim_heap()
    return answer


class _WhileWanted(Progress):
    """Cancels what is done for a phase that the caller has ended."""

    def __init__(self, phase):
        self.phase, self.looked = phase, time.monotonic()

    def check_cancelled(self):
        if time.monotonic() - self.looked > LOOK_TIME:
            self.looked = time.monotonic()
            if not self.phase.exists():
                raise Cancelled


def _watch(folder):
    """See to it that the folder goes when the caller is gone; one thread for each folder."""
    with _lock:
        if folder in _watched:
            return
        _watched.add(folder)
    threading.Thread(target=_remove_after, args=(Path(folder),), daemon=True).start()


def _remove_after(folder):
    beat, last, since = folder / BEAT, 0, time.monotonic()
    try:
        patience = float(beat.read_text(encoding="utf-8"))
        while time.monotonic() - since < patience:
            # clocks of two machines differ, so the time of the file is only compared with itself
            now = beat.stat().st_mtime_ns
            if now != last:
                last, since = now, time.monotonic()
            time.sleep(WATCH_TIME)
        shutil.rmtree(folder, ignore_errors=True)
    except (OSError, ValueError):
        pass   # the caller removed the folder
    with _lock:
        _watched.discard(str(folder))
