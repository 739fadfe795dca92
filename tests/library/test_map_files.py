"""Maps of other software through the library: read into layers, whole or not at all."""

import os

import fiona
import made_lanes
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.library import run
from map_files import geometry, lanelet_street, opendrive, road, street_section, written
from osm_files import osm_text


def test_an_opendrive_file_becomes_layers_that_the_assessment_takes(tmp_path):
    file = written(tmp_path, opendrive([road(geometry(0, 0, 0, 0, 40), 40)], offset=(602000, 5792000)))
    names = {name: tmp_path / f"{name.lower()}.gpkg" for name in ("LANES", "DRIVING_LINES", "MARKING_LINES", "ROAD_EDGES")}
    results = run("importopendrive", INPUT=file, **names)
    assert results["LANE_COUNT"] == 2 and results["LENGTH"] == pytest.approx(80)
    with fiona.open(results["LANES"]) as layer:
        assert layer.crs.to_epsg() == 25832 and layer.bounds == pytest.approx((602000, 5791996.5, 602040, 5792003.5))
    assessed = run("assessdrivinglines", INPUT=results["DRIVING_LINES"], REFERENCE=results["DRIVING_LINES"], OUTPUT=tmp_path / "outcome.gpkg")
    assert assessed["RECALL"] == 100


def test_a_lanelet2_file_is_read_in_the_crs_that_was_asked_for(tmp_path):
    results = run("importlanelet2", INPUT=written(tmp_path, lanelet_street(), "map.osm"), CRS="EPSG:25832", LANES=tmp_path / "lanes.gpkg")
    with fiona.open(results["LANES"]) as layer:
        assert len(layer) == 4 and layer.bounds == pytest.approx((602000, 5791996.5, 602040, 5792003.5), abs=1e-3)


@pytest.mark.parametrize("algorithm, given, said", [
    ("importopendrive", {"INPUT": "nowhere.xodr"}, "there is no file nowhere.xodr"),
    ("importlanelet2", {"INPUT": "map.xodr"}, "begins with <OpenDRIVE>"),
    ("importopendrive", {"INPUT": "map.xodr", "CRS": "EPSG:4326"}, "geographic")])
def test_a_refused_map_leaves_nothing(tmp_path, monkeypatch, algorithm, given, said):
    monkeypatch.chdir(tmp_path)
    written(tmp_path, opendrive([road(geometry(0, 0, 0, 0, 40), 40)]))
    with pytest.raises(RoadExtractionError, match=said):
        run(algorithm, **given, LANES="lanes.gpkg")
    assert os.listdir(tmp_path) == ["map.xodr"]


def test_a_good_and_a_faulty_map_are_told_apart(tmp_path):
    good = written(tmp_path, lanelet_street(), "map.osm")
    results = run("checkhdmap", INPUT=good, OUTPUT=tmp_path / "findings.gpkg", REPORT=tmp_path / "report.html")
    assert results["FINDINGS"] == 0 and results["LANES"] == 4 and results["SUCCESSORS"] == 2
    faulty = written(tmp_path, opendrive([road(geometry(0, 0, 0, 0, 40), 45)], offset=(602000, 5792000)))
    results = run("checkhdmap", INPUT=faulty, OUTPUT=tmp_path / "findings.gpkg", REPORT=tmp_path / "report.html")
    with fiona.open(results["OUTPUT"]) as layer:
        assert [row.properties["fault"] for row in layer] == ["road length"] and layer.bounds[:2] == pytest.approx((602040, 5792000))
    assert "road length" in (tmp_path / "report.html").read_text()


def test_the_same_finding_at_many_places_is_one_row_and_every_place_is_in_the_layer(tmp_path):
    kinked = [road(geometry(0, 0, 20 * k, 0, 20) + geometry(20, 20, 20 * k, 0.02 + 0.001 * k, 20), 40, f"A{k}") for k in range(30)]
    faulty = written(tmp_path, opendrive([*kinked, road(geometry(0, 0, -50, 0, 40), 45, "B")]))
    said, progress = [], Progress()
    progress.warn = said.append
    results = run("checkhdmap", progress, INPUT=faulty, OUTPUT=tmp_path / "findings.gpkg", REPORT=tmp_path / "report.html")
    with fiona.open(results["OUTPUT"]) as layer:
        rows = [(found.properties["fault"], found.properties["row"], found.properties["places"]) for found in layer]
    assert sorted(rows) == [("kink", 2, 30)] * 30 + [("road length", 1, 1)]
    assert said == ["road length: 1 (road B). The road says 45.000 m; its geometries are 40.000 m.",
                    "kink: 30 (road A0; road A1; road A2; and 27 more). The direction jumps by 0.049 rad at s = 20.00."]
    report = (tmp_path / "report.html").read_text()
    assert "0.049 rad" in report and "0.048 rad" not in report and "road A19; and 10 more" in report


