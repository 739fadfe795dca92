"""Lanewright outside QGIS: the algorithms from Python and from the command line, with layers read and written by fiona.

In come the names and values of an algorithm's parameters, out go files and a dictionary of results, both as in QGIS Processing.
`run` is the function for scripts and notebooks, `command_line` the program `lanewright`; `speak` sets the language of both.
"""

from ..algorithms.call import run as run_call
from ..algorithms.catalogue import ALGORITHMS
from ..algorithms.texts import languages
from ..algorithms.texts import speak as speak_language
from ..core.common.errors import Cancelled, RoadExtractionError
from ..core.common.progress import Progress
from .call import FileCall

__all__ = ["Cancelled", "Progress", "RoadExtractionError", "algorithms", "run", "speak"]


def algorithms():
    """{id: Algorithm} in the order of the work; `parameters` and `numbers` of each say what it takes and gives."""
    return {declared.ID: declared() for declared in ALGORITHMS}


def algorithm_named(name):
    """The algorithm of an id; raises RoadExtractionError where there is none."""
    by_id = algorithms()
    algorithm = by_id.get(name.partition("lanewright:")[2] or name)
    if algorithm is None:
        raise RoadExtractionError(f"There is no algorithm {name}. There are: {', '.join(by_id)}.")
    return algorithm


def run(name, progress=None, **parameters):
    """Run an algorithm on files, as QGIS Processing would.

    name : the algorithm's id, such as "roadmap"; with or without "lanewright:" before it
    progress : Progress that listens, and may raise Cancelled
    parameters : by the names of the algorithm's parameters. Files and layers are paths, one layer of a GeoPackage is `map.gpkg|layername=lanes`;
        POINT_CLOUDS is a list. Outputs that are not named are not made; what is not given keeps its default.
    Returns dict, name of each result to its path or number
    Raises RoadExtractionError if a parameter is wrong or the data cannot be worked with; no result is written then. Cancelled if `progress` said
    so; no result is written then.
    """
    progress = progress or Progress()
    return run_call(FileCall(algorithm_named(name), parameters, progress), progress)


def speak(language="en"):
    """Make help, messages and reports, but no ids, values of choices, fields and files, speak a language, such as "de".

    Raises RoadExtractionError if there is no translation.
    """
    if not speak_language(language):
        raise RoadExtractionError(f"There are no texts in the language {language}. There are: {', '.join(languages())}.")
