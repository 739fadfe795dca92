"""Marks painted on a straight street, and the markings found in their points."""

from lanewright.core.markings.objects.cluster import cluster_markings
from painted_streets import drive, paint, road_points

FRAME = drive()


def layer_of(points, frame):
    """The layer of the markings in some points, and the clustered points."""
    markings, clustered = cluster_markings(points, frame)
    return markings.to_features(frame), clustered


def markings_of(marks, frame=FRAME, **kind):
    return layer_of(road_points(paint(frame, marks, **kind), frame), frame)[0]


def classes(markings):
    return sorted(markings.column("class"))
