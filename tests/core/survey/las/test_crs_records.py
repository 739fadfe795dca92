"""What LAS files say about their coordinates, in WKT and GeoKeys, in feet and in contradiction."""

import laspy
import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.io.crs import check_projected, crs_note, parse_crs
from lanewright.core.survey.las.reader import read_blocks, read_headers

FOOT = 1200 / 3937
UTM, NEW_YORK = (550_000.0, 5_400_000.0, 50.0), (984_250.0, 200_000.0, 164.0)   # m; feet
METRE, INTERNATIONAL, US = 9001, 9002, 9003


def cloud(path, place, keys=(), wkt="", doubles=()):
    """A LAS file of 100 points within 30 units of a place."""
    header = laspy.LasHeader(point_format=1, version="1.2" if not wkt else "1.4")
    header.scales, header.offsets = np.full(3, 0.001), np.array(place)
    if keys:
        record = laspy.vlrs.known.GeoKeyDirectoryVlr()
        record.geo_keys = [laspy.vlrs.known.GeoKeyEntryStruct(id=key, tiff_tag_location=34736 * (key == 3077), count=1, value_offset=value)
                           for key, value in keys]
        record.geo_keys_header.number_of_keys = len(keys)
        header.vlrs.append(record)
    if doubles:
        header.vlrs.append(laspy.VLR("LASF_Projection", 34736, "", np.array(doubles, "<f8").tobytes()))
    if wkt:
        header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(parse_crs(wkt).to_wkt("WKT1_GDAL")))
        header.global_encoding.wkt = True
    data = laspy.LasData(header)
    data.x, data.y, data.z = (np.asarray(place)[:, None] + np.random.default_rng(1).uniform(0, 30, (3, 100)))
    data.write(str(path))
    return str(path)


def units_of(path, given=""):
    files = read_headers([path], given=given)
    crs = check_projected(files, given)
    return files[0].units.across, files[0].units.up, crs_note(files, given, crs)


@pytest.mark.parametrize("keys, wkt, across, up", [
    ([(3072, 2263), (3076, US)], "", FOOT, FOOT), ([(3072, 2263), (3076, US), (4096, 5703), (4099, METRE)], "", FOOT, 1.0),
    ([(3072, 2263), (3076, US), (4096, 6360), (4099, US)], "", FOOT, FOOT), ([], "EPSG:2263+6360", FOOT, FOOT), ([], "EPSG:2263+5703", FOOT, 1.0),
    ([(3072, 2263), (3076, US)], "EPSG:2263", FOOT, FOOT), ([(3072, 2263), (3077, 0)], "", FOOT, FOOT),
    ([(3072, 2263), (3076, 32767), (3077, 0)], "", FOOT, FOOT),
])
def test_clouds_in_feet_are_read_in_metres(tmp_path, keys, wkt, across, up):
    path = cloud(tmp_path / "cloud.las", NEW_YORK, keys, wkt, [FOOT])
    assert units_of(path)[:2] == pytest.approx((across, up), rel=1e-9)
    points = np.concatenate([np.c_[block.x, block.y, block.z] for block in read_blocks(path)])
    stored = laspy.read(path)
    np.testing.assert_allclose(points, np.c_[stored.x * across, stored.y * across, stored.z * up], rtol=1e-12)
    header = read_headers([path])[0]
    np.testing.assert_allclose(header.minimum, points.min(axis=0), atol=1e-3)
    assert "New York" in parse_crs(header.crs).name


@pytest.mark.parametrize("keys, wkt", [
    ([(3072, 32632), (3076, METRE), (4096, 5703), (4099, US)], ""), ([(3072, 32632), (4099, US)], ""), ([(3072, 32632), (4096, 6360)], ""),
    ([], "EPSG:32632+6360"), ([(3072, 32632), (4099, US)], "EPSG:32632"),
])
def test_heights_in_feet_beside_metres_are_converted_and_said(tmp_path, keys, wkt):
    across, up, note = units_of(cloud(tmp_path / "cloud.las", UTM, keys, wkt))
    assert (across, up) == (1.0, pytest.approx(FOOT)) and "unit of its heights is the US survey foot" in note


@pytest.mark.parametrize("place, keys, wkt, says", [
    (UTM, [(3072, 32632), (3076, US)], "", "its unit key says US survey foot"),
    (NEW_YORK, [(3072, 2263), (3076, METRE)], "", "its unit key says metre"),
    (NEW_YORK, [(3072, 2263), (3076, INTERNATIONAL)], "", "its unit key says foot"),
    (UTM, [(3072, 32633)], "EPSG:32632", "WKT says .*32N, its GeoKeys say .*33N"),
    (UTM, [(3072, 32632), (3076, US)], "EPSG:32632", "its unit key says US survey foot"),
    (UTM, [(3072, 32632), (4099, METRE)], "EPSG:32632+6360", "heights are in US survey foot, its GeoKeys say metre"),
    (NEW_YORK, [(3076, US)], "", "CRS that they lie in is not known"), (NEW_YORK, [(3072, 32767), (3076, US)], "", "is not known"),
    (UTM, [(4099, US)], "", "CRS of its x and y is not known"),
])
def test_contradictions_are_refused_until_the_parameter_crs_decides(tmp_path, place, keys, wkt, says):
    path = cloud(tmp_path / "cloud.las", place, keys, wkt)
    with pytest.raises(RoadExtractionError, match=f"{says}.*by the parameter CRS"):
        units_of(path)
    given = "EPSG:2263" if place is NEW_YORK else "EPSG:32632"
    across, up, note = units_of(path, given)
    assert (across, up) == pytest.approx((FOOT, FOOT) if place is NEW_YORK else (1.0, 1.0)) and "was not used, but the parameter CRS" in note


@pytest.mark.parametrize("keys, wkt", [
    ([(3072, 32632), (3076, METRE)], ""), ([(3072, 32632), (4096, 5703), (4099, METRE)], ""), ([(3072, 32632), (4096, 5103)], ""),
    ([(3072, 25832)], "EPSG:32632"), ([(3072, 32632), (4099, METRE)], "EPSG:32632+5703"),
])
def test_files_that_say_one_thing_twice_are_read_without_a_word(tmp_path, keys, wkt):
    assert units_of(cloud(tmp_path / "cloud.las", UTM, keys, wkt)) == (1.0, 1.0, "")


def test_a_cloud_without_a_crs_has_the_units_of_the_one_given(tmp_path):
    path = cloud(tmp_path / "cloud.las", NEW_YORK)
    assert units_of(path, "EPSG:2263")[:2] == pytest.approx((FOOT, FOOT))
    assert read_headers([path], given="EPSG:2263")[0].minimum[0] == pytest.approx(laspy.read(path).x.min() * FOOT)


@pytest.mark.parametrize("wkt, says", [("EPSG:4978", "geocentric"), ("EPSG:4326", "geographic"), ("EPSG:3857", "1.478")])
def test_other_kinds_of_crs_are_refused_by_kind(tmp_path, wkt, says):
    with pytest.raises(RoadExtractionError, match=says):
        units_of(cloud(tmp_path / "cloud.las", (1_000_000.0, 6_000_000.0, 50.0), [], wkt))


def test_a_crs_of_heights_alone_counts_as_none(tmp_path):
    path = cloud(tmp_path / "cloud.las", UTM, [], "EPSG:5703")
    assert read_headers([path])[0].crs == "" and check_projected(read_headers([path])) == ""
