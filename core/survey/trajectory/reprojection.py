"""A trajectory in another coordinate reference system."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.crs import check_metric, horizontal_part, parse_crs, same_crs
from .trajectory import Trajectory

HEADING_STEP = 10.0  # m ahead of a position, reprojected with it for the heading


def reproject_trajectory(trajectory: Trajectory, target_wkt: str) -> Trajectory:
    """The trajectory in another CRS: its positions, and its heading from the target's grid north.

    Heights stay as they are; whether they are ellipsoidal or orthometric is absorbed by
    the estimated height of the sensor.

    Parameters
    ----------
    trajectory : Trajectory
    target_wkt : WKT or "EPSG:n", projected, in metres; "" where unknown

    Returns
    -------
    Trajectory; unchanged where its CRS or the target is unknown

    Raises
    ------
    RoadExtractionError
        If the target is not projected in metres, the source is in another unit
        than metres or degrees, or positions cannot be brought to the target.
    """
    from pyproj import Transformer
    from pyproj.exceptions import ProjError

    source, target = parse_crs(trajectory.crs), parse_crs(target_wkt)
    if source is None or target is None:
        return trajectory
    if same_crs(source, target):
        return replace(trajectory, crs=target.to_wkt())
    check_metric(target, "The target of the trajectory")
    source, target = horizontal_part(source), horizontal_part(target)
    if not source.is_geographic:
        check_metric(source, "The trajectory")
    try:
        transformer = Transformer.from_crs(source, target, always_xy=True)
        x, y = transformer.transform(trajectory.x, trajectory.y)
        known = np.isfinite(trajectory.x) & np.isfinite(trajectory.y)
        if not (np.isfinite(x[known]) & np.isfinite(y[known])).all():
            raise ProjError("some positions lie where the projection is not defined")
    except ProjError as problem:
        raise RoadExtractionError(
            f"The trajectory is in {source.name} and cannot be brought to {target.name} ({problem}). Check the CRS of the trajectory.") from problem
    x, y = np.where(known, x, np.nan), np.where(known, y, np.nan)
    heading = _reproject_heading(trajectory, source, transformer, x, y)
    note = f"The trajectory was reprojected from {source.name} to {target.name}."
    return replace(trajectory, x=x, y=y, heading=heading, crs=target.to_wkt(), notes=(*trajectory.notes, note))


def _reproject_heading(trajectory, source, transformer, x, y):
    """Headings from the target's grid north: of each position, a point HEADING_STEP ahead is reprojected too."""
    known = np.isfinite(trajectory.heading) & np.isfinite(x)
    heading = np.full(len(x), np.nan)
    if not known.any():
        return heading
    ahead = np.radians(trajectory.heading[known])
    step_x, step_y = HEADING_STEP * np.sin(ahead), HEADING_STEP * np.cos(ahead)
    if source.is_geographic:
        latitude = np.radians(trajectory.y[known])
        per_degree_y, per_degree_x = _metres_per_degree(source.ellipsoid, latitude)
        step_x, step_y = step_x / per_degree_x, step_y / per_degree_y
    to_x, to_y = transformer.transform(trajectory.x[known] + step_x, trajectory.y[known] + step_y)
    heading[known] = np.degrees(np.arctan2(to_x - x[known], to_y - y[known])) % 360.0
    return heading


def _metres_per_degree(ellipsoid, latitude):
    """Metres per degree along the meridian and along the parallel, at (N,) latitudes in radians (radii of curvature of the ellipsoid)."""
    major = ellipsoid.semi_major_metre
    e2 = 1.0 - (ellipsoid.semi_minor_metre / major)**2
    w = np.sqrt(1.0 - e2 * np.sin(latitude)**2)
    return np.radians(1.0) * major * (1.0 - e2) / w**3, np.radians(1.0) * major * np.cos(latitude) / w
