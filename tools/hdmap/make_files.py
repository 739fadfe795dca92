"""Writes maps of streets with known lanes, and what the other readers must find in them: make_files.py FOLDER."""

import json
import sys
from pathlib import Path

import numpy as np

STEP = 0.1   # m between the places of a lane that is driven along

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "streets"))

from plugin_package import load  # noqa: E402


def scenes():
    from made_lanes import crossing, double_line, parting, roundabout, s_curve, split, street, widening

    return {"street": street(cut=30.0), "left_hand": street(side="left", cut=30.0), "arc": street(((100.0, 1 / 40, 1 / 40),)),
            "crowned": s_curve(slope=0.02, crown=0.025), "tilted": s_curve(slope=0.02, crossfall=0.02), "widening": widening(), "split": split(),
            "crossing": crossing(), "double_line": double_line(), "parting": parting(),
            "roundabout": roundabout()}


def main():
    load()
    from lanewright.core.export.cad.dxf import dxf_lines, write_dxf
    from lanewright.core.export.lanelet.exporter import draft_lanelets
    from lanewright.core.export.lanelet.writer import lanelet2_text, to_degrees
    from lanewright.core.export.map_crs import reference_of_crs
    from lanewright.core.export.opendrive.exporter import OpenDriveSettings, draft_opendrive
    from lanewright.core.export.opendrive.writer import opendrive_text
    from lanewright.core.export.shared_borders import with_shared_borders
    from lanewright.core.export.sources import RoadMapSource, checked

    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, lanes in scenes().items():
        source = with_shared_borders(checked(RoadMapSource(lanes)))
        expected = {"lanes": int((np.isin(lanes.type, ("driving", "connector"))).sum()), "successors": sum(map(len, lanes.successors))}
        for version in ("1.7", "1.8"):
            draft = draft_opendrive(source, OpenDriveSettings(version=version))
            draft.map.reference = reference_of_crs(lanes.crs)
            (folder / f"{name}_{version}.xodr").write_text(opendrive_text(draft.map), encoding="utf-8")
        expected["borders"] = borders(folder / f"{name}_1.7.xodr")
        expected["driven"] = driven_lanes(folder / f"{name}_1.7.xodr")
        lanelets = draft_lanelets(source)
        (folder / f"{name}.osm").write_text(lanelet2_text(lanelets, to_degrees(lanelets.nodes, lanes.crs)), encoding="utf-8")
        expected["lanelets"] = len(lanelets.lanelets)
        lines = dxf_lines(source)
        write_dxf(lines, str(folder / f"{name}.dxf"))
        expected["dxf"] = len(lines)
        (folder / f"{name}.json").write_text(json.dumps(expected), encoding="utf-8")
    print(f"{len(scenes())} streets written to {folder}")


def borders(path):
    """[road, section, lane, [[x, y], ...]] of every outer border as our own reader has it."""
    from lanewright.core.export.opendrive.reader import read_opendrive
    from lanewright.core.export.opendrive.surface import RoadSurface

    found = []
    for road in read_opendrive(str(path)).roads:
        surface = RoadSurface(road)
        for number, section in enumerate(road.sections):
            s = surface.stations(number, 0.1)
            offsets = surface.offsets(number, s)
            for lane in section.lanes:
                if lane:
                    found.append([road.id, number, lane, surface.borders(number, lane, s, offsets)[1][:, :2].tolist()])
    return found


def driven_lanes(path):
    """Every driven lane of a section as our own reader has it: its road and number, stations along the road, way it is driven (1 along), middle
    [[x, y, z], ...] in the file's coordinates, and the (road, number) of the lanes that follow it."""
    from lanewright.core.export.opendrive.model import DRIVEN_TYPES
    from lanewright.core.export.opendrive.network import LaneNetwork, travel
    from lanewright.core.export.opendrive.reader import read_opendrive
    from lanewright.core.export.opendrive.surface import RoadSurface

    whole = read_opendrive(str(path))
    network, found = LaneNetwork(whole), []
    for road in whole.roads:
        surface = RoadSurface(road)
        for number, section in enumerate(road.sections):
            first, last = section.s, road.section_end(number)
            s = np.linspace(first, last - 1e-6, max(int((last - first) / STEP), 1) + 1)
            offsets = surface.offsets(number, s)
            for id, lane in section.lanes.items():
                if id and lane.type in DRIVEN_TYPES:
                    middle = sum(surface.borders(number, id, s, offsets)) / 2
                    found.append({"road": int(road.id), "lane": id, "way": travel(road, id), "s": s.tolist(), "middle": middle.tolist(),
                                  "following": sorted({(int(key[0]), key[2]) for key in network.following((road.id, number, id))})})
    return found


if __name__ == "__main__":
    main()
