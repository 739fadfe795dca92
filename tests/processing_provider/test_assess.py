"""The three assessments through real Processing, with layers as other software writes them."""

import math
from contextlib import suppress
from pathlib import Path

import processing
import pytest
from osgeo import gdal, ogr, osr
from qgis.core import QgsCoordinateReferenceSystem, QgsFeature, QgsGeometry, QgsProcessingException, QgsProcessingFeedback, QgsVectorLayer

EAST, NORTH = 610400.0, 5405000.0
UTM = "EPSG:32632"


def layer(kind, geometries, crs=UTM, fields="", rows=None):
    """A scratch layer of WKT whose numbers are metres from the street's corner."""
    made = QgsVectorLayer(f"{kind}?{f'crs={crs}' if crs else ''}{fields}", kind, "memory")
    if not crs:
        made.setCrs(QgsCoordinateReferenceSystem())
    features = []
    for number, wkt in enumerate(geometries):
        feature = QgsFeature(made.fields())
        geometry = QgsGeometry.fromWkt(wkt)
        geometry.translate(EAST, NORTH)
        feature.setGeometry(geometry)
        if rows:
            feature.setAttributes(rows[number])
        features.append(feature)
    made.dataProvider().addFeatures(features)
    return made


def street():
    return layer("LineStringZ", ["LineStringZ (0 3.5 10, 100 3.5 10)", "LineStringZ (0 -3.5 10, 100 -3.5 10)"])


def found():
    """Both curbs in one flat multi-line drawn backwards, the right one 7 cm off and 20 m short."""
    return layer("MultiLineString", ["MultiLineString ((100 3.5, 0 3.5), (0 -3.57, 80 -3.57))"])


def drive(heights=True):
    z = " 12" if heights else ""
    return layer("LineStringZ" if heights else "LineString", [f"LineString{'Z' if heights else ''} (-4 -1{z}, 50 -1{z}, 104 -1{z})"])


def run(algorithm, folder, **inputs):
    outputs = {"OUTPUT": "TEMPORARY_OUTPUT", "REPORT": str(folder / "report.html")}
    results = processing.run(f"lanewright:{algorithm}", {**outputs, **inputs})
    return results, Path(results["REPORT"]).read_text(encoding="utf-8")


def refusal(algorithm, **inputs):
    class Heard(QgsProcessingFeedback):
        text = ""

        def reportError(self, error, fatalError=False):
            self.text += error

    heard = Heard()
    with pytest.raises(QgsProcessingException) as problem:
        processing.run(f"lanewright:{algorithm}", {"OUTPUT": "TEMPORARY_OUTPUT", **inputs}, feedback=heard)
    return str(problem.value) + heard.text


def outcomes(made):
    return [feature["outcome"] for feature in made.getFeatures()]


@pytest.fixture(params=["with a trajectory", "with a flat trajectory", "without"])
def trajectory(request, provider):
    return {"with a trajectory": drive(), "with a flat trajectory": drive(False), "without": None}[request.param]


def test_boundaries_of_other_software_are_judged_side_by_side(trajectory, tmp_path):
    results, report = run("assessboundaries", tmp_path, INPUT=found(), REFERENCE=street(), TRAJECTORY=trajectory)
    assert (results["CORRECT"], results["MISSED"], results["FALSE"]) == (90, 10, 0)
    assert results["RECALL_LEFT"] == 100 and results["RECALL_RIGHT"] == 80 and results["PRECISION"] == 100
    assert results["RMSE"] == pytest.approx(0.07 * math.sqrt(40 / 90), abs=1e-3) and "HEIGHT_RMSE" not in results
    made = results["OUTPUT"]
    assert outcomes(made).count("correct") == 90 and outcomes(made).count("missed") == 10
    assert made.crs().authid() == UTM
    assert "<svg" in report and "data:image/png" in report and "Recall" in report


def test_a_tighter_tolerance_is_another_outcome(provider, tmp_path):
    results, report = run("assessboundaries", tmp_path, INPUT=found(), REFERENCE=street(), TOLERANCES="0,02; 0,05", TOLERANCE=0.05)
    assert (results["CORRECT"], results["MISSED"], results["FALSE"]) == (50, 50, 40)
    assert ">2</td>" in report and ">5</td>" in report and ">20</td>" not in report


