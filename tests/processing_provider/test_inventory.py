"""The inventory through Processing: from a survey and the layers of its road map to styled layers and a report."""

import shutil

import pytest
from osgeo import ogr

pytestmark = pytest.mark.slow

ogr.UseExceptions()


def rows_of(path):
    source = ogr.Open(str(path))
    return [feature.items() for feature in source.GetLayer(0)]


def test_cross_sections_of_a_mapped_street(street, street_map, tmp_path):
    import processing

    survey = {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"]}
    sections, table, drawing, report = (str(tmp_path / name) for name in ("sections.gpkg", "table.gpkg", "sections.dxf", "report.html"))
    found = processing.run("lanewright:crosssections", {**survey, "ROAD_EDGES": street_map["ROAD_EDGES"], "INTERVAL": 5, "COUNTRY": "germany",
                                                        "OUTPUT": sections, "TABLE": table, "DRAWING": drawing, "REPORT": report})
    rows = rows_of(sections)
    assert found["SECTIONS"] == len({row["station_m"] for row in rows}) >= 5
    assert rows_of(table)[0]["width_m"] == pytest.approx(rows[0]["width_m"])
    assert all(row["curb_l_m"] > 0.05 for row in rows if row["part"] == "carriageway" and row["curb_l_m"] is not None)
    assert {row["Layer"] for row in rows_of(drawing)} >= {"SECTION_GROUND", "SECTION_TEXT"}
    assert "Cross-sections" in open(report, encoding="utf-8").read()


def test_the_roadside_of_a_mapped_street(street, street_map, tmp_path):
    import processing

    survey = {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"]}
    lines, objects, report = (str(tmp_path / name) for name in ("lines.gpkg", "objects.gpkg", "report.html"))
    found = processing.run("lanewright:roadside", {**survey, "ROAD_EDGES": street_map["ROAD_EDGES"], "OUTPUT": lines, "OBJECTS": objects,
                                                   "REPORT": report})
    assert {row["kind"] for row in rows_of(lines)} <= {"guard_rail", "barrier", "wall", "fence", "hedge", "gutter"}
    assert found["POLES"] == len(rows_of(objects))
    assert "Roadside" in open(report, encoding="utf-8").read()


def test_layers_of_another_drive_are_refused(street, street_map, tmp_path):
    import processing
    from qgis.core import QgsProcessingException

    edges = shutil.copy(street_map["ROAD_EDGES"], tmp_path / "edges.gpkg")
    source = ogr.Open(str(edges), 1)
    layer = source.GetLayer(0)
    for feature in layer:
        feature["station_m"] += 30.0
        layer.SetFeature(feature)
    del layer, source
    with pytest.raises(QgsProcessingException, match="Road edges"):
        processing.run("lanewright:crosssections", {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"],
                                                    "ROAD_EDGES": str(edges), "OUTPUT": str(tmp_path / "s.gpkg")})
