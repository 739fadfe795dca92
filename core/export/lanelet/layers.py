"""The lanelets and lines of a Lanelet2 map as layers like ours."""

from __future__ import annotations

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...driving.layers import Lanes
from ...io.crs import parse_crs
from ..map_crs import LOCAL_CRS, metric_wkt, utm_of
from ..map_layers import MapLayers, MapLine, without_repeats
from .model import LaneletMap, LaneletNetwork

PATTERN_OF_WAY = {"solid": "solid", "dashed": "dashed", "solid_solid": "double-solid",
                  "dashed_dashed": "double-dashed", "solid_dashed": "solid-dashed", "dashed_solid": "dashed-solid"}
EDGE_WAYS = ("curbstone", "road_border", "guard_rail", "wall", "fence")
NO_LAND = 1.0   # degrees from latitude and longitude 0
LANE_TYPE_OF_LANELET = {"bicycle_lane": "bicycle", "emergency_lane": "shoulder", "parking": "parking", "road_shoulder": "shoulder"}


def node_places(whole: LaneletMap, crs: str = "") -> tuple[np.ndarray, str]:
    """The nodes in metres.

    Parameters
    ----------
    whole : LaneletMap
    crs : WKT or EPSG:n to compute them in; "" takes the UTM zone of the map

    Returns
    -------
    places : (N, 3) metres; a height of 0 where a node has none. A map without latitudes, or with all of them about 0, where there is nothing
        but sea, has local coordinates: local_x and local_y, or metres from latitude and longitude 0
    crs : WKT, "" where coordinates are local

    Raises
    ------
    RoadExtractionError
        If the CRS is not in metres, or nodes have neither latitude nor local coordinates.
    """
    from pyproj import Transformer

    known = np.isfinite(whole.degrees).all(1)
    heights = np.nan_to_num(whole.heights)
    at_sea = known.any() and np.abs(whole.degrees[known]).max() < NO_LAND
    if not known.all() or at_sea:
        if np.isfinite(whole.local).all():
            return np.c_[whole.local, heights], ""
        if not known.all():
            raise RoadExtractionError(f"Node {whole.node_ids[~known][0]} has neither lat and lon nor local_x and local_y. Export the map with them.")
        if not crs:
            x, y = Transformer.from_crs("EPSG:4326", LOCAL_CRS, always_xy=True).transform(*whole.degrees.T)
            return np.c_[x, y, heights], ""
    target = metric_wkt(crs, "The chosen CRS") if crs else utm_of(*whole.degrees.mean(0))
    x, y = Transformer.from_crs("EPSG:4326", parse_crs(target), always_xy=True).transform(*whole.degrees.T)
    places = np.c_[x, y, heights]
    if not np.isfinite(places).all():
        raise RoadExtractionError("The map does not lie where the chosen CRS holds. Choose the CRS of its country, or leave it empty.")
    return places, target


def layers_of_lanelets(whole: LaneletMap, crs: str = "", progress: Progress = Progress()) -> MapLayers:
    """Lanes, painted borders and edges of a map.

    Parameters
    ----------
    whole : LaneletMap
    crs : WKT or EPSG:n of the layers; "" takes the UTM zone of the map
    progress : told of the share of the lanelets

    Returns
    -------
    MapLayers. `lane_id` of a lane is the lanelet's id; footways are left out; a way of the type of a line is a marking line, curbs and
    borders of the road are edges

    Raises
    ------
    RoadExtractionError
        As `node_places`.
    """
    places, crs = node_places(whole, crs)
    network, rows = LaneletNetwork(whole, places), []
    shown = [id for id in network.left if network.driven(id)]
    for count, id in enumerate(shown):
        lanelet = whole.lanelets[id]
        left, right = matched(places[network.left[id]], places[network.right[id]])
        turned = {"left": network.reversed_left[id], "right": network.reversed_right[id]}
        kinds, patterns = zip(*(_border(whole.ways[lanelet.way(role) or 0].tags, turned[role]) for role in turned))
        rows.append(dict(
            left=left, right=right, road=1, lane=count + 1, lane_id=str(id), direction=1,
            type=LANE_TYPE_OF_LANELET.get(lanelet.tags.get("subtype", ""), "driving"),
            left_kind=kinds[0], right_kind=kinds[1], left_pattern=patterns[0], right_pattern=patterns[1],
            successors=[str(other) for other in network.following(id) if network.driven(other)]))
        progress.report((count + 1) / len(shown))
    found = MapLayers(Lanes.of_pieces(rows, crs))
    for way in whole.ways.values():
        points = without_repeats(places[whole.rows(way)]) if len(whole.rows(way)) > 1 else np.empty((0, 3))
        kind = way.tags.get("type", "")
        if len(points) > 1 and (kind in ("line_thin", "line_thick") or kind in EDGE_WAYS):
            pattern = PATTERN_OF_WAY.get(way.tags.get("subtype", ""), "")
            found.lines.append(MapLine(1, "edge" if kind in EDGE_WAYS else "marking", "lane", pattern, points,
                                       edge="curb" if kind == "curbstone" else "pavement"))
    if not crs:
        found.notes.append("The map has local coordinates: its place on the earth is not known, and the layers have no CRS.")
    left_out = len(whole.lanelets) - len(network.left)
    if left_out:
        found.notes.append(f"{left_out} lanelets lack a border or its nodes and were left out.")
    if len(whole.heights) and not np.isfinite(whole.heights).all():
        found.notes.append(f"{int((~np.isfinite(whole.heights)).sum())} nodes have no height (ele); theirs is 0.")
    return found


def matched(left: np.ndarray, right: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two borders with vertices at the same shares of their lengths, so that each has those of both."""
    shares = []
    for border in (left, right):
        along = np.append(0.0, np.cumsum(np.hypot(*np.diff(border[:, :2], axis=0).T)))
        shares.append(along / along[-1] if along[-1] > 0 else np.linspace(0, 1, len(border)))
    every = np.unique(np.concatenate(shares))
    every = every[np.append(True, np.diff(every) > 1e-9)]
    every[-1] = 1.0
    return tuple(np.stack([np.interp(every, share, values) for values in border.T], axis=1)     # type: ignore[return-value]
                 for border, share in zip((left, right), shares))


def _border(tags, turned):
    """(kind, pattern) of a way, seen in the direction of travel."""
    named = tags.get("type", "")
    kind = {"curbstone": "curb", "road_border": "pavement"}.get(named, "edge" if named in EDGE_WAYS else "lane")
    pattern = PATTERN_OF_WAY.get(tags.get("subtype", ""), "") if tags.get("type") in ("line_thin", "line_thick") else ""
    return kind, "-".join(pattern.split("-")[::-1]) if turned and "-" in pattern and not pattern.startswith("double") else pattern
