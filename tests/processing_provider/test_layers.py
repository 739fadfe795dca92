"""Layers written and read again are the layers that were written."""

import sqlite3
from contextlib import closing

import numpy as np
import pytest
import shapely
from lanewright.algorithms.survey_input import read_trajectory_source
from lanewright.algorithms.vector_source import read_features, vertices_of
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.features import CURVE_ELEMENTS, ROAD_EDGES, Features
from lanewright.processing_provider.call import WKB_TYPES, QgisSource, crs_text, keeps_aliases, qgis_fields, write_features
from qgis.core import QgsCoordinateReferenceSystem, QgsFeatureSink, QgsProcessingContext, QgsProcessingFeedback, QgsProcessingUtils, QgsVectorLayer

UTM = QgsCoordinateReferenceSystem("EPSG:32650")


def through_a_geopackage(features, folder):
    """Write features with a sink and open the file as a layer."""
    context = QgsProcessingContext()
    fields = qgis_fields(features.schema)
    sink, dest = QgsProcessingUtils.createFeatureSink(
        str(folder / "layer.gpkg"), context, fields, WKB_TYPES[features.geometry_type], UTM
    )
    write_features(sink, features, fields)
    del sink
    layer = QgsVectorLayer(dest, "layer", "ogr")
    assert layer.isValid()
    return layer


def edges():
    features = Features("LineStringZ", ROAD_EDGES, crs=crs_text(UTM))
    line = shapely.LineString([(610427.12345678, 2710262.5, 24.001), (610430.0, 2710270.25, 24.0625)])
    features.add(line, road=0, side="left", status="measured", station_m=0.1, length_m=line.length)
    features.add(shapely.LineString([(0, 0, 0), (1, 1, 1)]), road=np.int64(3), side="right", rmse_m=np.float32(0.5), height_m=float("nan"))
    return features


def test_geometries_keep_every_digit_and_their_heights(tmp_path, qgis_app):
    written = edges()
    found = read_features(QgisSource(through_a_geopackage(written, tmp_path), "Road edges"), ROAD_EDGES, "LineStringZ")
    for before, after in zip(written.geometries, found.geometries):
        np.testing.assert_array_equal(shapely.get_coordinates(before, include_z=True), shapely.get_coordinates(after, include_z=True))
    assert found.crs == crs_text(UTM)


def test_values_come_back_in_their_type_and_missing_ones_as_missing(tmp_path, qgis_app):
    found = read_features(QgisSource(through_a_geopackage(edges(), tmp_path), "Road edges"), ROAD_EDGES, "LineStringZ")
    assert found.rows[0]["road"] == 0 and found.rows[0]["side"] == "left" and found.rows[0]["station_m"] == 0.1
    assert found.rows[1]["road"] == 3 and found.rows[1]["rmse_m"] == 0.5
    assert found.rows[1]["status"] is None and found.rows[1]["height_m"] is None


def test_a_layer_without_rows_is_still_a_layer(tmp_path, qgis_app):
    layer = through_a_geopackage(Features("LineStringZ", ROAD_EDGES, crs=crs_text(UTM)), tmp_path)
    assert layer.featureCount() == 0 and layer.fields().lookupField("station_m") >= 0
    assert len(read_features(QgisSource(layer, "Road edges"), ROAD_EDGES, "LineStringZ")) == 0


def test_cancel_is_heard_while_a_large_layer_is_written(qgis_app):
    class Sink(QgsFeatureSink):
        written = 0

        def addFeatures(self, features, flags):
            self.written += len(features)
            feedback.cancel()
            return True

    feedback, sink, many = QgsProcessingFeedback(), Sink(), edges()
    for _ in range(12_000):
        many.add(many.geometries[0], **many.rows[0])
    with pytest.raises(Cancelled):
        write_features(sink, many, qgis_fields(many.schema), feedback)
    assert 0 < sink.written < len(many) / 2


def test_a_table_has_rows_and_no_geometry(tmp_path, qgis_app):
    table = Features("None", CURVE_ELEMENTS)
    table.add(None, road=0, lane=1, radius_m=140.8, turn="left")
    found = read_features(QgisSource(through_a_geopackage(table, tmp_path), "Curve elements"), CURVE_ELEMENTS, "None")
    assert found.rows[0]["radius_m"] == 140.8 and found.geometries == [None]


def edge_layer(kind, fields=ROAD_EDGES, crs="EPSG:32650"):
    """An empty layer with the fields of road edges."""
    kinds = {int: "integer", float: "double", str: "string"}
    columns = "".join(f"&field={column.name}:{kinds[column.type]}" for column in fields)
    return QgsVectorLayer(f"{kind}?crs={crs}{columns}", "edges", "memory")


def test_lines_in_many_parts_become_lines(qgis_app):
    layer = edge_layer("MultiLineStringZ")
    from qgis.core import QgsFeature, QgsGeometry

    feature = QgsFeature(layer.fields())
    feature.setAttribute("road", 2)
    feature.setGeometry(QgsGeometry.fromWkt("MultiLineStringZ((0 0 1, 1 0 1),(2 0 1, 3 0 1))"))
    layer.dataProvider().addFeatures([feature], QgsFeatureSink.Flag.FastInsert)
    found = read_features(QgisSource(layer, "Road edges"), ROAD_EDGES, "LineStringZ")
    assert [g.geom_type for g in found.geometries] == ["LineString", "LineString"] and found.column("road") == [2, 2]


