"""The sections of the page on surveys that lack something, and on how honest the uncertainty of lines is."""

from .streets import harmonic, percent, pooled
from .streets_page import CHANGED, change, changes_row, scores
from .tables import label, number, table


def _boundaries(found):
    """The share of all edges of the road that was found, curbs or not."""
    return percent(pooled([{"edges": found[name]} for name in ("curbs", "pavement") if name in found]), "edges")


BY_SURVEY = {
    "Curbs and edges of the pavement": _boundaries,
    "Markings, F1": lambda found: harmonic(found, "paint", "paint_right"),
    "Driving lines, 15 cm": lambda found: percent(found, "lanes"),
}


def poorer_section(figures):
    """The change of each figure when something lacks, over all surveys that were judged so and of each."""
    figures = [f for f in figures if f.get("poorer") and "refused" not in f["streets"]["as surveyed"]]
    if not figures:
        return ""
    lacks = list(dict.fromkeys(name for f in figures for name in f["poorer"]))
    parts = [_over_all(figures, lacks)] if len(figures) > 1 else []
    for title, score in BY_SURVEY.items():
        rows = [[label(f), number(score(f["streets"]["as surveyed"])), *(_change(f, name, score) for name in lacks)]
                for f in figures if score(f["streets"]["as surveyed"]) is not None]
        if rows:
            parts.append(f"{title}:\n\n" + table(["survey", "as surveyed", *lacks], rows))
    return ("## Surveys that lack something\n\nThe same surveys with fewer points, coarse coordinates, 8-bit intensity, without time, or with "
            "colours in place of intensity (made photographs: paint on asphalt with noise, 3 cm beside the points, a third of the street in "
            "shadow, and all other ground as grey as asphalt, so that only its form shows where pavement ends; *Intensity from* is then "
            "`rgb`). What is as surveyed is in per cent, the others are the change in points; “lost” "
            "stands where nothing of the kind was drawn any more, “no map” where the survey was refused.\n\n" + "\n\n".join(parts))


def _over_all(figures, lacks):
    """The table of all figures, pooled over the surveys by length."""
    rows = [["**as surveyed**", *(number(value) for value in scores(pooled([f["streets"]["as surveyed"] for f in figures])))]]
    rows += [changes_row(name, [(f["streets"]["as surveyed"], f["poorer"][name]) for f in figures if name in f["poorer"]]) for name in lacks]
    return "All, by length:\n\n" + table(["", *CHANGED], rows)


def _change(figure, name, score):
    """The cell of one survey that lacks one thing."""
    found = figure["poorer"].get(name)
    if found is None:
        return "–"
    if "refused" in found:
        return "no map"
    before, after = score(figure["streets"]["as surveyed"]), score(found)
    return "lost" if after is None else change(before, after)


def sigma_section(figures):
    """Which share of the places of edges and driving lines lies within the uncertainty that their line says."""
    judged = [(label(f), f["streets"]["as surveyed"]) for f in figures]
    judged = [(name, found) for name, found in judged if "edges_sigma" in found or "lanes_sigma" in found]
    if not judged:
        return ""
    rows = [[name, *_shares(found)] for name, found in judged]
    if len(judged) > 1:
        rows.append(["**all, by length**", *_shares(pooled([found for _, found in judged]))])
    return ("## Uncertainty\n\nRoad edges and driving lines say in `sigma_m` how uncertain they are across, as one sigma, which should hold at 68 % "
            "of the places. Counted are the places within 10 cm of a true curb and 15 cm of a true driving line; what is farther off is an "
            "error and counted above. The shares were chosen on half of the simulated streets, of this simulator and of another, and held on "
            "the other half and with a quarter of the points. It holds against the points of the survey. Where these are off as a whole, as one "
            "pass does not show, fewer places lie within, unless *Accuracy of the trajectory* tells how far off they may be.\n\n"
            + table(["survey", "road edges", "driving lines"], rows))


def _shares(found):
    return [number(percent(found, name)) for name in ("edges_sigma", "lanes_sigma")]
