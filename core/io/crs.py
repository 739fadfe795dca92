"""The coordinate reference system a survey is worked in: projected, in metres, and agreed on."""

from dataclasses import replace

import numpy as np

from ..common.errors import RoadExtractionError


def parse_crs(text):
    """A pyproj CRS of WKT, "EPSG:n" or PROJ text; None for an empty text.

    Raises
    ------
    RoadExtractionError
        If the text is not understood.
    """
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    if not text:
        return None
    try:
        return CRS.from_user_input(text)
    except CRSError as problem:
        raise RoadExtractionError(f"The CRS {text[:60]!r} is not understood ({problem}). Give it as EPSG:number.") from problem


def horizontal(crs):
    """The projected or geographic part of a CRS, a compound one included."""
    if crs is not None and crs.is_compound:
        return crs.sub_crs_list[0]
    return crs


def check_projected(files, given="", trajectory_crs=""):
    """WKT of the CRS that the survey is worked in ("" where none is known).

    The clouds' own CRS counts first, then `given`, then the trajectory's.

    Raises
    ------
    RoadExtractionError
        If clouds disagree, the CRS is geographic, or its unit is not the metre.
    """
    known = {}
    for file in files:
        if file.crs:
            known.setdefault(file.crs, file.path)
    parsed = [(parse_crs(wkt), path) for wkt, path in known.items()]
    if not known and not given and trajectory_crs and horizontal(parse_crs(trajectory_crs)).is_geographic and not _in_degrees(files):
        raise RoadExtractionError(
            f"The point cloud carries no CRS, and the trajectory is in {horizontal(parse_crs(trajectory_crs)).name} (degrees), so "
            "neither tells where the other lies. Give the CRS of the point cloud by the parameter CRS.")
    for crs, path in parsed[1:]:
        if not horizontal(crs).equals(horizontal(parsed[0][0]), ignore_axis_order=True):
            raise RoadExtractionError(
                f"The point clouds use different CRSs: {parsed[0][1]} is in {horizontal(parsed[0][0]).name}, "
                f"{path} in {horizontal(crs).name}. Reproject them to one CRS first.")
    wkt = next(iter(known), "") or given or trajectory_crs
    crs = parse_crs(wkt)
    if crs is None:
        return ""
    check_metric(crs, "The point cloud")
    return wkt if wkt in known or len(wkt) > 20 else crs.to_wkt()


def _in_degrees(files):
    """Whether the clouds' coordinates can only be longitude and latitude: within the globe's, and a survey less than a degree wide."""
    low, high = np.min([file.minimum for file in files if file.count], axis=0), np.max([file.maximum for file in files if file.count], axis=0)
    return bool((np.abs([low[0], high[0]]) <= 180).all() and (np.abs([low[1], high[1]]) <= 90).all() and (high - low)[:2].max() < 1.0)


def crs_note(files, given, crs):
    """What the user should know about the CRS the survey is worked in; "" where there is nothing to say."""
    if not crs:
        return ("The point cloud carries no CRS, and neither do the results: they lie in its own coordinates. Where these are "
                "map coordinates, give their CRS by the parameter CRS (such as EPSG:25832) and run again.")
    own = next((file.crs for file in files if file.crs), "")
    if given and own and not same_place(parse_crs(given), parse_crs(own)):
        return (f"The point cloud says that it is in {horizontal(parse_crs(own)).name}; the parameter CRS "
                f"({horizontal(parse_crs(given)).name}) is for clouds that carry none and was not used.")
    return ""


def check_metric(crs, what):
    """Refuse, by name, a CRS that is geographic or not in metres."""
    flat = horizontal(crs)
    if flat.is_geographic:
        raise RoadExtractionError(
            f"{what} is in the geographic CRS {flat.name} (degrees). Road geometry needs metres: reproject it to a "
            "projected CRS, such as the UTM zone of the survey, and run again.")
    units = {axis.unit_name for axis in flat.axis_info if axis.direction.lower() not in ("up", "down")}
    if units - {"metre", "meter", "m"}:
        raise RoadExtractionError(
            f"{what} is in {flat.name}, whose unit is {', '.join(sorted(units))}. Lanewright works in metres: "
            "reproject it to a metric CRS and run again.")
    if crs.is_compound:
        vertical = {axis.unit_name for axis in crs.sub_crs_list[-1].axis_info}
        if vertical - {"metre", "meter", "m"}:
            raise RoadExtractionError(
                f"{what} has heights in {', '.join(sorted(vertical))} ({crs.sub_crs_list[-1].name}). Lanewright works "
                "in metres: convert the heights and run again.")


def same_place(a, b):
    """Whether two CRSs give a place the same x and y, however their WKT was written."""
    a, b = horizontal(a), horizontal(b)
    if a.equals(b, ignore_axis_order=True):
        return True
    # LAS files round and rename; the projection itself is what counts
    a, b = a.to_dict(), b.to_dict()
    ignored = ("title", "type", "no_defs")
    return bool(a) and {k: v for k, v in a.items() if k not in ignored} == {k: v for k, v in b.items() if k not in ignored}


def reproject_trajectory(trajectory, target_wkt):
    """The trajectory in another CRS: positions, and the heading turned to the target's grid north.

    Heights stay as they are; whether they are ellipsoidal or not is absorbed by
    the estimated height of the sensor. A trajectory or target without CRS, or
    both in one CRS, comes back unchanged.

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
    if same_place(source, target):
        return replace(trajectory, crs=target.to_wkt())
    check_metric(target, "The target of the trajectory")
    source, target = horizontal(source), horizontal(target)
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
    heading = _turned_heading(trajectory, source, transformer, x, y)
    note = f"The trajectory was reprojected from {source.name} to {target.name}."
    return replace(trajectory, x=x, y=y, heading=heading, crs=target.to_wkt(), notes=(*trajectory.notes, note))


def _turned_heading(trajectory, source, transformer, x, y):
    """Headings against the target's grid north: a step of some metres ahead is reprojected too."""
    known = np.isfinite(trajectory.heading) & np.isfinite(x)
    heading = np.full(len(x), np.nan)
    if not known.any():
        return heading
    ahead = np.radians(trajectory.heading[known])
    step_x, step_y = 10.0 * np.sin(ahead), 10.0 * np.cos(ahead)
    if source.is_geographic:
        latitude = np.radians(trajectory.y[known])
        per_degree_y, per_degree_x = _metres_per_degree(source.ellipsoid, latitude)
        step_x, step_y = step_x / per_degree_x, step_y / per_degree_y
    to_x, to_y = transformer.transform(trajectory.x[known] + step_x, trajectory.y[known] + step_y)
    heading[known] = np.degrees(np.arctan2(to_x - x[known], to_y - y[known])) % 360.0
    return heading


def _metres_per_degree(ellipsoid, latitude):
    """Metres along the meridian and along the parallel per degree, at latitudes in radians."""
    major = ellipsoid.semi_major_metre
    e2 = 1.0 - (ellipsoid.semi_minor_metre / major)**2
    w = np.sqrt(1.0 - e2 * np.sin(latitude)**2)
    return np.radians(1.0) * major * (1.0 - e2) / w**3, np.radians(1.0) * major * np.cos(latitude) / w
