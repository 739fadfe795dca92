"""Figures and numbers that the reports of all assessments share: outcomes on a map and along the road, errors along the road."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import shapely

from ..assess.metrics import Errors
from ..common.features import Features
from ..common.texts import tr, word
from ..lazy import cv2
from .figures import Chart
from .map_figure import MAP_MARGIN, draw_map, png
from .page import Page

OUTCOME_COLOURS = {"correct": "#009e73", "missed": "#d55e00", "false": "#a33ea1", "excluded": "#9a9a9a"}
BAR_COLOUR, CURVE_COLOUR = "#4a7fb5", "#333333"
PAPER_GREY = 246          # grey level of an empty map
MAX_MAP_WIDTH, MAX_MAP_HEIGHT = 1800, 1100  # px
MIN_BAR_LENGTH = 10.0     # m of road that one bar stands for, at least
MAX_BARS = 180
ERROR_CLASSES = 41        # of the histogram of errors


def outcome_map(page: Page, layer: Features, caption: str, background: tuple[np.ndarray, Any] | None = None, filled: bool = False) -> None:
    """Add a map of the outcomes.

    Parameters
    ----------
    page : Page
    layer : Features with the field `outcome`
    caption : of the map
    background : of `grey_background`, or None
    filled : whether polygons are filled
    """
    if not len(layer):
        return
    bounds = shapely.total_bounds(np.array(layer.geometries, object)) + MAP_MARGIN * np.array([-1, -1, 1, 1])
    width, height = bounds[2:] - bounds[:2]
    style = tuple(("outcome", ("outcome", name), _bgr(OUTCOME_COLOURS[name]), 2 if filled else 4, filled)
                  for name in ("excluded", "correct", "missed", "false"))
    if background is not None:
        grey, extent = background
        background = np.where(grey > 0, 90 + 0.6 * grey, 0).astype(np.uint8), extent
    # a road that runs north would fill several screens
    longest = MAX_MAP_WIDTH if width > height else MAX_MAP_HEIGHT
    picture: Any = draw_map({"outcome": layer}, background, bounds, longest, style, PAPER_GREY)
    length = _scale_bar(picture, longest / max(width, height), min(width, 200.0))
    page.picture(png(picture), caption + " " + tr("The bar is {length:g} m long.").format(length=length))
    shown = {row["outcome"] for row in layer.rows}
    page.colour_key([(colour, word(name)) for name, colour in OUTCOME_COLOURS.items() if name in shown])


def _scale_bar(picture, scale, width):
    """Draw a scale bar of a round length, at most a fifth of the map; return that length in metres."""
    power = 10.0 ** np.floor(np.log10(width / 5))
    length = power * max(m for m in (1, 2, 5) if m * power <= width / 5 * 1.001)
    base, left = picture.shape[0] - 14, 14
    cv2.rectangle(picture, (left - 3, base - 4), (left + int(length * scale) + 3, base + 4), (255, 255, 255), -1)
    cv2.rectangle(picture, (left, base - 2), (left + int(length * scale), base + 2), (30, 30, 30), -1)
    return length


def error_along_road(page: Page, station: np.ndarray, error: np.ndarray, weights: np.ndarray, along: str) -> None:
    """Add a chart of the RMSE and the largest lateral error along the road, in bins of 10 m or more.

    Parameters
    ----------
    page : Page
    station, error, weights : (N,) metres
    along : what stations are measured along
    """
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
    chart = Chart((edges[0], edges[-1]), (0, 1.05 * 100 * np.nanmax(largest)), tr("along {what} (m)").format(what=along), "cm")
    chart.bars(edges[:-1], edges[1:], rms, BAR_COLOUR, title="RMSE")
    chart.curve(np.repeat(edges, 2)[1:-1], np.repeat(100 * largest, 2), CURVE_COLOUR, tr("largest"))
    page.drawing(chart.svg(), tr("The lateral error along {what}: bars are the RMSE of every {bin:.0f} m, the line is the largest.").format(
        what=along, bin=edges[1] - edges[0]))


def error_histogram(page: Page, error: np.ndarray, weights: np.ndarray, signed: str) -> None:
    """Add a histogram of (N,) lateral errors, metres, with (N,) weights; `signed` says which sign is which."""
    known = np.isfinite(error)
    if not known.any():
        return
    error, weights = 100 * error[known], weights[known]
    reach = max(float(np.percentile(np.abs(error), 99)) * 1.15, 0.5)
    edges = np.linspace(-reach, reach, ERROR_CLASSES + 1)
    share = 100 * np.histogram(np.clip(error, edges[0], edges[-1]), edges, weights=weights)[0] / weights.sum()
    chart = Chart((edges[0], edges[-1]), (0, 1.08 * share.max()), tr("lateral error (cm)"), tr("% of the length"))
    chart.bars(edges[:-1], edges[1:], share, BAR_COLOUR)
    page.drawing(chart.svg(), tr("Lateral error, {signed}; what lies farther out is counted in the outermost bars.").format(signed=signed))


def outcomes_along_road(page: Page, stations: Mapping[str, np.ndarray], lengths: Mapping[str, np.ndarray], along: str, unit: str) -> None:
    """Add stacked bars of what is correct, missed and false along the road.

    Parameters
    ----------
    page : Page
    stations, lengths : outcome to (N,) metres along the road and to (N,) amounts
    along : what stations are measured along
    unit : of the amounts
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
    chart = Chart((edges[0], edges[-1]), (0, 1.05 * total.max()), tr("along {what} (m)").format(what=along), unit)
    base = np.zeros(count)
    for name in OUTCOME_COLOURS:
        if name in amounts:
            base = chart.bars(edges[:-1], edges[1:], amounts[name], OUTCOME_COLOURS[name], base, word(name))
    page.drawing(chart.svg(), tr("Outcomes along {what}, in every {bin:.0f} m.").format(what=along, bin=edges[1] - edges[0]))


def bins_of(station: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Bins along the road.

    Parameters
    ----------
    station : (N,) metres

    Returns
    -------
    edges : (B + 1,) metres, multiples of 10 m, B at most about 180
    number : (N,) index of the bin of each station
    """
    low, high = float(station.min()), float(station.max())
    step = MIN_BAR_LENGTH * max(1.0, np.ceil((high - low) / MIN_BAR_LENGTH / MAX_BARS))
    edges = np.arange(np.floor(low / step), np.floor(high / step) + 2) * step
    return edges, np.clip(np.searchsorted(edges, station, side="right") - 1, 0, len(edges) - 2)


def plain(value: float) -> float:
    """A tolerance in centimetres, as an int if it is whole."""
    return int(round(value)) if abs(value - round(value)) < 1e-6 else value


def centimetres(value: float | None) -> float | None:
    """Metres as centimetres; None for NaN."""
    return None if value is None or value != value else 100.0 * value


def percent(share: float) -> float | None:
    """A share as a percentage; None for NaN."""
    return None if share != share else 100.0 * share


def errors_row(errors: Errors) -> list[float | None]:
    """Mean, RMSE, 95th percentile and maximum in centimetres."""
    return [centimetres(value) for value in (errors.mean, errors.rmse, errors.p95, errors.maximum)]


def _bgr(colour):
    return tuple(int(colour[k:k + 2], 16) for k in (5, 3, 1))
