"""A road map under a client's names: what the template says happens, and what is not known is said with its line."""

import sqlite3
import sys
from contextlib import closing

import pyproj
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import MARKING_LINES, MARKINGS, ROADSIDE_OBJECTS, Features
from lanewright.products.cad import drawn_layers
from lanewright.products.client_fields import apply_template, layers_of_client, read_template, write_client_layers

UTM = pyproj.CRS.from_epsg(32632).to_wkt()
SOURCES = {"MARKINGS": (MARKINGS, "PolygonZ"), "MARKING_LINES": (MARKING_LINES, "LineStringZ"), "ROADSIDE_OBJECTS": (ROADSIDE_OBJECTS, "PointZ")}


def square(x):
    return shapely.Polygon([(x, 0, 5), (x + 2, 0, 5), (x + 2, 2, 7), (x, 2, 7)])


@pytest.fixture
def street():
    """A zebra crossing, a stop line 29.6 cm wide, a dashed line to the left and a pole."""
    markings = Features("PolygonZ", MARKINGS, crs=UTM)
    markings.add(square(0), **{"class": "zebra", "width_m": 4.0, "station_m": 12.3456})
    markings.add(square(5), **{"class": "stop", "width_m": 0.296, "station_m": 20.0})
    lines = Features("LineStringZ", MARKING_LINES, crs=UTM)
    lines.add(shapely.LineString([(0, 9, 1), (10, 9, 3)]), kind="lane", pattern="dashed", width_m=0.12, line=4)
    poles = Features("PointZ", ROADSIDE_OBJECTS, crs=UTM)
    poles.add(shapely.Point(1, 2, 3), kind="pole", side="left", height_m=5.5)
    return {"MARKINGS": markings, "MARKING_LINES": lines, "ROADSIDE_OBJECTS": poles}


def template(tmp_path, *rows, mixed=False):
    path = tmp_path / "office.csv"
    path.write_text("\n".join(rows), encoding="utf-8")
    return read_template(path, SOURCES, mixed)


def test_codes_fields_units_lists_and_texts_are_those_of_the_client(street, tmp_path):
    made = apply_template(template(
        tmp_path, "# of the office, 2026", "from;where;layer;geometry;CODE;WIDTH:int;PLACE;SIDE;NO",
        "MARKINGS;class = zebra;AREA;;K12;{width_m:mm};km {station_m:km};;{number}", "MARKINGS;;AREA;;K99;{width_m:mm};;;{number}",
        "ROADSIDE_OBJECTS;height_m >= 5 & kind=pole,sign;POLE;;P1;{height_m:cm};;{side:left=L,right=R};"), street)
    assert made.layers["AREA"].rows == [{"CODE": "K12", "WIDTH": 4000, "PLACE": "km 0.012", "NO": 1}, {"CODE": "K99", "WIDTH": 296, "NO": 2}]
    assert made.layers["POLE"].rows == [{"CODE": "P1", "WIDTH": 550, "SIDE": "L"}]
    assert [(field.name, field.type) for field in made.layers["AREA"].schema] == [("CODE", str), ("WIDTH", int), ("PLACE", str), ("NO", int)]
    assert made.left_out == {}, "lines were not asked for"


def test_what_no_row_takes_is_counted_and_what_is_left_out_on_purpose_is_not(street, tmp_path):
    rows = ["from,where,layer,CODE", "MARKINGS,class=stop,AREA,1"]
    assert apply_template(template(tmp_path, *rows), street).left_out == {"MARKINGS zebra": 1}
    assert apply_template(template(tmp_path, *rows, "MARKINGS,class=zebra,-,"), street).left_out == {}


def test_areas_become_outlines_or_points_and_lines_their_middles(street, tmp_path):
    made = apply_template(template(tmp_path, "from\twhere\tlayer\tgeometry", "MARKINGS\t\tOUTLINE\tline", "MARKINGS\t\tMIDDLE\tpoint",
                                   "MARKING_LINES\t\tMIDDLE\tpoint"), street).layers
    assert made["OUTLINE"].geometries[0].length == pytest.approx(8.0)
    assert [shape.coords[0] for shape in made["MIDDLE"].geometries][::2] == [pytest.approx((1, 1, 5.8)), pytest.approx((5, 9, 2))]


