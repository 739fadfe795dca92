"""The whole chain on a made street with known truth, and what must not change its result."""

import os
from dataclasses import replace

import laspy
import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.pipeline import road_map as chain
from lanewright.core.pipeline.road_map import RoadMapSettings, make_road_map
from lanewright.core.survey.open_survey import SurveySettings, open_survey
from lanewright.products.assess.driving_lines import compare_lines
from lanewright.products.assess.markings import assess_markings

pytestmark = pytest.mark.slow

LAYERS = ("edges", "surface", "markings", "marking_lines", "driving_lines")


@pytest.fixture(scope="module")
def street(made_survey):
    return made_survey(length=32.0, pulse_rate=90_000.0, rotation_rate=90.0)


@pytest.fixture(scope="module")
def sample(street):
    return street[0]


@pytest.fixture(scope="module")
def cloud(street):
    return street[1]


@pytest.fixture(scope="module")
def road_map(sample, cloud, tmp_path_factory):
    return make_road_map([cloud], sample.trajectory, tmp_path_factory.mktemp("map") / "intensity.tif")


def layers_of(road_map):
    return {name: shapely.get_coordinates(np.array(road_map.layer(name).geometries, object), include_z=True)
            for name in LAYERS}


def assert_same(one, other, shift=(0.0, 0.0, 0.0)):
    """Every vertex within a millimetre."""
    expected, found = layers_of(one), layers_of(other)
    for name in LAYERS:
        assert len(expected[name]) == len(found[name]) > 0, name
        np.testing.assert_allclose(found[name] - shift, expected[name], rtol=0, atol=1e-3, err_msg=name)


def area_of(road_map):
    return shapely.union_all([shapely.force_2d(g).buffer(0.5) for g in road_map.layer("surface").geometries])


def test_road_edges_lie_on_the_curbs(sample, road_map):
    curbs = [g for g, row in sample.truth_boundaries if row["part"] != "top" and row["edge"] == "curb"]
    found = compare_lines(road_map.layer("edges").geometries, curbs, area=area_of(road_map))
    assert found.completeness[0.10] > 0.95
    assert found.correctness[0.10] > 0.95
    assert found.height_rmse < 0.02


def test_markings_are_the_painted_ones(sample, road_map):
    found = assess_markings(road_map.markings.geometries, sample.truth_markings.geometries, area=area_of(road_map)).tolerant
    assert found.precision > 0.95 and found.recall > 0.90


def test_driving_lines_run_in_the_lanes_the_way_they_are_driven(sample, road_map):
    found = compare_lines(road_map.driving_lines.geometries, sample.truth_driving_lines.geometries, area=area_of(road_map))
    assert found.completeness[0.15] > 0.90
    assert found.correctness[0.15] > 0.90
    for line, _ in road_map.driving_lines:
        middle = line.interpolate(0.5, normalized=True)
        truth = min(sample.truth_driving_lines.geometries, key=middle.distance)
        ends = [truth.project(shapely.Point(line.coords[k])) for k in (0, -1)]
        assert ends[1] > ends[0]


def test_the_same_street_again_a_thousand_kilometres_on_gives_the_same_map(sample, cloud, road_map, tmp_path):
    """One survey of two towns: the map of each is that of the street alone, and the image leaves out what lies between."""
    east, later = 1_000_000.0, 4000.0
    there = laspy.read(cloud)
    there.points.offsets = there.header.offsets = there.header.offsets + [east, 0.0, 0.0]
    there.gps_time = np.asarray(there.gps_time) + later
    there.write(tmp_path / "there.las")
    here = sample.trajectory
    off = dict(time=later, x=east)
    both = replace(here, **{name: np.r_[getattr(here, name), getattr(here, name) + off.get(name, 0.0)]
                            for name in ("time", "x", "y", "z", "roll", "pitch", "heading")})
    found = make_road_map([cloud, tmp_path / "there.las"], both, tmp_path / "image.tif")
    assert found.survey_facts["outside"] == 2 * road_map.survey_facts["outside"]
    # a point right on the edge of the surface may fall on either side: what asphalt looks like is taken from the whole survey
    assert len(found.road_points) == pytest.approx(2 * len(road_map.road_points), abs=5)
    for name in LAYERS:
        expected = [shapely.get_coordinates(g, include_z=True) for g in road_map.layer(name).geometries]
        geometries = found.layer(name).geometries
        for first, shift in ((0, 0.0), (1, east)):
            town = [shapely.get_coordinates(g, include_z=True) for g in geometries if (g.centroid.x > sample.settings.origin[0] + east / 2) == first]
            assert len(town) == len(expected) > 0, name
            np.testing.assert_allclose(np.concatenate(town) - [shift, 0.0, 0.0], np.concatenate(expected), rtol=0, atol=1e-3, err_msg=name)
    assert (tmp_path / "image.tif").stat().st_size < 20e6


