"""What all algorithms share: how they are declared and named.

An algorithm says its name, adds its parameters with the helpers below and
implements `work(call, progress)`; `call` (see call.py) hands it the values.
"""

from dataclasses import replace

from .parameters import NumberOutput, OutputSpec, ParameterSpec
from .texts import tr

# In the order of the work
GROUPS = ("Survey", "Road", "Markings", "Driving", "Road map", "Export", "Inventory", "Assessment", "Orthoimages")
WARNINGS = "WARNINGS"  # a number that every run gives
TAGS_OF_ALL = ("mls", "mobile mapping", "lidar", "point cloud", "las", "laz", "road")


class Algorithm:
    """Base of every algorithm; subclasses set the texts below and write `declare` and `work`.

    parameters : list of ParameterSpec, inputs and outputs in the order of the dialog
    numbers : list of NumberOutput
    """

    ID = TITLE = GROUP = SUMMARY = ""
    TAGS = ()
    HELP = ""
    LOOKS = {}  # output -> the result whose map style it has, where that is not its own name
    NUMBERS = ()  # (name, label) of numbers among the results
    RETIRED = ()  # names of parameters of an earlier version, which are accepted and have no effect
    WHOLE_MAP = False  # a run makes a map of its own, not one layer of one
    DRAWS = False  # it draws pages by QGIS, which does that in the thread of its window alone
    NEEDS_GDAL = False  # it cannot run without GDAL's Python module, whatever is asked of it

    def __init__(self):
        self.parameters = []
        self.declare()
        self.numbers = [NumberOutput(name, tr(label)) for name, label in (*self.NUMBERS, (WARNINGS, tr("Warnings")))]

    def declare(self):
        """Add the parameters and outputs."""
        raise NotImplementedError

    def work(self, call, progress):
        """Do the work; returns further results (numbers) by output name."""
        raise NotImplementedError

    # -- what others ask --------------------------------------------------------------------

    def title(self):
        return tr(self.TITLE)

    def group(self):
        """The group in the user's language; QGIS sorts groups by name, and the number keeps them in the order of the work."""
        return f"{GROUPS.index(self.GROUP) + 1} {tr(self.GROUP)}"

    def summary(self):
        return tr(self.SUMMARY)

    def help_paragraphs(self):
        """The explanation below the summary."""
        return [tr(part) for part in self.HELP.split("\n\n") if part]

    def tags(self):
        """Search words in the user's language and in English, which the field speaks everywhere."""
        return list(dict.fromkeys((*(tr(tag) for tag in self.TAGS), *self.TAGS, *TAGS_OF_ALL)))

    def parameter(self, name):
        """The ParameterSpec of that name, None where there is none."""
        return next((spec for spec in self.parameters if spec.name == name), None)

    def inputs(self):
        return [spec for spec in self.parameters if not spec.is_output]

    def outputs(self):
        return [spec for spec in self.parameters if spec.is_output]

    # -- how subclasses declare -----------------------------------------------------------------

    def add(self, spec):
        """Add a parameter; a table of a module may have been made before the language was known."""
        self.parameters.append(replace(spec, label=tr(spec.label), help=tr(spec.help) if spec.help else spec.help))

    def add_input(self, kind, name, label, text, geometry="any", **more):
        """Add an input of a kind; `more` are further attributes of ParameterSpec."""
        self.add(ParameterSpec(kind, name, label, text, geometry=geometry, **more))

    def add_survey(self, trajectory_optional=False, without=""):
        """Point clouds, trajectory and the CRS for clouds that carry none; `without` says what happens without a trajectory."""
        self.add_point_clouds()
        self.add_trajectory(trajectory_optional, without)
        self.add_crs()

    def add_point_clouds(self):
        self.add_input("clouds", "POINT_CLOUDS", tr("Point clouds"), tr(
            "LAS, LAZ or COPC files of one survey, or a folder that holds them, or names with wildcards (/data/B12/tile_*.laz). Files may overlap "
            "and come in any order. Withheld points and noise (classes 7 and 18) are left out."))

    def add_trajectory(self, optional=False, without=""):
        text = tr("Where the vehicle drove: a point or line layer with heights, a table with columns time, x, y, z, or the path of a CSV, TXT or "
                  "SBET file. Made with Import trajectory it needs no further care.")
        self.add_input("trajectory", "TRAJECTORY", tr("Trajectory"), f"{text} {tr(without) if without else ''}".strip(), optional=optional)

    def add_crs(self):
        self.add_input("crs", "CRS", tr("CRS of the point clouds"),
                       tr("Only for point clouds that carry no CRS of their own, or contradict themselves; it is written into everything made from "
                          "them."), optional=True, advanced=True)

    def add_settings(self, specs, only=None, advanced=None):
        """Fields of a core Settings class, all or `only` those of the names given; what two stages share is asked for once."""
        for spec in specs:
            if (only is None or spec.name in only) and self.parameter(spec.name) is None:
                self.add(spec if advanced is None else replace(spec, advanced=advanced))

    def add_sink(self, name, label, text="", geometry="any", optional=False, by_default=True, fields=()):
        """A vector output; the help lists its fields."""
        listed = "; ".join(f"{field.name} ({tr(field.alias)})" for field in fields)
        text = " ".join(part for part in (text, tr("Fields: {fields}.").format(fields=listed) if fields else "") if part)
        self.add(OutputSpec("layer", name, label, text, optional, by_default=by_default, geometry=geometry, schema=tuple(fields)))

    def add_output(self, kind, name, label, text="", **more):
        """Add a result of another kind; `more` are further attributes of OutputSpec."""
        self.add(OutputSpec(kind, name, label, text, **more))

    def add_report(self, **more):
        self.add_output("report", "REPORT", tr("Report"), tr("A page with the numbers of every step and a picture."), **{"optional": True, **more})
