"""Reports of the accuracy of road boundaries, driving lines and markings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..assess.boundaries import BoundaryAccuracy
from ..assess.driving_lines import MAX_MATCH_DISTANCE, MIN_REFERENCE_GAP, LineAccuracy, LineAccuracySettings, LineMatch
from ..assess.markings import MarkingAccuracy
from ..common.features import Features
from ..common.texts import told, tr, word
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
    page = _page(tr("Accuracy of road boundaries"), names, notes)
    along = told(accuracy.along.title)
    page.text(tr(
        "Judged in intervals of {interval:g} m along {along}, each side by itself. An interval is correct when lines "
        "of the result cover at least {coverage:g} % of it and {agreement:g} % of them lie within the "
        "tolerance of the reference. A line elsewhere is false, and the reference is missed; so it is where there is no line, "
        "whether something hid the boundary or not. Tolerances are distances to either side.").format(
            interval=settings.interval, along=along, coverage=100 * settings.coverage, agreement=100 * settings.agreement))
    left_out = int((table.excluded != "").sum())
    page.table(
        (tr("Side"), tr("Tolerance (cm)"), tr("Intervals"), tr("Correct"), tr("Missed"), tr("False"), tr("Precision (%)"), tr("Recall (%)"), "F (%)",
         "IoU (%)"),
        [(side, plain(100 * tolerance), found.rates.right + found.rates.missed, found.rates.right, found.rates.missed, found.rates.false,
          percent(found.rates.precision), percent(found.rates.recall), percent(found.rates.f1), percent(found.rates.iou))
         for side, tolerance, found in _rows(accuracy)], (None,) * 6 + (2,) * 4)
    page.note(tr("Not judged: {count} intervals.").format(count=left_out))
    if accuracy.beyond:
        page.note(tr("{length:.1f} m of the result lie more than {corridor:g} m from the trajectory and were left out.").format(
            length=accuracy.beyond, corridor=settings.corridor))
    _reasons(page, table)
    page.heading(tr("Errors in the correct intervals"))
    page.table(
        (tr("Side"), tr("Tolerance (cm)"), tr("Across: mean (cm)"), "RMSE (cm)", "95 % (cm)", tr("Maximum (cm)"),
         tr("Height: mean (cm)"), "RMSE (cm)", "95 % (cm)", tr("Maximum (cm)")),
        [(side, plain(100 * tolerance), *errors_row(found.lateral), *errors_row(found.height)) for side, tolerance, found in _rows(accuracy)],
        (None, None) + (2,) * 8)
    page.note(tr("The mean across is {signed}; heights are result less reference, and missing where a layer has none.").format(
        signed=told(accuracy.along.signed)))
    page.heading(tr("Map, within {tolerance:g} cm").format(tolerance=100 * settings.tolerance))
    outcome_map(page, layer, tr("Intervals by outcome; north is up. Correct, missed and excluded ones are drawn along the reference, "
                                "false ones along the result."))
    page.heading(tr("Along the road"))
    judged = accuracy.result_group
    hit = np.append(table.hit[:, settings.tolerances.index(settings.tolerance)], False)[judged.interval]
    lateral = np.where(hit, accuracy.lateral, np.nan)
    error_along_road(page, judged.stations.station, lateral, judged.points.length, along)
    stations = {name: np.array([row["station_m"] for row in layer.rows if row["outcome"] == name]) for name in OUTCOME_COLOURS}
    outcomes_along_road(page, stations, {name: np.ones(len(s)) for name, s in stations.items()}, along, tr("intervals"))
    page.heading(tr("Distribution"))
    error_histogram(page, lateral, judged.points.length, told(accuracy.along.signed))
    return page.html()


def _page(title, names, notes):
    page = Page(title, tr("{result} against {reference}.").format(result=names[0], reference=names[1]))
    for note in notes:
        page.warning(told(note))
    return page


def _rows(accuracy):
    for side, found in (*((name or "unknown", figures) for name, figures in accuracy.by_side.items()), ("together", accuracy.total)):
        if side == "unknown" and len(accuracy.by_side) == 1:
            continue
        for tolerance in accuracy.settings.tolerances:
            yield word(side), tolerance, found[tolerance]


def _reasons(page, table):
    names, counts = np.unique(table.excluded[table.excluded != ""].astype(str), return_counts=True)
    if len(names):
        page.table((tr("Not judged because"), tr("Intervals")), [(told(str(name)), int(count)) for name, count in zip(names, counts)])


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
    along = told(along)
    page = _page(tr("Accuracy of driving lines"), names, notes)
    page.text(" ".join((
        tr("Tolerances were given as the total width of the buffer; the half-width stands beside it.") if total_width
        else tr("Tolerances were given as the half-width of the buffer, from the line to its rim."),
        tr("Completeness (recall) is the share of the reference within the tolerance of the result; correctness "
           "(precision) the share of the result within the tolerance of the reference, and miscoding the share outside it: the buffer lies "
           "about the reference. Quality is matched result over result and unmatched reference."),
        tr("Lines that cross at more than {angle:g}° do not match.").format(angle=settings.max_angle) if settings.max_angle < 90
        else tr("Lines match whatever their direction."))))
    page.table(
        (tr("Half-width (cm)"), tr("Total width (cm)"), tr("Completeness (%)"), tr("Correctness (%)"), tr("Miscoding (%)"), tr("Quality (%)"),
         tr("Gaps per km"), tr("Mean gap (m)")),
        [(plain(100 * t), plain(200 * t), percent(accuracy.completeness[t]), percent(accuracy.correctness[t]), percent(accuracy.miscoding[t]),
          percent(accuracy.quality[t]), accuracy.gaps_per_km[t], accuracy.mean_gap[t]) for t in settings.tolerances],
        (None, None, 2, 2, 2, 2, 2, 2))
    page.note(tr("{result:.1f} m of result, {reference:.1f} m of reference. A gap is at least "
                 "{gap:g} m of reference without a result within the tolerance.").format(
                     result=accuracy.result_length, reference=accuracy.reference_length, gap=MIN_REFERENCE_GAP))
    page.heading(tr("Errors"))
    page.table(("", tr("Mean (cm)"), "RMSE (cm)", "95 % (cm)", tr("Maximum (cm)")),
               [(tr("Across"), *errors_row(accuracy.lateral)), (tr("Height"), *errors_row(accuracy.height))], (None, 2, 2, 2, 2))
    page.note(tr("Of the result within {distance:.0f} cm of a reference line. The mean across is positive left of the reference as drawn.").format(
        distance=100 * MAX_MATCH_DISTANCE))
    _per_line(page, match, settings)
    page.heading(tr("Map, within {tolerance:g} cm").format(tolerance=100 * settings.tolerance))
    outcome_map(page, layer, tr("The result's lines, correct and false, and the reference where it was missed; north is up."))
    page.heading(tr("Along the road"))
    error_along_road(page, station[0], match.lateral, match.result_points.length, along)
    wrong, missed = match.to_reference > settings.tolerance, match.to_result > settings.tolerance
    outcomes_along_road(
        page, {"correct": station[0][~wrong], "false": station[0][wrong], "missed": station[1][missed]},
        {"correct": match.result_points.length[~wrong], "false": match.result_points.length[wrong],
         "missed": match.reference_points.length[missed]}, along, "m")
    page.heading(tr("Distribution"))
    error_histogram(page, match.lateral, match.result_points.length, tr("positive left of the reference as drawn"))
    return page.html()


def _per_line(page, match, settings):
    if len(match.reference) < 2 or len(match.reference) > 60:
        return
    page.heading(tr("Line by line"))
    widths = settings.tolerances
    page.table(
        (tr("Reference line"), tr("Length (m)"), *(tr("Recall {tolerance:g} cm (%)").format(tolerance=100 * t) for t in widths),
         *(tr("Miscoding {tolerance:g} cm (%)").format(tolerance=100 * t) for t in widths), "RMSE (cm)"),
        [(str(k + 1), found.reference_length, *(percent(found.completeness[t]) for t in widths), *(percent(found.miscoding[t]) for t in widths),
          None if np.isnan(found.rmse) else 100 * found.rmse) for k, found in enumerate(match.per_reference_line(widths))],
        (None,) + (2,) * (2 * len(widths) + 2))
    page.note(tr("Half-widths. Each reference line with the result that lies nearest to it; result farther than "
                 "{distance:.0f} cm from every reference line belongs to none and shows in the table above only.").format(
                     distance=100 * MAX_MATCH_DISTANCE))


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
    page = _page(tr("Accuracy of markings"), names, notes)
    page.text(tr(
        "Judged in cells of {size:g} cm; a cell is painted when its centre is. With a tolerance of one cell the other side is "
        "widened by one cell all round before the comparison. An object is found, or right, if at least {share:g} % of its "
        "cells are, with a tolerance of {cells}.").format(
            size=100 * settings.cell_size, share=100 * settings.found_share, cells=_cells(settings.tolerance)))
    rows = [(tr("Cells, strict") if t == 0 else tr("Cells, tolerance {cells}").format(cells=_cells(t)), rates) for t, rates in accuracy.rates.items()]
    page.table(("", tr("Right"), tr("False"), tr("Missed"), tr("Precision (%)"), tr("Recall (%)"), "F1 (%)", "IoU (%)"),
               [(name, int(r.right), int(r.false), int(r.missed), percent(r.precision), percent(r.recall), percent(r.f1), percent(r.iou))
                for name, r in (*rows, (tr("Objects"), accuracy.objects))], (None,) * 4 + (2,) * 4)
    page.note(tr("With a tolerance and for objects, IoU is F1 / (2 − F1): right cells of the result and found ones of the reference differ in "
                 "number."))
    _classes(page, accuracy)
    page.heading(tr("Map"))
    background = grey_background(image) if image else None
    outcome_map(page, layer, tr("Objects of the reference that were found and missed, and false objects of the result; north is up."),
                background, filled=True)
    page.heading(tr("Along the road"))
    blocks, size = accuracy.blocks, settings.cell_size**2
    outcomes = ("correct", "missed", "false")
    areas = {name: blocks[:, 2 + k] * size for k, name in enumerate(outcomes)}
    outcomes_along_road(page, dict.fromkeys(outcomes, station), areas, told(along), "m²")
    page.note(tr("With a tolerance of {cells}.").format(cells=_cells(settings.tolerance)))
    return page.html()


def _cells(count):
    return (tr("{count} cell") if count == 1 else tr("{count} cells")).format(count=count)


def _classes(page, accuracy):
    if not accuracy.by_class:
        return
    page.heading(tr("By class"))
    tolerance = accuracy.settings.tolerance
    rows = []
    for name, found in accuracy.by_class.items():
        own = found.rates if found.result and found.reference else None
        rows.append((word(name, "class"), found.reference, _share(found.found, found.reference), _share(found.found_beside, found.reference),
                     found.result, _share(found.right, found.result), _share(found.right_beside, found.result),
                     percent(own.f1) if own else None, percent(own.iou) if own else None))
    beside = tr("within {cells} (%)").format(cells=_cells(tolerance))
    page.table((tr("Class"), tr("Reference cells"), tr("Recall (%)"), beside, tr("Result cells"), tr("Precision (%)"), beside,
                tr("F1 of the class (%)"), tr("IoU of the class (%)")), rows,
               (None, None, 2, 2, None, 2, 2, 2, 2))
    page.note(tr("Recall and precision count paint of any class; F1 and IoU of the class require the same class in both, if both have it."))


def _share(part, whole):
    return 100.0 * part / whole if whole else None
