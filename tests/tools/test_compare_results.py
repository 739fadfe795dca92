"""`tools/compare_results.sh`: what differs between two folders of results is found and named."""

import shutil

import laspy
import numpy as np
import pytest

gdal = pytest.importorskip("osgeo.gdal")

import compare_results  # noqa: E402
from compare_results import compare_folders, main  # noqa: E402
from lanewright.core.common.features import Features, Field  # noqa: E402
from make_sample import write_layers  # noqa: E402
from osgeo import ogr, osr  # noqa: E402
from pyproj import CRS  # noqa: E402
from shapely import LineString, Polygon  # noqa: E402

EAST, NORTH = 610_000.0, 2_710_000.0


@pytest.fixture
def results(tmp_path):
    """Two folders with the same results of one survey, both written: edges.gpkg, intensity.tif, road.laz and report.html."""
    for which in ("first", "second"):
        folder = tmp_path / which / "street"
        folder.mkdir(parents=True)
        _write_edges(folder / "edges.gpkg")
        _write_image(folder / "intensity.tif")
        _write_cloud(folder / "road.laz")
        (folder / "report.html").write_text(f"made by the {which} run")
    return tmp_path / "first", tmp_path / "second"


def _write_edges(path):
    edges = Features("LineStringZ", [Field("side", str), Field("end_m", float), Field("params", str)], crs=CRS.from_epsg(32650).to_wkt())
    for number in range(5):
        line = [(EAST + x, NORTH + number, 30.0) for x in range(4)]
        edges.add(LineString(line), side="left", end_m=10.0 * number, params=f'{{"radius": {100.25 + number}}}')
    surface = Features("PolygonZ", [Field("road", int)])
    surface.add(Polygon([(0, 0, 1), (1, 0, 1), (1, 1, 1)]), road=1)
    write_layers(path, {"edges": edges, "surface": surface})


def _write_image(path, cells=None, nodata=-9999.0, left=EAST):
    cells = np.arange(60, dtype=np.float32).reshape(6, 10) if cells is None else cells
    image = gdal.GetDriverByName("GTiff").Create(str(path), 10, 6, 1, gdal.GDT_Float32)
    image.SetGeoTransform((left, 0.04, 0, NORTH, 0, -0.04))
    image.GetRasterBand(1).SetNoDataValue(nodata)
    image.GetRasterBand(1).WriteArray(cells)


def _write_cloud(path, change=lambda cloud: None, scale=0.001):
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = [scale] * 3, [EAST, NORTH, 0.0]
    header.add_extra_dim(laspy.ExtraBytesParams("offset_m", np.float32))
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = (origin + np.arange(50) * 0.01 for origin in (EAST, NORTH, 30.0))
    cloud.intensity, cloud.gps_time, cloud.offset_m = np.arange(50), np.arange(50) * 0.5, np.linspace(-3, 3, 50)
    change(cloud)
    cloud.write(str(path))


def told(results, **options):
    """What differs, by path; what is the same is left out."""
    return {str(path): differences for path, differences in compare_folders(*results, **options).items() if differences}


def sql(results, *statements):
    """Change the second GeoPackage."""
    source = gdal.OpenEx(str(results[1] / "street" / "edges.gpkg"), gdal.OF_VECTOR | gdal.OF_UPDATE)
    for statement in statements:
        source.ExecuteSQL(statement)


def move(results, feature, vertex, by):
    source = ogr.Open(str(results[1] / "street" / "edges.gpkg"), 1)
    layer = source.GetLayerByName("edges")
    found = layer.GetFeature(feature)
    line = found.GetGeometryRef().Clone()
    line.SetPoint(vertex, *(value + shift for value, shift in zip(line.GetPoint(vertex), by)))
    found.SetGeometry(line)
    layer.SetFeature(found)


def test_results_written_twice_are_the_same_though_their_reports_name_another_time(results, capsys):
    assert told(results) == {}
    assert main([str(folder) for folder in results]) == 0
    *files, last = capsys.readouterr().out.splitlines()
    assert files == ["same       street/edges.gpkg", "same       street/intensity.tif", "present    street/report.html", "same       street/road.laz"]
    assert last == "3 files are the same, 0 differ; of 1 only the presence was checked."


@pytest.mark.parametrize("by, metres", [((0.03, 0.04, 0.0), "0.05 m"), ((0.0, 0.0, 0.02), "0.02 m")])
def test_a_moved_vertex_is_found_in_plan_and_in_height(results, by, metres):
    move(results, feature=3, vertex=2, by=by)
    assert told(results) == {"street/edges.gpkg": [f"layer edges: coordinates of 1 of 5 features differ by up to {metres} (feature 3)"]}


def test_the_largest_difference_and_the_first_features_are_named(results):
    for feature in (1, 2, 4, 5):
        move(results, feature, vertex=0, by=(0.0, 0.0, feature / 8))
    difference, = told(results)["street/edges.gpkg"]
    assert difference == "layer edges: coordinates of 4 of 5 features differ by up to 0.625 m (feature 1, 2, 4 and others)"


