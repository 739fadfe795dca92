"""Layers in files, without QGIS."""

import sqlite3
from contextlib import closing

import numpy as np
import pytest
import shapely
from lanewright.algorithms.destinations import table_of
from lanewright.algorithms.vector_source import in_file_units, read_features, scaled_wkb, vertices_of
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import CURVE_ELEMENTS, MARKINGS, ROAD_EDGES, SCANLINES, TRAJECTORY, Features
from lanewright.core.io.crs import in_metres, parse_crs, same_crs
from lanewright.library import layer_files
from lanewright.library.layer_files import LayerFile, file_and_table, write_layer
from lanewright.products.scanline_layer import LineSpool
from pyproj import CRS

UTM = CRS.from_epsg(32650).to_wkt()
EDGE = {"road": 1, "side": "left", "status": "measured", "station_m": 12.25, "end_m": 1 / 3, "rmse_m": float("nan"), "chain": np.int64(4)}


def nothing():
    pass


def written(path, features, table=""):
    write_layer(str(path), table, features, nothing)
    return str(path)


def edges(count=2):
    lines = [shapely.linestrings([(610400.1 + k, 2710200.7, 24.123456789), (610410.0, 2710210.0, 25.0)]) for k in range(count)]
    return Features("LineStringZ", ROAD_EDGES, lines, [dict(EDGE) for _ in lines], UTM)


@pytest.mark.parametrize("value, file, table", [
    ("map.gpkg", "map.gpkg", ""), ("map.gpkg|layername=lanes", "map.gpkg", "lanes"),
    ("ogr:dbname='/data/the map.gpkg' table=\"lanes\" (geom)", "/data/the map.gpkg", "lanes"),
    (table_of("/home/O'Neil/map.gpkg", "lanes"), "/home/O'Neil/map.gpkg", "lanes"),
    (table_of(r"C:\data\map.gpkg", "lanes"), r"C:\data\map.gpkg", "lanes"),
    ("ogr:dbname='C:\\data\\map.gpkg' table=\"lanes\"", r"C:\data\map.gpkg", "lanes"),
])
def test_a_layer_is_named_as_in_qgis(value, file, table):
    assert file_and_table(value) == (file, table)


@pytest.mark.parametrize("suffix", ["gpkg", "fgb", "shp", "geojson"])
def test_edges_come_back_as_they_were_written(tmp_path, suffix):
    path = written(tmp_path / f"edges.{suffix}", edges())
    found = read_features(LayerFile(path, "Road edges"), ROAD_EDGES, "LineStringZ")
    tolerance = 0.0 if suffix in ("gpkg", "fgb") else 1e-6
    geometries = sorted(found.geometries, key=lambda line: line.coords[0])  # a FlatGeobuf sorts its rows by place
    assert shapely.equals_exact(geometries, edges().geometries, tolerance).all() and shapely.has_z(geometries).all()
    row = found.rows[0]
    assert (row["road"], row["side"], row["station_m"], row["chain"]) == (1, "left", 12.25, 4)
    assert row["rmse_m"] is None and row["pass"] is None and row["end_m"] == pytest.approx(1 / 3, abs=1e-9)
    assert CRS.from_wkt(found.crs).to_epsg() == 32650 or suffix == "geojson"


@pytest.mark.parametrize("kind, schema, wkb", [("PointZ", TRAJECTORY, None), ("LineStringZM", SCANLINES, True)])
def test_a_layer_without_a_crs_is_cartesian_in_a_geopackage_and_never_geographic(tmp_path, kind, schema, wkb):
    if wkb:
        layer = LineSpool(kind, schema)
        layer.add(np.array([[1.0, 2, 3, 4], [2, 3, 4, 5]]), np.array([0, 2]))
    else:
        layer = Features(kind, schema, [shapely.points(1.0, 2.0, 3.0)], [{}])
    path = written(tmp_path / "bare.gpkg", layer)
    with closing(sqlite3.connect(path)) as database:
        assert database.execute("SELECT srs_id FROM gpkg_geometry_columns").fetchall() == [(-1,)]
    assert LayerFile(path, "Layer").crs == ""


