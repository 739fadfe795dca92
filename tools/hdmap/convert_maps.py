"""Takes maps of other people from OpenDRIVE to Lanelet2 and back: convert_maps.py FOLDER OUT [--only NAME ...] [--readers PYTHON].

Every .xodr of the folder goes through Convert HD map to .osm and again to .xodr, which stay in OUT. A row of the table has the largest distance of
the borders that came out from those that went in, and the links from lane to lane, named by the lanes of the original: of the original, of the
lanelets as our reader has them and, with the Python of an environment that has lanelet2, as that library's routing graph has them, and of the roads
that came back; then the pairs of lanes of one direction side by side. The folder is not changed.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from plugin_package import load  # noqa: E402

load()

CRS = "EPSG:25832"   # given to maps, which often have none
ROUTING = """
import json, sys, lanelet2
projector = lanelet2.projection.UtmProjector(lanelet2.io.Origin(float(sys.argv[2]), float(sys.argv[3])))
loaded, errors = lanelet2.io.loadRobust(sys.argv[1], projector)
rules = lanelet2.traffic_rules.create(lanelet2.traffic_rules.Locations.Germany, lanelet2.traffic_rules.Participants.Vehicle)
graph = lanelet2.routing.RoutingGraph(loaded, rules)
driven = [one for one in loaded.laneletLayer if rules.canPass(one)]
beside = [(one.id, other.id) for one in driven for other in [graph.right(one) or graph.adjacentRight(one)] if other]
print(json.dumps({"errors": len(errors), "links": [(one.id, other.id) for one in driven for other in graph.following(one)], "beside": beside}))
"""


def read(path):
    """(layers, name of the original lane of each lane, by lane_id, where the file says it)."""
    from lanewright.products.export.lanelet_map import layers_of_lanelets, read_lanelet2
    from lanewright.products.export.opendrive.xodr import layers_of_opendrive, read_opendrive

    if path.suffix == ".osm":
        whole = read_lanelet2(str(path))
        return layers_of_lanelets(whole, CRS), {str(id): one.tags.get("lanewright:lane_id", "") for id, one in whole.lanelets.items()}
    whole = read_opendrive(str(path))
    names = {f"{road.id}.{id}.{number}": lane.data.get("lanewright:lane_id", "") for road in whole.roads
             for number, section in enumerate(road.sections) for id, lane in section.lanes.items()}
    return layers_of_opendrive(whole, CRS), names


def links(pairs, names, driven):
    """The links between different lanes of the original that are driven."""
    named = {(names.get(str(one), ""), names.get(str(other), "")) for one, other in pairs}
    return {pair for pair in named if pair[0] != pair[1] and driven.issuperset(pair)}


def successors(lanes):
    return [(one, other) for one, others in zip(lanes.lane_id, lanes.successors) for other in others]


def beside(lanes):
    """(lane, lane right of it) of one direction: the right border of the first is the left one of the second."""
    ends = [tuple(np.round(border[[0, -1], :2], 1).ravel()) for k in range(len(lanes)) for border in lanes.borders(k)]
    by_left = {}
    for k, end in enumerate(ends[::2]):
        by_left.setdefault(end, []).append(lanes.lane_id[k])
    return [(lanes.lane_id[k], other) for k, end in enumerate(ends[1::2]) for other in by_left.get(end, ())]


def by_library(python, path):
    """What the library lanelet2 makes of a file, in a process of its own: a missing node crashes it."""
    text = path.read_text(encoding="utf-8")
    lat, lon = (text.partition(f' {name}="')[2].partition('"')[0] for name in ("lat", "lon"))
    run = subprocess.run([python, "-c", ROUTING, str(path), lat, lon], capture_output=True, text=True)
    return json.loads(run.stdout) if run.returncode == 0 else {"errors": run.stderr[-150:], "links": [], "beside": []}


def row(path, folder, python):
    """The row of a map; what a step refused stands in the last column."""
    from lanewright.core.common.errors import RoadExtractionError
    from lanewright.library import run
    from lanewright.products.export.sources import border_misses

    there, back = folder / f"{path.stem}.osm", folder / f"{path.stem}.xodr"
    cells = [path.stem]
    try:
        run("converthdmap", INPUT=str(path), CRS=CRS, OUTPUT=str(there))
        original, first = read(path)[0].lanes, read(there)
        driven = set(original.lane_id[np.isin(original.type, ("driving", "connector"))])
        own = {name: name for name in driven}
        expected, sides = links(successors(original), own, driven), links(beside(original), own, driven)
        cells += [f"{border_misses(first[0].lanes, original)[0].largest:.3f}", len(expected)]
        made = links(successors(first[0].lanes), first[1], driven)
        cells.append(f"{len(made)} -{len(expected - made)} +{len(made - expected)}")
        library = by_library(python, there) if python else {"errors": "", "links": [], "beside": []}
        routed = links(library["links"], first[1], driven)
        cells.append(f"{len(routed)} -{len(expected - routed)} +{len(routed - expected)} errors {library['errors']}")
        run("converthdmap", INPUT=str(there), CRS=CRS, OUTPUT=str(back))
        last, names = read(back)
        names = {name: first[1].get(id, "") for name, id in names.items()}
        kept = links(successors(last.lanes), names, driven)
        cells += [f"{border_misses(first[0].lanes, last.lanes)[0].largest:.3f}", f"{len(kept)} -{len(expected - kept)} +{len(kept - expected)}"]
        pairs = [sides, links(library["beside"], first[1], driven), links(beside(last.lanes), names, driven)]
        cells.append(" ".join(str(len(one)) for one in pairs))
    except RoadExtractionError as problem:
        cells.append(str(problem)[:120])
    return cells


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--only", default=[""], nargs="*", help="parts of the names of maps")
    parser.add_argument("--readers", default="", help="a Python that has the package lanelet2")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    print("map | there (m) | links | in our reader | in lanelet2 | back (m) | links | side by side: in, lanelet2, back")
    for path in sorted(given.folder.glob("*.xodr")):
        if any(name in path.name for name in given.only):
            print(" | ".join(map(str, row(path, given.out, given.readers))), flush=True)


if __name__ == "__main__":
    sys.exit(main())
