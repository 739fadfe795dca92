"""The coordinate reference system of a survey: projected, in metres, and the same for all its files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.errors import RoadExtractionError
from ..lazy import pyproj, shapely
from .weights import IO

if TYPE_CHECKING:
    from pyproj import CRS


# what a GeoPackage calls the CRS of a layer that carries none; without it GDAL writes an undefined geographic one
UNDEFINED_CARTESIAN = 'LOCAL_CS["Undefined Cartesian SRS",UNIT["metre",1]]'


def parse_crs(text: str | None) -> CRS | None:
    """The pyproj.CRS of WKT, "EPSG:n" or PROJ text, None for an empty one; RoadExtractionError if the text is not understood."""
    if not text:
        return None
    try:
        return pyproj.CRS.from_user_input(text)
    except pyproj.exceptions.CRSError as problem:
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
    """Raise RoadExtractionError for a pyproj.CRS that is geographic, geocentric or of heights alone, or not in metres.

    what : the subject of the message, such as "The point cloud"
    """
    flat = horizontal_part(crs)
    if flat.is_geocentric or flat.is_vertical:
        raise RoadExtractionError(f"{what} is in {flat.name}, a CRS of {'geocentric coordinates' if flat.is_geocentric else 'heights alone'}. "
                                  "Reproject it to a projected CRS, such as the UTM zone of the survey, and run again.")
    if flat.is_geographic:
        raise RoadExtractionError(f"{what} is in the geographic CRS {flat.name} (degrees). Road geometry needs metres: reproject it to a projected "
                                  "CRS, such as the UTM zone of the survey, and run again.")
    units = _not_metres(axis for axis in flat.axis_info if axis.direction.lower() not in ("up", "down"))
    if units:
        raise RoadExtractionError(
            f"{what} is in {flat.name}, whose unit is {', '.join(units)}. Lanewright works in metres: reproject it to a metric CRS and run again.")
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
    first, second = ({name: value for name, value in crs.to_dict().items() if name not in ("title", "type", "no_defs")} for crs in (a, b))
    return bool(first) and first == second   # empty where PROJ has no words for a projection


def moved_by(a: Any, b: Any, place: tuple[float, float]) -> float:
    """How far apart (units of `b`) the coordinates (x, y) of `a` lie from those of the same place in `b`; infinite where it has none there."""
    if same_crs(a, b):
        return 0.0
    x, y = pyproj.Transformer.from_crs(a, b, always_xy=True).transform(*place)
    return float(np.hypot(x - place[0], y - place[1]))


def check_same_crs(layer_crs: str, other: str, place: tuple[float, float], label: str) -> None:
    """Raise RoadExtractionError for a layer in another CRS than the point clouds; one whose CRS is not known is taken to be in theirs.

    Two that give the place of the layer the same coordinates, such as UTM zone 32 of ETRS89 and of WGS 84, are no others.

    layer_crs, other : WKT or "EPSG:n" of the layer and of the point clouds, "" where unknown
    place : (x, y) in the layer
    label : name of the layer, as at the beginning of a sentence
    """
    layer, clouds = horizontal_part(parse_crs(layer_crs)), horizontal_part(parse_crs(other))
    if layer is not None and clouds is not None and not moved_by(layer, clouds, place) < IO.same_coordinates:
        raise RoadExtractionError(f"{label} is in {layer.name}, the point clouds are in {clouds.name}. "
                                  "Reproject the layer to their CRS and run again.")


# The CRS of a survey: projected, true to scale, and the same for all its files.


def check_projected(files: Sequence[Any], given: str = "", trajectory_crs: str = "") -> str:
    """The CRS in which a survey is processed: that of its clouds, else the given one, else that of the trajectory.

    files : CloudHeader of each point cloud
    given, trajectory_crs : WKT or "EPSG:n", the first for clouds without a CRS; "" where unknown

    Returns WKT, metric; "" where no CRS is known

    Raises RoadExtractionError if clouds contradict themselves or each other, the CRS is geographic or none but the coordinates look so, the CRS is of
    another kind that has no metres, lengths in it are not those on the ground, or x and y are exchanged.
    """
    stated = _crs_of_clouds(files, given)
    wkt = stated or given or trajectory_crs
    if not stated and not given:
        _refuse_degrees(files, trajectory_crs)
    crs = parse_crs(wkt)
    if crs is None:
        return ""
    wkt = in_metres(wkt if wkt == stated or len(wkt) > 20 else crs.to_wkt())[0]
    check_metric(parse_crs(wkt), "The point cloud")
    check_extent(wkt, _bounds(files), "The point cloud")
    return wkt


def _crs_of_clouds(files, given):
    """WKT of the CRS that clouds state, which must be one for all; "" where they state none."""
    contradictory = next((file for file in files if file.crs_problem), None)
    if contradictory is not None and not given:
        raise RoadExtractionError(f"What {contradictory.path} says about its coordinates cannot be used: {contradictory.crs_problem}. Give the CRS "
                                  "that they are in by the parameter CRS, or export the file again.")
    path_by_crs: dict[str, str] = {}
    for file in files:
        if file.crs:
            path_by_crs.setdefault(file.crs, file.path)
    (first, path), *rest = [(parse_crs(wkt), path) for wkt, path in path_by_crs.items()] or [(None, "")]
    heights = first
    for crs, other_path in rest:
        if not horizontal_part(crs).equals(horizontal_part(first), ignore_axis_order=True):
            raise RoadExtractionError(f"The point clouds use different CRSs: {path} is in {horizontal_part(first).name}, "
                                      f"{other_path} in {horizontal_part(crs).name}. Reproject them to one CRS first.")
        heights = heights if heights.is_compound else crs
        if crs.is_compound and not crs.sub_crs_list[-1].equals(heights.sub_crs_list[-1]):
            raise RoadExtractionError(f"The point clouds have heights of different kinds: {heights.sub_crs_list[-1].name} and, in {other_path}, "
                                      f"{crs.sub_crs_list[-1].name}. Bring all files to one kind of heights, and run again.")
    return next(iter(path_by_crs), "")


def _refuse_degrees(files, trajectory_crs):
    """Refuse clouds without a CRS where that of the trajectory does not help: it is geographic and they are not, or there is none and they are."""
    crs = horizontal_part(parse_crs(trajectory_crs))
    if crs is not None and crs.is_geographic and not _in_degrees(files):
        raise RoadExtractionError(
            f"The point cloud carries no CRS, and the trajectory is in {crs.name} (degrees). Give the CRS of the point cloud by the parameter CRS.")
    if crs is None and _in_degrees(files):
        raise RoadExtractionError("The point cloud carries no CRS, and its coordinates look like longitude and latitude in degrees. "
                                  "Reproject it to a projected CRS, such as its UTM zone, and run again.")


def _bounds(files):
    """(3,) least and (3,) greatest coordinates of the clouds."""
    filled = [file for file in files if file.count]
    return np.min([file.minimum for file in filled], axis=0), np.max([file.maximum for file in filled], axis=0)


def _in_degrees(files):
    """Whether the clouds' coordinates can only be longitude and latitude: valid degrees, and a survey less than a degree wide."""
    low, high = _bounds(files)
    return bool((np.abs([low[0], high[0]]) <= 180).all() and (np.abs([low[1], high[1]]) <= 90).all() and (high - low)[:2].max() < 1.0)


