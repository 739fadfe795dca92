"""Reports on a survey: its files as they are, and a trajectory that was estimated from the points."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import Any

import numpy as np

from ...core.common.texts import tr
from ...core.io.crs import crs_name
from ...core.lazy import cv2
from ...core.survey.estimation.estimate import WAYS, EstimatedTrajectory
from ..inspection import Inspection
from .page import Chart, html_page

DENSITY_PICTURE_SIDE = 1400  # px
NO_DATA_COLOUR = (28, 28, 30)  # blue, green, red
PLACE_COLOUR, HEIGHT_COLOUR = "#1f6feb", "#c2410c"
TRACK_COLOUR, ROAD_COLOUR, BAR_COLOUR = "#e63c3c", "#787878", "#3c6e96"
CHART_COLUMNS = 600   # of the chart: each shows the worst of its time
LEAST_CHART_TOP = 0.02  # m


def inspection_report(inspection: Inspection) -> str:
    first, track, profile = (inspection.time_span or (0.0,))[0], inspection.trajectory, None
    # seconds beyond a week are no seconds of a week, whatever the header says of them
    start = datetime(1980, 1, 6) + timedelta(seconds=first + 1e9) if first > timedelta(weeks=1).total_seconds() else None
    if inspection.drive is not None:
        heights = inspection.drive.profile[:, 1:]
        low, high = float(np.nanmin(heights)), float(np.nanmax(heights))
        chart = Chart((0.0, float(inspection.drive.profile[-1, 0])), (low, high), "m", "m")
        for row, colour in ((2, ROAD_COLOUR), (1, TRACK_COLOUR)):
            chart.curve(inspection.drive.profile[:, 0], inspection.drive.profile[:, row], colour, width=2.0)
        profile = dict(chart=chart.svg(), low=low, high=high)
    values = np.flatnonzero(inspection.intensity)
    quantiles = [int(np.searchsorted(np.cumsum(inspection.intensity) / inspection.count, q)) for q in (0.01, 0.5, 0.99)]
    histogram = _histogram(inspection.intensity, quantiles[0], quantiles[2]) if len(values) > 1 else ""
    return html_page(
        "inspection", inspection=inspection, notes=inspection.notes, crs_name=crs_name, size=inspection.maximum - inspection.minimum,
        density=_density_picture(inspection), profile=profile, start=start and f"{start:%Y-%m-%d %H:%M:%S}",
        driven=None if track is None else float(np.hypot(np.diff(track.x), np.diff(track.y)).sum()),
        intensity=dict(lowest=values[0], highest=values[-1], number=len(values), quantiles=quantiles, chart=histogram))


def _density_picture(inspection: Inspection) -> dict[str, Any]:
    """The density of the points with the trajectory on it: `image` (H, W, 3) uint8, `most` points per m² that it shows, `with_track` or not."""
    density, corner = inspection.density
    filled = np.isfinite(density)
    top = max(float(np.percentile(density[filled], 98)), 1e-9)
    value = np.where(filled, 20 + 235 * np.clip(np.nan_to_num(density) / top, 0, 1), 0).astype(np.uint8)
    image = cv2.applyColorMap(value, cv2.COLORMAP_VIRIDIS)
    image[~filled] = NO_DATA_COLOUR
    scale = max(DENSITY_PICTURE_SIDE / max(density.shape), 1.0 / 64)
    height, width = (max(int(round(n * scale)), 1) for n in density.shape)
    image = cv2.resize(image, (width, height), interpolation=cv2.INTER_NEAREST if scale >= 1 else cv2.INTER_AREA)
    trajectory: Any = inspection.trajectory
    with_track = trajectory is not None and bool(inspection.near_share)
    if with_track:
        track = np.c_[trajectory.x - corner[0], corner[1] - trajectory.y] / inspection.settings.cell_size * scale
        cv2.polylines(image, [np.rint(track).astype(np.int32)], False, (60, 60, 255), 2, cv2.LINE_AA)
    return dict(image=image, most=top, with_track=with_track)


def _histogram(counts, low, high):
    """SVG of how often the values from low to high occur, from the counts (M,) of the values from 0 on."""
    edges = np.linspace(low, high + 1, min(CHART_COLUMNS, high - low + 1) + 1)
    frequency = np.histogram(np.arange(low, high + 1), edges, weights=counts[low:high + 1])[0] / np.diff(edges)
    chart = Chart((low, high + 1), (0.0, float(frequency.max())), tr("Intensity"), "")
    chart.bars(edges[:-1], edges[1:], frequency, BAR_COLOUR)
    return chart.svg()


def estimated_trajectory_report(estimate: EstimatedTrajectory) -> str:
    place, height = ((np.median(sigma), sigma.max()) for sigma in (estimate.sigma, estimate.sigma_height))
    return html_page("estimated_trajectory", estimate=estimate, notes=estimate.notes, way=WAYS[estimate.method], place=place, height=height,
                  scanners=_scanners(estimate), chart="" if estimate.adjusted is None else _chart_of_sigmas(estimate))


def _scanners(estimate):
    if estimate.adjusted is None:
        return []
    adjusted, poses = estimate.adjusted, estimate.adjusted.poses
    return [(scanner.number + 1, abs(float(poses.rate[k])), float(np.degrees(poses.turn[k])), float(np.degrees(poses.lean[k])),
             *map(float, poses.lever[k]), 1000.0 * float(np.median(misfit[np.isfinite(misfit)])))
            for k, (scanner, misfit) in enumerate(zip(estimate.scanners, adjusted.misfit.T))]


def _chart_of_sigmas(estimate):
    time = estimate.trajectory.time - estimate.trajectory.time[0]
    gone = np.minimum(np.diff(time, prepend=time[0]), 1.0).cumsum()
    cell = np.minimum((gone / max(gone[-1], 1e-9) * CHART_COLUMNS).astype(np.int64), CHART_COLUMNS - 1)
    top = max(float(np.quantile(np.maximum(estimate.sigma, estimate.sigma_height), 0.995)), LEAST_CHART_TOP)
    chart = Chart((0.0, float(gone[-1])), (0.0, top), tr("seconds of driving, without pauses"), tr("one sigma (m)"))
    for values, colour, title in ((estimate.sigma, PLACE_COLOUR, tr("place")), (estimate.sigma_height, HEIGHT_COLOUR, tr("height"))):
        worst = np.full(CHART_COLUMNS, np.nan)
        np.fmax.at(worst, cell, values)
        chart.curve((np.arange(CHART_COLUMNS) + 0.5) / CHART_COLUMNS * gone[-1], worst, colour, title)
    return chart.svg()
