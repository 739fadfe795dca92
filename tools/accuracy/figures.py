"""All numbers of one survey, as a dict that JSON can hold."""

import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from lanewright.core.io.geotiff import IntensityImage
from lanewright.core.markings.paint.extract import extract_markings
from lanewright.core.pipeline.road_map import RoadMapSettings
from lanewright.core.road.detect_boundaries import draw_boundaries
from lanewright.core.survey.open_survey import open_survey
from lanewright.core.survey.trajectory.reader import read_trajectory
from lanewright.products.published_markings import METHODS

from . import judge
from .chain import Work, run, set_in
from .confidence import confidence_figures
from .otherwise import street_figures
from .poorer import poorer_figures
from .surveys import read_case

DEFAULT = RoadMapSettings()
CELLS = (0.02, 0.04, 0.06, 0.08, 0.10)


def figures_of(folder, quick=False):
    from osgeo import gdal

    # every raster made in memory would be said to lack a CRS
    gdal.PushErrorHandler("CPLQuietErrorHandler")
    case = read_case(folder)
    about = dict(name=case.name, kind=case.kind, text=case.text, points=len_of(case.cloud), has=sorted(case.truth.has), steps=case.steps,
                 streets=street_figures(case, variants=not quick), poorer=poorer_figures(case) if case.poorer and not quick else {})
    lanes = not quick and "driving_lines" in case.truth.has and "refused" not in about["streets"]["as surveyed"]
    if not case.steps and not lanes:
        return about
    with tempfile.TemporaryDirectory() as scratch:
        began = time.perf_counter()
        drive = read_trajectory(case.trajectory)
        survey = open_survey([case.cloud], drive)
        reading = time.perf_counter() - began
        try:
            work = run(Work(survey, Path(scratch)))
            figures = {**about, **_steps(case, work, reading, quick)} if case.steps else about
            if lanes:
                track = np.column_stack([drive.x, drive.y])
                figures.update(confidence=confidence_figures(case, track, list(work.driving)))
        finally:
            survey.store.close()
    return figures


def _steps(case, work, reading, quick):
    """The figures of every method and step."""
    figures = dict(road_points=len(work.road), beams=work.beams, seconds={"survey": reading, **work.seconds}, whole=judged(case, work),
                   boundaries=boundary_methods(case, work), methods=marking_methods(case, work))
    if not quick:
        figures.update(cells=resolutions(case, work))
    return figures


def len_of(cloud):
    import laspy

    with laspy.open(cloud) as reader:
        return reader.header.point_count


def judged(case, work):
    """Boundaries, markings and driving lines of one run."""
    has = case.truth.has
    return dict(boundaries=judge.boundaries(case, work.edges, work.frame) if case.truth.curbs else None,
                markings=judge.markings(case, work.markings) if "markings" in has else None,
                driving=judge.driving(case, work.driving) if "driving_lines" in has else None)


def boundary_methods(case, work):
    """Boundary accuracy of profiles, scanlines and both."""
    if "boundaries" not in case.truth.has:
        return {}
    both = run(work, "curbs", "curbs", replace(DEFAULT, boundary_method="both")).found
    given = {"profiles": {"profiles": both["profiles"]}, "scanlines": {"scanlines": both["scanlines"]}, "both": both}
    return {name: judge.boundaries(case, draw_boundaries(found, work.frame).edges, work.frame) for name, found in given.items()}


def marking_methods(case, work):
    """Marking accuracy of each method: its mask as extracted, and its polygons after the same later stages."""
    if "markings" not in case.truth.has:
        return {}
    found = {}
    for name, method in METHODS.items():
        settings = set_in(DEFAULT, "markings", method=method)
        mask = work.scratch / f"{name}.tif"
        one = work.copy()
        began = time.perf_counter()
        one.points = extract_markings(one.bright, IntensityImage.open(one.image_path), one.frame, settings.markings, mask_path=mask)
        seconds = time.perf_counter() - began
        one = run(one, "outliers", "clusters", settings)
        found[name] = dict(mask=judge.mask(case, mask), polygons=judge.markings(case, one.markings), seconds=seconds)
    return found


def resolutions(case, work):
    """Size of the image and what is seen in it, by cell size in cm."""
    if "markings" not in case.truth.has:
        return {}
    found = {}
    for cell in CELLS:
        one = run(work, "image", "clusters", set_in(DEFAULT, "image", cell_size=cell))
        found[f"{100 * cell:.0f}"] = dict(megabytes=one.image_path.stat().st_size / 1e6, **judge.markings(case, one.markings))
        one.image_path.unlink()
    return found
