"""What all algorithms share: how they are declared, guarded, run and how they fail.

An algorithm says its name, adds its parameters with the helpers below and
implements `work(call, progress)`; `call` (call.py) hands it the values.
"""

from qgis.core import (
    Qgis,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingOutputNumber,
    QgsProcessingParameterCrs,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterRasterDestination,
    QgsProcessingParameterRasterLayer,
)

from ..core.common.errors import Cancelled, RoadExtractionError
from ..core.common.parallel import heard
from .call import Call
from .dependencies import missing_packages
from .progress import FeedbackProgress
from .texts import tr
from .trajectory_source import accept_trajectory_file

# fileFilter is enforced and case-sensitive, and `extension=` accepts one suffix only
CLOUD_FILTER = "Point clouds (*.las *.laz *.LAS *.LAZ);;All files (*.*)"
LAZ_FILTER = "LAZ (*.laz);;LAS (*.las)"
HTML_FILTER = "HTML (*.html)"

# QGIS sorts the groups of the toolbox by name: the numbers keep them in the order of the work
ROOMS = ("Survey", "Road", "Markings", "Driving", "Road map", "Assessment", "Orthoimages")

SOURCES = {
    "PointZ": QgsProcessing.SourceType.TypeVectorPoint,
    "LineStringZ": QgsProcessing.SourceType.TypeVectorLine,
    "LineStringZM": QgsProcessing.SourceType.TypeVectorLine,
    "PolygonZ": QgsProcessing.SourceType.TypeVectorPolygon,
    "MultiLineStringZ": QgsProcessing.SourceType.TypeVectorLine,
    "MultiPolygonZ": QgsProcessing.SourceType.TypeVectorPolygon,
    "None": QgsProcessing.SourceType.TypeVector,
    "any": QgsProcessing.SourceType.TypeVector,
}


def with_help(parameter, text, advanced=False):
    """The parameter with its explanation, and moved to the dialog's advanced part if so wished."""
    parameter.setHelp(text)
    if advanced:
        parameter.setFlags(parameter.flags() | Qgis.ProcessingParameterFlag.Advanced)
    return parameter


def out_of_range(definitions, parameters):
    """What may be given, for the first number or choice that may not be; QGIS itself says only that it is incorrect."""
    for parameter in definitions:
        value = parameters.get(parameter.name())
        if value is None or parameter.checkValueIsAcceptable(value):
            continue
        if parameter.type() == "number":
            return tr("{label} ({name}) is {value}; it must be a number from {least:g} to {most:g}.").format(
                label=parameter.description(), name=parameter.name(), value=value, least=parameter.minimum(), most=parameter.maximum())
        if parameter.type() == "enum":
            return tr("{label} ({name}) is {value}; it must be one of {choices}.").format(
                label=parameter.description(), name=parameter.name(), value=value, choices=", ".join(parameter.options()))
    return ""