def test_a_line_layer_without_heights_is_refused_by_name(qgis_app):
    layer = edge_layer("LineString")
    from qgis.core import QgsFeature, QgsGeometry

    feature = QgsFeature(layer.fields())
    feature.setGeometry(QgsGeometry.fromWkt("LineString(0 0, 1 0)"))
    layer.dataProvider().addFeatures([feature])
    with pytest.raises(RoadExtractionError, match="Road edges has geometries without heights"):
        read_features(QgisSource(layer, "Road edges"), ROAD_EDGES, "LineStringZ")


def test_a_layer_of_something_else_is_refused_by_its_fields(qgis_app):
    layer = QgsVectorLayer("LineStringZ?crs=EPSG:32650&field=name:string", "rivers", "memory")
    with pytest.raises(RoadExtractionError, match="Road edges lacks the field.*road"):
        read_features(QgisSource(layer, "Road edges"), ROAD_EDGES, "LineStringZ")


def test_a_layer_that_lost_a_field_is_refused_by_its_name(qgis_app):
    layer = edge_layer("LineStringZ", [column for column in ROAD_EDGES if column.name not in ("side", "status")])
    with pytest.raises(RoadExtractionError, match=r"Road edges lacks the field\(s\) side, status\."):
        read_features(QgisSource(layer, "Road edges"), ROAD_EDGES, "LineStringZ")


def test_points_are_no_road_edges(qgis_app):
    with pytest.raises(RoadExtractionError, match="kind Point; Line is needed"):
        read_features(QgisSource(edge_layer("PointZ"), "Road edges"), ROAD_EDGES, "LineStringZ")


def test_a_geopackage_s_undefined_crs_is_no_crs(tmp_path, qgis_app):
    from osgeo import ogr

    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(tmp_path / "bare.gpkg"))
    source.CreateLayer("bare", None, ogr.wkbPoint25D)
    del source
    assert crs_text(QgsVectorLayer(str(tmp_path / "bare.gpkg"), "bare", "ogr").crs()) == ""


def test_a_layer_without_a_crs_is_cartesian_and_never_geographic(tmp_path, provider):
    import processing

    driven = np.c_[np.arange(50.0), 1000.0 + np.arange(50.0), np.full(50, 2000.0), np.full(50, 30.0)]
    np.savetxt(tmp_path / "drive.csv", driven, "%.3f", ",", header="time,x,y,z", comments="")
    path = tmp_path / "drive.gpkg"
    processing.run("lanewright:importtrajectory", {"INPUT": str(tmp_path / "drive.csv"), "OUTPUT": str(path)})
    with closing(sqlite3.connect(path)) as database:
        assert database.execute("SELECT srs_id FROM gpkg_geometry_columns").fetchall() == [(-1,)]
    layer = QgsVectorLayer(str(path), "drive", "ogr")
    assert QgisSource(layer, "Trajectory").crs == "" and not layer.crs().isGeographic()


def test_a_trajectory_in_feet_is_stored_in_feet_and_read_in_metres(tmp_path, provider):
    import processing

    foot = 1200 / 3937
    driven = np.c_[np.arange(50.0), 984_250.0 + np.arange(50.0), np.full(50, 200_000.0), np.full(50, 100.0)]
    np.savetxt(tmp_path / "drive.csv", driven, "%.3f", ",", header="time,x,y,z", comments="")
    path = str(tmp_path / "drive.gpkg")
    processing.run("lanewright:importtrajectory", {"INPUT": str(tmp_path / "drive.csv"), "INPUT_CRS": "EPSG:2263", "OUTPUT": path})
    source = QgisSource(QgsVectorLayer(path, "drive", "ogr"), "Trajectory")
    stored, read = (np.concatenate([vertices_of(wkb)[:, :3] for wkb, _ in rows]) for rows in (source.stored_rows(), source.rows()))
    np.testing.assert_allclose(stored, driven[:, 1:], atol=1e-6)
    np.testing.assert_allclose(read, driven[:, 1:] * foot, atol=1e-6)
    assert source.layer.crs().authid() == "EPSG:2263"
    np.testing.assert_allclose(read_trajectory_source(source).x, driven[:, 1] * foot, atol=1e-6)


@pytest.mark.parametrize("name", ["layer.gpkg", "layer.shp", "layer.csv", "layer.geojson"])
def test_no_format_is_given_aliases_it_would_complain_of(tmp_path, qgis_app, name):
    class Feedback(QgsProcessingFeedback):
        def pushWarning(self, text):
            warnings.append(text)

    warnings, context, feedback = [], QgsProcessingContext(), Feedback()
    context.setFeedback(feedback)  # as the dialogs do
    path = tmp_path / name
    fields = qgis_fields(ROAD_EDGES, with_aliases=keeps_aliases(path))
    sink, _ = QgsProcessingUtils.createFeatureSink(str(path), context, fields, WKB_TYPES["LineStringZ"], UTM)
    assert sink is not None and not [text for text in warnings if "liases" in text or "omments" in text]
    assert not keeps_aliases(None)


def test_a_layer_of_an_earlier_version_may_lack_what_was_not_known_then(qgis_app):
    layer = edge_layer("LineStringZ", [column for column in ROAD_EDGES if column.name not in ("sigma_m", "edge")])
    from qgis.core import QgsFeature, QgsGeometry

    feature = QgsFeature(layer.fields())
    feature.setAttribute("road", 2)
    feature.setGeometry(QgsGeometry.fromWkt("LineStringZ(0 0 1, 10 0 1)"))
    layer.dataProvider().addFeatures([feature])
    (_, row), = read_features(QgisSource(layer, "Road edges"), ROAD_EDGES, "LineStringZ")
    assert row["road"] == 2 and row["sigma_m"] is None and row["edge"] is None
