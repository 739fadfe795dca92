"""gdal_grid's inverse distance raster (invdistnn), to compare the intensity image with."""

import os
import resource
import shutil
import subprocess
import time

from .pcl import PeerMissing

NODATA = -9999.0


def inverse_distance(points, raster, like, radius, power, threads):
    """Fill the cells of a raster from the heights of a point layer.

    Parameters
    ----------
    points : path of a point layer whose z is the value
    raster : path of the GeoTIFF to write
    like : path of a raster with the same cells
    radius, power : m, all points within count; a point weighs 1 / distance^power
    threads : that gdal_grid may use

    Returns
    -------
    dict of wall and CPU seconds, less those of a run that fills a single cell: of starting and of reading the points

    Raises
    ------
    PeerMissing
        Without gdal_grid.
    """
    from osgeo import gdal

    program = shutil.which("gdal_grid")
    if program is None:
        raise PeerMissing("There is no gdal_grid here: apt-get install gdal-bin.")
    gdal.UseExceptions()
    dataset = gdal.Open(str(like))
    left, size, _, top, _, _ = dataset.GetGeoTransform()
    width, height = dataset.RasterXSize, dataset.RasterYSize
    # without an end to the number of points: all within the radius weigh, as in ours
    rule = f"invdistnn:power={power}:radius={radius}:max_points=100000:min_points=0:smoothing=0:nodata={NODATA}"
    words = [program, "-q", "-a", rule, "-txe", left, left + width * size, "-tye", top, top - height * size,
             "-ot", "Float32", "-of", "GTiff", "-co", "TILED=YES", "-co", "COMPRESS=DEFLATE"]
    environment = dict(os.environ, GDAL_NUM_THREADS=str(threads))
    reading = _timed([*words, "-outsize", 1, 1, points, f"{raster}.one.tif"], environment)
    os.remove(f"{raster}.one.tif")
    whole = _timed([*words, "-outsize", width, height, points, raster], environment)
    return {**{name: whole[name] - reading[name] for name in whole}, "peak": _children().ru_maxrss / 2**10}


def _children():
    return resource.getrusage(resource.RUSAGE_CHILDREN)


def _timed(words, environment):
    before, began = _children(), time.perf_counter()
    subprocess.run([str(word) for word in words], check=True, env=environment)
    after = _children()
    return dict(wall=time.perf_counter() - began, cpu=after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
