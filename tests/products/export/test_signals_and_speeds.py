"""What stands beside lanes and what holds for them comes out of one format as it went into the other."""

from collections import defaultdict

import numpy as np
import pytest
import shapely
from exported_maps import as_lanelets, as_roads
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import MARKINGS, Features
from lanewright.core.common.features import SIGNALS as SIGNALS_LAYER
from lanewright.products.export.check.lanelets import check_lanelets
from lanewright.products.export.lanelet_map import layers_of_lanelets, node_places, read_lanelet2
from lanewright.products.export.opendrive.xodr import layers_of_opendrive, read_opendrive
from lanewright.products.export.shared_borders import with_shared_borders
from lanewright.products.export.sources import RoadMapSource, checked
from made_lanes import CRS as LANES_CRS
from made_lanes import crossing
from map_files import geometry, lane, lanelet_street, opendrive, road, written

CRS = "EPSG:25832"
SIGNALS = (
    '<signal id="1" name="light" s="38" t="-5" zOffset="2.5" hOffset="0.1" orientation="+" dynamic="yes" type="1000001" subtype="-1" value="-1" '
    'country="OpenDRIVE" height="0.9" width="0.4"/>'
    '<signal id="2" name="" s="10" t="5" zOffset="2" orientation="-" dynamic="no" type="274" subtype="" country="DE" value="30" unit="km/h" '
    'height="0.6" width="0.6"/>')
OBJECTS = (
    '<object id="1" type="pole" name="mast" s="20" t="-5" zOffset="0" height="6" width="0.2" length="0.2"/>'
    + "".join(f'<object id="{k}" type="crosswalk" s="{s}" t="0" zOffset="0" orientation="none" length="7" width="3" hdg="1.5707963"/>'
              for k, s in ((2, 6), (3, 18), (4, 24), (5, 34)))
    + '<object id="6" type="roadMark" name="StopLine" s="37" t="-1.8" zOffset="0" orientation="none" length="0.4" width="3"/>'
    '<object id="7" type="building" s="30" t="30" zOffset="0" height="9" width="9" length="9"/>')


def street(signals=SIGNALS, objects=OBJECTS, types='<type s="0" type="town"><speed max="30" unit="mph"/></type>', more="", name="Long Street"):
    """A street to the east with a lane each way."""
    lanes = (f'<laneSection s="0"><left>{lane(1)}</left><center>{lane(0, "none", mark="broken")}</center>'
             f'<right>{lane(-1, more=more)}</right></laneSection>')
    text = road(geometry(0, 600000, 5800000, 0, 40), 40, lanes=lanes, profile='<elevation s="0" a="60" b="0.02" c="0" d="0"/>')
    text = text.replace('name=""', f'name="{name}"', 1).replace("<planView>", f"{types}<planView>", 1)
    return opendrive([text.replace("</road>", f"<objects>{objects}</objects><signals>{signals}</signals></road>")],
                     "<controller id='1'><control signalId='1'/></controller>")


def read_in(folder, text):
    return layers_of_opendrive(read_opendrive(written(folder, text)), CRS)


def lanelets_of(folder, layers):
    return as_lanelets(folder, with_shared_borders(checked(layers)))[1]


def roads_of(folder, layers):
    return as_roads(folder, with_shared_borders(checked(layers)))[1]


def there_and_back(folder, layers):
    """Layers of the map as lanelets, and of these as roads."""
    lanelets = layers_of_lanelets(lanelets_of(folder, layers), CRS)
    return lanelets, layers_of_opendrive(roads_of(folder, lanelets), CRS)


def test_a_sign_that_holds_for_no_lane_is_no_rule_of_the_crossings(tmp_path):
    sign = '<signal id="1" s="30" t="5" zOffset="2" orientation="+" dynamic="no" type="274" height="1" width="1"><validity fromLane="5" toLane="6"/>'
    whole = lanelets_of(tmp_path, read_in(tmp_path, street(f"{sign}</signal>")))
    assert any(one.tags.get("subtype") == "crosswalk" for one in whole.lanelets.values()) and not whole.others


def by_kind(layers):
    return {row["kind"]: (shapely.get_coordinates(point, include_z=True)[0], row) for point, row in layers.signals}