@pytest.mark.parametrize(("rows", "said"), [
    (["where;layer", "class=zebra;A"], "line 1: there is no column “from”"),
    (["from;where;layer", "", "ZEBRAS;;A"], "line 3: there is no layer ZEBRAS"),
    (["from;where;layer", "MARKING;;A"], r"line 2: there is no layer MARKING \(is MARKINGS meant\?\)"),
    (["from;where;layer", "MARKINGS;class=zebras;A"], r"line 2: zebras is no class that Lanewright writes \(is zebra meant\?\)"),
    (["from;where;layer", "MARKINGS;klass=zebra;A"], "line 2: MARKINGS has no field klass"),
    (["from;where;layer", "MARKINGS;class;A"], "line 2: “class” is no condition"),
    (["from;where;layer", "MARKINGS;width_m>wide;A"], "line 2: width_m is a number, and “wide” is none"),
    (["from;where;layer;W", "MARKINGS;;A;{width_m:inch}"], "line 2: width_m cannot be given in “inch”; known are m, dm, cm"),
    (["from;where;layer;W", "MARKINGS;;A;{breadth_m}"], "line 2: MARKINGS has no field breadth_m"),
    (["from;where;layer;W:date", "MARKINGS;;A;{width_m}"], "line 1: W is to be of the type “date”"),
    (["from;where;layer;w;W", "MARKINGS;;A;1;2"], "line 1: two columns are called w"),
    (["from;where;layer;geometry", "ROADSIDE_OBJECTS;;A;line"], "line 2: a point of ROADSIDE_OBJECTS cannot become a “line”"),
    (["from;where;layer", "MARKINGS;;A", "MARKING_LINES;;A"], "line 3: layer A would hold a line and, from line 2, a polygon"),
    (["from;where;layer"], "holds no rows"),
    (["from;where;layer", "MARKINGS;class=stop;A", "MARKINGS;;a"], "line 3: layer a is called A in line 2"),
    (["from,where,layer,W", "MARKINGS,class=stop,zebra,AREA,1"], "line 2: “1” stands in a column without a name"),
    (["from;where;layer", "MARKINGS;width_m>0,2;A"], "line 2: “width_m>0,2” compares width_m with 2 numbers"),
    (["from;where;layer;W", "MARKINGS;;A;{width_m"], "line 2: “{width_m” has a brace without its partner"),
    (["from;where;layer;S", "ROADSIDE_OBJECTS;;A;{side:left=L,R}"], "line 2: “R” in the list of side is no pair"),
])
def test_what_is_not_known_is_said_with_its_line(rows, said, tmp_path):
    with pytest.raises(RoadExtractionError, match=said):
        template(tmp_path, *rows)


def test_a_table_as_a_spreadsheet_saves_it_has_marks_of_bytes_quotes_and_empty_columns_and_lines(street, tmp_path):
    path = tmp_path / "office.csv"
    path.write_bytes('from;where;layer;NAME;WIDTH : INT;;\r\nMARKINGS;class=zebra;"Straße ""A""";"a;b";{width_m:mm};;\r\n;;;;;;\r\n\r\n'
                     .encode("utf-8-sig"))
    made = apply_template(read_template(path, SOURCES), street)
    assert made.layers['Straße "A"'].rows == [{"NAME": "a;b", "WIDTH": 4000}]


def test_what_the_client_has_just_written_is_in_the_copy_of_its_file(street, tmp_path):
    """A GeoPackage that a program has open keeps its latest rows in a file beside it."""
    gdal, ogr, osr = (pytest.importorskip(f"osgeo.{name}") for name in ("gdal", "ogr", "osr"))
    path, filled = str(tmp_path / "office.gpkg"), str(tmp_path / "filled.gpkg")
    dataset = gdal.GetDriverByName("GPKG").Create(path, 0, 0, 0, gdal.GDT_Unknown)
    dataset.CreateLayer("AREA", osr.SpatialReference(UTM), ogr.wkbPolygon25D, ["SPATIAL_INDEX=NO"]).CreateField(ogr.FieldDefn("CODE", ogr.OFTString))
    dataset = None
    with closing(sqlite3.connect(path)) as program:
        program.execute("PRAGMA journal_mode=WAL")
        program.execute("INSERT INTO AREA (CODE) VALUES ('theirs')")
        program.commit()
        said = template(tmp_path, "from;where;layer;CODE", "MARKINGS;;AREA;12")
        made = apply_template(said, street, layers_of_client(path, UTM, said))
        write_client_layers(made.layers, filled, path)
    layer = (dataset := ogr.Open(filled)).GetLayerByName("AREA")
    assert [feature["CODE"] for feature in layer] == ["theirs", "12", "12"]
    layer = dataset = None


