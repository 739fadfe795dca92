"""Files in feet: inside all is metres, in a CRS that differs from the file's in its units alone; the doors of files convert.

Such a *metric* CRS carries the WKT of the file's CRS in its remark, so that whatever is made from a survey is written in the survey's own CRS
again, by whatever process and stage.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from ..common.errors import RoadExtractionError
from .crs import horizontal_part, parse_crs

MARK = "Metric form of "        # begins the remark, before the WKT of the file's CRS
FOOT, US_SURVEY_FOOT = 0.3048, 1200 / 3937   # m, both exact (NIST Special Publication 811, appendix B.6)
NO_PLACE = (0.0, 1.0, 0.0, 0.0, 0.0, 1.0)   # of a raster without georeferencing, as GDAL gives it
SAME_UNIT = 1e-9                # relative, between units that are written with other digits; two definitions of the foot differ by 2e-6


@dataclass(frozen=True)
class FileUnits:
    """The units of coordinates in a file.

    across : metres per unit of x and y (1 for degrees)
    up : metres per unit of z
    """

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
    """The CRS to work in with coordinates of a file, and the units of the file.

    Parameters
    ----------
    wkt : WKT or "EPSG:n" of the file's CRS, or what this function made of it; "" where unknown

    Returns
    -------
    wkt : as it was where the file is in metres (or degrees); otherwise a CRS with the same projection in metres
    units : FileUnits. Heights without a vertical CRS have the unit of x and y, and beside degrees metres

    Raises
    ------
    RoadExtractionError
        If the text is not understood.
    """
    file_wkt = _file_wkt(wkt)
    crs = parse_crs(file_wkt or wkt)
    if crs is None:
        return "", METRES
    units = _units_of(crs)
    return (wkt if units.metric or file_wkt else _metric_form(crs).to_wkt()), units


@lru_cache(maxsize=64)
def as_in_file(wkt: str) -> tuple[str, FileUnits]:
    """The CRS of a file that is to be written, and its units.

    Parameters
    ----------
    wkt : of the CRS that was worked in, "" where unknown

    Returns
    -------
    wkt : of the survey's own CRS
    units : FileUnits
    """
    file_wkt = _file_wkt(wkt)
    return (file_wkt, _units_of(parse_crs(file_wkt))) if file_wkt else (wkt, METRES)


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


def unit_names(wkt: str) -> list[str]:
    """The names of the units of x, y and, where a CRS says it, z."""
    crs = parse_crs(wkt)
    return [] if crs is None else [axis.unit_name for axis in crs.axis_info]


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
    return FileUnits(*(1.0 if abs(factor - 1.0) < SAME_UNIT else float(factor) for factor in (across, up)))


def _metric_form(crs):
    """A pyproj.CRS with its lengths in metres and the same name, without the code, which is that of the original."""
    from pyproj import CRS

    content = _with_metres(crs.to_json_dict())
    content["remarks"] = MARK + crs.to_wkt()
    return CRS.from_json_dict(content)


def _with_metres(content):
    """PROJJSON with every length of the projection and every axis in metres."""
    if isinstance(content, list):
        return [_with_metres(one) for one in content]
    if not isinstance(content, dict):
        return content
    made = {key: _with_metres(value) for key, value in content.items()}
    unit = content.get("unit")
    if isinstance(unit, dict) and unit.get("type") == "LinearUnit":
        made["unit"] = "metre"
        if "value" in content:
            made["value"] = content["value"] * unit["conversion_factor"]
    if "coordinate_system" in content or content.get("type") == "CompoundCRS":
        made.pop("id", None)
    return made
