"""What the toolbox shows: every algorithm, and every parameter explaining itself."""

import re

import pytest
from lanewright.algorithms.algorithm import settings_class
from lanewright.algorithms.catalogue import ALGORITHMS
from lanewright.algorithms.driving import OFFERED, STAGES
from lanewright.processing_provider.algorithm import LanewrightAlgorithm
from qgis.core import Qgis, QgsProcessingParameterDefinition

# Commands, models and scripts call these; a name that changes breaks them.
INTERFACE = {
    "importtrajectory": "INPUT INPUT_CRS TARGET_CRS POINT_CLOUDS TIME OUTPUT",
    "estimatetrajectory": "POINT_CLOUDS CRS TRAJECTORY REPORT",
    "inspectsurvey": "POINT_CLOUDS TRAJECTORY CRS REPORT DENSITY",
    "samplesurvey": "SCENE LENGTH SEED POINT_CLOUD TRAJECTORY TRUTH_BOUNDARIES TRUTH_MARKINGS TRUTH_DRIVING_LINES",
    "normalizedscanlines": "POINT_CLOUDS TRAJECTORY CRS INTERVAL CORRIDOR SIMPLIFY SCANLINES RESAMPLED_POINTS",
    "boundariesfromscanlines": "SCANLINES TRAJECTORY SEARCH_WIDTH SENSOR_HEIGHT CLIPPING_HEIGHT MIN_HEIGHT DISTANCE_ACROSS "
                               "DISTANCE_ALONG RANSAC_DISTANCE VERTICAL_ANGLE HORIZONTAL_ANGLE MAX_GAP CORNERS BOUNDARIES",
    "detectcurbs": "POINT_CLOUDS TRAJECTORY CRS BLOCK_LENGTH PROFILE_WIDTH POINT_SPACING LAYER_JUMP SLOPE MIN_HEIGHT "
                   "MAX_HEIGHT CURB_POINTS PRINCIPAL_POINTS",
    "fitroadedges": "CURB_POINTS TRAJECTORY MAX_GAP FALLBACK_WIDTH ROAD_EDGES",
    "detectboundaries": "POINT_CLOUDS TRAJECTORY CRS BOUNDARY_METHOD ROAD_EDGES",
    "extractroadsurface": "POINT_CLOUDS TRAJECTORY CRS ROAD_EDGES MAX_WIDTH ROAD_POINTS ROAD_SURFACE",
    "correctintensity": "ROAD_POINTS TRAJECTORY OUTPUT REPORT",
    "intensityimage": "ROAD_POINTS CELL_SIZE INTENSITY_IMAGE",
    "extractmarkings": "ROAD_POINTS INTENSITY_IMAGE TRAJECTORY METHOD MARKING_POINTS MARKING_MASK",
    "removeoutliers": "INPUT NEIGHBOURS STD_RATIO SCOPE OUTPUT",
    "clustermarkings": "MARKING_POINTS TRAJECTORY DISTANCE MARKINGS CLUSTERED_POINTS",
    "fitmarkinglines": "CLUSTERED_POINTS MARKINGS TRAJECTORY CURVE DEGREE MARKING_LINES",
    "paintcolours": "MARKINGS MARKING_LINES POINT_CLOUDS IMAGE AROUND COLOURED_MARKINGS COLOURED_LINES",
    "drivinglines": "MARKING_LINES TRAJECTORY MARKINGS ROAD_EDGES ROAD_POINTS LANE_WIDTH LINE_DISTANCE TRAFFIC_SIDE "
                    "DRIVING_LINES CURVE_ELEMENTS",
    "proposecontrolpoints": "IMAGE INTENSITY_IMAGE ROUGH_POINTS PIXEL_SIZE SEARCH TOLERANCE MIN_SCORE COUNT CONTROL_POINTS REPORT",
    "georeferenceimage": "IMAGE GCPS GCP_FILE CRS ORDER PIXEL_SIZE OUTPUT RESIDUALS REPORT",
    "roadmap": "POINT_CLOUDS TRAJECTORY CRS BOUNDARY_METHOD ROAD_EDGES ROAD_SURFACE ROAD_POINTS INTENSITY_IMAGE MARKINGS "
               "MARKING_LINES DRIVING_LINES CURVE_ELEMENTS REPORT",
    "importopendrive": "INPUT CRS LANES DRIVING_LINES MARKING_LINES ROAD_EDGES MARKINGS SIGNALS",
    "importlanelet2": "INPUT CRS LANES DRIVING_LINES MARKING_LINES ROAD_EDGES MARKINGS SIGNALS",
    "roadattributes": "LANES OSM_FILE WAYS CORRIDOR OUTPUT",
    "converthdmap": "INPUT CRS VERSION TOLERANCE TRAFFIC_SIDE SPEED_LIMIT LOCATION LOCAL_COORDINATES OUTPUT REPORT",
    "exportopendrive": "LANES DRIVING_LINES MARKING_LINES ROAD_EDGES MARKINGS ROAD_POINTS VERSION TOLERANCE TRAFFIC_SIDE SIGNALS OUTPUT REPORT",
    "exportcad": "LANES DRIVING_LINES MARKING_LINES ROAD_EDGES MARKINGS ROAD_POINTS FORMAT TOLERANCE OUTPUT REPORT",
    "printsheets": "DRIVING_LINES ROAD_EDGES MARKING_LINES CROSS_SECTIONS MARKINGS LANES ROAD_SURFACE ROAD_POINTS BELOW TITLE OFFICE AUTHOR PAPER "
                   "ORIENTATION SCALE PROFILE SECTION_INTERVAL HEIGHT_SYSTEM CREDIT LANGUAGE KEEP OUTPUT",
    "exportlanelet2": "LANES DRIVING_LINES MARKING_LINES ROAD_EDGES MARKINGS ROAD_POINTS SPEED_LIMIT LOCATION SIGNALS OUTPUT REPORT",
    "checkhdmap": "INPUT CRS OUTPUT REPORT",
    "exporttemplate": "TEMPLATE ROAD_EDGES ROAD_SURFACE MARKINGS MARKING_LINES DRIVING_LINES LANES ROADSIDE ROADSIDE_OBJECTS CROSS_SECTIONS OFFICE "
                      "CONNECTION SCHEMA OUTPUT",
    "classifycloud": "POINT_CLOUDS TRAJECTORY CRS ROAD_SURFACE ROAD_EDGES MARKINGS ROADSIDE ROADSIDE_OBJECTS OUTPUT UNROLLED COPC",
    "roadside": "POINT_CLOUDS TRAJECTORY CRS ROAD_EDGES MARKING_LINES DRIVING_LINES LANES INTERVAL COUNTRY OUTPUT OBJECTS REPORT",
    "crosssections": "POINT_CLOUDS TRAJECTORY CRS ROAD_EDGES MARKING_LINES DRIVING_LINES LANES INTERVAL COUNTRY OUTPUT TABLE DRAWING LANDXML "
                     "HEIGHTS REPORT",
    "surfacemodel": "POINT_CLOUDS TRAJECTORY CRS ROAD_EDGES MARKING_LINES LANES TOLERANCE REACH CELL_SIZE MAX_GAP BREAKLINES TIN SURFACE_FILE DEM",
    "assessboundaries": "INPUT REFERENCE TRAJECTORY TOLERANCES TOLERANCE INTERVAL EDGES EXCLUDED AREA OUTPUT REPORT",
    "assessmarkings": "INPUT REFERENCE TRAJECTORY TOLERANCES TOLERANCE CELL_SIZE AREA IMAGE OUTPUT CELLS REPORT",
    "assessdrivinglines": "INPUT REFERENCE TRAJECTORY TOLERANCES TOLERANCE WIDTH AREA OUTPUT REPORT",
}
UNIT = re.compile(r"\((m|mm|m²|s|°|%|points|σ|MAD|km/h|per second|per line|cells|whole number|\d+-\d+)\)$")


