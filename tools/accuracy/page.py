"""docs/accuracy.md: one page that quotes the table of results beside it."""

from pathlib import Path
from string import Template

from results_table import markdown, number

from .otherwise import AS_SURVEYED
from .results import ALL, CHANGED

STREETS = ("curbs", "corners, islands", "pavement edges", "drawn edges right", "markings F1", "driving lines 5 cm", "driving lines 15 cm",
           "driven lanes 15 cm", "miscoding", "directions right")
SAMPLES = ("`make accuracy` makes the sample scenes anew, runs every method over them, and writes this page and $csv. The surveys are **simulated**: "
           "the figures show how methods compare and what a change does, not what is reached on your road.")
OWN = "`make accuracy SURVEYS=folder` ran every method over the surveys of a folder, and wrote this page and $csv."
PAGE = Template((Path(__file__).parent / "page.md").read_text(encoding="utf-8"))


def page(results, samples, csv="accuracy.csv"):
    """The page of a table of results.

    Parameters
    ----------
    results : Results
    samples : bool, whether the surveys are the sample scenes
    csv : name of the file beside the page that holds the table
    """
    link = f"[{csv}]({csv})"
    return PAGE.substitute(intro=Template(SAMPLES if samples else OWN).substitute(csv=link), csv=link, streets=_streets(results),
                           changes=_changes(results), lines="\n".join(f"- {line}" for line in _lines(results)))


def _streets(results):
    rows = []
    for name in sorted(results.names("streets"), key=lambda name: name == ALL):
        refused = results.get("streets", name, AS_SURVEYED, "refused")
        label = "**all, by length**" if name == ALL else f"{name} ({results.get('survey', name, '', 'kind')})"
        cells = [number(results.get("streets", name, AS_SURVEYED, figure)) for figure in STREETS]
        rows.append([label, *cells] if refused is None else [label, f"no map: {refused}", *[""] * (len(STREETS) - 1)])
    return markdown(["survey", *STREETS], rows)


def _changes(results):
    whole = [number(results.get("streets", ALL, AS_SURVEYED, figure)) for figure in CHANGED]
    rows = [[f"**{AS_SURVEYED}**", *whole]] if ALL in results.names("streets") else []
    every = len(results.names("streets")) - len(rows)
    for case in results.names("changes", "case"):
        given, lost = (results.get("changes", ALL, case, figure) for figure in ("surveys", "no map"))
        note = f" ({given:.0f} of {every} surveys)" * (given < every) + f" (no map of {lost:.0f})" * (lost > 0)
        rows.append([case + note, *(_change(results.get("changes", ALL, case, figure)) for figure in CHANGED)])
    return markdown(["", *CHANGED], rows) if rows else "Not measured."


def _change(value):
    return "–" if value is None else "·" if abs(value) < 0.05 else f"{value:+.1f}"


def _lines(results):
    """What else was measured, a sentence each; those without figures are left out."""
    def street(figure, digits=1):
        value = results.get("streets", ALL, AS_SURVEYED, figure)
        return value if value is None else number(value, digits)

    def get(*key):
        return number(results.get(*key))

    def spread(table, case, figure):
        """The least and the most over our surveys; empty where there is none."""
        values = [value for name in results.names("streets") if (value := results.get(table, name, case, figure)) is not None]
        return " to ".join(dict.fromkeys(number(pick(values)) for pick in (min, max))) if values else ""

    if street("driving lines within sigma"):
        yield (f"**Uncertainty**: {street('road edges within sigma') or '–'} % of the places of road edges and "
               f"{street('driving lines within sigma')} % of those of driving lines lie within one `sigma_m`; 68 % would be exact.")
    for span in results.names("confidence", "case")[:1]:
        right = 100 * results.get("confidence", ALL, span, "right")
        yield (f"**Confidence**: of lanes with a `confidence` of {span}, {right:.0f} % lie within 15 cm. The curve behind it was fitted "
               "on other simulated streets.")
    if street("roadside"):
        yield (f"**Beside the road**: {street('roadside')} % of {street('roadside m', 0)} m of rails, barriers, walls, fences and hedges are found "
               f"within 30 cm; {street('roadside m wrong')} m are wrong.")
    if found := spread("whole", "markings", "tolerant f1"):
        yield f"**Markings**, F1 by survey: {found}; the thesis, on other, real roads, has {get('whole', 'thesis, mean', 'markings', 'tolerant f1')}."
    if found := spread("whole", "driving", "recall 5"):
        yield (f"**Driving lines** within 5 cm: {found}; the thesis has {get('whole', 'thesis, line 2', 'driving', 'recall 5')} and "
               f"{get('whole', 'thesis, line 1', 'driving', 'recall 5')}.")
    if found := spread("boundaries", "both", "total 10 f1"):
        yield (f"**Curbs**, F by intervals of 2 m within 10 cm: {found}; the paper has {get('boundaries', 'paper', 'total', 'f1')}.")
    if found := spread("methods", "multi-threshold", "mask tolerant f1"):
        yield (f"**Three ways to find paint**, F1 as extracted: multi-threshold (ours) {found}, "
               f"point-segments (Yu) {spread('methods', 'point-segments', 'mask tolerant f1')}, "
               f"intensity-peaks (Chen) {spread('methods', 'intensity-peaks', 'mask tolerant f1')}.")
