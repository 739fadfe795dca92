"""The figures of all surveys, and of all together, as one table of results."""

from results_table import Results

from .confidence import BINS
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
# The thesis's stages, in ours; the surface includes reading the survey
STAGES = {"road surface": ("survey", "curbs", "edges", "surface"), "marking extraction": ("intensity", "image", "markings"),
          "outlier removal": ("outliers",), "clustering": ("clusters",), "lines": ("lines", "driving")}
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
    _confidence(table, figures)
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


def _confidence(table, figures):
    """How right the confidence of lanes is, all surveys together."""
    for k, (right, count, said) in sorted(pooled([f.get("confidence") or {} for f in figures]).items(), key=lambda one: -int(one[0])):
        if count:
            span = f"{BINS[int(k)]:.2f} to {min(BINS[int(k) + 1], 1.0):.2f}"
            table.put("confidence", ALL, span, {"said": said / count, "right": right / count, "m": count * STEP})
