"""Whether numbers can be the headings and coordinates of a drive."""

from __future__ import annotations

import numpy as np

from ...io.crs import horizontal_part, parse_crs
from .trajectory import MAX_VEHICLE_SPEED

METRES_PER_DEGREE = 111_000.0   # of latitude, rounded
HEADING_TOLERANCE = 10.0        # degrees between the heading and the course driven, median
MIN_COURSE_STEP = 1.0           # m of driving between two courses: the positions of a standing vehicle scatter in all directions
MAX_COURSE_ROWS = 5000          # courses of a drive


def rough_metres(x: np.ndarray, y: np.ndarray, crs: str) -> tuple[np.ndarray, np.ndarray]:
    """(N,) x and y in metres, of longitude and latitude as far as speeds and courses need it.

    Parameters
    ----------
    x, y : (N,) in the CRS
    crs : WKT or "EPSG:n"; "" where unknown, which is taken to be metric
    """
    if crs and horizontal_part(parse_crs(crs)).is_geographic:
        return x * np.cos(np.radians(np.nanmedian(y))) * METRES_PER_DEGREE, y * METRES_PER_DEGREE
    return x, y


def driven_course(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The course of a drive.

    Parameters
    ----------
    x, y : (N,) metres, in driving order

    Returns
    -------
    rows : (K,) indices of positions, at least MIN_COURSE_STEP of driving apart
    course : (K,) degrees clockwise from north at these
    """
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    spacing = max(MIN_COURSE_STEP, driven[-1] / MAX_COURSE_ROWS)
    cell = np.floor(driven / spacing)
    rows = np.flatnonzero(np.r_[True, np.diff(cell) > 0])
    if len(rows) < 3:
        return np.empty(0, int), np.empty(0)
    course = np.degrees(np.arctan2(x[rows[2:]] - x[rows[:-2]], y[rows[2:]] - y[rows[:-2]]))
    return rows[1:-1], course


def angle_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(N,) degrees between (N,) directions in degrees, 0 to 180."""
    return np.abs((np.asarray(a) - b + 180.0) % 360.0 - 180.0)


def heading_disagreement(x: np.ndarray, y: np.ndarray, heading: np.ndarray) -> float | None:
    """How far a column that may be the heading differs from the course driven.

    Parameters
    ----------
    x, y : (N,) metres
    heading : (N,) degrees or radians

    Returns
    -------
    Median difference in degrees; None beyond HEADING_TOLERANCE or where the column cannot be an angle
    """
    good = np.isfinite(x) & np.isfinite(y) & np.isfinite(heading)
    rows, course = driven_course(x[good], y[good])
    # The course of a straight drive equals many a constant column: values beyond an angle's range exclude it.
    if len(rows) < 3 or np.abs(heading[good]).max() > 361.0:
        return None
    found = min(float(np.median(angle_between(heading[good][rows] * factor, course))) for factor in (1.0, np.degrees(1.0)))
    return found if found < HEADING_TOLERANCE else None


def geographic_unit(lon: np.ndarray, lat: np.ndarray, time: np.ndarray | None = None) -> str:
    """The unit of two columns that may be the longitude and latitude of a drive.

    They are if their values are in range and change at the speed of a vehicle when taken as angles.

    Parameters
    ----------
    lon, lat : (N,) numbers
    time : (N,) seconds; None where unknown

    Returns
    -------
    "degrees" or "radians"; "" where they are not longitude and latitude
    """
    good = np.isfinite(lon) & np.isfinite(lat)
    lon, lat = lon[good], lat[good]
    if len(lon) < 2 or np.abs(lon).max() > 360 or np.abs(lat).max() > 90:
        return ""
    step = np.hypot(np.diff(lon) * np.cos(np.radians(np.median(lat))), np.diff(lat))
    if time is None:
        extent = max(np.ptp(lon), np.ptp(lat))
        if not 0 < extent < 0.5:
            return ""
        speed = None
    else:
        seconds = np.diff(np.asarray(time)[good])
        speed = np.percentile(step[seconds > 0] / seconds[seconds > 0], 95) if (seconds > 0).any() else 0.0
        if not 0 < speed < 2 * MAX_VEHICLE_SPEED / METRES_PER_DEGREE:
            return ""
        # a constant, or the noise of a standard deviation, varies but does not travel
        if np.hypot(*(np.diff(column).sum() for column in (lon, lat))) < 0.02 * step.sum():
            return ""
    if np.abs(lon).max() > np.pi or np.abs(lat).max() > np.pi / 2:
        return "degrees"
    in_radians = None if speed is None else speed * METRES_PER_DEGREE * np.degrees(1.0)
    return "radians" if in_radians is not None and in_radians < MAX_VEHICLE_SPEED else "degrees" if speed is not None else ""
