"""The report on a survey's files."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np

from ..io.crs import horizontal_part, parse_crs
from .map_figure import png
from .page import Page

if TYPE_CHECKING:
    from ..survey.inspection import Inspection

DENSITY_PICTURE_SIDE = 1400  # px
NO_DATA_COLOUR = (28, 28, 30)  # blue, green, red


def inspection_report(found: Inspection) -> str:
    """The report of an Inspection as HTML."""
    page = Page("Survey", "What the point clouds and the trajectory hold, before any work is done on them.")
    for note in found.notes:
        page.warning(note)
    _points(page, found)
    _density(page, found)
    _time(page, found)
    _drive(page, found.drive)
    _intensity(page, found)
    page.heading("Files")
    page.table(
        ("File", "LAS", "Point format", "Points", "x", "y", "z", "CRS"),
        [(file.path, file.version, file.point_format, file.count, *(f"{a:.1f} – {b:.1f}" for a, b in zip(file.minimum, file.maximum)),
          _crs_name(file.crs)) for file in found.files])
    return page.html()


def _points(page, found):
    size = found.maximum - found.minimum
    page.heading("Points")
    page.facts((
        ("Points", found.count), ("Files", len(found.files)), ("CRS", _crs_name(found.crs)),
        ("Extent", f"{size[0]:.1f} × {size[1]:.1f} m, {size[2]:.1f} m high"),
        ("x", f"{found.minimum[0]:.2f} to {found.maximum[0]:.2f}"), ("y", f"{found.minimum[1]:.2f} to {found.maximum[1]:.2f}"),
        ("z", f"{found.minimum[2]:.2f} to {found.maximum[2]:.2f}"),
        ("Returns", _shares(found.returns, found.count)), ("Classes", _shares(found.classes, found.count))))


def _density(page, found):
    page.heading("Density")
    page.table(
        ("", "Points per m²", "Points per m³"),
        [(title, float(found.per_area[key]), float(found.per_volume[key])) for title, key in (
            ("Mean of occupied cells", "mean"), ("Median of occupied cells", "median"),
            ("As a point sees it (mean over points)", "of_a_point"), ("Densest cell", "largest"))])
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
    caption = f"Points per m², from 0 (dark) to {top:.0f} (yellow); north is up."
    trajectory: Any = found.trajectory
    if trajectory is not None and found.near_share:
        track = np.c_[trajectory.x - corner[0], corner[1] - trajectory.y] / found.settings.cell_size * scale
        cv2.polylines(image, [np.rint(track).astype(np.int32)], False, (60, 60, 255), 2, cv2.LINE_AA)
        caption += " Red is the trajectory."
    return image, caption


def _time(page, found):
    page.heading("Time and scanners")
    rows = []
    if found.time_span:
        first, last = found.time_span
        rows.append(("gps_time", f"{first:.3f} to {last:.3f} s, {last - first:.1f} s"))
        if found.files[0].adjusted_time:
            start = datetime(1980, 1, 6) + timedelta(seconds=first + 1e9)
            rows.append(("Counted as", f"adjusted standard GPS time; begins {start:%Y-%m-%d %H:%M:%S} in GPS time"))
        else:
            rows.append(("Counted as", "seconds of the GPS week, says the file"))
    else:
        rows.append(("gps_time", "none that can be used"))
    rows.append(("Scanners", f"{len(found.scanners)}, distinguished by {found.scanner_field}" if found.scanner_field else "1"))
    if found.near_share is not None:
        rows.append(("Points within 25 m of the trajectory", f"{100 * found.near_share:.1f} %"))
    if found.in_time_share is not None:
        rows.append(("Scan time covered by the trajectory", f"{100 * found.in_time_share:.1f} %"))
    if found.trajectory is not None:
        driven = float(np.hypot(np.diff(found.trajectory.x), np.diff(found.trajectory.y)).sum())
        rows.append(("Trajectory", f"{len(found.trajectory)} positions over {driven:.1f} m"))
    page.facts(rows)


def _drive(page, drive):
    if drive is None:
        return
    page.heading("Drive")
    height = "unknown: too few points lie under the vehicle" if drive.sensor_height is None else f"{drive.sensor_height:.2f} m above the road"
    page.facts((("Driven", f"{drive.driven:.1f} m"), ("Trajectory", height),
                ("Roads", ", ".join(f"road {number}: {length:.1f} m" for number, length in enumerate(drive.roads)))))
    page.table(
        ("Pass", "Road", "Way", "From station (m)", "To station (m)", "Seconds", "Mean speed (km/h)"),
        [(number, road, "along" if way > 0 else "against", round(first, 1) + 0.0, round(last, 1) + 0.0, round(end - start, 1),
          round(3.6 * abs(last - first) / max(end - start, 1e-9), 1)) for number, road, way, first, last, start, end in drive.passes])
    image, low, high = profile_picture(drive.profile)
    page.picture(png(image), f"Heights along the drive, {drive.profile[-1, 0]:.0f} m from left to right, {low:.1f} m (below) to {high:.1f} m "
                             "(above): red the trajectory, grey the road under it.")


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
    page.heading("Intensity")
    values = np.flatnonzero(found.intensity)
    share = np.cumsum(found.intensity) / found.count
    low, middle, high = (int(np.searchsorted(share, q)) for q in (0.01, 0.5, 0.99))
    page.facts((("Range", f"{values[0]} to {values[-1]}"), ("1 %, median, 99 %", f"{low}, {middle}, {high}"),
                ("Different values", len(values))))
    if len(values) > 1:
        page.picture(png(histogram_picture(found.intensity, low, high)),
                     f"How often each intensity occurs, from {low} (left) to {high} (right).")


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
    return horizontal_part(parse_crs(wkt)).name if wkt else "none"


def _shares(counts, total):
    return ", ".join(f"{value}: {100 * count / total:.1f} %" for value, count in counts.items())
