"""The coordinate reference system of a survey: projected, in metres, and the same for all its files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.errors import RoadExtractionError

if TYPE_CHECKING:
    from pyproj import CRS

# what a GeoPackage calls the CRS of a layer that carries none; without it GDAL writes an undefined geographic one
UNDEFINED_CARTESIAN = 'LOCAL_CS["Undefined Cartesian SRS",UNIT["metre",1]]'
SAME_DATUM = 2.0                            # m between a place in two realisations of one datum, such as NAD 83 and WGS 84
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


def crs_name(wkt: str) -> str:
    """What the horizontal part of a CRS is called; "" where it is not known."""
    crs = horizontal_part(parse_crs(wkt))
    return "" if crs is None else str(crs.name)


def horizontal_part(crs: Any) -> Any:
    """The projected or geographic part of a pyproj.CRS, which may be compound; None for None."""
    if crs is not None and crs.is_compound:
        return crs.sub_crs_list[0]
    return crs


def check_metric(crs: Any, what: str) -> None:
    """Refuse a CRS that is geographic, geocentric or of heights alone, or not in metres.

    Parameters
    ----------
    crs : pyproj.CRS
    what : the subject of the message, such as "The point cloud"

    Raises
    ------
    RoadExtractionError
        If the CRS is of such a kind, or a unit of it is not the metre.
    """
    flat = horizontal_part(crs)
    if flat.is_geocentric or flat.is_vertical:
        coordinates = "geocentric coordinates, counted from the centre of the earth" if flat.is_geocentric else "heights alone"
        raise RoadExtractionError(f"{what} is in {flat.name}, a CRS of {coordinates}. Road geometry needs x and y on a map: reproject it to a "
                                  "projected CRS, such as the UTM zone of the survey, and run again.")
    if flat.is_geographic:
        raise RoadExtractionError(
            f"{what} is in the geographic CRS {flat.name} (degrees). Road geometry needs metres: reproject it to a "
            "projected CRS, such as the UTM zone of the survey, and run again.")
    units = _not_metres(axis for axis in flat.axis_info if axis.direction.lower() not in ("up", "down"))
    if units:
        raise RoadExtractionError(
            f"{what} is in {flat.name}, whose unit is {', '.join(units)}. Lanewright works in metres: "
            "reproject it to a metric CRS and run again.")
    vertical = _not_metres(crs.sub_crs_list[-1].axis_info) if crs.is_compound else []
    if vertical:
        raise RoadExtractionError(f"{what} has heights in {', '.join(vertical)} ({crs.sub_crs_list[-1].name}). Lanewright works in metres: convert "
                                  "the heights and run again.")


def _not_metres(axes):
    """The names of the units of axes that are no metres."""
    return sorted({axis.unit_name for axis in axes if axis.unit_conversion_factor != 1.0})


def same_crs(a: Any, b: Any) -> bool:
    """Whether two pyproj.CRS give every place the same x and y, however their WKT was written; heights are not compared."""
    a, b = horizontal_part(a), horizontal_part(b)
    if a.equals(b, ignore_axis_order=True):
        return True
    # The WKT of LAS files has rounded parameters and other names: the projections themselves are compared.
    first, second = (_projection(crs) for crs in (a, b))
    return bool(first) and first == second


def moved_by(a: Any, b: Any, place: tuple[float, float]) -> float:
    """How far apart (units of `b`) the coordinates (x, y) of `a` lie from those of the same place in `b`; infinite where it has none there."""
    from pyproj import Transformer

    if same_crs(a, b):
        return 0.0
    x, y = Transformer.from_crs(a, b, always_xy=True).transform(*place)
    return float(np.hypot(x - place[0], y - place[1]))


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
    layer, clouds = horizontal_part(parse_crs(own)), horizontal_part(parse_crs(other))
    if layer is not None and clouds is not None and not moved_by(layer, clouds, place) < SAME_COORDINATES:
        raise RoadExtractionError(f"{label} is in {layer.name}, the point clouds are in {clouds.name}. "
                                  "Reproject the layer to their CRS and run again.")


def _projection(crs):
    """The projection and its parameters by name, without what is only said about them; empty where PROJ has no words for it."""
    words = crs.to_dict()
    return {key: value for key, value in words.items() if key not in ("title", "type", "no_defs")}
