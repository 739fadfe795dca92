"""What a worker does: opens what a phase reads from, once, and computes one item after the other."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess  # nosec B404
import sys
import threading
import time
import traceback
from collections import OrderedDict
from collections.abc import Iterator, Sequence
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from uuid import uuid4

from ..common.errors import Cancelled, RoadExtractionError
from ..common.parallel import cancellation_scope, free_memory, is_lack_of_memory, reuse_freed_memory, trim_heap
from ..common.progress import Progress
from .phase import named, paths_of, read_plain, write_results
from .weights import EXECUTION

_lock = threading.Lock()
_open: OrderedDict[str, tuple[Any, Any, tuple[Any, ...]]] = OrderedDict()
_sources: dict[Any, Any] = {}   # sources that several phases share, by the keys of their recipes


@lru_cache(maxsize=1)
def code_digest() -> str:
    """A digest of the code that phases run, with its tables: other code may give other results."""
    package = Path(__file__).resolve().parents[2]
    sha = hashlib.sha256()
    files = (path for folder in ("core", "products") for path in (package / folder).rglob("*") if path.suffix in (".py", ".json", ".txt"))
    for path in sorted(files):
        sha.update(path.relative_to(package).as_posix().encode() + path.read_bytes())
    return sha.hexdigest()


def items_done(phase: str, items: str, results: Sequence[Any]) -> dict[str, Any]:
    """Compute some items of a phase, one after the other, but for those whose results are there.

    phase : file of the "module:name" of its function, the Recipe of its source and its arguments; the phase is wanted as long as it is there
    items : file of the list of the items
    results : files that their results are written to, or lists of files for lists of results; unfinished, they lie beside the phase

    Returns empty, or what went wrong: one of the keys "refused", "cancelled", "memory", "disk" and "bug", and words; and the number of the item that
    it is about as "at": those before it are computed, those after it not.
    """
    at = 0
    try:
        with cancellation_scope(_WhileWanted(Path(phase))):
            for item, result in zip(read_plain(Path(items)), results):
                if not all(path.exists() for path in paths_of(result)):
                    function, source, arguments = _phase(phase)
                    write_results(result, function(source, item, *arguments), Path(phase).parent)
                at += 1
    except RoadExtractionError as error:
        return {"at": at, "refused": str(error)}
    except Cancelled:
        return {"at": at, "cancelled": "the caller has ended the phase"}
    except Exception as error:
        if is_lack_of_memory(error):
            return {"at": at, "memory": "out of memory"}
        return {"at": at, "disk": str(error)} if isinstance(error, OSError) else {"at": at, "bug": traceback.format_exc()}
    return {}


def _phase(path):
    with _lock:
        if path not in _open:
            function, source, arguments = read_plain(Path(path))
            _open[path] = named(function), source.open(_sources), arguments
            while len(_open) > EXECUTION.open_phases:
                _open.popitem(last=False)
        return _open[path]


def forget() -> None:
    """Close what is kept open between items, and return its memory to the operating system; no item is being computed."""
    with _lock:
        _open.clear()
        _sources.clear()
    free_memory()


class _WhileWanted(Progress):
    """Cancels what is done for a phase that the caller has ended."""

    def __init__(self, phase):
        self.phase, self.looked = phase, time.monotonic()

    def check_cancelled(self):
        if time.monotonic() - self.looked > EXECUTION.look_time:
            self.looked = time.monotonic()
            if not self.phase.exists():
                raise Cancelled


# What runs on the workers of a Dask cluster: the look around before the work, and items of phases.
#
# The caller keeps a folder that all of them see. It is alive as long as it touches the file BEAT, and where it does no longer, the workers remove
# the folder.

BEAT = "beat"          # file that the caller touches; it holds the seconds after which a caller is taken for dead that did not

_watched: set[str] = set()


def look_around(folder: str, word: str, dask_worker: Any = None) -> dict[str, Any]:
    """What the caller must know of a worker, which Dask gives as `dask_worker`.

    folder : of the caller
    word : file in it that the worker must see

    Returns
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


