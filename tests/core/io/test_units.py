"""Files in feet, and the CRS in metres that is worked in."""

import numpy as np
import pytest
from lanewright.core.io.crs import METRES, FileUnits, as_in_file, in_metres, parse_crs, plane_wkt, same_crs
from pyproj import CRS, Transformer

FOOT, US_FOOT = 0.3048, 1200 / 3937


@pytest.mark.parametrize("file, across, up", [
    ("EPSG:2263", US_FOOT, US_FOOT), ("EPSG:2263+6360", US_FOOT, US_FOOT), ("EPSG:2263+5703", US_FOOT, 1.0), ("EPSG:2222", FOOT, FOOT),
    ("EPSG:32632+6360", 1.0, US_FOOT), ("EPSG:4326+6360", 1.0, US_FOOT), (CRS.from_epsg(2263).to_wkt("WKT1_ESRI"), US_FOOT, US_FOOT),
])
def test_what_is_worked_in_is_metric_and_leads_back_to_the_crs_of_the_file(file, across, up):
    wkt, units = in_metres(file)
    assert (units.across, units.up) == pytest.approx((across, up), rel=1e-12)
    assert in_metres(wkt) == (wkt, units), "once is as good as twice"
    assert {axis.unit_name for axis in parse_crs(wkt).axis_info} <= {"metre", "degree"}
    back, its_units = as_in_file(wkt)
    assert CRS(back) == CRS(file) and its_units == units
    assert as_in_file(plane_wkt(wkt))[1].across == pytest.approx(across), "the horizontal part alone knows its feet too"


@pytest.mark.parametrize("file", ["", "EPSG:32632", "EPSG:4326", "EPSG:25832+5783"])
def test_a_crs_in_metres_or_degrees_stays_as_it_is(file):
    assert in_metres(file) == (file, METRES) and as_in_file(file) == (file, METRES)


def test_a_place_in_feet_and_its_metres_are_one_place_on_the_ground():
    wkt, units = in_metres("EPSG:2263")
    feet = np.array([984_250.0, 200_000.0])
    there, here = (Transformer.from_crs(crs, 4326, always_xy=True).transform(*place)
                   for crs, place in ((2263, feet), (parse_crs(wkt), units.in_metres(feet))))
    assert here == pytest.approx(there, abs=1e-12)
    assert same_crs(parse_crs(wkt), parse_crs("EPSG:32118")), "the zone of State Plane in metres"


def test_coordinates_and_rasters_go_to_the_file_and_back():
    units = FileUnits(US_FOOT, 1.0)
    places = np.array([[300_000.0, 61_000.0, 12.0]])
    np.testing.assert_allclose(units.in_file(places), [[984_250.0, 61_000.0 / US_FOOT, 12.0]])
    np.testing.assert_allclose(units.in_metres(units.in_file(places)), places, rtol=1e-15)
    assert units.geotransform(units.geotransform((300_000.0, 0.04, 0, 61_000.0, 0, -0.04), to_file=True)) == pytest.approx(
        (300_000.0, 0.04, 0, 61_000.0, 0, -0.04))
