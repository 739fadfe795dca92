"""The figures of all surveys, and of all together, as one table of results."""

from results_table import Results

from .ablations import ABLATIONS
from .evidence import BINS, EVIDENCE
from .otherwise import AS_SURVEYED
from .published import PUBLISHED
from .roadside import KINDS
from .streets import STEP, harmonic, percent, pooled

ALL = "all"
# What the table says -> what streets and roadside call it
SHARES = {"curbs": "curbs", "corners, islands": "corners", "pavement edges": "pavement", "all edges": "edges", "drawn edges right": "curbs_right",
          "driving lines 5 cm": "lanes_5", "driving lines 15 cm": "lanes", "driven lanes 5 cm": "driven_5", "driven lanes 15 cm": "driven",
          "directions right": "directions", "road edges within sigma": "edges_sigma", "driving lines within sigma": "lanes_sigma",
          **{f"roadside {kind.replace('_', ' ')}": f"roadside {kind}" for kind in KINDS}, "roadside": "roadside", "roadside right": "roadside_right"}
CHANGED = ("curbs", "pavement edges", "drawn edges right", "markings F1", "driving lines 15 cm", "driven lanes 15 cm", "miscoding",
           "directions right")
SEEN_BY_EVIDENCE = {"driving lines 5 cm": "lanes_5", "driving lines 15 cm": "lanes", "driven lanes 15 cm": "driven",
                    "drawn lanes right": "lanes_right", "directions right": "directions"}
# The thesis's stages, in ours; the surface includes reading the survey
STAGES = {"road surface": ("survey", "curbs", "edges", "surface"), "marking extraction": ("intensity", "image", "markings"),
          "outlier removal": ("outliers",), "clustering": ("clusters",), "lines": ("lines", "driving")}
FELT = 0.5   # points by which evidence has to change a survey to be felt there
COUNTS = {"right", "missed", "counts"}   # beside the rates that are made from them


def results(figures):
    """Results of the surveys, from the figures of each as figures_of gives them."""
    table = Results()
    for f in figures:
        table.put("survey", f["name"], "", {"kind": f["kind"], "text": f["text"], "points": f["points"], "road points": f.get("road_points")})
        for case, found in _cases(f).items():
            table.put("streets", f["name"], case, found if "refused" in found else by_length(found))
        for name in ("whole", "boundaries", "methods", "cells"):
            for (case, *figure), value in _leaves(f.get(name) or {}):
                table.put(name, f["name"], case, {" ".join(figure): value})
        seconds = f.get("seconds") or {}
        for name, stages in {**STAGES, "whole": seconds}.items():
            table.put("seconds", f["name"], name, {"s": sum(seconds.get(stage, 0.0) for stage in stages)} if seconds else {})
    _together(table, figures)
    _evidence(table, figures)
    _ablations(table, [f for f in figures if f.get("ablations")])
    for row in PUBLISHED:
        table.put(*row)
    return table


def _cases(f):
    return {**f["streets"], **(f.get("poorer") or {})}


def by_length(found):
    """{figure: per cent} of the pairs that streets.judged and roadside.judged_roadside give."""
    edges = [found[name] for name in ("curbs", "pavement") if name in found]
    found = {**found, **({"edges": tuple(map(sum, zip(*edges)))} if edges else {})}
    shares = {name: percent(found, pair) for name, pair in SHARES.items()}
    right, drawn = found.get("lanes_right", (0, 0))
    beside_right, beside = found.get("roadside_right", (0, 0))
    return {**shares, "markings F1": harmonic(found, "paint", "paint_right"), "miscoding": 100.0 * (drawn - right) / drawn if drawn else None,
            "roadside m": found["roadside"][1] * STEP if "roadside" in found else None,
            "roadside m wrong": (beside - beside_right) * STEP if beside else None}


def _leaves(tree, path=()):
    """(path, value) of the numbers in nested dicts."""
    for name, value in tree.items():
        if isinstance(value, dict):
            yield from _leaves(value, (*path, name)) if name not in COUNTS else ()
        elif name not in COUNTS:
            yield (*path, name), value


