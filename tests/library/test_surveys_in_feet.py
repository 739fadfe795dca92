"""A street surveyed in feet gives the map that the same street gives in metres, in its own CRS, through every door of files."""

import re
from pathlib import Path

import fiona
import laspy
import numpy as np
import pytest
import shapely
from lanewright.core.io.crs import MARK, in_metres
from lanewright.library import run
from pyproj import CRS
from shapely.geometry import shape

FEET, METRES = "EPSG:2263+6360", "EPSG:32118"      # one projection; its zone holds the place below
PLACE = 301_000.0, 61_000.0                        # m
LAYERS = ("ROAD_EDGES", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "LANES", "ROAD_SURFACE", "CURVE_ELEMENTS")


@pytest.fixture(scope="module")
def surveys(made_once):
    """{"feet", "metres": (cloud, trajectory)} of one street with a bend."""
    street = made_once("street_with_a_bend", lambda folder: run(
        "samplesurvey", LENGTH=70, PULSE_RATE=45_000, POINT_CLOUD=folder / "s.laz", TRAJECTORY=folder / "drive.gpkg"))
    folder = made_once("survey_in_feet", lambda folder: _write(street, folder))
    return {name: (str(folder / f"{name}.laz"), str(folder / f"{name}.csv")) for name in ("feet", "metres")}


def _write(street, folder):
    cloud = laspy.read(street / "s.laz")
    with fiona.open(street / "drive.gpkg") as layer:
        driven = np.array([[row["properties"]["time"], *row["geometry"]["coordinates"]] for row in layer])
    shift = np.array([*(np.array(PLACE) - np.floor(cloud.header.mins[:2])), 0.0])
    for name, crs in (("feet", FEET), ("metres", METRES)):
        units = in_metres(CRS(crs).to_wkt())[1]
        header = laspy.LasHeader(point_format=6, version="1.4")
        header.scales, header.offsets = np.full(3, 1e-4), np.floor(units.in_file([*PLACE, 0.0]))
        header.global_encoding.gps_time_type = cloud.header.global_encoding.gps_time_type
        header.add_crs(CRS(crs))
        made = laspy.LasData(header)
        made.x, made.y, made.z = units.in_file(np.array(cloud.xyz) + shift).T
        for field in ("intensity", "gps_time", "point_source_id", "return_number", "number_of_returns"):
            made[field] = cloud[field]
        made.write(str(folder / f"{name}.laz"))
        table = np.c_[driven[:, 0], units.in_file(driven[:, 1:] + shift)]
        np.savetxt(folder / f"{name}.csv", table, "%.9f", ",", header="time,x,y,z", comments="")


@pytest.fixture(scope="module")
def maps(surveys, made_once):
    """{"feet", "metres": {output: path}} of both."""
    pytest.importorskip("osgeo.gdal")

    def outputs(folder, name):
        return {"ROAD_POINTS": str(folder / f"{name}_road.laz"), "INTENSITY_IMAGE": str(folder / f"{name}.tif"),
                **{layer: str(folder / f"{name}_{layer.lower()}.gpkg") for layer in LAYERS}}

    def make(folder):
        for name, (cloud, driven) in surveys.items():
            run("roadmap", POINT_CLOUDS=[cloud], TRAJECTORY=driven, BOUNDARY_METHOD="profiles", **outputs(folder, name))

    folder = made_once("maps_in_feet", make)
    return {name: outputs(folder, name) for name in surveys}


def rows(path):
    """[(coordinates in metres or None, fields)] and the WKT of a layer."""
    with fiona.open(path) as layer:
        units = in_metres(layer.crs_wkt)[1]
        return [(None if row["geometry"] is None else units.in_metres(shapely.get_coordinates(shape(row["geometry"]), include_z=True)),
                 dict(row["properties"])) for row in layer], layer.crs_wkt


