"""Writes Lanelet2 in the XML of OpenStreetMap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.crs import horizontal_part, parse_crs
from ...io.units import as_in_file
from ..xml_tree import XmlElement, xml_text
from .exporter import LaneletDraft

SQUARE = 100_000.0     # m: local coordinates of Autoware are those within a square of this size


@dataclass(frozen=True)
class Degrees:
    """How the map's places became latitude and longitude.

    lonlat : (N, 2) degrees of WGS 84; way : name of the transformation; accuracy : metres as its authors say, -1 where they do not;
    vertical : what the heights are
    """

    lonlat: np.ndarray
    way: str
    accuracy: float
    vertical: str


def to_degrees(places: np.ndarray, crs: str) -> Degrees:
    """Latitude and longitude of (N, 2+) places.

    Raises
    ------
    RoadExtractionError
        If the CRS is unknown, or the places lie outside of it.
    """
    from pyproj.transformer import TransformerGroup

    known = parse_crs(crs)
    if known is None:
        raise RoadExtractionError("The layer of lanes has no CRS, so its latitude and longitude are unknown. Set the CRS of the layer and run again.")
    found = TransformerGroup(horizontal_part(known), "EPSG:4326", always_xy=True).transformers[0]
    lon, lat = found.transform(places[:, 0], places[:, 1])
    if not (np.isfinite(lon).all() and np.isfinite(lat).all()):
        raise RoadExtractionError(f"The lanes do not lie where their CRS {horizontal_part(known).name} holds. Check the CRS of the layer.")
    vertical = known.sub_crs_list[-1].name if known.is_compound else "not stated by the survey; heights are written as they are"
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
    root = XmlElement("osm", {"version": "0.6", "generator": "Lanewright", "upload": "false"})
    if local:
        root.add("MetaInfo", format_version="1", map_version="1")
    used = sorted({node for way in draft.ways for node in way.nodes})
    ids = {node: k for k, node in enumerate(used, start=1)}
    square = np.floor(draft.nodes[used, :2].min(0) / SQUARE) * SQUARE if used else np.zeros(2)
    for node in used:
        lon, lat = degrees.lonlat[node]
        element = root.add("node", id=ids[node], visible="true", version="1", lat=f"{lat:.11f}", lon=f"{lon:.11f}")
        x, y, z = draft.nodes[node]
        element.add("tag", k="ele", v=f"{z:.4f}")
        if local:
            element.add("tag", k="local_x", v=f"{x - square[0]:.4f}")
            element.add("tag", k="local_y", v=f"{y - square[1]:.4f}")
    first_way = len(used) + 1
    for number, way in enumerate(draft.ways):
        element = root.add("way", id=first_way + number, visible="true", version="1")
        for node in way.nodes:
            element.add("nd", ref=ids[node])
        _tags(element, way.tags)
    first_lanelet = first_way + len(draft.ways)
    for number, lanelet in enumerate(draft.lanelets):
        element = root.add("relation", id=first_lanelet + number, visible="true", version="1")
        for role, member in (("left", lanelet.left), ("right", lanelet.right), ("centerline", lanelet.centre)):
            if member >= 0:
                element.add("member", type="way", ref=first_way + member, role=role)
        _tags(element, lanelet.tags | ({"lanewright:lane_id": lanelet.name} if lanelet.name else {}))
    return xml_text(root)


def _tags(element, tags):
    for key, value in tags.items():
        element.add("tag", k=key, v=value)