@pytest.mark.parametrize("crs, across, up", [
    ("EPSG:2263", 1200 / 3937, 1200 / 3937), ("EPSG:2263+5703", 1200 / 3937, 1.0), ("EPSG:2222", 0.3048, 0.3048)])
@pytest.mark.parametrize("suffix", ["gpkg", "fgb", "shp"])
def test_a_layer_of_a_survey_in_feet_is_stored_in_feet_and_read_in_metres(tmp_path, suffix, crs, across, up):
    wkt = in_metres(parse_crs(crs).to_wkt())[0]
    line = shapely.linestrings([(300000.5, 61000.25, 24.125), (300010.0, 61010.0, 25.0)])
    path = written(tmp_path / f"edges.{suffix}", in_file_units(Features("LineStringZ", ROAD_EDGES, [line], [dict(EDGE)], wkt)))
    source = LayerFile(path, "Road edges")
    (stored, _), = source.stored_rows()
    np.testing.assert_allclose(vertices_of(stored)[0, :3], [300000.5 / across, 61000.25 / across, 24.125 / up], rtol=1e-12)
    assert CRS(source.stored_crs).equals(CRS(crs)) or suffix == "shp"
    found = read_features(source, ROAD_EDGES, "LineStringZ")
    np.testing.assert_allclose(shapely.get_coordinates(found.geometries, include_z=True), shapely.get_coordinates(line, include_z=True), atol=1e-6)
    assert same_crs(parse_crs(found.crs), parse_crs(wkt)) and found.rows[0]["station_m"] == 12.25, "fields stay in metres"


def test_a_geojson_whose_texts_are_not_in_utf_8_is_refused_in_one_sentence(tmp_path):
    layer = edges()
    layer.rows[1]["status"] = "Straße"
    path = tmp_path / "edges.geojson"
    written(path, layer)
    path.write_bytes(path.read_bytes().replace("ß".encode(), b"\xdf"))
    with pytest.raises(RoadExtractionError, match="holds texts that are not in UTF-8"):
        read_features(LayerFile(str(path), "Road edges"), ROAD_EDGES, "LineStringZ")


def test_measures_of_lines_in_feet_stay_as_they_are(tmp_path):
    layer = LineSpool("LineStringZM", SCANLINES, in_metres("EPSG:2263")[0])
    layer.add(np.array([[300_000.0, 61_000, 3, 4], [300_001, 61_001, 4, 5]]), np.array([0, 2]), road=0)
    source = LayerFile(written(tmp_path / "lines.gpkg", in_file_units(layer)), "Scanlines")
    (stored, _), = source.stored_rows(measures=True)
    (found, _), = source.rows(measures=True)
    np.testing.assert_allclose(vertices_of(stored)[0], [984_250.0, 61_000 / (1200 / 3937), 3 / (1200 / 3937), 4])
    np.testing.assert_allclose(vertices_of(found), [[300_000.0, 61_000, 3, 4], [300_001, 61_001, 4, 5]])


def test_every_kind_of_geometry_is_scaled():
    square = shapely.polygons([(0, 0, 1), (4, 0, 1), (4, 4, 1), (0, 0, 1)], holes=[[(2, 1, 1), (3, 1, 1), (3, 2, 1), (2, 1, 1)]])
    lines = shapely.multilinestrings([[(0, 0), (1, 2)], [(3, 4), (5, 6)]])
    for one in (square, shapely.multipolygons([square, square]), lines, shapely.points(1, 2)):
        wkb = shapely.to_wkb(one, output_dimension=3, flavor="iso")
        found = shapely.from_wkb(scaled_wkb(wkb, 2.0, 3.0))
        expected = shapely.get_coordinates(one, include_z=True) * (2.0, 2.0, 3.0)
        np.testing.assert_array_equal(shapely.get_coordinates(found, include_z=True), expected)


