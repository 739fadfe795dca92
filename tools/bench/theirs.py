"""The same work by the programs people know: each function returns its figures as a dict, or {"missing": why}."""

import os
import shutil
import subprocess

import numpy as np
from peers import gdal_grid, open3d_peer, pcl
from peers.pcl import PeerMissing

from .prepare import prepared


def install(say=print):
    """Install the peers that are not here; those that cannot be are told of, and left out of the table."""
    try:
        open3d_peer.install()
    except PeerMissing as why:
        say(str(why))
    try:
        for program in ("sor", "clustering"):
            pcl.build(program)
    except PeerMissing as why:
        try:
            _unpack_pcl()
        except (PeerMissing, subprocess.CalledProcessError) as still:
            say(str(still) if isinstance(still, PeerMissing) else str(why))


def _unpack_pcl():
    if shutil.which("apt-get") is None:
        raise PeerMissing("There is no apt-get here, so PCL is not installed and left out.")
    if not shutil.which("g++"):
        if os.geteuid():
            raise PeerMissing("PCL's programs need a compiler: apt-get install g++, as root.")
        subprocess.run(["apt-get", "install", "-y", "-q", "--no-install-recommends", "g++"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([str(pcl.SOURCES / "unpack_pcl.sh")], check=True)
    for program in ("sor", "clustering"):
        pcl.build(program)


def image_gdal(size):
    """gdal_grid's inverse distance in the cells of our image."""
    from lanewright.core.intensity.image import ImageSettings

    radius = ImageSettings.radius_cells * ImageSettings.cell_size
    return gdal_grid.inverse_distance(prepared("strip.fgb", size), prepared("gdal.tif", size), prepared("strip.tif", size), radius,
                                      ImageSettings.power, len(os.sched_getaffinity(0)))


def sor_pcl(size):
    from lanewright.core.markings.outliers import OutlierSettings

    return _outliers("pcl", size, *pcl.outliers(_places(size), OutlierSettings.neighbours, OutlierSettings.std_ratio))


def sor_open3d(size):
    from lanewright.core.markings.outliers import OutlierSettings

    return _outliers("open3d", size, *open3d_peer.outliers(_places(size), OutlierSettings.neighbours, OutlierSettings.std_ratio))


def _outliers(name, size, kept, seconds):
    np.save(prepared(f"sor_{name}.npy", size), kept)
    return dict(_seconds(seconds), kept=int(kept.sum()))


def clusters_pcl(size):
    from lanewright.core.markings.objects.cluster import ClusterSettings

    return _clusters("pcl", size, *pcl.clusters(_plan(size), ClusterSettings.distance))


def clusters_open3d(size):
    from lanewright.core.markings.objects.cluster import ClusterSettings

    return _clusters("open3d", size, *open3d_peer.clusters(_plan(size), ClusterSettings.distance))


def _clusters(name, size, labels, seconds):
    np.save(prepared(f"clusters_{name}.npy", size), labels)
    return dict(_seconds(seconds), clusters=len(np.unique(labels)))


def _seconds(said):
    return dict(said) if isinstance(said, dict) else dict(cpu=said)


def _places(size):
    """(N, 3) metres near 0, so that the float32 of PCL keeps them to the tenth of a millimetre."""
    places = np.load(prepared("paint.npy", size))[:, :3]
    return places - places.mean(axis=0).round()


def _plan(size):
    """(N, 3) station and offset, stretched until near is a circle: quicker for PCL than a condition on a wider search."""
    from lanewright.core.markings.weights import GROUPS

    paint = np.load(prepared("paint.npy", size))
    reach = 1 / GROUPS.reach_along_factor, GROUPS.reach_across_divisor, 0.0
    return np.c_[paint[:, 3:5] - paint[:, 3:5].mean(axis=0).round(), np.zeros(len(paint))] * reach
