"""Lone points taken out of paint."""

from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import paint_of
from ..texts import tr

OUTLIERS = "core.markings.outliers:OutlierSettings"

OUTLIER_SETTINGS = (
    SettingSpec("NEIGHBOURS", OUTLIERS, "neighbours", tr("Nearest points looked at (points)"),
                tr("More judges by a wider neighbourhood and removes small clumps too; fewer removes single points only.")),
    SettingSpec("STD_RATIO", OUTLIERS, "std_ratio", tr("Allowed distance above the mean (σ)"),
                tr("Smaller removes more, first where points are sparse; larger keeps far paint, and some noise with it.")),
    SettingSpec("SCOPE", OUTLIERS, "scope", tr("Statistics over"),
                tr("All compares every point with the whole file, as PCL does, and eats sparse paint far from the scanner; windows compares it with "
                   "its own stretch of the road."), choices=("all", "windows")),
)


class RemoveOutliers(Algorithm):
    ID, TITLE, GROUP = "removeoutliers", "Remove outliers", "Markings"
    SUMMARY = "Statistical outlier removal: points that lie farther from their neighbours than is usual go."
    TAGS = ("outlier", "noise", "sor")

    def declare(self):
        self.add_input("cloud", "INPUT", tr("Marking points"), tr("The file written by Extract markings."))
        self.add_settings(OUTLIER_SETTINGS)
        self.add_output("cloud", "OUTPUT", tr("Marking points without outliers"))

    def work(self, call, progress):
        from ...core.markings.outliers import remove_outliers
        from ...core.survey.road_points_las import write_road_points

        points = paint_of(call, "INPUT", progress.part(0.0, 0.3))
        settings = call.settings(OUTLIER_SETTINGS)
        kept = remove_outliers(points, settings, progress.part(0.3, 0.8)) if len(points) else points
        write_road_points(kept, call.new_file("OUTPUT"), progress.part(0.8, 1.0))
