"""Marking lines: the painted lines of a road traced, linked over gaps, fitted with curves and named."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import shapely

from ...common.arrays import members_of, stretch_of
from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...countries.catalogue import NEUTRAL, country
from ...curves.base import Curve, CurveFit
from ...curves.bspline import Profile, fit_splines, smooth_profiles
from ...curves.model_selection import CURVES, fit_curve, fit_curves
from ...curves.robust import median
from ...execution.phase import THREADS, Items, NoSource, Phase
from ...road.common.pseudo_scanlines import expand_ranges
from ...road.edges.road_edges import RoadEdges
from ...survey.frame.placement import LINE_VERTEX_SPACING
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.columns import Columns
from ...survey.store.road_points import RoadPoints, columns_of_roads
from ..cross_section.evidence import hatched_areas
from ..cross_section.roads import RoadEstimates, estimate_roads
from ..cross_section.sections import EdgeSections
from ..cross_section.sequence import separated_kinds
from ..cross_section.weights import CENTRE_LINE, EDGE_LINE, LANE_LINE, EstimateWeights
from ..objects.classify import LINE_KINDS
from ..objects.marking_objects import MarkingObjects
from ..weights import STRANDS
from .linking import CommonTrend, link_lines, link_over_long_gaps, weighted_medians, with_paint_between_tracks, with_unseen_paint
from .painted_lines import CONFIRMED, PaintedLines, painted_lines_of
from .selection import SelectedLine, same_dash_pattern, select_lines
from .strands import EdgesBeside, LinkedLine, edges_beside, line_paint, painted_strands

# The course of one marking line in plan and height: places from its paint, a curve through them.


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
class _DrawnLine:
    """A line that was fitted, piece by piece.

    wanted : whether its curve is of the wanted kind, not the automatic one; arc : arc lengths on the curve at both ends of each piece
    stations, places : (M,) stations of each piece, at most half a metre apart, and (M, 3) local places there; z above the trajectory
    rmse : m, of the paint of each piece about the curve, NaN where it has none
    """

    wanted: bool
    curve: Curve
    arc: list[np.ndarray]
    stations: list[np.ndarray]
    places: list[np.ndarray]
    rmse: list[float]


def _lines_drawn(source: NoSource, courses: Sequence[_Course], curve: str, degree: int) -> list[_DrawnLine]:
    """The phase that fits lines, with a curve of the wanted kind where they can take it, and draws their pieces.

    curve, degree : as of MarkingLineSettings
    """
    measured = [(course.x[course.own], course.y[course.own]) for course in courses]
    fitted = [(fit, True) for fit in fit_curves(measured)] if curve == "automatic" else [_fitted(x, y, curve, degree) for x, y in measured]
    fits, wanted = (list(parts) for parts in zip(*fitted))
    # splines once more with the guides, which are no measurements and count in no choice
    curved = [k for k, fit in enumerate(fits) if fit.curve.kind == "b-spline"]
    along, guesses = [courses[k].along for k in curved], [None] * len(courses)
    for k, t, guided in zip(curved, along, fit_splines([(courses[k].x, courses[k].y) for k in curved], along)):
        fits[k], guesses[k] = guided, guided.curve.u_of(t)
    heights = smooth_profiles([(course.s[course.own], course.z) for course in courses], STRANDS.line_height_smoothing)
    drawn = []
    for course, fit, guess, of_kind, height in zip(courses, fits, guesses, wanted, heights):
        u, e = fit.curve.project(course.x, course.y, guess)
        if guess is not None:
            fit = CurveFit(fit.curve, e[course.own], fit.parameters)
        drawn.append(_drawn_line(course, fit, of_kind, np.maximum.accumulate(u), height))
    return drawn


def _drawn_line(course: _Course, fit: CurveFit, wanted: bool, u: np.ndarray, height: Profile) -> _DrawnLine:
    """The line between the first and the last station of each piece; u : (N,) arc lengths of the places of the course, which never fall."""
    keep = np.append(True, np.diff(u) > 1e-6)
    measured, stations, lengths = course.s[course.own], course.s[keep], u[keep]
    line = _DrawnLine(wanted, fit.curve, [], [], [], [])
    for first, last in course.pieces:
        arc = _led_on(np.array([first, last]), stations, lengths)
        along = np.linspace(arc[0], arc[1], max(2, int(np.ceil((arc[1] - arc[0]) / LINE_VERTEX_SPACING - 1e-9)) + 1))
        s, residuals = _led_on(along, lengths, stations), fit.residuals[stretch_of(measured, first, last)]
        line.arc.append(arc)
        line.stations.append(s)
        # heights above the trajectory go on along the road's slope
        line.places.append(np.column_stack([fit.curve.at(along), height(s)]))
        line.rmse.append(float(np.sqrt(np.mean(residuals**2))) if len(residuals) else np.nan)
    return line


def _led_on(at, places, values):
    """Values at places, interpolated, and going on evenly beyond both ends."""
    return np.interp(at, places, values) + np.minimum(at - places[0], 0.0) + np.maximum(at - places[-1], 0.0)


@dataclass(frozen=True)
class _Course:
    """Places of a line by station, (N,) m, of which some guide its curve where nothing is painted; z of its own ones above the trajectory."""

    s: np.ndarray
    x: np.ndarray
    y: np.ndarray
    along: np.ndarray   # length along the line
    own: np.ndarray
    z: np.ndarray
    pieces: list[tuple[float, float]]   # first and last stations of what is drawn


def _courses(selected, places, road, track_height):
    """The _Courses of the selected lines of a road, which lead over the stations that are to be drawn; places : of each, as of `_places`."""
    if not places:
        return []
    s, d, rows = (np.concatenate(parts) for parts in list(zip(*places))[:3])
    bounds = np.cumsum([len(stations) for stations, *_ in places])[:-1]
    track = np.split(track_height(s[rows]), np.cumsum([len(z) for *_, z in places])[:-1])
    x, y = (np.split(values, bounds) for values in road.to_map(s, d))
    pieces = [[(piece.first, piece.last) for piece in chosen.pieces] for chosen in selected]
    return [_Course(of_s, of_x, of_y, _along(road, of_s, of_d), of_own, z - below, of_line)
            for (of_s, of_d, of_own, z), of_x, of_y, below, of_line in zip(places, x, y, track, pieces)]


def _places(line, trend, edges, span):
    """(N,) stations and offsets of a line, beyond its paint, too, whether they are its own, and the heights of those."""
    s, d, z, weight = line.places
    strong = weight >= STRANDS.min_points_per_place
    if strong.sum() >= max(4, 0.5 * len(s)):
        s, d, z = s[strong], d[strong], z[strong]
    order = np.argsort(s, kind="stable")
    s, d, z = s[order], d[order], z[order]
    guide_s, guide_d = _guides(s, d, trend, edges, span)
    order = np.argsort(np.concatenate([s, guide_s]), kind="stable")
    return np.concatenate([s, guide_s])[order], np.concatenate([d, guide_d])[order], order < len(s), z


def _fitted(x, y, curve, degree):
    """The fit of the wanted curve, or the automatic one of places that cannot take it, and whether it is the wanted one."""
    try:
        return fit_curve(x, y, curve, degree), True
    except RoadExtractionError:
        return fit_curve(x, y), False


def _guides(s, d, trend, edges, span):
    """Places in long gaps and beyond the ends, where nothing is painted: parallel to the other lines, an edge of the road and the road."""
    wide = np.flatnonzero(np.diff(s) > STRANDS.min_guided_gap)
    stations, offsets = [], []
    for k in wide.tolist():
        a, b = s[[k, k + 1]].tolist()
        steps = np.linspace(a, b, int(np.ceil((b - a) / STRANDS.guide_spacing)) + 1)[1:-1]
        close = [slice(np.searchsorted(s, a - STRANDS.level_reach), k + 1), slice(k + 1, np.searchsorted(s, b + STRANDS.level_reach, "right"))]
        edge = edges.between((a, d[k]), (b, d[k + 1]))
        courses = [trend.at] if edge is None else [trend.at, edge, np.zeros_like]
        levels = np.array([[median(d[side] - course(s[side])) for side in close] for course in courses])
        stations.append(steps)
        offsets.append(_common_course(np.array([np.interp(steps, [a, b], ends) + course(steps) for ends, course in zip(levels, courses)]),
                                      levels[:, 1] - levels[:, 0]))
    for tip, end in ((s[0], span[0]), (s[-1], span[1])):
        if abs(end - tip) > STRANDS.guide_spacing / 4:
            steps = np.linspace(tip, end, int(np.ceil(abs(end - tip) / STRANDS.guide_spacing)) + 1)[1:]
            stations.append(steps)
            close = np.abs(s - tip) <= STRANDS.level_reach
            offsets.append(median(d[close] - trend.at(s[close])) + trend.at(steps))
    if not stations:
        return np.empty(0), np.empty(0)
    return np.concatenate(stations), np.concatenate(offsets)


def _common_course(parallel, missed):
    """(N,) offsets in a gap of what others have in common: the other lines, an edge of the road and the road itself.

    Each course counts by how well the line keeps its distance from it over the gap. Which of them it runs along is not told by the ends alone: an
    edge that gives way to a bay in the gap comes back to where it was. `parallel` : (C, N) m, offsets that lead parallel to each course;
    `missed` : (C,) m by which the line's distance from it differs at the ends.
    """
    weight = 1.0 / (STRANDS.kept_distance**2 + missed**2)
    order = np.argsort(parallel, axis=0, kind="stable")
    values = np.take_along_axis(parallel, order, axis=0)
    return weighted_medians(values.T.ravel(), weight[order].T.ravel(), len(parallel) * np.arange(parallel.shape[1]))


def _along(road, s, d):
    """(N,) length along the line at each station: the inner side of a bend is shorter."""
    middle = (s[1:] + s[:-1]) / 2
    rate = np.maximum(1.0 - road.curvature(middle) * (d[1:] + d[:-1]) / 2, 0.1)
    return np.append(0.0, np.cumsum(np.maximum(np.diff(s), 1e-6) * rate))


# Lines named by the estimate of their road, and markings after the lines that they make: a dash alone does not show what it separates.

KINDS = {EDGE_LINE: "edge", LANE_LINE: "lane", CENTRE_LINE: "centre"}


def named_by_estimate(lines: PaintedLines, estimates: RoadEstimates) -> PaintedLines:
    """Lines with the `kind` that the estimate of their road gives them; one that bounds no lane is called by how it is drawn."""
    if not len(lines):
        return lines
    kinds, second = _kinds_of_lines(estimates)
    drawn = np.where([pattern.startswith("double") for pattern in lines.pattern], "centre",
                     np.where(lines.pattern == "dashed", "lane", "edge")).astype(object)
    kind = np.array([kinds.get(number, drawn_kind) for number, drawn_kind in zip(lines.line.tolist(), drawn)], object)
    # what an analyst confirmed keeps its name
    confirmed = lines.status == CONFIRMED
    kind[confirmed] = lines.kind[confirmed]
    second_kind = np.array(["" if fixed else second.get(number, "") for number, fixed in zip(lines.line.tolist(), confirmed.tolist())], object)
    return replace(lines, kind=kind, other=second_kind)


def named_by_lines(markings: MarkingObjects, lines: PaintedLines) -> MarkingObjects:
    """Markings of lines (`keep`) with the `kind` of the marking line that runs along them, and what `with_paint_between_tracks` adds."""
    rows = np.flatnonzero(markings.keep & np.isin(markings.kind.astype(str), LINE_KINDS))
    if not len(rows) or not len(lines):
        return markings
    inner = shapely.point_on_surface(markings.outlines.polygons()[rows])
    marking, line = shapely.STRtree(lines.course.linestrings()).query_nearest(inner, max_distance=STRANDS.max_distance_to_line, all_matches=False)
    same_road = markings.road[rows[marking]] == lines.course.road[line]
    kind = markings.kind.copy()
    kind[rows[marking][same_road]] = lines.kind[line[same_road]]
    return with_paint_between_tracks(replace(markings, kind=kind), lines)


def _kinds_of_lines(estimates):
    """{number of a marking line: edge, lane or centre}, by what most of it separates, and {number: its second kind as JSON}.

    Lines that bound no lane are in neither, and in the second are those alone that are almost as probable to separate something else along most
    of them.
    """
    parts: list[tuple[np.ndarray, ...]] = []   # of each road: lines, at how many stations each separates something, what, and behind by how much
    for road in estimates.roads.values():
        c, estimate = road.estimate.candidates, road.estimate
        kinds = separated_kinds(estimate.sections)
        uses = kinds[np.arange(len(kinds)), estimate.choice]
        nats = np.stack([np.where(kinds == use, estimate.second[:, :, None], np.inf).min(axis=1) for use in KINDS])
        i, m = np.nonzero(np.isin(uses, list(KINDS)) & c.painted)
        use, rows = uses[i, m], c.rows[i, m]
        is_use = use == np.array(list(KINDS))[:, None]
        gaps = np.where(is_use, np.inf, nats[:, i, m] - nats[is_use.argmax(axis=0), i, m])
        of, side = np.nonzero((rows >= 0) & (np.diff(rows, prepend=-1) != 0))
        part, station = expand_ranges(c.first[i[of]], c.last[i[of]] + 1)
        number = road.lines.number[rows[of, side][part], station].astype(np.int64)   # 32 bits may not hold the key
        key, count = np.unique((number * len(of) + part)[number >= 0], return_counts=True)
        number, part = np.divmod(key, max(len(of), 1))
        parts.append((number, count.astype(float), use[of[part]], gaps.T[of[part]]))
    first, second, doubt = {}, {}, EstimateWeights().doubt
    lines, *columns = map(np.concatenate, zip(*parts)) if parts else (np.empty(0, int),)
    for number, members in members_of(lines):
        count, use, gaps = (column[members] for column in columns)
        first[number] = KINDS[int(np.bincount(use, count).argmax())]
        share = (count[:, None] * (gaps < doubt)).sum(axis=0) / count.sum()
        likely = int(np.argmax(share))
        if share[likely] > 0.5:
            close = gaps[:, likely][gaps[:, likely] < doubt]
            second[number] = json.dumps({"nats": round(max(float(np.median(close)), 0.0), 2), "kind": list(KINDS.values())[likely]})
    return first, second


LINES_SHARE = 0.65   # derived: of the work, half of it to link lines; the rest is the estimate that names the lines


def fit_marking_lines(clustered_points: RoadPoints, markings: MarkingObjects, frame: RoadFrame,
                      settings: MarkingLineSettings = MarkingLineSettings(), progress: Progress = Progress(),
                      edges: RoadEdges | EdgeSections | None = None, road_points: RoadPoints | None = None) -> PaintedLines:
    """The `traced_lines`, whose parameters these are, named by an estimate of their own."""
    edges = EdgeSections.of(edges)
    lines = traced_lines(clustered_points, markings, frame, settings, progress.part(0.0, LINES_SHARE), edges, road_points)
    return named_by_estimate(lines, estimate_roads(lines, frame, country(settings.country).usual_lane, edges=edges, markings=markings,
                                                   road_points=road_points, paint=clustered_points, progress=progress.part(LINES_SHARE, 1.0)))


def traced_lines(clustered_points: RoadPoints, markings: MarkingObjects, frame: RoadFrame, settings: MarkingLineSettings = MarkingLineSettings(),
                 progress: Progress = Progress(), edges: RoadEdges | EdgeSections | None = None,
                 road_points: RoadPoints | None = None) -> PaintedLines:
    """Trace, link and fit the painted lines of all roads, which have no names yet.

    clustered_points : RoadPoints with `cluster`; markings : MarkingObjects of the same clusters
    edges, road_points : RoadEdges, or their EdgeSections, and RoadPoints, or None: what the lines separate is told better with them

    Returns PaintedLines with `fitted`: a line that is partly bridged, or changes between dashed and solid, comes in touching pieces with one
    `line` number, between which there is only what leads over a hatched area. Every piece is drawn on the line's one curve.

    Raises RoadExtractionError if the points were not clustered.
    """
    if not clustered_points.has_cluster:
        raise RoadExtractionError(
            "The points have no field “cluster”. Give the file that “Cluster markings” wrote, together with its layer.")
    executor = THREADS if road_points is None else road_points.executor
    selected, courses, dropped = _traced(clustered_points, markings, frame, EdgeSections.of(edges), settings, executor, progress.part(0.0, 0.5))
    phase = Phase(_lines_drawn, NoSource(), (settings.curve, settings.degree), lambda item: "the curves of marking lines",
                  listed=STRANDS.fitted_together)
    fitted = list(executor.run_together(phase, courses, progress.part(0.5, 1.0)))
    rows = [dict(row, line=number, road=road) for number, ((road, chosen), line) in enumerate(zip(selected, fitted), start=1)
            for row in _drawn_pieces(chosen, line, frame, road)]
    progress.info(f"Marking lines: {len(fitted)}; {dropped} fragments were left out.")
    replaced = sum(not line.wanted for line in fitted)
    if replaced:
        progress.warn(f"{replaced} of {len(fitted)} lines cannot take the curve “{settings.curve}”; "
                      "the automatic curve was used for them.")
    drawn = painted_lines_of(rows, frame, clustered_points.crs)
    return drawn if road_points is None else with_unseen_paint(drawn, markings, clustered_points, road_points)


def _traced(points, markings, frame, edges, settings, executor, progress):
    """[(road, SelectedLine)] of all roads, the _Course of each, and how many fragments were left out."""
    selected: list[tuple[int, SelectedLine]] = []
    courses: list[_Course] = []
    dropped, roads = 0, points.roads()
    edge_lines = edges_beside(edges, {road: hatched_areas(markings, frame, road) for road in roads})
    phase = Phase(_lines_of_road, NoSource(), (settings,), lambda item: "the marking lines of a road")
    items = Items(len(roads), lambda k: _paint_of_road(points, markings, roads[k], edge_lines[roads[k]]))
    for (of_road, places, left_out), road in zip(executor.run(phase, items, progress), roads):
        dropped += left_out
        courses += _courses(of_road, places, frame.road(road), partial(frame.track_height, road))
        selected += [(int(road), chosen) for chosen in of_road]
    return selected, courses, dropped


PAINT_OF_LINES = "s", "d", "z", "cluster", "spacing"   # that strands are traced by


def _paint_of_road(points, markings, road, edges):
    """An item of `_lines_of_road`."""
    records, rank = line_paint(columns_of_roads(points.store, [road]), markings, road)
    return {name: records[name] for name in PAINT_OF_LINES}, rank, edges


def _lines_of_road(source: NoSource, item: tuple[dict[str, np.ndarray], np.ndarray, EdgesBeside],
                  settings: MarkingLineSettings) -> tuple[list[SelectedLine], list[tuple[np.ndarray, ...]], int]:
    """The phase that traces and links the paint of one road: its lines, places along each as of `_places`, and how many fragments were left out.

    item : columns PAINT_OF_LINES of N points, and (N,) class of each, as `line_paint` gives them; the edges beside
    """
    columns, rank, edges = item
    strands = painted_strands(Columns(columns, [(name, column.dtype) for name, column in columns.items()]), rank)
    lines, trend = _linked(strands, edges, settings)
    selected = select_lines(lines, trend, settings.min_paint, edges, country(settings.country).longest_dash)
    return selected, [_places(chosen.line, trend, edges, chosen.span) for chosen in selected], len(lines) - len(selected)


def _linked(strands, edges, settings):
    """Lines of strands, and the CommonTrend they have in common."""
    trend = CommonTrend(strands)
    lines = link_lines([LinkedLine([strand]) for strand in strands], trend, edges, settings.max_gap)
    return link_over_long_gaps(lines, trend, edges, settings.max_gap, settings.max_bridge,
                               partial(same_dash_pattern, longest_dash=country(settings.country).longest_dash)), trend


def _drawn_pieces(one: SelectedLine, line: _DrawnLine, frame: RoadFrame, road: int) -> Iterator[dict[str, Any]]:
    """The pieces of one line that have a length on the map."""
    heights = np.split(frame.track_height(road, np.concatenate(line.stations)), np.cumsum([len(s) for s in line.stations])[:-1])
    for piece, arc, places, track, rmse in zip(one.pieces, line.arc, line.places, heights, line.rmse):
        if not np.ptp(places[:, :2] + frame.origin[:2], axis=0).any():
            continue
        _, paint_offsets = one.line.near(piece.first - STRANDS.paint_beside_piece, piece.last + STRANDS.paint_beside_piece)
        yield dict(
            kind="", pattern=piece.pattern, status=piece.status,
            curve=line.curve, arc=arc, places=np.column_stack([places[:, :2], places[:, 2] + track]),
            station=piece.first, end=piece.last, offset=median(paint_offsets) if len(paint_offsets) else np.nan, width=one.width(piece),
            rmse=rmse if piece.status == "measured" else np.nan)