@pytest.fixture(params=ALGORITHMS, ids=lambda algorithm: algorithm.ID)
def algorithm(request, provider):
    return LanewrightAlgorithm(request.param()).create()


@pytest.mark.parametrize("name", INTERFACE)
def test_every_algorithm_is_listed_under_its_fixed_names(provider, name):
    algorithm = provider.algorithm(name)
    assert algorithm is not None
    assert not set(INTERFACE[name].split()) - {p.name() for p in algorithm.parameterDefinitions()}


def test_every_algorithm_of_the_catalogue_has_its_interface_written_down(provider):
    assert {algorithm.ID for algorithm in ALGORITHMS} == set(INTERFACE)


def test_every_number_has_help_and_a_unit(algorithm):
    for parameter in algorithm.parameterDefinitions():
        if parameter.type() == "number":
            assert len(parameter.help()) > 20, parameter.name()
            assert UNIT.search(parameter.description()), parameter.description()


def test_a_number_beyond_its_range_is_refused_before_the_work(algorithm):
    """QGIS itself says "Incorrect parameter value for ..." of the parameter, before the algorithm is run."""
    for parameter in algorithm.parameterDefinitions():
        if parameter.type() == "number":
            assert abs(parameter.minimum()) < 1e7 and abs(parameter.maximum()) < 1e10, parameter.name()
            for value in (parameter.minimum() - 1.0, 2.0 * abs(parameter.maximum()) + 1.0, "many"):
                assert not parameter.checkValueIsAcceptable(value), (parameter.name(), value)
            assert parameter.checkValueIsAcceptable(parameter.defaultValue()), parameter.name()


