"""A trajectory in another coordinate reference system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.crs import FOOT, check_metric, horizontal_part, in_metres, parse_crs, plane_wkt, same_crs
from .trajectory import Trajectory

HEADING_STEP = 10.0  # m ahead of a position, reprojected with it for the heading


def reproject_trajectory(trajectory: Trajectory, target_wkt: str) -> Trajectory:
    """The trajectory in another CRS: its positions, and its heading from the target's grid north.

    Heights stay as they are; whether they are ellipsoidal or orthometric is absorbed by
    the estimated height of the sensor.

    Parameters
    ----------
    trajectory : Trajectory
    target_wkt : WKT or "EPSG:n", projected; "" where unknown

    Returns
    -------
    Trajectory; unchanged where its CRS or the target is unknown

    Raises
    ------
    RoadExtractionError
        If the target is not projected, the source is of a kind that has no map coordinates, units contradict the CRS, or positions cannot be
        brought to the target.
    """
    from pyproj import Transformer
    from pyproj.exceptions import ProjError

    if not trajectory.crs:
        return taken_to_be_in(trajectory, target_wkt)
    target_wkt = in_metres(target_wkt)[0]
    source, target = parse_crs(trajectory.crs), parse_crs(target_wkt)
    if target is None:
        return trajectory
    if same_crs(source, target):
        return replace(trajectory, crs=target.to_wkt())
    check_metric(target, "The target of the trajectory")
    if not horizontal_part(source).is_geographic:
        check_metric(source, "The trajectory")
    target_wkt = plane_wkt(target_wkt)
    source, target = (horizontal_part(crs) for crs in (source, parse_crs(target_wkt)))
    try:
        transformer = Transformer.from_crs(source, target, always_xy=True)
        x, y = transformer.transform(trajectory.x, trajectory.y)
        known = np.isfinite(trajectory.x) & np.isfinite(trajectory.y)
        if not (np.isfinite(x[known]) & np.isfinite(y[known])).all():
            raise ProjError("some positions lie where the projection is not defined")
    except ProjError as problem:
        raise RoadExtractionError(
            f"The trajectory is in {source.name} and cannot be brought to {target.name} ({problem}). Check the CRS of the trajectory"
            f"{', and that its longitude and latitude are not exchanged' if source.is_geographic else ''}.") from problem
    x, y = np.where(known, x, np.nan), np.where(known, y, np.nan)
    heading = _reproject_heading(trajectory, source, transformer, x, y)
    note = f"The trajectory was reprojected from {source.name} to {target.name}."
    return replace(trajectory, x=x, y=y, heading=heading, crs=target_wkt, notes=(*trajectory.notes, note))


def taken_to_be_in(trajectory: Trajectory, wkt: str) -> Trajectory:
    """A trajectory without a CRS, its coordinates taken to be those of another file's CRS; it is unchanged where they are in metres.

    Raises
    ------
    RoadExtractionError
        If its columns say feet, and the CRS does not.
    """
    crs, (x, y, z), left = lengths_in_metres(wkt, (trajectory.x, trajectory.y, trajectory.z), trajectory.stated_units, "The trajectory")
    if "feet" in dict(left).values():
        raise RoadExtractionError("The trajectory gives positions in feet, and neither it nor the point cloud carries a CRS. Give the CRS in feet "
                                  "that they are in: Import trajectory takes that of the trajectory, the parameter CRS that of the cloud.")
    moved = x is not trajectory.x or z is not trajectory.z
    return replace(trajectory, x=x, y=y, z=z, crs=crs, stated_units=()) if moved else replace(trajectory, stated_units=())


def lengths_in_metres(crs: str, places: tuple[np.ndarray, np.ndarray, np.ndarray], stated: Sequence[tuple[str, str]],
                      label: str) -> tuple[str, tuple[np.ndarray, ...], Sequence[tuple[str, str]]]:
    """Coordinates of a trajectory in metres.

    Parameters
    ----------
    crs : WKT of their CRS, "" where unknown
    places : x, y and z, (N,) each, in its units, or where their columns state one, in that
    stated : (role, "feet" or "metres") of x, y and z
    label : the source, for messages

    Returns
    -------
    crs : WKT, metric
    places : in metres, or as they were where the CRS is unknown
    stated : what is still to be looked at once the CRS is known

    Raises
    ------
    RoadExtractionError
        If x or y are stated in feet, and the CRS is in another unit.
    """
    known = dict(stated)
    if not crs:
        return crs, places, stated
    wkt, units = in_metres(crs)
    factors = []
    for role, unit in (("x", units.across), ("y", units.across), ("z", units.up)):
        if known.get(role) == "feet" and unit == 1.0:
            if role != "z":
                raise RoadExtractionError(f"{label} gives positions in feet, and its CRS {horizontal_part(parse_crs(crs)).name} is not in feet. "
                                          "Give the CRS in feet that they are in: Import trajectory takes it.")
            unit = FOOT   # which one is not said; they differ by 2 mm in a kilometre of height
        factors.append(1.0 if known.get(role) == "metres" else unit)
    return wkt, tuple(values if factor == 1.0 else values * factor for values, factor in zip(places, factors)), ()


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
