"""Whether a survey lies where its CRS holds, and lengths on the map there are lengths on the ground."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from ..common.errors import RoadExtractionError
from .crs import horizontal_part, parse_crs
from .units import as_in_file

# Official grids for measuring keep within it where they are used: UTM zone 33, used in all of Norway, and Lambert-93 come to 4 per mille
MAX_SCALE_ERROR = 0.005
SCALE_STEP = 50.0                     # m on the map over which the scale is measured
MAX_OUTSIDE_AREA = 8.0                # degrees: official surveys lie outside the area of their CRS too, of UTM zone 33 in Norway by 7.5
MIN_EXCHANGED = 1.0             # degrees outside, from which on x and y may be exchanged; a survey beyond a border lies nearer
MAX_LOCAL = 1e5                 # m: local coordinates, and those without their leading digits, are smaller


@dataclass(frozen=True)
class MapPlace:
    """A place of the map on the ground.

    longitude, latitude : degrees from Greenwich, of the CRS's own datum
    scale : length on the map per length on the ground, in the direction where it is farthest from 1; NaN where the projection is not defined
    """

    longitude: float
    latitude: float
    scale: float

    @property
    def true_to_scale(self) -> bool:
        """Whether lengths on the map are lengths on the ground, as far as roads are concerned."""
        return abs(self.scale - 1.0) <= MAX_SCALE_ERROR


def place_on_ground(crs: Any, x: float, y: float) -> MapPlace:
    """Where a place of the map lies, and the scale there.

    The metric of the ground is measured along x, y and their diagonal with geodesics; its eigenvalues are the squared lengths of the axes of
    Tissot's indicatrix [1]_. Heights, which shorten lengths on the map by 0.16 per mille a kilometre, are not counted.

    Parameters
    ----------
    crs : pyproj.CRS, projected in metres
    x, y : m

    References
    ----------
    .. [1] Snyder (1987), Map Projections: A Working Manual, USGS Professional Paper 1395, p. 20-26.
    """
    from pyproj import Transformer

    datum = crs.geodetic_crs
    to_radians = datum.axis_info[0].unit_conversion_factor
    steps = SCALE_STEP * np.array([(0, 0), (1, 0), (0, 1), (1, 1)])
    u, v = (np.asarray(found) * to_radians for found in Transformer.from_crs(crs, datum, always_xy=True).transform(*(steps + (x, y)).T))
    if not np.isfinite([u, v]).all():
        return MapPlace(np.nan, np.nan, np.nan)
    along_x, along_y, diagonal = np.array(crs.get_geod().inv(*([end[0]] * 3 for end in (u, v)), u[1:], v[1:], radians=True)[2]) / SCALE_STEP
    mixed = (diagonal**2 - along_x**2 - along_y**2) / 2
    ground = np.sqrt(np.linalg.eigvalsh([[along_x**2, mixed], [mixed, along_y**2]]).clip(1e-12))
    scale = max(1 / ground, key=lambda one: abs(np.log(one)))
    meridian = datum.prime_meridian
    longitude = np.degrees(u[0]) + meridian.longitude * np.degrees(meridian.unit_conversion_factor)
    return MapPlace(float((longitude + 180) % 360 - 180), float(np.degrees(v[0])), float(scale))


@lru_cache(maxsize=16)
def check_place(wkt: str, place: tuple[float, float], what: str) -> str:
    """Refuse a CRS in which lengths at the survey are not those on the ground, and coordinates that are exchanged.

    Parameters
    ----------
    wkt : metric CRS
    place : (x, y) of the survey, metres
    what : the subject of the message, such as "The point cloud"

    Returns
    -------
    A sentence on a survey that lies far outside the area of its CRS; "" where there is nothing to note

    Raises
    ------
    RoadExtractionError
        If lengths differ by more than 5 per mille, or the survey lies in the area only with x and y exchanged.
    """
    crs = horizontal_part(parse_crs(wkt))
    if not crs.is_projected:
        return ""
    x, y = place
    there = place_on_ground(crs, x, y)
    area = _area_of_use(wkt, there.true_to_scale)
    beside = _beside(there, area)
    if beside > MIN_EXCHANGED:
        turned = place_on_ground(crs, y, x)
        if turned.true_to_scale and _beside(turned, area) == 0:
            raise RoadExtractionError(
                f"{what} has x and y exchanged: x is about {x:.0f} and y about {y:.0f}, and in its CRS {crs.name} only the place with y as the "
                f"easting lies in the area of this CRS ({_named(area)}). Export it with the easting as x and the northing as y, and run again.")
    outside = beside > MIN_EXCHANGED and area
    if beside > MAX_OUTSIDE_AREA and max(abs(x), abs(y)) < MAX_LOCAL:
        return (f"{what} says that it is in {crs.name}, but its coordinates (about {x:.0f}, {y:.0f}) are those of a local system, or lack their "
                "leading digits. They are taken as metres as they are; the results lie elsewhere on a map until the coordinates are complete.")
    if not there.true_to_scale:
        known = there.scale == there.scale
        named = f"{crs.name}, at {_degrees(there)}, outside the area of this CRS ({_named(area)})" if outside else crs.name
        lengths = (f"It has no place with x about {x:.0f} and y about {y:.0f}" if not known
                   else f"Lengths in it are {there.scale:.3f} times those on the ground" if outside
                   else f"Lengths in it are {there.scale:.3f} times those on the ground at {_degrees(there)}")
        zone = f", such as UTM zone {_utm_zone(there)}," if known and not outside else ""
        raise RoadExtractionError(
            f"{what} is in {named}. {lengths}, and roads are measured in metres on the ground. Reproject the data to a CRS that is made for this "
            f"place{zone} or correct the CRS.")
    if beside > MAX_OUTSIDE_AREA:
        return (f"{what} lies at {_degrees(there)}, outside the area of its CRS {crs.name} ({_named(area)}): if the survey was not made there, its "
                "CRS is wrong, and so is that of the results. Correct it in the data.")
    return ""


def check_extent(wkt: str, bounds: Sequence[Sequence[float]], what: str) -> str:
    """As `check_place`, of what lies between two corners.

    Single points astray move one corner, and the middle with it: what is right at the middle or at either corner is not refused.

    Parameters
    ----------
    wkt : metric CRS
    bounds : (2,) or (3,) least coordinates and greatest coordinates, metres
    what : the subject of the message, such as "The point cloud"

    Returns
    -------
    As `check_place`

    Raises
    ------
    RoadExtractionError
        If `check_place` refuses the middle and both corners.
    """
    corners = np.array(bounds)[:, :2]
    notes, refusals = [], []
    for place in (corners.mean(axis=0), *corners):
        try:
            note = check_place(wkt, tuple(place.tolist()), what)
        except RoadExtractionError as problem:
            refusals.append(problem)
            continue
        if not note:
            return ""
        notes.append(note)
    if notes:
        return notes[0]
    raise refusals[0]


def _area_of_use(wkt, by_code):
    """The pyproj AreaOfUse of the horizontal part of a file's CRS, None where it is not known.

    To find a CRS that states no code by its parameters takes half a second; with `by_code` it is not done.
    """
    from pyproj import CRS

    crs = horizontal_part(parse_crs(as_in_file(wkt)[0]))
    crs = crs.source_crs if crs.is_bound else crs
    if crs.area_of_use is not None:
        return crs.area_of_use
    stated = crs.to_json_dict().get("id", {})
    code = stated["code"] if stated.get("authority") == "EPSG" else None if by_code else crs.to_epsg()
    return None if code is None else CRS.from_epsg(code).area_of_use


def _beside(place, area):
    """Degrees from a place to an area; 0 within it and where it is not known, infinite from where the projection is not defined."""
    if area is None:
        return 0.0
    if place.scale != place.scale:
        return np.inf
    width = (area.east - area.west) % 360 or 360.0
    east = (place.longitude - area.west) % 360
    across = 0.0 if east <= width else min(east - width, 360 - east)
    return max(across, area.south - place.latitude, place.latitude - area.north, 0.0)


def _named(area):
    """The first words of what an area is called."""
    return re.split(r"[:;.](?: |$)", area.name)[0]


def _degrees(place):
    return (f"{abs(place.latitude):.2f}° {'N' if place.latitude >= 0 else 'S'} "
            f"{abs(place.longitude):.2f}° {'E' if place.longitude >= 0 else 'W'}")


def _utm_zone(place):
    return f"{int(min((place.longitude + 180) // 6 + 1, 60))}{'N' if place.latitude >= 0 else 'S'}"
