"""What was measured: trajectories imported and estimated, files inspected, a survey with known truth made."""

from ..core.common.features import CONTROL_POINTS, ESTIMATED_TRAJECTORY, TRAJECTORY
from ..core.lazy import np
from .algorithm import Algorithm, settings_of
from .survey_files import trajectory_features
from .survey_input import SURVEY_SETTINGS, imported_trajectory
from .texts import tr

TIME_SETTING = tuple(spec for spec in SURVEY_SETTINGS if spec.name == "TIME")


class ImportTrajectory(Algorithm):
    ID, TITLE, GROUP = "importtrajectory", "Import trajectory", "Survey"
    SUMMARY = "Reads the driven trajectory from a CSV or TXT file, an Applanix SBET, a log or track of a receiver, or a point or line layer."
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
        from ..core.survey.trajectory.trajectory import clean_trajectory

        trajectory = clean_trajectory(imported_trajectory(call, progress))
        for note in trajectory.notes:
            progress.info(note)
        for doubt in trajectory.doubts:
            progress.warn(doubt)
        if not trajectory.crs:
            progress.warn(tr("The trajectory names no CRS and none was given. Set CRS of the trajectory, or, where its coordinates are those of the "
                             "point clouds, CRS to bring it to."))
        progress.info(tr("Trajectory: {count} positions.").format(count=f"{len(trajectory):,}"))
        call.layer("OUTPUT", trajectory_features(trajectory))
        return {"ROWS": len(trajectory)}


SCANNER_SETTING = tuple(spec for spec in SURVEY_SETTINGS if spec.name == "SCANNER_FIELD")


class EstimateTrajectory(Algorithm):
    ID, TITLE, GROUP = "estimatetrajectory", "Estimate trajectory", "Survey"
    SUMMARY = "Where the scanner was, from the point clouds alone, for surveys that come without a trajectory."
    TAGS = ("trajectory", "no trajectory", "scanner position", "rotating mirror", "gps time")
    NUMBERS = (
        ("ROWS", tr("Positions")),
        ("LENGTH", tr("Length driven (m)")),
        ("SCANNERS", tr("Scanners that took part")),
        ("SIGMA", tr("Uncertainty of the place, median (m)")),
        ("SIGMA_Z", tr("Uncertainty of the height, median (m)")),
    )

    def declare(self):
        self.add_point_clouds()
        self.add_crs()
        self.add_settings(SCANNER_SETTING)
        self.add_sink("TRAJECTORY", tr("Trajectory"), fields=ESTIMATED_TRAJECTORY, geometry="PointZ")
        self.add_report()

    def work(self, call, progress):
        from ..core.survey.estimation.estimate import estimate_trajectory
        from ..products.report.survey import estimated_trajectory_report

        estimate = estimate_trajectory(call.point_clouds(), call.crs(), call.value("SCANNER_FIELD"), progress)
        for note in estimate.cloud_notes + estimate.notes:
            progress.warn(note)
        track = estimate.trajectory
        progress.info(estimate.summary())
        call.layer("TRAJECTORY", trajectory_features(track, sigma_m=estimate.sigma, sigma_z_m=estimate.sigma_height))
        call.text("REPORT", estimated_trajectory_report(estimate))
        values = len(track), estimate.length, len(estimate.scanners), float(np.median(estimate.sigma)), float(np.median(estimate.sigma_height))
        return {name: value for (name, _), value in zip(self.NUMBERS, values)}


INSPECTION_SETTINGS = settings_of("survey.INSPECTION_SETTINGS", "products.inspection:InspectionSettings", "CELL_SIZE*")


class InspectSurvey(Algorithm):
    ID, TITLE, GROUP = "inspectsurvey", "Inspect survey", "Survey"
    SUMMARY = "Reports what point clouds and trajectory contain, and whether they fit together, before any processing."
    TAGS = ("density", "report", "las", "header", "overlap")
    NUMBERS = (
        ("POINTS", tr("Points")),
        ("POINTS_PER_M2", tr("Points per m², mean of occupied cells")),
        ("POINTS_PER_M3", tr("Points per m³, mean of occupied cubes")),
        ("FIRST_TIME", tr("First gps_time (s)")),
        ("LAST_TIME", tr("Last gps_time (s)")),
        ("SCANNERS", tr("Scanners")),
        ("NEAR_TRAJECTORY", tr("Points near the trajectory (%)")),
        ("TIME_COVERED", tr("Scan time covered by the trajectory (%)")),
    )
    RETIRED = ("CUBE_SIZE",)

    def declare(self):
        self.add_survey(trajectory_optional=True)
        self.add_settings(INSPECTION_SETTINGS)
        self.add_report(optional=False)
        self.add_output("raster", "DENSITY", tr("Point density"), tr("Points per m² in every cell."), optional=True, by_default=False)

    def work(self, call, progress):
        from ..products.inspection import NEAR_TRAJECTORY, inspect_survey, write_density
        from ..products.report.survey import inspection_report

        inspection = inspect_survey(
            call.point_clouds(), call.trajectory(), call.settings(INSPECTION_SETTINGS), call.crs(), progress.part(0.0, 0.95))
        for note in inspection.notes:
            progress.warn(note)
        progress.info(tr("Survey: {count} points in {files} file(s), {density:.0f} points per m² where there are any, {scanners} scanner(s), "
                        "intensities {darkest} to {brightest}.").format(
            count=f"{inspection.count:,}", files=len(inspection.files), density=inspection.per_area["mean"], scanners=len(inspection.scanners),
            darkest=inspection.intensity.nonzero()[0].min(), brightest=inspection.intensity.nonzero()[0].max()))
        if inspection.near_share is not None:
            progress.info(tr("Trajectory: {near:.0f} % of the points lie within {metres:.0f} m of it.").format(
                near=100 * inspection.near_share, metres=NEAR_TRAJECTORY))
        call.text("REPORT", inspection_report(inspection))
        if call.wants("DENSITY"):
            write_density(inspection, call.new_file("DENSITY"))
        first, last = inspection.time_span or (None, None)
        values = (
            inspection.count, inspection.per_area["mean"], inspection.per_volume["mean"], first, last, len(inspection.scanners),
            _percent(inspection.near_share), _percent(inspection.in_time_share),
        )
        return {name: float(value) for (name, _), value in zip(self.NUMBERS, values) if value is not None}


