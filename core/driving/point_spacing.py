"""How far apart the points lie along a road: the fewer there are, the less well its lines are placed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import median_filter

from ..markings.cross_section.evidence import surface_coverage

if TYPE_CHECKING:
    from ..survey.store.road_points import RoadPoints

SECTIONS_ALIKE = 3   # the median of so many is taken: a section in which the road begins or ends holds fewer points


def point_spacing(road_points: RoadPoints, road: int, s: np.ndarray) -> np.ndarray:
    """Spacing of the road points at stations, the side of the square of surface that holds one of them.

    Parameters
    ----------
    road_points : RoadPoints
    road : number
    s : (K,) m, the grid stations of the road's lines

    Returns
    -------
    (K,) m; NaN where it is not known
    """
    numbers, length = np.array(road_points.sections(road)), road_points.store.section_length
    left, right = surface_coverage(road_points, road, s)[1]
    known = np.isfinite(left - right)
    if not len(numbers) or not known.any():
        return np.full(len(s), np.nan)
    middles = (numbers + 0.5) * length
    width = np.maximum(np.interp(middles, s[known], (left - right)[known]), 1.0)
    count = np.array([road_points.store.size(road, number) for number in numbers.tolist()])
    side = np.sqrt(width * length / np.maximum(count, 1))
    return np.interp(s, middles, median_filter(side, SECTIONS_ALIKE, mode="mirror"))
