"""Corrections of an analyst, given to Processing as a layer of the project."""

import pytest
from qgis.core import QgsFeature, QgsGeometry, QgsProcessingFeedback, QgsVectorLayer

pytestmark = pytest.mark.slow


def test_corrections_in_degrees_hold_in_a_road_map_and_their_lines_say_what_they_are(street, street_map, tmp_path):
    import processing

    given = {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"]}
    edges = QgsVectorLayer(street_map["ROAD_EDGES"])
    longest = max(edges.getFeatures(), key=lambda feature: feature["length_m"])
    degrees = processing.run("native:reprojectlayer", {"INPUT": edges, "TARGET_CRS": "EPSG:4326", "OUTPUT": "memory:"})["OUTPUT"]
    layer = QgsVectorLayer("LineString?crs=EPSG:4326&field=action:string&field=target:string&field=note:string", "corrections", "memory")
    correction = QgsFeature(layer.fields())
    correction.setGeometry(QgsGeometry(next(feature for feature in degrees.getFeatures() if feature["chain"] == longest["chain"]
                                            and feature["station_m"] == longest["station_m"]).geometry()))
    correction.setAttributes(["accept", "edge", ""])
    assert layer.dataProvider().addFeatures([correction])[0]
    heard = QgsProcessingFeedback(False)
    results = processing.run("lanewright:roadmap", {**given, "CORRECTIONS": layer, "ROAD_EDGES": str(tmp_path / "corrected.gpkg")}, feedback=heard)
    corrected = QgsVectorLayer(results["ROAD_EDGES"])
    accepted = [feature for feature in corrected.getFeatures() if feature["status"] == "accepted"]
    assert [feature["length_m"] for feature in accepted] == pytest.approx([longest["length_m"]], abs=0.01)
    assert results["CORRECTIONS_MADE"] == 1 and "match nothing" not in heard.textLog()
