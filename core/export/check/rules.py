"""Tags of a Lanelet2 map, and its rules of traffic and areas, held against what the format knows.

References
----------
Lanelet2, documents LaneletAndAreaTagging, LinestringTagging and RegulatoryElementTagging; Autoware's extensions of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import numpy as np

from ..lanelet.model import Lanelet, LaneletMap, Way
from .findings import Findings

YES_OR_NO = ("yes", "no", "true", "false", "1", "0")
NO_BORDERS = ("stop_line", "traffic_sign", "traffic_light", "light_bulbs", "arrow", "symbol", "pole", "post", "centerline", "trajectory", "building")
VEHICLES = ("bus", "car", "car:electric", "car:combustion", "truck", "motorcycle", "taxi", "emergency")
KNOWN_PARTICIPANTS = ("vehicle", *(f"vehicle:{kind}" for kind in VEHICLES), "bicycle", "pedestrian", "train")
# kind of a rule -> roles of which it needs at least one member; tags of which one does as well
RULES = {
    "traffic_light": (("refers",), ()), "traffic_sign": (("refers",), ()), "speed_limit": (("refers",), ("sign_type",)),
    "right_of_way": (("right_of_way", "yield"), ()), "all_way_stop": (("yield",), ()), "crosswalk": (("refers",), ()),
    "no_stopping_area": (("refers",), ()), "no_parking_area": (("refers",), ()), "detection_area": (("refers",), ()),
    "road_marking": (("refers",), ()), "speed_bump": (("refers",), ()), "virtual_traffic_light": (("refers",), ()),
    "bus_stop_area": (("refers",), ()), "roundabout": ((), ()),
}
RULE_ROLES = ("refers", "ref_line", "cancels", "cancel_line", "right_of_way", "yield", "light_bulbs", "crosswalk_polygon", "start_line", "end_line",
         "lanelet", "")


def way_tags(way: Way) -> Iterator[str]:
    """Sentences on tags of a way whose values no reader knows."""
    for key, value in way.tags.items():
        if key == "lane_change" or key.startswith("lane_change:"):
            if value not in YES_OR_NO:
                yield f"{key} is {value!r}."
        elif key in ("width", "height") and not _is_length(value):
            yield f"{key} is {value!r}."


def participant_tags(tags: Mapping[str, str], walked: bool) -> Iterator[str]:
    """Sentences on who may use a lanelet; `walked`: whether it is made for those on foot."""
    found = {key[len("participant:"):]: value for key, value in tags.items() if key.startswith("participant:")}
    for name, value in found.items():
        if name not in KNOWN_PARTICIPANTS:
            yield f"The participant {name!r} is not known."
        if value not in YES_OR_NO:
            yield f"participant:{name} is {value!r}."
        if walked and name.startswith("vehicle") and name != "vehicle:emergency" and value in ("yes", "true", "1"):
            yield f"Its subtype is {tags.get('subtype')!r}, and vehicles may use it."
    if found and not walked and all(value in ("no", "false", "0") for value in found.values()):
        yield "Nobody may use it."


def add_rule_findings(whole: LaneletMap, findings: Findings, place: Callable[[Lanelet], np.ndarray]) -> None:
    """Add what is wrong with relations that are no lanelets: rules of traffic, areas, and lanelets whose type is misspelt."""
    used = {id for lanelet in (*whole.lanelets.values(), *whole.others.values()) for kind, id in lanelet.members.get("regulatory_element", ())
            if kind == "relation"}
    for relation in whole.others.values():
        name, kind = f"relation {relation.id}", relation.tags.get("type", "")
        if kind == "regulatory_element":
            for text in _rule(relation, relation.id in used):
                findings.add("regulatory element", name, text, place(relation))
        elif kind == "multipolygon":
            if not _closed(whole, relation):
                findings.add("open area", name, "The ways of its outline do not come back to where they begin.", place(relation))
        elif "left" in relation.members and "right" in relation.members:
            findings.add("lanelet tag", name, f"It has borders left and right, but its type is {kind!r}.", place(relation))


def _rule(relation, used):
    subtype = relation.tags.get("subtype", "")
    if subtype not in RULES:
        yield f"The subtype is {subtype!r}."
        return
    roles, tags = RULES[subtype]
    if roles and not any(relation.members.get(role) for role in roles) and not any(tag in relation.tags for tag in tags):
        yield f"A {subtype} needs {' or '.join((*(f'a member {role}' for role in roles), *(f'a tag {tag}' for tag in tags)))}."
    for role in relation.members:
        if role not in RULE_ROLES:
            yield f"The role {role!r} is not known."
    if not used:
        yield "No lanelet obeys it."


def _closed(whole, relation):
    """Whether the outer ways of an area, in any order and direction, make rings."""
    ends: dict[int, int] = {}
    for kind, id in relation.members.get("outer", ()):
        way = whole.ways.get(id) if kind == "way" else None
        if way is not None and way.nodes:
            for node in (way.nodes[0], way.nodes[-1]):
                ends[node] = ends.get(node, 0) + 1
    return bool(ends) and all(count % 2 == 0 for count in ends.values())


def _is_length(text):
    try:
        return 0 <= float(text.removesuffix("m").strip()) < 1000
    except ValueError:
        return False
