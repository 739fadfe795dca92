"""What stands beside the road, in the clouds that are given back."""

import fiona
import laspy
import numpy as np
import pytest
import shapely
from lanewright.library import run
from shapely.geometry import shape


@pytest.fixture(scope="module")
def beside(street, made_once):
    """(cloud with classes, layer that named what stands there) of guard rails that are true, and of the poles and trunks that Roadside finds."""

    def make(folder):
        motorway = {"POINT_CLOUD": folder / "motorway.laz", "TRAJECTORY": folder / "motorway.gpkg", "TRUTH_ROADSIDE": folder / "rails.gpkg"}
        run("samplesurvey", SCENE="motorway", LENGTH=60, PULSE_RATE=60_000, ROTATION_RATE=100, **motorway)
        run("classifycloud", POINT_CLOUDS=[motorway["POINT_CLOUD"]], TRAJECTORY=motorway["TRAJECTORY"], ROADSIDE=folder / "rails.gpkg",
            OUTPUT=folder / "out")
        driven = {"POINT_CLOUDS": [street / "s.laz"], "TRAJECTORY": street / "drive.gpkg"}
        run("roadside", OUTPUT=folder / "lines.gpkg", OBJECTS=folder / "objects.gpkg", **driven)
        run("classifycloud", ROADSIDE_OBJECTS=folder / "objects.gpkg", OUTPUT=folder / "out", **driven)

    folder = made_once("classified_roadside", make)
    return {name: (laspy.read(folder / "out" / cloud), folder / layer) for name, cloud, layer in (
        ("rails", "motorway.laz", "rails.gpkg"), ("objects", "s.laz", "objects.gpkg"))}


def shapes_of(path, kind):
    with fiona.open(path) as layer:
        return [shape(row["geometry"]) for row in layer if row["properties"]["kind"] == kind]


def test_what_stands_on_a_guard_rail_is_guard_rail_and_nothing_else_is(beside):
    cloud, layer = beside["rails"]
    rails, places = shapely.union_all(shapes_of(layer, "guard_rail")), shapely.points(cloud.x, cloud.y)
    away, h = shapely.distance(places, rails), np.asarray(cloud.height_above_road)
    classes = np.asarray(cloud.classification)
    beams = (away < 0.2) & (h > 0.4) & (h < 0.7)
    assert beams.sum() > 1000 and (classes[beams] == 66).mean() > 0.95
    assert (away[classes == 66] <= 0.31).all() and (classes[away > 0.31] != 66).all()


def test_shafts_are_poles_and_trunks_are_vegetation_by_its_height_above_the_ground(beside):
    cloud, layer = beside["objects"]
    classes, places = np.asarray(cloud.classification), shapely.points(cloud.x, cloud.y)
    for kind, of_kind in (("pole", {70}), ("trunk", {3, 4, 5})):
        shafts = shapely.union_all(shapes_of(layer, kind))
        taken = np.isin(classes, list(of_kind))
        assert taken.sum() > 100 and (shapely.distance(places[taken], shafts) < 0.5).all(), kind
    feet = shapes_of(layer, "trunk")
    rise = np.asarray(cloud.z) - np.array([foot.z for foot in feet])[shapely.STRtree(feet).nearest(places)]
    for number, low, high in ((3, 0.0, 0.5), (4, 0.5, 2.0), (5, 2.0, np.inf)):
        assert ((rise[classes == number] >= low) & (rise[classes == number] < high)).all()