class LanewrightAlgorithm(QgsProcessingAlgorithm):
    """Base of every algorithm; subclasses set the five texts below and write `work`."""

    ID = TITLE = ROOM = SUMMARY = ""
    TAGS = ()
    HELP = ""
    TRAJECTORIES = ("TRAJECTORY",)  # inputs that may also be a file only the core can read
    LOOKS = {}  # output -> its entry in styling.LOOKS, where that is not its own name

    # -- what QGIS asks ---------------------------------------------------------------------

    def createInstance(self):
        return type(self)()

    def name(self):
        return self.ID

    def displayName(self):
        return tr(self.TITLE)

    def group(self):
        return f"{ROOMS.index(self.ROOM) + 1} {tr(self.ROOM)}"

    def groupId(self):
        return self.ROOM.lower().replace(" ", "")

    def shortDescription(self):
        return tr(self.SUMMARY)

    def helpUrl(self):
        """The page of the manual that the plugin itself shows; in a window only, where it can be shown."""
        return f"lanewright:{self.ID}"

    def tags(self):
        # In the user's language and in English, which the field speaks everywhere
        tags = *(tr(tag) for tag in self.TAGS), *self.TAGS, "mls", "mobile mapping", "lidar", "point cloud", "las", "laz", "road"
        return list(dict.fromkeys(tags))

    def shortHelpString(self):
        """The summary and every parameter's own help: written once, on the parameter."""
        lines = [f"<p>{tr(self.SUMMARY)}</p>"] + [f"<p>{tr(part)}</p>" for part in self.HELP.split("\n\n") if part]
        told = [p for p in self.parameterDefinitions() if p.help()]
        lines += [f"<p><b>{p.description()}</b><br>{p.help()}</p>" for p in told]
        return "\n".join(lines)

    def canExecute(self):
        missing = missing_packages()
        return (not missing, missing)

    def checkParameterValues(self, parameters, context):
        fine, said = super().checkParameterValues(accept_trajectory_file(self, parameters, context), context)
        return fine, said if fine else out_of_range(self.parameterDefinitions(), parameters) or said

    def processAlgorithm(self, parameters, context, feedback):
        # canExecute is asked by the desktop only
        missing = missing_packages()
        if missing:
            raise QgsProcessingException(missing)
        results, failure = self._run(Call(self, parameters, context, feedback), feedback)
        if failure:
            # QGIS never lets go of an exception: raised where the work was, it would keep all of the survey in memory
            raise QgsProcessingException(failure)
        return results

    def _run(self, call, feedback):
        """(results, "") of the work, or ({}, why there are none)."""
        try:
            call.check_destinations()
            progress = FeedbackProgress(feedback)
            with heard(progress):
                results = self.work(call, progress)
            return call.finish(results or {}), ""
        except RoadExtractionError as error:
            return {}, call.in_users_names(str(error))
        except Cancelled:
            return {}, tr("Cancelled")
        except OSError as error:
            if error.strerror is None:
                raise
            return {}, f"{error.strerror}: {error.filename or tr('while writing')}"
        except MemoryError:
            return {}, tr("Not enough memory for this step; close other programs or process fewer files at once.")
        finally:
            call.discard_unfinished()

    def work(self, call, progress):
        """Do the work; returns further results (numbers) by output name."""
        raise NotImplementedError

    # -- how subclasses declare -----------------------------------------------------------------

    def add(self, parameter, text="", advanced=False):
        self.addParameter(with_help(parameter, text, advanced))

    def add_survey(self, trajectory_optional=False):
        """Point clouds, trajectory and the CRS for clouds that carry none."""
        self.add(
            QgsProcessingParameterMultipleLayers("POINT_CLOUDS", tr("Point clouds"), QgsProcessing.SourceType.TypeFile),
            tr("LAS, LAZ or COPC files of one survey. Files may overlap and come in any order."),
        )
        self.add_trajectory(trajectory_optional)
        self.add_crs()

    def add_trajectory(self, optional=False):
        self.add(
            QgsProcessingParameterFeatureSource(
                "TRAJECTORY", tr("Trajectory"), [QgsProcessing.SourceType.TypeVector], optional=optional
            ),
            tr(
                "Where the vehicle drove: a point or line layer with heights, a table with columns time, x, y, z, or "
                "the path of a CSV, TXT or SBET file. Made with Import trajectory it needs no further care."
            ),
        )

    def add_crs(self):
        self.add(
            QgsProcessingParameterCrs("CRS", tr("CRS of the point clouds"), optional=True),
            tr("Only for point clouds that carry no CRS of their own; it is written into everything made from them."),
            advanced=True,
        )

    def add_cloud(self, name, label, text, optional=False):
        self.add(QgsProcessingParameterFile(name, label, fileFilter=CLOUD_FILTER, optional=optional), text)

    def add_layer(self, name, label, text, geometry="any", optional=False):
        self.add(QgsProcessingParameterFeatureSource(name, label, [SOURCES[geometry]], optional=optional), text)

    def add_layer_raster(self, name, label, text, optional=False):
        self.add(QgsProcessingParameterRasterLayer(name, label, optional=optional), text)

    def add_knobs(self, knobs, only=None):
        """The parameters of a core Settings class, with the defaults the core gives them."""
        for knob in knobs:
            if only is None or knob.name in only:
                self.addParameter(knob.parameter())

    def add_sink(self, name, label, text="", geometry="any", optional=False, by_default=True, fields=()):
        """A vector output; the help lists its fields."""
        listed = "; ".join(f"{field.name} ({tr(field.alias)})" for field in fields)
        text = " ".join(part for part in (text, tr("Fields: {fields}.").format(fields=listed) if fields else "") if part)
        self.add(QgsProcessingParameterFeatureSink(name, label, SOURCES[geometry], None, optional, by_default), text)

    def add_laz(self, name, label, text="", optional=False, by_default=True):
        self.add(QgsProcessingParameterFileDestination(name, label, LAZ_FILTER, None, optional, by_default), text)

    def add_raster(self, name, label, text="", optional=False, by_default=True):
        self.add(QgsProcessingParameterRasterDestination(name, label, None, optional, by_default), text)

    def add_number(self, name, label):
        """A number among the results."""
        self.addOutput(QgsProcessingOutputNumber(name, label))

    def add_report(self, name="REPORT", label=None, optional=True, by_default=True):
        label = label or tr("Report")
        self.add(
            QgsProcessingParameterFileDestination(name, label, HTML_FILTER, None, optional, by_default),
            tr("A page with the numbers of every step and a picture."),
        )
