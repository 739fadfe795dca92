"""A trajectory from any of the files and layers it comes in."""

from ...core.common.features import TRAJECTORY
from ..algorithm import Algorithm
from ..survey_input import SURVEY_SETTINGS, imported_trajectory
from ..texts import tr
from ..trajectory_source import trajectory_features

TIME_SETTING = tuple(spec for spec in SURVEY_SETTINGS if spec.name == "TIME")


class ImportTrajectory(Algorithm):
    ID, TITLE, GROUP = "importtrajectory", "Import trajectory", "Survey"
    SUMMARY = "Reads the driven trajectory from a CSV or TXT file, an Applanix SBET, a log or track of a receiver, or a point or line layer."
    HELP = (
        "Columns may come in any order, with or without a header, in degrees, radians or degrees with minutes and seconds. Rows are sorted by time; "
        "repeated and unusable rows are dropped and counted. The dialog shows what was understood of a file, and lets you assign its columns.\n\n"
        "Times are GPS seconds. Clock times are read where the file says what the clock shows: GPS time as it is, UTC with the leap seconds "
        "of its date. Days (modified Julian, Julian, and those of spreadsheets) are read as dates with clocks. Other clock times, and seconds since "
        "1970, are refused, as their leap seconds are unknown."
    )
    TAGS = ("trajectory", "sbet", "applanix", "csv", "gps time", "nmea", "gpx", "rtklib")
    NUMBERS = (("ROWS", tr("Positions")),)

    def declare(self):
        self.add_input("trajectory", "INPUT", tr("Trajectory file or layer"),
                       tr("A CSV or TXT file, an SBET (.out), a log (NMEA, RTKLIB, NovAtel), a GPX or KML track, or a layer of points or "
                          "lines with heights."))
        self.add_input(
            "columns", "COLUMNS", tr("Columns"),
            tr("Of a text file, one word a column from the left: time, x, y, z, roll, pitch, heading, lon, lat, or - for a column that is left out; "
               "such as time,y,x,z. A column of clock times is gps or utc, by what its clock shows, and week or date where these stand apart. Empty "
               "recognises them by their names, or by their numbers where they have none."), optional=True, default="")
        self.add_input("crs", "INPUT_CRS", tr("CRS of the trajectory"),
                       tr("Where the file does not say it. An SBET is in WGS 84 unless another is chosen."), optional=True)
        self.add_input("crs", "TARGET_CRS", tr("CRS to bring it to"),
                       tr("That of the point clouds. Empty takes it from the point clouds below, or leaves the trajectory as it is."), optional=True)
        self.add_input("clouds", "POINT_CLOUDS", tr("Point clouds"),
                       tr("With them the time system is distinguished, and the trajectory is written on the clouds' clock."), optional=True)
        self.add_settings(TIME_SETTING)
        self.add_sink("OUTPUT", tr("Imported trajectory"), fields=TRAJECTORY, geometry="PointZ")

    def work(self, call, progress):
        from ...core.survey.trajectory.trajectory import clean_trajectory

        trajectory = clean_trajectory(imported_trajectory(call, progress))
        for note in trajectory.notes:
            progress.info(note)
        for doubt in trajectory.doubts:
            progress.warn(doubt)
        if not trajectory.crs:
            progress.warn(tr("The trajectory names no CRS and none was given, so its layer has none: set CRS of the trajectory, or "
                             "CRS to bring it to where the coordinates are in that of the point clouds."))
        progress.info(tr("Trajectory: {count} positions.").format(count=f"{len(trajectory):,}"))
        call.layer("OUTPUT", trajectory_features(trajectory))
        return {"ROWS": len(trajectory)}
