"""Maps of other programs are converted, and lanes get the attributes of ways, by QGIS itself."""

import made_lanes
import processing
import pytest
from lanewright.library.layer_files import write_layer
from lanewright.products.export.sources import RoadMapSource
from map_files import geometry, opendrive, road, written
from osm_files import osm_text
from qgis.core import QgsFeature, QgsGeometry, QgsPointXY, QgsProcessingException, QgsVectorLayer

SIGNAL = '<signals><signal id="1" s="38" t="-5" zOffset="2" orientation="+" dynamic="yes" type="1000001" subtype="-1" height="1"/></signals>'


def test_a_map_with_a_light_is_converted_there_and_back_and_read_into_layers(provider, tmp_path):
    text = road(geometry(0, 0, 0, 0, 40), 40).replace("</road>", f"{SIGNAL}</road>")
    there = processing.run("lanewright:converthdmap", {
        "INPUT": written(tmp_path, opendrive([text], offset=(602000, 5792000))), "OUTPUT": str(tmp_path / "there.osm")})
    back = processing.run("lanewright:converthdmap", {"INPUT": there["OUTPUT"], "CRS": "EPSG:25832", "OUTPUT": str(tmp_path / "back.xodr")})
    assert there["SIGNAL_COUNT"] == back["SIGNAL_COUNT"] == 1 and there["FINDINGS"] == back["FINDINGS"] == 0
    layers = processing.run("lanewright:importopendrive", {"INPUT": back["OUTPUT"], "SIGNALS": str(tmp_path / "signals.gpkg")})
    signal, = QgsVectorLayer(layers["SIGNALS"]).getFeatures()
    place = signal.geometry().constGet()
    assert (place.x(), place.y(), place.z()) == pytest.approx((602038, 5791995, 2), abs=0.01) and signal["kind"] == "traffic_light"
    with pytest.raises(QgsProcessingException, match="is Lanelet2 already"):
        processing.run("lanewright:converthdmap", {"INPUT": there["OUTPUT"], "OUTPUT": str(tmp_path / "again.osm")})
    assert not (tmp_path / "again.osm").exists()


def test_who_goes_first_at_a_junction_is_a_field_of_the_lanes_and_stands_in_both_exports(provider, tmp_path):
    lanes = made_lanes.crossing()
    low, high, *_ = (str(name) for name, kind in zip(lanes.lane_id, lanes.type) if kind == "connector")
    areas = RoadMapSource(lanes, attributes={low: {"yields_to": high}}).lane_areas()
    write_layer(str(tmp_path / "lanes.gpkg"), "", areas, lambda: None)
    for algorithm, ending, said in (("exportopendrive", "xodr", "<priority high="), ("exportlanelet2", "osm", 'v="right_of_way"')):
        made = processing.run(f"lanewright:{algorithm}", {"LANES": str(tmp_path / "lanes.gpkg"), "OUTPUT": str(tmp_path / f"map.{ending}")})
        assert (tmp_path / f"map.{ending}").read_text(encoding="utf-8").count(said) == 1 and made["FINDINGS"] == 0
    for algorithm, ending in (("importopendrive", "xodr"), ("importlanelet2", "osm")):
        read = processing.run(f"lanewright:{algorithm}", {"INPUT": str(tmp_path / f"map.{ending}"), "LANES": str(tmp_path / f"{ending}.gpkg")})
        assert sum(bool(row["yields_to"]) for row in QgsVectorLayer(read["LANES"]).getFeatures()) == 1


@pytest.mark.parametrize("given", ["OSM_FILE", "WAYS"])
def test_lanes_get_the_name_of_their_way_from_a_file_and_from_a_layer(provider, tmp_path, given):
    street = made_lanes.street()
    write_layer(str(tmp_path / "lanes.gpkg"), "", street.to_features(), lambda: None)
    places = street.borders(0)[0][[0, -1], :2].tolist()
    file = written(tmp_path, osm_text((places, {"name": "Long Street", "maxspeed": "30"})), "streets.osm")
    ways = QgsVectorLayer("LineString?crs=EPSG:25832&field=name:string&field=maxspeed:string", "ways", "memory")
    feature = QgsFeature(ways.fields())
    feature.setAttributes(["Long Street", "30"])
    feature.setGeometry(QgsGeometry.fromPolylineXY([QgsPointXY(*place) for place in places]))
    ways.dataProvider().addFeatures([feature])
    results = processing.run("lanewright:roadattributes", {
        "LANES": str(tmp_path / "lanes.gpkg"), given: {"OSM_FILE": file, "WAYS": ways}[given], "OUTPUT": str(tmp_path / "known.gpkg")})
    rows = [(row["name"], row["speed_kmh"], row["ref"]) for row in QgsVectorLayer(results["OUTPUT"]).getFeatures()]
    assert rows and {row[:2] for row in rows} == {("Long Street", 30.0)} and results["KNOWN"] == len(rows)
