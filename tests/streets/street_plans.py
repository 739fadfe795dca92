"""Streets in plan: raised areas of any shape beside and in a carriageway, as a dense scan of them."""

import numpy as np
import shapely
from curbed_streets import SENSOR, survey_of

SPACING = 0.08
WIDTH, LENGTH = 13.0, 36.0  # m either side of the driven line, m driven


def scan(raised, height=0.12, noise=0.003, grade=0.0, hidden=None, spacing=SPACING, seed=8, within=None):
    """(x, y, z, time) of level ground with raised areas, their faces upright.

    raised : polygon or collection of them; hidden : polygon within which nothing is seen
    grade : rise across, m per m; spacing : m between points; within : x, y from and x, y to of the ground that is scanned, if not of all
    """
    rng = np.random.default_rng(seed)
    west, south, east, north = within or (-3.0, -WIDTH, LENGTH + 3.0, WIDTH)
    x, y = (v.ravel() for v in np.meshgrid(np.arange(west, east, spacing), np.arange(south, north, spacing)))
    x, y = x + rng.uniform(0, spacing, len(x)), y + rng.uniform(0, spacing, len(y))
    z = np.where(shapely.contains_xy(raised, x, y), height, 0.0)
    faces = shapely.get_coordinates(shapely.segmentize(shapely.boundary(raised), 0.05))
    up = np.arange(0.01, height, 0.02)
    x = np.r_[x, np.repeat(faces[:, 0], len(up))]
    y = np.r_[y, np.repeat(faces[:, 1], len(up))]
    z = np.r_[z, np.tile(up, len(faces))]
    seen = (y > south) & (y < north) & (x > west) & (x < east)
    if hidden is not None:
        seen &= ~shapely.contains_xy(hidden, x, y)
    x, y, z = x[seen], y[seen], z[seen] + grade * y[seen]
    x, y, z = (v + rng.normal(0.0, noise, len(v)) for v in (x, y, z))
    return x, y, z, 1000.0 + np.clip(x, 0, LENGTH) / 10


def with_points(points, x, y, z):
    """A scan with further points."""
    return tuple(np.r_[a, b] for a, b in zip(points, (x, y, z, 1000.0 + np.clip(x, 0, LENGTH) / 10)))


def survey_along(points, offset=0.0):
    """A Survey of a scan, driven straight along y = offset."""
    s = np.linspace(0, LENGTH, int(LENGTH * 10) + 1)
    return survey_of(points, (1000.0 + s / 10, s, np.full(len(s), offset), np.full(len(s), SENSOR)))


def sidewalks(half=3.5):
    """Raised ground on both sides of a straight street."""
    return shapely.union_all([shapely.box(-9, half, LENGTH + 9, 30), shapely.box(-9, -30, LENGTH + 9, -half)])


def side_street(half=3.5, start=16.0, end=23.0, radius=5.0):
    """Raised ground of a street with a side street on the left between two stations; corners of a radius."""
    corners = [shapely.box(-29, half, start, 40), shapely.box(end, half, LENGTH + 29, 40)]
    rounded = [shapely.buffer(shapely.buffer(area, -radius), radius, quad_segs=64) for area in corners]
    return shapely.union_all([*rounded, shapely.box(-9, -30, LENGTH + 9, -half)])
