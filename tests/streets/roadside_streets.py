"""Roads with rails, barriers, walls, fences, hedges, cars, buildings and poles beside them, as a scanner sees them."""

from dataclasses import dataclass

import numpy as np
from measured_streets import HALF, SENSOR, Drive, edges_of, measured_road

LENGTH = 120.0
BESIDE = 0.12 - 0.025 * HALF  # m, of the ground beside the carriageway above its crown: a curb of 12 cm where it fell by 2.5 %
FACE = 250.0            # points per m² of a face
SOLID = ("barrier", "wall", "hedge", "building", "cars")


@dataclass(frozen=True)
class Thing:
    """A thing along the road: its kind, offset of its face from the middle of the road, and stations; a rail may have the form double or ropes,
    a hedge that of loose leaves, between which one sees deep into it."""

    kind: str
    offset: float
    start: float = 0.0
    end: float = LENGTH
    height: float = 0.0
    form: str = ""

    @property
    def side(self):
        return 1 if self.offset > 0 else -1


HEIGHTS = dict(guard_rail=0.75, barrier=0.85, wall=1.8, fence=1.2, hedge=1.4, building=7.5, cars=1.45)


def points_of(thing, rng, density=FACE):
    """(x, y, z) of the side of a thing that the road sees; z counts from the road, the ground beside it lies BESIDE higher."""
    top, side = thing.height or HEIGHTS[thing.kind], thing.side
    count = int(density * (thing.end - thing.start) * min(top, 4.0))
    x, z = rng.uniform(thing.start, thing.end, count), rng.uniform(0.0, top, count)
    back = np.zeros(count)
    if thing.kind == "guard_rail":
        # a beam of 0.31 m with a wave, on posts every 2 m
        post = (np.abs((x - thing.start) % 2.0 - 1.0) < 0.05) & (z < top - 0.31)
        back = np.where(post, 0.12, 0.04 + 0.04 * np.cos(2 * np.pi * (z - top) / 0.155))
        low_beam = (z > top - 0.75) & (z < top - 0.44)
        ropes = (np.abs((top - z) % 0.13) < 0.02) & (z > top - 0.45)
        kept = post | (ropes if thing.form == "ropes" else (z > top - 0.31) | (low_beam if thing.form == "double" else False))
    elif thing.kind == "barrier":
        # New Jersey section: foot, slope of 55 degrees, steep upper part, top
        back = np.interp(z, [0.0, 0.08, 0.33, top], [0.0, 0.0, 0.18, 0.23])
        kept = np.ones(count, bool)
    elif thing.kind == "fence":
        kept = rng.random(count) < 0.35
    elif thing.kind == "hedge":
        back = rng.exponential(0.4, count) if thing.form == "loose" else np.abs(rng.normal(0.0, 0.10, count))
        kept = back < 0.9
        over = rng.random(count) < 0.3
        z, back = np.where(over, top + rng.normal(0.0, 0.05, count), z), np.where(over, rng.uniform(0.0, 0.8, count), back)
    elif thing.kind == "cars":
        # 4.5 m of car every 5.8 m, bonnet lower than roof, none parked quite like the next
        number, along = np.floor(x / 5.8), x % 5.8
        back = 0.25 * np.sin(7.0 * number) + 0.25
        roof = np.where((along > 1.2) & (along < 3.6), top, 0.85)
        over = rng.random(count) < 0.4
        z = np.where(over, roof, z * roof / top)
        back = np.where(over, back + rng.uniform(0.0, 1.6, count), back)
        kept = (along < 4.5) & (z > 0.2)
    else:
        kept = np.ones(count, bool)
    return x[kept], thing.offset + side * back[kept], z[kept] + BESIDE


def pole_points(x, y, diameter, height, rng, plate=0.0, crown=0.0):
    """(x, y, z) of a pole: of its half towards the road, with a plate of some width across or a crown on top."""
    count = int(1200 * max(diameter, 0.05) * height)
    angle = rng.uniform(-np.pi / 2, np.pi / 2, count) + (np.pi / 2 if y < 0 else -np.pi / 2)
    parts = [(x + diameter / 2 * np.cos(angle), y + diameter / 2 * np.sin(angle), rng.uniform(0, height, count))]
    if plate:
        across = y + rng.uniform(-plate / 2, plate / 2, 800)
        parts.append((x + rng.normal(0, 0.005, 800), across, rng.uniform(height - plate, height, 800)))
    if crown:
        parts.append((x + rng.normal(0, crown, 4000), y + rng.normal(0, crown, 4000), rng.normal(height, crown / 2, 4000).clip(2.3)))
    px, py, pz = (np.concatenate(v) for v in zip(*parts))
    return px, py, pz + BESIDE


def hidden_by(things):
    """The function `hides` of measured_road: what lies behind a solid thing and below the line of sight over it."""
    def hides(eye, x, y, z):
        found = np.zeros(len(x), bool)
        for thing in things:
            if thing.kind not in SOLID:
                continue
            top = (thing.height or HEIGHTS[thing.kind]) + BESIDE
            distance, beyond = abs(thing.offset - eye), thing.side * (y - thing.offset) - 0.9 * (thing.kind == "hedge") - 1.9 * (thing.kind == "cars")
            along = (x > thing.start) & (x < thing.end) & ((x % 5.8 < 4.5) if thing.kind == "cars" else True)
            found |= along & (beyond > 0.3) & (z < top + (top - SENSOR) * beyond / distance)
        return found
    return hides


def vans(offset, length=3.5, every=6.0, start=0.0, end=LENGTH, apart=0.0):
    """Vehicles that are parked beside the road, whose sides lie up to `apart` nearer to it or farther from it."""
    rng = np.random.default_rng(3)
    return tuple(Thing("wall", offset + rng.uniform(-apart, apart), x, x + length, 1.7) for x in np.arange(start, end, every))


def road_with(things, poles=(), drives=(Drive(1, -1.75),), density=300.0, face=FACE, noise=0.005, seed=5, steepest=np.inf, **road):
    """(Survey, ROAD_EDGES) of a road of LENGTH with things beside it; `poles` are arguments of `pole_points` but for the generator, `steepest` the
    slope down (m/m) beyond which the scanner sees nothing."""
    def above(rng):
        parts = [points_of(thing, rng, face) for thing in things] + [pole_points(*pole[:4], rng, *pole[4:]) for pole in poles]
        return tuple(np.concatenate(v) for v in zip(*parts)) if parts else (np.empty(0),) * 3

    behind = hidden_by(things)

    def hides(eye, x, y, z):
        return behind(eye, x, y, z) | (SENSOR - z > steepest * np.abs(y - eye))

    survey = measured_road(drives, length=LENGTH, density=density, noise=noise, reach=14.0, above=above, hides=hides, seed=seed, **road)
    return survey, edges_of(LENGTH)
