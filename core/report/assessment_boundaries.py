"""The report on road boundaries set against a reference."""

import numpy as np

from .assessment import COLOURS, error_along_road, error_spread, errors_row, outcome_map, outcomes_along_road, percent, plain
from .page import Page


def boundary_report(accuracy, layer, names, notes=()):
    """HTML of a BoundaryAccuracy.

    Parameters
    ----------
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
    mine = accuracy.mine
    hit = np.append(table.hit[:, settings.tolerances.index(settings.tolerance)], False)[mine.interval]
    lateral = np.where(hit, accuracy.lateral, np.nan)
    error_along_road(page, mine.stations.station, lateral, mine.places.length, accuracy.along.title)
    stations = {name: np.array([row["station_m"] for row in layer.rows if row["outcome"] == name]) for name in COLOURS}
    outcomes_along_road(page, stations, {name: np.ones(len(s)) for name, s in stations.items()}, accuracy.along.title, "intervals")
    page.heading("Distribution")
    error_spread(page, lateral, mine.places.length, accuracy.along.signed)
    return page.html()


def _rows(accuracy):
    for side, found in (*((name or "untold", figures) for name, figures in accuracy.by_side.items()), ("together", accuracy.total)):
        if side == "untold" and len(accuracy.by_side) == 1:
            continue
        for tolerance in accuracy.settings.tolerances:
            yield side, tolerance, found[tolerance]


def _reasons(page, table):
    names, counts = np.unique(table.excluded[table.excluded != ""].astype(str), return_counts=True)
    if len(names):
        page.table(("Not judged because", "Intervals"), [(str(name), int(count)) for name, count in zip(names, counts)])
