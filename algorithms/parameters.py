"""Typed parameters and outputs of the algorithms: name, label and help in one place, for every program that runs them."""

from __future__ import annotations

from dataclasses import dataclass, fields
from importlib import import_module
from typing import Any

from ..core.common.setting import limits_of
from .texts import tr


def settings_class(path):
    """`core.road.profiles.detect:CurbSettings` -> the class; None where a package it needs is missing."""
    module, name = path.split(":")
    try:
        return getattr(import_module(f"..{module}", __package__), name)
    except ImportError:
        return None


@dataclass(frozen=True)
class ParameterSpec:
    """What every parameter has. `advanced`: a dialog shows it folded away."""

    name: str
    label: str
    help: str = ""
    optional: bool = False
    advanced: bool = False

    is_output = False

    @property
    def default(self) -> Any:
        """What holds where nothing was given; None for nothing."""
        return None


# -- inputs -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class SettingSpec:
    """One field of a core Settings class as a parameter: the default and the limits are the core's, the words are ours.

    The label ends with the unit: m, s, °, %, points, or none for a count or ratio that it explains itself. `choices` makes it
    a list of words. Where a number is a multiple of the core's, its maximum is so many `times` the core's.
    """

    name: str
    settings: str
    field: str
    label: str
    help: str
    choices: tuple = ()
    times: float = 1.0
    advanced: bool = False

    is_output = False

    @property
    def default(self):
        owner = settings_class(self.settings)
        if owner is None:
            return None
        return next(entry.default for entry in fields(owner) if entry.name == self.field)

    @property
    def optional(self):
        return self.kind() == "text"

    def kind(self):
        """choice, flag, text, whole or number."""
        default = self.default
        if self.choices:
            return "choice"
        for type_, kind in ((bool, "flag"), (str, "text"), (int, "whole")):
            if isinstance(default, type_):
                return kind
        return "number"

    def limits(self):
        """(least, most) of a number; None where a package that knows them is missing."""
        owner = settings_class(self.settings)
        if owner is None:
            return None
        found = limits_of(owner, self.field)
        return found.lowest, found.maximum * self.times


@dataclass(frozen=True)
class _WithDefault(ParameterSpec):
    value: Any = None

    @property
    def default(self):
        return self.value


@dataclass(frozen=True)
class FlagSpec(_WithDefault):
    """Yes or no."""


@dataclass(frozen=True)
class TextSpec(_WithDefault):
    """Words or a list of numbers."""


@dataclass(frozen=True)
class ColumnsSpec(TextSpec):
    """Roles of the columns of the table that the input `table` names."""

    table: str = "INPUT"


@dataclass(frozen=True)
class ChoiceSpec(_WithDefault):
    """One of `choices`."""

    choices: tuple = ()


@dataclass(frozen=True)
class CrsSpec(_WithDefault):
    """A coordinate reference system, such as EPSG:32650."""


@dataclass(frozen=True)
class ExpressionSpec(_WithDefault):
    """A condition on the rows of the vector input `layer`."""

    layer: str = ""


@dataclass(frozen=True)
class PointCloudsSpec(ParameterSpec):
    """LAS, LAZ or COPC files."""


@dataclass(frozen=True)
class CloudSpec(ParameterSpec):
    """One LAS or LAZ file."""


@dataclass(frozen=True)
class FileSpec(ParameterSpec):
    """A file of another kind. `file_filter`: as file dialogs take it."""

    file_filter: str = ""


@dataclass(frozen=True)
class FolderSpec(ParameterSpec):
    """A folder; it need not be there."""


@dataclass(frozen=True)
class LayerSpec(ParameterSpec):
    """A vector layer. `geometry`: as in Features, or "any"."""

    geometry: str = "any"


@dataclass(frozen=True)
class TrajectorySpec(LayerSpec):
    """A vector layer or a CSV, TXT or SBET file."""


@dataclass(frozen=True)
class RasterSpec(ParameterSpec):
    """A raster file."""


@dataclass(frozen=True)
class PaintedSpec(ParameterSpec):
    """Polygons, lines or a raster of what is painted."""


# -- outputs ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class OutputSpec(ParameterSpec):
    """A result. `by_default`: a dialog makes it unless told otherwise."""

    by_default: bool = True

    is_output = True


@dataclass(frozen=True)
class LayerOutput(OutputSpec):
    """A vector layer. `geometry`: as in Features; `schema`: its fields, empty where they are not fixed."""

    geometry: str = "any"
    schema: tuple = ()


@dataclass(frozen=True)
class CloudOutput(OutputSpec):
    """A LAZ or LAS file."""


@dataclass(frozen=True)
class RasterOutput(OutputSpec):
    """A GeoTIFF."""


@dataclass(frozen=True)
class ReportOutput(OutputSpec):
    """An HTML page."""


@dataclass(frozen=True)
class FileOutput(OutputSpec):
    """A file of another kind. `suffixes`: the endings it may have; `file_filter`: as file dialogs take it, the first is the default."""

    suffixes: tuple = ()
    file_filter: str = ""


@dataclass(frozen=True)
class NumberOutput:
    """A number among the results."""

    name: str
    label: str


def number_refused(label, name, value, least, most):
    """What may be given, where a number may not be."""
    return tr("{label} ({name}) is {value}; it must be a number from {least:g} to {most:g}.").format(
        label=label, name=name, value=value, least=least, most=most)


def choice_refused(label, name, value, choices):
    """What may be given, where a choice may not be."""
    return tr("{label} ({name}) is {value}; it must be one of {choices}.").format(
        label=label, name=name, value=value, choices=", ".join(choices))
