"""Reads Lanelet2 maps in the XML of OpenStreetMap."""

from __future__ import annotations

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ..xml_tree import XmlElement, read_xml
from .model import Lanelet, LaneletMap, Way

OSM_KIND = "a Lanelet2 map in the XML of OpenStreetMap"
MAX_ID = 2**63   # ids are whole numbers of 64 bits with a sign; those that editors give to what is new are negative
ALL_IDS = 2**64   # of 64 bits; without a sign, as some programs write them, the larger ones are negative ones


def read_lanelet2(path: str, progress: Progress = Progress()) -> LaneletMap:
    """Read a file.

    Parameters
    ----------
    path : of the .osm file
    progress : told of the share that was read

    Returns
    -------
    LaneletMap

    Raises
    ------
    RoadExtractionError
        If the file is no map of this kind, hostile, or has no lanelet.
    """
    found = lanelets_of(read_xml(path, "osm", OSM_KIND, progress))
    if not found.lanelets:
        raise RoadExtractionError(f"{path} has no relation of type lanelet. Maps of OpenStreetMap have roads without lanes; choose a Lanelet2 map.")
    return found


def lanelets_of(root: XmlElement) -> LaneletMap:
    """The map of the element <osm>."""
    ids, places, local, twice, ways = [], [], [], [], {}
    tags_twice: list[tuple[str, int, str]] = []
    lanelets: dict[int, Lanelet] = {}
    others: dict[int, Lanelet] = {}
    seen = set()
    for element in root.children:
        if element.tag not in ("node", "way", "relation") or element.get("action") == "delete":
            continue
        id, tags = _id(element, "id"), _tags(element)
        if element.children and len(tags) < (count := sum(child.tag == "tag" for child in element.children)):
            keys = [child.get("k") for child in element.all("tag")]
            tags_twice += [(element.tag, id, key) for key in tags if keys.count(key) > 1][:count]
        if (element.tag, id) in seen:
            twice.append((element.tag, id, element.line))
            continue
        seen.add((element.tag, id))
        if element.tag == "node":
            ids.append(id)
            # maps in local coordinates leave latitude and longitude out, or empty
            lon, lat = (element.number(name, np.nan) if element.get(name) else np.nan for name in ("lon", "lat"))
            places.append((lon, lat, _tag_number(tags, "ele", element)))
            local.append((_tag_number(tags, "local_x", element), _tag_number(tags, "local_y", element)))
        elif element.tag == "way":
            ways[id] = Way(id, [_id(child, "ref") for child in element.all("nd")], tags, element.line)
        else:
            members: dict[str, list[tuple[str, int]]] = {}
            for child in element.all("member"):
                members.setdefault(child.get("role"), []).append((child.get("type"), _id(child, "ref")))
            (lanelets if tags.get("type") == "lanelet" else others)[id] = Lanelet(id, tags, members, element.line)
    places_array = np.array(places, float).reshape(-1, 3)
    _check_degrees(places_array, ids)
    return LaneletMap(np.array(ids, np.int64), places_array[:, :2], places_array[:, 2], np.array(local, float).reshape(-1, 2), ways, lanelets,
                      others, twice, tags_twice)


def _id(element, name):
    text = element.get(name)
    try:
        value = int(text) if len(text) <= 20 else ALL_IDS
    except ValueError:
        value = ALL_IDS
    if not -MAX_ID < value < ALL_IDS:
        raise RoadExtractionError(f"Line {element.line}: {name} of <{element.tag}> is {text[:40]!r}; a whole number of 64 bits is needed.")
    return value if value < MAX_ID else value - ALL_IDS


def _tags(element):
    return {child.get("k"): child.get("v") for child in element.all("tag")}


def _tag_number(tags, name, element):
    """A tag's number, NaN where there is none."""
    if name not in tags:
        return np.nan
    made = XmlElement("tag", None, "", element.line)
    made.attributes[name] = tags[name]
    return made.number(name)


def _check_degrees(places, ids):
    wrong = np.flatnonzero((np.abs(places[:, 0]) > 180) | (np.abs(places[:, 1]) > 90))
    if len(wrong):
        lon, lat = places[wrong[0], :2]
        raise RoadExtractionError(f"Node {ids[wrong[0]]} lies at lon {lon:g}, lat {lat:g}; degrees up to 180 and 90 are needed. "
                                  "Is the map in another CRS?")
