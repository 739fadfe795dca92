"""Roads of known crossfall, ruts and curbs, as scanners see them that are mounted and levelled a little wrong."""

from dataclasses import dataclass

import numpy as np
import shapely
from lanewright.core.common.features import LANES, MARKING_LINES, ROAD_EDGES, Features
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.open_survey import Survey
from lanewright.core.survey.store.records import SURVEY_POINT, to_units
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.trajectory.trajectory import Trajectory

EAST, NORTH, GROUND, SENSOR = 500_000.0, 5_400_000.0, 100.0, 2.6
HALF = 3.5         # m from the middle to either edge
RUT_HALF = 0.35    # m, half the width of a rut
WHEEL_PATHS = 0.9  # m from the middle of a lane


@dataclass(frozen=True)
class Drive:
    """One pass: 1 along the road or -1 against it, m of its track left of the middle, roll error in m/m, error in height in m, and m that the
    track lies farther left at the end of the road than at its beginning."""

    direction: int = 1
    offset: float = -1.75
    roll: float = 0.0
    up: float = 0.0
    shift: float = 0.0


def surface(d, crossfall=0.025, crown=True, rut=0.0, lanes=(-1.75, 1.75), curb=0.12):
    """Height of the road at offsets: falling to both sides of a crown or to the right, two ruts a lane, raised beyond the edges."""
    z = -crossfall * (np.minimum(np.abs(d), HALF) if crown else -np.clip(d, -HALF, HALF))
    for middle in lanes:
        for side in (-1, 1):
            u = (d - middle - side * WHEEL_PATHS) / RUT_HALF
            z = z - rut * np.clip(1.0 - u**2, 0.0, None)
    return z + np.where(np.abs(d) > HALF, curb, 0.0)


def on_map(x, y, north=False, radius=0.0):
    """Map coordinates of places x along and y left of the middle of the road."""
    if radius:
        turn = x / radius
        x, y = (radius - y) * np.sin(turn), radius - (radius - y) * np.cos(turn)
    return (EAST - y, NORTH + x) if north else (EAST + x, NORTH + y)


def measured_road(drives=(Drive(),), scanners=((0.0, 0.0),), length=60.0, density=450.0, noise=0.004, grade=0.03, reach=6.0, seed=11,
                  above=None, hides=None, north=False, radius=0.0, **road):
    """A Survey of a road, straight or in a bend to the left of a radius in m about its middle.

    scanners : (step in m, tilt in m/m) of each on its vehicle, the tilt positive where it measures its left side too high; the third, if
        given, is its turn about the vertical, in m that a point is placed too far ahead for each m that it lies to the left
    density : points per m² of one drive beneath the vehicle; it falls off to either side as a rotating mirror's does
    above : function of a random generator that gives further points (x, y, z) above z = 0
    hides : function of the drive's offset and points x, y, z; which of them something hides
    """
    rng = np.random.default_rng(seed)
    step = np.arange(0.0, length + 1e-9, 0.25)
    rows, parts = [], []
    for number, drive in enumerate(drives):
        x = step if drive.direction > 0 else step[::-1]
        time = 1000.0 * (number + 1) + np.arange(len(x)) * 0.025
        rows.append(np.stack([time, x, drive.offset + drive.shift * x / length, grade * x + SENSOR + GROUND]))
        for scanner, (up, tilt, *turn) in enumerate(scanners):
            count = int(density * np.pi * SENSOR * length / len(scanners))
            across = SENSOR * np.tan(rng.uniform(-np.pi / 2, np.pi / 2, count))
            ahead = np.cumsum(rng.standard_exponential(count))  # strewn evenly, in order, from the first metre to the last
            px = (ahead - ahead[0]) / (ahead[-1] - ahead[0]) * length
            py = drive.offset + drive.shift * px / length + across
            kept = np.abs(py) < reach
            px, py, across = px[kept], py[kept], across[kept]
            pz = surface(py, **road) + grade * px
            if above is not None and number == 0 and scanner == 0:
                ax, ay, az = above(rng)
                px, py, pz, across = np.r_[px, ax], np.r_[py, ay], np.r_[pz, az + grade * ax], np.r_[across, ay - drive.offset]
            if hides is not None:
                seen = ~hides(drive.offset, px, py, pz - grade * px)
                px, py, pz, across = px[seen], py[seen], pz[seen], across[seen]
            pz = pz + drive.up + up + (drive.roll + tilt) * drive.direction * across + rng.normal(0, noise, len(px))
            px = px + sum(turn) * across
            parts.append((number, scanner, np.interp(px, x[:: drive.direction], time[:: drive.direction]), px, py, pz + GROUND))

    def placed(x, y):
        return on_map(x, y, north, radius)

    time, x, y, z = np.concatenate(rows, axis=1)
    frame = build_frame(Trajectory(time, *placed(x, y), z))
    store = SectionStore(SURVEY_POINT, 20.0)
    passes = {drive: next(p.number for p in frame.passes if abs(p.time[0] - 1000.0 * (drive + 1)) < 1.0) for drive in range(len(drives))}
    road = frame.road(0)
    for drive, scanner, time, x, y, z in parts:
        lx, ly, lz = frame.to_local(*placed(x, y), z)
        track = rows[drive]
        along, _ = road.locate(*frame.to_local(*placed(track[1], track[2]), track[3])[:2])
        s, d = road.locate(lx, ly, start=np.interp(time, track[0], along))
        good = np.isfinite(s)
        records = np.zeros(good.sum(), SURVEY_POINT)
        for name, values in zip("xyzsd", (lx, ly, lz, s, d)):
            records[name] = to_units(values[good])
        records["time"], records["pass_number"], records["scanner"] = time[good], passes[drive], scanner
        store.append(0, records)
    field = "scanner_channel" if len(scanners) > 1 else None
    return Survey([], frame, store, "", {p.number: SENSOR for p in frame.passes}, field, list(range(len(scanners))), True, True, above_road=12.0)


