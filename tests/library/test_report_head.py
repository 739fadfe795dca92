"""A report says first which survey it is about, and how it was made."""

from lanewright.algorithms.provenance import own_version
from lanewright.library import run
from lanewright.products.report.page import html_page, with_facts


def test_a_report_names_survey_files_crs_time_version_and_what_was_set(tmp_path):
    folder = tmp_path / "B12"
    folder.mkdir()
    cloud, drive = folder / "north.laz", folder / "drive.gpkg"
    run("samplesurvey", LENGTH=25, PULSE_RATE=20000, POINT_CLOUD=str(cloud), TRAJECTORY=str(drive))
    run("inspectsurvey", POINT_CLOUDS=[str(cloud)], TRAJECTORY=str(drive), REPORT=str(tmp_path / "survey.html"))
    text = (tmp_path / "survey.html").read_text(encoding="utf-8")
    head = text[text.index("</h1>"):text.index("</table>")]
    for said in ("B12/north", "north.laz", "drive.gpkg", f"Lanewright {own_version()}", " UTC, ", "by default"):
        assert said in head, said
    assert str(tmp_path) not in head, "a report is handed on"


def test_what_files_are_called_is_text_and_no_page():
    page = with_facts(html_page("runs", tables=[]), [("Survey", "<script>alert(1)</script>")])
    assert "<script>alert" not in page and "&lt;script&gt;" in page
    assert with_facts("<p>no page of ours</p>", [("Survey", "B12")]) == "<p>no page of ours</p>"
