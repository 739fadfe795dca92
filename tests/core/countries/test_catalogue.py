"""What the catalogue of countries says is possible on a road, and has a source."""

import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.countries.catalogue import COUNTRIES, country


@pytest.mark.parametrize("one", COUNTRIES.values(), ids=list(COUNTRIES))
def test_lanes_dashes_and_curves_of_a_country_are_possible(one):
    assert one.narrowest_lane < one.usual_lane < one.widest_lane
    assert all(0.08 <= width <= 0.5 for width in one.line_widths)
    assert max(pattern.dash for pattern in one.dash_patterns) < one.longest_dash
    for slower, faster in zip(one.design_speeds[:-1], one.design_speeds[1:]):
        assert slower.speed < faster.speed and slower.radius < faster.radius and slower.length <= faster.length
    assert one.design_code and all(source.endswith(".") for source in one.sources)


def test_the_neutral_country_admits_the_lanes_and_dashes_of_all():
    neutral = country("neutral")
    for one in COUNTRIES.values():
        assert neutral.narrowest_lane <= one.narrowest_lane and neutral.widest_lane >= one.widest_lane
        assert neutral.longest_dash >= one.longest_dash


def test_the_radius_for_70_mph_is_the_published_one():
    """1,815 ft at 8 % superelevation and a side friction of 0.10."""
    row = country("united-states").design_speeds[-1]
    assert row.speed == 113
    assert row.radius == pytest.approx(1815 * 0.3048, rel=1e-3)


def test_an_unknown_country_is_refused_with_the_known_ones():
    with pytest.raises(RoadExtractionError, match="neutral, china, germany, japan, united-states"):
        country("atlantis")
