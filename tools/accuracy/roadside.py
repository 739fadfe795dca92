"""How right the lines beside the road are, by length and kind."""

from lanewright.core.inventory.borders import BorderLayers
from lanewright.core.inventory.roadside.find import find_roadside
from lanewright.core.inventory.roadside.layers import roadside_to_features
from lanewright.core.survey.open_survey import SurveySettings, open_survey
from lanewright.core.survey.trajectory.reader import read_trajectory

from .streets import STEP, distance, percent, pooled, sampled
from .tables import label, number, table

KINDS = ("guard_rail", "barrier", "wall", "fence", "hedge")
BESIDE = 0.30  # m between a line and the true face of the same kind
ABOVE_ROAD = 8.0  # m that are read, as the algorithm does


def roadside_figures(case, edges):
    """The figures of one survey, from its road edges (Features): name -> (right, of how much); none where the truth has no roadside."""
    if "roadside" not in case.truth.has:
        return {}
    survey = open_survey([case.cloud], read_trajectory(case.trajectory), SurveySettings(above_road=ABOVE_ROAD))
    try:
        lines, _ = roadside_to_features(find_roadside(survey, BorderLayers(edges=edges)))
    finally:
        survey.store.close()
    return judged_roadside(case.truth, [(line, row) for line, row in lines])


def judged_roadside(truth, rows):
    """The figures of lines: per kind what of the truth is found, and what of the lines is right.

    Parameters
    ----------
    truth : Truth
    rows : [(shapely line, row with `kind`), ...]; gutters do not count

    Returns
    -------
    dict of name -> (right, of how much)
    """
    found = {}
    for kind in KINDS:
        true, lines = ([line for line, row in some if row["kind"] == kind] for some in (truth.roadside, rows))
        for name, these, those in ((f"roadside {kind}", true, lines), (f"roadside_right {kind}", lines, true)):
            places, _ = sampled(these, truth.area)
            if len(places):
                found[name] = float((distance(places, those) <= BESIDE).sum()), float(len(places))
    for whole in ("roadside", "roadside_right"):
        parts = [pair for name, pair in found.items() if name.startswith(f"{whole} ")]
        if parts:
            found[whole] = tuple(map(sum, zip(*parts)))
    return found


def roadside_section(figures):
    """The table of all surveys whose truth says what runs beside the road."""
    judged = [(label(f), f["streets"]["as surveyed"]) for f in figures if "roadside" in f.get("has", ())]
    judged = [(name, found) for name, found in judged if "refused" not in found]
    if not judged:
        return ""
    if len(judged) > 1:
        judged.append(("**all, by length**", pooled([found for _, found in judged])))
    rows = [
        [
            name,
            _metres(found, "roadside"),
            *(number(percent(found, f"roadside {kind}")) for kind in KINDS),
            number(percent(found, "roadside")),
            number(percent(found, "roadside_right")),
            _wrong(found),
        ]
        for name, found in judged
    ]
    return (
        "## Beside the road\n\n*Roadside* with the road edges of the map: the share of the true length of guard rails, concrete barriers, walls, "
        f"fences and hedges that has a line of the same kind within {100 * BESIDE:.0f} cm, and the share of our lines so near a true one of "
        "their kind. The last column says how many metres of line are of another kind or beside nothing; streets where nothing runs "
        "along the road have cars, trees, poles and, in one, houses.\n\n"
        + table(["survey", "true m", *(kind.replace("_", " ") for kind in KINDS), "all found", "lines right", "m wrong"], rows)
    )


def _metres(found, name):
    return number(found.get(name, (0, 0))[1] * STEP, 0)


def _wrong(found):
    right, count = found.get("roadside_right", (0, 0))
    return number((count - right) * STEP, 1)