def crs_note(files: Sequence[Any], given: str, crs: str) -> str:
    """Sentences for the user about the CRS (WKT, "" where unknown) in which a survey is processed, and the one that was given; "" for none."""
    if not crs:
        return ("The point cloud carries no CRS, and neither do the results. Where its coordinates are those of a map, give their CRS by the "
                "parameter CRS and run again.")
    notes = [check_extent(crs, _bounds(files), "The point cloud")]
    stated = next((file.crs for file in files if file.crs), "")
    if given and stated and not same_crs(parse_crs(given), parse_crs(stated)):
        notes.append(f"The point cloud says that it is in {horizontal_part(parse_crs(stated)).name}; the parameter CRS "
                     f"({horizontal_part(parse_crs(given)).name}) is for clouds that carry none and was not used.")
    notes += [f"What {file.path} says about its coordinates was not used, but the parameter CRS: {file.crs_problem}."
              for file in files if file.crs_problem][:1]
    if (units := as_in_file(crs)[1]).across != units.up:
        across, *_, up = (axis.unit_name for axis in pyproj.CRS(as_in_file(crs)[0]).axis_info)
        notes.append(f"The point cloud says that the unit of its heights is the {up}, and that of its x and y the {across}: what is not in "
                     "metres was converted.")
    return " ".join(note for note in notes if note)


