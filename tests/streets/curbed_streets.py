"""Streets between curbs as a scanner sees them, for the tests of curbs and edges."""

import numpy as np
import shapely
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.open_survey import Survey
from lanewright.core.survey.store.records import SURVEY_POINT, to_units
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.trajectory.trajectory import Trajectory

EAST, NORTH, GROUND, SENSOR = 500_000.0, 5_400_000.0, 100.0, 2.5
LENGTH = 48.0


def street(curb=0.12, left=3.5, right=3.5, length=LENGTH, radius=None, noise=0.003, face=0.0, behind=3.0, seed=3,
           open_left=(), camber=0.02, wall=None, lines=0.06):
    """(x, y, z, time) of a street driven along its reference line, in metres about its start.

    curb : height in metres; left, right : offsets of the curbs' bottoms
    radius : of a left-hand bend, None for a straight street
    face : m across over which the curb rises
    open_left : stretches (from, to) of road where the left curb is flush
    wall : (offset, height) of a second step on the left, such as the back of a sidewalk
    """
    rng = np.random.default_rng(seed)
    road = np.arange(-right + 0.025, left, 0.05)
    up = (np.arange(0.0, max(curb, 1e-3), 0.015) + 0.007) / max(curb, 1e-3)
    walk = np.arange(0.03, behind, 0.05)
    offsets = np.r_[-right - face - walk[::-1], -right - face * up[::-1], road, left + face * up, left + face + walk]
    rises = curb * np.r_[np.ones(len(walk)), up[::-1], np.zeros(len(road)), up, np.ones(len(walk))]
    along = np.arange(-3.0, length + 3.0, lines)
    s = np.repeat(along, len(offsets)) + rng.uniform(0, lines, len(along) * len(offsets))
    d, z = np.tile(offsets, len(along)), np.tile(rises, len(along))
    for a, b in open_left:
        flush = (s > a) & (s < b) & (d > 0)
        z[flush] = np.minimum(z[flush], np.clip(0.03 * (d[flush] - left), 0.0, None))
    if wall:
        z[d > wall[0]] += wall[1]
    z -= camber * np.minimum(np.abs(d), np.where(d > 0, left, right))
    x, y = place(s, d, radius)
    noisy = rng.normal(0.0, noise, (3, len(s)))
    return x + noisy[0], y + noisy[1], z + noisy[2], 1000.0 + np.clip(s, 0, length) / 10


def place(s, d, radius):
    """Where station s and offset d lie on a straight along x or a left-hand bend that starts at (0, 0)."""
    if radius is None:
        return np.array(s, float), np.array(d, float)
    return (radius - d) * np.sin(s / radius), radius - (radius - d) * np.cos(s / radius)


def driven(length=LENGTH, radius=None, offset=0.0, start=1000.0, backwards=False):
    """Trajectory rows (time, x, y, z) of a drive along the street, 10 m/s."""
    s = np.linspace(0, length, int(length * 10) + 1)
    x, y = place(s, np.full(len(s), offset), radius)
    if backwards:
        x, y = x[::-1], y[::-1]
    return start + np.linspace(0, length, len(s)) / 10, x, y, np.full(len(s), SENSOR)


def survey_of(points, drive=None, east=EAST, section_length=20.0, second=None, shuffled=None):
    """A Survey of points (x, y, z, time); `second` are points and drive of another pass."""
    drive = driven() if drive is None else drive
    parts = [(points, drive)] + ([second] if second else [])
    rows = np.concatenate([np.array(d) for _, d in parts], axis=1)
    frame = build_frame(Trajectory(rows[0], rows[1] + east, rows[2] + NORTH, rows[3] + GROUND))
    store = SectionStore(SURVEY_POINT, section_length)
    for number, (cloud, (driven_at, *track)) in enumerate(parts):
        road = frame.roads[frame.passes[number].road]
        x, y, z, time = cloud
        x, y, z = frame.to_local(x + east, y + NORTH, z + GROUND)
        along, _ = road.locate(*frame.to_local(track[0] + east, track[1] + NORTH, track[2] + GROUND)[:2])
        s, d = road.locate(x, y, start=np.interp(time, driven_at, along))
        good = np.isfinite(s)
        records = np.zeros(good.sum(), SURVEY_POINT)
        for name, values in zip("xyzsd", (x, y, z, s, d)):
            records[name] = to_units(values[good])
        records["time"], records["pass_number"] = time[good], number
        if shuffled is not None:
            records = records[np.random.default_rng(shuffled).permutation(len(records))]
        store.append(road.number, records)
    return Survey([], frame, store, "", {p.number: SENSOR for p in frame.passes}, None, [0], True, True)