def test_points_polygons_and_tables(tmp_path):
    square = shapely.polygons([(0.0, 0, 1), (1, 0, 1), (1, 1, 2), (0, 0, 1)])
    for kind, schema, geometry in (("PointZ", TRAJECTORY, shapely.points(1.0, 2.0, 3.0)), ("PolygonZ", MARKINGS, square),
                                   ("MultiPolygonZ", MARKINGS, shapely.multipolygons([square]))):
        path = written(tmp_path / f"{kind}.gpkg", Features(kind, schema, [geometry], [{}], UTM))
        found = read_features(LayerFile(path, "Layer"), schema, kind)
        assert [shapely.to_wkt(one) for one in found.geometries] == [shapely.to_wkt(shapely.get_parts(geometry)[0])]
    table = Features("None", CURVE_ELEMENTS, [None], [{"road": 1, "turn": "left", "radius_m": 140.0}])
    found = read_features(LayerFile(written(tmp_path / "table.gpkg", table), "Curve elements"), CURVE_ELEMENTS, "None")
    assert found.rows[0]["turn"] == "left" and found.rows[0]["radius_m"] == 140.0 and found.rows[0]["lane"] is None and found.crs == ""


def test_tables_of_one_geopackage_leave_each_other_alone(tmp_path):
    package = tmp_path / "map.gpkg"
    written(package, edges(2), "first")
    written(package, edges(3), "second")
    written(package, edges(1), "first")
    assert [len(list(LayerFile(f"{package}|layername={name}", "Edges").rows())) for name in ("first", "second")] == [1, 3]


def test_scanlines_keep_their_intensity(tmp_path):
    pytest.importorskip("osgeo")
    spool = LineSpool("LineStringZM", SCANLINES, UTM)
    vertices = np.array([(610400.0, 2710200.0, 24.0, 100.0), (610401.0, 2710200.0, 24.1, 200.0), (610402.0, 2710201.0, 24.2, 300.0)])
    spool.add(vertices, [0, 3], road=0, station_m=1.5, length_m=2.4, interval_m=0.1, scanner=1, **{"pass": 0})
    source = LayerFile(written(tmp_path / "scanlines.gpkg", spool), "Scanlines")
    found = read_features(source, SCANLINES, "LineStringZM")
    assert source.has_m and found.rows[0]["scanner"] == 1
    np.testing.assert_array_equal(vertices_of(found.geometries[0]), vertices)


def test_without_gdal_a_line_with_measures_is_refused_and_one_without_is_read(tmp_path, monkeypatch):
    """Read without its measures a drive would lose its time unnoticed."""
    ogr = pytest.importorskip("osgeo.ogr")
    package = ogr.GetDriverByName("GPKG").CreateDataSource(str(tmp_path / "drive.gpkg"))
    drives = (("timed", ogr.wkbLineStringZM, "LINESTRING ZM (0 0 0 1, 1 0 0 2)"), ("plain", ogr.wkbLineString25D, "LINESTRING Z (0 0 5, 1 0 5)"))
    for name, kind, wkt in drives:
        layer = package.CreateLayer(name, None, kind)
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(wkt))
        layer.CreateFeature(feature)
    del feature, layer, package
    timed, plain = (f"{tmp_path}/drive.gpkg|layername={name}" for name in ("timed", "plain"))
    with_gdal = [vertices_of(next(LayerFile(value, "Trajectory").rows(measures=True))[0])[:, 2:].tolist() for value in (timed, plain)]
    np.testing.assert_equal(with_gdal, [[[0, 1], [0, 2]], [[5, np.nan], [5, np.nan]]])
    monkeypatch.setattr(layer_files, "find_spec", lambda name: None)
    with pytest.raises(RoadExtractionError, match="Trajectory has lines with measures, which needs GDAL"):
        next(LayerFile(timed, "Trajectory").rows(measures=True))
    wkb, _ = next(LayerFile(plain, "Trajectory").rows(measures=True))
    np.testing.assert_equal(vertices_of(wkb)[:, 2:], [[5, np.nan], [5, np.nan]])


def test_a_condition_holds_for_some_rows(tmp_path):
    layer = edges(3)
    layer.rows[1]["side"] = "right"
    source = LayerFile(written(tmp_path / "edges.gpkg", layer), "Reference")
    assert source.rows_where("\"side\" = 'right'") == [False, True, False]
    with pytest.raises(RoadExtractionError, match="no condition on the fields road, pass"):
        source.rows_where("nowhere = 1")


