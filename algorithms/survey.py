"""What was measured: trajectories imported and estimated, files inspected, a survey with known truth made."""

from ..core.common.features import CONTROL_POINTS, ESTIMATED_TRAJECTORY, TRAJECTORY
from ..core.lazy import np
from .algorithm import Algorithm, settings_of
from .rooms import core, products, simulator
from .survey_input import SURVEY_SETTINGS, imported_trajectory, trajectory_features
from .texts import tr


class ImportTrajectory(Algorithm):
    ID, TITLE, GROUP = "importtrajectory", "Import trajectory", "Survey"
    NUMBERS = "ROWS".split()

    def declare(self):
        self.add_input("trajectory", "INPUT")
        self.add_input("columns", "COLUMNS", optional=True, default="")
        self.add_input("crs", "INPUT_CRS", optional=True)
        self.add_input("crs", "TARGET_CRS", optional=True)
        self.add_input("clouds", "POINT_CLOUDS", optional=True)
        self.add_settings(SURVEY_SETTINGS, only=("TIME",))
        self.add_sink("OUTPUT", fields=TRAJECTORY, geometry="PointZ")

    def work(self, call, progress):
        trajectory = core.survey.trajectory.trajectory.clean_trajectory(imported_trajectory(call, progress))
        for note in trajectory.notes:
            progress.info(note)
        progress.warn_all(trajectory.doubts)
        if not trajectory.crs:
            progress.warn(tr("The trajectory names no CRS and none was given. Set CRS of the trajectory, or, where its coordinates are those of the "
                             "point clouds, CRS to bring it to."))
        progress.info(tr("Trajectory: {count} positions.", count=f"{len(trajectory):,}"))
        call.layer("OUTPUT", trajectory_features(trajectory))
        return {"ROWS": len(trajectory)}


class EstimateTrajectory(Algorithm):
    ID, TITLE, GROUP = "estimatetrajectory", "Estimate trajectory", "Survey"
    NUMBERS = "ROWS LENGTH SCANNERS SIGMA SIGMA_Z".split()

    def declare(self):
        self.add_input("clouds", "POINT_CLOUDS")
        self.add_input("crs", "CRS", optional=True, advanced=True)
        self.add_settings(SURVEY_SETTINGS, only=("SCANNER_FIELD",))
        self.add_sink("TRAJECTORY", fields=ESTIMATED_TRAJECTORY, geometry="PointZ")
        self.add_report()

    def work(self, call, progress):
        estimate = core.survey.estimation.estimate.estimate_trajectory(call.point_clouds(), call.crs(), call.value("SCANNER_FIELD"), progress)
        progress.warn_all(estimate.cloud_notes + estimate.notes)
        track = estimate.trajectory
        progress.info(estimate.summary())
        call.layer("TRAJECTORY", trajectory_features(track, sigma_m=estimate.sigma, sigma_z_m=estimate.sigma_height))
        call.text("REPORT", products.report.survey.estimated_trajectory_report(estimate))
        values = len(track), estimate.length, len(estimate.scanners), float(np.median(estimate.sigma)), float(np.median(estimate.sigma_height))
        return dict(zip(self.NUMBERS, values))


INSPECTION_SETTINGS = settings_of("products.inspection:InspectionSettings", "CELL_SIZE*")


