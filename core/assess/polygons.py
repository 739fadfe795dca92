"""Marking polygons against reference polygons, by area."""

from dataclasses import dataclass

import shapely


@dataclass(frozen=True)
class PolygonAccuracy:
    """precision, recall, f1: shares of area, 0 to 1, with a tolerance given on either side."""

    precision: float
    recall: float
    f1: float
    result_area: float
    reference_area: float


def compare_polygons(result, reference, tolerance=0.04, area=None):
    """Compare two sets of polygons.

    Parameters
    ----------
    result, reference : lists of shapely polygons in one metric CRS
    tolerance : metres by which the other side is widened before areas are intersected
    area : shapely polygon; what lies outside is left out of both, or None
    """
    mine, theirs = _merged(result, area), _merged(reference, area)
    right = mine.intersection(theirs.buffer(tolerance)).area
    found = theirs.intersection(mine.buffer(tolerance)).area
    precision = right / mine.area if mine.area else float(theirs.area == 0)
    recall = found / theirs.area if theirs.area else float(mine.area == 0)
    f1 = 2 * precision * recall / (precision + recall) if precision + recall else 0.0
    return PolygonAccuracy(precision, recall, f1, mine.area, theirs.area)


def _merged(polygons, area):
    merged = shapely.union_all([shapely.make_valid(shapely.force_2d(p)) for p in polygons if p is not None])
    return merged if area is None else merged.intersection(area)
