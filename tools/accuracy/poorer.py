"""The same survey with something lacking: fewer points, coarse coordinates, intensity or time left out.

The road map of each is judged by the truth of the street itself. Random choices are the same every time.
"""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import laspy
import numpy as np
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.pipeline.road_map import RoadMapSettings, make_road_map
from lanewright.core.survey.open_survey import SurveySettings
from lanewright.core.survey.trajectory.reader import read_trajectory

from . import judge
from .streets import judged

VOXEL, COARSE = 0.05, 0.01      # m
LOST = 0.1                      # share of the returns
FULL_SCALE = 99.9               # percentile of the intensities that becomes 255
PAINT, ASPHALT, SPREAD = 200.0, 90.0, 12.0   # of 255, of the made photographs
SHIFT = 0.03                    # m that they lie beside the points
SHADE, SHADED = 0.5, 10.0       # brightness in shadow, and m of street, of every three times that, that lie in it


@dataclass(frozen=True)
class Poorer:
    """What a survey lacks.

    name : for the page
    change : function of the points (laspy.LasData), the markings (shapely) and a random generator, that gives the changed points
    settings : of the road map
    """

    name: str
    change: Callable
    settings: RoadMapSettings = RoadMapSettings()


def poorer_figures(case):
    """{name: figures as `judged` gives them}; {"refused": why} where no map could be made."""
    drive, found = read_trajectory(case.trajectory), {}
    for poorer in POORER:
        with tempfile.TemporaryDirectory() as scratch:
            las = poorer.change(laspy.read(case.cloud), case.truth.markings, np.random.default_rng(1))
            las.write(f"{scratch}/cloud.laz")
            try:
                found[poorer.name] = _figures(case, drive, poorer, Path(scratch))
            except RoadExtractionError as problem:
                found[poorer.name] = {"refused": str(problem)}
    return found


def _figures(case, drive, poorer, folder):
    road_map = make_road_map([folder / "cloud.laz"], drive, folder / "intensity.tif", poorer.settings)
    try:
        edges, markings, lanes = ([] if layer is None else list(layer) for layer in map(road_map.layer, ("edges", "markings", "driving_lines")))
    finally:
        road_map.road_points.close()
    paint = judge.paint(case, [geometry for geometry, _ in markings])["counts"] if "markings" in case.truth.has else None
    return judged(case, np.column_stack([drive.x, drive.y]), edges, paint, lanes)


def _kept(las, rows):
    las.points = las.points[rows]
    return las


def every(count):
    """One point in so many, as the file lists them."""
    return lambda las, markings, rng: _kept(las, np.arange(0, len(las.points), count))


def voxels(las, markings, rng):
    """The first point of each cube."""
    cubes = np.floor(np.column_stack([las.x, las.y, las.z]) / VOXEL).astype(np.int64)
    return _kept(las, np.sort(np.unique(cubes, axis=0, return_index=True)[1]))


def coarse(las, markings, rng):
    """Coordinates rounded to a centimetre."""
    for axis in "xyz":
        setattr(las, axis, np.round(np.asarray(las[axis]) / COARSE) * COARSE)
    return las


def lost(las, markings, rng):
    """Returns missing at random."""
    return _kept(las, np.flatnonzero(rng.random(len(las.points)) >= LOST))


def bytes_of_intensity(las, markings, rng):
    """Intensity from 0 to 255, as exports for viewing write it."""
    las.intensity = np.clip(np.asarray(las.intensity) * (255.0 / np.percentile(las.intensity, FULL_SCALE)), 0, 255).astype(np.uint16)
    return las


def timeless(las, markings, rng):
    """Points whose time was left out."""
    las.gps_time = np.zeros(len(las.points))
    return las


def coloured(las, markings, rng):
    """Points without intensity, with the colours of made photographs: paint on asphalt, displaced, and shadows across the street."""
    found = laspy.convert(las, point_format_id=7)
    x, y = np.asarray(las.x) - SHIFT, np.asarray(las.y)
    painted = np.zeros(len(x), bool)
    painted[shapely.STRtree(markings).query(shapely.points(x, y), predicate="within")[0]] = True
    grey = np.where(painted, PAINT, ASPHALT) + rng.normal(0.0, SPREAD, len(x))
    grey *= np.where(np.mod(x + y, 3 * SHADED) < SHADED, SHADE, 1.0)
    for name in ("red", "green", "blue"):
        found[name] = (np.clip(grey, 0, 255) * 256).astype(np.uint16)
    found.intensity = np.zeros(len(x), np.uint16)
    return found


RGB = replace(RoadMapSettings(), survey=SurveySettings(intensity_from="rgb"))
POORER = (
    Poorer("one point in 4", every(4)), Poorer("one point in 10", every(10)), Poorer("one point per cube of 5 cm", voxels),
    Poorer("coordinates of 1 cm", coarse), Poorer("one return in ten missing", lost), Poorer("intensity in 8 bits", bytes_of_intensity),
    Poorer("points without time", timeless), Poorer("colours, no intensity", coloured, RGB))