def test_lights_signs_and_poles_stand_where_they_stood_and_say_what_they_said(tmp_path):
    layers = read_in(tmp_path, street())
    expected = {"traffic_light": ([600038, 5799995, 63.26], "1000001", 0.9), "sign": ([600010, 5800005, 62.2], "274", 0.6),
                "pole": ([600020, 5799995, 60.4], None, 6.0)}
    for others in (layers, *there_and_back(tmp_path, layers)):
        found = by_kind(others)
        assert set(found) == set(expected)
        for kind, (place, code, height) in expected.items():
            np.testing.assert_allclose(found[kind][0], place, atol=1e-3)
            assert found[kind][1].get("code") == code and found[kind][1]["height_m"] == pytest.approx(height, abs=0.005)
        assert found["sign"][1]["value"] == 30 and found["sign"][1]["unit"] == "km/h" and found["sign"][1]["country"] == "DE"
        headings = [found[kind][1]["heading"] for kind in ("traffic_light", "sign")]
        assert headings == pytest.approx([90 - np.degrees(0.1), 270], abs=0.05)


def test_a_trunk_among_the_poles_of_the_roadside_is_no_sign_of_the_map(tmp_path):
    layers = read_in(tmp_path, street())
    layers.signals.add(shapely.Point(600030, 5799995, 60.6), kind="trunk", height_m=3.0)
    written_out = layers_of_opendrive(roads_of(tmp_path, layers), CRS).signals
    assert sorted(row["kind"] for _, row in written_out) == ["pole", "sign", "traffic_light"]


def test_lights_and_signs_hold_for_the_lanes_that_see_them(tmp_path):
    layers = read_in(tmp_path, street())
    for others in (layers, *there_and_back(tmp_path, layers)):
        for kind, heads_east in (("traffic_light", True), ("sign", False)):
            name, = by_kind(others)[kind][1]["lanes"].split(",")
            row = list(others.lanes.lane_id).index(name)
            first, last = others.lanes.borders(row)[0][[0, -1], 0]
            assert (last > first) == heads_east


def test_lanelets_obey_rules_that_are_whole(tmp_path):
    whole = lanelets_of(tmp_path, read_in(tmp_path, street()))
    assert sorted(rule.tags["subtype"] for rule in whole.others.values()) == ["traffic_light", "traffic_sign"]
    assert not check_lanelets(whole, *node_places(whole, CRS)).found
    signs = [way.tags for way in whole.ways.values() if way.tags.get("type") == "traffic_sign"]
    assert [sign["subtype"] for sign in signs] == ["DE274"]


def crossing_with(*signs):
    """A crossing of four roads with (country, code, road) of signs beside the lanes that come from these, and a stop line before the second."""
    lanes, signals, markings = crossing(), Features("PointZ", SIGNALS_LAYER, crs=LANES_CRS), Features("PolygonZ", MARKINGS, crs=LANES_CRS)
    for country, code, road_number in signs:
        left, right = lanes.borders(list(lanes.lane_id).index(f"{road_number}.1.1"))
        signals.add(shapely.Point(right[-1]), kind="sign", country=country, code=code, lanes=f"{road_number}.1.1", heading=0.0, height_m=0.6)
    left, right = lanes.borders(list(lanes.lane_id).index("2.1.1"))
    markings.add(shapely.LineString([left[-1], right[-1]]).buffer(0.2, cap_style="flat"), **{"class": "stop_line"})
    return RoadMapSource(lanes, signals=signals, markings=markings)


def test_who_comes_to_a_sign_gives_way_to_those_whose_ways_cross_and_stops_at_the_line(tmp_path):
    whole = lanelets_of(tmp_path, crossing_with(("DE", "205", 2), ("DE", "206", 4)))
    name = {lanelet.id: lanelet.name for lanelet in whole.lanelets.values()}
    rules = [rule for rule in whole.others.values() if rule.tags["subtype"] == "right_of_way"]
    said = {role: [[name[id] for _, id in rule.members[role]] for rule in rules] for role in ("yield", "right_of_way")}
    assert said == {"yield": [["2.1.1"], ["4.1.1"]], "right_of_way": [["1.1.1", "3.1.1"]] * 2}
    assert [[whole.ways[id].tags["type"] for _, id in rule.members.get("ref_line", ())] for rule in rules] == [["stop_line"], []]
    for rule in rules:
        obeying = {lanelet.name for lanelet in whole.lanelets.values() if ("relation", rule.id) in lanelet.members.get("regulatory_element", ())}
        assert obeying == {"1.1.1", "3.1.1", name[rule.members["yield"][0][1]]}
    assert not check_lanelets(whole, *node_places(whole, CRS)).found
    again = layers_of_lanelets(whole, CRS)
    assert sorted(name[int(row["lanes"])] for _, row in again.signals) == ["2.1.1", "4.1.1"] and not again.left_out


