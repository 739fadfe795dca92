"""The report on driving lines set against a reference."""

import numpy as np

from ..assess.lines import ASSOCIATED, LEAST_GAP
from .assessment import error_along_road, error_spread, errors_row, outcome_map, outcomes_along_road, percent, plain
from .page import Page


def driving_report(match, accuracy, settings, layer, names, station, along, total_width=False, notes=()):
    """HTML of driving lines.

    Parameters
    ----------
    match, accuracy : LineMatch and its LineAccuracy
    layer : Features of `driving_line_layer`
    station : (N,) metres along the road of the result's places and (M,) of the reference's
    along : what that is measured along
    total_width : whether the user gave tolerances as the whole width of the buffer
    """
    page = Page("Accuracy of driving lines", f"{names[0]} against {names[1]}.")
    for note in notes:
        page.warning(note)
    asked = ("as the total width of the buffer; the half-width stands beside it" if total_width
             else "as the half-width of the buffer, from the line to its rim")
    page.text(
        f"Tolerances were given {asked}. Completeness (recall) is the share of the reference within the tolerance of the result; correctness "
        "(precision) the share of the result within the tolerance of the reference, and miscoding the share outside it: the buffer lies "
        "about the reference. Quality is matched result over result and unmatched reference. "
        + (f"Lines that cross at more than {settings.max_angle:g}° do not match." if settings.max_angle < 90
           else "Lines match whatever their direction."))
    page.table(
        ("Half-width (cm)", "Total width (cm)", "Completeness (%)", "Correctness (%)", "Miscoding (%)", "Quality (%)", "Gaps per km", "Mean gap (m)"),
        [(plain(100 * t), plain(200 * t), percent(accuracy.completeness[t]), percent(accuracy.correctness[t]), percent(accuracy.miscoding[t]),
          percent(accuracy.quality[t]), accuracy.gaps_per_km[t], accuracy.mean_gap[t]) for t in settings.tolerances],
        (None, None, 2, 2, 2, 2, 2, 2))
    page.note(f"{accuracy.result_length:.1f} m of result, {accuracy.reference_length:.1f} m of reference. A gap is at least {LEAST_GAP:g} m of "
              "reference without a result within the tolerance.")
    page.heading("Errors")
    page.table(("", "Mean (cm)", "RMSE (cm)", "95 % (cm)", "Maximum (cm)"),
               [("Across", *errors_row(accuracy.lateral)), ("Height", *errors_row(accuracy.height))], (None, 2, 2, 2, 2))
    page.note(f"Of the result within {100 * ASSOCIATED:.0f} cm of a reference line. The mean across is positive left of the reference as drawn.")
    _per_line(page, match, settings)
    page.heading(f"Map, within {100 * settings.tolerance:g} cm")
    outcome_map(page, layer, "The result's lines, correct and false, and the reference where it was missed; north is up.")
    page.heading("Along the road")
    error_along_road(page, station[0], match.lateral, match.mine.length, along)
    wrong, missed = match.to_reference > settings.tolerance, match.to_result > settings.tolerance
    outcomes_along_road(
        page, {"correct": station[0][~wrong], "false": station[0][wrong], "missed": station[1][missed]},
        {"correct": match.mine.length[~wrong], "false": match.mine.length[wrong], "missed": match.theirs.length[missed]}, along, "m")
    page.heading("Distribution")
    error_spread(page, match.lateral, match.mine.length, "positive left of the reference as drawn")
    return page.html()


def _per_line(page, match, settings):
    if len(match.reference) < 2 or len(match.reference) > 60:
        return
    page.heading("Line by line")
    widths = settings.tolerances
    page.table(
        ("Reference line", "Length (m)", *(f"Recall {100 * t:g} cm (%)" for t in widths),
         *(f"Miscoding {100 * t:g} cm (%)" for t in widths), "RMSE (cm)"),
        [(str(k + 1), found.reference_length, *(percent(found.completeness[t]) for t in widths), *(percent(found.miscoding[t]) for t in widths),
          None if np.isnan(found.rmse) else 100 * found.rmse) for k, found in enumerate(match.per_reference_line(widths))],
        (None,) + (2,) * (2 * len(widths) + 2))
    page.note(f"Half-widths. Each reference line with the result that lies nearest to it; result farther than {100 * ASSOCIATED:.0f} cm from every "
              "reference line belongs to none and shows in the table above only.")
