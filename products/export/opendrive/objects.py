"""What stands beside the lanes of a road or is painted on them: signals, poles, crossings, stop lines and figures, from and to the layers."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from typing import Any

import numpy as np
import shapely

from ....core.common.features import SIGNALS, Features
from ..sources import STOP_LINE_HALF, stop_lines, walked_crossings, wrapped
from .model import DRIVEN_TYPES, OpenDriveMap

SAMPLES = 1.0          # m between places of reference lines that objects are held against
FARTHEST = 25.0        # m from a reference line
SIMPLER = 0.02         # m by which an outline may be straightened
THINNEST = 0.01        # m of an object's length and width at the least: the format has none of 0
LANE_ID = "lanewright:lane_id"   # userData of a lane: its piece of the layer
NAME_OF_CLASS = {"hatch": "hatched area", "arrow": "arrow", "bicycle": "bicycle symbol", "bus": "word BUS"}
CLASS_OF_NAME = {"zebra": "crosswalk", "crosswalk": "crosswalk", "stopline": "stop_line", "stop line": "stop_line",
                 **{name: kind for kind, name in NAME_OF_CLASS.items()}}
POLES = ("pole", "streetLamp", "post", "guide-post")
LIGHTS = ("1000001", "1000002", "1000007", "1000008", "1000009", "1000010", "1000011", "1000012", "1000013")   # of the standard's own catalogue
FIELD_OF = {"type": "code", "subtype": "subcode", "country": "country", "unit": "unit", "name": "text"}   # attribute of a signal -> field


def outlines_of(whole: OpenDriveMap) -> Iterator[tuple[str, np.ndarray]]:
    """(class as in MARKINGS, (N, 3) corners in map coordinates) of everything that is painted."""
    for road in whole.roads:
        for item in road.objects:
            kind = _class_of(item)
            corners = _corners(road, item) if kind else np.empty((0, 3))
            if len(corners) > 2 and shapely.Polygon(corners).area > THINNEST**2:
                yield kind, whole.placed(corners)


def signals_of(whole: OpenDriveMap, crs: str = "") -> Features:
    """The layer SIGNALS: signals with the lanes that they hold for, on their own road and by reference, and poles."""
    layer = Features("PointZ", SIGNALS, crs=crs)
    lanes: dict[str | int, list[str]] = defaultdict(list)
    for road in whole.roads:
        for item in road.signals:   # those without an id are not one signal
            lanes[item["id"] or id(item)] += _lanes_obeying(road, item)
    for road in whole.roads:
        for item in road.signals:
            if item["own"]:
                values = {field: item[name] for name, field in FIELD_OF.items() if item[name] not in ("", "-1", "none")}
                kind = "traffic_light" if item["type"] in LIGHTS or item["dynamic"] == "yes" else "sign"
                turned = np.pi * (item["orientation"] == "-") + item["hOffset"] + whole.offset[3]
                layer.add(_point(whole, road, item), kind=kind, value=item["value"] if item["value"] >= 0 else np.nan, **values,
                          lanes=",".join(dict.fromkeys(lanes[item["id"] or id(item)])), heading=_heading(road, item, turned), **_size(item))
        for item in road.objects:
            if item["type"] in POLES:
                layer.add(_point(whole, road, item), kind="pole", **_size(item))
    return layer


def left_out_of(whole: OpenDriveMap) -> Counter[str]:
    """How often a map has what no layer of ours holds."""
    count = Counter(item["type"] if item["type"] not in ("", "-1") else "object of no type" for road in whole.roads for item in road.objects
                    if not _class_of(item) and item["type"] not in POLES)
    for element in whole.tree.children if whole.tree is not None else ():
        count += Counter(inner.tag for inner in (element, *element.children) if inner.tag in ("controller", "junctionGroup", "station", "railroad"))
        count += Counter(inner.tag for objects in element.all("objects") for inner in objects.children if inner.tag in ("tunnel", "bridge"))
    return count


def _class_of(item):
    name = str(item["name"]).lower()
    painted = item["type"] in ("roadMark", "crosswalk", "-1", "none", "")
    known = next((kind for words, kind in CLASS_OF_NAME.items() if painted and words.lower() in name), "")
    return known or ("crosswalk" if item["type"] == "crosswalk" else "stop_line" if item["subtype"] == "signalLines" else "")


def _corners(road, item):
    """(N, 3) corners of an object in the coordinates of the file: of its outline, else of the rectangle of its length and width."""
    s, t, corners = item["s"], item["t"], item["corners"]
    if len(corners) and not item["local"]:
        place, heading, _ = road.plan.at(corners[:, 0])
        return np.c_[place + corners[:, 1:2] * np.c_[-np.sin(heading), np.cos(heading)], corners[:, 2] + road.elevation.at(corners[:, 0])]
    if not len(corners):
        corners = np.array([[u, v, 0.0] for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]) * [item["length"] / 2, item["width"] / 2, 0.0]
    place, (heading,), _ = road.plan.at(np.array([s]))
    turned, n = heading + item["hdg"], np.array([-np.sin(heading), np.cos(heading)])
    way = np.array([[np.cos(turned), np.sin(turned)], [-np.sin(turned), np.cos(turned)]])
    return np.c_[place + t * n + corners[:, :2] @ way, corners[:, 2] + item["zOffset"] + road.elevation.at(np.array([s]))]


def _point(whole, road, item):
    s = np.array([np.clip(item["s"], 0.0, road.length)])
    return shapely.Point(whole.placed(road.surface.places(s, np.array([item["t"]]), item["zOffset"]))[0])


def _size(item):
    return {name + "_m": item[name] or np.nan for name in ("height", "width")}


def _heading(road, item, turned):
    """Degrees clockwise from north of the road at an object, turned by radians."""
    return float((90 - np.degrees(road.plan.at(np.array([item["s"]]))[1][0] + turned)) % 360)


def _section_at(road, s):
    """(number, lanes) of the section at s, with its lanes that are driven."""
    number = max((k for k, section in enumerate(road.sections) if section.s <= s), default=0)
    lanes = road.sections[number].lanes if road.sections else {}
    return number, {id: lane for id, lane in lanes.items() if id and lane.type in DRIVEN_TYPES}


def _sign(road, id):
    """The orientation of what the traffic of a lane sees."""
    return "+" if road.way_out(id) == "end" else "-"


def _lanes_obeying(road, item):
    """The lane_ids of the driven lanes that a signal or a reference to one holds for: the validity, where no lane of it is driven so."""
    number, lanes = _section_at(road, item["s"])
    named = [id for id in lanes if not item["validity"] or any(min(pair) <= id <= max(pair) for pair in item["validity"])]
    same_way = [id for id in named if item["orientation"] not in ("+", "-") or item["orientation"] == _sign(road, id)]
    return [road.lane_name(id, number) for id in same_way or named * bool(item["validity"])]


# From the layers to the roads.

def add_objects(whole: OpenDriveMap, markings: Features | None, signals: Features | None, origin: np.ndarray) -> None:
    """Give the roads what lies or stands beside them, of MARKINGS and SIGNALS in map coordinates; `origin` is the file's false origin, (3,) m."""
    shapes, signals = list(_painted_shapes(markings)), list(signals or ())
    if not shapes and not signals:
        return
    roads = [road for road in whole.roads if road.junction == "-1"] or whole.roads
    nearest = _nearest(roads)
    for number, (kind, name, corners) in enumerate(shapes):
        local = corners - origin
        if (place := nearest(local[:, :2].mean(0))) is not None:
            place[0].objects.append(_object(number, kind, name, local, *place))
    homes = defaultdict(list)
    for road in whole.roads:
        for section in road.sections:
            for id, lane in section.lanes.items():
                homes[lane.data.get(LANE_ID)].append((road, id))
    for number, (point, row) in enumerate(signals, start=len(shapes)):
        _add_signal(number, shapely.get_coordinates(point, include_z=True)[0] - origin, row, homes, nearest)


