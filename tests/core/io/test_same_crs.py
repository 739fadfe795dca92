"""Layers and clouds in CRS of different names that mean the same coordinates, or others."""

import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.io.crs import check_same_crs

PLACE = 460_000.0, 5_430_000.0


@pytest.mark.parametrize("layer", ["EPSG:32632", "EPSG:25832", ""])
def test_a_layer_whose_coordinates_are_those_of_the_clouds_is_taken_whatever_its_crs_is_called(layer):
    check_same_crs(layer, "EPSG:32632", PLACE, "Road edges")


@pytest.mark.parametrize("layer", ["EPSG:32633", "EPSG:23032", "EPSG:4326", "EPSG:31467"])
def test_a_layer_with_other_coordinates_than_the_clouds_is_refused(layer):
    place = (8.45, 49.0) if layer == "EPSG:4326" else PLACE
    with pytest.raises(RoadExtractionError, match="Reproject the layer"):
        check_same_crs(layer, "EPSG:32632", place, "Road edges")
