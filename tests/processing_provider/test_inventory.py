"""The inventory through Processing: from a survey and the layers of its road map to styled layers and a report."""

import pytest
from osgeo import ogr

pytestmark = pytest.mark.slow

ogr.UseExceptions()


@pytest.fixture(scope="module")
def street(sample_survey):
    return sample_survey(LENGTH=40, PULSE_RATE=60000, ROTATION_RATE=100)


def rows_of(path):
    source = ogr.Open(str(path))
    return [feature.items() for feature in source.GetLayer(0)]


def test_cross_sections_of_a_mapped_street(street, tmp_path):
    import processing

    survey = {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"]}
    edges, sections, table, report = (str(tmp_path / name) for name in ("edges.gpkg", "sections.gpkg", "table.gpkg", "report.html"))
    processing.run("lanewright:detectboundaries", {**survey, "BOUNDARY_METHOD": "profiles", "ROAD_EDGES": edges})
    found = processing.run("lanewright:crosssections", {**survey, "ROAD_EDGES": edges, "INTERVAL": 5, "COUNTRY": "germany", "OUTPUT": sections,
                                                        "TABLE": table, "REPORT": report})
    rows = rows_of(sections)
    assert found["SECTIONS"] == len({row["station_m"] for row in rows}) >= 5
    assert rows_of(table)[0]["width_m"] == pytest.approx(rows[0]["width_m"])
    assert all(row["curb_l_m"] > 0.05 for row in rows if row["part"] == "carriageway" and row["curb_l_m"] is not None)
    assert "Cross-sections" in open(report, encoding="utf-8").read()


def test_the_roadside_of_a_mapped_street(street, tmp_path):
    import processing

    survey = {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"]}
    edges, lines, objects, report = (str(tmp_path / name) for name in ("edges.gpkg", "lines.gpkg", "objects.gpkg", "report.html"))
    processing.run("lanewright:detectboundaries", {**survey, "BOUNDARY_METHOD": "profiles", "ROAD_EDGES": edges})
    found = processing.run("lanewright:roadside", {**survey, "ROAD_EDGES": edges, "OUTPUT": lines, "OBJECTS": objects, "REPORT": report})
    assert {row["kind"] for row in rows_of(lines)} <= {"guard_rail", "barrier", "wall", "fence", "hedge", "gutter"}
    assert found["POLES"] == len(rows_of(objects))
    assert "Roadside" in open(report, encoding="utf-8").read()


def test_layers_of_another_drive_are_refused(street, tmp_path):
    import processing
    from qgis.core import QgsProcessingException

    edges = tmp_path / "edges.gpkg"
    processing.run("lanewright:detectboundaries", {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"],
                                                   "BOUNDARY_METHOD": "profiles", "ROAD_EDGES": str(edges)})
    source = ogr.Open(str(edges), 1)
    layer = source.GetLayer(0)
    for feature in layer:
        feature["station_m"] += 30.0
        layer.SetFeature(feature)
    del layer, source
    with pytest.raises(QgsProcessingException, match="Road edges"):
        processing.run("lanewright:crosssections", {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"],
                                                    "ROAD_EDGES": str(edges), "OUTPUT": str(tmp_path / "s.gpkg")})
