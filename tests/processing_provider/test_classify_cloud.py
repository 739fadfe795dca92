"""The survey's clouds, given back with classes: what must stay as it was, and what every point belongs to."""

import laspy
import numpy as np
import pytest
import shapely
from lanewright.simulator.survey import SampleSettings, make_sample_survey

NEW = {"road", "station", "offset", "height_above_road"}


@pytest.fixture
def mapped(street, street_map):
    """A street of 40 m with its road map, as parameters of the algorithm."""
    layers = {name: street_map[name] for name in ("ROAD_SURFACE", "ROAD_EDGES", "MARKINGS")}
    return {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"], **layers}


def classified(mapped, folder, **more):
    import processing

    return processing.run("lanewright:classifycloud", {**mapped, "OUTPUT": str(folder), **more})


def same_points(before, after, but=("classification", "scan_angle_rank")):
    """Whether all that points had stands in the copy, in their order."""
    for name in before.point_format.dimension_names:
        if name not in but:
            np.testing.assert_array_equal(np.asarray(before[name]), np.asarray(after[name]), err_msg=name)
    np.testing.assert_array_equal(before.xyz, after.xyz)
    assert (before.header.scales == after.header.scales).all() and (before.header.offsets == after.header.offsets).all()


def test_points_are_those_of_the_street(mapped, tmp_path):
    """Road and paint where they are true; what is called a curb stands within a decimetre of the curbs."""
    found = classified(mapped, tmp_path / "out")
    before, after = laspy.read(mapped["POINT_CLOUDS"][0]), laspy.read(tmp_path / "out" / "s.laz")
    same_points(before, after)
    assert found["POINTS"] == len(before) == len(after) and found["FILES"] == 1
    classes, places = np.asarray(after.classification), shapely.points(*np.asarray(after.xyz).T[:2])
    low = np.abs(np.asarray(after.height_above_road)) < 0.25
    truth = make_sample_survey(SampleSettings(length=40.0, pulse_rate=60_000.0, rotation_rate=100.0))
    surface, paint, curbs = (shapely.union_all(layer.geometries) for layer in (truth.truth_surface, truth.truth_markings, truth.truth_boundaries))
    shapely.prepare([surface, paint, curbs])
    inside = shapely.within(places, surface) & low
    road = np.isin(classes, [11, 64])
    assert (road & inside).sum() > 0.97 * max(road.sum(), inside.sum())
    painted, brightness = shapely.within(places, paint) & inside, np.asarray(after.intensity)
    asphalt = np.median(brightness[road & ~painted])
    assert painted[classes == 64].mean() > 0.97
    assert (classes[painted & (brightness > 2 * asphalt)] == 64).mean() > 0.97
    worn = painted & (brightness < 1.2 * asphalt)
    assert worn.sum() > 500 and (classes[worn] == 11).mean() > 0.9
    curb = places[classes == 65]
    assert len(curb) > 500 and (shapely.distance(curb, curbs) < 0.10).mean() > 0.95
    assert found["CURB_POINTS"] == len(curb)


def written(source, path, point_format, change=lambda cloud: None):
    """Every fourth point of a cloud in another point format."""
    cloud = laspy.convert(laspy.read(source), point_format_id=point_format)
    cloud.points = cloud.points[np.arange(0, len(cloud), 4)]
    change(cloud)
    cloud.write(str(path))
    return str(path)


def test_an_old_file_with_colours_and_an_extra_field_becomes_a_new_one_with_all_of_them(mapped, tmp_path):
    def change(cloud):
        cloud.add_extra_dim(laspy.ExtraBytesParams("echo", "int16", "Width of the echo", scales=[0.1], offsets=[3.0]))
        cloud["echo"] = np.arange(len(cloud)) % 1000 / 10
        cloud.red, cloud.user_data, cloud.scan_angle_rank = np.arange(len(cloud)) % 65536, np.arange(len(cloud)) % 256, np.arange(len(cloud)) % 90
        cloud.header.vlrs.append(laspy.VLR("Surveyor", 7, "Job", b"B12"))

    old = written(mapped["POINT_CLOUDS"][0], tmp_path / "old.las", 3, change)
    classified(mapped, tmp_path / "out", POINT_CLOUDS=[old])
    before, after = laspy.read(old), laspy.read(tmp_path / "out" / "old.las")
    assert after.header.point_format.id == 7 and str(after.header.version) == "1.4"
    same_points(before, after)
    np.testing.assert_allclose(np.asarray(after.scan_angle) * 0.006, before.scan_angle_rank, atol=0.003)
    assert [record.record_data for record in after.header.vlrs if record.user_id == "Surveyor"] == [b"B12"]
    assert after.header.parse_crs().to_epsg() == before.header.parse_crs().to_epsg()
    assert set(after.point_format.extra_dimension_names) == {"echo", *NEW}
    names = next(record.lookups for record in after.header.vlrs if hasattr(record, "lookups"))
    assert (names[64], names[65]) == ("paint", "curb")


def test_classes_that_became_flags_and_long_records_of_an_old_file_are_in_the_new_one(mapped, tmp_path):
    old = laspy.convert(laspy.read(mapped["POINT_CLOUDS"][0]), point_format_id=1, file_version="1.4")
    old.classification[::5], old.classification[1::5] = 12, 8
    old.evlrs = laspy.vlrs.vlrlist.VLRList([laspy.VLR("Surveyor", 9, "Job", b"B" * 70_000)])
    old.write(str(tmp_path / "old.las"))
    classified(mapped, tmp_path / "out", POINT_CLOUDS=[str(tmp_path / "old.las")])
    after = laspy.read(tmp_path / "out" / "old.las")
    assert not np.isin(after.classification, [8, 12]).any()
    for flag, first in (("overlap", 0), ("key_point", 1)):
        np.testing.assert_array_equal(np.asarray(after[flag]) != 0, np.arange(len(after)) % 5 == first)
    assert [record.record_data_bytes() for record in after.header.evlrs] == [b"B" * 70_000]


def test_a_layer_of_another_survey_or_crs_is_refused_and_an_empty_one_is_told_of(mapped, tmp_path):
    import processing
    from qgis.core import QgsProcessingException

    def changed(name, algorithm, **how):
        return processing.run(algorithm, {"INPUT": mapped[name], "OUTPUT": str(tmp_path / f"{algorithm[7:]}.gpkg"), **how})["OUTPUT"]

    for layer, problem in ((changed("MARKINGS", "native:translategeometry", DELTA_X=300), "do not belong together"),
                           (changed("MARKINGS", "native:assignprojection", CRS="EPSG:31467"), "Reproject the layer to their CRS")):
        with pytest.raises(QgsProcessingException, match=problem):
            classified(mapped, tmp_path / "out", MARKINGS=layer)
    found = classified(mapped, tmp_path / "out", MARKINGS=changed("MARKINGS", "native:extractbyexpression", EXPRESSION="FALSE"))
    assert found["PAINT_POINTS"] == 0 and found["WARNINGS"] == 1


def test_noise_withheld_points_and_what_another_program_classified_stay(mapped, tmp_path):
    def change(cloud):
        cloud.classification[::10], cloud.withheld[1::10], cloud.classification[2::10] = 18, 1, 65
        cloud.classification[3::10] = 6

    path = written(mapped["POINT_CLOUDS"][0], tmp_path / "s.laz", 6, change)
    classified(mapped, tmp_path / "out", POINT_CLOUDS=[path])
    before, after = laspy.read(path), laspy.read(tmp_path / "out" / "s.laz")
    classes, far = np.asarray(after.classification), np.asarray(after.height_above_road) > 1.0
    assert (classes[::10] == 18).all()
    assert (classes[1::10] == before.classification[1::10]).all()
    assert far[2::10].any() and (classes[2::10][far[2::10]] == 1).all(), "a curb of an earlier run is none high above the road"
    assert (classes[3::10][far[3::10]] == 6).all()


def test_it_can_be_run_again_on_what_it_wrote(mapped, tmp_path):
    classified(mapped, tmp_path / "one", POINT_CLOUDS=[written(mapped["POINT_CLOUDS"][0], tmp_path / "s.laz", 6)])
    classified(mapped, tmp_path / "two", POINT_CLOUDS=[str(tmp_path / "one")])
    one, two = (laspy.read(tmp_path / name / "s.laz") for name in ("one", "two"))
    assert one.points.array.tobytes() == two.points.array.tobytes()
    assert len(one.header.vlrs) == len(two.header.vlrs)


def test_the_unrolled_road_is_straight_and_level_where_it_was_driven(mapped, tmp_path):
    classified(mapped, tmp_path / "out", UNROLLED=str(tmp_path / "unrolled"))
    laid, cloud = laspy.read(tmp_path / "unrolled" / "s.laz"), laspy.read(tmp_path / "out" / "s.laz")
    road = np.asarray(cloud.road) == 0
    assert len(laid) == road.sum() > 10_000
    for one, other in zip("xyz", ("station", "offset", "height_above_road")):
        np.testing.assert_allclose(laid[one], np.asarray(cloud[other])[road], atol=1e-6)
    np.testing.assert_array_equal(laid.gps_time, cloud.gps_time[road])
    asphalt = (laid.classification == 11) & (np.abs(np.asarray(laid.y)) < 1.0)
    assert np.abs(np.asarray(laid.z)[asphalt]).max() < 0.06
    assert laid.header.parse_crs() is None


def test_an_octree_stays_one_and_a_plain_file_becomes_one_on_wish(mapped, tmp_path):
    from copc_files import write_copc
    from qgis.core import QgsPointCloudLayer

    plain = written(mapped["POINT_CLOUDS"][0], tmp_path / "s.laz", 6)
    octree = write_copc(plain, tmp_path / "t.copc.laz")
    classified(mapped, tmp_path / "plain", POINT_CLOUDS=[plain])
    expected = laspy.read(tmp_path / "plain" / "s.laz")
    for cloud, name, more in ((octree, "t.copc.laz", {}), (plain, "s.copc.laz", {"COPC": True, "UNROLLED": str(tmp_path / "unrolled")})):
        classified(mapped, tmp_path / "out", POINT_CLOUDS=[cloud], **more)
        path = tmp_path / "out" / name
        assert QgsPointCloudLayer(str(path), "", "copc").isValid()
        with laspy.CopcReader.open(path) as reader:
            points, coarse = reader.query(), reader.query(level=0)
        assert 0 < len(coarse) < len(points) == len(expected)
        assert np.ptp(coarse.x) > 0.9 * np.ptp(points.x) and np.ptp(coarse.y) > 0.9 * np.ptp(points.y)
        before, after = (np.sort(np.rec.fromarrays([np.asarray(cloud[name]) for name in ("X", "Y", "Z", "gps_time", "classification", "road")]))
                         for cloud in (expected, points))
        np.testing.assert_array_equal(after, before)
        assert laspy.open(path).header.parse_crs() == expected.header.parse_crs()
    assert [path.name for path in (tmp_path / "unrolled").iterdir()] == ["s.copc.laz"]


def test_inputs_are_not_written_over_and_a_failed_run_leaves_nothing(mapped, tmp_path):
    from qgis.core import QgsProcessingException

    cloud = written(mapped["POINT_CLOUDS"][0], tmp_path / "s.laz", 6)
    stays = (tmp_path / "s.laz").read_bytes()
    with pytest.raises(QgsProcessingException, match="inputs are never changed"):
        classified(mapped, tmp_path, POINT_CLOUDS=[cloud])
    assert (tmp_path / "s.laz").read_bytes() == stays and [path.name for path in tmp_path.iterdir()] == ["s.laz"]
    with pytest.raises(QgsProcessingException, match="which is a file"):
        classified(mapped, tmp_path / "s.laz", POINT_CLOUDS=[cloud])
    with pytest.raises(QgsProcessingException, match="Give each a folder of its own"):
        classified(mapped, tmp_path / "out", POINT_CLOUDS=[cloud], UNROLLED=str(tmp_path / "out"))
    with pytest.raises(QgsProcessingException, match=r"written to s\.laz"):
        classified(mapped, tmp_path / "out", POINT_CLOUDS=[cloud, mapped["POINT_CLOUDS"][0]])
    other = written(cloud, tmp_path / "t.laz", 6, lambda made: made.add_extra_dim(laspy.ExtraBytesParams("station", "float64")))
    with pytest.raises(QgsProcessingException, match="extra field station"):
        classified(mapped, tmp_path / "out", POINT_CLOUDS=[other])
    assert not (tmp_path / "out").exists()