@pytest.mark.parametrize("expression, fields, rows", [
    ("", "kind:string", [["curb"], ["curb"], ["dropped"]]),
    ("\"kind\" = 'dropped'", "kind:string", [["curb"], ["curb"], ["dropped"]]),
    ("", "kind:string&field=edge:string", [["main", "curb"], ["main", "curb"], ["main", "dropped"]])])
def test_dropped_curbs_are_left_out(provider, tmp_path, expression, fields, rows):
    reference = layer(
        "LineStringZ", ["LineStringZ (0 3.5 10, 100 3.5 10)", "LineStringZ (0 -3.5 10, 80 -3.5 10)", "LineStringZ (80 -3.5 10, 100 -3.5 10)"],
        fields=f"&field={fields}", rows=rows)
    results, _ = run("assessboundaries", tmp_path, INPUT=found(), REFERENCE=reference, TRAJECTORY=drive(), EXCLUDED=expression)
    assert (results["CORRECT"], results["MISSED"], results["EXCLUDED_INTERVALS"]) == (90, 0, 10)


def test_tops_of_curbs_are_put_aside(provider, tmp_path):
    fields, parts = "&field=part:string", [["bottom"], ["bottom"], ["top"]]
    lines = ["LineStringZ (0 3.5 10, 100 3.5 10)", "LineStringZ (0 -3.5 10, 100 -3.5 10)", "LineStringZ (0 3.6 10, 100 3.6 10)"]
    both = layer("LineStringZ", lines, fields=fields, rows=parts)
    results, report = run("assessboundaries", tmp_path, INPUT=both, REFERENCE=both)
    assert results["CORRECT"] == 100 and results["F1"] == 100 and "bottoms are assessed" in report


def test_curbs_that_leave_the_road_are_put_aside(provider, tmp_path):
    lines = ["LineStringZ (0 3.5 10, 100 3.5 10)", "LineStringZ (0 -3.5 10, 100 -3.5 10)", "LineStringZ (20 1 10, 60 1 10)"]
    result = layer("LineStringZ", lines, fields="&field=kind:string", rows=[["main"], ["main"], ["island"]])
    results, report = run("assessboundaries", tmp_path, INPUT=result, REFERENCE=street())
    assert results["FALSE"] == 0 and "40 m of corners, side streets and islands" in report


@pytest.mark.parametrize("fields, rows, edges, false", [
    ("&field=kind:string", [["curb"], ["dropped"]], "automatic", 0), ("&field=edge:string", [["curb"], ["curb"]], "automatic", 0),
    ("&field=kind:string", [["curb"], ["curb"]], "all", 20), ("", None, "curbs", 0), ("", None, "automatic", 20)])
def test_a_reference_of_curbs_does_not_judge_edges_of_the_pavement(provider, tmp_path, fields, rows, edges, false):
    lines = ["LineStringZ (0 3.5 10, 100 3.5 10)", "LineStringZ (0 -3.5 10, 60 -3.5 10)", "LineStringZ (60 -5 10, 100 -5 10)"]
    what = [["main", "curb"], ["main", "curb"], ["main", "pavement"]]
    result = layer("LineStringZ", lines, fields="&field=kind:string&field=edge:string", rows=what)
    reference = layer("LineStringZ", ["LineStringZ (0 3.5 10, 100 3.5 10)", "LineStringZ (0 -3.5 10, 60 -3.5 10)"], fields=fields, rows=rows)
    results, report = run("assessboundaries", tmp_path, INPUT=result, REFERENCE=reference, TRAJECTORY=drive(), EDGES=edges, EXCLUDED="false")
    assert (results["CORRECT"], results["FALSE"], results["MISSED"]) == (80, false, 0)
    assert ("40 m of edges of the pavement" in report) == (edges != "all")


def test_a_reference_with_edges_of_the_pavement_judges_them(provider, tmp_path):
    lines, fields = ["LineStringZ (0 3.5 10, 100 3.5 10)", "LineStringZ (0 -3.5 10, 100 -3.5 10)"], "&field=edge:string"
    both = layer("LineStringZ", lines, fields=fields, rows=[["curb"], ["pavement"]])
    results, _ = run("assessboundaries", tmp_path, INPUT=both, REFERENCE=both)
    assert (results["CORRECT"], results["FALSE"], results["MISSED"]) == (100, 0, 0)
    results, _ = run("assessboundaries", tmp_path, INPUT=both, REFERENCE=both, EDGES="curbs")
    assert (results["CORRECT"], results["FALSE"], results["MISSED"]) == (50, 0, 0)


