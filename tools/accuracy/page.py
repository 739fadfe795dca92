"""The figures of all surveys as docs/accuracy.md."""

from . import published
from .poorer_page import poorer_section, sigma_section
from .roadside import roadside_section
from .streets_page import confidence_section, otherwise_section, streets_section
from .tables import label, mean, number, table, triple

STAGES = {"Road surface": ("survey", "curbs", "edges", "surface"), "Marking extraction": ("intensity", "image", "markings"),
          "Outlier removal": ("outliers",), "Clustering": ("clusters",), "Lines": ("lines", "driving")}


def page(figures, samples):
    every, figures = figures, [f for f in figures if f["steps"]]
    sections = (_intro(every, samples), streets_section(every), otherwise_section(every), confidence_section(every),
                poorer_section(every), sigma_section(every), roadside_section(every), _road_points(figures), _cells(figures),
                _classes(figures), _seconds(figures),
                _markings(figures), _methods(figures), _driving(figures), _boundaries(figures))
    return "\n\n".join(section for section in sections if section) + "\n"


def _intro(figures, samples):
    what = ("`make accuracy` makes the sample scenes anew, runs every method over them and writes this page. The surveys are "
            "**simulated**: figures on them say how the methods compare and what a change does, not what they reach on your road."
            if samples else "`make accuracy SURVEYS=folder` ran every method over the surveys of a folder and wrote this page.")
    rows = [[label(f), f["text"] or "–", f"{f['points']:,}"] for f in figures]
    return "\n\n".join((
        "# Accuracy", what,
        "Beside our figures stand those of the two papers that the methods come from, measured by their authors on other, real roads: "
        "the thesis on driving lines (University of Waterloo, 2018) and the paper on normalized scanlines (ISPRS Archives, 2020). "
        "They are there for the order of magnitude; only rows of one survey can be compared with each other. All our figures are with "
        "default parameters, the same for every survey, and are per cent where no unit is given. Except for the seconds, which are those "
        "of the machine, the command writes the same page every time.",
        table(["survey", "what it is", "points"], rows, words=2),
        "To measure on surveys of your own: `make accuracy SURVEYS=folder`, where each survey is a folder with `cloud.laz`, "
        "`trajectory.csv` (time, x, y, z) and `truth.gpkg` (or `truth/truth.gpkg`) with any of the layers `boundaries` or "
        "`curb_bottom` (lines; `side`; `edge` = *curb*, *dropped* or *pavement*, `kind` = *main*, *corner*, *island* or "
        "*side_street*), `markings` (polygons; `class`), `driving_lines`, `roadside` (lines; `kind`) and "
        "`surface` or `road_surface`. Optional are `truth/scanned.tif`, empty where nothing was seen and paint is not judged, and "
        "`about.json`: `{\"kind\": \"real\", \"text\": \"what it is\", \"steps\": true, \"poorer\": false}`; without steps only the road "
        "map as a whole is judged, and with poorer also that of the survey with something lacking. The page is written into that folder."))


def _road_points(figures):
    rows = [[label(f), f"{f['points']:,}", f"{f['road_points']:,}", number(100 * f["road_points"] / f["points"])] for f in figures]
    rows += [[f"thesis, data set {k}", f"{raw:,}", f"{road:,}", number(100 * road / raw)]
             for k, (raw, road) in enumerate(published.ROAD_POINTS, start=1)]
    return "## Points left by surface extraction (thesis, table 4.2)\n\n" + table(["survey", "points", "road points", "kept (%)"], rows)


def _with(figures, key):
    return [f for f in figures if f.get(key)]


