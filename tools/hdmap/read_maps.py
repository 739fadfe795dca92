"""Reads the maps of make_files.py by other people's libraries: read_maps.py FOLDER. Runs in an environment with pyxodr, lanelet2, ezdxf."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import shapely

READERS_APART = 0.002    # m between our own reader and pyxodr
END_OF_BORDER = 0.3      # m at the ends of borders, where pyxodr's steps of 0.1 m do not reach


def by_pyxodr(path, expected):
    """Largest distance of pyxodr's borders from ours."""
    from pyxodr.road_objects.network import RoadNetwork

    ours = {(road, section, lane): points for road, section, lane, points in expected["borders"]}
    worst = 0.0
    for road in RoadNetwork(str(path), resolution=0.02).get_roads():
        for number, section in enumerate(road.lane_sections):
            for lane in section.lanes:
                if lane.id == 0:
                    continue
                points, own = np.asarray(lane.boundary_line), shapely.LineString(ours[str(road.id), number, lane.id])
                apart = shapely.distance(shapely.points(points), own)
                inside = shapely.line_locate_point(own, shapely.points(points))
                worst = max(worst, float(apart[(inside > END_OF_BORDER) & (inside < own.length - END_OF_BORDER)].max(initial=0.0)))
    return worst


ROUTING = """
import json, sys, lanelet2
from lanelet2.projection import UtmProjector
path, lat, lon = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
projector = UtmProjector(lanelet2.io.Origin(lat, lon))
loaded, errors = lanelet2.io.loadRobust(path, projector)
rules = lanelet2.traffic_rules.create(lanelet2.traffic_rules.Locations.Germany, lanelet2.traffic_rules.Participants.Vehicle)
graph = lanelet2.routing.RoutingGraph(loaded, rules)
lanelets = list(loaded.laneletLayer)
driven = [one for one in lanelets if rules.canPass(one)]
print(json.dumps({"errors": list(errors), "lanelets": len(lanelets), "passable": len(driven),
                  "successors": sum(len(graph.following(one)) for one in driven), "invalid": list(graph.checkValidity())}))
"""


def by_lanelet2(path):
    """What the library says, in a process of its own: a missing node crashes it."""
    lat, lon = re.search(r'lat="([-\d.]+)" lon="([-\d.]+)"', path.read_text(encoding="utf-8")).groups()
    run = subprocess.run([sys.executable, "-c", ROUTING, str(path), lat, lon], capture_output=True, text=True)
    return json.loads(run.stdout) if run.returncode == 0 else {"errors": [f"stopped with {run.returncode}: {run.stderr[-200:]}"]}


def by_ezdxf(path):
    import ezdxf

    drawing = ezdxf.readfile(path)
    return len(list(drawing.modelspace())), len(drawing.audit().errors)


def main():
    folder, failed = Path(sys.argv[1]), []
    for file in sorted(folder.glob("*.json")):
        name, expected = file.stem, json.loads(file.read_text(encoding="utf-8"))
        apart = by_pyxodr(folder / f"{name}_1.7.xodr", expected)
        routing = by_lanelet2(folder / f"{name}.osm")
        entities, errors = by_ezdxf(folder / f"{name}.dxf")
        print(f"{name}: pyxodr {1000 * apart:.2f} mm from our reader; lanelet2 {routing}; ezdxf {entities} entities, {errors} errors")
        checks = {
            "pyxodr": apart <= READERS_APART, "lanelet2 errors": not routing["errors"] and not routing.get("invalid"),
            "lanelets": routing.get("lanelets") == expected["lanelets"], "successors": routing.get("successors") == expected["successors"],
            "passable": routing.get("passable") == expected["lanes"], "dxf": entities == expected["dxf"] and not errors,
        }
        failed += [f"{name}: {what}" for what, good in checks.items() if not good]
    sys.exit("\n".join(["These differ:", *failed]) if failed else 0)


if __name__ == "__main__":
    main()