def crossing_roads(up, halves=(HALF, HALF)):
    """(Survey, edges) of two level roads of 60 m that cross, the one to the north `up` m above the one to the east, with edges at `halves`."""
    rng = np.random.default_rng(3)
    x, rows, parts, edges = np.arange(-30.0, 30.1, 0.25), [], [], Features("LineStringZ", ROAD_EDGES)
    for number, (level, placed) in enumerate(((GROUND, lambda x, y: (EAST + x, NORTH + y)), (GROUND + up, lambda x, y: (EAST - y, NORTH + x)))):
        time = 1000.0 * number + np.arange(len(x)) * 0.025
        rows.append(np.stack([time, *placed(x, 0 * x), level + SENSOR + 0 * x]))
        px, py = np.sort(rng.uniform(-30, 30, 40_000)), rng.uniform(-6, 6, 40_000)
        parts.append((np.interp(px, x, time), *placed(px, py), level + surface(py) + rng.normal(0, 0.004, len(px))))
        for side, d in (("left", halves[number]), ("right", -halves[number])):
            edges.add(shapely.linestrings(np.stack([*placed(x, d + 0 * x), level + 0 * x], axis=1)), side=side, kind="main", part="bottom",
                      road=number)
    frame = build_frame(Trajectory(*np.concatenate(rows, axis=1)))
    store = SectionStore(SURVEY_POINT, 20.0)
    for number, (time, *places) in enumerate(parts):
        local = frame.to_local(*places)
        s, d = frame.road(number).locate(*local[:2])
        seen = np.isfinite(s)
        records = np.zeros(seen.sum(), SURVEY_POINT)
        for name, values in zip("xyzsd", (*local, s, d)):
            records[name] = to_units(values[seen])
        records["time"], records["pass_number"] = time[seen], number
        store.append(number, records)
    return Survey([], frame, store, "", dict.fromkeys((0, 1), SENSOR), None, [0], True, True, above_road=12.0), edges


def edges_of(length=60.0, half=HALF, north=False, radius=0.0):
    """ROAD_EDGES of the road."""
    return _lines(ROAD_EDGES, [(d, dict(side="left" if d > 0 else "right", status="measured", kind="main", part="bottom")) for d in (half, -half)],
                  length, north, radius)


def markings_of(length=60.0, offsets=(-3.25, 0.0, 3.25), north=False, radius=0.0):
    """MARKING_LINES of the road."""
    return _lines(MARKING_LINES, [(d, dict(line=k, kind="lane", status="measured")) for k, d in enumerate(offsets)], length, north,
                  radius)


def lanes_of(length=60.0, strips=((-3.5, -3.0, "shoulder", 0), (-3.0, 0.0, "driving", 1), (0.0, 3.4, "driving", -1))):
    """LANES of the road: (right, left, type, direction) of every strip, in pieces of 20 m."""
    found = Features("PolygonZ", LANES)
    for number, (right, left, kind, direction) in enumerate(strips, 1):
        for piece, start in enumerate(np.arange(0.0, length, 20.0)):
            s = np.linspace(start, min(start + 20.0, length), 5)[:: direction or 1]
            borders = (left, right) if direction >= 0 else (right, left)
            ring = [(EAST + x, NORTH + borders[0], GROUND) for x in s] + [(EAST + x, NORTH + borders[1], GROUND) for x in s[::-1]]
            found.add(shapely.Polygon(ring), road=0, lane=number, lane_id=f"0.{number}.{piece}", type=kind, direction=direction)
    return found


def _lines(schema, lines, length, north, radius):
    found = Features("LineStringZ", schema)
    x = np.linspace(0.0, length, int(length) + 1 if radius else 2)
    for d, row in lines:
        found.add(shapely.linestrings(np.stack([*on_map(x, d + 0 * x, north, radius), GROUND + 0 * x], axis=1)), road=0, **row)
    return found
