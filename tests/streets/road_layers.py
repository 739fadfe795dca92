"""The stages of the road with their input and output as layers, in map coordinates, as the algorithms read and write them."""

from lanewright.core.road import detect_boundaries as boundaries
from lanewright.core.road.common.curb_points import CurbPoints
from lanewright.core.road.edges import fit
from lanewright.core.road.edges.road_edges import RoadEdges
from lanewright.core.road.scanlines import detect as scanlines
from lanewright.core.road.surface import extract


def detect_curbs(survey, *settings, **options):
    return boundaries.find_curb_points(survey, boundaries.BoundarySettings("profiles", *settings), **options)["profiles"].to_features(survey.frame)


def curbs_from_scanlines(source, *settings, **options):
    return scanlines.curbs_from_scanlines(source, *settings, **options).to_features(source.frame)


def boundary_lines(corners, frame, *settings):
    return scanlines.boundary_lines(CurbPoints.from_features(corners, frame), frame, *settings).to_features(frame)


def fit_road_edges(curb_points, frame, *settings, **options):
    return fit.fit_road_edges(CurbPoints.from_features(curb_points, frame), frame, *settings, **options).to_features(frame)


def drawn_boundaries(survey, settings=boundaries.BoundarySettings(), **options):
    """Features ROAD_EDGES."""
    found = boundaries.find_curb_points(survey, settings, **options)
    return (boundaries.draw_boundaries(found, survey.frame, **options).edges).to_features(survey.frame)


def extract_road_surface(survey, edges=None, *settings):
    edges = None if edges is None else RoadEdges.from_features(edges, survey.frame)
    road_points, surface = extract.extract_road_surface(survey, edges, *settings)
    return road_points, surface.to_features(survey.frame)
