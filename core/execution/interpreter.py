"""A Python interpreter that worker processes can be started with: looked for, and tried before it is used.

Inside QGIS on Windows and macOS `sys.executable` is QGIS itself, and starting it would open another QGIS. Nothing but Python
interpreters is started, by their full path and without a shell.
"""

from __future__ import annotations

import json
import os
import subprocess  # nosec B404
import sys
from collections.abc import Iterator, Sequence
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

WORKER = Path(__file__).with_name("worker.py")
NEEDED = ("numpy", "scipy", "shapely")   # packages whose versions must be equal, or results could differ
IMPORTED = ("laspy", "lazrs", "cv2")     # packages whose results are the same in all versions
TRIAL_TIME = 30.0   # s that a trial may take on a busy computer
THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS")   # the last is lazrs's


def versions() -> dict[str, str]:
    """The versions of Python and of the packages NEEDED in this process; "" for a missing one."""
    found = {"python": ".".join(map(str, sys.version_info[:2]))}
    for name in NEEDED:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = ""
    return found


def command_of(interpreter: str, *arguments: str) -> list[str]:
    """The command that starts a worker: isolated, so that no variable and no folder of the user's changes what it imports."""
    cache = ["-X", f"pycache_prefix={sys.pycache_prefix}"] if sys.pycache_prefix else []
    return [interpreter, "-I", *cache, str(WORKER), *arguments]


def environment() -> dict[str, str]:
    """The environment of a worker: without what QGIS set for its own Python, and with one thread for numpy and for decoding."""
    return {**{name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}, **dict.fromkeys(THREAD_VARIABLES, "1")}


def no_window() -> int:
    """Flags by which Windows opens no console window."""
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
            timeout=TRIAL_TIME, creationflags=no_window(), check=False)
        return done.returncode == 0 and json.loads(done.stdout) == versions()
    except (OSError, ValueError, subprocess.SubprocessError):
        return False


def import_folders() -> Sequence[str]:
    """The folders that this process imports from, in order."""
    return [os.path.abspath(folder) for folder in sys.path if folder and os.path.exists(folder)]