def _add_signal(number, place, row, homes, nearest):
    """A signal on the road of its lanes that is nearest, with references to it on the others; a pole on the nearest of all; nothing else."""
    if row.get("kind") not in ("traffic_light", "sign", "pole"):
        return
    names = [name.strip() for name in str(row.get("lanes") or "").split(",")]
    near = [min((_nearest([road])(place[:2], np.inf) for road, _ in homes[name]), key=lambda one: one[2]) for name in names if name in homes]
    roads = {place_on_road[0].id: place_on_road for place_on_road in sorted(near, key=lambda one: one[2])}
    place_on_road = next(iter(roads.values()), None) or nearest(place[:2])
    if place_on_road is None:
        return
    for road, s_near, _ in list(roads.values()) or [place_on_road]:
        (s,), (t,) = road.plan.feet(place[None, :2], np.array([s_near]))
        s, t = float(np.clip(s, 0.0, road.length)), float(t)
        level = road.surface.places(np.array([s]), np.array([t]))[0, 2]
        item = {"id": str(number), "s": s, "t": t, "zOffset": round(float(place[2] - level), 4)}
        if row.get("kind") == "pole":
            width = row.get("width_m") or 10 * THINNEST
            road.objects.append({**_object_of(item, "pole", "pole"), "length": width, "width": width, "height": row.get("height_m") or 0.0})
        else:
            obeying = {id for name in names for home, id in homes.get(name, ()) if home is road}
            road.signals.append({**_signal(road, s, row, obeying), **item, "own": road is place_on_road[0]})


