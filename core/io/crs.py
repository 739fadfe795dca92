"""The coordinate reference system of a survey: projected, in metres, and the same for all its files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.errors import RoadExtractionError

if TYPE_CHECKING:
    from pyproj import CRS

SUSPICIOUS_SENSOR_HEIGHT = 5.0, 15.0  # m: higher than any survey vehicle; 1.5 to 4.5 m expressed in feet
SAME_COORDINATES = 0.01                     # m between coordinates of one place in two CRS that are none other for a map


def parse_crs(text: str | None) -> CRS | None:
    """The CRS that a text defines.

    Parameters
    ----------
    text : WKT, "EPSG:n" or PROJ text

    Returns
    -------
    pyproj.CRS; None for an empty text

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


def horizontal_part(crs: Any) -> Any:
    """The projected or geographic part of a pyproj.CRS, which may be compound; None for None."""
    if crs is not None and crs.is_compound:
        return crs.sub_crs_list[0]
    return crs


def check_projected(files: Sequence[Any], given: str = "", trajectory_crs: str = "") -> str:
    """The CRS in which a survey is processed: that of its clouds, else the given one, else that of the trajectory.

    Parameters
    ----------
    files : CloudHeader of each point cloud
    given : WKT or "EPSG:n", for clouds without a CRS; "" where none was given
    trajectory_crs : WKT or "EPSG:n"; "" where unknown

    Returns
    -------
    WKT, "" where no CRS is known

    Raises
    ------
    RoadExtractionError
        If clouds disagree, the CRS is geographic or none but the coordinates look so, or its unit is not the metre.
    """
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
    check_metric(crs, "The point cloud")
    return wkt if wkt in known or len(wkt) > 20 else crs.to_wkt()


def _in_degrees(files):
    """Whether the clouds' coordinates can only be longitude and latitude: valid degrees, and a survey less than a degree wide."""
    low = np.min([file.minimum for file in files if file.count], axis=0)
    high = np.max([file.maximum for file in files if file.count], axis=0)
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
    One or two sentences; "" where there is nothing to note
    """
    if not crs:
        return ("The point cloud carries no CRS, and neither do the results: they lie in its own coordinates. Where these are "
                "map coordinates, give their CRS by the parameter CRS (such as EPSG:25832) and run again.")
    own = next((file.crs for file in files if file.crs), "")
    if given and own and not same_crs(parse_crs(given), parse_crs(own)):
        return (f"The point cloud says that it is in {horizontal_part(parse_crs(own)).name}; the parameter CRS "
                f"({horizontal_part(parse_crs(given)).name}) is for clouds that carry none and was not used.")
    return ""


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
            "unit: everything is measured in metres, so curbs and markings would be missed. If they are in feet, convert both to metres "
            "(in a metric CRS); if they are not, set CRS.")


def check_metric(crs: Any, what: str) -> None:
    """Refuse a CRS that is geographic or not in metres.

    Parameters
    ----------
    crs : pyproj.CRS
    what : the subject of the message, such as "The point cloud"

    Raises
    ------
    RoadExtractionError
        If the CRS is geographic, or a unit of it is not the metre.
    """
    flat = horizontal_part(crs)
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


def same_crs(a: Any, b: Any) -> bool:
    """Whether two pyproj.CRS give every place the same x and y, however their WKT was written; heights are not compared."""
    a, b = horizontal_part(a), horizontal_part(b)
    if a.equals(b, ignore_axis_order=True):
        return True
    # The WKT of LAS files has rounded parameters and other names: the projections themselves are compared.
    first, second = (_projection(crs) for crs in (a, b))
    return bool(first) and first == second


def check_same_crs(own: str, other: str, place: tuple[float, float], label: str) -> None:
    """Refuse a layer in another CRS than the point clouds; one whose CRS is not known is taken to be in theirs.

    Two that give the place of the layer the same coordinates, such as UTM zone 32 of ETRS89 and of WGS 84, are no others.

    Parameters
    ----------
    own, other : WKT or "EPSG:n" of the layer and of the point clouds, "" where unknown
    place : (x, y) in the layer
    label : name of the layer, as at the beginning of a sentence

    Raises
    ------
    RoadExtractionError
        If they differ.
    """
    from pyproj import Transformer

    layer, clouds = parse_crs(own), parse_crs(other)
    if layer is None or clouds is None or same_crs(layer, clouds):
        return
    layer, clouds = horizontal_part(layer), horizontal_part(clouds)
    moved = Transformer.from_crs(layer, clouds, always_xy=True).transform(*place)
    if not np.hypot(moved[0] - place[0], moved[1] - place[1]) < SAME_COORDINATES:
        raise RoadExtractionError(f"{label} is in {layer.name}, the point clouds are in {clouds.name}. "
                                  "Reproject the layer to their CRS and run again.")


def _projection(crs):
    """The projection and its parameters by name, without what is only said about them; empty where PROJ has no words for it."""
    words = crs.to_dict()
    return {key: value for key, value in words.items() if key not in ("title", "type", "no_defs")}
