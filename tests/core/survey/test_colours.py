"""Clouds of coloured points without intensity: the brightness of the colours stands in for it where the user says so."""

import laspy
import numpy as np
import pytest
from drives import ahead, chain, contents, drive, surveyed_points, write_cloud
from heard import Heard
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.open_survey import SurveySettings, open_survey
from lanewright.products.inspection import inspect_survey

CRS = "EPSG:32632"
BRIGHTEST = 255 * 256


def coloured_street(path, point_format=7, intensity=0, colour=(255, 255, 255), paint=True):
    """(trajectory, cloud) of a street, grey but for paint of a colour on its left half."""
    trajectory = drive(chain(ahead(80)))
    points = surveyed_points(trajectory)
    write_cloud(path, *points, point_format=point_format, crs=CRS, intensity=intensity)
    if point_format in (2, 3, 5, 7, 8, 10):
        cloud = laspy.read(path)
        painted = (points[1] > np.median(points[1])) & paint
        for name, value in zip(("red", "green", "blue"), colour):
            cloud[name] = np.where(painted, value * 256, 60 * 256).astype(np.uint16)
        cloud.write(path)
    return trajectory, str(path)


@pytest.mark.parametrize("point_format", [3, 7, 8])
@pytest.mark.parametrize(("colour", "share"), [((255, 255, 255), 1.0), ((255, 0, 0), 0.2126), ((0, 255, 0), 0.7152), ((0, 0, 255), 0.0722)])
def test_the_brightness_of_a_colour_is_that_of_the_standard(tmp_path, point_format, colour, share):
    trajectory, cloud = coloured_street(tmp_path / "street.laz", point_format, colour=colour)
    found = contents(open_survey([cloud], trajectory, SurveySettings(intensity_from="rgb")))
    painted = found["d"] > 1000
    np.testing.assert_allclose(found["intensity"][painted], share * BRIGHTEST, atol=1)
    np.testing.assert_allclose(found["intensity"][~painted], 60 * 256, atol=1)


def test_by_default_colours_are_not_looked_at(tmp_path):
    trajectory, cloud = coloured_street(tmp_path / "street.laz", intensity=700)
    heard = Heard()
    survey = open_survey([cloud], trajectory, progress=heard)
    assert set(contents(survey)["intensity"].tolist()) == {700}
    assert not survey.has_intensity


def test_where_all_are_equally_bright_the_colours_are_named_as_a_way_on(tmp_path):
    trajectory, cloud = coloured_street(tmp_path / "street.laz")
    heard = Heard()
    open_survey([cloud], trajectory, progress=heard)
    assert any("set Intensity from (INTENSITY_FROM) to rgb" in text for text in heard.warned)
    assert any("INTENSITY_FROM" in note for note in inspect_survey([cloud]).notes)


def test_colours_that_are_all_the_same_are_no_way_on(tmp_path):
    trajectory, cloud = coloured_street(tmp_path / "grey.laz", paint=False)
    heard = Heard()
    assert not open_survey([cloud], trajectory, progress=heard).has_intensity
    assert not any("INTENSITY_FROM" in text for text in heard.warned)
    assert not open_survey([cloud], trajectory, SurveySettings(intensity_from="rgb"), heard).has_intensity
    assert any("colours of the points are all the same" in text for text in heard.warned)


def test_a_cloud_without_colours_is_refused_by_name(tmp_path):
    trajectory, cloud = coloured_street(tmp_path / "plain.laz", point_format=6)
    with pytest.raises(RoadExtractionError, match=r"plain\.laz have no colours \(point format 6\)"):
        open_survey([cloud], trajectory, SurveySettings(intensity_from="rgb"))


def test_only_two_sources_of_intensity_are_known():
    with pytest.raises(RoadExtractionError, match="“colour”"):
        SurveySettings(intensity_from="colour")
