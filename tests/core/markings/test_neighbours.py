"""Who a point's neighbours are, and how far: against distances of every point to every other."""

import numpy as np
import pytest
from lanewright.core.markings.outliers import Neighbours
from scipy.spatial.distance import cdist


def paint(count, extent, seed=0):
    """Points on a slightly uneven ground, units of 0.1 mm."""
    random = np.random.default_rng(seed)
    return np.rint(random.uniform(-0.5, 0.5, (count, 3)) * [extent, extent, 0.02] * 1e4).astype(np.int32)


def among_all(units, k):
    return np.sort(cdist(units, units), axis=1)[:, 1:k + 1] * 1e-4


SCENES = {
    "dense paint": paint(900, 1.0),
    "paint across the borders of several tiles": paint(900, 60.0),
    "points at the same places": np.repeat(paint(150, 1.0), 6, axis=0),
    "many points at the same places": np.repeat(paint(20, 1.0), 45, axis=0),
    "many points at the same places, three kilometres apart": np.repeat(np.r_[paint(10, 1.0), paint(10, 1.0, 1) + [30_000_000, 0, 0]], 45,
                                                                        axis=0).astype(np.int32),
    "two patches, three kilometres apart": np.r_[paint(300, 1.0), paint(300, 1.0, 1) + [30_000_000, 0, 0]].astype(np.int32),
    "a lone point beside dense paint": np.r_[paint(300, 1.0), [[200_000, 5, 5]]].astype(np.int32),
    "fewer points than neighbours": paint(7, 1.0),
    "two points": paint(2, 1.0),
}


@pytest.mark.parametrize("scene", SCENES)
def test_distances_are_those_among_all_points(scene):
    units = SCENES[scene]
    expected = among_all(units, 12)
    neighbours = Neighbours(units, 12)
    everyone = np.arange(len(units))
    distances, nearest = neighbours.distances(everyone), neighbours.nearest(everyone)
    np.testing.assert_allclose(distances, expected.mean(axis=1), rtol=1e-6)
    if len(np.unique(units, axis=0)) == len(units):
        reached = np.sqrt(((units[nearest].astype(float) - units[:, None]) ** 2).sum(axis=2)) * 1e-4
        np.testing.assert_allclose(np.sort(reached, axis=1), expected, rtol=1e-6)


def test_asking_for_some_points_tells_of_those_and_in_their_order():
    units = paint(500, 1.0)
    some = np.array([[77, 3], [410, 77]])
    whole, asked = Neighbours(units, 5), Neighbours(units, 5)
    np.testing.assert_array_equal(asked.distances(some), whole.distances(np.arange(500))[some])
    np.testing.assert_array_equal(asked.nearest(some.ravel()), whole.nearest(np.arange(500))[some.ravel()])
    np.testing.assert_array_equal(asked.distances(np.arange(500)), whole.distances(np.arange(500)))


def test_a_point_by_itself_has_nobody():
    lonely = Neighbours(paint(1, 1.0), 20)
    assert np.isinf(lonely.distances(np.arange(1))).all() and lonely.nearest(np.arange(1)).shape == (1, 0)


def test_no_points_have_no_distances():
    assert len(Neighbours(np.empty((0, 3), np.int32), 20).distances(np.empty(0, int))) == 0
    assert len(Neighbours(paint(30, 1.0), 5).nearest(np.empty(0, int))) == 0
