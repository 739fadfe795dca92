"""The parts of `make accuracy` that judge surveys which lack something, and the uncertainty of lines."""

from types import SimpleNamespace

import laspy
import numpy as np
import pytest
from shapely import LineString, box

pytest.importorskip("osgeo.gdal")

from accuracy.poorer import POORER  # noqa: E402
from accuracy.results import results  # noqa: E402
from accuracy.streets import judged, percent  # noqa: E402

CHANGES = {one.name: one.change for one in POORER}


def cloud(count=4000):
    """A square of 10 m, its right half painted, of points 4 to 5 mm beside the centimetres."""
    rng = np.random.default_rng(7)
    las = laspy.LasData(laspy.LasHeader(point_format=6, version="1.4"))
    las.header.scales = np.full(3, 0.001)
    las.x, las.y, las.z = (np.round(rng.uniform(0, 10, (3, count)), 2) + 0.004) * np.array([[1], [1], [0.01]])
    las.gps_time, las.intensity = np.linspace(10, 20, count), rng.integers(100, 40_000, count).astype(np.uint16)
    return las


def changed(name):
    return CHANGES[name](cloud(), [box(5, 0, 11, 10)], np.random.default_rng(1))


@pytest.mark.parametrize(("name", "share"), [("one point in 4", 0.25), ("one point in 10", 0.1), ("one return in ten missing", 0.9)])
def test_so_many_points_are_left(name, share):
    assert len(changed(name).points) == pytest.approx(4000 * share, rel=0.02)


def test_of_a_cube_one_point_is_left():
    las = changed("one point per cube of 5 cm")
    cubes = np.floor(np.column_stack([las.x, las.y, las.z]) / 0.05).astype(int)
    assert len(np.unique(cubes, axis=0)) == len(cubes)


def test_coordinates_are_whole_centimetres():
    las = changed("coordinates of 1 cm")
    for axis in (las.x, las.y):
        np.testing.assert_allclose(100 * np.asarray(axis), np.rint(100 * np.asarray(axis)), atol=1e-6)


def test_intensity_ends_at_255_and_keeps_its_order():
    las = changed("intensity in 8 bits")
    assert las.intensity.max() == 255
    assert (np.diff(np.asarray(las.intensity, int)[np.argsort(cloud().intensity, kind="stable")]) >= 0).all()


def test_times_are_gone():
    assert not np.asarray(changed("points without time").gps_time).any()


def test_paint_is_bright_in_the_colours_and_nowhere_in_the_intensity():
    las = changed("colours, no intensity")
    assert not np.asarray(las.intensity).any()
    lit = np.mod(np.asarray(las.x) + np.asarray(las.y), 30) >= 10
    paint, asphalt = (np.asarray(las.red)[lit & side] / 256 for side in (las.x > 5.1, las.x < 4.9))
    assert np.median(paint) == pytest.approx(200, abs=3) and np.median(asphalt) == pytest.approx(90, abs=3)


def test_lines_within_their_sigma_are_counted_and_far_ones_are_not():
    line = lambda y: LineString([(0, y, 0), (100, y, 0)])  # noqa: E731
    truth = SimpleNamespace(edges=[(line(4.0), "curb", "main")], driving=[line(0.0)], area=box(-5, -20, 105, 20), has={"boundaries", "driving_lines"})
    found = judged(SimpleNamespace(truth=truth), np.array([(0.0, 0.0), (100.0, 0.0)]),
                   [(line(4.003), {"sigma_m": 0.004}), (line(4.006), {"sigma_m": 0.004}), (line(5.0), {"sigma_m": 0.004}), (line(4.02), {})], None,
                   [(line(0.01), {"sigma_m": 0.02})])
    assert percent(found, "edges_sigma") == 50 and percent(found, "lanes_sigma") == 100


WHOLE = {"curbs": (90.0, 100.0), "lanes": (98.0, 100.0), "edges_sigma": (70.0, 100.0)}


def street(name, **poorer):
    return {"name": name, "kind": "simulated", "text": "", "points": 1000, "streets": {"as surveyed": WHOLE}, "poorer": poorer}


def test_the_results_say_of_each_street_what_is_left_when_something_lacks():
    table = results([street("one", thin={"curbs": (80.0, 100.0)}, timeless={"refused": "No road."})])
    assert table.get("streets", "one", "thin", "curbs") == table.get("streets", "one", "thin", "all edges") == 80.0
    assert table.get("streets", "one", "thin", "driving lines 15 cm") is None
    assert table.get("streets", "one", "timeless", "refused") == "No road."


def test_the_results_pool_streets_by_length_and_count_those_without_a_map():
    table = results([street("one", thin={"curbs": (80.0, 100.0), "lanes": (98.0, 100.0)}), street("two", thin={"refused": "No road."})])
    assert table.get("changes", "all", "thin", "curbs") == -10.0 and table.get("changes", "all", "thin", "driving lines 15 cm") == 0.0
    assert table.get("changes", "all", "thin", "surveys") == 2 and table.get("changes", "all", "thin", "no map") == 1


def test_the_results_say_which_share_lies_within_sigma():
    table = results([street("one")])
    assert table.get("streets", "one", "as surveyed", "road edges within sigma") == 70.0
    assert table.get("streets", "one", "as surveyed", "driving lines within sigma") is None
