"""What OpenStreetMap says of roads, given to the lanes of a road map that lie along its ways."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from ...core.common.errors import RoadExtractionError
from ...core.common.progress import Progress
from ...core.common.setting import Limited, setting
from ...core.driving.layers import Lanes
from ...core.lazy import pyproj
from ..assess.matching import sample_lines
from .lanelet_map import kmh
from .sources import without_repeats
from .xml_tree import read_xml

NO_ROADS = ("footway", "path", "steps", "pedestrian", "cycleway", "bridleway", "corridor", "platform", "proposed", "construction", "elevator")
ONE_WAY = {"yes": "yes", "1": "yes", "true": "yes", "-1": "yes", "reverse": "yes", "no": "no", "0": "no", "false": "no"}


@dataclass(frozen=True)
class AttributeSettings(Limited):
    """corridor : metres either side of a way; step : metres between the places of a lane; turn : radians between lane and way at the most."""

    corridor: float = setting(12.0, 1.0, 100.0, "Corridor", "m")
    step: float = 2.0
    turn: float = 0.5


Ways = list[tuple[np.ndarray, Mapping[str, Any]]]   # lines of roads, (N, 2) places, and their tags


def read_osm_ways(path: str, crs: str, progress: Progress = Progress()) -> Ways:
    """The ways with a tag highway of a file in the XML of OpenStreetMap, in a CRS (WKT).

    Raises RoadExtractionError if the file is none of that kind, or has no road.
    """
    root = read_xml(path, "osm", "a file in the XML of OpenStreetMap", progress)
    degrees = {node.get("id"): (node.number("lon"), node.number("lat")) for node in root.all("node") if node.get("lat")}
    ways: Ways = []
    for way in root.all("way"):
        tags = {tag.get("k"): tag.get("v") for tag in way.all("tag")}
        places = [degrees[child.get("ref")] for child in way.all("nd") if child.get("ref") in degrees]
        if len(places) > 1 and tags.get("highway"):
            ways.append((np.array(places), tags))
    if not ways:
        raise RoadExtractionError(f"{path} has no way with a tag highway. Choose an extract of OpenStreetMap that holds the roads.")
    return ways_in(ways, "EPSG:4326", crs)


def ways_in(ways: Ways, stored: str, crs: str) -> Ways:
    """Ways with tags or fields from the CRS `stored` in that of the lanes (WKT), in metres; what is for walking is left out.

    The field other_tags, as GDAL writes it, is read too.
    """
    transformer = pyproj.Transformer.from_crs(stored, crs, always_xy=True)
    roads: Ways = []
    for line, fields in ways:
        tags = dict(re.findall(r'"([^"]+)"=>"([^"]*)"', str(fields.get("other_tags") or "")))
        tags |= {name.lower(): str(value).strip() for name, value in fields.items() if value not in (None, "")}
        places = np.c_[transformer.transform(line[:, 0], line[:, 1])]
        if tags.get("highway") not in NO_ROADS and np.isfinite(places).all() and len(places := without_repeats(places)) > 1:
            roads.append((places, tags))
    return roads


def attributes_along(lanes: Lanes, ways: Ways, settings: AttributeSettings = AttributeSettings()) -> dict[str, dict[str, Any]]:
    """lane_id -> what is known of ROAD_ATTRIBUTES of lanes most of whose length lies along ways that say it.

    At each of its places a lane belongs to the nearest way within the corridor that runs as the lane does, of one-way roads in the direction of
    travel. A value that holds along more than half of the lane is the lane's.

    lanes : Lanes in map coordinates
    ways : in the same CRS
    """
    middles = [without_repeats(sum(lanes.borders(k))[:, :2] / 2) for k in range(len(lanes))]
    drawn = np.flatnonzero([len(middle) > 1 for middle in middles])
    points = sample_lines([shapely.linestrings(middles[k]) for k in drawn], settings.step)
    places, heading, owner = points.xy, points.heading, drawn[points.line]
    starts = np.concatenate([np.empty((0, 2)), *(line[:-1] for line, _ in ways)])
    ends = np.concatenate([np.empty((0, 2)), *(line[1:] for line, _ in ways)])
    of_way = np.repeat(np.arange(len(ways)), [len(line) - 1 for line, _ in ways])
    tree = shapely.STRtree(shapely.linestrings(np.stack([starts, ends], axis=1)))
    place, segment = tree.query(shapely.points(places), predicate="dwithin", distance=settings.corridor)
    run = ends[segment] - starts[segment]
    cosine = (np.c_[np.cos(heading), np.sin(heading)][place] * run).sum(1) / np.hypot(*run.T)
    allowed = np.array([_way_allowed(tags) for _, tags in ways], int)[of_way[segment]] if len(ways) else np.empty(0, int)
    driven = (lanes.direction[owner[place]] != 0) & np.isin(lanes.type[owner[place]], ("driving", "connector"))
    good = (np.abs(cosine) > np.cos(settings.turn)) & (~driven | (allowed * cosine >= 0))
    place, segment, cosine = place[good], segment[good], cosine[good]
    distance = shapely.distance(tree.geometries[segment], shapely.points(places[place]))
    order = np.lexsort((distance, place))
    _, first = np.unique(place[order], return_index=True)
    votes: dict[int, dict[str, Counter]] = defaultdict(lambda: defaultdict(Counter))
    for row in order[first]:
        for name, value in _said(ways[of_way[segment[row]]][1], cosine[row] > 0).items():
            votes[int(owner[place[row]])][name][value] += 1
    counts = np.bincount(owner, minlength=len(lanes))
    return {str(lanes.lane_id[k]): known for k, of_lane in votes.items()
            if (known := {name: value for name, count in of_lane.items() for value, number in count.most_common(1) if 2 * number > counts[k]})}


def _way_allowed(tags):
    """1 or -1 where a way is driven along it or against it alone, else 0."""
    text = tags.get("oneway", "yes" if tags.get("junction") in ("roundabout", "circular") else "").lower()
    return (-1 if text in ("-1", "reverse") else 1) * (ONE_WAY.get(text) == "yes")


def _said(tags, along):
    """What a way says of lanes that are driven along it, or against it."""
    speed = next((limit for name in (f"maxspeed:{'forward' if along else 'backward'}", "maxspeed") if (limit := kmh(tags.get(name, "")))), None)
    lanes = tags.get("lanes", "")
    attributes = {"speed_kmh": speed, "name": tags.get("name"), "ref": tags.get("ref"), "surface": tags.get("surface"),
            "lanes": int(lanes) if lanes.isdecimal() else None, "oneway": ONE_WAY.get(tags.get("oneway", "").lower())}
    return {name: value for name, value in attributes.items() if value}