def unit_note(height: float, crs: str) -> str:
    """A note for the user where a cloud without CRS is in feet, as it seems by the height of the sensor above the road, m; "" for none."""
    if crs or not IO.suspicious_sensor_height[0] < height < IO.suspicious_sensor_height[1]:
        return ""
    return (f"The sensor seems to ride {height:.1f} m above the road, as if cloud and trajectory were in feet. Set the parameter CRS to theirs, "
            "such as State Plane in feet.")


# Whether a survey lies where its CRS holds, and lengths on the map there are lengths on the ground.


@dataclass(frozen=True)
class _MapPlace:
    """A place of the map on the ground: degrees from Greenwich, of the CRS's own datum."""

    longitude: float
    latitude: float
    scale: float   # length on the map per length on the ground, in the direction where it is farthest from 1; NaN where the projection is not defined

    @property
    def true_to_scale(self) -> bool:
        """Whether lengths on the map are lengths on the ground, as far as roads are concerned."""
        return abs(self.scale - 1.0) <= IO.max_scale_error


def place_on_ground(crs: Any, x: float, y: float) -> _MapPlace:
    """Where a place of the map, x and y in metres of a projected pyproj.CRS, lies, and the scale there.

    The metric of the ground is measured along x, y and their diagonal with geodesics; its eigenvalues are the squared lengths of the axes of
    Tissot's indicatrix (Snyder, 1987, Map Projections: A Working Manual, USGS Professional Paper 1395, p. 20-26). Heights, which shorten lengths
    on the map by 0.16 per mille a kilometre, are not counted.
    """
    steps = IO.scale_step * np.array([(0, 0), (1, 0), (0, 1), (1, 1)])
    u, v = pyproj.Proj(crs)(*(steps + (x, y)).T, inverse=True)
    if not np.isfinite([u, v]).all():
        return _MapPlace(np.nan, np.nan, np.nan)
    along_x, along_y, diagonal = np.array(crs.get_geod().inv(*([end[0]] * 3 for end in (u, v)), u[1:], v[1:])[2]) / IO.scale_step
    mixed = (diagonal**2 - along_x**2 - along_y**2) / 2
    ground = np.sqrt(np.linalg.eigvalsh([[along_x**2, mixed], [mixed, along_y**2]]).clip(1e-12))
    scale = max(1 / ground, key=lambda one: abs(np.log(one)))
    return _MapPlace(float((u[0] + 180) % 360 - 180), float(v[0]), float(scale))


@lru_cache(maxsize=16)
def check_place(wkt: str, place: tuple[float, float], what: str) -> str:
    """Refuse a CRS in which lengths at the survey are not those on the ground, and coordinates that are exchanged.

    wkt : metric CRS
    place : (x, y) of the survey, metres
    what : the subject of the message, such as "The point cloud"

    Returns a sentence on a survey that lies far outside the area of its CRS; "" where there is nothing to note

    Raises RoadExtractionError if lengths differ by more than 5 per mille, or the survey lies in the area only with x and y exchanged.
    """
    crs = horizontal_part(parse_crs(wkt))
    if not crs.is_projected:
        return ""
    x, y = place
    location = place_on_ground(crs, x, y)
    area = _area_of_use(wkt, location.true_to_scale)
    outside = _beside(location, area)
    if outside > IO.min_exchanged:
        turned = place_on_ground(crs, y, x)
        if turned.true_to_scale and _beside(turned, area) == 0:
            raise RoadExtractionError(
                f"{what} has x and y exchanged: only with y (about {y:.0f}) as the easting it lies in the area of {crs.name} ({_named(area)}). "
                "Export the easting as x and run again.")
    if outside > IO.max_outside_area and max(abs(x), abs(y)) < IO.max_local:
        return (f"{what} says it is in {crs.name}; its coordinates (about {x:.0f}, {y:.0f}) are those of a local system or lack leading digits. "
                "They are taken as metres; the map lies elsewhere.")
    if not location.true_to_scale:
        raise _not_true_to_scale(what, crs, place, location, area if outside > IO.min_exchanged else None)
    if outside > IO.max_outside_area:
        return (f"{what} lies at {_degrees(location)}, outside the area of its CRS {crs.name} ({_named(area)}). If the survey was not made there, "
                "correct the CRS in the data.")
    return ""


