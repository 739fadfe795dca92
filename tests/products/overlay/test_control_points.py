"""Control points from whatever table they come in: the same points each time."""

import numpy as np
import pytest
from flown_images import EAST, NORTH, image
from lanewright.core.common.errors import RoadExtractionError
from lanewright.products.overlay.control_points import SourceImage, control_points, read_control_points

PIXEL, LINE = [10.5, 590.0, 300.25, 20.0], [20.25, 30.0, 380.0, 390.5]
EASTING, NORTHING = [EAST + p / 20 for p in PIXEL], [NORTH - q / 20 for q in LINE]
POINTS = list(zip(EASTING, NORTHING, PIXEL, LINE))

WKT = ('PROJCRS["WGS 84 / UTM zone 50N",BASEGEOGCRS["WGS 84",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,'
       '298.257223563]],ID["EPSG",4326]],CONVERSION["UTM zone 50N",METHOD["Transverse Mercator"],PARAMETER["Latitude of natural origin",0],'
       'PARAMETER["Longitude of natural origin",117],PARAMETER["Scale factor at natural origin",0.9996],'
       'PARAMETER["False easting",500000],PARAMETER["False northing",0]],CS[Cartesian,2],AXIS["easting",east],AXIS["northing",north],'
       'LENGTHUNIT["metre",1]]')


def rows(order, mark=",", lines_up=False, tail=""):
    sign = -1 if lines_up else 1
    values = [{"E": e, "N": n, "p": p, "l": sign * q} for e, n, p, q in POINTS]
    return "".join(mark.join(repr(value[key]) for key in order) + tail + "\n" for value in values)


TABLES = {
    "points, with CRS": f"#CRS: {WKT}\nmapX,mapY,sourceX,sourceY,enable,dX,dY,residual\n" + rows("ENpl", ",", True, ",1,0,0,0"),
    "points, CRS by number": "#CRS: EPSG:32650\nmapX,mapY,pixelX,pixelY,enable\n" + rows("ENpl", ",", True, ",1"),
    "points, before CRS": "mapX,mapY,pixelX,pixelY,enable\n" + rows("ENpl", ",", True, ",1"),
    "points, tabs": "mapX\tmapY\tpixelX\tpixelY\tenable\n" + rows("ENpl", "\t", True, "\t1"),
    "points, no header": rows("ENpl", ",", True, ",1"),
    "csv, pixels first": "pixel,line,easting,northing\n" + rows("plEN"),
    "csv, map first, semicolons": "Easting;Northing;Pixel;Line\n" + rows("ENpl", ";"),
    "csv, decimal commas": "E;N;col;row\n" + rows("ENpl", ";").replace(".", ","),
    "csv, mixed": "Line, E (m), pixel, N (m)\n" + rows("lEpN"),
    "csv, x and y": "x,y,column,row\n" + rows("ENpl"),
    "csv, header as comment": "#pixel,line,easting,northing\n" + rows("plEN"),
    "csv, no header, pixels first": rows("plEN"),
    "txt, spaces": "pixel line east north\n" + rows("plEN", "  "),
    "csv, windows": ("\ufeffpixel,line,easting,northing\n" + rows("plEN")).replace("\n", "\r\n"),
}


@pytest.mark.parametrize("table", TABLES)
def test_the_same_points_are_read_from_every_form(table, tmp_path):
    path = tmp_path / "image.tif.points"
    path.write_bytes(TABLES[table].encode())
    points = read_control_points(path, image())
    np.testing.assert_allclose([points.pixel, points.line], [PIXEL, LINE])
    np.testing.assert_allclose([points.easting, points.northing], [EASTING, NORTHING])
    assert (points.roles == "control").all()
    assert ("50N" in points.crs) == ("CRS" in table and "before" not in table)


def test_names_come_with_the_points_and_disabled_ones_are_told(tmp_path):
    path = tmp_path / "gcps.csv"
    path.write_text("id,pixel,line,easting,northing,enable,role\nA1,10,20,100,200,1,control\nA2,500,20,124,200,0,control\nA3,10,390,100,181,1,Check\n")
    points = read_control_points(path, image())
    assert points.names == ("A1", "A2", "A3")
    assert list(points.roles) == ["control", "disabled", "check"]
    assert list(points.with_disabled_as_checks().roles) == ["control", "check", "check"]


