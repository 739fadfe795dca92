"""What a survey holds, told of clouds whose content is known."""

import laspy
import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.trajectory.trajectory import Trajectory
from lanewright.products.inspection import InspectionSettings, inspect_survey
from lanewright.products.report.survey import inspection_report

WEST, SOUTH = 610400.0, 2710200.0


def a_carpet(path, per_metre=10, length=20, width=6, start=318204000.0, crs="EPSG:32650", intensity=500, layers=1):
    """A level carpet of `per_metre` points a metre both ways, in `layers` heights two metres apart."""
    step = 1.0 / per_metre
    x, y, layer = np.meshgrid(np.arange(step / 2, length, step), np.arange(step / 2, width, step), np.arange(layers), indexing="ij")
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), [WEST, SOUTH, 0.0]
    header.global_encoding.gps_time_type = laspy.header.GpsTimeType.STANDARD
    if crs:
        from pyproj import CRS

        header.add_crs(CRS.from_user_input(crs))
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = WEST + x.ravel(), SOUTH + y.ravel(), 20.5 + 2.0 * layer.ravel()
    cloud.gps_time = start + x.ravel() / 10.0
    cloud.intensity = np.full(x.size, intensity)
    cloud.return_number = cloud.number_of_returns = np.ones(x.size, int)
    cloud.write(str(path))
    return str(path)


def drive(shift=0.0, crs="EPSG:32650", start=318204000.0, north=3.0):
    along = np.arange(-5.0, 25.0, 0.5)
    return Trajectory(start + along / 10.0, WEST + along + shift, np.full(len(along), SOUTH + north), np.full(len(along), 23.0), crs=crs)


def test_the_density_of_an_even_carpet_is_what_it_was_made_with(tmp_path):
    found = inspect_survey([a_carpet(tmp_path / "a.laz")])
    assert found.count == 12000
    assert found.per_area["mean"] == found.per_area["median"] == found.per_area["of_a_point"] == 100.0
    assert found.per_volume["mean"] == 100.0


def test_a_copy_is_noted_and_not_counted(tmp_path):
    found = inspect_survey([a_carpet(tmp_path / "a.laz"), a_carpet(tmp_path / "copy.laz")])
    assert found.count == 12000 and "copy.laz holds the same points as" in found.notes[0]


def test_the_share_of_points_that_overlapping_tiles_have_in_common_is_told(tmp_path):
    whole = laspy.read(a_carpet(tmp_path / "whole.laz"))
    tiles = []
    for name, rows in (("west", whole.x < WEST + 12.0), ("east", whole.x > WEST + 8.0)):
        tiles.append(str(tmp_path / f"{name}.laz"))
        laspy.LasData(whole.header, whole.points[rows]).write(tiles[-1])
    notes = inspect_survey(tiles).notes
    assert sum("About 17 % of the points are copies of points in another file" in note for note in notes) == 1   # 4 m of 20 m twice: 4 of 24
    assert not any("copies" in note for note in inspect_survey([tiles[0], a_carpet(tmp_path / "beside.laz", start=318204100.0)]).notes)


def test_coordinates_without_crs_that_can_only_be_degrees_are_told_as_that(tmp_path):
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = [1e-8, 1e-8, 1e-3], [8.4, 49.0, 0.0]
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = 8.4 + np.arange(200) * 1e-6, 49.0 + np.arange(200) * 1e-6, np.full(200, 110.0)
    cloud.write(str(tmp_path / "degrees.laz"))
    assert any("look like longitude and latitude" in note for note in inspect_survey([tmp_path / "degrees.laz"]).notes)
    assert not any("latitude" in note for note in inspect_survey([a_carpet(tmp_path / "carpet.laz", crs="")]).notes)


def test_layers_above_each_other_add_up_in_the_plane_and_not_in_space(tmp_path):
    found = inspect_survey([a_carpet(tmp_path / "a.laz", layers=3)])
    assert found.per_area["mean"] == 300.0 and found.per_volume["mean"] == 100.0


def test_a_carpet_in_two_files_is_the_same_carpet(tmp_path):
    whole = inspect_survey([a_carpet(tmp_path / "whole.laz", per_metre=20)])
    with laspy.open(str(tmp_path / "whole.laz")) as reader:
        cloud = reader.read()
    halves = []
    for name, which in (("odd.laz", slice(1, None, 2)), ("even.laz", slice(0, None, 2))):
        half = laspy.LasData(cloud.header)
        half.points = cloud.points[which].copy()
        half.write(str(tmp_path / name))
        halves.append(str(tmp_path / name))
    found = inspect_survey(halves)
    assert found.count == whole.count and found.per_area == whole.per_area and found.per_volume == whole.per_volume
    np.testing.assert_array_equal(found.density[0], whole.density[0])


def test_the_density_raster_has_north_above(tmp_path):
    path = a_carpet(tmp_path / "a.laz", width=2)
    with laspy.open(path) as reader:
        cloud = reader.read()
    cloud.points = cloud.points[np.asarray(cloud.y) > SOUTH + 1.0]
    cloud.y = np.where(np.asarray(cloud.x) < WEST + 1.0, np.asarray(cloud.y) - 1.0, np.asarray(cloud.y))
    cloud.write(path)
    density, (west, north) = inspect_survey([path]).density
    assert (west, north) == (WEST, SOUTH + 2.0) and density.shape == (2, 20)
    assert np.isnan(density[0, 0]) and density[1, 0] == 100.0 and density[0, 5] == 100.0 and np.isnan(density[1, 5])


