"""What is refused, what is warned of, and what the errors of a georeferenced image are."""

import numpy as np
import pytest
from flown_images import HEIGHT, WIDTH, ground, image, measured
from lanewright.core.common.errors import RoadExtractionError
from lanewright.products.overlay.control_points import control_points
from lanewright.products.overlay.georeference import GeoreferenceSettings, georeference, residual_vectors


def placed(order=2, points=None, seen=None, **more):
    settings = {key: more.pop(key) for key in ("extrapolation", "pixel_size", "check_disabled") if key in more}
    return georeference(seen or image(), points if points is not None else measured(**more), GeoreferenceSettings(order=order, **settings))


def refusal(*arguments, **more):
    with pytest.raises(RoadExtractionError) as refused:
        placed(*arguments, **more)
    return str(refused.value)


def notes(found):
    return " ".join(found.notes)


@pytest.mark.parametrize("order, fewest", [(1, 3), (2, 6), (3, 10)])
def test_one_point_too_few_is_refused_and_the_fewest_are_warned_of(order, fewest):
    told = refusal(order, count=fewest - 1)
    assert f"There are {fewest - 1} control points" in told and f"needs {fewest}" in told
    assert "the fewest for order" in notes(placed(order, count=fewest, extrapolation="leave-out"))


def test_no_point_shifts_nothing():
    told = refusal(0, measured(count=1, roles=["disabled"]), seen=image(geotransform=(0, 1, 0, 0, 0, -1)))
    assert "There are 0 control points (1 more are disabled or check points)" in told


def test_points_along_a_road_are_refused_as_a_line():
    places = [(20 + 50 * k, 200 + 0.5 * (-1) ** k) for k in range(11)]
    for order in (1, 2, 3):
        assert "lie in a line: they spread 500 pixels along it and 1 pixels across" in refusal(order, places=places)


def test_points_in_two_rows_do_not_tell_a_second_order():
    places = [(20 + 60 * k, line) for k in range(9) for line in (50, 350)]
    assert "choose order 1" in refusal(2, places=places)
    assert placed(1, places=places).rmse() > 0.05


def test_points_piled_on_each_other_are_not_six():
    places = [(10, 10), (590, 15), (300, 390)] * 3
    assert "not determined" in refusal(2, places=places)


def test_few_points_are_warned_of_and_enough_are_not():
    assert "the residuals are smaller than the errors" in notes(placed(2, count=8))
    assert "smaller than the errors" not in notes(placed(2, count=9))


def test_a_shift_needs_a_rough_position_or_a_pixel_size():
    told = refusal(0, measured(count=4))
    assert "nothing to shift (order 0)" in told and "pixel size" in told


def test_a_shift_by_pixel_size_lies_north_up():
    found = placed(0, measured(count=4, bend=0.0, turn=0.0), pixel_size=0.05)
    np.testing.assert_allclose(found.fit.polynomial.to_map([0.0, WIDTH], [0.0, HEIGHT]),
                               ground([0.0, WIDTH], [0.0, HEIGHT], bend=0.0, turn=0.0), atol=1e-6)


def test_a_shift_of_an_image_in_another_crs_is_refused_by_name():
    from pyproj import CRS

    seen = image(geotransform=(0, 0.05, 0, 0, 0, -0.05), crs=CRS("EPSG:25832").to_wkt())
    told = refusal(0, measured(count=2), seen=seen)
    assert "ETRS89 / UTM zone 32N" in told and "WGS 84 / UTM zone 50N" in told


def test_control_points_in_degrees_are_refused_by_name():
    assert "degrees" in refusal(1, measured(crs="EPSG:4326"))


def test_a_web_map_is_warned_of_since_its_metres_are_none():
    points = measured(crs="EPSG:3857")
    points.easting[:], points.northing[:] = points.easting - 610_400 + 935_000, points.northing - 5_710_200 + 6_275_000  # 49° north
    assert "a metre of the map is 0.66 m on the ground" in notes(placed(2, points))
    assert "on the ground" not in notes(placed(2))


def test_a_local_system_of_a_building_site_will_do():
    local = 'LOCAL_CS["Site",LOCAL_DATUM["Site",0],UNIT["metre",1],AXIS["X",EAST],AXIS["Y",NORTH]]'
    assert placed(2, measured(crs=local)).rmse() < 1e-6


