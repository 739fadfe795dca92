"""The made UAV image: paint, plates and cars where the street has them, and points that say where."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.products.overlay.control_points import control_points, open_image
from lanewright.products.overlay.georeference import GeoreferenceSettings, draw_image, georeference
from lanewright.simulator.orthophoto import uav_control_points, write_uav_image
from lanewright.simulator.survey import SampleSettings, make_sample_survey
from osgeo import gdal

gdal.UseExceptions()


@pytest.fixture(scope="module")
def street():
    return make_sample_survey(SampleSettings(length=60.0))


@pytest.fixture(scope="module")
def image_path(street, tmp_path_factory):
    path = tmp_path_factory.mktemp("uav") / "uav.tif"
    write_uav_image(street, path)
    return path


@pytest.fixture(scope="module")
def picture(image_path):
    return gdal.Open(str(image_path)).ReadAsArray().astype(float)


def brightness_at(street, picture, s, d):
    x, y = street.scene.axis.to_map(np.asarray(s, float), np.asarray(d, float))
    pixel, line = street.camera.to_pixel(x, y)
    return picture[:, np.floor(line).astype(int), np.floor(pixel).astype(int)].mean(axis=0)


def points_of(survey, image):
    layer = uav_control_points(survey)
    places = shapely.get_coordinates(layer.geometries)
    rows = [(row["point"], row["role"], row["pixel"], row["line"], *place) for row, place in zip(layer.rows, places)]
    return control_points(["point", "role", "pixel", "line", "mapX", "mapY"], rows, image, "The layer", layer.crs)


def test_the_camera_knows_where_a_pixel_lies_both_ways(street):
    pixel, line = np.meshgrid(np.linspace(0, street.camera.width, 15), np.linspace(0, street.camera.height, 15))
    back = street.camera.to_pixel(*street.camera.to_map(pixel, line))
    np.testing.assert_allclose(back, [pixel, line], atol=1e-6)


def test_pixels_measure_four_centimetres_in_the_middle(street):
    camera = street.camera
    x, y = camera.to_map(camera.width / 2 + np.array([0.0, 10.0]), np.full(2, camera.height / 2))
    assert np.hypot(x[1] - x[0], y[1] - y[0]) == pytest.approx(0.40, abs=0.005)


def test_the_image_has_no_place_on_the_map(image_path, street):
    image = open_image(image_path)
    assert image.geotransform is None and not image.crs
    assert (image.width, image.height, image.bands) == (street.camera.width, street.camera.height, 3)


def test_paint_is_bright_where_it_lies_and_asphalt_is_not(street, picture):
    s = np.arange(3.0, 20.0, 0.5)
    on, beside = (brightness_at(street, picture, s, np.full(len(s), d)) for d in (3.5, 2.6))
    assert np.median(on) > np.median(beside) + 60


def test_plates_are_black_and_white_quarters_around_their_point(street, picture):
    layer = uav_control_points(street)
    plates = [row for row in layer.rows if row["kind"] == "plate"]
    assert len(plates) >= 4
    for row in plates:
        column, line = int(row["pixel"]), int(row["line"])
        around = picture[:, line - 6:line + 7, column - 6:column + 7].mean(axis=0)
        assert around.max() > 150 and around.min() < 60


def test_control_points_lie_in_the_image_and_clear_of_cars_and_trees(street):
    layer, camera = uav_control_points(street), street.camera
    place = shapely.get_coordinates(layer.geometries) - np.array(street.settings.origin[:2])
    for row in layer.rows:
        assert 0 < row["pixel"] < camera.width and 0 < row["line"] < camera.height
    for obstacle in street.scene.obstacles:
        assert np.hypot(place[:, 0] - obstacle.x, place[:, 1] - obstacle.y).min() > min(obstacle.reach, 2.4)
    assert {row["role"] for row in layer.rows} == {"control", "check"}


@pytest.mark.parametrize("scene, length", [("street", 120.0), ("rural", 120.0), ("urban", 400.0), ("street", 25.0)])
def test_a_second_order_finds_the_true_place_within_two_pixels_between_the_points(scene, length, tmp_path):
    """And a first order does not: the distortion is there."""
    survey = make_sample_survey(SampleSettings(scene=scene, length=length))
    camera, path = survey.camera, tmp_path / "plain.tif"
    gdal.GetDriverByName("GTiff").Create(str(path), camera.width, camera.height, 1, options=["SPARSE_OK=TRUE"])
    image = open_image(path)
    points = points_of(survey, image)
    pixel, line = (axis.ravel() for axis in np.meshgrid(np.linspace(0, camera.width, 40), np.linspace(0, camera.height, 40)))
    off = []
    for order in (1, 2):
        found = georeference(image, points, GeoreferenceSettings(order=order))
        inside = shapely.contains_xy(found.hull, pixel, line)
        truth = np.array(camera.to_map(pixel[inside], line[inside])) + np.array(survey.settings.origin[:2])[:, None]
        off.append(np.hypot(*(np.array(found.fit.polynomial.to_map(pixel[inside], line[inside])) - truth)).max())
    assert off[1] < 0.08
    assert off[0] > 2 * off[1]


def test_paint_lies_in_the_georeferenced_image_where_camera_and_polynomial_put_it(street, image_path, tmp_path):
    """What the demo takes for drawn over the image is in the image."""
    image = open_image(image_path)
    found = georeference(image, points_of(street, image), GeoreferenceSettings(order=2))
    draw_image(found, tmp_path / "ortho.tif")
    ortho = gdal.Open(str(tmp_path / "ortho.tif"))
    x0, size, _, y0, _, _ = ortho.GetGeoTransform()
    values = ortho.ReadAsArray()[:3].astype(float).mean(axis=0)

    def seen(offset):
        s = np.arange(3.0, 20.0, 0.25)
        place = street.camera.to_pixel(*street.scene.axis.to_map(s, np.full(len(s), offset)))
        east, north = found.fit.polynomial.to_map(*place)
        return np.median(values[np.floor((y0 - north) / size).astype(int), np.floor((east - x0) / size).astype(int)])

    on, *beside = (seen(3.5 + d) for d in (0.0, -0.14, 0.14))  # a line of 15 cm, and a pixel and a half beside it
    assert on > max(beside) + 50


def test_a_long_road_is_shown_from_its_beginning():
    camera = make_sample_survey(SampleSettings(length=200.0)).camera
    assert camera.stations == (0.0, 150.0)
    assert camera.width * camera.height < 10e6


def test_the_same_seed_gives_the_same_picture(street, picture, tmp_path):
    write_uav_image(street, tmp_path / "again.tif")
    np.testing.assert_array_equal(gdal.Open(str(tmp_path / "again.tif")).ReadAsArray(), picture)


def test_a_folder_that_is_not_there_is_told(street, tmp_path):
    with pytest.raises(RoadExtractionError, match="cannot be written"):
        write_uav_image(street, tmp_path / "none" / "uav.tif")
