"""Curbs of side streets that lead on beyond the corridor, where a metre of curb holds a few points."""

import numpy as np
import pytest
from lanewright.core.road.curb_returns.side_streets import CurbEnd, led_beyond

HEIGHT = 0.13


def end_of(height=HEIGHT):
    """The end of a straight curb along x, uphill on its left, known for 6 m."""
    at = np.arange(-6.0, 0.1, 0.5)
    return CurbEnd(0.0, 0.0, 0.0, 1.0, 0.0, -1.0, height, np.stack([at, np.random.default_rng(2).normal(0.0, 0.01, len(at)), 0.0 * at]))


def arm(height=HEIGHT, length=20.0, bend=0.0, dropped=0.0, grade=0.01, side=1.0, seed=1, slope=0.0):
    """Ground of an arm: t, u, z of points that thin out from 35 to 2 a metre, with a curb, dropped at first."""
    rng = np.random.default_rng(seed)
    t = np.concatenate([k + rng.random(int(2 + 33 * np.exp(-k / 5.0))) for k in np.arange(0.0, length)])
    u = rng.uniform(-0.8, 0.8, len(t))
    up = u > 0.5 * bend * t * t
    z = grade * t + np.where(up & (t > dropped), height, 0.0) + slope * u + rng.normal(0.0, 0.008, len(t))
    return (t, u, z) if side else (t[~up], u[~up], z[~up])


def test_an_arm_of_a_crossing_is_known_to_forty_five_metres():
    """Its curb is found to 25 m from the road, and seen for 20 m more."""
    found = led_beyond(*arm(), end_of())
    assert found.end > 17.0 and found.start == 0.0
    off = found.arc[0] + found.arc[1] * found.end + 0.5 * found.arc[2] * found.end**2
    assert abs(off) < 0.08 and abs(found.levels[2] - HEIGHT) < 0.015 and abs(found.levels[1] - 0.01) < 0.003


def off_the_curb(bend, seed):
    """Every metre how far the course of a bent arm lies off, and its sigma, m."""
    found = led_beyond(*arm(bend=bend, seed=seed), end_of())
    t = np.arange(found.start, found.end)
    return found.arc[0] + found.arc[1] * t + 0.5 * (found.arc[2] - bend) * t**2, found.sigma(t)


@pytest.mark.parametrize("bend", [-0.005, 0.0, 0.005])
def test_an_arm_may_bend_evenly_and_its_course_says_how_uncertain_it_is(bend):
    arms = [off_the_curb(bend, seed) for seed in range(1, 11)]
    off, sigma = (np.concatenate(values) for values in zip(*arms))
    assert np.median([len(along) for along, _ in arms]) > 14
    assert np.median([np.abs(along).max() for along, _ in arms]) < 0.07
    assert np.mean(np.abs(off) < sigma) > 0.4 and np.mean(np.abs(off) < 3 * sigma) > 0.9


def test_the_fewer_returns_an_arm_has_the_less_sure_is_its_course():
    t, u, z = arm()
    dense, thin = led_beyond(t, u, z, end_of()), led_beyond(t[::3], u[::3], z[::3], end_of())
    at = np.array([5.0, 10.0])
    assert (thin.sigma(at) > 1.2 * dense.sigma(at)).all() and (dense.sigma(at) > 0.005).all()


def test_a_curb_goes_on_behind_a_crossing_where_it_is_dropped():
    found = led_beyond(*arm(dropped=5.0), end_of())
    assert 3.0 <= found.start <= 6.0 and found.end > 16.0


def test_where_the_ground_is_flat_or_slopes_no_curb_leads_on():
    assert led_beyond(*arm(height=0.0), end_of()) is None
    assert led_beyond(*arm(height=0.0, slope=0.08), end_of()) is None


def test_where_only_the_street_is_seen_or_hardly_anything_none_leads_on():
    assert led_beyond(*arm(side=0.0), end_of()) is None
    assert led_beyond(*(v[::40] for v in arm()), end_of()) is None
    assert led_beyond(*np.empty((3, 0)), end_of()) is None


def test_a_curb_of_another_height_is_another_curb():
    assert led_beyond(*arm(height=0.3), end_of()) is None
    assert led_beyond(*arm(height=0.04), end_of()) is None
