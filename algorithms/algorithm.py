"""What all algorithms share: how they are declared and named.

An algorithm says its name, adds its parameters with the helpers below and
implements `work(call, progress)`; `call` (see call.py) hands it the values.
"""

from __future__ import annotations

import re
from collections import namedtuple
from dataclasses import dataclass, fields, replace
from importlib import import_module
from typing import Any, NamedTuple

from ..core.common import features
from ..core.common.setting import Choices, limits_of
from .texts import help_texts, tr

# In the order of the work
GROUPS = ("Survey", "Road", "Markings", "Driving", "Road map", "Export", "Inventory", "Assessment", "Orthoimages")
WARNINGS = "WARNINGS"  # a number that every run gives
TAGS_OF_ALL = ("mls", "mobile mapping", "lidar", "point cloud", "las", "laz", "road")


class Algorithm:
    """Base of every algorithm. Subclasses set the names below, add parameters and outputs in `declare()`, and do the work in `work(call, progress)`,
    which returns further results (numbers) by output name; all that users read of them stands in help.txt.

    parameters : list of ParameterSpec, inputs and outputs in the order of the dialog
    numbers : list of NumberOutput
    """

    ID = TITLE = GROUP = ""
    NUMBERS = ()  # names of numbers among the results
    RETIRED = ()  # names of parameters of an earlier version, which are accepted and have no effect
    WHOLE_MAP = False  # a run makes a map of its own, not one layer of one
    DRAWS = False  # it draws pages by QGIS, which does that in the thread of its window alone

    def __init__(self):
        self.parameters = []
        self.declare()
        self.numbers = [NumberOutput(name, tr(self._words(name)[0])) for name in (*self.NUMBERS, WARNINGS)]

    # -- what others ask --------------------------------------------------------------------

    def title(self):
        return tr(self.TITLE)

    def group(self):
        """The group in the user's language; QGIS sorts groups by name, and the number keeps them in the order of the work."""
        return f"{GROUPS.index(self.GROUP) + 1} {tr(self.GROUP)}"

    def summary(self):
        return tr(help_texts()[self.ID][0])

    def help_paragraphs(self):
        """The explanation below the summary."""
        return [tr(part) for part in help_texts()[self.ID][2:]]

    def tags(self):
        """Search words in the user's language and in English, which the field speaks everywhere."""
        tags = help_texts()[self.ID][1].removeprefix("Tags: ").split(", ")
        return list(dict.fromkeys((*map(tr, tags), *tags, *TAGS_OF_ALL)))

    def parameter(self, name):
        """The ParameterSpec of that name, None where there is none."""
        return next((spec for spec in self.parameters if spec.name == name), None)

    def inputs(self):
        return [spec for spec in self.parameters if not spec.is_output]

    def outputs(self):
        return [spec for spec in self.parameters if spec.is_output]

    # -- how subclasses declare -----------------------------------------------------------------

    def add(self, spec):
        """Add a parameter with the label and the help that help.txt has for it; what its help says already comes last."""
        label, *helps = self._words(spec.name, spec.settings)
        self.parameters.append(replace(spec, label=tr(label), help=" ".join(filter(None, (*map(tr, helps), spec.help)))))

    def _words(self, name, settings=""):
        """The paragraphs of help.txt for a parameter or number: its label, then its help."""
        texts = help_texts()
        return (texts.get(f"{self.ID} {name}") or texts.get(f"{settings.partition(':')[2]} {name}")
                or [*texts.get(name, []), *texts.get(f"{self.ID} + {name}", [])])

    def add_input(self, kind, name, **more):
        """Add an input of a kind; `more` are further attributes of ParameterSpec."""
        self.add(ParameterSpec(kind, name, **more))

    def add_map_layer(self, name, **more):
        self.add_input("layer", name, geometry=MAP_LAYERS[name].geometry, **more)

    def add_survey(self, trajectory_optional=False):
        """Point clouds, trajectory and the CRS for clouds that carry none."""
        self.add_input("clouds", "POINT_CLOUDS")
        self.add_trajectory(trajectory_optional)
        self.add_input("crs", "CRS", optional=True, advanced=True)

    def add_trajectory(self, optional=False):
        self.add_input("trajectory", "TRAJECTORY", optional=optional)

    def add_settings(self, specs, only=None, advanced=None):
        """Fields of a core Settings class, all or `only` those of the names given; what two stages share is asked for once."""
        for spec in specs:
            if (only is None or spec.name in only) and self.parameter(spec.name) is None:
                self.add(spec if advanced is None else replace(spec, advanced=advanced))

    def add_sink(self, name, fields=(), **more):
        """A vector output; the help lists its fields."""
        listed = "; ".join(f"{field.name} ({tr(field.alias)})" for field in fields)
        self.add_output("layer", name, help=tr("Fields: {fields}.", fields=listed) if fields else "", schema=tuple(fields), **more)

    def add_map_sink(self, name, **more):
        self.add_sink(name, MAP_LAYERS[name].schema, geometry=MAP_LAYERS[name].geometry, **more)

    def add_output(self, kind, name, **more):
        """Add a result of another kind; `more` are further attributes of OutputSpec."""
        self.add(OutputSpec(kind, name, **more))

    def add_report(self, optional=True):
        self.add_output("report", "REPORT", optional=optional)


