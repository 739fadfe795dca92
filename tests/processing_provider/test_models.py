"""The models that come along: listed, in step with the algorithms, and runnable."""

import sys
from pathlib import Path

import pytest
from qgis.core import Qgis, QgsApplication

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from models import RECIPES  # noqa: E402


@pytest.fixture(params=RECIPES, ids=lambda recipe: recipe.file)
def recipe(request):
    return request.param


@pytest.fixture
def model(provider, recipe):
    return QgsApplication.processingRegistry().createAlgorithmById(f"lanewright:{recipe.name}")


def test_every_model_is_listed_and_says_what_it_does(model, recipe):
    assert model is not None and model.group() == "Models"
    assert recipe.description[:30] in model.shortHelpString()


def test_the_file_is_that_of_the_recipe(model, recipe):
    assert set(model.childAlgorithms()) == set(recipe.stages)
    assert {p.name() for p in model.parameterDefinitions() if not p.isDestination()} == set(recipe.inputs)
    titles = {result.partition(":")[2] for result in recipe.results}
    assert {p.description() for p in model.destinationParameterDefinitions()} == titles


def test_every_stage_exists_and_its_wiring_holds(model):
    for child_id, child in model.childAlgorithms().items():
        assert child.algorithm() is not None, child.algorithmId()
        valid, errors = model.validateChildAlgorithm(child_id)
        assert valid, errors


def test_no_result_that_a_later_stage_reads_can_be_left_out(model, recipe):
    optional = {p.description() for p in model.destinationParameterDefinitions() if p.flags() & Qgis.ProcessingParameterFlag.Optional}
    read = {text for inputs, _ in recipe.stages.values() for text in inputs.values()}
    for stage in recipe.stages:
        for output in model.childAlgorithm(stage).modelOutputs().values():
            assert f"{stage}.{output.childOutputName()}" not in read or output.description() not in optional
