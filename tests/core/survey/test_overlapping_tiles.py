"""Tiles of a survey that overlap: a point that lies in two files is one point."""

import re

import numpy as np
import pytest
from drives import ahead, bend, chain, contents, drive, surveyed_points, write_cloud
from heard import Heard
from lanewright.core.survey.open_survey import open_survey

CRS = "EPSG:32632"
PATH = chain(ahead(80), bend(60, 60), ahead(60))




@pytest.fixture
def street(tmp_path):
    """(trajectory, points, path of their cloud) of a bend driven once."""
    trajectory = drive(PATH)
    points = surveyed_points(trajectory)
    return trajectory, points, write_cloud(tmp_path / "street.laz", *points, crs=CRS)


def tiles(folder, points, overlap):
    """Clouds of the points west and east of a place in the middle, with those within half the overlap (m) of it in both."""
    middle = np.median(points[0])
    halves = points[0] < middle + overlap / 2, points[0] >= middle - overlap / 2
    return [write_cloud(folder / f"tile{k}.laz", *(c[rows] for c in points), crs=CRS) for k, rows in enumerate(halves)]


def test_points_that_overlapping_tiles_share_are_used_once(street, tmp_path):
    trajectory, points, path = street
    heard = Heard()
    survey = open_survey(tiles(tmp_path, points, 40.0), trajectory, progress=heard)
    np.testing.assert_array_equal(contents(survey), contents(open_survey([path], trajectory)))
    shared = np.mean(np.abs(points[0] - np.median(points[0])) < 20.0)
    told = [re.match(r"About ([\d.]+) % of the points that were read are copies", text) for text in heard.said]
    assert [float(match[1]) for match in told if match] == [pytest.approx(100 * shared / (1 + shared), rel=0.1)]


def test_of_tiles_that_only_touch_nothing_is_said(street, tmp_path):
    trajectory, points, _ = street
    heard = Heard()
    open_survey(tiles(tmp_path, points, 0.0), trajectory, progress=heard)
    assert heard.said and not [text for text in heard.said if "copies" in text]


def test_points_without_time_that_overlapping_tiles_share_are_used_once(street, tmp_path):
    trajectory, points, _ = street
    points = (*points[:3], np.zeros(len(points[0])))
    whole = write_cloud(tmp_path / "whole.laz", *points, crs=CRS)
    np.testing.assert_array_equal(contents(open_survey(tiles(tmp_path, points, 40.0), trajectory)), contents(open_survey([whole], trajectory)))
