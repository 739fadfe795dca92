"""Drives and point clouds over known streets, for the tests of the survey."""

import laspy
import numpy as np
from lanewright.core.survey.trajectory.trajectory import Trajectory

EAST, NORTH = 500_000.0, 5_400_000.0
STREET_TIME = np.arange(0.0, 60.0, 0.1)  # s of a minute's drive


def straight(length, start=(0.0, 0.0), heading=0.0):
    """(N, 2) places 0.1 m apart along a straight, heading counter-clockwise from east in degrees."""
    along = np.arange(0.0, length, 0.1)
    angle = np.radians(heading)
    return np.c_[start[0] + along * np.cos(angle), start[1] + along * np.sin(angle)]


def arc(radius, turn, start=(0.0, 0.0), heading=0.0):
    """(N, 2) places 0.1 m apart along an arc that turns left by `turn` degrees (right where negative)."""
    angle, sign = np.radians(heading), np.sign(turn)
    swept = np.arange(0.0, radius * abs(np.radians(turn)), 0.1) / radius
    centre = np.array(start) + sign * radius * np.array([-np.sin(angle), np.cos(angle)])
    at = angle - sign * np.pi / 2 + sign * swept
    return centre + radius * np.c_[np.cos(at), np.sin(at)]


def chain(*pieces):
    """One path of pieces as `ahead` and `bend` give them; each begins where the last ended."""
    places, start, heading = [], np.zeros(2), 0.0
    for shape, turn in pieces:
        found = shape(start, heading)
        places.append(found)
        heading += turn
        start = found[-1] + 0.1 * np.array([np.cos(np.radians(heading)), np.sin(np.radians(heading))])
    return np.concatenate(places)


def ahead(length):
    return (lambda start, heading: straight(length, start, heading)), 0.0


def bend(radius, turn):
    return (lambda start, heading: arc(radius, turn, start, heading)), turn


def drive(path, speed=10.0, rate=50.0, start=1000.0, height=2.0, east=EAST, north=NORTH):
    """Trajectory of a vehicle along a path of places, `speed` m/s, `rate` rows a second, sensor `height` m above z = 100."""
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(path, axis=0).T))]
    time = np.arange(0.0, along[-1] / speed, 1.0 / rate)
    x, y = (np.interp(time * speed, along, c) for c in path.T)
    return Trajectory(time + start, x + east, y + north, np.full(len(time), 100.0 + height), crs="")


def joined(*drives):
    """One trajectory of several, in the order given."""
    return Trajectory(*(np.concatenate([getattr(d, name) for d in drives]) for name in ("time", "x", "y", "z")))


def standing(trajectory, seconds, rate=50.0, jitter=0.0, seed=5):
    """Rows of a vehicle that waits where `trajectory` ended, its position trembling by `jitter` metres."""
    rng = np.random.default_rng(seed)
    time = trajectory.time[-1] + np.arange(1, int(seconds * rate)) / rate
    tremble = np.cumsum(rng.normal(0.0, jitter, (2, len(time))), axis=1)
    tremble -= tremble * np.linspace(0, 1, len(time))  # comes back to where it stood
    return Trajectory(time, trajectory.x[-1] + np.clip(tremble[0], -0.3, 0.3), trajectory.y[-1] + np.clip(tremble[1], -0.3, 0.3),
                      np.full(len(time), trajectory.z[-1]))


def surveyed_points(trajectory, half_width=6.0, lines=10, across=0.5, curb=0.12):
    """x, y, z, time of points on a street along a trajectory: level, with sidewalks beyond `half_width` - 2 m."""
    count = int(2 * half_width / across) + 1
    offsets = np.linspace(-half_width, half_width, count)
    rows = np.arange(0, len(trajectory), max(1, len(trajectory) // (lines * 100)))
    heading = np.arctan2(np.gradient(trajectory.y), np.gradient(trajectory.x))[rows]
    x = trajectory.x[rows][:, None] - np.sin(heading)[:, None] * offsets
    y = trajectory.y[rows][:, None] + np.cos(heading)[:, None] * offsets
    z = np.broadcast_to(100.0 + curb * (np.abs(offsets) > half_width - 2.0), x.shape)
    time = trajectory.time[rows][:, None] + np.linspace(0, 1e-3, count)
    return x.ravel(), y.ravel(), z.ravel(), time.ravel()


def write_cloud(path, x, y, z, time=None, point_format=6, version="1.4", crs=None, adjusted=True, source=1, intensity=1000, channel=0):
    """A LAS or LAZ file of points; `time` None leaves gps_time zero."""
    header = laspy.LasHeader(point_format=point_format, version=version)
    header.scales, header.offsets = np.full(3, 0.001), np.floor([np.min(x), np.min(y), np.min(z)]) if len(x) else np.zeros(3)
    if crs:
        from pyproj import CRS

        header.add_crs(CRS.from_user_input(crs))
    if version >= "1.2":
        kind = laspy.header.GpsTimeType
        header.global_encoding.gps_time_type = kind.STANDARD if adjusted else kind.WEEK_TIME
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = x, y, z
    cloud.intensity = np.broadcast_to(np.asarray(intensity, np.uint16), len(x))
    cloud.point_source_id = np.broadcast_to(np.asarray(source, np.uint16), len(x))
    cloud.return_number = np.ones(len(x), np.uint8)
    cloud.number_of_returns = np.ones(len(x), np.uint8)
    names = set(cloud.point_format.dimension_names)
    if "gps_time" in names and time is not None:
        cloud.gps_time = time
    if "scanner_channel" in names:
        cloud.scanner_channel = np.broadcast_to(np.asarray(channel, np.uint8), len(x))
    cloud.write(str(path))
    return str(path)


def contents(survey):
    """All records of a survey in one fixed order, without what depends on how roads are cut into sections."""
    parts = [survey.section(road, number).records for road in survey.store.roads() for number in survey.store.sections(road)]
    records = np.concatenate(parts)
    return records[np.lexsort([records[name] for name in ("s", "z", "y", "x", "time")])]
