"""The stages of the road with their input and output as layers, in map coordinates, as the algorithms read and write them."""

from lanewright.core.road import detect_boundaries as boundaries
from lanewright.core.road.common.curb_points import CurbPoints
from lanewright.core.road.edges import fit
from lanewright.core.road.edges.road_edges import edges_from_features, edges_to_features
from lanewright.core.road.profiles import detect as profiles
from lanewright.core.road.scanlines import detect as scanlines
from lanewright.core.road.surface import extract
from lanewright.core.road.surface.road_surface import surface_to_features


def detect_curbs(survey, *settings, **options):
    return profiles.detect_curbs(survey, *settings, **options).to_features(survey.frame)


def curbs_from_scanlines(source, *settings, **options):
    return scanlines.curbs_from_scanlines(source, *settings, **options).to_features(source.frame)


def boundary_lines(corners, frame, *settings):
    return edges_to_features(scanlines.boundary_lines(CurbPoints.from_features(corners, frame), frame, *settings), frame)


def fit_road_edges(curb_points, frame, *settings, **options):
    return edges_to_features(fit.fit_road_edges(CurbPoints.from_features(curb_points, frame), frame, *settings, **options), frame)


def drawn_boundaries(survey, settings=boundaries.BoundarySettings(), **options):
    """Features ROAD_EDGES."""
    found = boundaries.find_curb_points(survey, settings, **options)
    return edges_to_features(boundaries.draw_boundaries(found, survey.frame, **options).edges, survey.frame)


def extract_road_surface(survey, edges=None, *settings):
    edges = None if edges is None else edges_from_features(edges, survey.frame)
    road_points, surface = extract.extract_road_surface(survey, edges, *settings)
    return road_points, surface_to_features(surface, survey.frame)
