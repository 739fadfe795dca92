"""A trajectory from any of the files and layers it comes in."""

from qgis.core import QgsProcessing, QgsProcessingParameterCrs, QgsProcessingParameterFeatureSource, QgsProcessingParameterMultipleLayers

from ...core.common.schemas import TRAJECTORY
from ..algorithm import LanewrightAlgorithm
from ..survey_input import SURVEY_KNOBS, imported_trajectory
from ..texts import tr
from ..trajectory_source import trajectory_features

TIME_KNOB = tuple(knob for knob in SURVEY_KNOBS if knob.name == "TIME")


class ImportTrajectory(LanewrightAlgorithm):
    ID, TITLE, ROOM = "importtrajectory", "Import trajectory", "Survey"
    SUMMARY = "Reads the driven trajectory from a CSV or TXT file, an Applanix SBET, or a point or line layer."
    HELP = (
        "Columns may come in any order, with or without a header, in degrees or radians. Rows are sorted by time; "
        "repeated and unusable rows are dropped and counted."
    )
    TAGS = ("trajectory", "sbet", "applanix", "csv", "gps time")

    TRAJECTORIES = ("INPUT",)

    def initAlgorithm(self, configuration=None):
        self.add(
            QgsProcessingParameterFeatureSource("INPUT", tr("Trajectory file or layer"), [QgsProcessing.SourceType.TypeVector]),
            tr("A CSV or TXT file, an SBET (.out), or a layer of points or lines with heights."),
        )
        self.add(
            QgsProcessingParameterCrs("INPUT_CRS", tr("CRS of the trajectory"), optional=True),
            tr("Where the file does not say it. An SBET is in WGS 84 unless another is chosen."),
        )
        self.add(
            QgsProcessingParameterCrs("TARGET_CRS", tr("CRS to bring it to"), optional=True),
            tr("That of the point clouds. Empty takes it from the point clouds below, or leaves the trajectory as it is."),
        )
        self.add(
            QgsProcessingParameterMultipleLayers(
                "POINT_CLOUDS", tr("Point clouds"), QgsProcessing.SourceType.TypeFile, optional=True
            ),
            tr("With them the time system is told apart, and the trajectory is written on the clouds' clock."),
        )
        self.add_knobs(TIME_KNOB)
        self.add_sink("OUTPUT", tr("Imported trajectory"), fields=TRAJECTORY, geometry="PointZ")
        self.add_number("ROWS", tr("Positions"))

    def work(self, call, progress):
        from ...core.survey.trajectory.trajectory import clean_trajectory

        trajectory = clean_trajectory(imported_trajectory(call, progress))
        for note in trajectory.notes:
            progress.say(note)
        if not trajectory.crs:
            progress.warn(tr("The trajectory names no CRS and none was given, so its layer has none: set CRS of the trajectory, or "
                             "CRS to bring it to where the coordinates are in that of the point clouds."))
        progress.say(tr("Trajectory: {count} positions.").format(count=f"{len(trajectory):,}"))
        call.layer("OUTPUT", trajectory_features(trajectory))
        return {"ROWS": len(trajectory)}