def test_a_result_in_another_crs_is_brought_over(provider, tmp_path):
    there = processing.run("native:reprojectlayer", {"INPUT": street(), "TARGET_CRS": "EPSG:4326", "OUTPUT": "TEMPORARY_OUTPUT"})["OUTPUT"]
    for algorithm in ("assessboundaries", "assessdrivinglines"):
        results, _ = run(algorithm, tmp_path, INPUT=there, REFERENCE=street())
        assert results["F1"] == 100 and results["RMSE"] < 1e-3
        assert results["OUTPUT"].crs().authid() == UTM


def test_a_vertex_on_another_continent_does_not_make_a_layer_one_without_a_scale(provider, tmp_path):
    """The middle of its extent lies where the projection ends; refused are layers that lie there, not those with one stray vertex."""
    stray = layer("MultiLineString", ["MultiLineString ((0 3.5, 100 3.5, 40000000 41000000), (0 -3.5, 100 -3.5))"])
    results, report = run("assessboundaries", tmp_path, INPUT=stray, REFERENCE=street(), TRAJECTORY=drive())
    assert (results["CORRECT"], results["MISSED"], results["FALSE"]) == (100, 0, 0) and "1 of 5 vertices lie more than 100 km" in report
    mercator = QgsVectorLayer("LineString?crs=EPSG:3857", "far", "memory")
    feature = QgsFeature(mercator.fields())
    feature.setGeometry(QgsGeometry.fromWkt("LineString (1000000 6800000, 1000100 6800000)"))
    mercator.dataProvider().addFeatures([feature])
    assert "times those on the ground" in refusal("assessboundaries", INPUT=mercator, REFERENCE=mercator)


def test_driving_lines_are_cut_where_they_leave_the_buffer(provider, tmp_path):
    made = layer("LineString", ["LineString (0 0, 75 0, 75 0.3, 100 0.3)"])
    reference = layer("LineString", ["LineString (100 0, 0 0)"])
    results, report = run("assessdrivinglines", tmp_path, INPUT=made, REFERENCE=reference)
    assert results["MISCODING"] == pytest.approx(25, abs=0.8) and results["COMPLETENESS"] == pytest.approx(75, abs=0.8)
    assert results["GAPS_PER_KM"] == pytest.approx(10) and results["MEAN_GAP"] == pytest.approx(25, abs=0.3)
    length = {name: sum(f["length_m"] for f in results["OUTPUT"].getFeatures() if f["outcome"] == name) for name in ("correct", "false", "missed")}
    assert length["false"] == pytest.approx(25.3, abs=0.6) and length["missed"] == pytest.approx(25, abs=0.3)
    assert "half-width of the buffer" in report


def test_a_total_width_is_half_of_it_to_either_side(provider, tmp_path):
    made, reference = layer("LineString", ["LineString (0 0.08, 100 0.08)"]), layer("LineString", ["LineString (0 0, 100 0)"])
    half, _ = run("assessdrivinglines", tmp_path, INPUT=made, REFERENCE=reference)
    total, report = run("assessdrivinglines", tmp_path, INPUT=made, REFERENCE=reference, WIDTH="total-width")
    assert half["CORRECTNESS"] == 100 and total["CORRECTNESS"] == 0
    assert "total width of the buffer" in report


def test_markings_are_judged_from_polygons_lines_and_masks(provider, tmp_path):
    reference = layer("Polygon", ["Polygon ((0 0, 20 0, 20 0.16, 0 0.16, 0 0))", "Polygon ((30 0, 40 0, 40 0.16, 30 0.16, 30 0))"],
                      fields="&field=class:string", rows=[["edge"], ["lane"]])
    line = layer("LineString", ["LineString (0 0.08, 20 0.08)"], fields="&field=width_m:double", rows=[[0.16]])
    cells = str(tmp_path / "cells.tif")
    results, report = run("assessmarkings", tmp_path, INPUT=line, REFERENCE=reference, CELLS=cells, TRAJECTORY=drive())
    assert (results["HITS"], results["MISSES"], results["FALSE_ALARMS"]) == (2000, 1000, 0)
    assert results["OBJECT_RECALL"] == 50 and results["PRECISION_TOLERANT"] == 100
    assert sorted(outcomes(results["OUTPUT"])) == ["correct", "missed"]
    assert "edge" in report and "lane" in report
    # the outcome raster is a mask too: hits (1) and misses (2) are the reference
    again, _ = run("assessmarkings", tmp_path, INPUT=cells, REFERENCE=reference)
    assert (again["HITS"], again["MISSES"], again["FALSE_ALARMS"]) == (3000, 0, 0)


