"""The surveys that are timed: simulated streets, made once into build/bench/surveys.

    dense   200 m driven slowly under two fast scanners, 18.4 million points: as the thesis's largest data set
    long    2 km at a usual speed under slow scanners, about as many points, in tiles of a 250 m grid
    short   the first 200 m of such a street, to see whether memory grows with the road

dense is there as LAZ and as LAS. Points per metre of long and short are a tenth of dense's.
"""

import shutil

import numpy as np

from . import BUILD

SURVEYS = BUILD / "surveys"
TILE = 250.0     # m
DENSE = dict(length=200.0, pulse_rate=550_000.0, rotation_rate=200.0, speed_kmh=21.0)
SPARSE = dict(pulse_rate=120_000.0, rotation_rate=120.0)
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
    from lanewright.core.sample.survey import SampleSettings, make_sample_survey

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
        np.savetxt(unfinished / "trajectory.csv", np.c_[drive.time, drive.x, drive.y, drive.z, drive.roll, drive.pitch, drive.heading],
                   "%.5f", ",", header="time,x,y,z,roll,pitch,heading", comments="")
        shutil.rmtree(folder, ignore_errors=True)
        unfinished.rename(folder)


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