def test_a_trajectory_of_the_same_survey_covers_it(tmp_path):
    found = inspect_survey([a_carpet(tmp_path / "a.laz", intensity=np.arange(12000))], drive())
    assert found.near_share == 1.0 and found.in_time_share == 1.0 and not found.notes


def test_where_points_of_one_tile_all_have_one_time_the_tile_is_noted_and_no_share_of_the_time_is_told(tmp_path):
    stopped = laspy.read(a_carpet(tmp_path / "stopped.laz", layers=2))
    stopped.gps_time = np.zeros(len(stopped))
    stopped.write(str(tmp_path / "stopped.laz"))
    found = inspect_survey([a_carpet(tmp_path / "a.laz"), tmp_path / "stopped.laz"], drive())
    assert found.in_time_share is None and "stopped.laz, have no gps_time that changes" in found.notes[0]


def test_a_trajectory_elsewhere_is_noted(tmp_path):
    found = inspect_survey([a_carpet(tmp_path / "a.laz")], drive(north=500.0))
    assert found.near_share == 0.0
    assert any("one survey" in note for note in found.notes)


def test_a_trajectory_of_another_day_is_noted_with_both_times(tmp_path):
    found = inspect_survey([a_carpet(tmp_path / "a.laz")], drive(start=318204000.0 + 5 * 86400 + 1234.0))
    assert any("does not cover the scan in time" in note and "318204000" in note for note in found.notes)


def test_what_the_road_map_would_stumble_over_is_noted(tmp_path):
    found = inspect_survey([a_carpet(tmp_path / "a.laz", crs="", intensity=0)])
    assert any("no CRS" in note for note in found.notes) and any("intensities are 0" in note for note in found.notes)
    assert any("intensities are 500" in note for note in inspect_survey([a_carpet(tmp_path / "b.laz")]).notes)


def test_the_report_tells_and_shows(tmp_path):
    report = inspection_report(inspect_survey([a_carpet(tmp_path / "a.laz")], drive()))
    assert "12\u202f000" in report and "UTM zone 50N" in report
    assert report.count("<img") == report.count("<svg") == 1, "density and height profile; one intensity makes no histogram"


def test_two_scanners_are_told_apart_by_their_channel(tmp_path):
    path = a_carpet(tmp_path / "a.laz")
    with laspy.open(path) as reader:
        cloud = reader.read()
    cloud.scanner_channel = np.arange(len(cloud.points)) % 2
    cloud.write(path)
    found = inspect_survey([path])
    assert (found.scanner_field, found.scanners) == ("scanner_channel", [0, 1])


def test_an_absurd_cell_is_refused(tmp_path):
    with pytest.raises(RoadExtractionError, match="density cell is 0.0 m"):
        InspectionSettings(cell_size=0.0)


def test_the_drive_is_told_with_its_road_pass_and_sensor_height(tmp_path):
    told = inspect_survey([a_carpet(tmp_path / "a.laz", per_metre=30)], drive()).drive
    assert told.sensor_height == pytest.approx(2.5, abs=0.002) and told.driven == pytest.approx(29.5, abs=0.1)
    (number, road, way, first, last, start, end), = told.passes
    assert (number, road, way) == (0, 0, 1) and last - first == pytest.approx(29.5, abs=0.1) and end - start == pytest.approx(2.95)
    seen = np.isfinite(told.profile[:, 2])
    assert seen[3:11].all() and not seen[:2].any(), "the carpet begins 5 m into the drive"
    np.testing.assert_allclose(told.profile[seen, 2], 20.5, atol=1e-6)


def test_without_a_trajectory_nothing_is_told_of_the_drive(tmp_path):
    assert inspect_survey([a_carpet(tmp_path / "a.laz")]).drive is None


@pytest.mark.parametrize("low, high", [((WEST + 300, SOUTH + 300, 0), (WEST + 400, SOUTH + 400, 9)),
                                       ((WEST - 1e5, SOUTH - 1e5, 0), (WEST + 1e5, SOUTH + 1e5, 9)),
                                       ((WEST + 9, SOUTH + 3, 0), (WEST - 9, SOUTH - 3, 9))],
                         ids=["beside the points", "of the whole project", "the other way round"])
def test_bounds_in_a_header_that_are_not_the_points_change_nothing(tmp_path, low, high):
    import struct

    right, path = inspect_survey([a_carpet(tmp_path / "right.laz")]), a_carpet(tmp_path / "wrong.laz")
    data = bytearray(open(path, "rb").read())
    struct.pack_into("<6d", data, 179, *np.c_[high, low].ravel())
    open(path, "wb").write(data)
    found = inspect_survey([path])
    np.testing.assert_allclose(np.r_[found.minimum, found.maximum], np.r_[right.minimum, right.maximum], atol=1e-6)
    np.testing.assert_array_equal(found.density[0], right.density[0])
    np.testing.assert_allclose(found.density[1], right.density[1])
    assert "points per m²".capitalize() in inspection_report(found)
