"""Where a road's straights end and its arcs begin."""

import numpy as np
import pytest
from lanewright.core.curves.segmentation import element_ranges


def alignment(*parts, step=0.5, noise=0.01, seed=3):
    """Points along straights, arcs and clothoids given as (length, curvature at start, at end)."""
    curvature = np.concatenate([np.linspace(a, b, int(length / step), endpoint=False) for length, a, b in parts])
    heading = np.r_[0.0, np.cumsum(curvature[:-1] * step)] + curvature * step / 2
    x = np.r_[0.0, np.cumsum(step * np.cos(heading))]
    y = np.r_[0.0, np.cumsum(step * np.sin(heading))]
    scatter = np.random.default_rng(seed).normal(0.0, noise, (2, len(x)))
    return x + scatter[0], y + scatter[1]


@pytest.mark.parametrize("radius", [60.0, 120.0, 400.0])
def test_an_arc_between_two_straights_is_found_within_a_node_of_its_ends(radius):
    elements, = element_ranges([alignment((40, 0, 0), (60, 1 / radius, 1 / radius), (50, 0, 0))])
    assert [kind for *_, kind in elements] == ["line", "circle", "line"]
    assert elements[1][0] == pytest.approx(40, abs=6) and elements[1][1] == pytest.approx(100, abs=6)


def test_a_bend_is_never_called_straight():
    (_, _, kind), = element_ranges([alignment((80, 1 / 90, 1 / 90))])[0]
    assert kind == "circle"


def test_a_straight_road_is_one_straight():
    (_, _, kind), = element_ranges([alignment((150, 0, 0))])[0]
    assert kind == "line"