def test_what_is_no_map_is_refused_by_the_check(tmp_path):
    with pytest.raises(RoadExtractionError, match="neither as OpenDRIVE nor as Lanelet2"):
        run("checkhdmap", INPUT=written(tmp_path, "<gpx/>"), OUTPUT=tmp_path / "findings.gpkg")


def lane_layer(folder, lanes, name="lanes.gpkg"):
    from lanewright.library.layer_files import write_layer

    write_layer(str(folder / name), "", lanes.to_features(), lambda: None)
    return folder / name


def test_lanes_are_written_as_lanelet2_with_a_report(tmp_path):
    results = run("exportlanelet2", LANES=lane_layer(tmp_path, made_lanes.crossing()), OUTPUT=tmp_path / "map.osm", REPORT=tmp_path / "report.html",
                  SPEED_LIMIT=50)
    assert results["LANELETS"] == 20 and results["SUCCESSORS"] == 24 and results["FINDINGS"] == 0
    assert "WGS 84" in (tmp_path / "report.html").read_text() and "<svg" in (tmp_path / "report.html").read_text()
    assert run("checkhdmap", INPUT=results["OUTPUT"], OUTPUT=tmp_path / "findings.gpkg")["FINDINGS"] == 0


def test_an_export_that_is_refused_leaves_the_last_good_map(tmp_path):
    (tmp_path / "map.osm").write_text("the last good map")
    empty = lane_layer(tmp_path, made_lanes.LaneScene().lanes())
    with pytest.raises(RoadExtractionError, match="empty"):
        run("exportlanelet2", LANES=empty, OUTPUT=tmp_path / "map.osm")
    assert (tmp_path / "map.osm").read_text() == "the last good map" and sorted(os.listdir(tmp_path)) == ["lanes.gpkg", "map.osm"]
    with pytest.raises(RoadExtractionError, match=r"written as \.osm only"):
        run("exportlanelet2", LANES=empty, OUTPUT=tmp_path / "map.xodr")


def test_lanes_are_written_as_opendrive_with_a_report_that_says_how_well_they_fit(tmp_path):
    lanes = lane_layer(tmp_path, made_lanes.s_curve(slope=0.02, crown=0.025))
    results = run("exportopendrive", LANES=lanes, OUTPUT=tmp_path / "map.xodr", REPORT=tmp_path / "report.html", VERSION="1.8")
    assert results["ROADS"] == 1 and results["FINDINGS"] == 0 and results["BORDER_MAXIMUM"] < 0.02
    report = (tmp_path / "report.html").read_text()
    assert "spiral" in report and "<svg" in report and 'revMinor="8"' in (tmp_path / "map.xodr").read_text()
    assert run("importopendrive", INPUT=results["OUTPUT"], LANES=tmp_path / "again.gpkg")["LANE_COUNT"] == 2
    with fiona.open(tmp_path / "again.gpkg") as layer:
        assert layer.crs.to_epsg() == 25832


@pytest.mark.parametrize("tolerance", ["0", "-1", "nan", "1e9"])
def test_a_tolerance_that_is_none_is_refused(tmp_path, tolerance):
    with pytest.raises(RoadExtractionError, match="Tolerance"):
        run("exportopendrive", LANES=lane_layer(tmp_path, made_lanes.street()), OUTPUT=tmp_path / "map.xodr", TOLERANCE=tolerance)
    assert not (tmp_path / "map.xodr").exists()


@pytest.mark.parametrize("kind, name", [("dxf", "map.dxf"), ("landxml", "map.xml")])
def test_lanes_are_written_for_cad(tmp_path, kind, name):
    pytest.importorskip("osgeo.gdal")
    results = run("exportcad", LANES=lane_layer(tmp_path, made_lanes.street()), FORMAT=kind, OUTPUT=tmp_path / name, REPORT=tmp_path / "report.html")
    assert results["LINES"] == 3 and (tmp_path / name).stat().st_size > 1000


def test_a_name_that_belongs_to_another_format_is_refused(tmp_path):
    with pytest.raises(RoadExtractionError, match="FORMAT is landxml"):
        run("exportcad", LANES=lane_layer(tmp_path, made_lanes.street()), FORMAT="landxml", OUTPUT=tmp_path / "map.dxf")


