"""The report on a trajectory that was estimated from the points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..common.texts import told, tr
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
    page = Page(tr("Estimated trajectory"), tr("Where the scanner was, from the point clouds alone."))
    for note in found.notes:
        page.warning(told(note))
    track = found.trajectory
    page.facts(((tr("Way"), tr("from {what}").format(what=told(WAYS[found.method]))),
                (tr("Positions"), len(track)), (tr("Length"), f"{found.length:.1f} m"),
                (tr("Time"), tr("{first:.3f} to {last:.3f} s").format(first=track.time[0], last=track.time[-1]) if track.has_time else tr("no time")),
                (tr("Refers to"), tr("the middle of the scanners") if len(found.scanners) > 1 else tr("the scanner")),
                (tr("Uncertainty of the place, one sigma"), _spread(found.sigma)),
                (tr("Uncertainty of the height, one sigma"), _spread(found.sigma_height))))
    if found.adjusted is not None:
        _scanners(page, found)
        page.heading(tr("Uncertainty along the drive"))
        page.drawing(_chart(found), tr(
            "Blue the place, orange the height, one sigma. It grows at the ends of the cloud, where few lines see the road."))
    return page.html()


def _spread(sigma):
    return tr("{median:.3f} m (median), {largest:.3f} m (largest)").format(median=np.median(sigma), largest=sigma.max())


def _scanners(page, found):
    adjusted, poses = found.adjusted, found.adjusted.poses
    page.heading(tr("Scanners"))
    rows = []
    for k, one in enumerate(found.scanners):
        used = np.isfinite(adjusted.misfit[:, k])
        rows.append((one.number + 1, abs(float(poses.rate[k])), float(np.degrees(poses.turn[k])), float(np.degrees(poses.lean[k])),
                     *map(float, poses.lever[k]), 1000.0 * float(np.median(adjusted.misfit[used, k]))))
    page.table((tr("Scanner"), tr("Turns per second"), tr("Plane turned (°)"), tr("Plane leaning forward (°)"), tr("Ahead (m)"), tr("Left (m)"),
                tr("Up (m)"), tr("Returns off their rays (mm)")), rows, (None, 3, 2, 2, 3, 3, 3, 1))
    page.note(tr("Turned: counter-clockwise from straight across. Ahead, left and up: from the middle of the scanners."))


def _chart(found):
    time = found.trajectory.time - found.trajectory.time[0]
    gone = np.minimum(np.diff(time, prepend=time[0]), 1.0).cumsum()
    cell = np.minimum((gone / max(gone[-1], 1e-9) * CHART_COLUMNS).astype(np.int64), CHART_COLUMNS - 1)
    top = max(float(np.quantile(np.maximum(found.sigma, found.sigma_height), 0.995)), LEAST_CHART_TOP)
    chart = Chart((0.0, float(gone[-1])), (0.0, top), tr("seconds of driving, without pauses"), tr("one sigma (m)"))
    for values, colour, title in ((found.sigma, PLACE_COLOUR, tr("place")), (found.sigma_height, HEIGHT_COLOUR, tr("height"))):
        worst = np.full(CHART_COLUMNS, np.nan)
        np.fmax.at(worst, cell, values)
        chart.curve((np.arange(CHART_COLUMNS) + 0.5) / CHART_COLUMNS * gone[-1], worst, colour, title)
    return chart.svg()