def _signal(road, s, row, obeying):
    """What a signal says, and of which lanes of its road; `obeying`: numbers of lanes anywhere on the road."""
    ids = [id for id in _section_at(road, s)[1] if id in obeying] or sorted(obeying)
    ways = {_sign(road, id) for id in ids} or {"-" if abs(_turned(road, s, row, "+")) > np.pi / 2 else "+"}
    way = min(ways) if len(ways) == 1 else "none"
    return {**{name: row.get(field) or "" for name, field in FIELD_OF.items()}, "value": row.get("value"), "height": row.get("height_m"),
            "width": row.get("width_m"), "dynamic": "yes" if row.get("kind") == "traffic_light" else "no", "orientation": way,
            "hOffset": _turned(road, s, row, way), "validity": [(id, id) for id in sorted(ids)]}


def _turned(road, s, row, way):
    """Radians by which the face of a signal is turned away from the traffic of its road, of an orientation."""
    if row.get("heading") is None or way == "none":
        return 0.0
    away = np.radians(_heading(road, {"s": s}, np.pi * (way == "-")) - row["heading"])
    return round(float(wrapped(away)), 6)


def _painted_shapes(markings):
    """(kind, name, (N, 3) corners) of every object."""
    for left, right in walked_crossings(markings):
        yield "crosswalk", "zebra crossing", np.concatenate([left, right[::-1]])
    for line in stop_lines(markings):
        way = line[1] - line[0]
        across = np.array([-way[1], way[0], 0.0]) / max(float(np.hypot(*way[:2])), 1e-6) * STOP_LINE_HALF
        yield "roadMark", "stop line", np.array([line[0] - across, line[1] - across, line[1] + across, line[0] + across])
    for geometry, row in markings if markings is not None else ():
        label = next((name for start, name in NAME_OF_CLASS.items() if str(row.get("class")).startswith(start)), "")
        for part in shapely.get_parts(geometry) if label and geometry is not None and not geometry.is_empty else ():
            yield "roadMark", label, shapely.get_coordinates(shapely.simplify(part, SIMPLER).exterior, include_z=True)[:-1]


def _nearest(roads):
    """A function that finds (road, s, metres) of the reference line nearest to a place, None where none lies within metres."""
    stations = [np.linspace(0, road.plan.length, max(int(road.plan.length / SAMPLES), 1) + 1) for road in roads]
    tree = shapely.STRtree(shapely.points(np.concatenate([road.plan.at(s)[0] for road, s in zip(roads, stations)])))
    owner, station = np.repeat(np.arange(len(roads)), [len(s) for s in stations]), np.concatenate(stations)

    def found(place, farthest=FARTHEST):
        near, distance = tree.query_nearest(shapely.Point(place), return_distance=True, all_matches=False)
        return (roads[owner[near[0]]], float(station[near[0]]), float(distance[0])) if len(near) and distance[0] <= farthest else None

    return found


def _object(number, kind, name, corners, road, near, _):
    """The attributes of an object; its outline is told along the road, or beside its own place where it reaches beyond the road's end."""
    s, t = road.plan.feet(corners[:, :2], np.full(len(corners), near))
    station, aside = float(np.clip(s.mean(), 0.0, road.length)), float(t.mean())
    local = bool(s.min() < 0.0 or s.max() > road.length)
    if local:
        (place,), (heading,), _ = road.plan.at(np.array([station]))
        way = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
        u, v = ((corners[:, :2] - place) @ way).T
        outline = np.c_[u, v - aside, corners[:, 2] - road.elevation.at(station)]
    else:
        outline = np.c_[s, t, corners[:, 2] - road.elevation.at(s)]
    outline[:, 2] = np.round(outline[:, 2], 4)
    length, width = (max(float(size), THINNEST) for size in np.ptp(outline[:, :2], axis=0))
    return {**_object_of({"id": str(number), "s": station, "t": aside, "zOffset": 0.0}, kind, name), "length": length, "width": width,
            "height": 0.0, "corners": outline, "local": local}


def _object_of(item: dict[str, Any], kind: str, name: str) -> dict[str, Any]:
    """What every object has."""
    return {**item, "type": kind, "subtype": "", "name": name, "orientation": "none", "hdg": 0.0, "corners": np.empty((0, 3)), "local": False}