def test_every_input_explains_itself(algorithm):
    for parameter in algorithm.parameterDefinitions():
        if not parameter.isDestination() and parameter.name() not in algorithm.declaration.RETIRED:
            assert parameter.help(), parameter.name()


def test_every_number_starts_from_the_default_of_the_core(algorithm):
    for parameter in algorithm.parameterDefinitions():
        if parameter.type() in ("number", "enum", "boolean"):
            assert parameter.defaultValue() is not None, parameter.name()


def test_choices_are_written_as_words(algorithm):
    for parameter in algorithm.parameterDefinitions():
        if parameter.type() == "enum":
            assert parameter.usesStaticStrings(), parameter.name()
            assert parameter.defaultValue() in parameter.options(), parameter.name()


def test_the_dialog_tells_what_the_algorithm_does(algorithm):
    assert algorithm.displayName() and algorithm.group() and len(algorithm.shortDescription()) > 30
    for parameter in algorithm.parameterDefinitions():
        assert parameter.help() in algorithm.shortHelpString()


def test_every_vector_result_lists_its_fields(algorithm):
    truth = re.compile("TRUTH_|PRINCIPAL_POINTS")
    for parameter in algorithm.destinationParameterDefinitions():
        if parameter.type() == "sink" and not truth.match(parameter.name()):
            assert "Fields:" in parameter.help(), parameter.name()


def test_clouds_are_files_since_qgis_without_pdal_cannot_load_them(algorithm):
    clouds = algorithm.parameterDefinition("POINT_CLOUDS")
    if clouds is not None:
        assert clouds.layerType() == Qgis.ProcessingSourceType.File


def test_the_dialog_of_the_road_map_shows_clouds_trajectory_and_where_to_save(provider):
    shown = [parameter.name() for parameter in provider.algorithm("roadmap").parameterDefinitions()
             if not parameter.isDestination() and not parameter.flags() & QgsProcessingParameterDefinition.Flag.FlagAdvanced]
    assert shown == ["POINT_CLOUDS", "TRAJECTORY"]


def test_a_setting_of_the_road_map_changes_one_thing_only():
    # a road lies in one country, and both boundary methods ask for one least height
    names = [spec.name for specs in STAGES.values() for spec in specs if spec.name not in ("COUNTRY", "MIN_HEIGHT")]
    assert len(names) == len(set(names))
    assert set(OFFERED) <= {*names, "COUNTRY", "MIN_HEIGHT"}


def test_settings_of_a_package_that_is_not_there_leave_the_algorithm_listed():
    assert settings_class("survey.no_such_module:Settings") is None


def test_an_algorithm_runs_from_a_script_and_from_the_dialog(provider, tmp_path):
    """Both go through QgsProcessingAlgorithm.run, which no method of ours may hide."""
    import processing

    results = processing.run("lanewright:samplesurvey", {
        "LENGTH": 20, "PULSE_RATE": 20000, "POINT_CLOUD": str(tmp_path / "s.laz"), "TRAJECTORY": "TEMPORARY_OUTPUT",
    })
    assert results["POINTS"] > 1000 and results["TRAJECTORY"].featureCount() > 100