def _cells(figures):
    figures = _with(figures, "cells")
    if not figures:
        return ""
    sizes = list(published.IMAGE_SIZE)
    head = ["", *(f"{size} cm" for size in sizes)]
    rows = []
    for f in figures:
        rows.append([f"{label(f)}: image (MB)", *(number(f["cells"][size]["megabytes"], 2) for size in sizes)])
        rows.append([f"{label(f)}: F1 of the markings", *(number(f["cells"][size]["tolerant"]["f1"]) for size in sizes)])
    rows.append(["thesis: image (MB)", *(number(published.IMAGE_SIZE[size], 2) for size in sizes)])
    return ("## Resolution of the intensity image (thesis, tables 4.3 and 4.4)\n\nOur images are 32-bit and compressed. The thesis "
            "chose 4 cm because the smallest markings are still seen there; so do we.\n\n" + table(head, rows))


def _classes(figures):
    figures = _with(figures, "cells")
    if not figures:
        return ""
    sizes = list(published.IMAGE_SIZE)
    names = sorted({name for f in figures for size in sizes for name in f["cells"][size]["classes"]})
    rows = [[name, *(number(mean([f["cells"][size]["classes"].get(name) for f in figures])) for size in sizes)] for name in names]
    return ("What is still seen, as the share of each kind of marking that is found (mean over the surveys; one cell of 4 cm of tolerance):"
            "\n\n" + table(["marking", *(f"{size} cm" for size in sizes)], rows))


def _seconds(figures):
    rows = []
    for name, stages in STAGES.items():
        ours = [number(sum(f["seconds"].get(stage, 0) for stage in stages)) for f in figures]
        rows.append([name, *ours, number(mean(published.SECONDS[name]))])
    rows.append(["Whole", *(number(sum(f["seconds"].values())) for f in figures), number(mean(published.SECONDS["Whole"]))])
    rows.append(["Whole, seconds per million points", *(number(sum(f["seconds"].values()) / f["points"] * 1e6) for f in figures),
                 number(sum(published.SECONDS["Whole"]) / sum(raw for raw, _ in published.ROAD_POINTS) * 1e6)])
    return ("## Seconds (thesis, table 4.12)\n\nThe surface includes reading the survey. The thesis's column is the mean of its six data "
            "sets (i5-6400, C++ with PCL).\n\n" + table(["stage", *(label(f) for f in figures), "thesis"], rows))


def _markings(figures):
    figures = [f for f in figures if f["whole"]["markings"]]
    if not figures:
        return ""
    rows = []
    for f in figures:
        found = f["whole"]["markings"]
        rows.append([label(f), triple(found["tolerant"]), triple(found["strict"])])
    for k, row in enumerate(published.MARKINGS, start=1):
        name = f"thesis, data set {k}" if k <= 6 else "thesis, mean"
        rows.append([name, " / ".join(number(value) for value in row), "–"])
    return ("## Road markings (thesis, table 4.13)\n\nRecall / precision / F1 in cells of 4 cm against the painted shapes, with one cell of "
            "tolerance and strictly. Worn paint counts as painted; paint that was never scanned is not judged where the truth says so.\n\n"
            + table(["survey", "one cell of tolerance", "strict"], rows))


