"""The stages of a road map, run by any executor on a sample survey in small tasks, and what must be the same to the last bit."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
import shapely
from lanewright.core.common.progress import Progress
from lanewright.core.driving import heights
from lanewright.core.driving.driving_lines import make_driving_lines
from lanewright.core.execution.choice import ExecutionSettings
from lanewright.core.execution.in_step import items_of_phases
from lanewright.core.execution.keep import Keep
from lanewright.core.intensity import image as imaging
from lanewright.core.intensity import scatter as scattering
from lanewright.core.intensity.correction import correct_intensity
from lanewright.core.intensity.image import make_intensity_image
from lanewright.core.markings import outliers
from lanewright.core.markings.lines.fit import fit_marking_lines
from lanewright.core.markings.objects import cluster as phases
from lanewright.core.markings.objects import grouping as linking
from lanewright.core.markings.objects.cluster import cluster_markings
from lanewright.core.markings.outliers import remove_outliers
from lanewright.core.markings.paint import extract as extraction
from lanewright.core.markings.paint.extract import extract_markings
from lanewright.core.road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points
from lanewright.core.road.surface import ground_grid
from lanewright.core.road.surface.extract import extract_road_surface
from lanewright.core.survey import open_survey as opening
from lanewright.core.survey.store import section_store

PHASES = ["ground_of_windows", "surface_points", "levels_of_stretch", "corrected_of_stretch",
          "windows_of_image", "tiles_of_image", "scatter_of_windows", "paint_of_window", "kept_of_windows", "links_of_windows",
          "combs_of_windows", "pieces_of_clusters", "outlines_of_markings", "sections_of_stretch",
          "heights_of_windows"]


def functions_of(phase, items):
    """{name of a function: how many of these items are its own}; several phases may be run as one."""
    if phase.function is not items_of_phases:
        return {phase.function.__name__: len(items)}
    return Counter(name.partition(":")[2] for together in items for name, _ in together)


def found_by(sample, executor=None, work=None, progress=Progress()):
    """All numbers of road points, outline, image, paint, markings and lines; `progress` is that of the last three. The executor is closed."""
    made, path = sample
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(section_store, "STRETCH_POINTS", 40_000)
        patch.setattr(ground_grid, "SURFACE", replace(ground_grid.SURFACE, measured_windows=2))
        patch.setattr(imaging, "IMAGE", replace(imaging.IMAGE, looked_windows=1))
        patch.setattr(imaging, "IMAGE", replace(imaging.IMAGE, tiles_per_task=1))
        for module in (scattering, extraction):
            patch.setattr(module, "WINDOWS_PER_TASK", 1)
        patch.setattr(phases, "TASK_POINTS", 300)
        patch.setattr(outliers, "TASK_WINDOWS", 1)
        patch.setattr(heights, "HEIGHT_POINTS", 1)
        patch.setattr(linking, "LINKING_WINDOW_CELLS", 250)
        patch.setattr(linking, "LINKED_POINTS", 300)
        if executor is not None:
            patch.setattr(opening, "executor_for", lambda *_: Keep(executor, work) if work else executor)
        survey = opening.open_survey([path], made.trajectory, execution=ExecutionSettings(work_folder=str(work) if work else ""))
        try:
            edges = draw_boundaries(find_curb_points(survey, BoundarySettings("profiles")), survey.frame).edges
            road_points, surface = extract_road_surface(survey, edges)
            density = road_points.density
            selected = [np.array(road_points.section(*key).records).tobytes() for key in road_points.all_sections()]
            road_points, report = correct_intensity(road_points, survey.frame)
            image = make_intensity_image(road_points)
            pixels = image.read_pixels(0, 0, image.width, image.height).tobytes()
            paint = extract_markings(road_points, image, survey.frame, progress=progress)
            image.close()
            paint = remove_outliers(paint, progress=progress, executor=survey.executor)
            markings, clustered = cluster_markings(paint, survey.frame, progress=progress, executor=survey.executor)
            edges = edges.densified(survey.frame)
            lines = fit_marking_lines(clustered, markings, survey.frame, progress=progress, edges=edges, road_points=road_points)
            driving, _, lanes = make_driving_lines(lines, survey.frame, progress=progress, markings=markings, edges=edges, road_points=road_points)
            lined = lines.course.x.tobytes(), lines.kind.tolist(), driving.vertices.tobytes(), driving.sigma.tobytes(), lanes.left.tobytes()
            clusters = [clustered.section(*key).cluster.tobytes() for key in clustered.all_sections()]
            drawn = [shapely.to_wkb(one) for one in markings.to_features(survey.frame).geometries], markings.kind.tolist()
            painted = [(key, np.array(paint.section(*key).records).tobytes()) for key in paint.all_sections()]
            corrected = [road_points.section(*key).corrected.tobytes() for key in road_points.all_sections()]
            return selected, corrected, surface.area.tobytes(), surface.status.tolist(), density, report, pixels, painted, clusters, drawn, lined
        finally:
            survey.store.close()