@pytest.mark.parametrize("value, says", [("nothing.gpkg", "there is no file"), ("text.gpkg", "cannot be read as a vector layer"),
                                         ("edges.gpkg|layername=lanes", "cannot be read as a vector layer")])
def test_what_is_no_layer_is_refused(tmp_path, value, says):
    written(tmp_path / "edges.gpkg", edges())
    (tmp_path / "text.gpkg").write_text("no database")
    with pytest.raises(RoadExtractionError, match=f"^Road edges: .*{says}"):
        LayerFile(str(tmp_path / value), "Road edges")


def test_words_where_a_number_is_needed_are_refused_by_their_field(tmp_path):
    import json

    feature = {"type": "Feature", "properties": {**EDGE, "rmse_m": 0.1, "chain": "north"},
               "geometry": {"type": "LineString", "coordinates": [[610400.0, 2710200.0, 24.0], [610410.0, 2710210.0, 25.0]]}}
    (tmp_path / "edges.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}, default=int), encoding="utf-8")
    schema = [field for field in ROAD_EDGES if field.name in feature["properties"]]
    with pytest.raises(RoadExtractionError, match="Road edges has 'north' in its field chain, where a number is needed"):
        read_features(LayerFile(str(tmp_path / "edges.geojson"), "Road edges"), schema, "LineStringZ")


def test_a_layer_of_another_stage_is_refused_by_its_fields_and_its_geometry(tmp_path):
    path = written(tmp_path / "edges.gpkg", edges())
    with pytest.raises(RoadExtractionError, match="Markings lacks the field"):
        read_features(LayerFile(path, "Markings"), MARKINGS, "PolygonZ")
    with pytest.raises(RoadExtractionError, match="of the kind Line; Point is needed"):
        read_features(LayerFile(path, "Curb points"), ROAD_EDGES, "PointZ")


ODD = {
    "one vertex": ([[610400.0, 2710200.0, 24.0]], "too few vertices"),
    "nowhere": ([[float("nan"), 2710200.0, 24.0], [610410.0, 2710210.0, 25.0]], "nowhere on earth"),
    "beyond the earth": ([[1e308, 2710200.0, 24.0], [610410.0, 2710210.0, 25.0]], "nowhere on earth"),
    "endless heights": ([[610400.0, 2710200.0, float("inf")], [610410.0, 2710210.0, 25.0]], "nowhere on earth"),
    "no heights": ([[610400.0, 2710200.0, float("nan")], [610410.0, 2710210.0, 25.0]], "without heights"),
}


@pytest.mark.parametrize("vertices, says", ODD.values(), ids=ODD)
def test_geometries_that_can_be_none_of_a_road_are_refused_by_layer_number_and_feature(tmp_path, vertices, says):
    import json

    good = [[610400.0, 2710200.0, 24.0], [610410.0, 2710210.0, 25.0]]
    features = [{"type": "Feature", "id": 11 + k, "properties": {"road": 0}, "geometry": {"type": "LineString", "coordinates": line}}
                for k, line in enumerate([good, vertices, good])]
    (tmp_path / "edges.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="utf-8")
    with pytest.raises(RoadExtractionError, match=f"Road edges .*{says}") as raised:
        read_features(LayerFile(str(tmp_path / "edges.geojson"), "Road edges"), ROAD_EDGES[:1], "LineStringZ")
    if says != "without heights":
        assert "1 of its 3 features" in str(raised.value) and "feature 12" in str(raised.value)


def test_a_ring_of_two_vertices_is_refused_and_rows_without_geometry_are_none_to_speak_of(tmp_path):
    import json

    def layer(*rings):
        features = [{"type": "Feature", "properties": {}, "geometry": ring and {"type": "Polygon", "coordinates": ring}} for ring in rings]
        (tmp_path / "areas.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="utf-8")
        return LayerFile(str(tmp_path / "areas.geojson"), "Area")

    square = [[[0, 0], [1, 0], [1, 1], [0, 0]]]
    assert [wkb is None for wkb, _ in layer(square, None).rows()] == [False, True]
    with pytest.raises(RoadExtractionError, match="Area cannot be used: 1 of its 2 features have too few vertices"):
        layer(square, [[[0, 0], [1, 0]]]).rows()
