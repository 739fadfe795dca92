"""Writes Lanelet2 in the XML of OpenStreetMap."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.crs import as_in_file, horizontal_part, parse_crs
from ..map_crs import LOCAL_CRS
from .exporter import LaneletDraft

NO_VERTICAL = "not stated by the survey; heights are written as they are"
SQUARE = 100_000.0     # m: local coordinates of Autoware are those within a square of this size


@dataclass(frozen=True)
class Degrees:
    """How the map's places became latitude and longitude.

    lonlat : (N, 2) degrees of WGS 84; way : name of the transformation; accuracy : metres as its authors say, -1 where they do not;
    vertical : what the heights are; local : whether the map lies nowhere on the earth
    """

    lonlat: np.ndarray
    way: str
    accuracy: float
    vertical: str
    local: bool = False


def to_degrees(places: np.ndarray, crs: str) -> Degrees:
    """Latitude and longitude of (N, 2+) places; those without CRS about the origin of their coordinates become a local map about 0, 0.

    Raises
    ------
    RoadExtractionError
        If the CRS is unknown and the coordinates are not local, or the places lie outside of the CRS.
    """
    from pyproj.transformer import Transformer, TransformerGroup

    known = parse_crs(crs)
    if known is None and np.abs(places[:, :2]).max(initial=0.0) < SQUARE:
        lon, lat = Transformer.from_crs(LOCAL_CRS, "EPSG:4326", always_xy=True).transform(places[:, 0], places[:, 1])
        return Degrees(np.c_[lon, lat], "local coordinates about latitude and longitude 0", -1.0, NO_VERTICAL, True)
    if known is None:
        raise RoadExtractionError("The layer of lanes has no CRS, so its latitude and longitude are unknown. Set the CRS of the layer and run again.")
    found = TransformerGroup(horizontal_part(known), "EPSG:4326", always_xy=True).transformers[0]
    lon, lat = found.transform(places[:, 0], places[:, 1])
    if not (np.isfinite(lon).all() and np.isfinite(lat).all()):
        raise RoadExtractionError(f"The lanes do not lie where their CRS {horizontal_part(known).name} holds. Check the CRS of the layer.")
    vertical = known.sub_crs_list[-1].name if known.is_compound else NO_VERTICAL
    if as_in_file(crs)[1].up != 1.0:
        vertical += ", in metres"
    return Degrees(np.c_[lon, lat], found.description, found.accuracy if found.accuracy is not None else -1.0, vertical)


def lanelet2_text(draft: LaneletDraft, degrees: Degrees, local: bool = False) -> str:
    """The file as text.

    Parameters
    ----------
    draft : LaneletDraft
    degrees : of its nodes
    local : also write the tags local_x and local_y, metres within a square of 100 km, as Autoware reads them
    """
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', '<osm version="0.6" generator="Lanewright" upload="false">']
    local = local or degrees.local
    if local:
        lines.append('  <MetaInfo format_version="1" map_version="1"/>')
    used = sorted({node for way in draft.ways for node in way.nodes})
    ids = {node: k for k, node in enumerate(used, start=1)}
    square = np.floor(draft.nodes[used, :2].min(0) / SQUARE) * SQUARE if used and not degrees.local else np.zeros(2)
    for node in used:
        lon, lat = degrees.lonlat[node]
        x, y, z = draft.nodes[node]
        tags = {"ele": f"{z:.4f}"}
        if local:
            tags |= {"local_x": f"{x - square[0]:.4f}", "local_y": f"{y - square[1]:.4f}"}
        lines.append(f'  <node id="{ids[node]}" visible="true" version="1" lat="{lat:.11f}" lon="{lon:.11f}">{_tags(tags)}</node>')
    first_way = len(used) + 1
    for number, way in enumerate(draft.ways):
        places = "".join(f'<nd ref="{ids[node]}"/>' for node in way.nodes)
        lines.append(f'  <way id="{first_way + number}" visible="true" version="1">{places}{_tags(way.tags)}</way>')
    first_lanelet = first_way + len(draft.ways)
    for number, lanelet in enumerate(draft.lanelets):
        members = "".join(f'<member type="way" ref="{first_way + member}" role="{role}"/>' for role, member in (
            ("left", lanelet.left), ("right", lanelet.right), ("centerline", lanelet.centre)) if member >= 0)
        tags = lanelet.tags | ({"lanewright:lane_id": lanelet.name} if lanelet.name else {})
        lines.append(f'  <relation id="{first_lanelet + number}" visible="true" version="1">{members}{_tags(tags)}</relation>')
    return "\n".join([*lines, "</osm>", ""])


def _tags(tags):
    return "".join(f'<tag k="{escape(key)}" v="{escape(str(value))}"/>' for key, value in tags.items())