def _together(table, figures):
    """All surveys by length, and the change in points of each other way to survey them."""
    made = [f for f in figures if "refused" not in f["streets"][AS_SURVEYED]]
    if len(made) > 1:
        table.put("streets", ALL, AS_SURVEYED, by_length(pooled([f["streets"][AS_SURVEYED] for f in made])))
    for case in dict.fromkeys(case for f in made for case in _cases(f) if case != AS_SURVEYED):
        given = [f for f in made if case in _cases(f)]
        pairs = [(f["streets"][AS_SURVEYED], _cases(f)[case]) for f in given if "refused" not in _cases(f)[case]]
        before, after = (by_length(pooled([pair[k] for pair in pairs])) for k in (0, 1))
        # driven the other way, arrows point against the traffic
        names = [name for name in CHANGED if not (name == "directions right" and case == "driven the other way")]
        table.put("changes", ALL, case, {**_differences(before, after, names), "surveys": len(given), "no map": len(given) - len(pairs)})


def _differences(before, after, names):
    return {name: after[name] - before[name] for name in names if before.get(name) is not None and after.get(name) is not None}


def _evidence(table, figures):
    """What lines and lanes lose without each kind of evidence, in points, and how right their confidence is."""
    # saved figures may be of a version that left out other evidence
    figures = [f for f in figures if {"", *EVIDENCE} <= set(f.get("evidence") or ())]
    if not figures:
        return

    def shares(given):
        return {text: percent(given, name) for text, name in SEEN_BY_EVIDENCE.items()}

    def felt(f, name):
        one, other = (shares(f["evidence"][which]) for which in ("", name))
        return any((one[k] is None) != (other[k] is None) or one[k] is not None and abs(one[k] - other[k]) > FELT
                   for k in ("driving lines 15 cm", "drawn lanes right", "directions right"))

    whole = shares(pooled([f["evidence"][""] for f in figures]))
    table.put("evidence", ALL, "everything", whole)
    for name in EVIDENCE:
        changes = _differences(whole, shares(pooled([f["evidence"][name] for f in figures])), whole)
        table.put("evidence", ALL, name, {**changes, "felt by": ", ".join(f["name"] for f in figures if felt(f, name)) or "none"})
    for k, (right, count, said) in sorted(pooled([f.get("confidence") or {} for f in figures]).items(), key=lambda one: -int(one[0])):
        if count:
            span = f"{BINS[int(k)]:.2f} to {min(BINS[int(k) + 1], 1.0):.2f}"
            table.put("confidence", ALL, span, {"said": said / count, "right": right / count, "m": count * STEP})


def _ablations(table, figures):
    """The mean of the whole chain over the surveys, and the mean change without each improvement."""
    whole = [_scores(f["whole"]) for f in figures]
    table.put("ablations", ALL, "the whole chain", _means(whole))
    for k, ablation in enumerate(ABLATIONS):
        pairs = [(base, _scores(f["ablations"][k])) for base, f in zip(whole, figures) if f["ablations"][k]]
        refused = sum("refused" in f["ablations"][k] for f in figures if f["ablations"][k])
        table.put("ablations", ALL, ablation.text, {**_means([_differences(*pair, pair[0]) for pair in pairs]), "no map": refused or None})


def _scores(judged):
    """F of boundaries, F1 of markings, recall and miscoding of driving lines of one run; None where there is none."""
    b, m, d = (judged.get(name) for name in ("boundaries", "markings", "driving"))
    return {"boundaries F 10 cm": b and b["total"]["10"]["f1"], "markings F1": m and m["tolerant"]["f1"],
            "driving lines 10 cm": d and d["recall"]["10"], "miscoding 10 cm": d and d["miscoding"]["10"]}


def _means(scores):
    known = {name: [one[name] for one in scores if one.get(name) is not None] for one in scores for name in one}
    return {name: sum(values) / len(values) for name, values in known.items() if values}
