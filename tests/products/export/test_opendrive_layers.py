"""A road of OpenDRIVE comes back as lanes and lines where its geometry says."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.products.export.opendrive.geometry import Cubics, PlanElement
from lanewright.products.export.opendrive.xodr import layers_of_opendrive, read_opendrive
from lanewright.products.export.sources import crs_of_reference
from map_files import geometry, lane, opendrive, road, street_section, written


def layers(folder, *roads, **more):
    return layers_of_opendrive(read_opendrive(written(folder, opendrive(roads, **more))))


def named(lanes, lane_id):
    return lanes.borders(list(lanes.lane_id).index(lane_id))


def test_the_lanes_of_a_straight_street_lie_beside_its_line(tmp_path):
    lanes = layers(tmp_path, road(geometry(0, 10, 20, 0, 40), 40)).lanes
    left, right = named(lanes, "1.-1.0")
    np.testing.assert_allclose(left[[0, -1]], [[10, 20, 0], [50, 20, 0]], atol=1e-9)
    np.testing.assert_allclose(right[[0, -1]], [[10, 16.5, 0], [50, 16.5, 0]], atol=1e-9)
    left, right = named(lanes, "1.1.0")   # driven to the west, with the middle to its left
    np.testing.assert_allclose(left[[0, -1]], [[50, 20, 0], [10, 20, 0]], atol=1e-9)
    np.testing.assert_allclose(right[[0, -1]], [[50, 23.5, 0], [10, 23.5, 0]], atol=1e-9)


def test_in_left_hand_traffic_the_same_lanes_are_driven_the_other_way(tmp_path):
    lanes = layers(tmp_path, road(geometry(0, 0, 0, 0, 40), 40, rule="LHT")).lanes
    assert dict(zip(lanes.lane_id, lanes.direction)) == {"1.1.0": 1, "1.-1.0": -1}
    left, right = named(lanes, "1.-1.0")
    assert left[0, 0] == 40 and left[0, 1] == -3.5 and right[0, 1] == 0


def test_on_an_arc_the_borders_are_arcs_about_the_same_centre(tmp_path):
    radius = 50.0
    lanes = layers(tmp_path, road(geometry(0, 0, 0, 0, 60, f'<arc curvature="{1 / radius}"/>'), 60)).lanes
    for border, expected in zip(named(lanes, "1.-1.0"), (radius, radius + 3.5)):
        np.testing.assert_allclose(np.hypot(border[:, 0], border[:, 1] - radius), expected, atol=1e-9)


def test_a_spiral_is_fresnels_integral():
    """With curvature growing from 0 at a rate of pi, a clothoid is at (C(1), S(1)) after 1 m, by the tables of Abramowitz and Stegun 7.7."""
    places, heading, bend = PlanElement(0, 0, 0, 0, 1.0, "spiral", (0.0, np.pi)).at(np.array([1.0]))
    np.testing.assert_allclose(places[0], [0.7798934, 0.4382591], atol=1e-6)
    assert heading[0] == pytest.approx(np.pi / 2) and bend[0] == pytest.approx(np.pi)


@pytest.mark.parametrize("normalized, scale", [(False, 1.0), (True, 40.0)])
def test_a_parametric_polynomial_by_arc_length_or_by_share(normalized, scale):
    element = PlanElement(0, 5, 6, np.pi / 2, 40.0, "paramPoly3", (0, scale, 0, 0, 0, 0, 0.01 * scale**2, 0), normalized)
    places, heading, _ = element.at(np.array([0.0, 20.0]))
    np.testing.assert_allclose(places, [[5, 6], [5 - 4.0, 26]], atol=1e-9)
    assert heading[1] == pytest.approx(np.pi / 2 + np.arctan(0.4))


def test_a_polynomial_of_old_files_is_walked_by_its_arc_length():
    """v = u^2 / 20 is 5 m up after 10 m across, an arc of 11.478 m (closed form of the parabola's length)."""
    length = 10 * np.sqrt(2) / 2 + 10 * np.arcsinh(1) / 2
    places, heading, _ = PlanElement(0, 0, 0, 0, 40.0, "poly3", (0, 0, 0.05, 0)).at(np.array([length]))
    np.testing.assert_allclose(places[0], [10.0, 5.0], atol=2e-3)
    assert heading[0] == pytest.approx(np.pi / 4, abs=1e-3)


def test_heights_follow_profile_crossfall_shape_and_curb(tmp_path):
    lateral = '<superelevation s="0" a="0.05" b="0" c="0" d="0"/>'
    lanes = layers(tmp_path, road(geometry(0, 0, 0, 0, 40), 40, profile='<elevation s="0" a="10" b="0.01" c="0" d="0"/>', lateral=lateral)).lanes
    left, right = named(lanes, "1.-1.0")
    np.testing.assert_allclose(left[:, 2], 10 + 0.01 * left[:, 0], atol=1e-9)
    np.testing.assert_allclose(right[0], [0, -3.5 * np.cos(0.05), 10 - 3.5 * np.sin(0.05)], atol=1e-9)
    crown = ''.join(f'<shape s="{s}" t="{t}" a="{-0.025 * abs(t)}" b="{0.025 if t < 0 else -0.025}" c="0" d="0"/>' for s in (0, 40) for t in (-4, 0))
    lanes = layers(tmp_path, road(geometry(0, 0, 0, 0, 40), 40, lateral=crown)).lanes
    for name in ("1.-1.0", "1.1.0"):
        np.testing.assert_allclose(named(lanes, name)[1][:, 2], -0.0875, atol=1e-9)


def test_widths_grow_as_their_polynomial_and_lines_end_where_their_paint_does(tmp_path):
    taper = ('<width sOffset="0" a="3" b="0" c="0" d="0"/><width sOffset="10" a="3" b="0" c="0.03" d="-0.001"/>'
             '<width sOffset="30" a="7" b="0" c="0" d="0"/>')
    marks = '<roadMark sOffset="25" type="broken" color="white" width="0.2"/>'
    section = (f'<laneSection s="0"><center>{lane(0, "none", mark="none")}</center><right>{lane(-1, widths=taper, more=marks)}</right></laneSection>')
    found = layers(tmp_path, road(geometry(0, 0, 0, 0, 40), 40, lanes=section))
    _, right = named(found.lanes, "1.-1.0")
    np.testing.assert_allclose(np.interp([5, 20, 35], right[:, 0], -right[:, 1]), [3, 5, 7], atol=1e-9)
    painted = found.marking_lines
    assert [(row["pattern"], round(line.bounds[0], 6), round(line.bounds[2], 6)) for line, row in painted] == [("solid", 0, 25), ("dashed", 25, 40)]
    assert painted.rows[1]["width_m"] == 0.2


def test_lanes_lead_on_through_sections_roads_and_junctions(tmp_path):
    links = ('<predecessor id="1"/><successor id="1"/>', '<predecessor id="-1"/><successor id="-1"/>')
    two = street_section(0, (links[0][:0] + '<successor id="1"/>', '<successor id="-1"/>')) + street_section(20, links)
    first = road(geometry(0, 0, 0, 0, 40), 40, "1", lanes=two, link='<successor elementType="junction" elementId="9"/>')
    turn = road(geometry(0, 40, 0, 0, 10), 10, "2", junction="9", lanes=street_section(0, links),
                link='<predecessor elementType="road" elementId="1" contactPoint="end"/>'
                     '<successor elementType="road" elementId="3" contactPoint="start"/>')
    last = road(geometry(0, 50, 0, 0, 40), 40, "3", lanes=street_section(0, ("", "")), link='<predecessor elementType="junction" elementId="9"/>')
    junction = ('<junction id="9" name=""><connection id="0" incomingRoad="1" connectingRoad="2" contactPoint="start">'
                '<laneLink from="-1" to="-1"/></connection><connection id="1" incomingRoad="3" connectingRoad="2" contactPoint="end">'
                '<laneLink from="1" to="1"/></connection></junction>')
    lanes = layers(tmp_path, first, turn, last, junctions=junction).lanes
    follows = dict(zip(lanes.lane_id, lanes.successors))
    assert follows["1.-1.0"] == ("1.-1.1",) and follows["1.-1.1"] == ("2.-1.0",) and follows["2.-1.0"] == ("3.-1.0",)
    assert follows["3.1.0"] == ("2.1.0",) and follows["2.1.0"] == ("1.1.1",) and follows["1.1.1"] == ("1.1.0",)
    assert dict(zip(lanes.lane_id, lanes.type))["2.-1.0"] == "connector"


@pytest.mark.parametrize("says", ["1", "2"])
def test_a_link_that_one_of_two_lanes_says_is_one(tmp_path, says):
    link = {"1": '<successor elementType="road" elementId="2" contactPoint="start"/>',
            "2": '<predecessor elementType="road" elementId="1" contactPoint="end"/>'}
    of_lanes = {"1": '<successor id="{0}"/>', "2": '<predecessor id="{0}"/>'}
    roads = [road(geometry(0, x, 0, 0, 40), 40, id, link=link[id] * (id == says),
                  lanes=street_section(0, [of_lanes[id].format(lane) * (id == says) for lane in (1, -1)])) for id, x in (("1", 0), ("2", 40))]
    lanes = layers(tmp_path, *roads).lanes
    follows = dict(zip(lanes.lane_id, lanes.successors))
    assert follows["1.-1.0"] == ("2.-1.0",) and follows["2.1.0"] == ("1.1.0",)


def test_a_curb_is_a_road_edge_at_its_foot(tmp_path):
    edges = layers(tmp_path, road(geometry(0, 0, 0, 0, 40), 40)).road_edges
    assert len(edges) == 1 and edges.rows[0]["side"] == "right"
    np.testing.assert_allclose(shapely.get_coordinates(edges.geometries[0], include_z=True)[:, 1:], np.tile([-3.5, 0], (41, 1)), atol=1e-9)


def test_the_false_origin_is_added_and_the_reference_read(tmp_path):
    whole = read_opendrive(written(tmp_path, opendrive([road(geometry(0, 1, 2, 0, 40), 40)], offset=(500000, 5800000))))
    lanes = layers_of_opendrive(whole).lanes
    np.testing.assert_allclose(named(lanes, "1.-1.0")[0][0], [500001, 5800002, 0])
    assert "25832" in crs_of_reference(whole.reference, "")[0]


@pytest.mark.parametrize("text, given, said", [("", "", "no geoReference"), ("EPSG:4326", "", "cannot be used"), ("nonsense", "", "cannot be used")])
def test_a_map_of_unknown_place_is_read_with_a_note(text, given, said):
    crs, note = crs_of_reference(text, given)
    assert crs == "" and said in note


def test_a_file_without_roads_and_one_with_a_broken_road(tmp_path):
    with pytest.raises(RoadExtractionError, match="no road that can be read"):
        read_opendrive(written(tmp_path, opendrive([])))
    with pytest.raises(RoadExtractionError, match="no road that can be read.*length of <geometry>"):
        read_opendrive(written(tmp_path, opendrive([road(geometry(0, 0, 0, 0, "1e999"), 40)])))
    broken = layers(tmp_path, road("", 40, "1"), road(geometry(0, 0, 0, 0, 40), 40, "2"))
    assert len(broken.lanes) == 2 and "1 parts of the file were passed over" in broken.notes[0]


def test_the_least_value_of_a_cubic_lies_between_its_ends():
    value, where = Cubics(np.array([[0.0, 1.0, -0.4, 0.04, 0.0]])).least(20.0)
    assert value == pytest.approx(0.0) and where == pytest.approx(5.0)
