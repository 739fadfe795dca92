"""The chain as a graphical model: listed, drawable, and in step with the algorithms it calls."""

import pytest
from qgis.core import Qgis, QgsApplication, QgsProcessingModelAlgorithm

RESULTS = {"road_edges", "road_surface", "road_points", "intensity_image", "markings", "marking_lines", "driving_lines", "lanes",
           "curve_elements"}


@pytest.fixture
def model(provider):
    return QgsApplication.processingRegistry().createAlgorithmById("lanewright:roadmapstages")


def test_the_model_is_listed_under_the_provider_and_knows_its_results(model):
    assert isinstance(model, QgsProcessingModelAlgorithm)
    assert model.displayName() == "Road map stages"
    assert {p.name() for p in model.destinationParameterDefinitions()} == RESULTS


def test_every_stage_of_the_model_exists_and_its_wiring_holds(model):
    for child_id, child in model.childAlgorithms().items():
        assert child.algorithm() is not None, child.algorithmId()
        valid, errors = model.validateChildAlgorithm(child_id)
        assert valid, errors


def test_the_model_sets_no_knob_so_that_it_equals_the_road_map(model):
    """What the model's own dialog asks is handed on; nothing else is turned."""
    for child in model.childAlgorithms().values():
        fixed = [name for name, sources in child.parameterSources().items()
                 if any(source.source() == Qgis.ProcessingModelChildParameterSource.StaticValue for source in sources)]
        kinds = {child.algorithm().parameterDefinition(name).type() for name in fixed}
        assert not kinds & {"number", "enum", "boolean"}, child.algorithmId()


def test_the_model_can_be_copied_and_run_again(model):
    copy = model.create()
    assert copy.displayName() == "Road map stages"
    assert {p.name() for p in copy.destinationParameterDefinitions()} == RESULTS