def spoilt_layer(folder, what):
    """A layer of lanes that is none, and other layers."""
    from lanewright.core.common.features import LANES, ROAD_EDGES, Features
    from lanewright.library.layer_files import write_layer

    lanes = made_lanes.street().to_features()
    others = {}
    if what == "no field":
        lanes = Features("PolygonZ", tuple(field for field in LANES if field.name != "successors"), lanes.geometries, lanes.rows, lanes.crs)
    if what == "degrees":
        lanes = Features("PolygonZ", LANES, lanes.geometries, lanes.rows, "EPSG:4326")
    if what == "one line":
        lanes.geometries[0] = shapely.Polygon(shapely.get_coordinates(lanes.geometries[0], include_z=True)[[0, 1, 2]])
    if what == "another survey":
        edges = Features("LineStringZ", ROAD_EDGES, crs=lanes.crs)
        edges.add(shapely.linestrings([[400000, 5500000, 0], [400010, 5500000, 0]]), road=1, height_m=0.12)
        write_layer(str(folder / "edges.gpkg"), "", edges, lambda: None)
        others["ROAD_EDGES"] = folder / "edges.gpkg"
    write_layer(str(folder / "lanes.gpkg"), "", lanes, lambda: None)
    if what == "no heights":
        with fiona.open(folder / "lanes.gpkg") as layer:
            flat = [(shapely.geometry.mapping(shapely.force_2d(shapely.geometry.shape(one["geometry"]))), dict(one["properties"])) for one in layer]
            schema, crs = {**layer.schema, "geometry": "Polygon"}, layer.crs_wkt
        os.remove(folder / "lanes.gpkg")
        with fiona.open(folder / "lanes.gpkg", "w", driver="GPKG", schema=schema, crs_wkt=crs) as layer:
            layer.writerecords([{"type": "Feature", "geometry": shape, "properties": row} for shape, row in flat])
    return {"LANES": folder / "lanes.gpkg", **others}


@pytest.mark.parametrize("algorithm, name", [("exportopendrive", "map.xodr"), ("exportlanelet2", "map.osm"), ("exportcad", "map.dxf")])
@pytest.mark.parametrize("what, said", [("no heights", "height|Z"), ("no field", "successors"), ("degrees", "degrees|geographic|metres"),
                                        ("one line", "vertices"), ("another survey", "do not lie where the lanes are")])
def test_what_cannot_be_exported_is_refused_in_one_sentence_and_nothing_is_written(tmp_path, algorithm, name, what, said):
    layers = spoilt_layer(tmp_path, what)
    there = sorted(os.listdir(tmp_path))
    with pytest.raises(RoadExtractionError, match=said) as refused:
        run(algorithm, OUTPUT=tmp_path / name, REPORT=tmp_path / "report.html", **layers)
    assert sorted(os.listdir(tmp_path)) == there and "\n" not in str(refused.value)


@pytest.mark.parametrize("algorithm", ["checkhdmap", "importopendrive"])
def test_a_road_as_long_as_the_earth_is_wide_costs_no_memory(tmp_path, algorithm):
    path = tmp_path / "map.xodr"
    path.write_text(opendrive([road(geometry(0, 0, 0, 0, 9e8), 9e8, "1", lanes=street_section(0))]))
    with pytest.raises(RoadExtractionError, match="longer than 200 km"):
        run(algorithm, INPUT=path, **{"OUTPUT" if algorithm == "checkhdmap" else "LANES": tmp_path / "layer.gpkg"})
    many = [road(geometry(0, 0, 10 * k, 0, 150e3), 150e3, str(k), lanes=street_section(0)) for k in range(1, 9)]
    path.write_text(opendrive(many))
    with pytest.raises(RoadExtractionError, match="1,200 km long; at most 1,000 km"):
        run(algorithm, INPUT=path, **{"OUTPUT" if algorithm == "checkhdmap" else "LANES": tmp_path / "layer.gpkg"})
    assert sorted(os.listdir(tmp_path)) == ["map.xodr"]


def lit_street(folder):
    """A street with a traffic light and a speed limit."""
    text = road(geometry(0, 0, 0, 0, 40), 40).replace("<planView>", '<type s="0" type="town"><speed max="50" unit="km/h"/></type><planView>')
    signal = '<signal id="1" s="38" t="-5" zOffset="2" orientation="+" dynamic="yes" type="1000001" subtype="-1" name="A" height="1" width="0.4"/>'
    return written(folder, opendrive([text.replace("</road>", f"<signals>{signal}</signals></road>")], offset=(602000, 5792000)))