def items_done_here(code: str, phase: str, items: str, results: Sequence[Any]) -> dict[str, Any]:
    """`items_done`; refused where this worker's Lanewright has another digest than `code`, that of the caller."""
    if code_digest() != code:
        return {"refused": "A worker that came later has another Lanewright than this computer. Install this one there."}
    _watch(str(Path(phase).parent))
    reuse_freed_memory()
    answer = items_done(phase, items, results)
    # a worker whose memory seems full pauses
    trim_heap()
    return answer


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
            modified = beat.stat().st_mtime_ns
            if modified != last:
                last, since = modified, time.monotonic()
            time.sleep(EXECUTION.watch_time)
        shutil.rmtree(folder, ignore_errors=True)
    except (OSError, ValueError):
        pass   # the caller removed the folder
    with _lock:
        _watched.discard(str(folder))


# A Python interpreter that worker processes can be started with: looked for, and tried before it is used.
#
# Inside QGIS on Windows and macOS `sys.executable` is QGIS itself, and starting it would open another QGIS. Nothing but Python interpreters is
# started, by their full path and without a shell.

WORKER = Path(__file__).with_name("worker.py")
NEEDED = ("numpy", "scipy", "shapely")   # packages whose versions must be equal, or results could differ
IMPORTED = ("laspy", "lazrs", "cv2")     # packages whose results are the same in all versions
THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS")   # the last is lazrs's


def versions(names: Sequence[str] = NEEDED) -> dict[str, str]:
    """The versions of Python (its first two numbers) and of packages in this process; "" for what was not installed as a package."""
    result = {"python": ".".join(map(str, sys.version_info[:2]))}
    for name in names:
        try:
            result[name] = version(name)
        except PackageNotFoundError:
            result[name] = ""
    return result


def command_of(interpreter: str, *arguments: str) -> list[str]:
    """The command that starts a worker: isolated, so that no variable and no folder of the user's changes what it imports."""
    cache = ["-X", f"pycache_prefix={sys.pycache_prefix}"] if sys.pycache_prefix else []
    return [interpreter, "-I", *cache, str(WORKER), *arguments]


def environment() -> dict[str, str]:
    """The environment of a worker: without what QGIS set for its own Python, and with one thread for numpy and for decoding."""
    return {**{name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}, **dict.fromkeys(THREAD_VARIABLES, "1")}


def no_window() -> int:
    return getattr(subprocess, "CREATE_NO_WINDOW", 0)


def candidates() -> Iterator[str]:
    """Interpreters that may belong to this Python, the likeliest first."""
    name = f"python{sys.version_info.major}.{sys.version_info.minor}"
    folders = [Path(folder) for folder in dict.fromkeys((sys.prefix, sys.exec_prefix, sys.base_prefix, sys.base_exec_prefix))]
    places = [Path(path) for path in (sys.executable, getattr(sys, "_base_executable", "")) if path]
    for folder in folders:
        places += [folder / "python.exe", folder / "bin" / name, folder / "bin" / "python3"]
    if sys.executable:   # QGIS.app/Contents/MacOS/bin
        places.append(Path(sys.executable).parent / "bin" / "python3")
    for path in dict.fromkeys(places):
        if path.name.lower().startswith("python") and path.is_file():
            yield str(path)


@lru_cache(maxsize=1)
def find_interpreter() -> str:
    """The first candidate that can do the work of this process; "" where there is none.

    It must import the packages NEEDED from the folders that this process imports from, in the same versions, and IMPORTED; these,
    half a second's work, are tried where it is another program than the one that runs.
    """
    return next((path for path in candidates() if _can_work(path)), "")


def _runs_this(path: str) -> bool:
    """Whether this process runs that very program, as far as the system tells: what is imported here, it can import, too."""
    try:
        return os.path.samefile("/proc/self/exe", path)
    except OSError:
        return False


def _can_work(path: str) -> bool:
    imported = () if _runs_this(path) else IMPORTED
    try:
        done = subprocess.run(  # nosec B603
            command_of(path, "--try", *imported), input=json.dumps(import_folders()), env=environment(), capture_output=True, text=True,
            timeout=EXECUTION.trial_time, creationflags=no_window(), check=False)
        return done.returncode == 0 and json.loads(done.stdout) == versions()
    except (OSError, ValueError, subprocess.SubprocessError):
        return False


def import_folders() -> Sequence[str]:
    """The folders that this process imports from, in order."""
    return [os.path.abspath(folder) for folder in sys.path if folder and os.path.exists(folder)]
