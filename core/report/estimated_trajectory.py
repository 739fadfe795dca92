"""The report on a trajectory that was estimated from the points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..survey.estimation.estimate import WAYS
from .figures import Chart
from .page import Page

if TYPE_CHECKING:
    from ..survey.estimation.estimate import EstimatedTrajectory

PLACE_COLOUR, HEIGHT_COLOUR = "#1f6feb", "#c2410c"
CHART_COLUMNS = 600   # of the chart: each shows the worst of its time
LEAST_CHART_TOP = 0.02  # m


def estimated_trajectory_report(found: EstimatedTrajectory) -> str:
    """The report on an EstimatedTrajectory as HTML."""
    page = Page("Estimated trajectory", "Where the scanner was, from the point clouds alone.")
    for note in found.notes:
        page.warning(note)
    track = found.trajectory
    page.facts((("Way", f"from {WAYS[found.method]}"),
                ("Positions", len(track)), ("Length", f"{found.length:.1f} m"),
                ("Time", f"{track.time[0]:.3f} to {track.time[-1]:.3f} s" if track.has_time else "none"),
                ("Refers to", "the middle of the scanners" if len(found.scanners) > 1 else "the scanner"),
                ("Uncertainty of the place, one sigma", _spread(found.sigma)), ("Uncertainty of the height, one sigma", _spread(found.sigma_height))))
    if found.adjusted is not None:
        _scanners(page, found)
        page.heading("Uncertainty along the drive")
        page.drawing(_chart(found), "Blue the place, orange the height, one sigma. It grows at the ends of the cloud, where few lines see the road.")
    return page.html()


def _spread(sigma):
    return f"{np.median(sigma):.3f} m (median), {sigma.max():.3f} m (largest)"


def _scanners(page, found):
    adjusted, poses = found.adjusted, found.adjusted.poses
    page.heading("Scanners")
    rows = []
    for k, one in enumerate(found.scanners):
        used = np.isfinite(adjusted.misfit[:, k])
        rows.append((one.number + 1, abs(float(poses.rate[k])), float(np.degrees(poses.turn[k])), float(np.degrees(poses.lean[k])),
                     *map(float, poses.lever[k]), 1000.0 * float(np.median(adjusted.misfit[used, k]))))
    page.table(("Scanner", "Turns per second", "Plane turned (°)", "Plane leaning forward (°)", "Ahead (m)", "Left (m)", "Up (m)",
                "Returns off their rays (mm)"), rows, (None, 3, 2, 2, 3, 3, 3, 1))
    page.note("Turned: counter-clockwise from straight across. Ahead, left and up: from the middle of the scanners.")


def _chart(found):
    time = found.trajectory.time - found.trajectory.time[0]
    gone = np.minimum(np.diff(time, prepend=time[0]), 1.0).cumsum()
    cell = np.minimum((gone / max(gone[-1], 1e-9) * CHART_COLUMNS).astype(np.int64), CHART_COLUMNS - 1)
    top = max(float(np.quantile(np.maximum(found.sigma, found.sigma_height), 0.995)), LEAST_CHART_TOP)
    chart = Chart((0.0, float(gone[-1])), (0.0, top), "seconds of driving, without pauses", "one sigma (m)")
    for values, colour, title in ((found.sigma, PLACE_COLOUR, "place"), (found.sigma_height, HEIGHT_COLOUR, "height")):
        worst = np.full(CHART_COLUMNS, np.nan)
        np.fmax.at(worst, cell, values)
        chart.curve((np.arange(CHART_COLUMNS) + 0.5) / CHART_COLUMNS * gone[-1], worst, colour, title)
    return chart.svg()
