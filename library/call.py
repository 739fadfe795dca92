"""One run of an algorithm on files, without QGIS."""

import math
import os
import re
from difflib import get_close_matches
from os import PathLike, fspath
from pathlib import Path

from ..algorithms.algorithm import choice_refused, number_refused
from ..algorithms.call import Call, existing_file
from ..algorithms.destinations import destination_path
from ..algorithms.provenance import provenance_now
from ..algorithms.rooms import core
from ..core.common.errors import RoadExtractionError
from ..core.io.local_files import gdal_exceptions, open_raster
from .layer_files import DRIVERS, LayerFile, check_format, check_gdal, file_and_table, first_table, write_layer


class FileCall(Call):
    """`Call` for values that name files."""

    VECTOR_SUFFIXES = tuple(DRIVERS)

    def __init__(self, algorithm, given, progress):
        values = checked_values(algorithm, given)
        rasters = [spec for spec in algorithm.parameters if spec.kind == "raster" and spec.name in values]
        if rasters:
            check_gdal(f"{rasters[0].label} ({rasters[0].name}) is a raster")
        for spec in algorithm.parameters:
            if spec.is_output and spec.geometry.endswith("ZM") and spec.name in values:
                check_format(file_and_table(values[spec.name])[0], spec.label)
        super().__init__(algorithm, values)
        self._progress = progress

    # -- in ---------------------------------------------------------------------------------

    def files(self, name):
        return self.value(name) or []

    def file(self, name):
        return self.value(name) or ""

    def value(self, name):
        return self.parameters.get(name, self.algorithm.parameter(name).default)

    def crs(self, name="CRS"):
        text = self.value(name)
        try:
            return core.io.crs.in_metres(core.io.crs.parse_crs(text).to_wkt())[0] if text else ""
        except RoadExtractionError as problem:
            raise RoadExtractionError(f"{self.label(name)}: the CRS {text} is not known. Give it as EPSG:number.") from problem

    def connection(self, name):
        return "service='{}'".format(re.sub(r"(['\\])", r"\\\1", self.value(name)))

    def raster(self, name):
        return existing_file(self.value(name), self.label(name))

    def source(self, name):
        value = self.value(name)
        return LayerFile(value, self.label(name)) if value else None

    def painted(self, name):
        value, label = self.value(name), self.label(name)
        path, table = file_and_table(value)
        if table or Path(path).suffix.lower().lstrip(".") in DRIVERS:
            return LayerFile(value, label), "", ""
        existing_file(path, label)
        check_gdal(f"{label} ({name}) is a raster")
        try:
            with gdal_exceptions():
                return None, path, open_raster(path).GetProjection()
        except RoadExtractionError:  # a vector format of another ending
            return LayerFile(value, label), "", ""

    def rows_where(self, name, source):
        condition = self.value(name)
        return source.rows_where(condition) if condition else None

    def layer_name(self, name):
        path, table = file_and_table(self.value(name))
        return table or Path(path).stem

    # -- out --------------------------------------------------------------------------------

    def destination(self, name):
        return self.parameters.get(name, "")

    def output_path(self, name):
        return self.parameters[name]

    def read_as(self, value, path):
        table, given = file_and_table(value)[1], ((spec.label, self.parameters.get(spec.name)) for spec in self.algorithm.inputs())
        inputs = ((label, *file_and_table(name)) for label, names in given for name in (names if isinstance(names, list) else [names])
                  if isinstance(name, str))
        return next((label for label, source, read in inputs if path.exists() and Path(source).is_file() and os.path.samefile(path, source)
                     and (not table or table == (read or first_table(source)))), "")

    def finish(self, numbers):
        """Write the layers beside their destinations, then give all results their names."""
        provenance = provenance_now(self.algorithm.ID, self.values(), self.warnings, self.names_only)
        for name, features in self._layers:
            features.description = "\n".join(provenance.history(self.algorithm.parameter(name).look or name))
            value = self.destination(name)
            path, table = destination_path(value), file_and_table(value)[1]
            unfinished = self._unfinished.begin_copy(path) if table else self._unfinished.begin(path)
            write_layer(str(unfinished), table, features, self._progress.check_cancelled)
            self._results[name] = f"{path}|layername={table}" if table else value
        self._progress.check_cancelled()
        self.sign_files()
        self._unfinished.commit()
        return {**self._results, **numbers}

    def values(self):
        return {spec.name: self.value(spec.name) for spec in self.algorithm.inputs()}


# What users write for a parameter, as a text or a Python value, in the type that the parameter has.

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