def assert_same_layers(feet, metres):
    (found, wkt), (expected, _) = rows(feet), rows(metres)
    assert len(found) == len(expected) > 0
    apart = []
    for (places, fields), (there, other) in zip(found, expected):
        if places is not None:
            assert CRS(wkt).equals(CRS(FEET)) and "foot" in wkt
            apart.append(np.abs(places - there))
        for name, value in fields.items():
            if name == "radius_m" and value is not None:   # of a line that is nearly straight its curvature is sure, not its radius
                assert 1 / value == pytest.approx(1 / other[name], abs=1e-6, rel=1e-3), name
            elif name != "params" and isinstance(value, float):
                in_feet = 1200 / 3937 if re.fullmatch(r"p[cti]_[xy]", name) else 1.0
                assert value * in_feet == pytest.approx(other[name], abs=3e-3, rel=1e-3), name
    if apart:
        # coordinates are rounded to 0.1 mm, which puts a point of this thin cloud into the next cell here and there
        assert np.mean(np.concatenate(apart) < 1e-3) > 0.9 and np.concatenate(apart).max() < 0.01, feet


@pytest.mark.parametrize("layer", LAYERS)
def test_every_layer_of_the_map_is_that_in_metres(maps, layer):
    assert_same_layers(maps["feet"][layer], maps["metres"][layer])


def test_road_points_and_image_lie_where_those_in_metres_lie(maps):
    from osgeo import gdal

    feet, metres = (laspy.read(maps[name]["ROAD_POINTS"]) for name in ("feet", "metres"))
    assert feet.header.parse_crs() == CRS(FEET)
    units = in_metres(CRS(FEET).to_wkt())[1]
    np.testing.assert_allclose(units.in_metres(feet.header.mins), metres.header.mins, atol=2e-3)
    images = [gdal.Open(maps[name]["INTENSITY_IMAGE"]) for name in ("feet", "metres")]
    assert CRS(images[0].GetProjection()).equals(CRS(FEET), ignore_axis_order=True) and images[0].RasterXSize == images[1].RasterXSize
    np.testing.assert_allclose(units.geotransform(images[0].GetGeoTransform()), images[1].GetGeoTransform(), atol=1e-6)


def test_later_stages_go_on_from_what_earlier_ones_wrote(surveys, maps, tmp_path):
    found = {}
    for name, (_, driven) in surveys.items():
        made = maps[name]
        found[name] = run("drivinglines", MARKING_LINES=made["MARKING_LINES"], ROAD_EDGES=made["ROAD_EDGES"], ROAD_POINTS=made["ROAD_POINTS"],
                          TRAJECTORY=driven, DRIVING_LINES=tmp_path / f"{name}.gpkg")
        run("intensityimage", ROAD_POINTS=made["ROAD_POINTS"], INTENSITY_IMAGE=tmp_path / f"{name}.tif")
        found[name].update(run("extractmarkings", ROAD_POINTS=made["ROAD_POINTS"], INTENSITY_IMAGE=tmp_path / f"{name}.tif", TRAJECTORY=driven,
                               MARKING_POINTS=tmp_path / f"{name}_paint.laz"))
    assert_same_layers(found["feet"]["DRIVING_LINES"], found["metres"]["DRIVING_LINES"])
    counts = [laspy.open(found[name]["MARKING_POINTS"]).header.point_count for name in ("feet", "metres")]
    assert counts[0] == pytest.approx(counts[1], rel=0.01)


@pytest.mark.parametrize("reference", ["feet", "metres"])
def test_a_map_in_feet_is_judged_in_metres_by_a_reference_in_either(maps, tmp_path, reference):
    found = run("assessboundaries", INPUT=maps["feet"]["ROAD_EDGES"], REFERENCE=maps[reference]["ROAD_EDGES"], OUTPUT=tmp_path / "judged.gpkg")
    assert found["RECALL"] == found["PRECISION"] == 100
    found = run("assessmarkings", INPUT=maps["feet"]["MARKINGS"], REFERENCE=maps[reference]["MARKINGS"], IMAGE=maps["feet"]["INTENSITY_IMAGE"],
                OUTPUT=tmp_path / "outcome.gpkg", CELLS=tmp_path / "cells.tif")
    assert found["IOU"] > 99


