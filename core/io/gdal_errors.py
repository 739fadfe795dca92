"""GDAL's errors as Python exceptions, and no network, for Lanewright's own calls alone."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import Any

from .local_files import offline

_lock = threading.Lock()
_active = 0       # blocks of all threads that run at present, before GDAL 3.7
_enabled: list[Any] = []    # GDAL's modules whose exceptions the first of them enabled


@contextmanager
def gdal_exceptions() -> Iterator[None]:
    """A context, or a decorator of a function, in which GDAL raises RuntimeError and asks no server; afterwards it is as it was before.

    Whether GDAL raises is a state of the whole process, which all plugins of QGIS share. Since GDAL 3.7 a
    thread may have a state of its own, and only that is changed; with older versions, the state is restored
    when the last thread leaves.
    """
    from osgeo import gdal, ogr

    modules = (gdal, ogr)
    with ExitStack() as stack:
        stack.enter_context(offline())
        if hasattr(gdal, "ExceptionMgr"):
            for module in modules:
                stack.enter_context(module.ExceptionMgr(useExceptions=True))
            # otherwise GDAL raises an earlier error once more when the state is restored
            stack.callback(gdal.ErrorReset)
        else:
            stack.enter_context(_for_all_threads(modules))
        yield


@contextmanager
def _for_all_threads(modules):
    global _active
    with _lock:
        if not _active:
            _enabled[:] = [module for module in modules if not module.GetUseExceptions()]
            for module in _enabled:
                module.UseExceptions()
        _active += 1
    try:
        yield
    finally:
        with _lock:
            _active -= 1
            if not _active:
                # each module keeps the error handler that was there before it: the last is removed first
                with suppress(RuntimeError):  # another plugin enabled a further module meanwhile, which must stay so
                    for module in reversed(_enabled):
                        module.DontUseExceptions()
                _enabled.clear()
