"""The road map by a client's template through Processing: as GeoPackage, as drawing, and into the client's own file."""

from pathlib import Path

import pytest
from osgeo import ogr

ogr.UseExceptions()
TEMPLATES = Path(__file__).resolve().parents[2] / "resources" / "templates"


def rows_of(path, layer):
    source = ogr.Open(str(path))
    return [feature.items() for feature in source.GetLayerByName(layer)]


def exported(street_map, folder, template, output, **more):
    import processing

    return processing.run("lanewright:exporttemplate", {"TEMPLATE": str(template), "ROAD_EDGES": street_map["ROAD_EDGES"],
                                                        "MARKINGS": street_map["MARKINGS"], "OUTPUT": str(folder / output), **more})


def written(folder, *rows):
    path = folder / "template.csv"
    path.write_text("\n".join(rows), encoding="utf-8")
    return path


@pytest.mark.parametrize("template", sorted(TEMPLATES.glob("*.csv")), ids=lambda path: path.stem)
def test_the_templates_that_come_along_are_right_and_leave_no_paint_out(street_map, template, tmp_path):
    found = exported(street_map, tmp_path, template, "client.gpkg")
    source = ogr.Open(str(tmp_path / "client.gpkg"))
    assert found["LAYERS"] == source.GetLayerCount() >= 1 and found["FEATURES"] > 0
    assert all(source.GetLayer(k).GetSpatialRef() is not None for k in range(source.GetLayerCount()))
    assert found["LEFT_OUT"] <= 2, "symbols have no number"


def test_curbs_have_the_codes_and_centimetres_of_the_client(street_map, tmp_path):
    template = written(tmp_path, "from;where;layer;CODE;HEIGHT_CM:int;SIDE", "ROAD_EDGES;edge=curb;Bordstein;B1;{height_m:cm};{side:left=L,right=R}",
                       "ROAD_EDGES;;-;;;", "MARKINGS;;-;;;")
    found = exported(street_map, tmp_path, template, "client.gpkg")
    rows = rows_of(tmp_path / "client.gpkg", "Bordstein")
    assert found["FEATURES"] == len(rows) >= 2 and found["LEFT_OUT"] == 0
    assert {row["CODE"] for row in rows} == {"B1"} and {row["SIDE"] for row in rows} == {"L", "R"}
    assert all(5 <= row["HEIGHT_CM"] <= 25 for row in rows)


def test_a_drawing_and_a_filled_file_of_the_client(street_map, tmp_path):
    from qgis.core import QgsProcessingException

    template = written(tmp_path, "from;where;layer;CODE", "ROAD_EDGES;;CURBS;B1", "MARKINGS;;PAINT;M1")
    exported(street_map, tmp_path, template, "client.dxf")
    assert {row["Layer"] for row in rows_of(tmp_path / "client.dxf", "entities")} == {"CURBS", "PAINT"}
    exported(street_map, tmp_path, template, "office.gpkg")
    before = len(rows_of(tmp_path / "office.gpkg", "CURBS"))
    exported(street_map, tmp_path, template, "filled.gpkg", OFFICE=str(tmp_path / "office.gpkg"))
    assert len(rows_of(tmp_path / "filled.gpkg", "CURBS")) == 2 * before
    for output, problem in (("office.gpkg", "inputs are never changed"), ("other.dxf", "cannot be filled as a DXF drawing")):
        with pytest.raises(QgsProcessingException, match=problem):
            exported(street_map, tmp_path, template, output, OFFICE=str(tmp_path / "office.gpkg"))


def test_a_wrong_template_is_refused_before_anything_is_written(street_map, tmp_path):
    from qgis.core import QgsProcessingException

    with pytest.raises(QgsProcessingException, match=r"template\.csv, line 2: there is no layer CURBS"):
        exported(street_map, tmp_path, written(tmp_path, "from;layer", "CURBS;A"), "client.gpkg")
    with pytest.raises(QgsProcessingException, match="No layer of the road map was given"):
        exported(street_map, tmp_path, written(tmp_path, "from;layer", "MARKINGS;A"), "client.gpkg", ROAD_EDGES=None, MARKINGS=None)
    assert {path.name for path in tmp_path.iterdir()} == {"template.csv"}