# Typed parameters and outputs of the algorithms, for every program that runs them. A label ends with the unit, if there is one.

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
        raster, painted (polygons, lines or a raster), connection (the name of one to PostgreSQL), schema (of one)
    """

    kind: str
    name: str
    label: str = ""
    help: str = ""
    optional: bool = False
    advanced: bool = False   # a dialog shows it folded away
    default: Any = None   # what holds where nothing was given; None for nothing
    choices: tuple = ()   # words of a choice
    geometry: str = "any"   # of a layer, as in Features, or "any"
    of: str = ""   # the input whose rows an expression is about, or whose schema is asked for
    file_filter: str = ""   # of a file, as file dialogs take it

    settings = ""
    is_output = False


@dataclass(frozen=True)
class OutputSpec(ParameterSpec):
    """A result, of the kind layer, cloud (LAZ or LAS), raster (GeoTIFF), report (HTML), file, or folder (for several files)."""

    by_default: bool = True   # a dialog makes it unless told otherwise
    look: str = ""   # the result whose map style it has, where that is not its own name
    schema: tuple = ()   # fields of a layer, empty where they are not fixed
    suffixes: tuple = ()   # the endings that a file may have; the first of its `file_filter` is the default

    is_output = True


@dataclass(frozen=True)
class SettingSpec:
    """One field of a core Settings class as an input: the default, the limits and the choices are the core's.

    `words` are choices that it does not have. Where a number is a multiple of the core's, its maximum is so many `times` the core's.
    """

    name: str
    settings: str
    field: str
    label: str = ""
    help: str = ""
    words: tuple = ()
    times: float = 1.0
    advanced: bool = False

    is_output = False

    @property
    def default(self):
        owner = settings_class(self.settings)
        return None if owner is None else next(entry.default for entry in fields(owner) if entry.name == self.field)

    @property
    def choices(self):
        """The words of a choice; none where a package that knows them is missing."""
        owner = settings_class(self.settings)
        allowed = None if owner is None else limits_of(owner, self.field)
        return allowed.words if isinstance(allowed, Choices) else self.words

    @property
    def optional(self):
        """Also where a package that knows the default is missing: then that is what the user is told, and not that a number was left out."""
        return self.kind == "text" or settings_class(self.settings) is None

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


def settings_of(settings, names, **further):
    """The SettingSpecs of a core Settings class, `module:class`; label and help of each stand in help.txt.

    names : of the parameters, with spaces between them, in the order of the dialog, which folds those with a star behind them away; a parameter
        is the field of its name in small letters
    further : name to a dict of other attributes of its SettingSpec
    """
    return tuple(SettingSpec(**{"name": name, "settings": settings, "field": name.lower(), "advanced": star == "*", **further.get(name, {})})
                 for name, star in re.findall(r"(\w+)(\*?)", names))


NumberOutput = namedtuple("NumberOutput", "name label")   # a number among the results


def number_refused(label, name, value, least, most):
    """What may be given, where a number may not be."""
    return tr("{label} ({name}) is {value}; it must be a number from {least:g} to {most:g}.", label=label, name=name, value=value, least=least,
              most=most)


def choice_refused(label, name, value, choices):
    """What may be given, where a choice may not be."""
    return tr("{label} ({name}) is {value}; it must be one of {choices}.", label=label, name=name, value=value, choices=", ".join(choices))


# The layers of the road map: what each is called, its fields and its geometry, for every algorithm that takes or gives it.

class MapLayer(NamedTuple):
    """A layer of the road map; the geometry is that of Features."""

    label: str
    schema: tuple
    geometry: str


MAP_LAYERS = {name: MapLayer(help_texts()[name][0], getattr(features, name), geometry) for name, geometry in dict(
    SCANLINES="LineStringZM", CURB_POINTS="PointZ", ROAD_EDGES="LineStringZ", ROAD_SURFACE="PolygonZ", MARKINGS="PolygonZ",
    MARKING_LINES="LineStringZ", DRIVING_LINES="LineStringZ", LANES="PolygonZ", CURVE_ELEMENTS="None", PASSES="LineStringZ",
    ROADSIDE="LineStringZ", ROADSIDE_OBJECTS="PointZ", CROSS_SECTIONS="LineStringZ", SIGNALS="PointZ").items()}
