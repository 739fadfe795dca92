"""What the reports of the three assessments share: colours, map, and charts along the road."""

import cv2
import numpy as np
import shapely

from .chart import Chart
from .map_picture import draw_map, png

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
