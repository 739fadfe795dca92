"""Reports of the accuracy of road boundaries, driving lines and markings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..assess.boundaries import BoundaryAccuracy
from ..assess.driving_lines import MAX_MATCH_DISTANCE, MIN_REFERENCE_GAP, LineAccuracy, LineAccuracySettings, LineMatch
from ..assess.markings import MarkingAccuracy
from ..common.features import Features
from .assessment_figures import OUTCOME_COLOURS, error_along_road, error_histogram, errors_row, outcome_map, outcomes_along_road, percent, plain
from .map_figure import grey_background
from .page import Page


def boundary_report(accuracy: BoundaryAccuracy, layer: Features, names: tuple[str, str], notes: Sequence[str] = ()) -> str:
    """The report of a BoundaryAccuracy as HTML.

    Parameters
    ----------
    accuracy : BoundaryAccuracy
    layer : Features of `boundary_layer`
    names : (result, reference) as the user calls them
    notes : further sentences
    """
    settings, table = accuracy.settings, accuracy.intervals
    page = Page("Accuracy of road boundaries", f"{names[0]} against {names[1]}.")
    for note in notes:
        page.warning(note)
    page.text(
        f"Judged in intervals of {settings.interval:g} m along {accuracy.along.title}, each side by itself. An interval is correct when lines "
        f"of the result cover at least {100 * settings.coverage:g} % of it and {100 * settings.agreement:g} % of them lie within the "
        f"tolerance of the reference. A line elsewhere is false, and the reference is missed; so it is where there is no line, "
        f"whether something hid the boundary or not. Tolerances are distances to either side.")
    left_out = int((table.excluded != "").sum())
    page.table(
        ("Side", "Tolerance (cm)", "Intervals", "Correct", "Missed", "False", "Precision (%)", "Recall (%)", "F (%)", "IoU (%)"),
        [(side, plain(100 * tolerance), found.rates.right + found.rates.missed, found.rates.right, found.rates.missed, found.rates.false,
          percent(found.rates.precision), percent(found.rates.recall), percent(found.rates.f1), percent(found.rates.iou))
         for side, tolerance, found in _rows(accuracy)], (None,) * 6 + (2,) * 4)
    page.note(f"Not judged: {left_out} intervals." + (f" {accuracy.beyond:.1f} m of the result lie more than {settings.corridor:g} m from the "
                                                      "trajectory and were left out." if accuracy.beyond else ""))
    _reasons(page, table)
    page.heading("Errors in the correct intervals")
    page.table(
        ("Side", "Tolerance (cm)", "Across: mean (cm)", "RMSE (cm)", "95 % (cm)", "Maximum (cm)",
         "Height: mean (cm)", "RMSE (cm)", "95 % (cm)", "Maximum (cm)"),
        [(side, plain(100 * tolerance), *errors_row(found.lateral), *errors_row(found.height)) for side, tolerance, found in _rows(accuracy)],
        (None, None) + (2,) * 8)
    page.note(f"The mean across is {accuracy.along.signed}; heights are result less reference, and missing where a layer has none.")
    page.heading(f"Map, within {100 * settings.tolerance:g} cm")
    outcome_map(page, layer, "Intervals by outcome; north is up. Correct, missed and excluded ones are drawn along the reference, "
                             "false ones along the result.")
    page.heading("Along the road")
    judged = accuracy.result_group
    hit = np.append(table.hit[:, settings.tolerances.index(settings.tolerance)], False)[judged.interval]
    lateral = np.where(hit, accuracy.lateral, np.nan)
    error_along_road(page, judged.stations.station, lateral, judged.points.length, accuracy.along.title)
    stations = {name: np.array([row["station_m"] for row in layer.rows if row["outcome"] == name]) for name in OUTCOME_COLOURS}
    outcomes_along_road(page, stations, {name: np.ones(len(s)) for name, s in stations.items()}, accuracy.along.title, "intervals")
    page.heading("Distribution")
    error_histogram(page, lateral, judged.points.length, accuracy.along.signed)
    return page.html()


def _rows(accuracy):
    for side, found in (*((name or "unknown", figures) for name, figures in accuracy.by_side.items()), ("together", accuracy.total)):
        if side == "unknown" and len(accuracy.by_side) == 1:
            continue
        for tolerance in accuracy.settings.tolerances:
            yield side, tolerance, found[tolerance]


def _reasons(page, table):
    names, counts = np.unique(table.excluded[table.excluded != ""].astype(str), return_counts=True)
    if len(names):
        page.table(("Not judged because", "Intervals"), [(str(name), int(count)) for name, count in zip(names, counts)])


def driving_report(match: LineMatch, accuracy: LineAccuracy, settings: LineAccuracySettings, layer: Features, names: tuple[str, str],
                   station: tuple[np.ndarray, np.ndarray], along: str, total_width: bool = False, notes: Sequence[str] = ()) -> str:
    """The report of a LineAccuracy as HTML.

    Parameters
    ----------
    match, accuracy : LineMatch and its LineAccuracy
    settings : LineAccuracySettings
    layer : Features of `driving_line_layer`
    names : (result, reference) as the user calls them
    station : (N,) metres along the road of the result's places and (M,) of the reference's
    along : what that is measured along
    total_width : whether the user gave tolerances as the whole width of the buffer
    notes : further sentences
    """
    page = Page("Accuracy of driving lines", f"{names[0]} against {names[1]}.")
    for note in notes:
        page.warning(note)
    given = ("as the total width of the buffer; the half-width stands beside it" if total_width
             else "as the half-width of the buffer, from the line to its rim")
    page.text(
        f"Tolerances were given {given}. Completeness (recall) is the share of the reference within the tolerance of the result; correctness "
        "(precision) the share of the result within the tolerance of the reference, and miscoding the share outside it: the buffer lies "
        "about the reference. Quality is matched result over result and unmatched reference. "
        + (f"Lines that cross at more than {settings.max_angle:g}° do not match." if settings.max_angle < 90
           else "Lines match whatever their direction."))
    page.table(
        ("Half-width (cm)", "Total width (cm)", "Completeness (%)", "Correctness (%)", "Miscoding (%)", "Quality (%)", "Gaps per km", "Mean gap (m)"),
        [(plain(100 * t), plain(200 * t), percent(accuracy.completeness[t]), percent(accuracy.correctness[t]), percent(accuracy.miscoding[t]),
          percent(accuracy.quality[t]), accuracy.gaps_per_km[t], accuracy.mean_gap[t]) for t in settings.tolerances],
        (None, None, 2, 2, 2, 2, 2, 2))
    page.note(f"{accuracy.result_length:.1f} m of result, {accuracy.reference_length:.1f} m of reference. A gap is at least "
              f"{MIN_REFERENCE_GAP:g} m of reference without a result within the tolerance.")
    page.heading("Errors")
    page.table(("", "Mean (cm)", "RMSE (cm)", "95 % (cm)", "Maximum (cm)"),
               [("Across", *errors_row(accuracy.lateral)), ("Height", *errors_row(accuracy.height))], (None, 2, 2, 2, 2))
    page.note(f"Of the result within {100 * MAX_MATCH_DISTANCE:.0f} cm of a reference line. "
              "The mean across is positive left of the reference as drawn.")
    _per_line(page, match, settings)
    page.heading(f"Map, within {100 * settings.tolerance:g} cm")
    outcome_map(page, layer, "The result's lines, correct and false, and the reference where it was missed; north is up.")
    page.heading("Along the road")
    error_along_road(page, station[0], match.lateral, match.result_points.length, along)
    wrong, missed = match.to_reference > settings.tolerance, match.to_result > settings.tolerance
    outcomes_along_road(
        page, {"correct": station[0][~wrong], "false": station[0][wrong], "missed": station[1][missed]},
        {"correct": match.result_points.length[~wrong], "false": match.result_points.length[wrong],
         "missed": match.reference_points.length[missed]}, along, "m")
    page.heading("Distribution")
    error_histogram(page, match.lateral, match.result_points.length, "positive left of the reference as drawn")
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
    page.note(f"Half-widths. Each reference line with the result that lies nearest to it; result farther than "
              f"{100 * MAX_MATCH_DISTANCE:.0f} cm from every reference line belongs to none and shows in the table above only.")


def marking_report(accuracy: MarkingAccuracy, layer: Features, names: tuple[str, str], station: np.ndarray, along: str,
                   image: str | None = None, notes: Sequence[str] = ()) -> str:
    """The report of a MarkingAccuracy as HTML.

    Parameters
    ----------
    accuracy : MarkingAccuracy
    layer : Features of `marking_layer`
    names : (result, reference) as the user calls them
    station : (N,) metres along the road of `accuracy.blocks`
    along : what that is measured along
    image : path of a raster to draw the map over, or None
    notes : further sentences
    """
    settings = accuracy.settings
    page = Page("Accuracy of markings", f"{names[0]} against {names[1]}.")
    for note in notes:
        page.warning(note)
    page.text(
        f"Judged in cells of {100 * settings.cell_size:g} cm; a cell is painted when its centre is. With a tolerance of one cell the other side is "
        f"widened by one cell all round before the comparison. An object is found, or right, if at least {100 * settings.found_share:g} % of its "
        f"cells are, with a tolerance of {settings.tolerance} cell{'s' * (settings.tolerance != 1)}.")
    rows = [(f"Cells, {'strict' if t == 0 else f'{t} cell' + 's' * (t > 1) + ' tolerance'}", rates) for t, rates in accuracy.rates.items()]
    page.table(("", "Right", "False", "Missed", "Precision (%)", "Recall (%)", "F1 (%)", "IoU (%)"),
               [(name, int(r.right), int(r.false), int(r.missed), percent(r.precision), percent(r.recall), percent(r.f1), percent(r.iou))
                for name, r in (*rows, ("Objects", accuracy.objects))], (None,) * 4 + (2,) * 4)
    page.note("With a tolerance and for objects, IoU is F1 / (2 − F1): right cells of the result and found ones of the reference differ in number.")
    _classes(page, accuracy)
    page.heading("Map")
    background = grey_background(image) if image else None
    outcome_map(page, layer, "Objects of the reference that were found and missed, and false objects of the result; north is up.",
                background, filled=True)
    page.heading("Along the road")
    blocks, size = accuracy.blocks, settings.cell_size**2
    outcomes = ("correct", "missed", "false")
    areas = {name: blocks[:, 2 + k] * size for k, name in enumerate(outcomes)}
    outcomes_along_road(page, dict.fromkeys(outcomes, station), areas, along, "m²")
    page.note(f"With a tolerance of {settings.tolerance} cell{'s' * (settings.tolerance != 1)}.")
    return page.html()


def _classes(page, accuracy):
    if not accuracy.by_class:
        return
    page.heading("By class")
    tolerance = accuracy.settings.tolerance
    rows = []
    for name, found in accuracy.by_class.items():
        own = found.rates if found.result and found.reference else None
        rows.append((name, found.reference, _share(found.found, found.reference), _share(found.found_beside, found.reference),
                     found.result, _share(found.right, found.result), _share(found.right_beside, found.result),
                     percent(own.f1) if own else None, percent(own.iou) if own else None))
    page.table(("Class", "Reference cells", "Recall (%)", f"within {tolerance} cell (%)", "Result cells", "Precision (%)",
                f"within {tolerance} cell (%)", "F1 of the class (%)", "IoU of the class (%)"), rows,
               (None, None, 2, 2, None, 2, 2, 2, 2))
    page.note("Recall and precision count paint of any class; F1 and IoU of the class require the same class in both, if both have it.")


def _share(part, whole):
    return 100.0 * part / whole if whole else None
