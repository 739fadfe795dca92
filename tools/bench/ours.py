"""What of ours is timed: each function works on the surveys of a size and returns its figures as a dict."""

import resource
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from .prepare import prepared
from .surveys import clouds_of, trajectory_of

SECONDS = ("wall", "cpu")


def timed(work):
    """(result, dict of wall and CPU seconds)."""
    began = time.perf_counter(), time.process_time()
    result = work()
    return result, dict(wall=time.perf_counter() - began[0], cpu=time.process_time() - began[1])


def threads_alone():
    """Have this process do without worker processes, however many points there are."""
    from lanewright.core.execution import choice

    choice.EXECUTION = replace(choice.EXECUTION, worker_points=float("inf"))


def peak_mib():
    """The highest resident memory of this process so far."""
    status = Path("/proc/self/status")  # getrusage would tell the parent's where that was higher
    if status.exists():
        return next(int(line.split()[1]) for line in status.read_text().splitlines() if line.startswith("VmHWM")) / 2**10
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10


def read(size, survey="dense"):
    """laspy's own read of the LAZ of a survey in blocks of 100,000 points: the floor."""
    import laspy

    def count():
        points = 0
        for path in clouds_of(survey, size):
            with laspy.open(path) as reader:
                points += sum(len(block.x) for block in reader.chunk_iterator(100_000))
        return points

    points, seconds = timed(count)
    return dict(seconds, points=points)


def placing(size):
    """Station and offset of points that are decoded already, from their raw coordinates and times."""
    from lanewright.core.common.parallel import ordered_map
    from lanewright.core.survey.blocks import DECODED_LAYERS
    from lanewright.core.survey.frame.projection import RoadProjection
    from lanewright.core.survey.frame.road_frame import build_frame
    from lanewright.core.survey.las.reader import read_blocks
    from lanewright.core.survey.trajectory.reader import read_trajectory
    from lanewright.core.survey.weights import FRAME, LAS

    blocks = [block for path in clouds_of("dense", size) for block in read_blocks(str(path), LAS.points_per_block, DECODED_LAYERS)]
    frame = build_frame(read_trajectory(trajectory_of("dense", size)))

    def place(block):
        x, y = (block.array[name] * scale + (offset - origin)
                for name, scale, offset, origin in zip("XY", block.scales, block.offsets, frame.origin))
        _, _, d = places.project(x, y, np.ascontiguousarray(block.array["gps_time"]))
        return int(np.isfinite(d).sum())

    places = RoadProjection(frame, FRAME.corridor)
    points, seconds = timed(lambda: sum(ordered_map(place, blocks)))
    return dict(seconds, points=points)


def storing(size):
    """Points that are decoded already into the sections of the road frame, ready for the next stage."""
    from lanewright.core.survey import blocks as reading
    from lanewright.core.survey.blocks import DECODED_LAYERS
    from lanewright.core.survey.las.reader import read_blocks
    from lanewright.core.survey.open_survey import open_survey
    from lanewright.core.survey.trajectory.reader import read_trajectory
    from lanewright.core.survey.weights import LAS

    clouds, trajectory = clouds_of("dense", size), read_trajectory(trajectory_of("dense", size))
    decoded = {str(path): list(read_blocks(str(path), LAS.points_per_block, DECODED_LAYERS)) for path in clouds}

    class Decoded:
        """Stands in for the readers of the files."""

        def __init__(self, layers):
            pass

        def ranges(self, files, size):
            return ((number, k * size, len(block)) for number, file in enumerate(files) for k, block in enumerate(decoded[file.path]))

        def points(self, file, first, count, size):
            return (decoded[file.path][first // size],)

    reading.ParallelCloudReader = Decoded
    threads_alone()
    survey, seconds = timed(lambda: open_survey(clouds, trajectory))
    return dict(seconds, points=survey.store.count)


def scanlines(size):
    """Normalized scanlines in memory, and the boundaries found on them, after the survey was read."""
    from lanewright.core.road.detect_boundaries import BoundarySettings, find_curb_points
    from lanewright.core.survey.open_survey import open_survey
    from lanewright.core.survey.trajectory.reader import read_trajectory

    threads_alone()
    survey = open_survey(clouds_of("dense", size), read_trajectory(trajectory_of("dense", size)))
    for road in survey.store.roads():
        for section in survey.store.sections(road):  # put in order when they are first read
            survey.section(road, section)
    found, seconds = timed(lambda: find_curb_points(survey, BoundarySettings(method="scanlines"))["scanlines"])
    return dict(seconds, corners=len(found))


def image_ours(size):
    """Road points of 50 m in memory to the 4 cm intensity image by inverse distance alone, as gdal_grid does it."""
    from lanewright.core.intensity.image import ImageSettings, make_intensity_image
    from lanewright.core.survey.road_points_las import read_road_points

    points, target = read_road_points(prepared("strip.laz", size)), prepared("ours.tif", size)
    for key in points.all_sections():
        points.section(*key)
    _, seconds = timed(lambda: make_intensity_image(points, ImageSettings(beta=0.0), path=target).close())
    return dict(seconds, points=len(points))


def sor_ours(size):
    """Outliers of a million points by one limit for all, 20 neighbours."""
    from lanewright.core.markings.outliers import OutlierSettings, remove_outliers

    points = _paint(size)
    kept, seconds = timed(lambda: remove_outliers(points, OutlierSettings(scope="all")))
    mask = np.zeros(len(points), bool)
    mask[kept.all_points().time.astype(np.int64)] = True
    np.save(prepared("sor_ours.npy", size), mask)
    return dict(seconds, points=len(points), kept=len(kept))


def clusters_ours(size):
    """Which of a million points on paint belong together."""
    from lanewright.core.execution.in_step import in_step
    from lanewright.core.execution.phase import THREADS
    from lanewright.core.markings.objects.cluster import ClusterSettings
    from lanewright.core.markings.objects.grouping import connected_points
    from lanewright.core.survey.store.road_points import columns_of_roads

    points = _paint(size)
    road = points.roads()[0]
    ((labels, *_),), seconds = timed(lambda: in_step([connected_points(points, ClusterSettings.distance)], THREADS))
    clusters = np.empty(len(labels), np.int64)
    clusters[columns_of_roads(points.store, [road], ("time",))["time"].astype(np.int64)] = labels
    np.save(prepared("clusters_ours.npy", size), clusters)
    return dict(seconds, points=len(labels), clusters=len(np.unique(labels)))


def _paint(size):
    """The prepared million, in memory and in order."""
    from lanewright.core.survey.road_points_las import read_road_points

    points = read_road_points(prepared("paint.laz", size))
    for key in points.all_sections():
        points.section(*key)
    return points
