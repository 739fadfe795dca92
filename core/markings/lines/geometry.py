"""The course of one marking line in plan and height: places from its paint, a curve through them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...countries.catalogue import country
from ...countries.neutral import NEUTRAL
from ...curves.base import CurveFit
from ...curves.bspline import fit_splines, smooth_profiles
from ...curves.model_selection import CURVES, fit_curve, fit_curves
from ...curves.robust import median
from ...survey.frame.frame_lines import LINE_VERTEX_SPACING
from .edges_beside import LEVEL_REACH
from .linking import weighted_medians

if TYPE_CHECKING:
    from ...survey.frame.road import Road
    from .edges_beside import EdgesBeside
    from .linking import CommonTrend
    from .strands import LinkedLine

MIN_POINTS_PER_PLACE = 3     # points that a place must have to count, where there are enough such places
MIN_GUIDED_GAP = 4.0         # m: in a longer gap the curve is guided parallel to the other lines
GUIDE_SPACING = 2.0          # m between guiding places
KEPT_DISTANCE = 0.1          # m within which a line keeps its distance from what it runs along, as MAX_STRAY_OFFSET of its own pieces
LINE_HEIGHT_SMOOTHING = 3.0  # m


@dataclass(frozen=True)
class MarkingLineSettings:
    """How marking lines are linked and which curve is fitted.

    curve : one of core.curves.model_selection.CURVES; degree : of the polynomial
    max_gap : m along the road over which paint of one line is linked
    max_bridge : m over which it is linked where the line's own dash pattern or a neighbouring line continues
    min_paint : m of paint without which there is no line (unless it fits another one's dashes)
    country : whose dashes are looked for; one of core.countries.COUNTRIES
    """

    curve: str = "automatic"
    degree: int = setting(2, 0, 9, "The polynomial's degree")
    max_gap: float = setting(13.0, 0.1, 100.0, "The longest gap that is linked", "m")
    max_bridge: float = setting(30.0, 0.1, 200.0, "The longest gap that is bridged", "m")
    min_paint: float = setting(4.0, 0.0, 100.0, "The least paint of a line", "m")
    country: str = NEUTRAL.name

    def __post_init__(self):
        check_limits(self)
        country(self.country)
        if self.curve not in CURVES:
            raise RoadExtractionError(f"There is no curve called {self.curve!r}. Choose one of {', '.join(CURVES)}.")
        if self.max_gap > self.max_bridge:
            raise RoadExtractionError(
                f"Gaps are linked up to {self.max_gap} m and bridged up to {self.max_bridge} m; the second must not "
                "be below the first.")


@dataclass
class LineShape:
    """A line that can be drawn between two stations.

    fit : CurveFit of the curve; residuals belong to the places `s`
    s : (K,) stations of the places
    """

    fit: CurveFit
    s: np.ndarray
    _station_to_u: tuple
    _height: Callable[[np.ndarray], np.ndarray]

    def u(self, s: np.ndarray) -> np.ndarray:
        """Arc length on the curve at stations s, going on evenly beyond the ends."""
        stations, lengths = self._station_to_u
        inside = np.interp(s, stations, lengths)
        return inside + np.minimum(s - stations[0], 0.0) + np.maximum(s - stations[-1], 0.0)

    def draw(self, first: float, last: float) -> np.ndarray:
        """(M, 3) local places from station `first` to `last`, at most half a metre apart."""
        ends = self.u(np.array([first, last]))
        count = max(2, int(np.ceil((ends[1] - ends[0]) / LINE_VERTEX_SPACING - 1e-9)) + 1)
        u = np.linspace(ends[0], ends[1], count)
        stations, lengths = self._station_to_u
        s = np.interp(u, lengths, stations) + np.minimum(u - lengths[0], 0.0) + np.maximum(u - lengths[-1], 0.0)
        return np.c_[self.fit.curve.at(u), self._height(s)]


def fit_line_shapes(lines: list[LinkedLine], spans: list[tuple[float, float]], road: Road, trend: CommonTrend, edges: EdgesBeside,
                    track_height: Callable[[np.ndarray], np.ndarray], settings: MarkingLineSettings,
                    progress: Progress = Progress()) -> tuple[list[LineShape], int]:
    """The LineShapes of linked lines, fitted together.

    Parameters
    ----------
    lines : list of LinkedLine
    spans : (first, last) stations of each to be drawn, which may reach beyond the paint
    road : Road
    trend : CommonTrend, how the painted lines of the road run together
    edges : EdgesBeside of the road
    track_height : function of stations (N,), height of the trajectory; the line's height is
        smoothed as the difference to it, so that it goes on along the road's slope
    settings : MarkingLineSettings
    progress : Progress

    Returns
    -------
    list of LineShape, and how many could not take the wanted curve (automatic replaces it there)
    """
    if not lines:
        return [], 0
    courses = []
    for line, span in zip(lines, spans):
        courses.append(_course(line, trend, edges, span))
        progress.report(0.2 * len(courses) / len(lines))
    s, d, own = (np.concatenate(parts) for parts in zip(*((course.s, course.d, course.own) for course in courses)))
    bounds = np.cumsum([len(course.s) for course in courses])[:-1]
    x, y = (np.split(values, bounds) for values in road.to_map(s, d))
    measured = [(x[k][course.own], y[k][course.own]) for k, course in enumerate(courses)]
    fits, replaced = _fitted(measured, settings)
    progress.report(0.6)
    # splines once more with the guides, which are no measurements and count in no choice
    curved = [k for k, fit in enumerate(fits) if fit.curve.kind == "b-spline"]
    along = [_along(road, courses[k].s, courses[k].d) for k in curved]
    near = [None] * len(courses)
    for k, t, guided in zip(curved, along, fit_splines([(x[k], y[k]) for k in curved], along)):
        fits[k], near[k] = guided, guided.curve.u_of(t)
    track = np.split(track_height(s[own]), np.cumsum([len(course.z) for course in courses])[:-1])
    heights = smooth_profiles([(course.s[course.own], course.z - below) for course, below in zip(courses, track)], LINE_HEIGHT_SMOOTHING)
    found = []
    for k, (course, fit, height) in enumerate(zip(courses, fits, heights)):
        progress.report(0.9 + 0.1 * k / len(courses))
        u, e = fit.curve.project(x[k], y[k], near[k])
        if near[k] is not None:
            fit = CurveFit(fit.curve, e[course.own], fit.parameters)
        rising = np.maximum.accumulate(u)
        keep = np.append(True, np.diff(rising) > 1e-6)
        found.append(LineShape(fit, course.s[course.own], (course.s[keep], rising[keep]),
                               _height_above(height, track_height)))
    return found, replaced


def _height_above(height, track_height):
    """The function of stations that gives the height of a line from that above the trajectory."""
    return lambda s: height(s) + track_height(s)


@dataclass
class _Course:
    """Places of a line by station, and places that guide its curve where nothing is painted.

    s, d : (N,) metres; own : (N,) True for the line's own places; z : heights of these
    """

    s: np.ndarray
    d: np.ndarray
    own: np.ndarray
    z: np.ndarray


def _course(line, trend, edges, span):
    s, d, z, weight = line.places()
    strong = weight >= MIN_POINTS_PER_PLACE
    if strong.sum() >= max(4, 0.5 * len(s)):
        s, d, z = s[strong], d[strong], z[strong]
    order = np.argsort(s, kind="stable")
    s, d, z = s[order], d[order], z[order]
    guide_s, guide_d = _guides(s, d, trend, edges, span)
    order = np.argsort(np.concatenate([s, guide_s]), kind="stable")
    return _Course(np.concatenate([s, guide_s])[order], np.concatenate([d, guide_d])[order], order < len(s), z)


def _fitted(places, settings):
    """Fits to a list of (x, y), and how many of them are not the wanted curve."""
    if settings.curve == "automatic":
        return fit_curves(places), 0
    found, replaced = [], 0
    for x, y in places:
        try:
            found.append(fit_curve(x, y, settings.curve, settings.degree))
        except RoadExtractionError:
            found.append(fit_curve(x, y, "automatic"))
            replaced += 1
    return found, replaced


def _guides(s, d, trend, edges, span):
    """Places in long gaps and beyond the ends, where nothing is painted: parallel to the other lines, an edge of the road and the road."""
    wide = np.flatnonzero(np.diff(s) > MIN_GUIDED_GAP)
    stations, offsets = [], []
    for k in wide.tolist():
        a, b = s[[k, k + 1]].tolist()
        at = np.linspace(a, b, int(np.ceil((b - a) / GUIDE_SPACING)) + 1)[1:-1]
        near = [slice(np.searchsorted(s, a - LEVEL_REACH), k + 1), slice(k + 1, np.searchsorted(s, b + LEVEL_REACH, "right"))]
        edge = edges.between((a, d[k]), (b, d[k + 1]))
        courses = [trend.at] if edge is None else [trend.at, edge, np.zeros_like]
        levels = np.array([[median(d[side] - course(s[side])) for side in near] for course in courses])
        stations.append(at)
        offsets.append(_common_course(np.array([np.interp(at, [a, b], ends) + course(at) for ends, course in zip(levels, courses)]),
                                      levels[:, 1] - levels[:, 0]))
    for tip, end in ((s[0], span[0]), (s[-1], span[1])):
        if abs(end - tip) > GUIDE_SPACING / 4:
            at = np.linspace(tip, end, int(np.ceil(abs(end - tip) / GUIDE_SPACING)) + 1)[1:]
            stations.append(at)
            near = np.abs(s - tip) <= LEVEL_REACH
            offsets.append(median(d[near] - trend.at(s[near])) + trend.at(at))
    if not stations:
        return np.empty(0), np.empty(0)
    return np.concatenate(stations), np.concatenate(offsets)


def _common_course(found, missed):
    """(N,) offsets in a gap of what others have in common: the other lines, an edge of the road and the road itself.

    Each course counts by how well the line keeps its distance from it from one end of the gap to the other. Which of them it runs along is not told
    by the ends alone: an edge that gives way to a bay in the gap comes back to where it was.

    found : (C, N) metres, offsets that lead parallel to each course; missed : (C,) metres by which the line's distance from it differs at the ends
    """
    weight = 1.0 / (KEPT_DISTANCE**2 + missed**2)
    order = np.argsort(found, axis=0, kind="stable")
    values = np.take_along_axis(found, order, axis=0)
    return weighted_medians(values.T.ravel(), weight[order].T.ravel(), len(found) * np.arange(found.shape[1]))


def _along(road, s, d):
    """(N,) length along the line at each station: the inner side of a bend is shorter."""
    middle = (s[1:] + s[:-1]) / 2
    rate = np.maximum(1.0 - road.curvature(middle) * (d[1:] + d[:-1]) / 2, 0.1)
    return np.r_[0.0, np.cumsum(np.maximum(np.diff(s), 1e-6) * rate)]
