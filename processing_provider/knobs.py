"""A core setting as a dialog's parameter: the default is the core's, the words are ours."""

from dataclasses import dataclass, fields
from importlib import import_module

from qgis.core import (
    Qgis,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterEnum,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

from ..core.common.setting import limits_of

DECIMALS = 3  # millimetres; QGIS would show six


def settings_class(path):
    """`road.curbs:CurbSettings` -> the class; None where a package it needs is missing."""
    module, name = path.split(":")
    try:
        return getattr(import_module(f"..core.{module}", __package__), name)
    except ImportError:
        return None


@dataclass(frozen=True)
class Knob:
    """One field of a core Settings class as a parameter.

    `unit` is what the label ends with: m, s, °, %, points, or "" for a count or ratio
    that the label explains itself. `choices` makes it a list of words. A number has the limits of the
    core; where the dialog also takes a multiple of it, its maximum is so many `times` the core's.
    """

    name: str
    settings: str
    field: str
    label: str
    help: str
    choices: tuple = ()
    times: float = 1.0
    advanced: bool = False

    def default(self):
        owner = settings_class(self.settings)
        if owner is None:
            return None
        return next(entry.default for entry in fields(owner) if entry.name == self.field)

    def parameter(self):
        default = self.default()
        if self.choices:
            parameter = QgsProcessingParameterEnum(
                self.name, self.label, list(self.choices), defaultValue=default, usesStaticStrings=True
            )
        elif isinstance(default, bool):
            parameter = QgsProcessingParameterBoolean(self.name, self.label, default)
        elif isinstance(default, str):
            parameter = QgsProcessingParameterString(self.name, self.label, default, optional=True)
        else:
            whole = isinstance(default, int)
            kind = QgsProcessingParameterNumber.Type.Integer if whole else QgsProcessingParameterNumber.Type.Double
            limits = {}
            if (owner := settings_class(self.settings)) is not None:
                found = limits_of(owner, self.field)
                limits = dict(minValue=found.lowest, maxValue=found.maximum * self.times)
            parameter = QgsProcessingParameterNumber(self.name, self.label, kind, default, **limits)
            if not whole:
                parameter.setMetadata({"widget_wrapper": {"decimals": DECIMALS}})
        parameter.setHelp(self.help)
        if self.advanced:
            parameter.setFlags(parameter.flags() | Qgis.ProcessingParameterFlag.Advanced)
        return parameter

    def value(self, algorithm, parameters, context):
        """What the user chose, in the type of the core's default."""
        if self.choices:
            return algorithm.parameterAsEnumString(parameters, self.name, context)
        default = self.default()
        if isinstance(default, bool):
            return algorithm.parameterAsBool(parameters, self.name, context)
        if isinstance(default, int):
            return algorithm.parameterAsInt(parameters, self.name, context)
        if isinstance(default, str):
            return algorithm.parameterAsString(parameters, self.name, context)
        return algorithm.parameterAsDouble(parameters, self.name, context)
