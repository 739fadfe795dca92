"""The table of the ablation: every result as CSV, and one short page."""

import csv

from accuracy.streets import harmonic, percent
from results_table import markdown, number

from .switches import SWITCHES
from .weight import weight

FIGURES = "curbs", "pavement", "markings", "5 cm", "15 cm", "off", "classes"
FELT = 0.05   # points by which a figure must change
NOT_FELT = "not called", "no effect", "same map"
ABOUT = """# What each rule brings

Each rule, method and kind of evidence is switched off alone, everything else as it is, and the map is judged by the truth of the survey.
*Curbs*: share of the true ones within 10 cm; *pavement*: of its edges within 20 cm; *markings*: F1 with a cell of 4 cm; *5 cm*, *15 cm*: share of
the true driving lines; *off*: share of the drawn ones more than 15 cm off; *classes*: share of the paint that was found with the right class.
Lines and numbers are those that nothing else uses.

## The maps with every rule

Other variants stand in `ablation.csv`.

"""
SILENT = """

## Felt by no survey that was tried

How often a rule was not called, gave nothing else than its stand-in, changed something of which the map shows nothing, or changed the map and no
figure by 0.05 points. Before a rule goes, the street it was made for is tried.

"""


def scores(figures):
    """{name of FIGURES: per cent or None} of a road map."""
    wrong = percent(figures, "lanes_right")
    values = (percent(figures, "curbs"), percent(figures, "pavement"), harmonic(figures, "paint", "paint_right"), percent(figures, "lanes_5"),
              percent(figures, "lanes"), None if wrong is None else 100.0 - wrong, percent(figures, "classes"))
    return dict(zip(FIGURES, values))


def changes(known, name):
    """{figure: points} by which a map changes without a rule, those of at least FELT; None where it was not measured."""
    found = known.get("off", {}).get(name)
    if found is None:
        return None
    if "figures" not in found:
        return {"no map": -100.0} if found["outcome"] == "refused" else {}
    before, after = scores(known["figures"]), scores(found["figures"])
    steps = {key: (after[key] or 0.0) - (before[key] or 0.0) for key in FIGURES if (before[key], after[key]) != (None, None)}
    return {key: step for key, step in steps.items() if abs(step) >= FELT}


def felt_by(results, name):
    """Words: the surveys whose figures change, each with the variant that changes most; "" where none does."""
    said = []
    for survey in dict.fromkeys(survey for survey, _ in results):
        steps = {variant: found for (of, variant), known in results.items() if of == survey and (found := changes(known, name))}
        if steps:
            most = max(steps, key=lambda variant: sum(map(abs, steps[variant].values())))
            text = ", ".join(f"{figure} {step:+.1f}" for figure, step in steps[most].items())
            said.append(f"{survey}{'' if most == 'as surveyed' else f' ({most})'}: {text}")
    return "; ".join(said)


def write_csv(path, switches, groups, results):
    """A row for every survey, variant and rule: outcome, and what each figure was and became."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["off", "group", "lines", "numbers", "street", "survey", "variant", "outcome", "seconds",
                       *(f"{figure} {when}" for figure in FIGURES for when in ("with", "without"))])
        for name in (*switches, *groups):
            switch = switches.get(name)
            about = [name, switch.group, *weight(switch), switch.street] if switch else [name, "together", "", "", ""]
            for (survey, variant), known in results.items():
                found = known.get("off", {}).get(name)
                if found:
                    with_it = scores(known["figures"])
                    without = scores(found["figures"]) if "figures" in found else {} if found["outcome"] == "refused" else with_it
                    cells = [number(one.get(figure), 2) for figure in FIGURES for one in (with_it, without)]
                    rows.writerow([*about, survey, variant, found["outcome"], found["seconds"], *cells])


def page(switches, groups, results):
    """The Markdown page."""
    measured = {name: [known["off"][name]["outcome"] for known in results.values() if name in known.get("off", {})]
                for name in (*switches, *groups)}
    heavy = {name: weight(switch) for name, switch in switches.items()}
    first = {survey: (variant, known) for (survey, variant), known in reversed(results.items())}
    maps = [[survey, variant, *(number(scores(known["figures"])[figure]) for figure in FIGURES)] if "figures" in known
            else [survey, variant, f"no map: {known['refused']}", *[""] * (len(FIGURES) - 1)]
            for survey, (variant, known) in reversed(first.items())]
    idle = [name for name in SWITCHES if all(name in known.get("idle", {name: ""}) for known in results.values())]
    rows, silent = [], []
    for name, outcomes in measured.items():
        if not outcomes:
            continue
        felt = felt_by(results, name)
        lines, numbers = heavy.get(name, ("", ""))
        street = switches[name].street if name in switches else ", ".join(groups[name])
        if felt or name in groups:
            rows.append([name, lines, numbers, street, len(outcomes), felt or "none"])
        else:
            counts = [sum(one == outcome for one in outcomes) for outcome in (*NOT_FELT, "another map")]
            silent.append([name, ", ".join(filter(None, switches[name].rule)), lines, numbers, street, *counts])
    return (ABOUT + markdown(["survey", "variant", *FIGURES], maps, words=2)
            + "\n\n## Felt\n\nChanges in points, of the variant of each survey that changes most.\n\n"
            + markdown(["off", "made for", "lines", "numbers", "tried", "felt by"],
                    [[name, street, lines, numbers, tried, felt] for name, lines, numbers, street, tried, felt in rows], words=2)
            + SILENT + markdown(["off", "where", "made for", "lines", "numbers", *NOT_FELT, "no figure"],
                             [[name, where, street, lines, numbers, *counts] for name, where, lines, numbers, street, *counts in silent], words=3)
            + f"\n\n## Without effect\n\nAll {len(SWITCHES)} rules were watched in these surveys. {len(idle)} were not called, or gave what stands "
            f"in for them: {'; '.join(idle)}.\n")