def test_the_last_bit_of_a_coordinate_counts_and_a_tolerance_forgives_it(results):
    move(results, feature=2, vertex=1, by=(0.0, 0.0, np.spacing(30.0)))
    assert told(results) and not told(results, tolerance=1e-9)
    move(results, feature=2, vertex=1, by=(0.0, 0.002, 0.0))
    assert told(results, tolerance=0.001) and not told(results, tolerance=0.003)


def test_a_vertex_more_is_no_small_difference(results):
    source = ogr.Open(str(results[1] / "street" / "edges.gpkg"), 1)
    layer = source.GetLayerByName("edges")
    feature = layer.GetFeature(1)
    line = feature.GetGeometryRef().Clone()
    line.AddPoint(*line.GetPoint(3))
    feature.SetGeometry(line)
    layer.SetFeature(feature)
    del layer, source
    words = "layer edges: coordinates of 1 of 5 features differ (feature 1: 4 and 5 vertices)"
    assert told(results, tolerance=10.0) == {"street/edges.gpkg": [words]}


def test_a_missing_feature_is_named(results):
    sql(results, "DELETE FROM edges WHERE fid = 4")
    assert told(results) == {"street/edges.gpkg": ["layer edges: 5 and 4 features", "layer edges: 1 only in the first: feature 4"]}


def test_features_in_another_order_are_not_the_same(results):
    sql(results, "UPDATE edges SET fid = 99 WHERE fid = 2")
    assert told(results) == {"street/edges.gpkg": ["layer edges: the same features in another order, from feature 2 on"]}


@pytest.mark.parametrize("change, words", [
    ("end_m = 20.25 WHERE fid = 3", "end_m of 1 of 5 features differ by up to 0.25 (feature 3)"),
    ("side = 'right' WHERE fid >= 4", "side of 2 of 5 features differ (feature 4, 5: 'left' and 'right')"),
    ("end_m = NULL WHERE fid = 1", "end_m of 1 of 5 features differ (feature 1: 0.0 and None)"),
    ("params = '{\"radius\": 100.75}' WHERE fid = 1", "params of 1 of 5 features differ by up to 0.5 (feature 1)"),
])
def test_a_changed_attribute_is_named(results, change, words):
    sql(results, f"UPDATE edges SET {change}")
    assert told(results) == {"street/edges.gpkg": [f"layer edges: {words}"]}


def test_a_tolerance_forgives_numbers_and_no_words(results):
    sql(results, "UPDATE edges SET end_m = end_m + 0.001, params = '{\"radius\": 100.2501}' WHERE fid = 1")
    assert told(results) and not told(results, tolerance=0.01)
    sql(results, "UPDATE edges SET side = 'right' WHERE fid = 1")
    assert told(results, tolerance=0.01)


def test_layers_fields_and_crs_are_compared(results):
    sql(results, "DROP TABLE surface", "ALTER TABLE edges ADD COLUMN kind TEXT")
    assert told(results) == {"street/edges.gpkg": ["layer edges: field kind only in the second", "layer surface only in the first"]}
    crs = osr.SpatialReference()
    crs.ImportFromEPSG(32651)
    gdal.VectorTranslate(str(results[1] / "street" / "edges.gpkg"), str(results[0] / "street" / "edges.gpkg"), dstSRS=crs.ExportToWkt(),
                         reproject=False, layers=["edges"])
    assert "layer edges: CRS WGS 84 / UTM zone 50N and WGS 84 / UTM zone 51N" in told(results)["street/edges.gpkg"]


def test_how_a_style_is_written_does_not_count_and_that_there_is_one_does(results):
    for which, folder in enumerate(results):
        source = gdal.OpenEx(str(folder / "street" / "edges.gpkg"), gdal.OF_VECTOR | gdal.OF_UPDATE)
        layer = source.CreateLayer("layer_styles", geom_type=ogr.wkbNone)
        layer.CreateField(ogr.FieldDefn("styleQML", ogr.OFTString))
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetField("styleQML", f"<qgis id='{which}'/>")
        layer.CreateFeature(feature)
    del layer, source
    assert told(results) == {}
    sql(results, "DROP TABLE layer_styles")
    assert told(results) == {"street/edges.gpkg": ["layer layer_styles only in the first"]}


def test_a_changed_pixel_is_named(results, monkeypatch):
    cells = np.arange(60, dtype=np.float32).reshape(6, 10)
    cells[4, 7] += 0.5
    _write_image(results[1] / "street" / "intensity.tif", cells)
    words = {"street/intensity.tif": ["1 of 60 cells of band 1 differ by up to 0.5 (column 7, row 4)"]}
    assert told(results) == words and not told(results, tolerance=0.5)
    monkeypatch.setattr(compare_results, "AT_ONCE", 25)
    assert told(results) == words