def test_a_disabled_point_may_lie_anywhere():
    table = [[10, 20, 1.0, 2.0, 1], [300, 200, 3.0, 4.0, 1], [9000, 20, 5.0, 6.0, 0]]
    assert len(control_points(["pixel", "line", "x", "y", "enable"], table, image(), "The table")) == 3
    with pytest.raises(RoadExtractionError, match="1 of 3 points"):
        control_points(["pixel", "line", "x", "y"], table, image(), "The table")


def test_names_may_stand_first_where_nothing_has_a_header(tmp_path):
    path = tmp_path / "gcps.txt"
    path.write_text("".join(f"P{k} {p} {q} {e} {n}\n" for k, (e, n, p, q) in enumerate(POINTS)))
    points = read_control_points(path, image())
    assert points.names[2] == "P2"
    np.testing.assert_allclose(points.easting, EASTING)


def test_source_coordinates_of_an_image_that_had_a_place_become_pixels(tmp_path):
    placed = image(geotransform=(5000.0, 0.1, 0.0, 9000.0, 0.0, -0.1))
    path = tmp_path / "image.tif.points"
    path.write_text("mapX,mapY,sourceX,sourceY,enable\n" + "".join(
        f"{e},{n},{5000 + 0.1 * p},{9000 - 0.1 * q},1\n" for e, n, p, q in POINTS))
    points = read_control_points(path, placed)
    np.testing.assert_allclose([points.pixel, points.line], [PIXEL, LINE], atol=1e-6)


def test_rows_without_numbers_are_left_out_and_counted():
    points = control_points(["pixel", "line", "x", "y"], [[1, 2, 3.0, 4.0], [None, 5, 6, 7], ["-", "-", 8, 9]], image(), "The table")
    assert len(points) == 1 and points.left_out == 2


def refusal(text, tmp_path, seen=None):
    path = tmp_path / "gcps.csv"
    path.write_text(text)
    with pytest.raises(RoadExtractionError) as refused:
        read_control_points(path, seen or image())
    return str(refused.value)


def test_points_of_another_image_are_refused_with_both_sizes(tmp_path):
    told = refusal("pixel,line,easting,northing\n4000,2000,1,2\n100,3000,3,4\n", tmp_path)
    assert "2 of 2 points" in told and "4000" in told and "600 by 400" in told


def test_a_missing_column_is_named(tmp_path):
    told = refusal("pixel,line,easting,height\n1,2,3,4\n", tmp_path)
    assert "none of them was recognised as northing" in told and "height" in told


def test_columns_without_names_that_could_be_either_are_refused(tmp_path):
    told = refusal("10,20,30,40\n50,60,70,80\n", tmp_path)
    assert "pixel,line,easting,northing" in told


@pytest.mark.parametrize("text", ["", "pixel,line,easting,northing\n", "#CRS: EPSG:32650\n"])
def test_a_table_without_points_is_refused(text, tmp_path):
    assert "holds no control points" in refusal(text, tmp_path)


def test_a_crs_that_nobody_knows_is_refused_by_name(tmp_path):
    assert "EPSG:1" in refusal("#CRS: EPSG:1\nmapX,mapY,sourceX,sourceY\n1,2,3,-4\n", tmp_path)


def test_an_image_chosen_in_place_of_the_points_is_refused(tmp_path):
    path = tmp_path / "image.tif"
    path.write_bytes(b"II*\0" + bytes(200))
    with pytest.raises(RoadExtractionError, match="is no text"):
        read_control_points(path, SourceImage(str(path), 10, 10))


def listed(above, order, name="flown.tif", tail=""):
    """A list of control points as photogrammetry software keeps it, each row with the image that it was measured in."""
    height = [20.0 + k for k in range(len(POINTS))]
    values = [{"E": e, "N": n, "p": p, "l": q, "z": z, "i": name, "g": f"gcp{k}"} for k, ((e, n, p, q), z) in enumerate(zip(POINTS, height))]
    return above + "".join(" ".join(str(value[key]) for key in order) + tail + "\n" for value in values)


