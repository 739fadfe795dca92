"""Takes maps of other people in and out again: foreign_maps.py FOLDER [--limit SECONDS] [--only NAME ...] [--json FILE] [--crs CRS].

Every .xodr of the folder is read by Import OpenDRIVE and written by Export OpenDRIVE (1.7 and 1.8) and Export Lanelet2; what was written is read
again. The table has the CPU seconds of each step, and the largest distance of the borders of its lanes, sampled from the original here by plain
evaluation of the standard's formulas, from the borders that were read; "fault of the map" where the import named one. The folder is not changed.
"""

import argparse
import json
import math
import multiprocessing
import resource
import sys
import tempfile
import time
import traceback
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import shapely

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from plugin_package import load  # noqa: E402

load()

STEP = 0.5           # m along the road between the places at which the original is evaluated
FROM_END = 1e-3      # m from the ends of a lane section: what lies on them is of either
INTEGRATION = 0.002  # m between the places by which spirals are integrated
NARROW = 0.05        # m: lanes that are narrower everywhere are none
BORDER_LIMIT = 0.02    # m that a border may be missed
START_UP = 2.0       # s of an export that are not counted
NO_VEHICLES = ("none", "sidewalk", "curb", "walking", "rail", "tram")
NO_LANELETS = (*NO_VEHICLES, "parking", "restricted", "median")
EXPORTS = {"xodr17": ("exportopendrive", "xodr", {"VERSION": "1.7"}), "xodr18": ("exportopendrive", "xodr", {"VERSION": "1.8"}),
           "osm": ("exportlanelet2", "osm", {})}


class Original:
    """Borders of a file by plain evaluation: no code of the project is used, so that a fault of its reader shows."""

    def __init__(self, path):
        root = ElementTree.parse(path).getroot()
        for element in root.iter():
            element.tag = element.tag.rpartition("}")[2]
        offset = root.find("header/offset") if root.find("header") is not None else None
        self.offset = tuple(_number(offset, name) for name in ("x", "y", "z", "hdg")) if offset is not None else (0.0, 0.0, 0.0, 0.0)
        self.borders = {}   # (road, section, lane) -> (type, (N, 3) inner, (N, 3) outer)
        self.faults = []
        for road in root.findall("road"):
            try:
                self._road(road)
            except (ValueError, ZeroDivisionError, IndexError, TypeError) as problem:
                self.faults.append(f"road {road.get('id')}: {problem}")

    def _road(self, road):
        pieces = sorted(([_number(one, name) for name in ("s", "x", "y", "hdg", "length")], one) for one in road.findall("planView/geometry"))
        if not pieces:
            raise ValueError("no geometry")
        elevation, roll = _cubics(road, "elevationProfile/elevation"), _cubics(road, "lateralProfile/superelevation")
        shape, centre = _shapes(road), _cubics(road, "lanes/laneOffset")
        sections = sorted(((_number(one, "s"), k, one) for k, one in enumerate(road.findall("lanes/laneSection"))), key=lambda one: one[:2])
        ends = [start for start, *_ in sections[1:]] + [_number(road, "length")]
        for (start, number, section), end in zip(sections, ends):
            if end - start < 3 * FROM_END:
                continue
            s = np.linspace(start + FROM_END, end - FROM_END, max(int((end - start) / STEP), 1) + 1)
            corners = np.array([start + _number(one, "sOffset") for tag in ("width", "border") for one in section.iter(tag)])
            s = np.unique(np.append(s, corners[(corners > s[0]) & (corners < s[-1])]))
            plan = np.array([_plan(pieces, at) for at in s])
            for side, group in ((1, "left"), (-1, "right")):
                inner = np.array([_value(centre, at) for at in s])
                lanes = sorted(section.findall(f"{group}/lane"), key=lambda lane: abs(int(lane.get("id"))))
                for lane in lanes:
                    widths, borders = _cubics(lane, "width", "sOffset"), _cubics(lane, "border", "sOffset")
                    if widths or not borders:
                        outer = inner + side * np.array([_value(widths, at - start) for at in s])
                    else:
                        outer = np.array([_value(borders, at - start) for at in s])
                        outer = side * np.abs(outer)
                    lift = [[_step(lane, at - start, name) for at in s] for name in ("inner", "outer")]
                    lines = [self._places(plan, s, t, np.array(up), elevation, roll, shape) for t, up in ((inner, lift[0]), (outer, lift[1]))]
                    if np.abs(outer - inner).max() >= NARROW:
                        self.borders[road.get("id"), number, int(lane.get("id"))] = (lane.get("type"), *lines)
                    inner = outer

    def _places(self, plan, s, t, lift, elevation, roll, shape):
        turn = np.array([_value(roll, at) for at in s])
        x = plan[:, 0] - t * np.cos(turn) * np.sin(plan[:, 2])
        y = plan[:, 1] + t * np.cos(turn) * np.cos(plan[:, 2])
        z = np.array([_value(elevation, at) for at in s]) + t * np.sin(turn) + lift + np.array([_shape(shape, *at) for at in zip(s, t)])
        ox, oy, oz, turned = self.offset
        c, n = math.cos(turned), math.sin(turned)
        return np.c_[c * x - n * y + ox, n * x + c * y + oy, z + oz]

    def places(self, left_out):
        """(N, 3) places of the borders of lanes that are of no type of `left_out`."""
        found = [line for kind, *lines in self.borders.values() if kind not in left_out for line in lines]
        return np.concatenate([np.empty((0, 3)), *found])

    def lines(self):
        """Every border as (N, 3) places."""
        return [line for _, *lines in self.borders.values() for line in lines]


