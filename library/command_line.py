"""The program `lanewright`: every algorithm with the names and values of QGIS Processing, on files."""

import argparse
import json
import os
import signal
import sys
import warnings
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path

from ..algorithms.algorithm import GROUPS
from ..algorithms.call import run, time_left
from ..algorithms.provenance import own_version
from ..algorithms.texts import told, tr
from ..core.common.errors import Cancelled, RoadExtractionError
from ..core.common.progress import Progress, RemainingTime
from . import algorithm_named, algorithms, speak
from .call import FileCall

# What a value looks like in the help
METAVARS = {"layer": "LAYER", "folder": "FOLDER", "crs": "EPSG:NUMBER", "flag": "true|false", "expression": "CONDITION", "text": "TEXT",
            "columns": "TEXT", "connection": "SERVICE", "schema": "NAME", "whole": "NUMBER", "number": "NUMBER"}
DEMO = {"LENGTH": 100}  # m, of the simulated street


def about_layers():
    """What stands below every help."""
    return tr("A layer is a file (.gpkg, .fgb, .shp, .geojson), or one layer of a GeoPackage: map.gpkg|layername=lanes. A result that is not named "
              "is not made. With --json the results, or the reason of a failure, are printed as JSON; --lang de speaks German.")


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise RoadExtractionError(f"{message[0].upper()}{message[1:]}. Try: {self.prog} --help")


def main(arguments=None):
    """Run the program; its exit code: 0, 1 after one sentence on stderr (with --json on stdout too), 130 after Ctrl-C."""
    common = Parser(prog="lanewright", add_help=False, allow_abbrev=False)
    common.add_argument("--json", action="store_true")
    common.add_argument("--lang", nargs="?", default="", const="")
    asked = argparse.Namespace(json=False, lang="")
    # CRSs are compared by their projections' words, which leave out names that do not matter
    warnings.filterwarnings("ignore", "You will likely lose important projection information", UserWarning)
    try:
        _, arguments = common.parse_known_args(sys.argv[1:] if arguments is None else list(arguments), asked)
        if asked.lang:
            speak(asked.lang)
        missing = [name for name in ("numpy", "scipy", "laspy", "lazrs", "shapely", "pyproj", "fiona", "cv2", "jinja2") if find_spec(name) is None]
        if missing:
            raise RoadExtractionError(f"These Python packages are missing: {', '.join(missing)}. pip install lanewright brings them.")
        return _main(arguments, asked.json)
    except RoadExtractionError as error:
        _tell_failure(told(str(error)), asked.json)
    except (Cancelled, KeyboardInterrupt):
        _tell_failure(tr("Cancelled"), asked.json)
        return 128 + signal.SIGINT
    except BrokenPipeError:  # whoever read the output has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    finally:
        if asked.lang:
            speak("en")
    return 1


def _tell_failure(sentence, as_json):
    print(sentence, file=sys.stderr)
    if as_json:
        print(json.dumps({"error": sentence}, ensure_ascii=False))


def _main(arguments, as_json):
    first, *options = arguments or ["--help"]
    if first in ("-h", "--help", "help"):
        print(overview(algorithms()))
    elif first == "--version":
        print(f"lanewright {own_version()}")
    elif first == "demo":
        demo(options, as_json)
    elif first == "list":
        print("\n".join(f"{algorithm.ID:24}{algorithm.summary()}" for algorithm in algorithms().values()))
    else:
        algorithm = algorithm_named(first)
        _run_with(algorithm, {name: value for name, value in vars(parser_of(algorithm).parse_args(options)).items() if value is not None}, as_json)
    return 0


def demo(options, as_json):
    """`lanewright demo FOLDER`: a simulated street, its road map, and how far the driving lines are from the true ones."""
    parser = Parser(prog="lanewright demo", description=tr("A simulated street, its road map with a report, and how far the driving lines are from "
                                                           "the true ones: files in a folder to look at and to try things on."))
    parser.add_argument("folder", metavar="FOLDER", nargs="?", default="lanewright_demo", help=tr("default {value}", value="lanewright_demo"))
    folder = Path(parser.parse_args(options).folder)
    with suppress(OSError):  # the first run says why nothing can be written
        folder.mkdir(parents=True, exist_ok=True)
    cloud, drive, truth = (str(folder / name) for name in ("street.laz", "trajectory.gpkg", "truth.gpkg|layername=driving_lines"))
    layers = {spec.name: f"{folder / 'road_map.gpkg'}|layername={spec.name.lower()}"
              for spec in algorithm_named("roadmap").outputs() if spec.kind == "layer" and spec.by_default}
    for name, parameters in (
            ("samplesurvey", {**DEMO, "POINT_CLOUD": cloud, "TRAJECTORY": drive, "TRUTH_DRIVING_LINES": truth}),
            ("roadmap", {"POINT_CLOUDS": [cloud], "TRAJECTORY": drive, **layers, "REPORT": str(folder / "report.html")}),
            ("assessdrivinglines", {"INPUT": layers["DRIVING_LINES"], "REFERENCE": truth, "OUTPUT": str(folder / "accuracy.gpkg"),
                                    "REPORT": str(folder / "accuracy.html")})):
        _run_with(algorithm_named(name), parameters, as_json)


