"""Which chains of steps look like a curb."""

import numpy as np
import pytest
from lanewright.core.road.common.corners import CurbSteps
from lanewright.core.road.common.curb_limits import CurbLimits
from lanewright.core.road.common.tracking import curb_chains

AUTOMATIC = CurbLimits.of(0.0, 0.0, 0.05, 60.0)


def curbs(*chains, height=0.04, limits=AUTOMATIC, width=0.25, run=0.0):
    """(start, end) of those of some chains (from, to, m of scatter, m aside) of steps of a low curb that are taken for a curb."""
    s = np.concatenate([np.arange(a, b + 0.01, width) for a, b, *_ in chains])
    label = np.concatenate([np.full(len(np.arange(a, b + 0.01, width)), k) for k, (a, b, *_) in enumerate(chains)])
    scatter, aside = (np.array([chain[k] for chain in chains])[label] for k in (2, 3))
    ones = np.ones(len(s))
    # every other step lies out by twice the distance of each from the chord of its neighbours
    u = 3.5 + aside + 0.5 * scatter * (-1.0) ** np.rint(s / width)
    steps = CurbSteps(profile=np.rint(s / width).astype(int), s=s, u=u, h=0 * s, skew=0 * s, height=height * ones, run=run * ones,
                      noise=0.003 * ones, scanner_noise=0.003 * ones, support=50 * ones, behind=20 * ones, hidden=0 * s)
    return [(chain.start, chain.end) for chain in curb_chains(steps, label, width, limits)]


def test_a_low_curb_that_scatters_more_is_one_where_it_continues_another():
    assert curbs((0.0, 6.0, 0.002, 0.0), (8.0, 10.0, 0.009, 0.0), (12.0, 13.0, 0.009, 0.0)) == [(0.0, 6.0), (8.0, 10.0), (12.0, 13.0)]
    assert curbs((0.0, 1.0, 0.009, 0.0), (3.0, 5.0, 0.009, 0.0), (8.0, 14.0, 0.002, 0.0)) == [(0.0, 1.0), (3.0, 5.0), (8.0, 14.0)]


@pytest.mark.parametrize("other", [(8.0, 10.0, 0.009, 1.0), (16.0, 18.0, 0.009, 0.0), (8.0, 10.0, 0.015, 0.0)],
                         ids=["aside", "far away", "scatters widely"])
def test_elsewhere_it_is_not(other):
    assert curbs((0.0, 6.0, 0.002, 0.0), other) == [(0.0, 6.0)]


def test_alone_it_is_not():
    assert curbs((0.0, 6.0, 0.009, 0.0)) == []


def test_who_asks_for_a_height_gets_no_lower_curb():
    assert curbs((0.0, 6.0, 0.002, 0.0), (8.0, 10.0, 0.009, 0.0), limits=CurbLimits.of(0.05, 60.0, 0.05, 60.0)) == []


def test_two_steps_alone_do_not_show_that_they_lie_in_line():
    assert curbs((0.0, 6.0, 0.0, 0.0), (8.0, 8.5, 0.0, 0.0), height=0.12, width=0.5) == [(0.0, 6.0)]
    assert curbs((0.0, 6.0, 0.0, 0.0), (8.0, 9.0, 0.0, 0.0), height=0.12, width=0.5) == [(0.0, 6.0), (8.0, 9.0)]


def test_a_sloped_curb_is_ten_metres_long_or_none():
    """The edge of worn cobbles or of a track is as straight over a few metres."""
    assert curbs((0.0, 9.0, 0.002, 0.0), (20.0, 31.0, 0.002, 0.0), (40.0, 51.0, 0.015, 0.0), height=0.1, run=0.1) == [(20.0, 31.0)]
