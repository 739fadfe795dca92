"""Road points on their way through a file: to the bit what was passed on in memory."""

from dataclasses import replace

import numpy as np
import pytest
from drives import write_cloud
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.adjustment.register import PassCorrections
from lanewright.core.survey.frame.row_table import SigmaAlong
from lanewright.core.survey.road_points_las import read_road_points, write_road_points
from lanewright.core.survey.store.records import ROAD_POINT, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.weights import REGISTER


def road_points(corrected=True, cluster=True, crs="EPSG:32632", count=3000):
    from pyproj import CRS

    rng = np.random.default_rng(7)
    found = RoadPoints.empty_like(origin=[500_000.0, 5_400_000.0, 90.0], crs=CRS.from_user_input(crs).to_wkt() if crs else "")
    found.has_corrected, found.has_cluster = corrected, cluster
    for road in (0, 3):
        records = np.zeros(count, ROAD_POINT)
        records["time"] = np.sort(rng.uniform(3e8, 3e8 + 10, count))
        for name, low, high in (("x", 0, 300), ("y", 0, 300), ("z", 0, 20), ("s", -9, 280), ("d", -12, 12)):
            records[name] = to_units(rng.uniform(low, high, count))
        records["intensity"], records["source"] = rng.integers(0, 65536, count), rng.integers(0, 3, count)
        records["pass_number"], records["scanner"] = rng.integers(0, 5, count), rng.integers(0, 2, count)
        records["returns"], records["half_width"] = 1 | (2 << 4), rng.integers(2000, 9000, count)
        records["corrected"] = rng.normal(1000, 50, count) if corrected else np.nan
        records["cluster"] = rng.integers(0, 40, count) if cluster else 0
        found.store.append(road, records)
    return found


@pytest.mark.parametrize("suffix", [".laz", ".las"])
@pytest.mark.parametrize("corrected, cluster", [(False, False), (True, False), (True, True)])
def test_every_column_comes_back_to_the_bit(tmp_path, suffix, corrected, cluster):
    written = road_points(corrected, cluster)
    write_road_points(written, tmp_path / f"road{suffix}")
    read = read_road_points(tmp_path / f"road{suffix}")
    assert (read.has_corrected, read.has_cluster, len(read)) == (corrected, cluster, len(written))
    np.testing.assert_array_equal(read.origin, written.origin)
    assert read.all_sections() == written.all_sections()
    for road, number in written.all_sections():
        for name in ROAD_POINT.names:
            np.testing.assert_array_equal(read.store.section(road, number)[name], written.store.section(road, number)[name], err_msg=name)
    assert list(tmp_path.iterdir()) == [tmp_path / f"road{suffix}"], "nothing unfinished is left"


@pytest.mark.parametrize("sigma", [{}, {0: SigmaAlong((5.0, 12.5), (0.0625, 0.03125)), 3: SigmaAlong.everywhere(0.015625)}])
def test_what_passes_differ_by_goes_with_the_points(tmp_path, sigma):
    written = road_points(count=50)
    written.pass_sigma = sigma
    write_road_points(written, tmp_path / "road.laz")
    assert read_road_points(tmp_path / "road.laz").pass_sigma == sigma
    assert RoadPoints.empty_like(written).pass_sigma == sigma


@pytest.mark.parametrize("of_colours", [False, True])
def test_whether_brightness_is_that_of_colours_goes_with_the_points(tmp_path, of_colours):
    written = replace(road_points(count=50), of_colours=of_colours)
    write_road_points(written, tmp_path / "road.laz")
    assert read_road_points(tmp_path / "road.laz").of_colours == RoadPoints.empty_like(written).of_colours == of_colours


def test_points_of_moved_passes_are_written_as_measured_and_read_as_moved(tmp_path):
    import laspy

    written = road_points(count=500)
    stations = np.arange(-15.0, 300.0, REGISTER.correction_step)
    left = np.rint([200 + stations, -100 + 0 * stations, 5 * np.sin(stations)]).astype(np.int16)
    written.moves = PassCorrections({1: (-15.0, left), 4: (-15.0, -left)})
    write_road_points(written, tmp_path / "road.laz")
    read = read_road_points(tmp_path / "road.laz")
    for road, number in written.all_sections():
        for name in "xyzsd":
            np.testing.assert_array_equal(read.store.section(road, number)[name], written.store.section(road, number)[name], err_msg=name)
    file = laspy.read(tmp_path / "road.laz")
    moved = np.concatenate([written.section(*key).x - written.moves.units(written.store.section(*key))[0] * 1e-4 for key in written.all_sections()])
    np.testing.assert_allclose(np.sort(file.x), np.sort(moved) + 500_000.0, atol=1e-6)
    assert np.abs(np.sort(file.x) - np.sort(np.concatenate([written.section(*key).x for key in written.all_sections()])) - 500_000.0).max() > 1e-3


def test_a_cloud_without_the_road_s_fields_is_refused_by_their_names(tmp_path):
    path = write_cloud(tmp_path / "plain.laz", *(np.arange(10.0) for _ in range(4)))
    with pytest.raises(RoadExtractionError, match="station_m, offset_m, half_width"):
        read_road_points(path)


def test_no_crs_stays_no_crs(tmp_path):
    write_road_points(road_points(crs=""), tmp_path / "road.laz")
    assert read_road_points(tmp_path / "road.laz").crs == ""