def switch_gdal(raises):
    while not raises and any(module.GetUseExceptions() for module in (gdal, ogr, osr)):
        for module in (gdal, ogr, osr):
            with suppress(RuntimeError):  # GDAL before 3.7 takes the last off first
                module.DontUseExceptions()
    if raises:
        gdal.UseExceptions()
        ogr.UseExceptions()


@pytest.mark.parametrize("raises", [False, True])
def test_an_algorithm_leaves_gdal_to_other_plugins_as_it_was(provider, tmp_path, raises):
    before = gdal.GetUseExceptions()
    switch_gdal(raises)
    line = layer("LineString", ["LineString (0 0.08, 20 0.08)"], fields="&field=width_m:double", rows=[[0.16]])
    cells = str(tmp_path / "cells.tif")
    run("assessmarkings", tmp_path, INPUT=line, REFERENCE=line, CELLS=cells, TRAJECTORY=drive())
    run("assessmarkings", tmp_path, INPUT=cells, REFERENCE=line, IMAGE=cells)
    after = gdal.GetUseExceptions(), ogr.GetUseExceptions()
    switch_gdal(before)
    assert after == (raises, raises)


def test_all_of_one_class_and_no_class_at_all_are_judged_alike(provider, tmp_path):
    shapes = ["Polygon ((0 0, 20 0, 20 0.16, 0 0.16, 0 0))"]
    plain, named = layer("Polygon", shapes), layer("Polygon", shapes, fields="&field=class:string", rows=[["edge"]])
    for reference in (plain, named):
        assert run("assessmarkings", tmp_path, INPUT=plain, REFERENCE=reference)[0]["F1"] == 100


KINDS = [("assessboundaries", "LineStringZ"), ("assessdrivinglines", "LineString"), ("assessmarkings", "Polygon")]


@pytest.mark.parametrize("algorithm, kind", KINDS)
class TestWhatCannotBeJudged:
    SHAPES = {"LineStringZ": "LineStringZ (0 0 1, 50 0 1)", "LineString": "LineString (0 0, 50 0)",
              "Polygon": "Polygon ((0 0, 50 0, 50 1, 0 1, 0 0))"}

    def good(self, kind, crs=UTM):
        return layer(kind, [self.SHAPES[kind]], crs)

    def in_degrees(self, kind):
        return processing.run("native:reprojectlayer", {
            "INPUT": self.good(kind), "TARGET_CRS": "EPSG:4326", "OUTPUT": "TEMPORARY_OUTPUT"})["OUTPUT"]

    def test_a_reference_without_rows_is_refused(self, provider, algorithm, kind):
        text = refusal(algorithm, INPUT=self.good(kind), REFERENCE=layer(kind, []))
        assert "Reference" in text and "Choose the layer of reference" in text

    def test_a_result_without_rows_misses_everything(self, provider, tmp_path, algorithm, kind):
        results, report = run(algorithm, tmp_path, INPUT=layer(kind, []), REFERENCE=self.good(kind))
        assert results["RECALL"] == 0 and results["F1"] == 0 and "PRECISION" not in results
        assert "everything is missed" in report

    def test_layers_of_two_towns_are_refused(self, provider, algorithm, kind):
        far = self.good(kind)
        far.dataProvider().changeGeometryValues({f.id(): QgsGeometry.fromWkt(self.SHAPES[kind]) for f in far.getFeatures()})
        assert "m apart" in refusal(algorithm, INPUT=far, REFERENCE=self.good(kind))

    def test_degrees_are_refused(self, provider, algorithm, kind):
        there = self.in_degrees(kind)
        assert "geographic" in refusal(algorithm, INPUT=there, REFERENCE=there)

    def test_a_layer_without_crs_is_taken_to_lie_with_the_other(self, provider, tmp_path, algorithm, kind):
        results, report = run(algorithm, tmp_path, INPUT=self.good(kind, crs=""), REFERENCE=self.good(kind))
        assert results["F1"] == 100 and "has no CRS" in report

    def test_layers_of_a_local_system_without_any_crs_are_judged(self, provider, tmp_path, algorithm, kind):
        results, _ = run(algorithm, tmp_path, INPUT=self.good(kind, crs=""), REFERENCE=self.good(kind, crs=""))
        assert results["F1"] == 100 and not results["OUTPUT"].crs().isValid()

    def test_an_area_elsewhere_is_refused(self, provider, algorithm, kind):
        area = layer("Polygon", ["Polygon ((500 500, 510 500, 510 510, 500 500))"])
        assert "inside the area" in refusal(algorithm, INPUT=self.good(kind), REFERENCE=self.good(kind), AREA=area)

    def test_tolerances_that_are_no_numbers_are_refused(self, provider, algorithm, kind):
        assert "give numbers with commas" in refusal(algorithm, INPUT=self.good(kind), REFERENCE=self.good(kind), TOLERANCES="5 cm")

    def test_points_are_refused(self, provider, algorithm, kind):
        points = layer("Point", ["Point (1 1)"])
        assert "points" in refusal(algorithm, INPUT=points, REFERENCE=self.good(kind)).lower()