def _number(element, name):
    value = float(element.get(name, 0.0))
    if not math.isfinite(value):
        raise ValueError(f"{name} is {value}")
    return value


def _cubics(element, path, start="s"):
    return sorted([_number(one, name) for name in (start, "a", "b", "c", "d")] for one in element.findall(path))


def _value(rows, at):
    found = 0.0
    for start, a, b, c, d in rows:
        if start > at + 1e-9:
            break
        ds = at - start
        found = a + b * ds + c * ds**2 + d * ds**3
    return found


def _step(lane, at, name):
    found = 0.0
    for start, value in sorted((_number(one, "sOffset"), _number(one, name)) for one in lane.findall("height")):
        found = value if start <= at + 1e-9 else found
    return found


def _shapes(road):
    found = {}
    for one in road.findall("lateralProfile/shape"):
        found.setdefault(_number(one, "s"), []).append([_number(one, name) for name in "tabcd"])
    return sorted((s, sorted(rows)) for s, rows in found.items())


def _shape(shape, s, t):
    if not shape:
        return 0.0
    before = max([one for one in shape if one[0] <= s] or shape[:1], key=lambda one: one[0])
    after = min([one for one in shape if one[0] > s] or [before], key=lambda one: one[0])
    values = [_value(rows, max(t, rows[0][0])) + rows[0][2] * min(t - rows[0][0], 0.0) for _, rows in (before, after)]
    share = (s - before[0]) / (after[0] - before[0]) if after[0] > before[0] else 0.0
    return values[0] + share * (values[1] - values[0])


def _plan(pieces, s):
    """x, y and heading of the reference line at s."""
    place, element = pieces[0]
    for one in pieces:
        if one[0][0] <= s + 1e-9:
            place, element = one
    start, x, y, heading, length = place
    u, kind = s - start, next(child for child in element if child.tag in ("line", "arc", "spiral", "poly3", "paramPoly3"))
    if kind.tag in ("line", "arc", "spiral"):
        first = _number(kind, "curvature") if kind.tag == "arc" else _number(kind, "curvStart")
        last = _number(kind, "curvEnd") if kind.tag == "spiral" else first
        rate = (last - first) / length if length else 0.0
        if kind.tag == "line" or not first and not rate:
            return x + u * math.cos(heading), y + u * math.sin(heading), heading
        if not rate:
            return x + (math.sin(heading + first * u) - math.sin(heading)) / first, y - (
                math.cos(heading + first * u) - math.cos(heading)) / first, heading + first * u
        middles = (np.arange(max(int(u / INTEGRATION), 2)) + 0.5) * u / max(int(u / INTEGRATION), 2)
        turns = heading + first * middles + rate * middles**2 / 2
        return x + np.cos(turns).mean() * u, y + np.sin(turns).mean() * u, heading + first * u + rate * u**2 / 2
    if kind.tag == "paramPoly3":
        p = u if kind.get("pRange") == "arcLength" else u / length
        along, across = ([_number(kind, name + axis) for name in "abcd"] for axis in "UV")
    else:
        along, across = [0.0, 1.0, 0.0, 0.0], [_number(kind, name) for name in "abcd"]
        grid = np.linspace(0.0, u, max(int(u / INTEGRATION), 2))
        length_at = np.append(0.0, np.cumsum(np.hypot(1.0, np.polyval([3 * across[3], 2 * across[2], across[1]], (grid[1:] + grid[:-1]) / 2))
                                             * np.diff(grid)))
        p = float(np.interp(u, length_at, grid))
    (v, w), (dv, dw) = (np.polyval(one[::-1], p) for one in (along, across)), (
        np.polyval([3 * one[3], 2 * one[2], one[1]], p) for one in (along, across))
    c, n = math.cos(heading), math.sin(heading)
    return x + c * v - n * w, y + n * v + c * w, heading + math.atan2(dw, dv)


