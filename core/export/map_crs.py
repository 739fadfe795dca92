"""The CRS of a map from elsewhere."""

from __future__ import annotations

import numpy as np

from ..common.errors import RoadExtractionError
from ..io.crs import check_metric, horizontal_part, parse_crs, plane_wkt, same_crs

LOCAL_CRS = "+proj=tmerc +lat_0=0 +lon_0=0 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs"   # of maps that lie nowhere


def crs_of_reference(text: str, given: str) -> tuple[str, str]:
    """The CRS of an OpenDRIVE file.

    Parameters
    ----------
    text : of its geoReference: PROJ, WKT or EPSG:n; "" where it has none
    given : WKT or EPSG:n that the user gave, "" for none

    Returns
    -------
    crs : WKT, "" where unknown
    note : a sentence for the user, "" where there is nothing to note

    Raises
    ------
    RoadExtractionError
        If what the user gave is not a CRS in metres.
    """
    if given:
        return metric_wkt(given, "The chosen CRS"), ""
    if not text:
        return "", ("The file has no geoReference: its coordinates were taken as they are and the layers have no CRS. "
                    "Where you know it, give it by the parameter CRS.")
    try:
        return metric_wkt(text, "The map"), ""
    except RoadExtractionError as problem:
        return "", (f"The geoReference of the file cannot be used ({problem}) The layers have no CRS; where you know it, give it by the "
                    "parameter CRS.")


def reference_of_crs(wkt: str) -> str:
    """The text of geoReference for a CRS: PROJ where that says the same, else WKT; "" where unknown."""
    import warnings

    crs = horizontal_part(parse_crs(wkt))
    if crs is None:
        return ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")   # pyproj warns that PROJ texts may lose something: what they lose is looked at here
        text = crs.to_proj4()
        same = bool(text) and same_crs(parse_crs(text), crs)
    return text if same else str(crs.to_wkt())


def metric_wkt(text: str, what: str) -> str:
    """WKT of the horizontal part of a CRS given as a text; refuses one that is not in metres. `what`: subject of the message."""
    crs = parse_crs(text)
    check_metric(crs, what)
    return plane_wkt(text)


def utm_of(longitude: float, latitude: float) -> str:
    """WKT of the UTM zone (WGS 84) of a place in degrees."""
    zone = int(np.clip((longitude + 180) // 6 + 1, 1, 60))
    return metric_wkt(f"EPSG:{(32600 if latitude >= 0 else 32700) + zone}", "The map")
