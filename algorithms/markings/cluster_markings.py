"""Paint gathered into markings."""

from ...core.common.features import MARKINGS
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import frame_of, paint_of
from ..texts import tr

CLUSTERS = "core.markings.objects.cluster:ClusterSettings"

CLUSTER_SETTINGS = (
    SettingSpec("DISTANCE", CLUSTERS, "distance", tr("Distance that joins points (m)"),
                tr("Larger joins worn paint into one marking, but also neighbouring markings; smaller keeps them apart.")),
)


class ClusterMarkings(Algorithm):
    ID, TITLE, GROUP = "clustermarkings", "Cluster markings", "Markings"
    SUMMARY = "Gathers paint into markings, measures them and tells lines from crossings, arrows and the rest."
    HELP = (
        "The field class is edge, lane or centre for lines, and zebra, stop, give_way (a row of equal blocks across a lane), zigzag (a "
        "line along the road that turns back again and again: no stopping), arrow, bicycle, bus (the word BUS, its letters one "
        "marking), hatch or symbol for what is no line. A bicycle or a word that is not clearly seen stays symbol. Far from the "
        "vehicle, points join over the distance between the tracks of the scan."
    )
    TAGS = ("road marking", "lane marking", "cluster", "give-way line", "zigzag line", "zebra crossing", "stop line", "arrow",
            "bicycle symbol", "bus lane")
    RETIRED = ("MIN_POINTS",)

    def declare(self):
        self.add_input("cloud", "MARKING_POINTS", tr("Marking points"), tr("The file written by Remove outliers or Extract markings."))
        self.add_trajectory()
        self.add_settings(CLUSTER_SETTINGS)
        self.add_sink("MARKINGS", tr("Markings"), fields=MARKINGS, geometry="PolygonZ")
        self.add_output("cloud", "CLUSTERED_POINTS", tr("Clustered points"), tr("The points with the extra field cluster."))

    def work(self, call, progress):
        from ...core.markings.objects.cluster import cluster_markings
        from ...core.survey.road_points_las import write_road_points

        points = paint_of(call, "MARKING_POINTS", progress.part(0.0, 0.2))
        frame = frame_of(call, points.crs, progress, points)
        markings, clustered = cluster_markings(points, frame, call.settings(CLUSTER_SETTINGS), progress.part(0.2, 0.9))
        write_road_points(clustered, call.new_file("CLUSTERED_POINTS"), progress.part(0.9, 1.0))
        call.layer("MARKINGS", markings.to_features(frame))