def _not_true_to_scale(what, crs, place, there, area):
    """The error for a survey at a _MapPlace where lengths are not those on the ground; `area` of the CRS where it lies outside, else None."""
    named = f"{crs.name}, at {_degrees(there)}, outside the area of this CRS ({_named(area)})" if area else crs.name
    if there.scale != there.scale:
        lengths, zone = f"It has no place with x about {place[0]:.0f} and y about {place[1]:.0f}", ""
    elif area:
        lengths, zone = f"Lengths in it are {there.scale:.3f} times those on the ground", ""
    else:
        lengths = f"Lengths in it are {there.scale:.3f} times those on the ground at {_degrees(there)}"
        zone = f", such as UTM zone {min((there.longitude + 180) // 6 + 1, 60):.0f}{'N' if there.latitude >= 0 else 'S'},"
    return RoadExtractionError(f"{what} is in {named}. {lengths}, and roads are measured in metres on the ground. Reproject the data to a CRS that "
                               f"is made for this place{zone} or correct the CRS.")


def check_extent(wkt: str, bounds: Sequence[Sequence[float]], what: str) -> str:
    """As `check_place`, of what lies between two corners, (2,) or (3,) least and greatest coordinates in metres.

    Single points astray move one corner, and the middle with it: what is right at the middle or at either corner is not refused.
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
    crs = horizontal_part(parse_crs(as_in_file(wkt)[0]))
    crs = crs.source_crs if crs.is_bound else crs
    if crs.area_of_use is not None:
        return crs.area_of_use
    stated = crs.to_json_dict().get("id", {})
    code = stated["code"] if stated.get("authority") == "EPSG" else None if by_code else crs.to_epsg()
    return None if code is None else pyproj.CRS.from_epsg(code).area_of_use


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
    return (f"{abs(place.latitude):.2f}° {'N' if place.latitude >= 0 else 'S'} {abs(place.longitude):.2f}° {'E' if place.longitude >= 0 else 'W'}")


# Files in feet: inside all is metres, in a CRS that differs from the file's in its units alone; the doors of files convert.
#
# Such a *metric* CRS carries the WKT of the file's CRS in its remark, so that whatever is made from a survey is written in the survey's own CRS
# again, by whatever process and stage.

MARK = "Metric form of "        # begins the remark, before the WKT of the file's CRS
FOOT, US_SURVEY_FOOT = 0.3048, 1200 / 3937   # source: m, both exact (NIST Special Publication 811, appendix B.6)
NO_PLACE = (0.0, 1.0, 0.0, 0.0, 0.0, 1.0)   # source: of a raster without georeferencing, as GDAL gives it


@dataclass(frozen=True)
class FileUnits:
    """The units of coordinates in a file: metres per unit of x and y (1 for degrees), and per unit of z."""

    across: float = 1.0
    up: float = 1.0

    @property
    def metric(self) -> bool:
        """Whether the numbers of the file are those that are worked with."""
        return self == METRES

    def in_metres(self, places: Any) -> np.ndarray:
        """(..., 2) or (..., 3) coordinates of a file in metres."""
        return np.asarray(places) * np.array([self.across, self.across, self.up])[:np.shape(places)[-1]]

    def in_file(self, places: Any) -> np.ndarray:
        """(..., 2) or (..., 3) metres as coordinates of a file."""
        return np.asarray(places) / np.array([self.across, self.across, self.up])[:np.shape(places)[-1]]

    def geotransform(self, numbers: Any, to_file: bool = False) -> tuple[float, ...]:
        """Places and lengths on the map, such as the six numbers of GDAL, from the units of a file to metres, or the other way round."""
        return tuple(numbers) if self.metric else tuple(float(number / self.across if to_file else number * self.across) for number in numbers)


METRES = FileUnits()


@lru_cache(maxsize=64)
def in_metres(wkt: str) -> tuple[str, FileUnits]:
    """The CRS to work in with coordinates of a file, and the units of the file; RoadExtractionError if the text is not understood.

    wkt : WKT or "EPSG:n" of the file's CRS, or what this function made of it; "" where unknown

    Returns
        wkt : as it was where the file is in metres (or degrees); otherwise a CRS with the same projection in metres
        units : FileUnits. Heights without a vertical CRS have the unit of x and y, and beside degrees metres
    """
    file_wkt = _file_wkt(wkt)
    crs = parse_crs(file_wkt or wkt)
    if crs is None:
        return "", METRES
    units = _units_of(crs)
    if units.metric or file_wkt:
        return wkt, units
    # with the same name and without the code, which is that of the original
    return pyproj.CRS.from_json_dict({**_with_metres(crs.to_json_dict()), "remarks": MARK + crs.to_wkt()}).to_wkt(), units


@lru_cache(maxsize=64)
def as_in_file(wkt: str) -> tuple[str, FileUnits]:
    """The survey's own CRS, in which a file is written, and its units, of the CRS that was worked in; WKT, "" where unknown."""
    file_wkt = _file_wkt(wkt)
    return (file_wkt, _units_of(parse_crs(file_wkt))) if file_wkt else (wkt, METRES)


