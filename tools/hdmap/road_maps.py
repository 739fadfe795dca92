"""The road maps that are exported: streets with known lanes, and results of tools/survey_results.sh."""

import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import shapely

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "streets"))

from plugin_package import load  # noqa: E402

load()

from lanewright.core.common.errors import RoadExtractionError  # noqa: E402
from lanewright.products.export.sources import RoadMapSource, checked  # noqa: E402

LAYERS = {"LANES": "lanes.gpkg", "DRIVING_LINES": "driving.gpkg", "MARKING_LINES": "lines.gpkg", "ROAD_EDGES": "edges.gpkg",
          "MARKINGS": "markings.gpkg"}
ROAD_POINTS = "road.laz"
TRAJECTORIES = ("survey/trajectory.gpkg", "survey/trajectory.csv")   # in the folder of a survey's results
SAME_ARM = 25.0     # m between the ends of two drives on one arm
PAUSE = 5.0         # s between two drives
SAME_SECTION = 1.0  # m along the road between places of lanes side by side
MOST_TURNED = 0.5   # rad between a drive and the lane that it is on


@dataclass
class RoadMap:
    """source : RoadMapSource, checked; drives : ((2,), (2,)) first and last place on a lane, in map coordinates, of every drive."""

    source: RoadMapSource
    drives: list = field(default_factory=list)

    def ways(self):
        """(from, to) between which a route must exist, of one of the places of the first to one of the second: from every arm that a drive came
        from to every other one that a drive led to. (N, 2) places each, in the lanes of the arm side by side: any of them may be taken."""
        starts, ends = (_apart([drive[end] for drive in self.drives]) for end in (0, 1))
        return [(_beside(start, self.source.lanes), _beside(end, self.source.lanes)) for start in starts for end in ends
                if np.hypot(*(start - end)) > SAME_ARM]


def streets():
    """Name -> RoadMap of streets made by formula."""
    from made_lanes import crossing, double_line, parting, roundabout, s_curve, split, street, widening

    lanes = {"street": street(cut=30.0), "left_hand": street(side="left", cut=30.0), "arc": street(((100.0, 1 / 40, 1 / 40),)),
             "crowned": s_curve(slope=0.02, crown=0.025), "tilted": s_curve(slope=0.02, crossfall=0.02), "widening": widening(), "split": split(),
             "crossing": crossing(), "double_line": double_line(), "parting": parting(), "roundabout": roundabout()}
    return {name: RoadMap(checked(RoadMapSource(one))) for name, one in lanes.items()}


def results(folder):
    """Name -> RoadMap of every folder with lanes in a folder of results, as an export takes them."""
    found = {}
    for path in sorted(path for path in Path(folder).iterdir() if (path / LAYERS["LANES"]).exists()):
        try:
            source = _source(path)
        except RoadExtractionError as problem:
            print(f"{path.name}: {problem}")
            continue
        trajectory = next((path / name for name in TRAJECTORIES if (path / name).exists()), None)
        found[path.name] = RoadMap(source, _drives(trajectory, source.lanes) if trajectory else [])
    return found


def _source(folder):
    from lanewright.algorithms.export import road_map_source
    from lanewright.core.common.progress import Progress
    from lanewright.library import algorithms
    from lanewright.library.call import FileCall

    files = {name: str(folder / file) for name, file in LAYERS.items() if (folder / file).exists()}
    if (folder / ROAD_POINTS).exists():
        files["ROAD_POINTS"] = str(folder / ROAD_POINTS)
    return road_map_source(FileCall(algorithms()["exportopendrive"], files | {"OUTPUT": str(folder / "map.xodr")}, Progress()), Progress())


def _drives(path, lanes):
    """(first, last) place of every drive on a lane that is driven its way."""
    from lanewright.core.survey.trajectory.trajectory import clean_trajectory

    rows = [k for k in range(len(lanes)) if lanes.type[k] in ("driving", "connector")]
    areas = shapely.STRtree([shapely.Polygon(np.concatenate([left, right[::-1]])[:, :2]) for left, right in map(lanes.borders, rows)])
    trajectory, found = clean_trajectory(_trajectory(path)), []
    for places in np.split(np.c_[trajectory.x, trajectory.y], np.flatnonzero(np.diff(trajectory.time) > PAUSE) + 1):
        way = np.gradient(places, axis=0)
        on = []
        for place, number in areas.query(shapely.points(places), predicate="within").T:
            left, right = lanes.borders(rows[number])
            middle = ((left + right) / 2)[:, :2]
            k = min(int(np.argmin(np.hypot(*(middle - places[place]).T))), len(middle) - 2)
            ahead = middle[k + 1] - middle[k]
            turned = np.arctan2(ahead[0] * way[place, 1] - ahead[1] * way[place, 0], ahead @ way[place])
            if abs(turned) < MOST_TURNED:
                on.append(place)
        if on:
            found.append((places[min(on)], places[max(on)]))
    return found


def _trajectory(path):
    from lanewright.core.survey.trajectory.reader import read_trajectory, trajectory_from_columns

    if path.suffix == ".csv":
        return read_trajectory(path)
    import fiona

    with fiona.open(path) as layer:
        rows = [(*row.geometry.coordinates[:3], row.properties["time"]) for row in layer]
    return trajectory_from_columns(dict(zip(("x", "y", "z", "time"), np.array(rows).T)))


def _beside(place, lanes):
    """(N, 2) a place on a lane, and those beside it in the other lanes of its road that are driven the same way."""
    middles = {k: sum(lanes.borders(k))[:, :2] / 2 for k in range(len(lanes)) if lanes.type[k] == "driving"}
    nearest = {k: int(np.argmin(np.hypot(*(middle - place).T))) for k, middle in middles.items()}
    own = min(middles, key=lambda k: np.hypot(*(middles[k][nearest[k]] - place)))
    ahead = np.gradient(middles[own], axis=0)[nearest[own]]
    found = [place]
    for k, middle in middles.items():
        away = middle[nearest[k]] - place
        if k != own and lanes.road[k] == lanes.road[own] and lanes.direction[k] == lanes.direction[own] \
                and abs(away @ ahead) < np.hypot(*ahead) * SAME_SECTION and np.hypot(*away) < SAME_ARM:
            found.append(middle[nearest[k]])
    return np.array(found)


def _apart(places):
    """Those of some places that lie on arms of their own."""
    found = []
    for place in places:
        if all(np.hypot(*(place - other)) > SAME_ARM for other in found):
            found.append(place)
    return found