def test_swapped_pixel_and_line_are_told_as_a_mirror_image():
    points = measured(count=9, places=[(p, q) for p in (20, 200, 390) for q in (30, 150, 380)])
    swapped = control_points(["line", "pixel", "x", "y"], list(zip(points.pixel, points.line, points.easting, points.northing)),
                             image(), "The table", points.crs)
    assert "mirror image" in refusal(1, swapped)


def test_a_point_that_folds_the_image_is_named():
    points = measured(count=12)
    points.easting[5] += 30.0
    points.northing[5] -= 30.0
    told = refusal(3, points)
    assert "folds" in told and "(check 6 first)" in told


def test_a_point_that_does_not_fit_is_named_with_its_distance():
    points = measured(count=20, noise=0.01)
    points.easting[11] += 0.5
    assert "Point 12 does not fit the others: it lies 0.5" in notes(placed(2, points))
    assert "does not fit" not in notes(placed(2, count=20, noise=0.01))


def test_extrapolation_is_warned_of_with_the_share_of_the_image():
    half = [(p, q) for p in (20, 120, 220, 280) for q in (20, 150, 280, 380)]
    found = placed(2, places=half)
    assert found.outside == pytest.approx(1 - 260 * 360 / (WIDTH * HEIGHT), abs=1e-6)
    assert f"{100 * found.outside:.0f} % of the image lies outside" in notes(found) and "extrapolates" in notes(found)
    rims = [(p, q) for p in (1, 200, 400, 599) for q in (1, 200, 399)]
    assert "outside" not in notes(placed(2, places=rims))


@pytest.mark.parametrize("order, extrapolation, cut", [
    (1, "automatic", False), (2, "automatic", False), (3, "automatic", True), (3, "draw", False), (1, "leave-out", True)])
def test_only_order_3_leaves_out_what_lies_outside_unless_told(order, extrapolation, cut):
    assert placed(order, extrapolation=extrapolation).cut is cut


def test_check_points_judge_and_do_not_place():
    roles = ["control"] * 20 + ["check"] * 4
    points, spoiled = (measured(count=24, noise=0.01, roles=roles) for _ in range(2))
    spoiled.easting[20:] += 1.0
    honest, judged = placed(2, points), placed(2, spoiled)
    assert judged.rmse() == honest.rmse()
    assert judged.rmse("check") == pytest.approx(1.0, abs=0.05)
    np.testing.assert_array_equal(judged.left_out[20:], judged.errors[20:])


def test_disabled_points_are_passed_over_unless_they_shall_judge():
    points = measured(count=12, noise=0.01, roles=["control"] * 10 + ["disabled"] * 2)
    assert np.isnan(placed(1, points).rmse("check"))
    assert placed(1, points, check_disabled=True).rmse("check") > 0


def test_rmse_is_the_root_of_the_mean_square_of_vectors():
    found = placed(1, count=30, noise=0.05, bend=0.0)
    dx, dy = found.errors.T
    assert found.rmse() == pytest.approx(np.sqrt(np.mean(dx**2 + dy**2)))
    assert found.rmse() == pytest.approx(0.05 * np.sqrt(2 * (1 - 3 / 30)), rel=0.25)
    assert found.left_out_rmse > found.rmse()


def test_the_pixel_size_is_that_of_the_image_in_two_digits():
    assert placed(1, bend=0.0, size=0.0417).pixel_size == pytest.approx(0.042)
    assert placed(1, pixel_size=0.1).pixel_size == 0.1


def test_vectors_end_where_the_points_were_measured():
    found = placed(1, noise=0.05)
    vectors = residual_vectors(found)
    ends = np.array([geometry.coords[1][:2] for geometry in vectors.geometries])
    np.testing.assert_allclose(ends, np.column_stack([found.points.easting, found.points.northing]))
    np.testing.assert_allclose([geometry.length for geometry in vectors.geometries], vectors.column("resid_m"), atol=1e-7)
    assert vectors.crs == found.points.crs


@pytest.mark.parametrize("wrong", [{"order": 4}, {"pixel_size": -1.5}, {"resampling": "guess"}, {"extrapolation": "never"}])
def test_a_setting_that_makes_no_sense_is_refused_by_its_value(wrong):
    with pytest.raises(RoadExtractionError, match=str(list(wrong.values())[0])):
        GeoreferenceSettings(**wrong)
