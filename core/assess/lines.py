"""Lines against reference lines: how much was found, how much is right, how far off."""

from dataclasses import dataclass

import numpy as np
import shapely

STEP = 0.1          # m between compared places along the lines
ASSOCIATED = 0.75   # m: farther apart, two lines are not the same line


@dataclass(frozen=True)
class LineAccuracy:
    """Shares are 0 to 1, keyed by tolerance (half-width of the buffer, metres); NaN where nothing was to compare.

    completeness : share of the reference's length within the tolerance of the result
    correctness : share of the result's length within the tolerance of the reference;
        1 - correctness is the miscoding of the driving-line thesis
    rmse, height_rmse : metres, over result places within 0.75 m of the reference
    """

    completeness: dict
    correctness: dict
    rmse: float
    height_rmse: float
    reference_length: float
    result_length: float


def compare_lines(result, reference, tolerances=(0.05, 0.10, 0.15, 0.20), area=None):
    """Compare two sets of lines in plan.

    Parameters
    ----------
    result, reference : lists of shapely LineStrings, with Z or without, in one metric CRS
    tolerances : half-widths of the buffer around the reference, metres
    area : shapely polygon; what lies outside is left out of both, or None

    Notes
    -----
    Measures after Heipke et al. (1997), evaluated on places 0.1 m apart.
    """
    mine, theirs = _places(result, area), _places(reference, area)
    to_reference, height = _nearest(mine, reference)
    to_result, _ = _nearest(theirs, result)
    near = to_reference <= ASSOCIATED
    difference = (mine[:, 2] - height)[near] if len(mine) else np.empty(0)
    difference = difference[np.isfinite(difference)]
    return LineAccuracy(
        {w: _share(to_result <= w) for w in tolerances}, {w: _share(to_reference <= w) for w in tolerances},
        _rms(to_reference[near]), _rms(difference), STEP * len(theirs), STEP * len(mine))


def _places(lines, area):
    """(N, 3) places every 0.1 m along the lines."""
    parts = [_along(line) for line in lines if line is not None and line.length > 0]
    places = np.vstack(parts) if parts else np.empty((0, 3))
    if area is not None and len(places):
        places = places[shapely.contains_xy(area, places[:, 0], places[:, 1])]
    return places


def _along(line):
    if line.geom_type != "LineString":
        return np.vstack([_along(part) for part in line.geoms])
    count = max(2, int(np.ceil(line.length / STEP)) + 1)
    places = shapely.line_interpolate_point(line, np.linspace(0, line.length, count))
    return shapely.get_coordinates(places, include_z=True)


def _nearest(places, lines):
    """Distance in plan to the nearest line and that line's height there."""
    lines = [line for line in lines if line is not None and line.length > 0]
    if not len(places) or not lines:
        return np.full(len(places), np.inf), np.full(len(places), np.nan)
    points = shapely.points(places[:, :2])
    (_, which), distance = shapely.STRtree(lines).query_nearest(points, return_distance=True, all_matches=False)
    line = np.asarray(lines, object)[which]
    foot = shapely.line_interpolate_point(line, shapely.line_locate_point(line, points))
    return distance, shapely.get_z(foot)


def _share(mask):
    return float(mask.mean()) if len(mask) else float("nan")


def _rms(values):
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")
