"""`make accuracy`: surveys with truth in, a page out."""

import json

import pytest
from shapely import LineString, Polygon, box

pytest.importorskip("osgeo.gdal")

from accuracy import judge  # noqa: E402
from accuracy.figures import figures_of  # noqa: E402
from accuracy.page import page  # noqa: E402
from accuracy.results import results  # noqa: E402
from accuracy.surveys import read_case, surveys_in  # noqa: E402
from lanewright.core.common.features import Features, Field  # noqa: E402
from make_sample import write_layers  # noqa: E402
from results_table import Results  # noqa: E402


@pytest.fixture(scope="module")
def measured(short_street):
    """The survey, and its figures without the long tables."""
    return short_street, figures_of(short_street / "short", quick=True)


@pytest.mark.slow
def test_a_made_survey_is_found_and_says_that_it_is_simulated(measured):
    folder, figures = measured
    assert [path.name for path in surveys_in(folder)] == ["short"]
    assert figures["kind"] == "simulated" and figures["points"] > 50_000
    assert read_case(folder / "short").seen is not None


@pytest.mark.slow
def test_every_method_is_measured(measured):
    _, figures = measured
    assert set(figures["boundaries"]) == {"profiles", "scanlines", "both"}
    assert set(figures["methods"]) == {"intensity-peaks", "point-segments", "multi-threshold"}
    assert figures["whole"]["markings"]["tolerant"]["f1"] > 90
    assert figures["methods"]["multi-threshold"]["polygons"]["tolerant"] == figures["whole"]["markings"]["tolerant"]
    assert figures["boundaries"]["profiles"]["total"] == figures["whole"]["boundaries"]["total"]


@pytest.mark.slow
def test_the_results_hold_published_figures_beside_ours_and_the_page_is_the_same_from_the_file(measured, tmp_path):
    _, figures = measured
    table = results(json.loads(json.dumps([figures])))
    table.write(tmp_path / "accuracy.csv")
    again = Results.read(tmp_path / "accuracy.csv")
    text = page(again, samples=True)
    assert text == page(table, samples=True)
    assert "| short (simulated) |" in text and "**simulated**" in text and "the thesis, on other, real roads, has 92.0" in text
    assert again.get("methods", "thesis, mean of data sets 1, 4, 5", "intensity-peaks", "polygons tolerant f1") == 83.42
    for name in ("survey", "seconds", "whole", "methods", "boundaries"):
        assert "short" in again.names(name) and any(of.startswith(("thesis", "paper")) for of in again.names(name))
    assert "Not measured." in text
    assert "nan" not in text and "None" not in text and "nan" not in (tmp_path / "accuracy.csv").read_text()


def test_truth_of_another_kind_is_read(tmp_path):
    (tmp_path / "one" / "truth").mkdir(parents=True)
    words = [Field(name, str) for name in ("side", "scope", "kind", "mark_class")]
    line, square = LineString([(0, 0, 0), (10, 0, 0)]), Polygon([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
    curbs, paint = Features("LineStringZ", words), Features("PolygonZ", words)
    for kind, scope in (("curb", "main"), ("dropped", "main"), ("curb", "island")):
        curbs.add(line, side="left", kind=kind, scope=scope)
    paint.add(square, mark_class="stop_line")
    write_layers(tmp_path / "one" / "truth" / "truth.gpkg", {"curb_bottom": curbs, "markings": paint})
    for name in ("cloud.laz", "trajectory.csv"):
        (tmp_path / "one" / name).touch()
    case = read_case(surveys_in(tmp_path)[0])
    assert len(case.truth.curbs) == 1 and len(case.truth.aside) == 2
    assert case.truth.classes == ["stop line"]
    assert case.truth.area is None and case.seen is None and case.kind == "not stated"
    assert case.truth.has == {"boundaries", "markings"}


@pytest.mark.slow
def test_the_truth_itself_scores_full_marks(measured):
    folder, _ = measured
    case = read_case(folder / "short")
    found = judge.paint(case, case.truth.markings)
    assert found["strict"]["f1"] == 100 and min(found["classes"].values()) == 100
    driving = judge.driving(case, [(line, {}) for line in case.truth.driving])
    assert driving["recall"]["5"] == pytest.approx(100) and driving["miscoding"]["5"] == pytest.approx(0)


@pytest.mark.slow
def test_paint_beyond_the_judged_area_costs_nothing_and_beside_the_road_it_does(measured):
    folder, _ = measured
    case = read_case(folder / "short")
    middle = case.truth.area.centroid
    far, near = (box(middle.x + away, middle.y, middle.x + away + 0.2, middle.y + 5) for away in (500, 0))
    assert judge.paint(case, [*case.truth.markings, far])["strict"]["precision"] == 100
    assert judge.paint(case, [*case.truth.markings, near])["strict"]["precision"] < 100
