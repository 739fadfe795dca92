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
from lanewright.core.survey.trajectory.trajectory import Trajectory
from lanewright.products.assess.lines import compare_lines
from lanewright.products.assess.markings import assess_markings

pytestmark = pytest.mark.slow

LAYERS = ("edges", "surface", "markings", "marking_lines", "driving_lines")


@pytest.fixture(scope="module")
def street(made_survey):
    return made_survey(length=32.0, pulse_rate=60_000.0, rotation_rate=90.0)


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


def assert_same(one, other):
    """Every vertex within a millimetre."""
    expected, found = layers_of(one), layers_of(other)
    for name in LAYERS:
        assert len(expected[name]) == len(found[name]) > 0, name
        np.testing.assert_allclose(found[name], expected[name], rtol=0, atol=1e-3, err_msg=name)


def area_of(road_map):
    return shapely.union_all([shapely.force_2d(g).buffer(0.5) for g in road_map.layer("surface").geometries])


def test_road_edges_lie_on_the_curbs(sample, road_map):
    """Every curb has its edge, and every edge is that of a curb, which may be dropped."""
    curbs, dropped = ([g for g, row in sample.truth_boundaries if row["part"] != "top" and row["edge"] == edge] for edge in ("curb", "dropped"))
    edges, area = road_map.layer("edges").geometries, area_of(road_map)
    found = compare_lines(edges, curbs, area=area)
    assert found.completeness[0.10] > 0.95
    assert compare_lines(edges, curbs + dropped, area=area).correctness[0.10] > 0.95
    assert found.height.rmse < 0.02


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
            town = [vertices - [shift, 0.0, 0.0] for vertices in town]
            if name == "driving_lines":
                # where a line is cut into measured and bridged depends on the usual width of lanes, which two towns show better than one
                there, alone = (shapely.MultiLineString([shapely.LineString(vertices[:, :2]) for vertices in lines]) for lines in (town, expected))
                assert shapely.hausdorff_distance(there, alone, densify=0.1) < 1e-3
            else:
                np.testing.assert_allclose(np.concatenate(town), np.concatenate(expected), rtol=0, atol=1e-3, err_msg=name)
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


def test_tiles_and_their_order_section_length_block_size_and_number_of_threads_do_not_show(sample, cloud, road_map, tmp_path, monkeypatch):
    whole = laspy.read(cloud)
    half, tiles = np.asarray(whole.x) > np.median(whole.x), []
    for name, part in (("east", half), ("west", ~half)):
        tile = laspy.LasData(whole.header)
        tile.points = whole.points[part]
        tile.write(tmp_path / f"{name}.las")
        tiles.append((np.median(tile.gps_time), tmp_path / f"{name}.las"))
    others = 4 if os.cpu_count() == 1 else 1
    monkeypatch.setattr(os, "cpu_count", lambda: others)
    settings = RoadMapSettings(survey=SurveySettings(section_length=7.0, block=33_333))
    against_the_drive = [path for _, path in sorted(tiles, reverse=True)]
    assert_same(road_map, make_road_map(against_the_drive, sample.trajectory, tmp_path / "intensity.tif", settings))


ABOUT = np.array([610_450.0, 2_710_220.0])
TURN = np.radians(37.0)
MOVED = np.array([1234.567, -987.653])


def mirrored_turned_and_moved(places):
    c, n = np.cos(TURN), np.sin(TURN)
    return (np.c_[2 * ABOUT[0] - places[:, 0], places[:, 1]] - ABOUT) @ np.array([[c, n], [-n, c]]) + ABOUT + MOVED


def moved_turned_and_mirrored_back(places):
    c, n = np.cos(TURN), np.sin(TURN)
    x, y = ((places - MOVED - ABOUT) @ np.array([[c, -n], [n, c]]) + ABOUT).T
    return np.c_[2 * ABOUT[0] - x, y]


def left_as_it_is(places):
    return places


def road_map_of(street, folder, there, backwards):
    """The road map of the same drive, without its angles, in other places, or at reversed time.

    It has no CRS, for both put traffic on the left, which the country of the street would speak against.
    """
    points, drive = laspy.read(street[1]), street[0].trajectory
    places, track = (there(np.c_[np.asarray(p.x), np.asarray(p.y)]) for p in (points, drive))
    ends = drive.time[0] + drive.time[-1]
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 1e-4), np.floor(places.min(axis=0)).tolist() + [0.0]
    header.global_encoding.gps_time_type = points.header.global_encoding.gps_time_type
    cloud = laspy.LasData(header)
    order = slice(None, None, -1 if backwards else 1)
    cloud.x, cloud.y, cloud.z = places[order, 0], places[order, 1], np.asarray(points.z)[order]
    cloud.gps_time = (ends - points.gps_time if backwards else np.asarray(points.gps_time))[order]
    for name in ("intensity", "return_number", "number_of_returns", "point_source_id"):
        cloud[name] = np.asarray(points[name])[order]
    cloud.write(folder / "cloud.las")
    time = ends - drive.time if backwards else drive.time
    trajectory = Trajectory(time[order], track[order, 0], track[order, 1], drive.z[order])
    return make_road_map([folder / "cloud.las"], trajectory, folder / "intensity.tif")


def on_the_map_before(lines, back):
    return [shapely.transform(shapely.force_2d(line), back) for line in lines]


def metres_by_side(layer):
    found = {"left": 0.0, "right": 0.0}
    for line, row in layer:
        found[row["side"]] += line.length
    return found


@pytest.mark.parametrize("there, back, backwards", [
    (mirrored_turned_and_moved, moved_turned_and_mirrored_back, False), (left_as_it_is, left_as_it_is, True),
], ids=["mirrored, turned by 37° and moved", "driven backwards"])
def test_the_map_does_not_depend_on_how_the_street_lies_or_is_driven(street, road_map, tmp_path, there, back, backwards):
    """Its sides are as they then are: both ways swap them."""
    found = road_map_of(street, tmp_path, there, backwards)
    for name in ("edges", "marking_lines", "driving_lines"):
        # a low curb that is just seen may end a few metres earlier
        same = compare_lines(on_the_map_before(found.layer(name).geometries, back), road_map.layer(name).geometries)
        assert same.completeness[0.10] > 0.94 and same.correctness[0.10] > 0.94, name
    same = assess_markings(on_the_map_before(found.markings.geometries, back), road_map.markings.geometries).tolerant
    assert same.precision > 0.98 and same.recall > 0.98
    assert sorted(found.markings.column("class")) == sorted(road_map.markings.column("class"))
    before, after = metres_by_side(road_map.layer("edges")), metres_by_side(found.layer("edges"))
    assert [after["left"], after["right"]] == pytest.approx([before["right"], before["left"]], abs=4.0)


def test_a_run_that_is_broken_off_gives_back_the_disk_of_its_points(sample, cloud, tmp_path, monkeypatch):
    opened = []

    def broken_off(*_, **__):
        raise Cancelled

    monkeypatch.setattr(chain, "open_survey", lambda *given, **named: opened.append(open_survey(*given, **named)) or opened[0])
    monkeypatch.setattr(chain, "make_intensity_image", broken_off)
    with pytest.raises(Cancelled):
        make_road_map([cloud], sample.trajectory, tmp_path / "intensity.tif")
    assert not opened[0].store.roads()
    assert opened[0].counts["kept"] > 0
