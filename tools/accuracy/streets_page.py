"""The sections of the page on streets of every kind, and on streets surveyed otherwise."""

from .streets import harmonic, percent, pooled
from .tables import number, table

HEAD = ("survey", "curbs", "corners, islands", "pavement edges", "drawn edges right", "markings F1", "driving lines 5 / 15 cm",
        "driven lanes 5 / 15 cm", "miscoding", "directions right")


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
            rows.append([f"{f['name']} ({f['kind']})", f"no map: {found['refused']}", *[""] * (len(HEAD) - 2)])
        else:
            made.append(found)
            rows.append([f"{f['name']} ({f['kind']})", *_row(found)])
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
        pairs = [(f["streets"]["as surveyed"], f["streets"][name]) for f in figures if name in f["streets"]]
        refused = sum("refused" in after for _, after in pairs)
        pairs = [(before, after) for before, after in pairs if "refused" not in before and "refused" not in after]
        before, after = (_scores(pooled([pair[k] for pair in pairs])) for k in (0, 1))
        cells = [_change(b, a) for b, a in zip(before, after)]
        if name == "driven the other way":
            cells[-1] = "–"
        rows.append([name + (f" (no map of {refused})" if refused else ""), *cells])
    whole = _scores(pooled([f["streets"]["as surveyed"] for f in figures if "refused" not in f["streets"]["as surveyed"]]))
    return ("## The same streets surveyed otherwise\n\nEach survey is also mirrored, which makes left-hand traffic of right-hand traffic, "
            "turned, driven the other way and thinned to every second point; the maps are changed back and judged by the same truth. The "
            "first row is pooled over all surveys by length, the others are the change in points. Driven the other way, arrows point "
            f"against the traffic, so directions are not compared.{some}\n\n"
            + table(["", "curbs", "pavement edges", "drawn edges right", "markings F1", "driving lines 15 cm", "driven lanes 15 cm", "miscoding",
                     "directions right"], [["**as surveyed**", *(number(value) for value in whole)], *rows]))


def _scores(figures):
    wrong = percent(figures, "lanes_right")
    return [percent(figures, "curbs"), percent(figures, "pavement"), percent(figures, "curbs_right"), harmonic(figures, "paint", "paint_right"),
            percent(figures, "lanes"), percent(figures, "driven"), None if wrong is None else 100.0 - wrong, percent(figures, "directions")]


def _change(before, after):
    if before is None or after is None:
        return "–"
    return "·" if abs(after - before) < 0.05 else f"{after - before:+.1f}"
