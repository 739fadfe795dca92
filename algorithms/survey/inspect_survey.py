"""What the files of a survey hold."""

from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..texts import tr

INSPECTION = "products.inspection:InspectionSettings"

INSPECTION_SETTINGS = (
    SettingSpec("CELL_SIZE", INSPECTION, "cell_size", tr("Cell of the density raster (m)"),
                tr("Smaller shows single scan lines, larger the broad picture."), advanced=True),
)


class InspectSurvey(Algorithm):
    ID, TITLE, GROUP = "inspectsurvey", "Inspect survey", "Survey"
    SUMMARY = "Reports what point clouds and trajectory contain, and whether they fit together, before any processing."
    HELP = "What the road map would stumble over, such as a geographic CRS or two clocks, is said with a way on."
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
        from ...products.inspection import NEAR_TRAJECTORY, inspect_survey, write_density
        from ...products.report.survey import inspection_report

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
