"""Writes the layers of a road map as a DXF drawing: 3D polylines, one layer a class."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from ....core.common.errors import RoadExtractionError
from ....core.common.features import Features
from ....core.io.crs import as_in_file
from ....core.io.local_files import gdal_exceptions
from ..sources import RoadMapSource

COLOURS = {"LANE_BORDER": "#808080", "DRIVING_LINE": "#00a0ff", "MARKING_EDGE": "#ffffff", "MARKING_LANE": "#e0e0e0", "MARKING_CENTRE": "#ffd040",
           "ROAD_EDGE": "#ff8000", "MARKING_AREA": "#ffff00"}


@dataclass(frozen=True)
class _DxfLine:
    """layer : name; places : (N, 3); closed : whether the last place is joined with the first."""

    layer: str
    places: np.ndarray
    closed: bool = False


def dxf_lines(source: RoadMapSource) -> list[_DxfLine]:
    """Lane borders, driving lines, marking lines by kind and pattern, road edges by what they are, outlines of markings by class."""
    lines = []
    lanes = source.lanes
    seen = set()
    for k in range(len(lanes)):
        for border in lanes.borders(k):
            key = min(border.tobytes(), border[::-1].tobytes())
            if key not in seen and np.hypot(*(border[-1] - border[0])[:2]) > 0.01:
                seen.add(key)
                lines.append(_DxfLine(f"LANE_BORDER_{lanes.type[k].upper()}", border))
    lines += _of(source.driving_lines, lambda row: "DRIVING_LINE" + ("" if row.get("status") in (None, "measured") else f"_{row['status'].upper()}"))
    lines += _of(source.marking_lines, lambda row: "_".join(filter(None, ("MARKING", str(row.get("kind") or "line").upper(),
                                                                          str(row.get("pattern") or "").upper().replace("-", "_")))))
    lines += _of(source.road_edges, _edge_layer)
    lines += _of(source.markings, lambda row: f"MARKING_AREA_{str(row.get('class') or 'other').upper()}")
    return lines


def _edge_layer(row: dict[str, Any]) -> str:
    """ROAD_EDGE_CURB, _DROPPED or _PAVEMENT; of layers that do not say what an edge is, ROAD_EDGE_CURB where it has a height, else ROAD_EDGE."""
    edge = row.get("edge") or ("curb" if row.get("height_m") else "")
    return f"ROAD_EDGE_{str(edge).upper()}" if edge else "ROAD_EDGE"


def _of(layer: Features | None, name_of: Callable[[dict[str, Any]], str]) -> list[_DxfLine]:
    lines = []
    for geometry, row in layer or ():
        for part in shapely.get_parts(geometry) if geometry is not None else ():
            closed = part.geom_type == "Polygon"
            places = shapely.get_coordinates(part.exterior if closed else part, include_z=True)
            lines.append(_DxfLine(name_of(row), places, closed))
    return lines


def _colour_of(layer: str) -> str:
    """The colour of a layer by the beginning of its name."""
    return next((colour for name, colour in COLOURS.items() if layer.startswith(name)), "#c0c0c0")


def write_dxf(lines: list[_DxfLine], path: str, crs: str = "") -> None:
    """Write the file by GDAL, in the units of the survey's own CRS, metric WKT, or ""; RoadExtractionError if there is no GDAL."""
    try:
        from osgeo import gdal, ogr
    except ImportError as problem:
        raise RoadExtractionError("DXF is written by GDAL, whose Python module is not installed. Install it (on Debian python3-gdal), or choose "
                                  "FORMAT = landxml.") from problem

    units = as_in_file(crs)[1]
    with gdal_exceptions():
        dataset = gdal.GetDriverByName("DXF").Create(path, 0, 0, 0, gdal.GDT_Unknown)
        layer = dataset.CreateLayer("entities")
        for line in lines:
            feature, geometry = ogr.Feature(layer.GetLayerDefn()), ogr.Geometry(ogr.wkbLineString25D)
            for x, y, z in units.in_file(line.places):
                geometry.AddPoint(float(x), float(y), float(z))
            feature.SetField("Layer", line.layer)
            feature.SetStyleString(f"PEN(c:{_colour_of(line.layer)},w:1px)")
            feature.SetGeometryDirectly(geometry)
            layer.CreateFeature(feature)
            feature = None
        layer = None
        dataset = None