@pytest.mark.parametrize("name", ["fid", "geom"])
def test_names_of_fields_that_a_geopackage_has_itself_are_the_clients_too(name, street, tmp_path):
    ogr = pytest.importorskip("osgeo.ogr")
    made = apply_template(template(tmp_path, f"from;where;layer;{name}", "MARKINGS;;AREA;{number}"), street)
    write_client_layers(made.layers, str(tmp_path / "client.gpkg"))
    dataset = ogr.Open(str(tmp_path / "client.gpkg"))
    layer = dataset.GetLayerByName("AREA")
    assert layer.GetFeatureCount() == 2 and layer.GetExtent() == (0, 7, 0, 2)
    assert [feature[name] for feature in layer] == [1, 2]


def test_a_text_in_a_field_of_numbers_is_refused(street, tmp_path):
    with pytest.raises(RoadExtractionError, match="line 2: CODE of AREA holds numbers, and “K12” is none"):
        apply_template(template(tmp_path, "from;where;layer;CODE:int", "MARKINGS;;AREA;K12"), street)


@pytest.mark.parametrize(("code", "said"), [("70000", "does not take “70000”"), ("9" * 30, "does not take")])
def test_a_number_that_a_field_of_the_client_would_cut_is_refused(code, said, street, tmp_path):
    with pytest.raises(RoadExtractionError, match=said):
        filled_with(street, tmp_path, "OFTInteger", "OFSTInt16", code)


@pytest.mark.parametrize(("kind", "code"), [("OFTDate", "2026-13-45"), ("OFTString", "a text of many letters")])
def test_a_text_that_a_field_of_the_client_does_not_take_is_refused(kind, code, street, tmp_path):
    with pytest.raises(RoadExtractionError, match=f"The field CODE of layer AREA does not take “{code}”"):
        filled_with(street, tmp_path, kind, "OFSTNone", code)


def test_a_table_without_places_is_none_for_lines_or_areas(street, tmp_path):
    with pytest.raises(RoadExtractionError, match="holds a row without a place, and a polygon is to be written"):
        filled_with(street, tmp_path, "OFTString", "OFSTNone", "1", "wkbNone")


def filled_with(street, tmp_path, kind, smaller, code, geometry="wkbPolygon"):
    """Write a code into the one field of a client's layer, which is 8 letters wide where it holds texts."""
    gdal, ogr, osr = (pytest.importorskip(f"osgeo.{name}") for name in ("gdal", "ogr", "osr"))
    path = str(tmp_path / "office.gpkg")
    dataset = gdal.GetDriverByName("GPKG").Create(path, 0, 0, 0, gdal.GDT_Unknown)
    field = ogr.FieldDefn("CODE", getattr(ogr, kind))
    field.SetSubType(getattr(ogr, smaller))
    field.SetWidth(8 if kind == "OFTString" else 0)
    dataset.CreateLayer("AREA", osr.SpatialReference(UTM), getattr(ogr, geometry)).CreateField(field)
    dataset = None
    said = template(tmp_path, "from;where;layer;CODE", f"MARKINGS;;AREA;{code}")
    made = apply_template(said, street, layers_of_client(path, UTM, said))
    write_client_layers(made.layers, str(tmp_path / "filled.gpkg"), path)


