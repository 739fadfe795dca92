"""The inventory through Processing: from a survey and the layers of its road map to styled layers and a report."""

import shutil

import numpy as np
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
    sections, table, drawing, report, landxml, heights = (str(tmp_path / name) for name in (
        "sections.gpkg", "table.gpkg", "sections.dxf", "report.html", "sections.xml", "sections.csv"))
    found = processing.run("lanewright:crosssections", {**survey, "ROAD_EDGES": street_map["ROAD_EDGES"], "INTERVAL": 5, "COUNTRY": "germany",
                                                        "OUTPUT": sections, "TABLE": table, "DRAWING": drawing, "REPORT": report,
                                                        "LANDXML": landxml, "HEIGHTS": heights})
    rows = rows_of(sections)
    assert found["SECTIONS"] == len({row["station_m"] for row in rows}) >= 5
    assert rows_of(table)[0]["width_m"] == pytest.approx(rows[0]["width_m"])
    curbs = [row["curb_l_m"] for row in rows if row["part"] == "carriageway" and row["curb_l_m"] is not None]
    assert min(curbs) > 0.01 and np.median(curbs) > 0.1, "beside a drive the curb is lowered"
    assert {row["Layer"] for row in rows_of(drawing)} >= {"SECTION_GROUND", "SECTION_TEXT"}
    assert "Cross-sections" in open(report, encoding="utf-8").read()
    assert open(landxml, encoding="utf-8").read().count("<CrossSect ") == found["SECTIONS"]
    assert len({line.split(",")[1] for line in open(heights, encoding="utf-8").read().splitlines()[1:]}) == found["SECTIONS"]


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


@pytest.mark.parametrize("ending", ["xml", "dxf"])
def test_the_surface_of_a_mapped_street(street, street_map, tmp_path, ending):
    import processing
    from osgeo import gdal

    survey = {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"]}
    lines, tin, surface, dem = (str(tmp_path / name) for name in ("lines.gpkg", "tin.gpkg", f"surface.{ending}", "dem.tif"))
    found = processing.run("lanewright:surfacemodel", {**survey, "ROAD_EDGES": street_map["ROAD_EDGES"], "BREAKLINES": lines, "TIN": tin,
                                                       "SURFACE_FILE": surface, "DEM": dem, "CELL_SIZE": 0.5})
    assert {row["kind"] for row in rows_of(lines)} >= {"edge_bottom", "edge_top"}
    assert {row["status"] for row in rows_of(tin)} <= {"measured", "bridged"} and len(rows_of(tin)) == found["TRIANGLES"]
    assert found["RMSE"] < 0.006 and found["SHARE"] < 1.0
    assert open(surface, encoding="utf-8").read().count("<F>" if ending == "xml" else "3DFACE") == found["TRIANGLES"]
    raster = gdal.Open(dem)
    assert raster.GetGeoTransform()[1] == 0.5 and raster.GetProjection()


@pytest.mark.parametrize("changed, said", [
    ({"ROAD_EDGES": None}, "ROAD_EDGES"),
    ({"SURFACE_FILE": "surface.txt"}, ".xml or .landxml or .dxf"),
    ({"SURFACE_FILE": "nowhere/surface.xml"}, "no folder"),
    ({"TOLERANCE": 0.0}, "TOLERANCE"),
])
def test_what_a_surface_cannot_be_made_of_or_written_to_is_refused_in_a_sentence(street, street_map, tmp_path, changed, said):
    import processing
    from qgis.core import QgsProcessingException

    parameters = {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"], "ROAD_EDGES": street_map["ROAD_EDGES"],
                  "BREAKLINES": str(tmp_path / "lines.gpkg")}
    changed = {name: str(tmp_path / value) if name == "SURFACE_FILE" else value for name, value in changed.items()}
    with pytest.raises(QgsProcessingException, match=said):
        processing.run("lanewright:surfacemodel", {**parameters, **changed})
    assert not list(tmp_path.iterdir())
