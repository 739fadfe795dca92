"""Surveys with truth: the sample scenes, or folders of one's own.

A survey is a folder with

    cloud.laz  (or .las, .copc.laz)      the points
    trajectory.csv                       time, x, y, z in the cloud's CRS
    truth.gpkg  or  truth/truth.gpkg     what is there: any of the layers in LAYERS
    truth/scanned.tif                    optional: what was seen; paint elsewhere is not judged
    about.json                           optional: {"kind": "real" or "simulated", "text": "what it is", "steps": false where the
                                         road map is judged as a whole alone, "poorer": true where it is also judged with something lacking}
"""

import json
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import shapely
from lanewright.core.io.geotiff import new_geotiff
from lanewright.simulator.parts.materials import CARRIAGEWAY_LABELS
from lanewright.simulator.survey import SampleSettings, make_sample_survey

# What a truth layer may be called; the first is the name in the sample survey
LAYERS = dict(boundaries=("boundaries", "curb_bottom"), markings=("markings",), driving_lines=("driving_lines",),
              surface=("surface", "road_surface"), area=("survey_area",), roadside=("roadside",))
SAMPLES = {
    "difficult": (SampleSettings(seed=2, length=160.0, speed_kmh=70.0, pulse_rate=100_000.0, rotation_rate=100.0, radius=60.0,
                                 curb_height=0.08, gutter=0.30),
                  "the street scene in sharp bends, low curbs, concrete gutters, scan lines 19 cm apart, a fifth of the points"),
    "street": (SampleSettings(), "two lanes, parked cars, one pass"),
    "rural": (SampleSettings(scene="rural"), "country road without curbs, one pass"),
    "urban": (SampleSettings(scene="urban", gutter=0.30), "four lanes, concrete gutters, parked cars, two passes"),
}
# Streets of other kinds, on which the road map is judged as a whole but its steps are not measured one by one
OTHERS = {
    "one lane": (SampleSettings(scene="one-lane"), "one lane of 5.8 m with arrows in its middle, parked cars, one pass"),
    "wide lane": (SampleSettings(scene="wide-lane"), "one lane of 7 m with arrows in its middle, parked cars, one pass"),
    "no centre line": (SampleSettings(scene="no-centre-line"), "two lanes without a line between them, parked cars, one pass"),
    "hatched island": (SampleSettings(scene="hatched-island"), "two lanes, held apart by a hatched island, two passes"),
    "motorway": (SampleSettings(scene="motorway"), "two lanes and a hard shoulder each way, an exit, 100 km/h, two passes"),
    "serpentine": (SampleSettings(scene="serpentine"), "hairpins of 12 m radius, no curbs, one pass"),
    "crossing": (SampleSettings(scene="crossing"), "four arms with turning lanes, one not driven, two passes"),
    "roundabout": (SampleSettings(scene="roundabout"), "four arms with splitter islands, one not driven, two passes"),
    "outskirts": (SampleSettings(scene="outskirts"), "two lanes between gardens and a pasture, rail, barrier, walls, fences, hedge, two passes"),
    "cycle lanes": (SampleSettings(scene="cycle-lanes"), "two lanes with the word BUS, two cycle lanes with bicycles, two passes"),
}
CELL, SEEN = 0.04, 3   # m; cells about a point of road that count as seen


def surveys_in(folder):
    """Paths of the surveys in a folder, by name; a folder that is a survey itself counts."""
    candidates = [Path(folder), *sorted(path for path in Path(folder).iterdir() if path.is_dir())]
    return [path for path in candidates if _truth_file(path) and _cloud(path) and (path / "trajectory.csv").exists()]


def _truth_file(folder):
    return next((path for path in (folder / "truth.gpkg", folder / "truth" / "truth.gpkg") if path.exists()), None)


def _cloud(folder):
    return next((path for name in ("cloud.laz", "cloud.copc.laz", "cloud.las") if (path := folder / name).exists()), None)


@dataclass
class Truth:
    """Shapely geometries in map coordinates; an empty list where the survey has no such truth.

    curbs, with the side of each; aside : curbs that are not judged (dropped ones, islands, corners); edges : all of them and the edges
    of the pavement, each with what it is (curb, dropped, pavement) and where it runs (main, side_street, corner, island);
    markings, with the class of each; area : polygon outside of which nothing is judged, or None; roadside : (line, row) of what runs
    beside the road
    """

    curbs: list = field(default_factory=list)
    sides: list = field(default_factory=list)
    aside: list = field(default_factory=list)
    edges: list = field(default_factory=list)
    markings: list = field(default_factory=list)
    classes: list = field(default_factory=list)
    driving: list = field(default_factory=list)
    area: object = None
    roadside: list = field(default_factory=list)
    has: set = field(default_factory=set)


@dataclass
class Case:
    """One survey: `kind` is simulated, real or not stated; `steps` says whether the methods of each step are measured
    too, `poorer` whether it is judged with something lacking."""

    name: str
    cloud: Path
    trajectory: Path
    truth: Truth
    seen: Path
    kind: str
    text: str
    steps: bool = True
    poorer: bool = False


