"""Streets under a scanner that spins many unequal lasers, as road points in the road's own frame."""

import numpy as np
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.records import ROAD_POINT, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.trajectory.trajectory import Trajectory

LENGTH, HEIGHT, SPEED, HALF = 45.0, 1.8, 5.0, 7.0
TURN = 0.1      # s
BEAMS = 40
NOISE = 0.003   # m, of heights
ELEVATIONS = np.radians(np.linspace(-26.0, -7.0, BEAMS))


def drive(length=LENGTH):
    """A drive to the east in a vehicle that rolls and pitches by a degree."""
    time = np.arange(0.0, length / SPEED + 0.05, 0.05)
    return Trajectory(1000 + time, SPEED * time + 500_000, np.full(len(time), 5_400_000.0), np.full(len(time), 100 + HEIGHT),
                      np.sin(time), np.cos(1.7 * time), np.full(len(time), 90.0))


def spun(paint=None, by_turn=False, unequal=True, length=LENGTH, section_length=20.0, height=None, covered=None, glare=None, noisy=False):
    """Road points of a spinning scanner and its frame; `by_turn` brings each turn to the place of its middle, as clouds of frames do.

    paint, covered : functions of places; height : of places, metres
    noisy : whether beams differ, and points scatter, as much as asphalt is bright
    glare : of places and the turn's number, how much brighter asphalt looks then, in the scanner's 256 levels
    """
    rng = np.random.default_rng(5)
    trajectory = drive(length)
    frame = build_frame(trajectory)
    angle = np.arange(0, 2 * np.pi, np.radians(0.6))
    turns = np.arange(0.0, length / SPEED - TURN / 2, TURN)
    turn, azimuth, beam = (a.ravel() for a in np.meshgrid(turns, angle, np.arange(BEAMS), indexing="ij"))
    time = turn + TURN * azimuth / (2 * np.pi)
    seen = turn + TURN / 2 if by_turn else time
    roll, pitch = (np.radians(np.interp(1000 + seen, trajectory.time, a)) for a in (trajectory.roll, trajectory.pitch))
    # in the vehicle a beam keeps its elevation; where it meets the road follows from the tilt
    ahead, left = np.cos(azimuth), np.sin(azimuth)
    elevation = ELEVATIONS[beam] + rng.normal(0, np.radians(0.03), len(beam))
    level = np.tan(elevation) + roll * left - pitch * ahead
    x, y = SPEED * seen - HEIGHT / level * ahead, -HEIGHT / level * left
    gain = np.where(unequal, rng.uniform(-24 if noisy else -14, 8, BEAMS), 0.0)
    value = 28 + gain[beam] + rng.normal(0, 5 if noisy else 3, len(x)) + (np.where(paint(x, y), 25, 0) if paint else 0) \
        + (glare(x, y, np.rint(turn / TURN)) if glare else 0)
    kept = (np.abs(y) < HALF) & (x > 0) & (x < length)
    records = np.zeros(kept.sum(), ROAD_POINT)
    z = 100 - frame.origin[2] + (height(x, y) if height else np.zeros(len(x))) + rng.normal(0, NOISE, len(x))
    for name, values in (("x", x), ("y", y), ("s", x), ("d", y), ("z", z)):
        records[name] = to_units(values[kept])
    records["time"] = 1000 + time[kept]
    records["source"] = 1 + np.rint(turn[kept] / TURN)
    records["intensity"] = np.clip(np.rint(value[kept]), 0, 255) * 256
    records["corrected"], records["half_width"] = np.nan, HALF * 1000
    if covered:
        records["covered"] = covered(x[kept], y[kept])
    found = RoadPoints(SectionStore(ROAD_POINT, section_length), frame.origin)
    found.store.append(0, records)
    return found, frame
