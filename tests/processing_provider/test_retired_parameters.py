"""Parameters of an earlier version: commands, scripts and models that still give them run, and are told that they have no effect."""

import pytest
from lanewright.algorithms.catalogue import ALGORITHMS
from qgis.core import (
    QgsProcessingContext,
    QgsProcessingModelAlgorithm,
    QgsProcessingModelChildAlgorithm,
    QgsProcessingModelChildParameterSource,
    QgsProcessingModelOutput,
    QgsProcessingParameterDefinition,
)
from qgis.core import QgsProcessingFeedback as Feedback

SURVEY = dict(LENGTH=20.0, PULSE_RATE=20000.0, ROTATION_RATE=50.0)
RETIRED = [(declaration, name) for declaration in ALGORITHMS for name in declaration.RETIRED]


class Listener(Feedback):
    def __init__(self):
        super().__init__(False)
        self.warned = []

    def pushWarning(self, text):
        self.warned.append(text)


def test_a_script_that_gives_a_retired_parameter_runs_and_is_told_that_it_has_no_effect(provider, tmp_path):
    import processing

    listener = Listener()
    results = processing.run("lanewright:samplesurvey", {**SURVEY, "GUTTER": 0.5, "POINT_CLOUD": str(tmp_path / "a.laz"), "TRAJECTORY": "memory:"},
                             feedback=listener)
    assert results["WARNINGS"] == 1 and (tmp_path / "a.laz").exists()
    assert listener.warned == ["GUTTER was given and has no effect any more: the usual value is used. Leave it out."]


def test_a_model_that_gives_a_retired_parameter_runs_and_is_told_that_it_has_no_effect(provider, tmp_path):
    stage = QgsProcessingModelChildAlgorithm("lanewright:samplesurvey")
    stage.setChildId("made")
    given = {**SURVEY, "GUTTER": 0.5, "POINT_CLOUD": str(tmp_path / "a.laz")}
    for name, value in given.items():
        stage.addParameterSources(name, [QgsProcessingModelChildParameterSource.fromStaticValue(value)])
    output = QgsProcessingModelOutput("drive", "drive")
    output.setChildId("made")
    output.setChildOutputName("TRAJECTORY")
    stage.setModelOutputs({"drive": output})
    model = QgsProcessingModelAlgorithm("old", "old")
    model.addChildAlgorithm(stage)
    model.updateDestinationParameters()
    listener, context = Listener(), QgsProcessingContext()
    results, fine = model.run({"made:drive": "memory:"}, context, listener)
    assert fine and results["CHILD_RESULTS"]["made"]["WARNINGS"] == 1
    assert any("GUTTER was given and has no effect" in text for text in listener.warned)


@pytest.mark.parametrize(("declaration", "name"), RETIRED)
def test_no_dialog_shows_a_retired_parameter(provider, declaration, name):
    algorithm = provider.algorithm(declaration.ID).create()  # whose parameters live no longer than it
    parameter = algorithm.parameterDefinition(name)
    assert parameter.flags() & QgsProcessingParameterDefinition.Flag.FlagHidden
    assert declaration().parameter(name) is None, "one of that name is offered, so it has an effect"