def in_other_crs(geometries: Iterable[Any], source: CRS, target: CRS) -> list[Any]:
    """Geometries, of which some may be None, brought from one CRS to another; their heights stay."""
    transformer = pyproj.Transformer.from_crs(horizontal_part(source), horizontal_part(target), always_xy=True)

    def moved(places):
        return np.column_stack([*transformer.transform(*places[:, :2].T), places[:, 2:]])

    return [None if geometry is None else shapely.transform(geometry, moved, include_z=bool(geometry.has_z)) for geometry in geometries]


def place_of_raster(dataset: Any) -> tuple[tuple[float, ...] | None, str]:
    """The six numbers of an open GDAL raster in metres, None where it has none, and the WKT, metric, of its CRS."""
    transform, text = dataset.GetGeoTransform(can_return_null=True), dataset.GetProjection() or ""
    try:
        crs, units = in_metres(text)
    except RoadExtractionError:   # whoever needs the CRS says so
        crs, units = text, METRES
    return None if transform is None else units.geotransform(transform), crs


def place_raster(dataset: Any, geotransform: Any, crs: str) -> None:
    """Give a new GDAL raster its place, six numbers in metres and WKT, in the units of the survey's own CRS."""
    wkt, units = as_in_file(crs)
    dataset.SetGeoTransform(units.geotransform(geotransform, to_file=True))
    if wkt:
        dataset.SetProjection(wkt)


def plane_wkt(wkt: str) -> str:
    """WKT of the horizontal part of a CRS that is worked in."""
    return in_metres(horizontal_part(parse_crs(as_in_file(wkt)[0])).to_wkt())[0]


def _file_wkt(wkt):
    """The WKT that the remark of a metric form holds, "" for every other CRS."""
    return parse_crs(wkt).remarks[len(MARK):] if f'REMARK["{MARK}' in wkt else ""


def _units_of(crs):
    flat = horizontal_part(crs)
    axes = [axis for axis in flat.axis_info if axis.direction.lower() not in ("up", "down")]
    across = axes[0].unit_conversion_factor if axes and not flat.is_geographic else 1.0
    heights = [axis for axis in (crs.sub_crs_list[-1] if crs.is_compound else flat).axis_info if axis.direction.lower() in ("up", "down")]
    up = heights[0].unit_conversion_factor if heights else across
    return FileUnits(*(1.0 if abs(factor - 1.0) < IO.same_unit else float(factor) for factor in (across, up)))


def _with_metres(content):
    """PROJJSON with every length of the projection and every axis in metres."""
    if isinstance(content, list):
        return [_with_metres(item) for item in content]
    if not isinstance(content, dict):
        return content
    result = {key: _with_metres(value) for key, value in content.items()}
    unit = content.get("unit")
    if isinstance(unit, dict) and unit.get("type") == "LinearUnit":
        result["unit"] = "metre"
        if "value" in content:
            result["value"] = content["value"] * unit["conversion_factor"]
    if "coordinate_system" in content or content.get("type") == "CompoundCRS":
        result.pop("id", None)
    return result
