"""Lines for the design office: elements that a LandXML reader adds up to the line again, and polylines by class."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.features import DRIVING_LINES, Features
from lanewright.products.cad import NAMESPACE, _DxfLine, alignments_of, dxf_lines, elements_without_reversal, landxml_text, write_dxf
from lanewright.products.export.opendrive.geometry import PlanElement, PlanView
from lanewright.products.export.sources import RoadMapSource, checked
from lanewright.products.export.xml_tree import read_xml
from made_lanes import CRS, crossing, s_curve, street
from map_files import written

gdal = pytest.importorskip("osgeo.gdal")


def driven(lanes):
    """The middle of the first lane in two pieces, given in the wrong order."""
    layer, middle = Features("LineStringZ", DRIVING_LINES), sum(lanes.borders(0)) / 2
    for rows in (slice(100, None), slice(0, 101)):
        layer.add(shapely.linestrings(middle[rows]), road=1, lane=1, status="measured")
    return layer


def landxml(folder, lanes, tolerance=0.02, **layers):
    found = alignments_of(checked(RoadMapSource(lanes, **layers)), tolerance)
    return found, read_xml(written(folder, landxml_text(found, CRS), "map.xml"), "LandXML", "a LandXML file")


def places(element, tag):
    north, east = map(float, element.find(tag).text.split()[:2])
    return np.array([east, north])


def test_elements_join_end_to_end_and_curves_have_their_radius_and_centre(tmp_path):
    lanes = s_curve(slope=0.02)
    found, root = landxml(tmp_path, lanes, driving_lines=driven(lanes))
    assert root.get("xmlns") == NAMESPACE and root.find("CoordinateSystem").get("epsgCode") == "25832"
    alignments = list(root.find("Alignments").all("Alignment"))
    assert [one.get("name") for one in alignments] == ["Road 1", "Lane 1.1"]
    for alignment in alignments:
        elements = alignment.find("CoordGeom").children
        assert {element.tag for element in elements} == {"Line", "Curve", "Spiral"}
        for first, second in zip(elements[:-1], elements[1:]):
            np.testing.assert_allclose(places(first, "End"), places(second, "Start"), atol=2e-5)
        assert sum(element.number("length") for element in elements) == pytest.approx(alignment.number("length"), abs=1e-6)
        for curve in (element for element in elements if element.tag == "Curve"):
            for tag in ("Start", "End"):
                assert np.hypot(*(places(curve, tag) - places(curve, "Center"))) == pytest.approx(curve.number("radius"), abs=1e-3)
        for spiral in (element for element in elements if element.tag == "Spiral"):
            assert spiral.get("spiType") == "clothoid" and spiral.get("rot") in ("cw", "ccw")
    assert max(one.missed for one in found) <= 0.02


def test_the_profile_has_the_heights_of_the_line_by_few_points(tmp_path):
    lanes = s_curve(slope=0.02)
    _, root = landxml(tmp_path, lanes)
    profile = root.find("Alignments", "Alignment").find("Profile", "ProfAlign")
    rows = np.array([[float(value) for value in point.text.split()] for point in profile.all("PVI")])
    assert len(rows) <= 4
    np.testing.assert_allclose(np.interp([0, 110, 220], *rows.T), [70, 72.2, 74.4], atol=0.02)


def test_a_spiral_that_turns_from_left_to_right_is_two():
    spiral = PlanElement(0, 0, 0, 0, 60.0, "spiral", (0.02, -0.01))
    first, second = elements_without_reversal(PlanView((spiral,)))
    assert first.length == pytest.approx(40) and first.values[1] == 0 and second.values[0] == 0
    np.testing.assert_allclose(second.end(), spiral.end(), atol=1e-9)


def test_without_driving_lines_the_middles_of_the_lanes_are_aligned(tmp_path):
    found, _ = landxml(tmp_path, street())
    assert [one.name for one in found] == ["Road 1", "Lane 1.1.1", "Lane 1.2.1"]
    assert found[1].length == pytest.approx(60.0, abs=1e-3)


def test_a_dxf_has_every_line_in_3d_in_the_layer_of_its_class(tmp_path):
    lanes = s_curve(slope=0.02)
    source = checked(RoadMapSource(lanes, driving_lines=driven(lanes)))
    lines = dxf_lines(source)
    write_dxf(lines, str(tmp_path / "map.dxf"))
    dataset = gdal.OpenEx(str(tmp_path / "map.dxf"))
    layer = dataset.GetLayer(0)
    found = {}
    for feature in layer:
        found.setdefault(feature.GetField("Layer"), []).append(np.array(feature.GetGeometryRef().GetPoints()))
    assert set(found) == {"LANE_BORDER_DRIVING", "DRIVING_LINE"}
    assert len(found["LANE_BORDER_DRIVING"]) == 3 and len(found["DRIVING_LINE"]) == 2
    border = min(found["LANE_BORDER_DRIVING"], key=lambda points: np.abs(points[0] - lanes.left[0]).sum())
    np.testing.assert_allclose(border, lanes.borders(0)[0], atol=1e-6)


def test_a_text_in_a_dxf_keeps_its_letters_its_place_and_its_turn(tmp_path):
    write_dxf([_DxfLine("SECTION_TEXT", np.array([[3.0, 4.0, 0.0]]), text="Straße 2 %", turned=90.0)], str(tmp_path / "text.dxf"))
    dataset = gdal.OpenEx(str(tmp_path / "text.dxf"))
    feature = dataset.GetLayer(0).GetNextFeature()
    assert feature.GetField("Layer") == "SECTION_TEXT" and feature.GetField("Text") == "Straße 2 %"
    assert feature.GetGeometryRef().GetPoint(0) == (3.0, 4.0, 0.0) and "a:90" in feature.GetStyleString()


def test_lines_that_no_elements_follow_are_irregular(tmp_path):
    layer = Features("LineStringZ", DRIVING_LINES)
    x = np.arange(0.0, 12.0, 0.5)
    layer.add(shapely.linestrings(np.c_[602000 + x, 5792000 + np.where(np.arange(len(x)) % 2, 0.3, 0.0), np.full(len(x), 70.0)]), road=1, lane=1)
    _, root = landxml(tmp_path, crossing(), 0.005, driving_lines=layer)
    last = list(root.find("Alignments").all("Alignment"))[-1]
    assert [element.tag for element in last.find("CoordGeom").children] == ["IrregularLine"]
