"""Bright things that stand above the road are no paint; paint on a crown, a ramp or a hump lies on the road."""

import numpy as np
import pytest
from lanewright.core.intensity.image import make_intensity_image
from lanewright.core.markings.paint.extract import extract_markings
from lanewright.core.markings.paint.not_paint import raised_cells
from painted_streets import drive, road_points, street, strip

SHAPE = 300, 200     # cells of 4 cm: 12 m along the road, 8 m across it
S, D = ((np.arange(n) + 0.5) * 0.04 for n in SHAPE)
FRAME = drive()


def square(s0, s1, d0, d1):
    return ((S > s0) & (S < s1))[:, None] & ((D > d0) & (D < d1))


def raised(mask, height, noise=0.004, points=3):
    """(rows, columns) bool, of cells of such heights in m, seen by so many points each."""
    rng = np.random.default_rng(4)
    cell = np.repeat(np.arange(mask.size, dtype=np.int32), points)
    z = np.broadcast_to(height, SHAPE).ravel()[cell] + rng.normal(0.0, noise, len(cell))
    return raised_cells([(cell, np.rint(z * 1e4).astype(np.int32))], mask)


STRIPES = np.any([square(3.0, 6.0, d, d + 0.5) for d in (1.0, 2.0, 3.0, 4.0)], axis=0)
ISLAND = square(6.28, 8.0, 2.0, 3.6)


@pytest.mark.parametrize("step", [0.03, 0.12], ids=["dropped curb", "curb"])
def test_the_bright_end_of_an_island_is_raised_and_the_stripes_beside_it_are_not(step):
    found = raised(STRIPES | ISLAND, 0.02 * D + np.where(ISLAND, step, 0.0))
    assert found[ISLAND].mean() > 0.9 and not found[STRIPES].any()


def test_an_island_of_which_one_part_is_dark_is_raised():
    bright = ISLAND & square(0, 20, 2.0, 2.8)
    found = raised(STRIPES | bright, 0.02 * D + np.where(ISLAND, 0.04, 0.0))
    assert found[bright].mean() > 0.9 and not found[STRIPES].any()


def test_the_lower_part_of_a_curb_face_is_raised_as_one_piece():
    face = square(2.5, 8.5, 2.0, 2.2)
    height = 0.02 * D + np.where(face, 0.15 * (D - 2.0), 0.0)   # 1.5 cm on average: less than a single square would have to stand up
    found = raised(face | square(2.5, 8.5, 4.0, 4.5), height)
    assert found[face].all() and found.sum() == face.sum()


@pytest.mark.parametrize("height", [
    0.0 * D, 0.025 * np.abs(D - 4.0), 0.06 * S[:, None], 0.05 * (1 - np.cos(2 * np.pi * S[:, None] / 4.0)),
], ids=["level", "crown", "slope", "hump"])
def test_paint_on_the_road_is_not_raised(height):
    assert not raised(STRIPES, height).any()


def test_paint_6_mm_thick_and_heights_that_scatter_by_2_cm_are_not_raised():
    assert not raised(STRIPES, np.where(STRIPES, 0.006, 0.0)).any()
    assert raised(STRIPES, 0.02 * D, noise=0.02).mean() < 0.001


def test_where_nothing_but_paint_was_scanned_nothing_is_raised():
    everywhere = np.ones(SHAPE, bool)
    assert not raised(everywhere, 0.1 * square(3, 4, 3, 4)).any()


def test_a_bright_island_on_the_road_is_no_paint():
    stripes, island = [strip(20, 23, d, d + 0.5) for d in (-2.0, -1.0, 0.0, 1.0)], strip(23.3, 24.1, -0.6, 0.0)
    records = street(FRAME, [*stripes, island], density=1500)
    on_island = island(records["s"] * 1e-4, records["d"] * 1e-4)
    for height, share in ((0.0, 1.0), (0.035, 0.0)):
        heights = records.copy()
        heights["z"][on_island] += int(height * 1e4)
        points = road_points(heights, FRAME)
        paint = extract_markings(points, make_intensity_image(points), FRAME).all_points()
        assert island(paint.s, paint.d).sum() == pytest.approx(share * on_island.sum(), abs=0.12 * on_island.sum())
        assert sum(mark(paint.s, paint.d).sum() for mark in stripes) > 7000
