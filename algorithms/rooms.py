"""Where the work is done. What the algorithms call there is named in full, such as `core.io.crs.parse_crs`, and imported when it is first used:
QGIS asks every algorithm for its parameters when it starts, and need not wait for the rest."""

from importlib import import_module
from typing import Any


class Room:
    """A package of the program, whose packages and modules are its attributes. name : of the package"""

    def __init__(self, name):
        self._name = name

    def __getattr__(self, attribute):
        module = import_module(f"{self._name}.{attribute}")
        return Room(module.__name__) if hasattr(module, "__path__") else module


ROOT = __package__.rpartition(".")[0]
core: Any = Room(f"{ROOT}.core")
products: Any = Room(f"{ROOT}.products")
simulator: Any = Room(f"{ROOT}.simulator")
