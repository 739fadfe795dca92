"""What is imported when it is first used: public names of a folder, and OpenCV, a large library that QGIS need not wait for at its start."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any


def public(package: str, modules: dict[str, tuple[str, ...]]) -> tuple[Callable[[str], Any], list[str]]:
    """(`__getattr__`, `__all__`) with which an `__init__` offers names of the modules beside it (PEP 562): {module, relative to it: names}."""
    module_of = {name: module for module, names in modules.items() for name in names}

    def get(name: str) -> Any:
        if name not in module_of:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module = import_module(f".{module_of[name]}", package)
        # a module may have the name of its function: importing it set the folder's attribute to the module
        value = getattr(module, name)
        setattr(import_module(package), name, value)
        return value

    return get, sorted(module_of)


class LazyModule:
    """A module that is imported when one of its names is first used.

    QGIS asks every algorithm for its parameters when it starts, and their defaults stand in the files of the
    stages; what those files compute with is needed only when a stage runs.

    name : of the module; ImportError at the first use where it is not installed
    """

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, attribute: str) -> Any:
        value = getattr(import_module(self._name), attribute)
        setattr(self, attribute, value)  # the next use finds it at once
        return value


cv2: Any = LazyModule("cv2")