def step(work, limit):
    """(result, CPU seconds, fault) of a function in a process of its own."""
    mine, other = multiprocessing.Pipe(False)
    process = multiprocessing.get_context("fork").Process(target=_worker, args=(work, limit, other))
    process.start()
    other.close()
    try:
        found = mine.recv()
    except EOFError:
        found = None, float(limit), f"not ended in {limit} s"
    process.join()
    return found


def _worker(work, limit, pipe):
    resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
    start = time.process_time()
    try:
        result, fault = work(), ""
    except Exception as problem:
        refused = type(problem).__name__ == "RoadExtractionError"
        result, fault = None, str(problem) if refused else "TRACEBACK " + traceback.format_exc()[-400:]
    pipe.send((result, time.process_time() - start, fault))


def read(path, table, crs, algorithm):
    """Layers of a map file in GeoPackages, with the warnings."""
    from lanewright.core.common.progress import Progress
    from lanewright.library import run

    said = []
    progress = Progress()
    progress.warn = said.append
    run(algorithm, progress, INPUT=str(path), LANES=f"{table}_lanes.gpkg", MARKING_LINES=f"{table}_lines.gpkg", ROAD_EDGES=f"{table}_edges.gpkg",
        DRIVING_LINES=f"{table}_driving.gpkg", **({"CRS": crs} if crs else {}))
    return said


def write(algorithm, table, output, more):
    """A map file of the layers."""
    from lanewright.core.common.progress import Progress
    from lanewright.library import run

    said, layers = [], {}
    progress = Progress()
    progress.warn = said.append
    for name, file in (("MARKING_LINES", "lines"), ("ROAD_EDGES", "edges"), ("DRIVING_LINES", "driving")):
        layers[name] = f"{table}_{file}.gpkg"
    run(algorithm, progress, LANES=f"{table}_lanes.gpkg", OUTPUT=str(output), **layers, **more)
    return said


def borders_of(table):
    """((n, 3) left, (n, 3) right) of every lane of a layer that was read."""
    import fiona

    found = []
    with fiona.open(f"{table}_lanes.gpkg") as layer:
        for feature in layer:
            ring = np.array(feature["geometry"]["coordinates"][0])[:-1]
            half = (len(ring) + 1) // 2
            found.append((ring[:half], ring[half:] if len(ring) % 2 == 0 else np.concatenate([ring[half:], ring[:1]])))
    return found


def apart(places, lines):
    """(largest metres in plan of places from lines, of height above the nearest ones)."""
    segments = np.concatenate([np.empty((0, 6)), *(np.c_[line[:-1], line[1:]] for line in lines if len(line) > 1)])
    if not len(segments) or not len(places):
        return math.nan, math.nan
    tree = shapely.STRtree(shapely.linestrings(segments.reshape(-1, 2, 3)[:, :, :2]))
    across = tree.query_nearest(shapely.points(places[:, :2]), return_distance=True, all_matches=False)[1]
    which, near = tree.query(shapely.points(places[:, :2]), predicate="dwithin", distance=2.5 * BORDER_LIMIT)
    run = (segments[near, 3:] - segments[near, :3])[:, :2]
    share = np.clip(((places[which, :2] - segments[near, :2]) * run).sum(1) / np.maximum((run**2).sum(1), 1e-12), 0.0, 1.0)
    rise = np.full(len(places), np.inf)
    np.minimum.at(rise, which, np.abs(places[which, 2] - segments[near, 2] - share * (segments[near, 5] - segments[near, 2])))
    rise = rise[np.isfinite(rise)]
    return float(across.max()), float(rise.max()) if len(rise) else math.nan


