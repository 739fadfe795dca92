"""Lanewright outside QGIS: the algorithms from Python and from the command line, with layers read and written by fiona.

In come the names and values of an algorithm's parameters, out go files and a dictionary of results, both as in QGIS Processing.
`run` is the function for scripts and notebooks, `command_line` the program `lanewright`; `speak` sets the language of both.
"""

from ..core.common.errors import Cancelled, RoadExtractionError
from ..core.common.progress import Progress
from .run import algorithms, run, speak

__all__ = ["Cancelled", "Progress", "RoadExtractionError", "algorithms", "run", "speak"]
