"""The surveys that are timed: simulated streets, made once into build/bench/surveys.

    dense   200 m driven slowly under two fast scanners, 18.4 million points: as the thesis's largest data set
    long    2 km at a usual speed under slow scanners, about as many points, in tiles of a 250 m grid
    short   the first 200 m of such a street, to see whether memory grows with the road
    far     40 km: long twenty times end to end, made only where it is measured

dense is there as LAZ and as LAS. Points per metre of long, short and far are a tenth of dense's.
"""

import shutil

import numpy as np

from . import BUILD

SURVEYS = BUILD / "surveys"
TILE = 250.0     # m
DENSE = dict(length=200.0, pulse_rate=550_000.0, rotation_rate=200.0, speed_kmh=21.0)
SPARSE = dict(pulse_rate=120_000.0, rotation_rate=120.0)
COPIES = dict(full=20, quick=3)   # of long, which far consists of
SETTINGS = {
    "full": dict(dense=DENSE, long=dict(SPARSE, length=2000.0), short=dict(SPARSE, length=200.0)),
    "quick": dict(dense=dict(DENSE, length=40.0), long=dict(SPARSE, length=400.0), short=dict(SPARSE, length=40.0)),
}


def clouds_of(name, size="full", suffix="laz"):
    """Paths of a survey's point clouds, tiles in an order that has nothing to do with the road."""
    found = sorted((SURVEYS / size / name).glob(f"*.{suffix}"))
    return [found[k] for k in np.random.default_rng(7).permutation(len(found))]


def trajectory_of(name, size="full"):
    return SURVEYS / size / name / "trajectory.csv"


def make_surveys(size, say=print):
    """Make the surveys that are not there yet; each appears when it is whole."""
    from lanewright.simulator.survey import SampleSettings, make_sample_survey

    for name, settings in SETTINGS[size].items():
        folder = SURVEYS / size / name
        if (folder / "trajectory.csv").exists():
            continue
        say(f"Making the survey {name}: {settings['length']:g} m …")
        unfinished = folder.with_name(f"{name}.unfinished")
        shutil.rmtree(unfinished, ignore_errors=True)
        unfinished.mkdir(parents=True)
        sample = make_sample_survey(SampleSettings(**settings))
        sample.write_cloud(unfinished / "cloud.laz")
        if name == "dense":
            _copy(unfinished / "cloud.laz", unfinished / "cloud.las")
        if name == "long":
            _cut(unfinished / "cloud.laz")
        drive = sample.trajectory
        _write_trajectory(unfinished, np.c_[drive.time, drive.x, drive.y, drive.z, drive.roll, drive.pitch, drive.heading])
        shutil.rmtree(folder, ignore_errors=True)
        unfinished.rename(folder)


def make_far_survey(size, say=print):
    """Make the survey far if it is not there yet: each copy of long begins where the one before it ends, in place, height, heading and time."""
    folder, long = SURVEYS / size / "far", np.loadtxt(trajectory_of("long", size), delimiter=",", skiprows=1)
    if (folder / "trajectory.csv").exists():
        return
    say(f"Making the survey far: {COPIES[size]} × {SETTINGS[size]['long']['length']:g} m …")
    unfinished = folder.with_name("far.unfinished")
    shutil.rmtree(unfinished, ignore_errors=True)
    unfinished.mkdir(parents=True)
    first, last = long[0], long[-1]
    turn, lasts = np.radians(last[6] - first[6]), last[0] - first[0] + np.median(np.diff(long[:, 0]))
    start, drives = first[1:4], []
    for copy in range(COPIES[size]):
        place = _turned(first[1:4], start, copy * turn)
        drives.append(np.c_[long[:, 0] + copy * lasts, place(long[:, 1:4]), long[:, 4:6], (long[:, 6] + np.degrees(copy * turn)) % 360.0])
        for path in clouds_of("long", size):
            _move(path, unfinished / f"{path.stem}_{copy:02d}.laz", place, copy * lasts)
        start = drives[-1][-1, 1:4]
    _write_trajectory(unfinished, np.concatenate(drives))
    shutil.rmtree(folder, ignore_errors=True)
    unfinished.rename(folder)


def _turned(centre, onto, angle):
    """A motion of (N, 3) places: turned by an angle (radians, clockwise from above) about a place, which comes to lie on another one."""
    cos, sin = np.cos(angle), np.sin(angle)
    return lambda places: (places - centre) @ np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]) + onto


def _move(path, target, place, later):
    """A copy of a cloud, moved to another place and time."""
    import laspy

    with laspy.open(path) as reader, laspy.open(target, "w", header=reader.header) as writer:
        for points in reader.chunk_iterator(1_000_000):
            points.x, points.y, points.z = place(np.c_[points.x, points.y, points.z]).T
            points.gps_time = points.gps_time + later
            writer.write_points(points)


def _write_trajectory(folder, columns):
    np.savetxt(folder / "trajectory.csv", columns, "%.5f", ",", header="time,x,y,z,roll,pitch,heading", comments="")


def _copy(path, target):
    import laspy

    with laspy.open(path) as reader, laspy.open(target, "w", header=reader.header) as writer:
        for points in reader.chunk_iterator(1_000_000):
            writer.write_points(points)


def _cut(path):
    """The tiles of one cloud beside it, the cloud itself removed."""
    import laspy

    writers = {}
    with laspy.open(path) as reader:
        for points in reader.chunk_iterator(1_000_000):
            tiles = np.floor(np.c_[points.x, points.y] / TILE).astype(np.int64)
            for tile in np.unique(tiles, axis=0):
                name = path.with_name("tile_{}_{}.laz".format(*tile))
                if name not in writers:
                    writers[name] = laspy.open(name, "w", header=reader.header)
                writers[name].write_points(points[(tiles == tile).all(axis=1)])
    for writer in writers.values():
        writer.close()
    path.unlink()
