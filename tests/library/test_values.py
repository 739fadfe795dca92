"""What one writes on the command line or in Python, and what is refused before any work."""

import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.library import algorithms
from lanewright.library.call import checked_values

NEEDED = {"samplesurvey": {"POINT_CLOUD": "s.laz", "TRAJECTORY": "t.gpkg"}, "roadmap": {"POINT_CLOUDS": ["a.laz"], "TRAJECTORY": "t.csv"},
          "georeferenceimage": {"IMAGE": "i.tif", "OUTPUT": "o.tif"}}


def values(name, **given):
    return checked_values(algorithms()[name], {**NEEDED[name], **given})


@pytest.mark.parametrize("name, given, value", [
    ("LENGTH", "80", 80.0), ("LENGTH", 80, 80.0), ("SEED", "3", 3), ("SEED", 3.0, 3), ("SCENE", "rural", "rural"),
])
def test_texts_and_values_of_python_are_the_same(name, given, value):
    found = values("samplesurvey", **{name: given})[name]
    assert found == value and type(found) is type(value)


@pytest.mark.parametrize("given, value", [("true", True), ("no", False), (True, True), (False, False), ("1", True)])
def test_yes_and_no(given, value):
    assert values("roadmap", CORRECT_INTENSITY=given)["CORRECT_INTENSITY"] is value


def test_one_point_cloud_or_many_and_paths_of_pathlib(tmp_path):
    assert values("roadmap", POINT_CLOUDS=tmp_path)["POINT_CLOUDS"] == [str(tmp_path)]
    assert values("roadmap", POINT_CLOUDS=("a.laz", tmp_path))["POINT_CLOUDS"] == ["a.laz", str(tmp_path)]


def test_what_is_empty_was_not_given():
    assert not {"ROAD_EDGES", "CRS"} & set(values("roadmap", ROAD_EDGES="", CRS=None))


@pytest.mark.parametrize("algorithm, given, says", [
    ("samplesurvey", {"LENGTHS": 80}, r"no parameter LENGTHS. Did you mean LENGTH\?"),
    ("samplesurvey", {"LENGTH": "long"}, r"\(LENGTH\) is long; it must be a number from"),
    ("samplesurvey", {"LENGTH": -1}, r"\(LENGTH\) is -1; it must be a number from"),
    ("samplesurvey", {"LENGTH": True}, r"must be a number from"),
    ("samplesurvey", {"SEED": 1.5}, r"\(SEED\) is 1.5"),
    ("samplesurvey", {"SCENE": "moon"}, r"must be one of street, rural, urban"),
    ("roadmap", {"CORRECT_INTENSITY": "maybe"}, r"must be true or false"),
    ("roadmap", {"ROAD_EDGES": "TEMPORARY_OUTPUT"}, r"only QGIS can write to. .* such as road_edges.gpkg"),
    ("roadmap", {"ROAD_EDGES": "memory:"}, r"only QGIS can write to"),
    ("roadmap", {"TRAJECTORY": ["a.csv", "b.csv"]}, r"must be one text"),
])
def test_what_cannot_be_is_refused_in_one_sentence(algorithm, given, says):
    with pytest.raises(RoadExtractionError, match=says):
        values(algorithm, **given)


def test_an_empty_raster_is_not_taken_for_a_default():
    with pytest.raises(RoadExtractionError, match=r"Image \(IMAGE\) was not given"):
        values("georeferenceimage", IMAGE="")


def test_a_retired_parameter_is_taken_though_no_algorithm_asks_for_it():
    """A script of an earlier version goes on; the run says once that the parameter may be left out."""
    assert values("samplesurvey", GUTTER="0.5")["GUTTER"] == "0.5"
    assert algorithms()["samplesurvey"].parameter("GUTTER") is None