def test_towns_too_far_apart_for_one_image_are_refused_before_anything_is_detected(sample, cloud, tmp_path, monkeypatch):
    """300 km east and 300 km north at 4 cm: more tiles than one file holds."""
    there = laspy.read(cloud)
    there.points.offsets = there.header.offsets = there.header.offsets + [3e5, 3e5, 0.0]
    there.gps_time = np.asarray(there.gps_time) + 4000.0
    there.write(tmp_path / "there.las")
    here = sample.trajectory
    off = dict(time=4000.0, x=3e5, y=3e5)
    both = replace(here, **{name: np.r_[getattr(here, name), getattr(here, name) + off.get(name, 0.0)]
                            for name in ("time", "x", "y", "z", "roll", "pitch", "heading")})
    monkeypatch.setattr(chain, "find_curb_points", None)
    with pytest.raises(RoadExtractionError, match=r"span 300\.\d by 300\.\d km.*larger cell size"):
        make_road_map([cloud, tmp_path / "there.las"], both, tmp_path / "image.tif")
    assert not (tmp_path / "image.tif").exists()


def test_tiles_in_any_order_give_the_same_map(sample, cloud, road_map, tmp_path):
    whole = laspy.read(cloud)
    half = np.asarray(whole.x) > np.median(whole.x)
    tiles = []
    for name, part in (("east", half), ("west", ~half)):
        tile = laspy.LasData(whole.header)
        tile.points = whole.points[part]
        tile.write(tmp_path / f"{name}.las")
        tiles.append(tmp_path / f"{name}.las")
    for order in (tiles, tiles[::-1]):
        assert_same(road_map, make_road_map(order, sample.trajectory, tmp_path / "intensity.tif"))


def test_section_length_and_block_size_do_not_show(sample, cloud, road_map, tmp_path):
    settings = RoadMapSettings(survey=SurveySettings(section_length=7.0, block=33_333))
    assert_same(road_map, make_road_map([cloud], sample.trajectory, tmp_path / "intensity.tif", settings))


def test_the_number_of_threads_does_not_show(sample, cloud, road_map, tmp_path, monkeypatch):
    others = 4 if os.cpu_count() == 1 else 1
    monkeypatch.setattr(os, "cpu_count", lambda: others)
    assert_same(road_map, make_road_map([cloud], sample.trajectory, tmp_path / "intensity.tif"))


def test_a_survey_moved_500_km_gives_the_same_map_there(sample, cloud, road_map, tmp_path):
    east = 500_000.0
    moved = laspy.read(cloud)
    x = np.asarray(moved.x) + east
    moved.change_scaling(offsets=moved.header.offsets + [east, 0, 0])
    moved.x = x
    moved.write(tmp_path / "moved.las")
    drive = replace(sample.trajectory, x=sample.trajectory.x + east)
    assert_same(road_map, make_road_map([tmp_path / "moved.las"], drive, tmp_path / "intensity.tif"), (east, 0.0, 0.0))


def test_without_intensity_there_are_edges_and_a_reason(sample, cloud, tmp_path):
    dark = laspy.read(cloud)
    dark.intensity = np.zeros(len(dark.points), np.uint16)
    dark.write(tmp_path / "dark.las")
    found = make_road_map([tmp_path / "dark.las"], sample.trajectory, tmp_path / "intensity.tif")
    assert len(found.edges) and len(found.surface)
    assert "intensity" in found.without_paint and found.markings is None


@pytest.mark.parametrize("stage", ["draw_boundaries", "make_intensity_image"])
def test_a_run_that_is_broken_off_gives_back_the_disk_of_its_points(sample, cloud, tmp_path, monkeypatch, stage):
    opened = []

    def broken_off(*_, **__):
        raise Cancelled

    monkeypatch.setattr(chain, "open_survey", lambda *given, **named: opened.append(open_survey(*given, **named)) or opened[0])
    monkeypatch.setattr(chain, stage, broken_off)
    with pytest.raises(Cancelled):
        make_road_map([cloud], sample.trajectory, tmp_path / "intensity.tif")
    assert not opened[0].store.roads()
    assert opened[0].counts["kept"] > 0
