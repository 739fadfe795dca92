"""The sections of the page on surveys that lack something, and on how honest the uncertainty of lines is."""

from .streets import percent, pooled
from .streets_page import CHANGED, change, scores
from .tables import number, table


def poorer_section(figures):
    """The change of each figure when something lacks, a table for each survey that was judged so."""
    parts = []
    for f in figures:
        if f.get("poorer") and "refused" not in f["streets"]["as surveyed"]:
            whole = scores(f["streets"]["as surveyed"])
            rows = [["**as surveyed**", *(number(value) for value in whole)]]
            for name, found in f["poorer"].items():
                cells = [f"no map: {found['refused']}", *[""] * (len(CHANGED) - 1)] if "refused" in found else [
                    "lost" if after is None and before is not None else change(before, after) for before, after in zip(whole, scores(found))]
                rows.append([name, *cells])
            parts.append(f"{f['name']} ({f['kind']}), {f['points']:,} points:\n\n" + table(["", *CHANGED], rows))
    if not parts:
        return ""
    return ("## Surveys that lack something\n\nThe same surveys with fewer points, coarse coordinates, 8-bit intensity, without time, or with "
            "colours in place of intensity (made photographs: paint on asphalt with noise, 3 cm beside the points, a third of the street in "
            "shadow; *Intensity from* is then `rgb`). The first row of a table is in per cent, the others are the change in points; “lost” "
            "stands where nothing of the kind was drawn any more.\n\n" + "\n\n".join(parts))


def sigma_section(figures):
    """Which share of the places of edges and driving lines lies within the uncertainty that their line says."""
    judged = [(f"{f['name']} ({f['kind']})", f["streets"]["as surveyed"]) for f in figures]
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
