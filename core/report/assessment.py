"""What the reports of the three assessments share: colours, map, and charts along the road."""

import cv2
import numpy as np
import shapely

from ..assess.driving_lines import MAX_MATCH_DISTANCE, MIN_REFERENCE_GAP
from .figures import Chart
from .map_figure import draw_map, grey_background, png
from .page import Page

COLOURS = {"correct": "#009e73", "missed": "#d55e00", "false": "#a33ea1", "excluded": "#9a9a9a"}
PAPER = 246
WIDE, TALL = 1800, 1100  # pixels of the map's longer side
BIN = 10.0      # m of road that one bar stands for, at least
BARS = 180      # bars at most
SPREAD = 41     # classes of the distribution of errors


def outcome_map(page, layer, caption, background=None, filled=False):
    """The layer coloured by outcome, over a grey image where there is one."""
    if not len(layer):
        return
    bounds = shapely.total_bounds(np.array(layer.geometries, object)) + np.array([-3, -3, 3, 3])
    width, height = bounds[2:] - bounds[:2]
    style = tuple(("outcome", ("outcome", name), _bgr(COLOURS[name]), 2 if filled else 4, filled)
                  for name in ("excluded", "correct", "missed", "false"))
    if background is not None:
        grey, extent = background
        background = np.where(grey > 0, 90 + 0.6 * grey, 0).astype(np.uint8), extent
    # a road that runs north would fill several screens
    longest = WIDE if width > height else TALL
    picture = draw_map({"outcome": layer}, background, bounds, longest, style, PAPER)
    length = _scale_bar(picture, longest / max(width, height), min(width, 200.0))
    page.picture(png(picture), f"{caption} The bar is {length:g} m long.")
    shown = {row["outcome"] for row in layer.rows}
    page.colour_key([(colour, name) for name, colour in COLOURS.items() if name in shown])


def _scale_bar(picture, scale, width):
    """Draw a bar of a round number of metres, a fifth of the map or less; that number."""
    power = 10.0 ** np.floor(np.log10(width / 5))
    length = power * max(m for m in (1, 2, 5) if m * power <= width / 5 * 1.001)
    foot, left = picture.shape[0] - 14, 14
    cv2.rectangle(picture, (left - 3, foot - 4), (left + int(length * scale) + 3, foot + 4), (255, 255, 255), -1)
    cv2.rectangle(picture, (left, foot - 2), (left + int(length * scale), foot + 2), (30, 30, 30), -1)
    return length


def error_along_road(page, station, error, weights, along, what="lateral error"):
    """Bars of the root mean square error of every 10 m or more along the road, in centimetres, with the largest as a line."""
    known = np.isfinite(station) & np.isfinite(error)
    if not known.any():
        return
    edges, number = bins_of(station[known])
    size, weight = np.abs(error[known]), weights[known]
    count = len(edges) - 1
    mean = np.bincount(number, weight * size**2, count) / np.maximum(np.bincount(number, weight, count), 1e-12)
    largest = np.full(count, np.nan)
    np.fmax.at(largest, number, size)
    rms = np.where(np.isfinite(largest), 100 * np.sqrt(mean), np.nan)
    chart = Chart((edges[0], edges[-1]), (0, 1.05 * 100 * np.nanmax(largest)), f"along {along} (m)", "cm")
    chart.bars(edges[:-1], edges[1:], rms, "#4a7fb5", title="RMSE")
    chart.curve(np.repeat(edges, 2)[1:-1], np.repeat(100 * largest, 2), "#333333", "largest")
    page.drawing(chart.svg(), f"The {what} along {along}: bars are the RMSE of every {edges[1] - edges[0]:.0f} m, the line is the largest.")


def error_spread(page, error, weights, signed, what="Lateral error"):
    """How often each error occurs."""
    known = np.isfinite(error)
    if not known.any():
        return
    error, weights = 100 * error[known], weights[known]
    reach = max(float(np.percentile(np.abs(error), 99)) * 1.15, 0.5)
    edges = np.linspace(-reach, reach, SPREAD + 1)
    share = 100 * np.histogram(np.clip(error, edges[0], edges[-1]), edges, weights=weights)[0] / weights.sum()
    chart = Chart((edges[0], edges[-1]), (0, 1.08 * share.max()), f"{what.lower()} (cm)", "% of the length")
    chart.bars(edges[:-1], edges[1:], share, "#4a7fb5")
    page.drawing(chart.svg(), f"{what}, {signed}; what lies farther out is counted in the outermost bars.")


