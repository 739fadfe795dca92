"""Drives along every lane of the maps of make_files.py by CARLA's map library, without its server: drive_maps.py FOLDER.

Its y runs the other way, and it takes no geoReference but that of its own towns, which it says in a warning.
"""

import json
import sys
from pathlib import Path

import carla
import numpy as np
import shapely

MIDDLES_APART = 0.02    # m between the middles of lanes
LENGTH_LOST = 0.6       # m at the end of a lane that its steps do not reach
STEP = 0.5              # m from place to place
FROM_END = 0.02         # m from the end of a lane where it begins to be driven, and where it is left
SHORTEST_LANE = 0.2     # m: shorter ones are stepped over
HALF_LANE = 1.75        # m beside the middle of a lane within which a drive is on it
ROUTE_STEP = 2.0        # m from place to place on the way to another arm


def drive(whole, lane):
    """(largest distance of its places from our middle, metres driven, the lanes that follow) of one lane; None where it has no such lane."""
    start, end = (lane["s"][0] + FROM_END, lane["s"][-1] - FROM_END)[::lane["way"]]
    first, last = (whole.get_waypoint_xodr(lane["road"], lane["lane"], s) for s in (start, end))
    if first is None or last is None:
        return None
    places = [first]
    # the library's own walk to the end of a lane stops the process where a lane ends before its road
    while further := [place for place in places[-1].next(STEP)
                      if (place.road_id, place.section_id, place.lane_id) == (first.road_id, first.section_id, first.lane_id)]:
        places.append(further[0])
    places.append(last)
    line = shapely.LineString(np.array(lane["middle"])[:, :2])
    at = np.array([[place.transform.location.x, -place.transform.location.y] for place in places])
    apart = shapely.distance(shapely.points(at), line)
    along = shapely.line_locate_point(line, shapely.points(at))
    following = {(place.road_id, place.lane_id) for place in last.next(2 * FROM_END) if place.s != last.s or place.road_id != last.road_id}
    return float(apart.max()), float(np.ptp(along)), following


def is_led_to(whole, starts, ends, lanes):
    """Whether a drive from one of some places, (x, y) each, can come to one of others along the lanes that follow each other."""
    goals = {(lane["road"], lane["lane"]) for end in ends for lane in lanes_at(lanes, end)}
    places = [place for start in starts for lane in lanes_at(lanes, start)
              if (place := whole.get_waypoint_xodr(lane["road"], lane["lane"], station(lane, start))) is not None]
    seen = set()
    while places:
        place = places.pop()
        if (place.road_id, place.lane_id) in goals:
            return True
        here = place.road_id, place.section_id, place.lane_id, round(place.s / ROUTE_STEP)
        if here not in seen:
            seen.add(here)
            places += place.next(ROUTE_STEP)
    return False


def lanes_at(lanes, place):
    """Those that the middle of passes a place within half of their width."""
    point = shapely.Point(place)
    return [lane for lane in lanes if shapely.LineString(np.array(lane["middle"])[:, :2]).distance(point) < HALF_LANE]


def station(lane, place):
    """Metres along the road at a place beside the middle of a lane."""
    line = shapely.LineString(np.array(lane["middle"])[:, :2])
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(np.array(lane["middle"])[:, :2], axis=0).T)))
    s = float(np.interp(line.project(shapely.Point(place)), along, lane["s"]))
    return min(max(s, lane["s"][0] + FROM_END), lane["s"][-1] - FROM_END)


def main():
    folder, failed = Path(sys.argv[1]), []
    for file in sorted(folder.glob("*.json")):
        name, expected = file.stem, json.loads(file.read_text(encoding="utf-8"))
        lanes = expected["driven"]
        whole = carla.Map(name, (folder / f"{name}_1.7.xodr").read_text(encoding="utf-8"))
        worst, metres, links = 0.0, 0.0, 0
        for lane in lanes:
            what, length = f"{name}: road {lane['road']}, lane {lane['lane']}", lane["s"][-1] - lane["s"][0]
            if length < SHORTEST_LANE:
                continue
            found = drive(whole, lane)
            if found is None:
                failed.append(f"{what} is not there")
                continue
            apart, driven, following = found
            worst, metres, links = max(worst, apart), metres + driven, links + len(following)
            if apart > MIDDLES_APART:
                failed.append(f"{what}: its middle lies {apart:.3f} m beside ours")
            if driven < shapely.LineString(np.array(lane["middle"])[:, :2]).length - LENGTH_LOST:
                failed.append(f"{what}: {driven:.2f} m of it are driven")
            if following != {tuple(other) for other in lane["following"]}:
                failed.append(f"{what} leads to {sorted(following)}, ours to {lane['following']}")
        routes = [is_led_to(whole, start, end, lanes) for start, end in expected["ways"]]
        failed += [f"{name}: no route from {start} to {end}" for (start, end), there in zip(expected["ways"], routes) if not there]
        print(f"{name}: carla drives along {len(lanes)} lanes, {metres:.0f} m, {links} links; middles within {1000 * worst:.1f} mm of ours; "
              f"{sum(routes)} of {len(routes)} routes", flush=True)
    sys.exit("\n".join(["These differ:", *failed]) if failed else 0)


if __name__ == "__main__":
    main()
