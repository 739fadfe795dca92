"""GDAL's errors as Python exceptions, for our own calls alone."""

import threading
from contextlib import ExitStack, contextmanager, suppress

_lock = threading.Lock()
_inside = 0       # blocks of all threads that run at present, before GDAL 3.7
_switched = []    # GDAL's modules that the first of them switched on


@contextmanager
def gdal_exceptions():
    """While this lasts, or in a function decorated with it, GDAL raises RuntimeError; afterwards it is as it was before.

    Whether GDAL raises is a state of the whole process, which every plugin of QGIS shares. Since GDAL 3.7 a
    thread may have a state of its own, and only that is touched; before, the state is restored
    when the last thread leaves.
    """
    from osgeo import gdal, ogr

    modules = (gdal, ogr)
    with ExitStack() as stack:
        if hasattr(gdal, "ExceptionMgr"):
            for module in modules:
                stack.enter_context(module.ExceptionMgr(useExceptions=True))
            # GDAL raises an error that was met before once more when the state is restored
            stack.callback(gdal.ErrorReset)
        else:
            stack.enter_context(_for_all_threads(modules))
        yield


@contextmanager
def _for_all_threads(modules):
    global _inside
    with _lock:
        if not _inside:
            _switched[:] = [module for module in modules if not module.GetUseExceptions()]
            for module in _switched:
                module.UseExceptions()
        _inside += 1
    try:
        yield
    finally:
        with _lock:
            _inside -= 1
            if not _inside:
                # each module keeps the error handler that was there before it: the last is taken off first
                with suppress(RuntimeError):  # somebody else switched another module on meanwhile, and it must stay
                    for module in reversed(_switched):
                        module.DontUseExceptions()
                _switched.clear()