def test_a_map_is_converted_there_and_back_with_its_light_and_speed_limit(tmp_path):
    there = run("converthdmap", INPUT=lit_street(tmp_path), OUTPUT=tmp_path / "there.osm", REPORT=tmp_path / "report.html")
    assert there["SIGNAL_COUNT"] == 1 and there["FINDINGS"] == 0 and "map.xodr" in (tmp_path / "report.html").read_text()
    back = run("converthdmap", INPUT=there["OUTPUT"], OUTPUT=tmp_path / "back.xodr", CRS="EPSG:25832")
    assert back["SIGNAL_COUNT"] == 1 and back["FINDINGS"] == 0
    results = run("importopendrive", INPUT=back["OUTPUT"], LANES=tmp_path / "lanes.gpkg", SIGNALS=tmp_path / "signals.gpkg")
    with fiona.open(results["LANES"]) as layer:
        assert len(layer) == 2 and layer.bounds == pytest.approx((602000, 5791996.5, 602040, 5792003.5), abs=0.02)
        assert {row.properties["speed_kmh"] for row in layer} == {50.0}
    with fiona.open(results["SIGNALS"]) as layer:
        assert [(row.properties["kind"], row.properties["text"]) for row in layer] == [("traffic_light", "A")]
    again = run("exportlanelet2", LANES=results["LANES"], SIGNALS=results["SIGNALS"], OUTPUT=tmp_path / "again.osm")
    text = (tmp_path / "again.osm").read_text()
    assert again["FINDINGS"] == 0 and 'v="50"' in text and "regulatory_element" in text


@pytest.mark.parametrize("text, output, said", [
    (lanelet_street(), "out.osm", "is Lanelet2 already"), (opendrive([road(geometry(0, 0, 0, 0, 40), 40)]), "out.xodr", "is OpenDRIVE already"),
    (opendrive([]), "out.osm", "no road that can be read"), (opendrive([road(geometry(0, 0, 0, 0, 40), 40)])[:-40], "out.osm", "not well-formed"),
    ("<osm></osm>", "out.xodr", "no relation of type lanelet"), ("<gpx/>", "out.osm", "neither as OpenDRIVE nor as Lanelet2"),
    (lanelet_street(), "out.txt", "written as")])
def test_what_cannot_be_converted_is_refused_in_one_sentence_and_leaves_nothing(tmp_path, text, output, said):
    with pytest.raises(RoadExtractionError, match=said):
        run("converthdmap", INPUT=written(tmp_path, text, "map.any"), OUTPUT=tmp_path / output)
    assert os.listdir(tmp_path) == ["map.any"]


def test_lanes_get_names_and_limits_of_a_file_or_layer_and_hand_them_to_the_exports(tmp_path):
    lanes = lane_layer(tmp_path, made_lanes.street())
    places = [tuple(place) for place in made_lanes.street().borders(0)[0][[0, -1], :2].tolist()]
    file = written(tmp_path, osm_text((places, {"name": "Long Street", "maxspeed": "30"})), "streets.osm")
    results = run("roadattributes", LANES=lanes, OSM_FILE=file, OUTPUT=tmp_path / "known.gpkg")
    assert results["KNOWN"] == results["SPEEDS"] == results["NAMES"] == results["LANE_COUNT"] == 2
    run("exportlanelet2", LANES=results["OUTPUT"], OUTPUT=tmp_path / "map.osm", SPEED_LIMIT=50)
    text = (tmp_path / "map.osm").read_text()
    assert text.count('k="speed_limit" v="30"') == 2 and 'v="50"' not in text and 'k="road_name" v="Long Street"' in text
    run("exportopendrive", LANES=results["OUTPUT"], OUTPUT=tmp_path / "map.xodr")
    text = (tmp_path / "map.xodr").read_text()
    assert 'name="Long Street"' in text and '<speed max="30" unit="km/h"/>' in text
    schema = {"geometry": "LineString", "properties": {"name": "str", "maxspeed": "str"}}
    with fiona.open(tmp_path / "ways.gpkg", "w", driver="GPKG", schema=schema, crs="EPSG:25832") as layer:
        layer.write({"geometry": {"type": "LineString", "coordinates": places}, "properties": {"name": "Other Street", "maxspeed": None}})
    results = run("roadattributes", LANES=results["OUTPUT"], WAYS=tmp_path / "ways.gpkg", OUTPUT=tmp_path / "again.gpkg")
    with fiona.open(results["OUTPUT"]) as layer:
        assert {(row.properties["name"], row.properties["speed_kmh"]) for row in layer} == {("Other Street", 30.0)}


@pytest.mark.parametrize("given, said", [
    ({}, "Give either"), ({"OSM_FILE": "nowhere.osm"}, "there is no file"), ({"WAYS": "lanes.gpkg"}, "layer of lines")])
def test_attributes_need_one_source_of_roads(tmp_path, monkeypatch, given, said):
    monkeypatch.chdir(tmp_path)
    lane_layer(tmp_path, made_lanes.street())
    with pytest.raises(RoadExtractionError, match=said):
        run("roadattributes", LANES="lanes.gpkg", **given, OUTPUT="known.gpkg")
    assert os.listdir(tmp_path) == ["lanes.gpkg"]
