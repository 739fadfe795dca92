"""Reports of the accuracy of road boundaries, driving lines and markings: outcomes on a map and along the road, errors along the road."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely

from ...core.common.features import Features
from ...core.common.texts import told, tr, word
from ...core.lazy import cv2
from ..assess.lines import MAX_MATCH_DISTANCE, MIN_REFERENCE_GAP, BoundaryAccuracy, LineAccuracy, LineAccuracySettings, LineMatch
from ..assess.markings import MarkingAccuracy
from ..assess.matching import Errors
from .page import MAP_MARGIN, Chart, draw_map, grey_background, html_page, percent, round_down

OUTCOME_COLOURS = {"correct": "#009e73", "missed": "#d55e00", "false": "#a33ea1", "excluded": "#9a9a9a"}
BAR_COLOUR, CURVE_COLOUR = "#4a7fb5", "#333333"
PAPER_GREY = 246          # grey level of an empty map
MAX_MAP_WIDTH, MAX_MAP_HEIGHT = 1800, 1100  # px
MIN_BAR_LENGTH = 10.0     # m of road that one bar stands for, at least
MAX_BARS = 180
ERROR_CLASSES = 41        # of the histogram of errors


def boundary_report(accuracy: BoundaryAccuracy, layer: Features, names: tuple[str, str], notes: Sequence[str] = ()) -> str:
    """The report of a BoundaryAccuracy as HTML. `layer`: of `boundary_layer`; `names`: result and reference as the user calls them."""
    settings, table, judged = accuracy.settings, accuracy.intervals, accuracy.result_group
    along, signed, weights = told(accuracy.along.title), told(accuracy.along.signed), judged.points.length
    hit = np.append(table.hit[:, settings.tolerances.index(settings.tolerance)], False)[judged.interval]
    lateral = np.where(hit, accuracy.lateral, np.nan)
    stations = {name: np.array([row["station_m"] for row in layer.rows if row["outcome"] == name]) for name in OUTCOME_COLOURS}
    reasons = np.unique(table.excluded[table.excluded != ""].astype(str), return_counts=True)
    return html_page(
        "boundary_accuracy", accuracy=accuracy, names=names, notes=notes, along=along, whole=_whole, errors_row=_errors_row,
        rows=list(_by_side(accuracy)), left_out=int((table.excluded != "").sum()),
        reasons=[(told(str(name)), int(count)) for name, count in zip(*reasons)], map=_outcome_map(layer),
        error_chart=_error_along_road(judged.stations.station, lateral, weights, along),
        outcome_chart=_outcomes_along_road(stations, {name: np.ones(len(s)) for name, s in stations.items()}, along, tr("intervals")),
        histogram=_error_histogram(lateral, weights, signed))


def _by_side(accuracy):
    """(side, tolerance, figures) of every side and of all together."""
    for side, figures in (*((name or "unknown", values) for name, values in accuracy.by_side.items()), ("together", accuracy.total)):
        if side != "unknown" or len(accuracy.by_side) > 1:
            yield from ((side, tolerance, figures[tolerance]) for tolerance in accuracy.settings.tolerances)


def driving_report(match: LineMatch, accuracy: LineAccuracy, settings: LineAccuracySettings, layer: Features, names: tuple[str, str],
                   station: tuple[np.ndarray, np.ndarray], along: str, total_width: bool = False, notes: Sequence[str] = ()) -> str:
    """The report of a LineAccuracy as HTML. `layer`: of `driving_line_layer`; `names`: result and reference as the user calls them.

    station : (N,) metres along the road of the result's places and (M,) of the reference's; `along` is what that is measured along
    total_width : whether the user gave tolerances as the whole width of the buffer
    """
    along, length = told(along), match.result_points.length
    wrong, missed = match.to_reference > settings.tolerance, match.to_result > settings.tolerance
    accuracies = match.per_reference_line(settings.tolerances) if 2 <= len(match.reference) <= 60 else []
    return html_page(
        "driving_accuracy", accuracy=accuracy, settings=settings, names=names, notes=notes, total_width=total_width, whole=_whole,
        errors_row=_errors_row, min_gap=MIN_REFERENCE_GAP, max_distance=MAX_MATCH_DISTANCE,
        lines=[(str(k), line.reference_length, *(percent(shares[t]) for shares in (line.completeness, line.miscoding) for t in settings.tolerances),
                _centimetres(line.lateral.rmse)) for k, line in enumerate(accuracies, start=1)],
        map=_outcome_map(layer), error_chart=_error_along_road(station[0], match.lateral, length, along),
        outcome_chart=_outcomes_along_road(
            {"correct": station[0][~wrong], "false": station[0][wrong], "missed": station[1][missed]},
            {"correct": length[~wrong], "false": length[wrong], "missed": match.reference_points.length[missed]}, along, "m"),
        histogram=_error_histogram(match.lateral, length, tr("positive left of the reference as drawn")))


def marking_report(accuracy: MarkingAccuracy, layer: Features, names: tuple[str, str], station: np.ndarray, along: str,
                   image: str | None = None, notes: Sequence[str] = ()) -> str:
    """The report of a MarkingAccuracy as HTML. `layer`: of `marking_layer`; `names`: result and reference as the user calls them.

    station : (N,) metres along the road of `accuracy.blocks`; `along` is what that is measured along
    image : path of a raster to draw the map over, or None
    """
    outcomes = ("correct", "missed", "false")
    areas = {name: accuracy.blocks[:, 2 + k] * accuracy.settings.cell_size**2 for k, name in enumerate(outcomes)}
    return html_page("marking_accuracy", accuracy=accuracy, names=names, notes=notes,
                  share=lambda part, whole: 100.0 * part / whole if whole else None,
                  map=_outcome_map(layer, grey_background(image) if image else None, filled=True),
                  outcome_chart=_outcomes_along_road(dict.fromkeys(outcomes, station), areas, told(along), "m²"))


def _outcome_map(layer, background=None, filled=False):
    """The outcomes of a layer as a picture over a `grey_background`, polygons filled or not; the metres of its bar and its colours."""
    if not len(layer):
        return None
    bounds = shapely.total_bounds(np.array(layer.geometries, object)) + MAP_MARGIN * np.array([-1, -1, 1, 1])
    width, height = bounds[2:] - bounds[:2]
    style = tuple(("outcome", ("outcome", name), tuple(bytes.fromhex(OUTCOME_COLOURS[name][1:])[::-1]), 2 if filled else 4, filled)
                  for name in ("excluded", "correct", "missed", "false"))
    if background is not None:
        grey, extent = background
        background = np.where(grey > 0, 90 + 0.6 * grey, 0).astype(np.uint8), extent
    # a road that runs north would fill several screens
    longest = MAX_MAP_WIDTH if width > height else MAX_MAP_HEIGHT
    picture: Any = draw_map({"outcome": layer}, background, bounds, longest, style, PAPER_GREY)
    length = _scale_bar(picture, longest / max(width, height), min(width, 200.0))
    shown = {row["outcome"] for row in layer.rows}
    return dict(image=picture, bar=length, colours=[(colour, word(name)) for name, colour in OUTCOME_COLOURS.items() if name in shown])


def _scale_bar(picture, scale, width):
    """Draw a scale bar of a round length, at most a fifth of the map; return that length in metres."""
    length = round_down(width / 5)
    base, left = picture.shape[0] - 14, 14
    cv2.rectangle(picture, (left - 3, base - 4), (left + int(length * scale) + 3, base + 4), (255, 255, 255), -1)
    cv2.rectangle(picture, (left, base - 2), (left + int(length * scale), base + 2), (30, 30, 30), -1)
    return length


def _error_along_road(station, error, weights, along):
    """SVG and caption of the RMSE and the largest (N,) lateral error along the road, in bins of 10 m or more; empty where none is known."""
    finite = np.isfinite(station) & np.isfinite(error)
    if not finite.any():
        return "", ""
    edges, number = bins_of(station[finite])
    size, weight = np.abs(error[finite]), weights[finite]
    count = len(edges) - 1
    mean = np.bincount(number, weight * size**2, count) / np.maximum(np.bincount(number, weight, count), 1e-12)
    largest = np.full(count, np.nan)
    np.fmax.at(largest, number, size)
    rms = np.where(np.isfinite(largest), 100 * np.sqrt(mean), np.nan)
    chart = Chart((edges[0], edges[-1]), (0, 1.05 * 100 * np.nanmax(largest)), tr("along {what} (m)", what=along), "cm")
    chart.bars(edges[:-1], edges[1:], rms, BAR_COLOUR, title="RMSE")
    chart.curve(np.repeat(edges, 2)[1:-1], np.repeat(100 * largest, 2), CURVE_COLOUR, tr("largest"))
    return chart.svg(), tr("The lateral error along {what}: bars are the RMSE of every {bin:.0f} m, the line is the largest.",
        what=along, bin=edges[1] - edges[0])


def _error_histogram(error, weights, signed):
    """SVG and caption of a histogram of (N,) lateral errors, metres, with (N,) weights; `signed` says which sign is which."""
    finite = np.isfinite(error)
    if not finite.any():
        return "", ""
    error, weights = 100 * error[finite], weights[finite]
    reach = max(float(np.percentile(np.abs(error), 99)) * 1.15, 0.5)
    edges = np.linspace(-reach, reach, ERROR_CLASSES + 1)
    share = 100 * np.histogram(np.clip(error, edges[0], edges[-1]), edges, weights=weights)[0] / weights.sum()
    chart = Chart((edges[0], edges[-1]), (0, 1.08 * share.max()), tr("lateral error (cm)"), tr("% of the length"))
    chart.bars(edges[:-1], edges[1:], share, BAR_COLOUR)
    return chart.svg(), tr("Lateral error, {signed}; what lies farther out is counted in the outermost bars.", signed=signed)


def _outcomes_along_road(stations: Mapping[str, np.ndarray], lengths: Mapping[str, np.ndarray], along: str, unit: str) -> tuple[str, str]:
    """SVG and caption of stacked bars of what is correct, missed and false, from stations and amounts (N,) of each outcome."""
    all_stations = np.concatenate([stations[name] for name in stations]) if stations else np.empty(0)
    if not np.isfinite(all_stations).any():
        return "", ""
    edges, _ = bins_of(all_stations[np.isfinite(all_stations)])
    count, total, amounts = len(edges) - 1, np.zeros(len(edges) - 1), {}
    for name in stations:
        finite = np.isfinite(stations[name])
        number = np.clip(np.searchsorted(edges, stations[name][finite], side="right") - 1, 0, count - 1)
        amounts[name] = np.bincount(number, lengths[name][finite], count)
        total = total + amounts[name]
    chart = Chart((edges[0], edges[-1]), (0, 1.05 * total.max()), tr("along {what} (m)", what=along), unit)
    base = np.zeros(count)
    for name in OUTCOME_COLOURS:
        if name in amounts:
            base = chart.bars(edges[:-1], edges[1:], amounts[name], OUTCOME_COLOURS[name], base, word(name))
    return chart.svg(), tr("Outcomes along {what}, in every {bin:.0f} m.", what=along, bin=edges[1] - edges[0])


def bins_of(station: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """((B + 1,) edges, multiples of 10 m, of at most about 180 bins; (N,) bin of each station) of (N,) stations along the road, m."""
    low, high = float(station.min()), float(station.max())
    step = MIN_BAR_LENGTH * max(1.0, np.ceil((high - low) / MIN_BAR_LENGTH / MAX_BARS))
    edges = np.arange(np.floor(low / step), np.floor(high / step) + 2) * step
    return edges, np.clip(np.searchsorted(edges, station, side="right") - 1, 0, len(edges) - 2)


def _whole(value):
    """A tolerance in centimetres, as an int if it is whole."""
    return int(round(value)) if abs(value - round(value)) < 1e-6 else value


def _centimetres(value: float | None) -> float | None:
    """Metres as centimetres; None for NaN."""
    return None if value is None or value != value else 100.0 * value


def _errors_row(errors: Errors) -> list[float | None]:
    """Mean, RMSE, 95th percentile and maximum in centimetres."""
    return [_centimetres(value) for value in (errors.mean, errors.rmse, errors.p95, errors.maximum)]