def test_a_disk_that_is_full_at_the_very_end_is_told_of(street, tmp_path):
    """A GeoPackage writes its last tables when it is closed. Every size at which a disk may be full is tried."""
    resource = pytest.importorskip("resource")
    made = apply_template(template(tmp_path, "from;where;layer;CODE", "MARKINGS;;AREA;12"), street)
    write_client_layers(made.layers, str(tmp_path / "whole.gpkg"))
    whole, before = (tmp_path / "whole.gpkg").stat().st_size, resource.getrlimit(resource.RLIMIT_FSIZE)
    for size in range(8192, whole, 8192):
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
        try:
            with pytest.raises(RoadExtractionError, match="could not be written"):
                write_client_layers(made.layers, str(tmp_path / f"{size}.gpkg"))
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_the_file_of_the_client_is_filled_as_its_layers_are(street, tmp_path):
    """Of several parts and flat, with fields that the template does not name; what it does not have is refused."""
    gdal, ogr, osr = (pytest.importorskip(f"osgeo.{name}") for name in ("gdal", "ogr", "osr"))
    path, filled = str(tmp_path / "office.gpkg"), str(tmp_path / "filled.gpkg")
    dataset = gdal.GetDriverByName("GPKG").Create(path, 0, 0, 0, gdal.GDT_Unknown)
    crs = osr.SpatialReference()
    crs.ImportFromEPSG(32632)
    layer = dataset.CreateLayer("AREA", crs, ogr.wkbMultiPolygon)
    layer.CreateField(ogr.FieldDefn("CODE", ogr.OFTString))
    layer.CreateField(ogr.FieldDefn("CHECKED", ogr.OFTString))
    layer = dataset = None
    said = template(tmp_path, "from;where;layer;CODE", "MARKINGS;;AREA;12", "ROADSIDE_OBJECTS;;POLES;13")
    office = layers_of_client(path, UTM, said)
    assert office == {"AREA": ("polygon", {"CODE": str, "CHECKED": str})}
    markings = {"MARKINGS": street["MARKINGS"]}   # of what is not given, the file needs no layer
    write_client_layers(apply_template(said, markings, office).layers, filled, path)
    layer = (dataset := ogr.Open(filled)).GetLayerByName("AREA")
    assert [(feature["CODE"], feature["CHECKED"]) for feature in layer] == [("12", None)] * 2
    assert layer.GetGeomType() == ogr.wkbMultiPolygon and layer.GetExtent() == (0, 7, 0, 2)
    assert ogr.Open(path).GetLayer(0).GetFeatureCount() == 0, "the client's own file stays as it is"
    layer = dataset = None
    for row, problem in (("MARKINGS;;AREAS;1", r"no layer AREAS \(is AREA meant"), ("MARKING_LINES;;AREA;1", "holds a polygon, and a line")):
        with pytest.raises(RoadExtractionError, match=problem):
            apply_template(template(tmp_path, "from;where;layer;CODE", row), street, office)
    with pytest.raises(RoadExtractionError, match="has no field KODE"):
        apply_template(template(tmp_path, "from;where;layer;KODE", "MARKINGS;;AREA;1"), street, office)
    with pytest.raises(RoadExtractionError, match="is in WGS 84 / UTM zone 32N, and the map in"):
        layers_of_client(path, "EPSG:32633", said)
    other = template(tmp_path, "from;where;layer;CODE", "ROADSIDE_OBJECTS;;POLES;13")
    assert layers_of_client(path, "EPSG:32633", other) == office, "the template does not fill what is in another CRS"


def test_without_gdal_a_geopackage_is_refused_in_one_sentence(street, tmp_path, monkeypatch):
    for name in ("osgeo", "osgeo.gdal", "osgeo.ogr"):
        monkeypatch.setitem(sys.modules, name, None)
    made = apply_template(template(tmp_path, "from;where;layer;CODE", "MARKINGS;;AREA;12"), street)
    with pytest.raises(RoadExtractionError, match="which is not installed. Install lanewright"):
        write_client_layers(made.layers, str(tmp_path / "client.gpkg"))


def test_a_drawing_has_the_layers_of_the_client_and_points_as_texts(street, tmp_path):
    made = apply_template(template(tmp_path, "from;where;layer;CODE", "MARKINGS;;ROAD;1", "ROADSIDE_OBJECTS;;ROAD;P7", mixed=True), street)
    with pytest.raises(RoadExtractionError, match="line 2: a drawing has no layer ROAD/1"):
        template(tmp_path, "from;where;layer", "MARKINGS;;ROAD/1", mixed=True)
    drawn = [(line.layer, line.closed, line.text) for line in drawn_layers(made.layers)]
    assert drawn == [("ROAD", True, ""), ("ROAD", True, ""), ("ROAD", False, "P7")]
