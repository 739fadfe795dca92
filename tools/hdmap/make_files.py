"""Writes maps of road maps, and what the other readers must find in them: make_files.py FOLDER [RESULTS].

The road maps are those of streets with known lanes and, where RESULTS is given, those of tools/survey_results.sh.
"""

import json
import sys
from pathlib import Path

import numpy as np
from road_maps import results, streets

STEP = 0.1   # m between the places of a lane that is driven along
SOME_CRS = "EPSG:25832"   # for road maps that have none


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    maps = streets() | (results(sys.argv[2]) if len(sys.argv) > 2 else {})
    for name, one in maps.items():
        write(folder, name, one)
    print(f"{len(maps)} road maps written to {folder}")


def write(folder, name, one):
    """The files of one road map, and the JSON with what must be found in them."""
    from lanewright.products.cad import dxf_lines, write_dxf
    from lanewright.products.export.lanelet_export import draft_lanelets, lanelet2_text, to_degrees
    from lanewright.products.export.opendrive.exporter import OpenDriveSettings, draft_opendrive
    from lanewright.products.export.opendrive.xodr import opendrive_text
    from lanewright.products.export.shared_borders import with_inferred_ways, with_shared_borders
    from lanewright.products.export.sources import reference_of_crs

    source = with_shared_borders(with_inferred_ways(one.source))
    lanes, crs = source.lanes, source.lanes.crs or SOME_CRS
    for version in ("1.7", "1.8"):
        draft = draft_opendrive(source, OpenDriveSettings(version=version))
        draft.map.reference = reference_of_crs(lanes.crs)
        (folder / f"{name}_{version}.xodr").write_text(opendrive_text(draft.map), encoding="utf-8")
    origin = np.array(draft.map.offset[:2])
    lanelets = draft_lanelets(source)
    (folder / f"{name}.osm").write_text(lanelet2_text(lanelets, to_degrees(lanelets.nodes, crs)), encoding="utf-8")
    lines = dxf_lines(one.source)
    write_dxf(lines, str(folder / f"{name}.dxf"))
    driven = {lanes.lane_id[k] for k in range(len(lanes)) if lanes.type[k] in ("driving", "connector")}
    passable = sum(lanelet.name in driven for lanelet in lanelets.lanelets)
    links = sum(next in driven for id, others in zip(lanes.lane_id, lanes.successors) if id in driven for next in others)
    expected = {
        # each cut of a lane makes one lanelet more and one link more
        "lanes": passable, "successors": links + passable - len(driven), "lanelets": len(lanelets.lanelets), "dxf": len(lines),
        "borders": borders(folder / f"{name}_1.7.xodr"), "driven": driven_lanes(folder / f"{name}_1.7.xodr"),
        "vertices": (np.concatenate([lanes.left, lanes.right])[:, :2] - origin).round(4).tolist(), "origin": origin.tolist(),
        "ways": [[(places - origin).tolist() for places in way] for way in one.ways()],
        "ways_in_degrees": [[to_degrees(places, crs).lonlat[:, ::-1].tolist() for places in way] for way in one.ways()]}
    (folder / f"{name}.json").write_text(json.dumps(expected), encoding="utf-8")


def borders(path):
    """[road, section, lane, [[x, y], ...]] of every outer border as our own reader has it."""
    from lanewright.products.export.opendrive.xodr import read_opendrive

    found = []
    for road in read_opendrive(str(path)).roads:
        surface = road.surface
        for number in range(len(road.sections)):
            s = surface.stations(number)
            s = np.unique(np.append(s, np.arange(s[0], s[-1], 0.1)))
            offsets = surface.offsets(number, s)
            for lane in road.sections[number].lanes:
                if lane:
                    found.append([road.id, number, lane, surface.borders(number, lane, s, offsets)[1][:, :2].tolist()])
    return found


def driven_lanes(path):
    """Every driven lane of a section as our own reader has it: its road and number, stations along the road, way it is driven (1 along), middle
    [[x, y, z], ...] in the file's coordinates, and the (road, number) of the lanes that follow it."""
    from lanewright.products.export.opendrive.model import DRIVEN_TYPES, LaneNetwork
    from lanewright.products.export.opendrive.xodr import read_opendrive

    whole = read_opendrive(str(path))
    network, found = LaneNetwork(whole), []
    for road in whole.roads:
        surface = road.surface
        for number, section in enumerate(road.sections):
            first, last = section.s, road.section_end(number)
            s = np.linspace(first, last - 1e-6, max(int((last - first) / STEP), 1) + 1)
            offsets = surface.offsets(number, s)
            for id, lane in section.lanes.items():
                if id and lane.type in DRIVEN_TYPES:
                    middle = sum(surface.borders(number, id, s, offsets)) / 2
                    way = 1 if road.way_out(id) == "end" else -1
                    found.append({"road": int(road.id), "lane": id, "way": way, "s": s.tolist(), "middle": middle.tolist(),
                                  "following": sorted({(int(key[0]), key[2]) for key in network.following((road.id, number, id))})})
    return found


if __name__ == "__main__":
    main()