def one_map(path, folder, given):
    """The row of a map."""
    table, crs, limit = f"{folder}/{path.stem}", given.crs, given.limit
    said, seconds, fault = step(lambda: read(path, table, crs, "importopendrive"), limit)
    row = {"map": path.stem, "import": {"s": seconds, "fault": fault, "said": said}}
    if fault:
        return row
    original, first = Original(path), [line for lane in borders_of(table) for line in lane]
    row["faults"] = original.faults
    row["metres"] = float(sum(np.hypot(*np.diff(line[:, :2], axis=0).T).sum() for line in first)) / 2
    row["import"]["apart"] = apart(original.places(NO_VEHICLES), first)
    row["import"]["back"] = apart(np.concatenate([np.empty((0, 3)), *first]), original.lines())
    for name in given.exports:
        algorithm, ending, more = EXPORTS[name]
        output = Path(f"{table}_{name}.{ending}")
        said, used, fault = step(lambda: write(algorithm, table, output, more), limit)   # noqa: B023
        row[name] = {"s": used, "fault": fault, "said": said}
        if fault:
            continue
        _, _, fault = step(lambda: read(output, f"{table}_{name}", crs, "importlanelet2" if ending == "osm" else "importopendrive"), limit)  # noqa: B023
        row[name]["read"] = fault
        if not fault:
            again = [line for lane in borders_of(f"{table}_{name}") for line in lane]
            row[name]["apart"] = apart(original.places(NO_LANELETS if ending == "osm" else NO_VEHICLES), again)
            row[name]["back"] = apart(np.concatenate([np.empty((0, 3)), *again]), first)
        row[name]["late"] = used > 2 * seconds + START_UP
    return row


def shown(row):
    """One line of the table."""
    parts = [f"{row['map'][:44]:44}"]
    for name in ("import", *EXPORTS):
        one = row.get(name)
        if one is None:
            continue
        if one["fault"] or one.get("read"):
            parts.append(f"{name} {one['s']:.1f} s: {(one['fault'] or one['read'])[:150]}")
        else:
            flag = "" if max(one["apart"][0], one["back"][0]) <= BORDER_LIMIT else " (fault of the map)" if row["import"]["said"] else " !"
            parts.append(f"{name} {one['s']:.1f} s{' LATE' if one.get('late') else ''} {one['apart'][0]:.3f}/{one['apart'][1]:.3f} "
                         f"back {one['back'][0]:.3f}/{one['back'][1]:.3f}{flag}")
    return " | ".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--limit", type=int, default=120)
    parser.add_argument("--only", default=[""], nargs="*", help="parts of the names of maps")
    parser.add_argument("--exports", default=list(EXPORTS), nargs="*", choices=list(EXPORTS))
    parser.add_argument("--json", type=Path)
    parser.add_argument("--crs", default="EPSG:25832", help="given to maps, which often have none; Lanelet2 needs one")
    parser.add_argument("--keep", type=Path, help="folder for the layers and files that are made")
    given = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for path in sorted(given.folder.glob("*.xodr")):
            if any(name in path.name for name in given.only):
                for old in folder.glob(f"{path.stem}*"):
                    old.unlink()
                rows.append(one_map(path, folder, given))
                print(shown(rows[-1]), flush=True)
                if given.json:
                    given.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")
    for name in ("import", *EXPORTS):
        done = [row[name] for row in rows if name in row and not row[name]["fault"] and not row[name].get("read")]
        within = sum(max(one["apart"][0], one["back"][0]) <= BORDER_LIMIT for one in done)
        print(f"{name}: {len(done)} of {len(rows)} done, {within} within {BORDER_LIMIT} m, {sum(one.get('late', False) for one in done)} late")


if __name__ == "__main__":
    sys.exit(main())
