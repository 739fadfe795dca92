"""Intensity freed of range and incidence."""

from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import bright_road_points_of, frame_of
from ..texts import tr

INTENSITY = "core.intensity.correction:IntensitySettings"

INTENSITY_SETTINGS = (
    SettingSpec("SCALE", INTENSITY, "scale", tr("Scale of the intensities"),
                tr("Linear ones are multiplied, logarithmic ones added to. Automatic goes by the spread of asphalt; choose one when the report names "
                   "the wrong one."), choices=("automatic", "linear", "logarithmic"), advanced=True),
)


class CorrectIntensity(Algorithm):
    ID, TITLE, GROUP = "correctintensity", "Correct intensity", "Markings"
    SUMMARY = "Evens out the fall of intensity with range and incidence, scanner by scanner, from the road's own asphalt."
    HELP = "The raw intensity stays as it was; the corrected one is the extra field intensity_corrected, which later stages prefer."
    TAGS = ("intensity", "range correction", "calibration")

    def declare(self):
        self.add_input("cloud", "ROAD_POINTS", tr("Road points"), tr("The file written by Extract road surface."))
        self.add_trajectory()
        self.add_settings(INTENSITY_SETTINGS)
        self.add_output("cloud", "OUTPUT", tr("Corrected road points"))
        self.add_report()

    def work(self, call, progress):
        from ...core.intensity.correction import correct_intensity
        from ...core.survey.road_points_las import write_road_points
        from ...products.report.page import html_page

        road_points = bright_road_points_of(call, "ROAD_POINTS", progress.part(0.0, 0.2))
        frame = frame_of(call, road_points.crs, progress, road_points)
        corrected, report = correct_intensity(road_points, frame, call.settings(INTENSITY_SETTINGS), progress.part(0.2, 0.8))
        write_road_points(corrected, call.new_file("OUTPUT"), progress.part(0.8, 1.0))
        for line in report.lines()[1:]:  # the first was said when it was found, as was a warning
            if line != report.saturation_warning:
                progress.info(line)
        call.text("REPORT", html_page("intensity_correction", found=report))
