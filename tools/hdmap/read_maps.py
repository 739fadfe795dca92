"""Reads the maps of make_files.py by other people's libraries: read_maps.py FOLDER. Runs in an environment with pyxodr, lanelet2, ezdxf."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import shapely

TOLERANCE = 0.02         # m between the borders that were exported and those of the map, as its default is
READERS_APART = 0.002    # m between our own reader and pyxodr
END_OF_BORDER = 0.3      # m at the ends of borders, where pyxodr's steps do not reach
# m between the places that pyxodr computes. It counts the metres of a section from the first of them in it, up to a step too late, so that
# the border of a lane that widens lies beside its place by up to a step times how fast it widens, and ends up to a step too early: of a road that is
# not within READERS_APART of ours it is asked again with shorter steps, and of all where a vertex lies farther than TOLERANCE from what it has.
# What the file itself had wrong would stay.
STEPS = (0.02, 0.01, 0.005, 0.0025)


def by_pyxodr(path, expected):
    """(largest distance of pyxodr's borders from ours, of the exported vertices from pyxodr's borders, shortest step) in metres."""
    from pyxodr.road_objects.network import RoadNetwork

    ours = {(road, section, lane): shapely.LineString(points) for road, section, lane, points in expected["borders"]}
    worst, shortest, lines = 0.0, STEPS[0], []
    roads, vertices = RoadNetwork(str(path), resolution=STEPS[0]).get_roads(), shapely.points(np.array(expected["vertices"]))
    for road in roads:
        for step in STEPS:
            apart, borders = _borders_apart(type(road)(road.road_xml, resolution=step), ours)
            shortest = min(shortest, step)
            if apart <= READERS_APART:
                break
        worst, lines = max(worst, apart), lines + borders
    missed = _missed(vertices, lines)
    for step in STEPS[1:]:
        if missed <= TOLERANCE:
            break
        lines = [line for road in roads for line in _borders_apart(type(road)(road.road_xml, resolution=step), ours)[1]]
        missed, shortest = _missed(vertices, lines), min(shortest, step)
    return worst, missed, shortest


def _missed(places, lines):
    return float(shapely.STRtree(lines).query_nearest(places, return_distance=True, all_matches=False)[1].max())


def _borders_apart(road, ours):
    """(largest distance of the borders of one road of pyxodr from ours, the borders)."""
    worst, lines = 0.0, []
    for number, section in enumerate(road.lane_sections):
        for points in (section.get_offset_line(False), *(lane.boundary_line for lane in section.lanes)):
            if len(points) > 1:
                lines.append(shapely.LineString(np.asarray(points)[:, :2]))
        for lane in section.lanes:
            if lane.id == 0:
                continue
            points, own = shapely.points(np.asarray(lane.boundary_line)), ours[str(road.id), number, lane.id]
            inside = shapely.line_locate_point(own, points)
            points = points[(inside > END_OF_BORDER) & (inside < own.length - END_OF_BORDER)]
            worst = max(worst, float(shapely.distance(points, own).max(initial=0.0)))
    return worst, lines


ROUTING = """
import json, sys, lanelet2
from lanelet2.projection import UtmProjector
path, ways = sys.argv[1], json.load(sys.stdin)
lat, lon = float(sys.argv[2]), float(sys.argv[3])
projector = UtmProjector(lanelet2.io.Origin(lat, lon))
loaded, errors = lanelet2.io.loadRobust(path, projector)
rules = lanelet2.traffic_rules.create(lanelet2.traffic_rules.Locations.Germany, lanelet2.traffic_rules.Participants.Vehicle)
graph = lanelet2.routing.RoutingGraph(loaded, rules)
lanelets = list(loaded.laneletLayer)
driven = [one for one in lanelets if rules.canPass(one)]

def on(places):
    found = []
    for place in places:
        point = projector.forward(lanelet2.core.GPSPoint(*place, 0.0))
        near = lanelet2.geometry.findNearest(loaded.laneletLayer, lanelet2.core.BasicPoint2d(point.x, point.y), 20)
        found += [one for distance, one in near if distance < 0.01 and rules.canPass(one)]
    return found

routes = [any(graph.getRoute(a, b) is not None for a in on(start) for b in on(end)) for start, end in ways]
print(json.dumps({"errors": list(errors), "lanelets": len(lanelets), "passable": len(driven),
                  "successors": sum(len(graph.following(one)) for one in driven), "invalid": list(graph.checkValidity()), "routes": routes}))
"""


def by_lanelet2(path, ways):
    """What the library says, in a process of its own: a missing node crashes it."""
    lat, lon = re.search(r'lat="([-\d.]+)" lon="([-\d.]+)"', path.read_text(encoding="utf-8")).groups()
    run = subprocess.run([sys.executable, "-c", ROUTING, str(path), lat, lon], input=json.dumps(ways), capture_output=True, text=True)
    return json.loads(run.stdout) if run.returncode == 0 else {"errors": [f"stopped with {run.returncode}: {run.stderr[-200:]}"]}


def by_ezdxf(path):
    import ezdxf

    drawing = ezdxf.readfile(path)
    return len(list(drawing.modelspace())), len(drawing.audit().errors)


def main():
    folder, failed = Path(sys.argv[1]), []
    for file in sorted(folder.glob("*.json")):
        name, expected = file.stem, json.loads(file.read_text(encoding="utf-8"))
        apart, missed, step = by_pyxodr(folder / f"{name}_1.7.xodr", expected)
        routing = by_lanelet2(folder / f"{name}.osm", expected["ways_in_degrees"])
        entities, errors = by_ezdxf(folder / f"{name}.dxf")
        routes = routing.pop("routes", [])
        print(f"{name}: pyxodr in steps down to {1000 * step:g} mm {1000 * apart:.2f} mm from our reader, exported borders within "
              f"{1000 * missed:.1f} mm of its; lanelet2 {routing}, {sum(routes)} of {len(routes)} routes; ezdxf {entities} entities, "
              f"{errors} errors", flush=True)
        checks = {
            "pyxodr": apart <= READERS_APART, "pyxodr and what was exported": missed <= TOLERANCE,
            "lanelet2 errors": not routing["errors"] and not routing.get("invalid"), "lanelets": routing.get("lanelets") == expected["lanelets"],
            "successors": routing.get("successors") == expected["successors"], "passable": routing.get("passable") == expected["lanes"],
            "routes": all(routes), "dxf": entities == expected["dxf"] and not errors,
        }
        failed += [f"{name}: {what}" for what, good in checks.items() if not good]
    sys.exit("\n".join(["These differ:", *failed]) if failed else 0)


if __name__ == "__main__":
    main()
