"""Where an image lies roughly: what cameras, world files and two points say."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.products.overlay.control_points import SourceImage, control_points
from lanewright.products.overlay.rough_place import position_tags, rough_place
from lanewright.simulator.camera_tags import camera_tags
from lanewright.simulator.survey import SampleSettings, make_sample_survey
from paint_from_above import EAST, NORTH, UTM

IMAGE = SourceImage("photo.jpg", 4000, 3000)


def test_exif_gives_degrees_minutes_and_seconds_with_their_hemisphere():
    tags = position_tags({"EXIF_GPSLatitude": "(33) (51) (31.32)", "EXIF_GPSLatitudeRef": "S", "EXIF_GPSLongitude": "(151) (12) (50.4)",
                          "EXIF_GPSLongitudeRef": "E", "EXIF_GPSImgDirection": "(90.5)", "EXIF_FocalLengthIn35mmFilm": "24"})
    assert (tags.latitude, tags.longitude) == (pytest.approx(-33.8587), pytest.approx(151.214))
    assert tags.heading == 90.5 and tags.focal_length == 24 and tags.height is None and tags.pixel_size(IMAGE) is None


@pytest.mark.parametrize("xmp", [
    '<rdf:Description drone-dji:GpsLatitude="+24.5" drone-dji:GpsLongtitude="-118.1" drone-dji:RelativeAltitude="+80.0" '
    'drone-dji:GimbalYawDegree="-12.5" drone-dji:GimbalPitchDegree="-90.0" drone-dji:FlightYawDegree="3.0"/>',
    "<drone-dji:GpsLatitude>24.5</drone-dji:GpsLatitude><drone-dji:GpsLongitude>-118.1</drone-dji:GpsLongitude>"
    "<drone-dji:RelativeAltitude>80.0</drone-dji:RelativeAltitude><drone-dji:GimbalYawDegree>-12.5</drone-dji:GimbalYawDegree>",
], ids=["attributes", "elements"])
def test_a_drones_xmp_is_read_however_it_is_written(xmp):
    tags = position_tags({"EXIF_FocalLengthIn35mmFilm": "24"}, xmp)
    assert (tags.latitude, tags.longitude, tags.heading, tags.height) == (24.5, -118.1, -12.5, 80.0)
    assert tags.pixel_size(IMAGE) == pytest.approx(80 * 36 / 24 / 4000 * 43.27 / 45.0, rel=1e-3)  # 36 x 27 mm has a diagonal of 45 mm


@pytest.mark.parametrize("exif", [{}, {"EXIF_GPSLatitude": "(0) (0) (0)", "EXIF_GPSLongitude": "(0) (0) (0)"}, {"EXIF_GPSLatitude": "north"},
                                  {"EXIF_GPSLatitude": "(10/0)", "EXIF_GPSLongitude": "(10) (0) (0)"}])
def test_tags_without_a_place_are_none(exif):
    assert position_tags(exif) is None


def test_the_sample_cameras_tags_lie_within_what_a_receiver_and_a_compass_err():
    survey = make_sample_survey(SampleSettings(length=60.0))
    tags = position_tags({}, camera_tags(survey.camera, survey.settings.origin, survey.crs))
    size = tags.pixel_size(SourceImage("uav.tif", survey.camera.width, survey.camera.height))
    assert size == pytest.approx(0.04, rel=0.06)
    assert -90 < tags.latitude < 90 and abs(tags.height) > 20


def test_a_local_survey_has_no_degrees_and_so_no_tags():
    survey = make_sample_survey(SampleSettings(length=60.0))
    local = 'ENGCRS["site",EDATUM["site"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'
    assert camera_tags(survey.camera, survey.settings.origin, local) == ""


def test_a_world_file_says_place_turn_and_size():
    turned = SourceImage("photo.tif", 1000, 500, (EAST, 0.04, 0.03, NORTH, 0.03, -0.04))
    rough = rough_place(turned, UTM, 15.0)
    assert (rough.x, rough.y) == (pytest.approx(EAST + 27.5), pytest.approx(NORTH + 5.0))
    assert rough.size == pytest.approx(0.05) and np.degrees(rough.turn) == pytest.approx(36.87, abs=0.01) and rough.reach == 15.0


def points(pixel, line, easting, northing):
    return control_points(["pixel", "line", "easting", "northing"], list(zip(pixel, line, easting, northing)), IMAGE, "The points", UTM)


def test_two_points_say_place_turn_and_size_and_how_well_they_do():
    rough = rough_place(IMAGE, UTM, 15.0, points=points([0, 4000], [1500, 1500], [EAST, EAST], [NORTH, NORTH + 80]))
    assert (rough.x, rough.y) == (pytest.approx(EAST), pytest.approx(NORTH + 40))
    assert rough.size == pytest.approx(0.02) and rough.turn == pytest.approx(np.pi / 2)
    assert rough.reach < 10 and rough.turn_range == pytest.approx(0.05)


def test_points_in_one_place_and_an_image_that_says_nothing_are_refused():
    with pytest.raises(RoadExtractionError, match="far apart"):
        rough_place(IMAGE, UTM, 15.0, points=points([0, 10], [0, 0], [EAST, EAST + 0.2], [NORTH, NORTH]))


def test_a_pixel_size_alone_leaves_place_and_turn_open(tmp_path):
    from osgeo import gdal

    gdal.GetDriverByName("GTiff").Create(str(tmp_path / "bare.tif"), 40, 30)
    bare = SourceImage(str(tmp_path / "bare.tif"), 40, 30)
    rough = rough_place(bare, UTM, 15.0, 0.05)
    assert np.isinf(rough.reach) and rough.turn_range == np.pi and rough.size == 0.05
    with pytest.raises(RoadExtractionError, match="neither a position nor position tags"):
        rough_place(bare, UTM, 15.0)
