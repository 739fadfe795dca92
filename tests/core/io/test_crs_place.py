"""Surveys where their CRS holds, beside it, and with exchanged coordinates."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.io.crs import check_extent, check_place, in_metres, parse_crs, place_on_ground
from pyproj import Proj, Transformer


def at(code, longitude, latitude):
    """(metric WKT, coordinates in metres) of a place."""
    wkt, units = in_metres(parse_crs(code).to_wkt())
    x, y = Transformer.from_crs(4326, parse_crs(code), always_xy=True).transform(longitude, latitude)
    return wkt, (x * units.across, y * units.across)


@pytest.mark.parametrize("code, longitude, latitude", [
    ("EPSG:32632", 11, 48), ("EPSG:25832", 13.8, 48.5), ("EPSG:25833", 5, 60), ("EPSG:2154", 9, 41.5), ("EPSG:3950", 3, 50),
    ("EPSG:27700", -3, 57), ("EPSG:2056", 7, 47), ("EPSG:28992", 5, 52), ("EPSG:31467", 9, 50), ("EPSG:5514", 14, 50), ("EPSG:27572", 2.5, 48),
    ("EPSG:27561", 2.5, 49), ("EPSG:32760", 179.9, -18), ("EPSG:2263", -74, 40.7), ("EPSG:2222", -110, 34), ("EPSG:3035", 10, 52),
])
def test_a_survey_in_a_grid_made_for_measuring_passes_without_a_word(code, longitude, latitude):
    assert check_place(*at(code, longitude, latitude), "The point cloud") == ""


@pytest.mark.parametrize("code, longitude, latitude, scale", [
    ("EPSG:3857", 13, 52.5, "1.64"), ("EPSG:3857", 104, 1.3, "1.007"), ("EPSG:3395", 13, 52, "1.62"), ("EPSG:32662", 13, 52, "1.62"),
    ("EPSG:3034", 10, 52, "0.966"), ("EPSG:5070", -74, 40.7, "0.99"), ("EPSG:6933", 10, 52, "0.71"), ("EPSG:32631", 30, 52, "1.041"),
    ("EPSG:2154", 13, 13, "1.1"),
])
def test_where_lengths_are_not_those_on_the_ground_the_scale_is_said(code, longitude, latitude, scale):
    with pytest.raises(RoadExtractionError, match=f"Lengths in it are {scale}"):
        check_place(*at(code, longitude, latitude), "The point cloud")


def test_scale_agrees_with_what_proj_says_of_a_conformal_and_an_equal_area_projection():
    for code, longitude, latitude in (("EPSG:32632", 12, 47), ("EPSG:3035", -8, 38)):
        factors = Proj(parse_crs(code)).get_factors(longitude, latitude)
        found = place_on_ground(parse_crs(code), *at(code, longitude, latitude)[1])
        assert min(abs(found.scale - axis) for axis in (factors.tissot_semimajor, factors.tissot_semiminor)) < 1e-4


@pytest.mark.parametrize("code, longitude, latitude", [("EPSG:32650", 118, 24.5), ("EPSG:25832", 9, 49), ("EPSG:31467", 9, 50), ("EPSG:2056", 8, 47)])
def test_x_and_y_exchanged_are_recognised_by_the_area_of_the_crs(code, longitude, latitude):
    wkt, (x, y) = at(code, longitude, latitude)
    with pytest.raises(RoadExtractionError, match="The point cloud has x and y exchanged"):
        check_place(wkt, (y, x), "The point cloud")


@pytest.mark.parametrize("code", ["EPSG:2154", "EPSG:25832"])
def test_a_local_system_that_bears_the_name_of_a_grid_is_taken_with_a_word(code):
    assert "local system" in check_place(code, (300.0, 400.0), "The point cloud")


def test_a_survey_far_outside_its_zone_is_taken_with_a_word_where_lengths_hold():
    assert "outside the area of its CRS OSGB36" in check_place("EPSG:27700", (610_530.0, 2_710_120.0), "The point cloud")


@pytest.mark.parametrize("low, high", [((2e6, 0), (0, 0)), ((0, 0), (0, 2e6))])
def test_a_point_astray_moves_a_survey_to_no_other_place(low, high):
    """A point 2,000 km away, where a clock that jumps puts it, is one corner of the bounds."""
    wkt, place = at("EPSG:32650", 118.1, 24.5)
    assert check_extent(wkt, (np.subtract(place, low), np.add(place, high)), "The point cloud") == ""
    with pytest.raises(RoadExtractionError, match="outside the area"):
        check_extent(wkt, np.add(place, [(2e6, 0), (4e6, 0)]), "The point cloud")
