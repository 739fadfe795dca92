"""The report of a whole run: the map, lengths and areas by status, curvature and the design code."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import numpy as np
import shapely

from ...core.common.texts import tr, word
from ...core.countries.catalogue import country
from ...core.survey.store.records import Points
from ...core.survey.store.road_points import columns_of_roads
from .curvature import marking_curvature
from .page import Chart, draw_map, grey_background, html_page

DRAWN = "boundary_differences", "markings", "edges", "marking_lines", "driving_lines"   # layers of the overview
MAX_DIAGRAMS = 16         # of curvature; further driving lines are not drawn
CURVATURE_STEP = 1.0      # m between the values of a curvature diagram
CURVATURE_BASE = 5.0      # m to either side over which the change of heading is measured
MAX_JOIN_DISTANCE = 0.05  # m between the ends of pieces of one line
LINE_COLOUR, ELEMENT_COLOUR, CODE_COLOUR = "#2b6ca3", "#009e73", "#d55e00"  # of the curvature diagrams


def road_map_report(road_map: Any, image_path: str | None = None) -> str:
    """The report of a RoadMap of core.pipeline as HTML, its map over the intensity image of a path, or over nothing."""
    edges, surface, corrections = road_map.edges, road_map.surface, road_map.corrections
    lost = {one.row for one in corrections.unmatched}
    values = dict(
        map=road_map, notes=[note for note in (road_map.without_paint, surface.thin) if note],
        overview=draw_map({name.removeprefix("boundary_"): road_map.layer(name) for name in DRAWN},
                          grey_background(image_path) if image_path and road_map.markings is not None else None),
        edges=_totals_with_sigma(edges.length, edges.sigma, edges.what, edges.kind, edges.side, edges.status),
        areas=[(word(status), area) for status, area in _totals(surface.area, surface.status)], lost=lost,
        corrections=sorted(corrections.rows, key=lambda one: (one.row not in lost, one.row)))
    if road_map.boundary_differences is not None:
        values |= _agreement(edges, road_map.boundary_differences)
    if road_map.markings is not None:
        paint = Points(columns_of_roads(road_map.paint.store, road_map.paint.roads()))
        values |= dict(markings=_markings(road_map.markings), marking_lines=_lengths(road_map.marking_lines, "kind", "pattern", "status"),
                       curvature=marking_curvature(paint, road_map.marking_lines.geometries, road_map.frame.origin))
        values |= _driving(road_map)
    return html_page("road_map", **values)


def _lengths(features, *names):
    """Total length by the values of some fields, in the order of those values, which are given in the user's words."""
    return [(*(word(value, name) for value, name in zip(key, names)), length)
            for *key, length in _totals(shapely.length(features.geometries), *(features.column(name) for name in names))]


def _totals(measure, *columns):
    """Sums of (N,) lengths or areas by the values of (N,) columns, in the order of those values."""
    total = defaultdict(float)
    for value, *key in zip(measure, *columns):
        total[tuple(str(part or "–") for part in key)] += value
    return [(*key, total[key]) for key in sorted(total)]


def _totals_with_sigma(length, sigma, *columns):
    """`_totals` of (N,) lengths in the user's words, each with the RMS of (N,) sigmas over its length in mm, a dash where none is known."""
    known = np.isfinite(sigma)
    totals = (_totals(values, *columns) for values in (length, np.where(known, length, 0.0), np.where(known, length * sigma**2, 0.0)))
    return [(*map(word, key), total, 1000.0 * float(np.sqrt(square / of_known)) if of_known else "–")
            for (*key, total), (*_, of_known), (*_, square) in zip(*totals)]


def _agreement(edges, differences):
    """Where profiles and scanlines find different edges: a measure of reliability without a reference."""
    compared = np.isfinite(edges.agree)
    length = edges.length[compared].sum()
    return dict(agreement=(length, (edges.length * edges.agree)[compared].sum() / length) if length else None,
                differences=list(zip(differences.road.tolist(), map(word, differences.side.tolist()), *(
                    values.tolist() for values in (differences.station, differences.end, differences.agree)))))


def _markings(markings):
    """(class, use, number, area) of markings."""
    columns = markings.column("class"), markings.column("use")
    return [(word(kind, "class"), word(use, "use"), int(count), area) for (kind, use, area), (*_, count) in zip(
        _totals(shapely.area(markings.geometries), *columns), _totals(np.ones(len(markings)), *columns))]


