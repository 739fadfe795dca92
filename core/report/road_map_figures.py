"""The figures of the driving-line thesis in the road map report: density, curvature of markings, curvature diagrams, design code."""

import numpy as np
import shapely

from ..assess.curvature import DIAGRAM_BASE, curvature_along
from ..driving.elements import DESIGN_CODE
from .chart import Chart

MOST_DIAGRAMS = 16
TOUCHING = 0.05  # m between the ends of pieces of one line
LINE, ELEMENT, CODE = "#2b6ca3", "#009e73", "#d55e00"


def density_table(page, road_map):
    """Points per cubic metre before and after the surface was extracted."""
    before, after = road_map.density
    if not before.points:
        return
    page.heading("Point density")
    page.table(("", "Points", "Per m³, mean of occupied cubes", "Per m³, as a point sees it"),
               [(name, found.points, found.mean, found.of_a_point) for name, found in (
                   ("Before: points near the road", before), ("After: road surface", after))])
    page.note(f"Cubes of 1 m. {100 * after.points / before.points:.1f} % of the points near the road are its surface. “As a point sees it” is the "
              "mean over points of how many share their cube.")


def marking_curvature_table(page, road_map):
    """Mean curvature of the marking points before and after fitting."""
    found = road_map.marking_curvature
    if found is None:
        return
    page.table(("Mean curvature of marking points (1/m)", "Before fitting", "After fitting"),
               [(f"kernel of 0.2 m, {found.points} points", found.before, found.after)], (None, 4, 4))
    page.note("Absolute mean curvature of the surface through the points of line markings, as measured and at the height of the line fitted "
              "to them: how rough a marking is, not how the road bends.")


def curvature_diagrams(page, road_map):
    """Curvature along each driving line, with the arcs found and the least radii of the design code."""
    lanes = {}
    for geometry, row in road_map.driving_lines:
        lanes.setdefault((row["road"], row["lane"]), []).append((geometry, row))
    if not lanes:
        return
    page.heading("Curvature along the driving lines")
    elements = road_map.curve_elements.rows
    for road, lane in list(sorted(lanes))[:MOST_DIAGRAMS]:
        arcs = [row for row in elements if (row["road"], row["lane"]) == (road, lane)]
        chart = _diagram(sorted(lanes[road, lane], key=lambda piece: piece[1]["station_m"]), arcs)
        if chart is not None:
            page.drawing(chart, f"Road {road}, lane {lane}." if len({key[0] for key in lanes}) > 1 else f"Lane {lane}.")
    page.colour_key(((LINE, "the line as drawn"), (ELEMENT, "arcs of the table of curve elements"),
                     (CODE, "least radius for the speed, CJJ 37-2012")))
    page.note(f"In 1/m, in the direction of travel, positive to the left; from the headings of the {DIAGRAM_BASE:g} m behind and ahead. "
              "Stations are the road's.")
    if len(lanes) > MOST_DIAGRAMS:
        page.note(f"{len(lanes) - MOST_DIAGRAMS} further driving lines are not drawn.")


def _diagram(pieces, arcs):
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
    chart = Chart((stations.min(), stations.max()), (-reach, reach), "station (m)", "1/m", height=170)
    for speed, radius, _ in DESIGN_CODE:
        if 1 / radius < reach and speed in (30, 50, 80):
            chart.level(1 / radius, CODE, f"R {radius:.0f} m, {speed} km/h")
            chart.level(-1 / radius, CODE)
    for first, last, bend in steps:
        chart.curve(np.array([first, last]), np.array([bend, bend]), ELEMENT, f"R {abs(1 / bend):.1f} m", width=5)
    for station, bend in curves:
        chart.curve(station, bend, LINE)
    return chart.svg()


def _joined(pieces):
    """(line, station of its vertices) of a lane's pieces, put together where one ends and the next begins: status cuts them, not the curve."""
    against = pieces[0][1]["direction"] < 0
    parts = []
    # a line is drawn in the direction of travel, stations run with the road
    for line, row in reversed(pieces) if against else pieces:
        xy = shapely.get_coordinates(line)
        along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(xy, axis=0).T))]
        first, last = (row["end_m"], row["station_m"]) if against else (row["station_m"], row["end_m"])
        station = first + (last - first) * along / along[-1]
        if parts and np.hypot(*(parts[-1][0][-1] - xy[0])) < TOUCHING:
            parts[-1] = np.concatenate([parts[-1][0], xy[1:]]), np.concatenate([parts[-1][1], station[1:]])
        else:
            parts.append((xy, station))
    return [(shapely.LineString(xy), station) for xy, station in parts]


def design_code_table(page, road_map):
    """What the design code says of every curve."""
    elements = road_map.curve_elements.rows
    if not elements:
        return
    page.heading("Design code check, CJJ 37-2012")
    page.table(("Lane", "From (m)", "R (m)", "L (m)", "Allows (km/h)", "Why"),
               [(row["lane"], row["station_m"], row["radius_m"], row["length_m"], str(row["speed_kmh"] or f"less than {DESIGN_CODE[0][0]}"),
                 row["code"].removeprefix("CJJ 37-2012: ")) for row in elements])
    page.table(("Speed (km/h)", "Least radius (m)", "Least length of a curve (m)"), DESIGN_CODE)
