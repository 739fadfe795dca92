"""Streets of known section as a scanner with a rotating mirror sees them, every line and pulse known."""

from dataclasses import dataclass

import numpy as np
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.open_survey import Survey
from lanewright.core.survey.store.records import SURVEY_POINT, to_units
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.trajectory.trajectory import Trajectory

HEIGHT = 2.5   # m of the scanner above the road
START = 5000.0  # s
CURB = 0.12
# offset and height along the section, from right to left: sidewalks 0.12 m above the road behind upright faces at 3.5 m
SECTION = ((-20.0, CURB), (-3.5, CURB), (-3.5, 0.0), (3.5, 0.0), (3.5, CURB), (20.0, CURB))
TUNNEL = ((-4.0, 5.0), (-4.0, CURB), (-3.5, CURB), (-3.5, 0.0), (3.5, 0.0), (3.5, CURB), (4.0, CURB), (4.0, 5.0), (-4.0, 5.0))


@dataclass
class Cloud:
    """Points of one scanner: local x along the street, y to its left, z above the road, and what is known of each."""

    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    line: np.ndarray    # turn of the mirror, counted from the zenith
    angle: np.ndarray   # radians about the vehicle's way, 0 at the zenith, positive to the left

    def __getitem__(self, which):
        return Cloud(*(getattr(self, name)[which] for name in ("time", "x", "y", "z", "line", "angle")))

    def __len__(self):
        return len(self.time)


def driven(seconds=6.0, speed=10.0, waits=()):
    """(time, x) of a drive along the street at 200 rows a second; waits are (at second, how long)."""
    time = np.arange(0.0, seconds + sum(w for _, w in waits), 0.005)
    going = np.ones(len(time))
    for at, length in waits:
        going[(time >= at) & (time < at + length)] = 0.0
    x = np.r_[0.0, np.cumsum(going[:-1] * speed * 0.005)]
    return START + time, x


def scanned(drive=None, rotation=100.0, pulses=100_000.0, yaw=45.0, section=SECTION, noise=0.0, wander=0.0, lost=0.0, rounded=0.0,
            clipped=20.0, offset=0.0, seed=7):
    """The Cloud of one scanner.

    rotation : Hz, negative turns the other way; pulses : Hz; yaw : degrees of the scan plane from straight across
    wander : share by which the rotation swings; lost : share of points that never returned
    rounded : s to which times are rounded; clipped : m either side; offset : m of the vehicle left of the middle
    """
    rng = np.random.default_rng(seed)
    time, x = driven() if drive is None else drive
    t = np.arange(time[0], time[-1], 1.0 / pulses)
    since = t - time[0]
    # the swing of the rotation has a period of four seconds
    turns = abs(rotation) * (since + wander * 4.0 / (2 * np.pi) * np.sin(2 * np.pi * since / 4.0)) + 0.3
    mirror = np.sign(rotation) * 2 * np.pi * turns
    across, above = np.sin(mirror) * np.cos(np.radians(yaw)), np.cos(mirror)
    ahead = np.sin(mirror) * np.sin(np.radians(yaw))
    reach = np.full(len(t), np.inf)
    for (y0, z0), (y1, z1) in zip(section[:-1], section[1:]):
        # place offset + r across on the piece of the section, HEIGHT + r above
        normal = np.array([z0 - z1, y1 - y0])
        down = across * normal[0] + above * normal[1]
        with np.errstate(divide="ignore", invalid="ignore"):
            r = ((y0 - offset) * normal[0] + (z0 - HEIGHT) * normal[1]) / down
            along = ((offset + r * across - y0) * (y1 - y0) + (HEIGHT + r * above - z0) * (z1 - z0)) / ((y1 - y0) ** 2 + (z1 - z0) ** 2)
        hit = (r > 0.1) & (along >= 0) & (along <= 1)
        reach = np.where(hit & (r < reach), r, reach)
    seen = np.isfinite(reach)
    reach = np.where(seen, reach, 0.0) + noise * rng.standard_normal(len(t))
    px, py, pz = np.interp(t, time, x) + reach * ahead, offset + reach * across, HEIGHT + reach * above
    seen &= (np.abs(py) <= clipped) & (rng.random(len(t)) >= lost)
    t = np.round(t / rounded) * rounded if rounded else t
    angle = np.arctan2(py - offset, pz - HEIGHT)
    return Cloud(t, px, py, pz, np.floor(turns).astype(np.int64), angle)[seen]


def survey_of(*clouds, drive=None, drives=None, place=None, height=HEIGHT, section_length=20.0, has_time=True):
    """A Survey of clouds, each of a scanner of its own over one drive, or of a pass of its own where `drives` are given.

    place : (x, y) of the street to (east, north) of the map, for streets that are not straight; the drives are placed likewise
    """
    drives = drives or [driven() if drive is None else drive]
    place = place or (lambda x, y: (x, y))
    rows = [np.stack([time, *place(x, np.full(len(x), y)), np.full(len(x), height)]) for time, x, y in
            ((d if len(d) == 3 else (*d, 0.0)) for d in drives)]
    time, x, y, z = np.concatenate(rows, axis=1)
    frame = build_frame(Trajectory(time, x + 1000.0, y + 2000.0, z + 100.0))
    frame.has_time = has_time
    store = SectionStore(SURVEY_POINT, section_length)
    for number, cloud in enumerate(clouds):
        east, north = place(cloud.x, cloud.y)
        lx, ly, lz = frame.to_local(east + 1000.0, north + 2000.0, cloud.z + 100.0)
        owner = np.zeros(len(cloud), int) if len(drives) == 1 else np.full(len(cloud), number)
        p = frame.passes[owner[0]]
        s, d = frame.road(0).locate(lx, ly, p.station_at(cloud.time) + p.direction * (cloud.x - np.interp(cloud.time, p.time, drives[owner[0]][1])))
        kept = np.isfinite(s)
        records = np.zeros(int(kept.sum()), SURVEY_POINT)
        for name, values in zip("xyzsd", (lx, ly, lz, s, d)):
            records[name] = to_units(values[kept])
        records["time"], records["pass_number"] = cloud.time[kept] if has_time else 0.0, owner[0]
        records["scanner"] = number if len(drives) == 1 else 0
        records["intensity"] = np.clip(np.rint(3000 + 100 * cloud.y[kept]), 1, 65535)
        records["returns"] = 1 + 16
        store.append(0, records)
    scanners = list(range(len(clouds) if len(drives) == 1 else 1))
    return Survey([], frame, store, "", {p.number: height for p in frame.passes}, "scanner_channel", scanners, True, has_time)