def test_a_cell_without_a_value_differs_from_one_with_a_value_and_the_nodata_value_is_no_distance(results):
    cells = np.arange(60, dtype=np.float32).reshape(6, 10)
    cells[0, 3] = -9999.0
    cells[1, 1] = 13.0
    _write_image(results[1] / "street" / "intensity.tif", cells)
    assert told(results) == {"street/intensity.tif": ["2 of 60 cells of band 1 differ by up to 2 (column 3, row 0; column 1, row 1)"]}


def test_place_and_nodata_value_of_an_image_are_compared(results):
    _write_image(results[1] / "street" / "intensity.tif", nodata=0.0, left=EAST + 0.5)
    place, nodata = told(results)["street/intensity.tif"]
    assert place.startswith("geotransform (610000.0,") and "(610000.5," in place
    assert nodata == "nodata value of band 1 -9999.0 and 0.0"


@pytest.mark.parametrize("dimension, step, words", [
    ("z", 0.004, "z of 1 of 50 points differ by up to 0.004 m (point 31)"),
    ("intensity", 7, "intensity of 1 of 50 points differ by up to 7 (point 31)"),
    ("offset_m", 0.5, "offset_m of 1 of 50 points differ by up to 0.5 (point 31)"),
    ("classification", 11, "classification of 1 of 50 points differ by up to 11 (point 31)"),
])
def test_a_changed_point_is_named(results, monkeypatch, dimension, step, words):
    def change(cloud):
        values = np.array(cloud[dimension])
        values[30] += step
        cloud[dimension] = values

    _write_cloud(results[1] / "street" / "road.laz", change)
    assert told(results) == {"street/road.laz": [words]}
    monkeypatch.setattr(compare_results, "AT_ONCE", 20)
    assert told(results) == {"street/road.laz": [words]}
    assert not told(results, tolerance=step)


def test_points_too_few_and_another_scale_are_named(results):
    _write_cloud(results[1] / "street" / "road.laz", lambda cloud: setattr(cloud, "points", cloud.points[:49]))
    assert told(results) == {"street/road.laz": ["50 and 49 points"]}
    _write_cloud(results[1] / "street" / "road.laz", scale=0.0001)
    assert told(results, tolerance=1e-6) == {"street/road.laz": ["scale (0.001, 0.001, 0.001) and (0.0001, 0.0001, 0.0001)"]}


def test_the_crs_of_a_cloud_is_compared(results):
    _write_cloud(results[1] / "street" / "road.laz", lambda cloud: cloud.header.add_crs(CRS.from_epsg(32650)))
    assert told(results) == {"street/road.laz": ["CRS none and WGS 84 / UTM zone 50N"]}


def test_a_file_that_is_missing_or_damaged_is_named(results, capsys):
    (results[0] / "street" / "intensity.tif").unlink()
    (results[1] / "street" / "report.html").unlink()
    whole = (results[1] / "street" / "road.laz").read_bytes()
    (results[1] / "street" / "road.laz").write_bytes(whole[:len(whole) - 200])
    (results[1] / "street" / "edges.gpkg").write_text("no database")
    assert main([str(folder) for folder in results]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(": ")[0] for line in lines[:-1]] == [f"different  street/{name}" for name in
                                                            ("edges.gpkg", "intensity.tif", "report.html", "road.laz")]
    assert "only in the second folder" in lines[1] and "only in the first folder" in lines[2]
    assert "cannot be read" in lines[0] and "cannot be read" in lines[3]


def test_some_surveys_alone_are_compared(results, capsys):
    shutil.copytree(results[0] / "street", results[0] / "avenue")
    folders = [str(folder) for folder in results]
    assert main(folders) == 1
    assert main([*folders, "--only", "street"]) == 0
    assert main([*folders, "--only", "street,avenue"]) == 1
    with pytest.raises(SystemExit) as ended:
        main([*folders, "--only", "lane"])
    assert ended.value.code == 2 and "holds results in a folder lane" in capsys.readouterr().err


def test_nothing_to_compare_is_not_the_same(results, tmp_path):
    (tmp_path / "empty").mkdir()
    for first, second in ((tmp_path / "empty", tmp_path / "empty"), (results[0], tmp_path / "nowhere")):
        with pytest.raises(SystemExit) as ended:
            main([str(first), str(second)])
        assert ended.value.code == 2


def test_an_unknown_kind_of_file_is_compared_byte_by_byte_and_what_viewers_leave_behind_is_not(results):
    for folder in results:
        (folder / "lanes.xodr").write_text("<OpenDRIVE/>")
        shutil.copy(folder / "street" / "report.html", folder / "intensity.tif.aux.xml")
    assert told(results) == {}
    (results[1] / "lanes.xodr").write_text("<OpenDRIVE />")
    assert told(results) == {"lanes.xodr": ["other bytes"]}
