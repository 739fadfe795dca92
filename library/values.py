"""What users write for a parameter, as a text or a Python value, in the type that the parameter has."""

import math
from difflib import get_close_matches
from os import PathLike, fspath

from ..algorithms.algorithm import choice_refused, number_refused
from ..core.common.errors import RoadExtractionError

YES, NO = ("true", "yes", "on", "1"), ("false", "no", "off", "0")


def checked_values(algorithm, given):
    """The values of a run by parameter name, of texts, numbers, paths or lists of paths; what was not given is left out.

    Raises RoadExtractionError if a name is not the algorithm's, a value is none that the parameter takes, or a necessary one is missing.
    """
    values = {}
    for name, value in given.items():
        spec = algorithm.parameter(name)
        if spec is None and name not in algorithm.RETIRED:
            raise RoadExtractionError(_unknown(algorithm, name))
        value = _plain(value)
        if value not in (None, "", []):
            values[name] = value if spec is None else parsed(spec, value)
    for spec in algorithm.parameters:
        if spec.name not in values and not spec.optional and spec.default is None:
            raise RoadExtractionError(f"{spec.label} ({spec.name}) was not given and {algorithm.ID} needs it.")
    return values


def _unknown(algorithm, name):
    names = [spec.name for spec in algorithm.parameters]
    near = get_close_matches(str(name).upper(), names, 1)
    return (f"{algorithm.ID} has no parameter {name}. " + (f"Did you mean {near[0]}?" if near else f"It has: {', '.join(names)}."))


def _plain(value):
    """Paths as texts, tuples as lists."""
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return fspath(value) if isinstance(value, PathLike) else value


def parsed(spec, value):
    """The value of one parameter; raises RoadExtractionError where it is none that the parameter takes."""
    if spec.is_output:
        return _destination(spec, value)
    if spec.kind == "clouds":
        return [_text(spec, path) for path in (value if isinstance(value, list) else [value])]
    return PARSERS.get(spec.kind, _text)(spec, value)


def _text(spec, value):
    if not isinstance(value, str):
        raise RoadExtractionError(f"{spec.label} ({spec.name}) is {value!r}; it must be one text.")
    return value


def _destination(spec, value):
    text = _text(spec, value)
    if text == "TEMPORARY_OUTPUT" or text.startswith(("memory:", "postgres:", "mssql:", "oracle:")):
        raise RoadExtractionError(
            f"{spec.label} ({spec.name}) is {text}, which only QGIS can write to. Outside QGIS name a file, such as {spec.name.lower()}.gpkg.")
    return text


def _choice(spec, value):
    if value not in spec.choices:
        raise RoadExtractionError(choice_refused(spec.label, spec.name, value, spec.choices))
    return value


def _flag(spec, value):
    word = str(value).lower()
    if word not in YES + NO:
        raise RoadExtractionError(f"{spec.label} ({spec.name}) is {value}; it must be true or false.")
    return word in YES


def _number(spec, value):
    least, most = spec.limits()
    try:
        number = math.nan if isinstance(value, bool) else float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not least <= number <= most or spec.kind == "whole" and number != int(number):
        raise RoadExtractionError(number_refused(spec.label, spec.name, value, least, most))
    return int(number) if spec.kind == "whole" else number


PARSERS = {"choice": _choice, "flag": _flag, "whole": _number, "number": _number}