def test_a_sign_of_another_kind_and_one_before_a_junction_where_all_give_way_make_no_right_of_way(tmp_path):
    for signs in ([("DE", "274", 2)], [("DE", "205", road_number) for road_number in (1, 2, 3, 4)]):
        rules = lanelets_of(tmp_path, crossing_with(*signs)).others.values()
        assert {rule.tags["subtype"] for rule in rules} == {"traffic_sign"}


def test_a_reference_names_lanes_of_another_road_and_a_validity_some_of_a_road(tmp_path):
    signal = ('<signals><signal id="7" s="39" t="-4" zOffset="3" orientation="+" dynamic="yes" type="1000001" subtype="-1">'
              '<validity fromLane="0" toLane="0"/></signal></signals></road>')
    reference = ('<signals><signalReference id="7" s="1" t="-4" orientation="+"><validity fromLane="-1" toLane="-1"/></signalReference></signals>'
                 '</road>')
    roads = [road(geometry(0, x, 0, 0, length), length, id).replace("</road>", more)
             for id, x, length, more in (("1", 0, 40, signal), ("2", 50, 20, reference))]
    layers = read_in(tmp_path, opendrive(roads))
    assert by_kind(layers)["traffic_light"][1]["lanes"] == "2.-1.0"
    assert by_kind(layers_of_opendrive(roads_of(tmp_path, layers), CRS))["traffic_light"][1]["lanes"] == "2.-1.0"


def test_roads_state_signals_before_references_and_countries_in_capitals(tmp_path):
    sign = '<signal id="{}" s="9" t="-4" zOffset="3" orientation="+" dynamic="no" type="31" subtype="-1" country="{}"/></signals></road>'
    reference = '<signals><signalReference id="2" s="1" t="-4" orientation="+"/>'
    roads = [road(geometry(0, x, 0, 0, 40), 40, str(id)).replace("</road>", before + sign.format(id, country))
             for id, x, before, country in ((1, 0, reference, "se"), (2, 50, "<signals>", "GERMANY"))]
    whole = roads_of(tmp_path, read_in(tmp_path, opendrive(roads)))
    order = [[one.tag for one in element.find("signals").children] for element in whole.tree.all("road")]
    assert order == [["signal", "signalReference"], ["signal"]]
    assert [item["country"] for item in whole.roads[0].signals + whole.roads[1].signals if item["own"]] == ["SE", "Germany"]


def test_every_crossing_and_the_stop_line_lie_where_they_lay(tmp_path):
    layers = read_in(tmp_path, street())
    expected = {(round(x, 1), round(y, 1)) for x, y in ((6, 0), (18, 0), (24, 0), (34, 0), (37, -1.8))}
    for others in (layers, *there_and_back(tmp_path, layers)):
        middles = {(round(area.centroid.x - 600000, 1), round(area.centroid.y - 5800000, 1)): row["class"] for area, row in others.markings}
        assert {(x, y + 0.0) for x, y in middles} == expected
        assert sorted(middles.values()) == ["crosswalk"] * 4 + ["stop_line"]


@pytest.mark.parametrize("types, more, expected", [
    ('<type s="0" type="town"><speed max="30" unit="mph"/></type>', "", (48.28, 48.28)),
    ('<type s="0" type="rural"><speed max="25" unit="m/s"/></type>', '<speed sOffset="0" max="70" unit="km/h"/>', (70, 90)),
    ('<type s="0" type="motorway"><speed max="no limit" unit="km/h"/></type>', "", (None, None)),
    ("", "", (None, None))])