def _percent(share):
    return None if share is None else 100.0 * share


SAMPLE_SETTINGS = settings_of("survey.SAMPLE_SETTINGS", "simulator.survey:SampleSettings",
    "SCENE LENGTH SEED SPEED* PULSE_RATE* ROTATION_RATE* RADIUS*", SPEED=dict(field="speed_kmh"), SCENE=dict(choices=(
        "street", "rural", "urban", "one-lane", "wide-lane", "no-centre-line", "hatched-island", "motorway", "serpentine", "crossing",
        "roundabout", "outskirts", "cycle-lanes")))

TRUTHS = (
    ("TRUTH_BOUNDARIES", "truth_boundaries", "LineStringZ", tr("True road boundaries")),
    ("TRUTH_MARKINGS", "truth_markings", "PolygonZ", tr("True markings")),
    ("TRUTH_DRIVING_LINES", "truth_driving_lines", "LineStringZ", tr("True driving lines")),
    ("TRUTH_SURFACE", "truth_surface", "PolygonZ", tr("True road surface")),
    ("TRUTH_LANES", "truth_lanes", "PolygonZ", tr("True lanes")),
    ("TRUTH_ROADSIDE", "truth_roadside", "LineStringZ", tr("True roadside")),
)


class SampleSurvey(Algorithm):
    ID, TITLE, GROUP = "samplesurvey", "Sample survey", "Survey"
    SUMMARY = "Simulates a mobile laser scanning survey of a street, motorway, junction or mountain road, together with its known truth."
    TAGS = ("sample", "simulation", "test data")
    NUMBERS = (("POINTS", tr("Points")),)
    RETIRED = ("MOUNT_YAW", "CURB_HEIGHT", "GUTTER")

    def declare(self):
        self.add_settings(SAMPLE_SETTINGS)
        self.add_input("crs", "CRS", tr("CRS of the survey"),
                       tr("A projected CRS in metres. The coordinates are the same in each; it only says where on earth they are."), optional=True,
                       advanced=True, default="EPSG:32650")
        self.add_output("cloud", "POINT_CLOUD", tr("Point cloud"))
        self.add_sink("TRAJECTORY", tr("Trajectory"), fields=TRAJECTORY, geometry="PointZ")
        for name, _, geometry, label in TRUTHS:
            self.add_sink(name, label, geometry=geometry, optional=True)
        self.add_output("raster", "UAV_IMAGE", tr("UAV image"),
                        tr("What a UAV sees of the first 150 m: a TIFF of 4 cm pixels without a place on the map, with the distortion of its camera "
                           "and the position tags of a drone. Propose control points and Georeference image find its place. There is none of "
                           "motorway, serpentine, crossing and roundabout."), optional=True, by_default=False)
        self.add_sink("UAV_GCPS", tr("Ground control points of the UAV image"), geometry="PointZ", optional=True, by_default=False,
                      fields=CONTROL_POINTS)

    def work(self, call, progress):
        from ..simulator.survey import make_sample_survey

        settings = call.settings(SAMPLE_SETTINGS, **({"crs": call.crs()} if call.crs() else {}))
        survey = make_sample_survey(settings, progress.part(0.0, 0.1))
        if call.wants("UAV_IMAGE") or call.wants("UAV_GCPS"):
            from ..simulator.orthophoto import seen_from_above

            seen_from_above(survey)
        count = survey.write_cloud(call.new_file("POINT_CLOUD"), progress.part(0.1, 0.9 if call.wants("UAV_IMAGE") else 1.0))
        progress.info(tr("Sample survey: {count} points along {length:.0f} m of road.").format(count=count, length=settings.length))
        if call.wants("UAV_IMAGE"):
            from ..simulator.orthophoto import write_uav_image

            write_uav_image(survey, call.new_file("UAV_IMAGE"), progress.part(0.9, 1.0))
        if call.wants("UAV_GCPS"):
            from ..simulator.orthophoto import uav_control_points

            call.layer("UAV_GCPS", uav_control_points(survey))
        call.layer("TRAJECTORY", trajectory_features(survey.trajectory))
        for name, attribute, _, _ in TRUTHS:
            call.layer(name, getattr(survey, attribute))
        return {"POINTS": count}
