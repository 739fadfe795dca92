"""The report on a survey's files."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.texts import told, tr
from ..io.crs import horizontal_part, parse_crs
from ..lazy import cv2
from ..survey.trajectory.time_systems import SECONDS_PER_WEEK
from .map_figure import png
from .page import Page

if TYPE_CHECKING:
    from ..survey.inspection import Inspection

DENSITY_PICTURE_SIDE = 1400  # px
NO_DATA_COLOUR = (28, 28, 30)  # blue, green, red


def inspection_report(found: Inspection) -> str:
    """The report of an Inspection as HTML."""
    page = Page(tr("Survey"), tr("What the point clouds and the trajectory hold, before any work is done on them."))
    for note in found.notes:
        page.warning(told(note))
    _points(page, found)
    _density(page, found)
    _time(page, found)
    _drive(page, found.drive)
    _intensity(page, found)
    page.heading(tr("Files"))
    page.table(
        (tr("File"), "LAS", tr("Point format"), tr("Points"), "x", "y", "z", tr("CRS")),
        [(file.path, file.version, file.point_format, file.count, *(f"{a:.1f} – {b:.1f}" for a, b in zip(file.minimum, file.maximum)),
          _crs_name(file.crs)) for file in found.files])
    return page.html()


def _points(page, found):
    size = found.maximum - found.minimum
    page.heading(tr("Points"))
    page.facts((
        (tr("Points"), found.count), (tr("Files"), len(found.files)), (tr("CRS"), _crs_name(found.crs)),
        (tr("Extent"), tr("{width:.1f} × {depth:.1f} m, {height:.1f} m high").format(width=size[0], depth=size[1], height=size[2])),
        *((axis, tr("{low:.2f} to {high:.2f}").format(low=low, high=high)) for axis, low, high in zip("xyz", found.minimum, found.maximum)),
        (tr("Returns"), _shares(found.returns, found.count)), (tr("Classes"), _shares(found.classes, found.count))))


def _density(page, found):
    page.heading(tr("Density"))
    page.table(
        ("", tr("Points per m²"), tr("Points per m³")),
        [(title, float(found.per_area[key]), float(found.per_volume[key])) for title, key in (
            (tr("Mean of occupied cells"), "mean"), (tr("Median of occupied cells"), "median"),
            (tr("As a point sees it (mean over points)"), "of_a_point"), (tr("Densest cell"), "largest"))])
    image, caption = density_picture(found)
    page.picture(png(image), caption)


def density_picture(found: Inspection) -> tuple[np.ndarray, str]:
    """((H, W, 3) uint8 picture of the density with the trajectory on it, its caption)."""
    density, corner = found.density
    known = np.isfinite(density)
    top = max(float(np.percentile(density[known], 98)), 1e-9)
    value = np.where(known, 20 + 235 * np.clip(np.nan_to_num(density) / top, 0, 1), 0).astype(np.uint8)
    image = cv2.applyColorMap(value, cv2.COLORMAP_VIRIDIS)
    image[~known] = NO_DATA_COLOUR
    scale = max(DENSITY_PICTURE_SIDE / max(density.shape), 1.0 / 64)
    height, width = (max(int(round(n * scale)), 1) for n in density.shape)
    image = cv2.resize(image, (width, height), interpolation=cv2.INTER_NEAREST if scale >= 1 else cv2.INTER_AREA)
    caption = tr("Points per m², from 0 (dark) to {most:.0f} (yellow); north is up.").format(most=top)
    trajectory: Any = found.trajectory
    if trajectory is not None and found.near_share:
        track = np.c_[trajectory.x - corner[0], corner[1] - trajectory.y] / found.settings.cell_size * scale
        cv2.polylines(image, [np.rint(track).astype(np.int32)], False, (60, 60, 255), 2, cv2.LINE_AA)
        caption += " " + tr("Red is the trajectory.")
    return image, caption


def _time(page, found):
    page.heading(tr("Time and scanners"))
    rows = []
    if found.time_span:
        first, last = found.time_span
        rows.append(("gps_time", tr("{first:.3f} to {last:.3f} s, {seconds:.1f} s").format(first=first, last=last, seconds=last - first)))
        if first > SECONDS_PER_WEEK:   # whatever the header says of them
            start = datetime(1980, 1, 6) + timedelta(seconds=first + 1e9)
            rows.append((tr("Counted as"), tr("adjusted standard GPS time; begins {start} in GPS time").format(start=f"{start:%Y-%m-%d %H:%M:%S}")))
        else:
            rows.append((tr("Counted as"), tr("seconds of the GPS week, says the file")))
    else:
        rows.append(("gps_time", tr("none that can be used")))
    apart = tr("{count}, distinguished by {field}").format(count=len(found.scanners), field=found.scanner_field)
    rows.append((tr("Scanners"), apart if found.scanner_field else "1"))
    if found.near_share is not None:
        rows.append((tr("Points within 25 m of the trajectory"), f"{100 * found.near_share:.1f} %"))
    if found.in_time_share is not None:
        rows.append((tr("Scan time covered by the trajectory"), f"{100 * found.in_time_share:.1f} %"))
    if found.trajectory is not None:
        driven = float(np.hypot(np.diff(found.trajectory.x), np.diff(found.trajectory.y)).sum())
        rows.append((tr("Trajectory"), tr("{count} positions over {length:.1f} m").format(count=len(found.trajectory), length=driven)))
    page.facts(rows)


def _drive(page, drive):
    if drive is None:
        return
    page.heading(tr("Drive"))
    height = tr("unknown: too few points lie under the vehicle") if drive.sensor_height is None else \
        tr("{height:.2f} m above the road").format(height=drive.sensor_height)
    page.facts(((tr("Driven"), f"{drive.driven:.1f} m"), (tr("Trajectory"), height),
                (tr("Roads"), ", ".join(tr("road {number}: {length:.1f} m").format(number=number, length=length)
                                        for number, length in enumerate(drive.roads)))))
    page.table(
        (tr("Pass"), tr("Road"), tr("Way"), tr("From station (m)"), tr("To station (m)"), tr("Seconds"), tr("Mean speed (km/h)")),
        [(number, road, tr("along") if way > 0 else tr("against"), round(first, 1) + 0.0, round(last, 1) + 0.0, round(end - start, 1),
          round(3.6 * abs(last - first) / max(end - start, 1e-9), 1)) for number, road, way, first, last, start, end in drive.passes])
    image, low, high = profile_picture(drive.profile)
    page.picture(png(image), tr("Heights along the drive, {length:.0f} m from left to right, {low:.1f} m (below) to {high:.1f} m "
                                "(above): red the trajectory, grey the road under it.").format(length=drive.profile[-1, 0], low=low, high=high))


def profile_picture(profile: np.ndarray, width: int = 900, height: int = 220) -> tuple[np.ndarray, float, float]:
    """Heights along the drive.

    Parameters
    ----------
    profile : (N, 3) distance driven, height of the trajectory and of the road under it (NaN where unknown), metres
    width, height : pixels

    Returns
    -------
    picture : (height, width, 3) uint8
    low, high : lowest and highest height, metres
    """
    known = profile[:, 1:][np.isfinite(profile[:, 1:])]
    low, high = float(known.min()), float(known.max())
    spread = max(high - low, 0.1)
    image = np.full((height, width, 3), 255, np.uint8)
    across = profile[:, 0] / max(profile[-1, 0], 1e-9) * (width - 1)

    def at(z):
        return height - 6 - (z - low) / spread * (height - 12)

    seen = np.isfinite(profile[:, 2])
    runs = np.split(np.arange(len(profile)), np.flatnonzero(np.diff(seen.astype(int))) + 1)
    for run in runs:
        if seen[run[0]]:
            line = np.rint(np.c_[across[run], at(profile[run, 2])]).astype(np.int32)
            cv2.polylines(image, [line], False, (120, 120, 120), 2, cv2.LINE_AA)
    cv2.polylines(image, [np.rint(np.c_[across, at(profile[:, 1])]).astype(np.int32)], False, (60, 60, 230), 2, cv2.LINE_AA)
    return image, low, high


def _intensity(page, found):
    page.heading(tr("Intensity"))
    values = np.flatnonzero(found.intensity)
    share = np.cumsum(found.intensity) / found.count
    low, middle, high = (int(np.searchsorted(share, q)) for q in (0.01, 0.5, 0.99))
    page.facts(((tr("Range"), tr("{low} to {high}").format(low=values[0], high=values[-1])), (tr("1 %, median, 99 %"), f"{low}, {middle}, {high}"),
                (tr("Different values"), len(values))))
    if len(values) > 1:
        page.picture(png(histogram_picture(found.intensity, low, high)),
                     tr("How often each intensity occurs, from {low} (left) to {high} (right).").format(low=low, high=high))


def histogram_picture(counts: np.ndarray, low: int, high: int, width: int = 900, height: int = 220) -> np.ndarray:
    """(height, width, 3) uint8 picture of the histogram of the values low to high, from the counts (M,) of the values from 0 on."""
    high = max(high, low + 1)
    edges = np.linspace(low, high + 1, min(width // 3, high - low + 1) + 1)
    place = np.clip(np.searchsorted(edges, np.arange(low, high + 1), side="right") - 1, 0, len(edges) - 2)
    bars = np.bincount(place, weights=counts[low:high + 1], minlength=len(edges) - 1) / np.diff(edges)
    image = np.full((height, width, 3), 255, np.uint8)
    tops = height - 4 - (height - 14) * bars / bars.max()
    left = np.linspace(0, width, len(bars) + 1)
    for start, end, top in zip(left[:-1], left[1:], tops):
        cv2.rectangle(image, (int(start), int(top)), (max(int(end) - 2, int(start)), height - 4), (150, 110, 60), -1)
    return image


def _crs_name(wkt):
    return horizontal_part(parse_crs(wkt)).name if wkt else tr("no CRS")


def _shares(counts, total):
    return ", ".join(f"{value}: {100 * count / total:.1f} %" for value, count in counts.items())