def test_open_drive_and_lanelets_are_in_metres_and_degrees(maps, tmp_path):
    texts = {}
    for name in ("feet", "metres"):
        run("exportopendrive", LANES=maps[name]["LANES"], OUTPUT=tmp_path / f"{name}.xodr")
        run("exportlanelet2", LANES=maps[name]["LANES"], OUTPUT=tmp_path / f"{name}.osm")
        texts[name] = (tmp_path / f"{name}.xodr").read_text()
    assert "+units=m" in texts["feet"] and "foot" not in texts["feet"] and "us-ft" not in texts["feet"]
    lengths = [[float(value) for value in re.findall(r'<road [^>]*length="([\d.]+)"', texts[name])] for name in ("feet", "metres")]
    assert lengths[0] == pytest.approx(lengths[1], abs=1e-3)
    places = [np.array(re.findall(r'lat="([\d.]+)" lon="(-[\d.]+)"', (tmp_path / f"{name}.osm").read_text()), float) for name in maps]
    np.testing.assert_allclose(*places, atol=1e-8)
    run("importopendrive", INPUT=tmp_path / "feet.xodr", CRS="EPSG:2263", LANES=tmp_path / "lanes.gpkg")
    with fiona.open(tmp_path / "lanes.gpkg") as back, fiona.open(maps["feet"]["LANES"]) as lanes:
        assert back.crs.to_epsg() == 2263 and back.bounds == pytest.approx(lanes.bounds, abs=0.5)


def test_cad_files_have_the_feet_of_the_layers(maps, tmp_path):
    for kind, suffix in (("landxml", "xml"), ("dxf", "dxf")):
        for name in ("feet", "metres"):
            run("exportcad", LANES=maps[name]["LANES"], DRIVING_LINES=maps[name]["DRIVING_LINES"], FORMAT=kind, OUTPUT=tmp_path / f"{name}.{suffix}")
    texts = {name: (tmp_path / f"{name}.xml").read_text() for name in ("feet", "metres")}
    assert 'linearUnit="USSurveyFoot"' in texts["feet"] and 'linearUnit="meter"' in texts["metres"]
    for pattern in (r'<Alignment [^>]*length="([\d.]+)"', r"<Start>([\d.]+) ", r"<Start>[\d.]+ ([\d.]+)<", r"<PVI>[\d.]+ ([\d.]+)<"):
        feet, metres = (np.array(re.findall(pattern, texts[name]), float) for name in ("feet", "metres"))
        np.testing.assert_allclose([feet.min() * 1200 / 3937, feet.max() * 1200 / 3937], [metres.min(), metres.max()], atol=2e-3)
    drawn = {}
    for name in ("feet", "metres"):
        with fiona.open(tmp_path / f"{name}.dxf") as layer:
            drawn[name] = np.array(layer.bounds)
    np.testing.assert_allclose(drawn["feet"] * 1200 / 3937, drawn["metres"], atol=2e-3)


def test_no_file_tells_of_the_metres_that_were_worked_in(maps):
    for path in map(Path, maps["feet"].values()):
        assert MARK.encode() not in path.read_bytes(), path.name


def test_clouds_that_are_given_back_stay_in_feet_and_have_the_classes_of_metres(surveys, maps, tmp_path):
    for name, (cloud, driven) in surveys.items():
        run("classifycloud", POINT_CLOUDS=[cloud], TRAJECTORY=driven, OUTPUT=tmp_path,
            **{layer: maps[name][layer] for layer in ("ROAD_SURFACE", "ROAD_EDGES", "MARKINGS")})
    feet, metres = (laspy.read(tmp_path / f"{name}.laz") for name in ("feet", "metres"))
    before = laspy.read(surveys["feet"][0])
    np.testing.assert_array_equal(before.xyz, feet.xyz)
    assert (before.header.scales == feet.header.scales).all() and feet.header.parse_crs() == before.header.parse_crs()
    assert (feet.classification == metres.classification).mean() > 0.999 and (feet.classification == 64).sum() > 1000
    inside = np.asarray(metres.road) == 0
    np.testing.assert_allclose(np.asarray(feet.station)[inside], np.asarray(metres.station)[inside], atol=0.0021)
