"""The trajectory of a survey that comes without one."""

from ...core.common.features import ESTIMATED_TRAJECTORY
from ..algorithm import Algorithm
from ..survey_input import SURVEY_SETTINGS
from ..texts import tr
from ..trajectory_source import trajectory_features

SCANNER_SETTING = tuple(spec for spec in SURVEY_SETTINGS if spec.name == "SCANNER_FIELD")


class EstimateTrajectory(Algorithm):
    ID, TITLE, GROUP = "estimatetrajectory", "Estimate trajectory", "Survey"
    SUMMARY = "Where the scanner was, from the point clouds alone, for surveys that come without a trajectory."
    HELP = (
        "Every return lies on the ray that the scanner's mirror had at its time. All rays together tell where the scanner was, how "
        "it was turned and how it is mounted; what stands along the road does not matter. This takes clouds from vehicles with "
        "rotating mirrors, whole, with the gps_time of every point; lines or points may be thinned out.\n\n"
        "The positions are those of the scanner, of the middle between several: where the vehicle's own trajectory refers to another "
        "place of the vehicle, the two differ by a constant arm. Heading, roll and pitch are relative to the way driven and the road. "
        "What a cloud is displaced by as a whole does not show in it, nor in the uncertainty.\n\n"
        "Heads of many beams that turn about an upright axis are known by their turns: their place is that from which every return lies in "
        "the direction of its time. Their height above the road is that from which every beam has one elevation, on whatever it falls; where too "
        "little stands beside the road to tell it, it is a usual one, known to 0.5 m, and the log says so.\n\n"
        "Without gps_time, or where no mirror is seen to turn, the track follows the density of the points: it is rough, half a metre "
        "off and with a height known to 0.3 m, and says so. Airborne, terrestrial and handheld clouds are refused, and so "
        "are those that lack the road under the vehicle and files of drives whose clocks overlap."
    )
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
        import numpy as np

        from ...core.survey.estimation import estimate_trajectory
        from ...products.report.survey import estimated_trajectory_report

        estimate = estimate_trajectory(call.point_clouds(), call.crs(), call.value("SCANNER_FIELD"), progress)
        for note in estimate.cloud_notes + estimate.notes:
            progress.warn(note)
        track = estimate.trajectory
        progress.info(estimate.summary())
        call.layer("TRAJECTORY", trajectory_features(track, sigma_m=estimate.sigma, sigma_z_m=estimate.sigma_height))
        call.text("REPORT", estimated_trajectory_report(estimate))
        values = len(track), estimate.length, len(estimate.scanners), float(np.median(estimate.sigma)), float(np.median(estimate.sigma_height))
        return {name: value for (name, _), value in zip(self.NUMBERS, values)}