def outcomes_along_road(page, stations, lengths, along, unit):
    """Stacked bars of how much is correct, missed and false in every stretch of road.

    stations, lengths : dict of outcome to (N,) metres along the road and (N,) amounts
    """
    everything = np.concatenate([stations[name] for name in stations]) if stations else np.empty(0)
    if not np.isfinite(everything).any():
        return
    edges, _ = bins_of(everything[np.isfinite(everything)])
    count, total, amounts = len(edges) - 1, np.zeros(len(edges) - 1), {}
    for name in stations:
        known = np.isfinite(stations[name])
        number = np.clip(np.searchsorted(edges, stations[name][known], side="right") - 1, 0, count - 1)
        amounts[name] = np.bincount(number, lengths[name][known], count)
        total = total + amounts[name]
    chart = Chart((edges[0], edges[-1]), (0, 1.05 * total.max()), f"along {along} (m)", unit)
    base = np.zeros(count)
    for name in COLOURS:
        if name in amounts:
            base = chart.bars(edges[:-1], edges[1:], amounts[name], COLOURS[name], base, name)
    page.drawing(chart.svg(), f"Outcomes along {along}, in every {edges[1] - edges[0]:.0f} m.")


def bins_of(station):
    """(edges, number of each station's bin): whole multiples of 10 m, no more than 180 bins."""
    low, high = float(station.min()), float(station.max())
    step = BIN * max(1.0, np.ceil((high - low) / BIN / BARS))
    edges = np.arange(np.floor(low / step), np.floor(high / step) + 2) * step
    return edges, np.clip(np.searchsorted(edges, station, side="right") - 1, 0, len(edges) - 2)


def plain(value):
    """A tolerance in centimetres: whole where it is."""
    return int(round(value)) if abs(value - round(value)) < 1e-6 else value


def centimetres(value):
    return None if value is None or value != value else 100.0 * value


def percent(share):
    return None if share != share else 100.0 * share


def errors_row(errors):
    """Mean, RMSE, 95th percentile and maximum in centimetres."""
    return [centimetres(value) for value in (errors.mean, errors.rmse, errors.p95, errors.maximum)]


def _bgr(colour):
    return tuple(int(colour[k:k + 2], 16) for k in (5, 3, 1))


# The report on road boundaries set against a reference.

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
    judged = accuracy.result_group
    hit = np.append(table.hit[:, settings.tolerances.index(settings.tolerance)], False)[judged.interval]
    lateral = np.where(hit, accuracy.lateral, np.nan)
    error_along_road(page, judged.stations.station, lateral, judged.points.length, accuracy.along.title)
    stations = {name: np.array([row["station_m"] for row in layer.rows if row["outcome"] == name]) for name in COLOURS}
    outcomes_along_road(page, stations, {name: np.ones(len(s)) for name, s in stations.items()}, accuracy.along.title, "intervals")
    page.heading("Distribution")
    error_spread(page, lateral, judged.points.length, accuracy.along.signed)
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


# The report on driving lines set against a reference.

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
    error_spread(page, match.lateral, match.result_points.length, "positive left of the reference as drawn")
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


# The report on markings set against a reference.

def marking_report(accuracy, layer, names, station, along, image=None, notes=()):
    """HTML of a MarkingAccuracy.

    Parameters
    ----------
    layer : Features of `marking_layer`
    station : (N,) metres along the road of `accuracy.blocks`
    along : what that is measured along
    image : path of a raster to draw the map over, or None
    """
    settings = accuracy.settings
    page = Page("Accuracy of markings", f"{names[0]} against {names[1]}.")
    for note in notes:
        page.warning(note)
    page.text(
        f"Judged in cells of {100 * settings.cell_size:g} cm; a cell is painted when its centre is. With a tolerance of one cell the other side is "
        f"widened by one cell all round before it is asked. An object is found, or right, when at least {100 * settings.found_share:g} % of its "
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
    names = ("correct", "missed", "false")
    outcomes_along_road(page, dict.fromkeys(names, station), {name: blocks[:, 2 + k] * size for k, name in enumerate(names)}, along, "m²")
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
    page.note("Recall and precision ask for paint of any class; F1 and IoU of the class ask for the same class in both, where both name it.")


def _share(part, whole):
    return 100.0 * part / whole if whole else None
