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
    """An input: what kind it is of, and how it is called and explained.

    kind : flag, choice, text, columns (roles of those of a table), expression (a condition on rows), crs (such as EPSG:32650);
        clouds (LAS, LAZ or COPC files), cloud, file, folder (which need not be there), layer, trajectory (a layer, or a CSV, TXT or SBET file),
        raster, painted (polygons, lines or a raster)
    """

    kind: str
    name: str
    label: str   # ends with the unit, if there is one
    help: str = ""
    optional: bool = False
    advanced: bool = False   # a dialog shows it folded away
    default: Any = None   # what holds where nothing was given; None for nothing
    choices: tuple = ()   # words of a choice
    geometry: str = "any"   # of a layer, as in Features, or "any"
    of: str = ""   # the input whose rows an expression is about
    file_filter: str = ""   # of a file, as file dialogs take it

    is_output = False


@dataclass(frozen=True)
class OutputSpec(ParameterSpec):
    """A result, of the kind layer, cloud (LAZ or LAS), raster (GeoTIFF), report (HTML) or file."""

    by_default: bool = True   # a dialog makes it unless told otherwise
    schema: tuple = ()   # fields of a layer, empty where they are not fixed
    suffixes: tuple = ()   # the endings that a file may have; the first of its `file_filter` is the default

    is_output = True


@dataclass(frozen=True)
class SettingSpec:
    """One field of a core Settings class as an input: the default and the limits are the core's, the words are ours.

    `choices` makes it a list of words. Where a number is a multiple of the core's, its maximum is so many `times` the core's.
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
        return None if owner is None else next(entry.default for entry in fields(owner) if entry.name == self.field)

    @property
    def optional(self):
        return self.kind == "text"

    @property
    def kind(self):
        """choice, flag, text, whole or number."""
        if self.choices:
            return "choice"
        return next((kind for type_, kind in ((bool, "flag"), (str, "text"), (int, "whole")) if isinstance(self.default, type_)), "number")

    def limits(self):
        """(least, most) of a number; None where a package that knows them is missing."""
        owner = settings_class(self.settings)
        if owner is None:
            return None
        allowed = limits_of(owner, self.field)
        return allowed.lowest, allowed.maximum * self.times


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
