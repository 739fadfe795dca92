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
    drive = read_trajectory(case.trajectory)
    rows = np.column_stack([getattr(drive, name) for name in COLUMNS])
    centre = np.rint(rows[:, 1:3].mean(axis=0))
    found = {}
    for variant in (Variant(AS_SURVEYED), *(VARIANTS if variants else ())):
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch)
            cloud, trajectory = case.cloud, case.trajectory
            if variant.name != AS_SURVEYED:
                cloud, trajectory = folder / "cloud.laz", folder / "trajectory.csv"
                variant.write_cloud(case.cloud, cloud, centre, (rows[0, 0], rows[-1, 0]))
                np.savetxt(trajectory, variant.trajectory(rows, centre), ["%.6f"] + ["%.4f"] * 3 + ["%.5f"] * 3, ",",
                           header=",".join(COLUMNS), comments="")
            try:
                found[variant.name] = _figures(case, rows[:, 1:3], variant, centre, cloud, trajectory, folder)
            except RoadExtractionError as problem:
                found[variant.name] = {"refused": str(problem)}
    return found


def _figures(case, track, variant, centre, cloud, trajectory, folder):
    road_map = make_road_map([cloud], read_trajectory(trajectory), folder / "intensity.tif")
    try:
        edges, markings, lanes = (_features(road_map.layer(name), variant, centre) for name in ("edges", "markings", "driving_lines"))
        beside = roadside_figures(case, road_map.layer("edges")) if variant.name == AS_SURVEYED else {}
    finally:
        road_map.road_points.close()
    paint = judge.paint(case, [geometry for geometry, _ in markings])["counts"] if "markings" in case.truth.has else None
    return {**judged(case, track, edges, paint, lanes), **beside}


def _features(layer, variant, centre):
    return [] if layer is None else [(variant.back(geometry, centre), row) for geometry, row in layer]
