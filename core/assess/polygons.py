"""Marking polygons against reference polygons, by area."""

from dataclasses import dataclass

import shapely

from .rates import Rates


@dataclass(frozen=True)
class PolygonAccuracy:
    """Shares of area, 0 to 1, with a tolerance given on either side; areas in m²."""

    rates: Rates
    result_area: float
    reference_area: float

    @property
    def precision(self):
        return self.rates.precision

    @property
    def recall(self):
        return self.rates.recall

    @property
    def f1(self):
        return self.rates.f1


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
    return PolygonAccuracy(Rates(right, mine.area - right, theirs.area - found, found), mine.area, theirs.area)


def _merged(polygons, area):
    merged = shapely.union_all([shapely.make_valid(shapely.force_2d(p)) for p in polygons if p is not None])
    return merged if area is None else merged.intersection(area)