def test_a_model_hands_on_layers_and_numbers(provider, tmp_path):
    """The number of one step decides in an expression of the next."""
    from qgis.core import (
        QgsProcessingContext,
        QgsProcessingFeatureSourceDefinition,
        QgsProcessingModelAlgorithm,
        QgsProcessingModelChildAlgorithm,
        QgsProcessingModelChildParameterSource,
        QgsProcessingModelParameter,
        QgsProcessingParameterFeatureSource,
    )

    model = QgsProcessingModelAlgorithm("check", "check")
    for name in ("MADE", "TRUTH"):
        model.addModelParameter(QgsProcessingParameterFeatureSource(name, name), QgsProcessingModelParameter(name))
    source = QgsProcessingModelChildParameterSource
    first = QgsProcessingModelChildAlgorithm("lanewright:assessdrivinglines")
    first.setChildId("assess")
    first.addParameterSources("INPUT", [source.fromModelParameter("MADE")])
    first.addParameterSources("REFERENCE", [source.fromModelParameter("TRUTH")])
    model.addChildAlgorithm(first)
    second = QgsProcessingModelChildAlgorithm("lanewright:assessdrivinglines")
    second.setChildId("again")
    second.addParameterSources("INPUT", [source.fromChildOutput("assess", "OUTPUT")])
    second.addParameterSources("REFERENCE", [source.fromModelParameter("TRUTH")])
    second.addParameterSources("TOLERANCE", [source.fromExpression("@assess_MISCODING / 250")])
    model.addChildAlgorithm(second)
    assert model.validate()[0]
    made, reference = layer("LineString", ["LineString (0 0, 75 0, 75 0.3, 100 0.3)"]), layer("LineString", ["LineString (0 0, 100 0)"])
    context = QgsProcessingContext()
    given = {}
    for name, given_layer in (("MADE", made), ("TRUTH", reference)):
        context.temporaryLayerStore().addMapLayer(given_layer)
        given[name] = QgsProcessingFeatureSourceDefinition(given_layer.id())
    results, ok = model.create().run(given, context, QgsProcessingFeedback())
    assert ok and results["CHILD_RESULTS"]["assess"]["MISCODING"] == pytest.approx(25, abs=0.8)
    assert float(results["CHILD_INPUTS"]["again"]["TOLERANCE"]) == pytest.approx(0.1, abs=0.004)


def test_a_trajectory_of_another_street_is_refused(provider):
    elsewhere = layer("LineStringZ", ["LineStringZ (0 800 1, 100 800 1)"])
    assert "does not pass" in refusal("assessboundaries", INPUT=street(), REFERENCE=street(), TRAJECTORY=elsewhere)


def test_an_expression_that_cannot_be_read_is_refused(provider):
    assert "cannot be used" in refusal("assessboundaries", INPUT=street(), REFERENCE=street(), EXCLUDED="kind = = 3")