class InspectSurvey(Algorithm):
    ID, TITLE, GROUP = "inspectsurvey", "Inspect survey", "Survey"
    NUMBERS = "POINTS POINTS_PER_M2 POINTS_PER_M3 FIRST_TIME LAST_TIME SCANNERS NEAR_TRAJECTORY TIME_COVERED".split()
    RETIRED = ("CUBE_SIZE",)

    def declare(self):
        self.add_survey(trajectory_optional=True)
        self.add_settings(INSPECTION_SETTINGS)
        self.add_report(optional=False)
        self.add_output("raster", "DENSITY", optional=True, by_default=False)

    def work(self, call, progress):
        inspection = products.inspection.inspect_survey(
            call.point_clouds(), call.trajectory(), call.settings(INSPECTION_SETTINGS), call.crs(), progress.part(0.0, 0.95))
        progress.warn_all(inspection.notes)
        progress.info(tr("Survey: {count} points in {files} file(s), {density:.0f} points per m² where there are any, {scanners} scanner(s), "
                         "intensities {darkest} to {brightest}.", count=f"{inspection.count:,}", files=len(inspection.files),
                         density=inspection.per_area["mean"], scanners=len(inspection.scanners), darkest=inspection.intensity.nonzero()[0].min(),
                         brightest=inspection.intensity.nonzero()[0].max()))
        if inspection.near_share is not None:
            progress.info(tr("Trajectory: {near:.0f} % of the points lie within {metres:.0f} m of it.", near=100 * inspection.near_share,
                             metres=products.inspection.NEAR_TRAJECTORY))
        call.text("REPORT", products.report.survey.inspection_report(inspection))
        if call.wants("DENSITY"):
            products.inspection.write_density(inspection, call.new_file("DENSITY"))
        first, last = inspection.time_span or (None, None)
        values = (
            inspection.count, inspection.per_area["mean"], inspection.per_volume["mean"], first, last, len(inspection.scanners),
            *(None if share is None else 100.0 * share for share in (inspection.near_share, inspection.in_time_share)),
        )
        return {name: float(value) for name, value in zip(self.NUMBERS, values) if value is not None}


SAMPLE_SETTINGS = settings_of("simulator.survey:SampleSettings", "SCENE LENGTH SEED SPEED* PULSE_RATE* ROTATION_RATE* RADIUS*",
    SPEED=dict(field="speed_kmh"), SCENE=dict(words=(
        "street", "rural", "urban", "one-lane", "wide-lane", "no-centre-line", "hatched-island", "motorway", "serpentine", "crossing",
        "roundabout", "outskirts", "cycle-lanes")))

TRUTHS = {"TRUTH_BOUNDARIES": "LineStringZ", "TRUTH_MARKINGS": "PolygonZ", "TRUTH_DRIVING_LINES": "LineStringZ", "TRUTH_SURFACE": "PolygonZ",
          "TRUTH_LANES": "PolygonZ", "TRUTH_ROADSIDE": "LineStringZ"}   # result -> geometry


class SampleSurvey(Algorithm):
    ID, TITLE, GROUP = "samplesurvey", "Sample survey", "Survey"
    NUMBERS = "POINTS".split()
    RETIRED = ("MOUNT_YAW", "CURB_HEIGHT", "GUTTER")

    def declare(self):
        self.add_settings(SAMPLE_SETTINGS)
        self.add_input("crs", "CRS", optional=True, advanced=True, default="EPSG:32650")
        self.add_output("cloud", "POINT_CLOUD")
        self.add_sink("TRAJECTORY", fields=TRAJECTORY, geometry="PointZ")
        for name, geometry in TRUTHS.items():
            self.add_sink(name, geometry=geometry, optional=True)
        self.add_output("raster", "UAV_IMAGE", optional=True, by_default=False)
        self.add_sink("UAV_GCPS", geometry="PointZ", optional=True, by_default=False, fields=CONTROL_POINTS)

    def work(self, call, progress):
        settings = call.settings(SAMPLE_SETTINGS, **({"crs": call.crs()} if call.crs() else {}))
        survey = simulator.survey.make_sample_survey(settings, progress.part(0.0, 0.1))
        if call.wants("UAV_IMAGE") or call.wants("UAV_GCPS"):
            simulator.orthophoto.seen_from_above(survey)
        count = survey.write_cloud(call.new_file("POINT_CLOUD"), progress.part(0.1, 0.9 if call.wants("UAV_IMAGE") else 1.0))
        progress.info(tr("Sample survey: {count} points along {length:.0f} m of road.", count=count, length=settings.length))
        if call.wants("UAV_IMAGE"):
            simulator.orthophoto.write_uav_image(survey, call.new_file("UAV_IMAGE"), progress.part(0.9, 1.0))
        if call.wants("UAV_GCPS"):
            call.layer("UAV_GCPS", simulator.orthophoto.uav_control_points(survey))
        call.layer("TRAJECTORY", trajectory_features(survey.trajectory))
        for name in TRUTHS:
            call.layer(name, getattr(survey, name.lower()))
        return {"POINTS": count}
