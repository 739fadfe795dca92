"""The CRS of a LAS file from its WKT and GeoKeys records, which may contradict each other."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from ...io.crs import SAME_DATUM, SAME_UNIT, horizontal_part, moved_by

if TYPE_CHECKING:
    from pyproj import CRS

RECORDS_OF = "LASF_Projection"  # user id of the records
WKT_RECORD, KEYS_RECORD, DOUBLES_RECORD = 2112, 34735, 34736
PROJECTED, GEODETIC, LENGTH_UNIT, LENGTH_SIZE, VERTICAL, HEIGHT_UNIT = 3072, 2048, 3076, 3077, 4096, 4099   # GeoKeys, OGC 19-008r4
EPSG_CODES = range(1024, 32767)


def crs_of_records(header: Any) -> tuple[str, str]:
    """The CRS that a file states.

    Parameters
    ----------
    header : laspy.LasHeader

    Returns
    -------
    wkt : of the file's CRS with the unit of its heights, "" where it has none, or none that is understood
    problem : a sentence on why what the file says cannot be used, "" for none
    """
    records = [record for record in [*header.vlrs, *(header.evlrs or ())] if record.user_id == RECORDS_OF]
    texts = [record.record_data_bytes() for record in records if record.record_id == WKT_RECORD]
    keys = [record.record_data_bytes() for record in records if record.record_id == KEYS_RECORD]
    doubles = [record.record_data_bytes() for record in records if record.record_id == DOUBLES_RECORD]
    middle = (header.mins + header.maxs) / 2
    return _stated(b"".join(texts[:1]), b"".join(keys[:1]), b"".join(doubles[:1]), tuple(middle[:2].tolist()))


@lru_cache(maxsize=256)
def _stated(text, keys, doubles, place):
    """As of `crs_of_records`, of the contents of the records."""
    import numpy as np

    table = np.frombuffer(keys[:len(keys) // 8 * 8], "<u2").reshape(-1, 4)[1:].tolist()
    sizes = np.frombuffer(doubles[:len(doubles) // 8 * 8], "<f8").tolist()
    values = {key: value if where == 0 else sizes[value] for key, where, _, value in table
              if where == 0 or where == DOUBLES_RECORD and value < len(sizes)}
    written, (plane, vertical, problem) = _parsed(text.split(b"\0")[0].decode("utf-8", "replace")), _of_keys(values)
    if written is None:
        return _joined(plane, vertical), problem
    if _of_heights(written):
        written, vertical = plane, written
    if written is None:
        return "", problem or ("" if _same_unit(vertical, 1.0) else f"only the CRS of its heights is known ({vertical.name})")
    if plane is not None and moved_by(plane, horizontal_part(written), place) > SAME_DATUM:
        problem = problem or f"its WKT says {horizontal_part(written).name}, its GeoKeys say {plane.name}"
    own = written.sub_crs_list[-1] if written.is_compound else None
    if own is not None and vertical is not None and not _same_unit(own, vertical.axis_info[0].unit_conversion_factor):
        problem = problem or f"its WKT says that heights are in {own.axis_info[0].unit_name}, its GeoKeys say {vertical.axis_info[0].unit_name}"
    return _joined(written, None if own is not None else vertical), problem


def _of_keys(values: Mapping[int, Any]) -> tuple[CRS | None, CRS | None, str]:
    """The horizontal and vertical CRS that GeoKeys name, None where they do not, and what contradicts itself in them."""
    plane = _coded(values.get(PROJECTED)) or _coded(values.get(GEODETIC))
    if _of_heights(plane):
        plane = None
    factor, unit = _length(values.get(LENGTH_UNIT), values.get(LENGTH_SIZE))
    problem = ""
    if factor and plane is None and abs(factor - 1.0) > SAME_UNIT:
        problem = f"its x and y are in {unit}, and the CRS that they lie in is not known"
    elif factor and plane is not None and not plane.is_geographic and not _same_unit(plane, factor):
        problem = f"its code says {plane.name}, whose unit is {plane.axis_info[0].unit_name}, and its unit key says {unit}"
    vertical = _coded(values.get(VERTICAL))
    if not _of_heights(vertical):   # codes of datums, which older files have there
        vertical = None
    factor, unit = _length(values.get(HEIGHT_UNIT), None)
    if factor and (vertical is None or not _same_unit(vertical, factor)):
        vertical = _vertical(vertical, factor, unit)
    if not problem and plane is None and vertical is not None and not _same_unit(vertical, 1.0):
        problem = f"its heights are in {vertical.axis_info[0].unit_name}, and the CRS of its x and y is not known"
    return plane, vertical, problem


def _joined(plane, vertical):
    """WKT of a compound CRS where heights have another unit than x and y, else of the horizontal one; "" without one."""
    from pyproj.crs import CompoundCRS

    if plane is None:
        return ""
    across = 1.0 if plane.is_geographic else plane.axis_info[0].unit_conversion_factor
    if vertical is None or plane.is_compound or _same_unit(vertical, across):
        return plane.to_wkt()
    return CompoundCRS(name=f"{plane.name} + {vertical.name}", components=[plane, vertical]).to_wkt()


def _vertical(crs, factor, unit):
    """A vertical CRS with another unit, or of an unknown datum."""
    from pyproj import CRS

    content = {"type": "VerticalCRS", "name": "height", "datum": {"type": "VerticalReferenceFrame", "name": "unknown"}, "coordinate_system": {
        "subtype": "vertical", "axis": [{"name": "Height", "abbreviation": "H", "direction": "up"}]}} if crs is None else crs.to_json_dict()
    content.pop("id", None)
    content["name"] += f" ({unit})"
    content["coordinate_system"]["axis"][0]["unit"] = {"type": "LinearUnit", "name": unit, "conversion_factor": factor}
    return CRS.from_json_dict(content)


def _of_heights(crs):
    """Whether a CRS is one of heights alone."""
    return crs is not None and crs.is_vertical and not crs.is_compound


def _same_unit(crs, factor):
    """Whether the first axis of a CRS has a unit of `factor` metres."""
    return abs(crs.axis_info[0].unit_conversion_factor / factor - 1.0) < SAME_UNIT


def _length(code, size):
    """(metres, name) of a unit of length by its EPSG code, or its size where it has none; (None, "") where it is not said."""
    from pyproj.database import get_units_map

    for unit in get_units_map("EPSG", "linear").values() if code in EPSG_CODES else ():
        if unit.code == str(code):
            return unit.conv_factor, unit.name
    return (float(size), f"units of {size:g} m") if size else (None, "")


def _coded(code):
    """The CRS of an EPSG code, None where it is none."""
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        return CRS.from_epsg(code) if code in EPSG_CODES else None
    except CRSError:
        return None


def _parsed(text):
    """The CRS of WKT, None where it is empty or not understood: the user is then asked for one."""
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        return CRS.from_wkt(text) if text.strip() else None
    except CRSError:
        return None
