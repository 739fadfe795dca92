"""One drive is one trajectory, whatever it comes as."""

import numpy as np
import pytest
from lanewright.algorithms.survey_input import read_trajectory_source, trajectory_features, trajectory_path
from lanewright.core.common.errors import RoadExtractionError
from lanewright.processing_provider.call import QgisSource
from qgis.core import QgsFeature, QgsGeometry, QgsVectorLayer

TIME = 1000.0 + 0.1 * np.arange(60)
X = 610400.0 + 1.2 * np.arange(60)
Y = 2710200.0 + 0.3 * np.arange(60)
Z = 24.0 + 0.01 * np.arange(60)


def layer_of(uri, features):
    layer = QgsVectorLayer(uri, "drive", "memory")
    rows = []
    for wkt, attributes in features:
        feature = QgsFeature(layer.fields())
        if wkt:
            feature.setGeometry(QgsGeometry.fromWkt(wkt))
        feature.setAttributes(attributes)
        rows.append(feature)
    layer.dataProvider().addFeatures(rows)
    return layer


def points_with_heights():
    rows = [(f"PointZ({x} {y} {z})", [t, 0.5]) for t, x, y, z in zip(TIME, X, Y, Z)]
    return layer_of("PointZ?crs=EPSG:32650&field=GPS_Time:double&field=roll_deg:double", rows)


def points_with_a_column_of_heights():
    rows = [(f"Point({x} {y})", [z, t]) for t, x, y, z in zip(TIME, X, Y, Z)]
    return layer_of("Point?crs=EPSG:32650&field=z:double&field=time:double", rows)


def a_line_with_time_as_its_measure():
    line = ", ".join(f"{x} {y} {z} {t}" for t, x, y, z in zip(TIME, X, Y, Z))
    return layer_of("LineStringZM?crs=EPSG:32650", [(f"LineStringZM({line})", [])])


def a_table_of_texts():
    """As QGIS opens a CSV file: every column may be text."""
    rows = [(None, [str(v) for v in (t, x, y, z)]) for t, x, y, z in zip(TIME, X, Y, Z)]
    return layer_of("NoGeometry?field=time:string&field=Easting:string&field=Northing:string&field=height:string", rows)


@pytest.mark.parametrize("drive", [
    points_with_heights, points_with_a_column_of_heights, a_line_with_time_as_its_measure, a_table_of_texts,
])
def test_one_drive_reads_the_same_from_every_kind_of_layer(qgis_app, drive):
    trajectory = read_trajectory_source(QgisSource(drive(), "Trajectory"))
    assert trajectory.has_time
    np.testing.assert_allclose(np.c_[trajectory.time, trajectory.x, trajectory.y, trajectory.z], np.c_[TIME, X, Y, Z], atol=1e-6)


def test_a_line_without_measure_has_no_time_but_an_order(qgis_app):
    line = ", ".join(f"{x} {y} {z}" for x, y, z in zip(X, Y, Z))
    trajectory = read_trajectory_source(QgisSource(layer_of("LineStringZ?crs=EPSG:32650", [(f"LineStringZ({line})", [])]), "Trajectory"))
    assert not trajectory.has_time and (np.diff(trajectory.time) > 0).all()


def test_points_without_heights_are_refused(qgis_app):
    layer = layer_of("Point?crs=EPSG:32650&field=time:double", [(f"Point({x} {y})", [t]) for t, x, y in zip(TIME, X, Y)])
    with pytest.raises(RoadExtractionError, match="no heights"):
        read_trajectory_source(QgisSource(layer, "Trajectory"))


def test_a_table_of_something_else_is_refused_by_its_columns(qgis_app):
    layer = layer_of("NoGeometry?field=name:string&field=owner:string", [(None, ["A", "B"])])
    with pytest.raises(RoadExtractionError, match="name, owner"):
        read_trajectory_source(QgisSource(layer, "Trajectory"))


