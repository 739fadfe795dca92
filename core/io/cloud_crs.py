"""The CRS of a survey: projected, true to scale, and the same for all its files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..common.errors import RoadExtractionError
from .crs import check_metric, horizontal_part, parse_crs, same_crs
from .crs_place import check_extent
from .units import as_in_file, in_metres, unit_names

SUSPICIOUS_SENSOR_HEIGHT = 5.0, 15.0  # m: higher than any survey vehicle; 1.5 to 4.5 m expressed in feet


def check_projected(files: Sequence[Any], given: str = "", trajectory_crs: str = "") -> str:
    """The CRS in which a survey is processed: that of its clouds, else the given one, else that of the trajectory.

    Parameters
    ----------
    files : CloudHeader of each point cloud
    given : WKT or "EPSG:n", for clouds without a CRS; "" where none was given
    trajectory_crs : WKT or "EPSG:n"; "" where unknown

    Returns
    -------
    WKT, metric; "" where no CRS is known

    Raises
    ------
    RoadExtractionError
        If clouds contradict themselves or each other, the CRS is geographic or none but the coordinates look so, the CRS is of another kind
        that has no metres, lengths in it are not those on the ground, or x and y are exchanged.
    """
    contradictory = next((file for file in files if file.crs_problem), None)
    if contradictory is not None and not given:
        raise RoadExtractionError(f"What {contradictory.path} says about its coordinates cannot be used: {contradictory.crs_problem}. Give the CRS "
                                  "that they are in by the parameter CRS, or export the file again.")
    known: dict[str, str] = {}
    for file in files:
        if file.crs:
            known.setdefault(file.crs, file.path)
    parsed = [(parse_crs(wkt), path) for wkt, path in known.items()]
    if not known and not given and trajectory_crs and horizontal_part(parse_crs(trajectory_crs)).is_geographic and not _in_degrees(files):
        raise RoadExtractionError(
            f"The point cloud carries no CRS, and the trajectory is in {horizontal_part(parse_crs(trajectory_crs)).name} (degrees), so "
            "the position of one relative to the other is unknown. Give the CRS of the point cloud by the parameter CRS.")
    for crs, path in parsed[1:]:
        if not horizontal_part(crs).equals(horizontal_part(parsed[0][0]), ignore_axis_order=True):
            raise RoadExtractionError(
                f"The point clouds use different CRSs: {parsed[0][1]} is in {horizontal_part(parsed[0][0]).name}, "
                f"{path} in {horizontal_part(crs).name}. Reproject them to one CRS first.")
    wkt = next(iter(known), "") or given or trajectory_crs
    crs = parse_crs(wkt)
    if crs is None:
        if _in_degrees(files):
            raise RoadExtractionError(
                "The point cloud carries no CRS, and its coordinates look like longitude and latitude in degrees: it is less than 1 m wide if they "
                "are metres. Reproject it to a projected CRS, such as the UTM zone of the survey, and run again.")
        return ""
    wkt = in_metres(wkt if wkt in known or len(wkt) > 20 else crs.to_wkt())[0]
    check_metric(parse_crs(wkt), "The point cloud")
    check_extent(wkt, _bounds(files), "The point cloud")
    return wkt


def _bounds(files):
    """(3,) least and (3,) greatest coordinates of the clouds."""
    held = [file for file in files if file.count]
    return np.min([file.minimum for file in held], axis=0), np.max([file.maximum for file in held], axis=0)


def _in_degrees(files):
    """Whether the clouds' coordinates can only be longitude and latitude: valid degrees, and a survey less than a degree wide."""
    low, high = _bounds(files)
    return bool((np.abs([low[0], high[0]]) <= 180).all() and (np.abs([low[1], high[1]]) <= 90).all() and (high - low)[:2].max() < 1.0)


def crs_note(files: Sequence[Any], given: str, crs: str) -> str:
    """A note for the user about the CRS in which a survey is processed.

    Parameters
    ----------
    files : CloudHeader of each point cloud
    given : the CRS that the user gave, "" for none
    crs : WKT of the CRS of the survey, "" where unknown

    Returns
    -------
    Sentences; "" where there is nothing to note
    """
    if not crs:
        return ("The point cloud carries no CRS, and neither do the results: they lie in its own coordinates. Where these are "
                "map coordinates, give their CRS by the parameter CRS (such as EPSG:25832) and run again.")
    notes = [check_extent(crs, _bounds(files), "The point cloud")]
    own = next((file.crs for file in files if file.crs), "")
    if given and own and not same_crs(parse_crs(given), parse_crs(own)):
        notes.append(f"The point cloud says that it is in {horizontal_part(parse_crs(own)).name}; the parameter CRS "
                     f"({horizontal_part(parse_crs(given)).name}) is for clouds that carry none and was not used.")
    notes += [f"What {file.path} says about its coordinates was not used, but the parameter CRS: {file.crs_problem}."
              for file in files if file.crs_problem][:1]
    if (units := as_in_file(crs)[1]).across != units.up:
        across, *_, up = unit_names(as_in_file(crs)[0])
        notes.append(f"The point cloud says that the unit of its heights is the {up}, and that of its x and y the {across}: what is not in "
                     "metres was converted.")
    return " ".join(note for note in notes if note)


def unit_note(height: float, crs: str) -> str:
    """A note for the user where a cloud without CRS is in feet, as it seems; "" where there is nothing to note.

    Parameters
    ----------
    height : m, of the sensor above the road; NaN where unknown
    crs : WKT of the CRS of the survey, "" where unknown
    """
    if crs or not SUSPICIOUS_SENSOR_HEIGHT[0] < height < SUSPICIOUS_SENSOR_HEIGHT[1]:
        return ""
    return (f"The sensor seems to ride {height:.1f} m above the road, as if cloud and trajectory were in feet, and no CRS tells their "
            "unit: everything is measured in metres, so curbs and markings would be missed. Set the parameter CRS to the CRS that they are "
            "in, such as a zone of State Plane in feet.")