def parked_car(points, start, length=4.5, near=1.5, far=3.2, height=1.4, seed=5):
    """Points of a street with a car on its left side: its flank is seen, what it hides is not."""
    x, y, z, time = points
    hidden = (x > start) & (x < start + length) & (y > near) & (y < far + 2.0)
    rng = np.random.default_rng(seed)
    count = int(length * 600)
    # the flank ends 0.2 m above the road; wheels reach down to it
    px, pz = start + rng.uniform(0, length, count), rng.uniform(0.2, height, count)
    wheel = (np.abs(px - start - 0.8) < 0.3) | (np.abs(px - start - length + 0.8) < 0.3)
    pz[wheel] *= rng.uniform(0, 1, wheel.sum())
    car = px, np.full(count, near) + rng.normal(0, 0.003, count), pz, 1000.0 + px / 10
    return tuple(np.r_[a[~hidden], b] for a, b in zip((x, y, z, time), car))


def measured(features, side):
    """(N, 5) x, y about the street's start, z, station and curb height of the measured curb points of a side."""
    rows = [(g.x - EAST, g.y - NORTH, g.z - GROUND, r["station_m"], r["height_m"]) for g, r in features
            if r["side"] == side and r["status"] == "measured"]
    return np.array(rows).reshape(-1, 5)


def length_of(edges, side, status):
    return sum(shapely.length(g) for g, r in edges if r["side"] == side and r["status"] == status)


def ringed_street(curb=0.08, half=4.5, ramp=0.0, length=36.0, noise=0.025, beam_error=0.008, drift=0.006, seed=4, bed=0.0):
    """(x, y, z, time) of a straight street as a spinning scanner of 40 beams sees it: rings, noise, drifting positions.

    half : m from the driven line to either curb; ramp : m across over which the curb rises
    noise : m along the ray; beam_error : m of height that each beam has of its own
    drift : m across per metre ahead by which positions disagree
    bed : rise over run of plants on the left, 10 cm behind the curb
    """
    rng = np.random.default_rng(seed)
    height = 1.73
    down = np.radians(np.linspace(4.0, 24.8, 40))
    stations = np.arange(0.0, length, 0.7)
    v, down, turn = (a.ravel() for a in np.meshgrid(stations, down, np.linspace(0, 2 * np.pi, 480, endpoint=False), indexing="ij"))
    turn = turn + rng.uniform(0, 0.01, len(turn))
    reach = height / np.tan(down)
    reach = reach + rng.normal(0.0, noise, len(reach)) * np.cos(down)
    x, y = v + reach * np.cos(turn), reach * np.sin(turn)
    up = np.clip((np.abs(y) - half) / max(ramp, 1e-6), 0.0, 1.0) * curb
    up += bed * np.clip(y - half - 0.1, 0.0, 0.5) * rng.uniform(0.7, 1.3, len(y))
    z = up + rng.normal(0.0, noise, len(up)) * np.sin(down) + np.repeat(rng.normal(0, beam_error, 40), 480)[np.arange(len(up)) % (40 * 480)]
    y = y + drift * (x - v)
    seen = (np.abs(y) < 9.0) & (x > 0.0) & (x < length)
    return x[seen], y[seen], z[seen], 1000.0 + v[seen] / 10
