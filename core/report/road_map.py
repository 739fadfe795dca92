"""The report of a whole run: the map, the survey, lengths and areas by status, curvature, the design code, and the time of each stage."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import numpy as np
import shapely

from ..assess.curvature import CURVATURE_BASE, curvature_along
from ..common.progress import Progress
from ..common.texts import told, tr, word
from ..countries.catalogue import country
from .figures import Chart
from .map_figure import draw_map, grey_background, png
from .page import Page, number

MAX_DIAGRAMS = 16         # of curvature; further driving lines are not drawn
MAX_JOIN_DISTANCE = 0.05  # m between the ends of pieces of one line
LINE_COLOUR, ELEMENT_COLOUR, CODE_COLOUR = "#2b6ca3", "#009e73", "#d55e00"  # of the curvature diagrams


def _stage_titles():
    return dict(survey=tr("Reading and placing points"), curbs=tr("Curbs"), edges=tr("Road edges"), surface=tr("Road surface"),
                intensity=tr("Intensity correction"), image=tr("Intensity image"), markings=tr("Marking extraction"),
                outliers=tr("Outlier removal"), clusters=tr("Clustering"), lines=tr("Marking lines"), driving=tr("Driving lines"))


def _sigma_note():
    return tr("The uncertainty is one sigma across the line, from residuals, point spacing and what passes differ by; two thirds of the places lie "
              "within it on simulated streets. What the whole trajectory is off is not in it.")


def _map_colour_key():
    return (("#e63c3c", tr("road edge, measured")), ("#ff963c", tr("road edge, bridged")), ("#e63cff", tr("the two methods more than 5 cm apart")),
            ("#ffdc50", tr("marking")), ("#3cc8e6", tr("marking line")), ("#3cdc5a", tr("driving line")),
            ("#bfff3c", tr("bridged")), ("#c878dc", tr("inferred")))


def road_map_report(road_map: Any, image_path: str | None = None, progress: Progress = Progress()) -> str:
    """The report of a RoadMap as HTML.

    Parameters
    ----------
    road_map : RoadMap of core.pipeline.road_map, which stands above this folder
    image_path : of the intensity image, which is drawn below the map, or None
    progress : Progress
    """
    page = Page(tr("Road map"), tr("Made by Lanewright. Lengths are in metres; “bridged” was drawn across a gap, “inferred” "
                                   "was placed from the outer lines alone; everything else was measured."))
    if road_map.without_paint:
        page.warning(told(road_map.without_paint))
    if road_map.surface.thin:
        page.warning(told(road_map.surface.thin))
    _picture(page, road_map, image_path)
    _survey(page, road_map)
    _density(page, road_map)
    _road(page, road_map)
    if road_map.markings is not None:
        _markings(page, road_map)
        _marking_curvature(page, road_map)
        _driving(page, road_map)
    if len(road_map.corrections):
        _corrections(page, road_map.corrections)
    page.heading(tr("Time"))
    total, titles = sum(road_map.seconds.values()), _stage_titles()
    page.table((tr("Stage"), tr("Seconds")), [*((titles[k], v) for k, v in road_map.seconds.items()), (tr("Together"), total)])
    return page.html()


def _picture(page, road_map, image_path):
    background = grey_background(image_path) if image_path and road_map.image is not None else None
    layers = dict(differences=road_map.layer("boundary_differences"),
                  **{name: road_map.layer(name) for name in ("markings", "edges", "marking_lines", "driving_lines")})
    picture = draw_map(layers, background)
    if picture is not None:
        page.picture(png(picture), tr("The road map over the intensity image; north is up."))
        page.colour_key(_map_colour_key())


def _survey(page, road_map):
    facts = road_map.survey_facts
    page.heading(tr("Survey"))
    heights = ", ".join(tr("{height:.2f} m (pass {number})").format(height=height, number=number)
                        for number, height in facts["sensor_height"].items())
    page.facts(((tr("Files"), facts["files"]), (tr("Points read"), facts["read"]), (tr("Points near the road"), facts["kept"]),
                (tr("Roads"), facts["roads"]), (tr("Passes"), facts["passes"]), (tr("Scanners"), facts["scanners"]),
                (tr("Trajectory above the road"), heights), (tr("Road points"), road_map.counts["road_points"])))
    if "trajectory" in facts:
        page.note(told(facts["trajectory"]))
    for note in road_map.frame.notes:
        page.note(told(note))


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
    """`_totals` of (N,) lengths, each with the RMS of (N,) sigmas over its length in mm, None where none is known."""
    known = np.isfinite(sigma)
    squares = {tuple(key): value for *key, value in _totals((length * sigma**2)[known], *(np.asarray(column, object)[known] for column in columns))}
    lengths = {tuple(key): value for *key, value in _totals(length[known], *(np.asarray(column, object)[known] for column in columns))}
    return [(*key, total, 1000.0 * float(np.sqrt(squares[tuple(key)] / lengths[tuple(key)])) if lengths.get(tuple(key)) else "–")
            for *key, total in _totals(length, *columns)]


def _road(page, road_map):
    page.heading(tr("Road edges and surface"))
    edges, surface = road_map.edges, road_map.surface
    if len(edges):
        page.table((tr("Edge"), tr("Where"), tr("Side"), tr("Status"), tr("Length (m)"), tr("Uncertainty (mm)")),
                   [(*map(word, key), length, sigma) for *key, length, sigma in _totals_with_sigma(
                       edges.length, edges.sigma, edges.what, edges.kind, edges.side, edges.status)])
        page.note(_sigma_note())
    else:
        page.text(tr("Neither a curb nor an edge of the pavement was found along this road, so no edge line was drawn."))
    if road_map.boundary_differences is not None:
        _agreement(page, road_map)
    page.table((tr("Status of the surface"), tr("Area (m²)")), [(word(status), area) for status, area in _totals(surface.area, surface.status)])


def _agreement(page, road_map):
    """Where profiles and scanlines find different edges: a measure of reliability without a reference."""
    page.heading(tr("Agreement of the two methods"))
    page.table((tr("Method"), tr("Edges measured (m)")), [(word(name), length) for name, length in sorted(road_map.length_by_method.items())])
    edges, differences = road_map.edges, road_map.boundary_differences
    seen = np.isfinite(edges.agree)
    length = edges.length[seen].sum()
    if length:
        usual = (edges.length * edges.agree)[seen].sum() / length
        page.text(tr("Both methods see {length:.0f} m of the edges drawn; 95 % of each piece keeps within {usual:.1f} cm on average.").format(
            length=length, usual=usual))
    if not len(differences):
        page.text(tr("Nowhere do they lie more than 5 cm apart for a metre or more."))
        return
    page.text(tr("Here they lie more than 5 cm apart; look at these places first."))
    page.table((tr("Road"), tr("Side"), tr("From (m)"), tr("To (m)"), tr("Apart at most (cm)")),
               list(zip(differences.road.tolist(), map(word, differences.side.tolist()), *(
                   values.tolist() for values in (differences.station, differences.end, differences.agree)))))


def _markings(page, road_map):
    page.heading(tr("Markings"))
    report = road_map.intensity_report
    if report is not None:
        for line in report.lines():
            page.note(told(line))
    counts = road_map.counts
    page.text(tr("{taken} points were taken for paint, {kept} are left without outliers.").format(
        taken=number(int(counts["marking_points"])), kept=number(int(counts["marking_points_kept"]))))
    area, count = defaultdict(float), defaultdict(int)
    for geometry, row in road_map.markings:
        key = (row.get("class") or "–", row.get("use") or "–")
        area[key] += geometry.area
        count[key] += 1
    page.table((tr("Class"), tr("Use"), tr("Number"), tr("Area (m²)")),
               [(word(key[0], "class"), word(key[1], "use"), count[key], area[key]) for key in sorted(area)])
    if len(road_map.marking_lines):
        page.table((tr("Line"), tr("Pattern"), tr("Status"), tr("Length (m)")), _lengths(road_map.marking_lines, "kind", "pattern", "status"))


def _driving(page, road_map):
    page.heading(tr("Driving lines"))
    if not len(road_map.driving_lines):
        page.text(tr("No driving line was made: no two lines that bound a lane were found."))
        return
    lines = road_map.driving_lines
    page.table((tr("Lane"), tr("Source"), tr("Status"), tr("Length (m)"), tr("Uncertainty (mm)")),
               [(*map(word, key), length, sigma) for *key, length, sigma in _totals_with_sigma(
                   shapely.length(lines.geometries), np.array(lines.column("sigma_m", np.nan), float),
                   *(lines.column(name) for name in ("lane", "source", "status")))])
    page.note(_sigma_note())
    elements = road_map.curve_elements
    if len(elements):
        names = ("lane", "station_m", "end_m", "turn", "radius_m", "delta_deg", "length_m", "tangent_m", "middle_m",
                 "chord_m", "ext_m")
        page.table((tr("Lane"), tr("From (m)"), tr("To (m)"), tr("Turn"), "R (m)", "Δ (°)", "L (m)", "T (m)", "M (m)", "LC (m)", "E (m)"),
                   [[word(row.get(name)) if name == "turn" else row.get(name) for name in names] for row in elements.rows])
    else:
        page.text(tr("The driving lines have no circular arcs."))
    _curvature_diagrams(page, road_map)
    _design_code(page, road_map)


def _corrections(page, corrections):
    """What an analyst asked for, and what of it this run has nothing for."""
    page.heading(tr("Corrections"))
    lost = {one.row for one in corrections.unmatched}
    if lost:
        page.warning(tr("Corrections that match nothing in this run and were left out: {count}. Look at these places and delete or renew the "
                        "rows.").format(count=len(lost)))
    page.table((tr("Row"), tr("Action"), tr("Target"), tr("Road"), tr("Station (m)"), tr("Offset (m)"), tr("Note"), tr("Made")),
               [(one.row, word(one.action), word(one.target, "target"), one.road if one.on_a_road else "–", one.station if one.on_a_road else "–",
                 one.offset if one.on_a_road else "–", one.note or "–", tr("no") if one.row in lost else tr("yes"))
                for one in sorted(corrections.rows, key=lambda one: (one.row not in lost, one.row))])


def _density(page, road_map):
    """Points per cubic metre before and after the surface was extracted."""
    before, after = road_map.density
    if not before.points:
        return
    page.heading(tr("Point density"))
    page.table(("", tr("Points"), tr("Per m³, mean of occupied cubes"), tr("Per m³, as a point sees it")),
               [(name, found.points, found.mean, found.of_a_point) for name, found in (
                   (tr("Before: points near the road"), before), (tr("After: road surface"), after))])
    page.note(tr("Cubes of 1 m. {share:.1f} % of the points near the road are its surface. “As a point sees it” is the "
                 "mean over points of how many share their cube.").format(share=100 * after.points / before.points))


def _marking_curvature(page, road_map):
    """Mean curvature of the marking points before and after fitting."""
    found = road_map.marking_curvature
    if found is None:
        return
    page.table((tr("Mean curvature of marking points (1/m)"), tr("Before fitting"), tr("After fitting")),
               [(tr("kernel of 0.2 m, {count} points").format(count=found.points), found.before, found.after)], (None, 4, 4))
    page.note(tr("Absolute mean curvature of the surface through the points of line markings, as measured and at the height of the line fitted "
                 "to them: how rough a marking is, not how the road bends."))


def _curvature_diagrams(page, road_map):
    """Curvature along each driving line, with the arcs found and the least radii of the design code."""
    lanes = {}
    for geometry, row in road_map.driving_lines:
        lanes.setdefault((row["road"], row["lane"]), []).append((geometry, row))
    if not lanes:
        return
    page.heading(tr("Curvature along the driving lines"))
    elements, code = road_map.curve_elements.rows, country(road_map.country)
    for road, lane in list(sorted(lanes))[:MAX_DIAGRAMS]:
        arcs = [row for row in elements if (row["road"], row["lane"]) == (road, lane)]
        chart = _diagram(sorted(lanes[road, lane], key=lambda piece: piece[1]["station_m"]), arcs, code)
        if chart is not None:
            page.drawing(chart, (tr("Road {road}, lane {lane}.") if len({key[0] for key in lanes}) > 1 else tr("Lane {lane}.")).format(
                road=road, lane=lane))
    page.colour_key(((LINE_COLOUR, tr("the line as drawn")), (ELEMENT_COLOUR, tr("arcs of the table of curve elements")),
                     (CODE_COLOUR, tr("least radius for the speed, {code}").format(code=code.design_code))))
    page.note(tr("In 1/m, in the direction of travel, positive to the left; from the headings of the {base:g} m behind and ahead. "
                 "Stations are the road's.").format(base=CURVATURE_BASE))
    if len(lanes) > MAX_DIAGRAMS:
        page.note(tr("{count} further driving lines are not drawn.").format(count=len(lanes) - MAX_DIAGRAMS))


def _diagram(pieces, arcs, code):
    """SVG of one lane; None where its pieces are too short for a curvature."""
    curves = []
    for line, station in _joined(pieces):
        along, bend = curvature_along(line)
        if len(along):
            vertices = np.r_[0.0, np.cumsum(np.hypot(*np.diff(shapely.get_coordinates(line), axis=0).T))]
            curves.append((np.interp(along, vertices, station), bend))
    if not curves:
        return None
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


def _design_code(page, road_map):
    """The check of every curve against the design code."""
    elements = road_map.curve_elements.rows
    if not elements:
        return
    code = country(road_map.country)
    page.heading(tr("Design code check, {code}").format(code=code.design_code))
    below = tr("less than {speed}").format(speed=code.design_speeds[0].speed)
    page.table((tr("Lane"), tr("From (m)"), "R (m)", "L (m)", tr("Allows (km/h)"), tr("Why")),
               [(row["lane"], row["station_m"], row["radius_m"], row["length_m"], str(row["speed_kmh"] or below),
                 told(row["code"]).removeprefix(f"{code.design_code}: ")) for row in elements])
    page.table((tr("Speed (km/h)"), tr("Least radius (m)"), tr("Least length of a curve (m)")),
               [(row.speed, round(row.radius), row.length or "–") for row in code.design_speeds])
