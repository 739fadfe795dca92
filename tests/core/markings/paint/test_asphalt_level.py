"""How bright paint must be."""

import numpy as np
import pytest
from lanewright.core.intensity.asphalt_model import asphalt_statistics
from lanewright.core.markings.paint.asphalt_level import asphalt_bins, background, bin_edges, otsu, patch_level, split_bins
from lanewright.core.survey.store.records import to_units

RNG = np.random.default_rng(4)


def test_otsu_parts_two_materials_between_them():
    values = np.r_[RNG.normal(0, 1, 9000), RNG.normal(12, 1, 1000)]
    threshold, below, above, share = otsu(values)
    assert 3 < threshold < 9
    assert (below, above, share) == (pytest.approx(0, abs=0.1), pytest.approx(12, abs=0.1), pytest.approx(0.1, abs=0.005))


def test_otsu_of_one_value_has_nothing_above():
    assert otsu(np.full(100, 7.0))[3] == 0.0


@pytest.mark.parametrize("share", [0.0, 0.1, 0.4])
def test_paint_does_not_change_what_asphalt_is(share):
    count = int(20000 * share)
    values = np.r_[RNG.normal(1000, 80, 20000 - count), RNG.normal(4000, 400, count)]
    median, spread = asphalt_statistics(values)
    assert median == pytest.approx(1000, rel=0.02)
    assert spread == pytest.approx(80, rel=0.15)


@pytest.mark.parametrize("dark", [100, 300, 500])
def test_dark_repairs_and_water_do_not_change_what_asphalt_is(dark):
    values = np.r_[RNG.normal(1000, 60, 16_000), RNG.normal(dark, 20, 3_000), RNG.normal(4000, 400, 1_000)]
    median, spread = asphalt_statistics(values)
    assert median == pytest.approx(1000, rel=0.02)
    assert spread == pytest.approx(60, rel=0.15)


def test_bins_are_as_wide_as_the_points_are_dense_within_limits():
    for sigma, width in ((0.3, 0.75), (1.5, 1.5), (8.0, 3.0)):
        edges = bin_edges(to_units(RNG.normal(0.0, sigma, 50_000)), -5.0, 5.0)
        np.testing.assert_allclose(np.diff(edges), width, rtol=0.03)
        assert edges[0] <= -5.0 and edges[-1] >= 5.0


def split_of(z, separation=4.0, highest=np.inf):
    window = z.reshape(-1, 10), np.ones((len(z) // 10, 10), bool), np.linspace(-0.9, 0.9, 10)
    bins = asphalt_bins(*window, np.array([-1.0, 1.0]))
    (split,) = split_bins(*window, bins, separation, highest)
    return split


def test_asphalt_alone_is_not_parted():
    assert not split_of(RNG.normal(0, 1, 20_000)).accepted


def test_a_patch_of_lighter_asphalt_is_not_paint():
    assert not split_of(np.r_[RNG.normal(0, 1, 15_000), RNG.normal(2.5, 1, 5_000)]).accepted


@pytest.mark.parametrize("share", [0.01, 0.10, 0.40])
def test_paint_is_parted_also_where_it_covers_much_of_the_road(share):
    count = int(20_000 * share)
    split = split_of(np.r_[RNG.normal(0, 1, 20_000 - count), RNG.normal(15, 3, count)])
    assert split.accepted
    assert 2 < split.threshold < 12


@pytest.mark.parametrize("share", [0.40, 0.48])
def test_a_zebra_crossing_over_half_of_a_bin_leaves_its_threshold_where_asphalt_ends(share):
    count = int(20_000 * share)
    asphalt = np.r_[RNG.normal(0, 1, 18_000 - count), RNG.normal(2, 1, 2_000)]
    split = split_of(np.r_[asphalt, RNG.normal(15, 3, count)], highest=8.0)
    assert split.accepted
    assert split.spread == pytest.approx(1.2, abs=0.4)
    assert 2 < split.threshold < 12


def test_bins_with_few_cells_join_their_neighbour():
    counted = np.arange(600)[:, None] < [600, 100, 600, 20]
    bins = asphalt_bins(RNG.normal(0, 1, counted.shape), counted, np.arange(4) + 0.5, np.arange(0.0, 5.0))
    assert [b.count for b in bins] == [600, 720]


@pytest.mark.parametrize("striped", [0.3, 0.49, 0.51, 0.7])
def test_asphalt_is_the_same_whether_stripes_cover_less_than_half_of_a_bin_or_more(striped):
    rng = np.random.default_rng(4)
    values = rng.normal(5000.0, 300.0, (100, 40))
    far = np.zeros(values.shape, bool)
    far[:, 20:] = rng.random((100, 20)) < striped
    values[far] = rng.normal(25_000.0, 4000.0, far.sum())
    bins = asphalt_bins(values, np.ones(values.shape, bool), np.arange(40) + 0.5, np.array([0.0, 20.0, 40.0]), usual=5000.0)
    assert [b.median for b in bins] == pytest.approx([5000.0, 5000.0], rel=0.05)
    assert [b.spread for b in bins] == pytest.approx([300.0, 300.0], rel=0.25)


def test_the_background_follows_a_patch_and_not_the_paint_on_it():
    z = np.zeros((300, 200))
    z[100:] = 2.0
    z[:, 95:99] = 20.0
    level = background(z, z < 5)
    assert level[50, 97] == pytest.approx(0.0, abs=0.01)
    assert level[250, 97] == pytest.approx(2.0, abs=0.01)


def test_a_patch_is_lifted_with_its_paint_and_bold_letters_are_none():
    z = RNG.normal(0, 1, (200, 200))
    patch, letters = (slice(20, 80), slice(20, 80)), (slice(120, 180), slice(120, 180))
    z[patch] += 8.0
    z[40:44, 20:80] += 20.0
    strokes = np.zeros((60, 60), bool)
    strokes[np.arange(60) % 7 < 4] = True
    z[letters][strokes] += 25.0
    level = patch_level(z, 2.5)
    assert np.median(level[patch]) == pytest.approx(8.0, abs=1.0)
    assert not level[letters].any()