def test_a_layer_without_rows_is_refused(qgis_app):
    with pytest.raises(RoadExtractionError, match="has no rows"):
        read_trajectory_source(QgisSource(layer_of("PointZ?crs=EPSG:32650&field=time:double", []), "Trajectory"))


def test_a_written_trajectory_carries_road_pass_and_station(qgis_app):
    features = trajectory_features(read_trajectory_source(QgisSource(points_with_heights(), "Trajectory")))
    stations = np.array(features.column("station_m"))
    assert set(features.column("road")) == {0} and set(features.column("pass")) == {0}
    np.testing.assert_allclose(np.diff(stations), np.hypot(1.2, 0.3), atol=1e-3)
    np.testing.assert_allclose(features.column("time"), TIME)


@pytest.mark.parametrize("value, is_file", [
    ("drive.csv", True), ("drive.TXT", True), ("mission.out", True), ("drive.gpkg", False), ("layer_id_1", False), (None, False),
])
def test_which_values_are_files_for_our_own_reader(value, is_file):
    assert (trajectory_path(value) is not None) == is_file


@pytest.mark.parametrize(("field", "values", "seconds"), [
    ("gps_seconds[s]:string", [f"{t:.3f}" for t in TIME], TIME),
    ("gps_time_ms:double", TIME * 1000, TIME),
    ("utc:datetime", [f"2021-10-13T23:46:{40 + k // 10:02d}.{k % 10}00Z" for k in range(60)], 1_318_204_018.0 + 0.1 * np.arange(60)),
])
def test_a_layer_knows_the_names_units_and_clocks_that_a_file_knows(qgis_app, field, values, seconds):
    from qgis.PyQt.QtCore import QDateTime, Qt

    stored = [QDateTime.fromString(v, Qt.DateFormat.ISODateWithMs) if field.endswith("datetime") else v for v in values]
    layer = layer_of(f"Point?crs=EPSG:32650&field={field}&field=Ellipsoidal height:double",
                     [(f"Point({x} {y})", [v, z]) for v, x, y, z in zip(stored, X, Y, Z)])
    trajectory = read_trajectory_source(QgisSource(layer, "Trajectory"))
    np.testing.assert_allclose(np.c_[trajectory.time, trajectory.z], np.c_[seconds, Z], atol=1e-3)


def test_a_layer_with_clock_times_of_nobody_knows_what_is_refused_as_a_file_is(qgis_app):
    layer = layer_of("PointZ?crs=EPSG:32650&field=Time:string", [
        (f"PointZ({x} {y} 3)", [f"13/10/2021 23:46:{k:02d}"]) for k, (x, y) in enumerate(zip(X, Y))])
    with pytest.raises(RoadExtractionError, match="GPS seconds are needed"):
        read_trajectory_source(QgisSource(layer, "Trajectory"))


@pytest.mark.parametrize("door", ["file", "QGIS layer", "layer without QGIS"])
def test_a_gpx_track_is_read_by_every_door(qgis_app, tmp_path, door):
    from lanewright.core.survey.trajectory.reader import read_trajectory
    from lanewright.library.layer_files import LayerFile

    path = tmp_path / "drive.gpx"
    points = "".join(
        f'<trkpt lat="{24.5 + 1e-5 * k}" lon="118.09"><ele>{20 + k}</ele><time>2021-10-13T23:46:{22 + k // 4}.{k % 4 * 25:02d}0Z</time></trkpt>'
        for k in range(40))
    path.write_text(f'<gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg>{points}</trkseg></trk></gpx>')
    layer = f"{path}|layername=track_points"
    trajectory = read_trajectory(path) if door == "file" else read_trajectory_source(
        QgisSource(QgsVectorLayer(layer), "Trajectory") if door == "QGIS layer" else LayerFile(layer, "Trajectory"))
    np.testing.assert_allclose(trajectory.time, 1_318_204_000.0 + 0.25 * np.arange(40), atol=0.01)
    np.testing.assert_allclose(trajectory.z, 20.0 + np.arange(40))