LISTS = {
    "number": listed("EPSG:32650\n", "ENzpli"),
    "words": listed("WGS84 UTM 50N\n", "ENzpli"),
    "words, zone": listed("WGS 84 / UTM zone 50N\n", "ENzpli"),
    "PROJ": listed("+proj=utm +zone=50 +datum=WGS84 +units=m +no_defs\n", "ENzpli"),
    "WKT": listed(WKT + "\n", "ENzpli"),
    "labels": listed("EPSG:32650\n", "ENzplig"),
    "comments": listed("# measured on Monday\nEPSG:32650\n# x y z pixel line image\n", "ENzpli") + "# end\n",
    "tabs": listed("EPSG:32650\n", "ENzpli").replace(" ", "\t"),
    "windows": ("\ufeff" + listed("EPSG:32650\n", "ENzpli")).replace("\n", "\r\n"),
    "other ending, capitals": listed("EPSG:32650\n", "ENzpli", "FLOWN.JPG"),
    "folder": listed("EPSG:32650\n", "ENzpli", "images/flown.tif"),
    "image first": listed("#CRS: EPSG:32650\n", "iplENz").replace(" ", ",").replace(",EPSG", " EPSG"),
    "header": "EPSG:32650\ngeo_x geo_y geo_z im_x im_y image_name gcp_name\n" + listed("", "ENzplig"),
    "markers": "#CoordinateSystem: EPSG:32650\nMarker Label,X,Y,Z,Camera,Pixel X (px),Pixel Y (px)\n" + listed("", "gENzipl").replace(" ", ","),
    "ENVI": "; ENVI Image to Map GCP File\n; projection info = {UTM, 50, North, WGS-84}\n; Map (x,y), Image (x,y)\n;\n" + listed("", "ENpl"),
}


@pytest.mark.parametrize("kept", LISTS)
def test_lists_of_photogrammetry_software_give_the_same_points(kept, tmp_path):
    path = tmp_path / "gcp_list.txt"
    path.write_bytes(LISTS[kept].encode())
    points = read_control_points(path, image())
    np.testing.assert_allclose([points.pixel, points.line], [PIXEL, LINE])
    np.testing.assert_allclose([points.easting, points.northing], [EASTING, NORTHING])
    assert kept == "ENVI" or list(points.height) == [20.0, 21.0, 22.0, 23.0] and "50N" in points.crs
    assert points.names[1] == ("gcp1" if kept in ("labels", "header", "markers") else "2")


@pytest.mark.parametrize("above", ["EPSG:32650\n", "EPSG:32650\ngeo_x geo_y geo_z im_x im_y image_name\n"])
def test_of_several_images_only_the_rows_of_the_image_in_hand_are_used(above, tmp_path):
    other = [line.split() for line in listed("", "ENzpli", "other.tif").splitlines()]
    other = "".join(" ".join([*row[:3], str(5000 - float(row[3])), str(3000 + float(row[4])), row[5]]) + "\n" for row in other)
    mixed = [line for pair in zip(listed("", "ENzpli").splitlines(), other.splitlines()) for line in pair]
    path = tmp_path / "gcp_list.txt"
    path.write_text(above + "\n".join(mixed))
    points = read_control_points(path, image())
    np.testing.assert_allclose([points.pixel, points.line, points.easting], [PIXEL, LINE, EASTING])
    path.write_text(above + other)
    with pytest.raises(RoadExtractionError, match="no control point of flown.tif: its rows are of other.tif"):
        read_control_points(path, image())


def test_images_whose_names_differ_in_capitals_alone_are_several(tmp_path):
    other = [line.split() for line in listed("", "ENzpli", "FLOWN.TIF").splitlines()]
    path = tmp_path / "gcp_list.txt"
    path.write_text("EPSG:32650\n" + "".join(" ".join([*row[:3], str(5000 - float(row[3])), *row[4:]]) + "\n" for row in other)
                    + listed("", "ENzpli"))
    points = read_control_points(path, image())
    np.testing.assert_allclose([points.pixel, points.line, points.easting], [PIXEL, LINE, EASTING])


def test_words_above_a_list_that_are_no_crs_are_shown(tmp_path):
    assert "'WGS84 UTM 77N'" in refusal(listed("WGS84 UTM 77N\n", "ENzpli"), tmp_path)


def test_heights_between_the_coordinates_are_not_taken_for_pixels(tmp_path):
    """A height of 20 m could be a pixel, too; the ground lies like the image in one order alone."""
    path = tmp_path / "bare.txt"
    path.write_text(listed("", "ENzpl"))
    points = read_control_points(path, image())
    np.testing.assert_allclose([points.pixel, points.height], [PIXEL, [20.0, 21.0, 22.0, 23.0]])