def read_case(folder):
    folder = Path(folder)
    about = folder / "about.json"
    about = json.loads(about.read_text()) if about.exists() else {}
    seen = folder / "truth" / "scanned.tif"
    return Case(folder.name, _cloud(folder), folder / "trajectory.csv", _read_truth(_truth_file(folder)),
                seen if seen.exists() else None, about.get("kind", "not stated"), about.get("text", ""),
                about.get("steps", True), about.get("poorer", False))


def _read_truth(path):
    from osgeo import ogr

    ogr.UseExceptions()
    source = ogr.Open(str(path))
    present = {source.GetLayer(k).GetName() for k in range(source.GetLayerCount())}
    truth, layers = Truth(), {}
    for what, names in LAYERS.items():
        name = next((name for name in names if name in present), None)
        layers[what] = list(_features(source.GetLayerByName(name))) if name else []
        if name:
            truth.has.add(what)
    for geometry, row in layers["boundaries"]:
        if row.get("part") == "top":
            continue
        edge, where = row.get("edge", row.get("kind")), row.get("scope") if "edge" not in row else row.get("kind")
        truth.edges.append((geometry, edge or "curb", where or "main"))
        if edge in ("pavement", "none"):
            continue
        if edge in (None, "curb") and where in (None, "main"):
            truth.curbs.append(geometry)
            truth.sides.append(row.get("side"))
        else:
            truth.aside.append(geometry)
    for geometry, row in layers["markings"]:
        truth.markings.append(shapely.make_valid(shapely.force_2d(geometry)))
        name = row.get("class") or row.get("mark_class") or row.get("kind") or "paint"
        truth.classes.append(str(name).replace("_", " "))
    truth.driving = [geometry for geometry, _ in layers["driving_lines"]]
    truth.roadside = layers["roadside"]
    areas = [geometry for geometry, _ in layers["area"]]
    # without a word about it, what lies well beside the road is judged too
    areas = areas or [geometry.buffer(8.0) for geometry, _ in layers["surface"]]
    truth.area = shapely.union_all(shapely.force_2d(np.array(areas, object))) if areas else None
    return truth


def _features(layer):
    for feature in layer:
        geometry = feature.GetGeometryRef()
        if geometry is not None:
            yield shapely.from_wkb(bytes(geometry.ExportToIsoWkb())), feature.items()


def make_samples(folder, only=()):
    """The sample surveys, or some of them, in a folder each."""
    for name, (settings, text) in {**SAMPLES, **OTHERS}.items():
        if not only or name in only:
            _make_sample(folder / name, settings, text, name in SAMPLES)


def _make_sample(folder, settings, text, steps=True):
    from make_sample import write_layers

    (folder / "truth").mkdir(parents=True, exist_ok=True)
    sample = make_sample_survey(settings)
    seen = _Seen(settings)
    blocks = sample.blocks
    sample.blocks = lambda *arguments: seen.watched(blocks(*arguments))
    sample.write_cloud(folder / "cloud.laz")
    seen.write(folder / "truth" / "scanned.tif", sample.crs)
    drive = sample.trajectory
    np.savetxt(folder / "trajectory.csv", np.c_[drive.time, drive.x, drive.y, drive.z, drive.roll, drive.pitch, drive.heading],
               ["%.6f"] + ["%.4f"] * 3 + ["%.5f"] * 3, ",", header="time,x,y,z,roll,pitch,heading", comments="")
    (folder / "truth.gpkg").unlink(missing_ok=True)
    write_layers(folder / "truth.gpkg", dict(boundaries=sample.truth_boundaries, markings=sample.truth_markings,
                                             driving_lines=sample.truth_driving_lines, surface=sample.truth_surface, lanes=sample.truth_lanes,
                                             roadside=sample.truth_roadside))
    about = dict(kind="simulated", text=f"{settings.length:g} m, {text}", steps=steps, poorer=True)
    (folder / "about.json").write_text(json.dumps(about))


class _Seen:
    """Cells of carriageway that a pulse fell on or beside, gathered from the points on their way into the file."""

    def __init__(self, settings):
        self.origin, self.found = settings.origin, set()

    def watched(self, blocks):
        for points in blocks:
            road = points[np.isin(points["label"], CARRIAGEWAY_LABELS)]
            cells = [np.floor(road[axis] / CELL).astype(np.int64) for axis in "xy"]
            self.found.update(np.unique(cells[0] * 2**32 + cells[1]).tolist())
            yield points

    def write(self, path, crs):
        from scipy.ndimage import binary_dilation

        cells = np.array(sorted(self.found))
        column, row = cells // 2**32, cells % 2**32
        left, top = column.min() - SEEN, row.max() + SEEN + 1
        seen = np.zeros((top - row.min() + SEEN, column.max() - left + SEEN + 1), bool)
        seen[top - 1 - row, column - left] = True
        seen = binary_dilation(seen, np.ones((2 * SEEN + 1,) * 2, bool)).astype(np.uint8)
        with new_geotiff(path, seen.shape[1], seen.shape[0], (left * CELL, CELL, 0.0, top * CELL, 0.0, -CELL), crs, byte=True,
                         nodata=0) as image:
            image.write(0, 0, seen)
