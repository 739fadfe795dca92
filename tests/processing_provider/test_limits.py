"""A dialog offers what the core accepts, to the last number, and nothing beyond."""

import pytest
from lanewright.algorithms.algorithm import SettingSpec, settings_class
from lanewright.algorithms.catalogue import ALGORITHMS
from lanewright.core.common.errors import RoadExtractionError
from lanewright.processing_provider.algorithm import LanewrightAlgorithm

# Settings that are compared with each other: what another one must be beside an extreme one
BESIDE = {
    ("CurbSettings", "min_height"): {"max_height": 1.0},
    ("CurbSettings", "max_height"): {"min_height": 0.01},
    ("ScanlineBoundarySettings", "min_height"): {"clipping_height": 2.0},
    ("ScanlineBoundarySettings", "clipping_height"): {"min_height": 0.01},
    ("ScanlineBoundarySettings", "vertical_angle"): {"horizontal_angle": 1.0},
    ("MarkingLineSettings", "max_gap"): {"max_bridge": 200.0},
    ("MarkingLineSettings", "max_bridge"): {"max_gap": 0.1},
    ("CrossSectionSettings", "min_crossfall"): {"max_crossfall": 20.0},
}


@pytest.fixture(scope="module")
def numbers(provider):
    """(algorithm, SettingSpec, parameter) of every number in every dialog that is a setting of the core."""
    found = []
    for declaration in ALGORITHMS:
        algorithm = LanewrightAlgorithm(declaration()).create()
        for spec in algorithm.declaration.parameters:
            if isinstance(spec, SettingSpec) and spec.kind in ("whole", "number"):
                found.append((algorithm.name(), spec, algorithm.parameterDefinition(spec.name).clone()))
    return found


def settings_with(spec, value):
    owner = settings_class(spec.settings)
    beside = BESIDE.get((owner.__name__, spec.field), {})
    return owner(**{spec.field: value}, **{name: other for name, other in beside.items() if name in owner.__dataclass_fields__})


def beyond(parameter, value, way):
    return value + way * (1 if parameter.dataType() == parameter.Type.Integer else max(abs(value), 1.0) * 1e-3)


def test_dialogs_have_numbers(numbers):
    assert len(numbers) > 60 and len({algorithm for algorithm, *_ in numbers}) > 12


def test_the_core_accepts_the_extremes_that_a_dialog_offers(numbers):
    refused = []
    for algorithm, spec, parameter in numbers:
        for value, times in ((parameter.minimum(), 1.0), (parameter.maximum(), spec.times)):
            assert parameter.checkValueIsAcceptable(value)
            try:
                settings_with(spec, type(spec.default)(value / times))
            except RoadExtractionError as error:
                refused.append((algorithm, spec.name, value, str(error)))
    assert not refused


def test_what_lies_beyond_is_refused_by_the_dialog_and_the_core(numbers):
    accepted = []
    for algorithm, spec, parameter in numbers:
        for end, way, times in ((parameter.minimum(), -1, 1.0), (parameter.maximum(), 1, spec.times)):
            value = beyond(parameter, end, way)
            if parameter.checkValueIsAcceptable(value):
                accepted.append((algorithm, spec.name, value, "dialog"))
            try:
                settings_with(spec, type(spec.default)(value / times))
                accepted.append((algorithm, spec.name, value, "core"))
            except RoadExtractionError as error:
                assert "it must be" in str(error), str(error)
    assert not accepted
