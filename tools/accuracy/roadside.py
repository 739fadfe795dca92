"""How right the lines beside the road are, by length and kind."""

from lanewright.core.survey.open_survey import SurveySettings, open_survey
from lanewright.core.survey.trajectory.reader import read_trajectory
from lanewright.products.inventory.borders import BorderLayers
from lanewright.products.inventory.roadside.find import find_roadside, roadside_to_features

from .streets import distance, sampled

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