def test_speed_limits_are_those_of_the_lane_else_of_its_road(tmp_path, types, more, expected):
    layers = read_in(tmp_path, street(types=types, more=more))
    known = [layers.attributes[name].get("speed_kmh") for name in ("1.-1.0", "1.1.0")]
    assert known == [limit and pytest.approx(limit, abs=0.01) for limit in expected]
    for others in there_and_back(tmp_path, layers):
        limits = sorted(known["speed_kmh"] for known in others.attributes.values() if "speed_kmh" in known)
        assert limits == pytest.approx(sorted(limit for limit in expected if limit), abs=0.01)


def test_a_lane_has_every_speed_limit_where_it_holds(tmp_path):
    types = '<type s="0" type="town"><speed max="30" unit="km/h"/></type><type s="25" type="town"><speed max="50" unit="km/h"/></type>'
    layers = read_in(tmp_path, street(types=types, more='<speed sOffset="10" max="70" unit="km/h"/>'))
    for others in (layers, *there_and_back(tmp_path, layers)):
        limits = defaultdict(float)
        for k, name in enumerate(others.lanes.lane_id):
            limits[others.attributes[name]["speed_kmh"]] += float(others.lanes.length[k])
        assert limits == pytest.approx({30: 10 + 25, 70: 30, 50: 15}, abs=0.05)
        assert sum(map(len, others.lanes.successors)) == 4, "the parts of a lane lead to each other"


def test_signals_without_an_id_hold_for_the_lanes_of_their_own_road_alone(tmp_path):
    sign = '<signals><signal s="9" t="-4" zOffset="3" orientation="+" dynamic="no" type="31" subtype="-1"/></signals></road>'
    roads = [road(geometry(0, x, 0, 0, 40), 40, id).replace("</road>", sign) for id, x in (("1", 0), ("2", 50))]
    layers = read_in(tmp_path, opendrive(roads))
    assert sorted(row["lanes"] for _, row in layers.signals) == ["1.-1.0", "2.-1.0"]


def test_two_roads_of_one_id_are_not_converted(tmp_path):
    layers = read_in(tmp_path, opendrive([road(geometry(0, x, 0, 0, 40), 40, "1") for x in (0, 50)]))
    with pytest.raises(RoadExtractionError, match=r"is there 2 times: two roads of the map have one id"):
        checked(layers)


def test_the_name_of_a_road_is_carried_and_its_number_is_none(tmp_path):
    for others in there_and_back(tmp_path, read_in(tmp_path, street())):
        assert {known["name"] for known in others.attributes.values()} == {"Long Street"}
    assert all("name" not in known for known in read_in(tmp_path, street(name="Road 12")).attributes.values())


def test_what_no_layer_holds_is_counted(tmp_path):
    layers = read_in(tmp_path, street())
    assert layers.said_left_out() == ["Not carried over: 1 building, 1 controller."]
    walkway = lanelet_street().replace('<tag k="subtype" v="road"/>', '<tag k="subtype" v="walkway"/>', 1)
    text = walkway.replace("</osm>", '<relation id="900"><tag k="type" v="multipolygon"/><tag k="subtype" v="parking"/></relation></osm>')
    lanelets = layers_of_lanelets(read_lanelet2(written(tmp_path, text, "map.osm")), CRS)
    assert lanelets.said_left_out() == ["Not carried over: 1 multipolygon parking, 1 walkway lanelet."]


def test_the_sign_of_a_speed_limit_is_one(tmp_path):
    rule = ('<relation id="800"><tag k="type" v="regulatory_element"/><tag k="subtype" v="speed_limit"/><tag k="sign_type" v="de274-60"/></relation>')
    text = lanelet_street(more=rule)
    text = text.replace('<relation id="101">', '<relation id="101"><member type="relation" role="regulatory_element" ref="800"/>')
    text = text.replace('<relation id="201">', '<relation id="201"><tag k="speed_limit" v="20 mph"/>')
    layers = layers_of_lanelets(read_lanelet2(written(tmp_path, text, "map.osm")), CRS)
    assert layers.attributes == {"101": {"speed_kmh": 60.0}, "201": {"speed_kmh": pytest.approx(32.19, abs=0.01)}}
