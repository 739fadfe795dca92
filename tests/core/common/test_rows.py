"""Things of one kind kept as columns."""

from dataclasses import dataclass, field

import numpy as np
import shapely
from lanewright.core.common.arrays import Rows
from lanewright.core.common.features import Field
from lanewright.core.common.layer_rows import LayerRows, column


@dataclass
class Poles(Rows):
    place: np.ndarray
    height: np.ndarray


@dataclass
class Signs(Poles):
    text: np.ndarray


def test_some_of_the_signs_keep_their_columns_together_and_stay_signs():
    signs = Signs(np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 5.0]]), np.array([2.1, 2.4, 3.0]), np.array(["A", "B", "C"]))
    assert len(signs) == 3
    tall = signs[signs.height > 2.2]
    assert isinstance(tall, Signs) and tall.text.tolist() == ["B", "C"] and tall.place.tolist() == [[1.0, 0.0], [2.0, 5.0]]
    assert signs[1:2].height.tolist() == [2.4]


def test_parts_of_a_street_are_joined_in_their_order():
    first, second = Poles(np.array([3.0]), np.array([2.0])), Poles(np.array([1.0, 2.0]), np.array([4.0, 5.0]))
    joined = Poles.join([first, second])
    assert joined.place.tolist() == [3.0, 1.0, 2.0] and joined.height.tolist() == [2.0, 4.0, 5.0]


TREES = [Field("road", int), Field("kind", str), Field("girth_m", float), Field("age", int, needed=False), Field("tall", str)]


@dataclass
class Trees(LayerRows):
    GEOMETRY_TYPE, SCHEMA = "PointZ", TREES

    road: np.ndarray = field(metadata=column())
    species: np.ndarray = field(metadata=column("kind", unknown="oak"))
    girth: np.ndarray = field(metadata=column("girth_m"))
    age: np.ndarray = field(metadata=column())
    x: np.ndarray
    crs: str = ""

    def on_map(self, frame):
        return shapely.points(self.x + frame, 0.0, 0.0)

    def derived(self, frame):
        return {"tall": np.where(self.girth > 2, "yes", None)}


def test_what_is_not_known_of_trees_is_null_in_their_layer_and_comes_back_as_it_was():
    trees = Trees.filled(2, "EPSG:25832", road=[0, 3], girth=[2.5, np.nan], age=80, x=[1.0, 2.0])
    assert trees.species.tolist() == ["oak", "oak"]
    layer = Trees.join([trees, Trees.filled(1)], trees.crs).to_features(100.0)
    assert (layer.geometry_type, layer.schema, layer.crs, layer.geometries[1].x) == ("PointZ", TREES, "EPSG:25832", 102.0)
    assert layer.rows == [dict(road=0, kind="oak", girth_m=2.5, age=80, tall="yes"), dict(road=3, kind="oak", girth_m=None, age=80, tall=None),
                          dict(road=None, kind="oak", girth_m=None, age=None, tall=None)]
    read = Trees(**Trees.read_columns([{}, *layer.rows]), x=np.zeros(4))[1:]
    assert read.road.tolist() == [0, 3, -1] and read.age.tolist() == [80, 80, -1] and np.isnan(read.girth[1:]).all()
    assert read.species.tolist() == ["oak"] * 3
