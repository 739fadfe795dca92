"""The models that come along: listed, in step with the algorithms, and runnable."""

import sys
from pathlib import Path

import pytest
from lanewright.processing_provider.provider import model_id
from qgis.core import Qgis, QgsApplication

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from models import RECIPES  # noqa: E402


@pytest.fixture(params=RECIPES, ids=lambda recipe: recipe.file)
def recipe(request):
    return request.param


@pytest.fixture
def model(provider, recipe):
    return QgsApplication.processingRegistry().createAlgorithmById(f"lanewright:{model_id(recipe.name)}")


def test_every_model_is_listed_and_says_what_it_does(model, recipe):
    assert model is not None and model.group() == "Models"
    assert recipe.description[:30] in model.shortHelpString()


def test_the_id_of_a_model_has_no_spaces_and_its_title_is_kept_by_copies(model, recipe):
    assert model.name() == model_id(recipe.name) and " " not in model.id()
    assert model.displayName() == model.create().displayName() == recipe.name


@pytest.mark.parametrize("old", ["Road map stages", "Boundaries from scanlines", "Markings and driving lines with assessment"])
def test_a_model_is_still_found_by_the_name_that_was_its_id(provider, old):
    assert QgsApplication.processingRegistry().createAlgorithmById(f"lanewright:{old}") is not None


def test_the_file_is_that_of_the_recipe(model, recipe):
    assert [child.algorithmId() for child in model.childAlgorithms().values()] == [f"lanewright:{stage}" for stage in recipe.stages]
    assert {p.name() for p in model.parameterDefinitions() if not p.isDestination()} == set(recipe.inputs)
    assert {p.description() for p in model.destinationParameterDefinitions()} == set(recipe.results)
    assert [output.description() for output in model.orderedOutputs()] == list(recipe.results)


def test_every_stage_exists_and_its_wiring_holds(model):
    for child_id, child in model.childAlgorithms().items():
        assert child.algorithm() is not None, child.algorithmId()
        valid, errors = model.validateChildAlgorithm(child_id)
        assert valid, errors


def test_no_result_that_a_later_stage_reads_can_be_left_out(model, recipe):
    optional = {p.description() for p in model.destinationParameterDefinitions() if p.flags() & Qgis.ProcessingParameterFlag.Optional}
    read = {text for inputs, _ in recipe.stages.values() for text in inputs.values()}
    for child in model.childAlgorithms().values():
        for output in child.modelOutputs().values():
            stage = child.algorithmId().partition(":")[2]
            assert f"{stage}.{output.childOutputName()}" not in read or output.description() not in optional


def test_every_input_explains_itself_in_the_words_of_its_stage(model):
    for parameter in model.parameterDefinitions():
        if not parameter.isDestination():
            assert len(parameter.help()) > 20 and parameter.help() in model.shortHelpString(), parameter.name()


def test_the_results_tell_their_fields(model):
    assert "Fields:" in model.shortHelpString()


def test_the_help_button_of_a_model_opens_the_page_on_models(model):
    assert model.helpUrl() == "lanewright:models"
