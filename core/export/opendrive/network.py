"""Which lane follows which on a map of OpenDRIVE."""

from __future__ import annotations

from collections import defaultdict

from .model import DRIVEN_TYPES, Connection, MapLane, MapRoad, OpenDriveMap

LaneKey = tuple[str, int, int]   # road, number of the section, lane


class LaneNetwork:
    """Looks up what lanes touch. Ends of a lane are "start" and "end", along the road's reference line."""

    def __init__(self, whole: OpenDriveMap) -> None:
        self.roads = {road.id: road for road in whole.roads}
        self.junctions = {junction.id for junction in whole.junctions}
        self.connections: dict[tuple[str, str], list[Connection]] = defaultdict(list)
        for junction in whole.junctions:
            for connection in junction.connections:
                self.connections[junction.id, connection.incoming].append(connection)

    def lane(self, key: LaneKey) -> MapLane | None:
        """The lane of a key, None where there is none."""
        road = self.roads.get(key[0])
        if road is None or not 0 <= key[1] < len(road.sections):
            return None
        return road.sections[key[1]].lanes.get(key[2])

    def touching(self, key: LaneKey, end: str) -> list[tuple[LaneKey, str]]:
        """(lane, which of its ends) of all lanes that a lane's end is linked to, whether they exist or not."""
        road, lane = self.roads[key[0]], self.lane(key)
        numbers = [] if lane is None else lane.successors if end == "end" else lane.predecessors
        inside = key[1] + (1 if end == "end" else -1)
        if 0 <= inside < len(road.sections):
            return [((road.id, inside, number), "start" if end == "end" else "end") for number in numbers]
        link = road.link(end)
        if link is None:
            return []
        if link.element != "junction":
            return [(self._at(link.id, link.contact, number), link.contact) for number in numbers]
        return [(self._at(connection.connecting, connection.contact, to), connection.contact)
                for connection in self.connections[link.id, road.id] for start, to in connection.lanes if start == key[2]]

    def _at(self, road: str, contact: str, number: int) -> LaneKey:
        known = self.roads.get(road)
        return road, len(known.sections) - 1 if contact == "end" and known is not None else 0, number

    def touched(self) -> set[tuple[LaneKey, str]]:
        """(lane, which of its ends) of all that any lane is linked to."""
        lanes = [(road.id, number, id) for road in self.roads.values() for number, section in enumerate(road.sections) for id in section.lanes if id]
        return {found for key in lanes for end in ("start", "end") for found in self.touching(key, end)}

    def is_open(self, key: LaneKey, end: str, touched: set[tuple[LaneKey, str]]) -> bool:
        """Whether a driven lane is linked to no driven lane at an end, although its road goes on there.

        touched : as above; roads that leave a junction are named by its connecting roads alone
        """
        road, lane = self.roads[key[0]], self.lane(key)
        if lane is None or lane.type not in DRIVEN_TYPES:
            return False
        touching = self.touching(key, end)
        if any((known := self.lane(other)) is not None and known.type in DRIVEN_TYPES for other, _ in touching):
            return False
        if not touching and (key, end) in touched:
            return False
        link = road.link(end)
        return 0 <= key[1] + (1 if end == "end" else -1) < len(road.sections) or link is not None and (
            link.element == "junction" and link.id in self.junctions or link.id in self.roads)

    def following(self, key: LaneKey) -> list[LaneKey]:
        """The driven lanes that a driven lane leads to, in the direction of travel."""
        end = "end" if travel(self.roads[key[0]], key[2]) > 0 else "start"
        found = []
        for other, there in self.touching(key, end):
            lane = self.lane(other)
            # what ends where ours ends is no way on
            if lane is not None and lane.type in DRIVEN_TYPES and there == ("start" if travel(self.roads[other[0]], other[2]) > 0 else "end"):
                found.append(other)
        return found


def travel(road: MapRoad, id: int) -> int:
    """1 where the lanes of this side are driven along the reference line, -1 where against it."""
    return 1 if (id < 0) == (road.rule != "LHT") else -1
