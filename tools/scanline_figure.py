"""How boundaries from scanlines depend on interval, density and speed, measured on sample surveys with known truth.

Every setting keeps its default but the one of its row. Writes docs/img/scanlines.svg and the table between the
markers in docs/scanlines.md: tools/scanline_figure.sh
"""

import argparse
from pathlib import Path

from plugin_package import ROOT, load

PAGE, FIGURE = ROOT / "docs" / "scanlines.md", ROOT / "docs" / "img" / "scanlines.svg"
BEGIN, END = "<!-- table of tools/scanline_figure.sh -->", "<!-- end of the table -->"
SPEEDS = (15.0, 45.0)                           # km/h
INTERVALS = (0.05, 0.10, 0.20, 0.30, 0.50)      # m
KEPT = (1, 2, 4, 8)                             # one scan line in so many
ROTATION = 100.0                                # lines per second of each scanner
TOLERANCE = 0.10                                # m
COLOURS = {15.0: "#1f6fb2", 45.0: "#c8502c"}


def make(folder, speed, length):
    """A sample survey of a street at one speed; (cloud, SampleSurvey)."""
    from lanewright.simulator.survey import SampleSettings, make_sample_survey

    sample = make_sample_survey(SampleSettings(length=length, speed_kmh=speed, rotation_rate=ROTATION, pulse_rate=150_000.0))
    cloud = folder / f"street_{speed:.0f}.laz"
    if not cloud.exists():
        sample.write_cloud(cloud)
    return cloud, sample


def thinned(cloud, keep):
    """The cloud with one scan line of `keep` left, whole lines at a time."""
    import laspy
    import numpy as np

    if keep == 1:
        return cloud
    path = cloud.with_name(f"{cloud.stem}_{keep}.laz")
    if not path.exists():
        points = laspy.read(cloud)
        turn = np.floor((points.gps_time - np.floor(points.gps_time.min())) * ROTATION + 1e-3)
        points.points = points.points[turn % keep == 0]
        points.write(path)
    return path


def measure(survey, sample, interval):
    """F1 and the errors of scanline boundaries against the sample's truth."""
    from lanewright.core.road.edges.fit import fit_road_edges
    from lanewright.core.road.scanlines.detect import SurveyScanlines, curbs_from_scanlines
    from lanewright.core.road.scanlines.section_planes import ScanlineSettings
    from lanewright.products.assess.lines import assess_boundaries

    edges = fit_road_edges(curbs_from_scanlines(SurveyScanlines(survey, ScanlineSettings(interval=interval))), survey.frame)
    truth, dropped = [], []
    for geometry, row in sample.truth_boundaries:
        if row.get("part") != "top":
            (dropped if row["edge"] == "dropped" else truth).append(geometry)
    found = assess_boundaries(list(edges.on_map(survey.frame)), truth, frame=survey.frame, excluded=dropped, reasons=["dropped"] * len(dropped))
    accuracy = found.total[TOLERANCE]
    return dict(f1=100 * accuracy.rates.f1, lateral=1000 * accuracy.lateral.rmse, height=1000 * accuracy.height.rmse)


def rows_of(folder, length):
    """[(speed, kept, interval, figures)] of every variation."""
    from lanewright.core.survey.open_survey import open_survey

    rows = []
    for speed in SPEEDS:
        cloud, sample = make(folder, speed, length)
        for keep in KEPT:
            survey = open_survey([thinned(cloud, keep)], sample.trajectory)
            for interval in INTERVALS if keep == 1 else INTERVALS[1:2]:
                rows.append((speed, keep, interval, measure(survey, sample, interval)))
                print(*rows[-1], flush=True)
            survey.store.close()
    return rows


def table(rows):
    lines = ["| speed | scan lines kept | interval | F1 within 10 cm | across, RMSE | height, RMSE |", "|---|---|---|---|---|---|"]
    for speed, keep, interval, found in rows:
        lines.append(f"| {speed:.0f} km/h | {'all' if keep == 1 else f'1 in {keep}'} | {interval:.2f} m | {found['f1']:.1f} | "
                     f"{found['lateral']:.1f} mm | {found['height']:.1f} mm |")
    return "\n".join(lines)


def figure(rows):
    """Two panels: F1 over the interval and over the density, a line for each speed."""
    panels = [("Interval between section planes (m)", lambda keep, interval: keep == 1, 2, INTERVALS, "{:.2f}"),
              ("Scan lines kept: one in", lambda keep, interval: interval == INTERVALS[1], 1, KEPT, "{}")]
    width, height, left, top, inner_w, inner_h = 860, 330, 60, 30, 330, 230
    low = min(80.0, 5 * (min(found["f1"] for *_, found in rows) // 5))
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="13">',
             f'<rect width="{width}" height="{height}" fill="white"/>']

    def text(x, y, words, anchor="middle", colour="#333"):
        parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{words}</text>')

    for number, (title, chosen, column, places, form) in enumerate(panels):
        x0 = left + number * (inner_w + 80)

        def at(place, value):
            return x0 + (places.index(place) + 0.5) * inner_w / len(places), top + inner_h * (100.0 - value) / (100.0 - low)

        for k in range(5):
            value = low + k * (100.0 - low) / 4
            y = at(places[0], value)[1]
            parts.append(f'<line x1="{x0}" x2="{x0 + inner_w}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>')
            text(x0 - 8, y + 4, f"{value:.0f}", "end")
        for place in places:
            text(at(place, low)[0], top + inner_h + 20, form.format(place))
        text(x0 + inner_w / 2, top + inner_h + 44, title)
        for speed in SPEEDS:
            line = [(row[column], row[3]["f1"]) for row in rows if row[0] == speed and chosen(row[1], row[2])]
            points = [at(*entry) for entry in line]
            parts.append(f'<polyline fill="none" stroke="{COLOURS[speed]}" stroke-width="2" points="'
                         + " ".join(f"{x:.1f},{y:.1f}" for x, y in points) + '"/>')
            parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{COLOURS[speed]}"/>' for x, y in points]
    text(left, 18, "F1 within 10 cm (%), simulated data", "start")
    for k, speed in enumerate(SPEEDS):
        text(width - 180 + 90 * k, 18, f"● {speed:.0f} km/h", "start", COLOURS[speed])
    return "\n".join([*parts, "</svg>"]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "scanlines")
    parser.add_argument("--length", type=float, default=160.0, help="m of road")
    arguments = parser.parse_args()
    load()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    rows = rows_of(arguments.folder, arguments.length)
    FIGURE.write_text(figure(rows), encoding="utf-8")
    page = PAGE.read_text(encoding="utf-8")
    before, after = page.split(BEGIN)[0], page.split(END)[1]
    PAGE.write_text(f"{before}{BEGIN}\n{table(rows)}\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