def _driving(road_map):
    """Lengths of the driving lines, and their curvature with the arcs found and the least radii of the design code."""
    lines, elements, code = road_map.driving_lines, road_map.curve_elements.rows, country(road_map.country)
    lanes = defaultdict(list)
    for geometry, row in lines:
        lanes[row["road"], row["lane"]].append((geometry, row))
    diagrams = [(road, lane, _diagram(sorted(lanes[road, lane], key=lambda piece: piece[1]["station_m"]),
                                      [row for row in elements if (row["road"], row["lane"]) == (road, lane)], code))
                for road, lane in sorted(lanes)[:MAX_DIAGRAMS]]
    return dict(
        code=code, diagrams=diagrams, several_roads=len({road for road, _ in lanes}) > 1, not_drawn=len(lanes) - MAX_DIAGRAMS,
        curvature_base=CURVATURE_BASE, colours=(LINE_COLOUR, ELEMENT_COLOUR, CODE_COLOUR),
        driving_lines=_totals_with_sigma(shapely.length(lines.geometries), np.array(lines.column("sigma_m", np.nan), float),
                                         *(lines.column(name) for name in ("lane", "source", "status"))))


def _diagram(pieces, arcs, code):
    """SVG of one lane; "" where its pieces are too short for a curvature."""
    curves = []
    for line, station in _joined(pieces):
        along, bend = curvature_along(line)
        if len(along):
            vertices = np.r_[0.0, np.cumsum(np.hypot(*np.diff(shapely.get_coordinates(line), axis=0).T))]
            curves.append((np.interp(along, vertices, station), bend))
    if not curves:
        return ""
    steps = [(row["station_m"], row["end_m"], (1 if row["turn"] == "left" else -1) / row["radius_m"]) for row in arcs]
    bends = np.concatenate([bend for _, bend in curves] + [np.array([k for *_, k in steps])])
    reach = max(1.25 * float(np.abs(bends).max()), 0.004)
    stations = np.concatenate([station for station, _ in curves])
    chart = Chart((stations.min(), stations.max()), (-reach, reach), tr("station (m)"), "1/m", height=170)
    shown = code.design_speeds[::max(1, (len(code.design_speeds) + 1) // 3)]   # three at most: more would lie on each other
    for row in shown:
        if 1 / row.radius < reach:
            chart.level(1 / row.radius, CODE_COLOUR, f"R {row.radius:.0f} m, {row.speed} km/h")
            chart.level(-1 / row.radius, CODE_COLOUR)
    for first, last, bend in steps:
        chart.curve(np.array([first, last]), np.array([bend, bend]), ELEMENT_COLOUR, f"R {abs(1 / bend):.1f} m", width=5)
    for station, bend in curves:
        chart.curve(station, bend, LINE_COLOUR)
    return chart.svg()


def _joined(pieces):
    """(line, stations of its vertices) of a lane's pieces, joined where one ends and the next begins: they are cut by status, not by shape."""
    against = pieces[0][1]["direction"] < 0
    parts = []
    # a line is drawn in the direction of travel, stations run with the road
    for line, row in reversed(pieces) if against else pieces:
        xy = shapely.get_coordinates(line)
        along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(xy, axis=0).T))]
        first, last = (row["end_m"], row["station_m"]) if against else (row["station_m"], row["end_m"])
        station = first + (last - first) * along / along[-1]
        if parts and np.hypot(*(parts[-1][0][-1] - xy[0])) < MAX_JOIN_DISTANCE:
            parts[-1] = np.concatenate([parts[-1][0], xy[1:]]), np.concatenate([parts[-1][1], station[1:]])
        else:
            parts.append((xy, station))
    return [(shapely.LineString(xy), station) for xy, station in parts]


def curvature_along(line: shapely.LineString, step: float = CURVATURE_STEP, base: float = CURVATURE_BASE) -> tuple[np.ndarray, np.ndarray]:
    """((N,) m along a line, every `step`; (N,) curvature there, 1/m, positive where it turns left) in the direction it is drawn.

    The curvature is the change of heading between the chords of `base` metres behind and ahead; there is none where a line is shorter than both.
    """
    length = line.length
    station = np.arange(base, length - base + 1e-9, step)
    if not len(station):
        return np.empty(0), np.empty(0)
    behind, middle, ahead = (shapely.get_coordinates(shapely.line_interpolate_point(line, station + k)) for k in (-base, 0.0, base))
    first, second = np.arctan2(*(middle - behind).T[::-1]), np.arctan2(*(ahead - middle).T[::-1])
    turn = (second - first + np.pi) % (2 * np.pi) - np.pi
    return station, turn / base
