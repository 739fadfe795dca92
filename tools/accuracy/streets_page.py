"""The sections of the page on streets of every kind, and on streets surveyed otherwise."""

from .confidence import BINS
from .streets import STEP, harmonic, percent, pooled
from .tables import label, number, table

HEAD = ("survey", "curbs", "corners, islands", "pavement edges", "drawn edges right", "markings F1", "driving lines 5 / 15 cm",
        "driven lanes 5 / 15 cm", "miscoding", "directions right")
CHANGED = "curbs", "pavement edges", "drawn edges right", "markings F1", "driving lines 15 cm", "driven lanes 15 cm", "miscoding", "directions right"


def _row(figures):
    """The cells of one survey."""
    wrong = percent(figures, "lanes_right")
    return [number(percent(figures, "curbs")), number(percent(figures, "corners")), number(percent(figures, "pavement")),
            number(percent(figures, "curbs_right")), number(harmonic(figures, "paint", "paint_right")),
            *(f"{number(percent(figures, name + '_5'))} / {number(percent(figures, name))}" if name in figures else "–"
              for name in ("lanes", "driven")),
            number(None if wrong is None else 100.0 - wrong), number(percent(figures, "directions"))]


def streets_section(figures):
    """The road map of every survey, judged by length."""
    rows, made = [], []
    for f in figures:
        found = f["streets"]["as surveyed"]
        if "refused" in found:
            rows.append([label(f), f"no map: {found['refused']}", *[""] * (len(HEAD) - 2)])
        else:
            made.append(found)
            rows.append([label(f), *_row(found)])
    if len(made) > 1:
        rows.append(["**all, by length**", *_row(pooled(made))])
    return ("## Streets of every kind\n\nThe road map as one call makes it. Boundaries by length: the share of the true curbs within 10 cm of a "
            "drawn edge, of those at corners and islands alone, and of the edges of pavement without a curb within 20 cm; then the share of "
            "the drawn edges that lie so near a true one (dropped curbs count here). Markings: F1 with one cell of 4 cm of tolerance. "
            "Driving lines: the share of the true ones within 5 and 15 cm of ours, and of those in whose lane a pass drove; miscoding is the "
            "share of ours more than 15 cm off. What is drawn on the track where the truth has no lanes, inside crossings and rings, is "
            "neither right nor wrong. Directions: the share of ours that run with the traffic.\n\n" + table(HEAD, rows))


def otherwise_section(figures):
    """The change of each figure when a street is surveyed otherwise, pooled over the surveys by length."""
    names = list(dict.fromkeys(name for f in figures for name in f["streets"] if name != "as surveyed"))
    given = [f for f in figures if all(name in f["streets"] for name in names)]
    if not names or not given:
        return ""
    some = f" Measured so far: {', '.join(f['name'] for f in given)}." if len(given) < len(figures) else ""
    figures = given
    rows = []
    for name in names:
        row = changes_row(name, [(f["streets"]["as surveyed"], f["streets"][name]) for f in figures if name in f["streets"]])
        rows.append(row if name != "driven the other way" else [*row[:-1], "–"])
    whole = scores(pooled([f["streets"]["as surveyed"] for f in figures if "refused" not in f["streets"]["as surveyed"]]))
    return ("## The same streets surveyed otherwise\n\nEach survey is also mirrored, which makes left-hand traffic of right-hand traffic, "
            "turned, driven the other way and thinned to every second point; the maps are changed back and judged by the same truth. The "
            "first row is pooled over all surveys by length, the others are the change in points. Driven the other way, arrows point "
            f"against the traffic, so directions are not compared.{some}\n\n"
            + table(["", *CHANGED], [["**as surveyed**", *(number(value) for value in whole)], *rows]))


def changes_row(name, pairs):
    """The row of what changes in (figures before, figures after) of several surveys, pooled by length; those without a map are counted."""
    refused = sum("refused" in after for _, after in pairs)
    pairs = [pair for pair in pairs if not any("refused" in figures for figures in pair)]
    before, after = (scores(pooled([pair[k] for pair in pairs])) for k in (0, 1))
    return [name + (f" (no map of {refused})" if refused else ""), *map(change, before, after)]


def scores(figures):
    """What the tables of changes compare, in the order of CHANGED."""
    wrong = percent(figures, "lanes_right")
    return [percent(figures, "curbs"), percent(figures, "pavement"), percent(figures, "curbs_right"), harmonic(figures, "paint", "paint_right"),
            percent(figures, "lanes"), percent(figures, "driven"), None if wrong is None else 100.0 - wrong, percent(figures, "directions")]


def change(before, after):
    """The cell of a change in points: · where there is none."""
    if before is None or after is None:
        return "–"
    return "·" if abs(after - before) < 0.05 else f"{after - before:+.1f}"


def confidence_section(figures):
    """How right the confidence of lanes is, pooled over the surveys."""
    total = pooled([f.get("confidence") or {} for f in figures])
    rows = []
    for k in sorted(total, key=int, reverse=True):
        right, count, said = total[k]
        if count:
            span = f"{BINS[int(k)]:.2f} to {min(BINS[int(k) + 1], 1.0):.2f}"
            rows.append([span, number(said / count, 2), number(right / count, 2), number(count * STEP, 0)])
    if not rows:
        return ""
    return ("## Confidence of lanes\n\nPieces of lanes carry a `confidence`: how often such pieces were right. The curve from what the estimate "
            "holds for probable to that share was fitted on other simulated streets, not on these. Of what is drawn here with some confidence, the "
            "share that lies within 15 cm of a true driving line:\n\n" + table(["said", "mean", "right", "m of driving lines"], rows))
