"""The report of a whole run: what was measured, what was bridged, how long it took."""

from collections import defaultdict

from ..progress import Progress
from .background import grey_background
from .map_picture import draw_map, png
from .page import Page
from .road_map_figures import curvature_diagrams, density_table, design_code_table, marking_curvature_table

STAGES = dict(survey="Reading and placing points", curbs="Curbs", edges="Road edges", surface="Road surface",
              intensity="Intensity correction", image="Intensity image", markings="Marking extraction",
              outliers="Outlier removal", clusters="Clustering", lines="Marking lines", driving="Driving lines")
KEY = (("#e63c3c", "road edge, measured"), ("#ff963c", "road edge, bridged"), ("#e63cff", "the two methods more than 5 cm apart"),
       ("#ffdc50", "marking"),
       ("#3cc8e6", "marking line"), ("#3cdc5a", "driving line"), ("#bfff3c", "bridged"), ("#c878dc", "inferred"))


def road_map_report(road_map, image_path=None, progress=Progress()):
    """HTML of a finished RoadMap.

    Parameters
    ----------
    road_map : core.road_map.RoadMap
    image_path : the intensity image, drawn below the map, or None
    """
    page = Page("Road map", "Made by Lanewright. Lengths are in metres; “bridged” was drawn across a gap, “inferred” "
                            "was placed from the outer lines alone; everything else was measured.")
    if road_map.without_paint:
        page.warning(road_map.without_paint)
    _picture(page, road_map, image_path)
    _survey(page, road_map)
    density_table(page, road_map)
    _road(page, road_map)
    if road_map.markings is not None:
        _markings(page, road_map)
        marking_curvature_table(page, road_map)
        _driving(page, road_map)
    page.heading("Time")
    total = sum(road_map.seconds.values())
    page.table(("Stage", "Seconds"), [*((STAGES[k], v) for k, v in road_map.seconds.items()), ("Together", total)])
    return page.html()


def _picture(page, road_map, image_path):
    background = grey_background(image_path) if image_path and road_map.image is not None else None
    layers = dict(markings=road_map.markings, edges=road_map.edges, differences=road_map.boundary_differences, marking_lines=road_map.marking_lines,
                  driving_lines=road_map.driving_lines)
    picture = draw_map(layers, background)
    if picture is not None:
        page.picture(png(picture), "The road map over the intensity image; north is up.")
        page.colour_key(KEY)


def _survey(page, road_map):
    facts = road_map.survey_facts
    page.heading("Survey")
    heights = ", ".join(f"{height:.2f} m (pass {number})" for number, height in facts["sensor_height"].items())
    page.facts((("Files", facts["files"]), ("Points read", facts["read"]), ("Points near the road", facts["kept"]),
                ("Roads", facts["roads"]), ("Passes", facts["passes"]), ("Scanners", facts["scanners"]),
                ("Trajectory above the road", heights), ("Road points", road_map.counts["road_points"])))
    for note in road_map.frame.notes:
        page.note(note)


def _lengths(features, *names):
    """Total length by the values of some fields, in the order of those values."""
    return _totals(features, "length", *names)


def _totals(features, measure, *names):
    total = defaultdict(float)
    for geometry, row in features:
        total[tuple(str(row.get(name) or "–") for name in names)] += getattr(geometry, measure)
    return [(*key, total[key]) for key in sorted(total)]


def _road(page, road_map):
    page.heading("Road edges and surface")
    if len(road_map.edges):
        page.table(("Curb", "Side", "Status", "Length (m)"), _lengths(road_map.edges, "kind", "side", "status"))
    else:
        page.text("No curb was found along this road, so no edge line was drawn.")
    if road_map.boundary_differences is not None:
        _agreement(page, road_map)
    page.table(("Status of the surface", "Area (m²)"), _totals(road_map.surface, "area", "status"))


def _agreement(page, road_map):
    """Where profiles and scanlines tell of different edges: a measure of trust where there is no truth."""
    page.heading("Agreement of the two methods")
    page.table(("Method", "Edges measured (m)"), sorted(road_map.length_by_method.items()))
    apart = [(row["length_m"], row["agree_cm"]) for row in road_map.edges.rows if row.get("agree_cm") is not None]
    length = sum(m for m, _ in apart)
    if length:
        usual = sum(m * cm for m, cm in apart) / length
        page.text(f"Both methods see {length:.0f} m of the edges drawn; 95 % of each piece keeps within {usual:.1f} cm on average.")
    stretches = road_map.boundary_differences.rows
    if not stretches:
        page.text("Nowhere do they lie more than 5 cm apart for a metre or more.")
        return
    page.text("Here they lie more than 5 cm apart; look at these places first.")
    page.table(("Road", "Side", "From (m)", "To (m)", "Apart at most (cm)"),
               [[row[name] for name in ("road", "side", "station_m", "end_m", "agree_cm")] for row in stretches])


def _markings(page, road_map):
    page.heading("Markings")
    report = road_map.intensity_report
    if report is not None:
        for line in report.lines():
            page.note(line)
    counts = road_map.counts
    page.text(f"{counts['marking_points']:,} points were taken for paint, {counts['marking_points_kept']:,} are left "
              "without outliers.")
    area, number = defaultdict(float), defaultdict(int)
    for geometry, row in road_map.markings:
        key = (row.get("class") or "–", row.get("use") or "–")
        area[key] += geometry.area
        number[key] += 1
    page.table(("Class", "Use", "Number", "Area (m²)"), [(*key, number[key], area[key]) for key in sorted(area)])
    if len(road_map.marking_lines):
        page.table(("Line", "Pattern", "Status", "Length (m)"), _lengths(road_map.marking_lines, "kind", "pattern", "status"))


def _driving(page, road_map):
    page.heading("Driving lines")
    if not len(road_map.driving_lines):
        page.text("No driving line was made: no two lines that bound a lane were found.")
        return
    page.table(("Lane", "Source", "Status", "Length (m)"), _lengths(road_map.driving_lines, "lane", "source", "status"))
    elements = road_map.curve_elements
    if len(elements):
        names = ("lane", "station_m", "end_m", "turn", "radius_m", "delta_deg", "length_m", "tangent_m", "middle_m",
                 "chord_m", "ext_m")
        page.table(("Lane", "From (m)", "To (m)", "Turn", "R (m)", "Δ (°)", "L (m)", "T (m)", "M (m)", "LC (m)", "E (m)"),
                   [[row.get(name) for name in names] for row in elements.rows])
    else:
        page.text("The driving lines have no circular arcs.")
    curvature_diagrams(page, road_map)
    design_code_table(page, road_map)
