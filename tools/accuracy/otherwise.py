"""Road maps of a street and of its variants, judged by length."""

import tempfile
from pathlib import Path

import numpy as np
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.pipeline.road_map import make_road_map
from lanewright.core.survey.trajectory.reader import read_trajectory

from . import judge
from .roadside import roadside_figures
from .streets import judged
from .variants import VARIANTS, Variant

AS_SURVEYED = "as surveyed"
COLUMNS = ("time", "x", "y", "z", "roll", "pitch", "heading")


def street_figures(case, variants=True):
    """{"as surveyed": figures, name of the variant: figures, ...}; {"refused": why} where no map could be made."""
    rows, centre = rows_of(case)
    found = {}
    for variant in (Variant(AS_SURVEYED), *(VARIANTS if variants else ())):
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch)
            cloud, trajectory = surveyed(case, variant, rows, centre, folder)
            try:
                found[variant.name] = _figures(case, rows[:, 1:3], variant, centre, cloud, trajectory, folder)
            except RoadExtractionError as problem:
                found[variant.name] = {"refused": str(problem)}
    return found


def rows_of(case):
    """(N, 7) COLUMNS of the trajectory, and its middle, (2,) whole metres."""
    drive = read_trajectory(case.trajectory)
    rows = np.column_stack([getattr(drive, name) for name in COLUMNS])
    return rows, np.rint(rows[:, 1:3].mean(axis=0))


def surveyed(case, variant, rows, centre, folder):
    """Paths of the cloud and the trajectory of a variant, which are written into a folder."""
    if variant.name == AS_SURVEYED:
        return case.cloud, case.trajectory
    cloud, trajectory = folder / "cloud.laz", folder / "trajectory.csv"
    variant.write_cloud(case.cloud, cloud, centre, (rows[0, 0], rows[-1, 0]))
    np.savetxt(trajectory, variant.trajectory(rows, centre), ["%.6f"] + ["%.4f"] * 3 + ["%.5f"] * 3, ",", header=",".join(COLUMNS), comments="")
    return cloud, trajectory


def _figures(case, track, variant, centre, cloud, trajectory, folder):
    road_map = make_road_map([cloud], read_trajectory(trajectory), folder / "intensity.tif")
    try:
        edges, markings, lanes = (on_the_street(road_map.layer(name), variant, centre) for name in ("edges", "markings", "driving_lines"))
        beside = roadside_figures(case, road_map.layer("edges")) if variant.name == AS_SURVEYED else {}
    finally:
        road_map.road_points.close()
    paint = judge.paint(case, [geometry for geometry, _ in markings])["counts"] if "markings" in case.truth.has else None
    return {**judged(case, track, edges, paint, lanes), **beside}


def on_the_street(layer, variant, centre):
    """[(geometry, row)] of a layer of a variant, where they lie on the street itself."""
    return [] if layer is None else [(variant.back(geometry, centre), row) for geometry, row in layer]