def _run_with(algorithm, parameters, as_json):
    progress = TextProgress()
    with cancelled_by_signals(progress):
        results = run(FileCall(algorithm, parameters, progress), progress)
    if as_json:
        print(json.dumps({"results": results}, ensure_ascii=False, default=str))
    else:
        print("\n".join(f"{name}: {value}" for name, value in results.items()))


def overview(known):
    """What `lanewright --help` prints."""
    lines = ["usage: lanewright ALGORITHM --PARAMETER=VALUE ...", "       lanewright ALGORITHM --help",
             "       lanewright demo [FOLDER] | list | --version", "",
             tr("Road maps from mobile laser scanning: the algorithms of Lanewright in QGIS, on files."), about_layers()]
    for group in GROUPS:
        lines += ["", tr(group)] + [f"  {algorithm.ID:24}{algorithm.title()}" for algorithm in known.values() if algorithm.GROUP == group]
    return "\n".join(lines)


def parser_of(algorithm):
    """The options of an algorithm."""
    parser = Parser(prog=f"lanewright {algorithm.ID}", usage=f"lanewright {algorithm.ID} --PARAMETER=VALUE ...", allow_abbrev=False,
                    description=" ".join([algorithm.summary(), *algorithm.help_paragraphs()]).replace("%", "%%"), epilog=about_layers())
    inputs, advanced, results = (parser.add_argument_group(title) for title in (tr("inputs"), tr("advanced parameters"), tr("results")))
    for spec in algorithm.parameters:
        group = results if spec.is_output else advanced if spec.advanced else inputs
        many_values = dict(action="extend", nargs="+") if spec.kind == "clouds" else {}
        group.add_argument(f"--{spec.name}", dest=spec.name, metavar=metavar(spec), help=explained(spec).replace("%", "%%"), **many_values)
    for name in algorithm.RETIRED:
        parser.add_argument(f"--{name}", help=argparse.SUPPRESS)
    return parser


def metavar(spec):
    return "|".join(spec.choices) if spec.kind == "choice" else METAVARS.get(spec.kind, "FILE")


def explained(spec):
    """Label, help, default and limits of a parameter in one paragraph."""
    notes = []
    if spec.default not in (None, ""):
        notes.append(tr("default {value}", value=str(spec.default).lower() if isinstance(spec.default, bool) else spec.default))
    elif not spec.optional:
        notes.append(tr("necessary"))
    if spec.kind in ("whole", "number"):
        notes.append(tr("{low:g} to {high:g}", low=spec.limits()[0], high=spec.limits()[1]))
    return f"{spec.label}. {spec.help}" + (f" [{', '.join(notes)}]" if notes else "")


# What a run says on a terminal or in a log, and Ctrl-C as Cancel.

PERCENT_STEP = 10  # between two lines about the share that is done


class TextProgress(Progress):
    """Writes findings and, every tenth of the work, the share that is done; raises Cancelled once `cancelled` is set."""

    def __init__(self, stream=None, remaining=None):
        self.stream = sys.stderr if stream is None else stream
        self.cancelled = False
        self._remaining = remaining or RemainingTime()
        self._written = 0

    def check_cancelled(self):
        if self.cancelled:
            raise Cancelled

    def report(self, fraction):
        self.check_cancelled()
        left = self._remaining.after(fraction)
        remaining = "" if left is None else time_left(left)
        percent = PERCENT_STEP * int(100 * fraction / PERCENT_STEP)
        if percent > self._written or left is not None:
            self._written = max(percent, self._written)
            self._write(f"{100 * fraction:.0f} %" + (remaining and f", {remaining[0].lower()}{remaining[1:]}"))

    def info(self, text):
        self._write(told(text))

    def warn(self, text):
        self._write(tr("Warning: {text}", text=told(text)))

    def _write(self, text):
        print(text, file=self.stream, flush=True)


@contextmanager
def cancelled_by_signals(progress):
    """While this lasts, Ctrl-C and a polite kill end the run at its next question; a second one ends the program at once."""

    def cancel(number, frame):
        progress.cancelled = True
        signal.signal(number, before[number])

    before = {number: signal.signal(number, cancel) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