def _methods(figures):
    figures = _with(figures, "methods")
    if not figures:
        return ""
    methods = list(published.METHODS)
    rows = []
    for f in figures:
        for kind, text in (("mask", "as extracted"), ("polygons", "after our clustering")):
            rows.append([f"{label(f)}, {text}", *(triple(f["methods"][m][kind]["tolerant"]) for m in methods)])
    best = []
    for kind, text in (("mask", "as extracted"), ("polygons", "after our clustering")):
        f1 = {m: mean([f["methods"][m][kind]["tolerant"]["f1"] for f in figures]) or 0.0 for m in methods}
        best.append(f"{text} {max(f1, key=f1.get)} ({number(max(f1.values()))})")
        cells = [" / ".join(number(mean([f["methods"][m][kind]["tolerant"][name] for f in figures]))
                            for name in ("recall", "precision", "f1")) for m in methods]
        rows.append([f"mean, {text}", *cells])
    rows.append(["thesis, mean of data sets 1, 4, 5", *(" / ".join(number(v) for v in published.METHODS[m]) for m in methods)])
    return ("## Three ways of finding paint (thesis, table 4.14)\n\nRecall / precision / F1 with one cell of tolerance. All three get the same "
            "road points with the same corrected intensity. *As extracted* is the mask of each method; *after our clustering* adds outlier "
            "removal and clustering, which also drop what is no marking, and so help the other two.\n\n"
            "*intensity-peaks* follows Chen et al. (2009): profiles, a running median of 5, peaks of a least prominence and width, chained "
            "along the road; it finds lines only. Ours are its numbers (prominence 7, chains that show in three of five profiles), chosen "
            "so that a road without paint stays empty. *point-segments* follows Yu et al. (2015) without its learned part: Otsu's threshold "
            "on the points of segments of 10 m by 1 m and a filter by density. Ours are the sizes, the refusal to split a segment without "
            "paint, and the share of neighbours that is enough. The numbers were chosen once and are the same for all surveys. Neither of the "
            "two tells a concrete gutter from paint.\n\n"
            f"The highest mean F1 on these surveys: {' and '.join(best)}.\n\n"
            + table(["survey", "intensity-peaks (Chen)", "point-segments (Yu)", "multi-threshold (ours)"], rows))


def _driving(figures):
    figures = [f for f in figures if f["whole"]["driving"]]
    if not figures:
        return ""
    rows = []
    for f in figures:
        found = f["whole"]["driving"]
        cells = [f"{number(found['recall'][w])} / {number(found['miscoding'][w])}" for w in published.DRIVING]
        rows.append([label(f), *cells, number(found["rmse_cm"])])
    for k in (0, 1):
        rows.append([f"thesis, line {k + 1}", *(f"{number(v[k][0])} / {number(v[k][1])}" for v in published.DRIVING.values()), "–"])
    return ("## Driving lines (thesis, table 4.15)\n\nRecall / miscoding by buffer. Recall is the share of the true line within the distance "
            "of ours; miscoding the share of our line farther than that from the true one. The buffer is the half-width, about the "
            "reference. The truth ends at crossings and where lanes begin or end; what we draw on there counts as miscoding.\n\n"
            + table(["survey", *(f"{w} cm" for w in published.DRIVING), "RMSE (cm)"], rows))


def _boundaries(figures):
    figures = _with(figures, "boundaries")
    rows, notes = [], []
    for f in figures:
        silent = []
        for method, found in f["boundaries"].items():
            if not any(found["total"]["10"][name] for name in ("right", "missed")):
                silent.append(f"{found['total']['10']['false']:.0f} by {method}")
                continue
            for side in ("left", "right", "total"):
                if side in found:
                    at = found[side]["10"]
                    spread = [found[side][t]["f1"] for t in ("5", "20")]
                    rmse = [found["rmse_cm"], found["height_rmse_cm"]] if side == "total" else [None, None]
                    rows.append([f"{label(f)}, {method}", side, *(number(at[n]) for n in ("precision", "recall", "f1")),
                                 *(number(v) for v in spread), " / ".join(number(v) for v in rmse) if side == "total" else ""])
        if silent:
            notes.append(f"{label(f)} has no curbs; intervals in which a line was drawn all the same: {', '.join(silent)}.")
    if not rows and not notes:
        return ""
    for name, row in published.BOUNDARIES.items():
        rows.append(["paper", name, *(number(v) for v in row), "–", "–", ""])
    head = ["survey, method", "side", "precision", "recall", "F", "F at 5 cm", "F at 20 cm", "RMSE across / in height (cm)"]
    return ("## Road boundaries (paper, table 3)\n\nIntervals of 2 m along the trajectory, by side; an interval is right when our line covers "
            "half of it and lies within 10 cm of the true curb bottom. The paper states no tolerance. Curbs hidden by parked cars count as "
            "missed unless we bridge them rightly; dropped curbs are left out.\n\n"
            + table(head, rows, words=2) + ("\n\n" + " ".join(notes) if notes else ""))
